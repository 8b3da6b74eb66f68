"""score.py HISTORIES ENTRY...: scores entries on the histories in a folder (docs/histories.md).

An ENTRY is a folder of files of forces with the names of the histories, or MODULE:FUNCTION, which is run and timed."""

import importlib
import sys
import time
from pathlib import Path

import h5py
import numpy as np


def planes(file, group):
    """Forces [T, 3, P, Q] of a group."""
    return np.stack([np.asarray(file[f"{group}/{name}"], float) for name in ("shear_x", "shear_y", "normal")], 1)


class History:
    def __init__(self, path):
        with h5py.File(path) as file:
            self.name, self.readings, self.truth = Path(path).stem, file["frames/raw"][:], planes(file, "truth")
            self.slip_share = file["truth/slip_share"][:]
            self.skin = tuple(float(file["skin"].attrs[name]) for name in ("counts_per_newton", "threshold_counts"))


def sensels(readings):
    """Readings of sensels 1 to 4, [T, P, Q, 4]."""
    return np.stack([readings[:, row::2, col::2] for row, col in ((0, 1), (0, 0), (1, 0), (1, 1))], -1)


def regions(usable):
    """The paper's regions 1 to 4 from the usable sensels [..., 4]; 0: none, or two opposite ones."""
    opposite = (usable & np.roll(usable, 2, -1)).any(-1)
    return np.where((usable.sum(-1) == 2) & opposite, 0, (5 - usable.sum(-1)) % 5)


def slip_states(share):
    """0 sticking, 1 partial, 2 sliding, from the share of the load that slips."""
    return 1 - (share <= 0.1) + (share >= 0.9)


def score(history, forces, slip=None):
    """Errors of an entry on a history; slip: a state a frame, -1 if unknown."""
    slip = np.full(len(forces), -1) if slip is None else np.asarray(slip)
    if forces.shape != history.truth.shape or slip.shape != forces.shape[:1] or not np.isfinite(forces).all():
        raise ValueError(f"{history.name}: forces {forces.shape} and slip {slip.shape}; give {history.truth.shape} "
                         f"finite forces and {history.truth.shape[:1]} states")
    squares = history.skin[0]**2 * ((forces - history.truth)**2).sum(1)  # counts^2
    region = regions(sensels(history.readings) > history.skin[1])
    off, total = (np.linalg.norm(each.sum((2, 3)), axis=1) for each in (forces - history.truth, history.truth))
    right = slip == slip_states(history.slip_share)

    def rms(where):
        return np.sqrt(squares[where].mean()) if where.any() else np.nan

    return {"region_3": rms(region == 3), "regions_1_2": rms((region == 1) | (region == 2)), "all": rms(region > 0),
            "resultant_%": 100 * np.sqrt(((off / total)**2).mean()),
            "slip_right_%": 100 * right.mean(), "slip_wrong_%": 100 * (~right & (slip >= 0)).mean()}


def seconds_a_frame(solve, histories):
    """Processor time of a further frame: that of each history many times over, less that of once."""
    total = frames = 0
    for history in histories:
        before = time.process_time()
        solve(history.readings, *history.skin)
        start = time.process_time()
        times = int(np.clip(0.5 / max(start - before, 1e-6), 3, 500))
        solve(np.concatenate([history.readings] * times), *history.skin)
        total += time.process_time() - start - (start - before)
        frames += (times - 1) * len(history.readings)
    return total / frames


def evaluate(entry, histories):
    """Name of an entry, its scores on each history, and its seconds a frame if it is run."""
    if ":" not in entry:
        scores = []
        for each in histories:
            with h5py.File(Path(entry, f"{each.name}.h5")) as file:
                scores.append(score(each, planes(file, "force"), file["slip"][:] if "slip" in file else None))
        return Path(entry).name, scores, None
    module, name = entry.split(":")
    solve = getattr(importlib.import_module(module), name)
    scores = [score(each, *solve(each.readings, *each.skin)) for each in histories]
    return name, scores, seconds_a_frame(solve, histories)


def table(found):
    """Rows of cells, the head first: means over the histories, and time over that of `direct`."""
    reference = next((seconds for name, _, seconds in found if name == "direct"), None)
    yield ["entry", *(key.replace("_", " ") for key in found[0][1][0]), "time"]
    for name, scores, seconds in found:
        means = [np.nanmean([one[key] for one in scores]) for key in scores[0]]
        yield [name, *(f"{mean:.{2 if index < 3 else 1}f}" for index, mean in enumerate(means)),
               f"{seconds / reference:.1f}" if seconds and reference else "-"]


def run(folder, entries):
    """The histories of a folder, and what evaluate() finds of each entry."""
    sys.path.append(".")
    histories = [History(path) for path in sorted(Path(folder).glob("*.h5"))]
    if not histories:
        raise ValueError(f"{folder}: there are no histories; write them with generate.py")
    return histories, [evaluate(entry, histories) for entry in entries]


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        for line in table(run(sys.argv[1], sys.argv[2:])[1]):
            print("".join(cell.ljust(15) for cell in line))
    except (ValueError, OSError, KeyError, ImportError, AttributeError) as failure:
        sys.exit(f"score.py: {failure}")
