"""Damaged archives of NumPy and chunks of HDF5 are refused, or give the numbers of the undamaged file, never others.

A seed makes a sound file of random size, type and kind, and one kind of damage. `damage_test.py --seeds N`; a failure
prints its seed, which `--first SEED` repeats.
"""

import argparse
import collections
import os
import pathlib
import random
import unittest
import zlib

import h5py
import numpy as np

import pillarfield as pf

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def flip_a_bit(data, rng):
    data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)


def overwrite(data, rng):
    at = rng.randrange(len(data))
    data[at:at + 8] = rng.randbytes(len(data[at:at + 8]))


def cut(data, rng):
    del data[rng.randrange(len(data)):]


def write_archive(rng, frames, times):
    save = rng.choice([np.savez, np.savez_compressed])
    save(WORK / "sound.npz", raw=frames, time=times)
    damage = rng.choice([flip_a_bit, overwrite, cut])
    data = bytearray((WORK / "sound.npz").read_bytes())
    damage(data, rng)
    (WORK / "damaged.npz").write_bytes(data)
    return f"{save.__name__}, {damage.__name__}"


def write_chunks(rng, frames, times):
    """A file one of whose chunks has fewer or more bytes than it states, behind the filters that it was stored with."""
    filters = rng.choice([{"shuffle": True}, {"compression": "gzip"}, {"shuffle": True, "compression": "gzip"}])
    skips = rng.random() < 0.2  # the chunk is stored without filters
    damage = rng.choice(["shorter", "longer"])
    chunk = tuple(rng.randint(2, size) for size in frames.shape)
    version = rng.choice(["earliest", "latest"])
    for name in ("sound.h5", "damaged.h5"):
        with h5py.File(WORK / name, "w", libver=version) as file:
            file.create_dataset("raw", data=frames, chunks=chunk, **filters)
            file["time"] = times
    with h5py.File(WORK / "damaged.h5", "r+") as file:
        at = tuple(rng.randrange(0, size, step) for size, step in zip(frames.shape, chunk))
        size = int(np.prod(chunk)) * frames.itemsize
        stored = rng.randbytes(max(1, rng.randrange(size)) if damage == "shorter" else size + rng.randint(1, 99))
        if "compression" in filters and not skips:
            stored = zlib.compress(stored)
        file["raw"].id.write_direct_chunk(at, stored, 2**len(filters) - 1 if skips else 0)
    return f"{'+'.join(filters)}, {damage}{', filters skipped' if skips else ''}"


def read(path):
    """Readings and times, or None if they are refused in one line."""
    try:
        recording = pf.Recording(path, dataset="raw", times="time", axes="frames,rows,columns")
        return recording[:], np.array(recording.times)
    except pf.Error as error:
        assert "\n" not in str(error), error
        return None


class Damage(unittest.TestCase):
    seeds = range(0)

    def check(self, write, sound, damaged):
        rate = collections.Counter()
        for seed in self.seeds:
            rng = random.Random(seed)
            shape = rng.randint(2, 9), rng.randint(2, 40), rng.randint(2, 40)
            numbers = np.random.default_rng(seed)
            frames = numbers.integers(0, 250, shape).astype(rng.choice(["u1", "u2", "f4"]))
            times = np.cumsum(numbers.uniform(0.01, 0.1, shape[0]))
            kind = write(rng, frames, times)
            expected, found = read(WORK / sound), read(WORK / damaged)
            np.testing.assert_array_equal(expected[0], frames)
            rate[kind, "refused" if found is None else "same"] += 1
            if found is not None:
                message = f"seed {seed}: {kind}"
                np.testing.assert_array_equal(found[0], frames, message)
                np.testing.assert_array_equal(found[1], times, message)
        for (kind, outcome), count in sorted(rate.items()):
            print(f"{damaged}: {kind}: {count} {outcome}, 0 other")
        return rate

    def test_archives(self):
        self.check(write_archive, "sound.npz", "damaged.npz")

    def test_chunks(self):
        rate = self.check(write_chunks, "sound.h5", "damaged.h5")
        self.assertFalse([kind for kind, outcome in rate if outcome == "same"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    Damage.seeds = range(arguments.first, arguments.first + arguments.seeds)
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=["damage_test.py"])
