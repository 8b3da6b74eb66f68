"""The window of pillarfield-viewer under a display without a screen: every control does something
that can be seen, nothing is said by Vulkan's validation, and the field in the window is the picture
that --headless writes. Screenshots stay in the folder that PILLARFIELD_PICTURES names."""

import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

try:
    import numpy
    import display
    from PIL import Image
    from window import VIEWER, PROGRAM, SCENES, PATIENCE_S, WindowTest, field_of
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(0)


class PictureTest(WindowTest):
    def test_field_is_what_headless_writes(self):
        for (name, options) in (("top", []), ("orbit", ["--view", "orbit", "--layer", "shear"]),
                                ("light", ["--light", "--layer", "region", "--copy"]),
                                ("bare", ["--no-contacts"])):
            with self.subTest(name):
                window = self.open(SCENES / "demo.toml", "--paused", "--frame", 31, *options)
                pixels = self.shoot("field_" + name)
                statistics = self.assert_quiet(window)
                size = "{2}x{3}".format(*statistics["field"])
                picture = self.folder / "headless.png"
                subprocess.run([VIEWER, SCENES / "demo.toml", "--headless", "--frame", "31",
                                "--size", size, "--png", picture, *options], check=True)
                self.assertTrue(
                    numpy.array_equal(field_of(pixels, statistics), numpy.asarray(Image.open(picture).convert("RGB"))))
                self.assertEqual(statistics["in_place"], "--copy" not in options)


class KeyTest(WindowTest):
    def test_keys_change_what_is_seen(self):
        window = self.open(SCENES / "demo.toml", "--paused", "--frame", 20)
        before = self.shoot("opened")
        for key in ("2", "a", "k", "v", "b", "t", "Tab", "Right", "question", "Escape"):
            window.key(key)
            before = self.shoot_changed("key_" + key, before)
        window.key("space")
        self.wait_for_motion()
        window.key("space")
        statistics = self.assert_quiet(window)
        self.assertGreater(statistics["produced"], 3)
        self.assertIn(statistics["produced"] - statistics["taken"] - statistics["not_shown"],
                      (0, 1))


class Sensor(threading.Thread):
    """Sends frames of 32 x 32 sensels by UDP, and leaves out every tenth."""

    def __init__(self, port, rate_hz=200):
        super().__init__(daemon=True)
        (self.port, self.rate_hz, self.stopping) = (port, rate_hz, False)
        self.start()

    def run(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            self.send(out)

    def send(self, out):
        number = 0
        while not self.stopping:
            frame = bytearray(32 * 32)
            for row in range(10, 18):
                begin = 32 * row + 8 + number // 20 % 10
                frame[begin:begin + 8] = bytes([90] * 8)
            header = struct.pack("<IHHIIQQQIIIIII", 0x31524650, 0, 1, 32, 32, 0, number,
                                 number * 5_000_000, 0, 1, 0, 0, 0, len(frame))
            if number % 10 != 9:
                out.sendto(header + frame, ("127.0.0.1", self.port))
            number += 1
            time.sleep(1 / self.rate_hz)

    def stop(self):
        self.stopping = True
        self.join()


class SourceTest(WindowTest):
    def test_start_page_covers_a_source_and_remembers_it(self):
        window = self.open(SCENES / "demo.toml", "--paused")
        opened = self.shoot("start_opened")
        window.key("ctrl+o")
        covered = self.shoot_changed("start_covered", opened)
        window.key("Escape")
        self.shoot_changed("start_uncovered", covered)
        self.assertGreater(self.assert_quiet(window)["taken"], 0)
        self.assertIn("demo.toml", self.settings())
        window = self.open()
        self.shoot_page("start_recent")
        self.assert_quiet(window)

    def test_a_missing_file_is_an_error(self):
        ended = subprocess.run([VIEWER, self.folder / "none.h5"], env=self.screen.environment(),
                               check=False, capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("none.h5", ended.stderr)

    def test_a_sensor_comes_goes_and_is_recorded(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        window = self.open(f"udp:127.0.0.1:{port}")
        sensor = Sensor(port)
        window.wait_for_source()
        for key in ("k", "z", "ctrl+r"):
            window.key(key)
            time.sleep(0.7)
        self.wait_for(lambda: any(self.folder.glob("udp_*recording.h5*")), "no recording")
        self.shoot("sensor", still=False)
        window.key("ctrl+r")
        self.wait_for(lambda: any(self.folder.glob("udp_*recording.h5")), "no end of the recording")
        sensor.stop()
        time.sleep(2)
        stopped = self.shoot("sensor_stopped", still=False)
        sensor = Sensor(port)
        self.shoot_changed("sensor_again", stopped, still=False)
        statistics = self.assert_quiet(window)
        sensor.stop()
        self.assertGreater(statistics["produced"], 10)
        (recording,) = self.folder.glob("udp_*recording.h5")
        printed = subprocess.run([PROGRAM, "info", recording], check=True, capture_output=True,
                                 text=True).stdout
        self.assertIn("32", printed)


class WholeWindowTest(WindowTest):
    def test_no_key_is_lost_while_it_loads_or_draws_slowly(self):
        window = self.open(SCENES / "demo.toml", "--paused", "--frame", 31, waits=False)
        for number in range(2):  # While it loads, and while it draws slowly.
            for key in ("v", "p", "t", "p"):
                window.key(key)
            window.sleep(False)
            window.wait_for_source()
            count = 2 * (number + 1)
            self.wait_for(lambda: len(list(self.folder.glob("demo*.png"))) == count, "a key is lost")
            window.sleep()
        window.sleep(False)
        self.assert_quiet(window)

    def test_large_letters(self):
        window = self.open(SCENES / "demo.toml", "--paused", "--scale", 1.5)
        self.shoot("scale_1_5")
        self.assert_quiet(window)

    def test_interrupt_ends_it(self):
        for ending in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            window = self.open(SCENES / "touch/spin.toml", "--paused")
            self.screen.still_pixels()
            window.process.send_signal(ending)
            window.process.communicate(timeout=PATIENCE_S)
            self.assertEqual(window.process.returncode, 0)

    def test_without_a_display(self):
        environment = {name: value for (name, value) in os.environ.items() if name != "DISPLAY"}
        ended = subprocess.run([VIEWER, SCENES / "touch/spin.toml"], env=environment, check=False,
                               capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("--headless", ended.stderr)
        self.assertEqual(len(ended.stderr.strip().splitlines()), 1)


if __name__ == "__main__":
    if not display.is_possible():
        print("skipped: Xvfb or xdotool is not installed")
        sys.exit(0)
    unittest.main()
