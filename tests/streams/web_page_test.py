"""The page of the sink web in a real Chromium, where one is installed."""

import re
import sys
import time
import unittest

import h5py
import numpy as np
from browser import PROGRAM, Browser
from sink_process import SinkTest


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
        known = sorted(cell for cell in cells if not cell[1] & 64)
        self.assertEqual(known[0][2:], [0, 34, 78])
        reds = [cell[2] for cell in known]  # in this map they grow with the force
        self.assertEqual(reds, sorted(reds))
        self.assertGreater(len(set(reds)), 20)
        self.assertEqual(page.value("performance.getEntriesByType('resource').length"), 0)


if __name__ == "__main__":
    if PROGRAM is None:
        sys.exit(print("skipped: no chromium is installed"))
    unittest.main()
