// SPDX-License-Identifier: Apache-2.0
// prehend score: grammars against the physical oracle. Tested by tests/program/score_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "grammar/contents.h"
#include "harness/base/default_grammar.h"
#include "harness/base/project_paths.h"
#include "harness/check/select_scenarios.h"
#include "harness/cli/command.h"
#include "harness/cli/number_in.h"
#include "harness/oracle/oracle.h"
#include "harness/process/worker_pool.h"
#include "harness/run/load_grammar.h"
#include "harness/score/score_json.h"
#include "harness/score/score_scenario.h"
#include "harness/timeline/timeline_json.h"

namespace prehend::harness {
namespace {

using Json = nlohmann::ordered_json;
using score::EpisodeToScore;

constexpr double kDefaultCollar_ms = 50;
constexpr double kTimeLimit_s = 300;

void Declare(CLI::App& options) {
  options.add_option("names", "names, skill/name, globs or files; nothing: all")
      ->expected(-1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options
      .add_option("--filter",
                  "only those that match this glob, or have tag:NAME; see prehend check --help")
      ->type_name("[!]GLOB|[!]tag:NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options
      .add_option(
          "--grammar",
          "a grammar to score, may be given again; otherwise pick_and_place and original_2020")
      ->type_name("NAME|FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options
      .add_option("--events",
                  "only these events, for every grammar; otherwise all that docs/events.md defines")
      ->type_name("NAME,..")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options
      .add_option("--collar-ms",
                  "how far off a boundary may be for the scores at a collar; otherwise 50")
      ->type_name("MS")
      ->expected(1)
      ->check(NumberIn(0, 10000));
  DeclareFlag(options, "--json", "one JSON object instead of tables");
}

/// What a worker sends: {"problem", "bad_input"} or {"episodes": [{"ticks", "truth", "found",
/// "not_judged"}, ..]}, one per grammar.
std::string Judged(const ScoreRequest& request) {
  bool bad_input = false;
  const auto episodes = EpisodesToScore(request, bad_input);
  if (!episodes.value)
    return Json{{"problem", Format(episodes.diagnostics)}, {"bad_input", bad_input}}.dump();
  Json sent = Json::array();
  for (const EpisodeToScore& episode : *episodes.value) {
    sent.push_back({{"ticks", episode.ticks},
                    {"truth", TimelineJson(episode.truth)},
                    {"found", TimelineJson(episode.found)},
                    {"not_judged", episode.not_judged}});
  }
  return Json{{"episodes", std::move(sent)}}.dump();
}

/// Episodes by grammar; what could not be played is told on `context.err`, and `worst` says what
/// kind it was.
std::vector<std::vector<EpisodeToScore>> JudgeAll(const ScenarioSelection& selection,
                                                  const std::vector<std::string>& grammars,
                                                  const std::vector<std::string>& events,
                                                  const CommandContext& context, ExitCode& worst) {
  std::vector<WorkerJob> jobs;
  std::vector<std::string> ids;
  for (const ScenarioFile& file : selection.scenarios) {
    ids.push_back(IdOf(file));
    const ScoreRequest request{file.path, ids.back(), context.root, grammars, events};
    jobs.push_back([request] { return Judged(request); });
  }
  const WorkerLimits limits{
      .jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency())),
      .time_limit_s = kTimeLimit_s};
  const std::vector<WorkerResult> results = RunInWorkers(jobs, limits);
  std::vector<std::vector<EpisodeToScore>> by_grammar(grammars.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json sent = results[i].finished ? Json::parse(results[i].output)
                                          : Json{{"problem", results[i].reason + "\n"}};
    if (sent.contains("problem")) {
      context.err << "prehend: " << ids[i]
                  << " is not scored: " << sent["problem"].get<std::string>();
      const bool bad_input = sent.value("bad_input", false);
      if (worst != ExitCode::kFailure) worst = bad_input ? ExitCode::kBadInput : ExitCode::kFailure;
      continue;
    }
    for (std::size_t g = 0; g < grammars.size(); ++g) {
      const Json& episode = sent["episodes"][g];
      by_grammar[g].push_back({ids[i], episode["ticks"], TimelineFromJson(episode["truth"]),
                               TimelineFromJson(episode["found"]), episode["not_judged"]});
    }
  }
  return by_grammar;
}

/// Between commas; what is empty stays, so that it can be complained about.
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

/// Why these events cannot be chosen, or "".
std::string UnknownEvent(const std::vector<std::string>& events) {
  const std::vector<std::string> known(OracleEvents().begin(), OracleEvents().end());
  for (const std::string& event : events) {
    if (OracleDefines(event)) continue;
    if (event.empty()) return "--events: a name is missing beside a comma; write NAME,NAME";
    const std::string near = grammar::NearestName(event, known);
    return fmt::format("--events: docs/events.md defines no '{}'; {}", event,
                       near.empty() ? fmt::format("it defines {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

/// Of the judged events those that no rule of the grammar prints.
std::vector<std::string> NotSpokenOf(const grammar::Program& program,
                                     const std::vector<std::string>& events) {
  std::vector<std::string> silent;
  for (const std::string_view event : OracleEvents()) {
    const bool judged = events.empty() || std::ranges::find(events, event) != events.end();
    if (judged && !HasEvent(program, event)) silent.emplace_back(event);
  }
  return silent;
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

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  std::vector<std::string> grammars = ValuesOf(options, "--grammar");
  if (grammars.empty()) grammars = {kDefaultGrammar, "original_2020"};
  const std::vector<std::string> events = NamesIn(ValuesOf(options, "--events"));
  if (const std::string unknown = UnknownEvent(events); !unknown.empty())
    return Complain(context, ExitCode::kBadInput, unknown);
  std::vector<std::vector<std::string>> not_spoken_of;
  for (const std::string& name : grammars) {
    const grammar::CompileResult compiled = LoadGrammar(context.root, name);
    if (!compiled.program) return Complain(context, compiled.diagnostics);
    not_spoken_of.push_back(NotSpokenOf(*compiled.program, events));
  }
  std::string problem;
  const auto selection = SelectScenarios(ValuesOf(options, "names"), ValuesOf(options, "--filter"),
                                         context.root, problem);
  if (!selection) return Complain(context, ExitCode::kNothing, problem);

  ExitCode worst = ExitCode::kAgrees;
  const auto by_grammar = JudgeAll(*selection, grammars, events, context, worst);
  if (by_grammar.front().empty()) return worst;  // no table of nothing
  const double collar_s =
      std::stod(ValueOf(options, "--collar-ms", std::to_string(kDefaultCollar_ms))) / 1000;
  std::vector<score::Score> scores;
  for (std::size_t g = 0; g < grammars.size(); ++g) {
    scores.push_back(ScoreOf(grammars[g], by_grammar[g], collar_s));
    scores.back().not_spoken_of = not_spoken_of[g];
  }
  if (IsGiven(options, "--json"))
    context.out << ScoresJson(scores, collar_s).dump(2) << "\n";
  else
    Print(scores, collar_s, context.out);
  return worst;
}

}  // namespace

Command ScoreCommand() {
  return {.name = "score",
          .summary = "Score grammars against what physically happened",
          .examples =
              "prehend score\n"
              "prehend score --grammar pick_and_place --grammar my/rules.grammar\n"
              "prehend score --grammar my/rules.grammar --events grasping,sliding\n"
              "prehend score 'slide/*' --collar-ms 20 --json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
