// SPDX-License-Identifier: Apache-2.0
// What was recognised against what must be recognised, as a value.
// Events are paired per label (name and roles) so that as many as possible find a partner and the
// partners are as close as possible; what is left over and overlaps a pair of its label is a piece
// of it; then pairs are made across labels where only a role, or only the event's name, changed;
// the rest is missing or extra. Tested by tests/harness/golden/compare_test.cc
#pragma once

#include <cstdlib>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/golden/golden.h"

namespace prehend::harness {

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

/// An expected event and its partner; one of the two is empty when missing or extra, and for the
/// further pieces of what is fragmented or merged.
struct Pairing {
  LineVerdict agreement = LineVerdict::kMatched;
  std::optional<grammar::NamedEvent> expected, actual;
  std::size_t golden_line = 0;     ///< index into Golden::events; only with `expected`
  grammar::Tick begin_offset = 0;  ///< actual - expected, ticks; 0 without a partner
  grammar::Tick end_offset = 0;
  grammar::Tick tolerance = 0;
  std::vector<std::string> changes;       ///< "object: milk -> cup"
  std::vector<grammar::Interval> pieces;  ///< all of them, in order; only of the one with a partner

  const grammar::NamedEvent& event() const { return expected ? *expected : *actual; }

  /// A further piece, told of by the one that has a partner.
  bool IsFurtherPiece() const;

  /// The first tick at which expected and recognised part.
  grammar::Tick DivergenceTick() const;
};

/// Two events that are both there, but lie to each other in another way, by more than the
/// tolerance.
struct RelationChange {
  std::string first, second;     ///< labels
  std::string expected, actual;  ///< names of Allen's relations
};

/// How near a boundary of a matched event comes to its tolerance.
struct Headroom {
  std::string boundary;  ///< "begin of reaching(right_hand, milk)"
  grammar::Tick offset = 0;
  grammar::Tick tolerance = 0;

  grammar::Tick Left() const { return tolerance - std::abs(offset); }
};

struct Comparison {
  grammar::Tick ticks_per_second = 480;
  std::vector<Pairing> pairings;  ///< in the order of time
  std::vector<RelationChange>
      relations;  ///< between differing events and all others that share their roles
  std::vector<Headroom> headroom;  ///< of every boundary of the matched events

  bool Agrees() const;
  int Count(LineVerdict agreement) const;
  const Headroom* Tightest() const;        ///< null without matched events
  const Pairing* FirstDivergence() const;  ///< null when all agree
  std::vector<const Pairing*> Differing()
      const;  ///< first divergence first; pieces are told of by one
};

/// Of every two pairs that share their entities and of which at least one differs. Two boundaries
/// count as equal when they are no further apart than the tolerance.
std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings);

/// Compares in the ticks of `actual`; `default_tolerance` (ticks) is for golden lines without their
/// own.
Comparison Compare(const Golden& expected, const grammar::Timeline& actual,
                   grammar::Tick default_tolerance);

/// Two frames of sensing, in ticks: a boundary can't be known better than to the frame that shows
/// it.
grammar::Tick DefaultTolerance(int rate_hz, int sensing_hz);

/// Two numbers of an event agree within 5 % of the expected one, or 0.001 of its unit.
bool ValuesAgree(double expected, double actual);

/// The differences as text, first divergence first, each with both intervals, signed offsets in
/// milliseconds, and what of `command`, "prehend explain ..", tells why; `facts` are of the first.
/// Empty when all agree.
std::string DifferenceText(const Comparison& comparison, std::string_view command,
                           std::string_view facts = {});

/// What `prehend explain` is to be asked about a difference: "--event 'sliding hand cup @0.1000s'".
std::string QuestionAbout(const Pairing& pairing, grammar::Tick ticks_per_second);

/// The same differences, and the relations that changed, as lists for programs: keys in
/// docs/regression-suite.md.
nlohmann::ordered_json DifferencesJson(const Comparison& comparison, std::string_view command);
nlohmann::ordered_json RelationsJson(const Comparison& comparison);

/// One line: "headroom: 4.2 of 8.3 ms are left at begin of reaching(right_hand, milk)", or "".
std::string HeadroomText(const Comparison& comparison);

/// Where events lie to each other otherwise than the golden says: of every two pairs that share
/// their entities and of which at least one differs. Two boundaries count as equal when they are no
/// further apart than the tolerance.
std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings);

}  // namespace prehend::harness
