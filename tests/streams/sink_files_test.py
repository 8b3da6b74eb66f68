"""Force files and recordings behind a queue: whole ones, and those of a killed writer."""

import signal
import time
import unittest

import h5py
import numpy as np

from sink_process import SinkTest


def flushed_frames(path):
    """Frames of a recording that is being written; 0 before the first."""
    try:
        with h5py.File(path, "r", swmr=True) as file:
            return len(file["frames/time"])
    except (OSError, KeyError):
        return 0


class FilesTest(SinkTest):
    def test_files_are_those_of_a_direct_sink(self):
        paths = [self.folder / name for name in ("a.h5", "reference.h5", "b.npy", "c.csv", "raw.h5")]
        results = self.run_driver("--to", paths[0], "--reference", paths[1], "--record", paths[4])
        self.assertEqual(results[str(paths[0])]["frames"], 40)
        self.assertEqual(paths[0].read_bytes(), paths[1].read_bytes())
        reference = self.folder / "reference.csv"
        self.run_driver("--no-contacts", "--to", paths[2], "--to", paths[3],
                        "--reference", reference)
        self.assertEqual(paths[3].read_bytes(), reference.read_bytes())
        with h5py.File(paths[1]) as file:
            for plane in ("shear_x", "shear_y", "normal", "status"):
                np.testing.assert_array_equal(np.load(paths[2])[plane], file["force"][plane][()])
        with h5py.File(paths[4]) as file:
            self.assertEqual(file["frames/raw"].shape, (40, 60, 48))
            np.testing.assert_allclose(file["frames/time"][()], np.arange(40) / 1000)

    def test_killed_recording(self):
        path, part = self.folder / "raw.h5", self.folder / "raw.h5.part"
        process = self.start("--record", path, "--rate", 200, "--frames", 100000)
        while flushed_frames(part) <= 50:
            time.sleep(0.1)
        process.send_signal(signal.SIGKILL)
        process.wait()
        with h5py.File(part, swmr=True) as file:
            frames, times = file["frames/raw"][()], file["frames/time"][()]
        self.assertGreater(len(times), 50)
        np.testing.assert_allclose(times, np.arange(len(times)) / 200)
        np.testing.assert_array_equal(frames[40:], frames[:-40])  # the scene repeats
        self.assertTrue(frames[-1].any())

    def test_abandoned_sinks_leave_no_final_file(self):
        names = ("a.h5", "b.mcap", "c.npy", "raw.h5")
        self.run_driver("--no-contacts", "--abandon", "--record", self.folder / names[3],
                        *(word for name in names[:3] for word in ("--to", self.folder / name)))
        self.assertFalse(any((self.folder / name).exists() for name in names))


if __name__ == "__main__":
    unittest.main()
