"""Frames of which the tests know the forces."""

import numpy as np

import pillarfield as pf

K = 320.0  # counts per newton


def scene(frames=12, **skin):
    """A ball that presses and slides: 8-bit frames of 40 x 60 sensels."""
    return {"skin": {"pillars": [20, 30], "threshold_counts": 2, **skin},
            "sensor": {"adc_bits": 8, "noise_counts": 0.5},
            "time": {"rate_hz": 50, "frames": frames},
            "contact": [{"shape": "sphere", "motion": "slide", "contact_radius_mm": 8,
                         "reference_load_n": 20, "friction": 0.6, "direction_deg": 0,
                         "path": [{"time_s": 0.0, "position_mm": [-5, 0], "load_n": 15},
                                  {"time_s": 0.2, "position_mm": [5, 0], "load_n": 20}]}]}


def plan_of(simulation, **options):
    return pf.Plan(simulation.skin, sensel_type=str(simulation.frames.dtype),
                   scene=simulation.scene, calibration=simulation.calibration, **options)


def forces_of_region_one(frames):
    """Forces of pillars whose four sensels press, by the inverse of the paper's equation (1)."""
    v2, v1 = frames[:, 0::2, 0::2].astype(float), frames[:, 0::2, 1::2].astype(float)
    v3, v4 = frames[:, 1::2, 0::2].astype(float), frames[:, 1::2, 1::2].astype(float)
    scale = 4 * K
    return (np.sqrt(2) * (v1 + v4 - v2 - v3) / scale, np.sqrt(2) * (v1 + v2 - v3 - v4) / scale,
            (v1 + v2 + v3 + v4) / scale)
