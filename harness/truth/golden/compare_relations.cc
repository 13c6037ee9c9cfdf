// SPDX-License-Identifier: Apache-2.0
// How events lie to each other, where that differs from the golden. Boundaries jitter by a frame or
// two, and with them relations like `meets`; so a relation has changed only if some boundary of one
// event went past one of the other by more than the tolerance. Tested by
// tests/harness/truth/golden/compare_test.cc
#include <algorithm>
#include <cstdlib>

#include "grammar/base/allen.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

/// Values of the roles, sorted; attributes are left out.
std::vector<std::string> Entities(const NamedEvent& event) {
  std::vector<std::string> entities;
  for (const auto& role : event.roles) {
    if (!IsAttribute(role)) entities.push_back(role.value);
  }
  std::ranges::sort(entities);
  return entities;
}

/// Both sides exist, each in one piece.
bool IsWholePair(const Pairing& pairing) {
  return pairing.expected && pairing.actual && pairing.pieces.empty();
}

/// Whether two boundaries changed their order, and lie clearly apart in one of the timelines.
bool Swapped(Tick expected_gap, Tick actual_gap, Tick tolerance) {
  const auto sign = [](Tick gap) { return (gap > 0) - (gap < 0); };
  return sign(expected_gap) != sign(actual_gap) &&
         std::max(std::abs(expected_gap), std::abs(actual_gap)) > tolerance;
}

bool ClearlyChanged(const Pairing& p, const Pairing& q) {
  const Tick tolerance = std::max(p.tolerance, q.tolerance);
  for (const auto of_p : {&Interval::begin, &Interval::end}) {
    for (const auto of_q : {&Interval::begin, &Interval::end}) {
      if (Swapped(p.expected->interval.*of_p - q.expected->interval.*of_q,
                  p.actual->interval.*of_p - q.actual->interval.*of_q, tolerance))
        return true;
    }
  }
  return false;
}

std::string Relation(const NamedEvent& a, const NamedEvent& b) {
  return std::string(
      grammar::kAllenNames[static_cast<std::size_t>(grammar::Relate(a.interval, b.interval))]);
}

}  // namespace

std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings) {
  std::vector<RelationChange> changes;
  for (std::size_t i = 0; i < pairings.size(); ++i) {
    for (std::size_t j = i + 1; j < pairings.size(); ++j) {
      const Pairing &p = pairings[i], &q = pairings[j];
      if (!IsWholePair(p) || !IsWholePair(q)) continue;
      if (p.agreement == LineVerdict::kMatched && q.agreement == LineVerdict::kMatched) continue;
      if (Entities(*p.expected) != Entities(*q.expected) || !ClearlyChanged(p, q)) continue;
      changes.push_back({p.expected->Label(), q.expected->Label(),
                         Relation(*p.expected, *q.expected), Relation(*p.actual, *q.actual)});
    }
  }
  return changes;
}

}  // namespace prehend::truth
