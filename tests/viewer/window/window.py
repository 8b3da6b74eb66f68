"""A window of pillarfield-viewer under a display without a screen, and what its tests share."""

import json
import os
import pathlib
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
PATIENCE_S = 600  # of a busy machine


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
        if arguments and not str(arguments[0]).startswith(("-", "udp:")):
            self.wait_for_source()

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
        raise AssertionError("no window came")

    def wait_for_source(self):
        """Until it is open, as the window's title tells."""
        deadline = time.monotonic() + PATIENCE_S
        while "–" not in self.screen.xdotool("getwindowname", self.id):
            assert self.process.poll() is None, "the viewer ended: " + self.error_text()
            assert time.monotonic() < deadline, "the source does not open"
            time.sleep(0.05)

    def error_text(self):
        self.errors.seek(0)
        return self.errors.read()

    def key(self, name):
        self.screen.xdotool("key", "--window", self.id, name)

    def move(self, x, y):
        self.screen.xdotool("mousemove", "--window", self.id, round(x), round(y))

    def drag(self, begin, end, button=1):
        self.move(*begin)
        self.screen.xdotool("mousedown", button)
        time.sleep(0.15)  # A busy machine draws few frames, and a drag needs several.
        for share in (0.3, 0.7, 1):
            self.move(begin[0] + share * (end[0] - begin[0]),
                      begin[1] + share * (end[1] - begin[1]))
            time.sleep(0.15)
        self.screen.xdotool("mouseup", button)

    def quit(self):
        """Closes the window by its key; returns the statistics."""
        self.key("q")
        (output, _) = self.process.communicate(timeout=PATIENCE_S)
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

    def open(self, *arguments):
        window = Window(self.screen, self.folder, *arguments)
        self.addCleanup(window.kill)
        return window

    def shoot(self, name, still=True):
        pixels = self.screen.still_pixels() if still else self.screen.pixels()
        Image.fromarray(pixels).save(PICTURES / f"window_{name}.png", compress_level=1)
        return pixels

    def wait_for(self, condition, what):
        """Waits until condition() is true, and returns its value."""
        end = time.monotonic() + PATIENCE_S
        while not (value := condition()):
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.1)
        return value

    def shoot_changed(self, name, *before, still=True):
        """Waits for a picture other than all those before."""
        def changed():
            pixels = self.shoot(name, still)
            return None if any(numpy.array_equal(each, pixels) for each in before) else [pixels]
        return self.wait_for(changed, name)[0]

    def act(self, name, action, *before):
        """Acts until a new picture comes: a window that draws seldom misses short actions."""
        for _ in range(4):
            action()
            end = time.monotonic() + 15
            while time.monotonic() < end:
                pixels = self.shoot(name)
                if not any(numpy.array_equal(each, pixels) for each in before):
                    return pixels
        self.fail(name)

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
