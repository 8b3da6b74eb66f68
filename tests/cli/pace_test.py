"""`pillarfield pace`: frames at a fixed rate. The tests require no absolute speed."""

import signal
import time
import unittest

from command import BALL, PROGRAM, SCENES, CommandTest, on_terminal, run, run_json

SCENE = BALL.replace("[20, 20]", "[16, 16]").replace("noise_counts", "tare_counts = 4\nnoise_counts")

KEYS = ["source", "device", "zero_copy", "estimator", "stages", "pillar_rows", "pillar_cols",
        "frames_in_source", "frames_loaded", "rate_hz", "deadline_ms", "backlog_frames",
        "frames_in_flight", "spin_us", "realtime", "interrupted", "scheduled", "solved",
        "dropped", "missed", "seconds", "achieved_rate_hz", "latency_p50_ms", "latency_p99_ms",
        "latency_p99_9_ms", "latency_longest_ms", "latency_histogram", "cpu_cores",
        "voluntary_switches", "involuntary_switches", "minor_page_faults", "major_page_faults",
        "contact_share"]


class PaceTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(SCENE)

    def pace(self, *arguments):
        """Runs `pace` and returns its report, checked for consistency."""
        report = run_json("pace", *arguments)
        self.assertEqual(list(report), KEYS)
        self.assertEqual(report["scheduled"], report["solved"] + report["dropped"])
        self.assertLessEqual(report["missed"], report["solved"])
        self.assertAlmostEqual(report["achieved_rate_hz"] * report["seconds"], report["solved"],
                               delta=1e-3)
        latencies = [report[f"latency_{name}_ms"] for name in ("p50", "p99", "p99_9", "longest")]
        known = [latency for latency in latencies if latency is not None]
        self.assertEqual(known, sorted(known))
        self.assertEqual(known, [round(latency, 6) for latency in known])  # nanoseconds
        bins = report["latency_histogram"]
        self.assertEqual(sum(each["frames"] for each in bins), report["solved"])
        for lower, upper in zip(bins, bins[1:]):
            self.assertEqual(lower["to_ms"], upper["from_ms"])
        if bins:
            self.assertLessEqual(bins[-1]["from_ms"], report["latency_longest_ms"])
            self.assertGreater(bins[-1]["to_ms"], report["latency_longest_ms"])
        return report


class Run(PaceTest):
    def test_scene(self):
        report = self.pace(self.scene, "--rate", 200, "--seconds", 0.5)
        self.assertEqual(report["scheduled"], 100)
        self.assertGreaterEqual(report["seconds"], 0.5)
        self.assertEqual((report["frames_in_source"], report["frames_loaded"]), (6, 6))
        self.assertEqual((report["frames_in_flight"], report["backlog_frames"]), (2, 4))
        self.assertEqual((report["rate_hz"], report["deadline_ms"]), (200, 5))
        self.assertEqual((report["pillar_rows"], report["pillar_cols"]), (16, 16))
        self.assertFalse(report["interrupted"])
        self.assertIsNone(report["realtime"])
        self.assertGreater(report["contact_share"], 0.3)
        self.assertLess(report["contact_share"], 1)
        self.assertGreater(report["cpu_cores"], 0)
        self.assertIn("tare", report["stages"])

    def test_a_slow_rate_is_kept(self):
        report = self.pace(self.scene, "--rate", 20, "--seconds", 0.5, "--backlog", 1000)
        self.assertEqual((report["solved"], report["dropped"]), (10, 0))
        self.assertLess(report["achieved_rate_hz"], 22)

    def test_an_impossible_rate_is_not_hidden(self):
        report = self.pace(self.scene, "--rate", 100000, "--seconds", 0.2)
        self.assertEqual(report["scheduled"], 20000)
        self.assertGreater(report["dropped"], 0)
        self.assertGreater(report["missed"], 0)
        self.assertLess(report["achieved_rate_hz"], 100000)
        if report["dropped"] > 200:
            self.assertIsNone(report["latency_p99_ms"])

    def test_every_frame_misses_a_deadline_of_a_microsecond(self):
        arguments = (self.scene, "--rate", 100, "--seconds", 0.1, "--deadline", 0.001)
        report = self.pace(*arguments)
        self.assertEqual(report["missed"], report["solved"])
        result = run("pace", *arguments, "--strict", "--json", expect=1)
        self.assertIn("10 of 10 frames", result.stderr)
        self.assertIn('"missed":', result.stdout)

    def test_strict_accepts_a_run_without_failures(self):
        run("pace", self.scene, "--rate", 10, "--seconds", 0.3, "--deadline", 60000, "--backlog",
            100, "--strict")

    def test_recording(self):
        recording = self.folder / "ball.h5"
        run("simulate", self.scene, "-o", recording)
        report = self.pace(recording, "--rate", 50, "--seconds", 0.08)
        self.assertEqual((report["scheduled"], report["frames_loaded"]), (4, 4))

    def test_contacts(self):
        contact = ("--estimator", "contact", "--friction", 0.8, "--unrelated-frames")
        report = self.pace(self.scene, "--rate", 50, "--seconds", 0.3, "--backlog", 1000,
                           *contact)
        self.assertEqual(report["estimator"], "contact")
        self.assertIn("estimate_contacts", report["stages"])
        self.assertEqual(report["solved"], 15)  # the six frames come again
        self.scene.write_text(SCENE + '[solver]\nestimator = "contact"\nmemory = false\n')
        from_scene = self.pace(self.scene, "--rate", 50, "--seconds", 0.1)
        self.assertEqual(from_scene["stages"], report["stages"])

    def test_everything_has_the_stages_of_solve(self):
        recording = self.folder / "ball.h5"
        run("simulate", self.scene, "-o", recording)
        solve = ("solve", recording, "-o", self.folder / "forces.h5", "--everything")
        self.assert_fails(*solve, names=["noise"])
        solved = run_json(*solve, "--noise", 0.5)
        paced = self.pace(recording, "--rate", 50, "--seconds", 0.1, "--everything", "--noise", 0.5)
        self.assertEqual(solved["stages"], paced["stages"])
        plain = self.pace(recording, "--rate", 50, "--seconds", 0.1)
        for stage in ("parity_test", "angles", "uncertainty", "follow_baseline"):
            self.assertIn(stage, paced["stages"])
            self.assertNotIn(stage, plain["stages"])

    def test_memory_is_bounded(self):
        scene = self.folder / "large.toml"
        scene.write_text(SCENE.replace("[16, 16]", "[300, 300]"))
        arguments = ("pace", scene, "--rate", 20, "--seconds", 0.2, "--memory-limit", 1)
        result = run(*arguments, "--json")
        self.assertIn('"frames_loaded":2,', result.stdout)
        self.assertIn("2 of 6 frames fit into 1 MiB", result.stderr)
        scene.write_text(SCENE.replace("[16, 16]", "[600, 600]"))
        line = self.assert_fails(*arguments, names=["large.toml", "1440000 bytes"])
        self.assertIn("--memory-limit 2", line)

    def test_realtime_is_granted_or_warned_of(self):
        result = run("pace", self.scene, "--rate", 50, "--seconds", 0.1, "--realtime", "--json")
        for key, words in (("scheduling", "real-time scheduling: refused"),
                           ("locked_memory", "locked memory: refused")):
            self.assertEqual(f'"{key}":false' in result.stdout, words in result.stderr)

    def test_text(self):
        text = run("pace", self.scene, "--rate", 100, "--seconds", 0.2).stdout
        for words in ("16 x 16 pillars", "scheduled        20", "dropped", "missed", "p99.9", "#",
                      "cores", "In contact"):
            self.assertIn(words, text)

    def test_square_metre_has_every_stage(self):
        kernel = run("info", "--kernel", SCENES / "square_metre_live.toml").stdout
        plan = kernel.split("\n#line 1 ", 1)[0]
        for plane in ("TARE", "GAIN", "DEAD_ZONE", "MASK", "ANGLES", "UNCERTAINTY"):
            self.assertIn(f"#define PF_{plane}", plan)


class Interruption(PaceTest):
    def test_an_interrupted_run_is_reported(self):
        arguments = ["pace", self.scene, "--rate", "100", "--seconds", "60"]
        for extra, expected in (([], 0), (["--strict"], 1)):
            status, text = self.interrupted(arguments + extra)
            self.assertEqual(status, expected, text)
            self.assertIn("Interrupted", text)
            self.assertIn("scheduled", text)
            self.assertEqual("interrupted after" in text, "--strict" in extra)

    def interrupted(self, arguments):
        """Exit status and all output on a terminal after Ctrl-C during the run."""
        def interrupt(process, messages):
            if "Pacing for 60 s at 100 Hz, 6 frames repeated" in messages:
                time.sleep(0.3)
                process.send_signal(signal.SIGINT)
                return True
            return False
        status, out, messages = on_terminal([PROGRAM, *map(str, arguments)], interrupt)
        return status, out + messages


class BadArguments(PaceTest):
    def test_runs_of_no_length(self):
        for seconds in (0, 1e7):
            self.assert_fails("pace", self.scene, "--seconds", seconds, names=["--seconds", "give"])

    def test_sources_that_cannot_be_read(self):
        self.assert_fails("pace", self.folder / "absent.h5", names=["absent.h5"])
        self.assert_fails("pace", self.folder / "absent.toml", names=["absent.toml"])
        self.assert_fails("pace", self.scene, "--calibration", self.folder / "none.h5",
                          names=["none.h5"])
        noise = self.folder / "noise.h5"
        noise.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        self.assert_fails("pace", noise, names=["noise.h5"])

    def test_source_without_frames(self):
        import h5py  # pylint: disable=import-outside-toplevel
        recording = self.folder / "ball.h5"
        run("simulate", self.scene, "-o", recording)
        with h5py.File(recording, "r+") as file:
            frames = file["frames"]
            for name in ("raw", "time"):
                frames[name].resize(0, axis=0)
        error = run("pace", recording, expect=1).stderr.splitlines()[-1]
        self.assertRegex(error, "^pillarfield: .*ball.h5: it has no frames; give ")


if __name__ == "__main__":
    unittest.main()
