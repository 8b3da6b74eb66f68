"""fit_lean.py PROGRAM FOLDER: prints the coefficients of kernels/pillar/lean.h.

Least squares over random indenters on random paths, which PROGRAM, pillarfield, simulates in FOLDER.
Equations: docs/derivations/sensor_effects.md, E7."""

import itertools
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy

BODIES = 96
K = 320  # counts per newton
NOISE_COUNTS = 0.5
LEAST_COUNTS = 8
PITCH_OVER_ARM = 2 * 0.632455532 / 0.224
LEANING = "pillar_arm_mm = 0.224"
# With little shear every loaded sensel reads, and the readings hold the whole moment.
UNCLIPPED = f"{LEANING}\nshear_coefficient = 0.1"


# --- Scenes ---

def shape(kind, choose):
    """Lines of [[indenter]] and a load, N."""
    if kind == "sphere":
        radius = 10 ** choose(0.75, 1.8)
        return f'shape = "sphere"\nradius_mm = {radius:.2f}', 0.8 * radius**0.9 + 1
    if kind == "rough":
        radius = 10 ** choose(1, 1.6)
        return (f'shape = "sphere"\nradius_mm = {radius:.2f}\nroughness_um = {choose(10, 50):.1f}',
                radius)
    if kind == "ellipsoid":
        return (f'shape = "ellipsoid"\nradii_mm = [{choose(5, 15):.2f}, {choose(5, 22):.2f}, '
                f"{choose(5, 15):.2f}]", choose(6, 16))
    if kind == "punch":
        radius = choose(3.5, 11)
        return (f'shape = "punch"\nradius_mm = {radius:.2f}\n'
                f"edge_radius_mm = {choose(0.2, 2.5):.2f}", 2.5 * radius)
    return (f'shape = "cylinder"\nradius_mm = {choose(4, 18):.2f}\n'
            f"length_mm = {choose(6, 18):.2f}\nedge_radius_mm = {choose(0.3, 2.5):.2f}",
            choose(10, 20))


def shapes():
    choose = random.Random(5).uniform
    kinds = ("sphere", "ellipsoid", "punch", "cylinder", "rough", "punch", "cylinder", "rough")
    return [shape(kinds[i % len(kinds)], choose) for i in range(BODIES)]


def scene(indenter, sensor, stiffness, seed):
    """An indenter that presses, is dragged and turned, half unloaded, and dragged further."""
    lines, load_n = indenter
    choose = random.Random(seed).uniform
    x, y, angle = choose(-4, 2), choose(-2, 2), choose(-90, 90)
    friction = choose(0.6, 2)
    right, up, turn = choose(-1, 1), choose(-1, 1), choose(-30, 30)
    path = ((0, 0, 0, 0.2), (0.2, 0, 0, 1), (0.4, 0.02, 0, 1), (0.6, 0.3, 0.1, 1),
            (0.8, 0.3, 0.1, 0.5), (1.15, 4, 1, 0.8))
    keys = ",\n".join(
        f"{{ time_s = {time}, position_mm = [{x + part * right:.4f}, {y + part * up:.4f}], "
        f"angle_deg = {angle + turned * turn:.3f}, load_n = {load * load_n * stiffness:g} }}"
        for time, part, turned, load in path)
    return (f"[skin]\npillars = [36, 36]\nthreshold_counts = {4 * NOISE_COUNTS}\n"
            f"modulus_kpa = {400 * stiffness}\ncounts_per_newton = {K}\n[sensor]\n{sensor}\n"
            f"[time]\nrate_hz = 10\nframes = 12\nseed = 7\n[[indenter]]\n{lines}\n"
            f"friction = {friction:.3f}\npath = [\n{keys}\n]\n")


class Simulation:
    """Recordings and forces of one indenter."""

    def __init__(self, program, folder, number, indenter):
        self.program, self.folder, self.number, self.indenter = program, Path(folder), number, indenter

    def run(self, *words):
        subprocess.run([self.program, *map(str, words), "-q", "--overwrite"], check=True)

    def record(self, name, sensor, stiffness):
        """The path of a recording without noise."""
        text, path = (self.folder / f"{self.number}_{name}.{end}" for end in ("toml", "h5"))
        text.write_text(scene(self.indenter, sensor, stiffness, self.number), encoding="utf-8")
        self.run("simulate", text, "-o", path)
        return path

    def samples(self):
        """Normal forces [frame, row, col], moments over the pitch [axis, ...] and their mask."""
        with h5py.File(self.record("peak", "", 1)) as file:
            peak = numpy.percentile(file["frames/raw"][:], 99.97)
        stiffness = 150 * random.Random(self.number).uniform(0.4, 1.3) / float(peak)
        leaning = self.record("leaning", LEANING, stiffness)
        noise = numpy.random.default_rng(self.number + 10)
        with h5py.File(leaning, "r+") as file:
            raw = file["frames/raw"]
            raw[...] = raw[:] + noise.normal(0, NOISE_COUNTS, raw.shape)
            truth = [file[f"truth/{name}"][:].astype(float)
                     for name in ("shear_x", "shear_y", "normal")]
        forces = self.folder / f"{self.number}_forces.h5"
        # The recording's own calibration has the arm; the normal force does not depend on it.
        self.run("solve", leaning, "-o", forces)
        with h5py.File(forces) as file:
            normal, status = file["force/normal"][:].astype(float), file["force/status"][:]
        with h5py.File(self.record("unclipped", UNCLIPPED, stiffness)) as file:
            raw = file["frames/raw"][:].astype(float)
        left, right = raw[:, :, 0::2], raw[:, :, 1::2]
        x = (right - left)[:, 0::2] + (right - left)[:, 1::2]
        y = (right + left)[:, 0::2] - (right + left)[:, 1::2]
        shears = numpy.stack([x, y]) / (4 * K * 0.1 * 0.5**0.5)
        largest = truth[2] + (abs(truth[0]) + abs(truth[1])) * 0.5**0.5
        usable = sum((status >> bit) & 1 for bit in range(4))
        return (normal, (shears - truth[:2]) / PITCH_OVER_ARM,
                (usable >= 3) & (truth[2] > 0) & (K * largest > LEAST_COUNTS))


# --- Fit ---

def part(outer, inner):
    whole = outer + inner
    return numpy.where(whole > 0, outer / numpy.where(whole > 0, whole, 1), 0)


def ratios(normal, axis):
    """d, e, s and t of all pillars along x (0) or y (1)."""
    padded = numpy.pad(normal, ((0, 0), (2, 2), (2, 2)))
    rows, cols = normal.shape[1:]

    def beside(step):
        down, right = (0, step) if axis == 0 else (-step, 0)
        return padded[:, 2 + down:2 + down + rows, 2 + right:2 + right + cols]

    low, high = part(beside(-1), normal), part(beside(1), normal)
    far_low, far_high = part(beside(-2), beside(-1)), part(beside(2), beside(1))
    return high - low, far_high - far_low, high + low - 1, far_high + far_low - 1


def terms():
    """The odd terms of second and third degree in d, e (odd), s and t (even), by index."""
    return [term for degree in (2, 3)
            for term in itertools.combinations_with_replacement(range(4), degree)
            if sum(at < 2 for at in term) % 2]


def non_negative(matrix, values):
    """Least squares without the columns whose coefficients would be negative."""
    kept = list(range(matrix.shape[1]))
    while True:
        found = numpy.linalg.lstsq(matrix[:, kept], values, rcond=None)[0]
        if (found >= 0).all():
            return [dict(zip(kept, found)).get(i, 0.0) for i in range(matrix.shape[1])]
        kept.pop(int(numpy.argmin(found)))


def main(program, folder):
    Path(folder).mkdir(parents=True, exist_ok=True)
    simulations = [Simulation(program, folder, i, indenter) for i, indenter in enumerate(shapes())]
    with ThreadPoolExecutor(2) as threads:
        found = list(threads.map(Simulation.samples, simulations))
    z = numpy.concatenate([numpy.stack([r[mask] for r in ratios(normal, axis)], 1)
                           for normal, _, mask in found for axis in (0, 1)])
    own = numpy.concatenate([normal[mask] for normal, _, mask in found for _ in (0, 1)])
    moment = numpy.concatenate([moments[axis][mask] for _, moments, mask in found
                                for axis in (0, 1)]) / own
    columns = numpy.stack([z[:, list(term)].prod(axis=1) for term in terms()], 1)
    odd = numpy.linalg.lstsq(columns * own[:, None], (moment - z[:, 0] / 6) * own, rcond=None)[0]
    for term, value in zip(terms(), odd):
        print(f"{' '.join('dest'[at] for at in term):8}{value:8.3f}")
    left = abs(numpy.clip(z[:, 0] / 6 + columns @ odd, -0.5, 0.5) - moment)
    d, e, s = abs(z[:, 0]), z[:, 1] - z[:, 0], abs(z[:, 2])
    sizes = numpy.stack([numpy.ones_like(d), d**3, s, s * s, abs(e)], 1)
    weight = numpy.minimum(own / numpy.sqrt((own**2).mean()), 3**0.5)[:, None]
    # The mean of the absolute value of a normal error is 0.8 deviations.
    values = non_negative(sizes * weight, 1.25 * left * weight[:, 0])
    print("deviation of 1, |d|^3, |s|, s^2, |e - d|:", *(f"{value:.3f}" for value in values))


if __name__ == "__main__":
    main(*sys.argv[1:])
