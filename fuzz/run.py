#!/usr/bin/env python3
"""Fuzzes the readers and prints the findings; called by `./dev fuzz`.

    fuzz/run.py [TARGET] [SECONDS] [--programs build/fuzz/bin] [--findings build/fuzz/findings]

libFuzzer mutates the files of fuzz/corpus/TARGET.zip for SECONDS (60), through all crashes; without TARGET,
each target gets SECONDS. Inputs that reach new code are stored beside the findings for the next run.
Each failing input then runs again alone, and the symbolised stack of that run gives its owner: our code,
or libhdf5 (which a command first runs in a child process; SECURITY.md). One input per distinct failure
is stored and printed.

Exit status: 0, or 1 after a failure in our code.
"""

import argparse
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGETS = ("recording", "forces", "calibration", "tekscan", "scene", "plain", "packets")

# Above the 5 s and 1 GB of the commands, since sanitizers need more.
TIMEOUT_S = 15
MEMORY_MB = 2048
MAX_BYTES = 65536

ENVIRONMENT = {
    **os.environ,
    "ASAN_OPTIONS": "detect_leaks=0:handle_abort=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
}

OURS, HDF5, UNKNOWN = "our code", "libhdf5", "unknown place"

Finding = collections.namedtuple("Finding", "owner kind place caller file")


def memory_folder():
    """A scratch folder, in memory if possible, since each run writes and reads a file."""
    memory = pathlib.Path("/dev/shm")
    return tempfile.TemporaryDirectory(prefix="fuzz-", dir=memory if memory.is_dir() else None)


def fuzz(program, target, seconds, folders):
    """Runs libFuzzer, which writes its artifacts to folders["raw"]."""
    with zipfile.ZipFile(ROOT / "fuzz/corpus" / f"{target}.zip") as archive:
        archive.extractall(folders["seeds"])
    seeds = [folders["seeds"]]
    if target == "scene":
        seeds.append(ROOT / "scenes")
    command = [program, "-fork=1", "-print_funcs=0", "-ignore_crashes=1", "-ignore_timeouts=1", "-ignore_ooms=1",
               f"-max_total_time={seconds}", f"-timeout={TIMEOUT_S}",
               f"-rss_limit_mb={MEMORY_MB}", f"-max_len={MAX_BYTES}", "-detect_leaks=0",
               f"-artifact_prefix={folders['raw']}/", folders["grown"], *seeds]
    with open(folders["log"], "wb") as log:
        subprocess.run([str(word) for word in command], stdout=log, stderr=log, env=ENVIRONMENT,
                       check=False, cwd=folders["raw"])
    text = folders["log"].read_text(errors="replace")
    progress = re.findall(r"#(\d+): cov: (\d+)", text)
    if not progress:
        sys.exit(f"run.py: {target} did not start; see {folders['log']}")
    runs, coverage = progress[-1]
    return f"{int(runs):,} runs in {seconds} s, {coverage} edges reached"


def failure_of(program, artifact):
    """The output of the program for a failing input, or None if it succeeds."""
    command = [program, f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MB}", "-detect_leaks=0",
               f"-artifact_prefix={artifact.parent}/again-", artifact]
    # libhdf5 has no frame pointers, so stacks through it need the slow unwinder, which sometimes fails.
    slow = ":fast_unwind_on_malloc=0:fast_unwind_on_fatal=0:malloc_context_size=60"
    report = None
    for unwinder in (slow, ""):
        options = {**ENVIRONMENT, "ASAN_OPTIONS": ENVIRONMENT["ASAN_OPTIONS"] + unwinder}
        done = subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, env=options, check=False)
        if done.returncode == 0:
            break
        report = done.stderr.decode(errors="replace")
        if stacks_of(report):
            break
    return report


FRAME = re.compile(r"^\s+#\d+ 0x[0-9a-f]+ (?:in (?P<function>.+?) )?\(?(?P<place>/\S+?)"
                   r"(?:\+0x[0-9a-f]+\).*)?$")


def stacks_of(report):
    """The stacks of a report, each a list of (function, place)."""
    stacks = [[]]
    for line in report.splitlines():
        match = FRAME.match(line)
        if match:
            stacks[-1].append((match["function"] or "?", match["place"]))
        elif stacks[-1]:
            stacks.append([])
    return [stack for stack in stacks if stack]


def owner_of(place):
    if "libhdf5" in place:
        return HDF5
    if re.search(r"/(host|kernels|fuzz)/[^ ]*\.(cpp|h)", place):
        return OURS
    return None


def top_of(stack, owners=(OURS, HDF5)):
    """Owner and name of the topmost frame that belongs to `owners`, or None."""
    for function, place in stack:
        owner = owner_of(place)
        if owner in owners:
            where = re.sub(r"^.*/(host|kernels|fuzz)/", r"\1/", place) if owner == OURS else ""
            name = re.sub(r"pillarfield::|\(anonymous namespace\)::|\(.*|\[abi.*?\]", "", function)
            return owner, f"{name} {where}".strip()
    return None


def kind_of(report):
    for pattern in (r"ERROR: AddressSanitizer: ([\w-]+(?: allocation size)?)", r"runtime error: (.{1,80})",
                    r"ERROR: libFuzzer: ([\w-]+)"):
        match = re.search(pattern, report)
        if match:
            return match[1]
    return "a failure"


def classify(report):
    """Owner, kind and place of a failure, and our calling function. An access of libhdf5 beyond memory
    that our code allocated is ours."""
    kind = kind_of(report)
    stacks = stacks_of(report)
    tops = [top for top in map(top_of, stacks) if top]
    if not tops:
        return UNKNOWN, kind, "no frame of ours or of libhdf5", ""
    owner, place = tops[0]
    caller = (top_of(stacks[0], (OURS,)) or ("", ""))[1] if owner == HDF5 else ""
    if owner == HDF5 and re.search(r"overflow|underflow|use-after", kind) and len(tops) > 1:
        other, where = tops[1]
        if other == OURS:
            return OURS, kind, f"{place}, in memory of {where}", caller
    return owner, kind, place, caller


def collect(program, target, folders):
    """The distinct findings among the artifacts; stores one file of each."""
    found = {}
    for artifact in sorted(folders["raw"].iterdir()):
        if not re.match(r"(crash|timeout|oom|leak)-", artifact.name):
            continue
        report = failure_of(program, artifact)
        if report is None and not artifact.name.startswith("crash"):
            continue  # slow or large only after many inputs in one process
        owner, kind, place, caller = (classify(report) if report is not None
                                      else (UNKNOWN, "a crash", "not when run alone", ""))
        key = (owner, kind, place)
        if key in found:
            continue
        name = re.sub(r"\W+", "_", f"{target}_{owner}_{kind}_{place}")[:100] + "-" + artifact.name[-8:]
        kept = folders["findings"] / name
        kept.write_bytes(artifact.read_bytes())
        kept.with_name(kept.name + ".txt").write_text(report or "", errors="replace")
        found[key] = Finding(owner, kind, place, caller, kept)
    return list(found.values())


def run_target(target, options):
    program = (options.programs / f"fuzz_{target}").resolve()
    folders = {"findings": options.findings.resolve()}
    work = folders["findings"].parent / "work" / target
    folders.update(raw=work / "artifacts", grown=work / "corpus", seeds=work / "seeds", log=work / "log.txt")
    for name in ("findings", "raw", "grown"):
        folders[name].mkdir(parents=True, exist_ok=True)
    for old in folders["raw"].iterdir():
        old.unlink()
    print(f"{target}: ", end="", flush=True)
    print(fuzz(program, target, options.seconds, folders), flush=True)
    findings = collect(program, target, folders)
    for finding in sorted(findings):
        called = f", called by {finding.caller}" if finding.caller else ""
        print(f"  {finding.owner}: {finding.kind}: {finding.place}{called}\n    {finding.file}",
              flush=True)
    return findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("target", nargs="?", help=", ".join(TARGETS) + "; all without one")
    parser.add_argument("seconds", nargs="?", type=int, default=60)
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/fuzz/bin")
    parser.add_argument("--findings", type=pathlib.Path, default=ROOT / "build/fuzz/findings")
    options = parser.parse_args()
    if options.target and options.target.isdecimal():
        options.target, options.seconds = None, int(options.target)
    if options.target and options.target not in TARGETS:
        parser.error(f"'{options.target}' is not a target; there are {', '.join(TARGETS)}")
    count = collections.Counter()
    with memory_folder() as folder:
        ENVIRONMENT["TMPDIR"] = folder
        for target in [options.target] if options.target else TARGETS:
            count.update(finding.owner for finding in run_target(target, options))
    ours = count[OURS] + count[UNKNOWN]
    print(f"{ours} distinct findings in our code, {count[HDF5]} within libhdf5")
    return 1 if ours else 0


if __name__ == "__main__":
    sys.exit(main())
