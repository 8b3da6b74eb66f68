"""The examples run, and their numbers are what they promise. LEARN=1: the one that trains, too."""

import ast
import importlib.util
import json
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
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def run(name):
    done = subprocess.run([sys.executable, SOURCE / f"examples/python/{name}.py"], cwd=WORK, text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def number(pattern, text):
    return float(re.search(pattern, text)[1])


class Message:
    """A message of ROS 2, whose fields come into being."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def __getattr__(self, name):
        return self.__dict__.setdefault(name, Message())


class Examples(unittest.TestCase):
    def test_first_forces(self):
        text = run("first_forces")
        self.assertAlmostEqual(number(r"normal ([\d.]+) N", text), 25, delta=0.1)
        self.assertEqual((WORK / "first_forces.png").read_bytes()[:4], b"\x89PNG")

    def test_calibrate_skin(self):
        text = run("calibrate_skin")
        self.assertAlmostEqual(number(r"gains spread by ([\d.]+) %", text), 8, delta=1)
        self.assertAlmostEqual(number(r"(\d+) counts per newton", text), 1400, delta=20)
        self.assertAlmostEqual(number(r"solved ([\d.]+) N", text), 40, delta=0.2)
        self.assertLess(number(r"RMS ([\d.]+) N", text), 0.002)

    def test_first_look(self):
        """Each cell of the notebook runs, shows what its last line is, and keeps that for web pages."""
        book = json.loads((SOURCE / "examples/python/first_look.ipynb").read_text())
        self.assertEqual((book["nbformat"], {cell["cell_type"] for cell in book["cells"]}), (4, {"code", "markdown"}))
        os.environ["MPLBACKEND"] = "Agg"
        names, shown = {}, []
        for cell in book["cells"]:
            source = "".join(cell["source"])
            if cell["cell_type"] == "markdown" or "matplotlib" in source and not importlib.util.find_spec("matplotlib"):
                continue
            self.assertTrue(cell["outputs"])
            *before, last = ast.parse(source).body
            exec(compile(ast.Module(before, []), "notebook", "exec"), names)
            shown.append(eval(compile(ast.Expression(last.value), "notebook", "eval"), names))
        self.assertEqual(shown[1]._repr_png_()[:4], b"\x89PNG")
        self.assertAlmostEqual(names["totals"]["normal_n"][-1], 19.7, delta=0.5)  # 20 N after the last frame
        self.assertLess(names["errors"].loaded.rms_n / names["errors"].true_rms_n, 0.1)

    def test_the_node_for_ros2(self):
        """That of docs/ros2.md against a live stream, with a stand-in for ROS 2."""
        scene = SOURCE / "scenes/touch/slide_and_spin.toml"
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = str(probe.getsockname()[1])
        (node,) = re.findall(r"^```python\n(.*?)^```$", (SOURCE / "docs/ros2.md").read_text(), re.M | re.S)
        published, streams = {}, []

        def ok():  # Called first when the node listens.
            if not streams:
                streams.append(subprocess.Popen([os.environ["PILLARFIELD"], "stream", scene, "--frames", "20",
                                                 "--friction", "0.8", "--to", f"udp:127.0.0.1:{port}", "--quiet"]))
            return streams[0].poll() is None

        def publisher(_, name, __):
            published[name] = []
            return types.SimpleNamespace(publish=published[name].append)

        made = types.SimpleNamespace(create_publisher=publisher)
        sys.modules["rclpy"] = types.SimpleNamespace(init=lambda: None, ok=ok, create_node=lambda _: made)
        sys.modules["geometry_msgs"] = sys.modules["geometry_msgs.msg"] = types.SimpleNamespace(WrenchStamped=Message)
        sys.modules["std_msgs"] = sys.modules["std_msgs.msg"] = types.SimpleNamespace(Float64=Message)
        exec(compile(node.replace("9871", port), "docs/ros2.md", "exec"), {})

        forces = pf.solve(pf.simulate(scene), friction=0.8)
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
        chances = [message.data for message in published["skin/contacts/2/slip"]]  # It slides.
        self.assertTrue(chances and all(0 <= chance <= 1 for chance in chances), chances)
        self.assertEqual({message.data for message in published["skin/contacts/2/time_to_slip"]}, {0})
        self.assertEqual({message.data for message in published["skin/contacts/1/slip"]}, {1})

    def test_hold_without_slip(self):
        text = run("hold_without_slip")
        self.assertGreater(number(r"least ([-\d.]+)", text), 0.2)
        self.assertAlmostEqual(number(r"at the end ([-\d.]+)", text), 0.3, delta=0.05)

    def test_regrip(self):
        text = run("regrip")
        self.assertGreaterEqual(number(r"gripped anew (\d+) times", text), 3)
        self.assertGreater(number(r"at least ([-\d.]+) s before slip", text), 0.3)
        self.assertGreater(number(r"never nearer than ([-\d.]+) s", text), 0)

    @unittest.skipUnless(os.environ.get("LEARN"), "takes half a minute")
    def test_learn_forces(self):
        try:
            import sklearn  # noqa: F401
        except ImportError:
            self.skipTest("scikit-learn is not installed")
        text = run("learn_forces")
        errors = [float(error) for error in re.findall(r"([\d.]+) mN in all", text)]
        self.assertEqual(len(errors), 2)
        self.assertLess(errors[0], 1.1 * errors[1])  # The estimator holds against the network.


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
