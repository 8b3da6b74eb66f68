"""PYTHONPATH=lab/benchmark histories.py DOCS HISTORIES ENTRY...: scores the entries and writes DOCS/histories.md."""

import sys

import page
import processors
import score

histories, found = score.run(sys.argv[2], sys.argv[3:])
by_history = [[history.name, *(f"{scores[index]['region_3']:.2f}" for _, scores, _ in found)]
              for index, history in enumerate(histories)]
page.write(sys.argv[1], "histories", entry_rows=list(score.table(found))[1:], history_rows=by_history,
           entries=" | ".join(f"`{name}`" for name, _, _ in found), ruler="--:|" * len(found), processor=processors.name())
