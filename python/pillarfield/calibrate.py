"""Steps that calibrate a skin, from frames of known loads (docs/calibration.md).

Frames are a path, readings [T, R, C], a Recording or a Simulation. `before` is a Calibration, its
path, or None for a new skin; each step returns a Step, whose calibration is the better one. A skin
gives constants such as the full scale; by default those of the file, or Skin().

>>> import numpy as np, pillarfield as pf
>>> unloaded = np.random.default_rng(1).normal(100, 1, (50, 16, 24)).round().astype(np.uint16)
>>> step = pf.calibrate.tare(unloaded)
>>> round(step.facts["tare_counts"])
100
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable, Sequence
from typing import Any, Optional, Union

from . import _core
from ._error import Error
from ._recording import Recording
from ._scene import Simulation
from ._solve import source_of

Before = Union[_core.Calibration, str, "os.PathLike[str]", None]

__all__ = ["Step", "arm", "bending", "equilibrate", "faults", "leak", "load", "memory", "shear",
           "tare", "wires"]


@dataclasses.dataclass(frozen=True)
class Step:
    """The result of a step: the better calibration, and what was measured (docs/calibration.md)."""

    calibration: _core.Calibration
    facts: dict[str, Any]


def _sources(all_frames: Iterable[Any], skin: Optional[_core.Skin]) -> list[_core.FrameSource]:
    sources = [source_of(frames, skin) for frames in all_frames]
    if not sources:
        raise Error("calibrate", "there are no frames", "give some")
    return sources


def _calibration(before: Before, source: _core.FrameSource) -> _core.Calibration:
    if before is None:
        return _core.blank_calibration(source)
    return before if isinstance(before, _core.Calibration) else _core.Calibration.load(before)


def _pairs(known: Sequence[tuple[Any, Any]]) -> tuple[list[Any], list[Any]]:
    return [frames for frames, _ in known], [value for _, value in known]


def tare(unloaded: Any, before: Before = None, *, skin: Optional[_core.Skin] = None,
         threshold_factor: float = 4.0, preloaded: bool = False) -> Step:
    """Tare and noise of each sensel on the unloaded skin; masks faulty sensels.

    threshold_factor: the threshold as a multiple of the noise. preloaded: accept an area that reads
    far above the rest. Raises Error for fewer than 10 frames, or if something touches the skin.
    """
    source = source_of(unloaded, skin)
    return Step(*_core.tare(source, _calibration(before, source), threshold_factor, preloaded))


def equilibrate(presses: Sequence[tuple[Any, float]], before: Before, *,
                skin: Optional[_core.Skin] = None, model: Optional[str] = None,
                most_unevenness: float = 0.1) -> Step:
    """Gains, dead zones and counts per newton from uniform pressures.

    presses: (frames, kPa) of each press. model: 'linear', 'curve', or None for the better one.
    most_unevenness: largest accepted relative deviation of the pressure from pillar to pillar.
    Raises Error if the pressure is not uniform, too low or too high.
    """
    frames, pressures_kpa = _pairs(presses)
    sources = _sources(frames, skin)
    return Step(*_core.equilibrate(sources, pressures_kpa, _calibration(before, sources[0]), model,
                                   most_unevenness))


def load(loads: Sequence[tuple[Any, float]], before: Before, *, skin: Optional[_core.Skin] = None,
         power: bool = False) -> Step:
    """Counts per newton from bodies at rest with a known normal force.

    loads: (frames, N) of each load. power: fit a power law too, from two different loads. Raises
    Error if the frames show no contact or the loads do not determine the fit.
    """
    frames, loads_n = _pairs(loads)
    sources = _sources(frames, skin)
    return Step(*_core.load(sources, loads_n, _calibration(before, sources[0]), power))


def shear(loads: Sequence[tuple[Any, tuple[float, float]]], before: Before, *,
          skin: Optional[_core.Skin] = None, normals_n: Optional[Sequence[float]] = None) -> Step:
    """Shear coefficients from known tangential forces on the skin.

    loads: (frames, (x, y) in N) of each load. normals_n: their normal forces, N, if known.
    """
    frames, shears_n = _pairs(loads)
    sources = _sources(frames, skin)
    return Step(*_core.shear(sources, shears_n, _calibration(before, sources[0]), normals_n))


def faults(moving: Sequence[Any], before: Before, *, skin: Optional[_core.Skin] = None,
           least_frames: int = 30) -> Step:
    """Masks sensels that are dead, stuck or saturated while their pillars move.

    moving: frames, one or more, of a skin touched everywhere. Raises Error if nothing moves.
    """
    sources = _sources(moving, skin)
    return Step(*_core.faults(sources, _calibration(before, sources[0]), least_frames))


def leak(presses: Sequence[Any], before: Before, *, skin: Optional[_core.Skin] = None) -> Step:
    """Leaks between sensels and between pillars from a fine tip on single pillars."""
    sources = _sources(presses, skin)
    return Step(*_core.leak(sources, _calibration(before, sources[0])))


def memory(recordings: Sequence[tuple[Any, Sequence[float]]], before: Before, *,
           skin: Optional[_core.Skin] = None) -> Step:
    """Hysteresis and creep from a uniform pressure that rises, rests and falls.

    recordings: (frames, kPa of each frame), each after a rest.
    """
    frames, pressures_kpa = _pairs(recordings)
    sources = _sources(frames, skin)
    return Step(*_core.memory(sources, pressures_kpa, _calibration(before, sources[0])))


def bending(shapes: Sequence[tuple[Any, tuple[float, float]]], before: Before, *,
            skin: Optional[_core.Skin] = None) -> Step:
    """Change of the tare with bending, from the untouched skin on cylinders.

    shapes: (frames, (radius in mm, angle of the axis in degrees)) of each cylinder.
    """
    frames, cylinders = _pairs(shapes)
    sources = _sources(frames, skin)
    return Step(*_core.bending(sources, cylinders, _calibration(before, sources[0])))


def arm(presses: Sequence[Any], before: Before, *, skin: Optional[_core.Skin] = None) -> Step:
    """Arm of off-centre pressure from bodies that press straight down."""
    sources = _sources(presses, skin)
    return Step(*_core.arm(sources, _calibration(before, sources[0])))


def wires(presses: Sequence[Any], before: Before, *, skin: Optional[_core.Skin] = None,
          tile: tuple[int, int] = (64, 64), tares: Optional[str] = None) -> Step:
    """Resistance of the wires from one body at rest, alone in the first frames.

    tile: rows and columns of sensels that share wires.
    tares: 'conduct' where unloaded sensels conduct, 'offset' where the converter adds the tare;
    None: as the frames show, or else 'conduct'.
    """
    sources = _sources(presses, skin)
    return Step(*_core.wires(sources, _calibration(before, sources[0]), *tile, tares))
