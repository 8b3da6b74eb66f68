"""Records what the page of `stream --to web` gets of a scene, and writes the page as a replay that needs no server.

replay.py PILLARFIELD SCENE OUTPUT writes OUTPUT.html, the page as it is served, and OUTPUT.js, a round of the scene.
"""

import base64
import gzip
import json
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tomllib
import urllib.request

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tests/streams"))
from websocket_client import WebSocket  # noqa: E402

HEAD = struct.Struct("<I3I2f")


def rounded(message):
    """The planes of a picture to 0.1 mN, whose bits compress, and its JSON."""
    _, rows, cols, planes, *_ = HEAD.unpack_from(message)
    end = HEAD.size + 4 * planes * rows * cols
    forces = np.round(np.frombuffer(message[HEAD.size:end], "<f4") * 8192) / 8192
    status_end = end + rows * cols
    return message[:HEAD.size] + forces.astype("<f4").tobytes() + message[end:status_end], message[status_end:]


def record(port, frames):
    """The pictures of a round, and the newest report of health."""
    pictures, health = {}, None
    with WebSocket(port, protocols=("pillarfield.page.v2",)) as socket:
        socket.write("next")
        while len(pictures) < frames or health is None:
            _, message = socket.read()
            if message[0] == 1:
                health = json.loads(message[4:])
                continue
            socket.write("next")
            planes, text = rounded(message)
            # Rounds differ by noise; a computer that is late fills a gap from the next one.
            pictures.setdefault(json.loads(text)["sequence"] % frames, (planes, text))
    return [pictures[i] for i in sorted(pictures)], health


def save(url, scene, output):
    """Writes OUTPUT.html and OUTPUT.js with a round of the scene that is streamed at this address again and again."""
    timing = tomllib.loads(pathlib.Path(scene).read_text(encoding="utf-8"))["time"]
    page = urllib.request.urlopen(url).read().decode()
    pictures, health = record(int(url.rstrip("/").rsplit(":", 1)[1]), timing["frames"])
    packed = b"".join(struct.pack("<2I", len(planes), len(text)) + planes + text for planes, text in pictures)
    recording = {"rate_hz": timing["rate_hz"], "health": health,
                 "pictures": base64.b64encode(gzip.compress(packed, mtime=0)).decode()}
    script = f"const RECORDING = {json.dumps(recording)};\n" + (HERE / "replay.js").read_text(encoding="utf-8")
    before, after = page.split("<script>")
    page = f'{before}<script src="{pathlib.Path(output).name}.js"></script>\n<script>{after}'
    for ending, text in (("js", script), ("html", page)):
        pathlib.Path(f"{output}.{ending}").write_text(text, encoding="utf-8")


def main(program, scene, output):
    with subprocess.Popen([program, "stream", scene, "--repeat", "--to", "web:0"], stderr=subprocess.PIPE,
                          stdout=subprocess.DEVNULL, text=True) as process:
        try:
            save(next(found[0] for line in process.stderr if (found := re.search(r"http://\S+/", line))), scene, output)
        finally:
            process.send_signal(signal.SIGTERM)


if __name__ == "__main__":
    main(*sys.argv[1:])
