"""Forces as columns of a LeRobotDataset, by its version 0.6.2 of August 2026 (format v3.0)."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ._error import Error

Columns = dict[str, npt.NDArray[np.float32]]
Features = dict[str, dict[str, Any]]


def columns_and_features(planes: Columns, name: str) -> tuple[Columns, Features]:
    """What ForceField.to_lerobot() returns, of planes of forces by their names.

    LeRobot compares shapes as tuples, takes `names` as those of the last axis, and its statistics
    are over all axes but that.
    """
    if not name or "/" in name:
        raise Error("ForceField.to_lerobot", f"'{name}' is not a name of a feature",
                    "give one of one letter or more, without '/'")
    column = np.stack(list(planes.values()), -1)
    key = f"observation.tactile.{name}"
    return {key: column}, {key: {"dtype": "float32", "shape": column.shape[-3:],
                                 "names": list(planes)}}
