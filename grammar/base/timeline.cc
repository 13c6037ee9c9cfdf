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

}  // namespace prehend::grammar
