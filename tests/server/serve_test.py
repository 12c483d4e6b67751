#!/usr/bin/env python3
"""Holds `steerstat serve` to what its help says.

Usage: serve_test.py STEERSTAT
"""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from served import note_answer, served

PROGRAM = sys.argv.pop(1)
SPEC = {"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 20, "audit": {"trials": 0}, "sampling": {"trials": 100}}
LONG = {**SPEC, "horizon": 300, "initial_state": {"q2": {"uniform": [-3, 3]}}, "sampling": {"trials": 4_000_000}}


def refusal(*options):
    """(exit code, message) of a serve that does not start."""
    ended = subprocess.run([PROGRAM, "serve", *options], capture_output=True, text=True, timeout=120)
    return ended.returncode, ended.stderr


class Serve(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.scratch = pathlib.Path(directory.name)
        self.data = self.scratch / "data"

    def token_file(self, text="0123456789abcdef0123456789abcdef", mode=0o600):
        path = self.scratch / "token"
        path.write_text(text + "\n")
        path.chmod(mode)
        return str(path)

    def test_a_second_instance_names_what_is_taken(self):
        with served(PROGRAM, self.data) as service:
            code, message = refusal("--port", str(service.port), "--data", str(self.scratch / "other"))
            self.assertEqual(code, 4)
            self.assertIn("in use", message)
            self.assertFalse((self.scratch / "other").exists())
            code, message = refusal("--port", "0", "--data", str(self.data))
            self.assertEqual(code, 4)
            self.assertIn(str(self.data), message)

    def test_a_data_directory_that_cannot_be_is_named(self):
        (self.scratch / "file").write_text("")
        code, message = refusal("--port", "0", "--data", str(self.scratch / "file"))
        self.assertEqual(code, 4)
        self.assertIn(str(self.scratch / "file"), message)

    def test_beyond_loopback_it_asks_for_a_token(self):
        code, message = refusal("--host", "0.0.0.0", "--port", "0", "--data", str(self.data))
        self.assertEqual(code, 2)
        self.assertIn("--token-file", message)
        self.assertFalse(self.data.exists())
        with served(PROGRAM, self.data, "--host", "0.0.0.0", "--token-file", self.token_file()) as service:
            self.assertEqual(service.ask("GET", "/v1/studies")[0], 401)
            shown = {"Authorization": "Bearer 0123456789abcdef0123456789abcdef"}
            self.assertEqual(service.ask("GET", "/v1/studies", headers=shown)[0], 200)
            self.assertEqual(service.ask("GET", "/healthz")[0], 200)

    def test_bad_options_are_bad_usage(self):
        for options in (["--port", "65536"], ["--port", "x"], ["--threads", "0"], ["--host", "no.such.host.invalid"],
                        ["--token-file", "/nonexistent"], ["--token-file", self.token_file(mode=0o644)],
                        ["--token-file", self.token_file("short")]):
            self.assertEqual(refusal("--data", str(self.data), *options)[0], 2, options)

    def test_signals_end_it_with_everything_kept(self):
        for how in (signal.SIGTERM, signal.SIGINT):
            with served(PROGRAM, self.data) as service:
                status, headers, _ = service.ask("POST", "/v1/studies", LONG)
                self.assertIn(status, (200, 201))
                study = headers["Location"]
                deadline = time.monotonic() + 120
                while True:
                    before = json.loads(service.ask("GET", study)[2])["progress"]["completed"]
                    if before > 0 or time.monotonic() > deadline:
                        break
                    time.sleep(0.02)
                code, told = service.stop(how)
                self.assertEqual(code, 0, told)
            with served(PROGRAM, self.data) as service:
                state = json.loads(service.ask("GET", study)[2])
                self.assertIn(state["status"], ("queued", "running"))
                self.assertEqual(service.ask("DELETE", study)[0], 200)
                state = service.wait_for_end(study)
                self.assertGreaterEqual(state["progress"]["completed"], before)
                self.assertEqual(service.ask("DELETE", study)[0], 204)

    def test_a_stream_of_events_ends_with_it(self):
        with served(PROGRAM, self.data) as service:
            study = service.ask("POST", "/v1/studies", LONG)[1]["Location"]
            with socket.create_connection(("127.0.0.1", service.port), timeout=60) as stream:
                stream.sendall(f"GET {study}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
                received = b""
                while b"event: progress" not in received:
                    received += stream.recv(4096)
                begin = time.monotonic()
                self.assertEqual(service.stop()[0], 0)
                self.assertLess(time.monotonic() - begin, 60)
                while piece := stream.recv(4096):
                    received += piece
            head, _, events = received.partition(b"\r\n\r\n")
            first, *fields = head.decode().split("\r\n")
            fields = [field.split(": ", 1) for field in fields]
            note_answer("GET", f"{study}/events", int(first.split()[1]), fields, events)

    def test_while_slow_clients_drip_and_trials_run_it_answers(self):
        with served(PROGRAM, self.data) as service:
            service.ask("POST", "/v1/studies", LONG)
            slow = []
            for _ in range(50):
                slow.append(socket.create_connection(("127.0.0.1", service.port)))
                slow[-1].sendall(b"POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Le")
            begin = time.monotonic()
            self.assertEqual(service.ask("GET", "/healthz")[0], 200)
            self.assertLess(time.monotonic() - begin, 1)
            for client in slow:
                client.close()


if __name__ == "__main__":
    os.environ.pop("http_proxy", None)
    unittest.main()
