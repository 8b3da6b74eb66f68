"""Frames from what users have: paths, arrays, iterators, and the objects of this package."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Optional, TypedDict, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import ArgumentError, Error, FrameError

Readings = npt.NDArray[Any]
Path = Union[str, os.PathLike[str]]
Axes = Union[str, Iterable[str]]
Blocks = list[tuple[int, int, int, int]]


class FileOptions(TypedDict, total=False):
    """What pf.Recording() takes of plain data, at the doors that take frames (docs/python.md)."""

    columns: str
    dataset: str
    frame_size: Optional[tuple[int, int]]
    where: str


_TYPES = (np.uint8, np.uint16, np.float32)


def range_of(frames: Union[int, slice], count: int) -> tuple[int, int, int]:
    """First index, step and number of the frames that an index or a slice takes of `count`."""
    try:
        chosen = range(count)[frames]
    except IndexError:
        raise FrameError("frames", f"there are {count}, and none has the index {frames}",
                         f"give {-count} to {count - 1}" if count else "index none") from None
    except TypeError:
        raise ArgumentError("frames", f"{frames!r:.60} is not an index", "give a whole number or a slice") from None
    if isinstance(chosen, int):
        return chosen, 1, 1
    return chosen.start, chosen.step, len(chosen)


def is_files(frames: Any) -> bool:
    """Whether these are a path, or a list of paths, of files or folders."""
    if isinstance(frames, (list, tuple)):
        return len(frames) > 0 and all(isinstance(each, (str, os.PathLike)) for each in frames)
    return isinstance(frames, (str, os.PathLike))


def is_table(frames: Any) -> bool:
    """Whether this is a DataFrame, as of pandas."""
    return hasattr(frames, "to_csv") and hasattr(frames, "columns")


def refuse_unknown(function: str, given: Iterable[str], known: Iterable[str]) -> None:
    """Raises TypeError for an argument that the function does not have, and suggests another."""
    known = list(known)
    for name in given:
        if name not in known:
            other = {"units": "readings", "unit": "readings", "shape": "frame_size"}.get(name, "")
            hint = f"; did you mean '{other}'?" if other in known else _core.suggestion(name, known)
            raise TypeError(f"{function}() has no argument '{name}'{hint}")


def warn(sentences: Iterable[str]) -> None:
    """Warns by each sentence once, in the name of the line that called the package."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    for sentence in dict.fromkeys(sentences):
        warnings.warn(sentence, stacklevel=level)


def readings_of(frames: npt.ArrayLike, kind: Optional[str] = None) -> Readings:
    """Readings as a dense array of uint8, uint16 or float32; of type `kind` if given.

    Whole numbers of other types become uint16 if they fit, else float32; other numbers float32.
    What a masked array masks is missing: NaN.
    """
    if isinstance(frames, Mapping):
        raise Error("frames", f"they are a {type(frames).__name__} of {', '.join(map(repr, frames)):.60}",
                    "give one of its arrays")
    array = array_of(missing_as_nan(frames))
    if array.dtype.kind not in "uif":
        raise Error("frames", f"their type is {array.dtype}", "give counts")
    if kind is not None:
        wanted = np.dtype(kind)
        if not np.can_cast(array.dtype, wanted) and wanted.kind == "u":
            _require_range(array, int(np.iinfo(wanted).max), kind)
    elif array.dtype.newbyteorder("=") in _TYPES:
        wanted = array.dtype.newbyteorder("=")
    elif array.dtype.kind in "ui" and _lies_within(array, 65535):
        wanted = np.dtype(np.uint16)
    else:
        wanted = np.dtype(np.float32)
    return np.require(array, wanted, ["C", "A"])


def missing_as_nan(frames: npt.ArrayLike) -> npt.ArrayLike:
    """A masked array as float32 with NaN where it masks; others as they are."""
    if not isinstance(frames, np.ma.MaskedArray) or not np.any(frames.mask):
        return frames
    hidden: Any = frames.astype(np.float32)
    return np.asarray(hidden.filled(np.nan))


def array_of(frames: npt.ArrayLike) -> Readings:
    """An array; raises Error for frames that differ in size."""
    try:
        if isinstance(frames, (list, tuple)) and any(isinstance(each, np.ma.MaskedArray) for each in frames):
            stack: Any = np.ma.stack
            frames = missing_as_nan(stack(frames))
        return np.asarray(frames)
    except ValueError as error:
        raise Error("frames", "they differ in size", "give frames of one size") from error


def axis_words(axes: Axes) -> str:
    """The words of axes=, separated by commas."""
    return axes if isinstance(axes, str) else ",".join(axes)


def frames_first(frames: npt.ArrayLike, axes: Axes) -> npt.ArrayLike:
    """An array, whose axes `axes` names in order, as [frames, rows, columns] or [rows, columns]."""
    positions = _core.axis_positions(axis_words(axes))
    array: Any = frames if isinstance(frames, np.ma.MaskedArray) else array_of(frames)
    if array.ndim != len(positions):
        raise Error("frames", f"the array has {array.ndim} axes, and {len(positions)} are named",
                    "name each axis of the array, or leave out axes=")
    transposed: npt.ArrayLike = array.transpose(positions)
    return transposed


def _lies_within(array: Readings, most: int) -> bool:
    return array.size == 0 or (bool(array.min() >= 0) and bool(array.max() <= most))


def _require_range(array: Readings, most: int, kind: str) -> None:
    if array.dtype.kind == "f" or not _lies_within(array, most):
        raise Error("frames", f"their type is {array.dtype}, but the plan's is {kind}",
                    f"give whole numbers, 0..{most}, or plan with sensel_type='float32'")


def times_of(count: int, times: Optional[npt.ArrayLike], rate_hz: Optional[float]) -> npt.NDArray[np.float64]:
    """Times of frames, from given ones or from a rate."""
    if times is None:
        rate_hz = 100.0 if rate_hz is None else rate_hz
        if not rate_hz > 0:
            raise Error("frames", f"rate_hz is {rate_hz}", "give a rate above 0")
        return np.arange(count) / rate_hz
    given = np.asarray(times, np.float64)
    if given.shape != (count,):
        raise Error("frames", f"there are {given.size} times for {count} frames", "give one a frame")
    wrong = np.flatnonzero(~np.isfinite(given) | (np.diff(given, prepend=given[:1]) < 0))
    if wrong.size:
        raise Error("frames", f"frame {wrong[0]} has the time {given[wrong[0]]:g}",
                    "give finite times, s, that do not fall")
    return given


def timed(frames: Iterable[Any], kind: str,
          rate_hz: float) -> Iterator[tuple[Readings, float, Blocks]]:
    """Readings, time and blocks that did not arrive of each frame: an array or a Frame."""
    for index, frame in enumerate(frames):
        time_s = getattr(frame, "time_s", None)
        yield (readings_of(getattr(frame, "readings", frame), kind),
               index / rate_hz if time_s is None else time_s, getattr(frame, "missing", []))
