"""The drivers of examples/driver, compiled, and the shared memory that a test leaves."""

import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PILLARFIELD"]
SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
DRIVERS = SOURCE / "examples/driver"
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
        for name in ("ring_driver", "control_loop"):
            subprocess.run([os.environ.get("CC", "cc"), "-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic",
                            "-Werror", "-I", SOURCE / "host/include", "-o", cls.folder / name,
                            DRIVERS / f"{name}.c", "-lm"], check=True)
