"""pillarfield.doctor."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Iterable
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._frames import Axes, Path, axis_words
from ._picture import Image, png_of
from ._recording import Recording, source_of
from ._scene import Simulation


@dataclasses.dataclass(frozen=True)
class ArrayFinding:
    """A fault of an array.

    fault: 'dead', 'stuck', 'dead column', 'shorted rows', ... (docs/command_line.md, Doctor)
    text: a sentence with the figure and the places
    figure: its meaning depends on the fault: per cent or counts
    sensels: (row, column) of each faulty sensel; lines: faulty rows or columns; both from 0
    order: lines as they lie, where they are wired in another order
    """

    fault: str
    text: str
    figure: float = 0.0
    sensels: list[tuple[int, int]] = dataclasses.field(default_factory=list)
    lines: list[int] = dataclasses.field(default_factory=list)
    order: list[int] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(frozen=True, repr=False)
class Diagnosis:
    """The result of doctor().

    findings: each fault; none: nothing wrong was found
    polarity: 'rises' or 'falls' under load, or 'unknown'
    layout: 'sensels', 'pillars' or 'unknown'
    idle_counts, noise_counts: reading without load and its noise, medians of the sensels
    rate_hz: frames per second; None without times
    contact_frames: frames with a contact; idle_frames: first frames without one, for tare_frames=
    untouched: (row, column) of the sensels that nothing tested
    facts: everything that `pillarfield doctor --json` prints, by its name
    """

    findings: list[ArrayFinding]
    polarity: str
    layout: str
    idle_counts: float
    noise_counts: float
    rate_hz: Optional[float]
    contact_frames: int
    idle_frames: int
    untouched: list[tuple[int, int]]
    facts: dict[str, Any]
    _pixels: Image = dataclasses.field(compare=False)

    def picture(self) -> bytes:
        """PNG of the array: the largest change of each sensel under load, counts, and the faults."""
        return png_of(self._pixels)

    _repr_png_ = picture

    def __repr__(self) -> str:
        facts = self.facts
        sensels = facts["rows"] * facts["cols"]
        texts = [f"\n  {finding.text}" for finding in self.findings] or ["\n  Nothing wrong was found."]
        return (f"<Diagnosis: {facts['frames']} frames of {facts['rows']} x {facts['cols']} sensels, "
                f"polarity {self.polarity}, noise {self.noise_counts:.3g} counts, "
                f"{sensels - len(self.untouched)} of {sensels} sensels tested{''.join(texts)}>")


def doctor(frames: Union[Path, npt.ArrayLike, Iterable[Any], Recording, Simulation], *,
           times: Optional[npt.ArrayLike] = None, rate_hz: Optional[float] = None,
           axes: Axes = "") -> Diagnosis:
    """Looks at frames of any pressure array and finds what is wrong with it.

    Sweep a finger over all of the array meanwhile, with moments without load.

    frames: as of solve(), with an iterator such as itertools.islice(pf.live(...), 500)
    times, rate_hz: of an array, or rate_hz of a file without times; without either there are no times
    axes: as of solve()

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
    if isinstance(frames, (str, os.PathLike)):
        name = os.fspath(frames)
        source = _core.FrameSource(frames, rate_hz=rate_hz, axes=axis_words(axes), untimed=rate_hz is None)
    else:
        if isinstance(frames, Iterable) and not (hasattr(frames, "__array__")
                                                 or isinstance(frames, (list, tuple, Simulation))):
            came = list(frames)
            if came and hasattr(came[0], "time_s"):
                times = [frame.time_s for frame in came]
            frames = [getattr(frame, "readings", frame) for frame in came]
        timed = isinstance(frames, (Recording, Simulation)) or times is not None or rate_hz is not None
        source = source_of(frames, None, times, rate_hz, axes=axes)
    text, pixels = _core.doctor(source, name, timed)
    facts = json.loads(text)
    return Diagnosis([_finding(each) for each in facts["findings"]], facts["polarity"], facts["layout"],
                     facts["idle_counts"], facts["noise_counts"]["median"], facts["rate_hz"],
                     facts["contact_frames"], facts["idle_frames"],
                     [(row, col) for row, col in facts["untouched"]], facts, pixels)


def _finding(fact: dict[str, Any]) -> ArrayFinding:
    """A finding from its facts."""
    sensels = [(row, col) for row, col in fact.get("sensels", [])]
    return ArrayFinding(fact["fault"], fact["text"], fact["figure"], sensels, fact.get("lines", []),
                        fact.get("order", []))
