"""speed.py DOCS BENCH LIVE: writes the tables and pictures of DOCS/performance.md.

BENCH is the output of pillarfield-bench --benchmark_format=json, LIVE that of `pillarfield stream
--summary --json`. What they say of the goals is kept in DOCS/measured, a file for each kind of processor; the
page shows all of them."""

from pathlib import Path

import page
import pictures
import processors
from page import Failure, text


class Bench:
    """The cases of a run of pillarfield-bench."""

    def __init__(self, name, measured):
        self.name = name
        try:
            self.context = measured["context"]
            self.cases = {case["name"]: case for case in measured["benchmarks"]}
        except (KeyError, TypeError) as error:
            raise Failure(f"{name}: not a run of pillarfield-bench: there is no {error}; "
                          "measure again with ./dev report speed") from error

    def case(self, name):
        """A case, measured or failed."""
        if name not in self.cases:
            raise Failure(f"{self.name}: there is no case '{name}'; "
                          "measure again with ./dev report speed")
        return self.cases[name]

    def left_out(self, name):
        """Why a case failed; empty where it was measured."""
        case = self.case(name)
        return case.get("error_message", "failed") if case.get("error_occurred") else ""

    def value(self, name, counter):
        if self.left_out(name):
            raise Failure(f"{self.name}: the case '{name}' was not measured: {self.left_out(name)}")
        if counter not in self.case(name):
            raise Failure(f"{self.name}: the case '{name}' has no '{counter}'; "
                          "measure again with ./dev report speed")
        return self.case(name)[counter]

    def find(self, name, counter):
        """None where the case is missing or failed."""
        if name not in self.cases or self.left_out(name):
            return None
        return self.value(name, counter)

    def cells(self, name, formats):
        """As page.cells."""
        return [format(self.value(name, key), pattern)
                for key, pattern in (word.split(":") for word in formats.split())]

    def group(self, name):
        return [case for case in self.cases if case.startswith(f"{name}/")]


# --- Goals ---

def ratio(numerator, denominator):
    return None if numerator is None or denominator is None else numerator / denominator


def of_copy(case):
    return lambda bench, live: bench.find(case, "of_copy")


def unevenness(bench, live):
    """Most over least time per pillar of the large skins."""
    times = [bench.find(f"size/{pillars}", "ns_per_pillar")
             for pillars in (99856, 624100, 1000000, 9998244)]
    return None if None in times else max(times) / min(times)


GOALS = (
    ("Bare solve of 10⁶ pillars from memory: fraction of the copy's speed", "≥", 0.95,
     of_copy("size/1000000")),
    ("Bare solve of 10⁵ pillars in the cache: fraction of the copy's speed", "≥", 0.85,
     of_copy("size/99856")),
    ("Speed over that of the paper's equations in OpenCL, one pillar per work-item", "≥", 80,
     lambda bench, live: bench.find("baseline/paper_opencl", "speedup")),
    ("All stages: time over the copy of the same bytes", "≤", 1.3,
     lambda bench, live: ratio(1, bench.find("stage/all", "of_copy"))),
    # The two cases move equal bytes: relative to their copies they compare as in one timing.
    ("1 % in contact: time over that of the whole skin in contact", "≤", 0.3,
     lambda bench, live: ratio(bench.find("contact/100/bare", "of_copy"),
                               bench.find("contact/1/bare", "of_copy"))),
    ("10⁵ to 10⁷ pillars: most over least time per pillar", "≤", 1.25, unevenness),
    ("One frame of 79 × 79 pillars: time over that of an empty launch", "≤", 1.5,
     lambda bench, live: bench.find("latency/6241", "of_empty_launch")),
    ("A square metre at 1 kHz, paced: frames late or lost", "≤", 0,
     lambda bench, live: live["missed"] + live["lost"]),
)


def goals(bench, live):
    """What this run measured, by goal; None where it did not."""
    return {what: measure(bench, live) for what, _, _, measure in GOALS}


def goal_cell(sign, limit, measured):
    """Three significant digits, from 100 on all of the whole digits; bold where the goal is not met."""
    if measured is None:
        return "–"
    met = measured >= limit if sign == "≥" else measured <= limit
    number = format(measured, ".0f" if measured >= 100 else ".3g")
    return number if met else f"**{number}**"


def goal_table(kept):
    """A column for each processor."""
    yield ["Goal", "wanted", *(f"{one['processor']}, {one['date']}" for one in kept)]
    for what, sign, limit, _ in GOALS:
        yield [what, f"{sign} {limit:g}", *(goal_cell(sign, limit, one["goals"].get(what)) for one in kept)]


# --- Size and contact ---

def sizes(bench):
    for case in bench.group("size"):
        time, share = bench.value(case, "ns_per_pillar"), bench.value(case, "of_copy")
        yield {"pillars": bench.value(case, "pillars"), "ours": time, "copy": time * share, "of_copy": share}


def contact_costs(bench, what):
    for share in ("0.1", "1", "10", "100"):
        case = f"contact/{share}/{what}"
        time = bench.value(case, "ns_per_pillar")
        over_copy = 1 / bench.value(case, "of_copy")
        yield {"percent": share, "time": time, "over_copy": over_copy, "copy": time / over_copy}


def draw_sizes(found, bare, every, folder):
    figure, (left, right) = pictures.panels(960, 400, 1, 2)
    pillars = [size["pillars"] for size in found]
    for key, label, style, colour in (("copy", "copy", "o--", pictures.BLACK),
                                      ("ours", "ours", "o-", pictures.BLUE)):
        left.plot(pillars, [size[key] for size in found], style, color=colour, label=label)
    left.set(xscale="log", yscale="log", xlabel="pillars", ylabel="ns per pillar")
    pictures.plain_ticks(left.xaxis, (1e3, 1e4, 1e5, 1e6, 1e7),
                         ("$10^3$", "$10^4$", "$10^5$", "$10^6$", "$10^7$"))
    for costs, name, colour in ((every, "all stages", pictures.VERMILION),
                                (bare, "bare", pictures.BLUE)):
        shares = [float(cost["percent"]) for cost in costs]
        right.plot(shares, [cost["copy"] for cost in costs], "o--", color=colour,
                   markerfacecolor="white", label=f"copy, {name}")
        right.plot(shares, [cost["time"] for cost in costs], "o-", color=colour, label=name)
    right.set(xscale="log", yscale="log", xlabel="share of the skin in contact (%)",
              ylabel="ns per pillar")
    pictures.plain_ticks(right.xaxis, (0.1, 1, 10, 100))
    # Space for the legend above the lines.
    right.set_ylim(top=5 * right.get_ylim()[1])
    for axis in (left, right):
        pictures.plain_ticks(axis.yaxis)
    left.legend(loc="upper right")
    right.legend(loc="upper left")
    pictures.save(figure, folder, "size_and_contact")


# --- Latency ---

def draw_latency(bench, folder):
    """Bands reach from the median to the 99 % quantile."""
    figure, axis = pictures.panels(640, 400)
    cases = bench.group("latency")
    pillars = [bench.value(case, "pillars") for case in cases]
    for key, label, style, colour in (("opencl", "OpenCL", "s-", pictures.ORANGE),
                                      ("host", "host", "o-", pictures.BLUE)):
        median, late = ([bench.value(case, f"{key}_{what}_us") for case in cases]
                        for what in ("median", "p99"))
        axis.fill_between(pillars, median, late, color=colour, alpha=0.15, linewidth=0)
        axis.plot(pillars, median, style, color=colour, label=label)
    axis.set(xscale="log", yscale="log", xlabel="pillars", ylabel="latency of a frame (µs)")
    pictures.plain_ticks(axis.xaxis, (1e2, 1e3, 1e4, 1e5, 1e6),
                         ("$10^2$", "$10^3$", "$10^4$", "$10^5$", "$10^6$"))
    pictures.plain_ticks(axis.yaxis)
    axis.legend(loc="upper left")
    pictures.save(figure, folder, "latency")


# --- Stages ---

def stage_rows(bench):
    bare = bench.value("stage/none", "ns_per_pillar")
    for case in bench.group("stage"):
        time = bench.value(case, "ns_per_pillar")
        yield [case.removeprefix("stage/"), *bench.cells(case, "ns_per_pillar:.3g of_copy:.2f"),
               text(time / bare)]


def main(docs, bench_json, live_json):
    folder = Path(docs, "pictures", "performance")
    bench, live = Bench(bench_json, page.load(bench_json)), page.load(live_json)["summary"]
    bare, every = list(contact_costs(bench, "bare")), list(contact_costs(bench, "all"))
    draw_sizes(list(sizes(bench)), bare, every, folder)
    draw_latency(bench, folder)
    context = {"commit": "unknown"} | bench.context
    kept = processors.keep(docs, "goals", {"date": context["date"][:10], "commit": context["commit"],
                                           "goals": goals(bench, live)})
    page.update(docs, "performance", goal_table=goal_table(kept), stage_rows=stage_rows(bench))


if __name__ == "__main__":
    page.run(main)
