"""pillarfield.calibrate: each step finds what was simulated, from arrays, paths and simulations."""

import os
import pathlib
import unittest

import numpy as np

import pillarfield as pf

WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
RANDOM = np.random.default_rng(3)


def noisy(readings, frames=40):
    """Frames of uint16 around the readings [R, C]."""
    return (readings + RANDOM.normal(0, 1, (frames, *readings.shape))).round().astype(np.uint16)


class Doctor(unittest.TestCase):
    def test_faults_of_frames_from_anywhere(self):
        row, col = np.mgrid[0:8, 0:12]
        bells = [np.exp(-((row - t // 40) ** 2 + (col - t % 40 / 3) ** 2) / 2) for t in range(320)]
        frames = (200 - 90 * np.array(bells) + RANDOM.normal(0, 1, (320, 8, 12))).round().astype(np.uint8)
        frames[:, 6, 1] = 77
        WORK.mkdir(parents=True, exist_ok=True)
        np.save(WORK / "pad.npy", frames)
        pf.save_recording(WORK / "pad.h5", frames, rate_hz=50, overwrite=True)
        for given, rate_hz in ((frames, None), (list(frames), None), (WORK / "pad.npy", None),
                               (pf.Recording(WORK / "pad.h5"), 50)):
            found = pf.doctor(given)
            self.assertEqual((found.polarity, found.rate_hz and round(found.rate_hz)), ("falls", rate_hz))
            self.assertEqual([(each.fault, each.sensels) for each in found.findings], [("stuck", [(6, 1)])])
        self.assertAlmostEqual(pf.doctor(WORK / "pad.npy", rate_hz=25).rate_hz, 25)
        self.assertIn(f"polarity falls, noise {found.noise_counts:.3g} counts", repr(found))
        self.assertIn(found.findings[0].text, repr(found))
        with self.assertRaisesRegex(pf.Error, "9 frames"):
            pf.doctor(frames[:9])


class Steps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.unloaded = noisy(RANDOM.normal(100, 5, (32, 40)))
        cls.tared = pf.calibrate.tare(cls.unloaded, skin=pf.Skin(32, 40))

    def test_tare(self):
        calibration = self.tared.calibration
        np.testing.assert_allclose(calibration.tare, self.unloaded.mean(0), atol=0.01)
        np.testing.assert_allclose(calibration.noise, self.unloaded.std(0, ddof=1), atol=0.01)
        self.assertIn("tare of 40 frames", calibration.history[0])
        touched = self.unloaded.copy()
        touched[:, 4:10, 4:10] += 3000
        with self.assertRaisesRegex(pf.Error, "preloaded|touch"):
            pf.calibrate.tare(touched)
        with self.assertRaises(pf.Error):
            pf.calibrate.tare(self.unloaded[:3])

    def test_paths_and_wrong_arguments(self):
        path = WORK / "unloaded.h5"
        pf.save_recording(path, self.unloaded, overwrite=True)
        np.testing.assert_array_equal(pf.calibrate.tare(path).calibration.tare,
                                      self.tared.calibration.tare)
        before = WORK / "before.h5"
        self.tared.calibration.save(before, overwrite=True)
        again = pf.calibrate.tare(pf.open(path), before).calibration
        self.assertEqual(len(again.history), 2)
        other = np.zeros((20, 8, 8), np.uint8)
        calls = [lambda: pf.calibrate.tare(other, self.tared.calibration),
                 lambda: pf.calibrate.equilibrate([], self.tared.calibration),
                 lambda: pf.calibrate.equilibrate([(self.unloaded, -1.0)], self.tared.calibration),
                 lambda: pf.calibrate.equilibrate([(self.unloaded, 5.0)], None, model="cubic"),
                 lambda: pf.calibrate.load([(self.unloaded, 5.0)], self.tared.calibration),
                 lambda: pf.calibrate.weight([(self.unloaded, 5.0)], self.tared.calibration),
                 lambda: pf.calibrate.memory([(self.unloaded, [1.0])], self.tared.calibration),
                 lambda: pf.calibrate.leak([self.unloaded], None)]
        for call in calls:
            with self.assertRaises(pf.Error):
                call()


class Sensels(unittest.TestCase):
    """A pad of odd size without pillars; 4 counts per newton and mm pitch of its own."""

    PITCH_MM, K = 5.0, 80.0

    @classmethod
    def setUpClass(cls):
        cls.tare = RANDOM.normal(30, 4, (15, 33))
        cls.gain = 1 + RANDOM.normal(0, 0.08, (15, 33))
        cls.gain /= cls.gain.mean()
        cls.skin = pf.Skin(15, 33, layout="sensels", sensel_pitch_mm=cls.PITCH_MM)
        cls.tared = pf.calibrate.tare(noisy(cls.tare), skin=cls.skin).calibration

    def pressed(self, normal_n):
        return noisy(self.tare + self.K * np.asarray(normal_n) * self.gain)

    def test_equilibrate_and_load(self):
        area_mm2 = self.PITCH_MM**2
        presses = [(self.pressed(np.full((15, 33), kpa * 1e-3 * area_mm2)), kpa) for kpa in (50, 100, 200)]
        even = pf.calibrate.equilibrate(presses, self.tared, skin=self.skin).calibration
        np.testing.assert_allclose(even.gain, 1 / self.gain, rtol=0.03)
        self.assertAlmostEqual(even.counts_per_newton, self.K, delta=0.02 * self.K)
        normal = np.zeros((15, 33))
        normal[9:, 25:] = 0.5  # up to the last row and column
        loaded = pf.calibrate.load([(self.pressed(normal), 24.0)], even, skin=self.skin).calibration
        self.assertAlmostEqual(loaded.counts_per_newton, self.K, delta=0.02 * self.K)
        forces = pf.solve(self.pressed(normal), calibration=loaded, skin=self.skin)
        self.assertFalse(forces.has_pillars)
        np.testing.assert_allclose(forces.normal.mean(0)[9:, 25:], 0.5, rtol=0.04)
        self.assertAlmostEqual(float(forces.normal.sum((1, 2)).mean()), 24, delta=0.3)
        loaded.save(WORK / "pad.h5", overwrite=True)
        self.assertFalse(pf.solve(self.pressed(normal), calibration=WORK / "pad.h5").has_pillars)

    def test_steps_of_pillars_are_refused(self):
        still = noisy(self.tare)
        for call in (lambda: pf.calibrate.shear([(still, (1.0, 0.0))], self.tared),
                     lambda: pf.calibrate.arm([still], self.tared)):
            with self.assertRaisesRegex(pf.Error, "needs pillars"):
                call()
        pillars = pf.calibrate.tare(still, skin=pf.Skin(15, 33)).calibration
        with self.assertRaisesRegex(pf.Error, "without pillars"):
            pf.calibrate.weight([(still, 5.0)], pillars)


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main()
