#!/usr/bin/env python3
"""Writes the API's description and the JSON schemas as C++.

Usage: embed_documents.py OUTPUT.cpp OPENAPI.yaml SCHEMA.json...

The description is kept as YAML, which people read and review, and served as JSON, which programs read; converted here,
the running program needs no YAML parser. References to schema files become references to where the service serves them.
"""

import json
import pathlib
import sys

import yaml


def rebased(value):
    """The value with `$ref: NAME.schema.json` leading to v1/schemas/NAME.schema.json, relative to /openapi.json."""
    if isinstance(value, dict):
        return {key: f"v1/schemas/{item}" if key == "$ref" and item.partition("#")[0].endswith(".schema.json")
                else rebased(item) for key, item in value.items()}
    return [rebased(item) for item in value] if isinstance(value, list) else value


def literal(text):
    """A C++ string literal, in pieces that every compiler takes."""
    data = text.encode()
    pieces = [data[i:i + 2000] for i in range(0, len(data), 2000)]
    return "\n".join('"' + "".join(f"\\{byte:03o}" if byte < 32 or byte > 126 or byte in b'"\\?' else chr(byte)
                                   for byte in piece) + '"' for piece in pieces)


def main(output, openapi, *schemas):
    description = rebased(yaml.safe_load(pathlib.Path(openapi).read_text(encoding="utf-8")))
    lines = ['#include "api/embedded_documents.hpp"', "", "namespace steerstat {", "",
             "const std::vector<EmbeddedDocument>& embedded_schemas() {",
             "  static const std::vector<EmbeddedDocument> schemas{"]
    for schema in sorted(map(pathlib.Path, schemas)):
        text = schema.read_text(encoding="utf-8")
        json.loads(text)
        lines.append(f'{{"{schema.name}", {{{literal(text)}, {len(text.encode())}}}}},')
    text = json.dumps(description, indent=1, ensure_ascii=False) + "\n"
    lines += ["  };", "  return schemas;", "}", "", "std::string_view embedded_openapi() {",
              f"  return {{{literal(text)}, {len(text.encode())}}};", "}", "", "}  // namespace steerstat", ""]
    pathlib.Path(output).write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
