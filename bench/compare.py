#!/usr/bin/env python3
"""compare.py OLD NEW [FILTER]: ratios of time per pillar of two programs pillarfield-bench, new over old.

Ten pairs of runs in turns, A B B A ..., so that drift of the machine affects both; a row has the median ratio of a case."""

import json
import statistics
import subprocess
import sys

PAIRS = 10
# A small and a large skin, 1 % in contact, all stages, float readings, and latency.
FILTER = "^(size/10000|size/624100|contact/1/bare|contact/1/all|stage/all|type/f32|latency/6241)$"


def times(program, pattern):
    """Nanoseconds per pillar by case, of one run."""
    output = subprocess.run([program, f"--benchmark_filter={pattern}", "--benchmark_format=json", "--seconds=0.3"],
                            stdout=subprocess.PIPE, check=True).stdout
    return {case["name"]: case["ns_per_pillar"] for case in json.loads(output)["benchmarks"] if "ns_per_pillar" in case}


def main(old, new, pattern=FILTER):
    ratios = {}
    for pair in range(PAIRS):
        found = {program: times(program, pattern) for program in ((old, new) if pair % 2 == 0 else (new, old))}
        for name in found[old].keys() & found[new].keys():
            ratios.setdefault(name, []).append(found[new][name] / found[old][name])
    for name, found in sorted(ratios.items()):
        print(f"{name:28} {statistics.median(found):.3f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
