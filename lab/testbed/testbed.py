"""The paper's testbed (sections IV and V), simulated: Table II and Figures 3, 4, 5 and 8 (docs/accuracy.md).

A probe presses one pillar from three directions with 10 to 100 N. Readings of many runs are made by equation (2) and a
sensor with a dead zone, and solved by the package pillarfield with the paper's equations and with the direct solve."""

import argparse
import dataclasses
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pillarfield as pf

SITES = (("Region 1", 2.094, 0.471), ("Region 2", 3.927, 0.977), ("Region 3", 5.760, 1.222))  # phi, theta of Table II
APPLIED_N = np.arange(10.0, 101, 10)
STATISTICS = ("mean", "deviation", "mean_error")
# The paper's figures: phi and theta of each site.
PUBLISHED = ((2.043, 0.093, 0.084), (0.551, 0.240, 0.177), (3.893, 0.152, 0.084),
             (0.926, 0.113, 0.0735), (5.890, 0.032, 0.130), (1.417, 0.013, 0.196))
USABLE = 0b1111
AMBIGUOUS_OR_INCONSISTENT = pf.Status.AMBIGUOUS | pf.Status.INCONSISTENT


@dataclass(frozen=True)
class Parameters:
    """Constants of probe and sensor; the paper states those of the probe (docs/accuracy.md)."""
    counts_per_newton: float = 20
    threshold_counts: float = 3
    dead_zone_counts: float = 144
    full_scale_counts: float = 4095
    noise_counts: float = 0.5
    positioner_rad: float = 0.04
    play_rad: float = 0.01
    probe_resolution_n: float = 0.1
    runs: int = 1000
    seed: int = 1


def brackets(theta, phi):
    """Brackets of equation (2), [..., 4]: readings of sensels 1 to 4 for F k = 1, negative under tension."""
    turns = math.pi / 4 * np.array([1, 3, 5, 7])
    return np.cos(theta)[..., None] - np.sin(theta)[..., None] * np.cos(turns - np.asarray(phi)[..., None])


def experiment(p):
    """Raw readings [runs, site, force, 4] in counts, and which sensels the ideal model finds usable."""
    random = np.random.default_rng(p.seed)
    runs, shape = p.runs, (p.runs, len(SITES), len(APPLIED_N))

    def angle(truth):
        lean = random.uniform(-p.positioner_rad, p.positioner_rad, (runs, len(SITES), 1))
        play = random.uniform(-p.play_rad, p.play_rad, (runs, len(SITES), 1))
        return np.array(truth)[:, None] + lean + play * APPLIED_N / APPLIED_N[-1]

    phi, theta = (angle([site[i] for site in SITES]) for i in (1, 2))
    force = APPLIED_N + p.probe_resolution_n * random.uniform(-0.5, 0.5, shape)
    ideal = force[..., None] * p.counts_per_newton * brackets(theta, phi)
    response = np.maximum(np.maximum(ideal, 0) - p.dead_zone_counts, 0)
    raw = np.round(response + p.noise_counts * random.standard_normal(response.shape))
    return np.clip(raw, 0, p.full_scale_counts), ideal > 0


def solve(raw, estimator, counts_per_newton=1.0, threshold_counts=0.0, dead_zone_counts=0.0, noise_counts=None):
    """Forces of pillars [..., 4] with their angles, and their ends where there is noise: a dict of arrays [...]."""
    pillars = raw.reshape(-1, 4)
    frame = np.zeros((2, 2 * len(pillars)), np.float32)
    for sensel, (row, col) in enumerate(((0, 1), (0, 0), (1, 0), (1, 1))):
        frame[row, col::2] = pillars[:, sensel]
    calibration = pf.Calibration(*frame.shape, dead_zone=np.full(frame.shape, dead_zone_counts, np.float32))
    outputs = ["angles"] if noise_counts is None else ["angles", "uncertainty"]
    forces = pf.solve(frame[None], calibration=calibration, estimator=estimator, outputs=outputs,
                      noise_counts=noise_counts, counts_per_newton=counts_per_newton,
                      threshold_counts=threshold_counts, layout="pillars")
    names = ["theta", "phi", "magnitude", "status"]
    found = {name: np.asarray(getattr(forces, name), float if name != "status" else None)[0, 0] for name in names}
    if noise_counts is not None:
        ends = forces.uncertainty
        found |= {name: np.asarray(getattr(ends, name), float)[0, 0]
                  for name in ("theta_low", "theta_high", "phi_low", "phi_high", "magnitude_low", "magnitude_high")}
    return {name: values.reshape(raw.shape[:-1]) for name, values in found.items()}


def solve_trials(p, raw):
    """By the paper's equations without a dead zone, and directly with it. Rounding adds 1/12 count² to the noise."""
    sensor = {"counts_per_newton": p.counts_per_newton, "threshold_counts": p.threshold_counts}
    return {"paper": solve(raw, "paper", **sensor),
            "direct": solve(raw, "direct", **sensor, dead_zone_counts=p.dead_zone_counts,
                            noise_counts=math.hypot(p.noise_counts, 12 ** -0.5))}


def statistics_of(angles, truth, detected):
    """Mean, SD (over n - 1) and mean of |angle - truth| over the detected forces of each run, [3, runs]; angles on the
    turn nearest to the truth. NaN for fewer than two."""
    near = truth + np.remainder(angles - truth + math.pi, 2 * math.pi) - math.pi
    count = detected.sum(-1)
    mean = np.where(detected, near, 0).sum(-1) / np.maximum(count, 1)
    squares = np.where(detected, (near - mean[..., None]) ** 2, 0).sum(-1)
    error = np.where(detected, abs(near - truth), 0).sum(-1) / np.maximum(count, 1)
    found = np.array([mean, np.sqrt(squares / np.maximum(count - 1, 1)), error])
    return np.where(count > 1, found, np.nan)


def named(figures):
    return dict(zip(STATISTICS, map(float, figures)))


def table_two(solved):
    """The rows of Table II: published figures, those of run 0, expectation and spread over the runs."""
    rows = []
    for number, published in enumerate(PUBLISHED):
        site, angle = SITES[number // 2], ("phi", "theta")[number % 2]
        row = {"site": site[0], "angle": angle, "truth": site[1 + number % 2], "published": named(published)}
        for estimator, found in solved.items():
            detected = (found["status"][:, number // 2] & USABLE) != 0
            runs = statistics_of(found[angle][:, number // 2], row["truth"], detected)
            row[estimator] = {"run": named(runs[:, 0]), "expected": named(np.nanmean(runs, 1)),
                              "spread": named(np.nanstd(runs, 1, ddof=1))}
        paper = row["paper"]
        row["reproduced"] = {key: abs(row["published"][key] - paper["expected"][key]) <= 2 * paper["spread"][key]
                             for key in STATISTICS}
        rows.append(row)
    return rows


def region(usable):
    """Region of usable sensels [..., 4]: 5 less their number, 0 without any."""
    count = usable.sum(-1)
    return np.where(count > 0, 5 - count, 0)


def audit(status, usable):
    """Forces whose region differs from that of the ideal model, and those of them without a status bit for it."""
    found = (status[..., None] >> np.arange(4)) & 1
    wrong = region(found) != region(usable)
    return {"forces": int(wrong.size), "wrong_regions": int(wrong.sum()),
            "unflagged": int((wrong & ((status & int(AMBIGUOUS_OR_INCONSISTENT)) == 0)).sum())}


def band(theta, phi, uncertainty_rad):
    """Least and largest magnitude from an applied force of 1 N with both angles off by at most `uncertainty_rad`:
    least squares of equation (2) over the usable sensels, on a grid."""
    readings = brackets(np.array(theta), phi)
    off = uncertainty_rad * np.linspace(-1, 1, 41)
    assumed = brackets(theta + off[:, None] + 0 * off, phi + off + 0 * off[:, None]) * (readings > 0)
    fitted = (assumed * readings).sum(-1) / (assumed ** 2).sum(-1)
    return float(fitted.min()), float(fitted.max())


def figure_eight(p, solved):
    """Calculated against applied magnitude of run 0, a dict for each site and force."""
    direct, points = solved["direct"], []
    for i, (site, phi, theta) in enumerate(SITES):
        low, high = band(theta, phi, p.positioner_rad + p.play_rad)
        for j, applied in enumerate(APPLIED_N):
            points.append({
                "site": site, "applied_n": applied, "uncertain_low_n": applied * low, "uncertain_high_n": applied * high,
                "paper_n": solved["paper"]["magnitude"][0, i, j], "direct_n": direct["magnitude"][0, i, j],
                "possible_low_n": direct["magnitude_low"][0, i, j], "possible_high_n": direct["magnitude_high"][0, i, j],
                "ambiguous": bool(direct["status"][0, i, j] & int(pf.Status.AMBIGUOUS))})
    return points


def run(p):
    """All figures of a set of parameters, as ./dev report accuracy and --json have them."""
    raw, usable = experiment(p)
    solved = solve_trials(p, raw)
    return {**dataclasses.asdict(p), "table_2": table_two(solved), **audit(solved["direct"]["status"], usable),
            "figure_8": figure_eight(p, solved)}


def difference(table):
    """RMS difference of the printed and the expected values of the paper's 18 figures, rad."""
    return math.sqrt(np.mean([(row["paper"]["expected"][key] - row["published"][key]) ** 2
                              for row in table for key in STATISTICS]))


def scan_dead_zones(p):
    """Dead zones of 0 to 10 N and the distance of the three figures of theta in region 1 from the printed ones."""
    points = []
    for dead_zone_n in np.arange(101) / 10:
        tried = dataclasses.replace(p, dead_zone_counts=dead_zone_n * p.counts_per_newton)
        raw, _ = experiment(tried)
        found = solve(raw[:, :1], "paper", p.counts_per_newton, p.threshold_counts)
        detected = (found["status"][:, 0] & USABLE) != 0
        expected = named(np.nanmean(statistics_of(found["theta"][:, 0], SITES[0][2], detected), 1))
        points.append({"dead_zone_n": float(dead_zone_n), **expected, "distance_rad": math.dist(
            expected.values(), PUBLISHED[1])})
    return points


def print_table(found):
    print(f"{'rad':16} truth | {'printed by the paper':22}| {'paper, run 0':22}| {'direct, run 0':22}| "
          "paper, expected ± SD over the runs; *: within two")
    print(f"{'':22} |{3 * ' mean    SD      error  |'}")
    for row in found["table_2"]:
        cells = [f"{row['site']}, {row['angle']:5} {row['truth']:7.3f} |"]
        for figures in (row["published"], row["paper"]["run"], row["direct"]["run"]):
            cells.append(" ".join(f"{figures[key]:7.4g}" for key in STATISTICS) + "|")
        cells += [f"{row['paper']['expected'][key]:.3f} ±{row['paper']['spread'][key]:.3f}"
                  f"{'*' if row['reproduced'][key] else ' '}" for key in STATISTICS]
        print(" ".join(cells))
    print(f"\n{found['wrong_regions']} of {found['forces']} forces are in another region than in the ideal model; "
          f"{found['unflagged']} of these lack a status bit for it.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for field in dataclasses.fields(Parameters):
        parser.add_argument("--" + field.name.replace("_", "-"), type=field.type, default=field.default,
                            help=f"[{field.default}]")
    parser.add_argument("--figures", type=Path, metavar="DIR", help="draw Figures 3, 4, 5 and 8 there")
    parser.add_argument("--json", action="store_true", help="print all figures as JSON")
    options = vars(parser.parse_args())
    folder, as_json = options.pop("figures"), options.pop("json")
    p = Parameters(**options)
    found = run(p)
    if folder is not None:
        import figures  # needs matplotlib
        figures.draw(found, folder, solve)
    if as_json:
        json.dump(found, sys.stdout, indent=1)
    else:
        print_table(found)


if __name__ == "__main__":
    main()
