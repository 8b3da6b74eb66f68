"""Configuration of the camera."""

from __future__ import annotations

import dataclasses
from typing import Optional

import pillarfield as pf
from lerobot.cameras import CameraConfig

from .rendering import check_rendering


@CameraConfig.register_subclass("pillarfield")
@dataclasses.dataclass(kw_only=True)
class PillarfieldCameraConfig(CameraConfig):
    """A tactile skin as a camera.

    source: live source of pillarfield, such as 'udp:0.0.0.0:9870', 'shm:skin' or
        'serial:/dev/ttyUSB0?protocol=flexitac&rows=16&cols=32'
    full_scale_n: force on one pillar or sensel at which a channel is at its end, N
    rendering: 'normal': normal force as grey, 0 N black; 'vector_rgb': shear_x, shear_y and normal as
        red, green and blue, 0 N at 128
    layout: 'pillars' or 'sensels', which have normal force alone; '': that of calibration or sensor, else
        sensels
    calibration: path of the skin's calibration
    counts_per_newton: of the skin; None: that of the calibration
    tare_frames: the first frames after connect(), at least 20, are of the unloaded skin; 0: no tare
    width, height: of the image, pixels; None: one a pillar or sensel, known after connect(). LeRobot's
        robots ask before.
    fps: not used; the sensor sets the pace
    """

    source: str
    full_scale_n: float
    rendering: str = "normal"
    layout: str = ""
    calibration: Optional[str] = None
    counts_per_newton: Optional[float] = None
    tare_frames: int = 0

    def __post_init__(self) -> None:
        check_rendering(self.rendering, self.layout)
        if not 0 < self.full_scale_n < float("inf"):
            raise pf.Error("full_scale_n", f"{self.full_scale_n} N is not a full scale",
                           "give a positive force")
        if self.tare_frames and self.tare_frames < 10:
            raise pf.Error("tare_frames", f"{self.tare_frames} frames are too few",
                           "give 10 or more, or 0")
