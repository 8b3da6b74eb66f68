"""Files of frames and of forces, and frames in memory."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import Error
from ._field import ForceField
from ._frames import (Axes, FileOptions, Path, Readings, axis_words, frames_first, is_files, is_table, range_of,
                      readings_of, times_of, warn)
from ._scene import Simulation

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Recording(_core.FrameSource):
    """Frames of a file of any format (docs/formats.md), read when they are indexed.

    recording[10] is a frame [R, C], recording[1000:2000:10] an array [T, R, C], of uint8, uint16 or
    float32 counts.

    path: a file, a folder or a list of files: several are one source in order of their names
    trust: the file is your own, so its frames may have any size
    dataset, times: names of the arrays of frames and times in an HDF5 file or .npz archive
    frame_size: (R, C) of frames that lie in one line of a table or array
    columns: those of a table that are readings, by name or number from 1 on: 'pressure_*', '2-97'
    where: lines of a table that are read, those with this word in a column: 'side=L'
    readings: unit of the numbers, 'kPa', 'psi', 'N', ... or 'counts'; by default what the file states
    pitch_mm: distance between sensels, or (from row to row, from column to column), in place of the file's
    rate_hz: frames per second of a file without times
    tare_frames: number of first frames, of the unloaded skin, that give the tare; 0: none
    axes: order of the axes of an array, such as 'rows,columns,frames'; by default frames first
    layout: 'pillars' or 'sensels', in place of that of the file; plain data and Tekscan exports have
        'sensels'

    falling: readings fall under load; they are mirrored, 255 or 65535 less the reading, or negated

    Raises Error if it holds no frames, is damaged, or an option does not fit it.
    """

    def __init__(self, path: Union[Path, Sequence[Path]], *, trust: bool = False,
                 dataset: str = "", times: str = "",
                 frame_size: Optional[tuple[int, int]] = None, rate_hz: Optional[float] = None,
                 tare_frames: int = 0, axes: Axes = "", layout: str = "",
                 falling: bool = False, columns: str = "", where: str = "",
                 readings: str = "",
                 pitch_mm: Union[float, tuple[float, float], None] = None) -> None:
        super().__init__(
            path, trust=trust, dataset=dataset, times=times, frame_size=frame_size,
            rate_hz=rate_hz, tare_frames=tare_frames, axes=axis_words(axes),
            layout=layout, falling=falling, columns=columns, where=where,
            readings=readings, pitch_mm=pitch_mm)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the readings: uint8, uint16 or float32."""
        return np.dtype(self.sensel_type)

    @property
    def shape(self) -> tuple[int, int, int]:
        """(frames, sensel rows, sensel columns)."""
        return len(self), self.skin.rows, self.skin.cols

    def truth(self, frames: Union[int, slice] = slice(None)) -> ForceField:
        """True forces of a frame or of a slice. Raises Error without truth."""
        chosen = range_of(frames, len(self))
        planes = self.read_truth(*chosen)
        times = self.times[frames if isinstance(frames, slice) else slice(
            chosen[0], chosen[0] + 1)]
        field = ForceField._of(planes, times, None, self.skin)
        return field if isinstance(frames, slice) else field[0]

    def __getitem__(self, frames: Union[int, slice]) -> Readings:
        """Readings of a frame [R, C] or of a slice [T, R, C]."""
        readings = self.read(*range_of(frames, len(self)))
        return readings if isinstance(frames, slice) else np.asarray(readings[0])

    def __iter__(self) -> Iterator[Readings]:
        """The frames."""
        return (self[frame] for frame in range(len(self)))

    def __array__(self, dtype: npt.DTypeLike = None) -> Readings:
        """All readings."""
        return np.asarray(self[:], dtype)

    def __repr__(self) -> str:
        frames, rows, cols = self.shape
        return f"<Recording: {frames} frames of {rows} x {cols} sensels, {self.dtype}>"


class ForceFile(_core.ForceReader):
    """A file of forces, read when it is indexed.

    file[10] is the ForceField of a frame, file[1000:2000:10] that of several. trust: the file is
    your own, so its frames may have any size. Raises Error if it is of another format, or damaged.
    """

    def __getitem__(self, frames: Union[int, slice]) -> ForceField:
        """Forces of a frame, planes [P, Q], or of a slice, [T, P, Q]."""
        planes = self.read(*range_of(frames, len(self)))
        field = ForceField._of(planes, planes.pop("times"), planes.pop("contacts", None), self.skin,
                               self.solved_by)
        return field if isinstance(frames, slice) else field[0]

    def __iter__(self) -> Iterator[ForceField]:
        """The frames."""
        return (self[frame] for frame in range(len(self)))

    def __repr__(self) -> str:
        rows, cols = self.skin.element_rows, self.skin.element_cols
        return (f"<ForceFile: {len(self)} frames of {rows} x {cols} {self.skin.layout}, "
                f"{self.estimator}>")


def open(path: Path, *, trust: bool = False, readings: str = "") -> Union[Recording, ForceFile, _core.Calibration]:
    """Opens a file by its content: a Recording, a ForceFile or a Calibration.

    trust: it is your own, so its frames may have any size; readings: their unit, as of Recording
    """
    kind = "frames" if os.path.isdir(path) else _core.kind_of(path)
    if kind == "calibration":
        return _core.Calibration.load(path, trust=trust)
    return ForceFile(path, trust=trust) if kind == "forces" else Recording(path, trust=trust, readings=readings)


def save_recording(path: Path, frames: Any, *, skin: Optional[_core.Skin] = None,
                   times: Optional[npt.ArrayLike] = None, rate_hz: Optional[float] = None,
                   axes: Axes = "",
                   calibration: Optional[_core.Calibration] = None,
                   overwrite: bool = False) -> None:
    """Writes frames as a recording, for the viewer and the command line.

    frames: readings, counts, [T, R, C], or what solve() takes but iterators
    skin, times, rate_hz, axes, calibration: as in solve()
    overwrite: replace an existing recording. Raises Error if it cannot be written.
    """
    if is_files(frames) and (skin or calibration or times is not None):
        frames = Recording(frames, rate_hz=rate_hz if times is None else 1.0, axes=axes)
        rate_hz, axes = None, ""
    if isinstance(frames, Recording) and (skin or calibration or times is not None):
        skin, calibration = skin or frames.skin, calibration or frames.calibration
        times = frames.times if times is None else times
        frames = frames[:]
    source = source_of(frames, skin, times, rate_hz, calibration, axes)
    warn(_core.layout_warnings(source.skin))
    source.write(path, overwrite=overwrite)


def source_of(frames: Any, skin: Optional[_core.Skin] = None, times: Optional[npt.ArrayLike] = None,
              rate_hz: Optional[float] = None,
              calibration: Optional[_core.Calibration] = None,
              axes: Axes = "", falling: bool = False, untimed: bool = False, readings: str = "",
              pitch_mm: Union[float, tuple[float, float], None] = None, layout: str = "",
              **file: Unpack[FileOptions]) -> _core.FrameSource:
    """Frames with random access from a path, an array, a DataFrame, a Recording or a Simulation.

    axes, readings, pitch_mm, layout: of an array, or that of a path. untimed, file: of a path or a DataFrame; of an
    array the frame_size.
    """
    if is_table(frames):
        return _source_of_table(frames, rate_hz=rate_hz, axes=axes, falling=falling, untimed=untimed,
                                readings=readings, pitch_mm=pitch_mm, layout=layout, **file)
    if (is_files(frames) or isinstance(frames, Recording)) and times is not None:
        raise Error("times", "files have times of their own", "give times with an array")
    if is_files(frames):
        return _core.FrameSource(frames, rate_hz=rate_hz, axes=axis_words(axes), falling=falling,
                                 untimed=untimed, readings=readings, pitch_mm=pitch_mm,
                                 layout=layout, **file)
    is_array = not isinstance(frames, (Recording, Simulation))
    for name, value in file.items():
        if value and not (is_array and name == "frame_size"):
            raise Error(name, "it is of a file or a DataFrame",
                        "leave it out" if is_array else f"give {name} to pf.Recording()")
    if readings and isinstance(frames, (Recording, Simulation)):
        raise Error("readings", f"a {type(frames).__name__} has its unit", "give readings to pf.Recording()")
    if falling and isinstance(frames, (Recording, Simulation)):
        raise Error("falling", f"a {type(frames).__name__} has its readings already",
                    "give falling to pf.Recording()" if isinstance(frames, Recording) else "leave it out")
    if isinstance(frames, Recording):
        if rate_hz is not None:
            raise Error("rate_hz", "this Recording was opened without it", "give it to pf.Recording()")
        if axes:
            raise Error("axes", "a Recording has the axes frames, rows, columns",
                        "give axes to pf.Recording()")
        return frames
    if axes:
        if isinstance(frames, Simulation):
            raise Error("axes", "a Simulation has the axes frames, rows, columns", "leave it out")
        frames = frames_first(frames, axes)
    axes_are_known = bool(axes) or skin is not None or isinstance(frames, Simulation)
    if isinstance(frames, Simulation):
        skin, calibration = skin or frames.skin, calibration or frames.calibration
        times = frames.times if times is None else times
        frames = frames.frames
    array = readings_of(frames)
    size = file.get("frame_size")
    if size is not None:
        if array.ndim != 2 or array.shape[1] != size[0] * size[1]:
            raise Error("frames", f"the array has the shape {array.shape}",
                        f"give [frames, {size[0] * size[1]}], or leave out frame_size=")
        array = array.reshape(-1, *size)
    if array.ndim > 3 or not (axes_are_known or size):
        _core.require_frame_axes(array)
    if array.ndim not in (2, 3):
        raise Error("frames", f"the array has {array.ndim} axes",
                    "give [rows, cols] for a frame, [frames, rows, cols] for several")
    if array.ndim == 2:
        if not axes_are_known:
            _core.require_likely_frame(*array.shape, "frames")
        array = array.reshape(1, *array.shape)
    return _core.FrameSource.of_array(array, times_of(len(array), times, rate_hz),
                                      skin_of(skin, array.shape[-2:]), calibration,
                                      axes_are_known or size is not None, falling, readings, pitch_mm, layout)


def _source_of_table(frames: Any, *, axes: Axes, **options: Any) -> _core.FrameSource:
    """A DataFrame by the rules of tables in files; its index counts if it has a name or times."""
    names = [" ".join(map(str, name)) if isinstance(name, tuple) else str(name) for name in frames.columns]
    is_dated = type(frames.index).__name__ == "DatetimeIndex"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "frames.csv")
        frames.to_csv(path, header=names, index=is_dated or frames.index.name is not None,
                      index_label=frames.index.name or "time")
        try:
            return _core.FrameSource(path, axes=axis_words(axes), **options)
        except Error as error:
            raise Error("frames", error.failure, error.mend) from None


def skin_of(skin: Optional[_core.Skin], shape: tuple[int, ...]) -> _core.Skin:
    """The skin of frames of this shape; raises Error if a given one has another size."""
    if skin is None:
        return _core.Skin(*shape, layout="sensels")
    if (skin.rows, skin.cols) != shape:
        raise Error("frames", f"they are {shape[0]} x {shape[1]}",
                    f"the skin has {skin.rows} x {skin.cols} sensels")
    return skin
