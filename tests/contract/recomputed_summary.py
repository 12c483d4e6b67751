"""Computes a study's summary again from the trials in its result file, and holds the summary against that."""

import json

import numpy as np

from result_layout import METRICS, OUTCOMES, equal, trials_a_draw, varying_inputs


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
