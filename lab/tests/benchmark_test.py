"""The open benchmark, lab/benchmark: its mechanics, its histories and its scorer."""

import json
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
import half_space  # noqa: E402
import score  # noqa: E402

QUICK = [name for name in generate.HISTORIES if name not in ("ball twisted", "rough ball")]


class Mechanics(unittest.TestCase):
    def test_boundary_elements_find_hertz_and_mindlin(self):
        x, y = half_space.cells(12, 12, 4)
        radius, size, share, friction = 100, 4.0, 0.6, 1.5
        ball = half_space.Indenter(x, y, lambda x, y: (x**2 + y**2) / (2 * radius), friction)
        p, _, _ = ball.move((0, 0), 0, size**2 / radius)
        load = p.sum() / 16
        self.assertAlmostEqual(load / (4 / 3 / np.pi * size**3 / radius), 1, delta=0.01)
        way = 9 * friction * np.pi * load / (8 * size) * (1 - (1 - share)**(2 / 3))  # (H11); G = 1 / (4 pi)
        ball.shape = lambda x, y: ((x + way)**2 + y**2) / (2 * radius)  # the skin goes with the body: Mindlin's contact
        p, qx, qy = ball.move((way, 0), 0, size**2 / radius)
        self.assertAlmostEqual(qx.sum() / 16 / (share * friction * load), 1, delta=0.01)
        self.assertTrue((np.hypot(qx, qy) <= friction * p * (1 + 1e-9) + 1e-12).all())

    def test_closed_forms_bear_their_loads(self):
        x, y = half_space.cells(16, 16, 8)
        for share, before in ((0.3, None), (0.9, None), (0.2, 0.9), (-0.85, 0.9)):
            p, qx, qy = half_space.dragged(lambda part: half_space.hertz(x, y, 6 * part), 3, 1.5, 0.5, share, before)
            self.assertAlmostEqual(p.sum() / 64 / (2 / 3 * np.pi * 6**3), 1, delta=0.002)
            self.assertAlmostEqual((qx * np.cos(0.5) + qy * np.sin(0.5)).sum() / p.sum(), 1.5 * share, delta=0.005)
        p, qx, qy = half_space.rolling(x, y, 4, 12, 2, -0.7, 0, (0, 0))
        self.assertAlmostEqual(p.sum() / 64 / (np.pi / 2 * 16 * 12), 1, delta=0.002)
        self.assertAlmostEqual(qx.sum() / p.sum(), -1.4, delta=0.01)


class Histories(unittest.TestCase):
    def test_each_is_in_equilibrium_within_its_friction_and_read_by_the_model(self):
        for name in QUICK:
            with self.subTest(name):
                readings, forces, slip_share, friction = generate.make(name)
                frames = np.moveaxis(np.array(generate.HISTORIES[name][0]()), 1, 0)
                resultants, sums = frames.sum((2, 3)), np.moveaxis(forces, 1, 0).sum((2, 3))
                scale = sums[2, -1] / resultants[2, -1]
                np.testing.assert_allclose(sums, scale * resultants, atol=1e-9 * sums[2].max())
                shear, normal = np.hypot(forces[:, 0], forces[:, 1]), forces[:, 2]
                self.assertTrue((shear <= friction * normal * (1 + 1e-9) + 1e-12).all())
                self.assertTrue(((slip_share >= 0) & (slip_share <= 1)).all())
                off = readings - generate.K * generate.model(forces)
                loaded = readings > generate.THRESHOLD
                self.assertLess(abs(off[loaded].mean()), 0.1)
                self.assertLess(off[loaded].std(), 0.65)  # noise of 0.5 and rounding
                self.assertGreater(readings.max(), 140)

    def test_files_are_the_same_bytes_each_time(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder, name) for name in ("one.h5", "other.h5")]
            for path in paths:
                generate.write(path, *generate.make("edge"))
            self.assertEqual(paths[0].read_bytes(), paths[1].read_bytes())


class Scorer(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.histories, self.mine = (Path(self.folder.name, name) for name in ("histories", "mine"))
        self.histories.mkdir()
        self.mine.mkdir()
        generate.write(self.histories / "edge.h5", *generate.make("edge"))
        self.history = score.History(self.histories / "edge.h5")

    def run_on(self, forces, slip=None):
        """Scores of a folder of forces, and the exit status."""
        with h5py.File(self.mine / "edge.h5", "w") as file:
            for index, name in enumerate(score.COMPONENTS):
                file[f"force/{name}"] = forces[:, index]
            if slip is not None:
                file["slip"] = slip
        done = subprocess.run([sys.executable, FOLDER / "score.py", self.histories, self.mine, "--json"],
                              capture_output=True, text=True, check=False)
        return done.returncode, json.loads(done.stdout)["mine"]["mean"] if done.stdout else done.stderr

    def test_the_truth_scores_zero(self):
        status, mean = self.run_on(self.history.truth, score.slip_states(self.history.slip_share))
        self.assertEqual((status, mean), (0, {"region_3": 0, "others": 0, "field": 0, "resultant": 0,
                                              "slip_right": 1, "slip_wrong": 0}))

    def test_an_offset_scores_itself(self):
        off = self.history.truth.copy()
        off[:, 0] += 3 / self.history.k
        off[:, 2] -= 4 / self.history.k
        _, mean = self.run_on(off, [1, -1, -1, -1, -1, -1, -1, 2, 2])  # the first frame sticks
        for name in ("region_3", "others", "field"):
            self.assertAlmostEqual(mean[name], 5, places=6)
        self.assertEqual([round(9 * mean[name]) for name in ("slip_right", "slip_wrong")], [2, 1])
        _, mean = self.run_on(1.1 * self.history.truth)
        self.assertAlmostEqual(mean["resultant"], 0.1, places=6)
        self.assertEqual(mean["slip_wrong"], 0)

    def test_a_wrong_shape_ends_in_one_line(self):
        status, message = self.run_on(self.history.truth[:-1])
        self.assertEqual((status, message.count("\n")), (1, 1))
        self.assertIn("edge: the forces have the shape", message)


class Entries(unittest.TestCase):
    def test_the_model_is_solved_where_it_is_determined(self):
        forces = np.array([[0.1, -0.05, 0.3], [0.2, 0.15, 0.25], [0.3, 0.02, 0.2]]).reshape(1, 3, 3, 1).transpose(0, 2, 1, 3)
        readings = generate.K * generate.model(forces)
        v = entries.sensels(readings)
        np.testing.assert_array_equal(score.regions(readings, 0).ravel(), [4, 3, 2])
        diagonal = np.full((1, 3, 1), 2 * generate.K * 0.2)
        np.testing.assert_allclose(entries.forces_of(v, generate.K, 0, diagonal), forces, atol=1e-12)

    def test_a_penalty_improves_on_the_middle_of_the_segment(self):
        readings, truth, _, _ = generate.make("edge")
        found, _ = entries.penalty(readings, generate.K, generate.THRESHOLD)
        v = entries.sensels(readings)
        middle = entries.forces_of(v, generate.K, generate.THRESHOLD, entries.segment_length(v, generate.THRESHOLD) / 2)
        self.assertLess(((found - truth)**2).sum(), ((middle - truth)**2).sum())


if __name__ == "__main__":
    unittest.main()
