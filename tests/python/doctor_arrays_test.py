"""The rates of pf.doctor on generated arrays: sound ones that it accuses, planted faults that it finds.

    doctor_arrays_test.py [--count N] [--seed S]     N sound arrays, and N with a fault
"""

import argparse
import collections
import unittest

import numpy as np

import pillarfield as pf

PARSER = argparse.ArgumentParser(description=__doc__)
PARSER.add_argument("--count", type=int, default=24)
PARSER.add_argument("--seed", type=int, default=0)
ARGUMENTS = PARSER.parse_args()

TOUCHING = ("one sensel", "one touch", "five touches", "many touches", "sweep", "rest", "pressed", "starts pressed",
            "grasps", "two at once", "full load", "four fingers")
NOISES = ("white", "coarse", "pink", "hum")
FAULTS = ("dead", "dead line", "weak", "stuck", "noisy", "shorted", "order", "polarity", "rest", "frozen",
          "repeated", "normalised", "drift", "ghosts", "missing", "two values", "byte order", "saturated", "absent")


class World:
    """An array of bare sensels: the loads on it in time, and what its circuit makes of them."""

    def __init__(self, seed, touching, fault=None):
        self.random = random = np.random.default_rng([ARGUMENTS.seed, seed, fault is not None])
        self.touching, self.fault = touching, fault
        least, most = (4, 64) if fault is None else (8, 32)
        self.rows, self.cols = (int(round(np.exp(random.uniform(*np.log((least, most)))))) for _ in range(2))
        self.y, self.x = np.mgrid[:self.rows, :self.cols]
        self.rate = float(random.choice([20, 50, 100]))
        self.loads = []
        self.touch()
        self.load = np.array(self.loads)
        self.gain = np.clip(1 + random.uniform(0, 0.5 if fault is None else 0.25) * random.normal(size=self.y.shape),
                            0.25, None)
        self.noise_kind = NOISES[seed // len(TOUCHING) % 4 if fault is None else random.integers(4)]
        self.falls = bool(random.random() < 0.4)
        self.peak = np.exp(random.uniform(np.log(40), np.log(3000)))
        self.noise = self.peak / np.exp(random.uniform(np.log(25), np.log(300)))
        if self.noise_kind == "coarse":
            self.noise = random.uniform(0.05, 0.45)
        else:
            self.noise = max(self.noise, 0.5)
        self.each_noise = np.ones(self.y.shape)
        if random.random() < 0.5:
            self.each_noise = random.uniform(1, 5, self.y.shape) if random.random() < 0.7 else random.choice(
                [1.0, 5.0], self.y.shape)
            self.noise /= 3
        self.rest = self.peak * (random.uniform(0.05, 0.5) + random.uniform(0, 0.06) * random.normal(size=self.y.shape))
        self.rest = np.maximum(self.rest, 0) if random.random() < 0.8 else 0 * self.rest
        self.drift = random.uniform(-0.3, 0.3) * self.peak * (random.random() < 0.4)

    # The loads, 0 to 1.

    def frame(self, load=0.0, count=1):
        self.loads += count * [np.broadcast_to(load, self.y.shape) + np.zeros(self.y.shape)]

    def shape(self, y, x, width, flat, aspect=1.0):
        radius = np.hypot((self.y - y) / aspect, (self.x - x) * aspect) / width
        return 0.5 - 0.5 * np.tanh((radius - 1.2) / 0.24) if flat else np.exp(-radius ** 2 / 2)

    def press(self, shape, frames):
        """A touch that comes, stays and goes."""
        random, edge = self.random, int(self.random.integers(1, 6))
        force = np.minimum(1, np.minimum(np.arange(1, frames + 1), np.arange(frames, 0, -1)) / edge)
        force *= random.uniform(0.6, 1) * (1 + 0.05 * np.cumsum(random.normal(size=frames)) / np.sqrt(frames))
        for each in force:
            self.frame(each * shape)

    def anywhere(self):
        return self.random.uniform(0, self.rows - 1), self.random.uniform(0, self.cols - 1)

    def sweep(self, width, flat=False):
        """A finger along all lines."""
        random = self.random
        step = max(0.7 * width, 0.5)
        lines = np.arange(0, self.rows - 1 + step, step)
        along = np.arange(-width, self.cols + width, max(0.35 * width, self.rows * self.cols / 1500))
        for number, line in enumerate(lines):
            for x in along[::1 if number % 2 else -1]:
                self.frame(random.uniform(0.85, 1) * self.shape(line + 0.2 * np.sin(x), x, width, flat))
            if random.random() < 0.3:
                self.frame(0, int(random.integers(3, 20)))

    def touch(self):
        random, kind = self.random, self.touching
        small = min(self.rows, self.cols)
        width, flat = random.uniform(0.5, max(0.8, min(3, small / 5))), bool(random.random() < 0.4)
        aspect = random.uniform(0.7, 1.4)
        before, hold = int(random.integers(15, 120)), int(random.integers(10, 120))
        if kind == "rest":
            self.frame(0, int(random.integers(30, 400)))
        elif kind == "pressed":
            places = [self.anywhere() for _ in range(random.integers(1, 3))]
            for _ in range(2 * hold):
                self.frame(sum(random.uniform(0.9, 1) * self.shape(y, x, width, flat) for y, x in places))
        elif kind == "starts pressed":
            y, x = self.anywhere()
            self.frame(random.uniform(0.6, 1) * self.shape(y, x, width, flat), before + hold)
            self.frame(0, int(random.integers(15, 150)))
        elif kind == "full load":
            self.frame(0, before)
            cover = self.shape(self.rows / 2 - 0.5, self.cols / 2 - 0.5, 0.4 * small, flat)
            for _ in range(random.integers(2, 5)):
                self.press(cover, hold)
                self.frame(0, int(random.integers(10, 40)))
        elif kind == "four fingers":  # on the corners of a rectangle, the last one later and for longer
            self.frame(0, before)
            rows, cols = ([0, size - 1] for size in (self.rows, self.cols))
            shapes = [self.shape(row, col, 0.5, flat) for row in rows for col in cols]
            for first, end in ((0, 2), (0, 3), (0, 4), (3, 4)):
                self.frame(sum(shapes[first:end]), hold)
        elif kind == "sweep":
            self.frame(0, before)
            self.sweep(max(0.7, width), flat)
        else:
            count = {"one sensel": 1, "one touch": 1, "five touches": 5, "many touches": 40, "grasps": 8,
                     "two at once": 12}[kind]
            y, x = self.anywhere()
            for _ in range(count):
                self.frame(0, before if not self.loads else int(random.integers(6, 30)))
                if kind != "grasps":
                    y, x = self.anywhere()
                if kind == "one sensel" or width < 0.6:
                    shape = (self.y == round(y)) & (self.x == round(x))
                else:
                    shape = self.shape(y, x, width, flat, aspect)
                if kind == "two at once":
                    shape = np.maximum(shape, self.shape(*self.anywhere(), width, flat))
                self.press(1.0 * shape, hold if count < 9 else int(random.integers(4, 14)))
            self.frame(0, before // 2)

    # The circuit.

    def noises(self):
        random, shape = self.random, self.load.shape
        white = random.normal(size=shape)
        if self.noise_kind == "pink":
            spectrum = np.fft.rfft(white, axis=0)
            spectrum[1:] /= np.sqrt(np.arange(1, len(spectrum)))[:, None, None]
            white = np.fft.irfft(spectrum, n=len(white), axis=0)
            white *= 1 / white.std()
        elif self.noise_kind == "hum":
            frequency, phase = random.uniform(0.02, 0.5), random.uniform(0, 6)
            hum = np.sin(2 * np.pi * frequency * np.arange(len(white)) + phase)
            white = 0.6 * white + 1.1 * hum[:, None, None]
        return self.noise * self.each_noise * white

    def readings(self):
        random = self.random
        time = np.linspace(0, 1, len(self.load))[:, None, None]
        drift = self.drift * time * (1 + 0.2 * random.normal(size=self.y.shape))
        counts = self.rest + self.peak * self.load * self.gain + drift + self.noises()
        full = 255 if self.peak < 150 else 65535
        if self.falls:
            counts = 0.9 * full - counts
        if random.random() < 0.2 and self.noise_kind != "coarse":
            return counts.astype("f4")
        return counts.round().clip(0, full).astype("u1" if full == 255 else "u2")

    def doctor(self):
        return pf.doctor(self.readings(), rate_hz=self.rate)


class Faulty(World):
    """A swept array with one fault that its loads show."""

    def touch(self):
        random, fault = self.random, self.fault
        self.frame(0, 40)
        width = random.uniform(0.9, 1.6)
        if fault in ("rest", "polarity"):
            y, x = self.anywhere()
            shape = self.shape(y, x, 1.5, False)
            if fault == "polarity":  # an array that starts pressed, for long
                self.loads.clear()
                self.frame(shape, 200)
            for _ in range(6):
                self.press(shape, 40)
                self.frame(0, 40)
        elif fault == "drift":
            self.frame(0, int(45 * self.rate))
        elif fault == "ghosts":
            for place in range(self.rows * self.cols):
                self.frame((self.y == place // self.cols) & (self.x == place % self.cols), 3)
            for corners in (2, 3, 2, 3):
                self.frame(0, 5)
                self.frame(self.corners(corners), 12)
        else:
            self.sweep(width)
            self.frame(0, 20)

    def corners(self, count):
        shape = 1.0 * ((self.y == 1) & (self.x == 1)) + ((self.y == 1) & (self.x == 5))
        return shape + (((self.y == 6) & (self.x == 1)) + 0.4 * ((self.y == 6) & (self.x == 5)) if count == 3 else 0)

    def readings(self):
        """Plants the fault."""
        random, fault = self.random, self.fault
        row, col = (int(random.integers(2, size - 2)) for size in (self.rows, self.cols))
        self.place, self.is_row = (row, col), bool(random.random() < 0.5)
        line = (slice(None), row) if self.is_row else (slice(None), slice(None), col)
        beside = (slice(None), row + 1) if self.is_row else (slice(None), slice(None), col + 1)
        self.line = row if self.is_row else col
        self.noise, self.drift = min(self.noise, self.peak / 60), self.drift * (fault != "drift")
        if fault == "dead":
            self.load[:, row, col] = 0
        elif fault == "dead line":
            self.load[line] = 0
        elif fault == "weak":
            self.gain = np.clip(self.gain, 0.7, 1.4)
            self.gain[row, col] = 0.12
        elif fault == "noisy":
            self.each_noise = np.ones(self.y.shape)
            self.each_noise[row, col] = random.uniform(10, 25)
            self.noise = max(self.noise, 0.5)
            self.rest += 25 * self.noise + 0.1 * self.peak
        elif fault == "shorted":
            self.load[line] = self.load[beside] = (self.load * self.gain)[line] + (self.load * self.gain)[beside]
            self.gain[line[1:]] = self.gain[beside[1:]] = 1
        elif fault == "order":
            size = self.rows if self.is_row else self.cols
            order, first = np.arange(size), int(random.integers(0, size - 4))
            if random.random() < 0.5:
                order[first:first + 5] = order[first:first + 5][::-1]
            else:
                order[[first, first + 4]] = order[[first + 4, first]]
            self.line = {line for line in range(size) if any(
                abs(order[line] - order[near]) > 1 for near in (line - 1, line + 1) if 0 <= near < size)}
            self.load = np.take(self.load, order, 1 if self.is_row else 2)
        elif fault == "rest":
            self.sign = random.choice([-1, 1])
            follows, left = np.zeros(self.y.shape), np.zeros(self.y.shape)
            for number, load in enumerate(self.load.copy()):
                if self.sign > 0:  # each touch leaves a part
                    left += 0.12 * (load - self.load[number - 1]).clip(0) if number else 0
                else:  # the board follows its baseline
                    follows += (load - follows) / 200
                self.load[number] = load + left * (load < 0.02) - follows
            self.rest += 0.5 * self.peak
        elif fault == "missing":
            self.rest += 10 * self.noise + 0.1 * self.peak
        elif fault == "drift":
            self.drift = random.choice([-1, 1]) * random.uniform(0.1, 0.3) * self.peak
            self.rest += 0.6 * self.peak
        self.rest = self.rest + abs(self.drift)
        counts = super().readings()
        if fault == "stuck":
            counts[:, row, col] = counts[:, row, col].min() if random.random() < 0.5 else np.median(counts) + 7
        elif fault in ("saturated", "absent"):
            counts = counts.astype("f4") if fault == "absent" else counts
            counts[:, row, col] = -1 if fault == "absent" else 255 if counts.dtype == np.uint8 else 65535
        elif fault == "missing":
            counts[[100, 101, 150]] = 0
        elif fault == "two values":
            counts = (100.0 * (self.load > 0.3)).astype("u1")
        elif fault == "byte order":
            counts = (counts * (60000 / counts.max())).astype("u2").byteswap()
        elif fault == "frozen":
            counts = counts[60:61].repeat(100, 0)
        elif fault == "repeated":
            counts = (counts + random.integers(0, 3, counts.shape)).astype("f4")
            counts[200:200 + int(random.integers(5, 40))] = counts[199]
        elif fault == "normalised":
            counts = counts.astype("f4") + random.normal(0, 0.1, counts.shape).astype("f4")
            counts /= counts.max((1, 2), keepdims=True)
        return counts

    def is_found(self, found):
        findings = {each.fault: each for each in found.findings}
        fault, kind = self.fault, "row" if self.is_row else "column"
        if fault == "dead line":
            return self.line in findings.get(f"dead {kind}", pf.ArrayFinding("", "", [], [])).lines
        if fault == "shorted":
            return any(each.lines == [self.line, self.line + 1] for each in found.findings
                       if each.fault == f"shorted {kind}s")
        if fault == "order":
            lines = set(findings.get(f"{kind} order", pf.ArrayFinding("", "", [], [])).lines)
            return lines and lines <= self.line
        if fault == "polarity":
            return found.polarity == ("falls" if self.falls else "rises")
        if fault == "rest":
            name = "rest after release" if self.sign > 0 else "followed baseline"
            return name in findings and all(self.load.max(0)[place] > 0.2 for place in findings[name].sensels)
        if fault == "drift":
            true = self.drift * (-1 if self.falls else 1) * 60 * self.rate / len(self.load)
            drift = found.facts["drift_counts_per_minute"]
            return drift is not None and abs(drift["median"] / true - 1) < 0.3
        if fault == "ghosts":
            return (6, 5) in findings.get("ghosts", pf.ArrayFinding("", "", [], [])).sensels
        name = {"repeated": "repeated frames", "missing": "missing frames"}.get(fault, fault)
        if name not in findings and fault in ("dead", "stuck", "weak", "saturated"):
            return any(self.place in each.sensels for name, each in findings.items() if name in ("dead", "stuck", "weak"))
        return name in findings and (not findings[name].sensels or self.place in findings[name].sensels)


def named(world, found):
    return f"{world.touching}, {world.noise_kind}, {world.rows} x {world.cols}: " + "; ".join(
        each.text for each in found.findings)


class DoctorArrays(unittest.TestCase):
    def test_sound_arrays_are_not_accused(self):
        count, accused, reversed_, words = collections.Counter(), collections.Counter(), 0, []
        for seed in range(ARGUMENTS.count):
            world = World(seed, TOUCHING[seed % len(TOUCHING)])
            found = world.doctor()
            count[world.touching] += 1
            reversed_ += found.polarity == ("rises" if world.falls else "falls")
            if found.polarity == ("rises" if world.falls else "falls"):
                words.append(f"{seed} reversed {named(world, found)}")
            if found.findings:
                accused[world.touching] += 1
                words.append(f"{seed} " + named(world, found))
        print("accused", {kind: f"{accused[kind]} of {count[kind]}" for kind in TOUCHING}, f"reversed {reversed_}")
        print("\n".join(words))
        self.assertLessEqual(accused.total(), max(1, 0.01 * ARGUMENTS.count), words)
        self.assertLessEqual(reversed_, max(1, 0.01 * ARGUMENTS.count), words)

    def test_shown_faults_are_found(self):
        found_of, count = collections.Counter(), collections.Counter()
        words = []
        for seed in range(ARGUMENTS.count):
            world = Faulty(seed, "sweep", FAULTS[seed % len(FAULTS)])
            found = world.doctor()
            count[world.fault] += 1
            found_of[world.fault] += bool(world.is_found(found))
            if not world.is_found(found):
                words.append(f"{seed} {world.fault} {world.place} {found.polarity} {world.falls}: {named(world, found)}")
        print("found", {kind: f"{found_of[kind]} of {count[kind]}" for kind in FAULTS})
        print("\n".join(words))
        self.assertGreaterEqual(found_of.total(), min(0.95 * ARGUMENTS.count, ARGUMENTS.count - 2), words)


if __name__ == "__main__":
    unittest.main(argv=["doctor_arrays_test.py"])
