// SPDX-License-Identifier: Apache-2.0
// prehend score: grammars against the physical oracle. Tested by tests/program/score_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "grammar/contents.h"
#include "harness/base/default_grammar.h"
#include "harness/base/project_paths.h"
#include "harness/check/select_scenarios.h"
#include "harness/command/typed_episode.h"
#include "harness/episode/open_episode.h"
#include "harness/labels/clock_offset.h"
#include "harness/labels/read_truths.h"
#include "harness/oracle/oracle.h"
#include "harness/process/worker_pool.h"
#include "harness/run/load_grammar.h"
#include "harness/run/load_run.h"
#include "harness/run/missing_facts.h"
#include "harness/score/score_json.h"
#include "harness/score/score_scenario.h"
#include "harness/timeline/match_events.h"
#include "harness/timeline/timeline_json.h"

namespace prehend::harness {
namespace {

using Json = nlohmann::ordered_json;
using score::EpisodeToScore;

constexpr double kDefaultCollar_ms = 50;
constexpr double kTimeLimit_s = 300;

/// What a worker sends: {"problem", "bad_input"} or {"episodes": [{"ticks", "truth", "found",
/// "ignored"}, ..]}, one per grammar.
std::string Judged(const ScoreRequest& request) {
  const auto episodes = EpisodesToScore(request);
  if (!episodes)
    return Json{{"problem", grammar::Format(episodes.error().diagnostics)},
                {"bad_input", episodes.error().is_bad_input}}
        .dump();
  Json sent = Json::array();
  for (const EpisodeToScore& episode : *episodes) {
    sent.push_back({{"ticks", episode.ticks},
                    {"truth", TimelineJson(episode.truth)},
                    {"found", TimelineJson(episode.found)},
                    {"ignored", episode.ignored},
                    {"by_definitions", score::TestimonyJson(episode.by_definitions)},
                    {"by_claims", score::TestimonyJson(episode.by_claims)}});
  }
  return Json{{"episodes", std::move(sent)}}.dump();
}

/// Episodes by grammar. A scenario that could not be scored is reported on `context.err`; `worst`
/// becomes the exit code for it.
std::vector<std::vector<EpisodeToScore>> JudgeAll(const ScenarioSelection& selection,
                                                  const std::vector<std::string>& grammars,
                                                  const std::vector<std::string>& events,
                                                  const grammar::Overrides& settings,
                                                  const CommandContext& context, ExitCode& worst) {
  std::vector<WorkerJob> jobs;
  std::vector<std::string> ids;
  for (const ScenarioFile& file : selection.scenarios) {
    ids.push_back(IdOf(file));
    const ScoreRequest request{NameOf(file), ids.back(), context.root, grammars, events, settings};
    jobs.push_back([request] { return Judged(request); });
  }
  const WorkerLimits limits{.jobs = CoreCount(), .time_limit_s = kTimeLimit_s};
  const std::vector<WorkerResult> results = RunInWorkers(jobs, limits);
  std::vector<std::vector<EpisodeToScore>> by_grammar(grammars.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json sent = results[i].finished ? Json::parse(results[i].output)
                                          : Json{{"problem", results[i].reason + "\n"}};
    if (sent.contains("problem")) {
      context.err << "prehend: " << ids[i]
                  << " was not scored: " << sent["problem"].get<std::string>();
      const bool bad_input = sent.value("bad_input", false);
      if (worst != ExitCode::kFailure) worst = bad_input ? ExitCode::kBadInput : ExitCode::kFailure;
      continue;
    }
    for (std::size_t g = 0; g < grammars.size(); ++g) {
      const Json& episode = sent["episodes"][g];
      by_grammar[g].push_back({ids[i], episode["ticks"], TimelineFromJson(episode["truth"]),
                               TimelineFromJson(episode["found"]), episode["ignored"],
                               score::TestimonyFromJson(episode["by_definitions"]),
                               score::TestimonyFromJson(episode["by_claims"])});
    }
  }
  return by_grammar;
}

/// The names between the commas; empty ones stay, so that they can be reported.
std::vector<std::string> NamesIn(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists) {
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      names.push_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return names;
}

/// Why these events cannot be selected, or "".
std::string UnknownEvent(const std::vector<std::string>& events) {
  const std::vector<std::string> known(OracleEvents().begin(), OracleEvents().end());
  for (const std::string& event : events) {
    if (OracleDefines(event)) continue;
    if (event.empty()) return "--events: a name is missing next to a comma; write NAME,NAME";
    const std::string near = grammar::NearestName(event, known);
    return fmt::format("--events: docs/events.md defines no '{}'; {}", event,
                       near.empty() ? fmt::format("it defines {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

/// Of the judged events those that no rule of the grammar prints.
std::vector<std::string> NotCovered(const grammar::Program& program,
                                    const std::vector<std::string>& events) {
  std::vector<std::string> silent;
  for (const std::string_view event : OracleEvents()) {
    const bool judged = events.empty() || std::ranges::find(events, event) != events.end();
    if (judged && !HasEvent(program, event)) silent.emplace_back(event);
  }
  return silent;
}

/// Of the episodes the definitions and the claims.
std::vector<score::Witness> WitnessesOf(
    const std::vector<std::vector<EpisodeToScore>>& by_grammar) {
  score::Witness definitions{"definitions", "events lie within the bands of docs/events.md", {}};
  score::Witness claims{"claims", "a run shows what its author said before it was played", {}};
  for (const std::vector<EpisodeToScore>& episodes : by_grammar) {
    score::Testimony &defined = definitions.of_grammars.emplace_back(),
                     &claimed = claims.of_grammars.emplace_back();
    for (const EpisodeToScore& episode : episodes) {
      defined += episode.by_definitions;
      claimed += episode.by_claims;
    }
  }
  return {std::move(definitions), std::move(claims)};
}

/// What differs, by grammar; of many differences the first ones.
void PrintDifferences(const std::vector<std::string>& grammars,
                      const std::vector<score::Witness>& witnesses, bool all, std::ostream& out) {
  constexpr std::size_t kMaxShown = 10;
  for (const score::Witness& witness : witnesses) {
    for (std::size_t g = 0; g < grammars.size(); ++g) {
      const std::vector<std::string>& lines = witness.of_grammars[g].differences;
      const std::size_t shown = all ? lines.size() : std::min(lines.size(), kMaxShown);
      if (shown > 0) out << fmt::format("{}, outside the {}:\n", grammars[g], witness.name);
      for (std::size_t i = 0; i < shown; ++i) out << "  " << lines[i] << "\n";
      if (shown < lines.size())
        out << fmt::format("  and {} more; --differences lists all\n", lines.size() - shown);
    }
  }
}

void Print(const std::vector<score::Score>& scores, double collar_s, std::ostream& out) {
  for (const score::Score& one : scores) out << ScoreTable(one, collar_s) << "\n";
  if (scores.size() > 1) out << SideBySide(scores, collar_s) << "\n";
  out << "C correct, D deleted, F fragmented, M merged, FM both, I' inserted (Ward et al. 2011); "
         "boundary errors are\n"
         "found - true: median / 95th percentile / largest, the last two by magnitude; late: from "
         "an event's end to its\n"
         "decision, median / 95th percentile / largest. Every grammar is scored on the same true "
         "events.\n";
}

/// The name of the take, and a line for each event that is missing, too much, or has a boundary
/// beyond the collar; "" if there is none.
std::string DifferencesOf(const EpisodeToScore& episode, double collar_s) {
  const auto per_s = static_cast<double>(episode.truth.ticks_per_second);
  const auto collar = static_cast<grammar::Tick>(std::lround(collar_s * per_s));
  const std::string lines =
      DescribeDisagreement(Agree(episode.truth, episode.found, collar), collar);
  return lines.empty() ? "" : episode.scenario + ":\n" + lines;
}

/// Each event that is never recognised, once for all takes.
void WarnOfMissingFacts(std::vector<Episode>& episodes, const grammar::Program& program,
                        const CommandContext& context) {
  std::set<std::string> said;
  for (Episode& episode : episodes) {
    if (!episode.recording()) continue;
    for (const std::string& warning : FindMissingFacts(*episode.recording(), program).never)
      if (said.insert(warning).second) context.err << warning;
  }
}

/// `score TAKES --truth LABELS`: against what people marked.
ExitCode RunLabels(const ParsedOptions& options, const CommandContext& context) {
  for (const char* other : {"--filter", "--events"}) {
    if (options.Has(other))
      return Complain(
          context, ExitCode::kBadInput,
          fmt::format("--truth compares what the labels mean: {} does not apply", other));
  }
  if (!options.Has("names"))
    return Complain(context, ExitCode::kNothing,
                    "--truth: which recordings? score take1.jsonl --truth take1.csv");
  const auto names = FindEpisodesOrComplain("names", options, context);
  if (!names) return names.error();
  const Result<grammar::Overrides> settings = ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  std::vector<std::string> grammars = options.All("--grammar");
  if (grammars.empty()) {
    Result<std::string> own = labels::OwnGrammar(*names);
    if (!own) return Complain(context, own.error());
    grammars.push_back(std::move(*own));
  }
  const double collar_s = options.NumberOr("--collar-ms", kDefaultCollar_ms) / 1000;
  std::vector<std::vector<EpisodeToScore>> all(grammars.size()), by_hand(grammars.size());
  std::vector<std::string> differences(grammars.size());
  std::vector<Episode> opened;
  EpisodeOpener opener(context.root);
  for (const EpisodeName& name : *names) {
    Result<Episode> episode = opener.Open(name, {grammars.front(), options.All("--set")});
    if (!episode) return Complain(context, episode.error());
    opened.push_back(std::move(*episode));
  }
  for (std::size_t g = 0; g < grammars.size(); ++g) {
    const grammar::CompileResult compiled = LoadGrammar(context.root, grammars[g], *settings);
    if (!compiled.program) return Complain(context, compiled.diagnostics);
    const auto truths = labels::ReadTruths(
        *names, options.All("--truth"), options.Text("--map"), *compiled.program,
        options.Has("--skip-bad-labels") ? labels::Backward::kSkip : labels::Backward::kRefuse);
    if (!truths) return Complain(context, truths.error());
    if (g == 0) context.err << labels::BackwardWarning(*truths);
    std::vector<std::pair<grammar::Timeline, grammar::Timeline>> compared;
    WarnOfMissingFacts(opened, *compiled.program, context);
    for (std::size_t i = 0; i < opened.size(); ++i) {
      Episode& take = opened[i];
      const grammar::EntityTable table = take.entities();
      const Result<grammar::Timeline> found = take.Segment(compiled.program);
      if (!found) return Complain(context, found.error());
      const grammar::Tick end = *take.EndTick();
      const auto truth = truths->Truth(i, table.entities, table.ticks_per_second, end);
      if (!truth) return Complain(context, truth.error());
      EpisodeToScore episode{.scenario = (*names)[i].scenario, .ticks = end};
      episode.truth = *truth;
      episode.found = labels::Compared(*found, truths->compared());
      for (const grammar::NamedEvent& event : found->events)
        if (!truths->compared().contains(event.event)) ++episode.ignored[event.event];
      compared.emplace_back(episode.truth, episode.found);
      differences[g] += DifferencesOf(episode, collar_s);
      all[g].push_back(episode);
      episode.truth = labels::ByHand(std::move(episode.truth));
      episode.found = labels::ByHand(std::move(episode.found));
      by_hand[g].push_back(std::move(episode));
    }
    if (const auto clock = labels::FindClockOffset(compared))
      context.err << fmt::format(
          "warning: {}: of {} labels {} are found, and {} if all of them were moved by {:+.2f} s; "
          "does the video begin when the tracker does?\n  hint: offset_s: {:.2f} in the map\n",
          grammars[g], clock->all, clock->found_now, clock->found_then, clock->offset_s,
          truths->offset_s() + clock->offset_s);
  }
  std::vector<score::Score> scores, of_hands;
  for (std::size_t g = 0; g < grammars.size(); ++g) {
    scores.push_back(ScoreOf(grammars[g], all[g], collar_s));
    of_hands.push_back(ScoreOf(grammars[g], by_hand[g], collar_s));
    scores.back().ignored_because = "no label means them";
    of_hands.back().ignored.clear();
  }
  if (options.Has("--json")) {
    nlohmann::ordered_json json = ScoresJson(scores, collar_s);
    json["by_hand"] = ScoresJson(of_hands, collar_s);
    context.out << json.dump(2) << "\n";
    return ExitCode::kAgrees;
  }
  Print(scores, collar_s, context.out);
  const bool has_hands = std::ranges::any_of(of_hands, [&](const score::Score& one) {
    return one.events.size() > scores[&one - of_hands.data()].events.size();
  });
  if (has_hands) {
    context.out << "\nEach hand for itself:\n\n";
    for (const score::Score& one : of_hands) context.out << ScoreTable(one, collar_s) << "\n";
  }
  for (std::size_t g = 0; options.Has("--differences") && g < grammars.size(); ++g)
    context.out << fmt::format("\n{}, against the labels:\n{}", grammars[g],
                               differences[g].empty() ? "no differences\n" : differences[g]);
  return ExitCode::kAgrees;
}

ExitCode RunScore(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--truth")) return RunLabels(options, context);
  std::vector<std::string> grammars = options.All("--grammar");
  // The baseline keeps the authors' numbers.
  if (grammars.empty())
    grammars = options.Has("--set") ? std::vector<std::string>{kDefaultGrammar}
                                    : std::vector<std::string>{kDefaultGrammar, "original_2020"};
  const Result<grammar::Overrides> settings = ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  for (const char* of_labels : {"--map", "--episode", "--skip-bad-labels"}) {
    if (options.Has(of_labels))
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("{} needs --truth: where are the labels?", of_labels));
  }
  const std::vector<std::string> events = NamesIn(options.All("--events"));
  if (const std::string unknown = UnknownEvent(events); !unknown.empty())
    return Complain(context, ExitCode::kBadInput, unknown);
  std::vector<std::vector<std::string>> not_covered;
  for (const std::string& name : grammars) {
    const grammar::CompileResult compiled = LoadGrammar(context.root, name, *settings);
    if (!compiled.program) return Complain(context, compiled.diagnostics);
    not_covered.push_back(NotCovered(*compiled.program, events));
  }
  const auto selection =
      SelectScenarios(options.All("names"), options.All("--filter"), context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);

  for (const ScenarioFile& file : selection->scenarios) {
    if (const std::string lack = Lacks(NameOf(file), Need::kGroundTruth); !lack.empty())
      return Complain(context, ExitCode::kBadInput, lack);
  }
  ExitCode worst = ExitCode::kAgrees;
  const auto by_grammar = JudgeAll(*selection, grammars, events, *settings, context, worst);
  if (by_grammar.front().empty()) return worst;  // no table of nothing
  const double collar_s = options.NumberOr("--collar-ms", kDefaultCollar_ms) / 1000;
  std::vector<score::Score> scores;
  for (std::size_t g = 0; g < grammars.size(); ++g) {
    scores.push_back(ScoreOf(grammars[g], by_grammar[g], collar_s));
    scores.back().not_covered = not_covered[g];
  }
  const std::vector<score::Witness> witnesses = WitnessesOf(by_grammar);
  if (options.Has("--json")) {
    nlohmann::ordered_json json = ScoresJson(scores, collar_s);
    json["witnesses"] = score::WitnessesJson(grammars, witnesses);
    context.out << json.dump(2) << "\n";
  } else {
    Print(scores, collar_s, context.out);
    context.out << "\n" << WitnessTable(grammars, witnesses) << "\n";
    PrintDifferences(grammars, witnesses, options.Has("--differences"), context.out);
  }
  return worst;
}

}  // namespace

Command ScoreCommand() {
  return {
      .name = "score",
      .summary = "Score grammars against what physically happened",
      .examples = {"score", "score --grammar pick_and_place --grammar my/rules.grammar",
                   "score --grammar my/rules.grammar --events grasping,sliding",
                   "score 'slide/*' --collar-ms 20 --json",
                   "score take1.jsonl take2.jsonl --truth labels --map labels.yaml --grammar "
                   "pick_and_place_from_motion"},
      .options = {{.name = "names",
                   .help = "names, skill/name, globs or files; default: all scenarios",
                   .repeatable = true},
                  {.name = "--filter",
                   .help = "keep those that match this glob or have the tag; as of 'check'",
                   .placeholder = "[!]GLOB|[!]tag:NAME",
                   .repeatable = true},
                  {.name = "--grammar",
                   .help = "a grammar to score; may be repeated; default: pick_and_place and\n"
                           "original_2020 (with --set the first alone); with --truth that of the\n"
                           "recordings",
                   .placeholder = "NAME|FILE",
                   .repeatable = true},
                  {.name = "--set",
                   .help = "set a parameter of the grammars; may be repeated",
                   .placeholder = "NAME=VALUE",
                   .repeatable = true},
                  {.name = "--truth",
                   .help = "labels by people (.csv, .eaf, .TextGrid) of the recordings or\n"
                           "episode files that are named, one file for each or a folder\n"
                           "(docs/labels.md); may be repeated",
                   .placeholder = "FILE|FOLDER",
                   .repeatable = true},
                  {.name = "--map",
                   .help = "what the labels mean: a YAML file; without it labels are events,\n"
                           "like grasping(right_hand, cup)",
                   .placeholder = "FILE"},
                  {.name = "--skip-bad-labels",
                   .help = "with --truth: leave out labels that end before they begin, and\n"
                           "count them"},
                  {.name = "--episode",
                   .help = "with --truth: only these episodes of episode files",
                   .placeholder = "WHICH"},
                  {.name = "--events",
                   .help = "score only these events; default: all that docs/events.md defines",
                   .placeholder = "NAME,..",
                   .repeatable = true},
                  {.name = "--collar-ms",
                   .help = fmt::format("tolerance of a boundary for the scores at a collar; "
                                       "default: {}",
                                       kDefaultCollar_ms),
                   .placeholder = "MS",
                   .rule = NumbersFrom(0, 10000)},
                  {.name = "--differences",
                   .help = "list every event that differs from what a witness says, or\n"
                           "from the labels"},
                  {.name = "--json", .help = "print one JSON object instead of tables"}},
      .run = RunScore};
}

}  // namespace prehend::harness
