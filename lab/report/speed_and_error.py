"""speed_and_error.py DOCS MEASURED TIMED: writes DOCS/speed_and_error.md and its picture.

MEASURED is the output of measure_choices.py, TIMED that of pillarfield-bench of its cases choice/.
The times are kept in DOCS/measured, a file for each kind of processor; the page shows all of them."""

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


def times(bench):
    """Time over that of the bare direct solve, and frames a second of a square metre."""
    return {name.removeprefix("choice/"):
            {"over_bare": round(bench.value(name, "over_bare"), 3),
             "frames_hz": round(1e6 / bench.value(name, "real_time"), 2)}
            for name in bench.group("choice")}


def keep_times(docs, bench):
    """Adds this processor's times to those kept, and returns all by processor."""
    return processors.keep(docs, "choices", {
        "cores": bench.context["num_cpus"], "date": bench.context["date"][:10],
        "load": bench.context["load_avg"][0], "times": times(bench)})


def time_cells(kept, case):
    for one in kept:
        found = one["times"].get(case)
        yield text(found and found["over_bare"], ".1f")
        yield text(found and found["frames_hz"], ".0f")


def choice_rows(measured, kept):
    for sensor, known, title in SENSORS:
        for estimator, score in measured[sensor][known].items():
            yield [title, estimator, text(error(score)), percent(of_peak(error(score))),
                   text(rms(score, "determined")), text(rms(score, "ambiguous")),
                   *time_cells(kept, f"{known}/{estimator}")]


def deviation_rows(kept):
    for known, title in (("none", "nothing"), ("calibrated", "tares and gains"),
                         ("sensor", "all corrections")):
        for way in ("direct", "contact"):
            yield [title, way, *time_cells(kept, f"{known}/{way}"),
                   *time_cells(kept, f"{known}/{way}_and_deviations")]


def heads(kept, outputs=""):
    """Names of the columns of times."""
    return " | ".join(f"{outputs}{one['processor']}: time over bare | frames/s" for one in kept)


def draw(measured, kept, folder):
    figure, axes = pictures.panels(900, 520)
    here = kept[0]["times"]
    for sensor, known, title in SENSORS:
        for estimator, score in measured[sensor][known].items():
            axes.plot(here[f"{known}/{estimator}"]["frames_hz"], 100 * of_peak(error(score)),
                      MARKERS[estimator], color=COLOURS[title], markersize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    pictures.plain_ticks(axes.xaxis)
    pictures.plain_ticks(axes.yaxis)
    axes.set_xlabel(f"frames per second of a square metre, 5 % in contact ({kept[0]['processor']}, "
                    f"{kept[0]['cores']} cores)")
    axes.set_ylabel("RMS error of a pillar's force, % of the largest")
    for title, colour in COLOURS.items():
        axes.plot([], [], "o", color=colour, label=title)
    for estimator, marker in MARKERS.items():
        axes.plot([], [], marker, color=pictures.GREY, label=f"estimator {estimator}")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    pictures.save(figure, folder, "speed_and_error")


def main(docs, measured, timed):
    measured, bench = page.load(measured), speed.Bench(timed, page.load(timed))
    kept = keep_times(docs, bench)
    draw(measured, kept, Path(docs, "pictures/performance"))
    score = {(sensor, known, estimator): error(found)
             for sensor, by_known in measured.items() for known, by_estimator in by_known.items()
             for estimator, found in by_estimator.items()}
    page.write(docs, "speed_and_error", choice_rows=list(choice_rows(measured, kept)),
               deviation_rows=list(deviation_rows(kept)), heads=heads(kept),
               aligns="--:|" * (2 * len(kept)), twice_heads=heads(kept, "forces, ") + " | " + heads(kept, "and deviations, "),
               twice_aligns="--:|" * (4 * len(kept)),
               peak=scenes.PEAK_COUNTS, noise=scenes.NOISE_COUNTS,
               ideal=of_text(score, "ideal", "none"), ignored=of_text(score, "real", "none"),
               corrected=of_text(score, "real", "sensor"),
               machines="; ".join(f"{one['processor']}, {one['cores']} cores, {one['date']}, load average "
                                  f"{one['load']:.1f} before" for one in kept))


def of_text(score, sensor, known):
    """Errors by estimator as text, % of the largest force."""
    return ", ".join(f"`{estimator}` {percent(of_peak(score[sensor, known, estimator]))} %"
                     for estimator in MARKERS)


if __name__ == "__main__":
    page.run(main)
