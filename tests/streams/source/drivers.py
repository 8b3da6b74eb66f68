"""The drivers of examples/driver, compiled, and the shared memory that a test leaves."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

PROGRAM = os.environ["PILLARFIELD"]
SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
DRIVERS = SOURCE / "examples/driver"
ROWS, COLS = 32, 48
NAME = f"pillarfield-drivers-{os.getpid()}"


def segments():
    """Names of the segments of shared memory whose names begin with NAME."""
    return sorted(path.name for path in pathlib.Path("/dev/shm").glob(f"{NAME}*"))


class DriverTest(unittest.TestCase):
    """A test with the drivers in its folder."""

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.addClassCleanup(lambda: [pathlib.Path("/dev/shm", name).unlink() for name in segments()])
        cls.folder = pathlib.Path(scratch.name)
        subprocess.run([os.environ.get("CC", "cc"), "-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic",
                        "-Werror", "-I", SOURCE / "host/include", "-o", cls.folder / "control_loop",
                        DRIVERS / "control_loop.c", "-lm"], check=True)
        cls.write_spot(cls.folder / "spot.h5")

    @classmethod
    def write_spot(cls, path):
        """A spot of 5 sensels radius that crosses the skin in 1000 frames."""
        rows, cols = np.mgrid[:ROWS, :COLS]
        squares = [(rows - ROWS // 2) ** 2 + (cols - frame * COLS // 1000) ** 2 for frame in range(1000)]
        with h5py.File(path, "w") as file:
            file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
            file["frames/raw"] = np.where(np.array(squares) > 25, 0, 200 - 6 * np.array(squares)).astype("u1")
            file["frames/time"] = np.arange(1000) / 500
            file.create_group("skin").attrs["layout"] = "pillars"

    def relay(self, name, rate):
        """The command of a writer of frames into a ring."""
        return [PROGRAM, "stream", self.folder / "spot.h5", "--repeat", "--rate", str(rate), "--relay", f"shm:{name}", "-q"]
