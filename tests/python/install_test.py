"""pip builds and installs the package without network, and cmake --install puts it on the path."""

import os
import pathlib
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
TRY = ("import numpy, pillarfield; print(pillarfield.__file__, "
       "pillarfield.solve(numpy.full((8, 12), 32)).normal[0, 0])")


def run(*command, **environment):
    done = subprocess.run([str(word) for word in command], env={**ENVIRONMENT, **environment}, cwd=WORK,
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 0, f"{command} ended with {done.returncode}:\n{done.stdout}"
    return done.stdout


def main():
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    run(sys.executable, "-m", "venv", "--system-site-packages", "venv")
    files = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], capture_output=True, text=True,
                           check=True).stdout.split("\0")
    for file in filter(None, files):  # A copy: pip leaves files beside the sources.
        target = WORK / "source" / file
        if (SOURCE / file).is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / file, target)
    run("venv/bin/pip", "install", "--no-index", "--no-build-isolation", WORK / "source")
    printed = run("venv/bin/python", "-c", TRY)
    assert f"{WORK}/venv" in printed and printed.endswith("0.1\n"), printed

    run("cmake", "--install", os.environ["PILLARFIELD_BUILD"], "--prefix", WORK / "prefix",
        "--component", "python")
    (place,) = (WORK / "prefix").glob("lib/python3.*/site-packages")
    assert (place / "pillarfield/py.typed").exists()
    printed = run(sys.executable, "-c", TRY, PYTHONUSERBASE=str(WORK / "prefix"))  # Mostly ~/.local.
    assert str(place) in printed, printed


if __name__ == "__main__":
    main()
