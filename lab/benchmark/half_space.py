"""Closed forms of contacts on an elastic half-space: pressure p and shear qx, qy on the skin, on square cells.

Arrays are [rows, columns] of cells, row 0 at +y; lengths in pillars, tractions in any unit. K. L. Johnson, Contact
Mechanics (1985), chapters 4, 7 and 8."""

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
