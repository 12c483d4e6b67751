#!/usr/bin/env python3
"""Draws the paper's Figs. 2 to 7 from our trajectories, and a success map, as SVG.

Usage: paper_figures.py DATA DIRECTORY

DATA       has cycle.csv (paper_cycle), nominal.csv and friction.csv (steerstat replay), basin.csv (steerstat export)
DIRECTORY  where figure-2.svg to figure-7.svg and success-map.svg go

The same data give the same bytes with the same matplotlib.
"""

import csv
import math
import pathlib
import re
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.patches import PathPatch  # noqa: E402
from matplotlib.path import Path  # noqa: E402

# Okabe and Ito's colours, which the colour-blind tell apart.
BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "#555555"
PHASES = {"align": "#e8edf3", "drift": "#ffffff", "contraction": "#fdf0d8", "swing": "#f3e3ee"}
PHASE_NAMES = {"align": "alignment", "drift": "drift (a = 0)", "contraction": "contraction", "swing": "swing"}
GOAL = {"q1": 0.0, "q2": math.pi / 4}

plt.rcParams.update({
    "svg.fonttype": "none",  # text stays text: small, searchable
    "svg.hashsalt": "steerstat",  # the same names in every run
    "font.family": "sans-serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.labelcolor": "#222222",
    "xtick.color": "#444444",
    "ytick.color": "#444444",
    "lines.linewidth": 1.3,
    "figure.facecolor": "white",
    "path.simplify_threshold": 0.2,
})


def columns(path):
    """The columns of a CSV file by name; numbers where they are."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names, rows = rows[0], rows[1:]
    if not rows:
        sys.exit(f"{path}: has no rows")

    def parsed(text):
        try:
            return float(text)
        except ValueError:
            return text

    return {name: [parsed(row[i]) for row in rows] for i, name in enumerate(names)}


def save(figure, directory, name):
    path = directory / f"{name}.svg"
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    plt.close(figure)
    # Hundredths of a point are fine enough for attributes (what is written stays), and no line need end in blanks.
    text = re.sub(r'="[^"]*"', lambda attribute: re.sub(r"(?<=\d\.\d\d)\d+", "", attribute.group()),
                  path.read_text(encoding="utf-8"))
    path.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n", encoding="utf-8")
    print(f"{path} ({path.stat().st_size / 1000:.0f} kB)")


def shade_phases(axes, course):
    """Bands behind the curves, one a phase; the kinds that occur."""
    t, phase = course["t"], course["phase"]
    start, seen = 0, []
    for i in range(1, len(t) + 1):
        if i < len(t) and phase[i] == phase[start]:
            continue
        for axis in axes:
            axis.axvspan(t[start], t[i - 1], color=PHASES[phase[start]], linewidth=0, zorder=0)
        if phase[start] not in seen:
            seen.append(phase[start])
        start = i
    return seen


def course_figure(course, panels, directory, name, title):
    """Stacked panels over time: (column, label, reference or None) each."""
    figure, axes = plt.subplots(len(panels), 1, sharex=True, figsize=(6.4, 4.2), layout="constrained")
    seen = shade_phases(axes, course)
    for axis, (column, label, reference) in zip(axes, panels):
        axis.plot(course["t"], course[column], color=BLUE)
        if reference is not None:
            axis.axhline(reference, color=ORANGE, linestyle=(0, (5, 3)), linewidth=1.0)
        axis.set_ylabel(label)
        axis.margins(x=0)
    axes[-1].set_xlabel("time [s]")
    axes[0].set_title(title, loc="left", fontsize=9)
    patches = [plt.Rectangle((0, 0), 1, 1, facecolor=PHASES[kind], edgecolor="#bbbbbb", linewidth=0.5) for kind in seen]
    axes[-1].legend(patches, [PHASE_NAMES[kind] for kind in seen], loc="upper center", bbox_to_anchor=(0.5, -0.28),
                    ncol=len(seen), frameon=False, fontsize=8)
    save(figure, directory, name)


def cycle_figure(cycle, directory):
    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6.4, 4.2), layout="constrained")
    for axis, column, label in zip(axes, ("q2", "q2_dot"), ("q₂ [rad]", "q̇₂ [rad/s]")):
        axis.plot(cycle["t"], cycle[column], color=BLUE, label="robot")
        axis.plot(cycle["t"], cycle[f"approximate_{column}"], color=ORANGE, linestyle=(0, (5, 3)),
                  label="nilpotent approximation (9)")
        axis.set_ylabel(label)
        axis.margins(x=0)
    axes[0].legend(frameon=False, fontsize=8)
    axes[0].set_title("Fig. 2  Second joint under one cycle, T = 2 s, A = 100 m", loc="left", fontsize=9)
    axes[-1].set_xlabel("time [s]")
    save(figure, directory, "figure-2")


def runs(levels):
    """(row, first column, end column, level) of neighbours in a row that have the same level; None has none."""
    for j, row in enumerate(levels):
        start = 0
        for i in range(1, len(row) + 1):
            if i < len(row) and row[i] == row[start]:
                continue
            if row[start] is not None:
                yield j, start, i, row[start]
            start = i


def success_map(trials, directory, bins=48, steps=16):
    """The share of trials that converge over the plane of two inputs, in colours of `steps` steps."""
    xs, ys = trials["initial_state.q2"], trials["initial_state.q2_dot"]
    low, high = (-math.pi, -0.5), (math.pi, 0.5)
    counts = [[[0, 0] for _ in range(bins)] for _ in range(bins)]
    for x, y, status in zip(xs, ys, trials["status"]):
        i, j = (min(int((v - low[k]) / (high[k] - low[k]) * bins), bins - 1) for k, v in enumerate((x, y)))
        counts[j][i][0] += 1
        counts[j][i][1] += status == "converged"
    levels = [[min(int(c / n * steps), steps - 1) if n else None for n, c in row] for row in counts]
    edges = [[low[k] + (high[k] - low[k]) * i / bins for i in range(bins + 1)] for k in (0, 1)]

    figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    colours = matplotlib.colormaps["cividis"].resampled(steps)
    rectangles = {level: [] for level in range(steps)}
    for j, first, end, level in runs(levels):
        left, right, bottom, top = edges[0][first], edges[0][end], edges[1][j], edges[1][j + 1]
        rectangles[level].append(Path([(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)],
                                      closed=True))
    for level, paths in rectangles.items():  # one path a colour: a fifth of the bytes
        if paths:
            axis.add_patch(PathPatch(Path.make_compound_path(*paths), facecolor=colours(level), linewidth=0,
                                     antialiased=False))
    axis.set_xlim(low[0], high[0])
    axis.set_ylim(low[1], high[1])
    axis.set_xticks([-math.pi, -math.pi / 2, 0, math.pi / 4, math.pi / 2, math.pi],
                    ["−π", "−π/2", "0", "π/4", "π/2", "π"])
    axis.axvline(math.pi / 4, color=ORANGE, linestyle=(0, (5, 3)), linewidth=1.0)
    axis.set_xlabel("q₂ at the start [rad]; the goal is π/4")
    axis.set_ylabel("q̇₂ at the start [rad/s]")
    axis.set_title(f"Which starts converge, f₂ = 0.03 N m s/rad ({len(xs):,} trials)", loc="left", fontsize=9)
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(cmap=colours), ax=axis, label="share that converged")
    bar.outline.set_linewidth(0.5)
    bar.solids.remove()  # a picture of bytes, or slivers
    for level in range(steps):
        bar.ax.axhspan(level / steps, (level + 1) / steps, color=colours(level), linewidth=0, antialiased=False)
    save(figure, directory, "success-map")


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    data, directory = map(pathlib.Path, arguments)
    directory.mkdir(parents=True, exist_ok=True)
    cycle_figure(columns(data / "cycle.csv"), directory)
    positions = [("q1", "q₁ [m]", GOAL["q1"]), ("q2", "q₂ [rad]", GOAL["q2"])]
    velocities = [("q1_dot", "q̇₁ [m/s]", None), ("q2_dot", "q̇₂ [rad/s]", None)]
    commands = [("a", "a [m/s²]", None), ("tau", "τ [N]", None)]
    nominal, friction = columns(data / "nominal.csv"), columns(data / "friction.csv")
    course_figure(nominal, positions, directory, "figure-3", "Fig. 3  Joint positions and their references (dashed)")
    course_figure(nominal, velocities, directory, "figure-4", "Fig. 4  Joint velocities")
    course_figure(nominal, commands, directory, "figure-5", "Fig. 5  Acceleration and force on the first joint")
    course_figure(friction, positions, directory, "figure-6",
                  "Fig. 6  Joint positions and their references (dashed), viscous friction at both joints")
    course_figure(friction, velocities, directory, "figure-7",
                  "Fig. 7  Joint velocities, viscous friction at both joints")
    success_map(columns(data / "basin.csv"), directory)


if __name__ == "__main__":
    main(sys.argv[1:])
