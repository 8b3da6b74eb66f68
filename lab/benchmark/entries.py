"""Entries of the open benchmark, as score.py runs them (docs/histories.md):

f(readings [T, R, C], counts_per_newton, threshold_counts, rate_hz) -> forces [T, 3, P, Q], N, and a dictionary of what is
reported of each frame, score.REPORTS."""

import functools

import numpy as np

import generate
from score import REPORTS, regions, sensels

def product(estimator, readings, k, threshold, rate_hz, contacts=False):
    import pillarfield
    skin = pillarfield.Skin(*readings.shape[1:], layout="pillars", counts_per_newton=k,
                            threshold_counts=threshold, full_scale_counts=255)
    found = pillarfield.solve(readings, skin=skin, rate_hz=rate_hz, noise_counts=generate.NOISE,
                              estimator=estimator, contacts=contacts)
    reports = [reports_of(list(found[t].contacts)) for t in range(len(found))] if contacts else []
    return (np.stack([found.shear_x, found.shear_y, found.normal], 1),
            dict(zip(REPORTS, np.transpose(np.array(reports, float)))) if contacts else {})


direct = functools.partial(product, "direct")
paper = functools.partial(product, "paper")
contact = functools.partial(product, "contact", contacts=True)


def reports_of(contacts):
    """The slip of all contacts, and the friction and the time to slip of the heaviest."""
    one = max(contacts, key=lambda each: each.normal_n, default=None)
    return slip_of(contacts), *(getattr(one, name, None) for name in (
        "friction", "friction_deviation", "time_to_slip_s", "time_to_slip_low_s", "time_to_slip_high_s"))


def slip_of(contacts):
    """The state of the contacts that bear a tenth of the load: partial if they differ, -1 where one is unknown."""
    load = sum(one.normal_n for one in contacts)
    states = {one.slip for one in contacts if one.normal_n >= 0.1 * load}
    if not states or "unknown" in states:
        return -1
    return ("sticking", "partial", "sliding").index(states.pop()) if len(states) == 1 else 1


def lengths(v, threshold):
    """The largest sum of a diagonal, 2 k normal, in region 3: the smaller usable reading; elsewhere 0."""
    usable = v > threshold
    return np.where(regions(usable) == 3, np.where(usable, v, np.inf).min(-1), 0)


def forces_of(v, k, threshold, diagonal):
    """Forces [T, 3, P, Q] of sensels [T, P, Q, 4]; diagonal [T, P, Q]: the sum of one where neither is usable."""
    usable, other = v > threshold, np.roll(v, 2, -1)
    whole = usable & (other > threshold)
    total = np.where(whole.any(-1), np.where(whole, v + other, 0).sum(-1) / np.maximum(whole.sum(-1), 1), diagonal)
    # An inactive sensel follows from parity; the others are usable, or both of a diagonal are not.
    v = np.where(usable, v, np.where(other > threshold, total[..., None] - other, total[..., None] / 2))
    v1, v2, v3, v4 = np.moveaxis(np.where(usable.any(-1, keepdims=True), v, 0), -1, 0) / k
    return np.stack([(v1 + v4 - v2 - v3) / 8**0.5, (v1 + v2 - v3 - v4) / 8**0.5, (v1 + v2 + v3 + v4) / 4], 1)


def penalty(readings, k, threshold, _rate_hz=None, friction=2.0, weight=1.0, steps=100):
    """Least sum over neighbours (N_i - N_j)^2 + weight * sum max(0, |s| - friction N)^2 on the segments, by projected
    gradients (shear towards usable sensels falls by sqrt(2) times the diagonal). Constants: a grid's best in training()."""
    v = sensels(readings.astype(float))
    length, loaded = lengths(v, threshold), np.pad((v > threshold).any(-1), ((0, 0), (1, 1), (1, 1)))
    diagonal = length / 2
    for _ in range(steps):
        x, y, n = 2 * k * np.moveaxis(forces_of(v, k, threshold, diagonal), 1, 0)
        shear, padded = np.hypot(x, y), np.pad(n, ((0, 0), (1, 1), (1, 1)))
        around = sum((np.roll(loaded, *way) * (padded - np.roll(padded, *way)))[:, 1:-1, 1:-1]
                     for way in ((1, 1), (-1, 1), (1, 2), (-1, 2)))
        slope = 2**0.5 * np.maximum(abs(x), abs(y)) / np.maximum(shear, 1e-9) + friction
        slope = around - weight * np.maximum(shear - friction * n, 0) * slope
        diagonal = np.clip(diagonal - slope / (8 + weight * (2**0.5 + friction)**2), 0, length)
    return forces_of(v, k, threshold, diagonal), {}


def patches(readings, threshold):
    """Places of the pillars of region 3; the readings of 5 x 5 pillars around each in this frame and the one before, over
    the sum of its own, turned so that its usable sensels are at +x."""
    usable = sensels(readings) > threshold
    places = np.nonzero(regions(usable) == 3)
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(readings.astype(float), ((1, 0), (4, 4), (4, 4))), (2, 10, 10))
    found = windows[places[0], 2 * places[1], 2 * places[2]]
    for turn, pair in enumerate(((0, 3), (2, 3), (1, 2), (0, 1))):
        which = usable[places][:, pair].all(-1)
        found[which] = np.rot90(found[which], turn, (2, 3))
    return places, np.minimum(found / found[:, 1:, 4:6, 4:6].sum((1, 2, 3), keepdims=True), 3).reshape(len(found), 200)


def training(seed, number):
    """Histories of other bodies: ellipsoids that are dragged until they slide, and on round corners."""
    rng = np.random.default_rng(seed)
    for index in range(number):
        friction, size = np.exp(rng.uniform(np.log((0.7, 1.5)), np.log((4.5, 12))))
        degrees, shape = rng.uniform((0, 0.8), (360, 1.25))
        frames = generate.drag_and_slide(*generate.cells(28, 28), size, friction, degrees, (shape, 1 / shape), rng.uniform(-0.5, 0.5, 2),
                                         (0, 0.3, 0.6, 0.9), [(turn, 1) for turn in (0, *rng.uniform(-90, 90, 2))])
        yield generate.history(frames, friction, (seed, index))


@functools.lru_cache
def trained(hidden=600, ridge=3.0):
    """The function from patches to the place on the segment, 0 to 1: ridge regression on rectified random projections."""
    inputs, targets = [], []
    for readings, forces, *_ in training(1000, 40):
        places, features = patches(readings, generate.THRESHOLD)
        inputs.append(features)
        targets.append(2 * generate.K * forces[:, 2][places] / lengths(sensels(readings), generate.THRESHOLD)[places])
    random = np.random.default_rng(1).normal(0, 1 / 200**0.5, (201, hidden))

    def lifted(features):
        return np.column_stack([np.maximum(features @ random[:-1] + random[-1], 0), np.ones(len(features))])

    lift = lifted(np.vstack(inputs))
    output = np.linalg.solve(lift.T @ lift + ridge * np.eye(hidden + 1), lift.T @ np.clip(np.concatenate(targets), 0, 1))
    return lambda features: np.clip(lifted(features) @ output, 0, 1)


def learnt(readings, k, threshold, _rate_hz=None):
    v = sensels(readings.astype(float))
    diagonal = lengths(v, threshold)
    places, features = patches(readings, threshold)
    diagonal[places] *= trained()(features)
    return forces_of(v, k, threshold, diagonal), {}
