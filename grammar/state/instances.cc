// SPDX-License-Identifier: Apache-2.0
// How instances are made, linked to what they ask about, and freed.
#include "grammar/state/instances.h"

#include <algorithm>
#include <numeric>

namespace prehend::grammar {
namespace {

// More bindings than this are a mistake in the grammar or need another machine: see docs/speed.md.
constexpr int kMaxInstances = 1'000'000;

FormState StateFor(Form form) {
  switch (form) {
    case Form::kTouching:
      return TouchingState();
    case Form::kAny:
      return AnyState();
    case Form::kUntilSince:
      return UntilSinceState();
    case Form::kCompose:
      return ComposeState();
    case Form::kFromTo:
      return FromToState();
    case Form::kWhile:
    case Form::kRestOf:
      break;
  }
  return NoState();
}

}  // namespace

// So that the condition is `truth`.
void RuleInstances::CollectNeeds(const Program& program, NodeId index, bool truth,
                                 std::vector<Need>& needs) {
  const Node& node = program.nodes[index];
  if (node.op == Op::kHolds) needs.push_back({node.slot, truth});
  if (node.op == Op::kNot) CollectNeeds(program, node.args[0], !truth, needs);
  if (node.op == Op::kBegins && truth) CollectNeeds(program, node.args[0], true, needs);
  if (node.op != (truth ? Op::kAnd : Op::kOr)) return;
  CollectNeeds(program, node.args[0], truth, needs);
  CollectNeeds(program, node.args[1], truth, needs);
}

void TouchingState::Reset() {
  touched = -1;
  crossings.Clear();
  touches.Clear();
}

RuleInstances::RuleInstances(const Program& program, const EntityTable& entity_table,
                             std::function<FrameNumber(InstanceId)> known_of)
    : program_(program),
      entity_table_(entity_table),
      known_of_(std::move(known_of)),
      guarded_(program.rules.size()),
      pose_watchers_(entity_table.entities.size()),
      grip_watchers_(entity_table.entities.size()),
      name_rank_(entity_table.entities.size()) {
  for (const RuleId index : program.schedule) {
    const Rule& rule = program.rules[index];
    // Compositions that nobody asks for are made when a part has an interval for them.
    const auto* composition = rule.If<ComposeRule>();
    if (composition != nullptr && rule.referenced) {
      for (std::size_t part = 0; part < composition->parts.size(); ++part)
        if (composition->MayBegin(part))
          guarded_[rule.references[composition->parts[part]].rule].push_back(
              {index, composition->parts[part]});
    } else if (rule.guard != kNone && composition == nullptr) {
      guarded_[rule.references[rule.guard].rule].push_back({index, rule.guard});
    }
  }
  for (const Rule& rule : program.rules) {
    symmetric_.push_back(rule.symmetric ? 1 : 0);
    std::vector<Need>& needs = needs_[needs_.push_back({})];
    NodeId needed;
    if (const auto* holds = rule.If<WhileRule>(); holds != nullptr && holds->at_least == 0)
      needed = holds->condition;
    if (const auto* from_to = rule.If<FromToRule>()) needed = from_to->from;
    if (const auto* looks_back = rule.If<UntilSinceRule>()) needed = looks_back->since;
    if (needed != kNone && program.waits) CollectNeeds(program, needed, true, needs);
    std::vector<std::vector<bool>>& roles = fits_[fits_.push_back({})];
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

bool RuleInstances::IsA(int entity, const std::string& class_name) const {
  const std::vector<std::string>& classes = entity_table_.entities[entity].classes;
  return std::find(classes.begin(), classes.end(), class_name) != classes.end();
}

void RuleInstances::BindUnguarded() {
  for (const RuleId rule : program_.schedule) {
    if (program_.rules[rule].form() == Form::kTouching || program_.rules[rule].guard != kNone)
      continue;
    double bindings = 1;
    for (const std::vector<bool>& role : fits_[rule]) {
      bindings *= static_cast<double>(std::count(role.begin(), role.end(), true));
    }
    if (bindings > kMaxInstances) {
      too_many_ = rule;
      return;
    }
    Binding entities = kUnbound;
    BindRest(rule, entities, 0, {}, nullptr);
  }
}

std::string RuleInstances::WhyTooMany() const {
  const Rule& rule = program_.rules[too_many_];
  std::string roles;
  std::string counts;
  for (std::size_t i = 0; i < rule.roles.size(); ++i) {
    const std::vector<bool>& fits = fits_[too_many_][i];
    const std::string comma = i == 0 ? "" : ", ";
    roles += comma + rule.roles[i].name + ": " + rule.roles[i].class_name;
    counts += comma + std::to_string(std::count(fits.begin(), fits.end(), true)) + " for " +
              rule.roles[i].name;
  }
  return "more than " + std::to_string(kMaxInstances) + " bindings with those of '" + rule.name +
         "(" + roles + ")': there are " + counts + "; give the roles narrower classes";
}

void RuleInstances::EnsureAll(RuleId rule, Binding entities, std::vector<InstanceId>& made) {
  BindRest(rule, entities, 0, {}, &made);
}

// Fills in the roles from `role` on that are still free, in all ways that fit.
void RuleInstances::BindRest(RuleId rule, Binding& entities, std::size_t role, Guard guard,
                             std::vector<InstanceId>* made) {
  if (TooMany()) return;
  if (role == program_.rules[rule].roles.size()) {
    if (Canonical(rule, entities).entities != entities)
      return;  // of a symmetric pair, the other order is what counts
    const InstanceId instance = Ensure(rule, entities);
    if (instance == kNone || made == nullptr) return;
    if (guard.instance != kNone) LinkToGuard(instance, guard);
    made->push_back(instance);
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

bool RuleInstances::Fits(RuleId rule, const Binding& entities) const {
  for (std::size_t i = 0; i < program_.rules[rule].roles.size(); ++i) {
    if (!fits_[rule][i][entities[i]]) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (entities[i] == entities[j]) return false;
    }
  }
  return true;
}

// A place that is free, with a state for this form.
RuleInstance& RuleInstances::UnusedFor(Form form) {
  FormState fresh = StateFor(form);
  std::vector<InstanceId>& free = free_[fresh.index()];
  if (free.empty()) {
    const InstanceId index = end_id();
    RuleInstance& instance = instances_.PushBack();
    instance.index = index;
    instance.of_form = std::move(fresh);
    return instance;
  }
  RuleInstance& instance = instances_[free.back()];
  free.pop_back();
  --free_count_;
  return instance;
}

InstanceId RuleInstances::Make(const InstanceKey& key) {
  if (!Fits(key.rule, key.entities)) return kNone;
  if (in_use() >= kMaxInstances) {
    too_many_ = key.rule;
    return kNone;
  }
  const Rule& r = program_.rules[key.rule];
  RuleInstance& instance = UnusedFor(r.form());
  instance.rule = key.rule;
  instance.entities = key.entities;
  instance.references.assign(r.references.size(), InstanceId());
  instance.anchors.assign(3 * r.anchors.size(), 0);
  if (const auto* composition = r.If<ComposeRule>())
    instance.As<ComposeState>().parts.resize(composition->parts.size());
  if (key.rule == kTouchingRule) {
    touches_.Insert(instance.index, PairKey(key.entities[0], key.entities[1]));
  } else {
    index_.Insert(instance.index, key);
  }
  WatchEntities(instance);
  return instance.index;
}

// For every rule guarded by this instance's rule: its roles that the guard names are settled, the
// rest are free.
void RuleInstances::MakeDependents(InstanceId instance, std::vector<InstanceId>& made) {
  const RuleId guard_rule = instances_[instance].rule;
  const bool both_orders = program_.rules[guard_rule].symmetric;
  for (const auto& [rule, slot] : guarded_[guard_rule]) {
    const Binding& mapping = program_.rules[rule].references[slot].roles;
    for (int order = 0; order < (both_orders ? 2 : 1); ++order) {
      Binding guard_entities = instances_[instance].entities;
      if (order == 1) std::swap(guard_entities[0], guard_entities[1]);
      Binding entities = kUnbound;
      bool fits = true;
      for (std::size_t i = 0; i < program_.rules[guard_rule].roles.size(); ++i) {
        if (mapping[i] == kNone) continue;
        entities[mapping[i]] = guard_entities[i];
        fits = fits && fits_[rule][mapping[i]][guard_entities[i]];
      }
      if (fits) BindRest(rule, entities, 0, {.instance = instance, .slot = slot}, &made);
    }
  }
  instances_[instance].dependents_made = true;
}

void RuleInstances::LinkToGuard(InstanceId index, Guard guard) {
  RuleInstance& instance = instances_[index];
  const Rule& rule = program_.rules[instance.rule];
  if (rule.form() == Form::kAny) {
    std::vector<InstanceId>& members = instance.As<AnyState>().members;
    // `any Hand` of a symmetric event: whichever way round, it is one binding.
    const bool is_narrowed =
        rule.As<AnyRule>().one == kNone && program_.rules[instances_[guard.instance].rule].hidden;
    const auto counted = [&](InstanceId member) {
      const RuleInstance& one = instances_[member];
      return is_narrowed ? Referred(one, 0).entities : one.entities;
    };
    if (std::ranges::count(members, counted(guard.instance), counted) > 0) return;
    members.push_back(guard.instance);
    instances_[guard.instance].watchers.push_back(
        {.instance = index, .kind = Watcher::Kind::kGuard});
  } else if (instance.references[guard.slot] == kNone) {
    Refer(instance, guard.slot, guard.instance);
  }
}

// From now on the instance's reference `slot` is this one, whose changes wake it.
void RuleInstances::Refer(RuleInstance& instance, int slot, InstanceId target) {
  instance.references[slot] = target;
  if (target == kNone) return;
  const Rule& rule = program_.rules[instance.rule];
  const MeasuredPart& part = rule.measured;
  RuleInstance& watched = instances_[target];
  const bool opened = slot == rule.opened_by;
  const bool measured = part.instant && slot == part.touch;
  using Kind = Watcher::Kind;
  watched.watchers.push_back(
      {.instance = instance.index,
       .kind = measured             ? Kind::kMeasured
               : slot != rule.guard ? Kind::kCondition
               : rule.guarded_begin ? Kind::kBeginGuard
                                    : Kind::kGuard,
       .opened = opened,
       .swapped =
           measured && part.first != kNone && watched.entities[0] != instance.entities[part.first],
       .thresholds = rule.watches_press,
       .measured = measured ? &part : nullptr,
       .hand = measured && part.hand != kNone ? instance.entities[part.hand] : kNoEntity});
  if (opened && !watched.awake) instance.moment = -1;  // else it may be on its way
}

void RuleInstances::WatchEntities(RuleInstance& instance) {
  const Rule& rule = program_.rules[instance.rule];
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (!rule.watches_pose[role] && !rule.watches_grip[role]) continue;
    std::vector<Watch>& watchers =
        (rule.watches_pose[role] ? pose_watchers_ : grip_watchers_)[instance.entities[role]];
    instance.watch_places[role] = static_cast<int>(watchers.size());
    const int other = rule.roles.size() == 2 ? instance.entities[1 - role] : kNone;
    watchers.push_back({instance.index, static_cast<int>(role), other});
  }
}

void RuleInstances::UnwatchEntities(const RuleInstance& instance) {
  const Rule& rule = program_.rules[instance.rule];
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (!rule.watches_pose[role] && !rule.watches_grip[role]) continue;
    std::vector<Watch>& watchers =
        (rule.watches_pose[role] ? pose_watchers_ : grip_watchers_)[instance.entities[role]];
    const Watch last = watchers.back();
    watchers[instance.watch_places[role]] = last;
    instances_[last.instance].watch_places[last.role] = instance.watch_places[role];
    watchers.pop_back();
  }
}

void RuleInstances::SetRest(const RuleInstance& instance, float rests_until_m) {
  const Rule& rule = program_.rules[instance.rule];
  for (std::size_t role = 0; role < rule.roles.size(); ++role)
    if (rule.watches_pose[role])
      pose_watchers_[instance.entities[role]][instance.watch_places[role]].rests_until_m =
          rests_until_m;
}

// Before `instance` is freed: it is no watcher any more, and has to be made again when its guard
// holds again.
void RuleInstances::Unlink(InstanceId index, InstanceId watcher, std::vector<InstanceId>& orphans) {
  RuleInstance& instance = instances_[index];
  std::erase_if(instance.watchers, [&](const Watcher& one) { return one.instance == watcher; });
  instance.dependents_made = false;
  if (instance.watchers.empty()) orphans.push_back(index);
}

void RuleInstances::Free(InstanceId index, std::vector<InstanceId>& orphans) {
  RuleInstance& instance = instances_[index];
  PREHEND_CHECK(!instance.awake && !instance.open && !instance.in_gap && instance.pending.empty());
  UnwatchEntities(instance);
  if (instance.rule == kTouchingRule) {
    touches_.Erase(PairKey(instance.entities[0], instance.entities[1]));
  } else {
    index_.Erase(instance);
  }
  for (const InstanceId reference : instance.references) {
    if (reference != kNone) Unlink(reference, index, orphans);
  }
  if (const auto* any = instance.If<AnyState>()) {
    for (const InstanceId member : any->members) Unlink(member, index, orphans);
  }
  for (const Watcher& watcher : instance.watchers) {
    auto* const any = instances_[watcher.instance].If<AnyState>();
    PREHEND_CHECK(any != nullptr);
    std::erase(any->members, index);
  }
  std::visit([](auto& state) { state.Reset(); }, instance.of_form);
  instance.watchers.clear();
  instance.past.Clear();
  instance.dependents_made = instance.awaited = instance.followed = instance.rests_apart = false;
  instance.reported = Kleene::kFalse;
  instance.moment = kNever;
  instance.style = kNoEntity;
  instance.rule = kNone;
  free_[instance.of_form.index()].push_back(index);
  ++free_count_;
}

bool RuleInstances::GuardRests(const RuleInstance& instance) const {
  const Rule& rule = program_.rules[instance.rule];
  const auto rests = [&](InstanceId guard) {
    return !instances_[guard].awake && !instances_[guard].open;
  };
  if (rule.form() == Form::kAny) return std::ranges::all_of(instance.As<AnyState>().members, rests);
  if (rule.guard == kNone) return false;
  if (rule.form() == Form::kCompose) {
    const auto& composition = rule.As<ComposeRule>();
    for (std::size_t i = 0; i < composition.parts.size(); ++i) {
      const InstanceId part = instance.references[composition.parts[i]];
      if (composition.MayBegin(i) && part != kNone && !rests(part)) return false;
    }
    return true;
  }
  const InstanceId guard = instance.references[rule.guard];
  return guard == kNone || rests(guard);
}

InstanceKey RuleInstances::Referred(const RuleInstance& instance, int slot) const {
  const Reference& reference = program_.rules[instance.rule].references[slot];
  Binding entities = kUnbound;
  for (std::size_t i = 0; i < program_.rules[reference.rule].roles.size(); ++i) {
    entities[i] = instance.entities[reference.roles[i]];
  }
  return Canonical(reference.rule, entities);
}

InstanceId RuleInstances::MakeReferred(RuleInstance& instance, int slot) {
  const InstanceKey key = Referred(instance, slot);
  if (!Fits(key.rule, key.entities)) return kNone;
  Refer(instance, slot, Ensure(key.rule, key.entities));
  return instance.references[slot];
}

// Seconds are rounded such that comparing ticks gives the same as comparing seconds.

RuleTicks TicksOf(const Rule& rule, const History& history) {
  RuleTicks ticks{.lasting = history.AtLeastTicks(rule.lasting_s)};
  if (rule.lasting_most_s >= 0) ticks.lasting_most = history.AtMostTicks(rule.lasting_most_s);
  if (const auto* composition = rule.If<ComposeRule>()) {
    if (composition->within_s > 0) ticks.within = history.AtMostTicks(composition->within_s);
    for (const ComposeRule::Clause& clause : composition->clauses)
      ticks.clauses.push_back(
          clause.In([&](double seconds) { return history.AtMostTicks(seconds); }));
  }
  if (const auto* any = rule.If<AnyRule>()) ticks.nearest = history.AtMostTicks(any->within_s);
  if (const auto* holds = rule.If<WhileRule>())
    ticks.bridging = history.AtMostTicks(holds->bridging_s);
  if (const auto* from_to = rule.If<FromToRule>(); from_to != nullptr && from_to->within_s >= 0) {
    ticks.in_time = history.AtMostTicks(from_to->within_s);
    ticks.within = from_to->absence ? history.AtLeastTicks(from_to->within_s) : ticks.in_time;
  }
  if (const auto* looks_back = rule.If<UntilSinceRule>()) {
    ticks.back = history.AtMostTicks(looks_back->back_s);
    if (const auto& approach = looks_back->approach) {
      ticks.idle = history.AtMostTicks(approach->idle_s);
      ticks.over = history.AtMostTicks(approach->over_s / 2);
      ticks.still = history.AtMostTicks(approach->still_s / 2);
    }
  }
  return ticks;
}

double LooksBack_s(const Rule& rule) {
  double back_s = 0;
  if (const auto* looks_back = rule.If<UntilSinceRule>()) {
    back_s += looks_back->back_s;
    if (looks_back->approach) back_s += looks_back->approach->looks_around_s();
  }
  // A requirement or an attribute is asked for where the run ended, when its gap is too long.
  if (const auto* holds = rule.If<WhileRule>();
      holds != nullptr && (rule.requirement != kNone || !rule.attributes.empty()))
    back_s += holds->bridging_s;
  return back_s;
}

}  // namespace prehend::grammar
