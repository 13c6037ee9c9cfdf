// SPDX-License-Identifier: Apache-2.0
// What was recognised against what must be recognised, as a value.
// Events are paired per label (name and roles) so that as many as possible find a partner and the
// partners are as close as possible; what is left over is paired across labels when only a role
// changed; the rest is missing or extra. Tested by tests/harness/compare_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/timeline.h"
#include "harness/golden.h"

namespace prehend::harness {

enum class LineVerdict {
  kMatched,  ///< both boundaries within tolerance
  kShifted,  ///< a boundary is out of tolerance
  kChanged,  ///< another role, attribute, or way to end
  kMissing,  ///< expected, not recognised
  kExtra,    ///< recognised, not expected
};

/// "matched", "shifted", ...
std::string_view Name(LineVerdict agreement);

/// An expected event and its partner; one of the two is empty when missing or extra.
struct Pairing {
  LineVerdict agreement = LineVerdict::kMatched;
  std::optional<grammar::NamedEvent> expected, actual;
  std::size_t golden_line = 0;     ///< index into Golden::events; only with `expected`
  grammar::Tick begin_offset = 0;  ///< actual - expected, ticks; 0 without a partner
  grammar::Tick end_offset = 0;
  grammar::Tick tolerance = 0;
  std::vector<std::string> changes;  ///< "object: milk -> cup"

  const grammar::NamedEvent& event() const { return expected ? *expected : *actual; }
};

/// The boundary that comes nearest to its tolerance.
struct Headroom {
  std::string boundary;  ///< "begin of reaching(right_hand, milk)"
  grammar::Tick offset = 0;
  grammar::Tick tolerance = 0;
};

struct Comparison {
  grammar::Tick ticks_per_second = 480;
  std::vector<Pairing> pairings;     ///< in the order of time
  std::optional<Headroom> tightest;  ///< among the matched events; empty without one

  bool Agrees() const;
  int Count(LineVerdict agreement) const;
};

/// Compares in the ticks of `actual`; `default_tolerance` (ticks) is for golden lines without their
/// own.
Comparison Compare(const Golden& expected, const grammar::Timeline& actual,
                   grammar::Tick default_tolerance);

/// Two frames of sensing, in ticks: a boundary can't be known better than to the frame that shows
/// it.
grammar::Tick DefaultTolerance(int rate_hz, int sensing_hz);

/// The differences as text, first divergence first, each with both intervals, the signed offsets in
/// milliseconds and `command`, which shows it again. Empty when all agree.
std::string DifferenceText(const Comparison& comparison, std::string_view command);

/// One line: "headroom: 4.2 of 8.3 ms are left at begin of reaching(right_hand, milk)", or "".
std::string HeadroomText(const Comparison& comparison);

}  // namespace prehend::harness
