// SPDX-License-Identifier: Apache-2.0
// How well a timeline agrees with what is known on paper. Tested by
// tests/witnesses/closed_form/agreement_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "tests/witnesses/closed_form/closed_form.h"

namespace prehend::witnesses {

/// Begin or end of an event. It is right within one frame: no frame lies between the expected
/// moment and the recognised one.
struct JudgedBoundary {
  std::optional<double> expected_s;    ///< none: there is no such event
  std::optional<double> recognised_s;  ///< none: the event was not recognised
  bool right = false;
  /// How late it was recognised; 0 unless there are both.
  double OffsetS() const { return expected_s && recognised_s ? *recognised_s - *expected_s : 0; }
};

struct JudgedEvent {
  std::string label;
  JudgedBoundary begin, end;
};

/// Every event that is known or was recognised, by label and time.
std::vector<JudgedEvent> ClosedFormAgreement(const std::vector<KnownEvent>& truth,
                                             const ClosedFormRecording& recording,
                                             const grammar::Timeline& recognised);

/// How many of the boundaries are right; all of them are twice the events.
int RightBoundaries(const std::vector<JudgedEvent>& events);

/// One line per event with a wrong boundary: "reaching(hand, cup): begins 1.2000 s, recognised
/// 1.3000 s (+100.0 ms); ends 2.0000 s".
std::string WrongBoundaries(const std::vector<JudgedEvent>& events);

}  // namespace prehend::witnesses
