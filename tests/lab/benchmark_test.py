"""The open benchmark, lab/benchmark: its histories and its scorer."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(os.environ["PILLARFIELD_SOURCE"], "lab/benchmark")
sys.path.insert(0, str(FOLDER))

import h5py  # noqa: E402
import numpy as np  # noqa: E402

import entries  # noqa: E402
import generate  # noqa: E402
import score  # noqa: E402


class Histories(unittest.TestCase):
    def test_closed_forms_bear_their_loads(self):
        x, y = generate.cells(16, 16)
        for share, before in ((0.3, None), (0.9, None), (0.2, 0.9), (-0.85, 0.9)):
            p, qx, qy = generate.dragged(lambda part: generate.hertz(x, y, 6 * part), 3, 1.5, 0.5, share, before)
            self.assertAlmostEqual(p.sum() / 64 / (2 / 3 * np.pi * 6**3), 1, delta=0.002)
            self.assertAlmostEqual((qx * np.cos(0.5) + qy * np.sin(0.5)).sum() / p.sum(), 1.5 * share, delta=0.005)
        p, qx, _ = generate.roller(2, -0.7, 0)[0]
        self.assertAlmostEqual(p.sum() / 64 / (np.pi / 2 * 16 * 12), 1, delta=0.002)
        self.assertAlmostEqual(qx.sum() / p.sum(), -1.4, delta=0.01)

    def test_pillars_are_in_equilibrium_and_within_the_friction(self):
        for name, (frames, _) in generate.HISTORIES.items():
            with self.subTest(name):
                readings, forces, _, friction = generate.make(name)
                np.testing.assert_array_equal(readings, generate.make(name)[0])
                resultants = np.array(frames()).sum((2, 3))[:, [1, 2, 0]]
                sums = forces.sum((2, 3))
                np.testing.assert_allclose(sums / sums[-1, 2], resultants / resultants[-1, 2], atol=1e-9)
                self.assertTrue((np.hypot(forces[:, 0], forces[:, 1]) <= friction * forces[:, 2] + 1e-12).all())
                off = (readings - generate.model(forces))[readings > generate.THRESHOLD]
                self.assertLess(abs(off.mean()), 0.1)
                self.assertLess(off.std(), 0.65)  # noise of 0.5 and rounding


class Scores(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        generate.write(Path(self.folder.name, "edge.h5"), *generate.make("edge"))
        self.history = score.History(Path(self.folder.name, "edge.h5"))

    def test_the_truth_scores_zero_and_an_offset_itself(self):
        found = score.score(self.history, self.history.truth, score.slip_states(self.history.slip_share))
        self.assertEqual(list(found.values()), [0, 0, 0, 0, 100, 0])
        offset = np.array([3, 0, -4]).reshape(1, 3, 1, 1) / generate.K
        # The first frame sticks, the sixth slips in part.
        found = score.score(self.history, self.history.truth + offset, [1, -1, -1, -1, -1, 0, -1, 2, 2])
        np.testing.assert_allclose(list(found.values())[:3], 5)
        np.testing.assert_allclose([found["slip_right_%"], found["slip_wrong_%"]], [200 / 9, 200 / 9])
        self.assertAlmostEqual(score.score(self.history, 1.1 * self.history.truth)["resultant_%"], 10)

    def test_the_command_scores_files_and_refuses_other_shapes(self):
        mine = Path(self.folder.name, "mine")
        mine.mkdir()
        for frames, status, expected in ((9, 0, "0.00"), (8, 1, "edge: forces (8, 3, 18, 18)")):
            with h5py.File(mine / "edge.h5", "w") as file:
                for index, name in enumerate(("shear_x", "shear_y", "normal")):
                    file[f"force/{name}"] = self.history.truth[:frames, index]
            done = subprocess.run([sys.executable, FOLDER / "score.py", self.folder.name, mine], text=True,
                                  capture_output=True, check=False)
            self.assertEqual(done.returncode, status)
            self.assertIn(expected, done.stdout + done.stderr)

    def test_the_model_is_solved_where_it_is_determined(self):
        forces = np.array([[0.1, -0.05, 0.3], [0.2, 0.15, 0.2], [0.4, 0.02, 0.2]]).T.reshape(1, 3, 3, 1)
        v = score.sensels(generate.model(forces))
        np.testing.assert_array_equal(score.regions(v > 0).ravel(), [1, 2, 3])
        diagonal = np.full((1, 3, 1), 2 * generate.K * 0.2)
        np.testing.assert_allclose(entries.forces_of(v, generate.K, 0, diagonal), forces, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
