"""The node of docs/ros2.md against a live stream, with a stand-in for ROS 2."""

import os
import pathlib
import re
import socket
import subprocess
import sys
import types
import unittest

import numpy as np

import pillarfield as pf

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
SCENE = SOURCE / "scenes/slide_and_spin.toml"


class Message:
    """A message whose fields come into being."""

    def __getattr__(self, name):
        value = Message()
        setattr(self, name, value)
        return value


class Node(unittest.TestCase):
    def test_wrenches_equal_the_solved_ones(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = str(probe.getsockname()[1])
        (node,) = re.findall(r"^```python\n(.*?)^```$", (SOURCE / "docs/ros2.md").read_text(), re.M | re.S)
        published, streams = {}, []

        def ok():  # Called first when the node listens.
            if not streams:
                streams.append(subprocess.Popen([os.environ["PILLARFIELD"], "stream", SCENE, "--frames", "20",
                                                 "--to", f"udp:127.0.0.1:{port}", "--quiet"]))
            return streams[0].poll() is None

        def publisher(_, name, __):
            published[name] = []
            return types.SimpleNamespace(publish=published[name].append)

        made = types.SimpleNamespace(create_publisher=publisher)
        sys.modules["rclpy"] = types.SimpleNamespace(init=lambda: None, ok=ok, create_node=lambda _: made)
        sys.modules["geometry_msgs"] = sys.modules["geometry_msgs.msg"] = types.SimpleNamespace(WrenchStamped=Message)
        exec(compile(node.replace("9871", port), "docs/ros2.md", "exec"), {})

        forces = pf.solve(pf.simulate(SCENE))
        points = forces.to_points()
        force = points.force_n.astype(float).sum(1)
        moment = np.cross(points.position_m, points.force_n).sum(1)
        self.assertGreater(len(published["skin/contacts/1"]), 5)
        for message in published["skin/total"]:
            got = [[getattr(vector, axis) for axis in "xyz"] for vector in (message.wrench.force, message.wrench.torque)]
            near = np.abs(force - got[0]).sum(1).argmin()  # A datagram may be lost.
            np.testing.assert_allclose(got[0], force[near], rtol=1e-4, atol=1e-4)
            np.testing.assert_allclose(got[1], moment[near], rtol=1e-3, atol=1e-4)
            self.assertEqual(message.header.frame_id, "skin")


if __name__ == "__main__":
    unittest.main()
