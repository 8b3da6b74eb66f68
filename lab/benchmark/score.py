"""score.py HISTORIES [--json] ENTRY...: scores entries on the histories in a folder (docs/histories.md).

An ENTRY is a folder of force files with the names of the histories, or FILE.py:FUNCTION, which is run and timed."""

import argparse
import importlib.util
import json
import sys
import time
from pathlib import Path

import h5py
import numpy as np

COMPONENTS = ("shear_x", "shear_y", "normal")
STICKING, SLIDING = 0.1, 0.9  # shares of the load that slips, up to which and from which a frame is in that state
SECONDS = 0.5  # about the time of a history many times over, by which an entry is timed


class Failure(Exception):
    """One line for the user: place, failure and remedy."""


def planes(file, group):
    """Forces [T, 3, P, Q] of a group."""
    return np.stack([np.asarray(file[f"{group}/{name}"], float) for name in COMPONENTS], 1)


class History:
    def __init__(self, path):
        with h5py.File(path) as file:
            self.readings, self.truth = file["frames/raw"][:], planes(file, "truth")
            self.slip_share = file["truth/slip_share"][:]
            self.k, self.threshold = (float(file["skin"].attrs[name]) for name in
                                      ("counts_per_newton", "threshold_counts"))
        self.name = Path(path).stem


def regions(readings, threshold):
    """Usable sensels of each pillar [T, P, Q]; 2 only of neighbours, -1 of opposite ones."""
    usable = readings > threshold
    v1, v2, v3, v4 = usable[:, ::2, 1::2], usable[:, ::2, ::2], usable[:, 1::2, ::2], usable[:, 1::2, 1::2]
    count = np.sum([v1, v2, v3, v4], axis=0)
    return np.where((count == 2) & ((v1 & v3) | (v2 & v4)), -1, count)


def slip_states(share):
    """0 sticking, 1 partial, 2 sliding."""
    return 1 - (share <= STICKING) + (share >= SLIDING)


def score(history, forces, slip=None):
    """Errors of an entry. Slip: a state a frame, -1 if unknown."""
    if forces.shape != history.truth.shape or not np.isfinite(forces).all():
        raise Failure(f"{history.name}: the forces have the shape {forces.shape}, and must be finite and have "
                      f"{history.truth.shape}")
    slip = np.full(len(forces), -1) if slip is None else np.asarray(slip)
    if slip.shape != history.slip_share.shape:
        raise Failure(f"{history.name}: slip has the shape {slip.shape}; write one state a frame")
    squares = (history.k**2 * (forces - history.truth)**2).sum(1)
    region = regions(history.readings, history.threshold)
    sums, true_sums = forces.sum((2, 3)), history.truth.sum((2, 3))
    pressed = true_sums[:, 2] > 0
    off = np.linalg.norm(sums - true_sums, axis=1)[pressed] / np.linalg.norm(true_sums, axis=1)[pressed]
    truth = slip_states(history.slip_share)[pressed]

    def rms(where):
        return float(np.sqrt(squares[where].mean())) if where.any() else None

    return {"region_3": rms(region == 2), "others": rms((region == 3) | (region == 4)), "field": rms(region != 0),
            "resultant": float(np.sqrt((off**2).mean())), "slip_right": float((slip[pressed] == truth).mean()),
            "slip_wrong": float(((slip[pressed] != truth) & (slip[pressed] >= 0)).mean())}


def function_of(entry):
    path, name = entry.rsplit(":", 1)
    sys.path.insert(0, str(Path(path).resolve().parent))
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    module = sys.modules.setdefault(spec.name, importlib.util.module_from_spec(spec))
    if not hasattr(module, name):
        spec.loader.exec_module(module)
    return getattr(module, name)


def read(folder, history):
    with h5py.File(Path(folder, f"{history.name}.h5")) as file:
        return planes(file, "force"), file["slip"][:] if "slip" in file else None


def seconds_a_frame(solve, histories):
    """Processor time of a further frame: that of each history many times over, less that of once."""
    def timed(frames, history):
        start = time.process_time()
        solve(frames, history.k, history.threshold)
        return time.process_time() - start

    total = frames = 0
    for history in histories:
        once = timed(history.readings, history)
        times = int(np.clip(SECONDS / once, 3, 500))
        total += timed(np.concatenate([history.readings] * times), history) - once
        frames += (times - 1) * len(history.readings)
    return total / frames


def evaluate(entry, histories):
    """Scores of an entry: of each history, their means, and its seconds a frame if it is run."""
    solve = function_of(entry) if ".py:" in entry else None
    scores = {history.name: score(history, *(solve(history.readings, history.k, history.threshold) if solve
                                             else read(entry, history))) for history in histories}
    means = {}
    for key in next(iter(scores.values())):
        values = [each[key] for each in scores.values() if each[key] is not None]
        means[key] = sum(values) / len(values) if values else None
    return {"histories": scores, "mean": means, "seconds": solve and seconds_a_frame(solve, histories)}


def name_of(entry):
    return entry.rsplit(":", 1)[1] if ".py:" in entry else Path(entry).name


def rows(found):
    """Cells of a table: entry, counts in region 3, other regions, all; resultant, slip right and wrong, %; time."""
    reference = found.get("direct", {}).get("seconds")
    for name, one in found.items():
        mean = one["mean"]
        yield [f"`{name}`", *("–" if mean[key] is None else f"{mean[key]:.2f}" for key in ("region_3", "others", "field")),
               f"{100 * mean['resultant']:.1f}", *(f"{100 * mean[key]:.0f}" for key in ("slip_right", "slip_wrong")),
               f"{one['seconds'] / reference:.1f}" if reference and one["seconds"] else "–"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("histories")
    parser.add_argument("entries", nargs="+", metavar="ENTRY")
    parser.add_argument("--json", action="store_true", help="scores of each history too")
    given = parser.parse_args()
    try:
        histories = [History(path) for path in sorted(Path(given.histories).glob("*.h5"))]
        if not histories:
            raise Failure(f"{given.histories}: it has no histories; write them with generate.py")
        found = {name_of(entry): evaluate(entry, histories) for entry in given.entries}
    except (Failure, OSError, KeyError) as failure:
        sys.exit(f"score.py: {failure}")
    if given.json:
        json.dump(found, sys.stdout, indent=1)
        return
    for row in [["entry", "region 3", "others", "all", "resultant %", "right %", "wrong %", "time"], *rows(found)]:
        print("".join(cell.ljust(13) for cell in row))


if __name__ == "__main__":
    main()
