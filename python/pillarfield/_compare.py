"""pillarfield.compare."""

from __future__ import annotations

import dataclasses

from . import _core
from ._field import ForceField
from ._status import Region


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Errors of solved forces.

    loaded: of all truly loaded pillars, or sensels without pillars
    regions: of the pillars of each true region; of sensels Region.NONE alone
    """

    loaded: _core.RegionErrors
    regions: dict[Region, _core.RegionErrors]

    def __repr__(self) -> str:
        errors = self.loaded
        elements = "pillars" if Region.THREE in self.regions else "sensels"
        return (f"<Comparison: {errors.pillars} loaded {elements}, RMS {errors.rms_n:.3g} N, "
                f"{100 * errors.rms_relative:.3g} %>")


def compare(solved: ForceField, truth: ForceField) -> Comparison:
    """Compares solved with true forces of the same frames by true region.

    Raises Error if they differ in shape or layout or the truth is not finite.
    """
    loaded, *regions = _core.compare(solved._batch(), truth._batch())
    known = list(Region) if truth.has_pillars else [Region.NONE]
    return Comparison(loaded, dict(zip(known, regions)))
