# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend lsp: a language server for grammars, on standard input and output.

Errors while typing, completion and hover with the words of the reference, go to definition, rename,
layout. It speaks version 3.17 of the Language Server Protocol, as editors do. docs/editor.md.
"""
import json
import os
import pathlib
import re
import sys
import urllib.parse

from . import _prehend

ITEMS = ("use", "param", "define", "condition", "event", "symmetric", "law")
WORDS = ITEMS + tuple("grammar while from to during until since at most back rest of outside compose where repeat otherwise "
                      "bridging lasting requires confirmed by within with without approaching receding slower than begins ends "
                      "and or not any style drawn known each".split())
EVENT = "event {}(role_: Thing) while height(role_) > 1 m"
ALONE = {"define": "define {}(role_: Thing) = height(role_) > 1 m\n" + EVENT.format("event_"), "event": EVENT, "condition": EVENT,
         "role": "event event_({0}: Thing) while height({0}) > 1 m"}  # what has this name, and no other mistake
UNITS = ("m", "cm", "mm", "s", "ms", "N", "rad", "deg")
TOKEN = re.compile(r'(?P<comment>#[^\n]*)|(?P<text>"[^"\n]*"?)|(?P<number>\.?\d[\d.eE]*)|(?P<name>[A-Za-z_]\w*)|(?P<sign>\S)')


def reference():
    """Name -> (how it is written, what it means): the tables of docs/grammar-language.md."""
    meanings, table = {}, ""
    for line in pathlib.Path(__file__).with_name("grammar-language.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) < 2 or not cells[0].startswith("`"):
            table = cells[0] if len(cells) > 1 and cells[0].strip("-") else table
            continue
        if table == "grammar":  # what a file is called is no word of the language
            continue
        unit = f" [{cells[1]}]" if len(cells) == 3 and not cells[1].startswith("`") else ""
        for written in re.findall(r"`([^`]+)`", cells[0]):
            name = re.search(r"[a-z_]+", written)
            if name:
                meanings.setdefault(name.group(), []).append((written + unit, cells[-1]))
    return meanings


class Grammar:
    """A text, cut into tokens: (kind, word, line, column), and what it defines."""

    def __init__(self, text, file):
        self.text, self.file, self.lines = text, file, text.split("\n")
        self.tokens, self.defined, self.uses, self.items = [], {}, [], []
        for line, words in enumerate(self.lines):
            self.tokens += [(m.lastgroup, m.group(), line, m.start()) for m in TOKEN.finditer(words)]
        code = [i for i, token in enumerate(self.tokens) if token[0] != "comment"]
        for at, i in enumerate(code):
            if self.tokens[i][1] not in ITEMS or self.tokens[i][0] != "name" or at + 1 == len(code):
                continue
            following = self.tokens[code[at + 1]]
            if self.tokens[i][1] == "use":
                name, rest = following[1], [self.tokens[k][1] for k in code[at + 2:at + 4]]
                self.uses.append(f"{name}_from_{rest[1]}" if len(rest) == 2 and rest[0] == "from" else name)
            elif following[0] == "name" and following[1] not in WORDS:
                self.items.append((i, following[1]))
                self.defined.setdefault(following[1], following)

    def at(self, line, column):
        """The token there, or that ends there: rather a name than a sign."""
        there = [one for one in self.tokens if one[2] == line and one[3] <= column <= one[3] + len(one[1])]
        return next((one for one in there if one[0] == "name"), there[-1] if there else None)

    def column(self, line, character):
        """What an editor counts in units of UTF-16, in characters."""
        words = self.lines[line] if line < len(self.lines) else ""
        return len(words.encode("utf-16-le", "surrogatepass")[:2 * character].decode("utf-16-le", "ignore"))

    def range(self, line, begin, end):
        """Of characters, in units of UTF-16."""
        def units(column):
            return len(self.lines[line][:column].encode("utf-16-le", "surrogatepass")) // 2 + max(column - len(self.lines[line]), 0)
        return {"start": {"line": line, "character": units(begin)}, "end": {"line": line, "character": units(end)}}

    def span(self, token):
        return self.range(token[2], token[3], token[3] + len(token[1]))

    def item(self, line):
        """First and last line of the definition that is there, and its tokens."""
        begins = [self.tokens[i][2] for i, _ in self.items] + [len(self.lines)]
        for first, end in zip(begins, begins[1:]):
            if first <= line < end:
                return [token for token in self.tokens if first <= token[2] < end]
        return []

    def roles(self, line):
        tokens = [token for token in self.item(line) if token[0] != "comment"]
        return {a[1]: b for a, b, c in zip(tokens, tokens[1:], tokens[2:] + tokens[:1])
                if a[0] == "name" and b[1] == ":" and c[1][:1].isupper()}

    def described(self, name):
        """The comment above a definition and its text."""
        first = last = self.defined[name][2]
        while first > 0 and self.lines[first - 1].startswith("#"):
            first -= 1
        while last + 1 < len(self.lines) and self.lines[last + 1][:1] in (" ", "\t"):
            last += 1
        comment = " ".join(line.lstrip("# ") for line in self.lines[first:self.defined[name][2]])
        return "```grammar\n" + "\n".join(self.lines[self.defined[name][2]:last + 1]) + "\n```\n" + comment


class Server:
    """Answers requests; `send` takes notifications."""

    def __init__(self, send):
        self.send, self.open, self.read, self.words, self.is_shut = send, {}, {}, reference(), False

    # Texts.

    @staticmethod
    def path(uri):
        path = urllib.parse.unquote(urllib.parse.urlparse(uri).path)
        return path if path.endswith(".grammar") else f"{path}.grammar"

    def used(self, grammar, seen=None):
        """The grammar and all that it uses."""
        seen = {} if seen is None else seen
        seen[grammar.file] = grammar
        for name in grammar.uses:
            folder = pathlib.Path(grammar.file).parent
            name = name.strip('"')
            candidates = [folder / name] if name.endswith(".grammar") else [folder / f"{name}.grammar",
                                                                            LIBRARY / f"{name}.grammar"]
            for file in map(str, candidates):
                if file in seen:
                    break
                if os.path.isfile(file):
                    stamp = os.stat(file).st_mtime_ns
                    if self.read.get(file, (0,))[0] != stamp:
                        self.read[file] = (stamp, Grammar(pathlib.Path(file).read_text("utf-8", "replace"), file))
                    self.used(self.read[file][1], seen)
                    break
        return seen

    def publish(self, uri):
        grammar, shown = self.open[uri], []
        for file, line, column, message, hint, is_warning in _prehend.check_grammar(grammar.file, grammar.text):
            where = max(line - 1, 0) if file == grammar.file else 0
            before = grammar.lines[where].encode()[:max(column - 1, 0)].decode("utf-8", "ignore")
            token = grammar.at(where, len(before)) if file == grammar.file else None
            end = token[3] + len(token[1]) if token else len(before) + 1
            if file != grammar.file:
                message = f"{file}:{line}: {message}"
            shown.append({"range": grammar.range(where, len(before), max(end, len(before) + 1)), "severity": 2 if is_warning else 1,
                          "source": "prehend", "message": message + (f"\nhint: {hint}" if hint else "")})
        self.send("textDocument/publishDiagnostics", {"uri": uri, "diagnostics": shown})

    # Requests: `textDocument/hover` is hover(), and so on.

    def initialize(self, _params):
        return {"capabilities": {"textDocumentSync": 1, "hoverProvider": True, "definitionProvider": True,
                                 "renameProvider": True, "documentFormattingProvider": True,
                                 "completionProvider": {"triggerCharacters": ["(", " "]}},
                "serverInfo": {"name": "prehend", "version": _prehend.__version__}}

    def shutdown(self, _params):
        self.is_shut = True

    def did_open(self, params):
        document = params["textDocument"]
        self.open[document["uri"]] = Grammar(document["text"], self.path(document["uri"]))
        self.publish(document["uri"])

    def did_change(self, params):
        uri = params["textDocument"]["uri"]
        self.open[uri] = Grammar(params["contentChanges"][-1]["text"], self.path(uri))
        self.publish(uri)

    def did_close(self, params):
        uri = params["textDocument"]["uri"]
        self.open.pop(uri, None)
        self.send("textDocument/publishDiagnostics", {"uri": uri, "diagnostics": []})

    def _asked(self, params):
        grammar, place = self.open[params["textDocument"]["uri"]], params["position"]
        column = grammar.column(place["line"], place["character"])
        return grammar, place["line"], column, grammar.at(place["line"], column)

    def completion(self, params):
        grammar, line, column, _ = self._asked(params)
        before = grammar.lines[line][:column] if line < len(grammar.lines) else ""
        if "#" in before:
            return []
        if re.match(r"\s*use\s+\w*$", before):
            return [{"label": file.stem, "kind": 9} for file in sorted(LIBRARY.glob("*.grammar"))]
        found = {}
        if re.search(r"\d\s*\w*$", before):
            found.update((unit, {"label": unit, "kind": 11}) for unit in UNITS)
        for role in grammar.roles(line):
            found[role] = {"label": role, "kind": 6, "detail": "a role"}
        for other in self.used(grammar).values():
            for name in other.defined:
                found.setdefault(name, {"label": name, "kind": 3, "detail": os.path.basename(other.file),
                                        "documentation": {"kind": "markdown", "value": other.described(name)}})
        for name, meanings in self.words.items():
            found.setdefault(name, {"label": name, "kind": 14 if name in WORDS else 3, "detail": meanings[0][0],
                                    "documentation": {"kind": "markdown", "value": meanings[0][1]}})
        for word in WORDS:
            found.setdefault(word, {"label": word, "kind": 14})
        return list(found.values())

    def hover(self, params):
        grammar, line, _, token = self._asked(params)
        if token is None or token[0] != "name" or token[1] in grammar.roles(line):
            return None
        for other in self.used(grammar).values():
            if token[1] in other.defined:
                return {"contents": {"kind": "markdown", "value": other.described(token[1])}, "range": grammar.span(token)}
        meanings = self.words.get(token[1])
        text = "\n\n".join(f"`{written}`: {meaning}" for written, meaning in meanings or [])
        return {"contents": {"kind": "markdown", "value": text}, "range": grammar.span(token)} if text else None

    def definition(self, params):
        grammar, line, _, token = self._asked(params)
        role = next((one for one in grammar.item(line) if token and token[1] in grammar.roles(line) and one[1] == token[1]), None)
        if role:
            return {"uri": params["textDocument"]["uri"], "range": grammar.span(role)}
        for other in self.used(grammar).values():
            if token and token[1] in other.defined:
                return {"uri": pathlib.Path(other.file).as_uri(), "range": other.span(other.defined[token[1]])}
        return None

    def rename(self, params):
        grammar, line, _, token = self._asked(params)
        new = params["newName"]
        if token is None or not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", new) or new in WORDS:
            raise ValueError(f"found '{new}', wanted another name: letters, digits and '_', no word of the language")
        is_role = token[1] in grammar.roles(line)
        if not is_role and token[1] not in grammar.defined:
            raise ValueError(f"'{token[1]}' is not defined in this file")
        taken = grammar.roles(line) if is_role else grammar.defined
        if new in taken:
            raise ValueError(f"'{new}' is there already")
        tokens = grammar.item(line) if is_role else grammar.tokens
        # A role may be called like something that is defined elsewhere.
        renamed = [one for one in tokens if one[:2] == ("name", token[1])
                   and (is_role or token[1] not in grammar.roles(one[2]))]
        lines = list(grammar.lines)
        for _, word, at, column in reversed(renamed):
            lines[at] = lines[at][:column] + new + lines[at][column + len(word):]
        def errors(text):
            return [error[3] for error in _prehend.check_grammar(grammar.file, text) if not error[5]]
        before, after = errors(grammar.text), errors("\n".join(lines))
        if len(after) > len(before):  # a signal, a class, or what a used file defines
            raise ValueError(f"'{new}': {next((error for error in after if error not in before), 'it is there already')}")
        if before:  # what hides what the name breaks: it is tried alone, too
            kind = "role" if is_role else next(grammar.tokens[i][1] for i, name in grammar.items if name == token[1])
            others = [one for one in self.used(grammar).values() if one is not grammar]
            values = {name for i, name in grammar.items if grammar.tokens[i][1] == "param"}
            if any(new in one.defined for one in others) and not is_role or is_role and new in values:
                raise ValueError(f"'{new}' is there already")
            if alone := errors("grammar alone_\n" + ALONE[kind].format(new)) if kind in ALONE else []:
                raise ValueError(f"'{new}': {alone[0]}")
        return {"changes": {params["textDocument"]["uri"]: [{"range": grammar.span(one), "newText": new} for one in renamed]}}

    def formatting(self, params):
        grammar = self.open[params["textDocument"]["uri"]]
        text = _prehend.format_grammar(grammar.text)
        whole = {"start": {"line": 0, "character": 0}, "end": {"line": len(grammar.lines), "character": 0}}
        return [] if text == grammar.text else [{"range": whole, "newText": text}]

    def answer(self, message):
        """The answer to a request; None to a notification."""
        name = message.get("method", "").rpartition("/")[2]
        name = re.sub("([A-Z])", lambda letter: "_" + letter.group().lower(), name)
        known = name in ("initialize", "shutdown", "did_open", "did_change", "did_close", "completion", "hover",
                         "definition", "rename", "formatting")
        if "id" not in message and not known:
            return None
        answer = {"id": message.get("id")}
        if not known:
            return answer | {"error": {"code": -32601, "message": f"unknown method '{message.get('method')}'"}}
        try:
            return answer | {"result": getattr(self, name)(message.get("params") or {})}
        except ValueError as error:
            return answer | {"error": {"code": -32803, "message": str(error)}}
        except (KeyError, TypeError, IndexError) as error:
            return answer | {"error": {"code": -32602, "message": f"a request that cannot be read: {error!r}"}}


def _library():
    """The folder of the library's grammars: beside the module, of Debian, or of the checkout."""
    here = pathlib.Path(_prehend.__file__).resolve()
    home = os.environ.get("PREHEND_HOME")
    folders = [pathlib.Path(home)] if home else []
    folders += [here.parent / "share/prehend", *(up / "share/prehend" for up in here.parents), *here.parents]
    return next((folder / "grammar/library" for folder in folders if (folder / "grammar/library").is_dir()), here.parent)


LIBRARY = _library()


def main(arguments):
    if arguments:
        print("usage: python3 -m prehend lsp  (an editor starts it: docs/editor.md)", file=sys.stderr)
        return 0 if arguments[0] in ("-h", "--help") else 2
    source, sink = sys.stdin.buffer, sys.stdout.buffer

    def write(message):
        body = json.dumps({"jsonrpc": "2.0"} | message).encode()
        sink.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        sink.flush()

    server = Server(lambda method, params: write({"method": method, "params": params}))
    while True:
        length = 0
        for line in iter(source.readline, b"\r\n"):
            if not line:
                return 1
            if line.lower().startswith(b"content-length:"):
                length = int(line[15:])
        try:
            message = json.loads(source.read(length))
        except ValueError as error:
            write({"id": None, "error": {"code": -32700, "message": str(error)}})
            continue
        if not isinstance(message, dict):
            write({"id": None, "error": {"code": -32600, "message": "wanted one object"}})
            continue
        if message.get("method") == "exit":
            return 0 if server.is_shut else 1
        answer = server.answer(message)
        if "id" in message:
            write(answer)
