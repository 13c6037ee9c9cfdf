// SPDX-License-Identifier: Apache-2.0
// Construction, and when instances wake, rest and wait for others. See grammar/engine/engine.h for
// the whole algorithm.
#include "grammar/engine/engine.h"

#include <algorithm>
#include <span>

namespace prehend::grammar {
namespace {

constexpr double kUntilItIsBound_m = 1e30;  // farther than anything gets

// Entities must be in the entity table, ticks must rise, and each touch names its entities in
// order.

bool IsEntity(int entity, int entities) { return entity >= 0 && entity < entities; }

std::string_view WhyNoTouches(std::span<const Touch> touches, int entities) {
  const auto is_bad = [&](const Touch& touch) {
    return touch.a < 0 || touch.a >= touch.b || touch.b >= entities;
  };
  return std::ranges::any_of(touches, is_bad) ? "a frame has a touch of entities that are not in "
                                                "the entity table, or not in its order"
                                              : std::string_view();
}

}  // namespace

Engine::Engine(std::shared_ptr<const Program> program, EntityTable entity_table)
    : program_(std::move(program)),
      entity_table_(std::move(entity_table)),
      entity_count_(static_cast<int>(entity_table_.entities.size())),
      history_(entity_table_),
      instances_(*program_, entity_table_,
                 [this](InstanceId follower) { return KnownOf(follower); }),
      evaluator_(*program_, entity_table_, history_, instances_),
      thresholds_(program_->thresholds),
      recalls_touches_(program_->recalls_touches || program_->asks_touches),
      keeps_touches_(program_->asks_touches),
      looks_at_all_(std::ranges::any_of(
          program_->nodes,
          [](const Node& node) { return node.op == Op::kNearest || node.op == Op::kOwns; })),
      grips_(entity_table_.entities.size(), thresholds_.OfGrip(0)),
      awake_(program_->rules.size()),
      idle_(*program_, history_, instances_),
      past_(entity_table_.entities.size()) {
  bool any_rests = false;
  for (const Rule& rule : program_->rules) {
    rule_ticks_.push_back(grammar::TicksOf(rule, history_));
    past_.LookBack(rule, history_);
    nearness_.push_back(NearnessOf(rule));
    follows_.push_back(WhenItFollows(rule));
    skips_by_.push_back(SkipsBy(rule));
    const auto* from_to = rule.If<FromToRule>();
    begins_by_others_.push_back(from_to != nullptr && AsksOnlyOthers(from_to->from));
    const auto* looks_back = rule.If<UntilSinceRule>();
    leads_always_.push_back(looks_back != nullptr && IsUnknownUntilTheEnd(looks_back->since));
    any_rests = any_rests || nearness_.back() != kNone;
  }
  turns_.resize(program_->rules.size());
  may_rest_.resize(program_->rules.size());
  ahead_.resize(program_->rules.size());
  for (std::size_t turn = 0; turn < program_->schedule.size(); ++turn)
    turns_[program_->schedule[turn]] = static_cast<int>(turn);
  if (any_rests) history_.MeasureWays(entity_table_);
  instances_.BindUnguarded();
  for (InstanceId i(0); i < instances_.end_id(); ++i) Wake(i);
  if (instances_.TooMany()) error_ = instances_.WhyTooMany();
}

// The condition without which nothing of the rule begins or leads on, if entities must be near each
// other for it.
NodeId Engine::NearnessOf(const Rule& rule) const {
  NodeId condition;
  if (const auto* holds = rule.If<WhileRule>(); holds != nullptr && holds->at_least == 0)
    condition = holds->condition;
  if (const auto* looks_back = rule.If<UntilSinceRule>()) condition = looks_back->since;
  return condition != kNone && evaluator_.NeedsNearness(condition) ? condition : NodeId();
}

void Engine::Wake(InstanceId index) {
  RuleInstance& instance = instances_[index];
  if (instance.follows) StopWaiting(instance);
  if (instance.awake || instance.rule == kNone) return;
  instance.awake = true;
  instances_.RestNoMore(instance);
  instance.next = std::max<FrameNumber>(history_.now(), 0);
  if (auto* looks_back = instance.If<UntilSinceState>()) looks_back->approach_from = instance.next;
  const bool rested = instance.known == kNever;
  if (!instance.open || (instance.certain && !instance.in_gap) || rested)
    instance.known = instance.next;
  awake_[instance.rule].push_back(index);
  ++awake_count_;
}

// Who rests until entities have got somewhere is asked when one of them gets on, not as it
// trembles.
void Engine::WakeWatchers(int entity, const std::vector<Watch>& watchers, bool gets_on) {
  for (const Watch& watch : watchers) {
    const double rests_until_m = watch.rests_until_m;
    if (rests_until_m > 0 &&
        (!gets_on || rests_until_m > kUntilItIsBound_m / 2 ||
         (watch.other != kNone &&
          history_.Way_m(entity) + history_.Way_m(watch.other) < rests_until_m)))
      continue;  // most of them
    RuleInstance& instance = instances_[watch.instance];
    if (instance.awake || (rests_until_m > 0 && Ways_m(instance) < rests_until_m)) continue;
    if (rests_until_m > 0) instances_.RestNoMore(instance);
    if (log_ == nullptr && instances_.NeedsOneThatRests(instance)) continue;
    if (MayWake(instance)) {
      Wake(watch.instance);
    } else if (instances_.LacksItsGuard(instance)) {
      instances_.RestUntil_m(instance, kUntilItIsBound_m);
    }
  }
}

// An instance that is not open cannot begin while its guard rests, whatever else happens.
bool Engine::MayWake(const RuleInstance& instance) const {
  return instance.open || (MayBegin(instance) && !instances_.GuardRests(instance));
}

double Engine::Ways_m(const RuleInstance& instance) const {
  double ways_m = 0;
  for (std::size_t role = 0; role < RuleOf(instance).roles.size(); ++role)
    ways_m += history_.Way_m(instance.entities[role]);
  return ways_m;
}

// An instance whose entities are too far apart for its condition rests until they have got nearer:
// most pairs in a room have nothing to do with each other, though all of them move. So does one
// that is open, until they are too far apart.
bool Engine::RestsFarApart(RuleInstance& instance) {
  const NodeId condition = nearness_[instance.rule];
  if (condition == kNone || log_ != nullptr) return false;
  const auto* holds = RuleOf(instance).If<WhileRule>();
  if (instance.open && (holds == nullptr || holds->until != kNone)) return false;
  double apart_m = instance.open ? evaluator_.TrueFor_m(condition, instance, history_.now())
                                 : evaluator_.FalseFor_m(condition, instance, history_.now());
  if (apart_m <= 0) return false;
  for (std::size_t role = 0; role < RuleOf(instance).roles.size(); ++role)
    apart_m -= history_.Tremble_m(instance.entities[role]);
  if (apart_m > 0) instances_.RestUntil_m(instance, Ways_m(instance) + apart_m);
  return true;
}

// Whether what must be measured for this instance to begin is known. At the end of the episode all
// touches are over.
bool Engine::CanMeasure(const RuleInstance& instance) const {
  const MeasuredPart& part = RuleOf(instance).measured;
  return !part.is_empty() && !finishing_ &&
         (part.touch == kNone || instance.references[part.touch] != kNone);
}

// Whether the touch and the grip are now as the condition wants them.
bool Engine::IsMeasured(const RuleInstance& instance) const {
  const MeasuredPart& part = RuleOf(instance).measured;
  const int hand = part.hand == kNone ? kNoEntity : instance.entities[part.hand];
  if (part.touch == kNone) return part.grip.Fit(grips_[hand]);
  const RuleInstance& touch = instances_[instance.references[part.touch]];
  return IsMeasured(part, hand, touch,
                    part.first != kNone && touch.entities[0] != instance.entities[part.first]);
}

// A resting instance would find what it found before: what must be measured for it to begin is not,
// or nothing else matters and that is as it was.
bool Engine::SaysTheSame(const RuleInstance& instance) const {
  if (!CanMeasure(instance)) return false;
  if (instance.open)
    return RuleOf(instance).measured.whole && IsMeasured(instance) == !instance.in_gap;
  return !IsMeasured(instance);
}

bool Engine::MomentMayCome(const RuleInstance& instance) const {
  const Rule& rule = RuleOf(instance);
  if (rule.opened_by == kNone) return true;
  const InstanceId event = instance.references[rule.opened_by];
  if (event == kNone) return true;  // it has not asked yet, so nothing would wake it
  const FrameNumber now = history_.now();
  return (rule.opened_by_end ? instances_.EndsAt(event, now) : instances_.BeginsAt(event, now)) !=
         Kleene::kFalse;
}

// This instance's truth value changed. What that means to an instance that rests and watches it:
//
//   its touch, measured   its interval begins or ends here, or nothing happens
//   open                  it wakes, as it may end
//   a moment may come     it wakes, unless its guard rests; if this is the guard, it may begin
//   its guard has ended   it held up to the frame before, so it wakes for a moment that may still
//                         come in this frame; unless the guard must hold at that moment, too
//   else                  it rests on
void Engine::NotifyWatchers(RuleInstance& instance) {
  using Kind = Watcher::Kind;
  if (!instance.dependents_made) {
    scratch_.clear();
    instances_.MakeDependents(instance.index, scratch_);
    for (const InstanceId dependent : scratch_) Wake(dependent);
  }
  for (const Watcher& watcher : instance.watchers) {
    RuleInstance& watching = instances_[watcher.instance];
    const bool is_guard = watcher.kind == Kind::kGuard || watcher.kind == Kind::kBeginGuard;
    if (watcher.opened)
      watching.moment = instance.reported == Kleene::kUnknown ? kNever : history_.now();
    if (watching.awake) continue;
    if (watcher.kind == Kind::kMeasured) {
      Measure(watching, watcher, instance);
    } else if (watching.open || MayBegin(watching)) {
      if (watching.open || is_guard || !instances_.GuardRests(watching)) Wake(watcher.instance);
    } else if (!instance.open && is_guard) {
      const bool too_late =
          watcher.kind == Kind::kBeginGuard && instance.reported == Kleene::kFalse;
      if (too_late) {
        RestOn(watching);
      } else {
        Wake(watcher.instance);
      }
    }
  }
}

void Engine::NotifyIfChanged(RuleInstance& instance) {
  if (!RuleOf(instance).referenced) return;
  const FrameNumber now = history_.now();
  const Kleene truth = instances_.TruthAt(instance.index, now);
  const bool at_an_edge = (instance.open && instance.begin.frame == now) ||
                          (!instance.past.empty() && (instance.past.back().end.frame == now ||
                                                      instance.past.back().begin.frame == now));
  if (truth == instance.reported && !at_an_edge) return;
  instance.reported = truth;
  NotifyWatchers(instance);
}

// Every frame is decided, and the next one gives the same result unless something changes or an
// alarm comes. A touch never rests while it is open.
bool Engine::MayRest(const RuleInstance& instance) {
  const Rule& rule = RuleOf(instance);
  if (instance.next <= history_.now() || !instance.pending.empty() || instance.by_itself)
    return rule.form() == Form::kCompose && !rule.referenced && LacksAPart(instance);
  switch (rule.form()) {
    case Form::kCompose:
      // Nobody would tell that a part goes on, so that it may still begin there.
      return !rule.referenced || instance.known > history_.now();
    case Form::kFromTo:
      if (instance.open && rule.TriesEachBegin())
        return false;  // its frames may be asked for again
      // What must not come may still come at the deadline; what should have come is too late after
      // it.
      if (instance.open && TicksOf(instance).within >= 0) {
        alarms_.Set(instance.begin.tick + TicksOf(instance).within +
                        (rule.As<FromToRule>().absence ? 0 : 1),
                    instance.index);
      }
      break;
    case Form::kUntilSince:
      return !rule.referenced || instance.As<UntilSinceState>().approach_from > history_.now();
    case Form::kWhile:
    case Form::kAny:
    case Form::kRestOf:
      break;
    case Form::kTouching:
      return !instance.open && instances_.GuardRests(instance);
  }
  // Where it ends is the frame of the gap, which must be there still when somebody asks about it.
  if (instance.in_gap && rule.uses_looks) return false;
  const bool time_makes_certain = rule.referenced && !MayComeToNothing(instance);
  const RuleTicks& ticks = TicksOf(instance);
  if (instance.open && rule.referenced && rule.lasting_most_s >= 0 &&
      !ticks.IsTooLong(AtLeastLasts(instance)))
    alarms_.Set(instance.begin.tick + ticks.lasting_most, instance.index);
  if (instance.in_gap) {
    alarms_.Set(instance.gap.tick + TicksOf(instance).bridging, instance.index);
  } else if (instance.open && !instance.certain && time_makes_certain) {
    alarms_.Set(instance.begin.tick + TicksOf(instance).lasting - 1, instance.index);
  }
  return true;
}

void Engine::Rest(RuleInstance& instance) {
  instance.awake = false;
  instance.resting_since = history_.now();
  // What lasts too long is known to be no interval.
  const bool is_known = instance.known > history_.now();
  if (!instance.open || (instance.certain && !instance.in_gap) || is_known) instance.known = kNever;
  if (!instance.open) idle_.Queue(instance);
  if (!following_.empty()) StopFollowers(instance);
  // No end leads back over a frame in which nothing led on.
  if (RuleOf(instance).form() == Form::kUntilSince) RestsFarApart(instance);
}

void Engine::StepRule(RuleId rule) {
  awake_count_ -= std::erase_if(awake_[rule], [&](InstanceId index) {
    RuleInstance& instance = instances_[index];
    const FrameNumber known = instance.known;
    const bool leaves = StepOrRest(instance);
    if (instance.awaited && instance.known != known) Tell(instance);
    if (instance.followed && known <= history_.now() && instance.known > history_.now())
      AskWhetherFollowersRest(instance);
    return leaves;
  });
}

// Whether it need not be stepped in the next frame.
bool Engine::StepOrRest(RuleInstance& instance) {
  const Edges edges = instance.followed ? EdgesOf(instance) : Edges();
  if (LooksTheSame(instance)) {
    Rest(instance);
    return true;
  }
  StepInstance(instance);
  if (instance.followed && EdgesOf(instance) != edges) TellFollowers(instance);
  NotifyIfChanged(instance);
  if (MayRest(instance)) {
    Rest(instance);
    return true;
  }
  if (AwaitOthers(instance)) return true;
  const FrameNumber needed = OldestNeeded(instance);
  past_.Need(needed);
  for (const Pending& pending : instance.pending) past_.Need(pending.next);
  if (RuleOf(instance).uses_looks && !past_.NeedLooks(needed)) HoldLooks(instance);
  return false;
}

// Waiting: an instance cannot decide a frame while the truth of another one is unknown there, and
// the other one need not tell for long: the shortest duration of its interval, a gap that may be
// bridged. If nothing but others can decide the frame, the instance waits; one that is awaited
// tells when its truth becomes known further than before. The frames that were missed are then
// stepped where something changes that the instance asks about; between two changes a step finds
// what the last one found. That is what lets instances rest, too (MayRest()).

// An instance could not decide its next frame. False if time may decide it: frames to come, the
// confirmation of an interval.
bool Engine::AwaitOthers(RuleInstance& instance) {
  if (Follow(instance)) return true;
  if (instance.next > history_.now() || !instance.pending.empty() || instance.by_itself ||
      RuleOf(instance).form() == Form::kCompose || !program_->waits ||
      (looks_at_all_ && RuleOf(instance).uses_looks))
    return false;
  ForEachReference(instance, [&](InstanceId index) {
    RuleInstance& other = instances_[index];
    if (instances_.KnownOf(other) > instance.next) return;
    other.awaited = instance.waits = true;
    if (!other.follows) return;
    const FrameNumber next = other.next, known = other.known;
    StopWaiting(other);
    other.next = next;  // its turn in this frame is over, so what it decided counts
    other.known = known;
    Hold(other);
  });
  if (!instance.waits) return false;
  Hold(instance);
  return true;
}

void Engine::Hold(const RuleInstance& instance) {
  past_.Hold(HeldBy(instance), instance.index, [this](const auto& held) { return IsHeld(held); });
  if (RuleOf(instance).uses_looks) HoldLooks(instance);
}

// Of the entities that play its roles: it asks for no others.
void Engine::HoldLooks(const RuleInstance& instance) {
  for (std::size_t role = 0; role < RuleOf(instance).roles.size(); ++role) {
    past_.HoldLooks(instance.entities[role], HeldBy(instance), instance.index, history_,
                    [this](const auto& held) { return IsHeld(held); });
  }
}

void Engine::Tell(RuleInstance& instance) {
  instance.awaited = false;
  for (const Watcher& watcher : instance.watchers) {
    RuleInstance& watching = instances_[watcher.instance];
    if (watching.waits && !watching.follows) StopWaiting(watching);
  }
}

void Engine::StopWaiting(RuleInstance& instance) {
  if (instance.follows) {
    // Of this frame nothing was decided that counts: whoever was at rest may begin or end in it.
    instance.next =
        std::min(following_[instance.index].resumes, std::max<FrameNumber>(history_.now(), 0));
    instance.known = std::min(instance.known, instance.next);
  }
  instance.waits = instance.follows = false;
  awake_[instance.rule].push_back(instance.index);
  ++awake_count_;
}

// Whether something that it asks about is known up to its next frame, and no further. What was not
// known in the frame before, which was decided without it, makes no difference.
bool Engine::IsAtTheKnown(const RuleInstance& instance) const {
  bool is_there = false;
  ForEachReference(instance, [&](InstanceId index) {
    const RuleInstance& other = instances_[index];
    is_there = is_there || (!instances_.IsKnownAt(other, instance.next) &&
                            instances_.IsKnownAt(other, instance.next - 1));
  });
  return is_there;
}

// A frame was decided. Those that follow are left out as long as they cannot differ from it.
void Engine::SkipUnchanged(RuleInstance& instance) const {
  const FrameNumber now = history_.now();
  if (instance.next >= now || instance.by_itself || !instance.pending.empty() || instance.in_gap ||
      !program_->waits)
    return;
  const Form form = RuleOf(instance).form();
  const bool has_deadline = instance.open && TicksOf(instance).within >= 0;
  if (form == Form::kUntilSince || has_deadline || IsAtTheKnown(instance)) return;
  instance.next = std::clamp(NextChange(instance, instance.next - 1), instance.next, now + 1);
}

// The first frame after this one where something changes that the instance asks about. As long as
// nothing begins for what others say, it does not look at entities.
FrameNumber Engine::NextChange(RuleInstance& instance, FrameNumber after) const {
  FrameNumber next = kNever;
  const Rule& rule = RuleOf(instance);
  const bool looks =
      instance.open || !begins_by_others_[instance.rule] ||
      evaluator_.Truth(rule.As<FromToRule>().from, {instance, after}) != Kleene::kFalse;
  for (std::size_t role = 0; looks && role < rule.roles.size(); ++role) {
    if (rule.watches_pose[role] || rule.watches_grip[role])
      next = std::min(next, history_.NextChange(instance.entities[role], after));
  }
  if (next == after + 1) return next;  // most things tremble
  ForEachReference(instance, [&](InstanceId index) {
    const RuleInstance& other = instances_[index];
    next = std::min({next, NextEdge(other, after), other.known > after ? other.known : kNever});
  });
  return next;
}

std::string_view WhyNoTick(Tick tick, const History& history) {
  if (tick > kLatestTick || tick < -kLatestTick) return "a frame's tick is too large";
  if (history.now() >= 0 && tick <= history.At(history.now()).tick)
    return "the frames are not in order of time";
  return {};
}

std::string_view WhyNotWatchable(const Frame& frame, int entities) {
  if (static_cast<int>(frame.entities.size()) != entities)
    return "a frame has another number of entities than the entity table";
  int last_hand = kNoEntity;
  for (const HandSample& hand : frame.hands) {
    if (!IsEntity(hand.entity, entities))
      return "a frame has a hand that is not in the entity table";
    if (hand.entity <= last_hand)
      return "a frame has a hand twice, or its hands are not in the order of the entity table";
    last_hand = hand.entity;
  }
  return WhyNoTouches(frame.touches, entities);
}

std::string_view WhyNotWatchable(const FrameChanges& changes, int entities) {
  for (const EntityChange& change : changes.entities) {
    if (!IsEntity(change.entity, entities))
      return "a frame has an entity that is not in the entity table";
  }
  for (const HandSample& hand : changes.hands) {
    if (!IsEntity(hand.entity, entities))
      return "a frame has a hand that is not in the entity table";
  }
  for (const ContactEnd& contact_end : changes.contact_ends) {
    if (!IsEntity(contact_end.a, entities) || !IsEntity(contact_end.b, entities))
      return "a frame has a contact end of an entity that is not in the entity table";
  }
  return WhyNoTouches(changes.touches, entities);
}

}  // namespace prehend::grammar
