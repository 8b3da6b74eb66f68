#!/usr/bin/env python3
"""Makes the seed_* and hostile_* files of fuzz/corpus.

    fuzz/make_corpus.py --program build/release/bin/pillarfield [--folder fuzz/corpus]

seed_* are small valid files of every kind, in all HDF5 formats; hostile_* are designed to mislead a
reader. Files damaged by a fuzzer do not change. fuzz/mutants.py makes its seeds with these functions.
"""

import argparse
import io
import pathlib
import struct
import subprocess
import tempfile
import zipfile
import zlib

import h5py
import numpy

import mat_files

KINDS = ("recording", "forces", "calibration", "tekscan", "scene", "plain")

SCENE = """\
title = "A ball that slides"

[skin]
pillars = [6, 8]
threshold_counts = 2

[sensor]
adc_bits = 8
noise_counts = 0.5
tare_counts = 3

[time]
rate_hz = 100
frames = 5

[[contact]]
shape = "sphere"
motion = "slide"
contact_radius_mm = 2
friction = 0.5
direction_deg = 30
path = [
  { time_s = 0, position_mm = [-1, 0], load_n = 1 },
  { time_s = 0.04, position_mm = [1, 0.5], load_n = 4 },
]
"""

# Every shape, motion and section.
SCENE_OF_ALL = """\
title = "Everything"
[skin]
size_mm = [16.5, 12.8]
sensel_pitch_mm = 0.632455532
counts_per_newton = 320
threshold_counts = 2.5
[sensor]
adc_bits = 12
dead_zone_counts = 1
gain_spread = 0.05
tare_counts = 20
tare_spread_counts = 2
noise_counts = 1.5
drift_counts_per_s = 0.1
dead_share = 0.01
[time]
rate_hz = 200
frames = 3
seed = 7
[solver]
estimator = "contact"
friction_bound = 4
friction_prior = [0.8, 0.4]
memory = false
segment_point = 0.5
angles = true
parity_tolerance_counts = 8
[[contact]]
shape = "flat_punch"
motion = "spin"
contact_radius_mm = 2
friction = 0.4
clockwise = true
position_mm = [-4, 0]
load_n = 3
[[contact]]
shape = "sphere"
motion = "partial_slip"
contact_radius_mm = 1.5
reference_load_n = 2
friction = 0.6
tangential_ratio = 0.5
direction_deg = 200
position_mm = [3, 2]
load_n = 2
[[contact]]
shape = "cylinder"
motion = "roll"
contact_radius_mm = 1
length_mm = 4
friction = 0.3
tangential_ratio = 0.7
direction_deg = 90
position_mm = [3, -3]
load_n = 2
"""

SCENE_CHART = """\
[chart]
directions = 12
inclinations = 5
max_theta_deg = 60
magnitudes_n = [0.1, 0.5]
[skin]
counts_per_newton = 100
"""

SCENE_OF_A_BODY = """title = "A rough ball that is dragged"

[skin]
pillars = [8, 8]
modulus_kpa = 300

[time]
rate_hz = 10
frames = 3

[[indenter]]
shape = "sphere"
radius_mm = 9
roughness_um = 30
roughness_exponent = 0.7
friction = 0.8
friction_variation = 0.2
path = [
  { time_s = 0, position_mm = [-0.5, 0], load_n = 1 },
  { time_s = 0.2, position_mm = [0.5, 0.2], angle_deg = 10, load_n = 2 },
]
"""

SCENE_OF_A_SENSOR = """title = "A real sensor"
[skin]
sensel_pitch_mm = 0.5
[direction_sweep]
directions = 4
inclinations = 2
path = [{ time_s = 0, factor = 0.5 }, { time_s = 1, factor = 2 }]
[sensor]
pillar_leak_edge = 0.01
pillar_leak_corner = -0.003
pillar_arm_mm = 0.5
shear_coefficient = [0.9, 1.1]
leak_inside = 0.05
leak_across = 0.02
hysteresis = 0.05
hysteresis_range_counts = 150
creep_per_decade = 0.05
response_curve = [[19, 15], [75, 70]]
wires = { tile = [4, 2], row_ohm = 40, column_ohm = 30, idle_row_ohm = 20, sensel_ohm = 10000 }
[surface]
bend_spread_counts_mm = 80
path = [{ time_s = 0, curvature_per_mm = [0.01, 0, -0.02] }]
"""
SCENES = {"sliding": SCENE, "all": SCENE_OF_ALL, "chart": SCENE_CHART, "body": SCENE_OF_A_BODY,
          "sensor": SCENE_OF_A_SENSOR,
          "empty": "[skin]\npillars = [1, 1]\n",
          "control": 'title = "\\u001b[2J\\n"\n[skin]\npillars = [2, 2]\n'}

TEKSCAN_HEADER = ["DATA_TYPE MOVIE", "VERSION Measurement 1.0", "ROWS {rows}", "COLS {cols}",
                  "ROW_SPACING 0.5 mm", "COL_SPACING 0.02 inches", "NOISE_THRESHOLD 3",
                  "SECONDS_PER_FRAME 0.5", "START_FRAME 1", "END_FRAME {frames}", "UNITS raw"]


def tekscan(frames, line_end="\n", header=True, times=False, sums=False, trailing="", units="raw"):
    """An export of these frames; a reading below zero marks an absent sensel."""
    lines = []
    if header:
        lines = [line.format(rows=len(frames[0]), cols=len(frames[0][0]), frames=len(frames))
                 for line in TEKSCAN_HEADER]
        lines[-1] = f"UNITS {units}"
        if units != "raw":
            lines[2:2] = ["SENSEL_AREA 0.00254 cm2"] + ["NOTE a long header"] * 20
    else:
        lines = [f"ROWS {len(frames[0])}", f"COLS {len(frames[0][0])}"]
    lines.append("ASCII_DATA @@")
    for number, frame in enumerate(frames, 1):
        total = int(frame[frame > 0].sum())
        time = f", {number / 8}" if times else ""
        raw_sum = f", Raw Sum=,,{total}" if sums else ""
        lines += ["", f"Frame {number}{time}{raw_sum}"]
        lines += [",".join("B" if cell < 0 else str(cell) for cell in row) + trailing
                  for row in frame]
    return line_end.join(lines + ["@@", ""])


def tekscan_exports():
    random = numpy.random.default_rng(5)
    bytes_ = random.integers(0, 256, (3, 4, 6)) * (random.random((3, 4, 6)) < 0.6)
    words = random.integers(0, 65536, (2, 5, 3))
    masked = bytes_.copy()
    masked[:, 0, 0] = -1
    masked[:, 3, 5] = -1
    return {"bytes": tekscan(bytes_), "words": tekscan(words, times=True),
            "crlf": tekscan(masked, "\r\n", times=True, sums=True, trailing=",,"),
            "bare": tekscan(bytes_, header=False),
            "kpa": tekscan(numpy.where(masked < 0, -1, masked / 8)[:, :, :5], units="kPa")}


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)


def copy_attributes(source, copy, variable):
    for name, value in source.attrs.items():
        text = value.decode() if isinstance(value, bytes) else value
        copy.attrs[name] = text if variable else value


def extendible(item):
    """The layout of a dataset that is extendible along its first axis, as in our files."""
    return {"maxshape": (None, *item.shape[1:]), "chunks": (2, *item.shape[1:])}


def convert(source, target, variable=False, layout=None, swmr=False, version=None, **file_options):
    """Copies a file object by object: with strings of variable length if `variable`, datasets of frames
    in the h5py `layout`, and the file version of `file_options`. With `swmr`, `target` is left as by a
    writer that was killed after a flush.
    `version` is the format's, by default that of `source`."""
    unfinished = target.with_name("unfinished.h5") if swmr else target
    with h5py.File(source, "r") as old, h5py.File(unfinished, "w", **file_options) as new:
        copy_attributes(old, new, variable)
        if version:
            new.attrs["version"] = version

        def visit(name, item):
            if isinstance(item, h5py.Group):
                copy_attributes(item, new.require_group(name), variable)
                return
            options = {}
            if item.ndim > 0 and item.size > 0:
                options = extendible(item) if layout == "extendible" else layout if item.ndim > 1 else {}
            made = new.create_dataset(name, data=item[()], **(options or {}))
            copy_attributes(item, made, variable)

        old.visititems(visit)
        if swmr:
            new.swmr_mode = True
            new.flush()
            target.write_bytes(unfinished.read_bytes())
    if swmr:
        unfinished.unlink()


# Variants of an HDF5 file: old and new format, compressed, checksummed, with strings of variable length.
VARIANTS = {
    "old": {"version": 1},
    "old_gzip_variable": {"variable": True, "layout": {"compression": "gzip", "shuffle": True}},
    "latest": {"libver": "latest"},
    "latest_gzip": {"libver": "latest", "layout": {"compression": "gzip", "fletcher32": True}},
    "latest_variable": {"libver": "latest", "variable": True},
    "extendible": {"libver": "latest", "layout": "extendible"},
}


def write_variants(ours, folder):
    """All variants of one of our files, which are far smaller than it: its chunks have 256 KiB."""
    for name, options in VARIANTS.items():
        convert(ours, folder / f"seed_{name}_{ours.stem}.h5", **options)


def write_plain_recording(path, dtype, **file_options):
    """A recording as a user writes it with h5py, without most optional objects."""
    raw = numpy.random.default_rng(3).uniform(0, 250, (4, 7, 9)).astype(dtype)
    if raw.dtype.kind == "f":
        raw[0, 0, :3] = numpy.nan, numpy.inf, -1
    with h5py.File(path, "w", **file_options) as file:
        file.attrs["format"] = "pillarfield-recording"
        file.attrs["version"] = 1
        file["frames/raw"] = raw
        file["frames/time"] = numpy.arange(4) / 100


def link_elsewhere(file):
    del file["frames"]
    file["frames"] = h5py.ExternalLink("other.h5", "/frames")


def link_in_a_circle(file):
    del file["frames/raw"]
    file["frames/raw"] = h5py.SoftLink("/frames/raw")


def store_elsewhere(file):
    del file["frames/raw"]
    space = h5py.h5s.create_simple((4, 7, 9))
    options = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    options.set_external(b"/etc/passwd", 0, 4 * 7 * 9)
    h5py.h5d.create(file["frames"].id, b"raw", h5py.h5t.STD_U8LE, space, options)


def map_elsewhere(file):
    del file["frames/raw"]
    layout = h5py.VirtualLayout((4, 7, 9), "u1")
    layout[:] = h5py.VirtualSource("other.h5", "frames/raw", (4, 7, 9))
    file["frames"].create_virtual_dataset("raw", layout)


def claim_frames(count, chunk):
    """Frames without any stored chunk."""
    def change(file):
        del file["frames/raw"]
        del file["frames/time"]
        file.create_dataset("frames/raw", (count, 7, 9), "u1", chunks=(chunk, 7, 9))
        file.create_dataset("frames/time", (count,), "f8", chunks=(chunk,), compression="gzip")
    return change


def give_plane(name, value):
    def change(file):
        file[f"calibration/{name}"] = numpy.full((7, 9), value)
    return change


def give_raw(dtype):
    def change(file):
        del file["frames/raw"]
        file["frames/raw"] = numpy.zeros((4, 7, 9), dtype)
    return change


def give_attribute(name, value):
    def change(file):
        file["skin"].attrs[name] = value
    return change


HOSTILE_RECORDINGS = {
    "external_link": link_elsewhere, "soft_link_loop": link_in_a_circle,
    "external_storage": store_elsewhere, "virtual_dataset": map_elsewhere,
    "2e40_frames": claim_frames(2**40, 64), "huge_chunk": claim_frames(2**24, 2**24),
    "tare_1e30": give_plane("tare", -1e30), "mask_nan": give_plane("mask", numpy.nan),
    "gain_nan": give_plane("gain", numpy.nan), "noise_negative": give_plane("noise", -1.0),
    "raw_compound": give_raw([("a", "u1"), ("b", "<f4")]), "raw_string": give_raw("S3"),
    "raw_float16": give_raw("f2"), "raw_long_double": give_raw("longdouble"),
    "raw_complex": give_raw("c8"), "raw_array_type": give_raw(numpy.dtype(("u1", (2,)))),
    "pitch_nan": give_attribute("sensel_pitch_mm", numpy.nan),
    "pitch_of_100": give_attribute("sensel_pitch_mm", numpy.ones(100)),
    "pitch_string": give_attribute("sensel_pitch_mm", "wide\x1b[2J\n"),
    "counts_subnormal": give_attribute("counts_per_newton", 5e-324),
}


def npy(array, version=None):
    data = io.BytesIO()
    numpy.lib.format.write_array(data, numpy.asarray(array), version=version)
    return data.getvalue()


def npz(compress=True, **arrays):
    data = io.BytesIO()
    (numpy.savez_compressed if compress else numpy.savez)(data, **arrays)
    return data.getvalue()


def table(array, separator=","):
    return "\n".join(separator.join(f"{value:g}" for value in line) for line in array).encode() + b"\n"


def plain_frames():
    """Three frames of 4 x 6 readings."""
    random = numpy.random.default_rng(7)
    return random.integers(0, 256, (3, 4, 6)) * (random.random((3, 4, 6)) < 0.7)


def plain_files():
    frames = plain_frames()
    real = numpy.where(frames == 0, numpy.nan, frames / 3)
    lines = frames.reshape(3, -1)
    times = numpy.arange(3)[:, None] / 100
    return {
        "uint8.npy": npy(frames.astype("u1")), "big_endian.npy": npy(frames.astype(">i4"), (2, 0)),
        "float64.npy": npy(real, (3, 0)), "lines.npy": npy(lines.astype("i2")),
        "stored.npz": npz(False, raw=frames.astype("u2"), time=times[:, 0]),
        "deflated.npz": npz(raw=frames.astype(">f4"), rate=numpy.array(100.0), name="text"),
        "frames.csv": b"\n".join(table(frame) for frame in frames),
        "lines.csv": b"time;" + b"s;" * 24 + b"\n" + table(numpy.hstack([times, lines]), ";"),
        "pandas.csv": pandas_table(lines),
        **mat_files.seeds(frames, real, times),
        "blanks.txt": b"# saved by numpy\n" + table(real[0], " ")}


def pandas_table(lines):
    """A table of frames in lines, as DataFrame.to_csv() writes one with a DatetimeIndex."""
    header = "," + ",".join(str(column) for column in range(lines.shape[1]))
    rows = [f"2024-05-01 12:00:00.{2 * n:03}000," + ",".join(map(str, line)) for n, line in enumerate(lines)]
    return "\n".join([header, *rows, ""]).encode()


def claim(data, old, new):
    """Replaces a part of a file by one of equal length."""
    assert data.count(old) >= 1 and len(old) == len(new), (old, new)
    return data.replace(old, new)


def zip_bomb(claimed=None):
    """An archive of 64 MiB of zeros, which claims another size if one is given."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        header = npy(numpy.zeros((2**20, 8, 8), "u1"))[:128]
        archive.writestr("raw.npy", header + bytes(2**26))
    data = data.getvalue()
    size = struct.pack("<I", 2**26 + 128)
    return data if claimed is None else claim(data, size, struct.pack("<I", claimed))


def hostile_plain_files():
    frames = plain_frames().astype("u1")
    good, archive = npy(frames), npz(raw=frames)
    line = b"1,2,3,4,5,6\n"
    return {
        "truncated.npy": good[:-1], "header_cut.npy": good[:60],
        "2e60_frames.npy": claim(good, b"(3, 4, 6), }" + b" " * 20, b"(1152921504606846976, 4, 6), }  "),
        "overflow.npy": claim(good, b"(3, 4, 6), }" + b" " * 20, b"(4294967296, 4294967296, 6), }  "),
        "bool.npy": npy(frames > 9), "complex.npy": npy(frames * 1j), "float16.npy": npy(frames.astype("f2")),
        "objects.npy": npy(numpy.array([1, "a"], object)), "records.npy": npy(numpy.zeros((1, 4, 6), "u1,f4")),
        "fortran.npy": npy(numpy.asfortranarray(frames)), "scalar.npy": npy(numpy.float64(3)),
        "version_9.npy": claim(good, b"NUMPY\x01", b"NUMPY\x09"), "one_row.npy": npy(frames[:, :1]),
        "beyond_float32.npy": npy(frames.astype("i8") + 2**40),
        "truncated.npz": archive[:-30], "checksum.npz": claim(archive, archive[60:64], b"\0\0\0\0"),
        "no_array.npz": npz(name="text"), "two_arrays.npz": npz(a=frames, b=frames),
        "too_many_times.npz": npz(raw=frames, time=numpy.arange(9)),
        "times_fall.npz": npz(raw=frames, time=-numpy.arange(3)),
        "bomb_claims_1_byte.npz": zip_bomb(1), "bomb_claims_3_gib.npz": zip_bomb(3 << 30),
        **mat_files.hostile(frames),
        "iso_time_of_month_13.csv": pandas_table(frames.reshape(3, -1)).replace(b"-05-01 12:00:00.004", b"-13-01 12:00:00.004"),
        "ragged.csv": 3 * line + b"1,2,3,4,5\n", "uneven_frames.csv": 3 * line + b"\n" + 2 * line,
        "decimal_commas.csv": b"1,5;2,5\n1,5;2,5\n", "words.csv": line + b"1,2,3,four,5,6\n",
        "one_column.csv": b"1 2\n1\n"}


def write_hostile(folder):
    for old in (folder / "plain").glob("hostile_*"):
        old.unlink()
    for name, data in hostile_plain_files().items():
        (folder / "plain" / f"hostile_{name}").write_bytes(data)
    for old in (folder / "recording").glob("hostile_*"):
        old.unlink()
    for name, change in HOSTILE_RECORDINGS.items():
        path = folder / "recording" / f"hostile_{name}.h5"
        write_plain_recording(path, "u1", libver="latest")
        with h5py.File(path, "a", libver="latest") as file:
            file.require_group("skin")
            change(file)
    for old in (folder / "scene").glob("hostile_*"):
        old.unlink()
    for name, text in HOSTILE_SCENES.items():
        (folder / "scene" / f"hostile_{name}.toml").write_bytes(text)


HOSTILE_SCENES = {
    "dotted_key_50000": b"a." * 50000 + b"a=1\n",
    "nested_arrays": b"a=" + b"[" * 5000 + b"]" * 5000 + b"\n",
    "not_utf8": b'title = "\xff\xfe"\n[skin]\npillars = [2, 2]\n',
    "nul": b"title = \"\x00\"\n[skin]\npillars = [2, 2]\n",
    "huge_skin": b"[skin]\npillars = [32767, 32767]\n",
    "nan": b"[skin]\npillars = [2, 2]\nthreshold_counts = nan\n",
}


def write_seeds(folder, program):
    """Writes all seeds to the folders `folder`/KIND."""
    for kind in KINDS:
        (folder / kind).mkdir(parents=True, exist_ok=True)
        for old in (folder / kind).glob("seed_*"):
            old.unlink()
    for name, text in SCENES.items():
        (folder / "scene" / f"seed_{name}.toml").write_text(text)
    for name, text in tekscan_exports().items():
        (folder / "tekscan" / f"seed_{name}.csv").write_bytes(text.encode())
    for name, data in plain_files().items():
        (folder / "plain" / f"seed_{name}").write_bytes(data)
    with h5py.File(folder / "plain" / "seed_dataset.h5", "w") as file:
        file["raw"] = plain_frames().astype("i4")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        scene = folder / "scene" / "seed_sliding.toml"
        recording = scratch / "slide.h5"
        run(program, "simulate", scene, "-o", recording)
        write_variants(recording, folder / "recording")
        convert(recording, folder / "recording" / "seed_killed_slide.h5", layout="extendible", swmr=True,
                libver="latest")
        for dtype in ("u1", ">u2", "<f4"):
            name = numpy.dtype(dtype).name
            write_plain_recording(folder / "recording" / f"seed_plain_{name}.h5", dtype)
        write_calibration(program, scratch)
        write_variants(scratch / "tare.h5", folder / "calibration")
        run(program, "solve", recording, "-o", scratch / "contacts.h5", "--contacts",
            scratch / "contacts.h5")
        write_variants(scratch / "contacts.h5", folder / "forces")
        run(program, "solve", recording, "-o", scratch / "uncertainty.h5", "--outputs",
            "angles,uncertainty", "--noise", "1")
        convert(scratch / "uncertainty.h5", folder / "forces" / "seed_old_uncertainty.h5")


def write_parts(folder, program):
    """Parts of two."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in [*folder.glob("seed_*"), *folder.glob("hostile_*")]:
        old.unlink()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        (scratch / "scene.toml").write_text(SCENE)
        recording, output = scratch / "slide.h5", scratch / "out.h5"
        run(program, "simulate", scratch / "scene.toml", "-o", recording)
        plans = {"contacts": ("--contacts", output, "--checkpoint-every", 2),
                 "uncertainty": ("--outputs", "angles,uncertainty", "--noise", 1)}
        for name, plan in plans.items():
            for part in (1, 2):
                run(program, "solve", recording, "-o", output, "--part", f"{part}/2", *plan)
                convert(scratch / f"out.h5.parts/{part:05}.h5", folder / f"seed_part{part}_{name}.h5",
                        libver="latest")
        for name, (seed, change) in HOSTILE_PARTS.items():
            path = folder / f"hostile_{name}.h5"
            path.write_bytes((folder / f"seed_{seed}.h5").read_bytes())
            with h5py.File(path, "r+") as file:
                change(file)


def give_part(**members):
    return lambda file: file["part"].attrs.update({name: value if isinstance(value, str) else float(value)
                                                  for name, value in members.items()})


def longer_table(file):
    """Contacts of a frame that the part does not have."""
    for name, column in list(file["contacts/patch"].items()):
        values = column[()]
        del file["contacts/patch"][name]
        file["contacts/patch"][name] = numpy.append(values, values[-1:])


HOSTILE_PARTS = {
    "part_of_2e45_frames": ("part2_contacts", give_part(frames=2**45 + 3, checkpoint_every=2**45)),
    "part_of_99999": ("part1_uncertainty", give_part(count=99999, frames=99999 * 2)),
    "part_nan": ("part1_contacts", give_part(frames=numpy.nan)),
    "part_0_of_0": ("part1_contacts", give_part(index=0, count=0)),
    "part_longer_table": ("part1_contacts", longer_table),
}


def write_calibration(program, scratch):
    """A calibration of the scene's skin in two steps, scratch/tare.h5."""
    unloaded = SCENE.split("[[contact]]")[0].replace("frames = 5", "frames = 40")
    (scratch / "unloaded.toml").write_text(unloaded)
    run(program, "simulate", scratch / "unloaded.toml", "-o", scratch / "unloaded.h5")
    run(program, "calibrate", "tare", scratch / "unloaded.h5", "-o", scratch / "first.h5")
    run(program, "calibrate", "tare", scratch / "unloaded.h5", "--calibration", scratch / "first.h5",
        "-o", scratch / "tare.h5")


def packet(readings, content=0, shape=(5, 7), kind=1, sequence=0, part=0, parts=1, first=0, count=0, checked=False,
           **members):
    """A packet of stream_format.h. `members` gives others than the right ones: rows, cols, bytes."""
    length = members.get("bytes", len(readings) + 4 * checked)
    head = struct.pack("<4sHHIIQQQ6I", b"PFR1", content | checked << 8, kind, members.get("rows", shape[0]),
                       members.get("cols", shape[1]), 1, sequence, 10**6 * (sequence + 1), part, parts, first, count,
                       0, length)
    return head + readings + (struct.pack("<I", zlib.crc32(head + readings)) if checked else b"")


def flexitac(frames):
    """Frames of 5 x 7 readings as a FlexiTac board sends them."""
    return b"".join(b"\xaa\x55" + frame for frame in frames)


def packets():
    """Streams of packets by name."""
    frame = bytes(range(35))
    rows = [packet(bytes(28), 1, kind=3, sequence=n, part=part, parts=5, first=part, count=1)
            for n in range(3) for part in (0, 2, 1, 4, 3)]
    marked = b"\0\xaa\x55".ljust(35)
    return {
        "seed_frames": b"".join(packet(frame, sequence=n) for n in range(4)),
        "seed_rows": b"".join(rows),
        "seed_late_rows": b"".join(rows[5:9] + rows[10:] + rows[9:11]),
        "seed_checked": b"".join([packet(frame, sequence=n, checked=True) for n in range(3)]
                                 + [packet(b"", 3, sequence=3)]),
        "seed_flexitac": flexitac([frame] * 10 + [marked] * 12 + [frame] * 2),
        "hostile_flexitac_loss": flexitac([frame] * 12 + [marked] * 3)[:-80] + flexitac([marked] * 12 + [frame] * 4),
        "hostile_flexitac_marks": b"\xaa\x55" * 400,
        "hostile_huge": packet(frame, rows=65534, cols=65534, bytes=65534**2 % 2**32),
        "hostile_claims_bytes": packet(frame, rows=4096, cols=4096, bytes=2**24),
        "hostile_no_parts": packet(frame, parts=0) + packet(frame),
        "hostile_row_beyond": packet(frame) + packet(bytes(7), 1, first=2**32 - 1, count=1),
        "hostile_checksum": packet(frame) + packet(frame, sequence=1, checked=True)[:-1] + b"x",
        "hostile_cut_short": packet(frame)[:80] + packet(frame, sequence=1),
        "hostile_magic": b"PFR1" * 100 + packet(frame),
    }


def write_packets(folder):
    (folder / "packets").mkdir(parents=True, exist_ok=True)
    for name, text in packets().items():
        (folder / "packets" / f"{name}.pfr").write_bytes(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--folder", type=pathlib.Path,
                        default=pathlib.Path(__file__).parent / "corpus")
    options = parser.parse_args()
    write_seeds(options.folder, options.program)
    write_hostile(options.folder)
    write_packets(options.folder)
    write_parts(options.folder / "parts", options.program)


if __name__ == "__main__":
    main()
