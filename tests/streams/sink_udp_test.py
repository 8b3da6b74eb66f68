"""Datagrams of JSON: every value, and what happens when nobody listens."""

import json
import socket
import time
import unittest

from expected_messages import Frames
from sink_process import SinkTest

QUANTITIES = {"shear_x_n": ("force", "shear_x"), "shear_y_n": ("force", "shear_y"),
              "normal_n": ("force", "normal"), "torque_nmm": ("torque_nmm",), "pillars": ("pillars",),
              "centre_of_pressure_x_mm": ("centre_mm", "x"),
              "centre_of_pressure_y_mm": ("centre_mm", "y")}

KNOWN = ("friction", "slip", "friction_deviation", "slip_margin", "slipping_share", "time_to_slip_s",
         "time_to_slip_low_s", "time_to_slip_high_s", "slip_within_0_1_s", "slip_within_0_3_s",
         "slip_within_1_s")


def numeric_leaves(value):
    if isinstance(value, dict):
        for each in value.values():
            yield from numeric_leaves(each)
    else:
        yield value


class UdpTest(SinkTest):
    def listen(self, family=socket.AF_INET, host="127.0.0.1"):
        listener = socket.socket(family, socket.SOCK_DGRAM)
        self.addCleanup(listener.close)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        listener.bind((host, 0))
        listener.settimeout(600)
        return listener, listener.getsockname()[1]

    def receive(self, listener, count):
        return [json.loads(listener.recv(65536)) for _ in range(count)]

    def check(self, json_object, expected):
        for column, path in QUANTITIES.items():
            value = json_object
            for key in path:
                value = value[key]
            self.assertEqual(value, expected[column], column)
        for name in KNOWN:  # NaN in the file
            value = json_object.get(name)
            self.assertTrue(value == expected[name] or value is None and expected[name] != expected[name],
                            (name, value, expected[name]))

    def test_every_value(self):
        listener, port = self.listen()
        target = f"udp:127.0.0.1:{port}"
        before = time.time()
        results = self.run_driver("--to", target, "--reference", self.folder / "forces.h5",
                                  "--record", self.folder / "raw.h5")
        frames = Frames(self.folder / "forces.h5", self.folder / "raw.h5")
        count = len(frames.time)
        self.assertEqual((results[target]["frames"], results[target]["dropped"]), (count, 0))
        for index, datagram in enumerate(self.receive(listener, count)):
            self.assertEqual((datagram["sequence"], datagram["time"]), (index, frames.time[index]))
            self.assertTrue(before <= datagram["timestamp"] <= time.time())
            self.check(datagram["total"], frames.totals[index])
            slots = {str(slot + 1): contact for slot, contact in enumerate(frames.slots[index])
                     if contact}
            self.assertEqual(datagram["contacts"].keys(), slots.keys())
            for slot, contact in slots.items():
                self.assertEqual(datagram["contacts"][slot]["id"], contact["id"])
                self.check(datagram["contacts"][slot], contact)
            self.assertEqual(datagram["contacts_omitted"], 0)
            self.assertTrue(all(type(leaf) in (int, float) for leaf in numeric_leaves(datagram)))

    def test_contacts_are_found_if_the_stream_has_none(self):
        listener, port = self.listen(socket.AF_INET6, "::1")
        target = f"udp:[::1]:{port}"
        self.run_driver("--to", target, "--no-contacts", "--reference", self.folder / "forces.h5")
        import h5py
        with h5py.File(self.folder / "forces.h5") as file:
            normal = file["force/normal"][()].astype(float).sum(axis=(1, 2))
        for datagram, expected in zip(self.receive(listener, len(normal)), normal):
            self.assertAlmostEqual(datagram["total"]["force"]["normal"], expected, places=9)

    def test_more_contacts_than_slots(self):
        contacts = "".join(f"""
[[contact]]
shape = "sphere"
motion = "press"
contact_radius_mm = 3
load_n = 8
position_mm = [{10 * (i % 5) - 20}, {10 * (i // 5) - 15}]
""" for i in range(20))
        scene = self.write_scene("many.toml", "title = \"Many\"\n[skin]\npillars = [40, 50]\n"
                                 "threshold_counts = 1\n[time]\nframes = 3\n" + contacts)
        listener, port = self.listen()
        self.run_driver("--to", f"udp:127.0.0.1:{port}", scene=scene)
        for datagram in self.receive(listener, 3):
            self.assertEqual(len(datagram["contacts"]), 16)
            self.assertEqual(datagram["contacts_omitted"], 4)

    def test_nobody_listens_at_first(self):
        listener, port = self.listen()
        listener.close()
        target = f"udp:127.0.0.1:{port}"
        process = self.start("--to", target, "--frames", 600, "--rate", 100)
        time.sleep(1)
        late = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(late.close)
        late.bind(("127.0.0.1", port))
        late.settimeout(600)
        sequence = json.loads(late.recv(65536))["sequence"]
        received = self.receive(late, 599 - sequence)
        self.assertEqual([each["sequence"] for each in received], list(range(sequence + 1, 600)))
        result = self.results(process)[target]
        self.assertEqual((result["frames"] + result["dropped"], result["failure"]), (600, ""))
        # Each refusal is known one datagram later.
        self.assertLessEqual(abs(result["dropped"] - sequence), 1)


if __name__ == "__main__":
    unittest.main()
