"""score.py HISTORIES ENTRY...: scores entries on the histories in a folder (docs/histories.md).

An ENTRY is a folder of files of forces with the names of the histories, or MODULE:FUNCTION, which is run and timed."""

import importlib
import sys
import time
from pathlib import Path

import h5py
import numpy as np

# Reports of an entry on each frame, NaN for none: a state of slip (-1: unknown), a coefficient, and seconds.
REPORTS = ("slip", "friction", "friction_deviation", "time_to_slip", "time_to_slip_low", "time_to_slip_high")
ALARM_S, EARLY_S = 0.3, 1  # an alarm is a time to slip up to the first, and false if the true one is above the second
# Name, unit and digits of each score
SCORES = {"region 3": 2, "regions 1, 2": 2, "all": 2, "resultant, %": 1, "slip right, %": 1, "wrong, %": 1}
FRICTION_SCORES = {"reports, %": 0, "off > 10 %, %": 0, "inside 1.96, %": 0}
TIME_SCORES = {"reports, %": 0, "inside 95 %, %": 0, "alarm before slip, s": 2, "false alarms": 1}


def planes(file, group):
    """Forces [T, 3, P, Q] of a group."""
    return np.stack([np.asarray(file[f"{group}/{name}"], float) for name in ("shear_x", "shear_y", "normal")], 1)


class History:
    def __init__(self, path):
        with h5py.File(path) as file:
            self.name, self.seed = Path(path).stem.rsplit(".", 1)
            self.readings, self.truth, self.slip_share = file["frames/raw"][:], planes(file, "truth"), file["truth/slip_share"][:]
            self.friction, self.kind = (file["truth"].attrs[name] for name in ("friction", "class"))
            self.rate_hz = 1 / (file["frames/time"][1] - file["frames/time"][0])
            self.skin = tuple(float(file["skin"].attrs[name]) for name in ("counts_per_newton", "threshold_counts"))

    def time_to_slip(self):
        """Seconds until all of the body slips [T], NaN from then on."""
        begin = np.flatnonzero(slip_states(self.slip_share) == 2)
        left = ((begin[0] if len(begin) else np.nan) - np.arange(len(self.truth))) / self.rate_hz
        return np.where(left > 0, left, np.nan)


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


def percent(where, of):
    """Share of `of` that is in `where` too, NaN of none."""
    return 100 * (where & of).sum() / of.sum() if of.any() else np.nan


def score(history, forces, reports=None):
    """Scores of an entry on a history: of its forces and slip, of its friction, of its time to slip."""
    frames = len(history.truth)
    found = {name: np.asarray((reports or {}).get(name, np.full(frames, np.nan)), float) for name in REPORTS}
    if forces.shape != history.truth.shape or not np.isfinite(forces).all() or any(
            each.shape != (frames,) for each in found.values()):
        raise ValueError(f"{history.name}: forces {forces.shape} and reports {[each.shape for each in found.values()]}; give "
                         f"{history.truth.shape} finite forces and {(frames,)} reports")
    squares = history.skin[0]**2 * ((forces - history.truth)**2).sum(1)  # counts^2
    region = regions(sensels(history.readings) > history.skin[1])
    off, total = (np.linalg.norm(each.sum((2, 3)), axis=1) for each in (forces - history.truth, history.truth))
    right = found["slip"] == slip_states(history.slip_share)

    def rms(where):
        return np.sqrt(squares[where].mean()) if where.any() else np.nan

    of_forces = (rms(region == 3), rms((region == 1) | (region == 2)), rms(region > 0),
                 100 * np.sqrt(((off / total)**2).mean()), 100 * right.mean(), 100 * (~right & (found["slip"] >= 0)).mean())
    return dict(zip(SCORES, of_forces)), friction_score(history, found), time_score(history, found)


def friction_score(history, found):
    """Frames with a report, and of these those off by more than 10 %, and within 1.96 stated deviations."""
    off, reported = abs(found["friction"] - history.friction), np.isfinite(found["friction"] + found["friction_deviation"])
    return dict(zip(FRICTION_SCORES, (100 * reported.mean(), percent(off > 0.1 * history.friction, reported),
                                      percent(off <= 1.96 * found["friction_deviation"], reported))))


def time_score(history, found):
    """Of the frames under shear before the body slides; alarms are sequences of frames, the first that is not false counts."""
    true_s, stated = history.time_to_slip(), found["time_to_slip"]
    loaded = np.isfinite(true_s) & (np.hypot(*history.truth[:, :2].sum((2, 3)).T) > 0)
    reported, high = loaded & np.isfinite(stated), np.where(np.isnan(found["time_to_slip_high"]), np.inf, found["time_to_slip_high"])
    inside = (found["time_to_slip_low"] <= true_s) & (true_s <= high)
    alarm = np.isfinite(true_s) & (stated <= ALARM_S)
    begins = np.flatnonzero(alarm & ~np.roll(alarm, 1))
    early = true_s[begins] > EARLY_S
    lead = true_s[begins[~early][0]] if (~early).any() else 0 if np.isfinite(true_s).any() else np.nan
    return dict(zip(TIME_SCORES, (percent(reported, loaded), percent(inside, reported), lead, early.sum())))


def seconds_a_frame(solve, histories):
    """Processor time of a further frame: that of each history many times over, less that of once."""
    total = frames = 0
    for history in histories:
        before = time.process_time()
        solve(history.readings, *history.skin, history.rate_hz)
        start = time.process_time()
        times = int(np.clip(0.5 / max(start - before, 1e-6), 2, 500))
        solve(np.concatenate([history.readings] * times), *history.skin, history.rate_hz)
        total += time.process_time() - start - (start - before)
        frames += (times - 1) * len(history.readings)
    return total / frames


def evaluate(entry, histories):
    """Name of an entry, its scores on each history, and its seconds a frame if it is run."""
    if ":" not in entry:
        scores = []
        for each in histories:
            with h5py.File(Path(entry, f"{each.name}.{each.seed}.h5")) as file:
                scores.append(score(each, planes(file, "force"), {name: file[name][:] for name in REPORTS if name in file}))
        return Path(entry).name, scores, None
    module, name = entry.split(":")
    solve = getattr(importlib.import_module(module), name)
    scores = [score(each, *solve(each.readings, *each.skin, each.rate_hz)) for each in histories]
    return name, scores, seconds_a_frame(solve, [each for each in histories if each.kind == "large" and each.seed == "0"])


def mean_and_error(histories, scores, part, key, digits, where):
    """Mean over histories of a score, and its standard error from the scatter of the seeds."""
    seeds = sorted({each.seed for each in histories})
    values = [[one[part][key] for each, one in zip(histories, scores) if each.seed == seed and where(each)] for seed in seeds]
    means = [np.nanmean(of_seed) for of_seed in values if np.isfinite(of_seed).any()]
    if not means:
        return "-"
    error = f" ± {np.std(means, ddof=1) / len(means)**0.5:.{digits}f}" if len(means) > 1 else ""
    return f"{np.mean(means):.{digits}f}{error}"


def table(histories, found):
    """Rows of cells, the head first: means over the histories, and time over that of `direct`."""
    reference = next((seconds for name, _, seconds in found if name == "direct"), None)
    yield ["entry", *SCORES, "time"]
    for name, scores, seconds in found:
        yield [name, *(mean_and_error(histories, scores, 0, key, digits, lambda each: True) for key, digits in SCORES.items()),
               f"{seconds / reference:.1f}" if seconds and reference else "-"]


def region_3_table(histories, found):
    """Errors in region 3 of each class and history."""
    yield ["history", *(f"`{name}`" for name, *_ in found)]
    for kind in dict.fromkeys(each.kind for each in histories):
        for name in [None, *dict.fromkeys(each.name for each in histories if each.kind == kind)]:
            yield [f"**{kind}**" if name is None else name.replace("_", " "), *(
                mean_and_error(histories, scores, 0, "region 3", 2,
                               lambda each, kind=kind, name=name: each.kind == kind and name in (None, each.name))
                for _, scores, _ in found)]


def reports_table(histories, found, part, names, by):
    """Scores of what the entries report beside forces, by class or by history."""
    yield ["entry", {"kind": "class", "name": "history"}[by], *names]
    for entry, scores, _ in found:
        for value in dict.fromkeys(getattr(each, by) for each in histories):
            row = [mean_and_error(histories, scores, part, key, digits, lambda each, value=value: getattr(each, by) == value)
                   for key, digits in names.items()]
            if row[0][0] not in "-0":
                yield [entry, value.replace("_", " "), *row]


def run(folder, entries):
    """The histories of a folder, and what evaluate() finds of each entry."""
    sys.path.append(".")
    histories = [History(path) for path in sorted(Path(folder).glob("*.h5"))]
    if not histories:
        raise ValueError(f"{folder}: there are no histories; write them with generate.py")
    return histories, [evaluate(entry, histories) for entry in entries]


def tables(histories, found):
    """All tables: of entries, of region 3, of friction by class, of the time to slip by history."""
    in_time = [index for index, each in enumerate(histories) if each.kind == "in time"]
    of_time = [(name, [scores[index] for index in in_time], seconds) for name, scores, seconds in found]
    return {"entry_rows": list(table(histories, found)), "history_table": list(region_3_table(histories, found)),
            "friction_table": list(reports_table(histories, found, 1, FRICTION_SCORES, "kind")),
            "time_table": list(reports_table([histories[index] for index in in_time], of_time, 2, TIME_SCORES, "name"))}


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        for rows in tables(*run(sys.argv[1], sys.argv[2:])).values():
            for line in rows:
                print("".join(cell.ljust(24 if index == 0 else 18) for index, cell in enumerate(line)))
            print()
    except (ValueError, OSError, KeyError, ImportError, AttributeError) as failure:
        sys.exit(f"score.py: {failure}")
