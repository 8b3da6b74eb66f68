"""The examples run, and their numbers are what they promise. LEARN=1: the one that trains, too."""

import ast
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def run(name):
    done = subprocess.run([sys.executable, SOURCE / f"examples/python/{name}.py"], cwd=WORK, text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def number(pattern, text):
    return float(re.search(pattern, text)[1])


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
        """Each cell of the notebook runs, and shows what its last line is."""
        book = json.loads((SOURCE / "examples/python/first_look.ipynb").read_text())
        self.assertEqual((book["nbformat"], {cell["cell_type"] for cell in book["cells"]}), (4, {"code", "markdown"}))
        os.environ["MPLBACKEND"] = "Agg"
        names, shown = {}, []
        for cell in book["cells"]:
            source = "".join(cell["source"])
            if cell["cell_type"] == "markdown" or "matplotlib" in source and not importlib.util.find_spec("matplotlib"):
                continue
            *before, last = ast.parse(source).body
            exec(compile(ast.Module(before, []), "notebook", "exec"), names)
            shown.append(eval(compile(ast.Expression(last.value), "notebook", "eval"), names))
        self.assertEqual(shown[1]._repr_png_()[:4], b"\x89PNG")
        self.assertAlmostEqual(names["totals"]["normal_n"][-1], 19.7, delta=0.5)  # 20 N after the last frame
        self.assertLess(names["errors"].loaded.rms_n / names["errors"].true_rms_n, 0.1)

    def test_hold_without_slip(self):
        text = run("hold_without_slip")
        self.assertGreater(number(r"least ([-\d.]+)", text), 0.2)
        self.assertAlmostEqual(number(r"at the end ([-\d.]+)", text), 0.3, delta=0.05)

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
