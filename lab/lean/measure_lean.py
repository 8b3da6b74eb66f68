"""measure_lean.py FRICTION FOLDER PROGRAM...: what the correction of off-centre pressure leaves.

Errors in regions 1 and 2, counts, under bodies of which fit_lean.py knows none, ignored and
corrected by each PROGRAM, pillarfield. The first one simulates in FOLDER."""

import random
import subprocess
import sys
from pathlib import Path

import h5py
import numpy

from fit_lean import dome, face, to_line

K = 320  # counts per newton
NOISE_COUNTS, PEAK_COUNTS = 0.5, 150
AXES = ("shear_x", "shear_y", "normal")
PITCH_MM = 2 * 0.632455532
SPAN, PLACES = 20, 240  # of height maps, pillars and points
EDGE = (numpy.arange(PLACES) + 0.5) / PLACES * SPAN - SPAN / 2
X, Y = numpy.meshgrid(EDGE, -EDGE)
R = numpy.hypot(X, Y)


def strokes(*points):
    return numpy.min([to_line(X, Y, *line) for line in zip(points, points[1:])], axis=0)


def sphere(radius, more=""):
    return f'shape = "sphere"\nradius_mm = {radius}\n{more}'


# Keys of [[indenter]], or heights over the lowest point in pillars, and a load, N.
BODIES = {
    "fingertip": ('shape = "ellipsoid"\nradii_mm = [8, 12, 10]', 12),
    "small ball": (sphere(7), 5),
    "large ball": (sphere(40), 30),
    "punch": ('shape = "punch"\nradius_mm = 6\nedge_radius_mm = 0.6', 15),
    "stamp": (face(numpy.maximum(abs(X) - 3.3, abs(Y) - 4.6), 0.4), 20),
    "cylinder": ('shape = "cylinder"\nradius_mm = 8\nlength_mm = 14\nedge_radius_mm = 1', 15),
    "rough ball": (sphere(20, "roughness_um = 35"), 22),
    "rough small ball": (sphere(11, "roughness_um = 20"), 9),
    "coin on its rim": (face(abs(Y) - 0.75, 0.15) + X**2 / 20, 4),
    "edge on its side": (face(abs(Y) - 0.4, 0.2) + face(abs(X) - 5.5, 0.3), 6),
    "wire": (dome(Y, 0.6) + face(abs(X) - 4.5, 0.5), 5),
    "cap ring": (face(abs(R - 4.8) - 0.45, 0.2), 12),
    "O-ring": ((R - 3.6) ** 2 / 1.6, 8),
    "letter A": (face(numpy.minimum(strokes((-3, -4), (0, 4), (3, -4)),
                                    strokes((-1.5, -1), (1.5, -1))) - 0.5, 0.25), 9),
    "letter S": (face(strokes((2.2, 3.2), (-2.2, 3.2), (-2.2, 0), (2.2, 0), (2.2, -3.2),
                              (-2.2, -3.2)) - 0.6, 0.3), 12),
    "pin": (dome(R, 0.9), 1),
    "three pins": (numpy.minimum(face(numpy.hypot(X - 2.3, Y) - 0.7, 0.3), face(
        numpy.hypot(abs(X + 2.1) + 0 * Y, abs(Y) - 2.4) - 0.9, 0.3)), 5),
}


def scene(folder, number, name, friction):
    """A body that presses, is dragged and turned, half unloaded, and dragged further."""
    shape, load_n = BODIES[name]
    if not isinstance(shape, str):
        numpy.save(folder / f"{number}.npy", -numpy.minimum(shape - shape.min(), 1.5))
        shape = (f'shape = "height_map"\nheight_map = "{number}.npy"\n'
                 f"height_map_size_mm = [{SPAN * PITCH_MM}, {SPAN * PITCH_MM}]\n"
                 f"height_map_depth_mm = {min(numpy.ptp(shape), 1.5) * PITCH_MM}")
    choose = random.Random(1000 + number).uniform
    x, y, angle = choose(-3, 1), choose(-2, 2), choose(-90, 90)
    right, up, turn = choose(-1, 1), choose(-1, 1), choose(-40, 40)
    path = ((0, 0, 0, 0.2), (0.2, 0, 0, 1), (0.4, 0.03, 0, 1), (0.6, 0.3, 0.2, 1),
            (0.8, 0.3, 0.2, 0.5), (1.15, 3, 1, 0.8))
    keys = ",\n".join(
        f"{{ time_s = {time}, position_mm = [{x + part * right:.4f}, {y + part * up:.4f}], "
        f"angle_deg = {angle + turned * turn:.3f}, load_n = {part_n * load_n:g} }}"
        for time, part, turned, part_n in path)
    return (f"[skin]\npillars = [36, 36]\nthreshold_counts = {4 * NOISE_COUNTS}\n"
            f"modulus_kpa = 400\ncounts_per_newton = {K}\n[sensor]\npillar_arm_mm = 0.224\n[time]\n"
            f"rate_hz = 10\nframes = 12\nseed = {number}\n[[indenter]]\n{shape}\n"
            f"friction = {friction}\npath = [\n{keys}\n]\n")


def run(*words):
    subprocess.run([*map(str, words), "-q", "--overwrite"], check=True)


def recording(program, folder, number, name, friction):
    """The path of a recording with noise, scaled to its peak, and the true forces [axis, ...]."""
    text, path = (folder / f"{number}.{end}" for end in ("toml", "h5"))
    text.write_text(scene(folder, number, name, friction), encoding="utf-8")
    run(program, "simulate", text, "-o", path)
    noise = numpy.random.default_rng(number)
    with h5py.File(path, "r+") as file:
        raw = file["frames/raw"]
        scale = PEAK_COUNTS / numpy.percentile(raw[:], 99.97)
        raw[...] = raw[:] * scale + noise.normal(0, NOISE_COUNTS, raw.shape)
        return path, scale * numpy.stack([file[f"truth/{axis}"][:].astype(float)
                                          for axis in AXES])


def judge(program, path, truth):
    """Sum of squared errors, counts, of pillars with three or four usable sensels, their number,
    and how many truths lie in the stated 95 % in x and in y."""
    out = path.with_suffix(".forces.h5")
    run(program, "solve", path, "-o", out, "--estimator", "direct", "--noise", NOISE_COUNTS, "--outputs",
        "forces,uncertainty")
    with h5py.File(out) as file:
        status = file["force/status"][:]
        determined = sum((status >> bit) & 1 for bit in range(4)) >= 3
        force, low, high = (
            numpy.stack([file[f"{group}/{axis}{end}"][:][determined] for axis in AXES])
            for group, end in (("force", ""), ("uncertainty", "_low"), ("uncertainty", "_high")))
    truth = truth[:, determined]
    held = ((low <= truth) & (truth <= high)).sum(axis=1)
    return numpy.array([K**2 * ((force - truth) ** 2).sum(), determined.sum(), held[0], held[1]])


def line(name, ignored, found):
    cells = [f"{(ignored[0] / ignored[1]) ** 0.5:.1f}"]
    for squares, count, x, y in found:
        cells += [f"{(squares / count) ** 0.5:.1f}", f"{(squares / ignored[0]) ** 0.5:.2f}",
                  f"{50 * (x + y) / count:.0f}"]
    print(f"| {name} | {' | '.join(cells)} |", flush=True)


def main(friction, folder, *programs):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    print("| Indenter | ignored |" + " corrected | over ignored | held, % |" * len(programs))
    print("|--|--:|" + "--:|--:|--:|" * len(programs))
    found = []
    for number, name in enumerate(BODIES):
        path, truth = recording(programs[0], folder, number, name, friction)
        corrected = [judge(program, path, truth) for program in programs]
        with h5py.File(path, "r+") as file:
            del file["calibration/effects"].attrs["arm_mm"]
        found.append([judge(programs[0], path, truth), *corrected])
        line(name, found[-1][0], found[-1][1:])
    ignored, *corrected = numpy.sum(found, axis=0)
    line("all", ignored, corrected)


if __name__ == "__main__":
    main(*sys.argv[1:])
