// SPDX-License-Identifier: Apache-2.0
// prehend report: recorded episodes as one web page. Tested by tests/program/report_command_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/cli/daily/recogniser_choice.h"
#include "harness/suite/check/failures.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/report/report.h"

namespace prehend::cli {
namespace {

constexpr const char* kDefaultPage = "report.html";
constexpr double kLongest_s = 600;  ///< for one episode

ExitCode RunReport(const ParsedOptions& options, const CommandContext& context) {
  const auto chosen = FindEpisodesOrComplain("EPISODES", options, context);
  if (!chosen) return chosen.error();
  const std::string page = options.TextOr("--output", kDefaultPage);
  std::string problem = WhyNotWritable(page);
  if (!problem.empty()) return Refuse(context, "--output: " + problem);

  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(context.root);
  suite::ScenarioSelection selection;
  for (const episode::EpisodeName& episode : *chosen)
    selection.scenarios.push_back(episode::ScenarioOf(episode, all));
  suite::SuiteRequest request{
      .selection = std::move(selection),
      .changes = {GrammarOf(options, context), options.All("--set")},
      .recogniser = RecogniserOf(options, context),
      .listen = ListenTo(RecogniserOf(options, context)),
      .root = context.root,
      .today = context.today,
      .pictures = false,
      .replays = suite::Replays::kAll,
      .limits = {.jobs = options.IntOr("--jobs", CoreCount()), .time_limit_s = kLongest_s}};
  std::vector<suite::ScenarioVerdict> verdicts = suite::RunSuite(request, {});
  // An episode of no scenario of the project is known by its file; on the page by what it is.
  for (std::size_t i = 0; i < chosen->size(); ++i) verdicts[i].scenario = (*chosen)[i].scenario;
  suite::ReportHeader header =
      suite::HeaderOf(CommandText(context.words), context.root, context.today);
  header.title = "Recorded episodes";
  problem = WriteTextFile(page, suite::ReportHtml(verdicts, header));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const suite::Tally tally = suite::Count(verdicts);
  const suite::Failures failures = suite::FailuresOf(verdicts);
  if (options.Has("--json")) {
    nlohmann::ordered_json json = {{"page", page},
                                   {"episodes", verdicts.size()},
                                   {"passed", tally.passed},
                                   {"failed", tally.failed},
                                   {"pending", tally.pending}};
    json["demonstrations"] = suite::FailuresJson(failures);
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{}: {} episode{}, {} passed, {} failed, {} without golden\n", page,
                               verdicts.size(), verdicts.size() == 1 ? "" : "s", tally.passed,
                               tally.failed, tally.pending)
                << suite::FailuresText(failures);
  }
  // What differs or ended badly is on the page; what cannot be read is not.
  const auto unread =
      std::ranges::find(verdicts, ExitCode::kBadInput, &suite::ScenarioVerdict::exit_code);
  if (unread == verdicts.end()) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {}: {}\n{}", unread->scenario, unread->reason,
                             suite::DetailsText(*unread));
  return ExitCode::kBadInput;
}

}  // namespace

Command ReportCommand() {
  return {
      .name = "report",
      .summary = "Write recorded episodes as one web page: events, differences, 3D replay",
      .examples = {"report milk.episodes", "report suite.episodes more.episodes -o page.html",
                   "report suite.episodes --episode 'slide/*' --grammar my/rules.grammar"},
      .options = {EpisodesArgument(), EpisodesOption(),
                  OutputOption(fmt::format("the page; default: {}", kDefaultPage)), JobsOption(),
                  GrammarOption(), SettingsOption(), RecogniserOption(), JsonOption()},
      .run = RunReport};
}

}  // namespace prehend::cli
