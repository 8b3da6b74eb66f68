"""The project stays within its size, as `./dev count` measures it."""

import os
import re
import subprocess
import sys

SOURCE = os.environ["PILLARFIELD_SOURCE"]

# At most so many lines of code, and files of any kind.
LIMITS = {
    "core": 109700,
    "viewer": 26300,
    "laboratory": 8800,
    "all": 144700,
    "tests": 43900,
    "files": 1500,
}


def main():
    if not os.path.exists(f"{SOURCE}/.git"):
        print("skipped: not a checkout of git")
        return
    counted = subprocess.run([f"{SOURCE}/dev", "count"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^(\w+) +(\d+) lines, +(\d+) of tests, +(\d+) files$", counted, re.MULTILINE)
    found = {name: int(lines) for name, lines, _, _ in rows}
    found |= {"tests": int(rows[-1][2]), "files": int(rows[-1][3])}
    over = [f"{name}: {found[name]} exceed {limit}" for name, limit in LIMITS.items() if found[name] > limit]
    if over:
        sys.exit("\n".join([*over, "Delete what this change makes superfluous (CONTRIBUTING.md). To raise a limit in "
                            "tests/package/budget_test.py, say in CHANGELOG.md what is worth its lines."]))


if __name__ == "__main__":
    main()
