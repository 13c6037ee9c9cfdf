// SPDX-License-Identifier: Apache-2.0
// prehend report: recorded episodes as one web page. Tested by tests/program/report_command_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/atomic_file.h"
#include "harness/base/shell_quote.h"
#include "harness/base/text_file.h"
#include "harness/check/run_suite.h"
#include "harness/command/command.h"
#include "harness/episodes/resegment_many.h"
#include "harness/episodes/schema.h"
#include "harness/report/report.h"

namespace prehend::harness {
namespace {

constexpr const char* kDefaultPage = "report.html";
constexpr double kLongest_s = 600;  ///< for one episode

/// Each episode as the scenario that it was; only those of the project have goldens.
std::vector<ScenarioFile> ScenariosOf(const std::vector<episodes::EpisodeName>& chosen,
                                      const std::string& root) {
  const std::vector<ScenarioFile> all = ListScenarios(root);
  std::vector<ScenarioFile> scenarios;
  for (const episodes::EpisodeName& episode : chosen) {
    const std::size_t slash = episode.scenario.rfind('/');
    const bool has_skill = slash != std::string::npos;
    const bool known = std::ranges::find(all, episode.scenario, IdOf) != all.end();
    scenarios.push_back({.skill = has_skill ? episode.scenario.substr(0, slash) : "",
                         .name = has_skill ? episode.scenario.substr(slash + 1) : episode.scenario,
                         .path = episode.file,
                         .in_project = known,
                         .episode = episode.id});
  }
  return scenarios;
}

ExitCode RunReport(const ParsedOptions& options, const CommandContext& context) {
  for (const std::string& file : options.All("files")) {
    if (!episodes::IsEpisodeFile(file))
      return Complain(
          context, ExitCode::kBadInput,
          fmt::format("found '{}', wanted an episode file, NAME.episodes ('{}' records "
                      "one)",
                      file, CommandText({"run", "SCENARIO", "--record", "NAME.episodes"})));
  }
  const auto chosen = episodes::SelectEpisodes(options.All("files"), options.Text("--episode"));
  if (!chosen) return Complain(context, chosen.error());
  if (chosen->empty())
    return Complain(context, ExitCode::kNothing,
                    options.Has("--episode") ? fmt::format("--episode: no episode matches '{}'",
                                                           options.Text("--episode"))
                                             : "there are no episodes in it");
  const std::string page = options.TextOr("--output", kDefaultPage);
  std::string problem = WhyNotWritable(page);
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, "--output: " + problem);

  SuiteRequest request{
      .selection = {ScenariosOf(*chosen, context.root), {}},
      .changes = RequestOf(options, {}),
      .root = context.root,
      .today = context.today,
      .pictures = false,
      .replays = Replays::kAll,
      .limits = {.jobs = options.IntOr("--jobs", CoreCount()), .time_limit_s = kLongest_s}};
  std::vector<ScenarioVerdict> verdicts = RunSuite(request, {});
  // An episode of no scenario of the project is known by its file; on the page by what it is.
  for (std::size_t i = 0; i < chosen->size(); ++i) verdicts[i].scenario = (*chosen)[i].scenario;
  ReportHeader header = HeaderOf(CommandText(context.words), context.root, context.today);
  header.title = "Recorded episodes";
  problem = WriteTextFile(page, ReportHtml(verdicts, header));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const Tally tally = Count(verdicts);
  context.out << fmt::format("{}: {} episode{}, {} passed, {} failed, {} without golden\n", page,
                             verdicts.size(), verdicts.size() == 1 ? "" : "s", tally.passed,
                             tally.failed, tally.pending);
  // What differs or ended badly is on the page; what cannot be read is not.
  const auto unread = std::ranges::find(verdicts, ExitCode::kBadInput, &ScenarioVerdict::exit_code);
  if (unread == verdicts.end()) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {}: {}\n{}", unread->scenario, unread->reason,
                             unread->details);
  return ExitCode::kBadInput;
}

}  // namespace

Command ReportCommand() {
  return {.name = "report",
          .summary = "Write recorded episodes as one web page: events, differences, 3D replay",
          .examples = {"report milk.episodes", "report suite.episodes more.episodes -o page.html",
                       "report suite.episodes --episode 'slide/*' --grammar my/rules.grammar"},
          .options = {{.name = "files",
                       .help = "files from 'run --record' or 'check --record' (docs/episodes.md)",
                       .required = true,
                       .repeatable = true},
                      {.name = "--episode",
                       .help = "only this one: its number, or its scenario (a name, skill/name or "
                               "a glob)",
                       .placeholder = "WHICH"},
                      {.name = "--output",
                       .help = fmt::format("the page; default: {}", kDefaultPage),
                       .placeholder = "FILE",
                       .other_name = "-o",
                       .is_output = true},
                      {.name = "--jobs",
                       .help = "episodes at a time; default: one per core",
                       .placeholder = "N",
                       .other_name = "-j",
                       .rule = IntegersFrom(1, kMaxJobs)},
                      GrammarOption(),
                      SettingsOption()},
          .run = RunReport};
}

}  // namespace prehend::harness
