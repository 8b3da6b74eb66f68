"""Rigid bodies on an elastic half-space of Poisson's ratio 1/2: pressure p and shear qx, qy on the skin, on square cells.

Arrays are [rows, columns] of cells, row 0 at +y; lengths in pillars, tractions over pi E*. Closed forms: K. L. Johnson,
Contact Mechanics (1985), chapters 4, 7, 8. Boundary elements: docs/derivations/half_space.md, with no code shared."""

import numpy as np


def cells(rows, cols, per_pillar):
    """x and y of the centres of the cells of rows x cols pillars, from the middle of the skin."""
    x, y = ((np.arange(n * per_pillar) + 0.5) / per_pillar - n / 2 for n in (cols, rows))
    return np.meshgrid(x, -y)


def turned(x, y, angle, at=(0, 0)):
    """Coordinates along and across a direction, rad, from a point."""
    x, y, c, s = x - at[0], y - at[1], np.cos(angle), np.sin(angle)
    return c * x + s * y, c * y - s * x


def hertz(x, y, size, radii=(1, 1)):
    """Hertz's pressure of an ellipsoid whose contact has the semi-axes size * radii."""
    return np.sqrt(np.maximum(size**2 - (x / radii[0])**2 - (y / radii[1])**2, 0))


def line(ahead, side, half, length):
    """Pressure of a cylinder whose contact is 2 half wide, cut off at its ends."""
    return np.where(abs(side) < length / 2, hertz(ahead, 0, half), 0)


def punch(x, y, size):
    """Pressure of a flat round punch; its singular rim is cut off at seven times the pressure of the middle."""
    r2 = (x**2 + y**2) / size**2
    return np.where(r2 < 1, 1 / np.sqrt(np.maximum(1 - r2, 0.02)), 0)


def along(p, q, angle):
    return p, q * np.cos(angle), q * np.sin(angle)


def dragged(pressure, order, friction, angle, share, before=None):
    """Cattaneo's and Mindlin's partial slip: shear of `share` (-1 to 1) of the friction at a constant load, from zero, or
    from a drag to the share `before` that turned back. pressure(s): of the contact scaled by s, whose load grows with
    s**order (3 of a point, 2 of a line)."""
    def stuck(part):
        return pressure(part**(1 / order))

    p = pressure(1)
    q = p - stuck(1 - share) if before is None else p - stuck(1 - before) - 2 * (p - stuck(1 - (before - share) / 2))
    return along(p, friction * q, angle)


def sliding(x, y, p, friction, velocity, spin=0, at=(0, 0)):
    """Shear under a body that slides with a velocity and spins about a point."""
    vx, vy = velocity[0] - spin * (y - at[1]), velocity[1] + spin * (x - at[0])
    scale = friction * p / np.maximum(np.hypot(vx, vy), 1e-9)
    return p, scale * vx, scale * vy


def rolling(x, y, half, length, friction, share, angle, at):
    """Carter's cylinder, which rolls along `angle` and sticks at its leading edge; shear of `share` of the friction."""
    ahead, side = turned(x, y, angle, at)
    stick = half * np.sqrt(1 - abs(share))
    p = line(ahead, side, half, length)
    return along(p, np.sign(share) * friction * (p - line(ahead - half + stick, side, stick, length)), angle)


def convolution(kernel, x, odd=False):
    """Transform of the displacements that a loaded cell causes; kernel: twice its integral, (H4)."""
    size = x[0, 1] - x[0, 0]
    steps = [np.fft.fftfreq(2 * n, 1 / (2 * n)) for n in x.shape]
    a, b = np.meshgrid(*(abs(step) * size for step in steps[::-1]))
    values = sum(s * t * kernel(a + s * size / 2, b + t * size / 2) for s in (-1, 1) for t in (-1, 1))
    return np.fft.rfft2(values * np.outer(*map(np.sign, steps)) if odd else values)


def minimise(product, b, project, start, steepest, tolerance):
    """Least q.Aq / 2 - q.b where `project` allows, product(q) = A q, which stretches by at most `steepest`: accelerated
    projected gradients that start anew when they turn back. Ends when a step moves A q by less than `tolerance`."""
    now, ahead, weight = start, start, 1.0
    for _ in range(5000):
        new = project(ahead - (product(ahead) - b) / steepest)
        if steepest * abs(new - ahead).max() < tolerance:
            return new
        if ((ahead - new) * (new - now)).sum() > 0:
            weight = 1.0
        grown = (1 + np.sqrt(1 + 4 * weight**2)) / 2
        now, ahead, weight = new, new + (weight - 1) / grown * (new - now), grown
    raise ArithmeticError("boundary elements: no convergence in 5000 steps; take a shorter step of the path")


def boundary_elements(x, y, shape, friction, poses):
    """(p, qx, qy) of each pose (place, rotation, rad, depth) of a body of the height shape(x, y) above its lowest point."""
    def first(a, b):
        return b * np.log(a + np.hypot(a, b))

    normal = convolution(lambda a, b: first(a, b) + first(b, a), x)
    xx = convolution(lambda a, b: 2 * first(a, b) + first(b, a), x)
    yy = convolution(lambda a, b: first(a, b) + 2 * first(b, a), x)
    xy = convolution(np.hypot, x, odd=True)  # the kernel is -hypot, and y points against the rows

    def applied(q, *matrix):
        q = np.fft.rfft2(q, [2 * n for n in x.shape])
        moved = np.fft.irfft2(np.array([sum(a * b for a, b in zip(row, q)) for row in matrix]))
        return moved[:, :x.shape[0], :x.shape[1]]

    def pressed(p):
        return applied(p, [normal])

    def sheared(q):
        return applied(q, [xx, xy], [xy, yy])

    p, q, before = np.zeros((1, *x.shape)), np.zeros((2, *x.shape)), poses[0]
    for place, angle, depth in poses:
        p = minimise(pressed, depth - shape(*turned(x, y, angle, place)), lambda p: np.maximum(p, 0), p,
                     abs(normal).max(), 1e-4 * depth)
        middle, turn = np.add(place, before[0]) / 2, angle - before[1]
        moved = np.array([place[0] - before[0][0] - turn * (y - middle[1]),
                          place[1] - before[0][1] + turn * (x - middle[0])])
        limit = friction * p[0]
        q = minimise(sheared, moved + sheared(q), lambda q: q * (limit / np.maximum(np.hypot(*q), limit + 1e-30)), q,
                     (abs(xx) + abs(xy)).max(), 1e-3 * abs(moved).max() + 1e-12)
        before = place, angle, depth
        yield p[0], *q
