#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whatever a query of `prehend episode ask` is, Prolog runs nothing but what docs/knowledge.md lists.

    python3 tests/knowledge/listed_goals.py PREHEND QUERIES SEED

makes QUERIES queries of listed goals, of goals of every name that Prolog knows, of what names a goal or a file in some other way, in
any nesting. One Prolog runs them all, every second one without the check before it; its tracer sees every predicate that is called
(tests/knowledge/listed_goals.pl). The exit code is 1 if one of them is not of those below.
"""
import pathlib
import random
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PROLOG = HERE.parent.parent / "harness/exchange/knowledge/prehend.pl"

# Of these modules any predicate: they read and write terms, numbers and lists, and call nothing but what they are given.
PURE = {"prehend", "lists", "apply", "nb_set", "solution_sequences", "aggregate", "json", "error", "pairs", "$bags", "$apply", "$dicts"}
LISTED = set("""
rdf_db:rdf/3 rdf_db:ns/2 rdf_prefixes:rdf_current_prefix/2 rdf_prefixes:rdf_current_prefix/3 $syspreds:goal_name_arity/3
$syspreds:predicate_property/2 $syspreds:property_predicate/2 run/3
(<)/2 (=)/2 (=..)/2 (=:=)/2 (=<)/2 (==)/2 (=@=)/2 (=\\=)/2 (>)/2 (>=)/2 (\\=)/2 (\\==)/2 (is)/2 acyclic_term/1 arg/3 atom/1
atom_chars/2 atom_concat/3 atom_number/2 atom_string/2 atomic/1 atomic_list_concat/2 atomic_list_concat/3 b_getval/2 b_setval/2 between/3
callable/1 char_type/2 clause/2 compare/3 compound/1 compound_name_arity/3 copy_term/2 current_predicate/1 cyclic_term/1 default_module/2
dict_pairs/3 duplicate_term/2 fail/0 float/1 flush_output/0 format/3 functor/3 ground/1 import_module/2 integer/1 is_dict/1 is_dict/2 is_list/1
length/2 line_position/2 memberchk/2 msort/2 nb_current/2 nb_linkarg/3 nb_setarg/3 nb_setval/2 nonvar/1 number/1 once/1 put_char/2
put_dict/3 put_dict/4 setup_call_catcher_cleanup/4 setup_call_cleanup/3 sig_atomic/1 sort/2 stream_pair/3 string/1 sub_atom/5 succ/2
term_variables/2 throw/1 true/0 upcase_atom/2 var/1 variant_hash/2 with_output_to/2 write/2 writeln/1
""".split())

LISTED_GOALS = """true fail =/2 \\=/2 ==/2 \\==/2 </2 >/2 =</2 >=/2 =:=/2 =\\=/2 is/2 between/3 member/2 memberchk/2 length/2 msort/2
nth1/3 sum_list/2 max_list/2 min_list/2 entity/2 occurs/2 holds/1 allen/3 episode_of/2 label_of/2 show/1 show/2""".split()
# What has hurt other sandboxes.
WORDS = """shell/1 halt/0 halt/1 call/1 call/2 call/3 apply/2 consult/1 load_files/2 ensure_loaded/1 use_module/1 open/3 see/1 tell/1
assertz/1 asserta/1 retract/1 abolish/1 format/2 format/3 print_message/2 print/1 portray_clause/1 read_term/2 term_to_atom/2
setof/3 bagof/3 aggregate/3 maplist/2 maplist/3 foldl/4 include/3 forall/2 ignore/1 not/1 catch/3 findall/4 freeze/2 when/2 dif/2
call_cleanup/2 setup_call_cleanup/3 thread_create/2 process_create/3 setenv/2 set_prolog_flag/2 op/3 nb_setval/2 b_setval/2 initialization/1
^/2 */2 *->/2 :/2 @/2 -->/2 :-/1 ?-/1 {}/1 prolog_load_context/2 current_op/3 apropos/1 make/0 edit/1 ls/0 cd/1 pwd/0 rdf_load/2
arithmetic_function/1 expand_term/2 goal_expansion/2 tabling/0 abolish_all_tables/0 reset/3 shift/1 string_code/3 prompt/2 safe_query/1
ask/1 asked/1 ask_main/0 load_knowledge/1 number_of/2 answers/4 put_line/1 described/2 said/3""".split()
FUNCTIONS1 = "- + abs sqrt sin exp log float integer truncate round \\ msb random random_float eval cputime shell".split()
FUNCTIONS2 = "+ - * / // mod ** ^ << >> max min atan2 gcd rdiv powm cmpflags shell".split()
DATA = ["a", "'..'", "[]", "{}", "milk", "'Grasping'", "0", "1", "-3", "2.5", "1r3", "inf", "nan", '"text"', '"shell(ls)"', "'~@'",
        '"~@~p~q~i~*c"', "shell(ls)", "halt", "user:halt", "[halt]", "['/etc/passwd']", "library(process)", "_{a:1}", "`ab`", "0'a",
        "'http://prehend.local/log.owl#x'", "knowrob:'Grasping'", "$", "!", "100000000000000000000", "'\\0\\'", "composed(a,[b])", "a:b:c"]


class Maker:
    def __init__(self, seed, others):
        self.random = random.Random(seed)
        self.others = others

    def one_of(self, *choices):
        return self.random.choice(choices)

    def variable(self):
        return self.one_of("X", "Y", "Z", "G", "L", "_", "_A")

    def term(self, depth):
        kind = self.random.random()
        if depth <= 0 or kind < 0.35:
            return self.variable() if self.random.random() < 0.4 else self.random.choice(DATA)
        if kind < 0.55:
            return "[" + ", ".join(self.term(depth - 1) for _ in range(self.random.randrange(4))) + self.one_of("", "", "|T") + "]"
        if kind < 0.65:
            return self.goal(depth - 1)
        if kind < 0.75:
            return self.sum(depth - 1)
        if kind < 0.9:
            return self.description(depth - 1)
        return f"f({self.term(depth - 1)})"

    def sum(self, depth):
        if depth <= 0 or self.random.random() < 0.3:
            return self.one_of("1", "2", "7", "2.5", "1r3", "inf", "nan", "pi", "e", "X", "Y", "a", '"a"', "[1]", "100000000000", "foo")
        if self.random.random() < 0.4:
            return f"{self.random.choice(FUNCTIONS1)}({self.sum(depth - 1)})"
        return f"'{self.random.choice(FUNCTIONS2)}'({self.sum(depth - 1)}, {self.sum(depth - 1)})".replace("'\\'", "\\")

    def description(self, depth):
        pairs = [self.one_of("..", "[..]", f"[type, {self.one_of('T', chr(39) + 'Grasping' + chr(39), self.term(0))}]", f"[name, {self.term(0)}]",
                             f"[object, {self.term(depth)}]", f"[sub-action, {self.term(depth)}]", f"[style, {self.term(0)}]",
                             f"[{self.term(0)}, {self.term(0)}]") for _ in range(self.random.randrange(3))]
        return "[" + ", ".join([self.one_of("an", "a", "X"), self.one_of("action", "event", "object", "thing", "X")] + pairs) + "]"

    def named(self, word, depth):
        name, _, arity = word.rpartition("/") if "/" in word[1:] else (word, "", "0")
        if name == "entity":
            return f"entity({self.variable()}, {self.one_of(self.description(depth), self.term(depth))})"
        if name == "is":
            return f"{self.one_of('X', 'Y')} is {self.sum(depth)}"
        name = name if re.fullmatch(r"[a-z]\w*", name) else "'" + name.replace("\\", "\\\\").replace("'", "\\'") + "'"
        terms = [self.one_of(self.term, self.term, self.goal)(depth - 1) for _ in range(int(arity))]
        return name + (f"({', '.join(terms)})" if terms else "")

    def goal(self, depth):
        kind = self.random.random()
        if depth <= 0 or kind < 0.45:
            return self.named(self.random.choice(LISTED_GOALS), depth)
        inner = [self.goal(depth - 1) for _ in range(2)]
        if kind < 0.8:
            t, n = self.term(1), self.one_of("1", "2", "infinite", "X", self.sum(1))
            spec = self.one_of("count", "sum(X)", "max(X)", "max(X*2, Y)", "min(shell)", "bag(X)", "set(X)", "r(count, max(X))", t)
            return self.one_of(f"({inner[0]}, {inner[1]})", f"({inner[0]} ; {inner[1]})", f"({inner[0]} -> {inner[1]})",
                               f"({inner[0]} -> {inner[1]} ; true)", f"\\+ ({inner[0]})", f"once({inner[0]})", f"forall({inner[0]}, {inner[1]})",
                               f"findall({t}, {inner[0]}, L)", f"aggregate_all({spec}, {inner[0]}, L)", f"distinct({t}, {inner[0]})",
                               f"limit({n}, {inner[0]})", f"(member(X, [1, 2, a]), {inner[0]})")
        if kind < 0.9:
            return self.named(self.random.choice(WORDS), depth)
        if kind < 0.95:
            return self.named(self.random.choice(self.others), depth)
        return self.one_of("G", "[..]", "..", "['x']", "[user]", "'a.pl'", '"shell(ls)"', f"user:{inner[0]}", f"(G = {inner[0]}, G)",
                           f"X^{inner[0]}", "{" + inner[0] + "}", f"_{{a: 1}}.put({inner[0]})", "{|html||x|}", f"call({inner[0]})", "!", "1",
                           f"@({inner[0]}, user)", f"(X = [an, object | X], {inner[0]})", f"({inner[0]}, !)", f"({inner[0]} *-> true ; true)")

    def query(self):
        text = self.goal(self.random.randrange(1, 5))
        damage = self.random.random()
        if damage < 0.03:
            at = self.random.randrange(len(text))
            text = text[:at] + self.random.choice("()[]{}'\"|,.!~@^") + text[at + 1:]
        return self.one_of("", "", "?- ") + text + self.one_of("", ".", ". % done", ". shell(ls).") if damage < 0.2 else text


def main():
    prehend, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    with tempfile.TemporaryDirectory() as folder:
        run = lambda *words, **more: subprocess.run(words, capture_output=True, text=True, check=True, **more)
        run(prehend, "run", "pick_and_place/milk_carton_wrap", "--record", f"{folder}/e.episodes")
        run(prehend, "episode", "knowledge", f"{folder}/e.episodes", "-o", f"{folder}/kb")
        names = run("swipl", "-q", "-g", "forall((predicate_property(M:H, visible), functor(H, N, A), A < 5), (print(N/A), nl))", "-t", "halt")
        others = sorted({line for line in names.stdout.splitlines() if re.fullmatch(r"[a-z]\w*/\d", line)})
        maker = Maker(seed, others)
        queries = "".join(maker.query() + "\n" for _ in range(count))
        said = subprocess.run(["swipl", "-q", "-f", "none", "--stack-limit=32m", "-g", "main", "-t", "halt", HERE / "listed_goals.pl", "--", PROLOG, f"{folder}/kb"],
                              input=queries, capture_output=True, text=True, cwd=folder)
        left = {path.name for path in pathlib.Path(folder).iterdir()}
    called = {name.replace("'", "").removeprefix("system:") for name in re.findall(r"^called\((.*)\)$", said.stdout, re.MULTILINE)}
    counts = re.search(r"^counts\((\d+),(\d+),(\d+)\)$", said.stdout, re.MULTILINE)
    if not counts or int(counts[1]) != count:
        sys.exit(f"Prolog did not come to the end: {said.stdout[-300:]} {said.stderr[-1000:]}")
    print(f"{counts[1]} queries, {counts[2]} run, {counts[3]} to their end, {len(called)} predicates called")
    odd = sorted(name for name in called - LISTED if name.split(":")[0] not in PURE)
    if odd or left != {"e.episodes", "kb"}:
        sys.exit("called, and not listed: " + " ".join(odd) + f"; left: {left}")


if __name__ == "__main__":
    main()
