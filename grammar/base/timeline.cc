// SPDX-License-Identifier: Apache-2.0
// The canonical order of events, and their labels.
#include "grammar/base/timeline.h"

#include <algorithm>
#include <tuple>

namespace prehend::grammar {

std::string NamedEvent::Label() const {
  std::string label = event + "(";
  bool first = true;
  for (const Role& role : roles) {
    if (role.name == "style") continue;
    if (!first) label += ", ";
    label += role.value;
    first = false;
  }
  return label + ")";
}

bool ComesBefore(const NamedEvent& a, const NamedEvent& b) {
  return std::tie(a.interval.begin, a.interval.end, a.event, a.roles) <
         std::tie(b.interval.begin, b.interval.end, b.event, b.roles);
}

void Sort(Timeline& timeline) { std::ranges::stable_sort(timeline.events, ComesBefore); }

IntervalSet Union(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](Interval a, Interval b) { return a.begin < b.begin; });
  IntervalSet set;
  for (const Interval interval : intervals) {
    if (interval.begin >= interval.end) continue;
    if (!set.empty() && interval.begin <= set.back().end) {
      set.back().end = std::max(set.back().end, interval.end);
    } else {
      set.push_back(interval);
    }
  }
  return set;
}

IntervalSet Without(Interval whole, const IntervalSet& parts) {
  IntervalSet left;
  for (const Interval part : parts) {
    if (part.end <= whole.begin) continue;
    if (part.begin >= whole.end) break;
    if (part.begin > whole.begin) left.push_back({whole.begin, part.begin});
    whole.begin = part.end;
    if (whole.begin >= whole.end) return left;
  }
  if (whole.begin < whole.end) left.push_back(whole);
  return left;
}

}  // namespace prehend::grammar
