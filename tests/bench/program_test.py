"""pillarfield-bench as a user starts it. No time is checked, only that rows say what they should."""

import json
import os
import re
import subprocess
import unittest

PROGRAM = os.environ["PILLARFIELD_BENCH"]


def run(*arguments, expect=0, **environment):
    """Runs the program; its exit status must be `expect`."""
    result = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=200,
                            check=False, env={**os.environ, **environment})
    assert result.returncode == expect, (
        f"{arguments} ended with {result.returncode}, not {expect}\n{result.stdout}{result.stderr}")
    return result


def rows(pattern, **environment):
    """What a short run reports of the rows that match, by name; and the context."""
    report = json.loads(run(f"--benchmark_filter={pattern}", "--benchmark_format=json",
                            "--seconds=0.001", **environment).stdout)
    return {row["name"]: row for row in report["benchmarks"]}, report["context"]


class Rows(unittest.TestCase):
    def test_a_solve_says_what_it_took_and_of_which_ceiling(self):
        found, _ = rows("^size/(1024|10000)$")
        self.assertEqual(set(found), {"size/1024", "size/10000"})
        for name, row in found.items():
            pillars = int(name.split("/")[1])
            self.assertEqual(row["pillars"], pillars)
            self.assertEqual(row["bytes_per_pillar"], 17)
            self.assertGreater(row["of_ceiling"], 0)
            self.assertGreater(row["copy_cached"], 0)
            self.assertGreater(row["copy_streaming"], 0)
            # The row's own time is that of a frame, in microseconds.
            self.assertAlmostEqual(row["real_time"] * 1e3 / pillars, row["ns_per_pillar"],
                                   delta=1e-3 * row["ns_per_pillar"])

    def test_ceilings(self):
        found, _ = rows("^ceiling/(empty_launch|copy/10000/none)$")
        copy = found["ceiling/copy/10000/none"]
        self.assertAlmostEqual(copy["ns_per_pillar"],
                               min(copy[key] for key in copy if key.startswith("copy_")))
        self.assertIn("p99_us", found["ceiling/empty_launch"])

    def test_latency(self):
        found, _ = rows("^latency/1024$")
        row = found["latency/1024"]
        self.assertLessEqual(row["median_us"], row["p99_us"])
        self.assertGreater(row["of_empty_launch"], 0)

    def test_an_opponent_is_compared(self):
        found, _ = rows("^opponent/cpp_one_thread$")
        row = found["opponent/cpp_one_thread"]
        self.assertNotIn("error_occurred", row)
        self.assertGreater(row["speedup"], 0)
        self.assertGreater(row["our_ns_per_pillar"], 0)

    def test_a_variant_says_its_error(self):
        row = rows("^variant/direct/float/u8/float32/none$")[0]["variant/direct/float/u8/float32/none"]
        self.assertAlmostEqual(row["error_over_bound"], 1, delta=0.005)
        self.assertGreater(row["error_pillars"], 200_000)
        self.assertGreater(row["error_counts_all_regions"], row["error_counts"])

    def test_numpy_agrees(self):
        found, _ = rows("^opponent/numpy$")
        row = found["opponent/numpy"]
        # Where it is left out, the row says what is missing.
        if row.get("error_occurred"):
            self.assertIn("python3-numpy", row["error_message"])
        else:
            self.assertGreater(row["speedup"], 0)

    def test_a_picture_is_drawn(self):
        found, _ = rows("^render/6241/top/(all|all_copied)$")
        self.assertEqual(len(found), 2)
        for row in found.values():
            # Where it is left out, the row says what is missing.
            if row.get("error_occurred"):
                self.assertRegex(row["error_message"], "^skipped: .+")
                continue
            self.assertAlmostEqual(row["ms"] * 1e6 / (1280 * 720), row["ns_per_pixel"],
                                   delta=1e-3 * row["ns_per_pixel"])
            self.assertGreater(row["processor_ms"], 0)
            self.assertGreater(row["of_clear_and_read"], 0)

    def test_pictures_without_vulkan_are_left_out(self):
        row = rows("^render/read_back$", VK_ICD_FILENAMES="/nothing.json",
                   VK_DRIVER_FILES="/nothing.json")[0]["render/read_back"]
        self.assertTrue(row["error_occurred"])
        self.assertRegex(row["error_message"], "^skipped: Vulkan: ")

    def test_context_names_the_machine(self):
        _, context = rows("^ceiling/empty_launch$")
        for key in ("device", "driver", "compiler", "lanes", "num_cpus", "caches", "build"):
            self.assertIn(key, context)

    def test_all_groups_are_there(self):
        listed = run("--benchmark_list_tests=true").stdout
        names = {re.sub("/manual_time$", "", line) for line in listed.splitlines()}
        self.assertLessEqual({
            "ceiling/memcpy", "ceiling/copy/624100/all", "size/1024", "size/9998244",
            "contact/0.1/bare", "contact/100/all", "regions/worst", "type/f32", "output/all",
            "estimator/paper", "lanes/16", "stage/none", "stage/all", "latency/6241",
            "throughput/shared/2", "throughput/staged/3", "opponent/paper_opencl",
            "opponent/vectorised", "opponent/numpy", "field/mixed/contact_and_contacts",
            "field/slipping/direct_and_contacts"}, names)
        self.assertEqual(len(names), len(listed.splitlines()), "a name stands twice")


class CommandLine(unittest.TestCase):
    def test_help(self):
        text = run("--help").stdout
        for word in ("--benchmark_filter", "--seconds", "--device", "opponent/"):
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

    def test_a_filter_without_rows(self):
        run("--benchmark_filter=^fly$", expect=1)


if __name__ == "__main__":
    unittest.main()
