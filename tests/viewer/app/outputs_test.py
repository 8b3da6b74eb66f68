"""pillarfield-viewer --headless never overwrites its source nor other files."""

import os
import pathlib
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

VIEWER = os.environ["PILLARFIELD_VIEWER"]
PROGRAM = os.environ["PILLARFIELD"]

SCENE = """
[skin]
pillars = [16, 16]
[time]
frames = 12
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 4
load_n = 10
position_mm = [0, 0]
"""


class Outputs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "ball.toml").write_text(SCENE, encoding="utf-8")
        for arguments in (("simulate", "ball.toml", "-o", "rec.h5"),
                          ("solve", "rec.h5", "-o", "forces.h5")):
            subprocess.run([PROGRAM, *arguments], cwd=self.folder, check=True, timeout=600,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.link(self.folder / "forces.h5", self.folder / "hard_forces.h5")

    def view(self, *arguments):
        return subprocess.run([VIEWER, *arguments, "--headless"], cwd=self.folder, check=False,
                              capture_output=True, text=True, timeout=600)

    def assert_refused(self, *arguments, says):
        ended = self.view(*arguments)
        lines = ended.stderr.strip().splitlines()
        self.assertEqual((ended.returncode, len(lines)), (1, 1), ended)
        self.assertTrue(lines[0].startswith("pillarfield-viewer: "), lines)
        self.assertIn(says, lines[0])

    def test_the_source_and_other_files_are_never_written(self):
        before = {path: path.read_bytes() for path in self.folder.iterdir()}
        self.assert_refused("forces.h5", "--csv", "hard_forces.h5", "--overwrite",
                            says="is a file that is read")
        os.link(self.folder / "forces.h5", self.folder / "forces_02.png")
        self.assert_refused("forces.h5", "--frames", "1:3", "--png", "forces.png",
                            says="forces_02.png: is a file that is read")
        for path, content in before.items():
            self.assertEqual(path.read_bytes(), content, path)

    def test_the_default_is_the_most_loaded_frame(self):
        path = ", ".join(f"{{ time_s = {time}, position_mm = [0, 0], load_n = {load} }}"
                         for (time, load) in ((0.0, 1), (0.06, 10), (0.11, 4)))
        scene = SCENE.replace("load_n = 10\nposition_mm = [0, 0]",
                              f"reference_load_n = 10\npath = [{path}]")
        (self.folder / "pulse.toml").write_text(scene, encoding="utf-8")
        ended = self.view("pulse.toml", "--png", "x.png")
        if "Vulkan" in ended.stderr:
            self.skipTest(ended.stderr)
        self.assertEqual(ended.stdout, "Wrote x.png: frame 7 of 12, the most loaded\n", ended)
        self.view("pulse.toml", "--png", "same.png", "--frame", "7")
        self.assertEqual((self.folder / "x.png").read_bytes(),
                         (self.folder / "same.png").read_bytes())

    def test_a_picture_has_its_size_and_a_layer_needs_its_data(self):
        ended = self.view("ball.toml", "--size", "642x240", "--png", "new/one.png")
        if "Vulkan" in ended.stderr:
            self.skipTest(ended.stderr)
        self.assertEqual(ended.returncode, 0, ended)
        header = (self.folder / "new/one.png").read_bytes()[16:24]
        self.assertEqual(struct.unpack(">II", header), (642, 240))
        self.assert_refused("forces.h5", "--layer", "parity", "--png", "x.png", says="no data for parity")

    @unittest.skipUnless(shutil.which("ffprobe"), "ffprobe is not installed")
    def test_slow_motion(self):
        for options, pictures, seconds in (((), 8, 0.12), (("--speed", "0.1"), 12, 1.2),
                                           (("--speed", "0.1", "--fps", "30"), 36, 1.2),
                                           (("--speed", "2", "--fps", "25"), 2, 0.08)):
            ended = self.view("forces.h5", "--frames", "1:12", "--size", "320x240", "--video",
                              "x.mp4", *options)
            if "Vulkan" in ended.stderr:
                self.skipTest(ended.stderr)
            slower = "; --speed 0.1 makes it slower" if "0.1" not in options else ""
            self.assertRegex(ended.stdout, rf"^Wrote x.mp4: [0-9.]+ s long{slower}\n$")
            self.assertAlmostEqual(float(ended.stdout.split()[2]), seconds, delta=0.02)
            probe = subprocess.run(
                ["ffprobe", "-v", "error", "-show_entries", "stream=nb_frames,duration", "-of",
                 "csv=p=0", "x.mp4"], cwd=self.folder, check=True, capture_output=True, text=True)
            duration, count = probe.stdout.strip().split(",")
            self.assertEqual(int(count), pictures, options)
            self.assertAlmostEqual(float(duration), seconds, delta=0.02)

    def test_hang_up_ends_it_in_one_line(self):
        scene = self.folder / "long.toml"
        scene.write_text(SCENE.replace("frames = 12", "frames = 5000"), encoding="utf-8")
        with subprocess.Popen([VIEWER, "long.toml", "--headless", "--frames", "1:5000", "--png",
                               "long.png"], cwd=self.folder, stderr=subprocess.PIPE,
                              text=True) as process:
            deadline = time.monotonic() + 600
            while process.poll() is None and time.monotonic() < deadline:
                if any(self.folder.glob("long_*.png")):
                    process.send_signal(signal.SIGHUP)
                    break
                time.sleep(0.02)
            try:
                _, complaint = process.communicate(timeout=600)
            finally:
                process.kill()
        if "Vulkan" in complaint:
            self.skipTest(complaint)
        # PoCL may print messages of its compiler first.
        lines = [line for line in complaint.splitlines() if "pillarfield-viewer" in line]
        self.assertEqual((process.returncode, len(lines)), (1, 1), complaint)
        self.assertIn("interrupted after", lines[0])
        self.assertEqual(list(self.folder.glob("*.part")), [])


if __name__ == "__main__":
    unittest.main()
