"""Copies and pickles, tables of contacts, comparisons, devices, and how a misspelt option is answered."""

import copy
import importlib.util
import os
import pathlib
import pickle
import re
import unittest

import numpy as np

import pillarfield as pf
import skins

PLANES = ("shear_x", "shear_y", "normal")


def copies(value):
    return [pickle.loads(pickle.dumps(value)), copy.deepcopy(value)]


def solved(**scene):
    simulation = pf.simulate({**skins.scene(), **scene})
    return simulation, pf.solve(simulation, estimator="contact", noise_counts=0.5,
                                outputs=["uncertainty"], contacts=True)


class Copies(unittest.TestCase):
    def same(self, one, other):
        """Asserts that all public attributes are equal."""
        for name, member in vars(type(one)).items():
            if name.startswith("_") or not isinstance(member, property):
                continue
            here, there = getattr(one, name), getattr(other, name)
            if type(here).__module__ == "pillarfield._core":
                self.same(here, there)
            else:
                np.testing.assert_equal(there, here, name)

    def same_forces(self, one, other):
        for name, plane in other._planes.items():
            np.testing.assert_array_equal(one._planes[name], plane, name)

    def same_records(self, one, other):
        np.testing.assert_equal(one.total_records().tolist(), other.total_records().tolist())
        np.testing.assert_equal(one.contact_records().tolist(), other.contact_records().tolist())

    def test_skin(self):
        heights = np.arange(24, dtype=float).reshape(4, 6)
        for surface in (None, pf.Surface.cylinder(40, axis_deg=30), pf.Surface.height_map(heights)):
            skin = pf.Skin(8, 12, sensel_pitch_mm=3, counts_per_newton=100, threshold_counts=2,
                           full_scale_counts=4000, power_law=(0.8, 100), surface=surface)
            for made in copies(skin):
                self.same(skin, made)
                np.testing.assert_array_equal(pf._core.poses(made), pf._core.poses(skin))
        self.assertEqual({made.layout for made in copies(pf.Skin(7, 5, layout="sensels"))}, {"sensels"})

    def test_calibration_and_plan(self):
        rng = np.random.default_rng(1)
        calibration = pf.calibrate.tare(rng.normal(20, 1, (50, 40, 60)).round(), skin=pf.Skin(40, 60)).calibration
        for made in copies(calibration):
            self.same(calibration, made)
        frames = rng.integers(0, 200, (3, 40, 60)).astype("u1")
        effects = pf.simulate({**skins.scene(), "sensor": {
            "adc_bits": 8, "noise_counts": 0.5, "leak_inside": 0.05, "creep_per_decade": 0.05, "shear_coefficient": 0.8}}).calibration
        self.assertEqual(len(effects.effects), 2)
        for options in ({"estimator": "contact", "outputs": ["angles", "uncertainty"], "friction": 0.7},
                        {"baseline_time_s": 3, "parity_tolerance_counts": 4},
                        {"scene": pf.simulate(skins.scene()).scene, "friction_bound": 2, "calibration": effects}):
            plan = pf.Plan(pf.Skin(40, 60), **{"calibration": calibration, **options})
            for made in copies(plan):
                self.assertEqual((repr(made), made.stages), (repr(plan), plan.stages))
                with pf.Processor(plan) as processor, pf.Processor(made) as other:
                    for one, two in zip(processor.stream(frames), other.stream(frames)):
                        self.same_forces(one, two)

    def test_forces_and_contacts(self):
        _, forces = solved(surface={"shape": "cylinder", "radius_mm": 60})
        self.assertIn("moment_z_nmm", forces.total_records().dtype.names)
        for made in copies(forces):
            self.same_forces(made, forces)
            self.same_records(made, forces)
            np.testing.assert_array_equal(made.intervals.shear_x_low, forces.intervals.shear_x_low)
            made.save("copy.h5", overwrite=True)  # With its contacts.
            self.same_records(pf.open("copy.h5")[:], forces)
        for value in (forces.contacts[0], pf.Plan(pf.Skin(8, 12))):
            with self.assertRaisesRegex(pf.Error, "another version"):
                type(value).__new__(type(value)).__setstate__(("0.0.1", *value.__getstate__()[1:]))
        bare = pf.solve(np.array(2 * [np.eye(6) * 9]), counts_per_newton=100, threshold_counts=1, contacts=True)
        for made in copies(bare):
            self.same(bare.contacts[0].total, made.contacts[0].total)
            self.assertIsNone(made.contacts[0][0].shear_x_n)

    def test_scene_and_simulation(self):
        simulation = pf.simulate(skins.scene(), frames=3, seed=7)
        for made in copies(simulation):
            self.assertEqual((made.scene.frames, made.scene.seed), (3, 7))
            np.testing.assert_array_equal(pf.simulate(made.scene).frames, simulation.frames)
            self.same_forces(pf.solve(made), pf.solve(simulation))


class Tables(unittest.TestCase):
    def test_records(self):
        _, forces = solved()
        totals, contacts = forces.total_records(), forces.contact_records()
        np.testing.assert_allclose(totals["normal_n"], forces.normal.sum((1, 2)), rtol=1e-5)
        np.testing.assert_array_equal(totals["time_s"], forces.times)
        rows = [(frame, contact) for frame, each in enumerate(forces.contacts) for contact in each]
        np.testing.assert_array_equal(contacts["frame"], [frame for frame, _ in rows])
        for field, name in (("id", "track_id"), ("normal_n", "normal_n"), ("slip", "slip")):
            np.testing.assert_array_equal(contacts[field], [getattr(contact, name) for _, contact in rows])
        self.assertEqual(len(forces[2].total_records()), 1)
        untouched = pf.solve(np.zeros((2, 6, 6)), counts_per_newton=100, contacts=True)
        self.assertEqual((len(untouched.contact_records()), len(untouched.total_records())), (0, 2))
        self.assertNotIn("shear_x_n", untouched.total_records().dtype.names)

    def test_pandas(self):
        _, forces = solved()
        if importlib.util.find_spec("pandas"):
            self.assertEqual(list(forces.to_pandas()["normal_n"]), list(forces.contact_records()["normal_n"]))
            self.assertEqual(len(forces.to_pandas(totals=True)), len(forces))
        else:
            with self.assertRaisesRegex(pf.Error, "pandas is not installed; install it"):
                forces.to_pandas()


class Comparisons(unittest.TestCase):
    def test_without_skin_or_pillars_or_truth(self):
        one = np.ones((2, 4, 4), np.float32)
        found = pf.compare(pf.ForceField(one, one, one), pf.ForceField(one, one, one))
        self.assertIsNone(found.resultant.torque or found.contacts.torque or found.contacts.centre)
        skin = pf.Skin(4, 4, layout="sensels")
        bare = pf.compare(pf.ForceField(None, None, 2 * one, status=one), pf.ForceField(None, None, one, skin=skin))
        self.assertIsNone(bare.resultant.torque)
        self.assertEqual((bare.resultant.force.rms, bare.contacts.found), (16, 2))
        for nothing in (0 * one, 1e-9 * one):
            self.assertNotIn("%", repr(pf.compare(pf.ForceField(one, one, one), pf.ForceField(*3 * [nothing]))))


class Answers(unittest.TestCase):
    def test_misspelt_options(self):
        for call, meant in ((lambda: pf.solve(np.zeros((20, 8, 12)), tare_frame=10), "tare_frames"),
                            (lambda: pf.solve(np.zeros((20, 8, 12)), estimater="direct"), "estimator"),
                            (lambda: pf.Plan(pf.Skin(8, 12), noise_count=1), "noise_counts"),
                            (lambda: pf.Skin(8, 12, counts_per_newtons=1), "counts_per_newton"),
                            (lambda: pf.Calibration(8, 12, tarre=None), "tare"),
                            (lambda: pf.Contacts(pf.Plan(pf.Skin(8, 12)), reach=3), "reach_mm")):
            with self.assertRaisesRegex(TypeError, rf"^\w+\(\) has no argument '\w+'; did you mean '{meant}'\?$"):
                call()

    def test_devices(self):
        host, *others = pf.devices()
        self.assertEqual((host.index, host.type, host.platform), (None, "host", ""))
        self.assertEqual([device.index for device in others], list(range(len(others))))
        for device in (host, *others):
            self.assertTrue(device.lanes >= 1 and device.name and device.name in repr(device))
            name = "host" if device.index is None else str(device.index)
            if not device.unsuitable:
                forces = pf.solve(np.eye(8) * 32, counts_per_newton=320, threshold_counts=1, device=name)
                self.assertAlmostEqual(float(forces.normal[0, 0]), 0.1, 6)


if __name__ == "__main__":
    work = pathlib.Path(os.environ["PILLARFIELD_WORK"])
    work.mkdir(parents=True, exist_ok=True)
    os.chdir(work)
    unittest.main()
