"""Every include of host/ names its own or a lower layer, no include of the product names the laboratory, and viewer
and laboratory include public headers and their own (ARCHITECTURE.md, Layers)."""

import os
import pathlib
import re
import sys

LAYERS = ["kernels", "base", "skin", "solve", "lanes", "contacts", "calibration", "simulation", "compare",
          "device", "io", "streams", "pipeline", "cli"]
PRODUCT = ["host", "kernels", "python", "shaders", "viewer"]
# The header of the library pillarfield_options, which the command lines of programs share.
SHARED = "cli/options/shared_arguments.h"
# The houses beyond the core.
HOUSES = {"viewer": ["viewer", "shaders"], "laboratory": ["bench", "lab", "fuzz"]}
# Public headers without a source file of their name.
HEADER_MODULES = {"version": "base", "indenter": "simulation", "closed_form_contact": "simulation",
                  "scene": "simulation", "friction": "solve", "host_solve": "solve",
                  "read_options": "io", "rgb_picture": "base", "layout_note": "io", "frame_stream": "io", "recording": "io", "force_file": "io",
                  "contact_file": "io", "live": "streams", "stream_format": "streams"}


def modules_of_headers(host):
    """The module of each public header: that of the source file with its name."""
    modules = dict(HEADER_MODULES)
    for layer in LAYERS:
        for source in (host / layer).rglob("*.cpp"):
            modules.setdefault(source.stem, layer)
    return modules


def upward_includes(host):
    modules = modules_of_headers(host)
    rank = {name: index for index, name in enumerate(LAYERS)}
    found = []
    for path in sorted([*host.rglob("*.h"), *host.rglob("*.cpp")]):
        module = path.relative_to(host).parts[0]
        if module == "include":
            module = modules.get(path.stem)
        if module not in rank:
            continue
        for included in re.findall(r'#include "([^"]+)"', path.read_text(encoding="utf-8")):
            folder, _, rest = included.partition("/")
            target = modules.get(pathlib.Path(rest).stem) if folder == "pillarfield" else folder
            if rank.get(target, 0) > rank[module]:
                found.append(f"{path.relative_to(host)} ({module}) includes {included} ({target})")
    return found


def includes_of_the_laboratory(source):
    """A program of users is built without lab, bench, tests and fuzz."""
    for path in sorted(path for folder in PRODUCT for path in (source / folder).rglob("*.*")):
        if path.suffix in (".h", ".cpp", ".cl", ".glsl"):
            text = path.read_text(encoding="utf-8")
            for included in re.findall(r'#include "((?:lab|bench|tests|fuzz)/[^"]+)"', text):
                yield f"{path.relative_to(source)} includes {included}"


def private_includes(source):
    """A house is built on the public interface of the core."""
    for house, folders in HOUSES.items():
        for path in sorted(path for folder in folders for path in (source / folder).rglob("*.*")):
            if path.suffix not in (".h", ".cpp", ".glsl", ".vert", ".frag", ".comp"):
                continue
            for included in re.findall(r'#include "([^"]+)"', path.read_text(encoding="utf-8")):
                is_own = included.partition("/")[0] in folders or (path.parent / included).exists()
                if not is_own and included != SHARED and not included.startswith("pillarfield/"):
                    yield f"{path.relative_to(source)} of the {house} includes {included}"


def main():
    source = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
    host = source / "host"
    unknown = {p.name for p in host.iterdir() if p.is_dir()} - set(LAYERS) - {"include"}
    found = [*upward_includes(host), *includes_of_the_laboratory(source), *private_includes(source),
             *(f"host/{name} is in no layer" for name in unknown)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
