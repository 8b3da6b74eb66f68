"""The camera `pillarfield` of LeRobot: the live field of force of a tactile skin as an image.

LeRobot (looked at: 0.6.2) imports this package by its prefix and finds the camera beside its config.
"""

from .camera import PillarfieldCamera
from .config import PillarfieldCameraConfig

__all__ = ["PillarfieldCamera", "PillarfieldCameraConfig"]
