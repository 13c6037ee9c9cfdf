// SPDX-License-Identifier: Apache-2.0
// prehend grammar coverage: what episodes show of a grammar. Tested by
// tests/program/coverage_test.cc
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/measure/coverage/coverage.h"

namespace prehend::cli {
namespace {

std::string CoverageFileProblem(const std::string& file) {
  return file.ends_with(".info") ? "" : "found '" + file + "', wanted a file that ends with .info";
}

ExitCode RunCoverage(const ParsedOptions& options, const CommandContext& context) {
  const std::string output = options.Text("--output");
  if (!output.empty()) {
    if (const std::string why = WhyNotWritable(output); !why.empty())
      return Refuse(context, "--output: " + why);
  }
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  if (!options.Has("--grammar")) {
    if (const auto why = episode::WhyNotOneGrammar(episodes, context.root); !why.empty())
      return Complain(context, why);
  }
  const auto coverage = measure::CoverageOf(
      episodes, {context.root, options.Text("--grammar"), options.IntOr("--jobs", CoreCount())});
  if (!coverage) return Complain(context, coverage.error());
  if (!output.empty()) {
    if (const std::string why = WriteTextFile(output, measure::CoverageLcov(*coverage));
        !why.empty())
      return Complain(context, ExitCode::kFailure, "--output: " + why);
  }
  if (options.Has("--json"))
    context.out << measure::CoverageJson(*coverage).dump() << "\n";
  else
    context.out << measure::CoverageText(*coverage);
  const double least = 100 - options.NumberOr("--within", 100),
               found = coverage->Clauses().percent();
  if (found >= least) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {:.1f} % of the clauses decided both ways, wanted {:g} %\n",
                             found, least);
  return ExitCode::kDiffers;
}

}  // namespace

Command CoverageCommand() {
  return {.name = "grammar coverage",
          .summary = "What episodes show of a grammar: rules, clauses, both sides of thresholds",
          .examples = {"grammar coverage suite.episodes --grammar my/rules.grammar",
                       "grammar coverage take1.jsonl take2.jsonl --within 10 -o coverage.info"},
          .options = {EpisodesArgument(),
                      GrammarOption(),
                      EpisodesOption(),
                      JobsOption(),
                      Value("--within", "PERCENT",
                            "exit code 1 if more than so many percent of the clauses never "
                            "decided both ways",
                            NumbersFrom(0, 100)),
                      {.name = "--output",
                       .help = "also write a file of lcov for editors and CI, NAME.info",
                       .placeholder = "FILE",
                       .other_name = "-o",
                       .rule = {.range = {}, .problem = CoverageFileProblem},
                       .is_output = true},
                      JsonOption()},
          .run = RunCoverage};
}

}  // namespace prehend::cli
