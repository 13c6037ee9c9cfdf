// SPDX-License-Identifier: Apache-2.0
// prehend score: grammars against the physical oracle. Tested by tests/program/score_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/base/base/project_paths.h"
#include "harness/cli/command/command.h"
#include "harness/measure/score/score.h"
#include "harness/measure/score/score_labels.h"
#include "harness/measure/score/score_scenarios.h"
#include "harness/suite/check/run_suite.h"

namespace prehend::cli {
namespace {

ExitCode PrintScores(const Result<measure::LabelScores>& scores, const std::string& warnings,
                     const ParsedOptions& options, const CommandContext& context) {
  context.err << warnings;
  if (!scores) return Complain(context, scores.error());
  context.err << scores->failures;
  const ExitCode code = scores->failures.empty() ? ExitCode::kAgrees : CodeOf(scores->failures);
  if (options.Has("--json")) {
    nlohmann::ordered_json json =
        measure::ScoresJson(scores->of_grammars, options.Has("--verbose"));
    json["by_hand"] = measure::ScoresJson(scores->by_hand);
    const exchange::Counted& counted = scores->counted;
    json["counted"] = {{"takes", counted.takes},
                       {"labels", counted.labels},
                       {"of_a_moment", counted.moments},
                       {"merged", counted.merged},
                       {"cut", counted.cut},
                       {"left_out",
                        {{"of_other_takes", counted.OfOtherTakes()},
                         {"ignored", counted.ignored},
                         {"without_text", counted.without_text},
                         {"columns", counted.unread},
                         {"backward", counted.Backward()}}}};
    context.out << json.dump(2) << "\n";
  } else {
    context.out << measure::LabelScoresText(*scores, options.Has("--verbose"));
  }
  return code;
}

double CollarFrom(const ParsedOptions& options) {
  return options.NumberOr("--collar-ms", kDefaultCollar_ms) / 1000;
}

exchange::Backward BackwardFrom(const ParsedOptions& options) {
  return options.Has("--skip-bad-labels") ? exchange::Backward::kSkip : exchange::Backward::kRefuse;
}

/// Grammars, files and programs, in this order.
measure::Asking AskingFrom(const ParsedOptions& options, const CommandContext& context) {
  measure::Asking asking{
      .label_map = options.Text("--map"),
      .pace = options.Text("--pace") == "online"      ? measure::Pace::kOnline
              : options.Text("--pace") == "real_time" ? measure::Pace::kRealTime
                                                      : measure::Pace::kOffline,
      .time_limit_s = options.NumberOr("--recogniser-limit-s", kRecogniserLimit_s)};
  for (const std::string& name : options.All("--grammar"))
    asking.sources.push_back({measure::Source::Kind::kGrammar, name});
  for (const std::string& path : options.All("--found"))
    asking.sources.push_back({measure::Source::Kind::kFiles, path});
  for (const std::string& typed : options.All("--recogniser"))
    asking.sources.push_back(measure::SourceOf(typed, context.root));
  return asking;
}

/// `score LABELS --truth LABELS`: how two people agree.
ExitCode RunLabelFiles(const ParsedOptions& options, const CommandContext& context) {
  std::string warnings;
  const double collar_s = CollarFrom(options);
  const auto scores = measure::ScoreLabelFiles({.root = context.root,
                                                .files = options.All("names"),
                                                .truth = options.All("--truth"),
                                                .grammar = options.Text("--grammar"),
                                                .label_map = options.Text("--map"),
                                                .backward = BackwardFrom(options),
                                                .collar_s = collar_s,
                                                .is_collar_asked = options.Has("--collar-ms")},
                                               warnings);
  return PrintScores(scores, warnings, options, context);
}

/// `score TAKES --truth LABELS`: against what people marked.
ExitCode RunLabels(const ParsedOptions& options, const CommandContext& context) {
  for (const char* other : {"--filter", "--event"}) {
    if (options.Has(other))
      return Refuse(context,
                    fmt::format("--truth compares what the labels mean: {} does not apply", other));
  }
  if (!options.Has("names"))
    return Refuse(context, "--truth: which recordings? score take1.jsonl --truth take1.csv");
  if (std::ranges::all_of(options.All("names"), exchange::IsLabelFile)) {
    if (options.Has("--found") || options.Has("--recogniser"))
      return Refuse(context,
                    "--found and --recogniser: of which recordings? score take1.jsonl --found ..");
    return RunLabelFiles(options, context);
  }
  PREHEND_TRY(auto takes, FindTakesOrComplain("names", options, context));
  const double collar_s = CollarFrom(options);
  std::string warnings;
  const auto scores = measure::ScoreLabels({.root = context.root,
                                            .takes = std::move(takes),
                                            .asking = AskingFrom(options, context),
                                            .settings = options.All("--set"),
                                            .label_files = options.All("--truth"),
                                            .backward = BackwardFrom(options),
                                            .collar_s = collar_s,
                                            .is_collar_asked = options.Has("--collar-ms")},
                                           warnings);
  return PrintScores(scores, warnings, options, context);
}

/// `score`: against what physically happened, in scenarios.
ExitCode RunScenarios(const measure::Asking& asking, const measure::ToScore& to_score,
                      const grammar::Overrides& settings, const ParsedOptions& options,
                      const CommandContext& context) {
  const auto selection =
      suite::SelectScenarios(options.All("names"), options.All("--filter"), context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);
  if (selection->scenarios.empty())
    return Complain(context, ExitCode::kNothing, "there is only a golden, without its scenario");
  std::vector<measure::ScoreRequest> requests;
  for (const episode::ScenarioFile& file : selection->scenarios) {
    if (const std::string lack = episode::Lacks(NameOf(file), episode::Need::kGroundTruth);
        !lack.empty())
      return Refuse(context, lack);
    // Many episodes of one file have its path, and are told apart by their scenarios.
    std::string id = file.episode && !file.in_project
                         ? file.skill + (file.skill.empty() ? "" : "/") + file.name
                         : episode::IdOf(file);
    requests.push_back(
        {NameOf(file), std::move(id), context.root, &asking, to_score.events, settings});
  }
  const double collar_s = CollarFrom(options);
  const auto scores =
      measure::ScoreScenarios(requests, asking, to_score.not_covered, collar_s, CoreCount());
  context.err << scores.notes;
  ExitCode worst = ExitCode::kAgrees;
  for (const measure::NotScored& one : scores.not_scored) {
    context.err << "prehend: " << one.id << " was not scored: " << one.why;
    if (worst != ExitCode::kFailure)
      worst = one.is_bad_input ? ExitCode::kBadInput : ExitCode::kFailure;
  }
  if (scores.of_grammars.empty()) return worst;  // no table of nothing
  if (options.Has("--json")) {
    nlohmann::ordered_json json = measure::ScoresJson(scores.of_grammars, options.Has("--verbose"));
    json["witnesses"] = measure::EvaluatorsJson(scores.of_grammars, scores.evaluators);
    context.out << json.dump(2) << "\n";
  } else {
    context.out << measure::ScenarioScoresText(scores, options.Has("--verbose"));
  }
  return worst;
}

ExitCode RunScore(const ParsedOptions& options, const CommandContext& context) {
  const bool has_takes = std::ranges::any_of(options.All("names"), [](const std::string& typed) {
    return episode::IsTakesFile(typed) || episode::IsTakesFile(typed + "/takes.yaml");
  });
  if (options.Has("--truth") || has_takes) return RunLabels(options, context);
  measure::Asking asking = AskingFrom(options, context);
  // The baseline keeps the authors' numbers.
  if (asking.sources.empty()) {
    asking.sources.push_back({measure::Source::Kind::kGrammar, kDefaultGrammar});
    if (!options.Has("--set"))
      asking.sources.push_back({measure::Source::Kind::kGrammar, "original_2020"});
  }
  const Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  const bool has_others = options.Has("--found") || options.Has("--recogniser");
  for (const char* of_labels : {"--map", "--episode", "--skip-bad-labels"}) {
    if (options.Has(of_labels) && !(has_others && of_labels == std::string("--map")))
      return Refuse(context, fmt::format("{} needs --truth: where are the labels?", of_labels));
  }
  const std::vector<std::string> events = measure::EventsIn(options.All("--event"));
  if (const std::string unknown = measure::UnknownEvent(events); !unknown.empty())
    return Refuse(context, unknown);
  const Result<measure::ToScore> to_score =
      measure::CompileToScore(context.root, asking.sources, *settings, events);
  if (!to_score) return Complain(context, to_score.error());
  return RunScenarios(asking, *to_score, *settings, options, context);
}

}  // namespace

Command ScoreCommand() {
  return {
      .name = "score",
      .summary = "Score grammars against what physically happened",
      .examples = {"score", "score --grammar pick_and_place --grammar my/rules.grammar",
                   "score --grammar my/rules.grammar --event grasping,sliding",
                   "score 'slide/*' --collar-ms 20 --json",
                   "score take1.jsonl take2.jsonl --truth labels --map labels.yaml",
                   "score takes.yaml", "score anna.csv --truth ben.csv"},
      .options = Joined(
          {Repeatable(
               Argument("names", "names, skill/name, globs or files; default: all scenarios")),
           FilterOption(),
           Repeatable(Value(
               "--grammar", "NAME|FILE",
               "a grammar to score; may be repeated; default: pick_and_place and original_2020 "
               "(with --set the first alone); with --truth that of the recordings")),
           ParametersOption(), EpisodesOption(),
           Repeatable(Value("--event", "NAME,..",
                            "score only these events; default: all that docs/events.md defines")),
           Flag("--verbose",
                "list every event that differs from what an evaluator says, or from the labels"),
           Repeatable(Value("--found", "FILE|FOLDER",
                            "score these events, too, which somebody else found: a folder with a "
                            "file for each episode (.csv, .eaf, .TextGrid, .timeline, .jsonl, "
                            ".txt), or one table with a column 'episode' (docs/recognisers.md)")),
           Repeatable(Value("--recogniser", "CMD",
                            "score a program that reads frames and prints events "
                            "(docs/recognisers.md), a grammar, or files:FOLDER; may be repeated")),
           PaceOption(), RecogniserLimitOption(), JsonOption()},
          TruthOptions("labels by people (.csv, .eaf, .TextGrid) of the recordings or episode "
                       "files that are named: one file for each, one table of all, or a folder "
                       "(docs/labels.md); may be repeated",
                       "FILE|FOLDER")),
      .run = RunScore};
}

}  // namespace prehend::cli
