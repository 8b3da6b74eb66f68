"""`pillarfield doctor`: what it prints, the next command, live frames; rates: tests/python/doctor_arrays_test.py."""

import json
import struct
import subprocess
import unittest

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

    def readings(self, falling=False, drift=0, dtype="u1"):
        """Frames, [frame, row, col]."""
        counts = self.peak * np.maximum(self.load, 0)
        counts = 200 - counts if falling else self.offset + counts
        counts += drift * self.time[:, None, None] / 60 + self.noise * self.random.normal(size=counts.shape)
        return np.clip(np.round(counts), 0, 255).astype(dtype)


class DoctorTest(CommandTest):
    def examine(self, readings, *options):
        path = self.folder / "pad.npy"
        np.save(path, readings)
        return run_json("doctor", path, "--rate", RATE_HZ, *options)

    def test_all_faults_at_once(self):
        pad = Pad(77, 20).sweep()
        pad.load[:, 3:5] = pad.load[:, 3:5].mean(axis=1, keepdims=True)
        pad.load[:, :, 20] = 0
        pad.load[:, 9, 6] = pad.load[:, 11, 27] = 0
        readings = pad.readings(falling=True, drift=-10)
        readings[:, 7, 15] = 70
        report = self.examine(readings)
        self.assertEqual((report["polarity"], report["row_order_tested"], report["column_order_tested"]),
                         ("falls", True, True))
        self.assertEqual([(finding["fault"], finding.get("sensels"), finding.get("lines"))
                          for finding in report["findings"]],
                         [("dead", [[9, 6], [11, 27]], None), ("stuck", [[7, 15]], None),
                          ("dead column", None, [20]), ("shorted rows", None, [3, 4])])
        self.assertEqual((report["findings"][0]["count"], report["findings"][1]["figure"]), (2, 70))
        self.assertEqual(report["findings"][1]["text"],
                         "Stuck: 1 sensel, constant (median 70 counts) while the others vary, at (7, 15)")

    def test_drift_takes_half_a_minute_of_rest(self):
        for seconds, is_told in ((20, False), (40, True)):
            drift = self.examine(Pad(3, seconds).readings(drift=30))["drift_counts_per_minute"]
            self.assertEqual(drift is not None, is_told)
        self.assertLess(abs(drift["median"] - 30), 3)

    def test_what_nothing_tested_is_named(self):
        """One touch of one sensel on a sound array accuses nobody; sensels that never differ count in no sum."""
        readings = np.random.default_rng(2).normal(30, 0.8, (200, 8, 8)).round()
        readings[80:120, 3, 4] += 140
        readings[:, :, 7] = 0
        np.save(self.folder / "pad.npy", readings.astype("u1"))
        text = run("doctor", self.folder / "pad.npy").stdout
        self.assertIn("1 of 56 sensels; not tested, touch here: (0, 0)", text)
        self.assertIn("8 more never differ", text)
        self.assertIn("Nothing wrong was found", text)

    def test_frames_that_are_no_readings(self):
        """They are named, do not spoil the others, and the next command works."""
        pad = Pad(21).sweep().readings()
        pad[[300, 301, 700]] = 0
        report = self.examine(pad)
        self.assertEqual(([finding["fault"] for finding in report["findings"]], report["polarity"]),
                         (["missing frames"], "rises"))
        run(*report["next"].split()[1:], cwd=self.folder)
        report = self.examine(np.full((50, 4, 4), 7, "u1"))
        self.assertEqual((report["findings"][0]["fault"], report["idle_counts"], report["next"]), ("frozen", 7, ""))

    def test_absent_cells(self):
        """A value that stands for "no sensel" is named, and the next command solves the others."""
        pad = Pad(22)
        pad.load[300:, 4:9, 5:12] = 1
        for value, falling, dtype in ((-1, True, "i2"), (30000, False, "i4"), (np.nan, False, "f4")):
            readings = pad.readings(falling).astype(dtype)
            readings[:, :6, -3:] = value
            with self.subTest(value=value):
                report = self.examine(readings)
                self.assertEqual([(each["fault"], each["count"]) for each in report["findings"]], [("absent", 18)])
                self.assertEqual(report["idle_frames"], 300)
                self.assertEqual("--falling" in report["next"], falling)
                run(*report["next"].split()[1:], cwd=self.folder)
                with h5py.File(self.folder / "forces.h5") as file:
                    normal = file["force/normal"][()]
                self.assertLess(np.abs(normal[100]).sum(), 0.05 * normal[-1].sum())
                (self.folder / "forces.h5").unlink()

    def test_solve_warns_of_a_dead_column(self):
        pad = Pad(5).sweep()
        pad.load[:, :, 20] *= 0
        pad.load[:50] = 0
        np.save(self.folder / "pad.npy", pad.readings())
        solved = run("solve", self.folder / "pad.npy", "--rate", RATE_HZ, "--tare-frames", 50, "--counts-per-newton",
                     40, "--pitch-mm", 5, "-o", self.folder / "pad.h5")
        self.assertIn("Dead: column 20 does not respond", solved.stderr)

    def test_a_tare_of_equal_frames_is_refused(self):
        np.save(self.folder / "pad.npy", np.full((50, 8, 8), 7, "u1"))
        refused = run("calibrate", "tare", self.folder / "pad.npy", "-o", self.folder / "tared.h5", "-q",
                      expect=1).stderr
        self.assertIn("50 frames are equal", refused.splitlines()[-1])

    def test_times(self):
        path, readings = self.folder / "pad.h5", Pad(6, 5).readings()
        times = np.delete(np.arange(len(readings) + 7) / RATE_HZ, np.r_[100:105, 300:302])
        with h5py.File(path, "w") as file:
            file["raw"], file["time"] = readings, times
        report = run_json("doctor", path, "--dataset", "raw", "--times", "time")
        self.assertAlmostEqual(report["rate_hz"], RATE_HZ)
        self.assertLess(report["jitter_ms"], 1e-6)
        self.assertEqual((report["gap_count"], report["lost"], [gap["frame"] for gap in report["gaps"]]),
                         (2, 7, [100, 295]))
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


if __name__ == "__main__":
    unittest.main()
