"""The status byte of a pillar."""

import enum

import numpy as np

from . import _core


class Status(enum.IntFlag):
    """Bits of a status byte: usable readings of a pillar and the reliability of its force.

    >>> import pillarfield as pf
    >>> pf.Status(17)
    <Status.SENSEL_1|AMBIGUOUS: 17>
    """

    SENSEL_1 = 1  #: the upper right sensel is usable
    SENSEL_2 = 2  #: upper left
    SENSEL_3 = 4  #: lower left
    SENSEL_4 = 8  #: lower right
    USABLE = 15  #: mask of the four; 0: no contact
    AMBIGUOUS = 16  #: the readings allow a segment of forces, or two regions
    SATURATED = 32  #: a sensel is at full scale
    INCONSISTENT = 64  #: a sensel is missing, or readings contradict
    FROM_CONTACT = 128  #: resolved by the friction of its contact


class Region(enum.IntEnum):
    """Regions of the paper, by the number of usable readings."""

    NONE = 0  #: nothing usable: no contact
    ONE = 1  #: four usable
    TWO = 2  #: three usable
    THREE = 3  #: two adjacent usable: the force lies on a segment
    FOUR = 4  #: one usable: nearly pure shear, or a reading near the threshold
    OPPOSITE = 5  #: only two opposite usable: a fault


#: Region of each status byte.
REGIONS = np.frombuffer(_core.regions(), np.uint8)
