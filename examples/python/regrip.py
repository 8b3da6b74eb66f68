"""A gripper that grips anew before its load slips, by the time that the skin foretells.

The sensor is simulated: the load grows, and the next frame follows from it and from the grip.
"""

import pillarfield as pf

RATE_HZ = 30
SECONDS = 9
FRICTION = 0.9  # the loop does not know it
GROWTH_N_PER_S = 1.5  # nor this


def sense(grip_n: float, load_n: float, index: int) -> pf.Simulation:
    """A frame of the skin under a fingertip that carries `load_n` with the grip `grip_n`."""
    contact = {"shape": "sphere", "motion": "partial_slip", "contact_radius_mm": 8,
               "position_mm": [0, 0], "friction": FRICTION, "direction_deg": -90,
               "tangential_ratio": min(0.999, load_n / (FRICTION * grip_n)), "load_n": grip_n}
    return pf.simulate({"skin": {"pillars": [20, 20], "threshold_counts": 2},
                        "sensor": {"adc_bits": 8, "noise_counts": 0.5},
                        "time": {"seed": index}, "contact": [contact]})


grip_n, leads_s, least_s = 5.0, [], float("inf")
first = sense(grip_n, 2.0, 0)
plan = pf.Plan(first.skin, scene=first.scene)
with pf.Processor(plan, contacts=True) as processor:
    for index in range(RATE_HZ * SECONDS):
        load_n = 2.0 + GROWTH_N_PER_S * index / RATE_HZ
        true_s = (FRICTION * grip_n - load_n) / GROWTH_N_PER_S  # until it slips
        least_s = min(least_s, true_s)
        processor.submit(sense(grip_n, load_n, index).frames[0], index / RATE_HZ)
        contact = processor.receive().contacts[0]
        if (contact.slip_within_1_s or 0) > 0.5:
            print(f"{index / RATE_HZ:.2f} s: load {load_n:.1f} N, grip {grip_n:.1f} N; foretold slip in "
                  f"{contact.time_to_slip_s:.2f} s (true {true_s:.2f} s): grips anew")
            leads_s.append(true_s)
            grip_n *= 1.5

print(f"gripped anew {len(leads_s)} times, at least {min(leads_s):.2f} s before slip; "
      f"never nearer than {least_s:.2f} s")
