"""accuracy.py DOCS MEASURED: writes the tables and pictures of DOCS/accuracy.md.

MEASURED is the output of measure_accuracy. lab/testbed computes the paper's figures with the Python package."""

import math
import sys
from pathlib import Path

import page
import pictures
from page import percent, root_mean_square, text

sys.path.insert(0, str(Path(__file__).parents[1] / "testbed"))
import figures  # noqa: E402
import testbed  # noqa: E402


# --- Error against the Cramér–Rao bound ---

def ratio_rows(table):
    """A row for each inclination, with columns for each noise."""
    result = []
    for cell in table:
        if not result or result[-1][0] != f"{cell['theta_deg']}°":
            regions = sorted({5 - force["usable"] for force in cell["forces"]})
            result.append([f"{cell['theta_deg']}°", ", ".join(map(str, regions))])
        result[-1] += [text(root_mean_square(force[estimator] for force in cell["forces"]))
                       for estimator in ("direct", "paper")]
    return result


def draw_bound(curves, folder):
    figure, axes = pictures.panels(960, 400, 1, 2, sharex=True, sharey=True)
    for axis, curve in zip(axes, curves):
        points = curve["points"]
        thetas = [point["theta_deg"] for point in points]
        for point in points:
            if point["near_border"]:
                axis.axvspan(point["theta_deg"] - 0.5, point["theta_deg"] + 0.5, color="#e6e6e6",
                             linewidth=0)
        axis.axhline(1, color=pictures.GREY, linewidth=0.8)
        for key, label, style in (
                ("paper", "paper", {"color": pictures.VERMILION}),
                ("direct_all_draws", "direct, all draws",
                 {"color": pictures.BLUE, "linestyle": "--", "linewidth": 1.2}),
                ("direct", "direct", {"color": pictures.BLUE})):
            axis.plot(thetas, [point[key] for point in points], label=label, **style)
        axis.set_title(f"φ = {curve['phi_deg']:g}°")
        axis.set_xlabel("inclination θ")
        axis.set(xlim=(0, 90), ylim=(0.9, 1.7), xticks=range(0, 91, 15))
        axis.xaxis.set_major_formatter("{x:g}°")
    axes[0].set_ylabel("RMS error over the bound")
    axes[0].legend(loc="upper left", bbox_to_anchor=(0.5, 1))
    pictures.save(figure, folder, "bound")


# --- Coverage ---

def coverage_rows(scenes):
    """Regions 1 and 2; the others have no standard deviation that covers 95 %."""
    for scene in scenes:
        for region, covered in enumerate(scene["all"][:2]):
            held = [f"{percent(covered[key])} %" for key in ("shear_x", "shear_y", "normal")]
            yield [scene["name"] if region == 0 else "", region + 1, *held, f"{percent(covered['ends'], 2)} %"]


# --- Small forces ---

def draw_small_forces(points, folder):
    figure, (left, right) = pictures.panels(960, 400, 1, 2)
    loads = [point["load"] for point in points]

    def curve(axis, solve, key, scale, label, style, **options):
        axis.plot(loads, [math.nan if point[solve][key] is None else scale * point[solve][key]
                          for point in points], style, label=label, **options)

    black, blue, red = pictures.BLACK, pictures.BLUE, pictures.VERMILION
    curve(left, "after", "undetected", 100, "undetected", ":", color=black)
    curve(left, "after", "wrong_region", 100, "wrong region", "o-", color=black)
    curve(left, "before", "unflagged", 100, "unflagged, before", "s-", color=red)
    curve(left, "after", "unflagged", 100, "unflagged, after", "o-", color=blue)
    curve(right, "paper", "force", 1, "all: paper", "--", color=pictures.ORANGE)
    curve(right, "after", "force", 1, "all: direct, after", "--", color=pictures.SKY_BLUE)
    curve(right, "before", "determined", 1, "3 or 4 usable, before", "s-", color=red)
    curve(right, "after", "determined", 1, "3 or 4 usable, after", "o-", color=blue)
    for axis in (left, right):
        axis.set(xscale="log", xlim=(0.3, 105), xlabel="force over dead zone, F k / z")
        pictures.plain_ticks(axis.xaxis, (0.3, 1, 3, 10, 30, 100))
    left.set(ylim=(-2, 102), ylabel="directions (%)")
    right.set(yscale="log", ylim=(1e-4, 1.1), ylabel="RMS error of the force, over F")
    pictures.plain_ticks(right.yaxis, (1e-4, 1e-3, 1e-2, 0.1, 1),
                         ("0.0001", "0.001", "0.01", "0.1", "1"))
    left.legend(loc="upper right")
    right.legend(loc="lower left")
    pictures.save(figure, folder, "small_forces")


# --- The testbed ---

def name_of(row):
    return f"{row['site']}, {'φ' if row['angle'] == 'phi' else 'θ'}"


def as_printed(figure):
    """Three decimals as in the paper, or four."""
    return f"{figure:.4f}".removesuffix("0")


def expected_rows(table):
    for row in table:
        cells = [f"{row['truth']:.3f}", *(as_printed(row["published"][key]) for key in testbed.STATISTICS)]
        for solve in ("paper", "direct"):
            for key in testbed.STATISTICS:
                bold = "**" if solve == "paper" and row["reproduced"][key] else ""
                answer = row[solve]
                cells.append(f"{bold}{answer['expected'][key]:.3f} ± "
                             f"{answer['spread'][key]:.3f}{bold}")
        yield [name_of(row), *cells]


def testbed_rows(folder):
    found = testbed.run(testbed.Parameters())
    figures.draw(found, folder, testbed.solve)
    return expected_rows(found["table_2"])


def main(docs, measured):
    folder = Path(docs, "pictures", "accuracy")
    found = page.load(measured)
    small = found["small_forces"]["points"]
    draw_bound(found["bound"]["curves"], folder)
    draw_small_forces(small, folder)
    page.update(docs, "accuracy", ratio_rows=ratio_rows(found["bound"]["table"]),
                coverage_rows=coverage_rows(found["coverage"]),
                expected_rows=testbed_rows(folder))


if __name__ == "__main__":
    page.run(main)
