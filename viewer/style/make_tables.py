#!/usr/bin/env python3
"""Prints the tables `diverging` and `cyclic` of colour_tables.cpp, designed in CIELAB (D65).

diverging  Lightness falls by equal steps from a light neutral in the middle to a blue and an orange
           of the same lightness. Blue and orange stay apart in all three kinds of colour blindness.
cyclic     A ring on which lightness separates up and down, and blue-yellow left and right, the two
           dimensions that red-green blindness leaves; red-green adds to up and down for others.
           Entry 128 (angle 0) is yellow, a quarter later light rose, then blue, then dark green.
"""

import bisect
import math

COLOURS = 256


def srgb_of(lab):
    """Converts CIELAB to sRGB components; outside 0..1 for colours outside sRGB.
    Not valid for the darkest colours, where CIELAB is linear."""
    lightness, a, b = lab
    f_y = (lightness + 16) / 116
    x, y, z = 0.95047 * (f_y + a / 500) ** 3, f_y**3, 1.08883 * (f_y - b / 200) ** 3
    linear = (
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
    )
    return [12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear]


def entry_of(lab):
    colour = srgb_of(lab)
    if min(colour) < -0.002 or max(colour) > 1.002:
        raise ValueError(f"{lab} is not a colour of sRGB: {colour}")
    red, green, blue = (round(255 * min(max(c, 0), 1)) for c in colour)
    return red << 16 | green << 8 | blue


def side_of_diverging(away, hue_degrees):
    """The colour `away` (0..1) from the middle: both lightness and chroma by equal steps."""
    lightness = 88 - 42 * away
    chroma = 58 * away
    hue = math.radians(hue_degrees)
    return lightness, chroma * math.cos(hue), chroma * math.sin(hue)


def diverging():
    for entry in range(COLOURS):
        at = (2 * entry + 1) / COLOURS - 1
        # Lines of constant perceived hue bend in CIELAB: blue is 260 if light, 286 if dark.
        hue = 260 - 26 * at if at < 0 else 62
        yield side_of_diverging(abs(at), hue)


def on_ring(turn):
    """The colour at `turn`, 0..1, counter-clockwise from yellow."""
    angle = 2 * math.pi * turn
    right, up = math.cos(angle), math.sin(angle)
    return 64 + 17 * up, (26 if up > 0 else 24) * up, (52 if right > 0 else 38) * right


def cyclic(fine=20000):
    """Entries at equal distances along the ring."""
    way = [0.0]
    last = on_ring(0)
    for step in range(1, fine + 1):
        here = on_ring(step / fine)
        way.append(way[-1] + math.dist(last, here))
        last = here
    for entry in range(COLOURS):
        # Each quarter turn has its own quarter of the table.
        turn = ((entry + 0.5) / COLOURS + 0.5) % 1
        quarter = int(4 * turn)
        low, high = way[quarter * fine // 4], way[(quarter + 1) * fine // 4]
        wanted = low + (4 * turn - quarter) * (high - low)
        yield on_ring(bisect.bisect_left(way, wanted) / fine)


def print_table(name, colours):
    entries = [f"0x{entry_of(colour):06x}" for colour in colours]
    print(f"constexpr Table {name} = {{")
    for start in range(0, COLOURS, 9):
        last = start + 9 >= COLOURS
        print("    " + ", ".join(entries[start : start + 9]) + ("};" if last else ","))
    print()


if __name__ == "__main__":
    print_table("kDiverging", diverging())
    print_table("kCyclic", cyclic())
