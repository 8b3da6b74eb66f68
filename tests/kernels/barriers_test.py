"""No kernel returns before its last barrier: drivers may part a work-group there, even where all return alike."""

import os
import pathlib
import re
import sys
import unittest

KERNELS = pathlib.Path(os.environ["PILLARFIELD_SOURCE"], "kernels")
HEAD = re.compile(r"^(?:kernel|PF_INLINE|static)\b[^;{}]*?(\w+)\((?:[^(){};]|\([^()]*\))*\)\s*\{", re.MULTILINE)


def functions_of(text):
    """Name and body of each function; alternatives of one name each count."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
    return [(head[1], body_of(text[head.end():])) for head in HEAD.finditer(text)]


def body_of(text):
    """The text before the brace that closes a function whose first brace is open."""
    depth = 1
    for brace in re.finditer(r"[{}]", text):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return text[:brace.start()]
    return text


def early_returns(functions):
    """Names of functions that return before a barrier of theirs or of what they call."""
    waiting = {"barrier"}
    while True:
        wait = re.compile(r"\b(?:" + "|".join(waiting) + r")\s*\(")
        found = {name for name, body in functions if wait.search(body)}
        if found <= waiting:
            break
        waiting |= found
    early = []
    for name, body in functions:
        last = max((match.start() for match in wait.finditer(body)), default=0)
        first = re.search(r"\breturn\b", body)
        if first and first.start() < last and ";" in body[first.start():last]:
            early.append(name)
    return early


class Barriers(unittest.TestCase):
    def test_no_kernel_returns_before_its_last_barrier(self):
        functions = [function for path in sorted(KERNELS.rglob("*"))
                     if path.suffix in (".h", ".cl") for function in functions_of(path.read_text(encoding="utf-8"))]
        names = {name for name, _ in functions}
        self.assertLessEqual({"find_wires", "pack_results", "range_in_group", "sweep_tile"}, names)
        self.assertEqual(early_returns(functions), [])

    def test_no_macro_hides_a_barrier_or_a_return(self):
        for path in KERNELS.rglob("*.cl"):
            text = path.read_text(encoding="utf-8").replace("\\\n", " ")
            self.assertIsNone(re.search(r"^#define.*\bbarrier\b", text, re.MULTILINE), path)

    def test_an_early_return_is_found(self):
        wait = "PF_INLINE void wait(int n) {\n  barrier(CLK_LOCAL_MEM_FENCE);\n}\n"
        early = wait + "kernel void run(global int* a) {\n  if (a[0]) return;\n  wait(1);\n}\n"
        late = wait + "kernel void run(global int* a) {\n  wait(1);\n  if (a[0]) return;\n  a[0] = 1;\n}\n"
        self.assertEqual(early_returns(functions_of(early)), ["run"])
        self.assertEqual(early_returns(functions_of(late)), [])


if __name__ == "__main__":
    sys.exit(unittest.main())
