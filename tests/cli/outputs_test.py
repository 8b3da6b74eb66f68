"""Outputs of the commands never replace inputs, recordings or a concurrent output."""

import os
import shutil
import signal
import subprocess
import time
import unittest

import h5py
import numpy

from command import PROGRAM, CommandTest, datasets, run

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
    """The bytes of an HDF5 file's datasets, for comparison."""
    return {name: values.tobytes() for name, values in datasets(path).items()}


class OutputTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(SCENE + BALL, encoding="utf-8")

    def record(self, name="rec.h5", *options):
        run("simulate", self.scene, "-o", self.folder / name, *options)
        return self.folder / name


class HeightMaps(OutputTest):
    def test_the_height_map_of_a_scene_is_an_input(self):
        heights = self.folder / "h.npy"
        numpy.save(heights, numpy.arange(64.0).reshape(8, 8))
        before = heights.read_bytes()
        scene = self.folder / "map.toml"
        scene.write_text(SCENE + '[[indenter]]\nshape = "height_map"\nheight_map = "h.npy"\n'
                         'height_map_size_mm = [8, 8]\nheight_map_depth_mm = 1\nfriction = 1\n'
                         'path = [{ time_s = 0, position_mm = [0, 0], load_n = 1 }]\n', encoding="utf-8")
        self.assert_fails("simulate", scene, "-o", heights, "--overwrite", names=["h.npy"])
        self.assertEqual(heights.read_bytes(), before)


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

    def test_no_command_writes_onto_them(self):
        recording, calibration, scene, table, tare = (
            "rec.h5", "cal.h5", "ball.toml", "rec.csv", "tare.h5")
        aims = [
            ("simulate", scene, "-o", "soft_ball.toml"),
            ("solve", recording, "-o", "hard_rec.h5"),
            ("solve", recording, "-o", calibration, "--calibration", calibration),
            ("solve", recording, "--scene", "hard_ball.toml", "-o", "f.h5", "--contacts",
             "ball.csv"),
            ("solve", table, "-o", "f.h5", "--contacts", "soft_rec.csv"),
            ("calibrate", "tare", tare, "--calibration", calibration, "-o", calibration),
            ("calibrate", "equilibrate", tare, recording, "--pressure-kpa", "50,100",
             "--calibration", calibration, "-o", recording),
            ("calibrate", "apply", calibration, recording, "-o", recording),
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

class Existing(OutputTest):
    def test_recordings_are_replaced_only_with_overwrite(self):
        recording = self.record()
        before = recording.read_bytes()
        other = self.record("other.h5", "--seed", 7)
        for arguments in (("simulate", self.scene, "-o", recording),
                          ("solve", other, "-o", recording),
                          ("calibrate", "tare", other, "-o", recording)):
            self.assert_fails(*arguments, names=["rec.h5", "not an earlier result", "--overwrite"])
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
        self.assert_fails("simulate", self.scene, "-o", notes, names=["notes.toml", "--overwrite"])

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
            deadline = time.monotonic() + 600
            while until and process.poll() is None and time.monotonic() < deadline:
                if self.part.exists() and self.part.stat().st_size > 3_000_000:
                    until(process)
                    break
                time.sleep(0.01)
            _, error = process.communicate(timeout=600)
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

    def test_hang_up_stays_ignored(self):
        def hang_up_then_stop(process):
            process.send_signal(signal.SIGHUP)
            size = self.part.stat().st_size
            deadline = time.monotonic() + 600
            while self.part.stat().st_size <= size and time.monotonic() < deadline:
                time.sleep(0.01)
            self.assertIsNone(process.poll())
            process.send_signal(signal.SIGTERM)
        status, _ = self.simulate(hang_up_then_stop,
                                  preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.assertEqual(status, 1)


if __name__ == "__main__":
    unittest.main()
