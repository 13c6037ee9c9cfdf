// SPDX-License-Identifier: Apache-2.0
// Instances that follow others: they are as they were, as far as those are known.
//
// Needs: values over a window of time, and events that look back, are known later than the frame;
// so is whoever asks about them. Algorithm: as long as nothing that it asks about begins or ends,
// an instance finds in each frame what it found before. It is not stepped as the others get on, but
// when the truth of one of them changes (TellFollowers()). One that looks at entities, too, looks
// ahead in each frame: what would happen if the others went on as they are? If that is nothing it
// goes on following, else it is stepped. How far it is known itself is found when somebody asks
// (KnownOf()); so it is known as far as if it had been stepped in each frame, and rests when it
// would have. Of one that asks about nothing but others this follows from how far they are known
// (StaysUntil()): in `a and b`, what is false and known further decides. The others make the steps
// that they would have made.
// Tested by tests/grammar/monitor_test.cc and tests/grammar/reference/reference_test.cc
#include <algorithm>
#include <span>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

// Those that an instance follows; of one that looks back, so many.
template <typename Visit>
void Engine::ForEachFollowed(const RuleInstance& instance, std::size_t most,
                             const Visit& visit) const {
  if (RuleOf(instance).form() != Form::kUntilSince) return ForEachReference(instance, visit);
  const std::vector<int>& slots = follows_[instance.rule].slots;
  for (const int slot : std::span(slots).first(std::min(most, slots.size()))) {
    const InstanceId reference = instance.references[static_cast<std::size_t>(slot)];
    if (reference != kNone) visit(reference);
  }
}

// Where an interval of another one begins or ends.
bool Engine::IsMoment(NodeId index) const {
  const Node& node = program_->nodes[index];
  return (node.op == Op::kBegins || node.op == Op::kEnds) &&
         program_->nodes[node.args[0]].op == Op::kHolds;
}

bool Engine::AsksOnlyOthers(NodeId index) const {
  if (index == kNone) return true;
  const Node& node = program_->nodes[index];
  return RowOf(node.op).type == Type::kTruth && !IsComparison(node.op) &&
         !RowOf(node.op).IsLook() &&
         std::ranges::all_of(node.args, [this](NodeId arg) { return AsksOnlyOthers(arg); });
}

namespace {

void CollectAsked(const Program& program, NodeId index, std::vector<int>& slots) {
  if (index == kNone) return;
  const Node& node = program.nodes[index];
  if (node.op == Op::kHolds || node.op == Op::kOwns) slots.push_back(node.slot);
  for (const NodeId arg : node.args) CollectAsked(program, arg, slots);
}

bool AsksFor(const Program& program, NodeId index, Op op) {
  if (index == kNone) return false;
  const Node& node = program.nodes[index];
  return node.op == op ||
         std::ranges::any_of(node.args, [&](NodeId arg) { return AsksFor(program, arg, op); });
}

}  // namespace

// What is nearest is a question about others than those of its roles.
bool Engine::AsksForTheNearest(const Rule& rule) const {
  return looks_at_all_ && std::ranges::any_of(ConditionsOf(rule), [&](NodeId index) {
           return AsksFor(*program_, index, Op::kNearest);
         });
}

// Whatever else happens: it cannot be known to be false before the end is.
bool Engine::IsUnknownUntilTheEnd(NodeId index) const {
  const Node& node = program_->nodes[index];
  if (node.op == Op::kAnd)
    return IsUnknownUntilTheEnd(node.args[0]) && IsUnknownUntilTheEnd(node.args[1]);
  if (node.op == Op::kOr)
    return IsUnknownUntilTheEnd(node.args[0]) || IsUnknownUntilTheEnd(node.args[1]);
  return node.needs_end;
}

// Whether instances of the rule may follow others. Where nothing is known later as a window of time
// is not over, waiting is short, and following would cost more.
Engine::Follows Engine::WhenItFollows(const Rule& rule) const {
  const bool has_windows =
      std::ranges::any_of(program_->rules, [](const Rule& one) { return one.looks_around_s > 0; });
  if (!program_->waits || !has_windows) return {};
  const bool only_others = std::ranges::all_of(
      ConditionsOf(rule), [this](NodeId condition) { return AsksOnlyOthers(condition); });
  if (const auto* holds = rule.If<WhileRule>()) {
    const bool follows = holds->at_least == 0 && !AsksForTheNearest(rule);
    const NodeId goes_on = holds->until == kNone ? holds->condition : holds->until;
    return {.closed = follows,
            .open = follows && rule.lasting_most_s < 0,
            .closed_looks = !AsksOnlyOthers(holds->condition) || !AsksOnlyOthers(holds->until),
            .open_looks = !AsksOnlyOthers(goes_on),
            .only_others = only_others};
  }
  // Of one that has a deadline only if a moment alone begins it: how far that is known says all.
  if (const auto* from_to = rule.If<FromToRule>();
      from_to != nullptr && (from_to->within_s < 0 || IsMoment(from_to->from))) {
    const bool follows = !AsksForTheNearest(rule);
    const bool closed_looks = !AsksOnlyOthers(from_to->from);
    return {.closed = follows && (!closed_looks || rule.anchors.empty() || rule.anchors_at_hand),
            .open = follows && rule.lasting_most_s < 0 && from_to->within_s < 0,
            .closed_looks = closed_looks,
            .open_looks = !AsksOnlyOthers(from_to->to) || !AsksOnlyOthers(from_to->during),
            .only_others = only_others};
  }
  if (rule.form() == Form::kAny || rule.form() == Form::kRestOf)
    return {.closed = true, .open = rule.lasting_most_s < 0, .only_others = true};
  const auto* looks_back = rule.If<UntilSinceRule>();
  if (looks_back == nullptr || !AsksOnlyOthers(looks_back->until)) return {};
  // Its truth is known later and later, as no interval reaches back further than the rule says.
  const bool is_far =
      program_->nodes[looks_back->since].op == Op::kOr && IsUnknownUntilTheEnd(looks_back->since);
  Follows follows{.closed = is_far || !rule.referenced};
  CollectAsked(*program_, looks_back->until, follows.slots);
  follows.of_until = follows.slots.size();
  if (follows.closed) return follows;
  CollectAsked(*program_, looks_back->since, follows.slots);
  follows.closed = follows.by_since = follows.slots.size() > follows.of_until;
  return follows;
}

// What tells how far its steps would get if nothing that it asks about begins or ends, or kNone.
NodeId Engine::SkipsBy(const Rule& rule) const {
  const auto asks_for = [&](NodeId index, Op op) { return AsksFor(*program_, index, op); };
  if (!program_->waits || !rule.anchors.empty()) return {};
  if (const auto* looks_back = rule.If<UntilSinceRule>()) {
    const Node& until = program_->nodes[looks_back->until];
    const bool is_simple = IsMoment(looks_back->until) &&
                           program_->nodes[looks_back->since].op == Op::kOr &&
                           IsUnknownUntilTheEnd(looks_back->since);
    return is_simple ? until.args[0] : NodeId();
  }
  const auto* holds = rule.If<WhileRule>();
  const bool is_simple = holds != nullptr && holds->at_least == 0 && holds->until == kNone &&
                         AsksOnlyOthers(holds->condition) &&
                         !asks_for(holds->condition, Op::kBegins) &&
                         !asks_for(holds->condition, Op::kEnds);
  return is_simple ? holds->condition : NodeId();
}

// Steps that would find nothing new need not be made. False if something else must be looked at.
// Nobody is asked whom the steps would not ask.
bool Engine::SkipAhead(RuleInstance& instance) {
  const NodeId asks = skips_by_[instance.rule];
  if (asks == kNone || log_ != nullptr || finishing_ || instance.in_gap || instance.next < 2 ||
      (instance.open && !instance.certain) || !instance.pending.empty())
    return false;
  const bool looks_back = RuleOf(instance).form() == Form::kUntilSince;
  FrameNumber seen = kNever;  // how far those who follow others have been asked
  for (std::size_t slot = 0; slot < instance.references.size(); ++slot) {
    const InstanceId index = instance.references[slot];
    if (index == kNone && instances_.CanRefer(instance, static_cast<int>(slot))) return false;
    if (index == kNone) continue;
    const RuleInstance& other = instances_[index];
    if (NextEdge(other, instance.next - 2) != kNever) return false;
    if (other.follows && !looks_back) seen = std::min(seen, other.known);
  }
  seen_only_ = !looks_back;
  const auto [holds, known] = BoundOf(asks, instance);
  seen_only_ = false;
  const FrameNumber now = history_.now();
  if (known < instance.next || std::min(known, now) >= seen ||
      (!looks_back && holds != instance.open))
    return false;
  instance.next = std::min(known, now + 1);
  instance.by_itself = false;
  return true;
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
    return is_false(looks_back->until) &&
           (!follows_[instance.rule].by_since || RuledOutUntil(instance) >= resumes);
  if (const auto* any = instance.If<AnyState>()) {
    const bool shares_out = RuleOf(instance).As<AnyRule>().one != kNone;
    return instance.open ||
           (any->owner == kNoEntity && std::ranges::none_of(any->members, [&](InstanceId member) {
              return shares_out && instances_.TruthAt(member, resumes - 1) != Kleene::kFalse;
            }));
  }
  const auto* from_to = RuleOf(instance).If<FromToRule>();
  return from_to == nullptr || instance.open || is_false(from_to->from) ||
         (from_to->during != kNone && AsksOnlyOthers(from_to->during) && is_false(from_to->during));
}

// Instead of waiting, or of being awake for nothing but the time.
bool Engine::Follow(RuleInstance& instance) {
  const Follows& follows = follows_[instance.rule];
  if (!(instance.open ? follows.open : follows.closed) || instance.awaited || instance.in_gap ||
      (instance.open && !instance.certain) || !instance.pending.empty() || finishing_)
    return false;
  if (following_.size() <= instance.index.index()) following_.resize(instance.index.index() + 1);
  const bool looks_back = RuleOf(instance).form() == Form::kUntilSince;
  const bool is_ruled_out = !follows.only_others && RuledOutUntil(instance) >= instance.next;
  const bool looks = !is_ruled_out && (instance.open ? follows.open_looks : follows.closed_looks);
  // Else nobody would be told that it is not known in the next frame.
  const bool is_known_now = RuleOf(instance).referenced && instance.known > history_.now();
  if (is_known_now || (looks && instance.next > history_.now())) return false;
  // It may have gone on as nothing led on, whether or not there was an end.
  FrameNumber resumes = instance.next;
  bool lags = looks_back;
  ForEachFollowed(instance, [&](InstanceId index) {
    const RuleInstance& other = instances_[index];
    lags = lags || other.follows || other.known <= instance.next;
    if (looks_back) resumes = std::min(resumes, instances_.KnownOf(other));
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
  Following& following = following_[instance.index];
  following.known_in = -1;
  following.held = following.resumes = resumes;
  following.assumed = looks ? resumes : kNever;
  following.asks_only_others = !looks_back && follows.only_others;
  following.is_ruled_out = is_ruled_out && !looks_back;
  if (looks && !following.is_listed) {
    ahead_[instance.rule].push_back(instance.index);
    ++ahead_count_;
  }
  following.is_listed = following.is_listed || looks;
  Hold(instance);
  return true;
}

// Whether nothing begins or ends at this frame if the others stay as they are.
Kleene Engine::StaysAt(RuleInstance& instance, FrameNumber frame) {
  const Evaluator::View view{instance, frame};
  if (const auto* from_to = RuleOf(instance).If<FromToRule>()) {
    if (!instance.open) {
      Kleene opens = evaluator_.Truth(from_to->from, view);
      if (opens == Kleene::kFalse) return Kleene::kTrue;
      const Evaluator::View begin{.instance = instance, .frame = frame, .begin_at = frame};
      if (from_to->during != kNone) opens = And(opens, evaluator_.Truth(from_to->during, begin));
      return Not(opens == Kleene::kFalse ? opens
                                         : And(opens, Not(evaluator_.Truth(from_to->to, begin))));
    }
    const Kleene stays = Not(evaluator_.Truth(from_to->to, view));
    if (stays == Kleene::kFalse || from_to->during == kNone) return stays;
    return And(stays, evaluator_.Truth(from_to->during, view));
  }
  const WhileRule& holds = RuleOf(instance).As<WhileRule>();
  if (!instance.open) {
    const Kleene begins = evaluator_.Truth(holds.condition, view);
    if (begins == Kleene::kFalse || holds.until == kNone) return Not(begins);
    if (!RuleOf(instance).anchors.empty()) return Kleene::kFalse;  // its steps tell
    return Not(And(begins, Not(evaluator_.Truth(holds.until, view))));
  }
  return holds.until == kNone ? evaluator_.Truth(holds.condition, view)
                              : Not(evaluator_.Truth(holds.until, view));
}

// Those who follow and look at entities, too: they see what happens if the others stay as they are,
// which is nothing, or else they follow no more.
void Engine::LookAhead(RuleId rule) {
  const FrameNumber now = history_.now();
  ++turn_;  // all that they ask about has had its turn
  ahead_count_ -= std::erase_if(ahead_[rule], [&](InstanceId index) {
    RuleInstance& instance = instances_[index];
    Following& following = following_[index];
    Kleene stays = Kleene::kTrue;
    if (instance.rule == rule && instance.follows) {
      instances_.Take(Beyond::kAsItWas);
      while (following.assumed <= now && stays == Kleene::kTrue) {
        stays = StaysAt(instance, following.assumed);
        if (stays == Kleene::kTrue) ++following.assumed;
      }
      instances_.Take(Beyond::kAsUnknown);
      const bool may_rest = stays == Kleene::kTrue && StaysAt(instance, now) == Kleene::kTrue;
      instances_.Take(Beyond::kAsAsked);
      if (stays == Kleene::kFalse || (may_rest && KnownOf(index) > now)) StopWaiting(instance);
    }
    following.is_listed = instance.rule == rule && instance.follows;
    return !following.is_listed;
  });
  --turn_;
}

// As far as all others are known it is as it was. Beyond that some of them may be enough: its steps
// tell. When its turn in this frame has come, all that it asks about is up to date; before, whoever
// rests may still be woken for this frame.
FrameNumber Engine::KnownOf(InstanceId follower) {
  RuleInstance& instance = instances_[follower];
  if (following_[instance.index].known_in == history_.now()) return instance.known;
  const bool had_its_turn = 2 * turns_[instance.rule] < turn_;
  const FrameNumber end = history_.now() + (had_its_turn ? 1 : 0);
  Following& following = following_[instance.index];
  const bool asks_followers = std::exchange(asks_followers_, true);
  if (following.is_ruled_out) {
    // Beyond that nothing can begin, but what it looks at itself may tell that nothing does.
    following.resumes = std::max(following.resumes, std::min(RuledOutUntil(instance), end));
    instance.next = std::max(instance.next, following.resumes);
    while (instance.next < end && StepFrame(instance)) continue;
  } else if (following.asks_only_others) {
    following.resumes = std::max(following.resumes, std::min(StaysUntil(instance), end));
    instance.next = following.resumes;
  } else {
    CatchUp(instance, end);
  }
  asks_followers_ = asks_followers;
  UpdateKnown(instance);
  if (had_its_turn) following.known_in = history_.now();
  return instance.known;
}

// As far as all that it asks about are known it is as it was. Beyond that some of them may be
// enough: its steps tell.
void Engine::CatchUp(RuleInstance& instance, FrameNumber end) {
  FrameNumber next = std::min(end, following_[instance.index].assumed);
  const auto* from_to = RuleOf(instance).If<FromToRule>();
  if (from_to != nullptr && !instance.open && begins_by_others_[instance.rule] != 0) {
    next = std::min(next, BoundOf(from_to->from, instance).known);
  } else {
    // Of those that say that nothing leads on, one is enough.
    if (follows_[instance.rule].by_since) next = std::min(next, RuledOutUntil(instance));
    ForEachFollowed(instance, follows_[instance.rule].of_until, [&](InstanceId index) {
      if (next > following_[instance.index].resumes)
        next = std::min(next, instances_.KnownOf(instances_[index]));
    });
  }
  Following& following = following_[instance.index];
  following.resumes = std::max(following.resumes, next);
  instance.next = std::max(instance.next, following.resumes);
  if (follows_[instance.rule].by_since) {
    auto& from = instance.As<UntilSinceState>().approach_from;
    from = std::max(from, following.resumes);
  }
  while (instance.next < std::min(end, following.assumed) && StepFrame(instance)) continue;
}

// Up to where nothing begins or ends, if it asks about nothing but others and these go on as they
// are: one that decides alone is enough.
FrameNumber Engine::StaysUntil(RuleInstance& instance) {
  const auto not_true = [](Bound one) { return Bound{!one.holds, one.known}; };
  switch (RuleOf(instance).form()) {
    case Form::kWhile: {
      const WhileRule& rule = RuleOf(instance).As<WhileRule>();
      if (rule.until == kNone) return BoundOf(rule.condition, instance).known;
      const Bound goes_on = not_true(BoundOf(rule.until, instance));
      return instance.open ? goes_on.known : Both(BoundOf(rule.condition, instance), goes_on).known;
    }
    case Form::kFromTo: {
      const FromToRule& rule = RuleOf(instance).As<FromToRule>();
      Bound stays = not_true(BoundOf(rule.to, instance));
      if (rule.during != kNone) stays = Both(stays, BoundOf(rule.during, instance));
      return instance.open ? stays.known : Both(BoundOf(rule.from, instance), stays).known;
    }
    case Form::kRestOf: {
      const RestOfRule& rule = RuleOf(instance).As<RestOfRule>();
      Bound rest = BoundOf(instances_.Resolve(instance, rule.whole));
      for (const int other : rule.outside) {
        if (!IsSettled(rest))
          rest = Both(rest, not_true(BoundOf(instances_.Resolve(instance, other))));
      }
      return rest.known;
    }
    case Form::kAny: {
      const int one = RuleOf(instance).As<AnyRule>().one;
      const auto& any = instance.As<AnyState>();
      if (RuleOf(instance).As<AnyRule>().at_least > 1) return CountStaysUntil(instance);
      Bound none{true, kNever};
      for (const InstanceId member : any.members) {
        const bool counts = one == kNone || !instance.open ||
                            instances_[member].entities[static_cast<std::size_t>(one)] == any.owner;
        if (counts) none = Both(none, not_true(BoundOf(member)));
      }
      return none.known;
    }
    case Form::kTouching:
    case Form::kUntilSince:
    case Form::kCompose:
      break;
  }
  return 0;  // they ask for more
}

// As long as so many hold for certain, or so few may.
FrameNumber Engine::CountStaysUntil(const RuleInstance& instance) const {
  const auto at_least = static_cast<std::size_t>(RuleOf(instance).As<AnyRule>().at_least);
  std::vector<FrameNumber> holding, others;  // up to where each is known to stay so
  for (const InstanceId member : instance.As<AnyState>().members) {
    const Bound bound = BoundOf(member);
    (bound.holds ? holding : others).push_back(bound.known);
  }
  std::ranges::sort(holding, std::greater<>());
  std::ranges::sort(others);
  if (holding.size() >= at_least) return holding[at_least - 1];
  const std::size_t missing = at_least - holding.size();
  return missing <= others.size() ? others[missing - 1] : kNever;
}

Engine::Bound Engine::Both(Bound a, Bound b) {
  if (a.holds && b.holds) return {true, std::min(a.known, b.known)};
  if (!a.holds && !b.holds) return {false, std::max(a.known, b.known)};
  return a.holds ? b : a;
}

Engine::Bound Engine::BoundOf(InstanceId index) const {
  if (index == kNone) return {false, kNever};
  const RuleInstance& other = instances_[index];
  const bool is_guessed =
      other.follows && !asks_followers_ && RuleOf(other).form() != Form::kUntilSince;
  return {other.open && other.certain, is_guessed   ? history_.now()
                                       : seen_only_ ? other.known
                                                    : instances_.KnownOf(other)};
}

// Of a condition: what it is as long as others go on as they are, and up to where that is known.
Engine::Bound Engine::BoundOf(NodeId index, RuleInstance& instance) {
  const Node& node = program_->nodes[index];
  const auto opposite = [](Bound one) { return Bound{!one.holds, one.known}; };
  if (node.op == Op::kAnd) {
    const Bound left = BoundOf(node.args[0], instance);
    return IsSettled(left) ? left : Both(left, BoundOf(node.args[1], instance));
  }
  if (node.op == Op::kOr) {
    const Bound left = opposite(BoundOf(node.args[0], instance));
    return opposite(IsSettled(left) ? left : Both(left, opposite(BoundOf(node.args[1], instance))));
  }
  if (node.op == Op::kKnown) return BoundOf(node.args[0], instance);
  if (node.op == Op::kNot) return opposite(BoundOf(node.args[0], instance));
  if (node.op == Op::kBegins || node.op == Op::kEnds) {
    const Bound of = BoundOf(node.args[0], instance);
    // What was so in the frame before does not become so.
    const bool is_past = program_->nodes[node.args[0]].op != Op::kHolds &&
                         of.holds == (node.op == Op::kBegins) && of.known != kNever;
    return {false, is_past ? of.known + 1 : of.known};
  }
  if (node.op != Op::kHolds && node.op != Op::kOwns)
    return {evaluator_.Truth(index, {instance, history_.now()}) == Kleene::kTrue, kNever};
  const InstanceId other = instances_.Resolve(instance, node.slot);
  Bound bound = BoundOf(other);
  if (node.op == Op::kOwns && bound.holds) {
    bound.holds = instances_[other].As<AnyState>().owner ==
                  instance.entities[static_cast<std::size_t>(node.roles[0])];
  }
  return bound;
}

// Up to where a condition is true, or false, by what others say as long as they go on as they are,
// whatever the entities do.
FrameNumber Engine::SettledByOthers(NodeId index, RuleInstance& instance, bool holds) {
  const Node& node = program_->nodes[index];
  if (node.op == Op::kNot) return SettledByOthers(node.args[0], instance, !holds);
  if (node.op == Op::kAnd || node.op == Op::kOr) {
    const FrameNumber left = SettledByOthers(node.args[0], instance, holds);
    const bool one_is_enough = (node.op == Op::kOr) == holds;
    if (one_is_enough ? left > history_.now() : left == 0) return left;
    const FrameNumber right = SettledByOthers(node.args[1], instance, holds);
    return one_is_enough ? std::max(left, right) : std::min(left, right);
  }
  if (node.op != Op::kHolds) return 0;
  const InstanceId other = instances_.Resolve(instance, node.slot);
  const bool is_open = other != kNone && instances_[other].open && instances_[other].certain;
  return is_open == holds ? BoundOf(other).known : 0;  // else nobody is asked
}

// Up to where nothing begins or leads on by what others say.
FrameNumber Engine::RuledOutUntil(RuleInstance& instance) {
  if (instance.open) return 0;
  if (const auto* holds = RuleOf(instance).If<WhileRule>())
    return SettledByOthers(holds->condition, instance, false);
  const auto* looks_back = RuleOf(instance).If<UntilSinceRule>();
  return looks_back == nullptr ? 0 : SettledByOthers(looks_back->since, instance, false);
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

void Engine::LetFollowersRest(RuleId rule) {
  const FrameNumber now = history_.now();
  ++turn_;  // all that they ask about has had its turn
  for (const InstanceId index : may_rest_[rule]) {
    RuleInstance& instance = instances_[index];
    if (!instance.follows) continue;
    if (following_[instance.index].asks_only_others) {
      asks_followers_ = false;  // who still follows after its turn is not known now
      const bool may_rest = StaysUntil(instance) > now;
      asks_followers_ = true;
      if (!may_rest) continue;
    }
    if (KnownOf(index) <= now) continue;
    // What goes on as nothing leads on does not rest.
    if (RuleOf(instance).form() != Form::kUntilSince || following_[instance.index].resumes > now)
      StopWaiting(instance);
  }
  --turn_;
  may_rest_[rule].clear();
}

// Who rests is told when what it asks about is known no longer. One that follows tells nobody: it
// does so no more, if it is known now.
void Engine::StopFollowers(const RuleInstance& resting) {
  ForEachReference(resting, [&](InstanceId index) {
    RuleInstance& other = instances_[index];
    if (!other.follows || other.known <= history_.now()) return;
    const FrameNumber next = other.next, known = other.known;
    StopWaiting(other);
    other.next = next;  // its turn in this frame is over, so what it decided counts
    other.known = known;
    other.reported = instances_.TruthAt(index, history_.now());
  });
}

// A frame that was held: who follows holds later ones as it gets on.
FrameNumber Engine::HeldFrom(const RememberedPast::Held& held) {
  constexpr FrameNumber kFramesBetween = 64;
  RuleInstance& instance = instances_[held.instance];
  if (!instance.follows || held.frame + kFramesBetween > history_.now()) return held.frame;
  instances_.KnownOf(instance);
  if (held.frame + kFramesBetween > following_[instance.index].resumes) return held.frame;
  following_[instance.index].held = following_[instance.index].resumes;
  if (RuleOf(instance).uses_looks) HoldLooks(instance);
  return following_[instance.index].held;
}

}  // namespace prehend::grammar
