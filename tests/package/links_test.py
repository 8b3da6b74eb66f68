"""Links of the Markdown pages lead to files and headings; every scene has a place in the gallery."""

import os
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
sys.path.insert(0, str(SOURCE / "docs/site"))
import page  # noqa: E402


def prose(path):
    """The page without code."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    return re.sub(r"`[^`]*`", "`code`",
                  "".join(line for line, code in zip(lines, page.is_code(lines)) if not code))


def anchors(path):
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    return set(page.anchors(lines))


def broken(path):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(path)):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        other = (path.parent / file).resolve() if file else path
        if not other.exists():
            yield f"{path.relative_to(SOURCE)}: {target}: no such file"
        elif anchor and anchor not in anchors(other):
            yield f"{path.relative_to(SOURCE)}: {target}: no such heading"


class Links(unittest.TestCase):
    def test_links_lead_somewhere(self):
        self.assertGreater(len(page.PAGES), 30)
        self.assertEqual([fault for path in sorted(page.PAGES) for fault in broken(path)], [])

    def test_tables_are_whole(self):
        """A row stands below another one, or heads a table."""
        for path in sorted(page.PAGES):
            self.assertEqual(re.findall(r"\n\n(\|.*)\n(?!\|[-:|\s]+\|\n)", prose(path)), [], path)

    def test_every_scene_is_in_the_gallery(self):
        shown = set(re.findall(r"^`scenes/(.*?)`\.", (SOURCE / "docs/gallery.md").read_text(), re.MULTILINE))
        self.assertEqual(shown, {str(path.relative_to(SOURCE / "scenes")) for path in (SOURCE / "scenes").rglob("*.toml")})

    def test_the_menu_has_every_page(self):
        menu = re.findall(r"@ref ([\w-]+)", (SOURCE / "docs/site/layout.xml").read_text())
        self.assertEqual(sorted(["index", *menu]), sorted(page.page_name(path) for path in page.PAGES))

    def test_the_first_page_has_a_replay(self):
        self.assertIn('src="hand.html"', page.replayed(page.MAIN.read_text()))

    def test_named_files_exist(self):
        """Paths in these pages, `host/io/*.h` and `host/io/file.{h,cpp}` among them."""
        folders = "|".join(path.name for path in SOURCE.iterdir() if path.is_dir())
        for name in ("CONTRIBUTING.md", "ARCHITECTURE.md", "SECURITY.md"):
            paths = re.findall(rf"`((?:{folders})/[^` ]*)`", (SOURCE / name).read_text())
            paths = [re.sub(r"\{.*\}", ending, path) for path in paths if not path.startswith("build/")
                     for ending in (re.search(r"\{(.*)\}", path) or ["", ""])[1].split(",")]
            self.assertGreater(len(paths), 10)
            self.assertEqual([path for path in paths if not any(SOURCE.glob(path))], [], name)

    def test_math_links_and_headings_for_doxygen(self):
        text = "# T\n\n$a$ and `$b$`, [x](#y)\n\n    $code$\n\n## Y\n## Y\n"
        got = "".join(page.convert(SOURCE / "docs/formats.md", text.splitlines(keepends=True)))
        self.assertEqual(got, "# T {#formats}\n\n\\f$a\\f$ and `$b$`, <a href=\"formats.html#formats--y\">x</a>\n\n"
                              "    $code$\n\n## Y {#formats--y}\n## Y {#formats--y-1}\n")


if __name__ == "__main__":
    unittest.main()
