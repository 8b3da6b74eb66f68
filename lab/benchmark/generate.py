"""generate.py FOLDER: writes the twelve histories of the open benchmark (docs/histories.md), the same bytes each time.

A history is a list of frames (p, qx, qy) on cells, with its friction; half_space.py has the mechanics."""

import sys
from pathlib import Path

import h5py
import numpy as np

from half_space import Indenter, along, cells, dragged, hertz, punch, rolling, sliding, turned

PER_PILLAR = 8          # cells on the edge of a pillar; boundary elements take half
PITCH_MM = 0.632455532  # of the sensels
K = 320.0               # counts per newton
PEAK, NOISE, THRESHOLD, FULL_SCALE = 150, 0.5, 2, 255  # counts
RATE_HZ = 30
DRAG = (0, 0.2, 0.4, 0.6, 0.75, 0.9, 0.97)  # shares of the friction, before a body slides


def direction(angle, length=1.0):
    return length * np.cos(angle), length * np.sin(angle)


def drag_and_slide(size, friction, degrees, radii=(1, 1), at=(0, 0), slides=3, grid=(24, 24)):
    """An ellipsoid is dragged under a constant load until it slides, a third of a pillar a frame."""
    x, y = cells(*grid, PER_PILLAR)
    angle = np.radians(degrees)

    def pressure(part, moved=0.0):
        step = direction(angle, moved)
        return hertz(x - at[0] - step[0], y - at[1] - step[1], part * size, radii)

    frames = [dragged(pressure, 3, friction, angle, share) for share in DRAG]
    return frames + [along(p, friction * p, angle)
                     for p in (pressure(1, step / 3) for step in range(slides))]


def two_balls():
    frames = zip(drag_and_slide(5, 1.2, 30, at=(-7, 4), grid=(26, 30)),
                 drag_and_slide(4, 1.2, 215, at=(6, -5), grid=(26, 30)))
    return [np.add(one, other) for one, other in frames]


def drag_back():
    x, y = cells(24, 24, PER_PILLAR)

    def pressure(part):
        return hertz(x - 0.2, y + 0.3, 9 * part)

    return ([dragged(pressure, 3, 2.2, np.radians(80), share) for share in (0, 0.4, 0.7, 0.9)] +
            [dragged(pressure, 3, 2.2, np.radians(80), share, 0.9) for share in (0.6, 0.2, -0.2, -0.5, -0.7, -0.85)])


def pressed_askew():
    """A force that grows in one direction: sticks everywhere, at one ratio of shear to pressure (19 pillars)."""
    x, y = cells(14, 14, PER_PILLAR)
    sizes = 2.46 * np.array([0.5, 0.6, 0.7, 0.8, 0.9, 1, 1, 0.95])
    return [along(p, 1.9 * p, np.radians(4)) for p in (hertz(x - 0.3, y - 0.1, size) for size in sizes)]


def round_a_corner():
    """A fingertip is dragged until it slides, then slides on round a corner."""
    frames = drag_and_slide(9, 1.6, 15, (1.15, 0.8), slides=2, grid=(26, 30))
    x, y = cells(26, 30, PER_PILLAR)
    place = np.array(direction(np.radians(15), 1 / 3))
    for degrees in (35, 55, 75, 95):
        step = direction(np.radians(degrees), 0.5)
        place = place + step
        frames.append(sliding(x, y, hertz(x - place[0], y - place[1], 9, (1.15, 0.8)), 1.6, step))
    return frames


def slide_and_spin():
    x, y = cells(24, 26, PER_PILLAR)
    frames = []
    for t in range(10):
        at = (0.3 * t - 1.4, 0.2)
        p = hertz(x - at[0], y - at[1], 8)
        frames.append(sliding(x, y, p, 1.8, (1, 0.2), 0.08 * t, at))
    return frames


def twisted():
    x, y = cells(20, 20, PER_PILLAR // 2)
    ball = Indenter(x, y, lambda x, y: (x**2 + y**2) / 200, 1.6)
    return [ball.move((0.2, -0.1), angle, depth) for angle, depth in
            ((0, 0.3), (0, 0.45), (0.03, 0.45), (0.08, 0.45), (0.13, 0.45), (0.19, 0.45), (0.29, 0.45), (0.24, 0.45),
             (0.16, 0.45), (0.08, 0.45))]


def roller(friction, share, degrees):
    """A long cylinder rolls half a pillar a frame, driven (share above zero) or braked."""
    x, y = cells(24, 24, PER_PILLAR)
    angle = np.radians(degrees)
    return [rolling(x, y, 4, 12, friction, share, angle, direction(angle, t / 2 - 2.2)) for t in range(10)]


def punch_pushed():
    """A flat punch sticks all over until it slides all over."""
    x, y = cells(20, 20, PER_PILLAR)
    frames = []
    for t, ratio in enumerate((0, 0.5, 1, 1.5, 2, 2.3, 2.5, 2.6, 2.6, 2.6)):
        p = punch(x - 0.3 * max(0, t - 7), y + 0.4, 6)
        frames.append(along(p, ratio * p, np.radians(-85)))
    return frames


def rough_ball():
    """Hills of a third of the depth, and friction of 3 within a tenth."""
    x, y = cells(24, 28, PER_PILLAR // 2)
    rng = np.random.default_rng(11)
    waves = [(direction(a, k), phase) for a, k, phase in
             zip(rng.uniform(0, np.pi, 12), rng.uniform(0.5, 1.8, 12), rng.uniform(0, 2 * np.pi, 12))]

    def surface(x, y):
        return sum(np.cos(k[0] * x + k[1] * y + phase) / np.hypot(*k) for k, phase in waves) / 12

    friction = 3 * (1 + 0.1 * np.cos(0.5 * x + 0.3 * y))
    ball = Indenter(x, y, lambda x, y: (x**2 + y**2) / 200 + 0.3 * surface(x, y), friction)
    return [ball.move(direction(0.15, step), 0, 0.4)
            for step in (0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1)], friction


def narrow_edge():
    """The edge of a plate, 0.8 of a pillar wide, dragged across itself at an angle to the pillars."""
    x, y = cells(18, 18, PER_PILLAR)
    ahead, side = turned(x, y, np.radians(12), (0.1, 0.2))

    def pressure(part):
        return np.where(abs(side) < 5, np.sqrt(np.maximum((0.4 * part)**2 - ahead**2, 0)), 0)

    return [dragged(pressure, 2, 2.0, np.radians(12), share) for share in (*DRAG, 1, 1)]


def swinging_load():
    """A large ball is pressed and dragged until it slides, then slides under a load that rises and falls."""
    x, y = cells(30, 32, PER_PILLAR)
    frames = [dragged(lambda part: hertz(x + 1.3, y - 0.2, 10 * part), 3, 4.5, np.radians(8), share)
              for share in (0, 0.3, 0.6, 0.9)]
    return frames + [along(p, 4.5 * p, np.radians(8)) for p in
                     (hertz(x + 1.3 - t / 3, y - 0.2, size) for t, size in enumerate((10, 11, 12, 10, 8, 9, 11, 12)))]


HISTORIES = {  # name: frames, and the friction where the function does not return it
    "two balls": (two_balls, 1.2), "ball dragged back": (drag_back, 2.2),
    "ball of 19 pillars": (pressed_askew, 3.0), "fingertip": (round_a_corner, 1.6),
    "ball slides and spins": (slide_and_spin, 1.8), "ball twisted": (twisted, 1.6),
    "roller driven": (lambda: roller(2.2, 0.8, 0), 2.2), "roller braked": (lambda: roller(0.8, -0.9, 60), 0.8),
    "flat punch": (punch_pushed, 2.6), "rough ball": (rough_ball, None), "edge": (narrow_edge, 2.0),
    "swinging load": (swinging_load, 4.5)}


def pillar_forces(tractions, size):
    """Forces [..., pillar rows, columns] of tractions on cells, size x size to a pillar."""
    *rest, rows, cols = np.shape(tractions)
    return np.reshape(tractions, (*rest, rows // size, size, cols // size, size)).sum(axis=(-3, -1))


def model(forces):
    """Readings [T, 2 P, 2 Q] of an ideal skin, counts per K, of forces [T, 3, P, Q] (docs/derivations/pillar_model.md)."""
    x, y, n = np.moveaxis(forces, 1, 0)
    v = np.empty((len(n), 2 * n.shape[1], 2 * n.shape[2]))
    for row, col, sx, sy in ((0, 1, 1, 1), (0, 0, -1, 1), (1, 0, -1, -1), (1, 1, 1, -1)):
        v[:, row::2, col::2] = np.maximum(n + (sx * x + sy * y) / np.sqrt(2), 0)
    return v


def history(frames, friction, size, seed):
    """Readings [T, R, C], uint8; forces [T, 3, P, Q] (shear_x, shear_y, normal), N; share of the load that slips [T]."""
    p, qx, qy = np.moveaxis(np.array(frames), 1, 0)
    slips = np.hypot(qx, qy) >= 0.999 * friction * p
    load = p.sum(axis=(1, 2))
    slip_share = (p * slips).sum(axis=(1, 2)) / np.where(load > 0, load, 1)
    forces = np.moveaxis(pillar_forces([qx, qy, p], size), 0, 1)
    forces *= PEAK / K / model(forces).max()
    noisy = K * model(forces) + np.random.default_rng(seed).normal(0, NOISE, model(forces).shape)
    return np.clip(np.rint(noisy), 0, FULL_SCALE).astype(np.uint8), forces, slip_share


def make(name):
    """The named history, as history() returns it, and its mean friction."""
    function, friction = HISTORIES[name]
    frames = function()
    if friction is None:
        frames, friction = frames
    size = PER_PILLAR // 2 if function in (twisted, rough_ball) else PER_PILLAR
    return *history(frames, friction, size, list(HISTORIES).index(name)), np.mean(friction)


def write(path, readings, forces, slip_share, friction):
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file.create_group("skin").attrs.update({
            "sensel_pitch_mm": PITCH_MM, "counts_per_newton": K, "threshold_counts": THRESHOLD,
            "full_scale_counts": FULL_SCALE})
        file["frames/raw"], file["frames/time"] = readings, np.arange(len(readings)) / RATE_HZ
        for name, plane in zip(("shear_x", "shear_y", "normal"), np.moveaxis(forces, 1, 0)):
            file[f"truth/{name}"] = plane.astype(np.float32)
        file["truth/slip_share"] = slip_share
        file["truth"].attrs["friction"] = friction


def main(folder):
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name in HISTORIES:
        write(Path(folder, name.replace(" ", "_") + ".h5"), *make(name))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 2 else __doc__)
