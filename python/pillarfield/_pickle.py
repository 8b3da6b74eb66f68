"""Pickling, and so copying, of what files hold whole: calibrations, and how forces were solved."""

from __future__ import annotations

import copyreg
import pathlib
import tempfile
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _core


def _file(data: bytes, use: Callable[[pathlib.Path], Any]) -> tuple[Any, bytes]:
    """What `use` returns for the path of a file of these bytes, or of none, and its bytes after that."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "pickled.h5")
        if data:
            path.write_bytes(data)
        return use(path), path.read_bytes()


def _calibration(data: bytes) -> Any:
    return _file(data, lambda path: _core.Calibration.load(path, trust=True))[0]


def _solved_by(data: bytes) -> Any:
    return _file(data, lambda path: _core.ForceReader(path, trust=True).solved_by)[0]


def _reduce_calibration(calibration: _core.Calibration) -> tuple[Callable[[bytes], Any], tuple[bytes]]:
    return _calibration, (_file(b"", calibration.save)[1],)


def _reduce_solved_by(solved_by: Any) -> tuple[Callable[[bytes], Any], tuple[bytes]]:
    """It travels as a force file without frames."""
    skin = _core.Skin(2, 2, layout=solved_by.layout)
    names = ("normal",) if solved_by.layout == "sensels" else ("normal", "shear_x", "shear_y")
    planes = dict.fromkeys(names, np.zeros((0, 1, 1), np.float32))
    planes["status"] = np.zeros((0, 1, 1), np.uint8)
    return _solved_by, (_file(b"", lambda path: _core.save_forces(
        path, planes, [], [], skin, solved_by, False))[1],)


copyreg.pickle(_core.Calibration, _reduce_calibration)
copyreg.pickle(_core.SolvedBy, _reduce_solved_by)
