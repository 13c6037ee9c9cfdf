# SPDX-License-Identifier: Apache-2.0
"""Rules as dictionaries: a key for each phrase of a rule, with what stands behind it. What README.md says of the language."""
import re
from fractions import Fraction

UNITS = {"m": Fraction(1), "cm": Fraction(1, 100), "mm": Fraction(1, 1000), "s": Fraction(1), "ms": Fraction(1, 1000)}


class Parser:
    def __init__(self, text):
        self.words = re.findall(r"[A-Za-z_]\w*|[\d.]+|[<>]=?|[-+(),:@|]", re.sub("#.*", "", text)) + [""]
        del self.words[:2]
        self.rules = [self.rule() for _ in iter(lambda: self.words[0], "")]

    def word(self):
        return self.words.pop(0)

    def take(self, phrase):
        found = self.words[:len(phrase.split())] == phrase.split()
        return found and bool(self.words.__delitem__(slice(len(phrase.split()))) or True)

    def list(self, item, separator=","):
        items = [item()]
        while self.words[:2] != [",", "gap"] and self.take(separator):
            items.append(item())
        return items

    def rule(self):
        rule = {"is": self.word(), "name": self.word(), "(": self.take("("), "roles": self.list(self.role), ")": self.take(")")}
        if self.words[0] == "compose":
            rule["first"] = self.words[1:2] == ["first"] and self.words[2] != ":" and bool(self.words.pop(1))
        calls, expr, time = lambda: self.list(self.primary), self.expr, lambda: Fraction(self.word()) * UNITS[self.word()]
        is_time = lambda: self.words[1][0] in "0123456789."
        clauses = {"while": expr, "until": expr, "from each": expr, "from": expr, "to": lambda: time() if rule.get("lasting") else expr(),
                   "without": expr, "within": lambda: time() if "confirmed by" not in rule else self.primary(),
                   "during": expr, "or drop": bool, "since": expr, "at most": time, "back": bool, "rest of": calls,
                   "outside": calls, "compose": lambda: self.list(self.part), "all of": lambda: self.list(self.part),
                   "where": lambda: self.list(self.relation), "repeat": lambda: self.list(self.primary, "or"),
                   "at least": lambda: int(self.word()), ", gap at most": time, "bridging": time, "lasting": time,
                   "requires": expr, "confirmed by": self.primary}
        while phrase := next((phrase for phrase in clauses if self.take(phrase)), None):
            key = {("to", True): "most", ("within", True): "meanwhile"}.get(
                (phrase, "lasting" in rule if phrase == "to" else "confirmed by" in rule), phrase)
            rule[key] = clauses[phrase]()
        return rule

    def role(self):
        return self.word(), self.take(":") and self.word()

    def part(self):
        return (self.word() if self.words[1] == ":" else None), (self.take(":"), self.list(self.primary, "or"))[1]

    def relation(self):
        if self.take("without"):
            return self.primary(), self.take("between") and self.word(), self.take("and") and self.word()
        one = lambda: (self.word(), Fraction(self.word()) * UNITS[self.word()] if self.take("within") else None)
        return None, self.word(), self.list(one, "|"), self.word()

    def expr(self, level=0):
        if level == 2:
            inner = self.expr(3)
            return (self.word(), inner) if self.words[0] in ("begins", "ends") else inner
        if level == 3 and self.words[0] in ("not", "known"):
            return self.word(), self.expr(3)
        if level == 3:
            left = self.sum()
            return (self.word(), left, self.sum()) if self.words[0][:1] in ("<", ">") and self.words[0] else left
        args = [self.expr(level + 1)]
        while self.words[:2] != ["or", "drop"] and self.take(("or", "and")[level]):
            args.append(self.expr(level + 1))
        return (("or", "and")[level], *args) if len(args) > 1 else args[0]

    def sum(self):
        left = self.primary()
        while self.words[0] in ("+", "-"):
            left = (self.word(), left, self.primary())
        return left

    def primary(self):
        if self.take("at least"):
            return "at least", int(self.word()), (self.take("of"), self.primary())[1]
        word = self.word()
        if word == "(":
            return (self.expr(), self.take(")"))[0]
        if word[0] in "0123456789.":
            return "number", Fraction(word) * UNITS[self.word()]
        arg = lambda: (self.word(), self.word() if self.words[0][:1].isupper() else "Entity")
        call = (self.take("("), ("call", word, *self.list(arg)), self.take(")"))[1]
        return ("@" + self.word(), call) if self.take("@") else call
