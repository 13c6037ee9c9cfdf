// SPDX-License-Identifier: Apache-2.0
// Grammars and the physical oracle, judged by the closed forms (tests/witnesses/README.md).
// Tested by tests/witnesses/closed_forms_test.cc and tests/witnesses/closed_form_score_test.cc
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/base/base/result.h"
#include "harness/measure/score/further_scores.h"
#include "harness/truth/oracle/recording.h"
#include "tests/witnesses/closed_form/agreement.h"
#include "tests/witnesses/closed_form/closed_form.h"

namespace prehend::witnesses {

/// Who finds events in a recording.
struct ClosedFormEvaluator {
  std::string name;
  std::function<grammar::Timeline(const ClosedFormRecording&)> recognise;
};
/// Only events that docs/events.md defines count.
ClosedFormEvaluator EvaluatedGrammar(const std::string& name,
                                     std::shared_ptr<const grammar::Program> program);
ClosedFormEvaluator EvaluatedOracle(const truth::OracleSettings& settings = {});

/// The events of one story, in one sampling.
struct ClosedFormRow {
  std::string form, sampling;
  std::vector<JudgedEvent> events;
};

struct ClosedFormScore {
  std::string evaluator;
  std::vector<ClosedFormRow> rows;

  /// Of all events, or of those of one name.
  int Boundaries(const std::string& event = "") const;
  int Right(const std::string& event = "") const;
};

/// One score per evaluator. Every file is read once.
Result<std::vector<ClosedFormScore>> ScoreOnClosedForms(
    const std::vector<std::string>& files, const std::vector<ClosedFormEvaluator>& evaluators);

/// A table of the scores, and of each evaluator what it has wrong: one line per story and event.
std::string ClosedFormText(const std::vector<ClosedFormScore>& scores);
nlohmann::ordered_json ClosedFormJson(const std::vector<ClosedFormScore>& scores);

/// Boundaries that are right, of those that are known on paper or were recognised.
measure::Evaluation ByClosedForms(const ClosedFormScore& score);

/// README's table: what `prehend score --json` says of each evaluator, and one more, the closed
/// forms.
std::string EvaluatorTableWith(const nlohmann::json& score,
                               const std::vector<ClosedFormScore>& closed_forms);

}  // namespace prehend::witnesses
