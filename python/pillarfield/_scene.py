"""Scenes and their simulation."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import Error
from ._field import ForceField
from ._frames import Path, Readings, warn


@dataclasses.dataclass(frozen=True, repr=False)
class Simulation:
    """Simulated frames with their truth; solve() takes it.

    frames: readings, counts, uint8, uint16 or float32 [T, R, C]
    truth: true forces [T, P, Q]
    times: float64 [T], s
    skin, calibration: exact constants of the simulated sensor
    """

    scene: _core.Scene
    frames: Readings
    truth: ForceField
    times: npt.NDArray[np.float64]
    skin: _core.Skin
    calibration: _core.Calibration

    def __repr__(self) -> str:
        frames, rows, cols = self.frames.shape
        return f"<Simulation '{self.scene.title}': {frames} frames of {rows} x {cols} sensels>"


def scene(source: Union[Path, Mapping[str, Any], _core.Scene]) -> _core.Scene:
    """A scene from the path of a TOML file or from a dict of the same keys (docs/scenes.md).

    Raises Error for keys that no scene has; warns of former names.

    >>> import pillarfield as pf
    >>> pf.scene({"skin": {"pillars": [8, 12]}, "time": {"frames": 3}})
    <Scene '': 3 frames of 16 x 24 sensels>
    """
    if isinstance(source, _core.Scene):
        return source
    made = (_core.Scene.parse(_toml_table(source, ()), "scene") if isinstance(source, Mapping)
            else _core.Scene.load(source))
    warn(made.warnings)
    return made


def simulate(source: Union[Path, Mapping[str, Any], _core.Scene], *, frames: Optional[int] = None,
             seed: Optional[int] = None) -> Simulation:
    """Simulates a scene: frames of readings with exact truth.

    frames, seed: replace those of the scene. Python's lock is released meanwhile. Raises Error if
    the scene is wrong.
    """
    made = scene(source).replace(frames=frames, seed=seed)
    simulator = _core.Simulator(made)
    planes = simulator.render(0, made.frames)
    readings, times = planes.pop("frames"), planes.pop("times")
    return Simulation(made, readings, ForceField._of(planes, times, None, made.skin), times,
                      made.skin, simulator.calibration)


def _toml_table(table: Mapping[str, Any], path: tuple[str, ...]) -> str:
    """TOML text of a table: its values, then its tables."""
    values, tables = [], []
    for key, value in table.items():
        where = (*path, key)
        name = ".".join(json.dumps(part) for part in where)
        if isinstance(value, Mapping):
            tables.append(f"[{name}]\n{_toml_table(value, where)}")
        elif isinstance(value, (list, tuple)) and value and all(isinstance(one, Mapping) for one in value):
            tables += [f"[[{name}]]\n{_toml_table(entry, where)}" for entry in value]
        else:
            values.append(f"{json.dumps(key)} = {_toml_value(value, name)}\n")
    return "".join(values + tables)


def _toml_value(value: Any, name: str) -> str:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (bool, str)):
        return json.dumps(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml_value(entry, name) for entry in value)}]"
    raise Error("scene", f"{name} is of type {type(value).__name__}",
                "give numbers, words, lists and dicts")
