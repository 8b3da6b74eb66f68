"""Every command refuses damaged and hostile files in one line, in bounded time and memory.

The files are those of fuzz/corpus, and large ones that are made here.
"""

import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

import h5py
import numpy

from command import PROGRAM, SCENES, run

VIEWER = pathlib.Path(PROGRAM).with_name("pillarfield-viewer")
CORPUS = sorted(file for file in pathlib.Path(sys.argv.pop()).glob("*/*.h5")
                if not file.name.startswith(("seed_", "hostile_")))
SANITIZED = "asan" in pathlib.Path(PROGRAM).parts
MEGABYTE = 1 << 20


class Outcome:
    """Exit status, messages, time and memory of a program."""

    def __init__(self, arguments, folder):
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            begin = time.monotonic()
            process = subprocess.Popen([str(word) for word in arguments], stdout=out, stderr=err,
                                       cwd=folder)
            status, usage = self._wait(process, begin)
            err.seek(0)
            # PoCL passes on warnings of its compiler; the C library names broken memory before it aborts.
            lines = err.read().decode().splitlines(keepends=True)
            self.error = "".join(line for line in lines
                                 if not re.search(r"warnings generated\.|^(free|malloc)\w*\(|^double free|^corrupted", line))
        self.signal = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        self.status = os.WEXITSTATUS(status) if os.WIFEXITED(status) else None
        self.seconds = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024

    @staticmethod
    def _wait(process, begin):
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid != 0:
                process.returncode = status
                return status, usage
            if time.monotonic() - begin > 600:
                process.kill()
            time.sleep(0.002)


def begin_recording(path, **raw):
    """A recording with the dataset /frames/raw of the arguments `raw`."""
    file = h5py.File(path, "w")
    file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
    dataset = file.create_dataset("frames/raw", dtype="u1", **raw)
    frames = dataset.shape[0]
    if frames <= 10_000:
        file["frames/time"] = numpy.arange(frames) / 100.0
    else:
        file.create_dataset("frames/time", (frames,), "f8", chunks=(1 << 20,), compression="gzip")
    return file


def fill_chunks(dataset):
    """Fills every chunk of a gzip dataset with zeros, compressed once."""
    packed = zlib.compress(bytes(int(numpy.prod(dataset.chunks))), 9)
    steps = [range(0, size, step) for size, step in zip(dataset.shape, dataset.chunks)]
    for frame in steps[0]:
        for row in steps[1]:
            for col in steps[2]:
                dataset.id.write_direct_chunk((frame, row, col), packed)


def sparse_frame(path):
    """One frame of 4.3 GB without stored data."""
    size = 65534
    layout = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    layout.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
    layout.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file["frames/time"] = numpy.zeros(1)
        space = h5py.h5s.create_simple((1, size, size))
        h5py.h5d.create(file["frames"].id, b"raw", h5py.h5t.STD_U8LE, space, layout)


def gzip_bomb(path):
    """A megabyte that inflates to a frame of a gigabyte."""
    with begin_recording(path, shape=(1, 32768, 32768), chunks=(1, 4096, 4096),
                         compression="gzip") as file:
        fill_chunks(file["frames/raw"])


def gzip_planes(path):
    """Planes of a calibration that inflate to gigabytes."""
    size = 32768
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-calibration", 1
        skin = file.create_group("skin")
        skin.attrs["rows"] = skin.attrs["cols"] = size
        for name in ("tare", "gain", "dead_zone", "noise"):
            plane = file.create_dataset(f"calibration/{name}", (size, size), "f4",
                                        chunks=(2048, 2048), compression="gzip")
            packed = zlib.compress(numpy.ones((2048, 2048), "f4").tobytes(), 9)
            for row in range(0, size, 2048):
                for col in range(0, size, 2048):
                    plane.id.write_direct_chunk((row, col), packed)


def frames_without_chunks(path, frames):
    """`frames` frames in absent gzip chunks."""
    begin_recording(path, shape=(frames, 20, 20), chunks=(16, 20, 20), compression="gzip").close()


def one_chunk(path):
    """4,000 frames in one chunk of 256 MiB."""
    with begin_recording(path, shape=(4000, 256, 262), chunks=(4000, 256, 262),
                         compression="gzip") as file:
        fill_chunks(file["frames/raw"])


def linked(path, is_chain):
    """A group of frames that is a link to another recording, or soft links to an external link."""
    with h5py.File(path.with_name("other.h5"), "w") as other:
        other["raw"], other["time"] = numpy.zeros((2, 4, 4), "u1"), numpy.arange(2.0)
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
        file["elsewhere" if is_chain else "frames"] = h5py.ExternalLink("other.h5", "/raw" if is_chain else "/")
        if is_chain:
            file["soft"], file["frames/raw"] = h5py.SoftLink("/elsewhere"), h5py.SoftLink("/soft")
            file["frames/time"] = numpy.arange(2.0)


MADE = {
    "sparse_frame": sparse_frame,
    "gzip_bomb": gzip_bomb,
    "gzip_planes": gzip_planes,
    "frames_2e40": lambda path: frames_without_chunks(path, 1 << 40),
    "one_chunk": one_chunk,
    "link_chain": lambda path: linked(path, True),
    "external_group": lambda path: linked(path, False),
}


class DamagedTest(unittest.TestCase):
    """Every file through every command."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.recording, cls.forces = cls.folder / "good.h5", cls.folder / "good_forces.h5"
        run("simulate", SCENES / "demo.toml", "-o", cls.recording, "-q", "--frames", 24)
        run("solve", cls.recording, "-o", cls.forces, "-q")

    def commands(self, file):
        """The command lines that read `file`."""
        yield [PROGRAM, "info", file]
        yield [PROGRAM, "solve", file, "-q", "-o", "out.h5"]
        yield [PROGRAM, "solve", self.recording, "--calibration", file, "-q", "-o", "out.csv"]
        yield [PROGRAM, "compare", file, self.recording, "-q"]
        yield [PROGRAM, "compare", self.forces, file, "-q"]
        yield [PROGRAM, "calibrate", "tare", file, "-q", "-o", "out.h5"]
        if VIEWER.exists():
            yield [VIEWER, file, "--headless", "--csv", "out.csv"]

    def check(self, file):
        """One line, exit 1, little memory and time, no output."""
        before = sorted(os.listdir(self.folder))
        for command in self.commands(file):
            with self.subTest(file=file.name, command=" ".join(map(str, command[1:]))):
                outcome = Outcome(command, self.folder)
                self.assertEqual(outcome.signal, 0, outcome.error)
                self.assertEqual(outcome.status, 1, outcome.error)
                self.assertEqual(outcome.error.count("\n"), 1, outcome.error)
                self.assertTrue(outcome.error.startswith("pillarfield"), outcome.error)
                self.assertEqual(sorted(os.listdir(self.folder)), before)
                if SANITIZED:
                    continue
                self.assertLess(outcome.seconds, 5)
                self.assertLess(outcome.megabytes, 1000)

    def test_corpus(self):
        """fuzz/corpus."""
        self.assertEqual(len(CORPUS), 10)
        for file in CORPUS:
            self.check(file)

    def test_made(self):
        """MADE."""
        for name, make in MADE.items():
            file = self.folder / f"{name}.h5"
            make(file)
            self.check(file)
            if make is one_chunk:
                self.assertIn("smaller chunks", Outcome([PROGRAM, "info", file], self.folder).error)
            file.unlink()

    def test_trusted(self):
        """--trust-input reads sound files."""
        for command in (["info", self.recording], ["compare", self.forces, self.recording],
                        ["solve", self.recording, "-o", self.folder / "t.csv", "-q"],
                        ["calibrate", "tare", self.recording, "--preloaded", "-q", "-o",
                         self.folder / "t.h5"]):
            run(*command, "--trust-input")
        for name in ("t.csv", "t.h5"):
            (self.folder / name).unlink(missing_ok=True)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    unittest.main()
