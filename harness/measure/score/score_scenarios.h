// SPDX-License-Identifier: Apache-2.0
// Grammars and others against what physically happened in many scenarios, and what other evaluators
// say of them. Tested by tests/program/score_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {

/// One scenario, which is simulated once and segmented by each source.
struct ScoreRequest {
  episode::EpisodeName episode;
  std::string id;
  std::string root;
  const Asking* asking = nullptr;
  std::vector<std::string> events;   ///< only these are scored
  grammar::Overrides settings = {};  ///< of parameters of all grammars
};

/// Judged events that no rule of a grammar prints, for each source; none of others than grammars.
using NotCovered = std::vector<std::vector<std::string>>;
struct ToScore {
  std::vector<std::string> events;
  NotCovered not_covered;
};
/// `events`: only these are judged; empty: all that the oracle defines, of furniture those that one
/// of the grammars has.
Result<ToScore> CompileToScore(const std::string& root, const std::vector<Source>& sources,
                               const grammar::Overrides& settings,
                               const std::vector<std::string>& events);

/// The names between the commas; empty ones stay, so that they can be reported.
std::vector<std::string> EventsIn(const std::vector<std::string>& lists);

/// Why these events cannot be judged, or "".
std::string UnknownEvent(const std::vector<std::string>& events);

struct NotScored {
  std::string id, why;
  bool is_bad_input = true;  ///< else it did not come to a good end
};

struct ScenarioScores {
  std::vector<Score> of_grammars;  ///< none if no scenario could be scored
  std::vector<Evaluator> evaluators;
  std::string notes;                  ///< of programs, on standard error: lines, or ""
  std::vector<NotScored> not_scored;  ///< by nobody, or by a program that failed
};

/// One request per scenario, all with what is asked. `jobs`: processes at a time.
ScenarioScores ScoreScenarios(const std::vector<ScoreRequest>& requests, const Asking& asking,
                              const NotCovered& not_covered, double collar_s, int jobs);

/// Tables for people, and what differs: all of it, or of much the beginning.
std::string ScenarioScoresText(const ScenarioScores& scores, bool all_differences);

}  // namespace prehend::measure
