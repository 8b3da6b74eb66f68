"""mypy --strict passes on the package and the examples; stubtest holds the stub to the module."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile

try:
    import mypy.main
    import mypy.stubtest
except ImportError:
    print("skipped: mypy is not installed")
    sys.exit(0)

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])

# Classes of pybind11 have its metaclass, and those that only the package makes an __init__ that
# raises.
ALLOWED = r"""pillarfield(\._core)?\.[A-Z]\w+
pillarfield(\._core)?\.\w+\.__init__
pillarfield\.calibrate\._core\..*
"""


def run(call, arguments):
    """Status and output of a program of mypy."""
    output = io.StringIO()
    sys.argv = arguments
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
        try:
            status = call() or 0
        except SystemExit as end:
            status = end.code or 0
    if status:
        sys.exit(f"{' '.join(arguments)} ended with {status}:\n{output.getvalue()}")


def main():
    examples = sorted(str(path) for path in (SOURCE / "examples/python").glob("*.py"))
    assert examples
    os.environ["MYPYPATH"] = os.environ["PYTHONPATH"].split(":")[0]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("allowed").write_text(ALLOWED, encoding="ascii")
        pathlib.Path("mypy.ini").write_text("[mypy]\n[mypy-xarray,pandas]\nignore_missing_imports = True\n",
                                            encoding="ascii")  # They are optional.
        for what in (["-p", "pillarfield"], examples):
            run(mypy.main.main, ["mypy", "--strict", *what])
        run(mypy.stubtest.main, ["stubtest", "pillarfield", "--allowlist", "allowed",
                                 "--ignore-unused-allowlist"])


if __name__ == "__main__":
    main()
