"""Pictures of one frame with the viewer's colours, as PNG; NumPy only."""

from __future__ import annotations

import math
import struct
import zlib
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core

Image = npt.NDArray[np.uint8]

_LEAST_PIXELS = 480  # of the longer side of the skin
_ARROW_CELL = 24  # pixels from arrow to arrow
# Rows of 3 x 5 pixels, from the top.
_FONT = {
    "0": (7, 5, 5, 5, 7), "1": (2, 6, 2, 2, 7), "2": (7, 1, 7, 4, 7), "3": (7, 1, 3, 1, 7),
    "4": (5, 5, 7, 1, 1), "5": (7, 4, 7, 1, 7), "6": (7, 4, 7, 5, 7), "7": (7, 1, 2, 2, 2),
    "8": (7, 5, 7, 5, 7), "9": (7, 5, 7, 1, 7), ".": (0, 0, 0, 0, 2), "-": (0, 0, 7, 0, 0),
    "+": (0, 2, 7, 2, 0), "e": (0, 7, 7, 4, 7), "N": (6, 5, 5, 5, 5), "°": (2, 5, 2, 0, 0),
    "k": (4, 5, 6, 5, 5), "P": (7, 5, 7, 4, 4), "a": (0, 3, 5, 5, 3), " ": (0, 0, 0, 0, 0)}


def picture(planes: dict[str, Any], quantity: str, limits: Optional[tuple[float, float]],
            light: bool, skin: Optional[_core.Skin]) -> bytes:
    """PNG of planes [1, P, Q]: heat map, arrows of the shear, and the colour bar with its ends."""
    pillars, low, high, unit = _core.paint(planes, quantity, limits, light, skin)
    zoom = max(1, math.ceil(_LEAST_PIXELS / max(1, *pillars.shape[:2])))
    heat = pillars.repeat(zoom, 0).repeat(zoom, 1)
    if "shear_x" in planes:
        _draw_arrows(heat, planes, zoom, light)
    colours = _core.colours(quantity, light)
    image = np.empty((max(heat.shape[0], 80) + 40, heat.shape[1] + 130, 3), np.uint8)
    image[:] = colours[-1]
    image[20:20 + heat.shape[0], 20:20 + heat.shape[1]] = heat
    left = heat.shape[1] + 36
    if quantity not in ("region", "status"):
        height = image.shape[0] - 40
        image[20:20 + height, left:left + 16] = colours[(np.arange(height)[::-1] * 256) // height,
                                                        None]
        ink = 20 if light else 230
        _write(image, f"{high:.3g} {unit}", 20, left + 22, ink)
        _write(image, f"{low:.3g} {unit}", image.shape[0] - 30, left + 22, ink)
    return _png_of(image)


def _write(image: Image, text: str, top: int, left: int, ink: int) -> None:
    """Writes characters of 6 x 10 pixels."""
    for character in text:
        rows = _FONT.get(character, _FONT[" "])
        bits = np.array([[row >> 2 & 1, row >> 1 & 1, row & 1] for row in rows], bool)
        mask = bits.repeat(2, 0).repeat(2, 1)
        area = image[top:top + 10, left:left + 6]
        area[mask[:area.shape[0], :area.shape[1]]] = ink
        left += 8


def _draw_arrows(skin: Image, planes: dict[str, Any], zoom: int, light: bool) -> None:
    """Arrows of the mean shear in cells of pillars, the longest one cell long."""
    cell = max(1, round(_ARROW_CELL / zoom))
    x, y = (_cell_means(planes[name][0], cell) for name in ("shear_x", "shear_y"))
    size = np.hypot(x, y)
    longest = size.max(initial=0)
    if not 0 < longest < math.inf:
        return
    rows, cols = np.nonzero(size > 0.05 * longest)
    length = zoom * cell / longest
    tip_x, tip_y = x[rows, cols] * length, -y[rows, cols] * length
    mid_x, mid_y = (cols + 0.5) * cell * zoom, (rows + 0.5) * cell * zoom
    along = np.linspace(-0.5, 0.5, 2 * cell * zoom + 1)[:, None]
    lines = [(mid_x + along * tip_x, mid_y + along * tip_y)]
    back = np.linspace(0, 0.35, cell * zoom + 1)[:, None]
    for turn in (2.6, -2.6):  # the two strokes of the head, radians from the direction
        head_x = tip_x * math.cos(turn) - tip_y * math.sin(turn)
        head_y = tip_x * math.sin(turn) + tip_y * math.cos(turn)
        lines.append((mid_x + 0.5 * tip_x + back * head_x, mid_y + 0.5 * tip_y + back * head_y))
    for line_x, line_y in lines:
        row = np.clip(line_y, 0, skin.shape[0] - 1).astype(int)
        col = np.clip(line_x, 0, skin.shape[1] - 1).astype(int)
        skin[row, col] = 20 if light else 255


def _cell_means(plane: npt.NDArray[np.float32], cell: int) -> Any:
    rows, cols = (max(1, size // cell) for size in plane.shape)
    whole = plane[:rows * cell, :cols * cell]
    if whole.size < rows * cols * cell * cell:
        return whole.mean(keepdims=True)
    return whole.reshape(rows, cell, cols, cell).mean((1, 3))


def _png_of(image: Image) -> bytes:
    """PNG of pixels, uint8 [rows, cols, 3]."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

    rows, cols, _ = image.shape
    lines = np.zeros((rows, 1 + 3 * cols), np.uint8)  # each line begins with its filter: none
    lines[:, 1:] = image.reshape(rows, -1)
    header = struct.pack(">IIBBBBB", cols, rows, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(lines.tobytes(), 6)) + chunk(b"IEND", b""))
