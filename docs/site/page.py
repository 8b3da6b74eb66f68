"""Filter of Doxygen: prints a Markdown page of the repository as Doxygen 1.9.4 understands it.

Headings get the anchors that GitHub gives them, links between pages lead to their HTML, links to files that
are no page become plain text, and $...$ and $$...$$ become formulas.
"""

import html
import itertools
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = {path.resolve() for pattern in ("*.md", "docs/*.md", "docs/*/*.md") for path in ROOT.glob(pattern)}
MAIN = ROOT / "README.md"
# Code, a link (no picture; its words may have brackets, [[[indenter]]](#indenter)), or a formula.
TOKEN = re.compile(r"`[^`]*`|(?<!!)\[(?P<words>(?:\[[^]]*\]+|[^]])*)\]\((?P<target>[^)]+)\)"
                   r"|\$\$(?P<display>.+?)\$\$|\$(?P<inline>.+?)\$", re.DOTALL)


def page_name(path):
    """docs/derivations/contact.md is derivations-contact."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return "index" if path == MAIN else "-".join(parts[parts[0] == "docs":]).lower()


def slug(heading):
    """The anchor that GitHub gives a heading."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def label(path, anchor):
    """The anchor in HTML: Doxygen wants ASCII, and each once in all pages."""
    return f"{page_name(path)}--{anchor}".encode("ascii", "ignore").decode()


def link(path, words, target):
    file, _, anchor = target.partition("#")
    page = (path.parent / file).resolve() if file else path
    if page in PAGES:
        return f'<a href="{page_name(page)}.html{"#" + label(page, anchor) if anchor else ""}">{words}</a>'
    if page.suffix == ".h" and page.is_relative_to(ROOT / "host/include"):
        return f'<a href="{page.stem.replace("_", "__")}_8h.html">{words}</a>'
    return words


def convert_token(path, match):
    # A bar in code within a table.
    if match[0].startswith("`") and r"\|" in match[0]:
        return f"<code>{html.escape(match[0].strip('`'), quote=False)}</code>"
    if match["display"]:
        return rf"\f[{match['display']}\f]"
    if match["inline"]:
        return rf"\f${match['inline']}\f$"
    if match["target"] and not re.match(r"[a-z]+:", match["target"]):
        return link(path, match["words"], match["target"])
    return match[0]


def replayed(text):
    """The first picture as the page hand.html, which docs/site/replay.py writes."""
    return re.sub(r"!\[([^]]*)\]\(docs/pictures/hand\.png\)",
                  r'\\htmlonly<iframe id="replay" src="hand.html" title="\1"></iframe>\\endhtmlonly', text)


def is_code(lines):
    """Whether each line is within a fence or indented code."""
    in_fence = indented = False
    before = ""
    for line in lines:
        fence = line.lstrip().startswith("```")
        in_fence ^= fence
        indented = line.startswith("    ") and (indented or not before.strip())
        yield fence or in_fence or indented
        before = line


def anchors(lines):
    """The anchor of each line: None where it is no heading."""
    seen = {}
    for line, code in zip(lines, is_code(lines)):
        heading = None if code else re.fullmatch(r"#+ (.*)\n", line)
        anchor = slug(heading[1]) if heading else None
        count = seen.get(anchor, 0)
        seen[anchor] = count + 1
        yield f"{anchor}-{count}" if anchor and count else anchor


def headed(path, lines):
    """The lines with the anchors of headings, and whether each is code or a heading."""
    has_title = False
    for line, code, anchor in zip(lines, is_code(lines), anchors(lines)):
        if anchor is None:
            yield line, code
            continue
        name = label(path, anchor) if has_title else page_name(path)
        has_title = True
        yield line if name == "index" else f"{line[:-1]} {{#{name}}}\n", True


def convert(path, lines):
    for fixed, block in itertools.groupby(headed(path, lines), key=lambda pair: pair[1]):
        text = "".join(line for line, _ in block)
        # Doxygen finds no emphasis that begins with code.
        text = re.sub(r"^\*(?=`)((?:.|\n(?!\n))+?)\*$", r"<em>\1</em>", text, flags=re.MULTILINE)
        yield text if fixed else TOKEN.sub(lambda match: convert_token(path, match), text)


if __name__ == "__main__":
    source = pathlib.Path(os.path.abspath(sys.argv[1]))
    sys.stdout.reconfigure(encoding="utf-8")
    # Doxygen wants the title first; reports begin with a comment.
    text = re.sub(r"\A(<!--.*?-->\s*)+", "", source.read_text(encoding="utf-8"), flags=re.DOTALL)
    sys.stdout.write(replayed("".join(convert(source, text.splitlines(keepends=True)))))
