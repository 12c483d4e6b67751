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


def points(design, dimensions, count, seeds):
    """(seeds x count x dimensions) the points of our designs of seeds 0, 1, ..."""
    output = subprocess.run([WRITE_DESIGN_POINTS, design, str(dimensions), str(count), str(seeds)], check=True,
                            capture_output=True, text=True).stdout
    return np.array([float.fromhex(x) for x in output.split()]).reshape(seeds, count, dimensions)


def discrepancies(samples):
    """(samples) squared centred discrepancies."""
    return np.array([qmc.discrepancy(sample, method="CD") for sample in samples])


def our_discrepancies(design, dimensions, count):
    return discrepancies(points(design, dimensions, count, SEEDS))


class Designs(unittest.TestCase):
    def assert_same_mean(self, ours, theirs):
        error = np.sqrt(ours.var(ddof=1) / SEEDS + theirs.var(ddof=1) / SEEDS)
        self.assertLess(abs(ours.mean() - theirs.mean()), 4.5 * error)

    def test_the_sequence_is_scipys_point_by_point_in_every_dimension(self):
        ours, = points("sequence", 101, 4096, 1)
        theirs = qmc.Sobol(101, scramble=False).random(4096)
        self.assertTrue(np.array_equal(ours, theirs))

    def test_scrambled_points_have_the_discrepancy_that_scipys_have(self):
        # scipy scrambles by random matrices and shifts. Pairs of points, and so the mean of a squared discrepancy,
        # have the same law under both [Matousek 1998].
        for dimensions in (2, 5, 8):
            theirs = discrepancies(qmc.Sobol(dimensions, seed=seed).random(128) for seed in range(SEEDS))
            self.assert_same_mean(our_discrepancies("sobol", dimensions, 128), theirs)

    def test_latin_hypercubes_have_the_discrepancy_that_scipys_have(self):
        for dimensions in (2, 5):
            for count in (5, 64):
                theirs = discrepancies(qmc.LatinHypercube(dimensions, seed=s).random(count) for s in range(SEEDS))
                self.assert_same_mean(our_discrepancies("latin_hypercube", dimensions, count), theirs)

    def test_designs_are_ordered_by_discrepancy(self):
        sobol = our_discrepancies("sobol", 2, 128).mean()
        latin = our_discrepancies("latin_hypercube", 2, 128).mean()
        independent = discrepancies(np.random.default_rng(seed).random((128, 2)) for seed in range(SEEDS)).mean()
        self.assertLess(sobol, latin / 4)
        self.assertLess(latin, independent / 2)


if __name__ == "__main__":
    WRITE_DESIGN_POINTS = sys.argv.pop(1)
    unittest.main()
