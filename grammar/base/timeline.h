// SPDX-License-Identifier: Apache-2.0
// Events with names instead of numbers, in one canonical order: what is printed, stored and
// compared. Tested by tests/grammar/base/timeline_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::grammar {

struct Role {
  std::string name;  ///< as in the rule's head: hand, object, a, b, support; or an attribute: style
  std::string value;  ///< an entity's name, or the attribute's value
  friend auto operator<=>(const Role&, const Role&) = default;
};

/// `with force = force(hand, object)`: a number that the event carries.
struct NamedValue {
  std::string name;
  double value = 0;  ///< SI units
  std::string unit;  ///< "N", "m/s"; empty for a plain number
  friend bool operator==(const NamedValue&, const NamedValue&) = default;
};

struct NamedEvent {
  std::string event;
  std::vector<Role> roles;  ///< in the order of the rule's head, attributes last
  Interval interval;
  Tick decided = 0;
  bool open_end = false;  ///< closed by the end of the episode
  std::vector<NamedValue> values = {};

  /// "reaching(right_hand, milk)"; attributes are left out.
  std::string Label() const;
};

struct Timeline {
  Tick ticks_per_second = 480;
  std::vector<NamedEvent> events;  ///< sorted by (begin, end, event, roles)
};

/// The canonical order of timelines: (begin, end, event, roles).
bool ComesBefore(const NamedEvent& a, const NamedEvent& b);

/// Sorts into the canonical order.
void Sort(Timeline& timeline);

// Sets of ticks as sorted lists of disjoint half-open intervals. Tested by
// tests/grammar/base/interval_set_test.cc

/// Sorted, disjoint, not touching, none empty: what Union() makes.
using IntervalSet = std::vector<Interval>;

IntervalSet Union(std::vector<Interval> intervals);

/// What is left of `whole` without `parts`.
IntervalSet Without(Interval whole, const IntervalSet& parts);

}  // namespace prehend::grammar
