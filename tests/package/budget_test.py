"""The project stays within its size, as `./dev count` measures it, and comments begin with their subject."""

import os
import re
import subprocess
import sys

SOURCE = os.environ["PILLARFIELD_SOURCE"]

# At most so many lines of code, and files of any kind.
LIMITS = {
    "core": 110800,
    "viewer": 19500,
    "laboratory": 6400,
    "all": 136600,
    "tests": 40000,
    "files": 1330,
}

# A comment that lacks its subject.
WITHOUT_SUBJECT = re.compile(r"(///|//|/\*) (What|Whether|How|Of|Where|Which) ")


def check_size():
    counted = subprocess.run([f"{SOURCE}/dev", "count"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^(\w+) +(\d+) lines, +(\d+) of tests, +(\d+) files$", counted, re.MULTILINE)
    found = {name: int(lines) for name, lines, _, _ in rows}
    found |= {"tests": int(rows[-1][2]), "files": int(rows[-1][3])}
    over = [f"{name}: {found[name]} exceed {limit}" for name, limit in LIMITS.items() if found[name] > limit]
    if over:
        sys.exit("\n".join([*over, "Delete what this change makes superfluous (CONTRIBUTING.md). To raise a limit in "
                            "tests/package/budget_test.py, say in CHANGELOG.md what is worth its lines."]))


def check_comments():
    tracked = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z", "*.cpp", "*.h", "*.cl"], capture_output=True,
                             text=True, check=True).stdout
    found = []
    for name in filter(None, tracked.split("\0")):
        if os.path.exists(f"{SOURCE}/{name}"):
            with open(f"{SOURCE}/{name}", encoding="utf-8") as file:
                found += [f"{name}:{number}: {line.strip()}"
                          for number, line in enumerate(file, 1) if WITHOUT_SUBJECT.search(line)]
    if found:
        sys.exit("\n".join([*found, "A comment begins with its subject; see CONTRIBUTING.md."]))


def main():
    if not os.path.exists(f"{SOURCE}/.git"):
        print("skipped: not a checkout of git")
        return
    check_size()
    check_comments()


if __name__ == "__main__":
    main()
