// SPDX-License-Identifier: Apache-2.0
// Compares a recognised timeline with a golden; the result is a value. Events are matched within
// their label (name and roles). An event without partner that overlaps a pair of its label is a
// fragment of that. Then events of different labels are paired if only a role, or only the event's
// name, changed. The rest is missing or extra. Tested by tests/harness/truth/golden/compare_test.cc
#pragma once

#include <cstdlib>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/truth/golden/golden.h"

namespace prehend::truth {

enum class LineVerdict {
  kMatched,     ///< both boundaries within tolerance
  kShifted,     ///< a boundary is out of tolerance
  kChanged,     ///< another role, attribute, value, or way to end
  kRelabelled,  ///< another event of the same roles at the same time
  kFragmented,  ///< one expected, several recognised
  kMerged,      ///< several expected, one recognised
  kMissing,     ///< expected, not recognised
  kExtra,       ///< recognised, not expected
};

/// "matched", "shifted", ...
std::string_view Name(LineVerdict agreement);

/// An expected event and its partner. One of the two is empty when missing or extra, and for all
/// but one of several fragments.
struct Pairing {
  LineVerdict agreement = LineVerdict::kMatched;
  std::optional<grammar::NamedEvent> expected, actual;
  std::size_t golden_line = 0;     ///< index into Golden::events; only with `expected`
  grammar::Tick begin_offset = 0;  ///< actual - expected, ticks; 0 without a partner
  grammar::Tick end_offset = 0;
  double tolerance = 0;                   ///< ticks, and parts of one: 12 ms are 5.76 of 480 Hz
  std::vector<std::string> changes;       ///< "object: milk -> cup"
  std::vector<grammar::Interval> pieces;  ///< all of them, in order; only of the one with a partner

  const grammar::NamedEvent& event() const { return expected ? *expected : *actual; }

  /// One of several fragments; reported with the one that has a partner.
  bool IsFurtherPiece() const;

  /// The first tick at which expected and recognised diverge.
  grammar::Tick DivergenceTick() const;
};

/// Two events whose relation in time is not that of the golden, by more than the tolerance.
struct RelationChange {
  std::string first, second;     ///< labels
  std::string expected, actual;  ///< names of Allen's relations
};

/// How far a boundary of a matched event is from the limit of its tolerance.
struct Margin {
  std::string label;  ///< "reaching(right_hand, milk)"
  bool at_end = false;
  grammar::Tick offset = 0;  ///< recognised - expected
  double tolerance = 0;      ///< ticks

  double Left() const { return tolerance - std::abs(offset); }
  std::string Boundary() const { return (at_end ? "end of " : "begin of ") + label; }
};

struct Comparison {
  // Compiled once, not wherever one is made or destroyed.
  Comparison();
  Comparison(const Comparison& other);
  Comparison(Comparison&& other) noexcept;
  Comparison& operator=(const Comparison& other);
  Comparison& operator=(Comparison&& other) noexcept;
  ~Comparison();

  grammar::Tick ticks_per_second = 480;
  std::vector<Pairing> pairings;  ///< in the order of time
  std::vector<RelationChange>
      relations;                ///< between differing events and all others that share their roles
  std::vector<Margin> margins;  ///< of every boundary of the matched events

  bool Agrees() const;
  int Count(LineVerdict agreement) const;
  const Margin* Smallest() const;  ///< of those that are off; null when all boundaries are exact
  const Pairing* FirstDivergence() const;  ///< null when all agree
  std::vector<const Pairing*> Differing()
      const;  ///< first divergence first; pieces are told of by one
};

/// Where events lie to each other otherwise than the golden says: of every two pairs that share
/// their entities and of which at least one differs. Two boundaries count as equal when they are no
/// further apart than the tolerance.
std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings);

/// Compares in the ticks of `actual`. `default_tolerance` (ticks) holds for golden lines without a
/// tolerance.
Comparison Compare(const Golden& expected, const grammar::Timeline& actual,
                   grammar::Tick default_tolerance);

/// The differences as text, first divergence first, each with both intervals, signed offsets in
/// milliseconds, and the question for `command`, "prehend explain ..", unless it is empty. `facts`
/// are shown with the first difference. Empty when all agree.
std::string DifferenceText(const Comparison& comparison, std::string_view command,
                           std::string_view facts = {});
/// `why`: the command about a difference, or "".
std::string DifferenceText(const Comparison& comparison,
                           const std::function<std::string(const Pairing&)>& why,
                           std::string_view facts = {});

/// The question to `prehend explain` about a difference: "--event 'sliding hand cup @0.1000s'".
std::string QuestionAbout(const Pairing& pairing, grammar::Tick ticks_per_second);
/// "sliding hand cup"
std::string AskedAs(const grammar::NamedEvent& event);

/// The same differences, and the relations that changed, as lists for programs: keys in
/// docs/regression-suite.md.
nlohmann::ordered_json DifferencesJson(const Comparison& comparison, std::string_view command);
nlohmann::ordered_json RelationsJson(const Comparison& comparison);

/// One line about the smallest margin, or "" without matched events:
/// "margin: 4.2 of 8.3 ms left at begin of reaching(right_hand, milk)"
std::string MarginText(const Comparison& comparison);

}  // namespace prehend::truth
