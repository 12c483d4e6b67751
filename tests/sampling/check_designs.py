#!/usr/bin/env python3
"""Holds our designs against those of scipy.stats.qmc.

Usage: check_designs.py WRITE_DESIGN_POINTS
"""

import subprocess
import sys
import unittest

import numpy as np
from scipy.stats import qmc

WRITE_DESIGN_POINTS = None
SEEDS = 60


def points(design, dimensions, count, *seed):
    output = subprocess.run([WRITE_DESIGN_POINTS, design, str(dimensions), str(count), *map(str, seed)],
                            check=True, capture_output=True, text=True).stdout
    values = np.array([[float.fromhex(x) for x in line.split()] for line in output.splitlines()])
    assert values.shape == (count, dimensions)
    return values


def discrepancies(sample):
    """Squared centred discrepancies of a sample a seed, of points that the second half of the cube tells apart too."""
    return np.array([qmc.discrepancy(sample(seed), method="CD") for seed in range(SEEDS)])


class Designs(unittest.TestCase):
    def assert_same_mean(self, ours, theirs):
        error = np.sqrt(ours.var(ddof=1) / SEEDS + theirs.var(ddof=1) / SEEDS)
        self.assertLess(abs(ours.mean() - theirs.mean()), 4.5 * error)

    def test_the_sequence_is_scipys_point_by_point_in_every_dimension(self):
        ours = points("sequence", 101, 4096)
        theirs = qmc.Sobol(101, scramble=False).random(4096)
        self.assertTrue(np.array_equal(ours, theirs))

    def test_scrambled_points_have_the_discrepancy_that_scipys_have(self):
        # scipy scrambles by random matrices and shifts. Pairs of points, and so the mean of a squared discrepancy,
        # have the same law under both [Matousek 1998].
        for dimensions in (2, 5, 8):
            ours = discrepancies(lambda seed: points("sobol", dimensions, 128, seed))
            theirs = discrepancies(lambda seed: qmc.Sobol(dimensions, seed=seed).random(128))
            self.assert_same_mean(ours, theirs)

    def test_latin_hypercubes_have_the_discrepancy_that_scipys_have(self):
        for dimensions in (2, 5):
            for count in (5, 64):
                ours = discrepancies(lambda seed: points("latin_hypercube", dimensions, count, seed))
                theirs = discrepancies(lambda seed: qmc.LatinHypercube(dimensions, seed=seed).random(count))
                self.assert_same_mean(ours, theirs)

    def test_designs_are_ordered_by_discrepancy(self):
        sobol = discrepancies(lambda seed: points("sobol", 2, 128, seed)).mean()
        latin = discrepancies(lambda seed: points("latin_hypercube", 2, 128, seed)).mean()
        independent = discrepancies(lambda seed: np.random.default_rng(seed).random((128, 2))).mean()
        self.assertLess(sobol, latin / 4)
        self.assertLess(latin, independent / 2)


if __name__ == "__main__":
    WRITE_DESIGN_POINTS = sys.argv.pop(1)
    unittest.main()
