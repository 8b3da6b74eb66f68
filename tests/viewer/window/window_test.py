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
                                ("contacts", ["--contacts"])):
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
        for key in ("2", "a", "k", "v", "b", "w", "t", "i", "Tab", "Right", "question", "Escape"):
            before = self.act("key_" + key, lambda key=key: window.key(key), before)
        self.assert_quiet(window)

    def test_space_plays_and_pauses(self):
        window = self.open(SCENES / "demo.toml", "--paused")
        self.screen.still_pixels()
        window.key("space")
        self.wait_for_motion()
        window.key("space")
        self.shoot("paused_again")
        statistics = self.assert_quiet(window)
        self.assertGreater(statistics["produced"], 3)
        self.assertIn(statistics["produced"] - statistics["taken"] - statistics["not_shown"],
                      (0, 1))


class MouseTest(WindowTest):
    def test_the_mouse_marks_turns_and_opens_lists(self):
        window = self.open(SCENES / "demo.toml", "--paused", "--frame", 20)
        before = self.shoot("mouse_opened")
        (x, y) = (411, 216)  # In the field, left of the panels and above the play head.
        for (name, action) in (("hover", lambda: window.move(x, y)),
                               ("pin", lambda: window.click(x, y)),
                               ("selection", lambda: window.drag((x - 70, y - 70), (x + 40, y + 50))),
                               ("zoom", lambda: window.click(x, y, button=4, times=5)),
                               ("scrub", lambda: window.drag((130, 594), (340, 594)))):
            before = self.act("mouse_" + name, action, before)
        self.assert_quiet(window)


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
    def test_start_page_opens_a_scene_and_remembers_it(self):
        window = self.open("--paused")
        before = self.shoot_page("start")
        window.click(312, 150)  # The first picture.
        window.wait_for_source()
        opened = self.shoot("start_opened")
        window.key("ctrl+o")
        covered = self.shoot_changed("start_covered", opened)
        window.key("Escape")
        self.shoot_changed("start_uncovered", covered)
        self.assertGreater(self.assert_quiet(window)["taken"], 0)
        window = self.open()
        self.shoot_changed("start_recent", before)
        self.assert_quiet(window)

    def test_a_missing_file_is_an_error(self):
        ended = subprocess.run([VIEWER, self.folder / "none.h5"], env=self.screen.environment(),
                               check=False, capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("none.h5", ended.stderr)

    def test_truth_and_a_second_source_beside(self):
        shots = []
        for arguments in (["--truth"], [SCENES / "spin.toml"], []):
            window = self.open(SCENES / "demo.toml", *arguments, "--paused", "--frame", 20)
            shots.append(self.shoot(f"beside_{len(shots)}"))
            self.assert_quiet(window)
        for (index, shot) in enumerate(shots[:2]):
            self.assertFalse(numpy.array_equal(shot, shots[2]), index)
        self.assertFalse(numpy.array_equal(shots[0], shots[1]))

    def test_a_sensor_comes_goes_and_is_recorded(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        window = self.open(f"udp:127.0.0.1:{port}")
        self.shoot("sensor_awaited")
        sensor = Sensor(port)
        self.shoot_field("sensor_found")
        for key in ("k", "z", "ctrl+r"):
            window.key(key)
            time.sleep(0.7)
        self.wait_for(lambda: any(self.folder.glob("udp_*recording.h5*")), "no recording")
        running = self.shoot("sensor", still=False)
        window.key("ctrl+r")
        self.wait_for(lambda: any(self.folder.glob("udp_*recording.h5")), "no end of the recording")
        sensor.stop()
        (x, y) = (866, 50)  # The bright end of the colour bar.
        colour = running[y, x].astype(int)
        self.wait_for(lambda: (self.shoot("sensor_stopped", still=False)[y, x] < colour).all(),
                      "the field of a stopped sensor is not dimmed")
        stopped = self.shoot("sensor_stopped", still=False)
        sensor = Sensor(port)
        self.shoot_changed("sensor_again", stopped, still=False)
        statistics = self.assert_quiet(window)
        sensor.stop()
        self.assertGreater(statistics["produced"], 10)
        recordings = list(self.folder.glob("udp_*recording.h5"))
        self.assertEqual(len(recordings), 1, list(self.folder.iterdir()))
        printed = subprocess.run([PROGRAM, "info", recordings[0]], check=True, capture_output=True,
                              text=True).stdout
        self.assertIn("32", printed)


class BoxTest(WindowTest):
    """Named boxes, in the top view and in relief."""

    def has_selected_text(self):
        return (abs(self.screen.pixels().astype(int) - [64, 92, 101]).max(axis=2) < 4).sum() > 100

    def test_boxes_stay(self):
        (width, height) = self.SIZE
        size = ["--size", f"{width}x{height}"]
        settings = self.folder / "config/pillarfield/viewer.conf"
        arguments = [SCENES / "demo.toml", "--paused", "--frame", 31, *size]
        window = self.open(*arguments)
        name = f"boxes_{height}"
        shots = [self.shoot(name + "_none")]

        def do(step, action):
            shots.append(self.act(f"{name}_{step}", action, *shots[-1:]))

        middle = (width - 284) / 2  # of the field, left of the panels; the skin fills its height

        def place(x, y):
            return (middle + x * height, y * height)

        for (begin, end, word) in ((place(-0.33, 0.06), place(-0.13, 0.27), "ball"),
                                   (place(0.04, 0.05), place(0.22, 0.26), "slides"),
                                   (place(-0.05, 0.29), place(0.15, 0.5), "twist")):
            do(word + "_selected", lambda begin=begin, end=end: window.drag(begin, end))
            window.key("o")
            self.wait_for(self.has_selected_text, "the name has no focus")
            self.screen.xdotool("type", "--window", window.id, word)
            window.key("Return")
            self.wait_for(lambda: word in settings.read_text(encoding="utf-8"), "the name is not kept")
        self.screen.xdotool("mousemove", width + 150, height + 110)
        shots.append(self.shoot(name))
        do("orbit", lambda: window.key("v"))
        window.key("b")
        shots.append(self.shoot_changed(name + "_relief", *shots[-2:]))
        self.assert_quiet(window)
        kept = [line for line in settings.read_text(encoding="utf-8").splitlines() if line.startswith("box ")]
        self.assertEqual([line.split()[-1] for line in kept], ["ball", "slides", "twist"])
        self.assertTrue(all(line.startswith("box 79 79 pillars ") for line in kept), kept)
        window = self.open(*arguments)
        self.shoot_changed(name + "_again", shots[0])
        self.assert_quiet(window)


class WholeWindowTest(WindowTest):
    def test_large_letters(self):
        window = self.open(SCENES / "demo.toml", "--paused", "--scale", 1.5)
        self.shoot("scale_1_5")
        self.assert_quiet(window)

    def test_interrupt_ends_it(self):
        for ending in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            window = self.open(SCENES / "spin.toml", "--paused")
            self.screen.still_pixels()
            window.process.send_signal(ending)
            window.process.communicate(timeout=PATIENCE_S)
            self.assertEqual(window.process.returncode, 0)

    def test_without_a_display(self):
        environment = {name: value for (name, value) in os.environ.items() if name != "DISPLAY"}
        ended = subprocess.run([VIEWER, SCENES / "spin.toml"], env=environment, check=False,
                               capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("--headless", ended.stderr)
        self.assertEqual(len(ended.stderr.strip().splitlines()), 1)


if __name__ == "__main__":
    if not display.is_possible():
        print("skipped: Xvfb or xdotool is not installed")
        sys.exit(0)
    unittest.main()
