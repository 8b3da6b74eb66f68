#!/usr/bin/env python3
"""Whether one pillarfield-bench is faster than another.

    compare.py --old PROGRAM --new PROGRAM [--pairs N] [--seconds S] [FILTER]

Both run by turns, A B B A A B ..., so that a machine that grows slow in the meantime slows both.
For each row the ratio new / old of the nanoseconds per pillar is taken within each pair of runs,
and told as the median of all pairs with the tenth and the ninetieth percentile. A row is faster or
slower when these lie both on the same side of 1.
"""

import argparse
import json
import statistics
import subprocess
import sys

# The rows that matter: a small and a large skin, one touched and one bare, all stages, and latency.
FILTER = "^(size/10000|size/624100|contact/1/bare|contact/1/all|stage/all|type/f32|latency/6241)$"
PAIRS = 10


def turns(pairs):
    """The order of the runs: "old" or "new", two runs a pair, each pair the other way round."""
    order = []
    for pair in range(pairs):
        order += ["old", "new"] if pair % 2 == 0 else ["new", "old"]
    return order


def times_of(report):
    """Nanoseconds per pillar by row, of what a program printed as JSON."""
    return {row["name"]: row["ns_per_pillar"] for row in report["benchmarks"]
            if row.get("run_type") == "iteration" and "ns_per_pillar" in row}


def spread(ratios):
    """Tenth percentile, median and ninetieth of two ratios or more."""
    deciles = statistics.quantiles(ratios, n=10, method="inclusive")
    return deciles[0], statistics.median(ratios), deciles[-1]


def verdict(low, high):
    """What it means that most ratios new / old lie from `low` to `high`."""
    if high < 1:
        return "faster"
    return "slower" if low > 1 else "same"


def compare(old, new):
    """Lines of a table. `old` and `new` are dictionaries of times, one for each pair."""
    lines = [f"{'row':28} {'new / old':>10} {'10 % .. 90 %':>17}  the new one is"]
    common = [name for name in old[0] if name in new[0]]
    for name in common:
        ratios = [after[name] / before[name] for before, after in zip(old, new)]
        low, middle, high = spread(ratios)
        lines.append(f"{name:28} {middle:10.3f} {low:8.3f} {high:8.3f}  {verdict(low, high)}")
    for name in sorted(set(old[0]) ^ set(new[0])):
        lines.append(f"{name:28} only in the {'old' if name in old[0] else 'new'} one")
    return lines


def run(program, rows, seconds):
    """The times of one run of a program."""
    result = subprocess.run([program, f"--benchmark_filter={rows}", "--benchmark_format=json",
                             f"--seconds={seconds}"],
                            stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"compare.py: {program} ended with {result.returncode}")
    return times_of(json.loads(result.stdout))


def whole_number_from_2(text):
    """For argparse: percentiles take two pairs."""
    number = int(text)
    if number < 2:
        raise argparse.ArgumentTypeError("must be 2 or more")
    return number


def main():
    """Runs the programs and prints the table."""
    parser = argparse.ArgumentParser(
        description="Tells whether one pillarfield-bench is faster than another.")
    parser.add_argument("--old", required=True, metavar="PROGRAM")
    parser.add_argument("--new", required=True, metavar="PROGRAM")
    parser.add_argument("--pairs", type=whole_number_from_2, default=PAIRS, metavar="N",
                        help="runs of each program (default %(default)s)")
    parser.add_argument("--seconds", type=float, default=0.3, metavar="S",
                        help="least time of a row's race (default %(default)s)")
    parser.add_argument("filter", nargs="?", default=FILTER, help="rows (default '%(default)s')")
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
