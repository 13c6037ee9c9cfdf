// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/bindings.h"

#include <algorithm>

namespace prehend::show {
namespace {

using grammar::Binding;
using grammar::InstanceId;
using grammar::kNone;
using grammar::ReplayMonitor;
using grammar::RuleId;

// Fills the open roles from `role` on with everybody whose class fits.
void Fill(ReplayMonitor& past, RuleId rule, Binding& entities, std::size_t role,
          std::vector<InstanceId>& instances) {
  const std::size_t roles = past.program().rules[rule].roles.size();
  if (instances.size() >= kMaxBindings) return;
  if (role == roles) {
    const InstanceId instance = past.InstanceOf(rule, entities);
    if (instance != kNone &&
        std::find(instances.begin(), instances.end(), instance) == instances.end())
      instances.push_back(instance);
    return;
  }
  if (entities[role] != kNone) return Fill(past, rule, entities, role + 1, instances);
  for (int entity = 0; entity < static_cast<int>(past.entity_table().entities.size()); ++entity) {
    if (std::find(entities.begin(), entities.end(), entity) != entities.end()) continue;
    entities[role] = entity;
    Fill(past, rule, entities, role + 1, instances);
    entities[role] = kNone;
  }
}

}  // namespace

std::vector<InstanceId> BindingsThatFit(ReplayMonitor& past, RuleId rule, const Binding& wanted) {
  const grammar::Rule& asked = past.program().rules[rule];
  std::vector<InstanceId> instances;
  for (const InstanceId instance : past.InstancesOf(rule)) {
    const Binding& entities = past.EntitiesOf(instance);
    const auto fits = [&](const Binding& open) {
      for (std::size_t i = 0; i < asked.roles.size(); ++i) {
        if (open[i] != kNone && open[i] != entities[i]) return false;
      }
      return true;
    };
    const bool either_way = asked.symmetric && fits({wanted[1], wanted[0], wanted[2], wanted[3]});
    if (instances.size() < kMaxBindings && (fits(wanted) || either_way))
      instances.push_back(instance);
  }
  Binding entities = wanted;
  if (instances.empty()) Fill(past, rule, entities, 0, instances);
  return instances;
}

}  // namespace prehend::show
