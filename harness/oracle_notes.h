// SPDX-License-Identifier: Apache-2.0
// What lines of a golden say about the physical oracle, and what the oracle objects to that no line
// explains yet. Tested by tests/harness/accept_golden_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/golden.h"

namespace prehend::harness {

/// The reason that stands in a pending golden until a person gives one.
inline constexpr const char* kReasonWanted = "a reason is wanted";

/// Whether two notes ("" where the oracle agrees) say the same; offsets may be so far apart.
bool SameNote(const std::string& was, const std::string& now, double tolerance_ms);

/// Something that a golden and the run it is compared with do not both say about the oracle.
struct Objection {
  GoldenEvent line;  ///< of the pending golden; of the golden when its note is out of date
  std::string text;  ///< "the oracle sees no such event: sliding(hand, cup) 1.0000..2.0000 s"
  bool wants_reason = false;  ///< false: a note of the golden is no longer true
};

/// In the order of the lines. `pending` is what PendingGolden() makes of `golden`.
std::vector<Objection> Objections(const std::optional<Golden>& golden, const Golden& pending);

/// Whether a person has to say why one of them does not count.
bool WantsReason(const std::vector<Objection>& objections);

/// One line each, or "".
std::string Text(const std::vector<Objection>& objections);

/// One line about all of them, not empty: "the physical oracle objects to 2 events".
std::string Summary(const std::vector<Objection>& objections);

/// Writes people's reasons into the lines that want one: "sliding(hand, cup): WHY" is for events of
/// that label, any other text for all that have none of their own. "" or what is missing or too
/// much.
std::string GiveReasons(const std::vector<std::string>& reasons, Golden& golden);

}  // namespace prehend::harness
