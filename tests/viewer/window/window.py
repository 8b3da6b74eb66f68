"""A window of pillarfield-viewer under a display without a screen, and what its tests share."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import numpy
from PIL import Image
from display import Display

VIEWER = os.environ["PILLARFIELD_VIEWER"]
PROGRAM = os.environ["PILLARFIELD"]
SCENES = pathlib.Path(os.environ["PILLARFIELD_SOURCE"]) / "scenes"
PICTURES = pathlib.Path(os.environ.get("PILLARFIELD_PICTURES", tempfile.gettempdir()))
WIDTH, HEIGHT = 1280, 720
PATIENCE_S = 60  # of a busy machine


class Window:
    """A running viewer with keyboard focus."""

    def __init__(self, screen, folder, *arguments):
        self.screen = screen
        self.errors = open(folder / "stderr.txt", "w+", encoding="utf-8")
        self.process = subprocess.Popen(
            [VIEWER, *map(str, arguments), "--validate", "--statistics"], cwd=folder,
            env={**screen.environment(), "XDG_CONFIG_HOME": str(folder / "config")},
            stdout=subprocess.PIPE, stderr=self.errors, text=True)
        self.id = self.wait_for_window()
        screen.xdotool("windowfocus", "--sync", self.id)

    def wait_for_window(self):
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline:
            if self.process.poll() is not None:
                raise AssertionError("the viewer ended: " + self.error_text())
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Pillarfield"],
                                   env=self.screen.environment(), capture_output=True, text=True,
                                   check=False).stdout.split()
            if found:
                return found[0]
            time.sleep(0.1)
        raise AssertionError(f"no window came within {PATIENCE_S} s")

    def wait_for_source(self):
        """Until it is open, as the window's title tells."""
        deadline = time.monotonic() + PATIENCE_S
        while "–" not in self.screen.xdotool("getwindowname", self.id):
            assert self.process.poll() is None, "the viewer ended: " + self.error_text()
            assert time.monotonic() < deadline, f"the source does not open within {PATIENCE_S} s"
            time.sleep(0.05)

    def error_text(self):
        self.errors.seek(0)
        return self.errors.read()

    def key(self, name):
        self.screen.xdotool("key", "--window", self.id, name)

    def sleep(self, sleeps=True):
        """Draws no more, as if a frame took long, or goes on."""
        self.process.send_signal(signal.SIGSTOP if sleeps else signal.SIGCONT)

    def quit(self):
        """Closes the window by its key; returns the statistics."""
        self.key("q")
        try:
            (output, _) = self.process.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired as late:
            raise AssertionError(f"the key Q does not end the viewer within {PATIENCE_S} s") from late
        assert self.process.returncode == 0, self.error_text()
        return json.loads(output)

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()
        self.errors.close()


class WindowTest(unittest.TestCase):
    SIZE = (WIDTH, HEIGHT)

    @classmethod
    def setUpClass(cls):
        cls.server_folder = tempfile.TemporaryDirectory()
        (width, height) = cls.SIZE
        cls.screen = Display(pathlib.Path(cls.server_folder.name), width + 160, height + 120)

    @classmethod
    def tearDownClass(cls):
        cls.screen.close()
        cls.server_folder.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (width, height) = self.SIZE
        self.screen.xdotool("mousemove", width + 150, height + 110)

    def open(self, *arguments, waits=True):
        window = Window(self.screen, self.folder, *arguments)
        self.addCleanup(window.kill)
        if waits and arguments and not str(arguments[0]).startswith(("-", "udp:")):
            window.wait_for_source()
        return window

    def shoot(self, name, still=True):
        pixels = self.screen.still_pixels() if still else self.screen.pixels()
        Image.fromarray(pixels).save(PICTURES / f"window_{name}.png", compress_level=1)
        return pixels

    def wait_for(self, condition, what):
        """Waits until condition() is true, and returns its value."""
        end = time.monotonic() + PATIENCE_S
        while not (value := condition()):
            self.assertLess(time.monotonic(), end, f"{what} within {PATIENCE_S} s")
            time.sleep(0.1)
        return value

    def shoot_changed(self, name, *before, still=True):
        """Waits for a picture other than all those before."""
        def changed():
            pixels = self.shoot(name, still)
            return None if any(numpy.array_equal(each, pixels) for each in before) else [pixels]
        return self.wait_for(changed, f"no new picture '{name}'")[0]

    def wait_for_motion(self, pictures=4):
        """Waits for pictures each of which differs from the one before."""
        last = self.screen.pixels()
        for _ in range(pictures):
            last = self.shoot_changed("moving", last, still=False)

    def shoot_page(self, name):
        """Waits for a page with words."""
        self.wait_for(lambda: (self.screen.pixels().min(axis=2) > 180).any(), "no page is shown")
        return self.shoot(name)

    def settings(self):
        """What the viewer remembers between runs."""
        file = self.folder / "config/pillarfield/viewer.conf"
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def assert_quiet(self, window):
        """Closes the window; expects no validation messages."""
        statistics = window.quit()
        text = window.error_text()
        self.assertNotIn("validation", text.lower())
        self.assertEqual(statistics["validation_messages"], 0, text)
        return statistics


def field_of(pixels, statistics):
    (x, y, width, height) = statistics["field"]
    return pixels[y:y + height, x:x + width]
