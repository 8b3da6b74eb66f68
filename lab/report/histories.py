"""PYTHONPATH=lab/benchmark histories.py DOCS HISTORIES ENTRY...: scores the entries and writes the tables of
DOCS/histories.md."""

import sys

import page
import score

histories, found = score.run(sys.argv[2], sys.argv[3:])
by_history = [[history.name, *(f"{scores[index]['region_3']:.2f}" for _, scores, _ in found)]
              for index, history in enumerate(histories)]
page.update(sys.argv[1], "histories", entry_rows=list(score.table(found))[1:],
            history_table=[["history", *(f"`{name}`" for name, _, _ in found)], *by_history])
