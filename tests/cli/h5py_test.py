"""Recordings of h5py, solved by the command and by independent NumPy code."""

import unittest

import h5py
import numpy as np

from command import BALL, CommandTest, run
from direct_oracle import sensels_of, solve


def random_frames(random, frames, rows, cols, dtype):
    """Readings of all regions: a third inactive; float32 also negative and missing ones."""
    readings = random.uniform(0, 255, (frames, rows, cols))
    readings[random.random(readings.shape) < 0.33] = 0
    if dtype == np.float32:
        readings[random.random(readings.shape) < 0.05] *= -1
        readings[random.random(readings.shape) < 0.03] = np.nan
    return readings.astype(dtype)


def write_recording(path, raw, threshold, counts_per_newton):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "pillarfield-recording"
        file.attrs["version"] = 1
        file["/frames/raw"] = raw
        file["/frames/time"] = np.arange(len(raw)) / 100.0
        skin = file.create_group("skin")
        skin.attrs["sensel_pitch_mm"] = 0.632
        skin.attrs["counts_per_newton"] = counts_per_newton
        skin.attrs["threshold_counts"] = threshold


class Versions(CommandTest):
    """Chunks may be absent from version 2 on; earlier files without them are damaged."""

    def setUp(self):
        super().setUp()
        scene = self.folder / "ball.toml"
        scene.write_text(BALL.replace("[20, 20]", "[60, 60]"), encoding="utf-8")
        self.recording, self.forces = self.folder / "rec.h5", self.folder / "forces.h5"
        run("simulate", scene, "-o", self.recording)
        run("solve", self.recording, "-o", self.forces)

    def table(self):
        return run("compare", self.forces, self.recording).stdout

    def test_new_files_say_that_chunks_may_be_absent(self):
        for file in (self.recording, self.forces):
            with h5py.File(file) as opened:
                self.assertEqual(opened.attrs["version"], 2, file)

    def test_dense_files_of_version_1_are_read(self):
        before = self.table()
        for path, group in ((self.recording, "truth"), (self.forces, "force")):
            with h5py.File(path, "r+") as file:
                file.attrs["version"] = 1
                for name, plane in list(file[group].items()):
                    values = plane[()]
                    del file[group][name]
                    file[group][name] = values
            self.assertEqual(self.table(), before)

    def test_absent_chunks_of_version_1_and_later_versions_are_refused(self):
        for path in (self.recording, self.forces):
            for version, words in ((1, "are stored"), (4, "its version is 4; this program reads version 1 to 3")):
                with h5py.File(path, "r+") as file:
                    file.attrs["version"] = version
                self.assert_fails("compare", self.forces, self.recording, names=[path.name, words])
            with h5py.File(path, "r+") as file:
                file.attrs["version"] = 2
        self.table()


class RecordingsOfH5py(CommandTest):
    def check(self, seed, dtype):
        random = np.random.default_rng(seed)
        rows, cols = (int(n) for n in random.integers(2, 90, 2))
        threshold = float(random.uniform(0, 20))
        counts_per_newton = float(random.uniform(5, 2000))
        raw = random_frames(random, 3, rows, cols, dtype)
        recording, output = self.folder / "random.h5", self.folder / "forces.h5"
        write_recording(recording, raw, threshold, counts_per_newton)
        run("solve", recording, "-o", output, "--estimator", "direct")
        with h5py.File(output) as file:
            self.assertEqual(file.attrs["format"].decode(), "pillarfield-forces")
            planes = ["shear_x", "shear_y", "normal"]
            forces = np.stack([file["/force"][plane][:] for plane in planes], axis=-1)
            status = file["/force/status"][:]
        self.assertEqual(forces.shape, (3, rows // 2, cols // 2, 3))
        for index, frame in enumerate(raw):
            self.compare(frame, forces[index], status[index], threshold, counts_per_newton)

    def compare(self, frame, forces, status, threshold, counts_per_newton):
        # The program compares in single precision.
        expected, bits, ambiguous = solve(frame, np.float32(threshold), counts_per_newton)
        missing = np.isnan(sensels_of(frame)).any(axis=-1)
        usable = sum((bits >> n) & 1 for n in range(4))
        opposite = (bits == 5) | (bits == 10)
        np.testing.assert_array_equal(status & 15, bits)
        np.testing.assert_array_equal((status & 64) != 0, missing | opposite)
        # With a missing sensel, three usable ones must determine the force.
        known = ~missing | (usable >= 3)
        np.testing.assert_array_equal((status[~missing] & 16) != 0, ambiguous[~missing])
        self.assertFalse((status[missing & (usable == 3)] & 16).any())
        self.assertTrue(np.isfinite(forces).all())
        size = np.linalg.norm(expected, axis=-1, keepdims=True)
        error = np.abs(forces - expected) / np.where(size > 0, size, 1)
        self.assertLess(error[known].max(initial=0), 8 * np.finfo(np.float32).eps)

    def test_random_frames(self):
        for seed, dtype in enumerate(6 * [np.uint8] + 3 * [np.uint16] + 6 * [np.float32]):
            with self.subTest(seed=seed, dtype=dtype):
                self.check(seed, dtype)

    def test_outputs_agree_with_each_other(self):
        random = np.random.default_rng(1)
        raw = random_frames(random, 4, 12, 14, np.uint8)
        recording = self.folder / "random.h5"
        write_recording(recording, raw, 5, 320)
        for ending in ("h5", "npy", "csv"):
            run("solve", recording, "-o", self.folder / f"forces.{ending}", "--outputs",
                "forces,angles,uncertainty,pressure", "--noise", "1.5")
        array = np.load(self.folder / "forces.npy")
        table = np.genfromtxt(self.folder / "forces.csv", delimiter=",", names=True)
        places = tuple(table[name].astype(int) for name in ("frame", "row", "col"))
        columns = {"shear_x": "shear_x_n", "shear_y": "shear_y_n", "normal": "normal_n",
                   "status": "status", "magnitude": "magnitude_n", "theta": "theta_rad",
                   "phi": "phi_rad", "pressure": "pressure_kpa"}
        forces, angles = ("shear_x", "shear_y", "normal"), ("theta", "phi")
        uncertainty = dict.fromkeys(forces, "n")
        for name in (*forces, "magnitude", *angles):
            for end in ("low", "high"):
                uncertainty[f"{name}_{end}"] = "rad" if name in angles else "n"
        with h5py.File(self.folder / "forces.h5") as file:
            for plane, column in columns.items():
                expected = file["/force"][plane][:]
                np.testing.assert_array_equal(array[plane], expected)
                np.testing.assert_array_equal(table[column].astype(np.float32), expected[places])
            for plane, unit in uncertainty.items():
                expected = file["/uncertainty"][plane][:]
                name = f"uncertainty_{plane}"
                np.testing.assert_array_equal(array[name], expected)
                np.testing.assert_array_equal(table[f"{name}_{unit}"].astype(np.float32),
                                              expected[places])
            pitch_mm = file.attrs["pillar_pitch_mm"]
            np.testing.assert_allclose(file["/force/pressure"][:], file["/force/normal"][:] * 1e3 / pitch_mm**2,
                                       rtol=1e-6)
            self.assertEqual(file["/force/pressure"].attrs["unit"].decode(), "kPa")
            status = file["/force/status"][:]
            self.assertEqual(file.attrs["estimator"].decode(), "contact")
        self.assertEqual(len(table), np.count_nonzero(status))


if __name__ == "__main__":
    unittest.main()
