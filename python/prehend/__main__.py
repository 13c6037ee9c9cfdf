# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend COMMAND ..: what the package adds to the program."""
import importlib
import sys

from .errors import Error, Visible

COMMANDS = {"baseline": "baselines"}  # name: module, whose main(arguments) returns the exit code
COMMANDS |= {name: name for name in ("benchmark", "dataset", "push", "query", "falsify", "mutate", "shrink", "lsp")}


def main(arguments):
    if not arguments or arguments[0] not in COMMANDS:
        print(f"usage: python3 -m prehend {'|'.join(sorted(COMMANDS))} ..", file=sys.stderr)
        return 0 if arguments and arguments[0] in ("-h", "--help") else 2
    try:
        return importlib.import_module("." + COMMANDS[arguments[0]], __package__).main(arguments[1:]) or 0
    except Error as error:
        print(f"prehend: {error}", file=sys.stderr)
    except OSError as error:
        print(f"prehend: {error.filename or 'output'}: {(error.strerror or str(error)).lower()}", file=sys.stderr)
    except ModuleNotFoundError as missing:
        print(f"prehend: {arguments[0]} needs the Python module '{missing.name}': apt install python3-{missing.name}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.stdout, sys.stderr = (Visible(one.buffer, "utf-8", "backslashreplace", line_buffering=one.line_buffering, write_through=one.write_through)
                              for one in (sys.stdout, sys.stderr))
    sys.exit(main(sys.argv[1:]))
