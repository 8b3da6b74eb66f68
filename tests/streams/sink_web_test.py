"""The sink web by its protocol: what a page gets, and who may get it."""

import http.client
import json
import struct
import unittest

import h5py
import numpy as np
from sink_process import SinkTest
from websocket_client import BINARY, PING, PONG, Closed, WebSocket

PICTURE = 0


class PageClient(WebSocket):
    def __init__(self, port):
        super().__init__(port, protocols=("pillarfield.page.v2",))

    def settle(self):
        self.write(b"done", PING)
        while self.read() != (PONG, b"done"):
            pass

    def read_picture(self):
        """The content of the next picture; health that comes meanwhile is kept."""
        while True:
            kind, content = self.read()
            assert kind == BINARY
            if content[0] == PICTURE:
                return content
            self.health = json.loads(content[4:])


class WebTest(SinkTest):
    def serve(self, *arguments):
        """Starts a server on a free port; returns the process and the port."""
        process = self.start("--to", "web:0", *arguments)
        return process, int(process.sinks[0].rstrip("/").rsplit(":", 1)[1])

    def check_picture(self, content, file):
        """Returns the number of its frame."""
        rows, cols, planes, row_mm, col_mm = struct.unpack_from("<3I2f", content, 4)
        count, end = rows * cols, 24 + 4 * planes * rows * cols
        text = json.loads(content[end + count:])
        frame = text["sequence"]
        forces = np.frombuffer(content, "<f4", planes * count, 24).reshape(planes, rows, cols)
        for name, plane in zip(("shear_x", "shear_y", "normal"), forces, strict=True):
            np.testing.assert_array_equal(plane, file[f"force/{name}"][frame])
        status = np.frombuffer(content, np.uint8, count, end).reshape(rows, cols)
        np.testing.assert_array_equal(status, file["force/status"][frame])
        for pitch_mm in (row_mm, col_mm):
            self.assertAlmostEqual(pitch_mm, file.attrs["pillar_pitch_mm"], places=6)
        total = np.sum(forces[-1], dtype=float)
        self.assertAlmostEqual(text["total"]["force"]["normal"], total, places=9)
        return frame

    def test_pictures_come_as_they_are_asked_for(self):
        process, port = self.serve("--rate", 50, "--wait-for-clients", 4,
                                   "--reference", self.folder / "forces.h5")
        pictures = []
        with PageClient(port) as mute, PageClient(port) as once, PageClient(port) as client:
            for each in (once, client):
                each.write("next")
                each.settle()
            with PageClient(port), self.assertRaises(Closed):  # The last one starts the frames.
                while True:
                    pictures.append(client.read_picture())
                    client.write("next")
            pictures.insert(0, once.read_picture())
            for other in (mute, once):  # They asked for none, or one.
                with self.assertRaises(Closed):
                    other.read_picture()
        [result] = self.results(process).values()
        self.assertEqual((result["dropped"], result["refused"], result["failure"]), (0, 0, ""))
        with h5py.File(self.folder / "forces.h5") as file:
            frames = [self.check_picture(picture, file) for picture in pictures]
        self.assertEqual(frames[1:], sorted(set(frames[1:])))
        self.assertGreater(len(frames), 2)
        self.assertIn(client.health["solved"], range(10, 41, 10))

    def test_a_client_that_does_not_read_costs_nobody_a_frame(self):
        process, port = self.serve("--rate", 500, "--frames", 500, "--wait-for-clients", 2,
                                   "--record", self.folder / "raw.h5")
        with PageClient(port) as deaf, PageClient(port) as client:
            deaf.write("next")
            client.write("next")
            client.read_picture()
            for result in self.results(process).values():
                self.assertEqual(result["dropped"], 0, result)

    def test_what_a_browser_may_get(self):
        _, port = self.serve("--wait-for-clients", 1)

        def answer_to(path="/", **headers):
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=600)
            self.addCleanup(connection.close)
            connection.request("GET", path, headers=headers)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read().decode()

        status, headers, page = answer_to()
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        self.assertNotRegex(page, r"(src|href)=\"(?!data:)|url\(|@import|https?://")
        self.assertEqual(answer_to("/other")[0], 404)
        self.assertEqual(answer_to(Host="foreign.example")[0], 403)
        status, _, text = answer_to(Origin="http://foreign.example", Upgrade="websocket")
        self.assertEqual(status, 403)
        self.assertIn("--allow-origin http://foreign.example", text)


if __name__ == "__main__":
    unittest.main()
