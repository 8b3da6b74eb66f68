"""Doctests, exported names, objects without a value, and the manual's snippets."""

import ast
import contextlib
import doctest
import importlib
import inspect
import io
import os
import pathlib
import pkgutil
import re
import subprocess
import sys
import unittest

import pillarfield as pf

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])


def modules():
    names = [module.name for module in pkgutil.iter_modules(pf.__path__)]
    return [pf] + [importlib.import_module(f"pillarfield.{name}") for name in names]


def public(owner):
    return {name: value for name, value in vars(owner).items() if not name.startswith("_")}


class Documentation(unittest.TestCase):
    def test_doctests(self):
        tried = 0
        for module in modules():
            result = doctest.testmod(module)
            self.assertEqual(result.failed, 0, module)
            tried += result.attempted
        self.assertGreater(tried, 20)

    def test_the_manual_runs(self):
        """Each Python block of docs/python.md runs, in order, in one program."""
        blocks = re.findall(r"^```python\n(.*?)^```$", (SOURCE / "docs/python.md").read_text(),
                            re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 5)
        WORK.mkdir(parents=True, exist_ok=True)
        os.chdir(WORK)
        names = {"__name__": "manual"}
        for block in blocks:
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, "docs/python.md", "exec"), names)


class Names(unittest.TestCase):
    def test_an_object_without_a_value_raises(self):
        for cls in vars(pf._core).values():
            if not inspect.isclass(cls) or type(cls).__name__ != "pybind11_type":
                continue
            empty = cls.__new__(cls)
            for name, member in public(cls).items():
                if isinstance(member, property):
                    with self.assertRaises(TypeError, msg=f"{cls.__name__}.{name}"):
                        getattr(empty, name)

    def test_exports(self):
        for name in pf.__all__:
            self.assertTrue(hasattr(pf, name), name)
        undescribed = [name for name in pf.__all__ if not inspect.getdoc(getattr(pf, name))]
        self.assertEqual(undescribed, [])
        self.assertEqual(pf.__all__, sorted(pf.__all__, key=lambda name: (name[0].islower(), name)))


class Types(unittest.TestCase):
    def test_every_option_has_one(self):
        stub = ast.parse((pathlib.Path(pf.__file__).parent / "_core.pyi").read_text())
        options = next(each for each in stub.body if isinstance(each, ast.ClassDef) and each.name == "PlanOptions")
        typed = {each.target.id for each in options.body if isinstance(each, ast.AnnAssign)}
        self.assertEqual(typed, set(pf._core.plan_options) - {"skin", "calibration", "sensel_type"})

    def test_a_checker_sees_mistakes(self):
        if importlib.util.find_spec("mypy") is None:
            self.skipTest("no mypy")
        program = WORK / "mistakes.py"
        WORK.mkdir(parents=True, exist_ok=True)
        program.write_text("import pillarfield as pf\npf.solve('a.h5', friction=0.5)\n"
                           "pf.solve('a.h5', cuonts_per_newton=320)\npf.solve('a.h5', layout='round')\n")
        seen = subprocess.run([sys.executable, "-m", "mypy", "--follow-imports=silent",
                               "--enable-incomplete-feature=Unpack", f"--cache-dir={WORK}/mypy", program],
                              env={**os.environ, "MYPYPATH": str(pathlib.Path(pf.__file__).parents[1])},
                              text=True, stdout=subprocess.PIPE, cwd=WORK).stdout
        lines = re.findall(r"mistakes\.py:(\d+): error", seen)
        self.assertEqual(lines, ["3", "4"], seen)


if __name__ == "__main__":
    sys.exit(unittest.main())
