"""The sink web by its protocol: what a page gets, and who may get it."""

import http.client
import json
import struct
import unittest

import h5py
import numpy as np
from sink_process import SinkTest
from websocket_client import BINARY, PING, PONG, Closed, WebSocket

PLANES = ("shear_x", "shear_y", "normal")
PICTURE, HEALTH = 0, 1


class Picture:
    def __init__(self, content):
        rows, cols, planes = struct.unpack_from("<3I", content, 4)
        [self.pitch_mm] = struct.unpack_from("<f", content, 16)
        count = rows * cols
        self.planes = np.frombuffer(content, "<f4", planes * count, 20).reshape(planes, rows, cols)
        end = 20 + 4 * planes * count
        self.status = np.frombuffer(content, np.uint8, count, end).reshape(rows, cols)
        self.json = json.loads(content[end + count:])


class PageClient(WebSocket):
    def __init__(self, port):
        super().__init__(port, protocols=("pillarfield.page.v1",))

    def settle(self):
        self.write(b"done", PING)
        while self.read() != (PONG, b"done"):
            pass

    def read_picture(self):
        """The next picture; health that comes meanwhile is kept."""
        while True:
            kind, content = self.read()
            self.assert_binary(kind)
            if content[0] == PICTURE:
                return Picture(content)
            self.health = json.loads(content[4:])

    @staticmethod
    def assert_binary(kind):
        assert kind == BINARY, kind


class WebTest(SinkTest):
    def serve(self, *arguments):
        """Starts a server on a free port; returns the process and the port."""
        process = self.start("--to", "web:0", *arguments)
        return process, int(process.sinks[0].rstrip("/").rsplit(":", 1)[1])

    def answer(self, port, path="/", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=600)
        self.addCleanup(connection.close)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        return answer, answer.read().decode()

    def check_picture(self, picture, file):
        frame = picture.json["sequence"]
        for name, plane in zip(PLANES, picture.planes, strict=True):
            np.testing.assert_array_equal(plane, file[f"force/{name}"][frame])
        np.testing.assert_array_equal(picture.status, file["force/status"][frame])
        self.assertAlmostEqual(picture.pitch_mm, file.attrs["pillar_pitch_mm"], places=6)
        total = picture.json["total"]["force"]["normal"]
        self.assertAlmostEqual(total, np.sum(picture.planes[-1], dtype=float), places=9)

    def test_pictures_come_as_they_are_asked_for(self):
        process, port = self.serve("--rate", 100, "--wait-for-clients", 2,
                                   "--reference", self.folder / "forces.h5")
        pictures = []
        with PageClient(port) as client, PageClient(port) as mute:
            mute.settle()
            try:
                client.write("next")
                while True:
                    pictures.append(client.read_picture())
                    client.write("next")
            except Closed:
                pass
            with self.assertRaises(Closed):
                mute.read_picture()  # It asked for none.
        [result] = self.results(process).values()
        self.assertEqual((result["dropped"], result["refused"], result["failure"]), (0, 0, ""))
        frames = [picture.json["sequence"] for picture in pictures]
        self.assertEqual(frames, sorted(set(frames)))
        self.assertGreater(len(frames), 1)
        with h5py.File(self.folder / "forces.h5") as file:
            for picture in pictures:
                self.check_picture(picture, file)
        self.assertIn(client.health["solved"], range(10, 41, 10))

    def test_a_client_that_does_not_read_loses_no_frame_of_others(self):
        process, port = self.serve("--rate", 500, "--frames", 500, "--wait-for-clients", 2,
                                   "--record", self.folder / "raw.h5")
        deaf = PageClient(port)
        self.addCleanup(deaf.socket.close)
        for _ in range(100):
            deaf.write("next")
        with PageClient(port) as client:
            client.write("next")
            client.read_picture()
        for result in self.results(process).values():
            self.assertEqual(result["dropped"], 0, result)

    def test_what_a_browser_may_get(self):
        _, port = self.serve("--wait-for-clients", 1)
        answer, page = self.answer(port)
        self.assertEqual((answer.status, answer.getheader("Content-Type")),
                         (200, "text/html; charset=utf-8"))
        self.assertIn("default-src 'none'", answer.getheader("Content-Security-Policy"))
        self.assertNotRegex(page, r"(src|href)=\"(?!data:)|url\(|@import|https?://")
        self.assertEqual(self.answer(port, "/other")[0].status, 404)
        self.assertEqual(self.answer(port, Host="foreign.example")[0].status, 403)
        upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
                   "Sec-WebSocket-Key": "MDEyMzQ1Njc4OWFiY2RlZg==",
                   "Sec-WebSocket-Protocol": "pillarfield.page.v1"}
        refused, text = self.answer(port, Origin="http://foreign.example", **upgrade)
        self.assertEqual(refused.status, 403)
        self.assertIn("--allow-origin http://foreign.example", text)


if __name__ == "__main__":
    unittest.main()
