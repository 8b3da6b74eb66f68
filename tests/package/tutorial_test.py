"""The commands of docs/tutorial.md and docs/any_array.md work as printed, and say what the text says."""

import csv
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
PAGE = (SOURCE / "docs/tutorial.md").read_text()
PROGRAMS = pathlib.Path(os.environ["PILLARFIELD"]).parent
HAS_VIEWER = (PROGRAMS / "pillarfield-viewer").exists()


def blocks():
    """The commands, block by block."""
    for block in re.findall(r"^```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        yield block if HAS_VIEWER else re.sub(r"^pillarfield-viewer.*\n", "", block, flags=re.MULTILINE)


class Tutorial(unittest.TestCase):
    def test_its_commands_work_as_printed(self):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "scenes").symlink_to(SOURCE / "scenes")
        said = ""
        for block in blocks():
            done = subprocess.run(["bash", "-ec", block], cwd=WORK, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, env={**os.environ, "PATH": f"{PROGRAMS}:{os.environ['PATH']}"})
            self.assertEqual(done.returncode, 0, f"{block}{done.stdout}")
            said += done.stdout
        for pattern in (r"loaded +[\d,]+ +0\.002", r"Resultant force, N +326\.(8|79\d*) +0\.1[45]",
                     r"Contacts: 6 in all"):
            self.assertTrue(re.search(pattern, said), pattern)
        for picture in re.findall(r"\]\(pictures/tutorial/(.*?)\)", PAGE) if HAS_VIEWER else []:
            drawn, shown = (size(folder / picture) for folder in (WORK, SOURCE / "docs/pictures/tutorial"))
            self.assertEqual(drawn, shown, picture)
        shutil.rmtree(WORK)


class AnyArray(unittest.TestCase):
    def test_every_figure_of_the_page_is_that_of_its_script(self):
        page = (SOURCE / "docs/any_array.md").read_text()
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        script = page[page.index("## The pad of this page"):]
        subprocess.run([sys.executable, "-c", re.search(r"```python\n(.*?)```", script, re.DOTALL)[1]], cwd=WORK, check=True)
        said = ""
        for command in re.findall(r"(?:^    pillarfield |`)((?:doctor|calibrate|solve) [^`\n]*\.npy[^`\n]*)", page, re.MULTILINE):
            if "*" in command:
                continue
            done = subprocess.run([PROGRAMS / "pillarfield", *command.split()], cwd=WORK, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}")
            said += done.stdout
        said = {" ".join(line.split()) for line in said.splitlines()}
        for line in re.findall(r"^    (?!pillarfield)(.*\d.*)$", page[:page.index("```python")], re.MULTILINE):
            self.assertIn(" ".join(line.split()), said)
        with open(WORK / "totals.csv", newline="") as table:
            totals = [float(row["normal_n"]) for row in csv.DictReader(table) if row["row"] == "patch"]
        self.assertIn(f"at {len(totals)} places, comes out as {min(totals):.2f} to {max(totals):.2f} N", " ".join(page.split()))
        shutil.rmtree(WORK)


def size(picture):
    return struct.unpack(">II", picture.read_bytes()[16:24])


if __name__ == "__main__":
    unittest.main()
