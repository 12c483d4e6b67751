"""Opens result files with h5py alone and holds them against the interface's description.

    check_result_file.py FILE.h5 [SUMMARY.json] ...

The names, types and units of result_layout.py are written out by hand, not taken from the engine: this is the
outside's view. A summary after a file is recomputed from that file's trials. Exits 1 naming the first thing wrong.
"""

import hashlib
import json
import re
import subprocess
import sys

import h5py
import numpy as np
from scipy.stats import norm

from recomputed_summary import check_summary
from result_layout import (AUDIT, OUTCOMES, PARAMETER_UNITS, TRAJECTORY, TRIALS, equal, levels_of, trials_a_draw,
                           varying_inputs)


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
