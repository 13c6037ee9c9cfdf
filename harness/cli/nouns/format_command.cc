// SPDX-License-Identifier: Apache-2.0
// prehend grammar format. Tested by tests/grammar/language/format_test.cc
#include "grammar/language/parser.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/load_grammar.h"

namespace prehend::cli {
namespace {

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
