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
#include "harness/measure/score/witnesses.h"
#include "harness/truth/oracle/settings.h"
#include "tests/witnesses/closed_form/agreement.h"
#include "tests/witnesses/closed_form/closed_form.h"

namespace prehend::witnesses {

/// Who finds events in a recording.
struct ClosedFormWitness {
  std::string name;
  std::function<grammar::Timeline(const ClosedFormRecording&)> recognise;
};
/// Only events that docs/events.md defines count.
ClosedFormWitness GrammarWitness(const std::string& name,
                                 std::shared_ptr<const grammar::Program> program);
ClosedFormWitness OracleWitness(const truth::OracleSettings& settings = {});

/// The events of one story, in one sampling.
struct ClosedFormRow {
  std::string form, sampling;
  std::vector<JudgedEvent> events;
};

struct ClosedFormScore {
  std::string witness;
  std::vector<ClosedFormRow> rows;

  /// Of all events, or of those of one name.
  int Boundaries(const std::string& event = "") const;
  int Right(const std::string& event = "") const;
};

/// One score per witness. Every file is read once.
Result<std::vector<ClosedFormScore>> ScoreOnClosedForms(
    const std::vector<std::string>& files, const std::vector<ClosedFormWitness>& witnesses);

/// A table of the scores, and of each witness what it has wrong: one line per story and event.
std::string ClosedFormText(const std::vector<ClosedFormScore>& scores);
nlohmann::ordered_json ClosedFormJson(const std::vector<ClosedFormScore>& scores);

/// Boundaries that are right, of those that are known on paper or were recognised.
measure::Testimony ByClosedForms(const ClosedFormScore& score);

/// README's table: what `prehend score --json` says of each witness, and one more, the closed
/// forms.
std::string WitnessTableWith(const nlohmann::json& score,
                             const std::vector<ClosedFormScore>& closed_forms);

}  // namespace prehend::witnesses
