#!/usr/bin/env python3
"""Checks the committed figures: drawings in text, small, all that the README shows, all that the scripts draw.

Usage: figures_test.py SOURCE_DIRECTORY
"""

import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree

SOURCE = pathlib.Path(sys.argv.pop(1))
FIGURES = sorted((SOURCE / "studies" / "figures").iterdir())
SVG = "{http://www.w3.org/2000/svg}"


class Figures(unittest.TestCase):
    def test_are_those_of_the_paper_of_the_policies_and_a_map(self):
        self.assertEqual([path.name for path in FIGURES],
                         [f"figure-{i}.svg" for i in range(2, 8)] +
                         [f"policy-{name}.svg" for name in ("costs", "maps", "success")] + ["success-map.svg"])

    def test_are_drawings_in_text_below_100_kb(self):
        for path in FIGURES:
            with self.subTest(path.name):
                self.assertLess(path.stat().st_size, 100_000)
                root = ElementTree.parse(path).getroot()
                self.assertEqual(root.tag, f"{SVG}svg")
                self.assertEqual(list(root.iter(f"{SVG}image")), [])
                self.assertGreater(len(list(root.iter(f"{SVG}text"))), 5)  # labels are text, not outlines

    def test_name_their_axes_with_units(self):
        for path in FIGURES:
            with self.subTest(path.name):
                texts = " ".join("".join(text.itertext()) for text in ElementTree.parse(path).iter(f"{SVG}text"))
                self.assertRegex(texts, r"\[(s|rad|N m s/rad)\]")

    def test_that_the_readme_shows_are_there(self):
        readme = (SOURCE / "README.md").read_text(encoding="utf-8")
        shown = re.findall(r"!\[[^\]]+\]\((studies/figures/[^)]+)\)", readme)
        self.assertGreaterEqual(len(shown), 3)
        for path in shown:
            self.assertTrue((SOURCE / path).is_file(), path)


if __name__ == "__main__":
    unittest.main()
