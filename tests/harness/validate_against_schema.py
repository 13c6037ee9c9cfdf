# SPDX-License-Identifier: Apache-2.0
"""Validates YAML files with python3-jsonschema: `validate_against_schema.py SCHEMA FILE...`.

Prints one line a file: "FILE: valid", or "FILE: " and the first complaint. Reads YAML as version 1.2 does, so
that the key `on` is no truth value, and shares no code with the program.
"""
import json
import re
import sys

import jsonschema
import yaml


class Yaml12Loader(yaml.SafeLoader):
    yaml_implicit_resolvers = {}


def resolve(tag, pattern, first):
    Yaml12Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first))


resolve("bool", "true|false", "tf")
resolve("null", "~|null|", ["~", "n", ""])
resolve("int", "-?[0-9]+", "-0123456789")
resolve("float", r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?", "-0123456789")


def main(schema_file, *files):
    schema = json.load(open(schema_file))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for file in files:
        value = yaml.load(open(file), Loader=Yaml12Loader)
        error = next(iter(validator.iter_errors(value)), None)
        print(f"{file}: {'valid' if error is None else error.message.splitlines()[0][:200]}")


main(*sys.argv[1:])
