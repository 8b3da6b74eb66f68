"""Runs the `pillarfield` command for the tests beside this file.

The environment gives PILLARFIELD, the program, and PILLARFIELD_SOURCE, the project's folder.
"""

import json
import os
import pathlib
import pty
import re
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PILLARFIELD"]
SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
SCENES = SOURCE / "scenes"

BALL = """
title = "A ball"
[skin]
pillars = [20, 20]
threshold_counts = 2
[time]
frames = 6
[sensor]
adc_bits = 8
noise_counts = 0.5
[[contact]]
shape = "sphere"
motion = "slide"
contact_radius_mm = 8
load_n = 20
position_mm = [0, 0]
friction = 0.5
direction_deg = 30
"""


def run(*arguments, expect=0, **options):
    """Runs the command and returns its result; its exit status must be `expect`."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                            timeout=120, check=False, **options)
    assert result.returncode == expect, (
        f"{arguments} ended with {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


def run_json(*arguments):
    """Runs the command with --json and returns what it printed, which must be JSON and all of it."""
    return json.loads(run(*arguments, "--json").stdout)


def on_terminal(words, watch=lambda process, said: True, **options):
    """Runs `words` with standard error a terminal: exit status, standard output, what was said there.
    watch(process, said) is called with all of it so far until it returns true."""
    controller, terminal = pty.openpty()
    with tempfile.TemporaryFile("w+") as out, subprocess.Popen(
            words, stdout=out, stderr=terminal, stdin=subprocess.DEVNULL, **options) as process:
        os.close(terminal)
        said, watched = "", False
        try:
            while chunk := os.read(controller, 4096).decode():
                # PoCL lets its compiler say so where a kernel is not in its cache yet.
                said += re.sub(r"\d+ warnings? generated.\r?\n", "", chunk)
                watched = watched or watch(process, said)
        except OSError:
            pass  # Nobody has the other end any more.
        os.close(controller)
        status = process.wait(timeout=120)
        out.seek(0)
        return status, out.read(), said


class CommandTest(unittest.TestCase):
    """A test with a folder of its own, `self.folder`."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def assert_fails(self, *arguments, says=(), status=1):
        """The command ends with `status` and one line on standard error that says all of `says`."""
        result = run(*arguments, expect=status)
        lines = result.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("pillarfield: "), lines[0])
        for words in says:
            self.assertIn(words, lines[0])
        self.assertEqual(result.stdout, "")
        return lines[0]

    def assert_folder_holds(self, *names):
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(names))
