"""Rigid bodies on an elastic half-space of Poisson's ratio 1/2: pressure and shear on square cells.

Arrays are cells [rows, columns], row 0 at +y; lengths in pillars, pressures over pi E* (no unit). Closed forms of
Hertz, Cattaneo and Mindlin, Mindlin and Deresiewicz, and Carter: K. L. Johnson, Contact Mechanics (1985), chapters
4, 7 and 8. Boundary elements: docs/derivations/half_space.md, whose equations are cited; no code is shared."""

import numpy as np


def cells(rows, cols, per_pillar):
    """x and y of the centres of the cells of rows x cols pillars, from the middle of the skin."""
    x, y = ((np.arange(n * per_pillar) + 0.5) / per_pillar - n / 2 for n in (cols, rows))
    return np.meshgrid(x, -y)


# --- Closed forms. Each returns p, qx, qy: the pressure, and the shear on the skin ---

def turned(x, y, angle, at=(0, 0)):
    """Coordinates along and across a direction, rad, from a point."""
    x, y, c, s = x - at[0], y - at[1], np.cos(angle), np.sin(angle)
    return c * x + s * y, c * y - s * x


def hertz(x, y, size, radii=(1, 1)):
    """Pressure of an ellipsoid whose contact has the semi-axes size * radii."""
    inside = size**2 - (x / radii[0])**2 - (y / radii[1])**2
    return np.sqrt(np.maximum(inside, 0)) if size > 0 else 0 * x


def punch(x, y, size):
    """Pressure of a flat round punch; its singular rim is cut off at seven times the pressure of the middle."""
    r2 = (x**2 + y**2) / size**2
    return np.where(r2 < 1, 1 / np.sqrt(np.maximum(1 - r2, 0.02)), 0)


def along(p, q, angle):
    """Shear of the size q in one direction."""
    return p, q * np.cos(angle), q * np.sin(angle)


def dragged(pressure, order, friction, angle, share, before=None):
    """Partial slip under a constant load: pressure(s) is that of a contact of s times the size, whose load grows with
    the power `order` of s (3 of a point, 2 of a line contact). Shear of `share` (-1 to 1) of the friction, from zero,
    or from a drag to the share `before` that turned back."""
    def stuck(part):
        return pressure(max(1 - part, 0)**(1 / order))

    p = pressure(1)
    if before is None:
        q = np.sign(share) * (p - stuck(abs(share)))
    else:
        q = p - stuck(before) - 2 * (p - stuck((before - share) / 2))
    return along(p, friction * q, angle)


def sliding(x, y, p, friction, velocity, spin=0, at=(0, 0)):
    """Shear under a body that slides with a velocity and spins, 1/s, about a point."""
    vx, vy = velocity[0] - spin * (y - at[1]), velocity[1] + spin * (x - at[0])
    speed = np.maximum(np.hypot(vx, vy), 1e-9)
    return p, friction * p * vx / speed, friction * p * vy / speed


def rolling(x, y, half, length, friction, share, angle, at):
    """Carter's cylinder, which rolls along `angle`: it sticks at the leading edge. Shear of `share` of the friction."""
    ahead, side = turned(x, y, angle, at)
    inside = abs(side) < length / 2
    stick = half * np.sqrt(1 - abs(share))

    def line(centre, width):
        return np.where(inside, np.sqrt(np.maximum(width**2 - (ahead - centre)**2, 0)), 0)

    p = line(0, half)
    return along(p, np.sign(share) * friction * (p - line(half - stick, stick)), angle)


# --- Boundary elements ---

def convolution(kernel, shape, size, odd=False):
    """Transform of the displacement of cells of a size by a load on one of them; kernel: twice its integral, (H4)."""
    dy, dx = (abs(np.fft.fftfreq(2 * n, 1 / (2 * n))) * size for n in shape)
    x, y = np.meshgrid(dx, dy)
    half = size / 2
    values = sum(a * b * kernel(x + a * half, y + b * half) for a in (-1, 1) for b in (-1, 1))
    if odd:
        signs = [np.sign(np.fft.fftfreq(2 * n)) for n in shape]
        values = values * signs[0][:, None] * signs[1]
    return np.fft.rfft2(values)


def minimise(gradient, project, start, steepest, tolerance):
    """Least q.Aq / 2 - q.b where `project` allows, by accelerated projected gradients that start anew when they turn;
    gradient(q) = A q - b, whose slope is at most `steepest`. Ends when a step moves A q by less than `tolerance`."""
    now, ahead, weight = start, start, 1.0
    for _ in range(5000):
        new = project(ahead - gradient(ahead) / steepest)
        if steepest * abs(new - ahead).max() < tolerance:
            return new
        if ((ahead - new) * (new - now)).sum() > 0:
            weight, ahead, now = 1.0, new, new
            continue
        grown = (1 + np.sqrt(1 + 4 * weight**2)) / 2
        now, ahead, weight = new, new + (weight - 1) / grown * (new - now), grown
    raise ArithmeticError("boundary elements: no convergence in 5000 steps; take a shorter step of the path")


class Indenter:
    """A body of the height shape(x, y) above its lowest point, its friction a number or one a cell, moved in steps.
    y of the skin points up, so rows run against it."""

    def __init__(self, x, y, shape, friction):
        self.x, self.y, self.shape, self.friction = x, y, shape, friction
        size = x[0, 1] - x[0, 0]

        def first(a, b):
            return b * np.log(a + np.hypot(a, b))  # of a^2 / r^3

        def transform(kernel, odd=False):
            return convolution(kernel, x.shape, size, odd)

        self.normal = transform(lambda a, b: first(a, b) + first(b, a))
        self.xx = transform(lambda a, b: 2 * first(a, b) + first(b, a))
        self.yy = transform(lambda a, b: first(a, b) + 2 * first(b, a))
        self.xy = -transform(lambda a, b: -np.hypot(a, b), odd=True)
        self.p, self.q = 0 * x, np.zeros((2, *x.shape))
        self.pose = None

    def displaced(self, tractions, kernel):
        rows, cols = self.x.shape
        return np.fft.irfft2(np.fft.rfft2(tractions, (2 * rows, 2 * cols)) * kernel)[:rows, :cols]

    def sheared(self, q):
        rows, cols = self.x.shape
        u, v = np.fft.rfft2(q, (2 * rows, 2 * cols))
        both = np.fft.irfft2(np.array([self.xx * u + self.xy * v, self.xy * u + self.yy * v]))
        return both[:, :rows, :cols]

    def move(self, at, angle, depth):
        """Next pose: place, rotation, rad, and depth of the lowest point. Returns p, qx, qy."""
        room = depth - self.shape(*turned(self.x, self.y, angle, at))
        self.p = minimise(lambda p: self.displaced(p, self.normal) - room, lambda p: np.maximum(p, 0), self.p,
                          abs(self.normal).max(), 1e-4 * depth)
        old_at, old_angle = self.pose or (at, angle)
        middle, turn = np.add(at, old_at) / 2, angle - old_angle
        moved = np.array([at[0] - old_at[0] - turn * (self.y - middle[1]),
                          at[1] - old_at[1] + turn * (self.x - middle[0])])
        moved = moved + self.sheared(self.q)
        limit = self.friction * self.p
        self.q = minimise(lambda q: self.sheared(q) - moved,
                          lambda q: q * (limit / np.maximum(np.hypot(*q), np.maximum(limit, 1e-30))), self.q,
                          (abs(self.xx) + abs(self.xy)).max(), 1e-3 * abs(moved).max() + 1e-12)
        self.pose = at, angle
        return self.p, *self.q
