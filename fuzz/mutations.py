"""Mutates files: a few random changes to bytes, integers, blocks, or words of text."""

import re

import hdf5_checksums

EDGES = [0, 1, 2, 3, 7, 8, 15, 16, 31, 32, 63, 64, 127, 128, 255, 256, 1023, 4096, 32767, 32768, 65534,
         65535, 65536, 2**24, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**40, 2**62, 2**63 - 1, 2**63,
         2**64 - 1]

WORDS = [b"nan", b"inf", b"-inf", b"1e999", b"-1", b"-0.0", b"1e-320", b"0", b"9223372036854775807",
         b"9223372036854775808", b"18446744073709551615", b"4294967296", b"65535", b"65536", b"1e300",
         b"0x10", b"true", b"[]", b"{}", b"[[", b"]]", b'"', b"'''", b'"""', b"#", b".", b",", b"a.b.c",
         b"\xff\xfe", b"\x1b[2J", b"\x00", b"\r", b"\n", b"@@", b"B", b"Frame 1", b"\xe2\x80\xae", b"="]


class Seed:
    """A valid file, with the positions of its checksums if it is HDF5."""

    def __init__(self, kind, name, data):
        self.kind, self.name, self.data = kind, name, data
        self.is_text = kind in ("scene", "tekscan")
        self.blocks = [] if self.is_text else hdf5_checksums.find_blocks(data)
        self.not_zero = [at for at, byte in enumerate(data) if byte]


def place_in(random, data, seed):
    """A position to change: with probability 1/2 one at which the seed is not zero."""
    if random.random() < 0.5:
        return min(random.choice(seed.not_zero), len(data) - 1)
    return random.randrange(len(data))


def flip_bits(random, data, seed):
    for _ in range(random.choice((1, 1, 2, 4, 8))):
        data[place_in(random, data, seed)] ^= 1 << random.randrange(8)


def set_bytes(random, data, seed):
    at = place_in(random, data, seed)
    for i in range(at, min(at + random.choice((1, 1, 2, 4, 8)), len(data))):
        data[i] = random.choice((0, 1, 0x7F, 0x80, 0xFF, random.randrange(256)))


def set_integer(random, data, seed):
    width = random.choice((1, 2, 4, 8))
    at = place_in(random, data, seed)
    old = int.from_bytes(data[at:at + width], "little")
    new = random.choice((random.choice(EDGES), old + 1, old - 1, 2 * old, old // 2,
                         random.getrandbits(8 * width)))
    written = (new % (1 << 8 * width)).to_bytes(width, "little")
    data[at:at + width] = written[:len(data) - at]


def copy_block(random, data, seed):
    size = random.choice((2, 4, 8, 16, 64, 256))
    source, at = place_in(random, data, seed), place_in(random, data, seed)
    block = data[source:source + size]
    data[at:at + len(block)] = block[:len(data) - at]


def truncate(random, data, seed):
    del data[random.randrange(1, len(data) + 1):]


def insert(random, data, seed):
    at = place_in(random, data, seed)
    source = place_in(random, data, seed)
    data[at:at] = random.choice((random.randbytes(random.randrange(1, 16)),
                                 data[source:source + random.randrange(1, 200)]))


def delete(random, data, seed):
    at = place_in(random, data, seed)
    del data[at:at + random.choice((1, 2, 8, 64))]
    if not data:
        data += b"\0"


def change_word(random, data, seed):
    """Replaces a number or a name by another word, or joins the word to it."""
    found = list(re.finditer(rb"[-+.\w]+", data))
    if not found:
        return
    word = random.choice(found)
    new = random.choice(WORDS + [random.choice(found)[0]])
    data[word.start():word.start() if random.random() < 0.2 else word.end()] = new


def change_line(random, data, seed):
    """Removes, repeats or moves a line; sometimes repeats it often."""
    lines = bytes(data).split(b"\n")
    at = random.randrange(len(lines))
    line = lines[at]
    how = random.randrange(4)
    if how < 2:
        del lines[at]
    if how == 1:
        lines.insert(random.randrange(len(lines) + 1), line)
    elif how == 2:
        lines.insert(at, line)
    elif how == 3:
        lines[at] = line * random.choice((2, 10, 2000))
    data[:] = b"\n".join(lines)


IN_PLACE = (flip_bits, set_bytes, set_integer, set_integer, copy_block)
OF_BYTES = IN_PLACE + (truncate, insert, delete)
OF_TEXT = (change_word,) * 4 + (change_line,) * 2 + OF_BYTES


def mutant_of(random, seed):
    """A mutant of the seed. Four of five HDF5 files keep their size and get correct checksums."""
    data = bytearray(seed.data)
    checksummed = not seed.is_text and random.random() < 0.8
    changes = OF_TEXT if seed.is_text else IN_PLACE if checksummed else OF_BYTES
    for _ in range(random.choice((1, 1, 1, 2) if seed.is_text else (1, 1, 1, 2, 3, 6))):
        random.choice(changes)(random, data, seed)
        if not data:
            data += b"\0"
    if checksummed:
        hdf5_checksums.correct(data, seed.data, seed.blocks)
    return bytes(data)
