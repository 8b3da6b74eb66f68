"""The paper's testbed: its statistics, and the solve of its readings."""

import dataclasses
import math
import unittest

import numpy as np

import testbed
from testbed import Parameters


class Model(unittest.TestCase):
    def test_brackets_are_equation_2(self):
        found = testbed.brackets(np.array(0.5), 1.2)
        expected = [math.cos(0.5) - math.sin(0.5) * math.cos(math.pi / 4 * (2 * n - 1) - 1.2) for n in range(1, 5)]
        np.testing.assert_allclose(found, expected, rtol=1e-14)

    def test_statistics_leave_out_undetected_forces_and_unwrap(self):
        angles = np.array([[0.1, 2 * math.pi + 0.3, 9.0], [0.1, 0.2, 9.0]])
        detected = np.array([[True, True, False], [True, False, False]])
        found = testbed.statistics_of(angles, 0.0, detected)
        np.testing.assert_allclose(found[:, 0], [0.2, math.sqrt(0.02), 0.2])
        self.assertTrue(np.isnan(found[:, 1]).all())

    def test_the_band_is_that_of_first_order(self):
        for site, phi, theta in testbed.SITES:
            low, high = testbed.band(theta, phi, 1e-4)
            self.assertAlmostEqual(1 - low, high - 1, delta=1e-7, msg=site)
        low, high = testbed.band(testbed.SITES[2][2], testbed.SITES[2][1], 0.05)
        self.assertAlmostEqual((high - low) / 2, 0.039, delta=0.001)


class Solved(unittest.TestCase):
    def test_an_ideal_sensor_and_probe_give_the_truth(self):
        exact = Parameters(dead_zone_counts=0, threshold_counts=0, noise_counts=0, positioner_rad=0, play_rad=0,
                           probe_resolution_n=0, runs=2)
        for row in testbed.run(exact)["table_2"][:4]:  # rounding dominates at the third site
            for estimator in ("paper", "direct"):
                self.assertLess(row[estimator]["run"]["mean_error"], 0.005)

    def test_the_paper_s_scatter_and_the_calibrated_dead_zone(self):
        found = testbed.run(dataclasses.replace(Parameters(), runs=50))
        theta = found["table_2"][1]
        self.assertEqual(theta["published"], {"mean": 0.551, "deviation": 0.24, "mean_error": 0.177})
        self.assertGreater(theta["paper"]["expected"]["deviation"], 0.2)
        self.assertLess(theta["direct"]["run"]["deviation"], 0.24 / 5)
        self.assertEqual(found["forces"], 50 * 30)
        self.assertGreater(found["wrong_regions"], 0)
        self.assertEqual(found["unflagged"], 0)

    def test_the_nearest_dead_zone(self):
        scan = testbed.scan_dead_zones(dataclasses.replace(Parameters(), runs=60))
        nearest = min(scan, key=lambda point: point["distance_rad"])
        self.assertAlmostEqual(nearest["dead_zone_n"], 7.2, delta=0.3)


if __name__ == "__main__":
    unittest.main()
