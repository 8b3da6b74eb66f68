"""The compiled half of the package: its public classes and their bases, with read-only attributes.

Names that only the package uses are not described.
"""

import os
from collections.abc import Sequence
from typing import Any, Optional, Protocol, Union

import numpy as np
import numpy.typing as npt

_Path = Union[str, os.PathLike[str]]
_Floats = npt.NDArray[np.float32]
_Place = tuple[float, float]
_Vector = tuple[float, float, float]

__version__: str

def devices() -> list[Device]: ...

def __getattr__(name: str) -> Any: ...

class Calibration:
    rows: int
    cols: int
    tare: Optional[_Floats]
    gain: Optional[_Floats]
    dead_zone: Optional[_Floats]
    mask: Optional[npt.NDArray[np.uint8]]
    noise: Optional[_Floats]
    threshold_counts: Optional[float]
    sensel_pitch_mm: Union[None, float, tuple[float, float]]
    layout: Optional[str]
    counts_per_newton: Optional[float]
    effects: list[str]
    history: list[str]
    def __init__(self, rows: int, cols: int, *, tare: Optional[npt.ArrayLike] = ...,
                 gain: Optional[npt.ArrayLike] = ..., dead_zone: Optional[npt.ArrayLike] = ...,
                 mask: Optional[npt.ArrayLike] = ..., noise: Optional[npt.ArrayLike] = ...,
                 threshold_counts: Optional[float] = ...,
                 counts_per_newton: Optional[float] = ...) -> None: ...
    @staticmethod
    def load(path: _Path, *, trust: bool = ...) -> Calibration: ...
    def save(self, path: _Path, *, overwrite: bool = ...) -> None: ...

class _Step(Protocol):
    @property
    def calibration(self) -> Calibration: ...

class _Quantities:
    pillars: int
    ambiguous: Optional[int]
    resolved: Optional[int]
    shear_x_n: Optional[float]
    shear_y_n: Optional[float]
    normal_n: float
    centre_of_pressure_mm: _Place
    centre_mm: _Place
    torque_nmm: Optional[float]
    area_mm2: float
    peak_n: float
    peak_mm: _Place
    mean_pressure_kpa: float
    peak_pressure_kpa: float
    friction: Optional[float]
    friction_deviation: Optional[float]
    friction_source: str
    slipping_share: Optional[float]
    slip_margin: Optional[float]
    time_to_slip_s: Optional[float]
    time_to_slip_low_s: Optional[float]
    time_to_slip_high_s: Optional[float]
    slip_within_0_1_s: Optional[float]
    slip_within_0_3_s: Optional[float]
    slip_within_1_s: Optional[float]
    slip: str
    wrench: Optional[tuple[_Vector, _Vector]]

class ContactTotal(_Quantities): ...

class Contact(_Quantities):
    track_id: int
    parent: Optional[int]
    first_time_s: float
    age_s: float

class Device:
    index: Optional[int]
    lanes: int
    name: str
    platform: str
    type: str
    unsuitable: str

class ForceReader:
    estimator: str
    skin: Skin
    source: str
    warnings: list[str]
    solved_by: Any
    def __init__(self, path: _Path, *, trust: bool = ...) -> None: ...
    def read(self, first: int, step: int, count: int) -> dict[str, Any]: ...
    def __len__(self) -> int: ...

class FrameContacts:
    time_s: float
    total: ContactTotal
    ended: list[tuple[int, Optional[int]]]
    def __getitem__(self, index: int) -> Contact: ...
    def __len__(self) -> int: ...

class FrameSource:
    calibration: Calibration
    format: str
    has_truth: bool
    sensel_type: str
    skin: Skin
    times: npt.NDArray[np.float64]
    warnings: list[str]
    def __init__(self, path: Union[_Path, Sequence[_Path]], *, trust: bool = ...,
                 dataset: str = ..., times: str = ...,
                 frame_size: Optional[tuple[int, int]] = ..., rate_hz: Optional[float] = ...,
                 tare_frames: int = ..., axes: str = ..., layout: str = ...,
                 falling: bool = ..., untimed: bool = ..., columns: str = ...) -> None: ...
    @staticmethod
    def of_array(readings: npt.NDArray[Any], times: npt.NDArray[np.float64], skin: Skin,
                 calibration: Optional[Calibration], axes_are_known: bool = ...,
                 falling: bool = ...) -> FrameSource: ...
    def read(self, first: int, step: int, count: int) -> npt.NDArray[Any]: ...
    def read_truth(self, first: int, step: int, count: int) -> dict[str, Any]: ...
    def write(self, path: _Path, *, overwrite: bool) -> None: ...
    def __len__(self) -> int: ...

class LiveFrames:
    health: dict[str, Any]
    sensel_type: str
    skin: Skin
    notes: list[str]
    def __init__(self, source: str, skin: Optional[Skin], serial_baud: int, layout: str,
                 pitch_mm: Union[None, float, tuple[float, float]], falling: bool,
                 timeout_s: Optional[float]) -> None: ...
    def close(self) -> None: ...
    def next(self, timeout_s: float) -> Any: ...

class LiveResults:
    health: dict[str, Any]
    skin: Skin
    def __init__(self, source: str) -> None: ...
    def close(self) -> None: ...
    def next(self, timeout_s: float) -> Any: ...

class LiveSink:
    statistics: dict[str, Any]
    def __init__(self, target: str, plan: Plan, contacts: bool, source: str, overwrite: bool,
                 allow_origins: list[str]) -> None: ...
    def close(self, finish: bool = ...) -> None: ...
    def send_planes(self, planes: dict[str, Any], contacts: Optional[FrameContacts], time_s: float,
                    sequence: int) -> None: ...

class Plan:
    estimator: str
    frame_interval_s: float
    sensel_type: str
    skin: Skin
    stages: list[str]
    def __init__(self, skin: Skin, *, sensel_type: str = ...,
                 calibration: Union[Calibration, _Path, None] = ...,
                 scene: Union[Scene, _Path, None] = ..., **settings: Any) -> None: ...

class Processor:
    in_flight: int
    plan: Plan
    tare: Optional[_Floats]
    def __init__(self, plan: Plan, frames_in_flight: int, lent: int, contacts: bool,
                 device: str) -> None: ...
    def close(self) -> None: ...
    def receive_planes(self) -> dict[str, Any]: ...
    def set_tare(self, tare: Union[npt.ArrayLike, Calibration, _Step]) -> None: ...
    def submit_readings(self, readings: npt.NDArray[Any], time_s: float,
                        missing: Sequence[tuple[int, int, int, int]]) -> None: ...
    def try_receive_planes(self) -> Optional[dict[str, Any]]: ...

class RegionErrors:
    pillars: int
    rms_n: float
    p95_n: float
    rms_relative: float
    p95_relative: float
    theta_rms_rad: float
    phi_rms_rad: float
    status_mismatches: int

class Scene:
    frames: int
    rate_hz: float
    seed: int
    skin: Skin
    title: str
    warnings: list[str]
    @staticmethod
    def load(path: _Path) -> Scene: ...
    @staticmethod
    def parse(text: str, name: str = ...) -> Scene: ...
    def replace(self, *, frames: Optional[int] = ..., seed: Optional[int] = ...) -> Scene: ...

class Skin:
    rows: int
    cols: int
    pillar_rows: int
    pillar_cols: int
    sensel_pitch_mm: Union[float, tuple[float, float]]
    pillar_pitch_mm: float
    layout: str
    stated: list[str]
    element_rows: int
    element_cols: int
    element_pitch_mm: Union[float, tuple[float, float]]
    element_area_mm2: float
    counts_per_newton: float
    threshold_counts: float
    full_scale_counts: Optional[float]
    power_law: Optional[tuple[float, float]]
    surface: Optional[Surface]
    def mirrored(self) -> Skin: ...
    def __init__(self, rows: int, cols: int, *,
                 sensel_pitch_mm: Union[None, float, tuple[float, float]] = ...,
                 counts_per_newton: Optional[float] = ..., threshold_counts: float = ...,
                 full_scale_counts: Optional[float] = ...,
                 power_law: Optional[tuple[float, float]] = ...,
                 surface: Optional[Surface] = ..., layout: Optional[str] = ...) -> None: ...

class Surface:
    axis_deg: float
    radius_mm: float
    shape: str
    @staticmethod
    def cylinder(radius_mm: float, *, axis_deg: float = ...) -> Surface: ...
    @staticmethod
    def height_map(heights_mm: npt.ArrayLike) -> Surface: ...
    @staticmethod
    def sphere(radius_mm: float) -> Surface: ...

class Tracker:
    def __init__(self, plan: Plan, *, minimum_pillars: int = ..., reach_mm: float = ...) -> None: ...
    def update_planes(self, planes: dict[str, Any],
                      times: npt.ArrayLike) -> list[FrameContacts]: ...

class VectorErrors:
    cases: int
    rms: float
    true_rms: float
    worst: float
    worst_frame: int
    worst_true: float
