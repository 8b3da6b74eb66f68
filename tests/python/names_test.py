"""Every public name: its docstring, a test that uses it, and values that nothing else tests."""

import ast
import inspect
import os
import pathlib
import re
import unittest

import h5py
import numpy as np

import pillarfield as pf
import skins

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])

UNIT = (r"\bN\b|\bmm|\bkPa\b|\brad\b|\bs\b|\bcounts\b|\bdegrees\b|per second|coefficient|fraction|float|"
        r"deviation|percentile|\|true\||\|shear\|")


def names():
    """(full name, value) of all functions, classes and their members."""
    for owner in (pf, pf.calibrate):
        for name in owner.__all__:
            value = getattr(owner, name)
            if inspect.ismodule(value) or isinstance(value, str):
                continue
            yield name, value
            if inspect.isclass(value) and not issubclass(value, int):
                fields = getattr(value, "__dataclass_fields__", {})
                yield from ((f"{name}.{member}", attribute) for member, attribute in vars(value).items()
                            if not member.startswith("_") and member not in fields)


def numbers():
    """Full names of all properties that are numbers with a unit, or arrays, by their annotations."""
    for path in (SOURCE / "python/pillarfield").glob("*.py*"):
        for owner in ast.parse(path.read_text()).body:
            for node in owner.body if isinstance(owner, ast.ClassDef) else ():
                if isinstance(node, ast.FunctionDef) and node.returns and len(node.args.args) == 1:
                    name, kind = node.name, node.returns
                elif isinstance(node, ast.AnnAssign):
                    name, kind = ast.unparse(node.target), node.annotation
                else:
                    continue
                if re.search("float|Floats|Doubles|Place", ast.unparse(kind)):
                    owners = ["Contact", "ContactTotal"] if owner.name == "_Quantities" else [owner.name]
                    yield from (f"{each}.{name}" for each in owners)


class Names(unittest.TestCase):
    def test_docstrings(self):
        public = dict(names())
        self.assertEqual([name for name, value in public.items() if not inspect.getdoc(value)], [])
        found = [public[name] for name in numbers() if isinstance(public.get(name), property)]
        self.assertGreater(len(found), 50)
        self.assertEqual([value for value in map(inspect.getdoc, found) if not re.search(UNIT, value)], [])

    def test_every_name_is_tested(self):
        """Those of contacts are columns, below."""
        tests = "\n".join(path.read_text() for path in (SOURCE / "tests/python").glob("*.py"))
        made = {"Comparison", "Device", "FrameContacts", "Intervals", "LiveSink", "RegionErrors", "ResultantErrors", "Scene",
                "ArrayFinding", "Diagnosis", "SenselFinding", "Simulation", "Step", "Uncertainty",
                "VectorErrors"}  # by functions
        untested = [name for name, _ in names() if not name.startswith("Contact") and name not in made
                    and not re.search(rf"\b{name.rpartition('.')[2]}\b", tests)]
        self.assertEqual(untested, [])


class Values(unittest.TestCase):
    def test_contacts_have_the_columns_of_the_file(self):
        WORK.mkdir(parents=True, exist_ok=True)
        scene = skins.scene()
        scene["surface"] = {"shape": "cylinder", "radius_mm": 40}
        simulation = pf.simulate(scene)
        pf.save_recording(WORK / "rec.h5", simulation, overwrite=True)
        options = {"estimator": "contact", "noise_counts": 0.5}
        pf.solve_to_file(WORK / "rec.h5", WORK / "out.h5", contacts=True, **options)
        contacts = pf.solve(WORK / "rec.h5", contacts=True, **options).contacts
        tested = set()
        with h5py.File(WORK / "out.h5") as file:
            for group, rows in (("contacts/patch", [each.total for each in contacts]),
                                ("contacts", [contact for each in contacts for contact in each])):
                self.assertGreater(len(rows), 5)
                for name, column in file[group].items():
                    if isinstance(column, h5py.Dataset):
                        tested |= self.compare(name, column, rows)
        members = {name.partition(".")[2] for name, _ in names() if name.startswith("Contact.")}
        self.assertEqual(members - tested - {"track_id", "centre_mm", "centre_of_pressure_mm", "peak_mm", "wrench"},
                         set())

    def compare(self, name, column, rows):
        """Compares a column with the members of these rows; returns the name if it is one."""
        axes = re.fullmatch(r"(centre|centre_of_pressure|peak)_([xy])_mm", name)
        wrench = re.fullmatch(r"(force|moment)_([xyz])_(n|nmm)", name)
        if axes:
            found = [(getattr(row, f"{axes[1]}_mm") or (np.nan,) * 2)["xy".index(axes[2])] for row in rows]
        elif wrench:
            found = [row.wrench[wrench[1] == "moment"]["xyz".index(wrench[2])] for row in rows]
        elif hasattr(rows[0], name) and name not in ("slip", "friction_source"):
            found = [getattr(row, name) for row in rows]
        elif hasattr(rows[0], name):
            words = np.array(column.attrs["words"].decode().replace(",", " ").split())
            self.assertEqual([getattr(row, name) for row in rows], list(words[column[()]]))
            return {name}
        else:
            return set()
        found = [(0 if name == "parent" else np.nan) if value is None else value for value in found]
        np.testing.assert_allclose(np.array(found, float), column[()].astype(float), rtol=1e-12, err_msg=name)
        return {name}

    def test_errors_of_a_region(self):
        simulation = pf.simulate(skins.scene())
        solved = pf.solve(simulation)
        found = pf.compare(solved, simulation.truth)
        errors = found.loaded
        self.assertLessEqual(found.regions[pf.Region.ONE].rms_n, errors.rms_n)
        error = np.sqrt(sum((getattr(solved, name) - getattr(simulation.truth, name)).astype(float)**2
                            for name in ("shear_x", "shear_y", "normal")))
        true = [getattr(simulation.truth, name).astype(float) for name in ("shear_x", "shear_y", "normal")]
        size = np.sqrt(sum(plane**2 for plane in true))
        loaded = size > 0
        self.assertEqual(errors.pillars, np.count_nonzero(loaded))
        self.assertAlmostEqual(errors.rms_n, np.sqrt(np.mean(error[loaded]**2)), 6)
        self.assertAlmostEqual(errors.p95_n / np.quantile(error[loaded], 0.95), 1, 1)
        relative = error[loaded] / size[loaded]
        self.assertAlmostEqual(errors.rms_relative / np.sqrt(np.mean(relative**2)), 1, 3)
        self.assertAlmostEqual(errors.p95_relative / np.quantile(relative, 0.95), 1, 1)
        self.assertLess(errors.status_mismatches, errors.pillars)
        for angle in (errors.theta_rms_rad, errors.phi_rms_rad):
            self.assertTrue(0 < angle < 1)

    def test_what_a_scene_gives(self):
        scene = skins.scene()
        scene["title"] = "A ball"
        scene["sensor"]["dead_zone_counts"] = 1.5
        simulation = pf.simulate(scene)
        plan = skins.plan_of(simulation, frame_interval_s=0.02)
        self.assertEqual((plan.skin.pillar_rows, plan.skin.pillar_cols), (20, 30))
        self.assertAlmostEqual(plan.skin.pillar_pitch_mm, 2 * plan.skin.sensel_pitch_mm)
        self.assertEqual(plan.frame_interval_s, 0.02)
        self.assertIn("dead_zone", " ".join(plan.stages))
        np.testing.assert_array_equal(simulation.calibration.dead_zone, np.full((40, 60), 1.5, np.float32))
        self.assertEqual(list(simulation.calibration.effects), [])
        self.assertEqual(pf.scene(scene).title, "A ball")
        scene["surface"] = {"shape": "sphere", "radius_mm": 300}
        self.assertEqual(pf.simulate(scene).skin.surface.radius_mm, 300)

    def test_a_recording_may_have_a_truth(self):
        WORK.mkdir(parents=True, exist_ok=True)
        simulation = pf.simulate(skins.scene())
        pf.save_recording(WORK / "true.h5", simulation, overwrite=True)
        self.assertFalse(pf.open(WORK / "true.h5").has_truth)
        with h5py.File(WORK / "true.h5", "r+") as file:
            for name in ("shear_x", "shear_y", "normal"):
                file[f"truth/{name}"] = getattr(simulation.truth, name)
        self.assertTrue(pf.open(WORK / "true.h5").has_truth)

    def test_sensels_without_pillars(self):
        skin = pf.Skin(7, 5, layout="sensels", sensel_pitch_mm=2, counts_per_newton=10)
        self.assertEqual((skin.layout, skin.element_rows, skin.element_cols, skin.element_pitch_mm, skin.element_area_mm2),
                         ("sensels", 7, 5, 2, 4))
        uneven = pf.Skin(8, 12, layout="sensels", sensel_pitch_mm=(7.62, 5.08))
        self.assertEqual((uneven.sensel_pitch_mm, uneven.element_area_mm2), ((7.62, 5.08), 7.62 * 5.08))
        frames = np.random.default_rng(3).integers(0, 200, (2, 7, 5)).astype("u1")
        forces = pf.solve(frames, skin=skin, contacts=True, outputs=["uncertainty", "pressure"], noise_counts=1)
        self.assertFalse(forces.has_pillars)
        np.testing.assert_allclose(forces.pressure_kpa, frames / 10 / 4 * 1000, rtol=1e-6)
        np.testing.assert_allclose(forces.pressure("psi") * 6.894757, forces.pressure_kpa, rtol=1e-6)
        with self.assertRaisesRegex(pf.Error, "'bar' is not a unit.*mmHg"):
            forces.pressure("bar")
        for name in ("shear_x", "theta", "region"):
            with self.assertRaisesRegex(pf.Error, "without pillars"):
                getattr(forces, name)
        self.assertIsNone(forces.uncertainty.shear_x)
        self.assertIsNone(forces.intervals.shear_x_low)
        self.assertIsNone(forces.contacts[0][0].shear_x_n)
        WORK.mkdir(parents=True, exist_ok=True)
        forces.save(WORK / "sensels.h5", overwrite=True)
        read = pf.open(WORK / "sensels.h5")[:]
        self.assertFalse(read.has_pillars)
        np.testing.assert_array_equal(read.normal, forces.normal)
        with h5py.File(WORK / "sensels.h5") as file:
            np.testing.assert_array_equal(file["force/pressure"], read.pressure_kpa)


if __name__ == "__main__":
    unittest.main()
