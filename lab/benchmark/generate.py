"""generate.py FOLDER: writes the twelve histories of the open benchmark (docs/histories.md), the same bytes each time.

A history is a list of frames (p, qx, qy), pressure and shear on the skin in any unit: arrays of cells, row 0 at +y;
lengths are in pillars. Closed forms: K. L. Johnson, Contact Mechanics (1985), chapters 4, 7 and 8."""

import sys
from pathlib import Path

import h5py
import numpy as np

SKIN = {"sensel_pitch_mm": 0.632455532, "counts_per_newton": 320.0, "threshold_counts": 2.0, "full_scale_counts": 255.0}
K, THRESHOLD, PEAK, NOISE = 320, 2, 150, 0.5  # counts per newton; counts
RATE_HZ, PER_PILLAR = 30, 8
DRAG = (0, 0.2, 0.4, 0.6, 0.75, 0.9, 0.97)  # shares of the friction, before a body slides


def cells(rows, cols):
    """x and y of the centres of the cells of rows x cols pillars, from the middle of the skin."""
    x, y = ((np.arange(n * PER_PILLAR) + 0.5) / PER_PILLAR - n / 2 for n in (cols, rows))
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


def along(p, q, angle):
    return p, q * np.cos(angle), q * np.sin(angle)


def dragged(pressure, order, friction, angle, share, before=None):
    """Cattaneo's and Mindlin's partial slip: shear of `share` of the friction at a constant load, or back from the share
    `before`. pressure(s): of the contact scaled by s, whose load grows with s**order (3; 2 of a line)."""
    p = pressure(1)
    q = p - pressure((1 - (share if before is None else before))**(1 / order))
    if before is not None:
        q = q - 2 * (p - pressure((1 - (before - share) / 2)**(1 / order)))
    return along(p, friction * q, angle)


def sliding(x, y, p, friction, velocity, spin=0, at=(0, 0)):
    """Shear under a body that slides with a velocity and spins about a point."""
    vx, vy = velocity[0] - spin * (y - at[1]), velocity[1] + spin * (x - at[0])
    scale = friction * p / np.maximum(np.hypot(vx, vy), 1e-9)
    return p, scale * vx, scale * vy


def drag_and_slide(grid, size, friction, degrees, radii=(1, 1), at=(0, 0), shares=DRAG, slides=3 * ((0, 1),)):
    """An ellipsoid is dragged until it slides, a third of a pillar a frame; slides: its turn, degrees, and its size."""
    x, y = cells(*grid)
    angle = np.radians(degrees)
    frames = [dragged(lambda part: hertz(x - at[0], y - at[1], size * part, radii), 3, friction, angle, share)
              for share in shares]
    for turn, scale in slides:
        step = np.array([np.cos(angle + np.radians(turn)), np.sin(angle + np.radians(turn))]) / 3
        at = at + step
        frames.append(sliding(x, y, hertz(x - at[0], y - at[1], size * scale, radii), friction, step))
    return frames


def drag_back(friction):
    x, y = cells(24, 24)
    return [dragged(lambda part: hertz(x - 0.2, y + 0.3, 9 * part), 3, friction, np.radians(80), share,
                    0.9 if t > 3 else None)
            for t, share in enumerate((0, 0.4, 0.7, 0.9, 0.6, 0.2, -0.2, -0.5, -0.7, -0.85))]


def pressed_obliquely():
    """A force that grows in one direction: the ball sticks, at one ratio of shear to pressure."""
    x, y = cells(14, 14)
    return [along(p, 1.9 * p, np.radians(4)) for p in
            (hertz(x - 0.3, y - 0.1, 2.46 * scale) for scale in (0.5, 0.6, 0.7, 0.8, 0.9, 1, 1, 0.95))]


def slide_and_spin(friction):
    x, y = cells(24, 26)
    return [sliding(x, y, hertz(x - a, y - 0.2, 8), friction, (1, 0.2), 0.08 * t, (a, 0.2))
            for t, a in enumerate(np.linspace(-1.4, 1.3, 10))]


def twisted(friction):
    """A ball is pressed, and twisted to and fro, each time so fast that it slips everywhere within a frame."""
    x, y = cells(20, 20)
    p = hertz(x - 0.2, y + 0.1, 6.5)
    return [(p, 0 * p, 0 * p)] * 2 + [sliding(x, y, p, friction, (0, 0), spin, (0.2 + t / 2, -0.1 - t / 4))
                                      for t, spin in enumerate((1, 1, 1, 1, -1, -1, -1))]


def roller(friction, share, degrees):
    """Carter's cylinder sticks at its leading edge; driven, it pushes the skin back by a share of the friction below 0."""
    ahead, side = turned(*cells(24, 24), np.radians(degrees))
    stick, frames = 4 * np.sqrt(1 - abs(share)), []
    for way in np.arange(10) / 2 - 2.2:
        p = line(ahead - way, side, 4, 12)
        q = p - line(ahead - way - 4 + stick, side, stick, 12)
        frames.append(along(p, np.sign(share) * friction * q, np.radians(degrees)))
    return frames


def punch_pushed():
    """A flat punch sticks all over until it slides all over; the singular pressure of its rim is cut off."""
    x, y = cells(20, 20)
    r2 = [(x**2 + (y - 0.4 + 0.3 * max(0, t - 7))**2) / 36 for t in range(10)]
    pressures = [np.where(each < 1, 1 / np.sqrt(np.maximum(1 - each, 0.02)), 0) for each in r2]
    return [along(p, ratio * p, np.radians(-85)) for p, ratio in
            zip(pressures, (0, 0.5, 1, 1.5, 2, 2.3, 2.5, 2.6, 2.6, 2.6))]


def rough_ball():
    """A ball on its hills: each has Mindlin's share of shear for the way of the ball, and slides from size**2 on."""
    x, y = cells(24, 28)
    rng = np.random.default_rng(11)
    places = 2.6 * np.mgrid[-2:3, -2:3].reshape(2, 25).T + rng.uniform(-0.2, 0.2, (25, 2))
    hills = [(rng.uniform(0.6, 1.1), *place) for place in places if np.hypot(*place) < 7]

    return [np.sum([dragged(lambda part, at=at, size=size: hertz(x - at[0], y - at[1], size * part), 3, 3.0, 0.15,
                            1 - max(0, 1 - way / size**2)**1.5) for size, *at in hills], axis=0)
            for way in (0, 0.15, 0.3, 0.45, 0.6, 0.8, 1, 1.3)]


def edge(friction):
    """The edge of a plate, 0.8 of a pillar wide, dragged across itself at an angle to the pillars."""
    ahead, side = turned(*cells(18, 18), np.radians(12), (0.1, 0.2))
    return [dragged(lambda part: line(ahead, side, 0.4 * part, 10), 2, friction, np.radians(12), share)
            for share in (*DRAG, 1, 1)]


HISTORIES = {  # name: frames, friction
    "two balls": (lambda: np.add(drag_and_slide((26, 30), 5, 1.2, 30, at=(-7, 4)),
                                 drag_and_slide((26, 30), 4, 1.2, 215, at=(6, -5))), 1.2),
    "ball dragged back": (lambda: drag_back(2.2), 2.2),
    "ball of 19 pillars": (pressed_obliquely, 3.0),
    "fingertip": (lambda: drag_and_slide((26, 30), 9, 1.6, 15, (1.15, 0.8), slides=(
        (0, 1), (0, 1), (20, 1), (40, 1), (60, 1), (80, 1))), 1.6),
    "ball slides and spins": (lambda: slide_and_spin(1.8), 1.8),
    "ball twisted": (lambda: twisted(1.6), 1.6),
    "roller driven": (lambda: roller(2.2, -0.8, 0), 2.2),
    "roller braked": (lambda: roller(0.8, 0.9, 60), 0.8),
    "flat punch": (punch_pushed, 2.6),
    "rough ball": (rough_ball, 3.0),
    "edge": (lambda: edge(2.0), 2.0),
    "swinging load": (lambda: drag_and_slide((30, 32), 10, 4.5, 8, at=(-1.3, 0.2), shares=(0, 0.3, 0.6, 0.9), slides=[
        (0, scale) for scale in (1, 1.1, 1.2, 1, 0.8, 0.9, 1.1, 1.2)]), 4.5)}


def model(forces):
    """Readings [T, 2 P, 2 Q] of forces [T, 3, P, Q], counts, without noise (docs/derivations/pillar_model.md)."""
    x, y, n = K * np.moveaxis(forces, 1, 0)
    v = np.empty((len(n), 2 * n.shape[1], 2 * n.shape[2]))
    for row, col, sx, sy in ((0, 1, 1, 1), (0, 0, -1, 1), (1, 0, -1, -1), (1, 1, 1, -1)):
        v[:, row::2, col::2] = np.maximum(n + (sx * x + sy * y) / np.sqrt(2), 0)
    return v


def history(frames, friction, seed):
    """Readings [T, R, C]; forces [T, 3, P, Q], N, scaled to the peak; share of the load that slips [T]; friction."""
    p, qx, qy = np.moveaxis(np.array(frames), 1, 0)
    slips = np.hypot(qx, qy) >= 0.999 * friction * p
    rows, cols = np.array(p.shape[1:]) // PER_PILLAR
    forces = np.stack([qx, qy, p], 1).reshape(len(p), 3, rows, PER_PILLAR, cols, PER_PILLAR).sum((3, 5))
    forces *= PEAK / model(forces).max()
    noisy = model(forces) + np.random.default_rng(seed).normal(0, NOISE, (len(p), 2 * rows, 2 * cols))
    return (np.clip(np.rint(noisy), 0, 255).astype(np.uint8), forces, (p * slips).sum((1, 2)) / p.sum((1, 2)), friction)


def make(name):
    frames, friction = HISTORIES[name]
    return history(frames(), friction, list(HISTORIES).index(name))


def write(path, readings, forces, slip_share, friction):
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file.create_group("skin").attrs.update(SKIN)
        file["frames/raw"], file["frames/time"] = readings, np.arange(len(readings)) / RATE_HZ
        for name, plane in zip(("shear_x", "shear_y", "normal"), np.moveaxis(forces, 1, 0)):
            file[f"truth/{name}"] = plane.astype(np.float32)
        file["truth/slip_share"] = slip_share
        file["truth"].attrs["friction"] = friction


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
    for each in HISTORIES:
        write(Path(sys.argv[1], each.replace(" ", "_") + ".h5"), *make(each))
