#!/usr/bin/env python3
"""Shows that the nightly studies can tell: they are green as they are, red with the alignment's velocity gain at 1 in
place of 5, inconclusive with 20 trials each.

Usage: nightly_test.py SOURCE_DIRECTORY PROGRAM green|red|starved
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

STUDIES = {
    "friction": "nightly/friction.json",
    "mass": "nightly/mass.json",
    "initial_state": "nightly/initial_state.json",
    "combined": "nightly.json",
    "robust": "nightly/robust.json",
}


def slacken(spec):
    spec.setdefault("controller", {})["alignment"] = {"kd": 1}
    spec["sampling"]["trials"] = 2000  # a tenth: what is so wrong shows soon


def starve(spec):
    spec["sampling"]["trials"] = 20


CHANGES = {"green": lambda spec: None, "red": slacken, "starved": starve}
EXIT_CODES = {"green": 0, "red": 1, "starved": 3}
ELEMENTS = {"failure": "fail", "error": "inconclusive"}


def expect(holds, message):
    if not holds:
        sys.exit(message)


def verdicts_of(directory, name):
    """The verdicts by what was judged, from the JUnit file, held against the summary's."""
    summary = json.loads((directory / f"{name}.json").read_text(encoding="utf-8"))
    suite = xml.etree.ElementTree.parse(directory / f"{name}.xml").getroot().find("testsuite")
    verdicts = {
        case.get("name"): ELEMENTS[case[0].tag] if len(case) else "pass" for case in suite.findall("testcase")
    }
    of_summary = {f"{gate['metric']} {gate['expr']}": gate["verdict"] for gate in summary["gates"]}
    expect(verdicts == of_summary, f"{name}: JUnit says {verdicts}, the summary {of_summary}")
    expect(summary["complete"], f"{name} is incomplete")
    return verdicts


def main():
    source, program, colour = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    with tempfile.TemporaryDirectory() as scratch:
        specs = pathlib.Path(scratch) / "specs"
        shutil.copytree(source / "studies/specs", specs)
        for path in STUDIES.values():
            spec = json.loads((specs / path).read_text(encoding="utf-8"))
            CHANGES[colour](spec)
            (specs / path).write_text(json.dumps(spec), encoding="utf-8")
        results = pathlib.Path(scratch) / "results"
        run = subprocess.run(
            [source / "studies/nightly", program, results, specs], capture_output=True, text=True, check=False
        )
        said = run.stdout + run.stderr
        expect(run.returncode == EXIT_CODES[colour], f"exit code {run.returncode}\n{said}")
        expect("nightly: friction " in run.stdout.splitlines()[-1], f"no closing line\n{said}")
        markdown = (results / "summary.md").read_text(encoding="utf-8")
        for name in STUDIES:
            verdicts = verdicts_of(results, name)
            expect((results / f"{name}.h5").stat().st_size > 0, f"{name} has no result file")
            title = f"## nightly-{name.replace('_', '-')}: "
            expect(title in markdown, f"{name} is not in the job summary\n{markdown}")
            baseline = [gate for gate in verdicts if gate.startswith("success_rate drop < ")]
            expect(len(baseline) == 1, f"{name} is not held against its baseline: {verdicts}")
            rate = [gate for gate in verdicts if gate.startswith("success_rate ci_low")]
            if colour == "green":
                expect(set(verdicts.values()) == {"pass"}, f"{name}: {verdicts}")
            elif colour == "red":
                expect(verdicts[baseline[0]] == "fail" and verdicts[rate[0]] == "fail", f"{name}: {verdicts}")
            else:
                expect("fail" not in verdicts.values(), f"{name}: {verdicts}")
                expect(verdicts[baseline[0]] == verdicts[rate[0]] == "inconclusive", f"{name}: {verdicts}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
