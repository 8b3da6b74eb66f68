"""The command line and the counters of pillarfield-bench; no test checks a time."""

import json
import os
import re
import subprocess
import unittest

PROGRAM = os.environ["PILLARFIELD_BENCH"]


def run(*arguments, expect=0):
    """Runs the program; its exit status must be `expect`."""
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                            check=False)
    assert result.returncode == expect, (
        f"{arguments} ended with {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


def cases(pattern):
    """Cases of a short run whose name matches, by name, and the context."""
    report = json.loads(run(f"--benchmark_filter={pattern}", "--benchmark_format=json",
                            "--seconds=0.001").stdout)
    return {case["name"]: case for case in report["benchmarks"]}, report["context"]


class Cases(unittest.TestCase):
    def test_a_solve_has_its_time_and_its_copy_bandwidth_limit(self):
        found, _ = cases("^size/(1024|10000)$")
        self.assertEqual(set(found), {"size/1024", "size/10000"})
        for name, case in found.items():
            pillars = int(name.split("/")[1])
            self.assertEqual(case["pillars"], pillars)
            self.assertEqual(case["bytes_per_pillar"], 17)
            self.assertGreater(case["of_copy"], 0)
            self.assertGreater(case["copy_cached"], 0)
            self.assertGreater(case["copy_streaming"], 0)
            # real_time is that of a frame, in microseconds.
            self.assertAlmostEqual(case["real_time"] * 1e3 / pillars, case["ns_per_pillar"],
                                   delta=1e-3 * case["ns_per_pillar"])

    def test_limits(self):
        found, _ = cases("^limit/(empty_launch|copy/10000)$")
        copy = found["limit/copy/10000"]
        self.assertAlmostEqual(copy["ns_per_pillar"],
                               min(copy[key] for key in copy if key.startswith("copy_")))
        self.assertIn("p99_us", found["limit/empty_launch"])

    def test_latency(self):
        found, _ = cases("^latency/1024$")
        case = found["latency/1024"]
        self.assertLessEqual(case["median_us"], case["p99_us"])
        self.assertEqual(case["median_us"], case["host_median_us"])
        self.assertGreater(case["opencl_median_us"], 0)
        self.assertGreater(case["of_empty_launch"], 0)

    def test_a_baseline_is_compared(self):
        found, _ = cases("^baseline/paper_opencl$")
        case = found["baseline/paper_opencl"]
        self.assertNotIn("error_occurred", case)
        self.assertGreater(case["speedup"], 0)
        self.assertGreater(case["our_ns_per_pillar"], 0)

    def test_context_names_the_machine(self):
        _, context = cases("^limit/empty_launch$")
        for key in ("device", "driver", "compiler", "lanes", "num_cpus", "caches", "build"):
            self.assertIn(key, context)

    def test_all_groups_are_there(self):
        listed = run("--benchmark_list_tests=true").stdout
        names = {re.sub("/manual_time$", "", line) for line in listed.splitlines()}
        self.assertLessEqual({
            "limit/memcpy", "limit/copy/624100", "size/1024", "size/9998244",
            "contact/0.1/bare", "contact/100/all", "regions/worst", "type/f32",
            "lanes/16", "stage/none", "stage/all", "latency/6241",
            "throughput/shared/2", "throughput/staged/3", "baseline/paper_opencl",
            "field/mixed/contact_and_contacts", "field/slipping/direct_and_contacts"}, names)
        self.assertEqual(len(names), len(listed.splitlines()), "a name occurs twice")


class CommandLine(unittest.TestCase):
    def test_help(self):
        text = run("--help").stdout
        for word in ("--benchmark_filter", "--seconds", "--device", "baseline/"):
            self.assertIn(word, text)

    def test_unknown_arguments_are_refused(self):
        for arguments in (["--fast"], ["size/1024"], ["--seconds"], ["--seconds=soon"],
                          ["--seconds=0"], ["--seconds=-1"], ["--benchmark_speed=1"]):
            with self.subTest(arguments=arguments):
                result = run(*arguments, expect=2)
                self.assertEqual(result.stdout, "")
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_a_device_that_is_not_there(self):
        self.assertIn("abacus", run("--device=abacus", expect=1).stderr)

    def test_a_filter_without_cases(self):
        run("--benchmark_filter=^fly$", expect=1)


if __name__ == "__main__":
    unittest.main()
