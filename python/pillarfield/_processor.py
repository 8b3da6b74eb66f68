"""pillarfield.Processor and Contacts: frames one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from types import TracebackType
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import Error
from ._field import ForceField
from ._frames import readings_of, warn


class Processor(_core.Processor):
    """Solves frames one by one on an OpenCL device, in order, several in flight.

    plan: Plan with the skin and what to compute
    frames_in_flight: frames that may be submitted and not yet received, 1..64
    lent: results that may be held at a time without a copy, 0..63; further ones are copied
    contacts: track contacts too
    device: 'host', 'opencl', or an OpenCL device by its index or a part of its name; '': the host for
        small skins, else the best of OpenCL

    Results are read-only arrays in the device's memory; ForceField.copy() is writeable. They stay
    right as long as they are held, also after close(). Python's lock is released while solving, and
    several threads may use one Processor. Raises Error if an option is out of range.

    >>> import numpy as np, pillarfield as pf
    >>> plan = pf.Plan(pf.Skin(8, 12, counts_per_newton=320, layout="pillars"))
    >>> with pf.Processor(plan) as processor:
    ...     processor.submit(np.full((8, 12), 32, np.uint8))
    ...     forces = processor.receive()
    >>> round(float(forces.normal[0, 0]), 3)
    0.1
    """

    def __init__(self, plan: _core.Plan, *, frames_in_flight: int = 2, lent: int = 4,
                 contacts: bool = False, device: str = "") -> None:
        warn(_core.layout_warnings(plan.skin))
        super().__init__(plan, frames_in_flight, lent, contacts, device)
        self._in_flight = frames_in_flight
        self._submitted = 0
        self._remember(plan)

    def _remember(self, plan: _core.Plan) -> None:
        """Keeps what frames need: each access to `plan` copies it, calibration and all."""
        self._skin = plan.skin
        self._sensel_type = plan.sensel_type
        self._frame_interval_s = plan.frame_interval_s
        self._solved_by = _core.SolvedBy(plan)

    def set_tare(self, tare: Any) -> None:
        """Replaces the tare, [R, C], counts, for the frames submitted from now on; of a Calibration, or a
        step such as pf.calibrate.tare(frames), noise, threshold and all else too.

        Raises Error if the plan has no tare (it may be zero) or the values do not fit.
        """
        super().set_tare(tare)
        self._remember(self.plan)

    def submit(self, frame: Any, time_s: Optional[float] = None) -> None:
        """Starts to solve a frame, which it copies.

        frame: readings [R, C], counts, that fit the plan's type; or a Frame of live()
        time_s: its time, s; None: that of the Frame, or its number times the plan's frame interval

        Raises Error if all frames are in flight or the frame does not fit.
        """
        if time_s is None:
            time_s = getattr(frame, "time_s", self._submitted * self._frame_interval_s)
        readings = readings_of(getattr(frame, "readings", frame), self._sensel_type)
        self.submit_readings(readings, time_s, getattr(frame, "missing", []))
        self._submitted += 1

    def receive(self) -> ForceField:
        """Waits for the oldest frame in flight: its forces, planes [R // 2, C // 2].

        Raises Error if none is in flight.
        """
        return self._field(self.receive_planes())

    def try_receive(self) -> Optional[ForceField]:
        """receive() if the oldest frame in flight is solved, without waiting; else None."""
        planes = self.try_receive_planes()
        return None if planes is None else self._field(planes)

    def stream(self, frames: Iterable[Any], ahead: int = 0) -> Iterator[ForceField]:
        """Solves the frames of an iterable, in order.

        ahead: frames submitted before the oldest is received, 0..frames_in_flight - 1. With 0 each
        result comes as early as it can; with more, solving overlaps with what the caller does.
        """
        if not 0 <= ahead < self._in_flight:
            raise Error("Processor.stream", f"ahead is {ahead}",
                        f"give 0..{self._in_flight - 1}, or more frames_in_flight")
        try:
            waiting = 0
            for frame in frames:
                self.submit(frame)
                waiting += 1
                if waiting > ahead:
                    waiting -= 1
                    yield self.receive()
            for _ in range(waiting):
                yield self.receive()
                waiting -= 1
        finally:
            for _ in range(waiting):
                self._discard()

    def _discard(self) -> None:
        """Receives a frame that nobody wants, unless the processor is closed."""
        try:
            self.receive_planes()
        except Error:
            pass

    def __enter__(self) -> Processor:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def _field(self, planes: dict[str, Any]) -> ForceField:
        contacts = planes.pop("contacts", None)
        return ForceField._of(planes, np.asarray(planes.pop("times")),
                              None if contacts is None else [contacts], self._skin,
                              self._solved_by)


class Contacts(_core.Tracker):
    """Finds the contacts of frame after frame and tracks them over time.

    plan: Plan of the solver; it gives pitch, friction and noise of the sensor
    minimum_pillars: smaller contacts are neither listed nor tracked
    reach_mm: how far a contact may move between frames, 0..1000

    Raises Error for a value out of range.

    >>> import numpy as np, pillarfield as pf
    >>> frame = np.zeros((16, 24), np.uint8)
    >>> frame[4:8, 4:8] = 64
    >>> contacts = pf.Contacts(pf.Plan(pf.Skin(16, 24)))
    >>> contacts.update(pf.solve(frame, counts_per_newton=320, layout="pillars"))
    <FrameContacts: 1 contact, 0.8 N>
    """

    def update(self, forces: ForceField) -> _core.FrameContacts:
        """The contacts of the next frame; forces are of one frame."""
        if len(forces.shape) != 2:
            raise Error("Contacts.update", "the forces are of several frames", "use over()")
        return self.over(forces)[0]

    def over(self, forces: ForceField) -> Sequence[_core.FrameContacts]:
        """The contacts of each of the next frames."""
        return self.update_planes(forces._batch(), forces.times.reshape(-1))
