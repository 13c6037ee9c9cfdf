// SPDX-License-Identifier: Apache-2.0
// See harness/measure/score/score_labels.h. Tested by tests/program/labels_test.cc
#include "harness/measure/score/score_labels.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "grammar/contents.h"
#include "harness/episode/episode/open_episode.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/missing_facts.h"
#include "harness/exchange/labels/clock_offset.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {
namespace {

/// The name of the recording, and a line for each event that is missing, too much, or has a
/// boundary beyond the collar; "" if there is none.
std::string DifferencesOf(const EpisodeToScore& episode, double collar_s) {
  const auto per_s = static_cast<double>(episode.truth.ticks_per_second);
  const auto collar = static_cast<grammar::Tick>(std::lround(collar_s * per_s));
  const std::string lines =
      truth::DescribeDisagreement(truth::Agree(episode.truth, episode.found, collar), collar);
  return lines.empty() ? "" : episode.scenario + ":\n" + lines;
}

/// Each event that is never recognised, once for all episodes.
std::string MissingFactsOf(std::vector<episode::Episode>& episodes,
                           const grammar::Program& program) {
  std::set<std::string> said;
  std::string warnings;
  for (episode::Episode& episode : episodes) {
    if (!episode.recording()) continue;
    for (const std::string& warning :
         episode::FindMissingFacts(*episode.recording(), program).never)
      if (said.insert(warning).second) warnings += warning;
  }
  return warnings;
}

std::string ClockWarning(const std::string& grammar, const std::vector<EpisodeToScore>& episodes,
                         const exchange::LabelReading& truths) {
  std::vector<std::pair<grammar::Timeline, grammar::Timeline>> compared;
  for (const EpisodeToScore& episode : episodes)
    compared.emplace_back(episode.truth, episode.found);
  const auto clock = exchange::FindClockOffset(compared);
  if (!clock) return "";
  return fmt::format(
      "warning: {}: of {} labels {} are found, and {} if all of them were moved by {:+.2f} s; "
      "does the video begin when the tracker does?\n  hint: offset_s: {:.2f} in the map\n",
      grammar, clock->all, clock->found_now, clock->found_then, clock->offset_s,
      truths.offset_s() + clock->offset_s);
}

/// The labels of one episode beside what the grammar recognises.
Result<EpisodeToScore> Labelled(episode::Episode& episode, std::size_t index,
                                const exchange::LabelReading& truths,
                                const std::shared_ptr<const grammar::Program>& program) {
  const Result<grammar::Timeline> found = episode.Segment(program);
  if (!found) return tl::unexpected(found.error());
  const grammar::EntityTable table = episode.entities();
  const grammar::Tick end = *episode.EndTick();
  Result<grammar::Timeline> truth =
      truths.Truth(index, table.entities, table.ticks_per_second, end);
  if (!truth) return tl::unexpected(std::move(truth.error()));
  EpisodeToScore labelled{.scenario = episode.name().scenario,
                          .ticks = end,
                          .truth = std::move(*truth),
                          .found = exchange::Compared(*found, truths.compared())};
  for (const grammar::NamedEvent& event : found->events)
    if (!truths.compared().contains(event.event)) ++labelled.ignored[event.event];
  return labelled;
}

Result<std::vector<EpisodeToScore>> AllLabelled(
    std::vector<episode::Episode>& episodes, const exchange::LabelReading& truths,
    const std::shared_ptr<const grammar::Program>& program) {
  std::vector<EpisodeToScore> all;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    Result<EpisodeToScore> labelled = Labelled(episodes[i], i, truths, program);
    if (!labelled) return tl::unexpected(std::move(labelled.error()));
    all.push_back(std::move(*labelled));
  }
  return all;
}

void AddScores(const std::string& grammar, std::vector<EpisodeToScore> episodes, double collar_s,
               LabelScores& scores) {
  std::string& differences = scores.differences.emplace_back();
  for (const EpisodeToScore& episode : episodes) differences += DifferencesOf(episode, collar_s);
  scores.of_grammars.push_back(ScoreOf(grammar, episodes, collar_s));
  scores.of_grammars.back().ignored_because = "no label means them";
  for (EpisodeToScore& episode : episodes) {
    episode.truth = exchange::ByHand(std::move(episode.truth));
    episode.found = exchange::ByHand(std::move(episode.found));
  }
  scores.by_hand.push_back(ScoreOf(grammar, episodes, collar_s));
  scores.by_hand.back().ignored.clear();
}

}  // namespace

bool LabelScores::HasHands() const {
  for (std::size_t g = 0; g < by_hand.size(); ++g)
    if (by_hand[g].events.size() > of_grammars[g].events.size()) return true;
  return false;
}

Result<LabelScores> ScoreLabels(const LabelsRequest& request, std::string& warnings) {
  const Result<grammar::Overrides> settings = episode::ParameterSettings(request.settings);
  if (!settings) return tl::unexpected(settings.error());
  std::vector<std::string> grammars = request.grammars;
  if (grammars.empty()) {
    grammar::Diagnostics why = episode::WhyNotOneGrammar(request.episodes, request.root);
    if (!why.empty()) return tl::unexpected(std::move(why));
    grammars.emplace_back();
  }
  std::vector<episode::Episode> episodes;
  episode::EpisodeOpener opener(request.root);
  for (const episode::EpisodeName& name : request.episodes) {
    Result<episode::Episode> episode = opener.Open(name, {grammars.front(), request.settings});
    if (!episode) return tl::unexpected(std::move(episode.error()));
    episodes.push_back(std::move(*episode));
  }
  LabelScores scores;
  for (const std::string& grammar : grammars) {
    const grammar::CompileResult compiled =
        opener.Compile(request.episodes.front(), grammar, *settings);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    const auto truths =
        exchange::ReadTruths(request.episodes, request.label_files, request.label_map,
                             *compiled.program, request.backward);
    if (!truths) return tl::unexpected(truths.error());
    if (scores.of_grammars.empty()) warnings += exchange::BackwardWarning(*truths);
    warnings += MissingFactsOf(episodes, *compiled.program);
    auto labelled = AllLabelled(episodes, *truths, compiled.program);
    if (!labelled) return tl::unexpected(std::move(labelled.error()));
    const std::string& name = grammar.empty() ? GrammarName(*compiled.program) : grammar;
    warnings += ClockWarning(name, *labelled, *truths);
    AddScores(name, std::move(*labelled), request.collar_s, scores);
  }
  return scores;
}

std::string LabelScoresText(const LabelScores& scores, double collar_s, bool differences) {
  std::string text = ScoresText(scores.of_grammars, collar_s);
  if (scores.HasHands()) {
    text += "\nEach hand for itself:\n\n";
    for (const Score& one : scores.by_hand) text += ScoreTable(one, collar_s) + "\n";
  }
  for (std::size_t g = 0; differences && g < scores.differences.size(); ++g)
    text += fmt::format("\n{}, against the labels:\n{}", scores.of_grammars[g].grammar,
                        scores.differences[g].empty() ? "no differences\n" : scores.differences[g]);
  return text;
}

}  // namespace prehend::measure
