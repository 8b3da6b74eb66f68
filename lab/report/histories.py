"""histories.py DOCS SCORED: writes DOCS/histories.md from the output of lab/benchmark/score.py --json."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmark"))

import page
import processors
import score


def history_rows(found):
    """Errors in region 3 by history, counts, of all entries."""
    for name in next(iter(found.values()))["histories"]:
        yield [name, *(page.text(one["histories"][name]["region_3"]) for one in found.values())]


def main(docs, scored):
    found = page.load(scored)
    first = next(iter(found.values()))
    page.write(docs, "histories", entry_rows=score.rows(found), history_rows=history_rows(found),
               entries=" | ".join(f"`{name}`" for name in found), ruler="--:|" * len(found),
               histories=len(first["histories"]), processor=processors.name())


if __name__ == "__main__":
    page.run(main)
