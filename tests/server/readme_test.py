#!/usr/bin/env python3
"""Runs what the README's section on the service tells a newcomer to type, as it stands there.

Usage: readme_test.py STEERSTAT README.md
"""

import contextlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from served import served


@contextlib.contextmanager
def relayed(port):
    """The port of a relay to the service at `port` that notes its answers: clients here are not of our making."""
    relay = pathlib.Path(__file__).resolve().parent / "relay.mjs"
    with subprocess.Popen(["node", relay, str(port)], stdout=subprocess.PIPE, text=True) as process:
        try:
            yield int(process.stdout.readline())
        finally:
            process.terminate()


def blocks(readme, language):
    """The code blocks of a language in the section on the service."""
    text = pathlib.Path(readme).read_text(encoding="utf-8")
    section = re.search(r"^## The service\n(.*?)(?=^## )", text, re.S | re.M)
    if not section:
        sys.exit(f"{readme} has no section `The service`")
    return re.findall(rf"^```{language}\n(.*?)^```$", section[1], re.S | re.M)


def run(directory, *command):
    ended = subprocess.run(command, cwd=directory, capture_output=True, text=True, timeout=300)
    if ended.returncode != 0:
        sys.exit(f"{command[0]} ends with {ended.returncode}:\n{ended.stdout}{ended.stderr}")
    return ended.stdout


def main(program, readme):
    os.environ.pop("http_proxy", None)
    (python,) = blocks(readme, "python")
    commands = [line for block in blocks(readme, "sh") for line in block.replace("\\\n", " ").splitlines()
                if line.startswith("curl ")]
    posts = [line for line in commands if "/summary" not in line]
    summaries = [line for line in commands if "/summary" in line]
    if len(posts) != 1 or len(summaries) != 1:
        sys.exit(f"expected a curl that posts and one that reads the summary, not {commands}")
    with (tempfile.TemporaryDirectory() as scratch, served(program, pathlib.Path(scratch) / "data") as service,
          relayed(service.port) as port):
        assert "127.0.0.1:8080" in posts[0] and "127.0.0.1:8080" in python
        here = f"127.0.0.1:{port}"
        state = json.loads(run(scratch, "bash", "-c", posts[0].replace("127.0.0.1:8080", here)))
        service.wait_for_end(f"/v1/studies/{state['id']}")
        command = re.sub(r"/v1/studies/\w+/", f"/v1/studies/{state['id']}/", summaries[0])
        summary = json.loads(run(scratch, "bash", "-c", command.replace("127.0.0.1:8080", here)))
        assert summary["complete"] and summary["study"]["id"] == state["id"], summary
        if len([line for line in python.splitlines() if line.strip()]) > 10:
            sys.exit("the Python has more than ten lines")
        printed = run(scratch, sys.executable, "-B", "-c", python.replace("127.0.0.1:8080", here))
        assert printed.strip(), "the Python prints nothing"
    print("the README's commands work")


if __name__ == "__main__":
    main(*sys.argv[1:])
