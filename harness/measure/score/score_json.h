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
nlohmann::ordered_json TestimonyJson(const Testimony& testimony);

/// [{"witness", "proves", "grammars": [{"grammar", "of", "confirmed", "by_event", "differences"}]}]
nlohmann::ordered_json WitnessesJson(const std::vector<Score>& scores,
                                     const std::vector<Witness>& witnesses);

}  // namespace prehend::measure
