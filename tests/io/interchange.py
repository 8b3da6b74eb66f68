"""Reads Pillarfield's files with h5py and NumPy, and h5py's files with Pillarfield.

    interchange.py WRITER_PROCESS READER_PROCESS FORMATS_MD
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

WRITER, READER, FORMATS = (pathlib.Path(name).resolve() for name in sys.argv[1:4])


def number_at(frame, place):
    """number_at() of sample_files.h."""
    with numpy.errstate(over="ignore"):
        mixed = (numpy.uint64(frame) * numpy.uint64(0x100000001B3) + place.astype("u8")
                 + numpy.uint64(0x9E3779B97F4A7C15))
        mixed = (mixed ^ (mixed >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
        return mixed ^ (mixed >> numpy.uint64(31))


def sample_forces(frame, rows, cols):
    numbers = number_at(frame, numpy.arange(4 * rows * cols)).reshape(rows, cols, 4)
    forces = (numbers[..., :3].astype("f8") * 1e-20 - 0.1).astype("f4")
    return {"shear_x": forces[..., 0], "shear_y": forces[..., 1], "normal": forces[..., 2],
            "status": (numbers[..., 3] % numpy.uint64(7)).astype("u1")}


def sample_raw(frame, rows, cols):
    numbers = number_at(frame, numpy.arange(2 * rows * cols))
    return (numbers & numpy.uint64(0xFF)).astype("u1").view("<u2").reshape(rows, cols)


def write(kind, path, rows, cols, frames):
    command = [WRITER, kind, path, str(rows), str(cols), str(frames)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def read(path):
    """The output of READER_PROCESS for a file: a list of lines, each a list of words."""
    done = subprocess.run([READER, path], capture_output=True, text=True)
    if done.returncode != 0 or done.stderr:
        raise AssertionError(done.stdout + done.stderr)
    return [line.split(" ") for line in done.stdout.splitlines()]


def values(lines, name):
    """The numbers of all lines with this name."""
    return [numpy.array(line[1:], "f8") for line in lines if line[0] == name]


class Interchange(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def test_h5py_reads_our_recordings(self):
        write("recording", self.folder / "r.h5", 5, 7, 100)
        with h5py.File(self.folder / "r.h5", "r") as file:
            self.assertEqual(file.attrs["format"].decode(), "pillarfield-recording")
            self.assertEqual(file.attrs["version"], 2)
            self.assertEqual(file["frames/raw"].dtype, numpy.dtype("<u2"))
            self.assertEqual(file["frames/raw"].shape, (100, 10, 14))
            self.assertNotIn("full_scale_counts", file["skin"].attrs)
            self.assertEqual(file["skin"].attrs["counts_per_newton"], 320)
            numpy.testing.assert_array_equal(file["frames/time"][:], numpy.arange(100) / 4)
            for frame in range(100):
                numpy.testing.assert_array_equal(file["frames/raw"][frame],
                                                 sample_raw(frame, 10, 14))
                for plane in ("shear_x", "shear_y", "normal"):
                    numpy.testing.assert_array_equal(file["truth"][plane][frame],
                                                     sample_forces(frame, 5, 7)[plane])

    def test_h5py_reads_our_forces(self):
        write("forces", self.folder / "f.h5", 5, 7, 40)
        with h5py.File(self.folder / "f.h5", "r") as file:
            self.assertEqual(file.attrs["format"].decode(), "pillarfield-forces")
            self.assertEqual(file.attrs["unit"].decode(), "N")
            self.assertEqual(file.attrs["pillar_pitch_mm"], 1.25)
            for name in ("sign_convention", "estimator", "device", "source", "program_version"):
                self.assertTrue(file.attrs[name].decode())
            numpy.testing.assert_array_equal(file["force/time"][:], numpy.arange(40) / 4)
            for frame in range(40):
                for plane, expected in sample_forces(frame, 5, 7).items():
                    numpy.testing.assert_array_equal(file["force"][plane][frame], expected)

    def new_recording(self, raw, **options):
        """Writes a recording with h5py and returns the output of READER_PROCESS."""
        path = self.folder / "h5py.h5"
        with h5py.File(path, "w", **options.pop("file", {})) as file:
            file.attrs["format"] = options.pop("format", "pillarfield-recording")
            file.attrs["version"] = options.pop("version", 1)
            file.create_dataset("frames/raw", data=raw, **options.pop("layout", {}))
            file["frames/time"] = numpy.arange(len(raw), dtype=options.pop("time", "f8")) / 8
            skin = file.create_group("skin")
            for name, value in options.pop("skin", {}).items():
                skin.attrs[name] = value
            for name, value in options.items():
                file[name.replace("__", "/")] = value
        return read(path)

    def expect_frames(self, lines, raw):
        self.assertEqual(lines[0][:3] + lines[0][4:],
                         ["recording", str(raw.shape[1]), str(raw.shape[2]), str(len(raw))])
        numpy.testing.assert_array_equal(values(lines, "raw"), raw.reshape(len(raw), -1))
        numpy.testing.assert_array_equal(values(lines, "time"), numpy.arange(len(raw))[:, None] / 8)

    def test_we_read_every_layout_of_h5py(self):
        raw = numpy.random.default_rng(2).integers(0, 256, (20, 6, 9))
        layouts = [{}, {"chunks": (1, 6, 9)}, {"chunks": (7, 4, 5), "compression": "gzip"},
                   {"maxshape": (None, 6, 9), "shuffle": True, "compression": "gzip"},
                   {"chunks": (3, 6, 9), "fletcher32": True}]
        files = [{}, {"libver": "latest"}, {"userblock_size": 1024}, {"libver": ("v108", "v110")}]
        for dtype in ("u1", "<u2", ">u2", "<f4", ">f4"):
            for layout in layouts:
                for file in files:
                    with self.subTest(dtype=dtype, layout=layout, file=file):
                        typed = raw.astype(dtype)
                        lines = self.new_recording(typed, layout=layout, file=file)
                        self.expect_frames(lines, typed)
                        self.assertEqual(lines[0][3], typed.dtype.newbyteorder("=").name)

    def test_a_chunk_that_does_not_fit_its_checksum_is_refused(self):
        self.new_recording(numpy.ones((4, 6, 9), "u1"), layout={"chunks": (4, 6, 9), "fletcher32": True})
        with h5py.File(self.folder / "h5py.h5", "r") as file:
            place = file["frames/raw"].id.get_chunk_info(0).byte_offset
        with open(self.folder / "h5py.h5", "r+b") as file:
            file.seek(place)
            file.write(b"\7")
        with self.assertRaisesRegex(AssertionError, "frame 0 of /frames/raw cannot be read.*damaged"):
            read(self.folder / "h5py.h5")

    def test_we_name_a_compression_that_we_lack(self):
        with self.assertRaisesRegex(AssertionError, "'lzf'.* which HDF5 lacks here; store it with"):
            self.new_recording(numpy.zeros((1, 20, 20), "u1"), layout={"compression": "lzf"})

    def test_we_read_every_kind_of_string(self):
        raw = numpy.zeros((1, 2, 2), "u1")
        name = "pillarfield-recording"
        for text in (name, numpy.bytes_(name), numpy.array([name.encode()]),
                     numpy.array(name, h5py.string_dtype("ascii")),
                     numpy.array(name.encode(), h5py.string_dtype("utf-8", 64))):
            with self.subTest(text=repr(text)):
                self.expect_frames(self.new_recording(raw, format=text), raw)

    def test_we_read_every_kind_of_number(self):
        raw = numpy.zeros((1, 2, 2), "u1")
        for kind in (int, float, numpy.uint8, numpy.float32, numpy.dtype(">f8").type,
                     lambda value: numpy.array([value], ">i2")):
            skin = {"sensel_pitch_mm": kind(2), "counts_per_newton": kind(100),
                    "threshold_counts": kind(3), "full_scale_counts": kind(200)}
            lines = self.new_recording(raw, version=kind(1), skin=skin, time="f4")
            numpy.testing.assert_array_equal(values(lines, "skin")[0], [2, 100, 3, 200])

    def test_we_read_planes_of_every_type(self):
        raw = numpy.zeros((2, 4, 4), "u1")
        mask = numpy.arange(16).reshape(4, 4) % 3 != 0
        for dtype in ("u1", "i4", "f8", ">f4", "bool"):
            with self.subTest(dtype=dtype):
                lines = self.new_recording(
                    raw, calibration__mask=mask.astype(dtype),
                    calibration__tare=numpy.arange(16, dtype="i2").reshape(4, 4),
                    truth__shear_x=numpy.full((2, 2, 2), 0.5, "f8"),
                    truth__shear_y=numpy.full((2, 2, 2), -1, ">f4"),
                    truth__normal=numpy.full((2, 2, 2), 2, "f4"))
                numpy.testing.assert_array_equal(values(lines, "mask")[0], mask.ravel())
                numpy.testing.assert_array_equal(values(lines, "tare")[0], numpy.arange(16))
                numpy.testing.assert_array_equal(values(lines, "shear_x"), numpy.full((2, 4), 0.5))
                numpy.testing.assert_array_equal(values(lines, "shear_y"), numpy.full((2, 4), -1))

    def test_the_example_of_the_documentation_works(self):
        code = re.search(r"```python\n(.*?)```", FORMATS.read_text(), re.S).group(1)
        subprocess.run([sys.executable, "-c", code], check=True, cwd=self.folder)
        lines = read(self.folder / "recording.h5")
        self.assertEqual(lines[0], ["recording", "8", "6", "uint8", "5"])
        self.assertNotIn("warning", [line[0] for line in lines])
        with h5py.File(self.folder / "recording.h5", "r") as file:
            numpy.testing.assert_array_equal(values(lines, "raw"), file["frames/raw"][:].reshape(5, -1))

    def test_the_copy_of_the_documentation_closes_a_part(self):
        with subprocess.Popen([WRITER, "recording", self.folder / "r.h5", "3", "3", "1000000000"],
                              stdout=subprocess.PIPE) as writer:
            for _ in range(20):
                writer.stdout.readline()
            writer.kill()
        command = re.search(r'python3 -c "(.*)"\n', FORMATS.read_text()).group(1)
        subprocess.run([sys.executable, "-c", command], check=True, cwd=self.folder)
        part, copy = (read(self.folder / name) for name in ("r.h5.part", "r.h5"))
        self.assertEqual([line for line in part if line[0] != "warning"],
                         [line for line in copy if line[0] != "warning"])
        self.assertNotIn("not closed", str(copy))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
