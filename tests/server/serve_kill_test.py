#!/usr/bin/env python3
"""Kills `steerstat serve` at random moments while studies come in over HTTP and run, starts it again each time, and
holds what is then there against what clients were told.

Usage: serve_kill_test.py STEERSTAT

STEERSTAT_KILLS says how often (20), STEERSTAT_SEED with which moments.
"""

import hashlib
import http.client
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

import h5py

from served import NotReady, Served

MARK = b"steerstat-sha256:"
SEALED = ("study.h5", "results.h5", "trials-", "earlier-", "partial.h5")


def spec_of(trials, seed):
    return {"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
            "initial_state": {"q2": {"uniform": [-3.1, 3.1]}}, "horizon": 60, "audit": {"trials": 2},
            "sampling": {"trials": trials, "seed": seed}}


def specs_of(number):
    """The studies of a round: one that others follow, one that extends it, and small ones that come in between."""
    seed = 1000 * number
    return [spec_of(40_000, seed), spec_of(60_000, seed), *(spec_of(300 + i, seed + 1 + i) for i in range(3))]


class Round:
    """Studies in a directory of their own, sent and killed until all of them have succeeded."""

    def __init__(self, program, scratch, number):
        self.program = program
        self.data = scratch / f"data-{number}"
        self.specs = specs_of(number)
        self.acknowledged = {}  # id: spec
        self.completed = {}     # id: the most trials that a client was told of
        self.kept = {}          # path of a shard: the bytes it had when it was seen first
        self.most_kept = 0

    def use(self, service):
        """What clients do until every study has succeeded: send all, those of earlier sessions too, and look."""
        for spec in self.specs:
            status, headers, body = service.ask("POST", "/v1/studies", spec)
            check(status in (200, 201), f"a study was answered {status}: {body!r}")
            study = json.loads(body)["id"]
            check(status == 200 or study not in self.acknowledged, f"{study} was there, and is taken for a new one")
            self.acknowledged[study] = spec
        while True:
            states = [json.loads(service.ask("GET", f"/v1/studies/{study}")[2]) for study in self.acknowledged]
            for state in states:
                check(state["status"] in ("queued", "running", "succeeded"), f"{state['id']} is {state}")
                if state["status"] == "succeeded":
                    self.completed[state["id"]] = state["progress"]["completed"]
            if all(state["status"] == "succeeded" for state in states):
                return
            time.sleep(0.01)

    def session(self, moment):
        """One life of the service. @param moment  [s] after its start at which it is killed, None: not at all
        @return whether it was killed"""
        timer = None

        def arm(process):
            nonlocal timer
            if moment is not None:
                timer = threading.Timer(moment, process.kill)
                timer.start()

        try:
            service = Served(self.program, self.data, on_start=arm)
        except NotReady as end:
            check(end.code == -signal.SIGKILL, f"it did not start: {end}")
            return True
        try:
            for study in self.acknowledged:
                check(service.ask("GET", f"/v1/studies/{study}")[0] == 200, f"{study} is lost")
            self.use(service)
        except (OSError, http.client.HTTPException):
            pass  # it was killed meanwhile, or the code below fails
        if timer:
            timer.cancel()
        code, told = service.stop()
        check("renamed" not in told and "made it again" not in told, f"it found damage: {told}")
        check(code in (0, -signal.SIGKILL), f"it ended with {code}: {told}")
        return code != 0

    def look(self):
        """Holds the files against what was told of, and what was there before."""
        studies = self.data / "studies"
        for study in self.acknowledged:
            check((studies / study / "study.h5").exists(), f"{study} is lost")
        for path, content in self.kept.items():
            if (path.parent / "results.h5").exists():
                continue
            check(path.exists(), f"{path} is lost")
            check(path.read_bytes() == content, f"{path} has changed")
        for path in (self.data.rglob("*") if self.data.exists() else ()):
            check(not path.name.startswith("damaged-"), f"{path} was set aside")
            if path.name.startswith(SEALED):
                check_readable(path)
            if path.name.startswith("trials-"):
                self.kept.setdefault(path, path.read_bytes())
        self.most_kept = max(self.most_kept, len(self.kept))

    def expect_undisturbed(self):
        """Holds every result, to the bit, against that of a run that nobody disturbed."""
        check(len(self.acknowledged) == len(self.specs), "studies were not acknowledged")
        for study, spec in self.acknowledged.items():
            alone = self.data / "alone"
            (self.data / "alone.json").write_text(json.dumps(spec))
            subprocess.run([self.program, "run", self.data / "alone.json", "-o", alone, "--no-progress"], check=True,
                           capture_output=True)
            result = self.data / "studies" / study / "results.h5"
            completed = self.completed.get(study)
            check(completed == spec["sampling"]["trials"], f"{study} has {completed} trials")
            check(datasets_of(result) == datasets_of(alone), f"trials of {study} were lost or changed")


def check(holds, what):
    if not holds:
        sys.exit(what)


def check_readable(path):
    content = path.read_bytes()
    body, mark, seal = content.rpartition(MARK)
    check(mark and seal.strip().decode() == hashlib.sha256(body).hexdigest(), f"{path} is damaged")
    with h5py.File(path) as file:
        file.visititems(lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None)


def datasets_of(path):
    """The bytes of every dataset of the trials, their inputs and the audit."""
    found = {}
    with h5py.File(path) as file:
        for group in ("trials", "parameters", "audit"):
            for name, dataset in file[group].items():
                found[f"{group}/{name}"] = dataset[()].tobytes()
    check(len(found) > 20, f"{path} has only {sorted(found)}")
    return found


def main(program):
    os.environ.pop("http_proxy", None)
    wanted = int(os.environ.get("STEERSTAT_KILLS", "20"))
    seed = int(os.environ.get("STEERSTAT_SEED", "7"))
    print(f"seed {seed}, {wanted} kills", flush=True)
    generator = random.Random(seed)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        undisturbed = Round(program, scratch, 0)
        begin = time.monotonic()
        check(not undisturbed.session(None), "it died without having been killed")
        whole = time.monotonic() - begin  # so that moments fit the machine
        undisturbed.look()
        undisturbed.expect_undisturbed()
        kills = studies = most_kept = number = 0
        while kills < wanted:
            number += 1
            current = Round(program, scratch, number)
            while current.session(generator.uniform(0, whole) if kills < wanted else None):
                kills += 1
                current.look()
            current.look()
            current.expect_undisturbed()
            studies += len(current.acknowledged)
            most_kept = max(most_kept, current.most_kept)
    check(most_kept > 0, "no kill came while trials were finished: the studies are too short")
    print(f"{kills} kills in {number} rounds; of {studies} studies none is lost, and no trial lost or changed")


if __name__ == "__main__":
    main(*sys.argv[1:])
