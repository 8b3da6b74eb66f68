"""Reads MCAP files (mcap.dev, version 0), front to back or by their index, and checks every checksum.
Shares no code with the writer."""

import collections
import ctypes
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F

Channel = collections.namedtuple("Channel", "topic encoding schema_name schema_encoding schema")
Message = collections.namedtuple("Message", "topic sequence log_time publish_time data")


def decompress(data, size):
    """Zstandard, by the system's library: Python has none."""
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(size)
    done = library.ZSTD_decompress(out, ctypes.c_size_t(size), data, ctypes.c_size_t(len(data)))
    assert done == size, f"{done} bytes in a chunk of {size}"
    return out.raw


class Fields:
    """The fields of a record, one after the other."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, layout):
        values = struct.unpack_from("<" + layout, self.data, self.at)
        self.at += struct.calcsize("<" + layout)
        return values if len(values) > 1 else values[0]

    def block(self, length="I"):
        size = self.take(length)
        block = self.data[self.at:self.at + size]
        assert len(block) == size
        self.at += size
        return block

    def text(self):
        return self.block().decode()

    def pairs(self, layout):
        return list(struct.iter_unpack("<" + layout, self.block()))


def records(data, start, end):
    """Pairs of type and content, with the offset of each."""
    at = start
    while at + 9 <= end:
        kind, size = struct.unpack_from("<BQ", data, at)
        if at + 9 + size > end:
            return
        yield at, kind, data[at + 9:at + 9 + size]
        at += 9 + size


class Schemas:
    """Schemas and channels met so far."""

    def __init__(self):
        self.schemas, self.channels = {}, {}

    def add(self, kind, content):
        fields = Fields(content)
        if kind == SCHEMA:
            number = fields.take("H")
            assert number != 0
            self.schemas[number] = (fields.text(), fields.text(), fields.block().decode())
        elif kind == CHANNEL:
            number, schema = fields.take("HH")
            topic, encoding = fields.text(), fields.text()
            fields.pairs("I")
            name, schema_encoding, text = self.schemas[schema]
            self.channels[number] = Channel(topic, encoding, name, schema_encoding, text)

    def message(self, content):
        fields = Fields(content)
        number, sequence, log_time, publish_time = fields.take("HIQQ")
        return Message(self.channels[number].topic, sequence, log_time, publish_time,
                       content[fields.at:])


def chunk_records(content):
    fields = Fields(content)
    first, last, size, crc = fields.take("QQQI")
    compression, packed = fields.text(), fields.block("Q")
    unpacked = decompress(packed, size) if compression == "zstd" else packed
    assert compression in ("zstd", "") and zlib.crc32(unpacked) == crc
    return first, last, unpacked


def read_stream(data):
    """All messages, front to back; stops where the file breaks off. Also returns the channels."""
    assert data.startswith(MAGIC)
    known, messages = Schemas(), []
    for _, kind, content in records(data, len(MAGIC), len(data)):
        known.add(kind, content)
        assert kind != MESSAGE, "a message outside a chunk"
        if kind == CHUNK:
            first, last, unpacked = chunk_records(content)
            inside = [known.message(each) for _, kind, each in records(unpacked, 0, len(unpacked))
                      if kind == MESSAGE]
            assert (first, last) == (min(m.log_time for m in inside),
                                     max(m.log_time for m in inside))
            messages += inside
        if kind == DATA_END:
            break
    return messages, known.channels


def read_index(data):
    """All messages by the index, chunk by chunk and channel by channel, and the statistics."""
    assert data.endswith(MAGIC) and data[-37] == FOOTER
    summary_start, offsets_start, crc = struct.unpack_from("<QQI", data, len(data) - 28)
    assert zlib.crc32(data[summary_start:len(data) - 12]) == crc
    groups = [Fields(content).take("BQQ") for _, kind, content in
              records(data, offsets_start, len(data) - 37) if kind == SUMMARY_OFFSET]
    known, messages, statistics = Schemas(), [], None
    for group, start, length in groups:
        for _, kind, content in records(data, start, start + length):
            assert kind == group
            known.add(kind, content)
            if kind == STATISTICS:
                statistics = Fields(content)
                statistics = (*statistics.take("QHIIIIQQ"), dict(statistics.pairs("HQ")))
            elif kind == CHUNK_INDEX:
                messages += indexed_messages(data, content, known)
    assert sum(length for *_, length in groups) == offsets_start - summary_start
    return messages, known.channels, statistics


def indexed_messages(data, content, known):
    fields = Fields(content)
    first, last, start, length = fields.take("QQQQ")
    offsets = fields.pairs("HQ")
    index_length, compression = fields.take("Q"), fields.text()
    packed_size, size = fields.take("QQ")
    _, kind, chunk = next(records(data, start, start + length))
    assert kind == CHUNK and len(chunk) + 9 == length and compression in ("zstd", "")
    chunk_first, chunk_last, unpacked = chunk_records(chunk)
    assert (first, last, size) == (chunk_first, chunk_last, len(unpacked)) and packed_size < length
    messages, indices = [], 0
    for channel, offset in offsets:
        _, kind, index = next(records(data, offset, len(data)))
        assert kind == MESSAGE_INDEX
        fields = Fields(index)
        assert fields.take("H") == channel
        indices += len(index) + 9
        for log_time, place in fields.pairs("QQ"):
            _, kind, content = next(records(unpacked, place, len(unpacked)))
            message = known.message(content)
            assert kind == MESSAGE and message.log_time == log_time
            assert message.topic == known.channels[channel].topic
            messages.append(message)
    assert indices == index_length
    return messages
