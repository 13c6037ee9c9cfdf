// SPDX-License-Identifier: Apache-2.0
// See harness/cli/cli/command_tree.h. Tested by tests/harness/cli/cli/command_tree_test.cc
#include "harness/cli/cli/command_tree.h"

namespace prehend::cli {
namespace {

constexpr const char* kFooter =
    R"(Options:
  -h,--help             Print this, or of a command what it does and takes
  --version             Print the version
  --time-limit-s S      After most commands: seconds that it may take; 0: no limit; default: 600,
                        of many episodes 3600, of sweeps 86400, of each scenario in 'check' 120,
                        of a question in 'episode ask' 10, with --trials or --on-save none
  --memory-limit-mb MB  Memory that it may take; 0: no limit; default: 4000, in 'check' 1000

Exit codes: 0 agrees, 1 differs, 2 bad input or usage, 3 simulation or internal failure,
4 nothing was selected or found, 5 goldens wait for acceptance.
The project is $PREHEND_HOME, or the nearest folder with a prehend.yaml, or the program's checkout.)";

}  // namespace

std::vector<Command> AllCommands() {
  // Ten times what the longest scenario takes on a slow machine; there may be many episodes.
  // Grammars are tried with hundreds of settings on them.
  constexpr double kOne_s = 600, kMany_s = 3600, kSettings_s = 86'400;
  return {NewCommand(),
          Limited(ValidateCommand(), kOne_s),
          CheckCommand(),
          Limited(ReviewCommand(), kOne_s),
          Limited(AcceptCommand(), kMany_s),
          Limited(ListCommand(), kOne_s),
          Limited(RunCommand(), kOne_s),
          Limited(ExplainCommand(), kOne_s),
          Limited(RenderCommand(), kOne_s),
          Limited(FigureCommand(), kMany_s),
          Limited(ReportCommand(), kMany_s),
          Limited(ImportCommand(), kOne_s),
          Limited(ScoreCommand(), kMany_s),
          Limited(EpisodesCommand(), kMany_s),
          Limited(QueryCommand(), kMany_s),
          Limited(ResegmentCommand(), kMany_s),
          Limited(VerifyCommand(), kMany_s),
          Limited(KnowledgeCommand(), kMany_s),
          AskCommand(),
          Limited(TryCommand(), kOne_s),
          Limited(SweepCommand(), kSettings_s),
          Limited(MarginsCommand(), kSettings_s),
          Limited(TracksCommand(), kOne_s),
          WatchCommand(),
          BenchCommand(),
          Limited(PosesCommand(), kOne_s),
          SchemaCommand()};
}

ProgramDescription DescribeProgram(const std::string& version) {
  return {
      .version = version,
      .summary =
          "Simulate manipulation, segment it with activity grammars, compare it with goldens.",
      .footer = kFooter,
      .groups = {{"Write scenarios", {"new", "validate"}},
                 {"Test", {"check", "review", "accept", "list"}},
                 {"Look at an episode", {"run", "explain", "render", "figure", "report"}},
                 {"Use data of your own", {"import", "score"}}},
      .nouns = {{"episode", "Recorded episodes"},
                {"grammar", "Rules and their parameters"},
                {"scenario", "What scenarios are made of"}},
      .old_commands = {{"episodes", "episode list"},
                       {"query", "episode query"},
                       {"resegment", "episode resegment"},
                       {"replay", "episode verify"},
                       {"knowledge", "episode knowledge"},
                       {"ask", "episode ask"},
                       {"try", "grammar try"},
                       {"sweep", "grammar sweep"},
                       {"margins", "grammar margins"},
                       {"tracks", "grammar tracks"},
                       {"watch", "grammar watch"},
                       {"bench", "grammar bench"},
                       {"poses", "scenario poses"},
                       {"schema", "scenario schema"}},
      .old_options = {{"validate --watch", "--on-save"},
                      {"check --time-limit", "--time-limit-s"},
                      {"render --only", "--hand"},
                      {"figure --only", "--hand"},
                      {"score --events", "--event"},
                      {"score --differences", "--verbose"},
                      {"episode resegment --compare", "--against"},
                      {"episode resegment --labels", "--output"},
                      {"episode resegment --events", "--event"},
                      {"episode query --scenario", "--episode"},
                      {"episode query --from-s", "--from"},
                      {"episode query --until-s", "--to"},
                      {"episode knowledge --to", "--also"},
                      {"episode ask --seconds", "--time-limit-s"},
                      {"grammar margins --only", "--over"}},
  };
}

}  // namespace prehend::cli
