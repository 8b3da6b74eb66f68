"""Independent direct solve in double precision by pseudo-inverses, without code of kernels/.

Sensel n at angle a_n reads V_n = k (N + X cos a_n + Y sin a_n), which is equation (2) of the paper
with X = -F sin(theta) cos(phi), Y = -F sin(theta) sin(phi), N = F cos(theta).
"""

import numpy as np

ANGLES = np.deg2rad([45, 135, 225, 315])
MODEL = np.stack([np.cos(ANGLES), np.sin(ANGLES), np.ones(4)], axis=1)  # columns X, Y, N


def sensels_of(frame):
    """Readings [pillar rows, pillar cols, 4] of a frame, sensels 1 to 4."""
    rows, cols = frame.shape[0] // 2 * 2, frame.shape[1] // 2 * 2
    frame = frame[:rows, :cols].astype(np.float64)
    return np.stack([frame[0::2, 1::2], frame[0::2, 0::2], frame[1::2, 0::2], frame[1::2, 1::2]],
                    axis=-1)


def solve_pattern(usable, readings, threshold):
    """Forces (X, Y, N) in counts, k = 1, of pillars [n, 4] with one pattern of usable sensels. Inactive
    ones may read up to the threshold."""
    chosen = [n for n in range(4) if usable[n]]
    known = readings[:, chosen]
    if len(chosen) >= 3:
        return known @ np.linalg.pinv(MODEL[chosen]).T
    normal = np.zeros(len(readings))
    if len(chosen) == 2 and (chosen[1] - chosen[0]) % 2 == 1:  # adjacent: 7/8 of the segment
        normal = 7 / 8 * (known.min(axis=1) + threshold) / 2
    elif len(chosen) == 2:  # opposite: a fault; their mean is the normal force
        normal = known.mean(axis=1)
    elif len(chosen) == 1:  # the midpoint; both neighbours are equal
        normal[:] = threshold / 2
        chosen = [n for n in range(4) if n != (chosen[0] + 2) % 4]
        known = np.where(usable[chosen], readings[:, chosen], normal[:, None])
    else:
        return np.zeros((len(readings), 3))
    shear = (known - normal[:, None]) @ np.linalg.pinv(MODEL[chosen][:, :2]).T
    return np.concatenate([shear, normal[:, None]], axis=1)


def may_be_region_one(usable, readings, threshold):
    """Whether parity predicts a positive reading of the inactive sensel of [n, 4]."""
    if usable.sum() != 3 or threshold == 0:
        return np.zeros(len(readings), dtype=bool)
    inactive = int(np.flatnonzero(~usable)[0])
    sign = np.array([1, -1, 1, -1]) * (1 if inactive % 2 else -1)
    return readings @ sign > 0


def solve(frame, threshold, counts_per_newton):
    """Forces [rows, cols, 3] in newtons, the usable bits [rows, cols] of a frame, and whether its
    pillars are ambiguous."""
    readings = sensels_of(frame)
    usable = readings > threshold  # False for NaN
    bits = (usable * [1, 2, 4, 8]).sum(axis=-1)
    forces = np.zeros(readings.shape[:2] + (3,))
    ambiguous = np.zeros(readings.shape[:2], dtype=bool)
    for pattern in range(16):
        here = bits == pattern
        if here.any():
            mask = np.array([(pattern >> n) & 1 for n in range(4)], dtype=bool)
            known = np.where(mask, readings[here], 0)
            forces[here] = solve_pattern(mask, known, threshold)
            adjacent = mask.sum() == 2 and mask[0] != mask[2]
            alone = mask.sum() == 1 and threshold > 0
            ambiguous[here] = may_be_region_one(mask, known, threshold) | adjacent | alone
    return forces / counts_per_newton, bits, ambiguous
