"""Live sources and sinks: frames by UDP arrive, forces leave as files and datagrams."""

import json
import os
import pathlib
import signal
import socket
import struct
import threading
import time
import unittest

import numpy as np

import pillarfield as pf

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def packet(readings, number):
    rows, cols = readings.shape
    return struct.pack("<4sHHIIQQQ6I", b"PFR1", 0, 1, rows, cols, 0, number, 10_000_000 * number, 0, 1,
                       0, 0, 0, readings.nbytes) + readings.tobytes()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Sender(threading.Thread):
    """Sends numbered frames until it is stopped."""

    def __init__(self, port):
        super().__init__()
        self.port, self.stopped, self.number = port, threading.Event(), 0

    def run(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            while not self.stopped.wait(0.002):
                out.sendto(packet(self.readings(), self.number), ("127.0.0.1", self.port))
                self.number += 1

    def readings(self):
        return np.full((16, 24), 40 + self.number % 50, np.uint8)

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.stopped.set()
        self.join()


class Live(unittest.TestCase):
    def test_frames_to_forces_to_sinks(self):
        port = free_port()
        listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(600)
        target = f"udp:127.0.0.1:{listener.getsockname()[1]}"
        saved = WORK / f"live_{os.getpid()}.h5"
        with Sender(port), pf.live(f"udp:127.0.0.1:{port}") as source:
            self.assertEqual((source.skin.rows, source.skin.cols, source.sensel_type),
                             (16, 24, "uint8"))
            plan = pf.Plan(source.skin, counts_per_newton=100)
            solved = []
            with pf.Processor(plan, contacts=True) as processor, \
                    pf.sink(target, plan, contacts=True) as datagrams, \
                    pf.sink(str(saved), plan, contacts=True) as file:
                frames = [frame for frame, _ in zip(source, range(20))]
                for forces in processor.stream(frames):
                    datagrams.send(forces)
                    file.send(forces)
                    solved.append(forces.copy())
                self.assertEqual(datagrams.statistics["failure"], "")
            message = json.loads(listener.recv(65536))
            self.assertGreater(source.health["frames"], 19)
        listener.close()
        for frame, forces in zip(frames, solved, strict=True):
            self.assertEqual(frame.readings[0, 0], 40 + frame.sequence % 50)
            np.testing.assert_allclose(forces.normal, frame.readings[0, 0] / 100, rtol=1e-5)
            self.assertEqual(float(forces.times), frame.time_s)
        self.assertAlmostEqual(message["total"]["force"]["normal"],
                               float(solved[0].normal.sum()), 2)
        read = pf.open(saved)
        self.assertEqual(len(read), 20)
        self.assertEqual(read[3].contacts[0].track_id, 1)
        saved.unlink()

    def test_forces_to_another_program(self):
        name = f"shm:pillarfield-python-{os.getpid()}"
        plan = pf.Plan(pf.Skin(16, 24, counts_per_newton=100, sensel_pitch_mm=0.7), friction=0.5)
        readings = np.zeros((16, 24), np.uint8)
        readings[4:8, 6:12] = 40, 50, 60, 50, 40, 60
        with pf.Processor(plan, contacts=True) as processor, pf.sink(name, plan, contacts=True) as sink, \
                pf.live_forces(name) as source:
            self.assertIsInstance(source, pf.LiveForces)
            self.assertIsNone(source.receive(0))
            processor.submit(readings)
            sent = processor.receive().copy()
            sink.send(sent)
            got = next(source)
            self.assertEqual(float(got.times), float(sent.times))
            for plane in ("shear_x", "shear_y", "normal", "status"):
                np.testing.assert_array_equal(getattr(got, plane), getattr(sent, plane))
            self.assertEqual((got.contacts[0].friction, got.contacts.total.normal_n), (0.5, sent.contacts.total.normal_n))
            self.assertEqual((source.health["frames"], source.health["lost"]), (1, 0))
            self.assertEqual((source.skin.rows, source.skin.sensel_pitch_mm), (16, 0.7))
            with self.assertRaisesRegex(pf.Error, "results, not frames"):
                pf.live(name)
        self.assertEqual(len(got.contacts), 1)  # It is kept.
        with self.assertRaisesRegex(pf.Error, "closed"):
            source.receive(0)

    def test_missing_rows_are_pillars_without_force(self):
        plan = pf.Plan(pf.Skin(8, 12, counts_per_newton=100))
        with pf.Processor(plan) as processor:
            processor.submit(pf.Frame(np.full((8, 12), 50, np.uint8), 3.0, 7, [(2, 1, 0, 6)]))
            forces = processor.receive()
        lost = np.zeros((4, 6), bool)
        lost[1, :3] = True
        np.testing.assert_array_equal(forces.where(pf.Status.INCONSISTENT), lost)
        np.testing.assert_array_equal(forces.normal == 0, lost)
        self.assertEqual(float(forces.times), 3.0)

    def test_a_silent_source(self):
        for source in (f"udp:127.0.0.1:{free_port()}", "shm:pillarfield-not-there"):
            with self.assertRaisesRegex(pf.Error, "no frame came in 0.2 s"):
                pf.live(source, timeout=0.2)

    def test_time_without_frames(self):
        port = free_port()
        with Sender(port) as sender:
            source = pf.live(f"udp:127.0.0.1:{port}")
            sender.stopped.set()
            sender.join()
            while source.receive(0.3) is not None:
                pass
            start = time.monotonic()
            self.assertIsNone(source.receive(0.2))
            self.assertGreater(time.monotonic() - start, 0.15)
            self.assertIsNone(source.receive(0))
            source.close()
            with self.assertRaisesRegex(pf.Error, "closed"):
                source.receive(0)

    def test_a_signal_handler_may_close_the_source(self):
        port = free_port()
        with Sender(port):
            source = pf.live(f"udp:127.0.0.1:{port}")
        before = signal.signal(signal.SIGALRM, lambda *_: source.close())
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with self.assertRaisesRegex(pf.Error, "closed"):
            for _ in source:
                pass
        signal.signal(signal.SIGALRM, before)

    def test_wrong_names(self):
        plan = pf.Plan(pf.Skin(8, 12))
        for name in ("", "udp:", "udp:127.0.0.1:notaport", "serial:/no/such/device", "http://x"):
            with self.assertRaises(pf.Error):
                pf.live(name)
        for name in ("", "udp:", "forces.xyz", "/no/such/folder/forces.h5"):
            with self.assertRaises(pf.Error):
                pf.sink(name, plan)
        sink = pf.sink(str(WORK / "unused.h5"), plan, overwrite=True)
        for wrong in (pf.solve(np.zeros((2, 8, 12))), pf.solve(np.zeros((8, 14)))):
            with self.assertRaises(pf.Error):
                sink.send(wrong)
        sink.close(finish=False)
        with self.assertRaisesRegex(pf.Error, "closed"):
            sink.send(pf.solve(np.zeros((8, 12)), layout="pillars"))


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
