#!/usr/bin/env python3
"""Checks that every room includes only what it may (README, "Layout").

Usage: check_includes.py SOURCE_DIRECTORY

Prints each include that breaks a rule as `path:line: problem (rule)` and exits 1 when there is one.
"""

import pathlib
import re
import sys

# Which rooms of engine/ a room may include, itself apart.
ROOMS = {
    "core": set(),
    "robot": {"core"},
    "control": {"core"},
    "integrate": {"core", "robot", "control"},
    "sampling": {"core"},
    "statistics": {"core"},
    "trial": {"core", "robot", "control", "integrate", "sampling"},
    "study": {"core", "robot", "control", "sampling", "statistics", "trial"},
    "store": {"core", "robot", "control", "sampling", "trial", "study"},
    "distributed": {"core", "robot", "control", "sampling", "trial", "study", "store"},
    "report": {"core", "robot", "control", "sampling", "statistics", "trial", "study"},
    "view": {"core", "robot", "control", "sampling", "statistics", "trial", "study", "report"},
    "page": {"core"},
}
# What stands on the engine may include all of it.
PROGRAMS = {"server": set(ROOMS), "studies": set(ROOMS) | {"server"}}

# Third-party headers that belong to few places: (name, pattern of the header, rule in words, pattern of the files that
# may).
LIBRARIES = [
    ("TBB", r"(oneapi/)?tbb(/|\.h)", "only in study/run.*", r"engine/study/run\.\w+"),
    ("HDF5", r"(hdf5|H5)\w*\.h", "only in store/", r"engine/store/.*"),
    ("SUNDIALS", r"(sundials|cvodes?|arkode|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol)/",
     "only in integrate/", r"engine/integrate/.*"),
    ("MPI", r"mpi\.h", "only in distributed/", r"engine/distributed/.*"),
    ("Boost", r"boost/", "only in statistics/", r"engine/statistics/.*"),
    ("Eigen", r"(Eigen|unsupported/Eigen)/", "only in sampling/", r"engine/sampling/.*"),
    ("nlohmann-json", r"nlohmann/", "only in *_json.*, server/ and studies/",
     r"engine/.*_json\.\w+|server/.*|studies/.*"),
    ("cpp-httplib", r"httplib", "only in server/", r"server/.*"),
    ("CLI11", r"CLI/", "only in studies/", r"studies/.*"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SOURCES = {".hpp", ".cpp", ".h", ".inc"}


def room_of(path):
    """The room of a file, and the rooms it may include."""
    if path.parts[0] == "engine":
        return path.parts[1], ROOMS.get(path.parts[1])
    return path.parts[0], PROGRAMS[path.parts[0]]


def problems_in(source, root):
    path = source.relative_to(root)
    room, allowed = room_of(path)
    if allowed is None:
        yield f"{path}:1: engine/{room} is no room (add it to tests/layering/check_includes.py and to the README)"
        return
    for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        header = match.group(2)
        where = f"{path}:{number}: includes {header}"
        if ".." in header.split("/"):
            yield f"{where} (no relative paths: they pass by the rooms' include paths)"
        first = header.split("/")[0]
        if "/" in header and first in set(ROOMS) | set(PROGRAMS) and first != room and first not in allowed:
            yield f"{where} ({room} may include {', '.join(sorted(allowed)) or 'no other room'})"
        for name, pattern, rule, places in LIBRARIES:
            if re.match(pattern, header) and not re.fullmatch(places, path.as_posix()):
                yield f"{where} ({name} {rule})"


def problems_under(root):
    found = []
    for folder in ("engine", *PROGRAMS):
        for source in sorted((root / folder).rglob("*")):
            if source.suffix in SOURCES and source.is_file() and "node_modules" not in source.parts:
                found.extend(problems_in(source, root))
    return found


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    root = pathlib.Path(arguments[0]).resolve()
    if not (root / "engine").is_dir():
        sys.exit(f"{root}: has no engine/; name the source directory")
    found = problems_under(root)
    print("\n".join(found) if found else "Every include is one its room may have.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
