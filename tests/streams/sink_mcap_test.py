"""MCAP files of live sinks: every value of every message, whole files and those of a killed writer."""

import collections
import signal
import time
import unittest

from cdr_reader import Decoder, header_of, stamp_ns
from expected_messages import Frames, check_message
from mcap_reader import read_index, read_stream
from sink_process import SCENE, SinkTest

EVERY_FRAME = ("/skin/normal", "/skin/raw", "/skin/forces", "/skin/field", "/skin/time")


class McapTest(SinkTest):
    def record(self, *arguments, **options):
        """Records the scene; returns the bytes of the file and the frames that it must hold."""
        paths = [self.folder / name for name in ("a.mcap", "forces.h5", "raw.h5")]
        results = self.run_driver("--to", paths[0], "--reference", paths[1], "--record", paths[2],
                                  *arguments, **options)
        for result in results.values():
            self.assertEqual((result["dropped"], result["failure"]), (0, ""))
        return paths[0].read_bytes(), Frames(*paths[1:])

    def check(self, data, frames):
        """Compares all messages with the frames; returns the number of each topic."""
        messages, channels = read_stream(data)
        decoders = {channel.topic: Decoder(channel.schema) for channel in channels.values()}
        for channel in channels.values():
            self.assertEqual((channel.encoding, channel.schema_encoding), ("cdr", "ros2msg"))
        counts = collections.Counter()
        for message in messages:
            decoded = decoders[message.topic].decode(message.data)
            counts[message.topic] += 1
            if message.topic == "/skin/health":
                self.check_health(decoded)
                continue
            if message.topic != "/skin/arrows":
                header = header_of(decoded)
                self.assertEqual(stamp_ns(header), message.log_time)
                if message.topic != "/skin/field":
                    self.assertEqual(header["frame_id"], "skin")
            check_message(self, frames, message.topic, message.sequence, decoded)
        return counts

    def check_health(self, decoded):
        [status] = decoded["status"]
        values = {value["key"]: value["value"] for value in status["values"]}
        self.assertEqual((status["level"], status["name"]), (0, "pillarfield"))
        self.assertEqual(values["solved"], values["frames"])

    def test_every_value(self):
        data, frames = self.record("--rate", 200)
        counts = self.check(data, frames)
        for topic in EVERY_FRAME:
            self.assertEqual(counts[topic], len(frames.time))
        for slot in range(16):
            messages = sum(slots[slot] is not None for slots in frames.slots)
            self.assertEqual(counts[f"/skin/contacts/{slot + 1}"], messages)
        self.assertGreater(counts["/skin/contacts/2"], 0)
        self.assertTrue(any(False in slots for slots in frames.slots), "no contact ends")
        # A late sink reports only the newest health.
        self.assertTrue(1 <= counts["/skin/health"] <= len(frames.time) // 10, counts)
        # 40 frames take 0.2 s or more: arrows come 30 times a second.
        self.assertTrue(1 <= counts["/skin/arrows"] < len(frames.time), counts)

    def test_field_without_shear(self):
        data, frames = self.record("--frames", 20, "--normal-only")
        frames.field = {name: frames.field[name] for name in ("normal", "status")}
        counts = self.check(data, frames)
        self.assertEqual((counts["/skin/field"], counts["/skin/normal"]), (20, 20))
        self.assertNotIn("/skin/forces", counts)

    def test_other_types_of_readings(self):
        for bits, encoding in (("12", "mono16"), ("", "32FC1")):
            text = SCENE.format(bits=bits or 8)
            scene = self.write_scene("other.toml", text if bits else text.replace("adc_bits = 8", ""))
            data, frames = self.record("--frames", 12, scene=scene)
            self.check(data, frames)
            messages, channels = read_stream(data)
            [channel] = [each for each in channels.values() if each.topic == "/skin/raw"]
            raw = next(each for each in messages if each.topic == "/skin/raw")
            self.assertEqual(Decoder(channel.schema).decode(raw.data)["encoding"], encoding)
            for file in self.folder.glob("*.h5"):
                file.unlink()
            (self.folder / "a.mcap").unlink()

    def test_curved_skin(self):
        curved = SCENE.format(bits=8).replace(
            "[sensor]", "[surface]\nshape = \"cylinder\"\nradius_mm = 40\naxis_deg = 90\n[sensor]")
        data, _ = self.record("--frames", 20, scene=self.write_scene("curved.toml", curved))
        frames = Frames(self.folder / "forces.h5", self.folder / "raw.h5", radius_mm=40)
        self.assertIn("moment_z_nmm", frames.contacts[10][0])
        counts = self.check(data, frames)
        self.assertGreater(min(counts["/skin/forces"], counts["/skin/contacts/2"]), 10)

    def test_index(self):
        # Several chunks of 1 MiB.
        data, _ = self.record("--rate", 2000, "--frames", 400)
        streamed, channels = read_stream(data)
        indexed, indexed_channels, statistics = read_index(data)
        self.assertEqual(channels, indexed_channels)
        self.assertEqual(sorted(indexed), sorted(streamed))
        count, schemas, channel_count, _, _, chunks, first, last, counts = statistics
        self.assertEqual((count, channel_count), (len(streamed), len(channels)))
        self.assertEqual(schemas, len({channel.schema_name for channel in channels.values()}))
        self.assertGreater(chunks, 2)
        times = [message.log_time for message in streamed]
        self.assertEqual((first, last), (min(times), max(times)))
        self.assertEqual({channels[number].topic: n for number, n in counts.items()},
                         collections.Counter(message.topic for message in streamed))

    def test_killed_writer(self):
        path, part = self.folder / "a.mcap", self.folder / "a.mcap.part"
        process = self.start("--to", path, "--rate", 200, "--frames", 100000)
        while not part.exists() or part.stat().st_size < 1000 or len(read_stream(part.read_bytes())[0]) < 500:
            time.sleep(0.1)
        process.send_signal(signal.SIGKILL)
        process.wait()
        messages, _ = read_stream(part.read_bytes())
        sequences = sorted(m.sequence for m in messages if m.topic == "/skin/normal")
        self.assertGreater(len(sequences), 10)
        self.assertEqual(sequences, list(range(len(sequences))))
        self.assertFalse(path.exists())
        # The next writer does not overwrite what cannot be made again.
        with self.assertRaisesRegex(AssertionError, "holds data"):
            self.start("--to", path)
        self.assertEqual(read_stream(part.read_bytes())[0], messages)


if __name__ == "__main__":
    unittest.main()
