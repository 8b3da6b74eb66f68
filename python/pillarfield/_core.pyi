"""The compiled half of the package: to type checkers its names are Any, but for the options of a plan."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal, Optional, TypedDict, Union

class PlanOptions(TypedDict, total=False):
    """The options of pf.solve() and pf.Plan(); help(pf.Plan) describes them."""

    scene: Union[str, PathLike[str], Any]
    layout: Literal["pillars", "sensels"]
    pitch_mm: Union[float, tuple[float, float], None]
    estimator: Literal["direct", "paper", "contact"]
    outputs: Sequence[Literal["angles", "uncertainty", "pressure"]]
    friction: Optional[float]
    friction_bound: Optional[float]
    friction_prior: Optional[tuple[float, float]]
    unrelated_frames: bool
    threshold_counts: Optional[float]
    counts_per_newton: Optional[float]
    full_scale_counts: Optional[float]
    noise_counts: Optional[float]
    parity_tolerance_counts: Optional[float]
    baseline_time_s: Optional[float]
    release_time_s: float
    baseline_interval: Optional[int]
    frame_interval_s: Optional[float]

def __getattr__(name: str) -> Any: ...
