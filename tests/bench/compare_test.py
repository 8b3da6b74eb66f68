"""The statistics of bench/compare.py, on synthetic times."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(os.environ["PILLARFIELD_SOURCE"]) / "bench"
sys.path.insert(0, str(BENCH))

import compare  # noqa: E402  pylint: disable=wrong-import-position

# Prints a case whose time grows by 1 % of the first with each run.
PROGRAM = """#!/bin/sh
printf x >>"$0.runs"
runs=$(wc -c <"$0.runs")
echo '{"benchmarks": [{"name": "case", "run_type": "iteration", "ns_per_pillar": '$((%d * (100 + runs)))'}]}'
"""


class Order(unittest.TestCase):
    def test_pairs_alternate(self):
        self.assertEqual("".join(turn[0] for turn in compare.turns(4)), "onnoonno")


class Statistics(unittest.TestCase):
    def test_spread_is_that_of_the_deciles(self):
        self.assertEqual(compare.spread([i / 10 for i in range(11)]), (0.1, 0.5, 0.9))

    def test_one_wild_pair_of_twenty_changes_nothing(self):
        low, middle, high = compare.spread([0.9] * 19 + [50])
        self.assertEqual((low, middle, high), (0.9, 0.9, 0.9))

    def test_a_change_needs_both_deciles_on_one_side(self):
        self.assertEqual(compare.change(0.8, 0.99), "faster")
        self.assertEqual(compare.change(1.01, 1.2), "slower")
        self.assertEqual(compare.change(0.99, 1.2), "same")
        self.assertEqual(compare.change(0.8, 1.0), "same")

    def test_ratios_are_taken_within_pairs(self):
        # The machine slows down to a tenth; the new program takes 80 % of the time throughout.
        old = [{"case": 10.0 * slow} for slow in range(1, 11)]
        new = [{"case": 8.0 * slow} for slow in range(1, 11)]
        line = compare.compare(old, new)[1].split()
        self.assertEqual(line, ["case", "0.800", "0.800", "0.800", "0.800", "faster"])

    def test_cases_of_only_one_program_are_named(self):
        text = "\n".join(compare.compare([{"a": 1.0, "b": 1.0}] * 2, [{"b": 1.0, "c": 1.0}] * 2))
        self.assertRegex(text, r"a +only in the old program")
        self.assertRegex(text, r"c +only in the new program")
        self.assertRegex(text, r"b +1\.000 +1\.000 +1\.000 +1\.000  same")


class Reports(unittest.TestCase):
    def test_only_measured_cases_count(self):
        cases = [{"name": "a", "run_type": "iteration", "ns_per_pillar": 2.5},
                 {"name": "a_mean", "run_type": "aggregate", "ns_per_pillar": 2.5},
                 {"name": "limit/memcpy", "run_type": "iteration", "GB_per_s": 9},
                 {"name": "b", "run_type": "iteration", "error_occurred": True}]
        self.assertEqual(compare.times_of({"benchmarks": cases}), {"a": 2.5})


class Program(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        path.chmod(0o755)
        return path

    def compare(self, *arguments):
        return subprocess.run([sys.executable, BENCH / "compare.py", *map(str, arguments)],
                              capture_output=True, text=True, timeout=600, check=False)

    def test_runs_of_both_programs_are_interleaved(self):
        old = self.write("old", PROGRAM % 3)
        new = self.write("new", PROGRAM % 6)
        result = self.compare("--old", old, "--new", new, "--pairs", 4)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"case +2\.000 +2\.000 +2\.000 +2\.000  slower")
        self.assertEqual((self.folder / "old.runs").read_text(), "xxxx")
        self.assertEqual((self.folder / "new.runs").read_text(), "xxxx")

    def test_a_program_that_fails_ends_the_comparison(self):
        bad = self.write("bad", "#!/bin/sh\nexit 3\n")
        result = self.compare("--old", bad, "--new", bad)
        self.assertEqual(result.returncode, 1)
        self.assertIn("ended with 3", result.stderr)

    def test_one_pair_is_refused(self):
        self.assertEqual(self.compare("--old", "a", "--new", "b", "--pairs", 1).returncode, 2)


if __name__ == "__main__":
    unittest.main()
