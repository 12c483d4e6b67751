#!/usr/bin/env python3
"""Holds our estimators against SciPy's.

Usage: check_estimates.py PRINT_ESTIMATES

Exits 1 after naming every case in which print_estimates' bounds differ from SciPy's by more than rounding.
"""

import math
import random
import subprocess
import sys

from scipy import optimize, special, stats

# SciPy finds Clopper-Pearson bounds by a root search to an absolute 2e-12.
ROOT_TOLERANCE = 4e-12


def proportion_cases():
    for n in (1, 2, 20, 997, 100_000):
        for x in sorted({0, 1, n // 3, n - 1, n}):
            for level in (0.5, 0.95, 0.999):
                interval = stats.binomtest(x, n).proportion_ci
                yield f"wilson {x} {n} {level}", interval(level, "wilson"), 1e-12
                yield f"clopper_pearson {x} {n} {level}", interval(level, "exact"), ROOT_TOLERANCE


def quantile_cases():
    generator = random.Random(1)
    for n in (1, 2, 5, 58, 59, 60, 400, 3000):
        sample = sorted(generator.lognormvariate(4, 0.5) for _ in range(n))
        for p in (0.05, 0.5, 0.95, 0.99):
            for level in (0.6, 0.95, 0.999):
                tail = (1 - level) / 2
                low = int(stats.binom.ppf(tail, n, p))  # the least count whose probability passes the tail
                high = int(stats.binom.isf(tail, n, p)) + 1
                bounds = (sample[low - 1] if low > 0 else math.nan, sample[high - 1] if high <= n else math.nan)
                yield f"quantile {p} {level} " + " ".join(map(repr, sample)), bounds, 0.0


def mean_cases():
    for n in (2, 3, 30, 10_000):
        for level in (0.5, 0.95, 0.999):
            mean, std = 92.3, 80.2
            # Not stats.t.ppf: it is right to nine digits only, where the distribution function is to fifteen.
            t = optimize.brentq(lambda t: stats.t.sf(t, n - 1) - (1 - level) / 2, 0, 1e4, xtol=1e-13, rtol=1e-14)
            reach = t * std / math.sqrt(n)
            yield f"mean {mean} {std} {n} {level}", (mean - reach, mean + reach), 1e-11 * (mean + reach)


def log_mixture_ratio(x, n, p):
    return special.betaln(x + 0.5, n - x + 0.5) - math.log(math.pi) - special.xlogy(x, p) - special.xlog1py(n - x, -p)


def confidence_sequence_cases():
    for n in (1, 2, 20, 997, 100_000):
        for x in sorted({0, 1, n // 3, n - 1, n}):
            for p in (1e-6, 0.3, 0.99):
                ratio = log_mixture_ratio(x, n, p)
                yield f"ratio {x} {n} {p}", (ratio, ratio), 1e-12 * (1 + n)  # betaln's rounding
            for level in (0.5, 0.95, 0.999):
                excess = lambda p: log_mixture_ratio(x, n, p) + math.log(1 - level)
                low = optimize.brentq(excess, 1e-300, x / n, xtol=1e-15) if x > 0 else 0
                high = optimize.brentq(excess, x / n, 1 - 1e-16, xtol=1e-15) if x < n else 1
                yield f"confidence_sequence {x} {n} {level}", (low, high), 1e-11
    for n in (0, 1, 10, 200, 3000):
        for p in (0.05, 0.5, 0.99):
            accepted = [k for k in range(n + 1) if log_mixture_ratio(k, n, p) < -math.log(0.05)]
            low, high = accepted[0], accepted[-1] + 1
            yield f"ranks {n} {p} 0.95", (low if low > 0 else math.nan, high if high <= n else math.nan), 0.0


def mcnemar_cases():
    for a, b in ((0, 0), (0, 1), (1, 7), (5, 5), (16, 6), (0, 60), (480, 520), (4800, 5200), (100_000, 100_500)):
        if a + b == 0:
            yield f"mcnemar {a} {b}", (1, 1), 0.0
            continue
        test = stats.binomtest(a, a + b).pvalue
        mid_p = 2 * stats.binom.cdf(min(a, b), a + b, 0.5) - math.exp(stats.binom.logpmf(a, a + b, 0.5))
        yield f"mcnemar {a} {b}", (test, mid_p), 1e-10 * test


def tango_interval(a, b, pairs, level):
    """Tango's interval from its definition: where the score of the trinomial's likelihood, maximised numerically at a
    given difference b less a, meets the normal quantile."""

    def score(difference):
        most = (1 - abs(difference)) / 2  # of the rarer discordant outcome

        def cells(rarer):
            return rarer + max(0.0, -difference), rarer + max(0.0, difference)

        def slope(rarer):  # of the log likelihood
            p_a, p_b = cells(rarer)
            return a / p_a + b / p_b - 2 * (pairs - a - b) / (1 - p_a - p_b)

        rarer = optimize.brentq(slope, 1e-12 * most, (1 - 1e-12) * most, xtol=1e-300, rtol=1e-15)
        return (b - a - pairs * difference) / math.sqrt(pairs * (sum(cells(rarer)) - difference**2))

    z = stats.norm.isf((1 - level) / 2)
    estimate = (b - a) / pairs
    low = optimize.brentq(lambda d: score(d) - z, -0.99, estimate - 1e-9, xtol=1e-14)
    high = optimize.brentq(lambda d: score(d) + z, estimate + 1e-9, 0.99, xtol=1e-14)
    return low, high


def tango_cases():
    for a, b, pairs in ((7, 1, 21), (16, 6, 161), (12, 2, 50), (28, 25, 618), (3, 40, 2000), (41, 48, 549)):
        for level in (0.5, 0.95, 0.999):
            yield f"tango {a} {b} {pairs} {level}", tango_interval(a, b, pairs, level), 1e-10


def same(found, expected, tolerance):
    return (math.isnan(found) and math.isnan(expected)) or abs(found - expected) <= tolerance


def main(program):
    cases = [*proportion_cases(), *quantile_cases(), *mean_cases(), *confidence_sequence_cases()]
    cases += [*mcnemar_cases(), *tango_cases()]
    lines = "".join(line + "\n" for line, _, _ in cases)
    printed = subprocess.run([program], input=lines, capture_output=True, text=True, check=True).stdout.splitlines()
    if len(printed) != len(cases):
        sys.exit(f"{len(printed)} answers to {len(cases)} cases")
    wrong = 0
    for (line, expected, tolerance), answer in zip(cases, printed):
        found = [float(word) for word in answer.split()]
        if not all(same(f, float(e), tolerance) for f, e in zip(found, expected)):
            wrong += 1
            print(f"{line[:80]}: {found} is not {[float(e) for e in expected]}")
    print(f"{len(cases)} cases, {wrong} wrong")
    sys.exit(wrong > 0)


main(*sys.argv[1:])
