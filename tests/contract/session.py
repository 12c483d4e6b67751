#!/usr/bin/env python3
"""A scripted session with `steerstat serve`, every answer of which is written down for validate.mjs.

Usage: session.py STEERSTAT OUTPUT.json

The output is {"openapi", "schemas": {name: schema}, "exchanges": [{"method", "path", "status", "type", "headers",
"body"}]}, bodies of JSON as values, others as text.
"""

import json
import os
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "server"))
from served import served  # noqa: E402

SWEPT = {"name": "swept", "plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.2]}},
         "controller": {"contraction": {"eta1": {"sweep": [0.4, 0.5]}}}, "horizon": 60, "audit": {"trials": 4},
         "gates": [{"metric": "success_rate", "expr": "ci_low >= 0.99"}], "sampling": {"trials": 60}}
LONG = {"plant": {"m1": {"uniform": [0.8, 1.2]}}, "audit": {"trials": 0}, "sampling": {"trials": 3_000_000}}


def main(program, output):
    os.environ.pop("http_proxy", None)
    exchanges = []
    with tempfile.TemporaryDirectory() as data, served(program, data) as service:
        def ask(method, path, body=None, headers=()):
            status, fields, content = service.ask(method, path, body, headers)
            kind = (fields["Content-Type"] or "").partition(";")[0]
            is_json = kind in ("application/json", "application/problem+json")
            value = json.loads(content) if is_json else content[:100].decode("latin-1")
            exchanges.append({"method": method, "path": path.partition("?")[0], "status": status, "type": kind,
                              "headers": {name.lower(): text for name, text in fields.items()}, "body": value})
            return status, fields, value

        ask("GET", "/healthz")
        ask("POST", "/healthz", {})
        ask("GET", "/v1/studies")
        for body, headers in ((SWEPT, {}), (SWEPT, {}), ({**SWEPT, "horizon": -1, "hrizon": 2}, {}), (b"{", {}),
                              (b"{}", {"Content-Type": "text/plain"}), ([], {})):
            ask("POST", "/v1/studies", body, headers)
        study = f"/v1/studies/{exchanges[3]['body']['id']}"
        service.wait_for_end(study)
        long = f"/v1/studies/{ask('POST', '/v1/studies', LONG)[2]['id']}"
        for path in ("/v1/studies", "/v1/studies?limit=1", "/v1/studies?limit=x", "/v1/studies?cursor=x"):
            ask("GET", path)
        for path in ("", "/summary", "/spec", "/trials", "/trials?status=converged&limit=3", "/trials?cell=1",
                     "/trials?cell=x", "/trials/0", "/trials/119", "/trials/120", "/trials/0/trajectory",
                     "/trials/120/trajectory", "/view", "/view/map?x=plant.m1&y=plant.f2",
                     "/view/map?x=plant.m1&y=plant.m2", "/view/map?x=plant.m1", "/trials/3/view", "/trials/120/view",
                     "/results.h5", "/events"):
            tag = ask("GET", study + path)[1]["ETag"]
            if tag:
                ask("GET", study + path, headers={"If-None-Match": tag})
        ask("GET", study + "/results.h5", headers={"Range": "bytes=0-7"})
        ask("GET", study + "/results.h5", headers={"Range": "bytes=999999999-"})
        ask("GET", study, headers={"Host": "evil.example"})
        for path in ("", "/summary", "/spec", "/trials", "/trials/2999999", "/results.h5", "/view"):
            ask("GET", long + path)
        for path in ("", "/summary", "/spec", "/trials", "/trials/0", "/trials/0/trajectory", "/results.h5", "/events",
                     "/view", "/view/map?x=plant.m1&y=plant.f2", "/trials/0/view"):
            ask("GET", "/v1/studies/none" + path)
        ids = {"a": study.rpartition("/")[2], "b": study.rpartition("/")[2]}
        for body in (ids, {**ids, "b": long.rpartition("/")[2]}, {**ids, "b": "none"}, b"[", {}):
            ask("POST", "/v1/comparisons", body)
            ask("POST", "/v1/comparisons/view", body)
        ask("POST", "/v1/comparisons", b"{}", {"Content-Type": "text/plain"})
        ask("POST", "/v1/comparisons/view", b"{}", {"Content-Type": "text/plain"})
        ask("DELETE", long)
        service.wait_for_end(long)
        for path in ("", "/summary", "/trials"):
            ask("GET", long + path)
        ask("DELETE", long)
        ask("DELETE", long)
        trial, nothing = {"name": "trial", "config": {}}, {"name": "none"}
        for action in ("ModelInfo", "InputSizes", "OutputSizes", "Evaluate", "Gradient", "ApplyJacobian",
                       "ApplyHessian"):
            for question in ({**trial, "input": [[0, 0, 0, 0]]}, {**trial, "input": [[0]]}, nothing, b"["):
                ask("POST", f"/{action}", question, {"Content-Type": "text/plain"})
        for path in ("/Info", "/page.css", "/page.js", "/metrics", "/", "/v1/schemas/summary", "/v1/schemas/none"):
            ask("GET", path)
        openapi = ask("GET", "/openapi.json")[2]
        names = [path.name for path in (pathlib.Path(__file__).resolve().parents[2] / "schemas").glob("*.schema.json")]
        schemas = {name: ask("GET", f"/v1/schemas/{name}")[2] for name in sorted(names)}
    text = json.dumps({"openapi": openapi, "schemas": schemas, "exchanges": exchanges})
    pathlib.Path(output).write_text(text, encoding="utf-8")
    print(f"{len(exchanges)} answers")


if __name__ == "__main__":
    main(*sys.argv[1:])
