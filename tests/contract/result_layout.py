"""What a result file has, by the interface's description: written out by hand, not taken from the engine."""

import sys

import numpy as np

OUTCOMES = {"converged": 0, "timeout": 1, "singular": 2, "diverged": 3, "integrator_failed": 4}
PHASES = {"align": 0, "drift": 1, "contraction": 2, "swing": 3}
TRIALS = {
    "index": ("<u8", "1"),
    "cell": ("<u8", "1"),
    "status": (OUTCOMES, "1"),
    "settling_time": ("<f8", "s"),
    "end_time": ("<f8", "s"),
    "cycles": ("<u4", "1"),
    "swings": ("<u4", "1"),
    "alignments": ("<u4", "1"),
    "passive_error": ("<f8", "rad, rad/s"),
    "active_error": ("<f8", "m, m/s"),
    "q1": ("<f8", "m"),
    "q2": ("<f8", "rad"),
    "q1_dot": ("<f8", "m/s"),
    "q2_dot": ("<f8", "rad/s"),
}
METRICS = {
    "effort": ("<f8", "N^2 s"),
    "peak_acceleration": ("<f8", "m/s^2"),
    "peak_force": ("<f8", "N"),
    "peak_stroke": ("<f8", "m"),
    "position_contraction_mean": ("<f8", "1"),
    "position_contraction_worst": ("<f8", "1"),
    "velocity_contraction_mean": ("<f8", "1"),
    "velocity_contraction_worst": ("<f8", "1"),
}
TRIALS.update(METRICS)
AUDIT = {name: TRIALS[name] for name in ("index", "status", "cycles", "swings", "settling_time")}
TRAJECTORY = {
    "t": ("<f8", "s"),
    "q1": ("<f8", "m"),
    "q2": ("<f8", "rad"),
    "q1_dot": ("<f8", "m/s"),
    "q2_dot": ("<f8", "rad/s"),
    "a": ("<f8", "m/s^2"),
    "tau": ("<f8", "N"),
    "phase": (PHASES, "1"),
}
PARAMETER_UNITS = {
    "plant.m1": "kg",
    "plant.m2": "kg",
    "plant.f1": "N s/m",
    "plant.f2": "N m s/rad",
    "initial_state.q1": "m",
    "initial_state.q2": "rad",
    "initial_state.q2_dot": "rad/s",
    "controller.contraction.eta1": "1",
    "controller.contraction.eta2": "1",
}


def equal(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: {found!r}, where {expected!r} should be")


def varying_inputs(spec):
    """Dotted names of what a spec lets vary, and how many cells its sweeps make."""
    names, cells = set(), 1

    def visit(value, name):
        nonlocal cells
        if not isinstance(value, dict):
            return
        if "sweep" in value:
            cells *= len(value["sweep"])
        if set(value) & {"sweep", "uniform", "normal", "truncated_normal", "lognormal", "triangular", "discrete"}:
            names.add(name)
            return
        for key, inner in value.items():
            visit(inner, f"{name}.{key}")

    for group in ("plant", "initial_state", "controller"):
        visit(spec[group], group)
    listed = spec["sampling"].get("trials")
    if isinstance(listed, list):
        names.update(listed[0])
    return names, cells


def trials_a_draw(spec, names):
    """What a row of sobol_indices gives; 1 for every other method."""
    return len(names) + 2 if spec["sampling"]["method"] == "sobol_indices" else 1


def levels_of(index, states):
    """All states of level 0 are drawn; a tenth of each further one's are states of the level before."""
    return np.where(index < states, 0, 1 + (index.astype(np.int64) - states) // (states - states // 10))
