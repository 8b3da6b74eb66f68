"""Steps that calibrate a skin, from frames of known loads (docs/calibration.md).

Frames are a path, readings [T, R, C], a Recording or a Simulation. `before` is a Calibration, its
path, or None for a new skin; each step returns a Step, whose calibration is the better one. Its facts
are those of `pillarfield calibrate --json`. A skin gives constants such as the full scale; by default
those of the file, or Skin(). `axes` is the order of the axes of arrays, and `file` columns, dataset, frame_size and
where of tables and arrays in files, as of solve().

>>> import numpy as np, pillarfield as pf
>>> unloaded = np.random.default_rng(1).normal(100, 1, (50, 16, 24)).round().astype(np.uint16)
>>> step = pf.calibrate.tare(unloaded)
>>> round(step.facts["tare_counts"])
100
"""

from __future__ import annotations

import dataclasses
import inspect
import json
import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _core
from ._error import ArgumentError
from ._frames import Axes, FileOptions, refuse_unknown, warn
from ._recording import source_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

Before = Union[_core.Calibration, str, "os.PathLike[str]", None]
Skin = Optional[_core.Skin]

__all__ = ["SenselFinding", "Step", "arm", "bending", "equilibrate", "faults", "leak", "load", "memory",
           "shear", "tare", "weight", "wires"]


@dataclasses.dataclass(frozen=True)
class SenselFinding:
    """A sensel that a step finds faulty or suspects.

    fault: 'stuck', 'noisy', 'saturated', ...
    masked: treated as missing from now on
    mean_counts: mean of its raw readings, counts
    """

    row: int
    col: int
    fault: str
    masked: bool
    mean_counts: float


@dataclasses.dataclass(frozen=True)
class Step:
    """The result of a step: the better calibration, and what was measured (docs/calibration.md)."""

    calibration: _core.Calibration
    facts: dict[str, Any]


def _run(step: str, all_frames: Iterable[Any], before: Before, skin: Skin, axes: Axes, file: FileOptions,
         **values: Any) -> Step:
    refuse_unknown(step, file, [*FileOptions.__annotations__, *inspect.signature(globals()[step]).parameters])
    sources = [source_of(frames, skin, axes=axes, untimed=step != "memory", **file)
               for frames in all_frames]
    if before is not None and not isinstance(before, _core.Calibration):
        before = _core.Calibration.load(before)
    given = {name.replace("_", "-"): value for name, value in values.items()}
    calibration, text, warnings = _core.calibrate(step, sources, before, given)
    warn(warnings)
    facts = json.loads(text)
    if "findings" in facts:
        facts["findings"] = [SenselFinding(**finding) for finding in facts["findings"]]
    return Step(calibration, facts)


def _pairs(known: Sequence[tuple[Any, Any]]) -> tuple[list[Any], list[Any]]:
    try:
        frames, values = zip(*known) if len(known) else ((), ())
    except (TypeError, ValueError):
        values = None
    if values is None or any(np.ndim(value) > 1 for value in values):
        raise ArgumentError("calibrate", "the known loads are not pairs",
                            "give a list of pairs of frames and load, such as [(frames, 25.0)]")
    return list(frames), list(values)


def tare(unloaded: Any, before: Before = None, *, skin: Skin = None, axes: Axes = "",
         threshold_factor: float = 4.0, preloaded: bool = False, **file: Unpack[FileOptions]) -> Step:
    """Tare and noise of each sensel on the unloaded skin; masks faulty sensels.

    threshold_factor: the threshold as a multiple of the noise. preloaded: accept what resembles a
    touch, and a tare much worse than that of `before`. Raises Error for fewer than 10 frames, or if
    something touches the skin in any of them.
    """
    return _run("tare", [unloaded], before, skin, axes, file, threshold_factor=threshold_factor,
                preloaded=preloaded)


def equilibrate(presses: Sequence[tuple[Any, float]], before: Before, *, skin: Skin = None,
                axes: Axes = "", model: Optional[str] = None, most_unevenness: float = 0.1,
                **file: Unpack[FileOptions]) -> Step:
    """Gains, dead zones and counts per newton from uniform pressures.

    presses: (frames, kPa) of each press. model: 'linear', 'curve', or None for the better one.
    most_unevenness: largest accepted relative deviation of the pressure from pillar to pillar.
    Raises Error if the pressure is not uniform, too low or too high.
    """
    frames, pressures_kpa = _pairs(presses)
    return _run("equilibrate", frames, before, skin, axes, file, pressure_kpa=pressures_kpa, model=model,
                max_unevenness=most_unevenness)


def load(loads: Sequence[tuple[Any, float]], before: Before, *, skin: Skin = None, axes: Axes = "",
         power: bool = False, **file: Unpack[FileOptions]) -> Step:
    """Counts per newton from bodies at rest with a known normal force.

    loads: (frames, N) of each load. power: fit a power law too, from two different loads. Raises
    Error if the frames show no contact or the loads do not determine the fit.
    """
    frames, loads_n = _pairs(loads)
    return _run("load", frames, before, skin, axes, file, load_n=loads_n,
                model="power" if power else "linear")


def weight(recordings: Sequence[tuple[Any, float]], before: Before, *, skin: Skin = None,
           axes: Axes = "", **file: Unpack[FileOptions]) -> Step:
    """Gains, a power law and newtons from a known weight that is placed or rolled anywhere.

    recordings: (frames, N) of each weight, on an array of sensels without pillars. Sensels that it
    did not visit are in facts["unvisited_sensels"]. Raises Error if frames or places are too few.
    """
    frames, weights_n = _pairs(recordings)
    return _run("weight", frames, before, skin, axes, file, load_n=weights_n)


def shear(loads: Sequence[tuple[Any, tuple[float, float]]], before: Before, *, skin: Skin = None,
          axes: Axes = "", normals_n: Optional[Sequence[float]] = None, **file: Unpack[FileOptions]) -> Step:
    """Shear coefficients from known tangential forces on the skin.

    loads: (frames, (x, y) in N) of each load. normals_n: their normal forces, N, if known.
    """
    frames, shears_n = _pairs(loads)
    return _run("shear", frames, before, skin, axes, file, shear_n=[n for pair in shears_n for n in pair],
                load_n=normals_n)


def faults(moving: Sequence[Any], before: Before, *, skin: Skin = None, axes: Axes = "",
           least_frames: int = 30, **file: Unpack[FileOptions]) -> Step:
    """Masks sensels that are dead, stuck or saturated while their pillars, or neighbours, move.

    moving: frames, one or more, of a skin touched everywhere. Raises Error if nothing moves.
    """
    return _run("faults", moving, before, skin, axes, file, min_frames=least_frames)


def leak(presses: Sequence[Any], before: Before, *, skin: Skin = None, axes: Axes = "",
         **file: Unpack[FileOptions]) -> Step:
    """Leaks between sensels and between pillars from a fine tip on single pillars."""
    return _run("leak", presses, before, skin, axes, file)


def memory(recordings: Sequence[tuple[Any, Sequence[float]]], before: Before, *, skin: Skin = None,
           axes: Axes = "", **file: Unpack[FileOptions]) -> Step:
    """Hysteresis and creep from a uniform pressure that rises, rests and falls.

    recordings: (frames, kPa of each frame), each after a rest.
    """
    frames, pressures_kpa = _pairs(recordings)
    return _run("memory", frames, before, skin, axes, file, pressure=pressures_kpa)


def bending(shapes: Sequence[tuple[Any, tuple[float, float]]], before: Before, *, skin: Skin = None,
            axes: Axes = "", **file: Unpack[FileOptions]) -> Step:
    """Change of the tare with bending, from the untouched skin on cylinders.

    shapes: (frames, (radius in mm, angle of the axis in degrees)) of each cylinder.
    """
    frames, cylinders = _pairs(shapes)
    return _run("bending", frames, before, skin, axes, file, radius_mm=[each[0] for each in cylinders],
                axis_deg=[each[1] for each in cylinders])


def arm(presses: Sequence[Any], before: Before, *, skin: Skin = None, axes: Axes = "",
        **file: Unpack[FileOptions]) -> Step:
    """Arm of off-centre pressure from bodies that press straight down."""
    return _run("arm", presses, before, skin, axes, file)


def wires(presses: Sequence[Any], before: Before, *, skin: Skin = None, axes: Axes = "",
          tile: tuple[int, int] = (64, 64), tares: Optional[str] = None, **file: Unpack[FileOptions]) -> Step:
    """Resistance of the wires from one body at rest, alone in the first frames.

    tile: rows and columns of sensels that share wires.
    tares: 'conduct' where unloaded sensels conduct, 'offset' where the converter adds the tare;
    None: as the frames show, or else 'conduct'.
    """
    return _run("wires", presses, before, skin, axes, file, tile_rows=tile[0], tile_cols=tile[1],
                tares=tares)
