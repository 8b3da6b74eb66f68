"""First forces in ten lines: frames of readings in, newtons and a picture out."""

import numpy as np

import pillarfield as pf

frames = np.full((10, 40, 60), 100, np.uint16)  # your own: counts, [frames, sensel rows, columns]
frames[5:, 10:20, 20:40] += 160                 # 50 pillars are pressed in the second half

skin = pf.Skin(40, 60, layout="pillars")        # without skin= each sensel is by itself
unloaded = np.random.default_rng(1).normal(100, 1, (50, 40, 60)).round()
tare = pf.calibrate.tare(unloaded, skin=skin).calibration
forces = pf.solve(frames, calibration=tare, counts_per_newton=320, contacts=True)
print(forces)
print(forces[9].contacts[0])
print("total:", forces.normal.sum(axis=(1, 2)).round(2), "N")
with open("first_forces.png", "wb") as file:
    file.write(forces[9].picture())
