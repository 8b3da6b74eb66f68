"""Versions of files, and outputs of a recording of h5py that agree with each other."""

import unittest

import h5py
import numpy as np

from command import BALL, CommandTest, run


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
    def test_outputs_agree_with_each_other(self):
        random = np.random.default_rng(1)
        raw = (random.uniform(0, 255, (4, 12, 14)) * (random.random((4, 12, 14)) > 0.33)).astype(np.uint8)
        recording = self.folder / "random.h5"
        with h5py.File(recording, "w") as file:
            file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
            file["frames/raw"], file["frames/time"] = raw, np.arange(4) / 100
            file.create_group("skin").attrs["threshold_counts"] = 5
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
            np.testing.assert_array_equal(table["time_s"], file["/force/time"][:][places[0]])
            self.assertEqual(file.attrs["estimator"].decode(), "contact")
        self.assertEqual(len(table), np.count_nonzero(status))


if __name__ == "__main__":
    unittest.main()
