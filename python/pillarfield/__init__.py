"""Fields of force from frames of a tactile skin: three axes of pillars, pressure of bare sensels.

>>> import numpy as np, pillarfield as pf
>>> frames = np.zeros((3, 8, 12), np.uint8)     # counts [frames, sensel rows, columns]
>>> frames[:, 2:4, 4:6] = 80                    # one pillar is pressed
>>> pf.solve(frames, counts_per_newton=320).normal.shape        # each sensel by itself, N
(3, 8, 12)
>>> forces = pf.solve(frames, counts_per_newton=320, layout="pillars")
>>> float(forces.normal[0, 1, 2])               # 2 x 2 sensels are a pillar, N
0.25

docs/python.md is the manual.
"""

from . import _arguments as _arguments  # Wraps the functions that the others import.
from . import _pickle as _pickle  # Registers what it pickles.
from . import calibrate
from ._compare import Comparison, ContactErrors, ResultantErrors, compare
from ._core import (Calibration, Contact, ContactTotal, Device, FrameContacts, Plan, RegionErrors,
                    Scene, Skin, Surface, VectorErrors, __version__, devices)
from ._doctor import ArrayFinding, Diagnosis, doctor
from ._error import Error
from ._field import ForceField, Intervals, Points, Uncertainty
from ._live import Frame, LiveForces, LiveSink, LiveSource, live, live_forces, sink
from ._processor import Contacts, Processor
from ._recording import ForceFile, Recording, open, save_recording
from ._scene import Simulation, scene, simulate
from ._solve import solve, solve_to_file
from ._status import Region, Status
from .calibrate import SenselFinding

__all__ = ["ArrayFinding", "Calibration", "Comparison", "Contact", "ContactErrors", "ContactTotal", "Contacts",
           "Device", "Diagnosis", "Error", "ForceField", "ForceFile", "Frame", "FrameContacts", "Intervals",
           "LiveForces", "LiveSink", "LiveSource", "Plan", "Points", "Processor", "Recording", "Region",
           "RegionErrors", "ResultantErrors", "Scene", "SenselFinding", "Simulation", "Skin",
           "Status", "Surface", "Uncertainty", "VectorErrors", "__version__", "calibrate",
           "compare", "devices", "doctor", "live", "live_forces", "open", "save_recording", "scene",
           "simulate", "sink", "solve", "solve_to_file"]
