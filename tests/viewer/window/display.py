"""A virtual display by Xvfb: pixels, mouse and keys."""

import os
import shutil
import struct
import subprocess
import time

import numpy


def is_possible():
    return shutil.which("Xvfb") is not None and shutil.which("xdotool") is not None


def read_xwd(path):
    """The pixels [height, width, 3] of an X window dump, version 7, 32 bits a pixel."""
    with open(path, "rb") as file:
        data = file.read()
    header = struct.unpack(">25I", data[:100])
    (header_size, width, height, little_endian) = (header[0], header[4], header[5], header[7] == 0)
    (bits, line, colours) = (header[11], header[12], header[19])
    assert bits == 32, f"{bits} bits a pixel"
    begin = header_size + 12 * colours
    pixels = numpy.frombuffer(data, dtype=numpy.uint8, count=line * height, offset=begin)
    pixels = pixels.reshape(height, line)[:, : 4 * width].reshape(height, width, 4)
    return pixels[:, :, [2, 1, 0]] if little_endian else pixels[:, :, [1, 2, 3]]


class Display:
    """An X server with one screen, which stores its pixels in a file."""

    def __init__(self, folder, width, height):
        self.folder = folder
        (reader, writer) = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{width}x{height}x24",
             "-fbdir", str(folder), "-nolisten", "tcp", "-noreset"],
            pass_fds=[writer], stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader) as pipe:
            self.name = ":" + pipe.readline().strip()

    def close(self):
        self.server.terminate()
        self.server.wait()

    def pixels(self):
        return read_xwd(self.folder / "Xvfb_screen0")

    def still_pixels(self, seconds=60):
        """The screen after a period without changes."""
        deadline = time.monotonic() + seconds
        last = self.pixels()
        since = time.monotonic()
        while time.monotonic() - since < 0.4:
            assert time.monotonic() < deadline, f"the screen does not come to rest within {seconds} s"
            time.sleep(0.05)
            now = self.pixels()
            if not numpy.array_equal(now, last):
                (last, since) = (now, time.monotonic())
        return last

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment(), check=True,
                              capture_output=True, text=True, timeout=60).stdout

    def environment(self):
        return {**os.environ, "DISPLAY": self.name}
