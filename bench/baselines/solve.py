"""The bare direct solve as NumPy array expressions: a baseline of pillarfield-bench.

    solve.py FRAMES ROWS COLS THRESHOLD COUNTS_PER_NEWTON RESULT

FRAMES holds uint8 frames of ROWS x COLS sensels, one after the other, ROWS and COLS even. RESULT
receives the solved first frame: shear_x, shear_y, normal as float32, then status as uint8. After
printing "ready", the program reads a number of frames per line of standard input, solves them, and
prints the nanoseconds per pillar.
"""

import math
import sys
import time

import numpy as np

HALF = np.float32(0.5)
SEGMENT_POINT = np.float32(0.875)


def difference(p, q, p_usable, q_usable, parity_sum):
    """V_p - V_q of a diagonal; parity predicts the inactive one of the two."""
    return np.where(p_usable & q_usable, p - q,
                    np.where(p_usable, p + p - parity_sum,
                             np.where(q_usable, parity_sum - q - q, np.float32(0))))


def may_press(p, q, p_usable, q_usable, parity_sum):
    """Whether the inactive sensel of a diagonal may be loaded below the threshold."""
    return (p_usable ^ q_usable) & (parity_sum - np.maximum(p, q) > 0)


def solve(frame, threshold, counts_per_newton):
    """Planes shear_x, shear_y, normal (N) and status of a frame [rows, cols]."""
    raw = (frame[0::2, 1::2], frame[0::2, 0::2], frame[1::2, 0::2], frame[1::2, 1::2])
    readings = [np.maximum(v.astype(np.float32), threshold) for v in raw]
    u1, u2, u3, u4 = (v > threshold for v in readings)
    v1, v2, v3, v4 = readings
    rising, falling = v1 + v3, v2 + v4
    rising_full, falling_full = u1 & u3, u2 & u4
    determined = rising_full | falling_full

    any_usable = u1 | u2 | u3 | u4
    high = np.where(rising_full, np.where(falling_full, HALF * (rising + falling), rising),
                    np.where(falling_full, falling,
                             np.where(any_usable, np.minimum(rising, falling), np.float32(0))))
    on_segment = (u1 | u3) & (u2 | u4)
    part = np.where(on_segment, SEGMENT_POINT, HALF)
    parity_sum = np.where(determined, high, part * high)
    along_rising = difference(v1, v3, u1, u3, parity_sum)
    along_falling = difference(v2, v4, u2, u4, parity_sum)

    ambiguous = ~determined & (high > 0)
    if threshold > 0:
        ambiguous |= falling_full & may_press(v1, v3, u1, u3, high)
        ambiguous |= rising_full & may_press(v2, v4, u2, u4, high)
    opposite = (rising_full & ~(u2 | u4)) | (falling_full & ~(u1 | u3))
    status = u1 + np.uint8(2) * u2 + np.uint8(4) * u3 + np.uint8(8) * u4
    status += np.uint8(16) * ambiguous + np.uint8(64) * opposite

    shear_scale = np.float32(1 / (2 * math.sqrt(2) * counts_per_newton))
    normal_scale = np.float32(1 / (2 * counts_per_newton))
    return ((along_rising - along_falling) * shear_scale,
            (along_rising + along_falling) * shear_scale, parity_sum * normal_scale,
            status.astype(np.uint8))


def main():
    path, rows, cols, threshold, counts_per_newton, result = sys.argv[1:]
    rows, cols = int(rows), int(cols)
    threshold, counts_per_newton = np.float32(threshold), float(counts_per_newton)
    frames = np.fromfile(path, np.uint8).reshape(-1, rows, cols)
    with open(result, "wb") as file:
        for plane in solve(frames[0], threshold, counts_per_newton):
            file.write(np.ascontiguousarray(plane).tobytes())
    print("ready", flush=True)

    solved = 0
    for line in sys.stdin:
        count = int(line)
        start = time.perf_counter()
        for _ in range(count):
            solve(frames[solved % len(frames)], threshold, counts_per_newton)
            solved += 1
        seconds = time.perf_counter() - start
        print(seconds * 1e9 / (count * (rows // 2) * (cols // 2)), flush=True)


if __name__ == "__main__":
    main()
