"""pillarfield.compare."""

from __future__ import annotations

import dataclasses
import math
from typing import Optional

import numpy as np

from . import _core
from ._field import ForceField
from ._status import Region


@dataclasses.dataclass(frozen=True)
class ResultantErrors:
    """Errors of the resultant of all forces, a case for each frame.

    force: of (shear_x, shear_y, normal), N
    torque: about the centre of the patch, N mm; None without pillars or skin
    """

    force: _core.VectorErrors
    torque: Optional[_core.VectorErrors]


@dataclasses.dataclass(frozen=True)
class ContactErrors:
    """Errors by contact, over all frames.

    found, missed: true contacts with a solved one that shares pillars, and without
    extra: solved contacts without a true one
    missed_normal_n, extra_normal_n: the largest normal force of such, N
    force: of found contacts, N
    torque: about the normal through the true centre of pressure, N mm; None without pillars or skin
    centre: of pressure, mm; None without a skin
    """

    found: int
    missed: int
    extra: int
    missed_normal_n: float
    extra_normal_n: float
    force: _core.VectorErrors
    torque: Optional[_core.VectorErrors]
    centre: Optional[_core.VectorErrors]


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Errors of solved forces.

    loaded: of all truly loaded pillars, or sensels without pillars
    regions: of the pillars of each true region; of sensels Region.NONE alone
    true_rms_n: RMS of the true forces of loaded ones, N
    resultant, contacts: of what they add up to, in each frame and each contact
    """

    loaded: _core.RegionErrors
    regions: dict[Region, _core.RegionErrors]
    true_rms_n: float
    resultant: ResultantErrors
    contacts: ContactErrors

    def __repr__(self) -> str:
        errors, contacts = self.loaded, self.contacts
        elements = "pillars" if Region.THREE in self.regions else "sensels"
        force = self.resultant.force
        return (f"<Comparison: {errors.pillars} loaded {elements}, "
                f"RMS {errors.rms_n:.3g} N{_share(errors.rms_n, self.true_rms_n)}; "
                f"resultant {force.rms:.3g} N{_share(force.rms, force.true_rms)}; "
                f"contacts: {contacts.found} found, {contacts.missed} missed, {contacts.extra} extra>")


def _share(error: float, true: float) -> str:
    """The error in percent of the true value, unless that is too near zero to mean anything."""
    return f" ({100 * error / true:.2g} %)" if 100 * error <= 999 * true and true > 0 else ""


def compare(solved: ForceField, truth: ForceField) -> Comparison:
    """Compares solved with true forces of the same frames: by true region, by frame and by contact.

    Raises Error if they differ in shape or layout or the truth is not finite.

    >>> import numpy as np, pillarfield as pf
    >>> one = np.ones((1, 4, 6), np.float32)
    >>> pf.compare(pf.ForceField(0 * one, 0 * one, 1.1 * one), pf.ForceField(0 * one, 0 * one, one))
    <Comparison: 24 loaded pillars, RMS 0.1 N (10 %); resultant 2.4 N (10 %); contacts: 0 found, 1 missed, 0 extra>
    """
    skin = truth.skin or solved.skin
    pitch_mm = skin.element_pitch_mm if skin else 1.0
    loaded, regions, resultant, contacts = _core.compare(solved._batch(), truth._batch(), pitch_mm)
    squares = sum(float(np.square(truth._planes[name], dtype=float).sum())
                  for name in ("shear_x", "shear_y", "normal") if name in truth._planes)
    true_rms_n = math.sqrt(squares / max(1, loaded.pillars))
    if not skin or not truth.has_pillars:
        resultant["torque"] = contacts["torque"] = None
    if not skin:
        contacts["centre"] = None
    known = list(Region) if truth.has_pillars else [Region.NONE]
    return Comparison(loaded, dict(zip(known, regions)), true_rms_n, ResultantErrors(**resultant),
                      ContactErrors(**contacts))
