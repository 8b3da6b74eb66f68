"""PYTHONPATH=lab/benchmark histories.py DOCS HISTORIES ENTRY...: scores the entries and writes the tables of
DOCS/histories.md."""

import sys

import page
import score

tables = score.tables(*score.run(sys.argv[2], sys.argv[3:]))
page.update(sys.argv[1], "histories", **{name: rows[name == "entry_rows":] for name, rows in tables.items()})
