"""Figures 3, 4, 5 and 8 of the paper, from the output of testbed.run() and the solve (docs/accuracy.md)."""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "report"))
import pictures  # noqa: E402

TOP = math.pi / 2
SENSELS = (pictures.BLUE, pictures.ORANGE, pictures.GREEN, pictures.PURPLE)
REGION_2, REGION_3 = "#E2EFF8", "#FAE6BE"
REGIONS = (("1", 4, 0.36), ("2.1", 1, 1.12), ("2.2", 3, 1.12), ("2.3", 5, 1.12), ("2.4", 7, 1.12), ("3.12", 2, 1.38),
           ("3.23", 4, 1.38), ("3.34", 6, 1.38), ("3.14", 0.4, 1.38), ("3.14", 7.6, 1.38))  # name, phi / (pi / 4), theta
CORNERS = (("4.124", 1), ("4.123", 3), ("4.234", 5), ("4.134", 7))
RATIOS = {"1/8": 1 / 8, "1/4": 1 / 4, "1/2": 1 / 2, "2/3": 2 / 3, "1": 1, "3/2": 3 / 2, "2": 2, "4": 4, "8": 8}
ROOT_HALF = 2 ** -0.5


def border(sensel, phi):
    """Inclination above which a sensel is inactive, equation (3); pi/2 where it is always active."""
    cosine = np.cos(math.pi / 4 * (2 * sensel - 1) - phi)
    return np.where(cosine > 0, np.arctan2(1, cosine), TOP)


def segment(ratio, share):
    """theta and phi of the forces that V3 / V4 = `ratio` in region 3.12 allows; `share` of the largest parity sum."""
    parity_sum = np.asarray(share) * min(ratio, 1)
    normal, shear_x = parity_sum / 2, (1 - ratio) / (2 * ROOT_HALF)
    shear_y = (parity_sum - ratio - 1) / (2 * ROOT_HALF)
    return np.arctan2(np.hypot(shear_x, shear_y), normal), np.arctan2(-shear_y, -shear_x)


def half_widths(ratio):
    """Half the range of theta and phi on the segment, rad."""
    theta, phi = segment(ratio, np.array([0, 1]))
    return abs(np.diff(theta)[0]) / 2, abs(np.diff(phi)[0]) / 2


def turns(axis, name, first, last):
    ticks = [i * math.pi / 8 for i in range(first, last + 1)]
    labels = ["0" if i == 0 else f"{i / 8:g}π" for i in range(first, last + 1)]
    getattr(axis, f"set_{name}ticks")(ticks, labels)


def draw_regions(folder):
    figure, axis = pictures.panels(800, 400)
    phi = np.linspace(0, 2 * math.pi, 721)
    borders = np.array([border(n, phi) for n in range(1, 5)])
    lowest = np.sort(borders, 0)
    axis.fill_between(phi, lowest[0], TOP, color=REGION_2)
    axis.fill_between(phi, lowest[1], TOP, color=REGION_3)
    for n, (curve, colour) in enumerate(zip(borders, SENSELS), start=1):
        axis.plot(phi, np.where(curve < TOP, curve, math.nan), color=colour)
        axis.text((2 * n - 1) * math.pi / 4, 0.67, f"$V_{n}=0$", color=colour, ha="center")
    for name, eighths, theta in REGIONS:
        axis.text(eighths * math.pi / 4, theta, name, ha="center", va="center")
    for name, eighths in CORNERS:
        axis.plot(eighths * math.pi / 4, TOP, "o", color=pictures.BLACK, clip_on=False)
        axis.text(eighths * math.pi / 4, TOP + 0.05, name, ha="center", clip_on=False)
    axis.set(xlim=(0, 2 * math.pi), ylim=(0, TOP), xlabel="azimuth φ (rad)", ylabel="inclination θ (rad)")
    turns(axis, "x", 0, 16)
    turns(axis, "y", 0, 4)
    axis.xaxis.set_ticks(axis.get_xticks()[::2])
    pictures.save(figure, folder, "figure_3_regions")


def draw_contours(folder, solve):
    figure, axis = pictures.panels(800, 480)
    phi = np.linspace(math.pi / 4, 3 * math.pi / 4, 201)
    low = np.maximum(border(1, phi), border(2, phi))
    axis.fill_between(phi, low, TOP, color=REGION_3)
    axis.plot(phi[phi >= TOP], border(1, phi[phi >= TOP]), color=SENSELS[0], label="$V_1=0$")
    axis.plot(phi[phi <= TOP], border(2, phi[phi <= TOP]), color=SENSELS[1], label="$V_2=0$")
    for name, ratio in RATIOS.items():
        theta, azimuth = segment(ratio, np.linspace(0, 1, 60))
        axis.plot(azimuth, theta, color=pictures.BLACK, linewidth=1)
        axis.text(azimuth[-1], theta[-1] - 0.03, name, ha="center")
    for estimator, marker, face, label in (("direct", "D", pictures.GREEN, "7/8 of the segment (direct)"),
                                           ("paper", "o", "white", "midpoint in θ (paper)")):
        found = solve(np.array([[0, 0, 2, 1.0]]), estimator)  # R = 2
        axis.plot(found["phi"][0], found["theta"][0], marker, color=pictures.BLACK, markerfacecolor=face, markersize=7, label=label,
                  zorder=3)
    axis.set(ylim=(0.82, TOP), xlabel="azimuth φ (rad)", ylabel="inclination θ (rad)",
             title="contours of $R=V_3/V_4$")
    turns(axis, "x", 2, 6)
    axis.legend(loc="lower right")
    pictures.save(figure, folder, "figure_4_contours")


def draw_uncertainty(folder):
    figure, axis = pictures.panels(800, 400)
    logarithm = np.linspace(-2, 2, 401)
    theta, phi = np.array([half_widths(10 ** value) for value in logarithm]).T
    axis.plot(logarithm, theta, color=pictures.BLUE, label=f"θ, at most {half_widths(1)[0]:.3f} rad (paper: 0.32)")
    axis.plot(logarithm, phi, color=pictures.VERMILION, label=f"φ, at most {half_widths(2)[1]:.3f} rad (paper: 0.07)")
    axis.set(xlim=(-2, 2), ylim=(0, 0.35), xlabel="log₁₀ R, the ratio of the two readings",
             ylabel="half-width of the interval (rad)")
    axis.legend(loc="upper right")
    pictures.save(figure, folder, "figure_5_uncertainty")


def draw_magnitude(points, folder):
    figure, axes = pictures.panels(1040, 370, 1, 3, sharex=True, sharey=True)
    for axis, site in zip(axes, dict.fromkeys(point["site"] for point in points)):
        here = [point for point in points if point["site"] == site]
        applied, low, high, paper, direct, least, most = (
            np.array([point[key] for point in here]) for key in (
                "applied_n", "uncertain_low_n", "uncertain_high_n", "paper_n", "direct_n", "possible_low_n",
                "possible_high_n"))
        axis.fill_between([0, *applied], [0, *low], [0, *high], color="#c8c8c8", label="uncertain angles")
        axis.plot([0, *applied], [0, *applied], color=pictures.GREY, linewidth=1, label="truth")
        axis.plot(applied, paper, "s", color=pictures.VERMILION, label="paper")
        axis.plot(applied, direct, "o", color=pictures.BLUE, label="direct")
        wide = most > least
        axis.vlines(applied[wide], least[wide], most[wide], color=pictures.BLUE, label="interval")
        axis.set(xlim=(0, 108), ylim=(0, 130), title=site, xlabel="applied (N)")
    axes[0].set_ylabel("calculated (N)")
    axes[0].legend(loc="upper left")
    pictures.save(figure, folder, "figure_8_magnitude")


def draw(found, folder, solve):
    """Draws all into `folder`; `found` is the output of run() of testbed.py, `solve` its function."""
    draw_regions(folder)
    draw_contours(folder, solve)
    draw_uncertainty(folder)
    draw_magnitude(found["figure_8"], folder)
