// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine/instances.h"

#include <algorithm>
#include <numeric>

namespace prehend::grammar {
namespace {

// More bindings than this are a mistake in the grammar or need another machine: see docs/speed.md.
constexpr int kMaxLanes = 1'000'000;

}  // namespace

Lanes::Lanes(const Program& program, const EntityTable& entity_table)
    : program_(program),
      entity_table_(entity_table),
      guarded_(program.events.size()),
      pose_watchers_(entity_table.entities.size()),
      grip_watchers_(entity_table.entities.size()),
      name_rank_(entity_table.entities.size()) {
  for (const int index : program.schedule) {
    const Rule& rule = program.events[index];
    // Compositions are made when a part has an interval for them.
    if (rule.guard != kNone && rule.form != Form::kCompose)
      guarded_[rule.references[rule.guard].rule].push_back(index);
  }
  for (const Rule& rule : program.events) {
    symmetric_.push_back(rule.symmetric ? 1 : 0);
    std::vector<std::vector<bool>>& roles = fits_.emplace_back();
    for (const RuleRole& role : rule.roles) {
      std::vector<bool>& entities = roles.emplace_back();
      for (std::size_t e = 0; e < entity_table.entities.size(); ++e) {
        entities.push_back(IsA(static_cast<int>(e), role.class_name));
      }
    }
  }
  std::vector<int> by_name(entity_table.entities.size());
  std::iota(by_name.begin(), by_name.end(), 0);
  std::stable_sort(by_name.begin(), by_name.end(), [&](int a, int b) {
    return entity_table.entities[a].name < entity_table.entities[b].name;
  });
  for (std::size_t i = 0; i < by_name.size(); ++i) name_rank_[by_name[i]] = static_cast<int>(i);
}

bool Lanes::IsA(int entity, const std::string& class_name) const {
  const std::vector<std::string>& classes = entity_table_.entities[entity].classes;
  return std::find(classes.begin(), classes.end(), class_name) != classes.end();
}

void Lanes::BindUnguarded() {
  for (const int rule : program_.schedule) {
    if (program_.events[rule].form == Form::kTouching || program_.events[rule].guard != kNone)
      continue;
    double bindings = 1;
    for (const std::vector<bool>& role : fits_[rule]) {
      bindings *= static_cast<double>(std::count(role.begin(), role.end(), true));
    }
    if (bindings > kMaxLanes) {
      too_many_ = rule;
      return;
    }
    Binding entities = kUnbound;
    BindRest(rule, entities, 0, kNone, nullptr);
  }
}

std::string Lanes::WhyTooMany() const {
  const Rule& rule = program_.events[too_many_];
  std::string roles;
  std::string counts;
  for (std::size_t i = 0; i < rule.roles.size(); ++i) {
    const std::vector<bool>& fits = fits_[too_many_][i];
    const std::string comma = i == 0 ? "" : ", ";
    roles += comma + rule.roles[i].name + ": " + rule.roles[i].class_name;
    counts += comma + std::to_string(std::count(fits.begin(), fits.end(), true)) + " for " +
              rule.roles[i].name;
  }
  return "more than " + std::to_string(kMaxLanes) + " bindings with those of '" + rule.name + "(" +
         roles + ")': there are " + counts + "; give the roles narrower classes";
}

void Lanes::EnsureAll(int rule, Binding entities, std::vector<int>& made) {
  BindRest(rule, entities, 0, kNone, &made);
}

// Fills in the roles from `role` on that are still free, in all ways that fit.
void Lanes::BindRest(int rule, Binding& entities, std::size_t role, int guard,
                     std::vector<int>* made) {
  if (TooMany()) return;
  if (role == program_.events[rule].roles.size()) {
    if (Canonical(rule, entities).entities != entities)
      return;  // of a symmetric pair, the other order is what counts
    const int lane = Ensure(rule, entities);
    if (lane == kNone || made == nullptr) return;
    if (guard != kNone) LinkToGuard(lane, guard);
    made->push_back(lane);
    return;
  }
  if (entities[role] != kNoEntity) {
    BindRest(rule, entities, role + 1, guard, made);
    return;
  }
  for (std::size_t e = 0; e < entity_table_.entities.size(); ++e) {
    if (!fits_[rule][role][e]) continue;
    if (std::find(entities.begin(), entities.end(), static_cast<int>(e)) != entities.end())
      continue;
    entities[role] = static_cast<int>(e);
    BindRest(rule, entities, role + 1, guard, made);
    entities[role] = kNoEntity;
  }
}

bool Lanes::Fits(int rule, const Binding& entities) const {
  for (std::size_t i = 0; i < program_.events[rule].roles.size(); ++i) {
    if (!fits_[rule][i][entities[i]]) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (entities[i] == entities[j]) return false;
    }
  }
  return true;
}

int Lanes::Make(const LaneKey& key) {
  if (!Fits(key.rule, key.entities)) return kNone;
  if (in_use() >= kMaxLanes) {
    too_many_ = key.rule;
    return kNone;
  }
  if (free_.empty()) {
    free_.push_back(size());
    lanes_.PushBack();
  }
  Lane& lane = lanes_[free_.back()];
  lane.index = free_.back();
  free_.pop_back();
  lane.rule = key.rule;
  lane.entities = key.entities;
  const Rule& r = program_.events[key.rule];
  lane.references.assign(r.references.size(), kNone);
  lane.anchors.assign(3 * r.anchors.size(), 0);
  lane.parts.resize(r.composition.parts.size());
  if (key.rule == kTouchingRule) {
    touches_.Insert(lane.index, PairKey(key.entities[0], key.entities[1]));
  } else {
    index_.Insert(lane.index, key);
  }
  WatchEntities(lane);
  return lane.index;
}

// For every rule guarded by this lane's rule: its roles that the guard names are settled, the rest
// are free.
void Lanes::MakeDependents(int lane, std::vector<int>& made) {
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
      if (fits) BindRest(rule, entities, 0, lane, &made);
    }
  }
  lanes_[lane].dependents_made = true;
}

void Lanes::LinkToGuard(int index, int guard) {
  Lane& lane = lanes_[index];
  const Rule& rule = program_.events[lane.rule];
  if (rule.form == Form::kAny) {
    if (std::find(lane.members.begin(), lane.members.end(), guard) != lane.members.end()) return;
    lane.members.push_back(guard);
    lanes_[guard].watchers.push_back({.lane = index, .guarded = true});
  } else if (lane.references[rule.guard] == kNone) {
    Refer(lane, rule.guard, guard);
  }
}

// From now on the lane's reference `slot` is this one, whose changes wake it.
void Lanes::Refer(Lane& lane, int slot, int target) {
  lane.references[slot] = target;
  if (target == kNone) return;
  const Rule& rule = program_.events[lane.rule];
  const MeasuredPart& part = rule.measured;
  Lane& watched = lanes_[target];
  const bool guarded = slot == rule.guard, opened = slot == rule.opened_by,
             instant = part.instant && slot == part.touch;
  watched.watchers.push_back(
      {.lane = lane.index,
       .guarded = guarded,
       .guarded_begin = guarded && rule.guarded_begin,
       .opened = opened,
       .turned = instant && part.first != kNone && watched.entities[0] != lane.entities[part.first],
       .press = rule.watches_press,
       .instant = instant ? &part : nullptr,
       .hand = instant && part.hand != kNone ? lane.entities[part.hand] : kNoEntity});
  if (opened && !watched.awake) lane.moment = -1;  // else it may be on its way
}

void Lanes::WatchEntities(Lane& lane) {
  const Rule& rule = program_.events[lane.rule];
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (!rule.watches_pose[role] && !rule.watches_grip[role]) continue;
    std::vector<Watch>& watchers =
        (rule.watches_pose[role] ? pose_watchers_ : grip_watchers_)[lane.entities[role]];
    lane.watch_places[role] = static_cast<int>(watchers.size());
    watchers.push_back({lane.index, static_cast<int>(role)});
  }
}

void Lanes::UnwatchEntities(const Lane& lane) {
  const Rule& rule = program_.events[lane.rule];
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (!rule.watches_pose[role] && !rule.watches_grip[role]) continue;
    std::vector<Watch>& watchers =
        (rule.watches_pose[role] ? pose_watchers_ : grip_watchers_)[lane.entities[role]];
    const Watch last = watchers.back();
    watchers[lane.watch_places[role]] = last;
    lanes_[last.lane].watch_places[last.role] = lane.watch_places[role];
    watchers.pop_back();
  }
}

// Before `lane` is freed: it is no watcher any more, and has to be made again when its guard holds
// again.
void Lanes::Unlink(int index, int watcher, std::vector<int>& orphans) {
  Lane& lane = lanes_[index];
  std::erase_if(lane.watchers, [&](const Watcher& one) { return one.lane == watcher; });
  lane.dependents_made = false;
  if (lane.watchers.empty()) orphans.push_back(index);
}

void Lanes::Free(int index, std::vector<int>& orphans) {
  Lane& lane = lanes_[index];
  UnwatchEntities(lane);
  if (lane.rule == kTouchingRule) {
    touches_.Erase(PairKey(lane.entities[0], lane.entities[1]));
  } else {
    index_.Erase(lane);
  }
  for (const int reference : lane.references) {
    if (reference != kNone) Unlink(reference, index, orphans);
  }
  for (const int member : lane.members) Unlink(member, index, orphans);
  for (const Watcher& any : lane.watchers) std::erase(lanes_[any.lane].members, index);
  lane.members.clear();
  lane.watchers.clear();
  lane.past.Clear();
  lane.touches.Clear();
  lane.beyonds.Clear();
  lane.dependents_made = false;
  lane.told = Kleene::kFalse;
  lane.moment = kNever;
  lane.last_end = 0;
  lane.touched = -1;
  lane.style = kNoEntity;
  lane.rule = kNone;
  free_.push_back(index);
}

bool Lanes::GuardRests(const Lane& lane) const {
  const Rule& rule = program_.events[lane.rule];
  const auto rests = [&](int guard) { return !lanes_[guard].awake && !lanes_[guard].open; };
  if (rule.form == Form::kAny) return std::all_of(lane.members.begin(), lane.members.end(), rests);
  if (rule.guard == kNone) return false;
  const int guard = lane.references[rule.guard];
  return guard == kNone || rests(guard);
}

LaneKey Lanes::Referred(const Lane& lane, int slot) const {
  const Reference& reference = program_.events[lane.rule].references[slot];
  Binding entities = kUnbound;
  for (std::size_t i = 0; i < program_.events[reference.rule].roles.size(); ++i) {
    entities[i] = lane.entities[reference.roles[i]];
  }
  return Canonical(reference.rule, entities);
}

int Lanes::Resolve(Lane& lane, int slot) {
  if (lane.references[slot] != kNone) return lane.references[slot];
  const LaneKey key = Referred(lane, slot);
  Refer(lane, slot, Ensure(key.rule, key.entities));
  return lane.references[slot];
}

}  // namespace prehend::grammar
