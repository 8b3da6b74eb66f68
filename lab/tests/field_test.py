"""lab/report/field.py on synthetic scores."""

import os
import sys
import unittest

sys.path.insert(0, f"{os.environ['PILLARFIELD_SOURCE']}/lab/report")

import field  # noqa: E402


def score(ambiguous, squares, held=0, total_error=0.0):
    return {"loaded": 2 * ambiguous, "ambiguous": ambiguous, "squares": squares, "held": [held] * 6,
            "held_with_noise": [held] * 6, "frames": 1, "total_errors": total_error,
            "total_squares": total_error**2}


def recording(friction=1.2, pillars=40, learnt=(), **squares):
    """A recording with squared errors of its pillars by method."""
    return {"friction": friction, "learnt": learnt, "name": "made up",
            "scores": {method: score(pillars, pillars * square)
                       for method, square in ({"noise": 0} | squares).items()}}


class Scores(unittest.TestCase):
    def test_pillars_of_recordings_are_taken_together(self):
        recordings = [{"scores": {"contact": score(30, 90, 20, 0.1)}},
                      {"scores": {"contact": score(10, 70, 10, -0.3)}}]
        both = field.Score(recordings, "contact")
        self.assertEqual((both.ambiguous, both.loaded, both.rms), (40, 80, 2))
        self.assertEqual(both.coverage, [0.75] * 6)
        self.assertAlmostEqual(both.total_bias, -0.1)
        self.assertAlmostEqual(both.total_rms, 0.05**0.5)

    def test_no_ambiguous_pillar_has_no_error(self):
        none = recording(pillars=0, paper=1, contact=1)
        self.assertIsNone(field.rms([none], "contact"))
        self.assertIsNone(field.over_paper([none], "contact"))
        self.assertEqual(field.with_pillars([none, recording()], 1), [recording()])


class Goals(unittest.TestCase):
    def bound_by(self, contact, given):
        values = {"contact": contact, "given": given}
        return field.goal("what", "≤ 1", values.get, str, lambda value: value <= 1)[3::3]

    def test_the_bound_of_a_goal(self):
        self.assertEqual(self.bound_by(1, 2), ["met", ""])
        self.assertEqual(self.bound_by(2, 1), ["**not met**", "friction"])
        self.assertEqual(self.bound_by(2, 2), ["**not met**", "more than friction"])

    def test_recordings_worse_than_the_paper(self):
        histories = [recording(paper=1, contact=1.02**2), recording(paper=1, contact=4),
                     recording(paper=1, contact=9), recording(4.5, paper=1, contact=9),
                     recording(pillars=0, paper=1, contact=9)]
        self.assertEqual([ratio for ratio, _ in field.worse_than_paper(histories)], [3, 2])

    def test_only_recordings_with_enough_pillars_have_a_coverage(self):
        histories = [{"scores": {"noise": score(pillars, 0), "contact": score(pillars, 0, held)}}
                     for pillars, held in ((100, 88), (100, 87), (29, 0))]
        self.assertEqual(field.true_recordings(histories, "contact", 0), 0.5)


class Learnt(unittest.TestCase):
    def test_narrow_posteriors_that_are_off(self):
        def contact(median, spread=0.01, pillars=10):
            return {"median": median, "spread": spread, "pillars": pillars}

        history = recording(1.0, learnt=[contact(1.05), contact(1.15), contact(0.7),
                                         contact(3, spread=0.1), contact(3, pillars=9)])
        self.assertEqual(field.narrow_contacts([history], 0.05, lambda _: True), (3, 2, 1))
        self.assertEqual(field.narrow_contacts([history], 0.2, lambda _: True), (4, 3, 2))


if __name__ == "__main__":
    unittest.main()
