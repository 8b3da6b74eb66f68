"""Builds the drivers of examples/driver with a C99 compiler, and lets them feed the program."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time
import unittest

from drivers import DRIVERS, NAME, PROGRAM, DriverTest, segments


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Drivers(DriverTest):
    def start(self, *words, **options):
        process = subprocess.Popen([str(word) for word in words], text=True, **options)
        self.addCleanup(lambda: (process.kill(), process.wait(), process.stdout and process.stdout.close()))
        return process

    def start_stream(self, *words):
        return self.start(PROGRAM, "stream", *words, "--json", stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL)

    def summary_of(self, stream):
        stream.send_signal(signal.SIGINT)
        lines = stream.communicate(timeout=600)[0].splitlines()
        self.assertEqual(stream.returncode, 0)
        return json.loads(lines[-1])["summary"]

    def test_ring_driver_to_control_loop(self):
        frames, forces = f"{NAME}-frames", f"{NAME}-forces"
        stream = self.start_stream(f"shm:{frames}", "--to", f"shm:{forces}")
        loop = self.start(self.folder / "control_loop", forces, "--seconds", 3600,
                          stdout=subprocess.PIPE)
        driver = self.start(self.folder / "ring_driver", frames, "--rate", 50, "--seconds", 3600,
                            "--rows", 48, "--cols", 48)
        def next_frame():
            while (line := loop.stdout.readline()).startswith("alarm:"):
                pass
            found = re.fullmatch(r"frame (\d+): ([\d.]+) N, 1 contact, .*\n", line)
            self.assertIsNotNone(found, line)
            self.assertGreater(float(found[2]), 1)
            return int(found[1])

        while next_frame() < 50:
            pass
        self.assertEqual(segments(), [forces, frames])

        # The program goes on when its driver is killed, and takes up the ring of the next one.
        driver.kill()
        driver.wait()
        again = self.start(self.folder / "ring_driver", frames, "--rate", 50, "--seconds", 3600,
                           "--rows", 48, "--cols", 48)
        while next_frame() >= 50:
            pass
        again.terminate()
        self.assertEqual(again.wait(), 0)
        summary = self.summary_of(stream)
        self.assertEqual(summary["restarts"], 1)
        self.assertEqual(summary["invalid"], 0)
        self.assertEqual(segments(), [])

    def test_a_driver_replaces_a_ring_of_another_size(self):
        driver = self.folder / "ring_driver"
        killed = self.start(driver, NAME, "--seconds", 3600)
        while not segments():
            time.sleep(0.01)
        busy = subprocess.run([driver, NAME], stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(busy.returncode, 1)
        self.assertIn("another driver", busy.stderr)
        loop = subprocess.run([self.folder / "control_loop", NAME], stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(loop.returncode, 1)
        self.assertIn("it holds frames, not results", loop.stderr)
        killed.kill()
        killed.wait()
        self.assertEqual(segments(), [NAME])
        with open(f"/dev/shm/{NAME}", "r+b") as segment:
            segment.write(b"PRG1\x02")  # results of an earlier version
        loop = subprocess.run([self.folder / "control_loop", NAME], stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(loop.returncode, 1)
        self.assertIn("compile this program", loop.stderr)
        subprocess.run([driver, NAME, "--rows", "20", "--seconds", "0.05"], check=True)
        self.assertEqual(segments(), [])

    @unittest.skipIf(os.geteuid() != 0, "only root gives files away")
    def test_a_driver_refuses_a_ring_of_another_user(self):
        segment = pathlib.Path("/dev/shm", NAME)
        segment.touch()
        os.chown(segment, 65534, 65534)
        driver = subprocess.run([self.folder / "ring_driver", NAME], stderr=subprocess.PIPE,
                                text=True, check=False)
        segment.unlink()
        self.assertEqual(driver.returncode, 1)
        self.assertIn("another user", driver.stderr)

    def test_udp_driver(self):
        port = free_port()
        stream = self.start_stream(f"udp:127.0.0.1:{port}")
        self.start(sys.executable, DRIVERS / "udp_driver.py", port, 3600)
        while json.loads(stream.stdout.readline()).get("health", {}).get("solved", 0) < 20:
            pass
        summary = self.summary_of(stream)
        self.assertEqual((summary["lost"], summary["invalid"], summary["restarts"]), (0, 0, 0))


if __name__ == "__main__":
    unittest.main()
