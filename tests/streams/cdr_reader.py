"""Decodes ROS 2 messages in CDR by the text of their definition (`ros2msg`). Shares no code with the
writer."""

import re
import struct

import numpy as np

PRIMITIVES = {"bool": "?", "byte": "B", "char": "b", "uint8": "B", "int8": "b", "uint16": "H",
              "int16": "h", "uint32": "I", "int32": "i", "uint64": "Q", "int64": "q",
              "float32": "f", "float64": "d"}


def definitions_of(schema):
    """The members of the message, and of each message it contains by its name."""
    parts = re.split(r"^=+\nMSG: (\S+)\n", schema, flags=re.MULTILINE)
    return {"": members_of(parts[0]),
            **{name: members_of(text) for name, text in zip(parts[1::2], parts[2::2])}}


def members_of(text):
    members = []
    for line in text.splitlines():
        if not line or "=" in line:
            continue  # a constant
        kind, name = line.split()
        members.append((kind.removesuffix("[]"), name, kind.endswith("[]")))
    return members


class Decoder:
    """Decodes messages of one definition into dictionaries."""

    def __init__(self, schema):
        self.definitions = definitions_of(schema)

    def decode(self, data):
        assert data[:4] == b"\x00\x01\x00\x00", "not little-endian plain CDR"
        self.data, self.at = data[4:], 0
        message = self.struct_of("")
        assert self.at == len(self.data), f"{len(self.data) - self.at} bytes are left"
        return message

    def struct_of(self, name):
        return {member: self.sequence(kind) if is_list else self.value(kind)
                for kind, member, is_list in self.definitions[name]}

    def value(self, kind):
        if kind == "string":
            size = self.value("uint32")
            text = self.data[self.at:self.at + size]
            self.at += size
            assert text[-1:] == b"\0"
            return text[:-1].decode()
        if kind not in PRIMITIVES:
            return self.struct_of(kind)
        layout = PRIMITIVES[kind]
        self.at += -self.at % struct.calcsize(layout)
        [value] = struct.unpack_from("<" + layout, self.data, self.at)
        self.at += struct.calcsize(layout)
        return value

    def sequence(self, kind):
        length = self.value("uint32")
        if kind != "uint8":
            return [self.value(kind) for _ in range(length)]
        block = self.data[self.at:self.at + length]
        assert len(block) == length
        self.at += length
        return block


PIXELS = {"mono8": "<u1", "mono16": "<u2", "32FC1": "<f4"}


def image_of(message):
    """An Image as an array."""
    kind = np.dtype(PIXELS[message["encoding"]])
    assert message["step"] == message["width"] * kind.itemsize and not message["is_bigendian"]
    return np.frombuffer(message["data"], kind).reshape(message["height"], message["width"])


def points_of(message):
    """A PointCloud2 as an array with a field for each of its fields."""
    kinds = {2: "u1", 6: "<u4", 7: "<f4", 8: "<f8"}
    fields = message["fields"]
    assert all(field["count"] == 1 for field in fields) and message["height"] == 1
    layout = np.dtype({"names": [field["name"] for field in fields],
                       "formats": [kinds[field["datatype"]] for field in fields],
                       "offsets": [field["offset"] for field in fields],
                       "itemsize": message["point_step"]})
    points = np.frombuffer(message["data"], layout)
    assert len(points) == message["width"] and len(message["data"]) == message["row_step"]
    return points


def field_of(message):
    """A Grid as an array of rows that run up, with a field for each plane."""
    kinds = {1: "u1", 7: "<f4", 8: "<f8"}
    fields = message["fields"]
    layout = np.dtype({"names": [field["name"] for field in fields],
                       "formats": [kinds[field["type"]] for field in fields],
                       "offsets": [field["offset"] for field in fields],
                       "itemsize": message["cell_stride"]})
    rows = np.frombuffer(message["data"], np.uint8).reshape(-1, message["row_stride"])
    return rows[:, :message["column_count"] * layout.itemsize].copy().view(layout)


def header_of(message):
    """The header of a message; a Grid has its members instead."""
    return message.get("header") or {"stamp": message["timestamp"], "frame_id": message["frame_id"]}


def stamp_ns(header):
    return header["stamp"]["sec"] * 10**9 + header["stamp"]["nanosec"]
