"""Images of a field of force."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
import numpy.typing as npt

import pillarfield as pf

Image = npt.NDArray[np.uint8]


def _normal(forces: pf.ForceField) -> Any:
    return np.repeat(forces.normal[..., None], 3, -1)


def _vector_rgb(forces: pf.ForceField) -> Any:
    return np.stack([forces.shear_x, forces.shear_y, forces.normal], -1)


# Of each: channels in N [rows, cols, 3], the pixel of 0 N, and levels from there to the full scale.
RENDERINGS: dict[str, tuple[Callable[[pf.ForceField], Any], int, int]] = {
    "normal": (_normal, 0, 255), "vector_rgb": (_vector_rgb, 128, 127)}


def check_rendering(rendering: str, layout: str) -> None:
    """Raises Error if there is no such rendering of the layout."""
    if rendering not in RENDERINGS:
        raise pf.Error("rendering", f"'{rendering}' is none", f"give {' or '.join(RENDERINGS)}")
    if rendering == "vector_rgb" and layout == "sensels":
        raise pf.Error("rendering", "sensels without pillars have no shear for vector_rgb",
                       "give normal, or the layout pillars if the skin has some")


def image_of(forces: pf.ForceField, rendering: str, full_scale_n: float, height: int,
             width: int) -> Image:
    """One frame as RGB, uint8 [height, width, 3], each pillar or sensel a rectangle of pixels.

    Forces beyond the full scale, and with `normal` those below zero, are at the end of the range.
    """
    channels_of, zero, levels = RENDERINGS[rendering]
    share = channels_of(forces) / full_scale_n
    pixels = np.clip(np.rint(zero + levels * np.clip(share, -1, 1)), 0, 255).astype(np.uint8)
    rows, cols = pixels.shape[:2]
    image: Image = pixels[np.arange(height) * rows // height][:, np.arange(width) * cols // width]
    return image
