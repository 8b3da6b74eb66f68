"""The commands of docs/tutorial.md work as printed, and say what the text says."""

import os
import pathlib
import re
import shutil
import struct
import subprocess
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


def size(picture):
    return struct.unpack(">II", picture.read_bytes()[16:24])


if __name__ == "__main__":
    unittest.main()
