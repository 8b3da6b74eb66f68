"""The commands simulate, solve, compare and info."""

import pathlib
import unittest

import h5py
import numpy

from command import BALL, SCENES, CommandTest, datasets, run, run_json


class Work(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(BALL)
        self.recording = self.folder / "ball.h5"
        self.forces = self.folder / "forces.h5"

    def test_simulate_solve_compare(self):
        made = run_json("simulate", self.scene, "-o", self.recording)
        self.assertEqual((made["frames"], made["sensel_rows"], made["sensel_cols"]), (6, 40, 40))
        solved = run_json("solve", self.recording, "-o", self.forces)
        self.assertEqual(solved["frames"], 6)
        self.assertEqual(sum(solved["regions"].values()), 6 * 20 * 20)
        self.assertGreater(solved["startup_seconds"], 0)
        self.assertGreater(solved["seconds"], 0)
        self.assertFalse([key for key in solved if key.startswith("solver_")])
        regions = run_json("compare", self.forces, self.recording)["regions"]
        self.assertEqual(sum(regions[name]["pillars"] for name in ("loaded", "none")), 6 * 400)
        # Noise of 0.5 counts and rounding of 0.29, at 320 counts per newton.
        self.assertGreater(regions["1"]["pillars"], 300)
        self.assertLess(regions["1"]["rms_n"], 1.5 / 320)
        self.assertGreater(regions["1"]["rms_n"], 0.3 / 320)

    def test_ranges_of_frames(self):
        """A range has the bits of all frames; one with a memory is warmed up by the frames before."""
        def normal(*options):
            run("solve", self.recording, "-o", self.forces, *options)
            with h5py.File(self.forces) as file:
                return file["force/normal"][...]
        run("simulate", self.scene, "-o", self.recording)
        whole = normal()
        numpy.testing.assert_array_equal(normal("--frames", "3:5"), whole[2:5])
        self.assertEqual(run_json("info", self.forces)["first_frame"], 2)
        compared = run_json("compare", self.forces, self.recording)
        self.assertLess(compared["regions"]["1"]["rms_n"], 1.5 / 320)
        drift = ("--follow-baseline", 0.1, "--noise", 0.5)
        numpy.testing.assert_array_equal(normal(*drift, "--frames", "3:6"), normal(*drift)[2:])
        cold = normal(*drift, "--frames", "3:6", "--warm-up", 0)
        self.assertTrue((cold != normal(*drift)[2:]).any())
        solve = ("solve", self.recording, "-o", self.forces, "--frames")
        for frames in ("0:3", "5:3", "3"):
            self.assertIn("FIRST:LAST, counted from 1", run(*solve, frames, expect=2).stderr)
        self.assertIn("has 6 frames; give --frames within 1:6", run(*solve, "3:7", expect=1).stderr)

    def test_uncertainty_holds_the_truth(self):
        self.scene.write_text(BALL.replace("threshold_counts = 2", "threshold_counts = 3"))
        run("simulate", self.scene, "-o", self.recording)
        solve = ("solve", self.recording, "-o", self.forces, "--outputs", "uncertainty")
        self.assert_fails(*solve, names=["noise"])
        self.assert_fails(*solve, "--noise", 1, "--estimator", "paper",
                          names=["the paper's estimator has no uncertainty"])
        run(*solve, "--scene", self.scene)
        coverage = run_json("compare", self.forces, self.recording)["coverage"]
        self.assertGreater(coverage["1"]["pillars"], 300)
        for component in ("shear_x", "shear_y", "normal"):
            self.assertGreater(coverage["1"][component], 0.93)
            self.assertLess(coverage["1"][component], 0.97)
        self.assertGreater(coverage["3"]["ends"], 0.98)
        self.assertIn("interval", run("compare", self.forces, self.recording).stdout)

    def test_text_names_what_was_done(self):
        text = run("simulate", self.scene, "-o", self.recording).stdout
        self.assertIn("6 frames", text)
        text = run("solve", self.recording, "-o", self.forces).stdout
        for words in ("Solved 6 frames of 20 x 20 pillars", "region 1", "region 3", "Wrote"):
            self.assertIn(words, text)
        self.assertRegex(text, r"reading, solving, writing +[\d.]+ s, [\d.,]+ frames/s")
        self.assertRegex(text, r"opening, compiling +[\d.]+ s\n")
        text = run("compare", self.forces, self.recording).stdout
        for words in ("RMS", "95 %", "theta", "loaded", "Resultant force"):
            self.assertIn(words, text)

    def test_contact_everywhere_is_warned_of(self):
        run("simulate", SCENES / "calibration/new_skin_pressed.toml", "-o", self.recording, "--uncalibrated",
            "--frames", 2)
        with h5py.File(self.recording, "r+") as file:
            del file["truth"]  # recordings with truth are not warned of
        for has_tare, cause in ((False, " and there is no tare;"), (True, ": a load covers the array")):
            if has_tare:
                with h5py.File(self.recording, "r+") as file:
                    file["calibration/tare"] = numpy.zeros(file["frames/raw"].shape[1:], "f4")
            messages = run("solve", self.recording, "-o", self.forces, "-q").stderr
            self.assertEqual(messages.count("% of all pillars are in contact"), 1)
            self.assertIn(f"100.0 % of all pillars are in contact{cause}", messages)

    def test_a_region_without_pillars_has_no_figures(self):
        run("simulate", SCENES / "touch/hertz_press.toml", "-o", self.recording)
        run("solve", self.recording, "-o", self.forces)
        lines = run("compare", self.forces, self.recording).stdout.splitlines()
        rows = {line.split()[0]: line.split()[1:] for line in lines[4:10]}
        self.assertEqual(rows["4"], ["0"] + 7 * ["-"])
        self.assertNotIn("-", rows["1"])

    def test_options_override_the_file(self):
        run("simulate", self.scene, "-o", self.recording, "--seed", 5, "--frames", 2)
        seeded = datasets(self.recording)["frames/raw"]
        run("simulate", self.scene, "-o", self.recording, "--overwrite")
        self.assertTrue((datasets(self.recording)["frames/raw"][:2] != seeded).any())
        shares = []
        for threshold in (2, 40):
            solved = run_json("solve", self.recording, "-o", self.forces, "--threshold", threshold)
            shares.append(solved["regions"]["none"])
        self.assertGreater(shares[1], shares[0])
        solved = run_json("solve", self.recording, "-o", self.forces, "--full-scale", 60)
        self.assertGreater(solved["saturated"], 0)
        solved = run_json("solve", self.recording, "-o", self.forces, "--parity-tolerance", 0.5)
        self.assertGreater(solved["inconsistent"], 0)
        self.assertIn("parity_test", solved["stages"])

    def test_contacts_resolve_ambiguous_pillars_by_their_friction(self):
        run("simulate", SCENES / "touch/ambiguous_contacts.toml", "-o", self.recording, "--frames", 1)
        normals = []
        for known in ((), ("--friction", 1.2), ("--friction-bound", 1.5), ("--friction-prior", "3,0.1")):
            solved = run_json("solve", self.recording, "-o", self.forces, "--estimator", "contact", *known)
            self.assertGreater(solved["resolved"], 0)
            with h5py.File(self.forces) as file:
                normals.append(float(file["force/normal"][:].sum()))
        self.assertEqual(len(set(normals)), 4)
        # A larger friction leaves less normal force for the same readings.
        self.assertEqual(max(normals), normals[1])
        self.assertEqual(min(normals), normals[3])

    def test_info_describes_every_file(self):
        run("simulate", self.scene, "-o", self.recording)
        run("solve", self.recording, "-o", self.forces)
        facts = run_json("info", self.recording)
        self.assertEqual((facts["frames"], facts["truth"], facts["sensel_type"]), (6, True, "uint8"))
        facts = run_json("info", self.forces)
        self.assertEqual((facts["frames"], facts["estimator"], facts["source"]),
                         (6, "contact", "ball.h5"))
        self.assertEqual(run_json("info", self.scene)["title"], "A ball")
        run("simulate", SCENES / "touch/curved_skin.toml", "-o", self.recording, "--frames", 1, "--overwrite")
        facts = run_json("info", self.recording)
        self.assertEqual((facts["surface"], facts["surface_radius_mm"]), ("cylinder", 60))

    def test_kernel_holds_only_the_stages_of_its_scene(self):
        plan, source = run("info", "--kernel", self.scene).stdout.split("\n#line 1 ", 1)
        self.assertIn("kernel void solve_frame", source)
        self.assertIn("#define PF_SATURATION", plan)
        self.assertNotIn("#define PF_TARE", plan)
        self.scene.write_text(BALL.replace("noise_counts", "tare_counts = 3\nnoise_counts"))
        plan = run("info", "--kernel", self.scene).stdout.split("\n#line 1 ", 1)[0]
        self.assertIn("#define PF_TARE", plan)

    def test_devices_are_listed(self):
        devices = run_json("info", "--devices")
        self.assertEqual((devices[0]["type"], devices[0]["index"]), ("host", -1))
        self.assertTrue(any(device["unsuitable"] == "" for device in devices[1:]))
        run("simulate", self.scene, "-o", self.recording)
        line = self.assert_fails("solve", self.recording, "-o", self.forces, "--device",
                                 "no such device", names=["no such device", devices[1]["name"]])
        for wanted, kind in (("host", "host"), ("opencl", devices[1]["type"])):
            solved = run_json("solve", self.recording, "-o", self.forces, "--overwrite",
                              "--device", wanted)
            self.assertIn(solved["device"], [device["name"] for device in devices
                                             if device["type"] == kind])
        self.assertIn("suitable", line)


class BadInput(CommandTest):
    @unittest.skipUnless(pathlib.Path("/proc/kmsg").exists(), "Linux has it")
    def test_files_that_wait_for_data_are_not_waited_for(self):
        out = self.folder / "out.h5"
        for arguments in (("simulate", "/proc/kmsg", "-o", out),
                          ("solve", "/proc/kmsg", "-o", out)):
            self.assert_fails(*arguments, names=["/proc/kmsg"])

    def test_wrong_scene_names_its_line(self):
        scene = self.folder / "wrong.toml"
        scene.write_text(BALL + "colour = 3\n")
        line = len(BALL.splitlines()) + 1
        self.assert_fails("simulate", scene, "-o", self.folder / "out.h5",
                          names=[f"wrong.toml:{line}", "colour", "load_n"])
        self.assert_folder_holds("wrong.toml")

    def test_forces_of_another_patch_are_not_compared(self):
        scene = self.folder / "ball.toml"
        for name, size in (("a.h5", "[20, 20]"), ("b.h5", "[20, 22]")):
            scene.write_text(BALL.replace("[20, 20]", size))
            run("simulate", scene, "-o", self.folder / name)
        run("solve", self.folder / "a.h5", "-o", self.folder / "forces.h5")
        self.assert_fails("compare", self.folder / "forces.h5", self.folder / "b.h5",
                          names=["20 x 20", "20 x 22"])
        self.assert_fails("compare", self.folder / "a.h5", self.folder / "b.h5", names=["a.h5"])


if __name__ == "__main__":
    unittest.main()
