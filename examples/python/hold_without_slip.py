"""A control loop on the slip margin: grips an ever heavier object as softly as it can.

The sensor is simulated: its next frame follows from the grip that the loop commands.
"""

import numpy as np

import pillarfield as pf

FRICTION = 0.9  # the loop does not know it
MARGIN = 0.3  # the reserve that it keeps
SAFE_FRICTION = 0.5  # assumed until the skin has observed it


def sense(grip_n: float, weight_n: float, index: int) -> pf.Simulation:
    """A frame of the skin under a fingertip that carries `weight_n` with the grip `grip_n`."""
    ratio = min(0.99, weight_n / (FRICTION * grip_n))
    contact = {"shape": "sphere", "motion": "partial_slip", "contact_radius_mm": 8,
               "position_mm": [0, 0], "friction": FRICTION, "direction_deg": -90, "tangential_ratio": ratio,
               "load_n": grip_n}
    return pf.simulate({"skin": {"pillars": [20, 20], "threshold_counts": 2},
                        "sensor": {"adc_bits": 8, "noise_counts": 0.5},
                        "time": {"seed": index}, "contact": [contact]})


grip_n, margins = 10.0, []
first = sense(grip_n, 2.0, 0)
plan = pf.Plan(first.skin, scene=first.scene)
with pf.Processor(plan, contacts=True) as processor:
    for index in range(80):
        weight_n = 2.0 + 0.1 * index
        processor.submit(sense(grip_n, weight_n, index).frames[0])
        contact = processor.receive().contacts[0]
        margins.append(1 - weight_n / (FRICTION * grip_n))  # the true one
        friction = contact.friction or SAFE_FRICTION
        shear_n = np.hypot(contact.shear_x_n, contact.shear_y_n)
        wanted_n = shear_n / (friction * (1 - MARGIN))
        grip_n *= min(1.3, max(0.95, wanted_n / contact.normal_n))  # grips fast, loosens slowly
        if index % 10 == 0:
            print(f"weight {weight_n:.1f} N, grip {grip_n:.2f} N, friction {friction:.2f}, "
                  f"{contact.slip}")

print(f"true margin: least {min(margins):.2f}, at the end {margins[-1]:.2f}; wanted {MARGIN}")
