"""Records and serves a scene, and lets clients of other people decode every message: @mcap/core front
to back and by the index, @foxglove/ws-protocol by both subprotocols, @foxglove/rosmsg2-serialization.
Every value must equal the force file and the recording of the same frames.

    cmake --build build/release --target streams_sink_driver
    cd lab/interop && npm install && python3 interop.py ../../build/release/bin/streams_sink_driver
"""

import base64
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
os.environ["STREAMS_SINK_DRIVER"] = sys.argv[1]
sys.path.insert(0, str(HERE.parents[1] / "tests/streams"))
from expected_messages import Frames, check_message  # noqa: E402
from sink_process import ALL_PLANES  # noqa: E402


def bytes_of(value):
    return base64.b64decode(value["base64"]) if value.keys() == {"base64"} else value


def decode(*arguments):
    """Starts the decoder."""
    return subprocess.Popen(["node", HERE / "decode.mjs", *map(str, arguments)],
                            stdout=subprocess.PIPE)


def messages_of(decoder):
    out, _ = decoder.communicate(timeout=300)
    assert decoder.returncode == 0
    return [json.loads(line, object_hook=bytes_of) for line in out.splitlines()]


def check(name, messages, frames):
    """Compares all messages but those of health with the frames."""
    times = sorted({int(m["time"]) for m in messages if m["topic"] == "/skin/time"})
    assert len(times) == len(frames.time), f"{len(times)} frames of {len(frames.time)}"
    counts = collections.Counter(message["topic"] for message in messages)
    for message in messages:
        if message["topic"] != "/skin/health":
            check_message(unittest.TestCase(), frames, message["topic"],
                          times.index(int(message["time"])), message["message"])
    print(f"{name}: {sum(counts.values())} messages of {len(counts)} topics are equal: " +
          ", ".join(f"{topic} {count}" for topic, count in sorted(counts.items())))


def main():
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "scene.toml").write_text(ALL_PLANES)
        files = [folder / name for name in ("a.mcap", "forces.h5", "raw.h5")]
        with subprocess.Popen(
                [sys.argv[1], folder / "scene.toml", "--rate", "50", "--to", files[0], "--to",
                 "foxglove:0", "--reference", files[1], "--record", files[2],
                 "--wait-for-clients", "2", "--settle", "1"],
                stdout=subprocess.PIPE, text=True) as driver:
            port = driver.stdout.readline().split()[2].rsplit(":", 1)[1]
            clients = {name: decode("serve", port, name)
                       for name in ("foxglove.websocket.v1", "foxglove.sdk.v1")}
            found = {name: messages_of(client) for name, client in clients.items()}
        found.update((way, messages_of(decode(way, files[0]))) for way in ("stream", "index"))
        frames = Frames(*files[1:])
        for name, messages in found.items():
            check(name, messages, frames)


if __name__ == "__main__":
    main()
