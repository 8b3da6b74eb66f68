"""lab/report/speed_and_error.py on synthetic scores and times."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, f"{os.environ['PILLARFIELD_SOURCE']}/lab/report")

import speed  # noqa: E402
import speed_and_error as choices  # noqa: E402

SCORE = {"determined": [36.0, 4], "ambiguous": [64.0, 1]}
CASES = [{"name": f"choice/{known}/{way}", "over_bare": 2.0, "real_time": 500.0}
         for known in ("none", "calibrated", "sensor")
         for way in ("paper", "direct", "direct_and_deviations", "contact", "contact_and_deviations")]


def bench(load=0.1):
    return speed.Bench("test", {"context": {"num_cpus": 2, "date": "2026-01-02T03:04", "load_avg": [load]},
                                "benchmarks": CASES})


class Choices(unittest.TestCase):
    def test_errors_of_all_pillars_are_taken_together(self):
        self.assertEqual(choices.rms(SCORE, "determined"), 3)
        self.assertAlmostEqual(choices.error(SCORE), 20**0.5)

    def test_times_are_frames_a_second(self):
        self.assertEqual(choices.times(bench())["none/paper"], {"over_bare": 2, "frames_hz": 2000})

    def test_times_of_other_processors_are_kept_and_shown_last(self):
        with tempfile.TemporaryDirectory() as docs:
            other = pathlib.Path(docs, "measured/choices_a_b.json")
            other.parent.mkdir()
            found = {"processor": "A B", "cores": 4, "date": "", "load": 0,
                     "times": {"none/direct": {"over_bare": 3, "frames_hz": 7}}}
            other.write_text(json.dumps(found), encoding="utf-8")
            choices.keep_times(docs, bench())
            kept = choices.keep_times(docs, bench(0.2))
            self.assertEqual([one["load"] for one in kept], [0.2, 0])
            self.assertEqual(list(choices.time_cells(kept, "none/direct")),
                             ["2.0", "2000", "3.0", "7"])
            self.assertEqual(list(choices.time_cells(kept, "none/paper"))[2:], ["–", "–"])

    def test_every_way_has_a_row(self):
        measured = {"ideal": {"none": dict.fromkeys(choices.MARKERS, SCORE)},
                    "real": {known: dict.fromkeys(choices.MARKERS, SCORE)
                             for known in ("none", "calibrated", "sensor")}}
        kept = [{"times": choices.times(bench())}]
        rows = list(choices.choice_rows(measured, kept))
        self.assertEqual(len(rows), 12)
        self.assertEqual(rows[0][2:], ["4.47", "3.0", "3.00", "8.00", "2.0", "2000"])


if __name__ == "__main__":
    unittest.main()
