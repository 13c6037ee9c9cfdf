// SPDX-License-Identifier: Apache-2.0
// prehend grammar diff, prehend grammar format. Tested by tests/program/causes_test.cc and
// tests/grammar/language/format_test.cc
#include "grammar/language/parser.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/suite/check/settings.h"

namespace prehend::cli {
namespace {

ExitCode RunDiff(const ParsedOptions& options, const CommandContext& context) {
  suite::Settings sides[2];
  for (int side = 0; side < 2; ++side) {
    const std::string file =
        episode::GrammarFile(context.root, options.Text(side == 0 ? "OLD" : "NEW"));
    const Result<std::string> text = ReadTextFile(file);
    if (!text) return Complain(context, text.error());
    sides[side][".grammar"] = suite::GrammarSettings(*text);
  }
  const std::vector<suite::SettingChange> changes = suite::ChangesBetween(sides[0], sides[1]);
  for (const suite::SettingChange& change : changes) context.out << ChangeText(change) << "\n";
  if (changes.empty()) context.out << "the same rules, clauses and parameters\n";
  return changes.empty() ? ExitCode::kAgrees : ExitCode::kDiffers;
}

ExitCode RunFormat(const ParsedOptions& options, const CommandContext& context) {
  const std::string file = episode::GrammarFile(context.root, options.Text("GRAMMAR"));
  const grammar::CompileResult compiled = episode::LoadGrammar(context.root, file);
  const Result<std::string> text = ReadTextFile(file);
  if (!text) return Complain(context, text.error());
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  context.out << grammar::FormatText({file, *text});
  return ExitCode::kAgrees;
}

}  // namespace

Command DiffCommand() {
  return {.name = "grammar diff",
          .summary = "Say what changed between two grammars: rules, clauses, parameters",
          .examples = {"grammar diff pick_and_place original_2020",
                       "grammar diff old.grammar new.grammar"},
          .options = {Required(Argument("OLD", "a grammar's name or file")),
                      Required(Argument("NEW", "another one"))},
          .run = RunDiff,
          .note =
              "Comments and spaces do not count, nor does the order of rules. Exit code 1: they "
              "differ."};
}

Command FormatCommand() {
  return {
      .name = "grammar format",
      .summary = "Lay out a grammar as those of the library are",
      .examples = {"grammar format pick_and_place", "grammar format my/rules.grammar"},
      .options = {Required(Argument("GRAMMAR", "a grammar's name or file"))},
      .run = RunFormat,
      .note =
          "Comments, line breaks and the columns of '=' and '#' are kept; with errors nothing is "
          "laid out."};
}

}  // namespace prehend::cli
