"""Live sources of frames and live sinks of forces (docs/streams.md)."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from types import TracebackType
from typing import Any, Optional, Union

import numpy as np

from . import _core
from ._error import Error
from ._field import ForceField
from ._frames import Readings, warn


Pitch = Union[None, float, tuple[float, float]]


@dataclasses.dataclass(frozen=True)
class Frame:
    """A frame of a live source.

    readings: counts, uint8, uint16 or float32 [R, C]
    time_s: time of the sensor, s
    sequence: its number; a gap means lost frames
    missing: (first_row, rows, first_col, cols) of sensels whose readings did not arrive
    """

    readings: Readings
    time_s: float
    sequence: int
    missing: list[tuple[int, int, int, int]]


class LiveSource(_core.LiveFrames):
    """Frames of a sensor as they come, an iterator of Frame; live() opens one."""

    def __init__(self, source: str, *, skin: Optional[_core.Skin] = None,
                 serial_baud: int = 2_000_000, layout: str = "", pitch_mm: Pitch = None,
                 falling: bool = False, timeout: Optional[float] = None) -> None:
        if timeout is not None and not timeout >= 0:
            raise Error("timeout", f"it is {timeout}", "give seconds, or None to wait without end")
        super().__init__(source, skin, serial_baud, layout, pitch_mm, falling, timeout)
        warn(self.notes)

    def receive(self, timeout_s: float) -> Optional[Frame]:
        """The next frame, or None if none comes in time; raises StopIteration at the end."""
        item = self.next(timeout_s)
        return None if item is None else Frame(*item)

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        frame = self.receive(math.inf)
        assert frame is not None
        return frame

    def __enter__(self) -> LiveSource:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()


def live(source: str, *, skin: Optional[_core.Skin] = None, serial_baud: int = 2_000_000,
         layout: str = "", pitch_mm: Pitch = None, falling: bool = False,
         timeout: Optional[float] = None) -> LiveSource:
    """Opens a live source and waits for its first frame; Ctrl+C gives up.

    source: 'udp:ADDRESS:PORT', 'shm:NAME', 'serial:DEVICE', 'serial:DEVICE?protocol=flexitac&rows=16&cols=32'
        of a FlexiTac board, 'serial:auto', which finds one, or '-' for standard input
    skin: constants of the skin; rows and columns come from the frames, and what it does not state from
        the sensor, if that states it; by default each sensel is by itself
    serial_baud: of 'serial:'
    layout, pitch_mm: 'pillars' or 'sensels', and distance of sensels, in place of those of skin and sensor
    falling: readings fall under load; they are mirrored, 255 or 65535 less the reading, or negated
    timeout: of the wait for the first frame, s; None: it has no end

    Raises Error for another source, one that cannot be opened, or no frame in time. What a sensor sends never raises:
    invalid packets are counted in health.

    >>> import pillarfield as pf
    >>> pf.live("press.h5")
    Traceback (most recent call last):
    pillarfield.Error: press.h5: it is not a live source; give one of -, shm:NAME, udp:ADDRESS:PORT, serial:DEVICE[?protocol=flexitac&rows=ROWS&cols=COLS] or serial:auto
    """
    return LiveSource(source, skin=skin, serial_baud=serial_baud, layout=layout, pitch_mm=pitch_mm,
                      falling=falling, timeout=timeout)


class LiveForces(_core.LiveResults):
    """Results of another program as they come, an iterator of ForceField; live_forces() opens one."""

    def receive(self, timeout_s: float) -> Optional[ForceField]:
        """The next result, read-only, or None if none comes in time."""
        planes = self.next(timeout_s)
        if planes is None:
            return None
        contacts = planes.pop("contacts", None)
        return ForceField._of(planes, np.asarray(planes.pop("times")),
                              None if contacts is None else [contacts], self.skin)

    def __iter__(self) -> Iterator[ForceField]:
        return self

    def __next__(self) -> ForceField:
        forces = self.receive(math.inf)
        assert forces is not None
        return forces

    def __enter__(self) -> LiveForces:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()


def live_forces(source: str) -> LiveForces:
    """Opens the results that another program writes, and waits for their ring; Ctrl+C gives up.

    source: 'shm:NAME' of `pillarfield stream --to shm:NAME`, or of sink()

    The first result is the newest; a reader that falls behind goes on with the newest. Contacts are
    the 64 strongest, without parent, ended and wrench. When the stream ends, receive()
    gives None until there are results of the next stream of this skin.

    Raises Error for another source, or a ring of frames.

    >>> import pillarfield as pf
    >>> pf.live_forces("udp:127.0.0.1:9870")
    Traceback (most recent call last):
    pillarfield.Error: udp:127.0.0.1:9870: it is not a ring of results; give shm:NAME
    """
    return LiveForces(source)


class LiveSink(_core.LiveSink):
    """Passes forces on without waiting for who receives them; sink() opens one."""

    def __init__(self, target: str, plan: _core.Plan, *, contacts: bool = False, source: str = "",
                 overwrite: bool = False, allow_origins: Sequence[str] = ()) -> None:
        super().__init__(target, plan, contacts, source, overwrite, list(allow_origins))
        self._contacts = contacts
        self._sent = 0

    def send(self, forces: ForceField) -> None:
        """Sends the forces of one frame, with their contacts if the sink has contacts."""
        if len(forces.shape) != 2:
            raise Error("LiveSink.send", "the forces are of several frames", "send one at a time")
        contacts = forces.contacts if self._contacts else None
        self.send_planes(forces._batch(), contacts, float(forces.times), self._sent)
        self._sent += 1

    def __enter__(self) -> LiveSink:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close(finish=kind is None)


def sink(target: str, plan: _core.Plan, *, contacts: bool = False, source: str = "",
         overwrite: bool = False, allow_origins: Sequence[str] = ()) -> LiveSink:
    """Opens a live sink for the forces of a Processor of this plan.

    target: 'foxglove:[ADDRESS:]PORT', 'web:[ADDRESS:]PORT' (a page in the browser), 'udp:ADDRESS:PORT', 'shm:NAME', a .mcap file or a file of
        forces such as .h5
    contacts: forces come with contacts
    source: name of the frames' source, for files
    overwrite: replace any file, not only other results
    allow_origins: web pages that may connect to 'foxglove:', such as 'https://app.foxglove.dev'

    Raises Error for another target or one that cannot be opened.
    """
    return LiveSink(target, plan, contacts=contacts, source=source, overwrite=overwrite,
                    allow_origins=allow_origins)
