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
        path = (0.3, 0.9, 0.2, -0.6, 0.5, -0.6, -0.85, 0.4, 0.95, -0.5)
        for share, (p, qx, qy) in zip(path, generate.swung(lambda part: generate.hertz(x, y, 6 * part), 3, 1.5, 0.5, path)):
            self.assertAlmostEqual(p.sum() / 64 / (2 / 3 * np.pi * 6**3), 1, delta=0.002)
            self.assertAlmostEqual((qx * np.cos(0.5) + qy * np.sin(0.5)).sum() / p.sum(), 1.5 * share, delta=0.005)
        p, qx, _ = generate.roller(*generate.cells(24, 24), 2, -0.7, 0)[0]
        self.assertAlmostEqual(p.sum() / 64 / (np.pi / 2 * 16 * 12), 1, delta=0.002)
        self.assertAlmostEqual(qx.sum() / p.sum(), -1.4, delta=0.01)

    def test_a_swing_that_is_exceeded_is_forgotten(self):
        x, y = generate.cells(16, 16)
        frames = [generate.swung(lambda part: generate.hertz(x, y, 6 * part), 3, 1, 0, path)[-1]
                  for path in ((0.9,), (0.5, -0.5, 0.3, 0.9), (0.9, 0.2, 0.9), (-0.9, 0.9))]
        for frame in frames[1:]:
            np.testing.assert_allclose(frame, frames[0], atol=1e-12)

    def test_pillars_are_in_equilibrium_and_within_the_friction(self):
        for name, (_, grid, friction, _, frames) in generate.HISTORIES.items():
            with self.subTest(name):
                readings, forces, *_ = generate.make(name)
                np.testing.assert_array_equal(readings, generate.make(name)[0])
                resultants = np.array(frames(*generate.cells(*grid), friction)).sum((2, 3))[:, [1, 2, 0]]
                sums = forces.sum((2, 3))
                np.testing.assert_allclose(sums / sums[-1, 2], resultants / resultants[-1, 2], atol=1e-9)
                off = (readings - generate.model(forces))[readings > generate.THRESHOLD]
                self.assertLess(abs(off.mean()), 0.1)
                self.assertLess(off.std(), 0.65)  # noise of 0.5 and rounding
                for each in (forces, generate.make(name, 1)[1]):
                    self.assertTrue((np.hypot(each[:, 0], each[:, 1]) <= friction * each[:, 2] + 1e-12).all())


class Scores(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.history = self.history_of("edge", "small", 30)

    def history_of(self, name, kind, rate_hz):
        path = Path(self.folder.name, f"{name.replace(' ', '_')}.0.h5")
        generate.write(path, kind, rate_hz, *generate.make(name))
        return score.History(path)

    def test_the_truth_scores_zero_and_an_offset_itself(self):
        found = score.score(self.history, self.history.truth, {"slip": score.slip_states(self.history.slip_share)})[0]
        self.assertEqual(list(found.values()), [0, 0, 0, 0, 100, 0])
        offset = np.array([3, 0, -4]).reshape(1, 3, 1, 1) / generate.K
        # The first frame sticks, the sixth slips in part.
        slip = [1, -1, -1, -1, -1, 0, -1, 2, 2]
        found = list(score.score(self.history, self.history.truth + offset, {"slip": slip})[0].values())
        np.testing.assert_allclose(found[:3], 5)
        np.testing.assert_allclose(found[4:], [200 / 9, 200 / 9])
        self.assertAlmostEqual(list(score.score(self.history, 1.1 * self.history.truth)[0].values())[3], 10)

    def test_frictions_are_judged_where_they_are_reported(self):
        friction = np.array([np.nan, 2, 2.1, 2.3, 2.3, 2.3, 1, np.nan, np.nan])
        deviation = np.array([0.1, 0.1, 0.1, 0.1, 0.2, 0.2, np.nan, 0.2, 0.2])  # NaN: the friction is a bound
        found = score.score(self.history, self.history.truth, {
            "friction": friction, "friction_deviation": deviation})[1]
        np.testing.assert_allclose(list(found.values()), [500 / 9, 60, 80])

    def test_times_to_slip_are_judged_until_the_body_slides(self):
        history = self.history_of("steady at 30", "in time", 30)
        true_s = history.time_to_slip()
        self.assertAlmostEqual(true_s[0], 1.6, delta=0.05)
        late = {"time_to_slip": true_s + 0.1, "time_to_slip_low": true_s, "time_to_slip_high": np.full_like(true_s, np.nan)}
        found = list(score.score(history, history.truth, late)[2].values())
        np.testing.assert_allclose(found, [100, 100, 0.2, 0], atol=0.04)
        late["time_to_slip"][5:8] = 0.2
        self.assertEqual(list(score.score(history, history.truth, late)[2].values())[3], 1)

    def test_the_command_scores_files_and_refuses_other_shapes(self):
        mine = Path(self.folder.name, "mine")
        mine.mkdir()
        for frames, status, expected in ((9, 0, "0.00"), (8, 1, "edge: forces (8, 3, 18, 18)")):
            with h5py.File(mine / "edge.0.h5", "w") as file:
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
