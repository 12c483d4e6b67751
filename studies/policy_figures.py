#!/usr/bin/env python3
"""Draws the paper's policy beside the robust one, as SVG.

Usage: policy_figures.py DATA DIRECTORY

DATA       has friction.paper.csv, friction.robust.csv, combined.paper.csv and combined.robust.csv (steerstat export)
DIRECTORY  where policy-success.svg, policy-maps.svg and policy-costs.svg go

The same data give the same bytes with the same matplotlib.
"""

import csv
import itertools
import math
import pathlib
import sys

import matplotlib.patches
import numpy as np

from paper_figures import BLUE, GREY, ORANGE, matplotlib, plt, save

POLICIES = {"paper": ("the paper's policy", ORANGE), "robust": ("the robust policy", BLUE)}


def columns(path, names):
    """Some columns of a CSV file of trials as arrays, NaN where there is no number, and whether each converged."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"{path}: has no rows")
    data = {name: np.array([float(row[name] or "nan") for row in rows]) for name in names}
    data["converged"] = np.array([row["status"] == "converged" for row in rows])
    return data


def wilson(successes, trials):
    """The 95 % interval [Wilson 1927]."""
    z = 1.959964
    middle = (successes + z * z / 2) / (trials + z * z)
    half = z / (trials + z * z) * np.sqrt(successes * (trials - successes) / trials + z * z / 4)
    return middle - half, middle + half


def success_figure(friction, directory):
    figure, axis = plt.subplots(figsize=(6.4, 2.8), layout="constrained")
    edges = np.linspace(0, 0.2, 41)
    middles = (edges[1:] + edges[:-1]) / 2
    for policy, (label, colour) in POLICIES.items():
        data = friction[policy]
        trials, _ = np.histogram(data["plant.f2"], edges)
        successes, _ = np.histogram(data["plant.f2"][data["converged"]], edges)
        low, high = wilson(successes, trials)
        axis.fill_between(middles, 100 * low, 100 * high, color=colour, alpha=0.3, linewidth=0)
        axis.plot(middles, 100 * successes / trials, color=colour, label=label)
    axis.set_xlabel("friction on the passive joint f₂ [N m s/rad]")
    axis.set_ylabel("converged [%]")
    axis.set_xlim(0, 0.2)
    axis.set_ylim(-3, 103)
    axis.legend(frameon=False, loc="center right")
    axis.set_title("Success against friction, f₁ up to 0.2 too, from the paper's start", loc="left", fontsize=9)
    save(figure, directory, "policy-success")


def fill(axis, edges, share, colours):
    """Draws a map of shares in [0, 1], a rectangle for neighbours in a row that are equal: half the bytes of cells."""
    x, y = edges
    axis.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), facecolor=colours(0.0))
    for row, values in enumerate(share.T):
        first = 0
        for value, equals in itertools.groupby(values):
            last = first + len(list(equals))
            if value > 0:
                axis.add_patch(matplotlib.patches.Rectangle((x[first], y[row]), x[last] - x[first], y[row + 1] - y[row],
                                                            color=colours(value), antialiased=False, linewidth=0))
            first = last


def map_figure(combined, directory):
    figure, axes = plt.subplots(1, 2, figsize=(6.4, 2.8), layout="constrained", sharey=True)
    edges = (np.linspace(-math.pi, math.pi, 25), np.linspace(-0.5, 0.5, 17))
    colours = matplotlib.colormaps["viridis"]
    for axis, (policy, (label, _)) in zip(axes, POLICIES.items()):
        data = combined[policy]
        start = data["initial_state.q2"], data["initial_state.q2_dot"]
        trials, *_ = np.histogram2d(*start, edges)
        failures, *_ = np.histogram2d(*(values[~data["converged"]] for values in start), edges)
        # Twenty colours, few enough that the same share is the same bytes.
        share = np.round(20 * failures / trials) / 20
        fill(axis, edges, share, colours)
        axis.set_xticks([-math.pi, 0, math.pi / 4, math.pi], ["−π", "0", "π/4", "π"])
        axis.set_xlabel("q₂ at the start [rad]")
        axis.set_title(f"{label}: {np.sum(failures):,.0f} failures", loc="left", fontsize=9)
    axes[0].set_ylabel("q̇₂ at the start [rad/s]")
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(cmap=colours), ax=axes, label="share that failed")
    bar.outline.set_linewidth(0.5)
    bar.solids.remove()  # a picture of bytes, or slivers
    for level in range(20):
        bar.ax.axhspan(level / 20, (level + 1) / 20, color=colours(level / 19), linewidth=0, antialiased=False)
    save(figure, directory, "policy-maps")


def cost_figure(combined, directory):
    figure, axes = plt.subplots(1, 3, figsize=(6.4, 2.6), layout="constrained", sharey=True)
    quantities = [("settling_time", "settling time [s]", "linear"),
                  ("peak_acceleration", "largest |a| [m/s²]", "log"),
                  ("peak_stroke", "largest |q₁ − goal| [m]", "linear")]
    for axis, (name, label, scale) in zip(axes, quantities):
        for policy, (policy_name, colour) in POLICIES.items():
            data = combined[policy]
            values = np.sort(np.where(data["converged"], data[name], np.inf) if name == "settling_time" else data[name])
            shares = np.linspace(0, 1, 400)
            at = values[np.minimum((shares * len(values)).astype(int), len(values) - 1)]
            finite = np.isfinite(at)
            axis.plot(at[finite], 100 * shares[finite], color=colour, label=policy_name)
        axis.set_xscale(scale)
        axis.set_xlabel(label)
    axes[1].axvline(19, color=GREY, linestyle=(0, (5, 3)), linewidth=1.0)
    axes[0].set_ylabel("trials at or below [%]")
    axes[0].legend(frameon=False, fontsize=7, loc="upper right", bbox_to_anchor=(1.06, 0.9))
    save(figure, directory, "policy-costs")


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    data, directory = map(pathlib.Path, arguments)
    directory.mkdir(parents=True, exist_ok=True)
    success_figure({policy: columns(data / f"friction.{policy}.csv", ["plant.f2"]) for policy in POLICIES}, directory)
    names = ["initial_state.q2", "initial_state.q2_dot", "settling_time", "peak_acceleration", "peak_stroke"]
    combined = {policy: columns(data / f"combined.{policy}.csv", names) for policy in POLICIES}
    map_figure(combined, directory)
    cost_figure(combined, directory)


if __name__ == "__main__":
    main(sys.argv[1:])
