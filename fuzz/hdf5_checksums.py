"""Finds the checksummed blocks of an HDF5 file and corrects their checksums.

Newer HDF5 files end each block of metadata with Jenkins' lookup3 hash of it, so an uncorrected mutant
seldom gets past its first wrong checksum. The end of a block is not parsed: it is the length whose hash
follows the block.
"""

import re

import numpy

SIGNATURES = re.compile(rb"\x89HDF\r\n\x1a\n|OHDR|OCHK|FRHP|FHDB|FHIB|FSHD|FSSE|BTHD|BTLF|BTIN|"
                        rb"FAHD|FADB|EAHD|EAIB|EASB|EADB|SMTB|SMLI")
LONGEST = 2048


def rotated(value, bits):
    return (value << numpy.uint32(bits)) | (value >> numpy.uint32(32 - bits))


def mixed(a, b, c):
    a = (a - c) ^ rotated(c, 4)
    c = c + b
    b = (b - a) ^ rotated(a, 6)
    a = a + c
    c = (c - b) ^ rotated(b, 8)
    b = b + a
    a = (a - c) ^ rotated(c, 16)
    c = c + b
    b = (b - a) ^ rotated(a, 19)
    a = a + c
    c = (c - b) ^ rotated(b, 4)
    b = b + a
    return a, b, c


def finished(a, b, c):
    c = (c ^ b) - rotated(b, 14)
    a = (a ^ c) - rotated(c, 11)
    b = (b ^ a) - rotated(a, 25)
    c = (c ^ b) - rotated(b, 16)
    a = (a ^ c) - rotated(c, 4)
    b = (b ^ a) - rotated(a, 14)
    return (c ^ b) - rotated(b, 24)


def checksums(data, lengths):
    """lookup3 of data[:n] for each n of `lengths`, which increase from 1 or more."""
    lengths = numpy.asarray(lengths, "u4")
    data = numpy.frombuffer(bytes(data) + bytes(12), "u1")
    a = b = c = lengths + numpy.uint32(0xDEADBEEF)
    results = []
    for at in range(0, int(lengths[-1]), 12):
        block = data[at:at + 12]
        ending = int(numpy.searchsorted(lengths, at + 12, "right"))
        if ending > 0:
            kept = numpy.arange(12) < (lengths[:ending].astype("i8") - at)[:, None]
            tails = numpy.ascontiguousarray(block * kept, "u1").view("<u4")
            results.append(finished(*(part[:ending] + tails[:, i]
                                      for i, part in enumerate((a, b, c)))))
            a, b, c, lengths = a[ending:], b[ending:], c[ending:], lengths[ending:]
        words = block.view("<u4")
        a, b, c = mixed(a + words[0], b + words[1], c + words[2])
    return numpy.concatenate(results)


def find_blocks(data):
    """The (begin, end) of each block in `data`; its checksum is the four bytes from `end` on."""
    blocks = []
    for match in SIGNATURES.finditer(data):
        part = data[match.start():match.start() + LONGEST]
        lengths = numpy.arange(8, len(part) - 3, dtype="u4")
        if lengths.size == 0:
            continue
        stored = sum(numpy.frombuffer(part, "u1")[lengths + i].astype("u4") << numpy.uint32(8 * i)
                     for i in range(4))
        for length in lengths[checksums(part, lengths) == stored][:1]:
            blocks.append((match.start(), match.start() + int(length)))
    return blocks


def correct(data, original, blocks):
    """Sets the checksum of each block that differs from `original`."""
    for begin, end in blocks:
        if data[begin:end] != original[begin:end]:
            value = int(checksums(data[begin:end], [end - begin])[0])
            data[end:end + 4] = value.to_bytes(4, "little")
