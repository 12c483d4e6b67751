"""A `steerstat serve` for a test, at a free port with a directory of its own."""

import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import time
import urllib.error
import urllib.request


def note_answer(method, target, status, fields, body):
    """Notes an answer in the directory that STEERSTAT_ANSWERS names, for tests/contract to hold it against
    schemas/openapi.yaml. @param fields  [(name, value)]"""
    directory = os.environ.get("STEERSTAT_ANSWERS")
    if not directory:
        return
    head = "".join(f"{name}: {value}\r\n" for name, value in fields)
    line = json.dumps({"answerer": "service", "method": method, "target": target, "status": status, "head": head,
                       "body": body.decode("latin-1")})
    with open(pathlib.Path(directory) / f"python-{os.getpid()}.jsonl", "a", encoding="ascii") as file:
        file.write(line + "\n")


class NotReady(AssertionError):
    """It ended before it was ready, with this exit code."""

    def __init__(self, line, told, code):
        super().__init__(f"it says {line!r}, and {told!r}")
        self.code = code


class Served:
    """The process once it is ready."""

    def __init__(self, program, data, *options, on_start=lambda process: None):
        """on_start gets the process before it is ready."""
        command = [program, "serve", "--port", "0", "--data", str(data), "--threads", "2", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        on_start(self.process)
        line = self.process.stdout.readline()
        match = re.fullmatch(r"steerstat serves (http://\S+:(\d+))/ \(studies in .*\)\n", line)
        if not match:
            told = self.process.communicate(timeout=60)[1]
            raise NotReady(line, told, self.process.returncode)
        self.url, self.port = match[1], int(match[2])

    def ask(self, method, path, body=None, headers=()):
        """(status, headers, body) of an answer, whatever the status; it is noted."""
        status, fields, content = self._ask(method, path, body, headers)
        note_answer(method, path, status, fields.items(), content)
        return status, fields, content

    def _ask(self, method, path, body, headers):
        data = None if body is None else body if isinstance(body, bytes) else json.dumps(body).encode()
        headers = {"Content-Type": "application/json", **dict(headers)} if data is not None else dict(headers)
        request = urllib.request.Request(self.url + path, data=data, method=method, headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, error.read()

    def wait_for_end(self, study):
        """The state of a study that is over."""
        deadline = time.monotonic() + 300
        while time.monotonic() < deadline:
            state = json.loads(self.ask("GET", study)[2])
            if state["status"] not in ("queued", "running"):
                return state
            time.sleep(0.05)
        raise AssertionError(f"{study} does not end: {state}")

    def stop(self, how=signal.SIGTERM):
        """(exit code, what it said on standard error)."""
        self.process.send_signal(how)
        _, told = self.process.communicate(timeout=120)
        return self.process.returncode, told


@contextlib.contextmanager
def served(program, data, *options):
    service = Served(program, data, *options)
    try:
        yield service
    finally:
        if service.process.poll() is None:
            service.process.kill()
            service.process.communicate()
