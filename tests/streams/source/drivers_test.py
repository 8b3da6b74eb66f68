"""Builds the drivers of examples/driver with a C99 compiler, and lets them feed the program."""

import json
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

    def test_ring_to_control_loop(self):
        frames, forces = f"{NAME}-frames", f"{NAME}-forces"
        stream = self.start_stream(f"shm:{frames}", "--to", f"shm:{forces}")
        loop = self.start(self.folder / "control_loop", forces, "--seconds", 3600,
                          stdout=subprocess.PIPE)
        driver = self.start(*self.relay(frames, 50))

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
        again = self.start(*self.relay(frames, 50))
        while next_frame() >= 50:
            pass
        again.terminate()
        self.assertEqual(again.wait(), 0)
        summary = self.summary_of(stream)
        self.assertEqual(summary["restarts"], 1)
        self.assertEqual(summary["invalid"], 0)
        self.assertEqual(segments(), [])

    def test_a_control_loop_refuses_other_rings(self):
        writer = self.start(*self.relay(NAME, 50))
        while not segments():
            time.sleep(0.01)
        loop = [self.folder / "control_loop", NAME]
        self.assertIn("it holds frames, not results", self.error_of(loop))
        writer.kill()
        writer.wait()
        with open(f"/dev/shm/{NAME}", "r+b") as segment:
            segment.write(b"PRG1\x02")  # results of an earlier version
        self.assertIn("compile this program", self.error_of(loop))
        pathlib.Path("/dev/shm", NAME).unlink()

    def error_of(self, command):
        result = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.returncode, 1)
        return result.stderr

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
