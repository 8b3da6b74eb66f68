"""Entries of the open benchmark: each function is one that score.py runs (docs/histories.md).

solve(readings [T, R, C], counts_per_newton, threshold_counts) -> forces [T, 3, P, Q], N, and slip [T] or None."""

import functools

import numpy as np

import generate
from half_space import along, cells, hertz, sliding

# --- Of the product ---


def product(estimator, readings, k, threshold, contacts=False):
    import pillarfield  # the NumPy entries do without
    skin = pillarfield.Skin(*readings.shape[1:], counts_per_newton=k, threshold_counts=threshold, full_scale_counts=255)
    forces = pillarfield.solve(readings, skin=skin, rate_hz=generate.RATE_HZ, estimator=estimator,
                               noise_counts=generate.NOISE, contacts=contacts)
    return np.stack([forces.shear_x, forces.shear_y, forces.normal], 1), forces


def direct(*given):
    return product("direct", *given)[0], None


def paper(*given):
    return product("paper", *given)[0], None


def contact(*given):
    forces, field = product("contact", *given, contacts=True)
    return forces, np.array([slip_of(field[t].contacts) for t in range(len(field))])


def slip_of(contacts):
    """The state that all contacts share that bear a tenth of the load, partial if they differ, -1 where one is unknown."""
    states = {one.slip for one in contacts if one.normal_n >= 0.1 * sum(other.normal_n for other in contacts)}
    if not states or "unknown" in states:
        return -1
    return ("sticking", "partial", "sliding").index(states.pop()) if len(states) == 1 else 1


# --- The model of a pillar, by NumPy ---


def sensels(readings):
    """Readings of sensels 1 to 4, [..., P, Q, 4]."""
    v = np.asarray(readings, float)
    return np.stack([v[..., 0::2, 1::2], v[..., 0::2, 0::2], v[..., 1::2, 0::2], v[..., 1::2, 1::2]], -1)


def ambiguous(usable):
    """Pillars of two usable sensels side by side, region 3."""
    return (usable.sum(-1) == 2) & ~(usable[..., 0] & usable[..., 2]) & ~(usable[..., 1] & usable[..., 3])


def segment_length(v, threshold):
    """Largest sum of a diagonal, 2 k normal, in region 3: the smaller usable reading; elsewhere 0."""
    usable = v > threshold
    return np.where(ambiguous(usable), np.where(usable, v, np.inf).min(-1), 0)


def forces_of(v, k, threshold, diagonal):
    """Forces [T, 3, P, Q], N; `diagonal` [T, P, Q]: the sum of a diagonal where none has both sensels usable."""
    usable = v > threshold
    whole = usable & np.roll(usable, 2, -1)
    total = np.where(whole, v + np.roll(v, 2, -1), 0).sum(-1) / np.maximum(whole.sum(-1), 1)
    total = np.where(whole.any(-1), total, diagonal)[..., None]
    # A lifted sensel follows from parity; where both of a diagonal are, nothing says which bears more.
    filled = np.where(usable, v, np.where(np.roll(usable, 2, -1), total - np.roll(v, 2, -1), total / 2))
    filled = np.where(usable.any(-1)[..., None], filled, 0)
    v1, v2, v3, v4 = np.moveaxis(filled, -1, 0)
    shear = np.array([v1 + v4 - v2 - v3, v1 + v2 - v3 - v4]) / (2 * np.sqrt(2) * k)
    return np.moveaxis(np.array([*shear, (v1 + v2 + v3 + v4) / (4 * k)]), 0, 1)


# --- A penalty model ---


def penalty(readings, k, threshold, friction=1.5, weight=0.3, steps=100):
    """Normal forces that vary little between neighbours, and a penalty on shear beyond a fixed friction: the least of
    sum over neighbours (N_i - N_j)^2 + weight sum max(0, |s| - friction N)^2 over the segments, by projected
    gradients. Friction and weight are the best of a grid on the training histories of `learnt`."""
    v = sensels(readings)
    length = segment_length(v, threshold)
    loaded = np.pad((v > threshold).any(-1), ((0, 0), (1, 1), (1, 1)))
    t = np.full(length.shape, 0.5)
    for _ in range(steps):
        x, y, n = 2 * k * np.moveaxis(forces_of(v, k, threshold, t * length), 1, 0)
        shear = np.hypot(x, y)
        beyond = np.maximum(shear - friction * n, 0)
        # With the diagonal's sum S = 2 k N: the shear towards the usable sensels falls by sqrt(2) S.
        towards = np.maximum(abs(x), abs(y)) / np.maximum(shear, 1e-9)
        padded = np.pad(n, ((0, 0), (1, 1), (1, 1)))
        around = 0
        for axis, way in ((1, 1), (1, -1), (2, 1), (2, -1)):
            near = (np.roll(loaded, way, axis) * (padded - np.roll(padded, way, axis)))[:, 1:-1, 1:-1]
            around = around + near
        slope = around - weight * beyond * (np.sqrt(2) * towards + friction)
        step = 1 / (8 + weight * (np.sqrt(2) + friction)**2)
        t = np.clip(t - step * slope / np.maximum(length, 1), 0, 1)
    return forces_of(v, k, threshold, t * length), None


# --- A learnt baseline ---


def patches(readings, threshold):
    """Per pillar of region 3: its place, and the readings of 5 x 5 pillars around it in this frame and the one before,
    over those of its usable sensels, turned so that these point to +x."""
    v = sensels(readings)
    usable = v > threshold
    places, turns = np.nonzero(ambiguous(usable)), {(0, 3): 0, (0, 1): 3, (1, 2): 2, (2, 3): 1}
    padded = np.pad(np.asarray(readings, float), ((1, 0), (4, 4), (4, 4)))
    rows = []
    for t, r, c in zip(*places):
        window = padded[t:t + 2, 2 * r:2 * r + 10, 2 * c:2 * c + 10]
        pair = tuple(np.nonzero(usable[t, r, c])[0])
        rows.append((np.rot90(window, turns[pair], (1, 2)) / v[t, r, c, list(pair)].sum()).ravel())
    return places, np.minimum(np.array(rows).reshape(-1, 200), 3)


def training(seed=1000, number=60):
    """Histories of other bodies: one ellipsoid each, pressed, tilted or dragged, that slides and spins."""
    rng = np.random.default_rng(seed)
    x, y = cells(22, 22, 4)
    for index in range(number):
        friction, angle, size = np.exp(rng.uniform(-0.4, 1.5)), rng.uniform(0, 2 * np.pi), rng.uniform(1.5, 8)
        shape, step, spin = rng.uniform(0.8, 1.25), rng.uniform(0.1, 0.5), rng.choice([0, 0, 0.1, -0.2])
        frames = []
        for t in range(6):
            at = (step * max(t - 3, 0) * np.cos(angle), step * max(t - 3, 0) * np.sin(angle))
            p = hertz(x - at[0], y - at[1], size * (0.7 if t == 0 else 1), (shape, 1 / shape))
            if t < 4:
                share = t / 4
                core = 0 if index % 3 == 0 else hertz(x, y, size * (1 - share)**(1 / 3), (shape, 1 / shape))
                shear = share * p if index % 3 == 0 else (p - core) * (t > 0)
                frames.append(along(p, friction * shear, angle))
            else:
                frames.append(sliding(x, y, p, friction, (np.cos(angle), np.sin(angle)), spin, at))
        yield generate.history(frames, friction, 4, [seed, index])[:2]


def lifted(features, weights):
    """Rectified random projections of patches, and a constant."""
    hidden = np.maximum(features @ weights[:-1] + weights[-1], 0)
    return np.hstack([hidden, np.ones((len(hidden), 1))])


@functools.lru_cache
def trained(hidden=600, ridge=3.0):
    """Weights of random features and of the ridge regression from them to the place on the segment, 0 to 1."""
    inputs, targets = [], []
    for readings, forces in training():
        places, features = patches(readings, generate.THRESHOLD)
        length = segment_length(sensels(readings), generate.THRESHOLD)[places]
        inputs.append(features)
        targets.append(np.clip(2 * generate.K * forces[places[0], 2, places[1], places[2]] / length, 0, 1))
    features, targets = np.vstack(inputs), np.concatenate(targets)
    random = np.random.default_rng(1).normal(0, 1 / np.sqrt(features.shape[1]), (features.shape[1] + 1, hidden))
    lift = lifted(features, random)
    return random, np.linalg.solve(lift.T @ lift + ridge * np.eye(hidden + 1), lift.T @ targets)


def learnt(readings, k, threshold):
    v = sensels(readings)
    diagonal = segment_length(v, threshold)
    places, features = patches(readings, threshold)
    random, output = trained()
    diagonal[places] *= np.clip(lifted(features, random) @ output, 0, 1)
    return forces_of(v, k, threshold, diagonal), None
