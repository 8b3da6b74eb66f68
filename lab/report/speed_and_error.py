"""speed_and_error.py DOCS MEASURED TIMED: writes the table and the picture of DOCS/speed_and_error.md.

MEASURED is the output of measure_choices.py, TIMED that of pillarfield-bench of its cases choice/."""

import math
from pathlib import Path

import page
import pictures
import processors
import sensor_scenes as scenes
import speed
from page import percent, text

SENSORS = (("ideal", "none", "an ideal sensor"),
           ("real", "none", "a real sensor, taken for ideal"),
           ("real", "calibrated", "a real sensor, tares and gains"),
           ("real", "sensor", "a real sensor, all corrections"))
COLOURS = {"an ideal sensor": pictures.BLUE, "a real sensor, taken for ideal": pictures.VERMILION,
           "a real sensor, tares and gains": pictures.ORANGE,
           "a real sensor, all corrections": pictures.GREEN}
MARKERS = {"paper": "s", "direct": "o", "contact": "D"}


def rms(score, *groups):
    """RMS error over the pillars of the groups, counts."""
    squares, pillars = map(sum, zip(*(score[group] for group in groups)))
    return math.sqrt(squares / pillars)


def error(score):
    return rms(score, "determined", "ambiguous")


def of_peak(counts):
    return counts / scenes.PEAK_COUNTS


def frames_hz(bench, way):
    """Frames a second of a square metre; None where the way was not timed."""
    time_us = bench.find(f"choice/{way}", "real_time")
    return time_us and 1e6 / time_us


def choice_rows(measured, bench):
    for sensor, known, title in SENSORS:
        for estimator, score in measured[sensor][known].items():
            way = f"{known}/{estimator}"
            yield [title, estimator, text(error(score)), percent(of_peak(error(score))),
                   text(rms(score, "determined")), text(rms(score, "ambiguous")),
                   text(bench.find(f"choice/{way}", "over_bare"), ".1f"), text(frames_hz(bench, way), ".0f"),
                   text(frames_hz(bench, f"{way}_and_deviations"), ".0f")]


def draw(measured, bench, folder):
    figure, axes = pictures.panels(900, 520)
    for sensor, known, title in SENSORS:
        for estimator, score in measured[sensor][known].items():
            axes.plot(frames_hz(bench, f"{known}/{estimator}"), 100 * of_peak(error(score)),
                      MARKERS[estimator], color=COLOURS[title], markersize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    pictures.plain_ticks(axes.xaxis)
    pictures.plain_ticks(axes.yaxis)
    axes.set_xlabel(f"frames per second of a square metre, 5 % in contact ({processors.name()}, "
                    f"{bench.context['num_cpus']} cores)")
    axes.set_ylabel("RMS error of a pillar's force, % of the largest")
    for title, colour in COLOURS.items():
        axes.plot([], [], "o", color=colour, label=title)
    for estimator, marker in MARKERS.items():
        axes.plot([], [], marker, color=pictures.GREY, label=f"estimator {estimator}")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    pictures.save(figure, folder, "speed_and_error")


def main(docs, measured, timed):
    measured, bench = page.load(measured), speed.Bench(timed, page.load(timed))
    draw(measured, bench, Path(docs, "pictures/performance"))
    page.update(docs, "speed_and_error", choice_rows=choice_rows(measured, bench))


if __name__ == "__main__":
    page.run(main)
