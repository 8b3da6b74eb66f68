"""The check of parity on worlds that share nothing with it: four sensels under each pillar, with errors of many kinds.

It blames what is wrong or nothing, and what it says makes intervals hold. SEEDS (20) worlds of each kind; prints rates.
"""

import os
import unittest
import warnings
import numpy as np
import pillarfield as pf

SEEDS = int(os.environ.get("SEEDS", "20"))
COUNTS_PER_NEWTON = 320
MODEL = np.array([[-1, 1, 2 ** 0.5], [1, 1, 2 ** 0.5], [-1, -1, 2 ** 0.5], [1, -1, 2 ** 0.5]]) / 2 ** 0.5
WORDS = {"noise": "noise is about", "tare": "Tares are off", "drift": "Sensels drift", "gains": "Gains are off",
         "leak": "of their neighbours' load", "curve": "grow about as", "nothing": "contradict each other"}
ERRORS = ["gains", "drift", "tare", "leak", "curve", "rows"]
KINDS = ["right", "right, 8 bits", "noise", *ERRORS, "drift of a count", "NaN", "two of them",
         "saturating", "rows read later", "hysteresis"]


def forces(random, frames, size):
    """Bodies that land, slide and turn: 4 counts each, [frames, size, size, 3]."""
    y, x = np.mgrid[:size, :size]
    out = np.zeros((frames, size, size, 3))
    for _ in range(random.integers(1, 4)):
        radius, power, aspect = random.uniform(0.12, 0.35) * size, random.choice([0.5, 1, 2]), random.uniform(0.6, 1.6)
        start, way = random.uniform(0.25, 0.75, 2) * size, random.normal(0, 0.12, 2) * size
        peak, friction = random.uniform(30, 100), random.uniform(0.2, 1.2)
        angle, turn, beat, lands = random.uniform(0, 6.28), random.uniform(0, 2), random.uniform(2, 12), random.uniform(0.1, 0.3)
        for frame, time in zip(out, np.linspace(0, 1, frames)):
            row, col = start + way * (time - 0.5)
            square = ((y - row) / radius) ** 2 * aspect + ((x - col) / radius) ** 2 / aspect
            load = np.clip((time - lands) / 0.15, 0, 1) * (0.75 + 0.25 * np.sin(beat * time))
            normal = peak * load * np.clip(1 - square, 0, None) ** power
            shear = friction * normal * (0.3 + 0.7 * np.clip(square, 0, 1)) * np.sin(np.pi * min(1, 1.3 * time))
            frame += np.stack([shear * np.cos(angle + turn * time), shear * np.sin(angle + turn * time), normal], -1)
    return out


def leaked(frames, inside, across):
    out = frames.copy()
    for axis in (1, 2):
        index = np.arange(frames.shape[axis])
        for step in (1, -1):
            other = index + step
            share = np.where(index // 2 == other // 2, inside, across) * ((other >= 0) & (other < len(index)))
            out += np.take(frames, other % len(index), axis) * share.reshape([-1 if i == axis else 1 for i in range(3)])
    return out


def world(seed, kind):
    """Frames, options of solve() and the true normal force, N; the errors."""
    random = np.random.default_rng([seed, KINDS.index(kind)])
    frames, size = int(random.integers(100, 250)), int(random.integers(12, 25))
    true = forces(random, frames, size)
    v = np.maximum(true @ MODEL.T, 0).reshape(frames, size, size, 2, 2).swapaxes(2, 3).reshape(frames, 2 * size, 2 * size)
    shape, ramp = v.shape[1:], np.linspace(0, 1, frames)[:, None, None]
    stated, tare, error = random.uniform(0.3, 0.8), random.normal(20, 2, v.shape[1:]), np.zeros(v.shape[1:])
    noise, kind_of_reading, full = np.full(shape, stated), random.choice(["f4", "u1", "u2"]), None
    errors = {"NaN": ["NaN", random.choice(["gains", "drift", "tare"])],
              "two of them": list(random.choice(ERRORS, 2, replace=False))}.get(kind, [kind])
    if "leak" in errors:
        v = leaked(v, random.uniform(0.02, 0.07), random.uniform(0.01, 0.035))
    if "saturating" in errors:
        v = v / (1 + v / random.uniform(250, 900))
    if "rows read later" in errors:
        v[1:, 1::2] = (v[1:, 1::2] + v[:-1, 1::2]) / 2
    if "hysteresis" in errors:
        play, width = np.zeros(shape), random.uniform(1, 6)
        for frame in v:
            play = np.maximum(np.minimum(np.maximum(play, frame - width), frame), 0)
            frame[:] = 0.7 * frame + 0.3 * play
    if "curve" in errors:
        exponent, reference = 1 + random.choice([-1, 1]) * random.uniform(0.06, 0.2), random.uniform(25, 120)
        v = reference * (v / reference) ** exponent
    if "gains" in errors:
        v = v * np.clip(random.normal(1, random.uniform(0.02, 0.1), shape), 0.5, 1.5)
    if "drift" in errors:
        v = v + ramp * random.normal(0, random.uniform(1.5, 5), shape)
    if "drift of a count" in errors:
        v = v + ramp * random.normal(0, 1, shape)
    if "tare" in errors:
        error = random.normal(0, random.uniform(1.5, 4), shape)
    if "rows" in errors:
        noise[random.random(shape[0]) < 0.2] *= random.uniform(4, 9)
        noise[random.integers(0, shape[0])] *= 4
    noise *= random.uniform(1.8, 4) if kind == "noise" else random.uniform(0.8, 1.2) if kind == "right" else 1
    readings = tare + v + random.normal(0, 1, v.shape) * noise
    if kind == "right, 8 bits":  # with a measured tare
        kind_of_reading = "u1"
        tare = np.round(tare + random.normal(0, 1, (30, *shape)) * noise).mean(0)
    if "NaN" in errors:
        kind_of_reading = "f4"
        readings[random.random(v.shape) < 10 ** random.uniform(-5, -2.5)] = np.nan
    if kind_of_reading != "f4":
        readings, full = np.round(readings).clip(0, 255), 255
    return readings.astype(kind_of_reading), {
        "layout": "pillars", "counts_per_newton": COUNTS_PER_NEWTON, "noise_counts": stated, "rate_hz": 50,
        "full_scale_counts": full, "threshold_counts": max(3, 5 * stated), "outputs": ["uncertainty"],
        "calibration": pf.Calibration(*shape, tare=(tare + error).astype("f4"))}, true[..., 2] / COUNTS_PER_NEWTON, errors


class Parity(unittest.TestCase):
    def test_blames_what_it_saw(self):
        print(f"\n{'error':18} blamed wrongly, nothing said, blamed nothing; inside 95 %: all, where it spoke")
        for kind in KINDS:
            wrong, silent, unnamed, held, held_told = 0, 0, 0, [], []
            for seed in range(SEEDS):
                frames, options, normal, errors = world(seed, kind)
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    solved = pf.solve(frames, **options)
                told = " ".join(str(each.message) for each in caught)
                named = {word for word, text in WORDS.items() if text in told}
                true = {{"rows": "noise", "saturating": "curve", "drift of a count": "drift"}.get(e, e) for e in errors}
                wrong += bool(named - true - {"nothing"})
                silent += not named
                unnamed += "nothing" in named
                touched = (solved.status & pf.Status.USABLE) != 0
                holds = (np.abs(solved.normal - normal) < 1.96 * solved.uncertainty.normal)[touched].mean()
                held.append(holds)
                held_told += [holds] if named else []
            rates = f"{kind:18} {wrong / SEEDS:.3f} {silent / SEEDS:.3f} {unnamed / SEEDS:.3f}; {np.mean(held):.3f}" + (
                f" {np.mean(held_told):.3f}" if held_told else "")
            print(rates, flush=True)
            with self.subTest(rates):
                self.assertLessEqual(wrong, 0.05 * SEEDS)
                if kind.startswith("right"):
                    self.assertLessEqual(SEEDS - silent, max(0.01 * SEEDS, 1))
                elif kind not in ("leak", "curve", *KINDS[-3:]):  # which may keep parity
                    self.assertLessEqual(silent, 0.1 * SEEDS)
                    self.assertGreater(np.mean(held), 0.9)
                if held_told and kind != "hysteresis":
                    self.assertGreater(np.mean(held_told), 0.9)


if __name__ == "__main__":
    unittest.main()
