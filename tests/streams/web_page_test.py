"""The page of the sink web in a real Chromium, where one is installed."""

import pathlib
import re
import sys
import time
import unittest

import h5py
import numpy as np
from browser import PROGRAM, Browser
from sink_process import SinkTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/site"))
import replay  # noqa: E402


class PageTest(SinkTest):
    """Frames go on until the end of a test."""

    def setUp(self):
        super().setUp()
        self.browser = Browser()
        self.addCleanup(self.browser.close)
        process = self.start("--to", "web:0", "--rate", 100, "--frames", 1_000_000,
                             "--wait-for-clients", 1)
        [self.url] = process.sinks

    def wait(self, page, expression):
        """Waits until an expression is true in the page, and returns its value."""
        deadline = time.monotonic() + 300
        while not (value := page.value(expression)):
            self.assertLess(time.monotonic(), deadline, expression)
            time.sleep(0.01)
        return value

    def open_page(self):
        page = self.browser.open(self.url)
        self.wait(page, "document.getElementById('frame')?.textContent")
        return page

    def test_forces_under_the_cursor(self):
        self.run_driver("--reference", self.folder / "one_round.h5")
        with h5py.File(self.folder / "one_round.h5") as file:
            forces = [file[f"force/{name}"][:] for name in ("shear_x", "shear_y", "normal")]
        frames, rows, cols = forces[0].shape
        page = self.open_page()
        x, y, width, height = page.value("const box = element('field').getBoundingClientRect();"
                                         "[box.x, box.y, box.width, box.height]")
        text = "element('frame').textContent + ' ' + element('cursor').textContent"
        seen = set()
        for row, col in ((12, 4), (18, 16), (19, 15), (0, cols - 1), (rows - 1, 0)):
            page.move_mouse(x + (col + 0.5) * width / cols, y + (row + 0.5) * height / rows)
            self.wait(page, f"({text}).includes('row {row}, column {col}:')")
            for _ in range(10):
                shown = page.value(text)
                frame = int(re.match(r"frame (\d+)", shown)[1]) % frames
                numbers = [float(number) for number in re.findall(r"(\S+) N", shown)]
                true = [plane[frame, row, col] for plane in forces]
                np.testing.assert_allclose(numbers, true, rtol=0, atol=0.51e-4, err_msg=shown)
                seen.update(numbers)
                self.wait(page, f"!element('frame').textContent.startsWith('frame {frame},')")
        self.assertGreater(len(seen), 10)

    def test_the_picture_has_the_colours_of_the_field_and_no_other_source(self):
        page = self.open_page()
        # In one call, so that forces and pixels are of one frame.
        cells = page.value("""draw(performance.now());
          const {rows, cols, normal, status} = picture;
          const pixels = cells.getContext("2d").getImageData(0, 0, cols, rows).data;
          [...normal].map((force, i) => [force, status[i], ...pixels.slice(4 * i, 4 * i + 3)])""")
        known = sorted(cell for cell in cells if not cell[1] & 64 and cell[1] & 47)
        idle = [cell[2:] for cell in cells if not cell[1] & (64 | 47)]
        self.assertEqual(idle, [[38, 42, 48]] * len(idle))
        reds = [cell[2] for cell in known]  # in this map they grow with the force
        self.assertEqual(reds, sorted(reds))
        self.assertGreater(len(set(reds)), 20)
        self.assertEqual(page.value("performance.getEntriesByType('resource').length"), 0)

    def test_ambiguous_pillars_are_hatched_and_no_others(self):
        page = self.open_page()
        # The share of orange pixels in the middle of each cell, far from arrows of other cells.
        cells = self.wait(page, """draw(performance.now());
          [...picture.status].filter(bits => (bits & 80) === 16).length > 5 && [...picture.status].map((bits, i) => {
            const {rows, cols} = picture, width = field.width / cols, height = field.height / rows;
            const {data} = field.getContext("2d").getImageData((i % cols + 0.25) * width,
                (Math.floor(i / cols) + 0.25) * height, width / 2, height / 2);
            let orange = 0;
            for (let at = 0; at < data.length; at += 4) {
              orange += data[at] > 1.45 * data[at + 1] && data[at + 1] > 1.8 * data[at + 2];
            }
            return [bits, orange / data.length];
          })""")
        hatched = [share > 0.02 for _, share in cells]
        self.assertEqual(hatched, [bits & 80 == 16 for bits, _ in cells])

    def test_a_replay_needs_no_server(self):
        replay.save(self.url, self.scene, self.folder / "replay")
        self.url = f"file://{self.folder}/replay.html"
        page = self.open_page()
        # The second round of forty frames.
        self.wait(page, "picture.sequence > 60 && element('state').textContent === 'recorded'")

    def test_words_and_width(self):
        page = self.open_page()
        text = self.wait(page, """Object.values(picture.contacts).forEach((each, i) => each.slip = i % 2 + 2);
          drawTotals();
          Object.keys(picture.contacts).length > 1 && element("contacts").textContent""")
        for word in ("normal N", "P(slip) 0.3 s", "all", "partial", "sliding"):
            self.assertIn(word, text)
        for width, height in ((390, 844), (1280, 720), (1920, 1080)):
            self.browser.call("Emulation.setDeviceMetricsOverride", page.session, width=width, height=height,
                              deviceScaleFactor=1, mobile=False)
            self.wait(page, f"innerWidth === {width} && document.documentElement.scrollWidth <= {width}"
                            " && field.width > 200")


if __name__ == "__main__":
    if PROGRAM is None:
        sys.exit(print("skipped: no chromium is installed"))
    unittest.main()
