"""Files, scenes, pictures, points."""

import io
import os
import pathlib
import unittest

import h5py
import numpy as np
from PIL import Image

import pillarfield as pf
import skins

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def pixels_of(png):
    return np.asarray(Image.open(io.BytesIO(png)))


class Contacts(unittest.TestCase):
    def test_contacts_have_the_columns_of_the_file(self):
        options = {"estimator": "contact", "noise_counts": 0.5}
        pf.save_recording(WORK / "touch.h5", pf.simulate(skins.scene()), overwrite=True)
        pf.solve_to_file(WORK / "touch.h5", WORK / "contacts.h5", contacts=True, overwrite=True, **options)
        frames = pf.solve(WORK / "touch.h5", contacts=True, **options).contacts
        with h5py.File(WORK / "contacts.h5") as file:
            for group, rows in (("contacts/patch", [each.total for each in frames]),
                                ("contacts", [contact for each in frames for contact in each])):
                self.assertGreater(len(rows), 5)
                compared = [name for name, column in file[group].items()
                            if hasattr(rows[0], name) and "words" not in column.attrs]
                self.assertGreater(len(compared), 15)
                for name in compared:
                    none = 0 if name == "parent" else np.nan
                    found = [none if getattr(row, name) is None else getattr(row, name) for row in rows]
                    np.testing.assert_allclose(found, file[group][name][()], rtol=1e-12, err_msg=name)


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation = pf.simulate(skins.scene())
        cls.forces = pf.solve(cls.simulation, outputs=["uncertainty"], contacts=True)
        pf.save_recording(WORK / "press.h5", cls.simulation, overwrite=True)
        cls.forces.save(WORK / "forces.h5", overwrite=True)

    def test_intervals(self):
        """Those of the file, kept when saved again."""
        ends = self.forces.intervals
        again = pf.open(WORK / "forces.h5")[:]
        again.copy()[1:].save(WORK / "again.h5", overwrite=True)
        for path, first in (("forces.h5", 0), ("again.h5", 1)):
            with h5py.File(WORK / path) as file:
                for name in ("shear_x_low", "shear_x_high", "shear_y_low", "shear_y_high", "normal_low", "normal_high"):
                    np.testing.assert_array_equal(file[f"uncertainty/{name}"], getattr(ends, name)[first:])
        np.testing.assert_array_equal(self.forces[6].intervals.normal_high, ends.normal_high[6])
        with self.assertRaisesRegex(pf.Error, "uncertainty"):
            pf.ForceField(self.forces.shear_x, self.forces.shear_y, self.forces.normal).intervals

    def test_ranges(self):
        recording, output = WORK / "press.h5", WORK / "range.h5"
        forces = pf.solve_to_file(recording, output, first=3, end=7)[:]
        np.testing.assert_array_equal(forces.normal, pf.solve(recording).normal[3:7])
        with self.assertRaisesRegex(pf.Error, "give frames within 0:"):
            pf.solve_to_file(recording, output, first=3, end=1000)

    def test_recording(self):
        recording, frames = pf.open(WORK / "press.h5"), self.simulation.frames
        self.assertIsInstance(recording, pf.Recording)
        self.assertEqual((recording.shape, recording.dtype), (frames.shape, frames.dtype))
        for index in (0, -1, 5, slice(2, 9, 3), slice(None, None, -1), slice(5, 5), slice(-3, None)):
            self.assertTrue(np.array_equal(recording[index], frames[index]), index)
        self.assertTrue(np.array_equal(recording, frames))
        self.assertTrue(np.array_equal([frame for frame in recording], frames))
        self.assertTrue(np.allclose(recording.times, self.simulation.times))
        for index in (12, -13):
            with self.assertRaises(IndexError):
                recording[index]
        with self.assertRaises(pf.Error):
            recording.truth()
        with self.assertRaises(pf.Error):
            pf.save_recording(WORK / "press.h5", self.simulation)  # Recordings are not replaced.

    def test_a_file_recorded_anew_takes_what_is_given(self):
        tare = np.full((8, 12), 12.0)
        np.save(WORK / "plain.npy", np.full((5, 8, 12), 40, np.uint8))
        calibration = pf.Calibration(8, 12, tare=tare)
        skin = pf.Skin(8, 12, counts_per_newton=50, full_scale_counts=200)
        for frames in (WORK / "plain.npy", pf.Recording(WORK / "plain.npy", rate_hz=10)):
            pf.save_recording(WORK / "anew.h5", frames, skin=skin, calibration=calibration,
                              times=[1, 2, 3, 4, 6], overwrite=True)
            anew = pf.open(WORK / "anew.h5")
            self.assertEqual((anew.skin.counts_per_newton, anew.skin.full_scale_counts), (50, 200))
            np.testing.assert_array_equal(anew.calibration.tare, tare)
            np.testing.assert_array_equal(anew.times, [1, 2, 3, 4, 6])
        self.assertEqual(len(anew[::100]), 1)

    def test_forces(self):
        file = pf.open(WORK / "forces.h5")
        self.assertIsInstance(file, pf.ForceFile)
        for index in (0, -1, slice(2, 9, 3), slice(None)):
            read, expected = file[index], self.forces[index]
            for name in ("shear_x", "normal", "status"):
                self.assertTrue(np.array_equal(getattr(read, name), getattr(expected, name)))
            self.assertTrue(np.array_equal(read.uncertainty.phi_low, expected.uncertainty.phi_low))
            self.assertTrue(np.array_equal(read.times, expected.times))
        for read, expected in zip(file[:].contacts, self.forces.contacts, strict=True):
            self.assertEqual(read.total.normal_n, expected.total.normal_n)
            self.assertEqual([(contact.track_id, contact.normal_n) for contact in read],
                             [(contact.track_id, contact.normal_n) for contact in expected])
        self.assertTrue(any(file[:].contacts))
        file[3].save(WORK / "frame.h5", overwrite=True)
        self.assertEqual(pf.open(WORK / "frame.h5")[0].contacts[0].track_id, self.forces.contacts[3][0].track_id)
        self.forces.save(WORK / "forces.csv", overwrite=True)
        with self.assertRaises(pf.Error):
            self.forces.save(WORK / "forces.xyz")

    def test_calibration(self):
        tare = np.arange(24.0).reshape(4, 6)
        pf.Calibration(4, 6, tare=tare, gain=np.ones((4, 6)), counts_per_newton=100).save(
            WORK / "calibration.h5", overwrite=True)
        read = pf.open(WORK / "calibration.h5")
        self.assertTrue(np.array_equal(read.tare, tare))
        self.assertEqual((read.counts_per_newton, read.noise), (100, None))
        for wrong in ({"tare": tare[:3]}, {"gain": 0 * tare}, {"tare": np.full((4, 6), np.inf)}):
            with self.assertRaises(pf.Error):
                pf.Calibration(4, 6, **wrong)


class Scenes(unittest.TestCase):
    def test_a_dict_is_the_file_of_the_same_keys(self):
        toml = ('[skin]\npillars = [20, 30]\nthreshold_counts = 2\n'
                '[sensor]\nadc_bits = 8\nnoise_counts = 0.5\n[time]\nrate_hz = 50\nframes = 3\n'
                '[[contact]]\nshape = "sphere"\nmotion = "slide"\ncontact_radius_mm = 8\n'
                'reference_load_n = 20\nfriction = 0.6\ndirection_deg = 0\npath = [\n'
                '{ time_s = 0.0, position_mm = [-5, 0], load_n = 15 },\n'
                '{ time_s = 0.2, position_mm = [5, 0], load_n = 20 }]\n')
        (WORK / "scene.toml").write_text(toml)
        one, other = pf.simulate(WORK / "scene.toml"), pf.simulate(skins.scene(frames=3))
        self.assertTrue(np.array_equal(one.frames, other.frames))
        self.assertFalse(np.array_equal(one.frames, pf.simulate(one.scene, seed=2).frames))
        self.assertEqual(len(pf.simulate(one.scene, frames=2).frames), 2)

    def test_wrong_scenes(self):
        for wrong in ({}, {"skin": {}}, {"skin": {"pillars": [8, {}]}}, {"skin": {"pillars": None}},
                      {"a\nb": 1}, {"skin": {"pillars": [8, 8], "colour": "red"}},
                      {"skin": {"pillars": [8, 8]}, "contct": []}):
            with self.assertRaises(pf.Error):
                pf.scene(wrong)
        self.assertEqual(pf.scene({"skin": {"pillars": [8, 8]}, "contact": []}).skin.rows, 16)
        with self.assertRaisesRegex(pf.Error, "estimator.*allowed"):
            pf.scene({"skin": {"pillars": [8, 8]}, "solver": {"estimator": "field"}})

    def test_a_resized_array_is_not_read(self):
        frames = np.zeros((40, 200, 200), np.uint8)
        source = pf._core.FrameSource.of_array(frames, np.arange(40.0), pf.Skin(200, 200), None)
        frames.resize((1, 2, 2), refcheck=False)
        with self.assertRaisesRegex(pf.Error, "resized"):
            source.read(0, 1, 40)

    def test_comparison_of_sensels_with_the_truth(self):
        rng = np.random.default_rng(4)
        truth = rng.uniform(0, 2, (5, 4, 6)) * (rng.uniform(size=(5, 4, 6)) < 0.4)
        error = rng.normal(0, 0.01, truth.shape) * (truth > 0)
        error[0, 0] = 0.5
        true, solved = (pf.ForceField(None, None, plane, status=plane > 0) for plane in (truth, truth + error))
        errors = pf.compare(solved, true)
        loaded = truth > 0
        self.assertEqual(list(errors.regions), [pf.Region.NONE])
        self.assertEqual(errors.loaded.pillars, np.count_nonzero(loaded))
        self.assertAlmostEqual(errors.loaded.rms_n, np.sqrt(np.mean(error[loaded] ** 2)), 6)
        self.assertEqual(errors.loaded.status_mismatches, 0)
        self.assertEqual(errors.regions[pf.Region.NONE].pillars, np.count_nonzero(~loaded))
        self.assertEqual(errors.regions[pf.Region.NONE].status_mismatches, np.count_nonzero(error[~loaded]))
        with self.assertRaisesRegex(pf.Error, "not both of pillars"):
            pf.compare(pf.ForceField(truth, truth, truth), true)


class Pictures(unittest.TestCase):
    def test_colours_are_those_of_the_viewer(self):
        normal = np.zeros((10, 10), np.float32)
        normal[2, 3] = 1
        forces = pf.ForceField(0 * normal, 0 * normal, normal, status=15 * (normal > 0))
        pixels = pixels_of(forces.picture(limits=(0, 1)))
        zoom = 48
        self.assertEqual(tuple(pixels[20 + 2 * zoom + 24, 20 + 3 * zoom + 24]), (254, 232, 56))
        self.assertEqual(tuple(pixels[24, 24]), (0x26, 0x2a, 0x30))  # idle
        self.assertEqual(tuple(pixels[2, 2]), (0x15, 0x18, 0x1c))  # background
        light = pixels_of(forces.picture(theme="light"))
        self.assertEqual(tuple(light[2, 2]), (0xf7, 0xf8, 0xf9))

    def test_quantities(self):
        forces = pf.solve(pf.simulate(skins.scene()), outputs=["angles", "uncertainty"])
        for quantity in ("normal", "shear", "shear_x", "shear_y", "magnitude", "theta", "phi", "region",
                         "status", "uncertainty"):
            self.assertGreater(len(np.unique(pixels_of(forces[5].picture(quantity)))), 10, quantity)
        self.assertEqual(pixels_of(forces._repr_png_()).ndim, 3)
        for wrong in ("parity", "colour", ""):
            with self.assertRaises(pf.Error):
                forces[5].picture(wrong)
        for limits in ((1, 1), (1, 0), (0, float("nan"))):
            with self.assertRaises(pf.Error):
                forces[5].picture(limits=limits)
        with self.assertRaises(pf.Error):
            forces.picture()

    def test_sensels_without_pillars(self):
        frame = np.zeros((5, 7), np.uint16)
        frame[2, 3], frame[4, 6] = 320, 160  # N: 1, 0.5
        skin = pf.Skin(5, 7, sensel_pitch_mm=2, threshold_counts=2, layout="sensels")
        forces = pf.solve(frame, skin=skin, noise_counts=1.0, outputs=["uncertainty"])
        zoom = 69
        colours = {}
        for quantity, limits in (("normal", (0, 1)), ("pressure", (0, 250)), ("status", None),
                                 ("uncertainty", None)):
            pixels = pixels_of(forces.picture(quantity, limits=limits))
            colours[quantity] = [tuple(pixels[20 + zoom * row + 34, 20 + zoom * col + 34])
                                 for row, col in ((2, 3), (4, 6), (0, 0))]
        self.assertEqual(colours["normal"][0], (254, 232, 56))
        self.assertEqual(colours["normal"][2], (0x26, 0x2a, 0x30))  # idle
        self.assertEqual(colours["pressure"], colours["normal"])  # A newton on 4 mm² is 250 kPa.
        self.assertNotEqual(colours["pressure"][1], colours["pressure"][0])
        for wrong in ("shear", "magnitude", "phi", "region", "parity"):
            with self.assertRaises(pf.Error):
                forces.picture(wrong)
        with self.assertRaises(pf.Error):  # The area is unknown.
            pf.ForceField(None, None, forces.normal, status=forces.status).picture("pressure")

        for shape in ((1, 1), (1, 700), (700, 1)):
            forces = pf.ForceField(*np.ones((3, *shape)), status=15 * np.ones(shape))
            self.assertGreater(len(forces.picture()), 100)


class Points(unittest.TestCase):
    def test_a_plane_and_a_cylinder(self):
        forces = np.arange(24.0).reshape(3, 2, 4)  # shear_x, shear_y, normal
        skin = pf.Skin(4, 8, sensel_pitch_mm=2)
        points = pf.ForceField(*forces, skin=skin).to_points()
        self.assertEqual(points.force_n.shape, (8, 3))
        np.testing.assert_allclose(points.force_n.T.reshape(3, 2, 4), forces * [[[1]], [[1]], [[-1]]])
        np.testing.assert_allclose(points.position_m[[0, 7]], [[-6e-3, 2e-3, 0], [6e-3, -2e-3, 0]])
        bent = pf.Skin(4, 8, sensel_pitch_mm=2, surface=pf.Surface.cylinder(20))
        round_ = pf.ForceField(*forces, skin=bent).to_points()
        np.testing.assert_allclose(np.linalg.norm(round_.force_n, axis=1),
                                   np.linalg.norm(points.force_n, axis=1), rtol=1e-6)
        radii = np.hypot(round_.position_m[:, 0], round_.position_m[:, 2] + 20e-3)
        np.testing.assert_allclose(radii, 20e-3)
        with self.assertRaises(pf.Error):
            pf.ForceField(*forces).to_points()

    def test_xarray(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("xarray is not installed")
        forces = pf.solve(pf.simulate(skins.scene()), outputs=["uncertainty"])
        data = forces.to_xarray()
        self.assertEqual(dict(data.sizes), {"time": 12, "y": 20, "x": 30})
        self.assertEqual(data.normal.attrs["units"], "N")
        self.assertEqual(data.uncertainty_phi_low.attrs["units"], "rad")
        self.assertGreater(float(data.y[0]), float(data.y[-1]))
        self.assertTrue(np.array_equal(data.sel(time=0.06).normal, forces[3].normal))


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
