"""Opens result files with h5py alone and holds them against the interface's description.

    check_result_file.py FILE.h5 [SUMMARY.json] ...

The names, types and units below are written out by hand, not taken from the engine: this is the outside's view. A
summary after a file is recomputed from that file's trials. Exits 1 naming the first thing wrong.
"""

import hashlib
import json
import re
import subprocess
import sys

import h5py
import numpy as np
from scipy.stats import norm

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


def check_columns(group, expected, rows):
    equal(f"datasets of {group.name}", set(group), set(expected))
    for name, (kind, units) in expected.items():
        dataset = group[name]
        equal(f"shape of {dataset.name}", dataset.shape, (rows,))
        equal(f"attributes of {dataset.name}", dict(dataset.attrs), {"units": units})
        if isinstance(kind, dict):
            equal(f"enumeration of {dataset.name}", h5py.check_enum_dtype(dataset.dtype), kind)
            equal(f"type of {dataset.name}", dataset.dtype.str, "|u1")
        else:
            equal(f"type of {dataset.name}", dataset.dtype.str, kind)
        if rows > 0:
            equal(f"checksum of {dataset.name}", dataset.fletcher32, True)
        dataset[:]  # every chunk's checksum


def check_attributes(file):
    attributes = dict(file.attrs)
    names = "filetype format_version engine_version created spec spec_sha256 complete wall_s threads simd"
    equal("attributes of the file", set(attributes), set(names.split()))
    for name in ("filetype", "engine_version", "created", "spec", "spec_sha256", "simd"):
        equal(f"type of {name}", type(attributes[name]), str)
    equal("filetype", attributes["filetype"], "steerstat-study")
    equal("format_version", attributes["format_version"], 1)
    equal("type of complete", type(attributes["complete"]), np.bool_)
    equal("engine_version", bool(re.fullmatch(r"\d+\.\d+\.\d+", attributes["engine_version"])), True)
    equal("created", bool(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", attributes["created"])), True)
    equal("spec_sha256", attributes["spec_sha256"], hashlib.sha256(attributes["spec"].encode()).hexdigest())
    equal("simd", attributes["simd"] in ("avx512", "avx2", "portable", "none"), True)
    equal("wall_s is not negative", attributes["wall_s"] >= 0, True)
    return json.loads(attributes["spec"])


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


def check_weights(file, spec):
    """Of importance sampling from uniform distributions: the densities at the stored draws."""
    def over_nominal(component):
        ratio = 1.0
        for name, tilt in component["inputs"].items():
            group, key = name.split(".", 1)
            low, high = spec[group][key]["uniform"]
            z = norm.ppf((file["parameters"][name][:] - low) / (high - low))
            ratio = ratio * norm.pdf(z, tilt["shift"], tilt["scale"]) / norm.pdf(z)
        return ratio

    proposal = spec["sampling"]["proposal"]
    total = sum(component["share"] for component in proposal["components"])
    mixture = proposal["nominal"] + sum((1 - proposal["nominal"]) * component["share"] / total * over_nominal(component)
                                        for component in proposal["components"])
    found = file["trials/weight"][:]
    equal("weights", bool(np.allclose(found, 1 / mixture, rtol=1e-7)), True)  # a draw near its bound has lost digits


def check_trials(file, spec):
    trials = file["trials"]
    rows = len(trials["index"])
    method = spec["sampling"]["method"]
    own = {"importance": {"weight": ("<f8", "1")}, "subset_simulation": {"level": ("<u4", "1")}}.get(method, {})
    check_columns(trials, TRIALS | own, rows)
    if method == "importance":
        check_weights(file, spec)
    names, cells = varying_inputs(spec)
    check_columns(file["parameters"], {name: ("<f8", PARAMETER_UNITS[name]) for name in names}, rows)
    index = trials["index"][:]
    equal("index rises", bool(np.all(np.diff(index.astype(np.int64)) > 0)), True)
    equal("cells", bool(np.array_equal(trials["cell"][:], index % cells)), True)
    converged = trials["status"][:] == OUTCOMES["converged"]
    expected = np.where(converged, trials["end_time"][:], np.nan)
    equal("settling times", np.array_equal(trials["settling_time"][:], expected, equal_nan=True), True)
    if file.attrs["complete"]:
        listed = spec["sampling"].get("trials", 1)
        if method == "subset_simulation":
            states = listed
            equal("levels", bool(np.array_equal(trials["level"][:], levels_of(index, states))), True)
            listed = states + int(trials["level"][:].max()) * (states - states // 10)
        draws = len(listed) if isinstance(listed, list) else listed
        # A study that stops on precision is complete with fewer trials: whole looks.
        if "stop" in spec and rows < draws * cells:
            beyond = rows / cells - spec["stop"]["min_trials"]
            equal("trials after the last look", beyond % spec["stop"]["check_every"] if beyond >= 0 else None, 0)
            draws = rows // cells
        equal("index of a complete file", index.tolist(), list(range(draws * cells * trials_a_draw(spec, names))))


def check_audit(file):
    audit, index = file["audit"], file["trials/index"][:]
    rows = len(audit["index"])
    check_columns(audit, AUDIT, rows)
    equal("attributes of /audit", {name: type(value) for name, value in audit.attrs.items()}, {"tolerance": np.float64})
    equal("audited trials rise", bool(np.all(np.diff(audit["index"][:].astype(np.int64)) > 0)), True)
    equal("audited trials are in the file", bool(np.all(np.isin(audit["index"][:], index))), True)
    converged = audit["status"][:] == OUTCOMES["converged"]
    equal("audited settling times", bool(np.array_equal(np.isfinite(audit["settling_time"][:]), converged)), True)


def audit_summary(file):
    audit, trials = file["audit"], file["trials"]
    rows = np.searchsorted(trials["index"][:], audit["index"][:])
    same = np.all([audit[name][:] == trials[name][:][rows] for name in ("status", "cycles", "swings")], axis=0)
    times = np.abs(audit["settling_time"][:] - trials["settling_time"][:][rows])[same & (audit["status"][:] == 0)]
    if len(rows) == 0:
        return None
    return {
        "trials": len(rows),
        "agree": int(np.sum(same)),
        "disagree": audit["index"][:][~same].tolist(),
        "settling_time_difference": {
            "median": np.median(times), "p99": np.quantile(times, 0.99), "max": np.max(times)
        } if len(times) else None,
        "tolerance": audit.attrs["tolerance"],
    }


def check_audit_summary(file, found):
    expected = audit_summary(file)
    difference = "settling_time_difference"
    if expected and expected[difference]:
        for name, value in expected[difference].items():
            # The quantiles' last bits are those of their interpolation.
            if np.isclose(found[difference][name], value, rtol=1e-9, atol=0):
                expected[difference][name] = found[difference][name]
    equal("audit in the summary", found, expected)


def check_trajectories(file, spec):
    for name, trajectory in file["trajectories"].items():
        t = trajectory["t"][:]
        check_columns(trajectory, TRAJECTORY, len(t))
        equal(f"time of {trajectory.name} never falls", bool(np.all(np.diff(t) >= 0)), True)
        row = np.searchsorted(file["trials/index"][:], int(name))
        for column in ("q1", "q2", "q1_dot", "q2_dot"):
            equal(f"end of {trajectory.name}/{column}", trajectory[column][-1], file["trials"][column][row])
        equal(f"end of {trajectory.name}/t", t[-1], file["trials/end_time"][row])
    retained = {int(name) for name in file["trajectories"]}
    wanted = spec["retain"]["trajectories"]
    failed = [int(i) for i in file["trials/index"][:][file["trials/status"][:] != 0]]
    expected = set(file["trials/index"][: wanted["first"]].tolist()) | set(failed[: wanted["failed"]])
    equal("retained trajectories", retained, expected)


def check_seal(path):
    content = open(path, "rb").read()
    seal = b"steerstat-sha256:" + hashlib.sha256(content[:-82]).hexdigest().encode() + b"\n"
    equal("seal", content[-82:], seal)


def levels_of(index, states):
    """All states of level 0 are drawn; a tenth of each further one's are states of the level before."""
    return np.where(index < states, 0, 1 + (index.astype(np.int64) - states) // (states - states // 10))


def check_by_levels(found, file, spec):
    """Of a subset simulation: the levels again, from the trials, with the Metropolis chains as they must have gone."""
    status = file["trials/status"][:]
    equal("outcomes", found["outcomes"], {name: int(np.sum(status == v)) for name, v in OUTCOMES.items()})
    time = np.where(status == 0, file["trials/end_time"][:], np.inf)
    states = spec["sampling"]["trials"]
    chains, row, threshold, product = np.arange(states), states, -np.inf, 1.0
    for number, level in enumerate(found["rare_failures"]["levels"]):
        reaches = time[chains] >= (np.inf if level["threshold"] is None else level["threshold"])
        equal(f"probability of level {number}", level["probability"], np.mean(reaches))
        equal(f"failures of level {number}", level["failures"], int(np.sum(np.isinf(time[chains]))))
        product *= level["probability"]
        if level["threshold"] is None:
            break
        equal(f"threshold of level {number} rises", level["threshold"] > threshold, True)
        threshold = level["threshold"]
        now = chains[np.argsort(-time[chains], kind="stable")][: states // 10]
        steps = [now]
        for _ in range(9):
            candidates = np.arange(row, row + len(now))
            row += len(now)
            now = np.where(time[candidates] >= threshold, candidates, now)
            steps.append(now)
        chains = np.transpose(steps).ravel()
    equal("trials of all levels", row, len(time))
    rate = found["rare_failures"]["failure_rate"]
    equal("rate", bool(np.isclose(rate["estimate"], product, rtol=1e-12)), True)
    equal("limits", rate["ci_low"] <= rate["estimate"] <= rate["ci_high"], True)
    equal("success", found["success_rate"]["estimate"], 1 - rate["estimate"])
    nominal = found["rare_failures"]["nominal"]
    equal("plain draws", (nominal["trials"], nominal["failures"]), (states, int(np.sum(np.isinf(time[:states])))))


def check_weighted(found, file):
    """Of the sum of failed trials' weights: no other statistic is of the study's distributions."""
    status, weight = file["trials/status"][:], file["trials/weight"][:]
    equal("outcomes", found["outcomes"], {name: int(np.sum(status == v)) for name, v in OUTCOMES.items()})
    failed = weight[status != 0]
    rare = found["rare_failures"]
    equal("failures", rare["failures"], len(failed))
    for name, value in {"effective_failures": failed.sum() ** 2 / (failed ** 2).sum(), "mean_weight": weight.mean(),
                        "largest_share": failed.max() / failed.sum(),
                        "effective_draws": weight.sum() ** 2 / (weight ** 2).sum()}.items():
        equal(f"{name} {rare[name]} against {value}", bool(np.isclose(rare[name], value, rtol=1e-12)), True)
    rate = rare["failure_rate"]
    equal("rate", bool(np.isclose(rate["estimate"], failed.sum() / len(status), rtol=1e-12)), True)
    equal("limits", rate["ci_low"] < rate["estimate"] < rate["ci_high"], True)
    equal("success", found["success_rate"]["estimate"], 1 - rate["estimate"])
    equal("metrics", all(found[name]["count"] == 0 for name in METRICS), True)


def check_statistics(what, found, trials, completed=None):
    status = trials["status"]
    equal(f"{what}: outcomes", found["outcomes"], {name: int(np.sum(status == v)) for name, v in OUTCOMES.items()})
    equal(f"{what}: completed", found["trials"]["completed"], len(status) if completed is None else completed)
    converged = status == 0
    rate = found["success_rate"]
    equal(f"{what}: estimate", rate["estimate"], float(np.mean(converged)) if len(status) else None)
    if len(status):
        equal(f"{what}: limits", rate["ci_low"] <= rate["estimate"] <= rate["ci_high"], True)
    samples = {key: trials[key][converged] for key in ("settling_time", "cycles")}
    samples.update({key: trials[key][np.isfinite(trials[key])] for key in METRICS})
    for key, sample in samples.items():
        equal(f"{what}: count of {key}", found[key]["count"], len(sample))
        expected = dict.fromkeys(("mean", "std", "min", "p05", "p50", "p95", "p99", "max"))
        if len(sample):
            expected.update(mean=np.mean(sample), min=np.min(sample), max=np.max(sample))
            expected.update({f"p{p:02}": np.quantile(sample, p / 100) for p in (5, 50, 95, 99)})
        if len(sample) > 1:
            expected["std"] = np.std(sample, ddof=1)
        # A sample of nearly equal values has a spread below NumPy's own rounding of their mean.
        rounding = 1e-14 * np.max(np.abs(sample), initial=0.0)
        for name, value in expected.items():
            same = (found[key][name] is None if value is None else
                    np.isclose(found[key][name], value, rtol=1e-12, atol=rounding if name == "std" else 0))
            equal(f"{what}: {key} {name} {found[key][name]} against {value}", bool(same), True)


def check_summary(file, spec, path):
    summary = json.load(open(path))
    trials = {name: file["trials"][name][:] for name in ("status", "settling_time", "cycles", "cell", *METRICS)}
    equal("name", summary["study"]["name"], spec["name"])
    equal("seed", summary["study"]["seed"], spec["sampling"].get("seed", 1))
    equal("spec_sha256", summary["study"]["spec_sha256"], file.attrs["spec_sha256"])
    equal("complete", summary["complete"], bool(file.attrs["complete"]))
    equal("wall_s", summary["performance"]["wall_s"], file.attrs["wall_s"])
    equal("simd", summary["performance"]["simd"] or "none", file.attrs["simd"])
    check_audit_summary(file, summary["audit"])
    equal("has stop", summary["stop"] is not None, "stop" in spec)
    if summary["complete"] and summary["stop"]:
        equal("trials at the stop", summary["stop"]["trials"], len(trials["status"]))
        reached = [goal["reached"] for goal in summary["stop"]["until"]]
        equal("reason", summary["stop"]["reason"], "precision_reached" if all(reached) else "max_trials")
    check_rare = {"importance": lambda: check_weighted(summary, file),
                  "subset_simulation": lambda: check_by_levels(summary, file, spec)}.get(spec["sampling"]["method"])
    equal("has rare failures", summary["rare_failures"] is not None, check_rare is not None)
    if check_rare:
        check_rare()
        return
    names, cells = varying_inputs(spec)
    # The statistics of a study of Sobol' indices are those of the first two trials of each row.
    independent = file["trials/index"][:] % trials_a_draw(spec, names) < 2
    independent_trials = {name: values[independent] for name, values in trials.items()}
    check_statistics("all", summary, independent_trials, completed=len(independent))
    for number, cell in enumerate(summary["cells"]):
        rows = trials["cell"] == number
        check_statistics(f"cell {number}", cell, {name: values[rows] for name, values in trials.items()})
        for name, value in cell["sweep"].items():
            equal(f"{name} in cell {number}", set(file["parameters"][name][rows].tolist()) <= {value}, True)
    equal("number of cells", len(summary["cells"]), cells if cells > 1 or summary["cells"] else 0)


def check(path, summary):
    with h5py.File(path, "r") as file:
        equal("groups of the file", set(file), {"trials", "parameters", "audit", "trajectories"})
        spec = check_attributes(file)
        check_trials(file, spec)
        check_audit(file)
        check_trajectories(file, spec)
        if summary:
            check_summary(file, spec, summary)
    check_seal(path)
    header = subprocess.run(["h5dump", "-H", path], capture_output=True, text=True, check=False)
    equal(f"h5dump -H {path}", (header.returncode, header.stderr), (0, ""))
    for name in TRIALS:
        equal(f"{name} in h5dump", f'DATASET "{name}"' in header.stdout, True)


def main(arguments):
    files = [i for i, argument in enumerate(arguments) if argument.endswith(".h5")]
    if not files:
        sys.exit("no result file was given")
    for i in files:
        following = arguments[i + 1] if i + 1 < len(arguments) else ""
        check(arguments[i], following if following.endswith(".json") else None)
    print(f"{len(files)} result files are as described")


main(sys.argv[1:])
