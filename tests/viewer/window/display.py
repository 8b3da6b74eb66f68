"""A virtual display by Xvfb: pixels, mouse and keys."""

import os
import shutil
import struct
import subprocess
import time
import zlib

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


def write_png(path, pixels):
    (height, width, _) = pixels.shape
    rows = numpy.zeros((height, 1 + 3 * width), dtype=numpy.uint8)
    rows[:, 1:] = pixels.reshape(height, 3 * width)

    def chunk(kind, data):
        whole = kind + data
        return struct.pack(">I", len(data)) + whole + struct.pack(">I", zlib.crc32(whole))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        file.write(chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)))
        file.write(chunk(b"IEND", b""))


def read_png(path):
    """The pixels [height, width, 3] of a PNG of 8 bits, red, green, blue and perhaps alpha."""
    with open(path, "rb") as file:
        data = file.read()
    (place, compressed) = (8, b"")
    while place < len(data):
        (size, kind) = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        if kind == b"IHDR":
            (width, height, bits, colour) = struct.unpack(">IIBB", body[:10])
            channels = {2: 3, 6: 4}[colour]
            assert bits == 8 and body[12] == 0
        elif kind == b"IDAT":
            compressed += body
        place += 12 + size
    raw = numpy.frombuffer(zlib.decompress(compressed), dtype=numpy.uint8)
    lines = raw.reshape(height, 1 + channels * width)
    above = numpy.zeros(channels * width, dtype=numpy.uint8)
    rows = []
    for line in lines:
        above = unfiltered(line[0], line[1:], above, channels)
        rows.append(above)
    return numpy.array(rows).reshape(height, width, channels)[:, :, :3]


def unfiltered(kind, line, above, channels):
    if kind == 0:
        return line.copy()
    if kind == 2:
        return line + above
    row = line.astype(int)
    up = above.astype(int)
    for i in range(len(row)):
        left = row[i - channels] if i >= channels else 0
        corner = up[i - channels] if i >= channels else 0
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + up[i]) // 2
        else:
            distances = [(abs(up[i] - corner), 0, left), (abs(left - corner), 1, up[i]),
                         (abs(left + up[i] - 2 * corner), 2, corner)]
            guess = min(distances)[2]
        row[i] = (row[i] + guess) & 255
    return row.astype(numpy.uint8)


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

    def still_pixels(self, seconds=600):
        """The screen after a period without changes."""
        deadline = time.monotonic() + seconds
        last = self.pixels()
        since = time.monotonic()
        while time.monotonic() - since < 0.4:
            assert time.monotonic() < deadline, "the screen does not come to rest"
            time.sleep(0.05)
            now = self.pixels()
            if not numpy.array_equal(now, last):
                (last, since) = (now, time.monotonic())
        return last

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment(), check=True,
                              capture_output=True, text=True, timeout=600).stdout

    def environment(self):
        return {**os.environ, "DISPLAY": self.name}
