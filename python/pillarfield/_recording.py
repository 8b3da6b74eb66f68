"""Files of frames and of forces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._field import ForceField
from ._frames import Axes, Path, Readings, axis_words


def range_of(frames: Union[int, slice], count: int) -> tuple[int, int, int]:
    """First index, step and number of the frames that an index or a slice takes of `count`."""
    chosen = range(count)[frames]
    if isinstance(chosen, int):
        return chosen, 1, 1
    return chosen.start, chosen.step, len(chosen)


class Recording:
    """Frames of a file of any format (docs/formats.md), read when they are indexed.

    recording[10] is a frame [R, C], recording[1000:2000:10] an array [T, R, C], of uint8, uint16 or
    float32 counts.

    trust: the file comes from your own programs, so it is not examined first
    dataset, times: names of the arrays of frames and times in an HDF5 file or .npz archive
    frame_size: (R, C) of frames that lie in one line of a table or array
    rate_hz: frames per second of a file without times
    tare_frames: number of first frames, of the unloaded skin, that give the tare; 0: none
    axes: order of the axes of an array, such as 'rows,columns,frames'; by default frames first

    Raises Error if it holds no frames, is damaged, or an option does not fit it.
    """

    def __init__(self, path: Path, *, trust: bool = False, dataset: str = "", times: str = "",
                 frame_size: Optional[tuple[int, int]] = None, rate_hz: Optional[float] = None,
                 tare_frames: int = 0, axes: Axes = "") -> None:
        self._source = _core.FrameSource.open(
            path, trust=trust, dataset=dataset, times=times, frame_size=frame_size,
            rate_hz=rate_hz, tare_frames=tare_frames, axes=axis_words(axes))

    @property
    def skin(self) -> _core.Skin:
        """Skin with the constants of the file."""
        return self._source.skin

    @property
    def calibration(self) -> _core.Calibration:
        """Planes of the file's calibration."""
        return self._source.calibration

    @property
    def times(self) -> npt.NDArray[np.float64]:
        """Times of all frames, float64 [T], s."""
        return self._source.times()

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the readings: uint8, uint16 or float32."""
        return np.dtype(self._source.sensel_type)

    @property
    def shape(self) -> tuple[int, int, int]:
        """(frames, sensel rows, sensel columns)."""
        return len(self), self.skin.rows, self.skin.cols

    @property
    def warnings(self) -> list[str]:
        """Warnings about the file, one sentence each."""
        return self._source.warnings

    @property
    def has_truth(self) -> bool:
        """Whether it is simulated and has its true forces."""
        return self._source.has_truth

    def truth(self, frames: Union[int, slice] = slice(None)) -> ForceField:
        """True forces of a frame or of a slice. Raises Error without truth."""
        chosen = range_of(frames, len(self))
        planes = self._source.read_truth(*chosen)
        times = self._source.times()[frames if isinstance(frames, slice) else slice(
            chosen[0], chosen[0] + 1)]
        field = ForceField._of(planes, times, None, self.skin)
        return field if isinstance(frames, slice) else field[0]

    def __len__(self) -> int:
        """The number of frames."""
        return len(self._source)

    def __getitem__(self, frames: Union[int, slice]) -> Readings:
        """Readings of a frame [R, C] or of a slice [T, R, C]."""
        readings = self._source.read(*range_of(frames, len(self)))
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


class ForceFile:
    """A file of forces, read when it is indexed.

    file[10] is the ForceField of a frame, file[1000:2000:10] that of several. trust: the file comes
    from your own programs, so it is not examined first. Raises Error if it is of another format, or
    damaged.
    """

    def __init__(self, path: Path, *, trust: bool = False) -> None:
        self._reader = _core.ForceReader(path, trust=trust)

    @property
    def skin(self) -> _core.Skin:
        """Skin, as far as the file tells: size, pitch and surface."""
        return self._reader.skin

    @property
    def estimator(self) -> str:
        """The estimator that solved it."""
        return self._reader.estimator

    @property
    def source(self) -> str:
        """Name of the file of frames."""
        return self._reader.source

    @property
    def warnings(self) -> list[str]:
        """Warnings about the file, one sentence each."""
        return self._reader.warnings

    def __len__(self) -> int:
        """The number of frames."""
        return len(self._reader)

    def __getitem__(self, frames: Union[int, slice]) -> ForceField:
        """Forces of a frame, planes [P, Q], or of a slice, [T, P, Q]."""
        planes = self._reader.read(*range_of(frames, len(self)))
        field = ForceField._of(planes, planes.pop("times"), planes.pop("contacts", None), self.skin,
                               self._reader.solved_by)
        return field if isinstance(frames, slice) else field[0]

    def __iter__(self) -> Iterator[ForceField]:
        """The frames."""
        return (self[frame] for frame in range(len(self)))

    def __repr__(self) -> str:
        rows, cols = self.skin.pillar_rows, self.skin.pillar_cols
        return f"<ForceFile: {len(self)} frames of {rows} x {cols} pillars, {self.estimator}>"


def open(path: Path, *, trust: bool = False) -> Union[Recording, ForceFile, _core.Calibration]:
    """Opens a file by its content: a Recording, a ForceFile or a Calibration.

    trust: it comes from your own programs, so it is not examined first.
    """
    kind = _core.kind_of(path)
    if kind == "calibration":
        return _core.Calibration.load(path, trust=trust)
    return ForceFile(path, trust=trust) if kind == "forces" else Recording(path, trust=trust)
