// SPDX-License-Identifier: Apache-2.0
// Instances that wait for others, and how they catch up.
//
// Needs: an instance cannot decide a frame while the truth of another one is unknown there, and the
// other one need not tell for long: the shortest duration of its interval, a gap that may be
// bridged. Algorithm: if nothing but others can decide the frame, the instance waits; one that is
// awaited tells when its truth becomes known further than before. The frames that were missed are
// then stepped where something changes that the instance asks about; between two changes a step
// finds what the last one found. That is what lets instances rest, too (Engine::MayRest()).
// Tested by tests/grammar/monitor_test.cc and tests/grammar/reference/reference_test.cc
#include <algorithm>

#include "grammar/engine/engine.h"

namespace prehend::grammar {
namespace {

// Where the truth of an instance changes, or becomes unknown.
FrameNumber NextEdge(const RuleInstance& instance, FrameNumber after) {
  FrameNumber next = kNever;
  const auto consider = [&](FrameNumber frame) {
    if (frame > after) next = std::min(next, frame);
  };
  consider(instance.known);
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
  if (instance.next > history_.now() || !instance.pending.empty() || evaluator_.depends_on_time() ||
      RuleOf(instance).form() == Form::kCompose || !program_->waits ||
      (looks_at_all_ && RuleOf(instance).uses_looks))
    return false;
  ForEachReference(instance, [&](InstanceId index) {
    RuleInstance& other = instances_[index];
    if (other.known > instance.next) return;
    other.awaited = instance.waits = true;
  });
  if (!instance.waits) return false;
  past_.Hold(OldestNeeded(instance), instance.index,
             [this](const auto& held) { return IsHeld(held); });
  if (RuleOf(instance).uses_looks) HoldLooks(instance);
  return true;
}

// Of the entities that play its roles: it asks for no others.
void Engine::HoldLooks(const RuleInstance& instance) {
  for (std::size_t role = 0; role < RuleOf(instance).roles.size(); ++role) {
    past_.HoldLooks(instance.entities[role], OldestNeeded(instance), instance.index, history_,
                    [this](const auto& held) { return IsHeld(held); });
  }
}

void Engine::Tell(RuleInstance& instance) {
  instance.awaited = false;
  for (const Watcher& watcher : instance.watchers) {
    if (instances_[watcher.instance].waits) StopWaiting(instances_[watcher.instance]);
  }
}

void Engine::StopWaiting(RuleInstance& instance) {
  instance.waits = false;
  awake_[instance.rule].push_back(instance.index);
  ++awake_count_;
}

// Whether something that it asks about is known up to its next frame, and no further.
bool Engine::IsAtTheKnown(const RuleInstance& instance) const {
  bool is_there = false;
  ForEachReference(instance, [&](InstanceId index) {
    is_there = is_there || instances_[index].known == instance.next;
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
    next = std::min(next, NextEdge(instances_[index], after));
  });
  const Rule& rule = RuleOf(instance);
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (rule.watches_pose[role] || rule.watches_grip[role])
      next = std::min(next, history_.NextChange(instance.entities[role], after));
  }
  return next;
}

}  // namespace prehend::grammar
