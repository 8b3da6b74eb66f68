"""`pillarfield doctor`: faults of simulated pads are found, and sound pads are accused of nothing."""

import json
import struct
import subprocess
import unittest
import zlib

import h5py
import numpy as np

from command import PROGRAM, SCENES, CommandTest, run, run_json

ROWS, COLS, RATE_HZ = 16, 32, 100


def shape_of(lines, centres, width):
    """A bell along an axis, [frame, line]."""
    return np.exp(-((np.arange(lines) - np.asarray(centres)[:, None]) / width) ** 2 / 2)


class Pad:
    """Frames of a pad of bare sensels: a load of 0 to 1, and what the wires make of it."""

    def __init__(self, seed, seconds=12):
        self.random = np.random.default_rng(seed)
        self.frames = int(seconds * RATE_HZ)
        self.time = np.arange(self.frames) / RATE_HZ
        self.load = np.zeros((self.frames, ROWS, COLS))
        self.peak = self.random.uniform(60, 120)
        self.noise = self.random.uniform(0.5, 1.5)
        self.base = self.random.uniform(10, 30)
        self.gain = np.clip(1 + self.random.uniform(0.05, 0.2) * self.random.normal(size=(ROWS, COLS)), 0.4, 2)
        self.offset = self.base * (1 + 0.1 * self.random.normal(size=(ROWS, COLS)))

    def sweep(self):
        """A finger along one row after the other, with moments without load."""
        turn = np.linspace(0, self.random.integers(9, 12), self.frames)
        across = np.abs((turn % 2) - 1) * (COLS - 1)
        down = np.linspace(0, ROWS - 1, self.frames) + 0.3 * np.sin(3 * self.time)
        width = self.random.uniform(0.8, 1.5)
        force = (0.8 + 0.2 * np.sin(2 * self.time)) * (np.sin(1.1 * self.time - 0.5) > -0.9)
        bell = shape_of(ROWS, down, width)[:, :, None] * shape_of(COLS, across, width)[:, None, :]
        ragged = 1 + 0.15 * self.random.normal(size=bell.shape)
        self.load += force[:, None, None] * bell * ragged * self.gain
        return self

    def press(self, presses, width):
        """Single presses, one after the other."""
        for index in range(presses):
            began, ended = (index + np.array([0.2, 0.8])) * self.frames / presses
            row, col = self.random.uniform(0, [ROWS - 1, COLS - 1])
            bell = shape_of(ROWS, [row], width)[0][:, None] * shape_of(COLS, [col], width)[0]
            bell *= 1 + 0.15 * self.random.normal(size=bell.shape)
            self.load[int(began):int(ended)] += bell * self.gain
        return self

    def lie(self):
        """A body: a flat contact over a third of the pad that breathes and turns once."""
        rows, cols = np.mgrid[0:ROWS, 0:COLS]
        for began, ended in ((0.1, 0.5), (0.6, 1)):
            row, col = self.random.uniform([5, 10], [10, 22])
            inside = ((rows - row) / 5) ** 2 + ((cols - col) / 10) ** 2 < 1
            body = inside * (0.6 + 0.1 * self.random.normal(size=inside.shape)) * self.gain
            frames = slice(int(began * self.frames), int(ended * self.frames))
            self.load[frames] += body * (1 + 0.1 * np.sin(self.time[frames]))[:, None, None]
        return self

    def readings(self, falling=False, drift=0, dtype="u1"):
        """Frames, [frame, row, col]."""
        counts = self.peak * np.maximum(self.load, 0)
        counts = 200 - counts if falling else self.offset + counts
        counts += drift * self.time[:, None, None] / 60 + self.noise * self.random.normal(size=counts.shape)
        return np.clip(np.round(counts), 0, 255).astype(dtype)


def faults_of(report, *kinds):
    return [finding for finding in report["findings"] if finding["fault"] in kinds]


class DoctorTest(CommandTest):
    def examine(self, readings, *options):
        path = self.folder / "pad.npy"
        np.save(path, readings)
        return run_json("doctor", path, "--rate", RATE_HZ, *options)

    def assert_sound(self, report):
        self.assertEqual([finding["text"] for finding in report["findings"]], [])

    def test_sound_pads_are_accused_of_nothing(self):
        for seed in range(5):
            for name, pad in (("finger", Pad(seed).sweep()), ("presses", Pad(seed).press(5, 1.2)),
                              ("wide presses", Pad(seed).press(3, 3)), ("body", Pad(seed).lie()),
                              ("idle", Pad(seed, 5))):
                falling, dtype = seed % 3 == 1, ("u1", "u2")[seed % 2]
                with self.subTest(name, seed=seed, falling=falling):
                    report = self.examine(pad.readings(falling, 10 * (seed == 2), dtype))
                    self.assert_sound(report)
                    if name in ("idle", "presses"):
                        self.assertGreater(len(report["untouched"]), 100)
                    if name == "finger":
                        self.assertTrue(report["row_order_tested"] and report["column_order_tested"])
                        self.assertEqual(report["layout"], "sensels")

    def planted(self, seed):
        """For each fault: readings, and a function that says whether a report names it."""
        def pad():
            return Pad(1000 + seed).sweep()
        random = np.random.default_rng(seed)
        row, col = int(random.integers(1, ROWS - 2)), int(random.integers(1, COLS - 2))

        shorted = pad()
        shorted.load[:, row:row + 2] = shorted.load[:, row:row + 2].mean(axis=1, keepdims=True)
        shorted.offset[row + 1] = shorted.offset[row]
        yield "shorted rows", shorted.readings(), lambda report: any(
            finding["lines"] == [row, row + 1] for finding in faults_of(report, "shorted rows"))

        column = pad()
        column.load[:, :, col] = 0
        yield "dead column", column.readings(), lambda report: any(
            finding["lines"] == [col] for finding in faults_of(report, "dead column"))

        dead = pad()
        sensels = sorted(map(tuple, np.argwhere(random.random((ROWS, COLS)) < 0.03).tolist()))
        for place in sensels:
            dead.load[:, place[0], place[1]] = 0
        yield "dead", dead.readings(), lambda report: self.mostly(sensels, report, "dead")

        yield "falling", pad().readings(falling=True), lambda report: report["polarity"] == "falls"

        for axis, name, size in ((1, "row order", ROWS), (2, "column order", COLS)):
            first = int(random.integers(0, size - 5))
            mirrored = np.arange(size)
            mirrored[first:first + 5] = mirrored[first:first + 5][::-1]
            swapped = np.arange(size)
            swapped[[first, first + 4]] = swapped[[first + 4, first]]
            interleaved = np.r_[0:size:2, 1:size:2]
            for order in (mirrored, swapped, interleaved):
                wired = pad().readings()
                yield name, np.take(wired, order, axis), lambda report, name=name, order=order: any(
                    finding["order"] == np.argsort(order).tolist() for finding in faults_of(report, name))

        ghosts = pad()
        ghosts.load = (ghosts.load + 0.05 * ghosts.load.max(1, keepdims=True)
                       + 0.05 * ghosts.load.max(2, keepdims=True))
        yield "crosstalk", ghosts.readings(), lambda report: all(
            any(3 < finding["figure"] < 7 for finding in faults_of(report, name))
            for name in ("row crosstalk", "column crosstalk"))

        drift = float(random.uniform(8, 20))
        yield "drift", pad().readings(drift=drift), lambda report: (
            abs(report["drift_counts_per_minute"]["median"] / drift - 1) < 0.2)

    def mostly(self, sensels, report, name):
        found = [tuple(place) for finding in faults_of(report, name) for place in finding["sensels"]]
        return set(found) <= set(sensels) and len(found) >= 0.9 * len(sensels)

    def test_planted_faults_are_found(self):
        allowed = {"dead": ["dead"], "shorted rows": ["shorted rows"], "dead column": ["dead column"],
                   "row order": ["row order"], "column order": ["column order"],
                   "crosstalk": ["row crosstalk", "column crosstalk"], "falling": [], "drift": []}
        planted, missed = 0, []
        for seed in range(3):
            for name, readings, is_named in self.planted(seed):
                report = self.examine(readings)
                planted += 1
                if not is_named(report):
                    missed.append((name, seed, [finding["text"] for finding in report["findings"]]))
                with self.subTest(name, seed=seed):
                    self.assertLessEqual({finding["fault"] for finding in report["findings"]},
                                         set(allowed[name]))
        self.assertLessEqual(len(missed), 0.05 * planted, missed)

    def test_all_faults_at_once(self):
        pad = Pad(77, 20).sweep()
        pad.load[:, 3:5] = pad.load[:, 3:5].mean(axis=1, keepdims=True)
        pad.load[:, :, 20] = 0
        pad.load[:, 9, 6] = pad.load[:, 11, 27] = 0
        order = np.r_[0:8, 15:7:-1, 16:COLS]
        report = self.examine(pad.readings(falling=True, drift=-10)[:, :, order])
        self.assertEqual(report["polarity"], "falls")
        self.assertEqual([(finding["fault"], finding.get("lines")) for finding in report["findings"]],
                         [("dead", None), ("dead column", [20]), ("shorted rows", [3, 4]),
                          ("column order", list(range(8, 16)))])
        self.assertEqual(report["findings"][0]["sensels"], [[9, 6], [11, 27]])

    def with_all_faults(self, seed):
        """Readings of a pad with eight faults, and for each whether a report names it."""
        pad, random = Pad(seed, (12, 20, 30)[seed % 3]).sweep(), np.random.default_rng(seed)
        row, col, first = (int(random.integers(1, size)) for size in (ROWS - 2, COLS - 2, COLS - 7))
        dead = random.random((ROWS, COLS)) < 0.03
        pad.load[:, dead] = 0
        pad.load[:, row:row + 2] = pad.load[:, row:row + 2].mean(axis=1, keepdims=True)
        pad.offset[row + 1] = pad.offset[row]
        pad.load = (pad.load + 0.05 * pad.load.max(1, keepdims=True) + 0.05 * pad.load.max(2, keepdims=True))
        pad.load[:, :, col] = 0
        order = np.r_[0:first, first + 6:first - 1:-1, first + 7:COLS]
        dead[row:row + 2] = dead[row] & dead[row + 1]
        dead[:, col] = False
        drift = float(random.choice([-1, 1]) * random.uniform(8, 20))

        def found(report):
            lines = {(finding["fault"], *finding.get("lines", [])) for finding in report["findings"]}
            orders = [finding["order"] for finding in faults_of(report, "column order")]
            ghosts = [any(3 < finding["figure"] < 7 for finding in faults_of(report, name))
                      for name in ("row crosstalk", "column crosstalk")]
            places = [(int(a), int(b)) for a, b in np.argwhere(dead[:, order])]
            return [("shorted rows", row, row + 1) in lines,
                    ("dead column", order.tolist().index(col)) in lines, self.mostly(places, report, "dead"),
                    report["polarity"] == "falls", orders == [np.argsort(order).tolist()], *ghosts,
                    abs(report["drift_counts_per_minute"]["median"] / drift - 1) < 0.2]
        return pad.readings(falling=True, drift=drift)[:, :, order], found

    def test_pads_with_all_faults(self):
        found = []
        for seed in range(2000, 2012):
            readings, found_in = self.with_all_faults(seed)
            found += found_in(self.examine(readings))
        self.assertEqual(len(found), 96)
        self.assertGreaterEqual(sum(found), 0.95 * len(found))

    def test_absent_stuck_and_saturated_sensels(self):
        readings = Pad(5).sweep().readings()
        readings[:, 2, 3:5] = 0
        readings[:, 9, 9] = 70
        readings[:, 12, 30] = 255
        found = {finding["fault"]: finding for finding in self.examine(readings)["findings"]}
        self.assertEqual({name: finding["sensels"] for name, finding in found.items()},
                         {"absent": [[2, 3], [2, 4]], "stuck": [[9, 9]], "saturated": [[12, 30]]})
        self.assertEqual((found["stuck"]["figure"], found["saturated"]["figure"]), (70, 255))
        floats = readings.astype("f4")
        floats[:, 2, 3:5] = np.nan
        self.assertEqual(self.examine(floats)["findings"][0]["sensels"], [[2, 3], [2, 4]])

    def test_times(self):
        path, readings = self.folder / "pad.h5", Pad(6, 5).readings()
        times = np.delete(np.arange(len(readings) + 7) / RATE_HZ, np.r_[100:105, 300:302])
        with h5py.File(path, "w") as file:
            file["raw"], file["time"] = readings, times
        report = run_json("doctor", path, "--dataset", "raw", "--times", "time")
        self.assertAlmostEqual(report["rate_hz"], RATE_HZ)
        self.assertLess(report["jitter_ms"], 1e-6)
        self.assertEqual((report["gap_count"], report["lost"]), (2, 7))
        self.assertEqual([gap["frame"] for gap in report["gaps"]], [100, 295])
        self.assertAlmostEqual(report["gaps"][0]["length_s"], 6 / RATE_HZ)
        np.save(self.folder / "pad.npy", Pad(6).sweep().readings())
        report = run_json("doctor", self.folder / "pad.npy")
        self.assertIsNone(report["rate_hz"])
        self.assertIn("--rate HZ", report["next"])
        self.assert_fails("doctor", self.folder / "pad.npy", "--axes", "columns,rows", names=["2 axes"])
        np.save(self.folder / "pad.npy", np.full((20, 4, 5), np.nan, "f4"))
        self.assert_fails("doctor", self.folder / "pad.npy", "-q", names=["all of its values are NaN"])
        np.save(self.folder / "pad.npy", readings[:9])
        self.assert_fails("doctor", self.folder / "pad.npy", "-q", names=["has 9 frames", "at least 10"])

    def test_more_frames_than_are_kept(self):
        pad = Pad(8, 90).sweep()
        pad.load[:, :, 11] = 0
        report = self.examine(pad.readings())
        self.assertEqual(report["frames"], 9000)
        self.assertLessEqual(report["frames_looked_at"], 4096)
        self.assertEqual([finding["fault"] for finding in report["findings"]], ["dead column"])

    def test_the_picture_shows_what_was_found(self):
        pad = Pad(9).sweep()
        pad.load[:, :, 7] = 0
        readings = pad.readings()
        readings[:, 4, 20] = 0
        picture = self.folder / "pad.png"
        self.examine(readings, "--png", picture)
        pixels = pixels_of(picture)
        top, left, side = 80, 44, 37
        bottom, right, paper, ink, red = top + ROWS * side, left + COLS * side, [24] * 3, [225] * 3, [255, 40, 40]
        absent = pixels[top + 4 * side:top + 5 * side, left + 20 * side:left + 21 * side]
        self.assertEqual((absent[0, side // 2].tolist(), absent[side // 2, side // 2].tolist()), (paper, [90, 90, 100]))
        column = left + 7 * side + side // 2
        for row in (top - 5, bottom + 5):
            self.assertEqual(pixels[row, column].tolist(), red)
        self.assertLess(pixels[top + side // 2, column].max(), 60)
        grey = pixels[top:top + 100, right + 25, 0]  # the scale
        self.assertEqual((grey[0], grey[-1], (np.diff(grey) <= 0).all()), (255, 0, True))
        for what, area in {"title": pixels[:40], "columns": pixels[45:70, left:right], "rows": pixels[top:bottom, :left],
                           "scale": pixels[top:top + 100, right + 45:], "legend": pixels[top + 120:, right + 45:]}.items():
            self.assertGreater((area == ink).all(2).sum(), 200, what)
        self.assertTrue((pixels[top + 120:, right:right + 45] == red).all(2).any())
        self.assert_fails("doctor", self.folder / "pad.npy", "--png", self.folder / "pad.npy",
                          names=["pad.npy"])

    def test_pillars_are_told_from_sensels(self):
        for scene in ("sliding", "new_skin_rolled"):
            run("simulate", SCENES / f"{scene}.toml", "--uncalibrated", "-o", self.folder / "skin.h5", "--overwrite")
            report = run_json("doctor", self.folder / "skin.h5")
            self.assertEqual(report["layout"], "pillars")
            self.assert_sound(report)

    def test_the_next_command_works(self):
        for pad, verb in ((Pad(10).sweep(), "solve"), (Pad(11, 5), "calibrate")):
            following = self.examine(pad.readings())["next"].split()
            self.assertEqual(following[:2], ["pillarfield", verb])
            run(*following[1:], cwd=self.folder)

    def test_live_frames(self):
        readings = Pad(12, 3).sweep().readings()
        packets = b"".join(
            struct.pack("<4sHHIIQQQ6I", b"PFR1", 0, 1, ROWS, COLS, 0, number, number * 10_000_000,
                        0, 1, 0, 0, 0, frame.size) + frame.tobytes()
            for number, frame in enumerate(readings))
        result = subprocess.run([PROGRAM, "doctor", "-", "--seconds", "60", "--json"], input=packets,
                                capture_output=True, check=True, timeout=600)
        report = json.loads(result.stdout)
        self.assertEqual((report["frames"], report["rows"], report["cols"]), (len(readings), ROWS, COLS))
        self.assertEqual(round(report["rate_hz"]), RATE_HZ)
        self.assertEqual(report["polarity"], "rises")


def pixels_of(path):
    """The pixels of a PNG of 8-bit RGB, [row, col, channel]."""
    data, at, compressed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        compressed += body if kind == b"IDAT" else b""
        at += size + 12
    lines = np.frombuffer(zlib.decompress(compressed), "u1").reshape(height, 1 + 3 * width)
    pixels = np.zeros((height + 1, width, 3), "u1")
    for row in range(height):
        line, above = lines[row, 1:].reshape(width, 3), pixels[row]
        unfiltered = {0: lambda line, _: line, 1: lambda line, _: np.cumsum(line, 0, "u1"),
                      2: lambda line, above: line + above}.get(lines[row, 0])
        pixels[row + 1] = unfiltered(line, above) if unfiltered else by_neighbours(line, above, lines[row, 0])
    return pixels[1:].astype(int)


def by_neighbours(line, above, method):
    """A line of a PNG that was filtered by the average (3) or by Paeth's method (4)."""
    pixels = []
    left = corner = [0, 0, 0]
    for given, up in zip(line.tolist(), above.tolist()):
        if method == 3:
            expected = [(a + b) // 2 for a, b in zip(left, up)]
        else:
            expected = [min((a, b, c), key=lambda value, near=a + b - c: abs(near - value))
                        for a, b, c in zip(left, up, corner)]
        left, corner = [(a + b) % 256 for a, b in zip(given, expected)], up
        pixels.append(left)
    return pixels


if __name__ == "__main__":
    unittest.main()
