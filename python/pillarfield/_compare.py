"""pillarfield.compare."""

from __future__ import annotations

import dataclasses

from . import _core
from ._field import ForceField
from ._status import Region


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Errors of solved forces.

    loaded: of all truly loaded pillars
    regions: of the pillars of each true region
    """

    loaded: _core.RegionErrors
    regions: dict[Region, _core.RegionErrors]

    def __repr__(self) -> str:
        errors = self.loaded
        return (f"<Comparison: {errors.pillars} loaded pillars, RMS {errors.rms_n:.3g} N, "
                f"{100 * errors.rms_relative:.3g} %>")


def compare(solved: ForceField, truth: ForceField) -> Comparison:
    """Compares solved with true forces of the same frames by true region.

    Raises Error if they differ in shape or the truth is not finite.
    """
    loaded, *regions = _core.compare(solved._batch(), truth._batch())
    return Comparison(loaded, dict(zip(Region, regions)))
