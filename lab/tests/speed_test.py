"""lab/report/speed.py on synthetic runs of pillarfield-bench."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, f"{os.environ['PILLARFIELD_SOURCE']}/lab/report")

import page  # noqa: E402
import processors  # noqa: E402
import speed  # noqa: E402


def made_up(**rows):
    """A run with these counters by case; names have __ instead of /."""
    return speed.Bench("made_up.json", {
        "context": {"device": "none"},
        "benchmarks": [{"name": name.replace("__", "/"), **row} for name, row in rows.items()]})


class BenchTest(unittest.TestCase):
    def test_cases_have_counters(self):
        bench = made_up(size__1024={"ns_per_pillar": 1.5}, size__10000={"ns_per_pillar": 0.5},
                        stage__none={"ns_per_pillar": 0.25})
        self.assertEqual(bench.value("size/1024", "ns_per_pillar"), 1.5)
        self.assertEqual(bench.find("stage/none", "ns_per_pillar"), 0.25)
        self.assertEqual(bench.group("size"), ["size/1024", "size/10000"])

    def test_a_missing_case(self):
        bench = made_up(size__1024={"ns_per_pillar": 1.5})
        self.assertIsNone(bench.find("size/10000", "ns_per_pillar"))
        with self.assertRaisesRegex(page.Failure, "made_up.json: there is no case 'size/10000'; "
                                                  "measure again with ./dev report speed"):
            bench.value("size/10000", "ns_per_pillar")

    def test_a_missing_counter(self):
        bench = made_up(size__1024={"ns_per_pillar": 1.5})
        for read in (bench.value, bench.find):
            with self.assertRaisesRegex(page.Failure, "'size/1024' has no 'of_copy'"):
                read("size/1024", "of_copy")

    def test_a_skipped_case(self):
        bench = made_up(baseline__numpy={"error_occurred": True,
                                         "error_message": "skipped: no NumPy"},
                        size__1024={"ns_per_pillar": 1.5})
        self.assertEqual(bench.left_out("baseline/numpy"), "skipped: no NumPy")
        self.assertEqual(bench.left_out("size/1024"), "")
        self.assertIsNone(bench.find("baseline/numpy", "speedup"))
        with self.assertRaisesRegex(page.Failure, "no NumPy"):
            bench.value("baseline/numpy", "speedup")

    def test_files_that_are_not_runs(self):
        for measured in ([], {}, {"context": {}, "benchmarks": [{}]}):
            with self.assertRaisesRegex(page.Failure, "torn.json"):
                speed.Bench("torn.json", measured)
        with tempfile.TemporaryDirectory() as folder:
            torn = Path(folder, "torn.json")
            torn.write_text('{"context"', encoding="utf-8")
            for path in (torn, Path(folder, "absent.json")):
                with self.assertRaisesRegex(page.Failure, path.name):
                    page.load(path)


class Goals(unittest.TestCase):
    LIVE = {"missed": 0, "lost": 0}

    def goal(self, words, live=None, **rows):
        """The cell of the goal that contains these words."""
        kept = [{"goals": speed.goals(made_up(**rows), live or self.LIVE)}]
        (row,) = (row for row in speed.goal_rows(kept) if words in row[0])
        return row[2]

    def test_at_the_limit_and_below(self):
        for share, cell in ((0.95, "0.95"), (0.949, "**0.949**")):
            self.assertEqual(
                self.goal("10⁶", size__1000000={"of_copy": share, "ns_per_pillar": 1}), cell)

    def test_times_are_met_below_their_limit(self):
        self.assertEqual(self.goal("All stages", stage__all={"of_copy": 0.8}), "1.25")
        self.assertEqual(self.goal("All stages", stage__all={"of_copy": 0.75}), "**1.33**")

    def test_without_a_case(self):
        for row in list(speed.goal_rows([{"goals": speed.goals(made_up(), self.LIVE)}]))[:-1]:
            self.assertEqual(row[2:], ["–"], row[0])

    def test_other_processors_have_columns_of_their_own(self):
        here = speed.goals(made_up(stage__all={"of_copy": 0.8}), self.LIVE)
        kept = [{"goals": here}, {"goals": {what: 2 for what in here}}, {"goals": {"a former goal": 1}}]
        (row,) = (row for row in speed.goal_rows(kept) if "All stages" in row[0])
        self.assertEqual(row[2:], ["1.25", "**2**", "–"])

    def test_timings_are_compared_by_their_copies(self):
        # The machine was half as fast in the second timing.
        self.assertEqual(self.goal("1 % in contact",
                                   contact__100__bare={"ns_per_pillar": 1, "of_copy": 0.8},
                                   contact__1__bare={"ns_per_pillar": 0.4, "of_copy": 4}),
                         "0.2")

    def test_sizes_take_the_slowest_over_the_fastest(self):
        times = {99856: 0.5, 624100: 0.6, 1000000: 0.4, 9998244: 0.5}
        rows = {f"size__{size}": {"ns_per_pillar": time, "of_copy": 1}
                for size, time in times.items()}
        self.assertEqual(self.goal("10⁷", **rows), "**1.5**")

    def test_a_live_run_counts_missed_and_lost(self):
        self.assertEqual(self.goal("1 kHz"), "0")
        self.assertEqual(self.goal("1 kHz", {"missed": 2, "lost": 3}), "**5**")


class Processors(unittest.TestCase):
    def test_generations_of_one_name(self):
        for family, model, generation in ((25, 0x01, "Zen 3"), (25, 0x11, "Zen 4"), (25, 0xA0, "Zen 4"),
                                          (26, 2, "Zen 5"), (99, 1, "family 99 model 1")):
            self.assertEqual(processors.generation("AuthenticAMD", family, model), generation)
        self.assertEqual(processors.generation("GenuineIntel", 6, 207), "family 6 model 207")


class Texts(unittest.TestCase):
    def test_caches_of_data(self):
        caches = [{"type": kind, "level": level, "size": size << 10, "num_sharing": sharing}
                  for kind, level, size, sharing in (("Data", 1, 32, 1), ("Instruction", 1, 32, 1),
                                                     ("Unified", 3, 32 << 10, 2))]
        self.assertEqual(speed.caches_text(caches), "level 1: 32 KiB, level 3: 32 MiB for 2 cores")

    def test_latencies_of_dropped_frames(self):
        live = {"latency_ms": {"median": 0.5, "p99": None, "p99_9": None, "worst": 1.2}}
        self.assertEqual(list(speed.latencies(live).values()), ["0.500", "never", "never", "1.200"])


if __name__ == "__main__":
    unittest.main()
