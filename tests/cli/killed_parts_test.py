"""Processes killed at any time: a restart ends with the serial bits."""

import os
import random
import shlex
import shutil
import signal
import subprocess
import time
import unittest

from command import PROGRAM, run
from parts_test import CARRYING, PartsFolder

FRAMES = 600
PLAN = (*CARRYING, "--checkpoint-every", 25)


class Killed(PartsFolder):
    def setUp(self):
        super().setUp()
        scene = self.folder / "ball.toml"
        scene.write_text(scene.read_text().replace("frames = 23", f"frames = {FRAMES}")
                         .replace("[20, 20]", "[80, 80]"), encoding="utf-8")
        run("simulate", scene, "-o", self.recording, "--overwrite")
        self.serial = self.folder / "serial.h5"
        self.solve(*PLAN, "--contacts", self.serial, output=self.serial)
        self.command = [PROGRAM, "solve", self.recording, "-o", self.output, *map(str, PLAN),
                        "--contacts", self.output, "-q"]
        self.all_parts = " && ".join(f"{shlex.join(map(str, self.command))} --part {part}/8"
                                     for part in range(1, 9))

    def assert_joined(self):
        run("join", self.output, "--overwrite")
        self.assert_same(self.serial, self.output)

    def test_ten_kills(self):
        rng = random.Random(21)
        kills = 0
        while kills < 10:
            shutil.rmtree(self.parts, ignore_errors=True)
            while True:
                process = subprocess.Popen(self.all_parts, shell=True, start_new_session=True)
                time.sleep(rng.uniform(0.05, 1.2))
                os.killpg(process.pid, signal.SIGKILL)
                if process.wait(600) != -signal.SIGKILL:
                    break  # It was faster.
                kills += 1
                if kills % 4 == 0:
                    break
            subprocess.run(self.all_parts, shell=True, check=True, timeout=600)
            self.assert_joined()


if __name__ == "__main__":
    unittest.main()
