"""Hardening of the programs, as readelf reports it. PILLARFIELD_PROGRAMS lists them, separated by colons."""

import os
import subprocess
import unittest

PROGRAMS = os.environ["PILLARFIELD_PROGRAMS"].split(":")


def readelf(option, program):
    return subprocess.run(["readelf", "--wide", option, program], capture_output=True, text=True,
                          check=True, env={**os.environ, "LC_ALL": "C"}).stdout


def search_paths(program):
    """The entries of RPATH and RUNPATH."""
    paths = []
    for line in readelf("--dynamic", program).splitlines():
        if "(RPATH)" in line or "(RUNPATH)" in line:
            paths += line[line.index("[") + 1:line.rindex("]")].split(":")
    return paths


class Hardening(unittest.TestCase):
    def for_each_program(self):
        self.assertTrue(PROGRAMS)
        for program in PROGRAMS:
            with self.subTest(program=program):
                yield program

    def test_no_library_comes_from_the_current_directory(self):
        # An empty entry means the current directory, a relative one a directory in it.
        for program in self.for_each_program():
            for path in search_paths(program):
                self.assertTrue(path.startswith(("/", "$ORIGIN")), f"'{path}' is searched")

    def test_addresses_are_random(self):
        for program in self.for_each_program():
            self.assertIn("DYN (", readelf("--file-header", program))

    def test_function_tables_are_read_only(self):
        for program in self.for_each_program():
            self.assertIn("GNU_RELRO", readelf("--program-headers", program))
            self.assertRegex(readelf("--dynamic", program), r"\b(BIND_NOW|NOW)\b")

    def test_no_stack_is_executable(self):
        for program in self.for_each_program():
            stack = [line for line in readelf("--program-headers", program).splitlines()
                     if "GNU_STACK" in line]
            self.assertEqual(len(stack), 1)
            self.assertNotIn("RWE", stack[0])

    def test_overruns_end_the_program(self):
        for program in self.for_each_program():
            symbols = readelf("--dyn-syms", program)
            self.assertIn("__stack_chk_fail", symbols)
            self.assertRegex(symbols, r"__\w+_chk\b")


if __name__ == "__main__":
    unittest.main()
