#!/usr/bin/env python3
"""Runs the command on mutants of valid files and checks how each run ends.

    fuzz/mutants.py --program build/release/bin/pillarfield [--count 10000] [--seed N] [--jobs 2]

Each mutant goes through `info` and `solve` (a scene also through `simulate`, since `solve` uses only its
sensor); with --more also through `compare`, `calibrate` or other outputs. A run passes if it ends within
5 s and 1 GB with status 0, or with status 1 and one line "pillarfield: ..." on standard error; prints no
other lines than warnings about the file and no control characters; and leaves no output after a failure,
no part after a success, and no process. With --twice, each successful solve runs again with different
bytes in fresh memory and must write the same file.

Mutants depend only on --seed and their number; --only N runs that one. Failing mutants are stored in
--keep with the command and its output. Exit status: 0, or 1 after a failure.
"""

import argparse
import collections
import multiprocessing
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile

import mutations

CORPUS = pathlib.Path(__file__).parent / "corpus"
KINDS = ("recording", "forces", "calibration", "tekscan", "scene", "plain")

MAX_SECONDS = 5
# Hard limit of a run. On a busy computer a run may exceed 5 s, so it is repeated up to twice and the
# fastest run counts.
KILLED_AFTER = 20
MAX_KILOBYTES = 1 << 20
# Limits that protect the computer from a runaway command.
MAX_WRITTEN = 512 << 20
MAX_ADDRESSES = 16 << 30

# Commands for each kind: IN is the mutant, GOOD a valid recording with truth, FORCES its forces, OUT an
# output of any extension.
COMMANDS = {
    "recording": ["info IN", "solve -q IN -o OUT"],
    "forces": ["info IN", "solve -q IN -o OUT"],
    "calibration": ["info IN", "solve -q GOOD --calibration IN -o OUT"],
    "tekscan": ["info IN", "solve -q IN -o OUT"],
    "plain": ["info IN", "solve -q IN -o OUT --rate 100",
              "solve -q IN -o OUT --rate 100 --shape 4x6"],
    "scene": ["info IN", "simulate -q IN -o OUT.h5", "solve -q GOOD --scene IN -o OUT"],
}
MORE = {
    "recording": ["compare FORCES IN", "calibrate tare -q IN -o OUT.h5", "info --json IN",
                  "solve -q IN -o OUT --contacts OUT.json --everything --noise 1"],
    "forces": ["compare IN GOOD", "info --json IN"],
    "calibration": ["calibrate tare -q GOOD --calibration IN -o OUT.h5", "info --json IN"],
    "tekscan": ["calibrate tare -q IN -o OUT.h5", "info --json IN"],
    "plain": ["calibrate tare -q IN -o OUT.h5", "info --json IN"],
    "scene": ["info --json IN"],
}
ENDINGS = (".h5", ".csv", ".npy")
# HDF5 files contain their creation time, so they are not compared.
ENDINGS_TO_COMPARE = (".csv", ".npy")

Run = collections.namedtuple("Run", "status signal seconds processor kilobytes output errors lives_on")


class Runner:
    """Runs the commands of one worker in a separate folder."""

    def __init__(self, options, good):
        self.options, self.good = options, good
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=options.scratch))
        self.out = self.folder / "out"
        self.child = 0
        for what, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_FSIZE, MAX_WRITTEN),
                           (resource.RLIMIT_AS, MAX_ADDRESSES)):
            resource.setrlimit(what, (most, most))
        signal.signal(signal.SIGALRM, self.kill)

    def kill(self, *_):
        try:
            os.killpg(self.child, signal.SIGKILL)
            return True
        except ProcessLookupError:
            return False

    def clear(self):
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir()

    def words_of(self, command, file, ending):
        names = {"IN": file, "GOOD": self.good / "good.h5", "FORCES": self.good / "forces.h5",
                 "OUT": self.out / f"out{ending}", "OUT.h5": self.out / "out.h5",
                 "OUT.json": self.out / "out.json"}
        return [str(names.get(word, word)) for word in command.split()]

    def run(self, words, **environment):
        self.clear()
        printed = [self.folder / "stdout", self.folder / "stderr"]
        actions = [(os.POSIX_SPAWN_OPEN, 0, "/dev/null", os.O_RDONLY, 0)]
        for number, path in enumerate(printed, 1):
            actions.append((os.POSIX_SPAWN_OPEN, number, path,
                            os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600))
        start = time.monotonic()
        program = str(self.options.program)
        self.child = os.posix_spawn(program, [program, *words],
                                    {**self.options.environment, **environment},
                                    file_actions=actions, setpgroup=0)
        signal.setitimer(signal.ITIMER_REAL, KILLED_AFTER)
        _, status, usage = os.wait4(self.child, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        seconds = time.monotonic() - start
        lives_on = self.kill()
        return Run(os.WEXITSTATUS(status) if os.WIFEXITED(status) else None,
                   os.WTERMSIG(status) if os.WIFSIGNALED(status) else None, seconds,
                   usage.ru_utime + usage.ru_stime, usage.ru_maxrss,
                   *(path.read_bytes() for path in printed), lives_on)

    def timed(self, words, **environment):
        """The run, or its fastest repetition if it exceeds the time limit."""
        for _ in range(3):
            run = self.run(words, **environment)
            if run.seconds <= MAX_SECONDS:
                break
        return run


def fault_of_text(run, file):
    """The fault in the printed text, or None."""
    if re.search(rb"[\x00-\x08\x0b-\x1f\x7f]", run.output + run.errors):
        return "prints control characters"
    lines = [line for line in run.errors.decode(errors="replace").split("\n") if line]
    errors = [line for line in lines if line.startswith("pillarfield: ")]
    if len(errors) != run.status:
        return f"{len(errors)} error lines with status {run.status}"
    if any(not line.startswith(("pillarfield: ", f"{file}: ")) and ": " not in line for line in lines):
        return "prints lines that are neither errors nor warnings"
    return None


def fault_of(run, file, left):
    """The fault of a run, or None."""
    if run.seconds > MAX_SECONDS:
        return f"over {MAX_SECONDS} s"
    if run.signal is not None:
        return f"killed by {signal.Signals(run.signal).name}"
    if run.kilobytes > MAX_KILOBYTES:
        return "over 1 GB"
    if run.status not in (0, 1):
        return f"status {run.status}"
    if run.lives_on:
        return "leaves a process"
    if run.status == 1 and left:
        return "leaves output after a failure"
    if any(name.endswith(".part") for name in left):
        return "leaves a part after a success"
    return fault_of_text(run, file)


def differs(runner, words):
    """Whether a second run, with different bytes in fresh memory, writes another file."""
    written = {path.name: path.read_bytes() for path in runner.out.iterdir()}
    runner.run(words, MALLOC_PERTURB_="85")
    again = {path.name: path.read_bytes() for path in runner.out.iterdir()}
    return written != again


def try_mutant(runner, number):
    """(kind, command, outcome, run, data, words) for each run of a mutant."""
    options = runner.options
    chance = random.Random(f"{options.seed}:{number}")
    kind = KINDS[number % len(KINDS)]
    seed = chance.choice(SEEDS[kind])
    data = mutations.mutant_of(chance, seed)
    file = runner.folder / f"mutant{pathlib.Path(seed.name).suffix}"
    file.write_bytes(data)
    ending = chance.choice(ENDINGS_TO_COMPARE if options.twice else ENDINGS)
    for command in COMMANDS[kind] + (MORE[kind] if options.more else []):
        words = runner.words_of(command, file, ending)
        run = runner.timed(words, MALLOC_PERTURB_="170")
        fault = fault_of(run, file, [path.name for path in runner.out.iterdir()])
        if options.twice and not fault and run.status == 0 and command.startswith("solve") \
                and differs(runner, words):
            fault = "writes what is not in the file"
        yield seed, command, fault or ("done" if run.status == 0 else "refused"), run, data, words


SEEDS = {}
RUNNER = None


def read_seeds():
    for kind in KINDS:
        with zipfile.ZipFile(CORPUS / f"{kind}.zip") as archive:
            names = sorted(name for name in archive.namelist() if name.startswith("seed_"))
            SEEDS[kind] = [mutations.Seed(kind, name, archive.read(name)) for name in names]


def start_worker(options, good):
    global RUNNER
    RUNNER = Runner(options, good)


def work(number):
    """Summary lines of a mutant; stores its failing runs."""
    results = []
    for seed, command, outcome, run, data, words in try_mutant(RUNNER, number):
        kept = None
        if outcome not in ("done", "refused"):
            folder = RUNNER.options.keep
            kept = folder / f"{number}_{seed.kind}_{re.sub(r'[^a-z0-9]+', '_', outcome.lower())}_{seed.name}"
            kept.write_bytes(data)
            with open(f"{kept}.txt", "ab") as report:
                report.write(f"{' '.join(words)}\n{outcome}; {run.seconds:.1f} s, "
                             f"{run.processor:.1f} s of processor time, {run.kilobytes} kB\n".encode())
                report.write(run.output[-2000:] + run.errors[-2000:])
        results.append((seed.kind, command, outcome, run.seconds, run.processor, run.kilobytes, kept))
    return results


def summary(results, seconds):
    table = collections.defaultdict(collections.Counter)
    cost = collections.defaultdict(list)
    for kind, command, outcome, took, processor, kilobytes, _ in results:
        table[kind, command][outcome] += 1
        cost[kind, command].append((took, processor, kilobytes))
    print(f"\n{'kind':<12} {'command':<42} {'done':>6} {'refused':>8} {'failed':>7} {'mean ms':>8} "
          f"{'CPU ms':>7} {'max s':>6} {'max MB':>7}")
    for (kind, command), counts in sorted(table.items()):
        took, processor, kilobytes = zip(*cost[kind, command])
        failed = sum(counts.values()) - counts["done"] - counts["refused"]
        print(f"{kind:<12} {command:<42} {counts['done']:>6} {counts['refused']:>8} {failed:>7} "
              f"{1000 * sum(took) / len(took):>8.0f} {1000 * sum(processor) / len(took):>7.0f} "
              f"{max(took):>6.1f} {max(kilobytes) / 1024:>7.0f}")
    failures = [result for result in results if result[-1]]
    groups = collections.Counter((kind, command, outcome) for kind, command, outcome, *_ in failures)
    for (kind, command, outcome), count in groups.most_common():
        example = next(r[-1] for r in failures if r[:3] == (kind, command, outcome))
        print(f"FAIL {count:>5}  {kind}: {command}: {outcome}\n            {example}")
    print(f"{len(results)} runs in {seconds:.0f} s, {len(failures)} failures")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=10000, help="mutants")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 32))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", type=int, help="run this mutant and no other")
    parser.add_argument("--more", action="store_true", help="compare, calibrate and other outputs too")
    parser.add_argument("--twice", action="store_true", help="compare two runs of each solve")
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("build/mutants"))
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.keep.mkdir(parents=True, exist_ok=True)
    shared_memory = pathlib.Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=shared_memory if shared_memory.is_dir() else None) as name:
        return run_all(options, pathlib.Path(name))


def run_all(options, scratch):
    options.scratch = scratch
    options.environment = {**os.environ, "POCL_CACHE_DIR": str(scratch / "pocl")}
    os.environ["POCL_CACHE_DIR"] = str(scratch / "pocl")
    read_seeds()
    good = next(seed for seed in SEEDS["recording"] if seed.name == "seed_old_slide.h5")
    (scratch / "good.h5").write_bytes(good.data)
    subprocess.run([options.program, "solve", "-q", scratch / "good.h5", "-o", scratch / "forces.h5"], check=True)
    numbers = range(options.count) if options.only is None else [options.only]
    print(f"{len(numbers)} mutants of {sum(map(len, SEEDS.values()))} seeds, --seed {options.seed}")
    results = []
    start = time.monotonic()
    with multiprocessing.Pool(options.jobs, start_worker, (options, scratch)) as pool:
        for of_mutant in pool.imap_unordered(work, numbers, chunksize=4):
            results += of_mutant
            for *_, kept in of_mutant:
                if kept:
                    print(kept, flush=True)
    return summary(results, time.monotonic() - start)


if __name__ == "__main__":
    sys.exit(main())
