"""Common parts of the pages of ./dev report: reads JSON, writes the tables of a page."""

import json
import math
import re
import sys
from pathlib import Path


class Failure(Exception):
    """One line for the user: place, failure and remedy."""


def load(path):
    """The JSON document in a file."""
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Failure(f"{path}: {error}; measure again with ./dev report") from error


def rows(table):
    """Rows of cells as rows of a Markdown table."""
    return "\n".join(f"| {' | '.join(map(str, row))} |" for row in table)


def cells(values, formats):
    """The values that "key:format key:format" names, as texts."""
    return [format(values[key], pattern)
            for key, pattern in (word.split(":") for word in formats.split())]


def percent(share, digits=1):
    return f"{100 * share:.{digits}f}"


def met_or_not(holds):
    """The last cell of a goal."""
    return "met" if holds else "**not met**"


def root_mean_square(values):
    """None of no values."""
    values = list(values)
    return math.sqrt(sum(value * value for value in values) / len(values)) if values else None


def text(value, pattern=".2f", otherwise="–"):
    """A number by a format specification; `otherwise` where there is none."""
    return otherwise if value is None else format(value, pattern)


def update(docs, name, **tables):
    """Writes tables of DOCS/NAME.md, each below a line <!-- KEY -->. The first row of a table whose key ends in
    _table is its head; others keep the head of the page."""
    path = Path(docs, f"{name}.md")
    page = path.read_text(encoding="utf-8")
    for key, table in tables.items():
        head, table = "", list(table)
        if key.endswith("_table"):
            head = f"{rows(table[:1])}\n|--{'|--:' * (len(table.pop(0)) - 1)}|\n"
        page, found = re.subn(rf"(<!-- {key} -->\n\n)(\|.*\n\|.*\n)(?:\|.*\n)*",
                              lambda match: match[1] + (head or match[2]) + rows(table) + "\n", page)
        if found != 1:
            raise Failure(f"{path}: {found} tables below <!-- {key} -->; there must be one")
    path.write_text(page, encoding="utf-8")


def run(main):
    """Runs a script's main function on its command-line arguments."""
    if len(sys.argv) - 1 != main.__code__.co_argcount:
        print(sys.modules["__main__"].__doc__, file=sys.stderr)
        sys.exit(2)
    try:
        main(*sys.argv[1:])
    except Failure as failure:
        sys.exit(f"{Path(sys.argv[0]).name}: {failure}")
    except KeyError as key:
        sys.exit(f"{Path(sys.argv[0]).name}: the measurements have no {key}; "
                 "measure again with ./dev report")
