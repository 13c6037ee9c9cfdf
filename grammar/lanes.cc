// SPDX-License-Identifier: Apache-2.0
#include "grammar/lanes.h"

#include <algorithm>
#include <numeric>

namespace prehend::grammar {
namespace {

// More bindings than this are a mistake in the grammar or need another machine: about 400 bytes each.
constexpr int kMaxLanes = 1'000'000;

}  // namespace

std::size_t Lanes::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = static_cast<std::uint64_t>(key.rule) + 1;
  for (const int entity : key.entities) {
    hash = (hash ^ static_cast<std::uint32_t>(entity)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 32;
  }
  return static_cast<std::size_t>(hash);
}

Lanes::Lanes(const Program& program, const Cast& cast)
    : program_(program), cast_(cast), guarded_(program.events.size()), name_rank_(cast.entities.size()) {
  for (const int index : program.schedule) {
    const Rule& rule = program.events[index];
    if (rule.guard != kNone) guarded_[rule.references[rule.guard].rule].push_back(index);
  }
  for (const Rule& rule : program.events) {
    std::vector<std::vector<bool>>& roles = fits_.emplace_back();
    for (const RuleRole& role : rule.roles) {
      std::vector<bool>& entities = roles.emplace_back();
      for (std::size_t e = 0; e < cast.entities.size(); ++e) {
        entities.push_back(IsA(static_cast<int>(e), role.class_name));
      }
    }
  }
  std::vector<int> by_name(cast.entities.size());
  std::iota(by_name.begin(), by_name.end(), 0);
  std::stable_sort(by_name.begin(), by_name.end(),
                   [&](int a, int b) { return cast.entities[a].name < cast.entities[b].name; });
  for (std::size_t i = 0; i < by_name.size(); ++i) name_rank_[by_name[i]] = static_cast<int>(i);
}

bool Lanes::IsA(int entity, const std::string& class_name) const {
  const std::vector<std::string>& classes = cast_.entities[entity].classes;
  return std::find(classes.begin(), classes.end(), class_name) != classes.end();
}

void Lanes::BindUnguarded() {
  for (const int rule : program_.schedule) {
    if (program_.events[rule].form == Form::kTouching || program_.events[rule].guard != kNone) continue;
    double bindings = 1;
    for (const std::vector<bool>& role : fits_[rule]) {
      bindings *= static_cast<double>(std::count(role.begin(), role.end(), true));
    }
    if (bindings > kMaxLanes) {
      too_many_ = true;
      return;
    }
    Binding entities = kUnbound;
    BindRest(rule, entities, 0, kNone);
  }
}

// Fills in the roles from `role` on that are still free, in all ways that fit.
void Lanes::BindRest(int rule, Binding& entities, std::size_t role, int guard) {
  if (too_many_) return;
  if (role == program_.events[rule].roles.size()) {
    const int made = Ensure(rule, entities);
    if (made == kNone || guard == kNone) return;
    std::vector<int>& dependents = lanes_[guard].dependents;
    if (std::find(dependents.begin(), dependents.end(), made) != dependents.end()) return;
    dependents.push_back(made);
    if (program_.events[rule].form == Form::kAny) lanes_[made].members.push_back(guard);
    return;
  }
  if (entities[role] != kNobody) {
    BindRest(rule, entities, role + 1, guard);
    return;
  }
  for (std::size_t e = 0; e < cast_.entities.size(); ++e) {
    if (!fits_[rule][role][e]) continue;
    if (std::find(entities.begin(), entities.end(), static_cast<int>(e)) != entities.end()) continue;
    entities[role] = static_cast<int>(e);
    BindRest(rule, entities, role + 1, guard);
    entities[role] = kNobody;
  }
}

Binding Lanes::Canonical(const Rule& rule, Binding entities) const {
  if (rule.symmetric && name_rank_[entities[1]] < name_rank_[entities[0]]) std::swap(entities[0], entities[1]);
  return entities;
}

int Lanes::Find(int rule, const Binding& entities) const {
  const auto found = index_.find({rule, Canonical(program_.events[rule], entities)});
  return found == index_.end() ? kNone : found->second;
}

bool Lanes::Fits(int rule, const Binding& entities, std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (!fits_[rule][i][entities[i]]) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (entities[i] == entities[j]) return false;
    }
  }
  return true;
}

int Lanes::Ensure(int rule, const Binding& entities) {
  const Rule& r = program_.events[rule];
  if (!Fits(rule, entities, r.roles.size())) return kNone;
  const Key key{rule, Canonical(r, entities)};
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  if (size() >= kMaxLanes) {
    too_many_ = true;
    return kNone;
  }
  const int index = size();
  index_.emplace(key, index);
  Lane& lane = lanes_.emplace_back();
  lane.rule = rule;
  lane.entities = key.entities;
  lane.references.assign(r.references.size(), kNone);
  lane.anchors.assign(3 * r.anchors.size(), 0);
  lane.parts.resize(r.composition.parts.size());
  MakeDependents(index);
  return index;
}

// For every rule guarded by this lane's rule: its roles that the guard names are settled, the rest are free.
void Lanes::MakeDependents(int lane) {
  const int guard_rule = lanes_[lane].rule;
  const bool both_orders = program_.events[guard_rule].symmetric;
  for (const int rule : guarded_[guard_rule]) {
    const Rule& r = program_.events[rule];
    const Binding& mapping = r.references[r.guard].roles;
    for (int order = 0; order < (both_orders ? 2 : 1); ++order) {
      Binding guard_entities = lanes_[lane].entities;
      if (order == 1) std::swap(guard_entities[0], guard_entities[1]);
      Binding entities = kUnbound;
      bool fits = true;
      for (std::size_t i = 0; i < program_.events[guard_rule].roles.size(); ++i) {
        if (mapping[i] == kNone) continue;
        entities[mapping[i]] = guard_entities[i];
        fits = fits && fits_[rule][mapping[i]][guard_entities[i]];
      }
      if (fits) BindRest(rule, entities, 0, lane);
    }
  }
}

int Lanes::Resolve(Lane& lane, int slot) {
  int& target = lane.references[slot];
  if (target != kNone) return target;
  const Reference& reference = program_.events[lane.rule].references[slot];
  const Rule& rule = program_.events[reference.rule];
  Binding entities = kUnbound;
  for (std::size_t i = 0; i < rule.roles.size(); ++i) entities[i] = lane.entities[reference.roles[i]];
  return target = Find(reference.rule, entities);
}

Kleene Lanes::TruthAt(int index, FrameNumber frame) const {
  if (index == kNone) return Kleene::kFalse;
  const Lane& lane = lanes_[index];
  if (lane.awake && frame >= lane.known) return Kleene::kUnknown;
  if (lane.open && lane.certain && frame >= lane.begin.frame) return Kleene::kTrue;
  for (auto span = lane.past.rbegin(); span != lane.past.rend(); ++span) {
    if (frame >= span->begin.frame && frame < span->end.frame) return Kleene::kTrue;
  }
  return Kleene::kFalse;
}

Kleene Lanes::BeginsAt(int index, FrameNumber frame) const {
  if (index == kNone) return Kleene::kFalse;
  const Lane& lane = lanes_[index];
  if (lane.awake && frame >= lane.known) return Kleene::kUnknown;
  if (lane.open && lane.certain && frame == lane.begin.frame) return Kleene::kTrue;
  return Known(std::any_of(lane.past.rbegin(), lane.past.rend(),
                           [&](const Span& span) { return span.begin.frame == frame; }));
}

Kleene Lanes::EndsAt(int index, FrameNumber frame) const {
  if (index == kNone) return Kleene::kFalse;
  const Lane& lane = lanes_[index];
  if (lane.awake && frame >= lane.known) return Kleene::kUnknown;
  return Known(std::any_of(lane.past.rbegin(), lane.past.rend(),
                           [&](const Span& span) { return span.end.frame == frame; }));
}

}  // namespace prehend::grammar
