#!/usr/bin/env python3
"""Checks JUnit files as a continuous integration server reads them.

Usage: check_junit.py FILE.xml...

Each must be well-formed XML whose counts are those of its elements; all verdicts must occur in them.
"""

import sys
import xml.etree.ElementTree

ELEMENTS = {"failures": "failure", "errors": "error", "skipped": "skipped"}


def problems_in(path, seen):
    root = xml.etree.ElementTree.parse(path).getroot()
    suites = root.findall("testsuite")
    if root.tag != "testsuites" or len(suites) != 1:
        yield f"{path}: {root.tag} with {len(suites)} test suites, not testsuites with one"
        return
    suite = suites[0]
    cases = suite.findall("testcase")
    if not suite.get("name"):
        yield f"{path}: the suite has no name"
    for element in (root, suite):
        if int(element.get("tests")) != len(cases):
            yield f"{path}: {element.tag} says {element.get('tests')} tests, there are {len(cases)}"
        for count, tag in ELEMENTS.items():
            there = len(suite.findall(f"testcase/{tag}"))
            if int(element.get(count)) != there:
                yield f"{path}: {element.tag} says {element.get(count)} {count}, there are {there}"
        if float(element.get("time")) < 0:
            yield f"{path}: {element.tag} took a negative time"
    for case in cases:
        if case.get("classname") != suite.get("name") or not case.get("name") or len(case) > 1:
            yield f"{path}: {case.attrib} with {len(case)} elements"
        for result in case:
            if not result.get("message") or result.tag not in ELEMENTS.values():
                yield f"{path}: {case.get('name')} has {result.tag} without a message"
        seen.add(case[0].tag if len(case) else "passed")


def main():
    seen = set()
    problems = [problem for path in sys.argv[1:] for problem in problems_in(path, seen)]
    missing = {"passed", "failure", "error"} - seen
    if missing:
        problems.append(f"no test case of these files shows {', '.join(sorted(missing))}")
    for problem in problems:
        print(problem)
    print(f"{len(sys.argv) - 1} files, {len(problems)} problems")
    return 1 if problems or len(sys.argv) < 2 else 0


if __name__ == "__main__":
    sys.exit(main())
