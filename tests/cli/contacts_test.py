"""`pillarfield solve --contacts`."""

import csv
import json
import unittest

import h5py
import numpy as np

from command import SCENES, CommandTest, run, run_json


class Contacts(CommandTest):
    def setUp(self):
        super().setUp()
        self.recording = self.folder / "several.h5"
        self.forces = self.folder / "forces.h5"
        self.csv = self.folder / "contacts.csv"
        self.json = self.folder / "contacts.json"
        run("simulate", SCENES / "touch/several_contacts.toml", "-o", self.recording, "--frames", 40)

    def solve(self, *arguments):
        return run_json("solve", self.recording, "-o", self.forces, "--minimum-pillars", 4,
                        *arguments)

    def rows(self):
        with open(self.csv, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_tables_go_into_files_of_their_own_or_the_force_file(self):
        solved = self.solve("--contacts", self.csv)
        self.assertEqual((solved["contacts"], solved["contacts_at_once"]), (3, 3))
        self.assertEqual(solved["contacts_output"], str(self.csv))
        rows = self.rows()
        self.solve("--contacts", self.json)
        table = json.loads(self.json.read_text(encoding="utf-8"))
        self.assertEqual((table["source"], len(table["frames"])), ("several.h5", 40))
        run("solve", self.recording, "-o", self.forces)
        self.assertFalse(run_json("info", self.forces)["contacts"])
        self.solve("--contacts", self.forces)
        self.assertTrue(run_json("info", self.forces)["contacts"])
        with h5py.File(self.forces) as file:
            normal = file["contacts/normal_n"][:]
            self.assertEqual(file["contacts"].attrs["minimum_pillars"], 4)
            columns = {name: column[:] for name, column in file["contacts"].items()
                       if isinstance(column, h5py.Dataset) and "words" not in column.attrs and name != "parent"}
        of_rows = [row for row in rows if row["row"] == "contact"]
        of_frames = [contact for frame in table["frames"] for contact in frame["contacts"]]
        shared = [name for name in columns if name in of_rows[0] and name in of_frames[0]]
        self.assertGreater(len(shared), 20)
        for name in shared:
            for each in (of_rows, of_frames):
                found = [np.nan if row[name] in ("", None) else float(row[name]) for row in each]
                np.testing.assert_allclose(found, columns[name], rtol=1e-15, err_msg=name)
        ended = sum(len(frame["ended"]) for frame in table["frames"])
        self.assertEqual([sum(row["row"] == kind for row in rows) for kind in ("patch", "contact", "ended")],
                         [40, len(normal), ended])
        for ending in ("csv", "npy"):
            run("solve", self.recording, "-o", self.folder / f"forces.{ending}", "--contacts", self.csv)
            self.assertEqual(sum(row["row"] == "patch" for row in self.rows()), 40)

    def friction_of(self, *arguments):
        """The friction values of the table, and the given friction of the force file."""
        run("solve", self.recording, "-o", self.forces, "--contacts", self.csv, *arguments)
        with h5py.File(self.forces) as file:
            given = file["contacts"].attrs.get("given_friction")
        found = {(row["friction"], row["friction_source"]) for row in self.rows()
                if row["row"] != "ended"}
        return found, given

    def test_given_friction_is_that_of_contacts(self):
        scene = self.folder / "frictional.toml"
        text = (SCENES / "touch/several_contacts.toml").read_text(encoding="utf-8")
        for estimator in ("direct", "contact"):
            options = ("--estimator", estimator, "--noise", 0.5)
            self.assertEqual(self.friction_of(*options, "--friction", 1.5),
                             ({("1.5", "given")}, 1.5))
            scene.write_text(text.replace("[solver]", "[solver]\nfriction = 1.25\n"
                                          f"estimator = '{estimator}'"), encoding="utf-8")
            self.assertEqual(self.friction_of("--scene", scene), ({("1.25", "given")}, 1.25))
            self.assertEqual(self.friction_of("--scene", scene, "--friction", 1.5),
                             ({("1.5", "given")}, 1.5))
            found, given = self.friction_of(*options)
            self.assertIsNone(given)
            self.assertIn("observed", {source for _, source in found})
            self.assertLessEqual({source for _, source in found},
                                 {"prior", "observed", "carried_over", "at_least"})
            for friction, source in found:
                self.assertEqual(friction == "", source == "prior")

    def test_friction_options_apply_to_contacts_of_direct_forces(self):
        def first(*known):
            self.solve("--estimator", "direct", "--contacts", self.csv, *known)
            return [(row["friction"], row["friction_source"], row["friction_deviation"])
                    for row in self.rows() if row["id"] == "1" and row["row"] == "contact"]

        usual = first()
        alone = first("--unrelated-frames")
        self.assertEqual(alone[0], usual[0])
        self.assertNotEqual(alone, usual)
        self.assertNotEqual(first("--friction-prior", "2,0.2"), usual)
        for friction, source, _ in first("--friction-bound", 0.5):
            self.assertTrue(source == "prior" or float(friction) <= 0.5)

    def test_wrong_names_are_refused_first(self):
        self.assert_fails("solve", self.recording, "-o", self.csv, "--contacts", self.csv, names=["contacts.csv", "share"])
        # The error precedes that of the absent recording.
        self.assert_fails("solve", self.folder / "absent.h5", "-o", self.forces, "--contacts", "c.txt",
                          names=["c.txt", ".csv or .json"])
        self.assert_folder_holds("several.h5")


if __name__ == "__main__":
    unittest.main()
