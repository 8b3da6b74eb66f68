"""Outputs of the commands never replace inputs, recordings or a concurrent output.

`outputs_test.py --pairs 20` races 20 pairs of writers.
"""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

from command import PROGRAM, CommandTest, run, run_json

PAIRS = 6

SCENE = """
[skin]
pillars = [24, 24]
threshold_counts = 2
[time]
frames = 4
[sensor]
noise_counts = 0.5
"""
BALL = """
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 6
load_n = 20
position_mm = [0, 0]
"""


def content_of(path):
    """The content of a file, for comparison."""
    if path.suffix != ".h5":
        return path.read_bytes()
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update(
            {name: item[()].tobytes()} if isinstance(item, h5py.Dataset) else {}))
    return found


class OutputTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(SCENE + BALL, encoding="utf-8")

    def record(self, name="rec.h5", *options):
        run("simulate", self.scene, "-o", self.folder / name, *options)
        return self.folder / name


class Inputs(OutputTest):
    """An input is never written, whatever its path."""

    def setUp(self):
        super().setUp()
        empty = self.folder / "empty.toml"
        empty.write_text(SCENE.replace("frames = 4", "frames = 40"), encoding="utf-8")
        run("simulate", empty, "-o", self.folder / "tare.h5", "--uncalibrated")
        run("calibrate", "tare", self.folder / "tare.h5", "-o", self.folder / "cal.h5")
        self.record()
        shutil.copy(self.folder / "rec.h5", self.folder / "new.h5.part")
        self.table = self.folder / "rec.csv"
        self.table.write_text("DATA_TYPE MOVIE\nROWS 2\nCOLS 2\nUNITS RAW\nASCII_DATA @@\n\n"
                              "Frame 1\n5,5\n5,5\n@@\n", encoding="utf-8")
        for name in ("rec.h5", "cal.h5", "ball.toml", "rec.csv", "tare.h5"):
            (self.folder / f"soft_{name}").symlink_to(name)
            os.link(self.folder / name, self.folder / f"hard_{name}")
        (self.folder / "here").symlink_to(".")

    def test_no_command_writes_onto_them(self):
        recording, calibration, scene, table, tare = (
            "rec.h5", "cal.h5", "ball.toml", "rec.csv", "tare.h5")
        load = ("--load-n", 20, "--calibration", calibration)
        press = ("--pressure-kpa", 100, "--calibration", calibration)
        aims = [
            ("simulate", scene, "-o", scene),
            ("simulate", scene, "-o", "soft_ball.toml"),
            ("simulate", "soft_ball.toml", "-o", "hard_ball.toml"),
            ("solve", recording, "-o", recording),
            ("solve", recording, "-o", "soft_rec.h5"),
            ("solve", recording, "-o", "hard_rec.h5"),
            ("solve", recording, "-o", "./here/../" + self.folder.name + "/here/rec.h5"),
            ("solve", "hard_rec.h5", "-o", self.folder / "soft_rec.h5"),
            ("solve", "new.h5.part", "-o", "new.h5"),
            ("solve", recording, "-o", calibration, "--calibration", calibration),
            ("solve", recording, "-o", "hard_cal.h5", "--calibration", calibration),
            ("solve", recording, "--scene", "hard_ball.toml", "-o", "f.h5", "--contacts",
             "ball.csv"),
            ("solve", table, "-o", table),
            ("solve", table, "-o", "hard_rec.csv"),
            ("solve", table, "-o", "f.h5", "--contacts", table),
            ("solve", table, "-o", "f.h5", "--contacts", "soft_rec.csv"),
            ("solve", table, "-o", "f.npy", "--contacts", "here/hard_rec.csv"),
            ("calibrate", "tare", tare, "-o", tare),
            ("calibrate", "tare", tare, "-o", "hard_tare.h5"),
            ("calibrate", "tare", tare, "--calibration", calibration, "-o", calibration),
            ("calibrate", "tare", tare, "--calibration", calibration, "-o", "soft_cal.h5"),
            ("calibrate", "equilibrate", tare, recording, "--pressure-kpa", "50,100",
             "--calibration", calibration, "-o", recording),
            ("calibrate", "equilibrate", tare, *press, "-o", "hard_cal.h5"),
            ("calibrate", "load", recording, *load, "-o", "soft_rec.h5"),
            ("calibrate", "load", recording, *load, "-o", calibration),
            ("calibrate", "faults", recording, "--calibration", calibration, "-o", "hard_rec.h5"),
            ("calibrate", "faults", recording, "--calibration", calibration, "-o", calibration),
            ("calibrate", "apply", calibration, recording, "-o", recording),
            ("calibrate", "apply", calibration, recording, "-o", "soft_cal.h5"),
            ("calibrate", "apply", calibration, "new.h5.part", "-o", "new.h5"),
        ]
        # Another name of the scene, given as table of contacts.
        os.link(self.scene, self.folder / "ball.csv")
        before = {path: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}
        names = sorted(path.name for path in self.folder.iterdir())
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        for arguments in aims:
            for leave in ((), ("--overwrite",)):
                with self.subTest(arguments=arguments, leave=leave):
                    line = self.assert_fails(*arguments, *leave, names=["read"])
                    self.assertIn("write to another file", line)
        self.assert_folder_holds(*names)
        for path, content in before.items():
            self.assertEqual(path.read_bytes(), content, path)

    def test_two_outputs_of_a_command_are_two_files(self):
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        (self.folder / "link.csv").symlink_to("x.csv")
        for table in ("x.csv", "./x.csv", "here/x.csv", "link.csv"):
            self.assert_fails("solve", "rec.h5", "-o", "x.csv", "--contacts", table,
                              names=["share this file"])
        self.assertFalse((self.folder / "x.csv").exists())


class Existing(OutputTest):
    def test_recordings_are_replaced_only_with_overwrite(self):
        recording = self.record()
        before = recording.read_bytes()
        other = self.record("other.h5", "--seed", 7)
        for arguments in (("simulate", self.scene, "-o", recording),
                          ("solve", other, "-o", recording),
                          ("calibrate", "tare", other, "-o", recording)):
            self.assert_fails(*arguments, names=["rec.h5", "holds a recording", "--overwrite"])
        self.assertEqual(recording.read_bytes(), before)
        run("simulate", self.scene, "-o", recording, "--seed", 7, "--overwrite")
        self.assertEqual(content_of(recording), content_of(other))

    def test_forces_are_replaced_by_forces_and_nothing_else(self):
        recording = self.record()
        for name in ("f.h5", "f.csv", "f.npy"):
            output = self.folder / name
            run("solve", recording, "-o", output)
            run("solve", recording, "-o", output)
            output.write_text("my notes\n", encoding="utf-8")
            self.assert_fails("solve", recording, "-o", output, names=[name, "--overwrite"])
            self.assertEqual(output.read_text(encoding="utf-8"), "my notes\n")
            run("solve", recording, "-o", output, "--overwrite")
        notes = self.folder / "notes.toml"
        notes.write_text("[a]\n", encoding="utf-8")
        self.assert_fails("simulate", self.scene, "-o", notes, names=["notes.toml", "TOML"])

    def test_a_link_at_the_name_stays(self):
        (self.folder / "far").mkdir()
        (self.folder / "f.csv").symlink_to("far/real.csv")
        run("solve", self.record(), "-o", self.folder / "f.csv")
        self.assertTrue((self.folder / "f.csv").is_symlink())
        self.assertIn("frame,time_s", (self.folder / "far/real.csv").read_text(encoding="utf-8"))

    def test_a_link_at_the_part_is_refused(self):
        victim = self.folder / "victim"
        victim.write_text("precious", encoding="utf-8")
        recording = self.record()
        for name in ("f.h5", "f.csv", "f.npy"):
            (self.folder / (name + ".part")).symlink_to("victim")
            self.assert_fails("solve", recording, "-o", self.folder / name,
                              names=[name + ".part", "symbolic link"])
        (self.folder / "new.h5.part").symlink_to("victim")
        self.assert_fails("simulate", self.scene, "-o", self.folder / "new.h5",
                          names=["symbolic link"])
        self.assertEqual(victim.read_text(encoding="utf-8"), "precious")


class Race(OutputTest):
    """Of two writers of one output one completes it and the other ends with one line."""

    FRAMES = 1500

    def start(self, command, errors):
        # pylint: disable=consider-using-with
        return subprocess.Popen([PROGRAM, *map(str, command), "--quiet"],
                                stdout=subprocess.DEVNULL, stderr=errors)

    @staticmethod
    def writers_of(processes, part):
        """The processes that have opened the part."""
        def has_it(process):
            folder = f"/proc/{process.pid}/fd"
            try:
                return any(os.readlink(f"{folder}/{name}") == str(part)
                           for name in os.listdir(folder))
            except OSError:
                return False
        return [process for process in processes if has_it(process)]

    def race(self, commands, output, wait_s):
        """Starts two commands `wait_s` apart and stops the first writer until the other has ended, so that
        they overlap on slow machines too. Returns the index of the winner."""
        logs = [open(self.folder / f"log_{index}", "w+", encoding="utf-8") for index in range(2)]
        processes = [self.start(commands[0], logs[0])]
        time.sleep(wait_s)
        processes.append(self.start(commands[1], logs[1]))
        part = output.with_name(output.name + ".part")
        held = []
        while not held and all(process.poll() is None for process in processes):
            held = self.writers_of(processes, part)
            for process in held:
                process.send_signal(signal.SIGSTOP)
            if len(held) == 2:  # One of them will find it locked.
                for process in held:
                    process.send_signal(signal.SIGCONT)
                held = []
        others = [process for process in processes if process not in held]
        if held:
            others[0].wait(60)
            held[0].send_signal(signal.SIGCONT)
        statuses = [process.wait(60) for process in processes]
        texts = []
        for log in logs:
            log.seek(0)
            texts.append(log.read())
            log.close()
        self.assertEqual(sorted(statuses), [0, 1], texts)
        winner = statuses.index(0)
        self.assertEqual(texts[winner], "")
        loser = texts[1 - winner].strip().splitlines()
        self.assertEqual(len(loser), 1, texts)
        self.assertRegex(loser[0], "being written by another process|exists and holds")
        self.assertFalse(part.exists())
        return winner

    def test_pairs(self):
        scene = self.scene.read_text(encoding="utf-8")
        self.scene.write_text(scene.replace("frames = 4", f"frames = {self.FRAMES}"),
                              encoding="utf-8")
        sources = [self.record(f"seed_{seed}.h5", "--seed", seed) for seed in (1, 2)]
        expected = {".rec": [content_of(source) for source in sources]}
        for ending in (".h5", ".csv"):
            expected[ending] = []
            for index, source in enumerate(sources):
                reference = self.folder / f"reference_{index}{ending}"
                run("solve", source, "-o", reference)
                expected[ending].append(content_of(reference))
                reference.unlink()
        for pair in range(PAIRS):
            kind = (".rec", ".h5", ".csv")[pair % 3]
            wait_s = 0 if pair % 2 == 0 else 0.005 * (pair % 7)
            with self.subTest(pair=pair, kind=kind, wait_s=wait_s):
                output = self.folder / ("both" + (".h5" if kind == ".rec" else kind))
                if kind == ".rec":
                    commands = [("simulate", self.scene, "--seed", seed, "-o", output)
                                for seed in (1, 2)]
                else:
                    commands = [("solve", source, "-o", output) for source in sources]
                winner = self.race(commands, output, wait_s)
                self.assertTrue(content_of(output) == expected[kind][winner], "it is mixed")
                output.unlink()


class Ends(OutputTest):
    """Signals and limits end in one line and keep flushed frames."""

    def setUp(self):
        super().setUp()
        scene = self.scene.read_text(encoding="utf-8")
        self.scene.write_text(scene.replace("frames = 4", "frames = 1000000"), encoding="utf-8")
        self.part = self.folder / "long.h5.part"

    def simulate(self, until=None, **options):
        with subprocess.Popen([PROGRAM, "simulate", self.scene, "-o", self.folder / "long.h5"],
                              stderr=subprocess.PIPE, text=True, **options) as process:
            deadline = time.monotonic() + 60
            while until and process.poll() is None and time.monotonic() < deadline:
                if self.part.exists() and self.part.stat().st_size > 3_000_000:
                    until(process)
                    break
                time.sleep(0.01)
            _, error = process.communicate(timeout=60)
        return process.returncode, error.strip().splitlines()

    def assert_part_is_read(self):
        with h5py.File(self.part, "r", swmr=True) as file:
            frames = file["frames/raw"].shape[0]
            self.assertTrue(numpy.all(numpy.diff(file["frames/time"][:frames]) > 0))
        self.assertGreater(frames, 0)
        run("info", self.part)

    def test_signals_end_it_in_one_line(self):
        for ending in (signal.SIGHUP, signal.SIGINT):
            status, lines = self.simulate(lambda process, ending=ending: process.send_signal(ending))
            self.assertEqual((status, len(lines)), (1, 1), lines)
            self.assertIn("long.h5: interrupted after", lines[0])
            self.assert_part_is_read()
            self.part.unlink()

    def test_killed(self):
        status, _ = self.simulate(lambda process: process.send_signal(signal.SIGKILL))
        self.assertEqual(status, -signal.SIGKILL)
        self.assertFalse((self.folder / "long.h5").exists())
        facts = run_json("info", self.part)
        self.assertGreater(facts["frames"], 16)
        self.assertTrue(facts["truth"])
        forces = self.folder / "forces.h5"
        self.assertEqual(run_json("solve", self.part, "-o", forces)["frames"], facts["frames"])
        self.assertLess(run_json("compare", forces, self.part)["regions"]["1"]["rms_n"], 1.5 / 320)

    def test_hang_up_is_ignored_where_it_was(self):
        def hang_up_then_stop(process):
            process.send_signal(signal.SIGHUP)
            size = self.part.stat().st_size
            deadline = time.monotonic() + 60
            while self.part.stat().st_size <= size and time.monotonic() < deadline:
                time.sleep(0.01)
            self.assertIsNone(process.poll())
            process.send_signal(signal.SIGTERM)
        status, _ = self.simulate(hang_up_then_stop,
                                  preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.assertEqual(status, 1)

    def test_limit_of_the_file_size(self):
        def limit(size):
            return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        for size in (0, 1000, 200_000):
            status, lines = self.simulate(preexec_fn=limit(size))
            self.assertEqual((status, len(lines)), (1, 1), lines)
            self.assertIn("File too large", lines[0])
            self.assertFalse(self.part.exists())
        status, lines = self.simulate(preexec_fn=limit(6_000_000))
        self.assertEqual((status, len(lines)), (1, 1), lines)
        self.assertIn("File too large", lines[0])
        self.assert_part_is_read()

    def test_limit_of_the_file_size_of_forces(self):
        recording = self.record("rec.h5", "--frames", 300)
        for name in ("f.csv", "f.npy", "f.h5"):
            result = subprocess.run(
                [PROGRAM, "solve", recording, "-o", self.folder / name], capture_output=True,
                text=True, check=False, timeout=60, preexec_fn=lambda: resource.setrlimit(
                    resource.RLIMIT_FSIZE, (100_000, 100_000)))
            lines = result.stderr.strip().splitlines()
            self.assertEqual((result.returncode, len(lines)), (1, 1), lines)
            self.assertIn("File too large", lines[0])
            self.assertFalse((self.folder / name).exists())


if __name__ == "__main__":
    if "--pairs" in sys.argv:
        at = sys.argv.index("--pairs")
        PAIRS = int(sys.argv[at + 1])
        del sys.argv[at:at + 2]
    unittest.main()
