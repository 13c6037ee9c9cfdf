// SPDX-License-Identifier: Apache-2.0
// Instances that wait for others, and how they catch up.
//
// Needs: an instance cannot decide a frame while the truth of another one is unknown there, and the
// other one need not tell for long: the shortest duration of its interval, a gap that may be
// bridged. Algorithm: if nothing but others can decide the frame, the instance waits; one that is
// awaited tells when its truth becomes known further than before. The frames that were missed are
// then stepped where something changes that the instance asks about; between two changes a step
// finds what the last one found. That is what lets instances rest, too (Engine::MayRest()).
//
// One that asks about nothing but others follows them: while none of them begins or ends, it is as
// it was up to where all of them are known. It is not stepped as they get on. How far it is known
// itself is found when somebody asks (KnownOf()), by the steps that it would have made; so it is
// known as far as if it had made them in each frame, and rests when it would have.
// Tested by tests/grammar/monitor_test.cc and tests/grammar/reference/reference_test.cc
#include <algorithm>

#include "grammar/engine/engine.h"

namespace prehend::grammar {
namespace {

// Where the truth of an instance changes.
FrameNumber NextEdge(const RuleInstance& instance, FrameNumber after) {
  FrameNumber next = kNever;
  const auto consider = [&](FrameNumber frame) {
    if (frame > after) next = std::min(next, frame);
  };
  if (instance.open) consider(instance.begin.frame);
  for (std::size_t i = 0; i < instance.past.size(); ++i) {
    consider(instance.past[i].begin.frame);
    consider(instance.past[i].end.frame);
  }
  if (const auto* touching = instance.If<TouchingState>()) {
    consider(FirstAfter(touching->crossings, after));
    consider(FirstAfter(touching->touches, after));
  }
  return next;
}

template <typename Visit>
void ForEachReference(const RuleInstance& instance, const Visit& visit) {
  if (const auto* any = instance.If<AnyState>()) {
    for (const InstanceId member : any->members) visit(member);
  }
  for (const InstanceId reference : instance.references) {
    if (reference != kNone) visit(reference);
  }
}

}  // namespace

// An instance could not decide its next frame. False if time may decide it: frames to come, the
// confirmation of an interval.
bool Engine::AwaitOthers(RuleInstance& instance) {
  if (Follow(instance)) return true;
  if (instance.next > history_.now() || !instance.pending.empty() || evaluator_.depends_on_time() ||
      RuleOf(instance).form() == Form::kCompose || !program_->waits ||
      (looks_at_all_ && RuleOf(instance).uses_looks))
    return false;
  ForEachReference(instance, [&](InstanceId index) {
    RuleInstance& other = instances_[index];
    if (instances_.KnownOf(other) > instance.next) return;
    other.awaited = instance.waits = true;
    if (!other.follows) return;
    StopWaiting(other);
    Hold(other);  // its turn in this frame is over
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

// Whether something that it asks about is known up to its next frame, and no further.
bool Engine::IsAtTheKnown(const RuleInstance& instance) const {
  bool is_there = false;
  ForEachReference(instance, [&](InstanceId index) {
    is_there = is_there || !instances_.IsKnownAt(instances_[index], instance.next);
  });
  return is_there;
}

// A frame was decided. Those that follow are left out as long as they cannot differ from it.
void Engine::SkipUnchanged(RuleInstance& instance) const {
  const FrameNumber now = history_.now();
  if (instance.next >= now || evaluator_.depends_on_time() || !instance.pending.empty() ||
      instance.in_gap || !program_->waits)
    return;
  const Form form = RuleOf(instance).form();
  const bool has_deadline = instance.open && TicksOf(instance).within >= 0;
  if (form == Form::kUntilSince || has_deadline || IsAtTheKnown(instance)) return;
  instance.next = std::clamp(NextChange(instance, instance.next - 1), instance.next, now + 1);
}

// The first frame after this one where something changes that the instance asks about.
FrameNumber Engine::NextChange(const RuleInstance& instance, FrameNumber after) const {
  FrameNumber next = kNever;
  ForEachReference(instance, [&](InstanceId index) {
    const RuleInstance& other = instances_[index];
    next = std::min({next, NextEdge(other, after), other.known > after ? other.known : kNever});
  });
  const Rule& rule = RuleOf(instance);
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (rule.watches_pose[role] || rule.watches_grip[role])
      next = std::min(next, history_.NextChange(instance.entities[role], after));
  }
  return next;
}

// Those that an instance follows.
template <typename Visit>
void Engine::ForEachFollowed(const RuleInstance& instance, const Visit& visit) const {
  if (RuleOf(instance).form() != Form::kUntilSince) return ForEachReference(instance, visit);
  for (const int slot : follows_[instance.rule].slots) {
    const InstanceId reference = instance.references[static_cast<std::size_t>(slot)];
    if (reference != kNone) visit(reference);
  }
}

bool Engine::AsksOnlyOthers(NodeId index) const {
  if (index == kNone) return true;
  const Node& node = program_->nodes[index];
  switch (node.op) {
    case Op::kAnd:
    case Op::kOr:
      return AsksOnlyOthers(node.args[0]) && AsksOnlyOthers(node.args[1]);
    case Op::kNot:
    case Op::kBegins:
    case Op::kEnds:
      return AsksOnlyOthers(node.args[0]);
    case Op::kHolds:
    case Op::kOwns:
    case Op::kPartOf:
    case Op::kIsA:
      return true;
    default:
      return false;
  }
}

namespace {

void CollectAsked(const Program& program, NodeId index, std::vector<int>& slots) {
  if (index == kNone) return;
  const Node& node = program.nodes[index];
  if (node.op == Op::kHolds || node.op == Op::kOwns) slots.push_back(node.slot);
  for (const NodeId arg : node.args) CollectAsked(program, arg, slots);
}

bool AsksForTheEnd(const Program& program, NodeId index) {
  const Node& node = program.nodes[index];
  switch (node.op) {
    case Op::kAtEnd:
      return true;
    case Op::kNegate:
    case Op::kAbs:
    case Op::kHeight:
      return AsksForTheEnd(program, node.args[0]);
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kDistance:
      return AsksForTheEnd(program, node.args[0]) || AsksForTheEnd(program, node.args[1]);
    default:
      return false;
  }
}

}  // namespace

// Whatever else happens: it cannot be known to be false before the end is.
bool Engine::IsUnknownUntilTheEnd(NodeId index) const {
  const Node& node = program_->nodes[index];
  switch (node.op) {
    case Op::kAnd:
      return IsUnknownUntilTheEnd(node.args[0]) && IsUnknownUntilTheEnd(node.args[1]);
    case Op::kOr:
      return IsUnknownUntilTheEnd(node.args[0]) || IsUnknownUntilTheEnd(node.args[1]);
    case Op::kInSphere:
    case Op::kInCylinder:
    case Op::kLess:
    case Op::kLessEqual:
    case Op::kGreater:
    case Op::kGreaterEqual:
      return AsksForTheEnd(*program_, node.args[0]) || AsksForTheEnd(*program_, node.args[1]);
    default:
      return false;
  }
}

// Whether instances of the rule may follow others. Where nothing is known later as a window of time
// is not over, waiting is short, and following would cost more.
Engine::Follows Engine::WhenItFollows(const Rule& rule) const {
  const bool has_windows =
      std::ranges::any_of(program_->rules, [](const Rule& one) { return one.looks_around_s > 0; });
  if (!program_->waits || !has_windows) return {};
  if (const auto* holds = rule.If<WhileRule>()) {
    const bool follows =
        holds->at_least == 0 && AsksOnlyOthers(holds->condition) && AsksOnlyOthers(holds->until);
    return {follows, follows && rule.lasting_most_s < 0};
  }
  if (const auto* from_to = rule.If<FromToRule>(); from_to != nullptr && from_to->within_s < 0)
    return {AsksOnlyOthers(from_to->from), rule.lasting_most_s < 0 && AsksOnlyOthers(from_to->to) &&
                                               AsksOnlyOthers(from_to->during)};
  if (rule.form() == Form::kAny || rule.form() == Form::kRestOf)
    return {true, rule.lasting_most_s < 0};
  const auto* looks_back = rule.If<UntilSinceRule>();
  if (looks_back == nullptr || !AsksOnlyOthers(looks_back->until)) return {};
  // Its truth is known later and later, as no interval reaches back further than the rule says.
  const bool is_far =
      program_->nodes[looks_back->since].op == Op::kOr && IsUnknownUntilTheEnd(looks_back->since);
  Follows follows{.closed = is_far || !rule.referenced};
  CollectAsked(*program_, looks_back->until, follows.slots);
  return follows;
}

// It found nothing new in the frame before its next one, and nothing of what it asks about begins
// or ends from there on, as far as that is known.
bool Engine::MayFollow(RuleInstance& instance, FrameNumber resumes) {
  constexpr int kMostCost = 1000;
  if (resumes == 0) return false;
  following_[instance.index].cost = 1;
  bool is_calm = true;
  ForEachFollowed(instance, [&](InstanceId index) {
    const RuleInstance& other = instances_[index];
    following_[instance.index].cost += other.follows ? following_[other.index].cost : 1;
    is_calm = is_calm && NextEdge(other, resumes - 2) == kNever;
  });
  if (!is_calm || following_[instance.index].cost > kMostCost) return false;
  const auto is_false = [&](NodeId node) {
    return evaluator_.Truth(node, {instance, resumes - 1}) == Kleene::kFalse;
  };
  if (const auto* looks_back = RuleOf(instance).If<UntilSinceRule>())
    return is_false(looks_back->until);
  if (const auto* any = instance.If<AnyState>()) return instance.open || any->owner == kNoEntity;
  const auto* from_to = RuleOf(instance).If<FromToRule>();
  return from_to == nullptr || instance.open || is_false(from_to->from) ||
         (from_to->during != kNone && AsksOnlyOthers(from_to->during) && is_false(from_to->during));
}

// Instead of waiting, or of being awake for nothing but the time.
bool Engine::Follow(RuleInstance& instance) {
  const Follows& follows = follows_[instance.rule];
  if (!(instance.open ? follows.open : follows.closed) || instance.awaited || instance.in_gap ||
      (instance.open && !instance.certain) || !instance.pending.empty() || log_ != nullptr ||
      finishing_)
    return false;
  if (following_.size() <= instance.index.index()) following_.resize(instance.index.index() + 1);
  const bool looks_back = RuleOf(instance).form() == Form::kUntilSince;
  // It may have gone on as nothing led on, whether or not there was an end.
  FrameNumber resumes = instance.next;
  bool lags = looks_back;
  ForEachFollowed(instance, [&](InstanceId index) {
    const FrameNumber known = instances_.KnownOf(instances_[index]);
    lags = lags || known <= instance.next;
    if (looks_back) resumes = std::min(resumes, known);
  });
  const bool is_kept =
      resumes == instance.next || resumes >= std::max(history_.first(), history_.first_look()) + 2;
  if (!lags || !is_kept || !MayFollow(instance, resumes)) return false;
  instance.waits = instance.follows = true;
  ForEachFollowed(instance, [&](InstanceId index) {
    RuleInstance& other = instances_[index];
    other.followed = true;
    other.awaited = other.awaited && std::ranges::any_of(other.watchers, [&](const Watcher& one) {
                      const RuleInstance& watching = instances_[one.instance];
                      return watching.waits && !watching.follows;
                    });
  });
  following_[instance.index].known_in = -1;
  following_[instance.index].held = following_[instance.index].resumes = resumes;
  Hold(instance);
  return true;
}

// As far as all others are known it is as it was. Beyond that some of them may be enough: its steps
// tell. When its turn in this frame has come, all that it asks about is up to date; before, whoever
// rests may still be woken for this frame.
FrameNumber Engine::KnownOf(InstanceId follower) {
  RuleInstance& instance = instances_[follower];
  if (following_[instance.index].known_in == history_.now()) return instance.known;
  const bool had_its_turn = 2 * turns_[instance.rule] < turn_;
  const FrameNumber end = history_.now() + (had_its_turn ? 1 : 0);
  FrameNumber next = end;
  ForEachFollowed(instance, [&](InstanceId index) {
    if (next > following_[instance.index].resumes)
      next = std::min(next, instances_.KnownOf(instances_[index]));
  });
  following_[instance.index].resumes = std::max(following_[instance.index].resumes, next);
  instance.next = std::max(instance.next, following_[instance.index].resumes);
  const bool depended_on_time = evaluator_.depends_on_time();
  while (instance.next < end && StepFrame(instance)) continue;
  evaluator_.ResetTimeDependence();
  if (depended_on_time) evaluator_.MarkTimeDependent();
  UpdateKnown(instance);
  if (had_its_turn) following_[instance.index].known_in = history_.now();
  return instance.known;
}

// The truth of one that is followed has changed.
void Engine::TellFollowers(RuleInstance& instance) {
  instance.followed = false;
  for (const Watcher& watcher : instance.watchers) {
    RuleInstance& watching = instances_[watcher.instance];
    if (watching.follows) StopWaiting(watching);
  }
}

// It is known at the newest frame. Who follows it may rest if what else it follows lets it: that is
// seen when its turn comes.
void Engine::AskWhetherFollowersRest(RuleInstance& instance) {
  for (const Watcher& watcher : instance.watchers) {
    const RuleInstance& watching = instances_[watcher.instance];
    if (!watching.follows) continue;
    may_rest_[watching.rule].push_back(watcher.instance);
    some_may_rest_ = true;
  }
}

// Up to where the condition of a follower may be known at most. Nothing if it is not that simple.
std::optional<Engine::Bound> Engine::BoundOf(NodeId index, const RuleInstance& instance) const {
  const Node& node = program_->nodes[index];
  if (node.op == Op::kHolds) {
    const InstanceId reference = instance.references[static_cast<std::size_t>(node.slot)];
    if (reference == kNone) return std::nullopt;
    const RuleInstance& other = instances_[reference];
    return Bound{other.open && other.certain, other.follows ? kNever : other.known};
  }
  const bool one_is_enough = node.op == Op::kOr;
  if (!one_is_enough && node.op != Op::kAnd) return std::nullopt;
  const auto left = BoundOf(node.args[0], instance), right = BoundOf(node.args[1], instance);
  if (!left || !right) return std::nullopt;
  const bool left_decides = left->holds == one_is_enough,
             right_decides = right->holds == one_is_enough;
  if (left_decides && right_decides)
    return Bound{one_is_enough, std::max(left->known, right->known)};
  if (left_decides || right_decides) return left_decides ? left : right;
  return Bound{!one_is_enough, std::min(left->known, right->known)};
}

bool Engine::MayBeKnownNow(const RuleInstance& instance) const {
  const auto* holds = RuleOf(instance).If<WhileRule>();
  if (holds == nullptr || holds->until != kNone) return true;
  const std::optional<Bound> bound = BoundOf(holds->condition, instance);
  return !bound || bound->known > history_.now();
}

void Engine::LetFollowersRest(RuleId rule) {
  const FrameNumber now = history_.now();
  ++turn_;  // all that they ask about has had its turn
  for (const InstanceId index : may_rest_[rule]) {
    RuleInstance& instance = instances_[index];
    if (!instance.follows || !MayBeKnownNow(instance) || KnownOf(index) <= now) continue;
    // What goes on as nothing leads on does not rest.
    if (RuleOf(instance).form() != Form::kUntilSince || following_[instance.index].resumes > now)
      StopWaiting(instance);
  }
  --turn_;
  may_rest_[rule].clear();
}

// A frame that was held: who follows holds later ones as it gets on.
FrameNumber Engine::HeldFrom(const RememberedPast::Held& held) {
  constexpr FrameNumber kFramesBetween = 32;
  RuleInstance& instance = instances_[held.instance];
  if (!instance.follows || held.frame + kFramesBetween > history_.now()) return held.frame;
  instances_.KnownOf(instance);
  if (held.frame + kFramesBetween > following_[instance.index].resumes) return held.frame;
  following_[instance.index].held = following_[instance.index].resumes;
  if (RuleOf(instance).uses_looks) HoldLooks(instance);
  return following_[instance.index].held;
}

}  // namespace prehend::grammar
