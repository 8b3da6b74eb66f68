"""generate.py FOLDER: writes the twelve histories of the open benchmark (docs/histories.md), the same bytes each time.

A history is a list of frames (p, qx, qy) on cells, 4 or 8 to the edge of a pillar (half_space.py), and its friction."""

import sys
from pathlib import Path

import h5py
import numpy as np

from half_space import along, boundary_elements, cells, dragged, hertz, line, punch, rolling, sliding, turned

SKIN = {"sensel_pitch_mm": 0.632455532, "counts_per_newton": 320.0, "threshold_counts": 2.0, "full_scale_counts": 255.0}
K, THRESHOLD, PEAK, NOISE = 320, 2, 150, 0.5  # counts per newton; counts
RATE_HZ = 30
DRAG = (0, 0.2, 0.4, 0.6, 0.75, 0.9, 0.97)  # shares of the friction, before a body slides


def drag_and_slide(grid, size, friction, degrees, radii=(1, 1), at=(0, 0), shares=DRAG, slides=((0, 1), (0, 1), (0, 1))):
    """An ellipsoid is dragged until it slides, a third of a pillar a frame; slides: its turn, degrees, and its size."""
    x, y = cells(*grid, 8)
    angle = np.radians(degrees)
    frames = [dragged(lambda part: hertz(x - at[0], y - at[1], size * part, radii), 3, friction, angle, share)
              for share in shares]
    for turn, scale in slides:
        step = np.cos(angle + np.radians(turn)) / 3, np.sin(angle + np.radians(turn)) / 3
        at = np.add(at, step)
        frames.append(sliding(x, y, hertz(x - at[0], y - at[1], size * scale, radii), friction, step))
    return frames


def two_balls():
    return [np.add(*both) for both in zip(drag_and_slide((26, 30), 5, 1.2, 30, at=(-7, 4)),
                                          drag_and_slide((26, 30), 4, 1.2, 215, at=(6, -5)))]


def drag_back(friction):
    x, y = cells(24, 24, 8)
    shares = [(share, None) for share in (0, 0.4, 0.7, 0.9)] + [(share, 0.9) for share in (0.6, 0.2, -0.2, -0.5, -0.7, -0.85)]
    return [dragged(lambda part: hertz(x - 0.2, y + 0.3, 9 * part), 3, friction, np.radians(80), *share) for share in shares]


def pressed_askew():
    """A force that grows in one direction: the ball sticks, at one ratio of shear to pressure."""
    x, y = cells(14, 14, 8)
    return [along(p, 1.9 * p, np.radians(4)) for p in
            (hertz(x - 0.3, y - 0.1, 2.46 * scale) for scale in (0.5, 0.6, 0.7, 0.8, 0.9, 1, 1, 0.95))]


def slide_and_spin(friction):
    x, y = cells(24, 26, 8)
    return [sliding(x, y, hertz(x - a, y - 0.2, 8), friction, (1, 0.2), 0.08 * t, (a, 0.2))
            for t, a in enumerate(np.linspace(-1.4, 1.3, 10))]


def twisted(friction):
    angles = (0, 0, 0.03, 0.08, 0.13, 0.19, 0.29, 0.24, 0.16, 0.08)
    return boundary_elements(*cells(20, 20, 4), lambda x, y: (x**2 + y**2) / 200, friction,
                             [((0.2, -0.1), angle, 0.45 if t else 0.3) for t, angle in enumerate(angles)])


def roller(friction, share, degrees):
    """A long cylinder rolls half a pillar a frame, driven (share above zero) or braked."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return [rolling(*cells(24, 24, 8), 4, 12, friction, share, np.radians(degrees), (c * way, s * way))
            for way in np.arange(10) / 2 - 2.2]


def punch_pushed():
    """A flat punch sticks all over until it slides all over."""
    x, y = cells(20, 20, 8)
    return [along(p, ratio * p, np.radians(-85)) for ratio, p in
            ((ratio, punch(x, y - 0.4 + 0.3 * max(0, t - 7), 6))
             for t, ratio in enumerate((0, 0.5, 1, 1.5, 2, 2.3, 2.5, 2.6, 2.6, 2.6)))]


ROUGH_X, ROUGH_Y = cells(24, 28, 4)
ROUGH_FRICTION = 3 * (1 + 0.1 * np.cos(0.5 * ROUGH_X + 0.3 * ROUGH_Y))


def rough_ball(friction):
    rng = np.random.default_rng(11)
    waves = np.transpose([rng.uniform(0, np.pi, 12), rng.uniform(0.5, 1.8, 12), rng.uniform(0, 2 * np.pi, 12)])

    def shape(x, y):
        hills = sum(np.cos(k * turned(x, y, a)[0] + phase) / k for a, k, phase in waves) / 12
        return (x**2 + y**2) / 200 + 0.3 * hills

    return boundary_elements(ROUGH_X, ROUGH_Y, shape, friction, [((way, 0.15 * way), 0, 0.4) for way in np.arange(8) * 0.3])


def edge(friction):
    """The edge of a plate, 0.8 of a pillar wide, dragged across itself at an angle to the pillars."""
    ahead, side = turned(*cells(18, 18, 8), np.radians(12), (0.1, 0.2))
    return [dragged(lambda part: line(ahead, side, 0.4 * part, 10), 2, friction, np.radians(12), share)
            for share in (*DRAG, 1, 1)]


HISTORIES = {  # name: frames, friction
    "two balls": (two_balls, 1.2),
    "ball dragged back": (lambda: drag_back(2.2), 2.2),
    "ball of 19 pillars": (pressed_askew, 3.0),
    "fingertip": (lambda: drag_and_slide((26, 30), 9, 1.6, 15, (1.15, 0.8), slides=(
        (0, 1), (0, 1), (20, 1), (40, 1), (60, 1), (80, 1))), 1.6),
    "ball slides and spins": (lambda: slide_and_spin(1.8), 1.8),
    "ball twisted": (lambda: twisted(1.6), 1.6),
    "roller driven": (lambda: roller(2.2, 0.8, 0), 2.2),
    "roller braked": (lambda: roller(0.8, -0.9, 60), 0.8),
    "flat punch": (punch_pushed, 2.6),
    "rough ball": (lambda: rough_ball(ROUGH_FRICTION), ROUGH_FRICTION),
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


def history(frames, friction, per_pillar, seed):
    """Readings [T, R, C], uint8; forces [T, 3, P, Q], N, scaled to the peak; share of the load that slips [T]."""
    p, qx, qy = np.moveaxis(np.array(list(frames)), 1, 0)
    slips = np.hypot(qx, qy) >= 0.999 * friction * p
    slip_share = (p * slips).sum((1, 2)) / p.sum((1, 2))
    rows, cols = np.array(p.shape[1:]) // per_pillar
    forces = np.stack([qx, qy, p], 1).reshape(len(p), 3, rows, per_pillar, cols, per_pillar).sum((3, 5))
    forces *= PEAK / model(forces).max()
    noisy = model(forces) + np.random.default_rng(seed).normal(0, NOISE, (len(p), 2 * rows, 2 * cols))
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8), forces, slip_share


def make(name):
    """Readings, forces, share that slips, and mean friction of a history."""
    frames, friction = HISTORIES[name]
    return *history(frames(), friction, 4 if name in ("ball twisted", "rough ball") else 8,
                    list(HISTORIES).index(name)), np.mean(friction)


def write(path, readings, forces, slip_share, friction):
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file.create_group("skin").attrs.update(SKIN)
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
