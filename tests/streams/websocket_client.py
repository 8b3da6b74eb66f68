"""A WebSocket client (RFC 6455) of the standard library's sockets, and what the Foxglove protocol adds.
Shares no code with the server."""

import base64
import collections
import hashlib
import json
import os
import socket
import struct

from cdr_reader import Decoder

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10

Data = collections.namedtuple("Data", "topic time_ns bytes")


class Closed(Exception):
    """The server ended the connection."""


class WebSocket:
    """A connection; `protocols` are the subprotocols it offers."""

    def __init__(self, port, protocols=("foxglove.websocket.v1",), host="127.0.0.1"):
        self.socket = socket.create_connection((host, port), timeout=600)
        self.received = b""
        try:
            self.shake_hands(f"[{host}]:{port}" if ":" in host else f"{host}:{port}", protocols)
        except BaseException:
            self.socket.close()
            raise

    def shake_hands(self, host, protocols):
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                             "Sec-WebSocket-Version: 13\r\n"
                             f"Sec-WebSocket-Protocol: {', '.join(protocols)}\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.received:
            self.receive()
        head, self.received = self.received.split(b"\r\n\r\n", 1)
        status, *lines = head.decode().split("\r\n")
        headers = {name.lower(): value for name, value in (line.split(": ", 1) for line in lines)}
        assert status.startswith("HTTP/1.1 101"), status
        accept = base64.b64encode(hashlib.sha1((key + GUID).encode()).digest()).decode()
        assert headers["sec-websocket-accept"] == accept
        self.protocol = headers["sec-websocket-protocol"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def receive(self):
        try:
            block = self.socket.recv(1 << 16)
        except ConnectionError as error:
            raise Closed from error
        if not block:
            raise Closed
        self.received += block

    def take(self, count):
        while len(self.received) < count:
            self.receive()
        taken, self.received = self.received[:count], self.received[count:]
        return taken

    def read(self):
        """The next message, whole: its kind and content. Answers pings."""
        kind, content = None, b""
        while True:
            first, length = self.take(2)
            assert first & 0x70 == 0 and length < 128, "reserved bits, or a mask"
            if length >= 126:
                [length] = struct.unpack(">H" if length == 126 else ">Q",
                                         self.take(2 if length == 126 else 8))
            payload, op = self.take(length), first & 15
            if op == PING:
                self.write(payload, PONG)
            elif op == CLOSE:
                raise Closed(payload)
            else:
                kind, content = op or kind, content + payload
                if first & 0x80:
                    return kind, content

    def write(self, content, kind=TEXT):
        content = content.encode() if isinstance(content, str) else content
        size = len(content)
        head = (struct.pack(">B", 0x80 | size) if size < 126 else
                struct.pack(">BH", 0x80 | 126, size) if size < 1 << 16 else
                struct.pack(">BQ", 0x80 | 127, size))
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(content))
        self.socket.sendall(bytes([0x80 | kind]) + head + mask + masked)


class FoxgloveClient(WebSocket):
    """Reads what the server is and which channels it has; decodes the data of channels."""

    def __init__(self, port, **options):
        super().__init__(port, **options)
        self.info, advertisement = self.read_json(), self.read_json()
        assert (self.info["op"], advertisement["op"]) == ("serverInfo", "advertise")
        self.channels = {channel["topic"]: channel for channel in advertisement["channels"]}
        self.decoders = {topic: Decoder(channel["schema"])
                         for topic, channel in self.channels.items()}
        self.subscriptions = {}

    def read_json(self):
        kind, content = self.read()
        assert kind == TEXT
        return json.loads(content)

    def subscribe(self, *topics, first=100):
        wanted = [{"id": first + i, "channelId": self.channels[topic]["id"]}
                  for i, topic in enumerate(topics)]
        self.subscriptions.update({each["id"]: topic for each, topic in zip(wanted, topics)})
        self.write(json.dumps({"op": "subscribe", "subscriptions": wanted}))

    def settle(self):
        """Waits until the server has obeyed; before the first data."""
        self.write(b"done", PING)
        assert self.read() == (PONG, b"done")

    def read_data(self):
        kind, content = self.read()
        assert kind == BINARY and content[0] == 1, content[:100]
        subscription, time_ns = struct.unpack_from("<IQ", content, 1)
        return Data(self.subscriptions[subscription], time_ns, content[13:])

    def read_all(self):
        """All data until the server closes."""
        data = []
        try:
            while True:
                data.append(self.read_data())
        except Closed:
            return data
