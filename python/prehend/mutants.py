# SPDX-License-Identifier: Apache-2.0
"""Mutants of a grammar, from its syntax tree: each is the grammar with one mistake in it."""
import os
import pathlib
import re
from dataclasses import dataclass, field

from . import _prehend
from .errors import Error

FACTORS = (0.5, 0.8, 1.25, 2)
MAY_BE_DROPPED = {"bridging", "lasting", "requires", "confirmed by", "during", "within", "approaching", "until"}
OTHER_RELATION = {"before": "meets", "meets": "before", "overlaps": "contains", "contains": "overlaps", "starts": "inside",
                  "inside": "starts", "finishes": "inside", "equals": "starts", "finished_by": "contains", "started_by": "contains",
                  "overlapped_by": "after", "met_by": "after", "after": "met_by"}


@dataclass
class Mutant:
    """One mistake."""

    file: str
    line: int
    column: int
    what: str
    text: str = field(repr=False)  # of the whole file
    clauses: list = field(default_factory=list, repr=False)  # numbers of those of the coverage that it touches
    threshold: bool = False  # another number stands there


def texts(grammar):
    """The files of a grammar that there are, its own first: dict by path."""
    files = [file for file in dict.fromkeys(_prehend.Grammar(grammar, {}).files) if os.path.isfile(file)]
    return {file: pathlib.Path(file).read_text("utf-8") for file in files}


class _File:
    def __init__(self, path, text, clauses, params):
        self.path, self.text, self.params, self.mutants = path, text, params, []
        self.lines = [0]
        for line in text.splitlines(keepends=True):
            self.lines.append(self.lines[-1] + len(line))
        self.clauses = [(self.at((one["line"], one["column"])), number, one) for number, one in enumerate(clauses)
                        if os.path.abspath(one["file"]) == os.path.abspath(path)]

    def at(self, place):
        return self.lines[place[0] - 1] + place[1] - 1

    def place(self, at):
        line = max(number for number, begin in enumerate(self.lines) if begin <= at)
        return line + 1, at - self.lines[line] + 1

    def add(self, begin, end, new, what, clauses, threshold=False):
        text = self.text[:begin] + new + self.text[end:]
        self.mutants.append(Mutant(self.path, *self.place(begin), what, text, sorted(set(clauses)), threshold))

    def numbers(self, begin, clauses, name, whole=False):
        """Other numbers in the place of the one that begins here."""
        literal = re.compile(r"-?\s*\d[\d.]*(?:[eE][-+]?\d+)?").match(self.text, begin)
        if not literal or float(literal.group().replace(" ", "")) == 0:
            return
        value = float(literal.group().replace(" ", ""))
        others = [value - 1, value + 1] if whole else [value * factor for factor in FACTORS]
        for other in (one for one in others if not whole or one >= 1):
            self.add(begin, literal.end(), f"{other:.10g}", f"{name}: {literal.group()} -> {other:.10g}", clauses, True)

    def within(self, begin, end, rule=None, word=None):
        """Clauses whose place is in here; of whole intervals those of this word."""
        found = [number for at, number, one in self.clauses if begin <= at < end and one["part"] != word and rule is None]
        return found + [number for _, number, one in self.clauses if one["rule"] == rule and one["part"] == word]

    def expression(self, tree, around, word):
        kind, text, place, begin, end, args = tree
        at, begin, end = self.at(place), self.at(begin), self.at(end)
        own = self.within(begin, end) or around
        spans = [(self.at(arg[3]), self.at(arg[4])) for arg in args]
        if kind == "quantity":
            self.numbers(begin, own, word, whole=word in ("at least",) and "." not in self.text[begin:end]
                         and not re.search("[a-z]", self.text[begin:end]))
        elif kind == "name" and text in self.params:
            self.params[text].update(own)
        elif kind == "chain":
            for gap, (left, right) in enumerate(zip(spans, spans[1:])):
                found = re.compile(rf"\b{text}\b").search(self.text, left[1], right[0])
                other = "or" if text == "and" else "and"
                self.add(found.start(), found.end(), other, f"{text} -> {other}", own)
                if gap == 0:
                    self.add(left[0], right[0], "", f"dropped: {self.short(left)}", own)
                self.add(left[1], right[1], "", f"dropped: {self.short(right)}", own)
        elif kind == "unary" and text != "-":
            self.add(at, spans[0][0], "", f"dropped: {text}", own)
        elif kind == "edge":
            other = "ends" if text == "begins" else "begins"
            self.add(at, at + len(text), other, f"{text} -> {other}", own)
        elif kind == "call" and len(args) > 1 and args[0][0] == args[1][0] == "name" and args[0][1] != args[1][1]:
            first, second = (self.text[slice(*span)] for span in spans[:2])
            new = second + self.text[spans[0][1]:spans[1][0]] + first
            self.add(spans[0][0], spans[1][1], new, f"{text}: roles swapped", own)
        for arg in args:
            self.expression(arg, own, "at least" if kind == "call" and text == "at least" else word)

    def short(self, span):
        text = " ".join(re.sub("#.*", "", self.text[slice(*span)]).split())
        return text if len(text) < 60 else text[:58] + ".."

    def definition(self, name, place, words, relations, ends_at):
        begin = self.at(place)
        of_rule = [number for at, number, one in self.clauses if one["rule"] == name or begin <= at < ends_at]
        spans = {word: (self.at(tree[3]), self.at(tree[4])) for word, tree in reversed(words)}
        forms = [word for word, _ in words]
        for word, tree in words:
            whole, first = self.within(begin, begin + 1, name, word), len(self.mutants)
            self.expression(tree, whole or of_rule, word)
            if word == "during":  # it may keep the interval from beginning
                for one in self.mutants[first:]:
                    one.clauses = sorted({*one.clauses, *self.within(*spans["from"])})
        for word in MAY_BE_DROPPED & set(forms):
            may = (word == "until" and forms[0] == "while", word == "within" and forms[:2] == ["from", "to"],
                   word not in ("until", "within"))
            if any(may):
                self.drop(word, spans, name, of_rule)
        for place_ in relations:
            self.relation(self.at(place_), self.within(begin, begin + 1, name, "where") or of_rule)

    def drop(self, word, spans, name, of_rule):
        start = re.compile(rf"\b{word.replace(' ', r'[ ]+')}\s*\Z").search(self.text[:spans[word][0]])
        if not start:
            return
        last = {"confirmed by": "confirmed within", "lasting": "lasting .. to"}.get(word, word)
        end = spans.get(last, spans[word])[1]
        if word == "approaching":
            end = self.text.rfind("at most", 0, spans["at most .. back"][0])
        if drops := re.compile(r"\s*\bor\s+drop\b").match(self.text, end) if word == "during" else None:
            self.add(end, drops.end(), "", f"{name}: dropped: or drop", of_rule)
            end = drops.end()
        touched = self.within(0, 1, name, word) or self.within(*spans[word]) or of_rule
        touched = touched + self.within(*spans["from"]) if word == "during" else touched
        self.add(start.start(), end, " ", f"{name}: dropped: {self.short((start.start(), end))}", touched)

    def relation(self, begin, clauses):
        names = re.compile(r"\w+\s+(\w+)((?:\s*\|\s*\w+)*)").match(self.text, begin)
        if not names or names.group(1) not in OTHER_RELATION:
            return
        for match in re.finditer(r"\w+", self.text[names.start(1):names.end(2)]):
            if match.group() in OTHER_RELATION:
                at, other = names.start(1) + match.start(), OTHER_RELATION[match.group()]
                self.add(at, at + len(match.group()), other, f"{match.group()} -> {other}", clauses)
        if names.group(2):
            self.add(names.end(1), names.end(2), "", f"dropped: {names.group(2)}", clauses)


def mutants(grammar, clauses):
    """All mutants of a grammar that compile; `clauses` are those of its coverage."""
    params, files, found = {}, [], []
    for path, text in texts(grammar).items():
        named, definitions = _prehend.syntax(path, text)
        params.update({name: set() for name, _ in named})
        files.append((_File(path, text, clauses, params), named, definitions))
    for file, _, definitions in files:
        begins = [file.at(place) for _, place, _, _ in definitions] + [len(file.text)]
        for name, place, words, relations in definitions:
            begin = file.at(place)
            file.definition(name, place, words, relations, min(one for one in begins if one > begin))
    for file, named, _ in files:
        for name, place in named:
            value = re.compile(r"\w+\s*=\s*").match(file.text, file.at(place))
            file.numbers(value.end(), params[name], name)
        for use in re.finditer(r"^use\b[^#\n]*?\bwith\b([^#\n]*)", file.text, re.MULTILINE):  # `use NAME with x = 5 cm`
            for given in re.finditer(r"(\w+)\s*=\s*", use.group(1)):
                file.numbers(use.start(1) + given.end(), params.get(given.group(1), set()), given.group(1))
        for one in file.mutants:
            try:
                _prehend.Grammar(grammar, {}, {one.file: one.text})
            except Error:
                continue
            found.append(one)
    return sorted(found, key=lambda one: (one.file, one.line, one.column))
