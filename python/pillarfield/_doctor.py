"""pillarfield.doctor."""

from __future__ import annotations

import dataclasses
import json
import os
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy.typing as npt

from . import _core
from ._frames import Axes, FileOptions, Path, is_files, is_table, refuse_unknown
from ._recording import Recording, source_of
from ._scene import Simulation

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclasses.dataclass(frozen=True)
class ArrayFinding:
    """A fault of an array (docs/command_line.md, Doctor).

    fault: 'dead', 'stuck', 'dead column', 'shorted rows', ...
    text: a sentence with the figure and the places
    sensels: (row, column) of each faulty sensel; lines: faulty rows or columns; both from 0
    """

    fault: str
    text: str
    sensels: list[tuple[int, int]]
    lines: list[int]


@dataclasses.dataclass(frozen=True, repr=False)
class Diagnosis:
    """The result of doctor().

    findings: each fault; none: nothing wrong was found
    polarity: 'rises' or 'falls' under load, or 'unknown'
    noise_counts, idle_counts: noise and reading without load, medians of the sensels
    rate_hz: frames per second; None without times
    facts: everything that `pillarfield doctor --json` prints, by its name
    """

    findings: list[ArrayFinding]
    polarity: str
    noise_counts: float
    idle_counts: float
    rate_hz: Optional[float]
    facts: dict[str, Any]

    def __repr__(self) -> str:
        facts = self.facts
        texts = [finding.text for finding in self.findings] or ["Nothing wrong was found."]
        return "\n  ".join([f"<Diagnosis: {facts['frames']} frames of {facts['rows']} x {facts['cols']} sensels, "
                            f"polarity {self.polarity}, noise {self.noise_counts:.3g} counts", *texts]) + ">"


def doctor(frames: Union[Path, npt.ArrayLike, Recording, Simulation], *,
           times: Optional[npt.ArrayLike] = None, rate_hz: Optional[float] = None,
           axes: Axes = "", readings: str = "", **file: Unpack[FileOptions]) -> Diagnosis:
    """Looks at frames of any pressure array, swept by a finger, and finds what is wrong with it.

    frames, axes: as of solve(), but no iterator
    file: columns, dataset, frame_size and where, as of solve()
    readings: unit of the numbers, as of solve(); the doctor judges the numbers as they are
    times, rate_hz: of an array, or rate_hz of a file without times; without either there are no times

    Raises Error for fewer than 10 frames and for frames of NaN alone.

    >>> import numpy as np, pillarfield as pf
    >>> row, col = np.mgrid[0:8, 0:12]
    >>> bells = [np.exp(-((row - t // 40)**2 + (col - t % 40 / 3)**2) / 2) for t in range(320)]
    >>> frames = 20 + 90 * np.array(bells) + np.random.default_rng(1).normal(0, 1, (320, 8, 12))
    >>> frames[:, 6, 1] = 77
    >>> found = pf.doctor(frames.round().astype(np.uint8), rate_hz=50)
    >>> found.polarity, [(each.fault, each.sensels) for each in found.findings]
    ('rises', [('stuck', [(6, 1)])])
    """
    name, timed = "frames", True
    refuse_unknown("doctor", file, FileOptions.__annotations__)
    if isinstance(frames, (str, os.PathLike)):
        name = os.fspath(frames)
    elif not is_table(frames) and not is_files(frames):
        timed = isinstance(frames, (Recording, Simulation)) or times is not None or rate_hz is not None
    judged = "counts" if is_table(frames) or is_files(frames) else ""
    source = source_of(frames, None, times, rate_hz, axes=axes, untimed=rate_hz is None, readings=judged, **file)
    facts = json.loads(_core.doctor(source, name, timed))
    findings = [ArrayFinding(each["fault"], each["text"], [(row, col) for row, col in each.get("sensels", [])],
                             each.get("lines", [])) for each in facts["findings"]]
    return Diagnosis(findings, facts["polarity"], facts["noise_counts"]["median"], facts["idle_counts"],
                     facts["rate_hz"], facts)
