"""`pillarfield stream --relay`: one sensor, and several programs that read it."""

import os
import pathlib
import signal
import socket
import unittest

import h5py
import numpy as np

from stream_test import PATIENCE_S, StreamTest


class Relay(StreamTest):
    def test_a_relayed_ring_has_many_readers(self):
        name = f"pillarfield-relay-{os.getpid()}"
        self.addCleanup(pathlib.Path("/dev/shm", name).unlink, missing_ok=True)
        readers = []
        for number in range(2):
            copy = self.folder / f"copy{number}.h5"
            process = self.started(f"shm:{name}", "--record", copy, "--frames", 20, "--json",
                                   "--layout", "pillars")
            self.assertEqual(process.stderr.readline(), f"Waiting for frames from shm:{name}\n")
            readers.append((process, copy))
        source = self.started(self.recording, "--repeat", "--relay", f"shm:{name}")
        with h5py.File(self.recording) as file:
            sent = file["frames/raw"][:]
        for process, copy in readers:
            summary = self.ended(process)
            self.assertEqual((summary["invalid"], summary["restarts"]), (0, 0))
            with h5py.File(copy) as file:
                places = [np.flatnonzero((sent == raw).all((1, 2))) for raw in file["frames/raw"]]
                steps = np.diff(file["frames/time"])
            self.assertTrue(all(place.size for place in places))
            self.assertGreater(len({place[0] for place in places}), 3)
            self.assertTrue((steps > 0).all())
        source.send_signal(signal.SIGINT)
        source.communicate(timeout=PATIENCE_S)
        self.assertEqual(source.returncode, 0)

    def test_a_busy_port_names_the_way(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            process = self.started(f"udp:127.0.0.1:{other.getsockname()[1]}")
            self.assertIn("--relay shm:NAME", process.communicate(timeout=PATIENCE_S)[1])
            self.assertEqual(process.returncode, 1)


if __name__ == "__main__":
    unittest.main()
