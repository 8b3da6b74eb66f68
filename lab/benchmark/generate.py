"""generate.py FOLDER [SEEDS]: writes the histories of the open benchmark (docs/histories.md), three of each by default,
the same bytes each time.

A history is a list of frames (p, qx, qy), pressure and shear on the skin in any unit: arrays of cells, row 0 at +y;
lengths are in pillars. Closed forms: K. L. Johnson, Contact Mechanics (1985), chapters 4, 7 and 8."""

import sys
from pathlib import Path

import h5py
import numpy as np

SKIN = {"sensel_pitch_mm": 0.632455532, "counts_per_newton": 320.0, "threshold_counts": 2.0, "full_scale_counts": 255.0}
K, THRESHOLD, PEAK, NOISE = 320, 2, 150, 0.5  # counts per newton; counts
PER_PILLAR = 8
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


def swung(pressure, order, friction, angle, path):
    """Cattaneo's and Mindlin's partial slip at a constant load, by Masing's rule after each turn of the shear.
    pressure(s): of the contact scaled by s, whose load grows with s**order (3; 2 of a line); path: shares of friction."""
    p, turns, before, way, frames = pressure(1), [], 0, 0, []
    for share in path:
        if (share - before) * way < 0:
            turns.append(before)
        way, before = np.sign(share - before) or way, share
        while len(turns) > 1 and abs(share - turns[-1]) >= abs(turns[-2] - turns[-1]):
            del turns[-2:]
        if len(turns) == 1 and abs(share) >= abs(turns[0]):
            turns.clear()
        ways = np.diff([0, *turns, share]) / np.array([1, *len(turns) * [2]])
        q = sum(np.sign(each) * (p - pressure((1 - abs(each))**(1 / order))) * (2 if index else 1)
                for index, each in enumerate(ways))
        frames.append(along(p, friction * q, angle))
    return frames


def sliding(x, y, p, friction, velocity, spin=0, at=(0, 0)):
    """Shear under a body that slides with a velocity and spins about a point."""
    vx, vy = velocity[0] - spin * (y - at[1]), velocity[1] + spin * (x - at[0])
    scale = friction * p / np.maximum(np.hypot(vx, vy), 1e-9)
    return p, scale * vx, scale * vy


def drag_and_slide(x, y, size, friction, degrees, radii=(1, 1), at=(0, 0), shares=DRAG, slides=3 * ((0, 1),), step=1 / 3):
    """An ellipsoid is dragged until it slides by `step` a frame; slides: its turn, degrees, and its size."""
    angle = np.radians(degrees)
    frames = swung(lambda part: hertz(x - at[0], y - at[1], size * part, radii), 3, friction, angle, shares)
    for turn, scale in slides:
        way = step * np.array([np.cos(angle + np.radians(turn)), np.sin(angle + np.radians(turn))])
        at = at + way
        frames.append(sliding(x, y, hertz(x - at[0], y - at[1], size * scale, radii), friction, way))
    return frames


def in_time(x, y, size, friction, degrees, rate_hz, corners, radii=(1, 1)):
    """A ball rests, or its shear grows or swings, as corners ((s, share), ...) say, until it slides for 0.3 s."""
    times, shares = np.transpose(corners)
    path = np.interp(np.arange(0, times[-1], 1 / rate_hz), times, shares)
    return drag_and_slide(x, y, size, friction, degrees, radii, shares=path, slides=round(0.3 * rate_hz) * [(0, 1)],
                          step=1 / rate_hz)


def drag_back(x, y, friction):
    return swung(lambda part: hertz(x - 0.2, y + 0.3, 9 * part), 3, friction, np.radians(80),
                 (0, 0.4, 0.7, 0.9, 0.6, 0.2, -0.2, -0.5, -0.7, -0.85))


def pressed_obliquely(x, y):
    """A force that grows in one direction: the ball sticks, at one ratio of shear to pressure."""
    return [along(p, 1.9 * p, np.radians(4)) for p in
            (hertz(x - 0.3, y - 0.1, 2.46 * scale) for scale in (0.5, 0.6, 0.7, 0.8, 0.9, 1, 1, 0.95))]


def slide_and_spin(x, y, friction):
    return [sliding(x, y, hertz(x - a, y - 0.2, 8), friction, (1, 0.2), 0.08 * t, (a, 0.2))
            for t, a in enumerate(np.linspace(-1.4, 1.3, 10))]


def twisted(x, y, friction):
    """A ball is pressed, and twisted to and fro, each time so fast that it slips everywhere within a frame."""
    p = hertz(x - 0.2, y + 0.1, 6.5)
    return [(p, 0 * p, 0 * p)] * 2 + [sliding(x, y, p, friction, (0, 0), spin, (0.2 + t / 2, -0.1 - t / 4))
                                      for t, spin in enumerate((1, 1, 1, 1, -1, -1, -1))]


def roller(x, y, friction, share, degrees):
    """Carter's cylinder sticks at its leading edge; driven, it pushes the skin back by a share of the friction below 0."""
    ahead, side = turned(x, y, np.radians(degrees))
    stick, frames = 4 * np.sqrt(1 - abs(share)), []
    for way in np.arange(10) / 2 - 2.2:
        p = line(ahead - way, side, 4, 12)
        q = p - line(ahead - way - 4 + stick, side, stick, 12)
        frames.append(along(p, np.sign(share) * friction * q, np.radians(degrees)))
    return frames


def punch_pushed(x, y, friction, radius=6):
    """A flat punch sticks all over until it slides all over; the singular pressure of its rim is cut off."""
    r2 = [(x**2 + (y - 0.4 + 0.3 * max(0, t - 7))**2) / radius**2 for t in range(10)]
    pressures = [np.where(each < 1, 1 / np.sqrt(np.maximum(1 - each, 0.02)), 0) for each in r2]
    return [along(p, share * friction * p, np.radians(-85)) for p, share in
            zip(pressures, (0, 0.2, 0.4, 0.6, 0.75, 0.9, 0.96, 1, 1, 1))]


def rough_ball(x, y, friction):
    """A ball on its hills: each has Mindlin's share of shear for the way of the ball, and slides from size**2 on."""
    rng = np.random.default_rng(11)
    places = 2.6 * np.mgrid[-2:3, -2:3].reshape(2, 25).T + rng.uniform(-0.2, 0.2, (25, 2))
    hills = [(rng.uniform(0.6, 1.1), *place) for place in places if np.hypot(*place) < 7]
    ways = np.array((0, 0.15, 0.3, 0.45, 0.6, 0.8, 1, 1.3))
    return sum(np.array(swung(lambda part, at=at, size=size: hertz(x - at[0], y - at[1], size * part), 3, friction, 0.15,
                              1 - np.maximum(0, 1 - ways / size**2)**1.5)) for size, *at in hills)


def edge(x, y, friction):
    """The edge of a plate, 0.8 of a pillar wide, dragged across itself at an angle to the pillars."""
    ahead, side = turned(x, y, np.radians(12), (0.1, 0.2))
    return swung(lambda part: line(ahead, side, 0.4 * part, 10), 2, friction, np.radians(12), (*DRAG, 1, 1))


STEADY, RESTS = ((0, 0), (0.4, 0), (1.6, 1)), ((0, 0), (0.4, 0), (0.8, 0.6), (1.2, 0.6), (1.8, 1))
SWINGS = ((0, 0), (0.3, 0), (0.5, 0.7), (0.7, 0), (0.9, 0.7), (1.1, 0), (1.3, 0.7), (1.5, 0), (2.2, 1))
LOADS = [(0, scale) for scale in (1, 1.1, 1.2, 1, 0.8, 0.9, 1.1, 1.2)]
HISTORIES = {  # name: class, pillars, friction, frames a second, frames of x, y and friction
    "two balls": ("large", (26, 30), 1.2, 30, lambda x, y, mu: np.add(
        drag_and_slide(x, y, 5, mu, 30, at=(-7, 4)), drag_and_slide(x, y, 4, mu, 215, at=(6, -5)))),
    "ball dragged back": ("large", (26, 26), 2.2, 30, drag_back),
    "fingertip": ("large", (26, 30), 1.6, 30, lambda x, y, mu: drag_and_slide(
        x, y, 9, mu, 15, (1.15, 0.8), slides=[(turn, 1) for turn in (0, 0, 20, 40, 60, 80)])),
    "ball slides and spins": ("large", (26, 28), 1.8, 30, slide_and_spin),
    "ball twisted": ("large", (20, 20), 1.6, 30, twisted),
    "roller driven": ("large", (24, 24), 2.2, 30, lambda x, y, mu: roller(x, y, mu, -0.8, 0)),
    "roller braked": ("large", (24, 24), 0.8, 30, lambda x, y, mu: roller(x, y, mu, 0.9, 60)),
    "flat punch": ("large", (20, 20), 2.6, 30, punch_pushed),
    "rough ball": ("large", (24, 28), 3.0, 30, rough_ball),
    "ball of 19 pillars": ("small", (14, 14), 3.0, 30, lambda x, y, mu: pressed_obliquely(x, y)),
    "edge": ("small", (18, 18), 2.0, 30, edge),
    "ball of 30 pillars": ("small", (14, 16), 1.6, 30, lambda x, y, mu: drag_and_slide(x, y, 2.8, mu, 10)),
    "punch of 30 pillars": ("small", (14, 14), 1.2, 30, lambda x, y, mu: punch_pushed(x, y, mu, 3)),
    "swinging load": ("friction 4.5", (30, 32), 4.5, 30, lambda x, y, mu: drag_and_slide(
        x, y, 10, mu, 8, at=(-1.3, 0.2), shares=(0, 0.3, 0.6, 0.9), slides=LOADS)),
    "finger at 4.5": ("friction 4.5", (26, 30), 4.5, 30, lambda x, y, mu: drag_and_slide(
        x, y, 8, mu, 25, (1.2, 0.8), slides=3 * [(0, 1)] + [(40, 1), (80, 1)])),
    "punch at 4.5": ("friction 4.5", (20, 20), 4.5, 30, punch_pushed),
    "steady at 30": ("in time", (18, 20), 0.9, 30, lambda x, y, mu: in_time(x, y, 6, mu, 20, 30, STEADY)),
    "swings at 30": ("in time", (18, 20), 1.4, 30, lambda x, y, mu: in_time(x, y, 5, mu, -40, 30, SWINGS, (1.2, 0.9))),
    "steady at 100": ("in time", (18, 20), 1.6, 100, lambda x, y, mu: in_time(x, y, 6, mu, 70, 100, STEADY)),
    "rests at 100": ("in time", (18, 20), 1.1, 100, lambda x, y, mu: in_time(x, y, 6, mu, -10, 100, RESTS, (0.9, 1.1)))}


def model(forces):
    """Readings [T, 2 P, 2 Q] of forces [T, 3, P, Q], counts, without noise (docs/derivations/pillar_model.md)."""
    x, y, n = K * np.moveaxis(forces, 1, 0)
    v = np.empty((len(n), 2 * n.shape[1], 2 * n.shape[2]))
    for row, col, sx, sy in ((0, 1, 1, 1), (0, 0, -1, 1), (1, 0, -1, -1), (1, 1, 1, -1)):
        v[:, row::2, col::2] = np.maximum(n + (sx * x + sy * y) / np.sqrt(2), 0)
    return v


def history(frames, friction, seed):
    """Readings [T, R, C]; forces [T, 3, P, Q], N, scaled to the peak; share of the load that slips [T]; friction."""
    p, qx, qy = np.moveaxis(np.array(list(frames)), 1, 0)
    slips = np.hypot(qx, qy) >= 0.999 * friction * p
    rows, cols = np.array(p.shape[1:]) // PER_PILLAR
    forces = np.stack([qx, qy, p], 1).reshape(len(p), 3, rows, PER_PILLAR, cols, PER_PILLAR).sum((3, 5))
    forces *= PEAK / model(forces).max()
    noisy = model(forces) + np.random.default_rng(seed).normal(0, NOISE, (len(p), 2 * rows, 2 * cols))
    return (np.clip(np.rint(noisy), 0, 255).astype(np.uint8), forces, (p * slips).sum((1, 2)) / p.sum((1, 2)), friction)


def make(name, seed=0):
    """A history, shifted, turned and scaled at random, but for the seed 0."""
    _, grid, friction, _, frames = HISTORIES[name]
    rng = np.random.default_rng((list(HISTORIES).index(name), seed))
    shift, angle, scale = (rng.uniform(-0.5, 0.5, 2), rng.uniform(-0.2, 0.2), rng.uniform(0.9, 1.1)) if seed else ((0, 0), 0, 1)
    x, y = turned(*cells(*grid), angle, shift)
    p, qx, qy = np.moveaxis(np.array(frames(x / scale, y / scale, friction)), 1, 0)
    return history(zip(p, *turned(qx, qy, -angle)), friction, rng)


def write(path, kind, rate_hz, readings, forces, slip_share, friction):
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file.create_group("skin").attrs.update(SKIN)
        file["frames/raw"], file["frames/time"] = readings, np.arange(len(readings)) / rate_hz
        for name, plane in zip(("shear_x", "shear_y", "normal"), np.moveaxis(forces, 1, 0)):
            file[f"truth/{name}"] = plane.astype(np.float32)
        file["truth/slip_share"] = slip_share
        file["truth"].attrs.update({"friction": friction, "class": kind})


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
    for each, (kind, _, _, rate, _) in HISTORIES.items():
        for number in range(int(sys.argv[2]) if len(sys.argv) == 3 else 3):
            write(Path(sys.argv[1], f"{each.replace(' ', '_')}.{number}.h5"), kind, rate, *make(each, number))
