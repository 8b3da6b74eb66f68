"""pillarfield.solve."""

from __future__ import annotations

import inspect
import itertools
import numbers
import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Optional, TypeGuard, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import ArgumentError, Error
from ._field import ForceField
from ._frames import Axes, Path, array_of, is_files, is_table, readings_of, refuse_unknown, timed, warn
from ._recording import ForceFile, Recording, skin_of, source_of
from ._scene import Simulation
from .calibrate import Step, tare

if TYPE_CHECKING:
    from typing_extensions import Unpack

_SCALE_ASSUMED = (f"The frames have no counts_per_newton; {_core.Skin(2, 2).counts_per_newton:g} "
                  "is assumed.")


def solve(frames: Union[Path, npt.ArrayLike, Iterable[Any], Recording, Simulation], *,
          skin: Optional[_core.Skin] = None,
          calibration: Union[_core.Calibration, Step, Path, None] = None, tare_frames: int = 0,
          times: Optional[npt.ArrayLike] = None, rate_hz: Optional[float] = None,
          axes: Axes = "", falling: bool = False, readings: str = "", columns: str = "", dataset: str = "",
          frame_size: Optional[tuple[int, int]] = None, where: str = "", contacts: bool = False, device: str = "",
          **options: Unpack[_core.PlanOptions]) -> ForceField:
    """Solves frames of readings into forces.

    frames: path of a recording or Tekscan export, of a folder of files, or a list of paths, which are
        one source in order of names; readings, counts, [T, R, C] or [R, C]; an iterator
        of arrays [R, C]; a DataFrame of pandas, read as a table in a file; a Recording or a Simulation
    skin: constants of the skin; by default those of the file, or Skin() for arrays, without pillars
    calibration: replaces that of the file; a step of pf.calibrate holds one
    tare_frames: the first frames, at least 20, are of the unloaded skin: tare, noise and threshold are
        measured in them
    times: of the frames of an array, s; by default from rate_hz
    rate_hz: frames per second of arrays and iterators, 100 by default, and of files without times
    axes: order of the axes of an array, such as 'rows,columns,frames' or ('rows', 'columns'); by
        default frames, rows, columns, and an array that more likely has another order is refused
    falling: readings fall under load; they are mirrored, 255 or 65535 less the reading, or negated
    columns, dataset, frame_size, where: of a file or a DataFrame, as of Recording(); frame_size also of an
        array [T, R * C]
    readings: unit of the numbers of an array or file, 'kPa', 'psi', 'mmHg', 'N/cm2', 'N', ... or 'counts';
        pressures need pitch_mm
    contacts: find and track the contacts too
    device: 'host', 'opencl', or an OpenCL device by its index or a part of its name; '': the host for
        small skins, else the best of OpenCL
    options: those of Plan: layout, pitch_mm, estimator, outputs, noise_counts, threshold_counts, ...

    Returns the forces of all frames, planes [T, R, C], or with pillars (layout='pillars')
    [T, R // 2, C // 2]; of a frame [R, C] one field. Arrays of
    uint8, uint16 and float32 with frames first are read in place; others are converted (docs/python.md). Python's lock
    is released meanwhile; Ctrl+C ends it. Raises Error if a file or an option is wrong; warns of constants
    that nothing gives and are assumed, counts_per_newton above all, and of an odd row or column.

    >>> import numpy as np, pillarfield as pf
    >>> frames = np.full((5, 8, 12), 32, np.uint8)
    >>> pf.solve(frames, counts_per_newton=320)
    <ForceField: 5 frames of 8 x 12 sensels, 0.1..0.1 N>
    >>> pf.solve(frames, counts_per_newton=320, layout="pillars")
    <ForceField: 5 frames of 4 x 6 pillars, 0.1..0.1 N, 0 % ambiguous>
    """
    settings = _known(options)
    calibration = _calibration_of(calibration)
    if isinstance(frames, Simulation):
        settings = {"scene": frames.scene, **settings}
        calibration = calibration or frames.calibration
    if _is_iterator(frames):
        if tare_frames:
            raise Error("tare_frames", "an iterator's frames come once",
                        "give calibration=pf.calibrate.tare(unloaded)")
        live_skin = getattr(frames, "skin", None)  # as a LiveSource has it
        given = _constants_given(skin, calibration, settings) | set(live_skin.stated if live_skin else [])
        _warn([_SCALE_ASSUMED], given)
        return _solve_iterator(frames, skin or live_skin, calibration, rate_hz or 100.0, falling, contacts,
                               device, settings)
    if isinstance(frames, (list, tuple)) and not is_files(frames):
        frames = array_of(frames)
    reads = is_files(frames) or is_table(frames) or bool(readings)
    source = source_of(frames, skin, times, rate_hz, axes=axes, falling=falling, readings=readings,
                       pitch_mm=settings.get("pitch_mm") if reads else None,
                       layout=settings.get("layout", "") if reads else "", columns=columns,
                       dataset=dataset, frame_size=frame_size, where=where)
    if readings not in ("", "counts"):
        if "counts_per_newton" in settings:
            raise Error("readings", "counts per newton are given, too", "leave out one of them")
        settings["counts_per_newton"] = source.skin.counts_per_newton
    if not isinstance(tare_frames, numbers.Integral):
        raise ArgumentError("tare_frames", f"it is {tare_frames!r:.60}", "give a whole number of frames")
    if tare_frames:
        if not 20 <= tare_frames < len(source):
            raise Error("tare_frames", f"{tare_frames} of {len(source)} frames cannot be the unloaded ones",
                        "give 20 or more, but fewer than there are")
        unloaded, before = source.read(0, 1, tare_frames), calibration or source.calibration
        try:
            calibration = tare(unloaded, before,
                               skin=skin.mirrored() if skin and falling else skin or source.skin).calibration
        except Error as error:
            raise Error("tare_frames", error.failure, error.mend.replace(
                "accept it with preloaded=True",
                "give calibration=pf.calibrate.tare(unloaded, preloaded=True)")) from None
    _warn(([_SCALE_ASSUMED] if source.format == "array" else []) + source.warnings,
          _constants_given(skin, calibration, settings))
    forces = _solve_source(source, skin or source.skin, calibration or source.calibration, contacts,
                           device, settings)
    if source.format == "array" and times is None and rate_hz is None and not settings.get("unrelated_frames"):
        warn(_unrelated(forces.normal))
    is_frame = getattr(frames, "ndim", 3) == 2 and frame_size is None and not is_table(frames)
    return forces[0] if is_frame else forces


def solve_to_file(frames: Union[Path, Recording], output: Path, *, first: int = 0, end: Optional[int] = None,
                  warm_up: Optional[int] = None, contacts: bool = False,
                  calibration: Union[_core.Calibration, Step, Path, None] = None, device: str = "",
                  overwrite: bool = False, **options: Unpack[_core.PlanOptions]) -> ForceFile:
    """Solves frames of a file into a file of forces, with one frame at a time in memory.

    frames: path of a file of frames, or a Recording of it
    output: path of the result, .h5
    first, end: the frames from `first`, 0 by default, to before `end`; by default all. Processes on any
        machines may solve ranges of one recording (docs/python.md)
    warm_up: frames before `first` that are solved first, for what frames leave to the next ones; by
        default 3 s, or 3 time constants of a followed baseline or of creep
    contacts: find and track the contacts too
    calibration, device, options: as in solve()
    overwrite: replace an output of any kind; results are replaced without it

    Returns the opened result. Raises Error if a file or an option is wrong.
    """
    settings = _known(options)
    source = frames if isinstance(frames, Recording) else Recording(frames)
    plan = _core.plan_of(source, source.skin, calibration=_calibration_of(calibration) or source.calibration,
                         **settings)
    warn(_core.allow_for_errors(plan, source))
    name = os.path.basename(frames) if isinstance(frames, (str, os.PathLike)) else "recording"
    _core.solve_to_file(source, plan, name, output, first, len(source) if end is None else end, warm_up,
                        contacts, device, overwrite)
    return ForceFile(output)


def _known(options: Mapping[str, Any]) -> dict[str, Any]:
    """The options; raises TypeError for an unknown one, and suggests another."""
    refuse_unknown("solve", options, [*_core.plan_options, *inspect.signature(solve).parameters])
    return dict(options)


def _unrelated(normal: npt.NDArray[Any]) -> list[str]:
    """A sentence if neighbouring frames have nothing in common: each has a small body, at other places."""
    largest = normal.max(axis=(1, 2), initial=0)
    touched = normal > np.maximum(largest / 2, 1e-9)[:, None, None]
    # Noise is everywhere, a body in one place.
    boxes = [touched.any(axis).cumsum(1).astype(bool) & touched.any(axis)[:, ::-1].cumsum(1).astype(bool)[:, ::-1]
             for axis in (1, 2)]
    area = boxes[0].mean(1) * boxes[1].mean(1)
    is_body = (area > 0) & (area < 0.25) & (largest > 0.2 * largest.max(initial=0))
    pairs = is_body[1:] & is_body[:-1]
    shared = (touched[1:] & touched[:-1]).any(axis=(1, 2))[pairs]
    if shared.size < 16 or shared.mean() > 0.6:
        return []
    return ["Neighbouring frames have nothing in common, as those of different pads; give unrelated_frames=True, so "
            "that nothing is carried over from frame to frame, or times=."]


def _calibration_of(given: Any) -> Optional[_core.Calibration]:
    """A calibration or None, from what solve() takes."""
    given = getattr(given, "calibration", given)
    if isinstance(given, (str, os.PathLike)):
        return _core.Calibration.load(given)
    if given is None or isinstance(given, _core.Calibration):
        return given
    raise Error("calibration", f"it is of the type {type(given).__name__}",
                "give a step such as pf.calibrate.tare(unloaded), a Calibration or its path")


def _constants_given(skin: Optional[_core.Skin], calibration: Optional[_core.Calibration],
                     options: dict[str, Any]) -> set[str]:
    """Names of the skin's constants that a skin, a calibration, a scene or options give."""
    names = {"sensel_pitch_mm", "counts_per_newton", "threshold_counts", "layout"}
    if "scene" in options:
        return names
    given = {name for name in names if getattr(calibration, name, None) is not None} | set(options)
    return given if skin is None else given | (names - {"layout"})


def _warn(sentences: Iterable[str], given: set[str]) -> None:
    """Warns by each sentence but those about constants that are given."""
    warn(sentence for sentence in sentences if not any(name in sentence for name in given))


def _is_iterator(frames: Any) -> TypeGuard[Iterable[Any]]:
    return (isinstance(frames, Iterable) and not hasattr(frames, "__array__") and not is_table(frames)
            and not isinstance(frames, (str, list, tuple, Mapping, os.PathLike, Simulation)))


def _solve_source(source: _core.FrameSource, skin: _core.Skin, calibration: Any, contacts: bool,
                  device: str, options: dict[str, Any]) -> ForceField:
    plan = _core.plan_of(source, skin, calibration=calibration, **options)
    if plan.skin.layout == "pillars" != source.skin.layout:
        warn(_core.layout_warnings(plan.skin) + _core.size_warnings(source.skin.rows, source.skin.cols))
    warn(_core.allow_for_errors(plan, source))
    planes = _core.solve_source(source, plan, contacts, device)
    return _field_of(planes, plan, source.has_truth or "scene" in options)


def _solve_iterator(frames: Iterable[Any], skin: Optional[_core.Skin], calibration: Any,
                    rate_hz: float, falling: bool, contacts: bool, device: str,
                    options: dict[str, Any]) -> ForceField:
    iterator = iter(frames)
    try:
        first = next(iterator)
    except StopIteration:
        raise Error("frames", "the iterator has none", "give at least one") from None
    readings = readings_of(getattr(first, "readings", first))
    if readings.ndim != 2:
        raise Error("frames", f"the iterator's array has {readings.ndim} axes",
                    "give frames [rows, cols]")
    options = {"frame_interval_s": 1 / rate_hz, **options}
    skin = skin_of(skin, readings.shape)
    plan = _core.Plan(skin.mirrored() if falling else skin, sensel_type=str(readings.dtype),
                      calibration=calibration, **options)
    if plan.skin.layout == "pillars":
        warn(_core.layout_warnings(plan.skin) + _core.size_warnings(*readings.shape))
    stream = timed(itertools.chain([first], iterator), str(readings.dtype), rate_hz)
    return _field_of(_core.solve_iterator(stream, plan, contacts, device, falling), plan, False)


def _field_of(planes: dict[str, Any], plan: _core.Plan, simulated: bool) -> ForceField:
    sentences = planes.pop("warnings")
    if not simulated:
        warn(sentences)
    return ForceField._of(planes, planes.pop("times"), planes.pop("contacts", None), plan.skin,
                          _core.SolvedBy(plan))
