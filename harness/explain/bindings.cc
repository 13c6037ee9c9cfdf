// SPDX-License-Identifier: Apache-2.0
// See harness/explain/bindings.h. Tested by tests/harness/explain_test.cc
#include "harness/explain/bindings.h"

#include <algorithm>

namespace prehend::harness::explain {
namespace {

using grammar::Binding;
using grammar::Hindsight;
using grammar::kNone;

// Fills the open roles from `role` on with everybody whose class fits.
void Fill(Hindsight& past, int rule, Binding& entities, std::size_t role, std::vector<int>& lanes) {
  const std::size_t roles = past.program().events[rule].roles.size();
  if (lanes.size() >= kMostBindings) return;
  if (role == roles) {
    const int lane = past.LaneOf(rule, entities);
    if (lane != kNone && std::find(lanes.begin(), lanes.end(), lane) == lanes.end())
      lanes.push_back(lane);
    return;
  }
  if (entities[role] != kNone) return Fill(past, rule, entities, role + 1, lanes);
  for (int entity = 0; entity < static_cast<int>(past.cast().entities.size()); ++entity) {
    if (std::find(entities.begin(), entities.end(), entity) != entities.end()) continue;
    entities[role] = entity;
    Fill(past, rule, entities, role + 1, lanes);
    entities[role] = kNone;
  }
}

}  // namespace

std::vector<int> BindingsThatFit(Hindsight& past, int rule, const Binding& wanted) {
  const grammar::Rule& asked = past.program().events[rule];
  std::vector<int> lanes;
  for (const int lane : past.LanesOf(rule)) {
    const Binding& entities = past.At(lane).entities;
    const auto fits = [&](const Binding& open) {
      for (std::size_t i = 0; i < asked.roles.size(); ++i) {
        if (open[i] != kNone && open[i] != entities[i]) return false;
      }
      return true;
    };
    const bool either_way = asked.symmetric && fits({wanted[1], wanted[0], wanted[2], wanted[3]});
    if (lanes.size() < kMostBindings && (fits(wanted) || either_way)) lanes.push_back(lane);
  }
  Binding entities = wanted;
  if (lanes.empty()) Fill(past, rule, entities, 0, lanes);
  return lanes;
}

}  // namespace prehend::harness::explain
