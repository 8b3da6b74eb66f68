"""The Foxglove server of live sinks: every value by both subprotocols, subscriptions, addresses."""

import collections
import json
import threading
import time
import unittest

from cdr_reader import header_of, stamp_ns
from expected_messages import Frames, check_message
from sink_process import ALL_PLANES, SinkTest
from websocket_client import Closed, FoxgloveClient, WebSocket


class FoxgloveTest(SinkTest):
    def serve(self, *arguments):
        """Starts a server on a free port; returns the process and the port."""
        process = self.start("--to", "foxglove:0", *arguments)
        return process, int(process.sinks[0].rsplit(":", 1)[1])

    def serve_with_reference(self, *arguments):
        return self.serve("--reference", self.folder / "forces.h5", "--record",
                          self.folder / "raw.h5", *arguments)

    def finish(self, process, frames):
        """Waits for the end; no frame may be missing in the other sink. Returns the statistics."""
        results = self.results(process)
        recorded = results.pop(str(self.folder / "raw.h5"))
        self.assertEqual((recorded["frames"], recorded["dropped"]), (frames, 0))
        [result] = results.values()
        self.assertEqual(result["failure"], "")
        return result

    def test_every_value_by_both_subprotocols(self):
        self.scene = self.write_scene("all.toml", ALL_PLANES)
        process, port = self.serve_with_reference("--rate", 50, "--wait-for-clients", 3)
        found = {}
        clients = []
        for protocol in ("foxglove.websocket.v1", "foxglove.sdk.v1"):
            client = FoxgloveClient(port, protocols=("other", protocol))
            self.addCleanup(client.socket.close)
            self.assertEqual(client.protocol, protocol)
            client.subscribe(*client.channels)
            client.settle()
            reader = threading.Thread(
                target=lambda client=client, name=protocol: found.update({name: client.read_all()}))
            reader.start()
            clients.append((client, reader))
        last = FoxgloveClient(port)  # starts the frames
        self.addCleanup(last.socket.close)
        for _, reader in clients:
            reader.join(600)
        result = self.finish(process, 40)
        self.assertEqual((result["dropped"], result["refused"]), (0, 0))
        frames = Frames(self.folder / "forces.h5", self.folder / "raw.h5")
        first, second = found.values()
        self.assertEqual(first, second)
        self.check(clients[0][0], first, frames)

    def check(self, client, data, frames):
        counts = collections.Counter(message.topic for message in data)
        stamps = sorted({m.time_ns for m in data if m.topic == "/skin/time"})
        self.assertEqual(len(stamps), len(frames.time))
        for message in data:
            decoded = client.decoders[message.topic].decode(message.bytes)
            if message.topic == "/skin/health":
                continue
            if message.topic != "/skin/arrows":
                self.assertEqual(stamp_ns(header_of(decoded)), message.time_ns)
            check_message(self, frames, message.topic, stamps.index(message.time_ns), decoded)
        # 50 a second are below the limit, but a driver that was late hurries.
        self.assertGreater(counts["/skin/normal"], 0)
        self.assertEqual(counts["/skin/raw"], counts["/skin/normal"])
        self.assertEqual(counts["/skin/forces"], counts["/skin/normal"])
        self.assertEqual(counts["/skin/field"], counts["/skin/normal"])
        self.assertEqual(counts["/skin/contacts/1"],
                         sum(slots[0] is not None for slots in frames.slots))
        # A late sink reports only the newest health.
        self.assertTrue(1 <= counts["/skin/health"] <= len(frames.time) // 10, counts)

    def test_pictures_come_at_most_60_times_a_second(self):
        for topic in ("/skin/normal", "/skin/field"):
            with self.subTest(topic):
                self.check_interval(topic)
                (self.folder / "raw.h5").unlink()

    def check_interval(self, topic):
        process, port = self.serve_with_reference("--rate", 1000, "--frames", 1000,
                                                  "--wait-for-clients", 2)
        with FoxgloveClient(port) as client:
            client.subscribe(topic, "/skin/time")
            client.settle()
            begin = time.monotonic()
            with FoxgloveClient(port):
                counts = collections.Counter(message.topic for message in client.read_all())
            most = 60 * (time.monotonic() - begin) + 2
        # The other topics have no such limit; on a busy computer the client loses some frames.
        self.assertTrue(0 < counts[topic] < most, counts)
        self.assertLess(counts[topic], counts["/skin/time"])
        self.finish(process, 1000)

    def test_subscriptions(self):
        process, port = self.serve("--frames", 100000, "--rate", 100)
        with FoxgloveClient(port) as client:
            channel = client.channels["/skin/time"]["id"]
            for message, words in (
                    ({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 999}]}, "no channel"),
                    ({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": channel}]}, "whole"),
                    ({"op": "subscribe", "subscriptions": [{"id": 2**32, "channelId": 1}]}, "whole"),
                    ({"op": "subscribe", "subscriptions": 7}, "not a list"),
                    ({"op": "unsubscribe", "subscriptionIds": [77]}, "no subscription"),
                    ({"op": "unsubscribe", "subscriptionIds": ["a"]}, "whole"),
                    ({"op": "advertise", "channels": []}, "only knows"),
                    ({"op": 3}, "JSON"), ([], "JSON"), (None, "JSON")):
                client.write(json.dumps(message))
                status = client.read_json()
                self.assertEqual((status["op"], status["level"]), ("status", 2))
                self.assertIn(words, status["message"])
            client.subscribe("/skin/time", first=5)
            self.assertEqual(client.read_data().topic, "/skin/time")
            client.write(json.dumps({"op": "unsubscribe", "subscriptionIds": [5]}))
            client.subscribe("/skin/arrows", first=5)
            while client.read_data().topic != "/skin/arrows":
                pass  # on its way before
            self.assertEqual(client.read_data().topic, "/skin/arrows")
        process.kill()

    def test_subprotocol_is_needed(self):
        _, port = self.serve("--linger", 30)
        with self.assertRaises(Closed):
            WebSocket(port, protocols=("other",))

    def test_addresses(self):
        _, port = self.serve("--linger", 30)
        with self.assertRaisesRegex(AssertionError, "in use; choose another"):
            self.start("--to", f"foxglove:{port}")
        any_address = self.start("--to", "foxglove:0.0.0.0:0", "--linger", 30)
        self.assertTrue(any_address.sinks[0].startswith("foxglove:127.0.0.1:"))
        process = self.start("--to", "foxglove:[::1]:0", "--linger", 30)
        self.assertTrue(process.sinks[0].startswith("foxglove:[::1]:"))
        with FoxgloveClient(int(process.sinks[0].rsplit(":", 1)[1]), host="::1") as client:
            self.assertEqual(client.info["name"], "pillarfield")


if __name__ == "__main__":
    unittest.main()
