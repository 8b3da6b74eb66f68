"""One array has one force, one pressure and one number of contacts by every way in and out."""

import contextlib
import csv
import json
import os
import pathlib
import pty
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import tty
import unittest

import h5py
import numpy as np

import pillarfield as pf

sys.path.insert(0, str(pathlib.Path(os.environ["PILLARFIELD_SOURCE"], "tests/streams")))
from websocket_client import BINARY, WebSocket  # noqa: E402

PROGRAM = os.environ["PILLARFIELD"]
VIEWER = pathlib.Path(os.environ["PILLARFIELD_BUILD"], "bin/pillarfield-viewer")
PITCH_MM, K, THRESHOLD = 5.0, 40.0, 6.0
LAYOUTS = ("pillars", "sensels")  # 1 and 2 in packets


def readings():
    """Two bodies on an array with noise below the threshold."""
    frame = np.random.default_rng(7).integers(0, 5, (16, 24))
    for row, col in ((2, 4), (8, 14)):
        frame[row:row + 4, col:col + 6] = 60 + 4 * np.arange(24).reshape(4, 6)
    return frame.astype(np.uint8)


FRAME = readings()


def expected(layout):
    """Newtons, the largest kPa and contacts, by independent code."""
    loads = np.where(FRAME > THRESHOLD, FRAME, 0) / K
    side = PITCH_MM
    if layout == "pillars":
        loads, side = loads.reshape(8, 2, 12, 2).mean((1, 3)), 2 * PITCH_MM
    return loads.sum(), 1000 * loads.max() / side**2, 2


def answer_of(normal, pitch_mm, contacts):
    return float(normal.sum()), 1000 * float(normal.max()) / pitch_mm**2, contacts


def words(layout):
    given = ["--pitch-mm", PITCH_MM, "--counts-per-newton", K, "--threshold", THRESHOLD]
    return [str(word) for word in given + (["--layout", layout] if layout == "pillars" else [])]


def packet(number, stated=0, counts_per_newton=0.0):
    header = struct.pack("<4sHHIIQQQ3If2I", b"PFR1", 0, 1, *FRAME.shape, 7, number, 10_000_000 * (number + 1),
                         0, 1, stated, counts_per_newton, 0, FRAME.nbytes)
    return header + FRAME.tobytes()


@contextlib.contextmanager
def repeated(send):
    """Calls send(number) until the end."""
    stopped = threading.Event()

    def work():
        number = 0
        with contextlib.suppress(OSError):
            while not stopped.wait(0.005):
                send(number)
                number += 1
    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield
    finally:
        stopped.set()
        thread.join()


class Doors(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        np.save(self.folder / "array.npy", np.stack([FRAME] * 12))
        np.savetxt(self.folder / "array.csv", np.stack([FRAME] * 12).reshape(12, -1), fmt="%d", delimiter=",")
        with h5py.File(self.folder / "array.h5", "w") as file:
            file["frames"] = np.stack([FRAME] * 12)

    def agree(self, layout, answer, way):
        with self.subTest(layout=layout, way=way):
            np.testing.assert_allclose(answer, expected(layout), rtol=2e-6)

    def run_program(self, *arguments):
        return subprocess.run([str(word) for word in arguments], cwd=self.folder, check=True, timeout=600,
                              capture_output=True, text=True)

    def answer_of_file(self, path):
        forces = pf.open(self.folder / path)[0]
        return answer_of(forces.normal, forces._skin.element_pitch_mm, len(forces.contacts))

    def test_files(self):
        for layout in LAYOUTS:
            for name, how in (("array.npy", []), ("array.csv", ["--shape", "16x24"]),
                              ("array.h5", ["--dataset", "frames"])):
                options = [*how, "--rate", 100, *words(layout)]
                self.run_program(PROGRAM, "solve", name, *options, "--overwrite", "-o", "forces.h5",
                                 "--contacts", "forces.h5")
                self.agree(layout, self.answer_of_file("forces.h5"), name)
                self.run_program(PROGRAM, "solve", name, *options, "--overwrite", "-o", "forces.csv",
                                 "--contacts", "contacts.csv")
                with open(self.folder / "contacts.csv", encoding="ascii") as file:
                    rows = [row for row in csv.DictReader(file) if row["row"] == "contact" and row["frame"] == "0"]
                force = sum(float(row["normal_n"]) for row in rows)
                pressure = max(float(row["peak_pressure_kpa"]) for row in rows)
                self.agree(layout, (force, pressure, len(rows)), name + ", table")
                if VIEWER.exists():
                    self.run_program(VIEWER, name, *options, "--headless", "--frame", 1, "--csv", "shown.csv")
                    with open(self.folder / "shown.csv", encoding="ascii") as file:
                        lines = [line for line in file if not line.startswith("#")]
                    normal = np.array([float(row["normal_n"]) for row in csv.DictReader(lines)])
                    (self.folder / "shown.csv").unlink()
                    self.agree(layout, (normal.sum(), *expected(layout)[1:]), name + ", viewer")

    def test_arrays_in_python(self):
        frames = np.stack([FRAME] * 12)
        constants = {"counts_per_newton": K, "threshold_counts": THRESHOLD}
        for layout in LAYOUTS:
            skin = pf.Skin(16, 24, layout=layout, sensel_pitch_mm=PITCH_MM, **constants)
            options = {"pitch_mm": PITCH_MM, "contacts": True, **constants}
            if layout == "pillars":
                options["layout"] = layout
            path = self.folder / "array.npy"
            for way, forces in {
                    "array": pf.solve(frames, **options), "file": pf.solve(path, rate_hz=100, **options),
                    "iterator": pf.solve(iter(frames), **options),
                    "mirrored": pf.solve(255 - frames, falling=True, **options),
                    "mirrored iterator": pf.solve(iter(255 - frames), falling=True, **options),
                    "skin": pf.solve(frames, skin=skin, contacts=True)}.items():
                pressure = float(forces[0].pressure_kpa.max())
                self.agree(layout, (forces[0].normal.sum(), pressure, len(forces[0].contacts)), way)
            with pf.Processor(pf.Plan(skin), contacts=True) as processor:
                processor.submit(FRAME)
                forces = processor.receive()
            self.agree(layout, answer_of(forces.normal, skin.element_pitch_mm, len(forces.contacts)), "processor")

    def started(self, source, *options, **streams):
        process = subprocess.Popen([PROGRAM, "stream", source, *map(str, options)], text=False, cwd=self.folder,
                                   stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, **streams)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def check_stream(self, layout, way, source, *options, **streams):
        """Runs a stream into every live sink, and compares what each one says."""
        ring = f"pillarfield-doors-{os.getpid()}"
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
            listener.bind(("127.0.0.1", 0))
            listener.settimeout(600)
            port = listener.getsockname()[1]
            process = self.started(source, *options, "--overwrite", "--to", "live.h5", "--to", f"udp:127.0.0.1:{port}",
                                   "--to", f"shm:{ring}", "--to", "web:0", **streams)
            said = b""
            while not (address := re.search(rb"Open http://127\.0\.0\.1:(\d+)", said)):
                line = process.stderr.readline()
                self.assertTrue(line, said.decode())
                said += line
            drain = threading.Thread(target=process.stderr.read)
            drain.start()
            total = json.loads(listener.recv(65536))
            with pf.live_forces(f"shm:{ring}") as results:
                shown = next(results)
            with WebSocket(int(address[1]), protocols=("pillarfield.page.v2",)) as page:
                page.write("next")
                picture = b"\1"
                while picture[0] != 0:
                    kind, picture = page.read()
                    self.assertEqual(kind, BINARY)
            process.send_signal(signal.SIGINT)
            drain.join()
            self.assertEqual(process.wait(timeout=600), 0)
        force, pressure, contacts = expected(layout)
        self.agree(layout, (total["total"]["force"]["normal"], total["total"].get("peak_pressure_kpa", pressure),
                            len(total["contacts"])), way + ", JSON")
        self.agree(layout, answer_of(shown.normal, shown._skin.element_pitch_mm, len(shown.contacts)), way + ", ring")
        rows, cols, planes, pitch_mm, _ = struct.unpack_from("<3I2f", picture, 4)
        end = 24 + 4 * planes * rows * cols
        normal = np.frombuffer(picture, "<f4", planes * rows * cols, 24).reshape(planes, rows, cols)[-1]
        text = json.loads(picture[end + rows * cols:])
        self.agree(layout, answer_of(normal, pitch_mm, len(text["contacts"])), way + ", page")
        self.agree(layout, self.answer_of_file("live.h5"), way + ", file")
        return said.decode()

    def test_live_sources(self):
        for code, layout in enumerate(LAYOUTS, 1):
            stated = code << 30 | round(1e6 * PITCH_MM)
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
                out.bind(("127.0.0.1", 0))
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                    probe.bind(("127.0.0.1", 0))
                    place = probe.getsockname()
                udp = f"udp:127.0.0.1:{place[1]}"
                with repeated(lambda number: out.sendto(packet(number), place)):
                    self.check_stream(layout, "UDP", udp, *words(layout))
                    forces = self.live(udp, pitch_mm=PITCH_MM, layout=layout if code == 1 else "")
                    self.agree(layout, forces, "UDP, pf.live")
                with repeated(lambda number: out.sendto(packet(number, stated, K), place)):
                    said = self.check_stream(layout, "UDP that states", udp, "--threshold", THRESHOLD)
                    self.assertNotIn("assumed", said)
                    self.agree(layout, self.live(udp), "UDP that states, pf.live")

            reader, writer = os.pipe()
            with repeated(lambda number: os.write(writer, packet(number))):
                self.check_stream(layout, "stdin", "-", *words(layout), stdin=reader)
                os.close(reader)
            os.close(writer)

            board, line = pty.openpty()
            tty.setraw(line)
            os.set_blocking(board, False)

            def send(_, board=board):
                with contextlib.suppress(BlockingIOError):  # Nobody reads any more.
                    os.write(board, b"\xaa\x55" + FRAME.tobytes())

            with repeated(send):
                self.check_stream(layout, "FlexiTac", f"serial:{os.ttyname(line)}?protocol=flexitac&rows=16&cols=24",
                                  *words(layout))
            os.close(board)
            os.close(line)

            relay = f"shm:pillarfield-relay-{os.getpid()}"
            source = self.started("array.npy", "--rate", 200, "--repeat", "--relay", relay, *words(layout))
            threading.Thread(target=source.stderr.read, daemon=True).start()
            said = self.check_stream(layout, "relay", relay)
            self.assertNotIn("assumed", said)
            self.agree(layout, self.live(relay), "relay, pf.live")
            source.send_signal(signal.SIGINT)
            source.wait(timeout=600)

    def live(self, source, **options):
        with pf.live(source, **options) as frames:
            given = {} if options == {} and "counts_per_newton" in frames.skin.stated else {"counts_per_newton": K}
            plan = pf.Plan(frames.skin, threshold_counts=THRESHOLD, **given)
            with pf.Processor(plan, contacts=True) as processor:
                processor.submit(next(frames))
                forces = processor.receive()
        return answer_of(forces.normal, plan.skin.element_pitch_mm, len(forces.contacts))


if __name__ == "__main__":
    unittest.main()
