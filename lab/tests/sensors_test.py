"""lab/report/measure_sensors.py and sensors.py on synthetic forces."""

import os
import sys
import unittest

import numpy

sys.path.insert(0, f"{os.environ['PILLARFIELD_SOURCE']}/lab/report")

import measure_sensors  # noqa: E402
import sensor_scenes  # noqa: E402
import sensors  # noqa: E402

COUNT = 1 / sensor_scenes.COUNTS_PER_NEWTON  # N


def field(*counts):
    """One frame of 4 x 4 pillars, the middle four under this force, counts."""
    forces = numpy.zeros((3, 1, 4, 4))
    forces[:, 0, 1:3, 1:3] = numpy.array(counts).reshape(3, 1, 1) * COUNT
    return forces


def status(bits):
    result = numpy.zeros((1, 4, 4), dtype=numpy.uint8)
    result[0, 1:3, 1:3] = bits
    return result


class Scores(unittest.TestCase):
    def test_the_sensels_that_a_force_loads(self):
        # Towards the right and up, the upper right sensel bears most, the lower left one least.
        v = measure_sensors.loads(numpy.array([10.0, 5.0, 8.0]))
        self.assertEqual(list(v.argsort()), [2, 1, 3, 0])
        self.assertAlmostEqual(v[0] + v[2], v[1] + v[3])

    def test_errors_are_those_of_the_vector(self):
        found = measure_sensors.scores(field(0, 0, 100), field(2, 1, 98), status(15))
        self.assertAlmostEqual(sensors.rms(found), 3)
        self.assertEqual(found["determined"][1], 4)
        self.assertEqual((found["rim"][1], found["inside"][1]), (4, 0))
        self.assertEqual(found["wrong"], [0, 4])

    def test_a_region_is_wrong_by_its_sensels(self):
        found = measure_sensors.scores(field(0, 0, 100), field(0, 0, 100), status(7))
        self.assertEqual((found["wrong"], found["unflagged"]), ([4, 4], [4, 4]))
        flagged = measure_sensors.scores(field(0, 0, 100), field(0, 0, 100), status(7 + 16))
        self.assertEqual((flagged["wrong"], flagged["unflagged"]), ([4, 4], [0, 4]))
        found = measure_sensors.scores(field(0, 200, 100), field(0, 200, 100), status(3))
        self.assertEqual(found["wrong"], [0, 4])
        self.assertEqual((found["ambiguous"][1], found["determined"][1]), (4, 0))
        found = measure_sensors.scores(field(0, 150, 100), field(0, 150, 100), status(15),
                                       coefficient=0.9)
        self.assertEqual(found["wrong"], [0, 4])

    def test_light_pillars_do_not_count(self):
        found = measure_sensors.scores(field(0, 0, 7), field(0, 0, 50), status(15))
        self.assertEqual(found["determined"], [0, 0])

    def test_coverage_by_component(self):
        deviations = field(1, 1, 1)
        found = measure_sensors.scores(field(0, 0, 100), field(1.9, 2, 100), status(15), deviations)
        self.assertEqual([found[name] for name in sensors.COMPONENTS], [[4, 4], [0, 4], [4, 4]])
        flagged = measure_sensors.scores(field(0, 0, 100), field(0, 0, 100), status(15 + 16),
                                         deviations)
        self.assertEqual(flagged["normal"], [0, 0])

    def test_histories_are_taken_together(self):
        self.assertEqual(measure_sensors.added([{"a": [1, 2]}, {"a": [3, 4]}]), {"a": [4, 6]})


class Scenes(unittest.TestCase):
    def test_a_pressure_is_that_of_its_counts(self):
        # One newton on a pillar of 1.6 mm^2 is 625 kPa, and 320 counts.
        self.assertAlmostEqual(sensor_scenes.kilopascals(320), 625, places=3)

    def test_every_step_of_an_effect_is_known(self):
        for effect in sensor_scenes.EFFECTS.values():
            for step in effect.steps:
                self.assertIn(step, measure_sensors.ORDER)
                self.assertTrue(step in sensor_scenes.CALIBRATIONS
                                or step in sensor_scenes.CONSTANTS)


class Times(unittest.TestCase):
    def test_rows_are_ratios_to_the_solve_without_the_effect(self):
        cases = [{"name": f"sensor/{percent}/{effect}", "ns_per_pillar": time}
                 for percent, factor in ((100, 4.0), (8, 1.0))
                 for effect, time in [("none", factor), *((each, 1.5 * factor) for each in sensors.TIMED)]]
        bench = sensors.speed.Bench("test", {"context": {}, "benchmarks": cases})
        rows = list(sensors.time_rows(bench))
        self.assertEqual(rows[0], ["response curve", "1.50", "1.50", "1.2"])
        self.assertEqual(len(rows), len(sensors.TIMED))


if __name__ == "__main__":
    unittest.main()
