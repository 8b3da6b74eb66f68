"""Calibrates a skin in three steps, here a simulated one, and compares forces with the truth."""

import math
from typing import Any, Optional

import pillarfield as pf

SKIN = {"pillars": [24, 32], "counts_per_newton": 1400}
SENSOR = {"adc_bits": 12, "noise_counts": 1.0, "gain_spread": 0.08, "tare_counts": 60,
          "tare_spread_counts": 6}


def record(contact: Optional[dict[str, Any]] = None) -> pf.Simulation:
    """Frames of the skin; on your bench they come from the sensor."""
    return pf.simulate({"skin": SKIN, "sensor": SENSOR, "time": {"frames": 30},
                        "contact": [contact] if contact else []})


def ball(load_n: float, radius_mm: float) -> dict[str, Any]:
    """A ball that presses with a known load."""
    return {"shape": "sphere", "motion": "press", "position_mm": [0, 0],
            "contact_radius_mm": radius_mm, "load_n": load_n}


def cushion(pressure_kpa: float) -> dict[str, Any]:
    """Even pressure: the middle of a very wide punch, where the pressure is load / (2 pi radius^2)."""
    radius_mm = 300.0
    return {"shape": "flat_punch", "motion": "press", "position_mm": [0, 0],
            "contact_radius_mm": radius_mm, "load_n": pressure_kpa * 1e-3 * 2 * math.pi * radius_mm**2}


unloaded = record()
step = pf.calibrate.tare(unloaded.frames, skin=unloaded.skin)  # a skin with pillars
print(f"tare {step.facts['tare_counts']:.1f} counts, noise {step.facts['noise_counts']:.2f} counts")

presses = [(record(cushion(kpa)).frames, kpa) for kpa in (200, 400, 800)]
step = pf.calibrate.equilibrate(presses, step.calibration)
print(f"gains spread by {100 * step.facts['gain_spread']:.1f} %")

step = pf.calibrate.load([(record(ball(60, 8)).frames, 60.0)], step.calibration)
print(f"{step.calibration.counts_per_newton:.0f} counts per newton")
step.calibration.save("skin.h5", overwrite=True)

touch = record(ball(40, 6))
solved = pf.solve(touch.frames, calibration="skin.h5", threshold_counts=8)
print(f"solved {solved.normal.sum(axis=(1, 2)).mean():.2f} N of 40 N")
print(pf.compare(solved, touch.truth))
