"""Kills driver, program and reader (SIGKILL) in every order, and starts each again.

Argument: the number of rounds. The spot of its frames moves across the skin, which orders the frames of a
recording."""

import itertools
import random
import signal
import subprocess
import sys
import time
import unittest

import h5py

from drivers import NAME, PROGRAM, DriverTest, segments

ROUNDS = int(sys.argv.pop(1))


def spot_column(readings):
    """The middle of the spot that the driver moves, sensels."""
    loaded = readings.max(axis=0).nonzero()[0]
    return (loaded[0] + loaded[-1]) / 2


class Kills(DriverTest):
    def setUp(self):
        self.recordings = []
        self.processes = {}
        self.addCleanup(lambda: [process.kill() for process in self.processes.values()])

    def start(self, which):
        frames, forces = f"{NAME}-frames", f"{NAME}-forces"
        if which == "program":
            self.recordings.append(self.folder / f"{len(self.recordings)}.h5")
        command = {
            "driver": self.relay(frames, 500),
            "program": [PROGRAM, "stream", f"shm:{frames}", "--to", f"shm:{forces}", "--record",
                        str(self.recordings[-1] if self.recordings else ""), "-q"],
            "reader": [self.folder / "control_loop", forces, "--seconds", "3600"],
        }[which]
        self.processes[which] = subprocess.Popen(command, text=True, stdout=subprocess.PIPE
                                                 if which == "reader" else subprocess.DEVNULL)

    def kill(self, which):
        process = self.processes[which]
        self.assertIsNone(process.poll(), f"{which} ended on its own")
        process.kill()
        process.wait()
        if process.stdout:
            process.stdout.close()

    def expect_results(self, count=2):
        """Waits for lines of the reader, which prints ten a second while results arrive."""
        for _ in range(count):
            line = self.processes["reader"].stdout.readline()
            self.assertRegex(line, r"frame \d+: \S+ N, [01] contacts?")

    def flushed(self):
        """Frames of the running program's recording that a reader can see; 0 before the first."""
        try:
            with h5py.File(f"{self.recordings[-1]}.part", "r", swmr=True) as file:
                return len(file["frames/raw"])
        except (OSError, KeyError):
            return 0

    def check_recording(self, path, at_least):
        with h5py.File(path, "r", swmr=True) as file:
            frames, times = file["frames/raw"][:], file["frames/time"][:]
        self.assertGreaterEqual(len(frames), at_least)
        self.assertEqual(len(frames), len(times))
        columns = [spot_column(frame) for frame in frames]
        for before, after in zip(columns, columns[1:]):  # The spot moves slowly, or begins anew.
            self.assertTrue(after >= before or after < 12, (before, after))

    def test_every_order(self):
        for which in ("driver", "program", "reader"):
            self.start(which)
        orders = itertools.cycle(itertools.permutations(self.processes))
        for order in itertools.islice(orders, ROUNDS):
            with self.subTest(order=order):
                self.expect_results()
                while not (flushed := self.flushed()):
                    time.sleep(0.05)
                recording = self.recordings[-1]
                for which in order:
                    time.sleep(random.uniform(0, 0.03))
                    self.kill(which)
                    if random.random() < 0.5:  # The others may meet a ring without its writer.
                        time.sleep(random.uniform(0, 0.03))
                    self.start(which)
                self.check_recording(f"{recording}.part", flushed)
        self.expect_results()
        self.end_cleanly()

    def end_cleanly(self):
        self.processes["driver"].send_signal(signal.SIGTERM)
        self.assertEqual(self.processes["driver"].wait(600), 0)
        self.processes["program"].send_signal(signal.SIGINT)
        self.assertEqual(self.processes["program"].wait(600), 0)
        self.kill("reader")
        self.assertEqual(segments(), [])
        self.check_recording(self.recordings[-1], 1)


if __name__ == "__main__":
    unittest.main()
