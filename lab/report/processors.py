"""Kinds of processors, and what was measured on each of them."""

import json
import re
from pathlib import Path

import page

ZEN = {23: "Zen or Zen 2", 26: "Zen 5"}


def generation(vendor, family, model):
    """What tells processors of one name apart: virtual machines call all of them "AMD EPYC"."""
    if vendor == "AuthenticAMD" and family == 25:
        return "Zen 4" if 0x10 <= model < 0x20 or 0x60 <= model < 0xB0 else "Zen 3"
    if vendor == "AuthenticAMD" and family in ZEN:
        return ZEN[family]
    return f"family {family} model {model}"


def name():
    """Name and generation of this processor, "AMD EPYC (Zen 5)"; "unknown" where Linux does not tell."""
    fields = dict(re.findall(r"^([a-z_ ]+?)\s*: (.*)$",
                             Path("/proc/cpuinfo").read_text(encoding="utf-8").split("\n\n")[0], re.MULTILINE))
    try:
        kind = generation(fields["vendor_id"], int(fields["cpu family"]), int(fields["model"]))
        return f"{fields['model name'].strip()} ({kind})"
    except (KeyError, ValueError):
        return fields.get("model name", "unknown")


def keep(docs, what, found):
    """Writes what was found on this processor to DOCS/measured, beside that of other processors.
    Returns all of them, this one first: `found` with the name of its processor."""
    here = {"processor": name()} | found
    folder = Path(docs, "measured")
    folder.mkdir(exist_ok=True)
    kind = re.sub("[^a-z0-9]+", "_", here["processor"].lower()).strip("_")
    (folder / f"{what}_{kind}.json").write_text(
        json.dumps(here, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    kept = [page.load(path) for path in sorted(folder.glob(f"{what}_*.json"))]
    return sorted(kept, key=lambda one: one["processor"] != here["processor"])
