"""measure_sensors.py PROGRAM FOLDER: prints the errors of forces under effects of a sensor, as JSON.

PROGRAM is pillarfield, whose recordings and calibrations are made in FOLDER."""

import concurrent.futures
import json
import subprocess
import sys
import zlib
from pathlib import Path

import h5py
import numpy

import page
import sensor_scenes as scenes
from page import Failure

K = scenes.COUNTS_PER_NEWTON
LEAST_COUNTS = 8  # of the largest load of a pillar that counts
LIMIT_95 = 1.959964
AMBIGUOUS = 16
COMPONENTS = ("shear_x", "shear_y", "normal")
ORDER = ("wires", "tare", "bending", "one pressure", "pressures", "memory", "leak", "shear", "arm")
IDEAL = scenes.Effect("ideal sensor", "", ())


# --- Errors ---

def loads(truth, coefficient=1):
    """V of the sensels 1 to 4, N, negative where a pillar lifts off."""
    x, y, normal = coefficient * truth[0] / 2**0.5, coefficient * truth[1] / 2**0.5, truth[2]
    return numpy.stack([normal + x + y, normal - x + y, normal - x - y, normal + x - y])


def at_rim(loaded):
    """Loaded pillars beside an unloaded one."""
    wide = numpy.pad(loaded, ((0, 0), (1, 1), (1, 1)))
    inside = wide[:, :-2, 1:-1] & wide[:, 2:, 1:-1] & wide[:, 1:-1, :-2] & wide[:, 1:-1, 2:]
    return loaded & ~inside


def usable(status):
    return sum((status >> bit) & 1 for bit in range(4))


def squares(errors, chosen):
    """Sum of squared errors of the chosen pillars, counts, and their number."""
    return [float((errors**2).sum(axis=0)[chosen].sum()), int(chosen.sum())]


def scores(truth, forces, status, deviations=None, coefficient=1):
    """Pairs of a sum over pillars and their number. Arrays are [component,] frame, row, col; N."""
    v = loads(truth, coefficient)
    largest = v.max(axis=0)
    pressed = (truth[2] > 0) & (K * largest > LEAST_COUNTS)
    errors = K * (forces - truth)
    # A sensel that a pillar loads by less than its own rounding error is not one.
    truly = sum((v[bit] > 1e-6 * largest).astype(int) << bit for bit in range(4))
    wrong = pressed & ((status & 15) != truly)
    determined = pressed & (usable(status) >= 3)
    rim = at_rim(truth[2] > 0)
    result = {"determined": squares(errors, determined),
              "inside": squares(errors, determined & ~rim),
              "rim": squares(errors, determined & rim),
              "ambiguous": squares(errors, pressed & (usable(status) == 2)),
              "wrong": [int(wrong.sum()), int(pressed.sum())],
              "unflagged": [int((wrong & ((status & AMBIGUOUS) == 0)).sum()), int(pressed.sum())]}
    if deviations is not None:
        stated = determined & ((status & AMBIGUOUS) == 0)
        held = numpy.abs(errors) <= LIMIT_95 * K * deviations
        for at, name in enumerate(COMPONENTS):
            result[name] = [int(held[at][stated].sum()), int(stated.sum())]
    return result


def added(many):
    """Scores of several histories together."""
    return {name: [sum(pair) for pair in zip(*(one[name] for one in many))] for name in many[0]}


def planes(path, group):
    with h5py.File(path) as file:
        return numpy.stack([file[f"{group}/{name}"][:].astype(float) for name in COMPONENTS])


def scores_of(recording, solved, with_uncertainty, coefficient):
    with h5py.File(solved) as file:
        status = file["force/status"][:]
    return scores(planes(recording, "truth"), planes(solved, "force"), status,
                  planes(solved, "uncertainty") if with_uncertainty else None, coefficient)


# --- The product's commands ---

class Sensor:
    """A simulated sensor with its experiments, calibrations and histories."""

    def __init__(self, program, folder, effect, stiffness):
        self.program, self.folder, self.effect = program, Path(folder), effect
        self.stiffness = stiffness
        self.folder.mkdir(parents=True, exist_ok=True)
        Path(self.folder, "cycles.csv").write_text(scenes.cycles_log(), encoding="utf-8")

    def run(self, *words):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True,
                              cwd=self.folder, check=False)
        if done.returncode:
            raise Failure(f"{' '.join(map(str, words))} in {self.folder}: {done.stderr.strip()}")

    def simulate(self, name, text, *options):
        """The name of a recording, made at most once."""
        recording = f"{name}.h5"
        if not Path(self.folder, recording).exists():
            Path(self.folder, f"{name}.toml").write_text(text, encoding="utf-8")
            self.run("simulate", f"{name}.toml", "-o", recording, "-q", *options)
            self.add_noise(recording)
        return recording

    def add_noise(self, recording):
        """Noise of its own for each recording: a scene's noise is that of its seed, equal in all
        recordings of one skin, so that a tare would remove it."""
        random = numpy.random.default_rng(zlib.crc32(f"{self.folder.name}/{recording}".encode()))
        with h5py.File(Path(self.folder, recording), "r+") as file:
            raw = file["frames/raw"]
            raw[...] = raw[:] + random.normal(0, scenes.NOISE_COUNTS, raw.shape)

    def experiment(self, name):
        return self.simulate(name, scenes.experiment(name, self.effect), "--uncalibrated")

    def calibrate(self, step, before):
        """The calibration after a step of scenes.CALIBRATIONS; made at most once."""
        command, recordings, words = scenes.CALIBRATIONS[step]
        after = f"{Path(before).stem}+{step}.h5".replace(" ", "_") if before else f"{step}.h5"
        if not Path(self.folder, after).exists():
            self.run("calibrate", command, *map(self.experiment, recordings), *words,
                     *(("--calibration", before) if before else ()), "-o", after, "-q")
        return after

    def calibrated(self, steps):
        """The calibration after these steps and the tare."""
        calibration = None
        for step in sorted((*steps, "tare"), key=ORDER.index):
            calibration = self.calibrate(step, calibration)
        return calibration

    def taken_for_ideal(self):
        """Tare, and counts per newton of one known weight."""
        counts = 60
        weight = scenes.PILLARS**2 * counts / K
        calibration = self.calibrate("tare", None)
        if not Path(self.folder, "weighed.h5").exists():
            self.run("calibrate", "load", self.experiment(f"press{counts}"), "--load-n", weight,
                     "--calibration", calibration, "-o", "weighed.h5", "-q")
        return "weighed.h5"

    def histories(self):
        for name, indenter in scenes.BODIES.items():
            text = scenes.history(indenter, self.effect.sensor, self.effect.surface,
                                  self.stiffness[name])
            yield self.simulate(name.replace(" ", "_"), text)

    def solve(self, *options, noise=True, estimator="direct"):
        words = ("--outputs", "uncertainty") if estimator != "paper" else ()
        words += ("--noise", scenes.NOISE_COUNTS) if noise and estimator != "paper" else ()
        for recording in self.histories():
            self.run("solve", recording, "-o", "forces.h5", "--overwrite", "-q", "--estimator",
                     estimator, *words, *options)
            yield scores_of(Path(self.folder, recording), Path(self.folder, "forces.h5"),
                            estimator != "paper", self.effect.coefficient)

    def score(self, *options, **more):
        return added(list(self.solve(*options, **more)))

    def score_calibrated(self, calibration):
        """By the calibration's own noise, with the ambiguous pillars of other estimators too."""
        options = {"noise": False}
        by_indenter = list(self.solve("--calibration", calibration, **options))
        result = added(by_indenter) | {"indenters": dict(zip(scenes.BODIES, by_indenter))}
        for estimator in ("contact", "paper"):
            other = self.score("--calibration", calibration, estimator=estimator, **options)
            result[f"ambiguous_{estimator}"] = other["ambiguous"]
        return result


# --- Measurements ---

def stiffness_for_peak(program, folder):
    """The factor of modulus and load with which each history has the same largest readings."""
    sensor = Sensor(program, folder, IDEAL, {name: 1 for name in scenes.BODIES})
    result = {}
    for name, recording in zip(scenes.BODIES, sensor.histories()):
        with h5py.File(Path(folder, recording)) as file:
            result[name] = scenes.PEAK_COUNTS / float(
                numpy.percentile(file["frames/raw"][:], 99.97))
    return result


def measure_ideal(program, folder, stiffness):
    """The ideal sensor, and what each calibration does to it."""
    sensor = Sensor(program, folder, IDEAL, stiffness)
    result = {"ideal": sensor.score()}
    absent = {}
    for effect in scenes.EFFECTS.values():
        if effect.steps not in absent:
            absent[effect.steps] = sensor.score_calibrated(sensor.calibrated(effect.steps))
    result["absent"] = {name: absent[effect.steps] for name, effect in scenes.EFFECTS.items()}
    return result


def measure_effect(program, folder, stiffness, effect):
    sensor = Sensor(program, folder, effect, stiffness)
    ignored = list(sensor.solve("--calibration", sensor.taken_for_ideal()))
    return {"ignored": added(ignored) | {"indenters": dict(zip(scenes.BODIES, ignored))},
            "exact": sensor.score(),
            "calibrated": sensor.score_calibrated(sensor.calibrated(effect.steps))}


def main(program, folder):
    program, folder = Path(program).resolve(), Path(folder)
    stiffness = stiffness_for_peak(program, folder / "peak")
    with concurrent.futures.ThreadPoolExecutor(2) as threads:
        ideal = threads.submit(measure_ideal, program, folder / "ideal", stiffness)
        effects = {name: threads.submit(measure_effect, program, folder / name, stiffness, effect)
                   for name, effect in scenes.EFFECTS.items()}
    json.dump(ideal.result() | {"effects": {name: effect.result()
                                            for name, effect in effects.items()}},
              sys.stdout, indent=1)


if __name__ == "__main__":
    page.run(main)
