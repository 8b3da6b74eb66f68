"""`pillarfield solve --contacts`."""

import csv
import json
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np

from command import PROGRAM, SCENES, CommandTest, run, run_json

WORDS = {"friction_source", "slip"}

# A punch that is pressed, dragged while it sticks, and slides after 0.9 s.
PUNCH = """
title = "A punch that sticks"
[skin]
pillars = [20, 20]
threshold_counts = 2
[time]
rate_hz = 10
frames = 16
[sensor]
adc_bits = 8
noise_counts = 0.5
[[indenter]]
shape = "punch"
radius_mm = 8
friction = 0.8
path = [{ time_s = 0.0, position_mm = [0, 0], load_n = 25 },
        { time_s = 1.5, position_mm = [2.4, 0], load_n = 25 }]
"""


class Contacts(CommandTest):
    def setUp(self):
        super().setUp()
        self.recording = self.folder / "several.h5"
        self.forces = self.folder / "forces.h5"
        self.csv = self.folder / "contacts.csv"
        self.json = self.folder / "contacts.json"
        run("simulate", SCENES / "several_contacts.toml", "-o", self.recording, "--frames", 40)

    def solve(self, *arguments):
        return run_json("solve", self.recording, "-o", self.forces, "--minimum-pillars", 4,
                        *arguments)

    def rows(self):
        with open(self.csv, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_forces_are_in_the_frame_of_a_curved_body(self):
        run("simulate", SCENES / "curved_skin.toml", "-o", self.recording, "--frames", 10,
            "--overwrite")
        facts = run_json("info", self.recording)
        self.assertEqual((facts["surface"], facts["surface_radius_mm"]), ("cylinder", 60))
        self.solve("--contacts", self.csv)
        with h5py.File(self.forces) as file:
            shear_x, shear_y, normal = (file[f"force/{plane}"][:].astype("f8")
                                        for plane in ("shear_x", "shear_y", "normal"))
            pitch = file.attrs["pillar_pitch_mm"]
            self.assertEqual(dict(file["surface"].attrs)["radius_mm"], 60)
        cols = normal.shape[2]
        angle = (np.arange(cols) - (cols - 1) / 2) * pitch / 60
        force = [(shear_x * np.cos(angle) - normal * np.sin(angle)).sum(axis=(1, 2)),
                 shear_y.sum(axis=(1, 2)),
                 (-shear_x * np.sin(angle) - normal * np.cos(angle)).sum(axis=(1, 2))]
        rows = [row for row in self.rows() if row["row"] == "patch"]
        read = np.array([[float(row[f"force_{axis}_n"]) for row in rows] for axis in "xyz"])
        np.testing.assert_allclose(read, force, rtol=1e-6, atol=1e-6)
        self.assertGreater(np.abs(read[0]).max(), 0.3 * np.abs(read[2]).max())

    def test_forces_add_up_to_the_loads(self):
        solved = self.solve("--contacts", self.csv)
        self.assertEqual((solved["contacts"], solved["contacts_at_once"]), (3, 3))
        self.assertEqual(solved["contacts_output"], str(self.csv))
        rows = self.rows()
        with h5py.File(self.recording) as file:
            loads = file["/truth/normal"][:].sum(axis=(1, 2))
        for frame in range(40):
            own = [row for row in rows if int(row["frame"]) == frame and row["row"] == "contact"]
            patch, = (row for row in rows if int(row["frame"]) == frame and row["row"] == "patch")
            total = sum(float(row["normal_n"]) for row in own)
            self.assertAlmostEqual(total, loads[frame], delta=0.01 * loads[frame] + 0.1)
            self.assertAlmostEqual(float(patch["normal_n"]), loads[frame],
                                   delta=0.01 * loads[frame] + 0.1)
            self.assertEqual(float(patch["time_s"]), frame / 100)
            self.assertEqual(patch["id"], "")
        slides = [row for row in rows if row["row"] == "contact" and row["id"] == "1"]
        self.assertEqual(len(slides), 40)
        for row in slides:
            self.assertEqual(row["slip"], "sliding")
            self.assertAlmostEqual(float(row["friction"]), 0.6, delta=0.02)
            self.assertAlmostEqual(float(row["centre_of_pressure_y_mm"]), 20, delta=0.2)

    def test_saturated_sensels_count(self):
        """The sums of contacts are those of the field."""
        frames = np.zeros((3, 16, 16), "u1")
        frames[:, 4:9, 4:9], frames[:, 5:8, 3] = 255, 120
        np.save(self.folder / "full.npy", frames)
        for layout in ("sensels", "pillars"):
            with self.subTest(layout=layout):
                run("solve", self.folder / "full.npy", "--layout", layout, "--rate", 100, "--pitch-mm", 5,
                    "--counts-per-newton", 10, "--full-scale", 255, "--threshold", 5, "-o", self.forces,
                    "--contacts", self.csv, "--overwrite", "-q")
                with h5py.File(self.forces) as file:
                    normal = file["force/normal"][:]
                rows = self.rows()
                total = sum(float(row["normal_n"]) for row in rows if row["row"] == "patch")
                self.assertAlmostEqual(total / normal.sum(), 1, 6)
                each = sum(float(row["normal_n"]) for row in rows if row["row"] == "contact")
                self.assertAlmostEqual(each / normal.sum(), 1, 6)

    def test_formats_agree(self):
        self.solve("--contacts", self.csv)
        self.solve("--contacts", self.json)
        table = json.loads(self.json.read_text(encoding="utf-8"))
        self.assertEqual((table["format"], table["version"], table["source"]),
                         ("pillarfield-contacts", 1, "several.h5"))
        self.assertEqual(len(table["frames"]), 40)
        rows = iter(self.rows())
        with h5py.File(self.forces) as file:
            group = file["contacts"]
            names = [name for name in group["patch"] if name in table["frames"][0]["patch"]]
            self.assertEqual(len(names), 29)
            self.assertIn("friction_deviation", names)
            self.assertEqual(group.attrs["minimum_pillars"], 4)
            self.assertEqual(group["normal_n"].attrs["unit"], b"N")
            row_of_contact = 0
            for index, frame in enumerate(table["frames"]):
                self.check_row(next(rows), "patch", frame["patch"], names, group["patch"], index)
                self.assertEqual(group["patch/first_contact"][index], row_of_contact)
                self.assertEqual(group["patch/contacts"][index], len(frame["contacts"]))
                for contact in frame["contacts"]:
                    row = next(rows)
                    self.assertEqual(int(row["id"]), contact["id"])
                    self.assertEqual(group["frame"][row_of_contact], index)
                    self.assertEqual(group["id"][row_of_contact], contact["id"])
                    self.check_row(row, "contact", contact, names, group, row_of_contact)
                    row_of_contact += 1
                for ended in frame["ended"]:
                    row = next(rows)
                    self.assertEqual((row["row"], int(row["id"])), ("ended", ended["id"]))
            self.assertEqual(len(group["frame"]), row_of_contact)
        self.assertIsNone(next(rows, None))

    def check_row(self, row, kind, members, names, group, index):
        self.assertEqual(row["row"], kind)
        for name in names:
            value = members[name]
            stored = group[name][index]
            if name in WORDS:
                self.assertEqual(row[name], value)
                words = group[name].attrs["words"].decode().split(", ")
                self.assertEqual(words[stored], value)
            elif value is None:
                self.assertEqual(row[name], "")
                self.assertTrue(np.isnan(stored))
            else:
                self.assertEqual(float(row[name]), value)
                self.assertEqual(stored, value)

    def test_runs_give_the_same_bytes(self):
        copies = [self.folder / name for name in ("a.json", "b.json")]
        for copy in copies:
            self.solve("--contacts", copy)
        self.assertEqual(copies[0].read_bytes(), copies[1].read_bytes())

    def test_contacts_only_in_the_force_file(self):
        self.solve("--contacts", self.forces)
        self.assert_folder_holds("several.h5", "forces.h5")
        self.assertTrue(run_json("info", self.forces)["contacts"])
        with h5py.File(self.forces) as file:
            self.assertEqual(len(file["contacts/patch/normal_n"]), 40)
        run("solve", self.recording, "-o", self.forces)
        self.assertFalse(run_json("info", self.forces)["contacts"])
        with h5py.File(self.forces) as file:
            self.assertNotIn("contacts", file)

    def test_beside_forces_that_hold_none(self):
        for ending in ("csv", "npy"):
            forces = self.folder / f"forces.{ending}"
            run("solve", self.recording, "-o", forces, "--contacts", self.csv)
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
        text = (SCENES / "several_contacts.toml").read_text(encoding="utf-8")
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
                                 {"prior", "observed", "carried_over"})
            for friction, source in found:
                self.assertEqual(friction == "", source == "prior")

    def test_friction_options_apply_to_contacts_of_direct_forces(self):
        def first(*known):
            self.solve("--contacts", self.csv, *known)
            return [(row["friction"], row["friction_source"], row["friction_deviation"])
                    for row in self.rows() if row["id"] == "1" and row["row"] == "contact"]

        usual = first()  # It slides, at 0.6.
        self.assertEqual({source for _, source, _ in usual}, {"observed"})
        for friction, _, deviation in usual:
            self.assertLess(abs(float(friction) - 0.6), 0.02)
            self.assertLess(0, float(deviation))
            self.assertLessEqual(float(deviation), 0.035 * float(friction))
        alone = first("--unrelated-frames")
        self.assertEqual(alone[0], usual[0])
        self.assertNotEqual(alone, usual)
        self.assertNotEqual(first("--friction-prior", "2,0.2"), usual)
        for friction, source, _ in first("--friction-bound", 0.5):
            self.assertTrue(source == "prior" or float(friction) <= 0.5)

    def test_a_punch_that_sticks_does_not_slide(self):
        scene = self.folder / "punch.toml"
        scene.write_text(PUNCH, encoding="utf-8")
        run("simulate", scene, "-o", self.recording, "--overwrite")
        with h5py.File(self.recording) as file:
            shear = np.abs(file["/truth/shear_x"][:].sum(axis=(1, 2)))
        sticks = shear < 0.99 * 0.8 * 25
        self.assertGreater(sticks.sum(), 4)
        self.assertLess(sticks.sum(), 16)
        self.assertGreater(shear[sticks].max(), 0.6 * 0.8 * 25)
        for estimator in ("direct", "contact"):
            self.solve("--contacts", self.csv, "--scene", scene, "--estimator", estimator)
            rows = [row for row in self.rows() if row["row"] == "contact"]
            self.assertEqual({int(row["frame"]) for row in rows}, set(range(16)))
            for row in rows:
                if sticks[int(row["frame"])]:
                    self.assertNotEqual(row["slip"], "sliding", row)
                    self.assertEqual((row["friction"], row["friction_deviation"]), ("", ""), row)
                    self.assertEqual(row["friction_source"], "prior")

    def test_wrong_names_are_refused_first(self):
        before = sorted(path.name for path in self.folder.iterdir())
        cases = {"contacts.txt": ".csv or .json", "contacts": ".csv or .json",
                 "other.h5": ".csv or .json", "no/such/folder.csv": "no/such/folder.csv"}
        for name, names in cases.items():
            with self.subTest(name=name):
                self.assert_fails("solve", self.recording, "-o", self.forces, "--contacts",
                                  self.folder / name, names=[name, names])
                self.assert_folder_holds(*before)
        table = self.folder / "both.csv"
        self.assert_fails("solve", self.recording, "-o", table, "--contacts", table,
                          names=["both.csv", "share"])
        # The error precedes that of the absent recording.
        self.assert_fails("solve", self.folder / "absent.h5", "-o", self.forces, "--contacts",
                          "c.txt", names=["c.txt"])
        self.assert_fails("solve", self.recording, "-o", self.forces, "--contacts", self.csv,
                          "--contact-reach", "1e9", status=2, names=["--contact-reach", "'1e9'"])
        self.assert_folder_holds(*before)

    def test_interrupt_leaves_no_half_table(self):
        run("simulate", SCENES / "several_contacts.toml", "-o", self.recording, "--frames", 4000,
            "--overwrite")
        self.csv.write_text("precious", encoding="utf-8")
        with subprocess.Popen([PROGRAM, "solve", self.recording, "-o", self.folder / "f.npy",
                               "--contacts", self.csv, "--overwrite"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            part = self.folder / "contacts.csv.part"
            deadline = time.monotonic() + 600
            while not part.exists() and process.poll() is None and time.monotonic() < deadline:
                time.sleep(0.001)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(600), 1)
        self.assertEqual(self.csv.read_text(encoding="utf-8"), "precious")
        self.assert_folder_holds("contacts.csv", "several.h5")


if __name__ == "__main__":
    unittest.main()
