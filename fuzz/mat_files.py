"""MAT-files of version 5 for the corpus, written byte by byte ("MAT-File Format", The MathWorks)."""

import struct
import zlib


def element(order, kind, data):
    """An element of a MAT-file of version 5; up to four bytes lie within its tag."""
    if 0 < len(data) <= 4:
        return struct.pack(order + "I", len(data) << 16 | kind) + data.ljust(4, b"\0")
    return struct.pack(order + "II", kind, len(data)) + data + bytes(-len(data) % 8)


CLASSES = {"f8": 6, "f4": 7, "i1": 8, "u1": 9, "i2": 10, "u2": 11, "i4": 12, "u4": 13, "i8": 14, "u8": 15}
TYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 9, "i8": 12, "u8": 13}


def matrix(order, kind, shape, name, content, flags=0):
    head = (element(order, 6, struct.pack(order + "II", kind | flags, 0))
            + element(order, 5, struct.pack(f"{order}{len(shape)}i", *shape)) + element(order, 1, name))
    return element(order, 14, head + content)


def array(order, values, name=b"raw", flags=0, parts=1):
    """A variable of numbers, column by column; complex ones have two parts."""
    kind = values.dtype.str[1:]
    numbers = element(order, TYPES[kind], values.astype(order + kind).tobytes("F"))
    return matrix(order, CLASSES[kind], values.shape, name, parts * numbers, flags)


def compressed(order, variable):
    data = zlib.compress(variable)
    return struct.pack(order + "II", 15, len(data)) + data


def file_of(order, *variables):
    version = struct.pack(order + "HH", 0x0100, 0x4d49)
    return b"MATLAB 5.0 MAT-file, written by a test".ljust(124) + version + b"".join(variables)


def cells(order, frames):
    return matrix(order, 1, (1, 2), b"pads", array(order, frames[0], b"") + array(order, frames, b""))


def seeds(frames, real, times):
    """Valid files by name; `real` has missing readings."""
    return {
        "little.mat": file_of("<", array("<", frames.astype("u1")), array("<", times, b"time")),
        "big_compressed.mat": file_of(">", compressed(">", array(">", frames.astype("i2")))),
        "cells.mat": file_of("<", compressed("<", cells("<", real.astype("f4"))))}


def hostile(frames):
    """Damaged and misleading files by name."""
    raw = array("<", frames)
    unnamed = array("<", frames, b"")
    deep = raw
    for _ in range(5000):
        deep = matrix("<", 1, (1, 1), b"raw", deep)
    return {
        "truncated.mat": file_of("<", raw)[:-1], "truncated_compressed.mat": file_of("<", compressed("<", raw))[:-1],
        "checksum.mat": file_of("<", compressed("<", raw))[:-1] + b"x", "header_alone.mat": file_of("<"),
        "complex.mat": file_of("<", array("<", frames, flags=0x800, parts=2)),
        "sparse.mat": file_of("<", matrix("<", 5, (4, 6), b"raw", 2 * element("<", 5, bytes(32)))),
        "version_4.mat": struct.pack("<5I", 0, 2, 3, 0, 4) + b"raw\0" + bytes(48),
        "2e31_columns.mat": file_of("<", matrix("<", 9, (2**31 - 1,) * 3, b"raw", element("<", 2, bytes(72)))),
        "2e31_cells.mat": file_of("<", matrix("<", 1, (2**31 - 1, 1), b"raw", b"")),
        "claims_4_gib.mat": file_of("<", compressed("<", raw.replace(
            struct.pack("<II", 2, 72), struct.pack("<II", 2, 2**32 - 1)))),
        "longer_than_its_cell.mat": file_of("<", cells("<", frames).replace(
            struct.pack("<II", 14, len(unnamed) - 8), struct.pack("<II", 14, len(unnamed) + 400))),
        "5000_cells_in_each_other.mat": file_of("<", compressed("<", deep)),
        "two_arrays.mat": file_of("<", array("<", frames, b"a"), array("<", frames, b"b"))}
