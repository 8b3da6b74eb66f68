"""`pillarfield stream`: frames of files and of sockets through the solver to files and sockets."""

import json
import os
import pty
import signal
import socket
import stat
import struct
import subprocess
import threading
import time
import tty
import unittest

import h5py
import numpy as np

from command import BALL, PROGRAM, CommandTest, run

PATIENCE_S = 600


def wait_for(condition, what):
    """Waits until condition() is true."""
    end = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        assert time.monotonic() < end, f"{what} did not come"
        time.sleep(0.01)
    return value


class Control:
    """A client of the control socket."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        wait_for(lambda: self.connects(path), "the control socket")
        self.socket.settimeout(PATIENCE_S)
        self.file = self.socket.makefile("rw")

    def connects(self, path):
        try:
            self.socket.connect(str(path))
        except (FileNotFoundError, ConnectionRefusedError):  # Not there, or does not listen yet.
            return False
        return True

    def say(self, line):
        self.file.write(line + "\n")
        self.file.flush()
        return json.loads(self.file.readline())

    def close(self):
        self.file.close()
        self.socket.close()


class StreamTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(BALL)
        self.recording = self.folder / "ball.h5"
        run("simulate", self.scene, "-o", self.recording)
        self.socket = self.folder / "control"

    def started(self, *arguments, **options):
        """Starts a stream that the test ends."""
        process = subprocess.Popen([PROGRAM, "stream", *map(str, arguments)], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def control(self):
        control = Control(self.socket)
        self.addCleanup(control.close)
        return control

    def ended(self, process):
        """The summary of a stream that ends by itself."""
        out, err = process.communicate(timeout=PATIENCE_S)
        self.assertEqual((process.returncode, err), (0, ""))
        lines = [json.loads(line) for line in out.splitlines()]
        self.assertEqual([list(line)[0] for line in lines[-1:]], ["summary"])
        return lines[-1]["summary"]

    def assert_same_forces(self, actual, expected):
        with h5py.File(actual) as a, h5py.File(expected) as b:
            for plane in ("shear_x", "shear_y", "normal", "status"):
                np.testing.assert_array_equal(a["force"][plane][:], b["force"][plane][:])


class SerialSearch(StreamTest):
    def board(self, readings, name="ttyUSB0"):
        """A serial device in the folder that sends these readings as frames of a FlexiTac board."""
        board, line = pty.openpty()
        tty.setraw(line)
        os.set_blocking(board, False)
        (self.folder / name).symlink_to(os.ttyname(line))
        ends = threading.Event()

        def send():
            while not ends.wait(0.005):
                try:
                    os.write(board, b"\xaa\x55" + bytes(readings) if readings else b"hello\n")
                except BlockingIOError:
                    pass

        sender = threading.Thread(target=send)
        sender.start()
        self.addCleanup(lambda: (ends.set(), sender.join(), os.close(board), os.close(line)))

    def test_a_board_is_found_with_its_size(self):
        self.board(None, "ttyUSB0")
        readings = list(range(96)) * 4
        self.board(readings, "ttyUSB1")
        copy = self.folder / "copy.h5"
        process = self.started(f"serial:{self.folder}/ttyUSB*", "--frames", 5, "--record", copy, "-q")
        error = process.communicate(timeout=PATIENCE_S)[1]
        self.assertEqual(process.returncode, 0, error)
        self.assertRegex(error, r"found a FlexiTac board on .*ttyUSB1, 384 readings a frame: 16 x 24 is assumed")
        with h5py.File(copy) as file:
            np.testing.assert_array_equal(file["frames/raw"][0].ravel(), readings)

    def test_a_stated_size_counts_where_frames_have_as_many_readings(self):
        self.board(list(range(96)) * 4)
        for pillars, words in (("[6, 16]", "12 x 32 as stated"), ("[6, 17]", "16 x 24 is assumed")):
            self.scene.write_text(BALL.replace("[20, 20]", pillars))
            process = self.started(f"serial:{self.folder}/tty*", "--scene", self.scene, "--frames", 2)
            self.assertIn(words, process.communicate(timeout=PATIENCE_S)[1])
            self.assertEqual(process.returncode, int("assumed" in words))

    def test_devices_without_a_board_are_named(self):
        self.board(None)
        self.assert_fails("stream", f"serial:{self.folder}/tty*", "-q", names=["ttyUSB0 sends lines of text", "baud"])
        self.assert_fails("stream", f"serial:{self.folder}/none*", "-q", names=["no device is", "plug"])


class Replay(StreamTest):
    def test_a_recording_gives_the_forces_of_solve_and_its_own_frames(self):
        forces, copy = self.folder / "live.h5", self.folder / "copy.h5"
        csv = self.folder / "live.csv"
        summary = self.ended(self.started(self.recording, "--to", forces, "--to", csv, "--record",
                                          copy, "--json"))
        self.assertEqual((summary["solved"], summary["lost"]), (6, 0))
        self.assertEqual([(sink["frames"], sink["dropped"]) for sink in summary["sinks"]],
                         3 * [(6, 0)])
        for name in ("solved.h5", "solved.csv"):
            run("solve", self.recording, "-o", self.folder / name)
        self.assert_same_forces(forces, self.folder / "solved.h5")
        self.assertEqual(csv.read_text(), (self.folder / "solved.csv").read_text())
        with h5py.File(copy) as a, h5py.File(self.recording) as b:
            np.testing.assert_array_equal(a["frames/raw"][:], b["frames/raw"][:])
            np.testing.assert_array_equal(a["frames/time"][:], b["frames/time"][:])

    def test_a_scene_repeats_until_its_limit(self):
        summary = self.ended(self.started(self.scene, "--repeat", "--rate", 400, "--frames", 50,
                                          "--json"))
        self.assertEqual(summary["solved"], 50)
        self.assertGreater(summary["seconds"], 49 / 400 * 0.9)
        self.assertLessEqual(summary["latency_ms"]["median"], summary["latency_ms"]["p99"])
        # Frames that come faster than they are solved: several are in flight at the limit.
        summary = self.ended(self.started(self.scene, "--repeat", "--rate", 100000, "--frames", 50,
                                          "--json"))
        self.assertEqual(summary["solved"], 50)

    def test_planes_of_a_scene_are_computed_for_sinks_or_by_request(self):
        full = self.folder / "full.toml"
        full.write_text(BALL + "[solver]\nangles = true\nuncertainty = true\n")

        def forces_over_readings(*arguments):
            cost = self.ended(self.started(full, "--frames", 3, "--rate", 100, "--summary", "--json",
                                           *arguments))["cost"]
            return cost["forces_gb_per_s"] / cost["readings_gb_per_s"]

        forces_alone = 13 / 4  # bytes of a pillar: three floats and the status
        self.assertAlmostEqual(forces_over_readings(), forces_alone, 6)
        self.assertAlmostEqual(forces_over_readings("--outputs", "angles"), 25 / 4, 6)
        self.assertGreater(forces_over_readings("--to", self.folder / "all.h5"), 60 / 4)

    def test_the_summary_counts_late_and_lost_frames(self):
        limits = ("--repeat", "--frames", 20, "--summary")
        summary = self.ended(self.started(self.scene, "--rate", 0.5, "--seconds", 1, "--summary",
                                          "--json"))
        self.assertEqual((summary["solved"], summary["lost"], summary["missed"]), (1, 0, 0))
        summary = self.ended(self.started(self.scene, "--rate", 100000, *limits, "--json"))
        latency = summary["latency_ms"]
        self.assertEqual(list(latency), ["median", "p99", "p99_9", "worst"])
        self.assertEqual((summary["solved"], summary["missed"]), (20, 20))
        self.assertGreater(summary["lost"], 0)
        self.assertEqual(summary["overrun"], summary["lost"])
        self.assertIsNone(latency["p99"])
        cost = summary["cost"]
        self.assertGreater(cost["core_s_per_frame"], 0)
        # Four readings of a byte; three forces of four and a status.
        self.assertAlmostEqual(cost["forces_gb_per_s"] / cost["readings_gb_per_s"], 13 / 4)
        text = run("stream", self.scene, "--rate", 100000, *limits).stdout
        for words in ("99 % never", "20 frames solved more than a period of 0.010 ms", " lost, ",
                      " GB/s of forces out", " core-milliseconds"):
            self.assertIn(words, text)

    def test_an_interrupt_completes_the_files(self):
        forces = self.folder / "live.h5"
        process = self.started(self.scene, "--repeat", "--to", forces, "--control", self.socket,
                               "--json")
        control = self.control()
        wait_for(lambda: control.say("health")["health"]["solved"] > 5, "six frames")
        process.send_signal(signal.SIGINT)
        solved = self.ended(process)["solved"]
        with h5py.File(forces) as file:
            self.assertEqual(len(file["force/normal"]), solved)

    def test_a_reader_that_ends_completes_the_files(self):
        copy = self.folder / "copy.h5"
        process = self.started(self.recording, "--repeat", "--record", copy, "--json",
                               "--health-interval", 0.1)
        process.stdout.readline()
        process.stdout.close()
        self.assertEqual(process.wait(PATIENCE_S), 0)
        with h5py.File(copy) as file:
            self.assertGreater(len(file["frames/raw"]), 0)

    def test_a_killed_run_leaves_the_flushed_frames_of_its_recording(self):
        copy = self.folder / "copy.h5"
        process = self.started(self.recording, "--repeat", "--rate", 500, "--record", copy,
                               "--control", self.socket)
        control = self.control()
        wait_for(lambda: control.say("health")["health"]["seconds"] > 2.5, "the third second")
        process.kill()
        process.wait()
        part = self.folder / "copy.h5.part"
        with h5py.File(self.recording) as file:
            frames = file["frames/raw"][:]
        run("solve", part, "-o", self.folder / "again.h5", "-q")
        with h5py.File(part, "r", swmr=True) as file:
            kept = file["frames/raw"][:]
        self.assertGreater(len(kept), 400)
        for index, frame in enumerate(kept):
            np.testing.assert_array_equal(frame, frames[index % 6])

    def test_a_file_that_is_read_is_never_written(self):
        before = self.recording.read_bytes()
        for option in ("--to", "--record"):
            self.assert_fails("stream", self.recording, option, self.recording, "--overwrite",
                              names=("ball.h5",))
        process = self.started(self.recording, "--repeat", "--overwrite", "--control", self.socket,
                               "--json")
        control = self.control()
        self.assertIn("ball.h5", control.say(f"record {self.recording}")["error"])
        control.say("quit")
        self.ended(process)
        self.assertEqual(self.recording.read_bytes(), before)

    def test_refusals(self):
        for arguments, names in [
                (("nothing.h5",), ("nothing.h5",)),
                ((self.recording, "--to", "nowhere"), ("nowhere", ".mcap")),
                ((self.recording, "--control", self.recording), ("not a socket",)),
                ((self.recording, "--follow-baseline", 3), ("--rate",))]:
            self.assert_fails("stream", *arguments, names=names)

    def test_a_busy_port_names_the_way(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            self.assert_fails("stream", f"udp:127.0.0.1:{other.getsockname()[1]}", "-q", names=("--relay shm:NAME",))


class Network(StreamTest):
    def test_frames_of_another_size_are_named_once(self):
        process = self.started("-", "--json", "--health-interval", 0.1, stdin=subprocess.PIPE)
        for number in range(60):
            process.stdin.buffer.write(packet(40, number, side=8 if number < 10 else 12))
            process.stdin.flush()
            time.sleep(0.01)
        output, errors = process.communicate(timeout=PATIENCE_S)
        self.assertEqual((process.returncode, errors.count("frames are 12 x 12, 8 x 8 expected")), (0, 1), errors)
        self.assertIn('"mismatch"', output)

    def test_one_line_tells_what_is_assumed(self):
        frames = b"".join(struct.pack("<4sHHIIQQQ6I", b"PFR1", 0, 1, 4, 6, 0, number, number * 10**7, 0, 1, 0, 0,
                                      0, 24) + bytes(24) for number in range(20))
        constants = ("--pitch-mm", 5, "--counts-per-newton", 40)
        for options, words in (
                ((), "each sensel by itself, without shear (--layout pillars: 2 x 2 are a pillar); pitch 0.632 mm "
                     "assumed (--pitch-mm); 320 counts per newton assumed (--counts-per-newton)\n"),
                (("--layout", "sensels", *constants), None), (("--layout", "pillars", *constants), None)):
            process = self.started("-", *options, stdin=subprocess.PIPE)
            process.stdin.buffer.write(frames)
            output, errors = process.communicate(timeout=PATIENCE_S)
            self.assertEqual(process.returncode, 0)
            self.assertIn("2 x 3 pillars" if "pillars" in options else "4 x 6 sensels", output)
            self.assertEqual(errors.count("assumed"), 0 if words is None else 2, errors)
            self.assertIn(words or "", errors)

    def test_options_about_files_are_refused(self):
        for option in (("--dataset", "a"), ("--times", "a"), ("--shape", "4x6"), ("--columns", "1-24"),
                       ("--axes", "rows,columns")):
            for command in ("stream", "doctor"):
                self.assert_fails(command, "udp:127.0.0.1:0", "-q", *option, names=(option[0], "leave it out"))

    def test_web_pages_must_be_allowed(self):
        process = self.started(self.scene, "--repeat", "--to", "foxglove:0", "--json",
                               "--allow-origin", "https://app.foxglove.dev", "--health-interval",
                               0.1)
        [sink] = json.loads(process.stdout.readline())["health"]["sinks"]
        for page, status in (("https://app.foxglove.dev", b"101"), ("https://evil.example", b"403")):
            with socket.create_connection(("127.0.0.1", int(sink["name"].rsplit(":", 1)[1]))) as client:
                client.sendall(f"GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: {page}\r\nUpgrade: "
                               "websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                               "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
                               "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n".encode())
                self.assertEqual(client.recv(12)[9:], status)
        self.assertEqual(process.stderr.readline(), f"Open ws://{sink['name'].split(':', 1)[1]} in Foxglove\n")
        self.assertIn("refused the web page https://evil.example", process.stderr.readline())


def packet(reading, number, side=8):
    return struct.pack("<4sHHIIQQQ6I", b"PFR1", 0, 1, side, side, 0, number, 10**7 * (number + 1), 0, 1, 0, 0, 0,
                       side**2) + bytes([reading]) * side**2


class FirstFrames(StreamTest):
    def udp(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            return free.getsockname()

    def test_limits_hold_where_no_frame_comes(self):
        silent = f"udp:127.0.0.1:{self.udp()[1]}"
        for words in (("stream", silent, "--seconds", 0.3), ("stream", silent, "--end-when-idle", 0.3),
                      ("stream", "shm:pillarfield_not_there", "--seconds", 0.3),
                      ("doctor", silent, "--seconds", 0.3)):
            self.assertIn("no frame came in 0.3 s", run(*words, expect=1).stderr.splitlines()[-1])

    def test_outputs_are_checked_before_a_frame_comes(self):
        silent = f"udp:127.0.0.1:{self.udp()[1]}"
        for words, names in ((("--to", "foo:9"), ("foo:9", "shm:NAME")), (("--to", "udp:1.2.3.4:x"), ("'x'",)),
                             (("--to", "web:nowhere:80"), ("nowhere",)), (("--relay", "foo"), ("shm:NAME",))):
            self.assert_fails("stream", silent, *words, names=names)

    def test_of_frames_that_wait_the_newest_is_solved(self):
        copy = self.folder / "copy.h5"
        frames = b"".join(packet(number % 50, number) for number in range(300))
        process = self.started("-", "--newest", "--record", copy, "--json", stdin=subprocess.PIPE)
        process.stdin.buffer.write(frames)
        process.stdin.flush()
        out, errors = process.communicate(timeout=PATIENCE_S)
        self.assertEqual(process.returncode, 0, errors)
        summary = json.loads(out.splitlines()[-1])["summary"]
        self.assertLess(summary["solved"], 300)
        self.assertEqual((summary["frames"] + summary["lost"], summary["frames"]), (300, summary["solved"]))
        self.assertEqual(summary["overrun"], summary["lost"])
        with h5py.File(copy) as file:
            self.assertEqual(file["frames/raw"][-1].max(), 299 % 50)
        self.assert_fails("stream", self.recording, "--newest", names=["--newest", "live"])

    def test_bytes_without_packets_are_named(self):
        device, terminal = os.openpty()
        self.addCleanup(os.close, device)
        self.addCleanup(os.close, terminal)
        process = self.started(f"serial:{os.ttyname(terminal)}", "--seconds", 2)
        wait_for(lambda: "Waiting" in process.stderr.readline(), "the program")
        frames = bytes(range(64)) * 16
        while process.poll() is None:
            os.write(device, frames)
            time.sleep(0.02)
        errors = process.stderr.read()
        self.assertEqual(process.returncode, 1)
        self.assertRegex(errors, r" kB came, no packet: it sends frames of 64 bytes that begin with 01 02 ")

    def test_an_untared_array_is_named_once(self):
        process = self.started("-", "--json", "--health-interval", 0.1, stdin=subprocess.PIPE)
        number, coverage = 0, None
        while not coverage:
            for _ in range(20):
                process.stdin.buffer.write(packet(40, number))
                process.stdin.flush()
                number += 1
                time.sleep(0.01)
            coverage = json.loads(process.stdout.readline())["health"]["coverage"]
        errors = process.communicate(timeout=PATIENCE_S)[1]
        self.assertEqual(errors.count("100.0 % of all"), 1, errors)
        self.assertIn("there is no tare", errors)


class Tares(StreamTest):
    def test_a_touched_skin_ends_the_run_before_a_frame_is_written(self):
        forces = self.folder / "forces.csv"
        process = self.started(self.scene, "--repeat", "--tare", 0.2, "--to", forces, "--frames", 5)
        errors = process.communicate(timeout=PATIENCE_S)[1]
        self.assertEqual(process.returncode, 1)
        self.assertRegex(errors, "--tare: no frame was solved: tare: .*touched")
        self.assertFalse(forces.exists() and len(forces.read_text().splitlines()) > 1)


class ControlLines(StreamTest):
    def test_every_line(self):
        process = self.started(self.scene, "--repeat", "--control", self.socket, "--json")
        control = self.control()
        self.assertEqual(stat.S_IMODE(os.stat(self.socket).st_mode) & 0o077, 0)
        self.assertEqual(control.say("pause"), {"ok": True, "done": "pause"})
        solved = control.say("health")["health"]["solved"]
        before = control.say("health")["health"]["frames"]
        wait_for(lambda: control.say("health")["health"]["frames"] > before, "another frame")
        health = control.say("health")["health"]
        self.assertLessEqual(health["solved"], solved + 2)  # Two were in flight.
        self.assertTrue(health["paused"])
        control.say("resume")
        wait_for(lambda: control.say("health")["health"]["solved"] > solved + 5, "further frames")
        self.assertIn("touched", control.say("tare 0.1")["error"])
        answer = control.say("tare 0.1 preloaded")
        self.assertTrue(answer["ok"], answer)
        self.assertIn("would not have been seen", answer["note"])
        for line in ("tare -1", "tare nan", "tare 61", "record", "record stop", "hold", "pause now"):
            self.assertFalse(control.say(line)["ok"], line)
        copy = self.folder / "copy.h5"
        self.assertTrue(control.say(f"record {copy}")["ok"])
        self.assertFalse(control.say(f"record {self.folder / 'other.h5'}")["ok"])
        wait_for(lambda: control.say("health")["health"]["sinks"][0]["frames"] > 3, "a recording")
        self.assertTrue(control.say("record stop")["ok"])
        with h5py.File(copy) as file:
            self.assertGreater(len(file["frames/raw"]), 3)
            self.assertEqual(file["calibration/tare"].shape, (40, 40))
        self.assertTrue(control.say("quit")["ok"])
        self.ended(process)
        self.assertFalse(self.socket.exists())

    def test_an_answer_comes_after_the_client_closed_its_sending_side(self):
        process = self.started(self.scene, "--repeat", "--control", self.socket, "--json")
        self.control().say("health")
        client = socket.socket(socket.AF_UNIX)
        client.settimeout(PATIENCE_S)
        client.connect(str(self.socket))
        client.sendall(b"tare 0.7\n")
        client.shutdown(socket.SHUT_WR)
        parts = []
        while part := client.recv(4096):
            parts.append(part)
        client.close()
        self.assertIn("touched", json.loads(b"".join(parts))["error"])
        self.assertGreater(len(parts), 2)  # socat leaves where nothing comes for half a second.
        self.control().say("quit")
        self.ended(process)

    def test_the_command_that_controls(self):
        def control(*words, **options):
            return json.loads(run("control", self.socket, *words, **options).stdout)

        process = self.started(self.scene, "--repeat", "--control", self.socket, "--json")
        wait_for(self.socket.exists, "the control socket")
        self.assertEqual(control("pause"), {"ok": True, "done": "pause"})
        control("record", "a copy.h5", cwd=self.folder)
        control("record", "stop")
        self.assertTrue((self.folder / "a copy.h5").exists())
        control("hold", expect=1)
        control("quit")
        self.ended(process)
        self.assert_fails("control", self.socket, "health", names=("no stream listens",))

    def test_a_name_lies_in_the_private_folder(self):
        private = {"env": dict(os.environ, XDG_RUNTIME_DIR=str(self.folder))}
        process = self.started(self.scene, "--repeat", "--control", "skin", "--json", **private)
        wait_for((self.folder / "skin").exists, "the control socket")
        run("control", "skin", "quit", **private)
        self.ended(process)

    def test_a_socket_whose_owner_is_busy_is_neither_waited_for_nor_removed(self):
        owner = socket.socket(socket.AF_UNIX)
        self.addCleanup(owner.close)
        owner.bind(str(self.socket))
        owner.listen(0)
        for _ in range(3):
            client = socket.socket(socket.AF_UNIX)
            self.addCleanup(client.close)
            client.setblocking(False)
            client.connect_ex(str(self.socket))
        self.assert_fails("stream", self.recording, "--control", self.socket, names=("listens",))
        self.assertTrue(self.socket.exists())

    def test_rubbish_and_many_clients_do_no_harm(self):
        process = self.started(self.scene, "--repeat", "--control", self.socket, "--json")
        others = [Control(self.socket) for _ in range(12)]
        others[-1].socket.sendall(b"\xff\x00" * 20000)
        others[-2].socket.sendall(b"health\n" * 5000)  # and never reads
        control = self.control()  # The others are idle, and lock nobody out.
        wait_for(lambda: control.say("health")["health"]["solved"] > 20, "frames")
        control.say("quit")
        self.ended(process)
        for other in others:
            other.close()

    def test_a_left_socket_is_replaced(self):
        process = self.started(self.scene, "--repeat", "--control", self.socket, "--json")
        self.control().say("health")
        process.kill()
        process.wait()
        self.assertTrue(self.socket.exists())
        self.ended(self.started(self.recording, "--control", self.socket, "--json"))

    def test_standard_input(self):
        process = self.started(self.scene, "--repeat", "--control", "-", "--json",
                               stdin=subprocess.PIPE)
        process.stdin.write("pause\nquit\n")
        process.stdin.flush()
        out = process.communicate(timeout=PATIENCE_S)[0]
        answers = [json.loads(line) for line in out.splitlines()]
        self.assertIn({"ok": True, "done": "quit"}, answers)


if __name__ == "__main__":
    unittest.main()
