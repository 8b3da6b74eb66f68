"""Recordings solved by many processes or machines, in parts (docs/many_machines.md).

`solve()` uses Dask distributed; `solve_part()` and `join()` fit any other engine.
"""

from __future__ import annotations

import importlib
import os
import time
from typing import Any, Optional

from . import _core
from ._error import Error
from ._frames import Path
from ._recording import ForceFile, Recording

__all__ = ["join", "solve", "solve_part"]


def solve(client: Any, recording: Path, output: Path, *, parts: Optional[int] = None,
          overwrite: bool = False, attempts: int = 10, **how: Any) -> ForceFile:
    """Solves a recording in parts on the workers of Dask distributed, joins them and opens the result.

    client: distributed.Client; its workers see both paths, and have this package
    recording: path of a file of frames
    output: path of the result, .h5; parts that are whole already are not solved again
    parts: number of parts; by default 64, or as many as there can be
    overwrite: replace an output of any kind
    attempts: how often a part is tried, since workers may die
    how: as in solve_part()

    Raises Error if a part fails, with the reason. After this, or Ctrl+C, workers finish the parts
    that they have begun, and begin no others.
    """
    as_completed = _dask().as_completed
    recording, output = os.path.abspath(recording), os.path.abspath(output)
    _require_portable(how)
    frames = len(_recording_of(recording, how))
    most = _core.most_parts(frames, how.get("checkpoint_every", 0))
    if parts is None:
        parts = max(1, min(64, most))  # Not by the workers: the same call continues with others.

    def submit(part: int) -> Any:
        return client.submit(solve_part, recording, output, part, parts, pure=False, **how)

    tried = dict.fromkeys(range(1, parts + 1), 1)
    waiting = {submit(part): part for part in tried}
    finished = as_completed(list(waiting))
    try:
        for future in finished:
            part = waiting.pop(future)
            failure = future.exception() if future.status != "finished" else None
            if future.status == "finished":
                continue
            if isinstance(failure, Error) and not _is_claimed(failure):
                raise failure
            if tried[part] >= attempts:
                raise Error(output, f"part {part} of {parts} failed {tried[part]} times: {failure}",
                            "look at the workers' logs; the same call continues") from failure
            tried[part] += 1
            # Another worker may still hold the part: Dask gives up workers that it does not hear.
            time.sleep(min(30, 0.2 * 2 ** tried[part]))
            again = submit(part)
            waiting[again] = part
            finished.add(again)
    except BaseException:  # Ctrl+C too: workers finish the parts that they have begun, and no others.
        client.cancel(list(waiting))
        raise
    join(output, overwrite=overwrite)
    return ForceFile(output)


def solve_part(recording: Path, output: Path, part: int, parts: int, *,
               checkpoint_every: int = 0, warm_up: Optional[int] = None, contacts: bool = False,
               calibration: Optional[Path] = None, device: str = "",
               reading: Optional[dict[str, Any]] = None, **options: Any) -> bool:
    """Solves one part of a recording into the folder output + '.parts', unless it is whole already.

    part, parts: it is the part-th of so many, from 1
    checkpoint_every: multiples of this frame begin anew what is carried from frame to frame: a
        followed baseline, hysteresis, friction, identities of contacts. 0: nothing is carried
    warm_up: frames before each of them that are solved first; by default a tenth of the distance
    contacts: find and track the contacts too
    calibration: path of its file
    device: 'host', 'opencl', or an OpenCL device by its index or a part of its name; '': the host for
        small skins, else the best of OpenCL
    reading: options of Recording
    options: those of Plan, with paths for files

    Returns whether it was solved by this call. Raises Error if a file or an option is wrong, or if
    another process writes the part.
    """
    source = Recording(recording, **(reading or {}))
    plan = _core.plan_of(source, source.skin, calibration=calibration or source.calibration, **options)
    warm_up = checkpoint_every // 10 if warm_up is None else warm_up
    solved: bool = _core.solve_part(source, plan, os.path.basename(recording), output, part, parts,
                                    checkpoint_every, warm_up, contacts, device)
    return solved


def join(output: Path, *, overwrite: bool = False, trust: bool = False) -> None:
    """Joins the parts in the folder output + '.parts', which may be removed then, into one file of forces.

    overwrite: replace an output of any kind
    trust: the parts come from your own programs, so they are not examined first

    Raises Error if a part is absent or damaged, or if parts differ in source or plan.
    """
    _core.join_parts(output, overwrite, trust)


def _dask() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise Error("pillarfield.distributed", "the package 'distributed' is not installed",
                    "install python3-distributed, or use solve_part()") from None


def _recording_of(recording: Path, how: dict[str, Any]) -> Recording:
    return Recording(recording, **(how.get("reading") or {}))


def _require_portable(how: dict[str, Any]) -> None:
    """Objects of the library stay in their process."""
    for name, value in how.items():
        if type(value).__module__.startswith("pillarfield"):
            raise Error("pillarfield.distributed.solve",
                        f"{name} is an object of this process, which workers lack",
                        "save it and give its path")


def _is_claimed(failure: Error) -> bool:
    """Whether a worker that was given up still writes the part, so that a later attempt may succeed."""
    return "being written by another process" in failure.failure
