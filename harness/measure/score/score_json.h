// SPDX-License-Identifier: Apache-2.0
// Scores as JSON. Tested by tests/program/score_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "harness/measure/score/score.h"

namespace prehend::measure {

/// {"collar_s", "grammars": [{"grammar", "episodes", "not_covered", "ignored", "total": {..},
/// "events": [{..}]}]}; shares from 0 to 1, times in seconds; docs/regression-suite.md says what
/// each is.
nlohmann::ordered_json ScoresJson(const std::vector<Score>& scores, double collar_s);

/// {"by_event": {EVENT: {"of", "confirmed"}}, "differences": ["..", ..]}
nlohmann::ordered_json EvaluationJson(const Evaluation& evaluation);

/// [{"witness", "proves", "grammars": [{"grammar", "of", "confirmed", "by_event", "differences"}]}]
nlohmann::ordered_json EvaluatorsJson(const std::vector<Score>& scores,
                                      const std::vector<Evaluator>& evaluators);

}  // namespace prehend::measure
