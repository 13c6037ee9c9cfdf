// SPDX-License-Identifier: Apache-2.0
// prehend report: recorded episodes as one web page. Tested by tests/program/report_command_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/cli/daily/recogniser_choice.h"
#include "harness/cli/daily/report_labels.h"
#include "harness/suite/check/failures.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/report/report.h"

namespace prehend::cli {
namespace {

constexpr const char* kDefaultPage = "report.html";
constexpr double kLongest_s = 600;  ///< for one episode

std::vector<suite::ScenarioVerdict> VerdictsOf(const std::vector<episode::EpisodeName>& episodes,
                                               const std::string& grammar, bool hears_who_is_named,
                                               const ParsedOptions& options,
                                               const CommandContext& context) {
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(context.root);
  suite::ScenarioSelection selection;
  std::ranges::transform(episodes, std::back_inserter(selection.scenarios),
                         [&](const auto& episode) { return episode::ScenarioOf(episode, all); });
  suite::SuiteRequest request{
      .selection = std::move(selection),
      .changes = {grammar, options.All("--set")},
      .root = context.root,
      .today = context.today,
      .pictures = false,
      .replays = suite::Replays::kAll,
      .limits = {.jobs = options.IntOr("--jobs", CoreCount()), .time_limit_s = kLongest_s}};
  if (hears_who_is_named) HearWho(options, request);
  std::vector<suite::ScenarioVerdict> verdicts = suite::RunSuite(request, {});
  // An episode of no scenario of the project is known by its file; on the page by what it is.
  for (std::size_t i = 0; i < verdicts.size(); ++i) verdicts[i].scenario = episodes[i].scenario;
  return verdicts;
}

/// What cannot be read is not on the page.
ExitCode ComplainOfUnread(const std::vector<suite::ScenarioVerdict>& verdicts,
                          const CommandContext& context) {
  const auto unread =
      std::ranges::find(verdicts, ExitCode::kBadInput, &suite::ScenarioVerdict::exit_code);
  if (unread == verdicts.end()) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {}: {}\n{}", unread->scenario, unread->reason,
                             suite::DetailsText(*unread));
  return ExitCode::kBadInput;
}

/// Labels, grammars and others beside each other.
ExitCode ReportSides(std::vector<episode::Take> takes, const std::string& page,
                     const ParsedOptions& options, const CommandContext& context) {
  measure::LabelsRequest request{.root = context.root,
                                 .takes = std::move(takes),
                                 .asking = {.label_map = options.Text("--map")},
                                 .settings = options.All("--set"),
                                 .label_files = options.All("--truth")};
  for (const char* option : {"--grammar", "--recogniser"})
    for (const std::string& typed : options.All(option))
      request.asking.sources.push_back(measure::SourceOf(typed, context.root));
  const bool has_labels = options.Has("--truth") || !request.takes.front().labels.empty();
  request.first_is_truth = !has_labels;
  std::string warnings;
  const auto scores = measure::ScoreLabels(request, warnings);
  context.err << warnings;
  if (!scores) return Complain(context, scores.error());
  context.err << scores->failures;
  // A recording is replayed from an episode file.
  episode::EpisodeKeeper keeper(context.root, context.today);
  const auto kept = keeper.KeepAll(episode::EpisodesOf(request.takes));
  if (!kept) return Complain(context, kept.error());
  std::vector<suite::ScenarioVerdict> verdicts =
      VerdictsOf(*kept, request.asking.WhoseEvents(), false, options, context);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    verdicts[i].scenario = request.takes[i].episode.scenario;
    verdicts[i].file = keeper.SourceOf(verdicts[i].file);
  }
  const double collar_s = kDefaultCollar_ms / 1000;
  const std::string first = has_labels ? "labels" : scores->first;
  warnings.clear();
  suite::ReportHeader header = CompareSides(*scores, first, collar_s, page, verdicts, warnings);
  context.err << warnings;
  const suite::ReportHeader made =
      suite::HeaderOf(CommandText(context.words), context.root, context.today);
  std::tie(header.command, header.date, header.commit, header.machine) =
      std::tie(made.command, made.date, made.commit, made.machine);
  const std::string problem = WriteTextFile(page, suite::ReportHtml(verdicts, header));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const suite::Tally tally = suite::Count(verdicts);
  if (options.Has("--json")) {
    nlohmann::ordered_json json = measure::ScoresJson(scores->of_grammars, collar_s);
    json["page"] = page;
    json["takes"] = verdicts.size();
    json["agree"] = tally.passed;
    json["differ"] = tally.failed;
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{}: {} take{}, {} as {}, {} differ\n", page, verdicts.size(),
                               verdicts.size() == 1 ? "" : "s", tally.passed,
                               has_labels ? "labelled" : first + " says", tally.failed);
  }
  return scores->failures.empty() ? ComplainOfUnread(verdicts, context) : ExitCode::kBadInput;
}

ExitCode RunReport(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto takes, FindTakesOrComplain("EPISODES", options, context));
  const std::string page = options.TextOr("--output", kDefaultPage);
  std::string problem = WhyNotWritable(page);
  if (!problem.empty()) return Refuse(context, "--output: " + problem);
  const bool has_sides =
      options.Has("--truth") || options.All("--grammar").size() > 1 ||
      std::ranges::any_of(takes, [](const episode::Take& take) { return !take.labels.empty(); });
  if (has_sides) return ReportSides(std::move(takes), page, options, context);
  if (options.Has("--map")) return Refuse(context, "--map needs --truth: where are the labels?");
  std::vector<suite::ScenarioVerdict> verdicts =
      VerdictsOf(episode::EpisodesOf(takes), options.Text("--grammar"), true, options, context);
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
  // What differs or ended badly is on the page.
  return ComplainOfUnread(verdicts, context);
}

}  // namespace

Command ReportCommand() {
  Option grammar = GrammarOption();
  grammar.help +=
      "; several, also of files:FOLDER and programs as in 'score --recogniser', are compared with "
      "the labels, or with the first";
  grammar.repeatable = true;
  return {.name = "report",
          .summary = "Write recorded episodes as one web page: events, differences, 3D replay",
          .examples = {"report milk.episodes", "report suite.episodes more.episodes -o page.html",
                       "report suite.episodes --episode 'slide/*' --grammar my/rules.grammar",
                       "report take1.jsonl take2.jsonl --truth labels --map labels.yaml",
                       "report takes.yaml --grammar old.grammar --grammar files:predictions"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      OutputOption(fmt::format("the page; default: {}", kDefaultPage)),
                      JobsOption(), grammar, SettingsOption(), RecogniserOption(),
                      Repeatable(
                          Value("--truth", "FILE|FOLDER",
                                "compare with labels by people: one file for each recording, one "
                                "table of all, or a folder (docs/labels.md); may be repeated")),
                      MapOption(), JsonOption()},
          .run = RunReport};
}

}  // namespace prehend::cli
