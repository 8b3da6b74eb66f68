"""sensors.py DOCS MEASURED TIMED: writes the tables of DOCS/sensors.md.

MEASURED is the output of measure_sensors.py, TIMED that of pillarfield-bench of its cases sensor/."""

import math

import page
import sensor_scenes as scenes
import speed
from page import met_or_not, percent, text

SINGLE_LIMIT = {"hysteresis": 2.5, "creep": 2.5, "all": 3, "centred": 3, "bending": 1.2}
OTHER_LIMIT = 1.5  # of the ideal error, for the other effects but off-centre pressure
ABSENT_LIMIT = 1.02
INSIDE_LIMIT, RIM_LIMIT = 0.6, 0.75  # of the uncorrected error
WRONG_POINTS = 2
COVERED = 0.93
PAPER_POINTS = 0.1
COMPONENTS = ("shear_x", "shear_y", "normal")


def rms(score, group="determined"):
    squares, pillars = score[group]
    return math.sqrt(squares / pillars) if pillars else None


def share(score, group):
    part, whole = score[group]
    return part / whole


def over_paper(score):
    """Error of ambiguous pillars by `contact` over that by `paper`."""
    return rms(score, "ambiguous_contact") / rms(score, "ambiguous_paper")


def is_exact(name):
    """Whether a recording holds the exact correction: not of hysteresis and creep."""
    return "memory" not in scenes.EFFECTS[name].steps


def short(name):
    return scenes.EFFECTS[name].title.split(",")[0]


def coverage(score):
    return " / ".join(percent(share(score, name), 0) for name in COMPONENTS)


def limit(name):
    """The wanted error over the ideal sensor's; None of off-centre pressure alone."""
    return None if name == "off_centre" else SINGLE_LIMIT.get(name, OTHER_LIMIT)


def ratio_cells(name, ratio):
    """A ratio, bold where it misses its goal, and the goal."""
    wanted = limit(name)
    if wanted is None:
        return [text(ratio), "–"]
    return [text(ratio) if ratio <= wanted else f"**{text(ratio)}**", f"≤ {wanted}"]


def error_rows(found):
    ideal = rms(found["ideal"])
    for name, effect in scenes.EFFECTS.items():
        ignored, exact, calibrated = (found["effects"][name][way]
                                      for way in ("ignored", "exact", "calibrated"))
        yield [effect.title, text(rms(ignored)), text(rms(exact)) if is_exact(name) else "–",
               text(rms(calibrated)), *ratio_cells(name, rms(calibrated) / ideal),
               *(text(rms(score, "ambiguous")) for score in (ignored, calibrated)),
               text(rms(found["absent"][name]) / ideal, ".3f")]


def indenter_rows(found):
    """Errors of off-centre pressure by indenter, ignored and corrected."""
    ignored, corrected = (found["effects"]["off_centre"][way]["indenters"]
                          for way in ("ignored", "calibrated"))
    for indenter in scenes.BODIES:
        cells = [text(rms(indenters[indenter], group), ".1f") for group in ("inside", "rim")
                 for indenters in (ignored, corrected)]
        yield [indenter, *cells]


# --- Goals ---

def goal(what, wanted, measured, holds):
    return [what, wanted, measured, met_or_not(holds)]


def off_centre_goals(found):
    ignored, corrected = (found["effects"]["off_centre"][way] for way in ("ignored", "calibrated"))
    for group, where, limit in (("inside", "inside contacts", INSIDE_LIMIT),
                                ("rim", "at rims", RIM_LIMIT)):
        left = rms(corrected, group) / rms(ignored, group)
        yield goal(f"off-centre pressure {where}: error over the uncorrected one", f"≤ {limit}",
                   text(left), left <= limit)


def shared_goals(found):
    """Goals of all effects, with the worst one."""
    effects = {name: effect["calibrated"] for name, effect in found["effects"].items()}

    def worst(values, show, holds, wanted, what):
        failing = [name for name, value in values.items() if not holds(value)]
        measured = "; ".join(f"{short(name)} {show(values[name])}"
                             for name in failing) or "all"
        return goal(what, wanted, measured, not failing)

    ideal_wrong = share(found["ideal"], "wrong")
    yield worst({name: share(score, "wrong") - ideal_wrong for name, score in effects.items()},
                lambda points: f"{100 * points:+.1f}",
                lambda points: 100 * points <= WRONG_POINTS, f"≤ +{WRONG_POINTS}",
                "wrong regions, points above the ideal sensor")
    yield worst({name: [share(score, part) for part in COMPONENTS]
                 for name, score in effects.items()},
                lambda shares: " / ".join(percent(part, 0) for part in shares),
                lambda shares: min(shares) >= COVERED,
                "≥ 93", "truths in the stated 95 %, x / y / normal, %")
    ideal_ratio = over_paper(found["absent"]["gains"])
    yield worst({name: over_paper(score) - ideal_ratio for name, score in effects.items()},
                lambda points: f"{points:+.2f}", lambda points: points <= PAPER_POINTS,
                f"≤ +{PAPER_POINTS}",
                "ambiguous pillars: ratio to `paper`, above that of the ideal sensor")
    ideal = rms(found["ideal"])
    yield worst({name: rms(score) / ideal for name, score in found["absent"].items()},
                lambda ratio: text(ratio, ".3f"), lambda ratio: ratio <= ABSENT_LIMIT,
                f"≤ {ABSENT_LIMIT}",
                "calibrated but absent: error over the ideal sensor's")


TIMED = {"curve": ("response curve", "1.2"), "shear_coefficient": ("shear coefficient", "1.02"),
         "leak": ("leak between sensels", "1.6"), "wires": ("wires", "2"),
         "memory": ("hysteresis and creep", "1.3"), "bending": ("bending", "1.2"),
         "pillar_leak": ("leak between pillars", "–"), "lean": ("off-centre pressure", "–"),
         "sensor": ("all but the leak between pillars and bending", "–")}


def time_rows(bench):
    """The time of a frame with each effect over that without, loaded everywhere and in part."""
    def ratio(percent, effect):
        return text(bench.value(f"sensor/{percent}/{effect}", "over_none"))
    for effect, (title, wanted) in TIMED.items():
        yield [title, ratio(100, effect), ratio(8, effect), wanted]


def main(docs, measured, timed):
    found = page.load(measured)
    bench = speed.Bench(timed, page.load(timed))
    page.update(docs, "sensors", error_rows=error_rows(found), indenter_rows=indenter_rows(found),
                time_rows=time_rows(bench),
                goal_rows=[*off_centre_goals(found), *shared_goals(found)])


if __name__ == "__main__":
    page.run(main)
