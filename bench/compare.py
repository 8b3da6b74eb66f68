#!/usr/bin/env python3
"""Compares the speed of two programs pillarfield-bench.

    compare.py --old PROGRAM --new PROGRAM [--pairs N] [--seconds S] [FILTER]

Runs are interleaved, A B B A A B ..., so that drift of the machine affects both programs. For each
case the table gives the ratio new / old of the nanoseconds per pillar within a pair of runs, median
and deciles over all pairs, and the ratio of the quickest runs, which other work on the machine
disturbs least. A case is faster or slower when both deciles lie on one side of 1.
"""

import argparse
import json
import statistics
import subprocess
import sys

# A small and a large skin, 1 % in contact, all stages, float readings, and latency.
FILTER = "^(size/10000|size/624100|contact/1/bare|contact/1/all|stage/all|type/f32|latency/6241)$"
PAIRS = 10


def turns(pairs):
    """Order of the runs, "old" or "new": two runs a pair, reversed from pair to pair."""
    order = []
    for pair in range(pairs):
        order += ["old", "new"] if pair % 2 == 0 else ["new", "old"]
    return order


def times_of(report):
    """Nanoseconds per pillar by case, from a program's JSON report."""
    return {case["name"]: case["ns_per_pillar"] for case in report["benchmarks"]
            if case.get("run_type") == "iteration" and "ns_per_pillar" in case}


def spread(ratios):
    """First decile, median and last decile of two or more ratios."""
    deciles = statistics.quantiles(ratios, n=10, method="inclusive")
    return deciles[0], statistics.median(ratios), deciles[-1]


def change(low, high):
    """Whether the new program is faster, from the deciles of new / old."""
    if high < 1:
        return "faster"
    return "slower" if low > 1 else "same"


def compare(old, new):
    """Lines of the table. `old` and `new` hold the times of each pair."""
    lines = [f"{'case':28} {'new / old':>10} {'10 % .. 90 %':>17} {'quickest':>9}  new program"]
    common = [name for name in old[0] if name in new[0]]
    for name in common:
        ratios = [after[name] / before[name] for before, after in zip(old, new)]
        low, middle, high = spread(ratios)
        quickest = min(after[name] for after in new) / min(before[name] for before in old)
        lines.append(f"{name:28} {middle:10.3f} {low:8.3f} {high:8.3f} {quickest:9.3f}  "
                     f"{change(low, high)}")
    for name in sorted(set(old[0]) ^ set(new[0])):
        lines.append(f"{name:28} only in the {'old' if name in old[0] else 'new'} program")
    return lines


def run(program, pattern, seconds):
    """Times of one run of a program."""
    result = subprocess.run([program, f"--benchmark_filter={pattern}", "--benchmark_format=json",
                             f"--seconds={seconds}"],
                            stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"compare.py: {program} ended with {result.returncode}")
    return times_of(json.loads(result.stdout))


def whole_number_from_2(text):
    """For argparse: deciles need two pairs."""
    number = int(text)
    if number < 2:
        raise argparse.ArgumentTypeError("must be 2 or more")
    return number


def main():
    """Runs the programs and prints the table."""
    parser = argparse.ArgumentParser(
        description="Compares the speed of two programs pillarfield-bench.")
    parser.add_argument("--old", required=True, metavar="PROGRAM")
    parser.add_argument("--new", required=True, metavar="PROGRAM")
    parser.add_argument("--pairs", type=whole_number_from_2, default=PAIRS, metavar="N",
                        help="runs of each program (default %(default)s)")
    parser.add_argument("--seconds", type=float, default=0.3, metavar="S",
                        help="minimum time of a case (default %(default)s)")
    parser.add_argument("filter", nargs="?", default=FILTER, help="cases (default '%(default)s')")
    arguments = parser.parse_args()

    programs = {"old": arguments.old, "new": arguments.new}
    times = {"old": [], "new": []}
    order = turns(arguments.pairs)
    for number, which in enumerate(order, 1):
        if sys.stderr.isatty():
            print(f"run {number} of {len(order)}", end="\r", file=sys.stderr, flush=True)
        times[which].append(run(programs[which], arguments.filter, arguments.seconds))
    print("\n".join(compare(times["old"], times["new"])))


if __name__ == "__main__":
    main()
