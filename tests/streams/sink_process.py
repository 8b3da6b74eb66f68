"""Runs streams_sink_driver for the tests in this folder. STREAMS_SINK_DRIVER names the program."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

DRIVER = os.environ["STREAMS_SINK_DRIVER"]

# Contacts come, move and go; one leaves and another takes its slot.
SCENE = """
title = "Contacts that come and go"
[skin]
pillars = [30, 24]
threshold_counts = 2
[sensor]
noise_counts = 0.4
adc_bits = {bits}
[time]
rate_hz = 100
frames = 40
[[contact]]
shape = "sphere"
motion = "slide"
contact_radius_mm = 5
reference_load_n = 20
friction = 0.6
direction_deg = 30
path = [
  {{ time_s = 0.00, position_mm = [-10, 5], load_n = 0 }},
  {{ time_s = 0.05, position_mm = [-10, 5], load_n = 20 }},
  {{ time_s = 0.20, position_mm = [-8, 6], load_n = 0 }},
]
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 5
reference_load_n = 20
path = [
  {{ time_s = 0.00, position_mm = [8, -6], load_n = 15 }},
  {{ time_s = 0.25, position_mm = [8, -6], load_n = 20 }},
  {{ time_s = 0.30, position_mm = [8, -6], load_n = 0 }},
]
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 5
reference_load_n = 20
path = [
  {{ time_s = 0.22, position_mm = [9, 8], load_n = 0 }},
  {{ time_s = 0.30, position_mm = [9, 8], load_n = 20 }},
  {{ time_s = 0.39, position_mm = [9, 8], load_n = 20 }},
]
"""

ALL_PLANES = SCENE.format(bits=8) + "[solver]\nuncertainty = true\n"


class SinkTest(unittest.TestCase):
    """A test with its own folder and the scene in it."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.scene = self.write_scene("scene.toml", SCENE.format(bits=8))

    def write_scene(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def start(self, *arguments, scene=None):
        """Starts the driver, and returns it once its sinks are open."""
        process = subprocess.Popen([DRIVER, str(scene or self.scene), *map(str, arguments)],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        line = process.stdout.readline()
        self.assertTrue(line.startswith("ready"), line or process.stderr.read())
        process.sinks = line.split()[1:]
        return process

    @staticmethod
    def end(process):
        process.kill()
        process.communicate()

    def results(self, process):
        """Waits for the end; returns the statistics of each sink by its name."""
        out, errors = process.communicate(timeout=600)
        self.assertEqual((process.returncode, errors), (0, ""))
        lines = [json.loads(line) for line in out.splitlines()]
        return {line["name"]: line for line in lines}

    def run_driver(self, *arguments, **options):
        return self.results(self.start(*arguments, **options))
