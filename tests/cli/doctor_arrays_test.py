"""`pillarfield doctor` on recordings of arrays as people have them: fine pads swept by a finger, arrays that are
loaded most of the time (insoles, seats, beds, grips), coarse arrays pressed one sensel at a time.

Every second array has planted faults. An array is made from its kind and number alone:

    doctor_arrays_test.py --all            scores all arrays; --seed S: others of the same kinds
    doctor_arrays_test.py foot 17 --seed 2 -o foot.npy    writes one, and prints what was planted
"""

import argparse
import re
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

import numpy as np

KINDS = {"pad": 40, "foot": 8, "seat": 8, "bed": 7, "grip": 7, "coarse": 20}  # and how many there are
FAULTS = ("dead", "dead row", "lost frames", "shorted columns", "noisy", "absent", "dead column", "stuck",
          "repeated frames", "shorted rows")
# The findings that name a planted fault. A sensel that is dead may read one number only.
NAMES = {"dead": "dead|stuck|absent", "stuck": "stuck|dead|absent|saturated", "noisy": "nois|unsteady|flicker",
         "absent": "absent|stuck", "lost frames": "zero|lost|missing|empty", "repeated frames": "repeat|stall|froz",
         "dead row": "dead row|absent|stuck|dead", "dead column": "dead column|absent|stuck|dead",
         "shorted rows": "shorted rows", "shorted columns": "shorted columns"}


class Array:
    """A recording: the load of each sensel, [frame, row, col], what the circuit makes of it, and the faults."""

    def __init__(self, kind, number, seed=0):
        self.name, self.number = f"{kind} {number}", number
        self.random = random = np.random.default_rng([list(KINDS).index(kind), number, seed])
        self.kind, self.outline = kind, None
        getattr(self, kind)()
        self.frames, self.rows, self.cols = self.load.shape
        self.load *= self.ragged(0.1)
        self.creep(*((0, 0.1) if kind in ("pad", "coarse") else (0.05, 0.25)))
        self.load /= np.quantile(self.load.max(0), 0.95)
        # The circuit: gains, rest, noise, drift, and a range that the load may exceed.
        self.falls = bool(random.random() < 0.4)
        self.bits = int(random.choice([8, 10, 12, 16]))
        self.full = 2 ** self.bits - 1
        shape = (self.rows, self.cols)
        self.gain = np.exp(random.uniform(0.1, 0.3) * random.normal(size=shape))
        self.at_rail = bool(random.random() < 0.2)  # without load most readings are 0, or full scale
        room = random.uniform(0.3, 0.8) if random.random() < 0.8 else random.uniform(1, 1.4)
        level = 0 if self.at_rail else random.uniform(0.04, 0.12) if not self.falls else random.uniform(0, 0.3)
        self.peak = room * (1 - level) * self.full
        spread = 0 if self.at_rail else random.uniform(0.005, 0.02) * self.full
        self.rest = level * self.full + spread * random.normal(size=shape)
        ratio = np.exp(random.uniform(*np.log((20, 700) if kind == "coarse" else (40, 300))))
        self.noise = max(self.peak / ratio, 0.2)
        self.planted = {}  # name: the frames, sensels or lines
        self.plant()

    def ragged(self, spread):
        """Unlike skin and cloth over each sensel, fixed in place."""
        return np.exp(spread * self.random.normal(size=self.load.shape[1:]))

    def creep(self, least, most):
        """Adds a part of the load that comes, and goes, slowly."""
        share, rate = self.random.uniform(least, most), 1 / (self.random.uniform(5, 30) * self.rate)
        slow = np.zeros(self.load.shape[1:])
        for load in self.load:
            slow += rate * (load - slow)
            load += share * slow

    def grid(self, rows, cols, pitch_mm, seconds, rate):
        """Places of the sensels, mm, and the times of the frames, s."""
        self.rate = float(rate)
        self.time = np.arange(int(seconds * rate)) / rate
        self.load = np.zeros((len(self.time), rows, cols))
        self.y, self.x = np.mgrid[0:rows, 0:cols] * pitch_mm

    def blob(self, y, x, half_y, half_x, edge=0.25):
        """A round load with a soft edge, under a cover: 1 in the middle; positions may be those of frames."""
        y, x = (np.asarray(centre)[..., None, None] for centre in (y, x))
        radius = np.hypot((self.y - y) / half_y, (self.x - x) / half_x)
        return 1 / (1 + np.exp((radius - 1) / edge)) * (1 - 0.4 * np.minimum(radius, 1) ** 2)

    def wander(self, size, seconds):
        """A slow random change around 0."""
        knots = np.arange(0, self.time[-1] + 2 * seconds, seconds)
        return size * np.interp(self.time, knots, self.random.normal(size=len(knots)))

    def absences(self, least, most, count=1):
        """1 while somebody is there; 0 for `count` times of this share of all frames, at any place."""
        there = np.ones(len(self.time))
        for _ in range(count):
            length = int(self.random.uniform(least, most) * len(there))
            first = self.random.choice([0, len(there) - length, self.random.integers(0, len(there) - length)])
            there[first:first + length] = 0
        return np.convolve(np.pad(there, 2, "edge"), np.ones(5) / 5, "valid")

    # The arrays.

    def pad(self):
        """A finger sweeps a fine pad line by line, to and fro."""
        random, pitch = self.random, self.random.uniform(1, 5)
        rows, cols = (int(random.integers(10, 40)) for _ in range(2))
        radius, rate = random.uniform(max(4, 1.2 * pitch), max(7, 2.2 * pitch)), random.choice([25, 50, 100])
        lengths, is_down = np.array([rows, cols]) * pitch, random.random() < 0.3
        across, along = lengths if not is_down else lengths[::-1]
        lines = int(np.ceil(across / (0.8 * radius))) + 1
        seconds = np.clip(lines * along / random.uniform(40, 80), 8, 60)
        self.grid(rows, cols, pitch, seconds, rate)
        turn = np.linspace(0, lines, len(self.time))
        line = np.floor(turn)
        position = np.abs((turn + random.integers(2)) % 2 - 1) * (along + 2 * radius) - radius
        height = np.minimum(turn if random.random() < 0.5 else line, lines - 1) / (lines - 1) * across
        height, position = height + self.wander(0.1 * radius, 1), position + self.wander(0.1 * radius, 0.5)
        force = np.clip(0.85 + self.wander(0.12, 0.7), 0.4, 1.2)
        if random.random() < 0.5:
            force *= (turn % 1) > 0.12  # the finger is lifted between lines
        force[:int(random.choice([0, 0.5, 2]) * rate)] = 0
        for first in random.integers(0, len(force), 3):
            force[first:first + int(0.5 * rate)] = 0
        y, x = (height, position) if not is_down else (position, height)
        self.load = force[:, None, None] * self.blob(y, x, radius, radius, random.uniform(0.15, 0.3))

    def foot(self):
        """An insole, or a plate, on which somebody walks and stands."""
        random, is_insole = self.random, self.random.random() < 0.6
        rows, cols = int(random.integers(22, 36)), int(random.integers(8, 13))
        self.grid(rows, cols, 8, random.uniform(20, 40), random.choice([25, 50, 100]))
        length, width = rows * 8, cols * 8
        step = random.uniform(0.9, 1.3)
        phase = (self.time % step) / step
        stands = np.repeat(random.random(60) < 0.5, int(2 * self.rate))[:len(self.time)]
        stands = np.convolve(np.pad(stands, 2, "edge"), np.ones(5) / 5, "valid")
        weight = self.absences(0.03, 0.06)
        loads = ((0.15, 0.5, 0.12, 0.3, 0.2, 0.6), (0.48, 0.62, 0.14, 0.13, 0.35, 0.25),
                 (0.74, 0.45, 0.1, 0.36, 0.45, 0.8), (0.92, 0.4, 0.06, 0.16, 0.55, 0.7))
        for down, right, half_y, half_x, middle, size in loads:
            walking = np.exp(-((phase - middle) / 0.13) ** 2 / 2)
            force = weight * size * np.where(stands > 0.5, 0.6 + self.wander(0.08, 1), walking)
            self.load += np.maximum(force, 0)[:, None, None] * self.blob(
                (1 - down) * length, right * width, half_y * length, half_x * width)
        if is_insole:
            along = np.linspace(0, 1, rows)[:, None]
            half = 0.3 + 0.2 * np.cos(2.6 * np.pi * (along - 0.25)) ** 2 * (along < 0.95)
            self.outline = np.abs(np.linspace(-0.5, 0.5, cols) - 0.03) > half
            self.load[:, self.outline] = 0

    def seat(self):
        """Somebody sits, breathes, shifts, and once gets up."""
        random, pitch = self.random, 15
        rows, cols = (int(random.integers(16, 32)) for _ in range(2))
        self.grid(rows, cols, pitch, random.uniform(60, 120), random.choice([10, 20]))
        height, width = rows * pitch, cols * pitch
        there = self.absences(0.04, 0.1) if random.random() < 0.8 else 1
        lean = self.wander(0.25, random.uniform(6, 15))
        breath = 1 + 0.03 * np.sin(2 * np.pi * 0.27 * self.time)
        for side in (-1, 1):
            force = (there * breath * (1 + side * lean)).clip(0)[:, None, None]
            x = width * (0.5 + 0.17 * side + 0.02 * lean)
            self.load += force * self.blob(0.66 * height + 0 * x, x, 0.14 * height, 0.12 * width)
            self.load += 0.35 * force * self.blob(0.36 * height + 0 * x, x, 0.24 * height, 0.1 * width)

    def bed(self):
        """Somebody lies, breathes, turns over, and once gets up."""
        random, pitch = self.random, 28
        rows, cols = int(random.integers(36, 60)), int(random.integers(18, 30))
        self.grid(rows, cols, pitch, random.uniform(120, 240), random.choice([4, 8]))
        there = self.absences(0.03, 0.08) if random.random() < 0.8 else 1
        places = np.repeat(random.uniform(0.3, 0.7, 9), len(self.time) // 6)[:len(self.time)]
        breath = 1 + 0.06 * np.sin(2 * np.pi * 0.24 * self.time)
        for down, right, half_y, half_x, size, breathes in (
                (0.12, 0, 0.05, 0.1, 0.6, 0), (0.32, 0, 0.12, 0.17, 0.7, 1), (0.53, 0, 0.08, 0.16, 1, 0),
                (0.75, 0.08, 0.12, 0.06, 0.35, 0), (0.75, -0.08, 0.12, 0.06, 0.35, 0), (0.93, 0.06, 0.03, 0.05, 0.7, 0)):
            force = there * size * (breath if breathes else 1) * (1 + self.wander(0.03, 4))
            x = cols * pitch * (places + right)
            self.load += force[:, None, None] * self.blob(down * rows * pitch + 0 * x, x,
                                                          half_y * rows * pitch, half_x * cols * pitch)

    def grip(self):
        """A hand holds things: it closes, holds with a tremor, and opens."""
        random, pitch = self.random, 4
        rows, cols = (int(random.integers(10, 18)) for _ in range(2))
        self.grid(rows, cols, pitch, random.uniform(30, 60), random.choice([30, 60]))
        held, force = np.zeros(len(self.time)), np.zeros(len(self.time))
        places, at = np.zeros((2, len(self.time))), int(random.uniform(0, 1) * self.rate)
        while at < len(held):
            hold, free = (int(random.uniform(*span) * self.rate) for span in ((4, 10), (0.3, 1)))
            held[at:at + hold] = random.uniform(0.6, 1.1)
            places[:, at:at + hold] = random.uniform(0.3, 0.7, (2, 1))
            at += hold + free
        force = np.convolve(held, np.ones(5) / 5, "same") * (1 + self.wander(0.05, 0.12))
        y, x = places[0] * rows * pitch, places[1] * cols * pitch
        thick, length = random.uniform(0.14, 0.22), random.uniform(0.35, 0.5)
        halves = (thick * rows * pitch, length * cols * pitch)
        self.load = force[:, None, None] * self.blob(y, x, *halves) + 0.6 * force[:, None, None] * self.blob(
            y + 0.3 * rows * pitch, x, *halves)

    def coarse(self):
        """A finger presses each sensel once or twice, and reaches its neighbours a little."""
        random = self.random
        rows, cols = (int(random.integers(4, 17)) for _ in range(2))
        hold, free = int(random.integers(3, 15)), int(random.integers(0, 6))
        order = random.permutation(rows * cols) if random.random() < 0.5 else np.arange(rows * cols)
        order = np.r_[order, order] if random.random() < 0.3 else order
        idle = int(random.integers(10, 60))
        self.grid(rows, cols, 12, (idle + len(order) * (hold + free)) / 20, 20)
        spread = random.uniform(0, 0.12)
        for index, sensel in enumerate(order):
            press = np.zeros((rows + 2, cols + 2))
            row, col = divmod(int(sensel), cols)
            press[row + 1, [col, col + 2]] = press[[row, row + 2], col + 1] = spread
            press[row + 1, col + 1] = 1
            first = idle + index * (hold + free)
            self.load[first:first + hold] = press[1:-1, 1:-1] * random.uniform(0.7, 1.1)

    # The faults.

    def plant(self):
        """Plants two faults in every second array."""
        signal = self.peak * self.load * self.gain
        strong = signal > max(0.25 * self.peak, 10 * self.noise)
        self.tested = strong.sum(0) >= 6 if self.kind != "coarse" else np.ones((self.rows, self.cols), bool)
        if self.kind in ("foot", "seat", "bed", "grip"):  # inside the load, not at its border
            padded = np.pad(self.tested, 1)
            self.tested = self.tested & padded[2:, 1:-1] & padded[:-2, 1:-1] & padded[1:-1, 2:] & padded[1:-1, :-2]
        self.absent = self.outline.copy() if self.outline is not None else np.zeros((self.rows, self.cols), bool)
        self.silent, self.at_end, self.stuck = np.zeros((3, self.rows, self.cols), bool)
        self.extra_noise = np.zeros((self.rows, self.cols))
        self.ties, self.lost, self.repeated = [], [], []
        self.tested &= ~self.absent
        first = 2 * list(KINDS).index(self.kind) + 3 * (self.number // 2)
        wanted = [FAULTS[(first + step) % len(FAULTS)] for step in range(len(FAULTS))]
        for fault in wanted if self.number % 2 else []:
            if len(self.planted) < 2 and (places := self.place(fault)) is not None:
                self.planted[fault] = places

    def place(self, fault):
        """Plants a fault where these loads show it; returns where, or None."""
        random = self.random
        if fault == "lost frames":
            if self.at_rail and not self.falls:
                return None
            self.lost = random.choice(self.frames, max(3, int(random.uniform(0.01, 0.05) * self.frames)), False)
            return sorted(self.lost.tolist())
        if fault == "repeated frames":
            if self.at_rail or self.noise < 0.4:
                return None
            self.repeated = [slice(first, first + int(random.integers(8, 40)))
                             for first in random.integers(1, self.frames - 40, random.integers(1, 4))]
            return [[each.start, each.stop] for each in self.repeated]
        if fault == "absent":
            if not self.absent.any():
                rows, cols = (int(random.integers(2, max(3, size // 3 + 1))) for size in (self.rows, self.cols))
                self.absent[:rows, -cols:] = True
                self.tested &= ~self.absent
            return np.argwhere(self.absent).tolist()
        if fault in ("dead", "stuck", "noisy"):
            places = random.permutation(np.argwhere(self.tested))[:random.integers(1, 4)]
            for row, col in places:
                self.tested[row, col] = False
                if fault == "dead":
                    self.silence((row, col))
                elif fault == "stuck":
                    self.stuck[row, col] = True
                else:
                    self.extra_noise[row, col] = max(6, random.uniform(8, 25) * self.noise)
            return places.tolist() if len(places) else None
        is_row = "row" in fault
        tested, exist = (mask.sum(1 if is_row else 0) for mask in (self.tested, ~self.absent))
        lines = np.flatnonzero((tested >= 4) & (tested >= 0.3 * exist))
        if "dead" in fault and len(lines):
            lines = random.choice(lines, 1).tolist()
            where = self.line(is_row, lines[0])
            self.silence(where)
        else:
            pairs = [(a, b) for a in lines for b in lines if a < b and (b == a + 1 or self.kind in ("pad", "coarse"))]
            pairs = [pair for pair in pairs if pair[1] == pair[0] + 1] if random.random() < 0.7 else pairs
            if not pairs:
                return None
            lines = [int(line) for line in random.choice(pairs)]
            where = self.line(is_row, lines)
            self.ties.append((is_row, lines))
        self.tested[where] = False
        return lines

    @staticmethod
    def line(is_row, line):
        return (line, slice(None)) if is_row else (slice(None), line)

    def silence(self, where):
        """No load is felt there: the reading rests, or is at an end of the range."""
        self.silent[where] = True
        self.at_end[where] = self.random.random() < 0.5

    def readings(self):
        random, load = self.random, self.load.copy()
        gain, rest = self.gain.copy(), self.rest.copy()
        for is_row, lines in self.ties:  # one wire: one load, one gain
            axis, where = (1, 0) if is_row else (2, 1)
            all_frames = (slice(None), *self.line(is_row, lines))
            load[all_frames] = (load * gain)[all_frames].sum(axis, keepdims=True)
            gain[self.line(is_row, lines)] = 1
            rest[self.line(is_row, lines)] = rest[self.line(is_row, lines)].mean(where, keepdims=True)
        signal = self.peak * load * gain
        signal[:, self.silent] = 0
        size = 0.25 * random.uniform(-1, 1) * (0.2 if self.kind in ("pad", "coarse") else 1)
        drift = size * self.peak * (1 - np.exp(-self.time / self.time[-1] * random.uniform(0.5, 4)))
        if self.at_rail:
            drift *= 0
        each = 1 + 0.3 * random.normal(size=gain.shape)
        noise = self.noise * random.normal(size=signal.shape)
        noise += 0.3 * self.noise * random.normal(size=(self.frames, 1, 1)) * (random.random() < 0.3)
        noise += self.extra_noise * random.normal(size=signal.shape)
        counts = rest + signal + drift[:, None, None] * each + noise
        counts[:, self.at_end] = 0
        self.pressed_full = (counts > self.full).mean(0) > 0.4  # so much that its load is not known
        counts[:, self.stuck] = (rest + self.peak * random.uniform(0.3, 0.7, gain.shape))[self.stuck]
        counts = np.clip(self.full - counts if self.falls else counts, 0, self.full).round()
        for frames in self.repeated:
            counts[frames] = counts[frames.start - 1]
        counts[self.lost] = 0
        if not self.absent.any():
            return counts.astype("u1" if self.bits == 8 else "u2")
        value = random.choice([-1, np.nan, 30000]) if self.bits < 16 else -1
        counts[:, self.absent] = value
        return counts.astype("f4" if np.isnan(value) else "i2" if self.bits < 16 else "i4")

    # The score.

    def is_named(self, fault, report):
        """Whether a report names a planted fault, with its places."""
        found = [each for each in report["findings"]
                 if re.search(NAMES[fault], f"{each['fault']} {each['text'] if 'frames' in fault else ''}")]
        if "frames" in fault:
            return bool(found)
        if "shorted" in fault:
            return any(each["lines"] == self.planted[fault] for each in found)
        sensels = self.named_sensels(found)
        if self.kind == "coarse" and "dead" in fault:  # nobody knows whether it was pressed
            sensels |= {tuple(place) for place in report["untouched"]}
        wanted = self.sensels_of(fault)
        return len(wanted & sensels) >= 0.9 * len(wanted)

    def sensels_of(self, fault):
        places = self.planted[fault]
        if "row" in fault or "column" in fault:
            mask = np.zeros((self.rows, self.cols), bool)
            mask[self.line("row" in fault, places)] = True
            places = np.argwhere(mask & ~self.absent)
        return {(int(row), int(col)) for row, col in places}

    def named_sensels(self, findings):
        named = np.zeros((self.rows, self.cols), bool)
        for each in findings:
            for row, col in each.get("sensels", []):
                named[row, col] = True
            if each["fault"] in ("dead row", "dead column"):
                named[self.line("row" in each["fault"], each["lines"])] = True
        return {(int(row), int(col)) for row, col in np.argwhere(named)}

    def accusations(self, report):
        """The findings that accuse what is sound."""
        guilty = {(int(row), int(col)) for row, col in np.argwhere(self.absent | self.pressed_full)}
        for fault in self.planted:
            guilty |= self.sensels_of(fault) if "frames" not in fault else set()
        wrong = []
        for each in report["findings"]:
            sensels = self.named_sensels([each])
            names = [fault for fault in self.planted
                     if re.search(NAMES[fault], f"{each['fault']} {each['text'] if 'frames' in fault else ''}")]
            if (sensels and not sensels <= guilty) or (not sensels and not names):
                wrong.append(each["text"])
        return wrong


def all_arrays(seed=0, step=1):
    for kind, count in KINDS.items():
        for number in range(seed % step, count, step):
            yield Array(kind, number, seed)


def score(arrays, folder, say=lambda line: None):
    """Counts, and a line for everything that is wrong."""
    from command import run_json
    count, wrong = Counter(), []
    for array in arrays:
        path = Path(folder) / "array.npy"
        np.save(path, array.readings())
        lines = []
        try:
            report = run_json("doctor", path, "--rate", array.rate, "-q")
        except AssertionError as error:
            report = {"polarity": str(error).splitlines()[-1], "findings": [], "untouched": []}
        count["arrays"] += 1
        if report["polarity"] != ("falls" if array.falls else "rises"):
            count["reversed"] += 1
            lines.append(f"polarity {report['polarity']}, not {'falls' if array.falls else 'rises'}")
        for fault, places in array.planted.items():
            count["planted"] += 1
            if array.is_named(fault, report):
                count["found"] += 1
            else:
                lines.append(f"{fault} not found: {str(places)[:60]}")
        accused = array.accusations(report)
        count["sound"] += not array.planted
        count["sound accused"] += bool(accused) and not array.planted
        count["faulty accused"] += bool(accused) and bool(array.planted)
        lines += [f"accused: {text[:110]}" for text in accused]
        wrong += [f"{array.name}: {line}" for line in lines]
        for line in lines:
            say(f"{array.name}: {line}")
    return count, wrong


PARSER = argparse.ArgumentParser(description=__doc__)
PARSER.add_argument("array", nargs="*", help="kind and number of one array that is written")
PARSER.add_argument("--all", action="store_true", help="all arrays; else every third")
PARSER.add_argument("--seed", type=int, default=0)
PARSER.add_argument("-o", "--output", default="array.npy")
ARGUMENTS = PARSER.parse_args()


class DoctorArraysTest(unittest.TestCase):
    step = 3

    def test_polarity_faults_and_sound_arrays(self):
        with tempfile.TemporaryDirectory() as folder:
            count, wrong = score(all_arrays(ARGUMENTS.seed, 1 if ARGUMENTS.all else self.step), folder)
        message = "\n".join([str(dict(count)), *wrong])
        self.assertEqual(count["reversed"], 0, message)
        self.assertGreaterEqual(count["found"], 0.95 * count["planted"], message)
        self.assertLessEqual(count["sound accused"], 0.02 * count["sound"], message)


def main():
    if len(sys.argv) > 1 and sys.argv[1] in KINDS:
        array = Array(sys.argv[1], int(sys.argv[2]), ARGUMENTS.seed)
        np.save(ARGUMENTS.output, array.readings())
        print(f"{ARGUMENTS.output}: {array.frames} frames of {array.rows} x {array.cols} at {array.rate} Hz, "
              f"{array.bits} bits, {'falls' if array.falls else 'rises'}, noise {array.noise:.2f}, "
              f"peak {array.peak:.0f}; planted: {array.planted}")
        return
    unittest.main(argv=sys.argv[:1])


if __name__ == "__main__":
    main()
