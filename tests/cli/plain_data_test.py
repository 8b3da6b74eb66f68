"""Plain data: .npy, .npz, tables of numbers and HDF5 datasets give the forces of the same recording."""

import importlib.util
import itertools
import json
import os
import pathlib
import pickle
import sqlite3
import struct
import subprocess
import sys
import unittest

import h5py
import numpy as np
from PIL import Image

from command import CommandTest, run, run_json

STREAMS = pathlib.Path(__file__).parent.parent / "streams"
CONSTANTS = ("--counts-per-newton", 200, "--threshold", 2, "--pitch-mm", 0.5, "--layout", "pillars")


def readings(dtype="u2"):
    """Five frames of 6 x 8 readings; with an odd row and column none is left over."""
    random = np.random.default_rng(3)
    frames = random.integers(1, 250, (5, 6, 8)) * (random.random((5, 6, 8)) < 0.7)
    return frames.astype(dtype)


class PlainData(CommandTest):
    def setUp(self):
        super().setUp()
        self.recording = self.folder / "recording.h5"
        with h5py.File(self.recording, "w") as file:
            file.attrs["format"], file.attrs["version"] = "pillarfield-recording", 1
            file["frames/raw"], file["frames/time"] = readings(), np.arange(5) / 100
            skin = file.create_group("skin")
            skin.attrs["counts_per_newton"], skin.attrs["threshold_counts"] = 200, 2
            skin.attrs["sensel_pitch_mm"] = 0.5
        self.expected = self.solve(self.recording)

    def solve(self, path, *options):
        """Forces (T, P, Q, 3), status and times."""
        forces = self.folder / "forces.h5"
        run("solve", path, "-o", forces, "-q", "--estimator", "direct", *options)
        with h5py.File(forces) as file:
            force = np.stack([file["force"][name][:] for name in ("shear_x", "shear_y", "normal")], -1)
            return force, file["force/status"][:], file["force/time"][:]

    def assert_solved(self, path, *options, frames=slice(None), times=None):
        found = self.solve(path, *CONSTANTS, *options)
        np.testing.assert_array_equal(found[0], self.expected[0][frames])
        np.testing.assert_array_equal(found[1], self.expected[1][frames])
        np.testing.assert_allclose(found[2], self.expected[2][frames] if times is None else times)

    def path(self, name):
        return self.folder / name

    def test_arrays_of_every_type(self):
        types = ("u1", "u2", "<f4", "f8", ">f4", ">f8", "i2", ">i2", "i4", ">u4", "i8", "u8")
        for dtype, version in [(dtype, (1, 0)) for dtype in types] + [("u2", (2, 0)), ("u2", (3, 0))]:
            with self.subTest(dtype=dtype, version=version), self.path("a.npy").open("wb") as file:
                np.lib.format.write_array(file, readings(dtype), version=version)
                file.flush()
                self.assert_solved(self.path("a.npy"), "--rate", 100)
        np.save(self.path("a.npy"), readings()[2])
        self.assert_solved(self.path("a.npy"), frames=slice(2, 3), times=[0])
        np.save(self.path("a.npy"), readings().reshape(5, -1))
        self.assert_solved(self.path("a.npy"), "--rate", 100, "--shape", "6x8")

    def test_axes_of_every_order(self):
        names, path = ("frames", "rows", "columns"), self.path("a.npy")
        for order in itertools.permutations(range(3)):
            words = ",".join(names[axis] for axis in order)
            np.save(path, np.ascontiguousarray(readings().transpose(order)))
            with self.subTest(axes=words):
                self.assert_solved(path, "--rate", 100, "--axes", words)
        with h5py.File(self.path("a.h5"), "w") as file:
            file.create_dataset("raw", data=readings().transpose(1, 2, 0), chunks=(6, 8, 1))
        self.assert_solved(self.path("a.h5"), "--dataset", "raw", "--rate", 100, "--axes",
                           "rows,columns,frames")
        np.save(path, np.ascontiguousarray(readings()[2].T))
        self.assert_solved(path, "--axes", "columns,rows", frames=slice(2, 3), times=[0])
        solve = ("solve", path, "-o", self.path("f.h5"))
        self.assert_fails(*solve, "--axes", "frames,rows,columns", names=["8 x 6", "3 axes"])
        for words in ("rows,rows", "frames,row,columns", "rows"):
            self.assert_fails(*solve, "--axes", words, status=2, names=["--axes"])
        self.assert_fails("solve", self.recording, "-o", self.path("f.h5"), "--axes", "rows,columns",
                          names=["leave out --axes"])

    def test_what_was_read_is_printed_and_a_doubtful_guess_refused(self):
        def spot(frames, rows, cols):
            """A spot that presses and leaves again."""
            time, row, col = np.ogrid[-1:1:frames * 1j, -1:1:rows * 1j, -1:1:cols * 1j]
            return (200 * (1 - time**2) * np.exp(-4 * (row**2 + col**2))).astype("u1")

        solve = ("solve", self.path("a.npy"), "-o", self.path("f.h5"), "--rate", 100)
        for shape in ((280, 63, 33), (30, 40, 60), (5, 40, 60)):
            np.save(self.path("a.npy"), spot(*shape))
            read = f"Read {shape[0]} frames of {shape[1]} x {shape[2]}, uint8"
            self.assertIn(read, run(*solve, "--overwrite").stderr)
            self.assertNotIn("Read", run(*solve, "--overwrite", "-q").stderr)
        for shape in ((280, 63, 33), (100, 13, 6), (120, 64, 27)):
            for axes in ((1, 2, 0), (1, 0, 2)):
                np.save(self.path("a.npy"), np.ascontiguousarray(spot(*shape).transpose(axes)))
                words = ",".join(("frames", "rows", "columns")[axis] for axis in axes)
                self.assert_fails(*solve, names=["doubtful", f"--axes '{words}'"])
                run(*solve, "--overwrite", "-q", "--axes", words)
        np.save(self.path("a.npy"), spot(70, 64, 32).reshape(70, -1))
        self.assert_fails(*solve, names=["70 lines of 2048 numbers", "--shape"])
        run(*solve, "--overwrite", "-q", "--shape", "64x32")
        run(*solve, "--overwrite", "-q", "--axes", "rows,columns")

    def test_signed_and_missing_readings(self):
        frames = readings("i2")
        frames[:, ::2] *= -1
        np.save(self.path("a.npy"), frames)
        below = self.solve(self.path("a.npy"), "--rate", 1, *CONSTANTS)[1]
        self.assertFalse((below & 3).any())  # sensels 1 and 2 are in the even rows
        frames = readings("f8")
        frames[1, 2, 3] = np.nan
        np.save(self.path("a.npy"), frames)
        status = self.solve(self.path("a.npy"), "--rate", 1, *CONSTANTS)[1]
        self.assertTrue(status[1, 1, 1] & 64)
        np.save(self.path("a.npy"), 255 - readings("u1"))
        self.assert_solved(self.path("a.npy"), "--rate", 100, "--falling")

    def test_totals_without_a_file_of_forces(self):
        frames = np.zeros((2, 6, 9), "u1")
        frames[1, 2:4, 3:6] = [[10, 20, 30], [20, 40, 60]]
        np.save(self.path("a.npy"), frames)
        for unit, pascal in (("psi", 6894.757), ("mmHg", 133.3224)):
            run("solve", self.path("a.npy"), "--contacts", self.path("c.csv"), "--axes", "frames,rows,columns",
                "--rate", 10, "--counts-per-newton", 10, "--pitch-mm", 5, "--overwrite", "--pressure-unit", unit)
            head, _, line = self.path("c.csv").read_text().splitlines()[:3]
            total = dict(zip(head.split(","), line.split(",")))
            self.assertAlmostEqual(float(total[f"peak_pressure_{unit.lower()}"]) * pascal / 240e3, 1, places=5)
            self.assertAlmostEqual(float(total[f"mean_pressure_{unit.lower()}"]) * pascal / 120e3, 1, places=5)
            self.assertNotIn("kpa", head)
            self.assertEqual((total["row"], total["frame"], total["sensels"]), ("patch", "1", "6"))
            self.assertNotIn("shear_x_n", total)
        self.assert_fails("solve", self.path("a.npy"), "-o", self.path("f.h5"), "--contacts", self.path("f.h5"),
                          "--pressure-unit", "psi", names=["HDF5", "kPa", ".csv"])

    def test_archives(self):
        other = np.ones((5, 6, 8))
        np.savez(self.path("a.npz"), raw=readings(">u2"), time=np.arange(5) / 100, note="text", k=3.0)
        self.assert_solved(self.path("a.npz"))
        np.savez(self.path("a.npz"), raw=readings("i4"), other=other, t=np.arange(5.) * 3, u=[1, 2])
        solve = ("solve", self.path("a.npz"), "-o", self.path("f.h5"))
        self.assert_fails(*solve, names=["raw, other", "--dataset"])
        self.assert_solved(self.path("a.npz"), "--dataset", "raw", "--times", "t", times=np.arange(5.) * 3)
        self.assert_fails(*solve, "--dataset", "raw", "--times", "u", names=["5 frames and 2 times"])

    def test_datasets(self):
        path = self.path("own.h5")
        with h5py.File(path, "w") as file:
            file["group/raw"] = readings("i4")
            file.create_dataset("packed", data=readings("f8"), chunks=(2, 5, 4), compression="gzip")
            file["lines"], file["frame"] = readings(">u2").reshape(5, -1), readings()[3]
            file["stamps"], file["mask"] = np.arange(5) / 100, readings() > 0
            file["elsewhere"] = h5py.ExternalLink("other.h5", "/raw")
        self.assert_fails("solve", path, "-o", self.path("f.h5"), names=["--dataset", "/group/raw"])
        self.assert_fails("info", path, names=["--dataset"])
        for options in (("group/raw",), ("/packed",), ("lines", "--shape", "6x8")):
            self.assert_solved(path, "--times", "stamps", "--dataset", *options)
        self.assert_solved(path, "--dataset", "frame", frames=slice(3, 4), times=[0])
        for name, words in (("mask", "booleans"), ("group", "not a dataset"), ("nix", "/group/raw"),
                            ("stamps", "shape 5"), ("elsewhere", "another file")):
            self.assert_fails("solve", path, "-o", self.path("f.h5"), "--rate", 1, "--dataset", name,
                              names=[words])
        self.assert_fails("solve", self.recording, "-o", self.path("f.h5"), "--dataset", "frames/raw",
                          names=["is a pillarfield-recording", "leave out"])

    def test_columns_of_a_table(self):
        frames, path = readings().reshape(5, -1), self.path("table.csv")
        table = np.hstack([np.arange(5)[:, None], frames, np.arange(5)[:, None] / 100, frames.sum(1, keepdims=True)])
        np.savetxt(path, table, delimiter=",", fmt="%.10g", comments="",
                   header="frame," + ",".join(f"p{i}" for i in range(48)) + ",time_s,total")
        self.assert_solved(path, "--shape", "6x8", "--columns", "2-25,p24,27-49")
        self.assert_fails("solve", self.recording, "-o", self.path("f.h5"), "--columns", "2-5",
                          names=["leave out --columns"])

    def test_recordings_of_other_types(self):
        for dtype in ("i2", "i4", "f8", ">i8"):
            with h5py.File(self.recording, "r+") as file:
                del file["frames/raw"]
                file["frames/raw"] = readings(dtype)
            np.testing.assert_array_equal(self.solve(self.recording)[0], self.expected[0])
        with h5py.File(self.recording, "r+") as file:
            del file["frames/raw"]
            file["frames/raw"] = readings() > 0
        self.assert_fails("solve", self.recording, "-o", self.path("f.h5"), names=["booleans"])

    def test_readings_that_give_no_contact_get_a_reason(self):
        random = np.random.default_rng(5)
        frames = random.normal(100, 1, (60, 20, 30))
        press = np.zeros_like(frames)
        press[40:, 5:12, 8:20] = 50
        solve = ("solve", self.path("a.npy"), "-o", self.path("f.h5"), "--rate", 100, "-q",
                 "--overwrite", "--tare-frames", 30)
        for added, words in ((press, ()), (-press, ("Readings fall", "84 sensels")),
                             (press / 25, ("No sensel is in contact", "--threshold"))):
            np.save(self.path("a.npy"), frames + added)
            warned = run(*solve).stderr
            self.assertEqual([word in warned for word in words], [True] * len(words), warned)
            self.assertEqual("in contact" in warned or "fall" in warned, bool(words), warned)
        frames[50:53] = np.nan
        np.save(self.path("a.npy"), frames + press)
        self.assertIn("In 3 of 60 frames no sensel has a reading", run(*solve).stderr)

    def test_every_command_reads_plain_data(self):
        array = self.path("idle.npy")
        np.save(array, np.random.default_rng(1).normal(20, 1, (30, 6, 8)))
        self.assertEqual(run_json("info", array)["frames"], 30)
        run("calibrate", "tare", array, "-o", self.path("tare.h5"))
        said = run("solve", array, "--rate", 50, "--calibration", self.path("tare.h5"), "-o", self.path("f.h5")).stderr
        self.assertIn("no counts_per_newton", said)
        self.assertNotIn("no threshold_counts", said)  # The calibration has one.
        self.path("scene.toml").write_text("[skin]\npillars = [3, 4]\n")
        said = run("solve", array, "--rate", 50, "--scene", self.path("scene.toml"), "-o", self.path("f.h5")).stderr
        self.assertNotIn("assumed", said)
        self.assert_fails("calibrate", "apply", self.path("tare.h5"), array, "-o", self.path("r.h5"),
                          names=["--rate"])
        run("calibrate", "apply", self.path("tare.h5"), array, "-o", self.path("r.h5"), "--rate", 50)
        self.assertAlmostEqual(run_json("info", self.path("r.h5"))["seconds"], 29 / 50)
        self.assert_fails("stream", array, "--record", self.path("s.h5"), names=["--rate"])
        run("stream", array, "--rate", 200, "--record", self.path("s.h5"), "-q")
        self.assertGreater(run_json("info", self.path("s.h5"))["frames"], 0)  # A busy computer drops some.

    def test_files_of_a_folder_are_one_source_or_one_each(self):
        folder, out = self.path("in"), self.path("out")
        folder.mkdir()
        for i, frame in enumerate(readings()):
            np.save(folder / f"{i + 7}.npy", frame)  # 10 and 11 come last, not first
        self.assert_solved(folder, "--rate", 100)
        run("solve", *folder.iterdir(), "-o", f"{out}/", "--contacts", f"{out}/", "--estimator", "direct", *CONSTANTS)
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         sorted(f"{i + 7}.{ending}" for i in range(5) for ending in ("csv", "h5")))
        with h5py.File(out / "10.h5") as file:
            np.testing.assert_array_equal(file["force/normal"], self.expected[0][3:4, ..., 2])
        self.assert_fails("solve", folder, "-o", out, "--contacts", self.path("c.csv"), names=["c.csv", "name folders"])
        self.assert_fails("solve", folder, self.recording, "-o", self.path("f.h5"), "--rate", 1,
                          names=["recording.h5", "7.npy", "-o a folder"])

    def test_two_pitches(self):
        """The load lies three columns of 5.08 mm right of the middle, and half a row of 7.62 mm up or down."""
        frames = np.zeros((10, 20, 21), "u2")
        frames[:, 9, 13] = 100
        np.save(self.path("a.npy"), frames)
        solve = ("solve", self.path("a.npy"), "--rate", 10, "--counts-per-newton", 100, "--overwrite")
        run(*solve, "--pitch-mm", "7.62x5.08", "--contacts", self.path("c.csv"), "--outputs", "pressure",
            "-o", self.path("f.h5"))
        head, total = (line.split(",") for line in self.path("c.csv").read_text().splitlines()[:2])
        total = {name: float(value) for name, value in zip(head, total) if value and name != "row"}
        self.assertAlmostEqual(total["centre_of_pressure_x_mm"], 15.24, places=4)
        self.assertAlmostEqual(total["centre_of_pressure_y_mm"], 3.81, places=4)
        self.assertAlmostEqual(total["area_mm2"], 38.7096, places=3)
        self.assertAlmostEqual(total["peak_pressure_kpa"], 25.8334, places=3)
        with h5py.File(self.path("f.h5")) as file:
            np.testing.assert_array_equal(file.attrs["sensel_pitch_mm"], [7.62, 5.08])
            self.assertAlmostEqual(file["force/pressure"][0, 9, 13], 25.8334, places=3)
        self.assertEqual(run_json("info", self.path("f.h5"))["sensel_pitch_mm"], [7.62, 5.08])
        self.assert_fails(*solve, "--pitch-mm", "7.62x5.08", "--layout", "pillars", "-o", self.path("g.h5"),
                          names=["7.62x5.08", "pillars"])
        self.assert_fails(*solve, "--pitch-mm", "7.62x", "-o", self.path("g.h5"), status=2, names=["--pitch-mm", "7.62x5.08"])

    def test_the_printed_line_of_python_reads_other_formats(self):
        frames, path = readings(), self.path("other")
        lines = frames.reshape(5, -1)

        def sqlite():
            bag = sqlite3.connect(path)
            bag.executescript("CREATE TABLE topics(id INTEGER, name TEXT, type TEXT);"
                              "CREATE TABLE messages(id INTEGER, topic_id INTEGER, timestamp INTEGER, data BLOB);")
            bag.execute("INSERT INTO topics VALUES(3, '/pad', 'std_msgs/msg/UInt16MultiArray')")
            for n, line in enumerate(lines):
                data = bytes([0, 1, 0, 0]) + struct.pack("<3I", 0, 0, 48) + line.tobytes()
                bag.execute("INSERT INTO messages VALUES(?, 3, ?, ?)", (9 - n, n, data))
            bag.commit()
            bag.close()

        def text(write, **options):
            return lambda: path.write_bytes(write(**options))

        cases = [
            (lines, text(lambda: pickle.dumps({"images": list(lines), "mass": [70.0] * 5}))),
            (lines, sqlite),
            (frames, text(lambda: json.dumps(frames.tolist()).encode())),
            (lines, text(lambda: ("<log>" + "".join(f"<f>{' '.join(map(str, x))}</f>" for x in lines) + "</log>").encode())),
        ]
        pages = [Image.fromarray(frame) for frame in frames]
        cases.append((frames, lambda: pages[0].save(path, "TIFF", save_all=True, append_images=pages[1:])))
        cases.append((frames[:1], lambda: pages[0].save(path, "PNG")))
        for expected, write in cases:
            path.unlink(missing_ok=True)
            write()
            line = self.assert_fails("solve", path, "-o", self.path("f.h5"), names=["run python3 -c"])
            command = line.split("; run ", 1)[1].replace("python3", sys.executable, 1)
            subprocess.run(command, shell=True, check=True, cwd=self.folder)
            with self.subTest(line=line):
                np.testing.assert_array_equal(np.load(self.path("other.npy")), expected)

    def run_printed_line(self, path):
        line = self.assert_fails("solve", path, "-o", self.path("f.h5"), names=["is not read", "run python3 -c"])
        subprocess.run(line[line.index("python3 -c"):].replace("python3", sys.executable, 1), shell=True, check=True,
                       cwd=self.folder, env={**os.environ, "PYTHONPATH": f"{self.folder}:{STREAMS}"})

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "needs scipy")
    def test_the_printed_line_of_python_reads_matlab_files(self):
        import scipy.io

        path, frames = self.path("hand.mat"), readings()
        cells, log = np.empty((1, 2), object), np.zeros(1, [("pad", object), ("note", object)])
        cells[0, 0], cells[0, 1], log[0] = frames, frames[:, :4], (frames[:, 2:], "a note")
        times = np.arange(5)[:, None] / 100
        for options in ({}, {"do_compression": True}):
            scipy.io.savemat(path, {"raw": frames, "time": times, "TS": cells, "log": log, "z": 1j}, **options)
            self.run_printed_line(path)
            self.assert_solved(self.path("hand.npz"), "--dataset", "raw")
            with np.load(self.path("hand.npz")) as arrays:
                self.assertEqual(set(arrays), {"raw", "time", "TS.1", "TS.2", "log.pad"})
                np.testing.assert_array_equal(arrays["TS.2"], frames[:, :4])
                np.testing.assert_array_equal(arrays["log.pad"], frames[:, 2:])
        scipy.io.savemat(path, {"raw": frames[0].astype("f8")}, format="4")
        self.run_printed_line(path)
        path.rename(self.path("hand.bin"))
        path.write_bytes(b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + b"\0\1IM")
        self.assert_fails("info", path, names=["MATLAB file before version 7.3", "save('hand.mat', '-v7.3')"])

    def test_matlab_files_of_version_7_3_are_read(self):
        with h5py.File(self.path("hand.mat"), "w", userblock_size=512) as file:
            file["raw"] = readings()
        with self.path("hand.mat").open("r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\0\2IM")
        self.assert_solved(self.path("hand.mat"), "--dataset", "raw", "--rate", 100)

    def test_the_printed_line_of_python_reads_the_mcap_of_a_stream(self):
        """By a reader of this project under the name of mcap-ros2-support."""
        (self.folder / "mcap_ros2").mkdir()
        (self.folder / "mcap_ros2" / "reader.py").write_text(
            "from types import SimpleNamespace as Object\nfrom cdr_reader import Decoder\n"
            "from mcap_reader import read_stream\n\n\ndef read_ros2_messages(path):\n"
            "    messages, channels = read_stream(open(path, 'rb').read())\n"
            "    decoders = {channel.topic: Decoder(channel.schema) for channel in channels.values()}\n"
            "    return [Object(topic=m.topic, ros_msg=Object(**decoders[m.topic].decode(m.data))) for m in messages]\n")
        run("stream", self.recording, "--to", self.path("a.mcap"), "-q")
        self.run_printed_line(self.path("a.mcap"))
        self.assert_solved(self.path("a.npz"), "--dataset", "skin.raw", "--rate", 100)
        self.path("b.mcap").write_bytes(b"cut off")
        self.assert_fails("info", self.path("b.mcap"), names=["is an MCAP file"])

    def test_small_archives_of_much_are_refused(self):
        np.savez_compressed(self.path("a.npz"), raw=np.zeros((300, 1000, 1000), "u1"))
        self.assert_fails("info", self.path("a.npz"), names=["300000128 bytes", "268435456", "numpy.savez"])

    def test_a_dash_is_no_file(self):
        for arguments in (("solve", self.recording, "-o", "-"), ("info", "-"), ("compare", "-", self.recording),
                          ("calibrate", "tare", "-", "-o", "c.h5"), ("simulate", "-", "-o", "r.h5")):
            self.assert_fails(*arguments, status=2, names=["'-' is not a file"])


if __name__ == "__main__":
    unittest.main()
