"""Runs the `pillarfield` command for the tests in this folder.

PILLARFIELD names the program and PILLARFIELD_SOURCE the source folder.
"""

import json
import os
import pathlib
import pty
import re
import subprocess
import tempfile
import unittest

import h5py

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


def datasets(path):
    """The datasets of an HDF5 file by name, but for the size that its writer noted."""
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update(
            {name: item[()]} if isinstance(item, h5py.Dataset) else {}))
    found.pop("flushed_bytes", None)
    found.pop("flushed_frames", None)
    return found


def run(*arguments, expect=0, **options):
    """Runs the command and returns its result; its exit status must be `expect`."""
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                            timeout=600, check=False, **options)
    assert result.returncode == expect, (
        f"{arguments} ended with {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


def run_json(*arguments):
    """Runs the command with --json and returns its output, which must be one JSON value."""
    return json.loads(run(*arguments, "--json").stdout)


def on_terminal(words, watch=lambda process, messages: True, **options):
    """Runs `words` with a terminal as standard error; returns exit status, output and messages. Calls
    watch(process, messages so far) until it returns true."""
    controller, terminal = pty.openpty()
    with tempfile.TemporaryFile("w+") as out, subprocess.Popen(
            words, stdout=out, stderr=terminal, stdin=subprocess.DEVNULL, **options) as process:
        os.close(terminal)
        messages, watched = "", False
        try:
            while chunk := os.read(controller, 4096).decode():
                # PoCL passes on warnings of its compiler for kernels outside its cache.
                messages += re.sub(r"\d+ warnings? generated.\r?\n", "", chunk)
                watched = watched or watch(process, messages)
        except OSError:
            pass  # The process closed the terminal.
        os.close(controller)
        status = process.wait(timeout=600)
        out.seek(0)
        return status, out.read(), messages


class CommandTest(unittest.TestCase):
    """A test with its own folder, `self.folder`."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def assert_fails(self, *arguments, names=(), status=1):
        """The command ends with `status` and one line on standard error with all `names`."""
        result = run(*arguments, expect=status)
        lines = result.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("pillarfield: "), lines[0])
        for words in names:
            self.assertIn(words, lines[0])
        self.assertEqual(result.stdout, "")
        return lines[0]

    def assert_folder_holds(self, *names):
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(names))
