"""Trains a small network on simulated frames and races it with the estimator: speed and error.

Needs scikit-learn (Debian: python3-sklearn).
"""

import time
from typing import Any

import numpy as np
import numpy.typing as npt
from sklearn.neural_network import MLPRegressor  # type: ignore[import]

import pillarfield as pf

Floats = npt.NDArray[np.float32]
K = 320.0


def touch(seed: int, frames: int) -> pf.Simulation:
    """Frames of three balls of random size, place, load and friction: they slide, spin and press."""
    random = np.random.default_rng(seed)
    contacts = []
    for motion, x in (("slide", -30), ("spin", 0), ("press", 30)):
        radius, load = random.uniform(7, 11), random.uniform(15, 40)
        contact: dict[str, Any] = {
            "shape": "sphere", "motion": motion, "contact_radius_mm": radius,
            "reference_load_n": load,
            "path": [{"time_s": 0.0, "position_mm": [x, -8], "load_n": 0.4 * load},
                     {"time_s": 0.01 * frames, "position_mm": [x, 8], "load_n": load}]}
        if motion != "press":
            contact["friction"] = (0.6, 1.0, 1.5, 2.0)[seed % 4]
        if motion == "slide":
            contact["direction_deg"] = random.uniform(0, 360)
        contacts.append(contact)
    return pf.simulate({"skin": {"pillars": [40, 80], "threshold_counts": 2},
                        "sensor": {"adc_bits": 8, "noise_counts": 0.5},
                        "time": {"frames": frames, "seed": seed}, "contact": contacts})


def readings_of(frames: npt.NDArray[np.uint8]) -> Floats:
    """The four readings of each pillar, about newtons: [T, P, Q, 4]."""
    corners = [frames[:, row::2, col::2] for row, col in ((0, 1), (0, 0), (1, 0), (1, 1))]
    newtons: Floats = np.stack(corners, -1).astype(np.float32) / np.float32(K)
    return newtons


def forces_of(field: pf.ForceField) -> Floats:
    return np.stack([field.shear_x, field.shear_y, field.normal], -1)


train, test = [touch(seed, 6) for seed in range(1, 9)], touch(99, 100)
inputs = np.concatenate([readings_of(one.frames).reshape(-1, 4) for one in train])
targets = np.concatenate([forces_of(one.truth).reshape(-1, 3) for one in train])
touched = inputs.max(1) > 2 / K
network = MLPRegressor((32, 32), random_state=1, max_iter=150, tol=1e-6, n_iter_no_change=20)
network.fit(inputs[touched], targets[touched])

pf.solve(test)  # compiles the kernels
start = time.perf_counter()
solved = pf.solve(test)
estimator_s = time.perf_counter() - start

start = time.perf_counter()
given = readings_of(test.frames).reshape(-1, 4)
guessed = np.zeros((len(given), 3), np.float32)
chosen = given.max(1) > 2 / K
guessed[chosen] = network.predict(given[chosen])
network_s = time.perf_counter() - start

planes = guessed.reshape(*test.truth.shape, 3)
learnt = pf.ForceField(planes[..., 0], planes[..., 1], planes[..., 2], status=solved.status)
for name, field, seconds in (("estimator", solved, estimator_s), ("network", learnt, network_s)):
    errors = pf.compare(field, test.truth)
    one, three = errors.regions[pf.Region.ONE], errors.regions[pf.Region.THREE]
    print(f"{name:9} {1e6 * seconds / len(test.frames):6.0f} us a frame; RMS error "
          f"{1e3 * one.rms_n:.2f} mN in region 1, {1e3 * three.rms_n:.2f} mN in region 3, "
          f"{1e3 * errors.loaded.rms_n:.2f} mN in all")
