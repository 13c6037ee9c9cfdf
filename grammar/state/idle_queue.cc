// SPDX-License-Identifier: Apache-2.0
// Which instances can be freed, and what goes with them.
#include "grammar/state/idle_queue.h"

#include <algorithm>

namespace prehend::grammar {

void IdleQueue::FreeOld() {
  while (!queue_.empty() && IsOld(queue_.front())) {
    RuleInstance& instance = instances_[queue_.front().instance];
    queue_.PopFront();
    instance.idle_queued = false;
    if (instance.awake || instance.open) continue;  // it is queued when it rests again
    candidates_.assign(1, instance.index);
    while (!candidates_.empty()) FreeOrQueue(candidates_);
  }
}

// Most instances that only a freed one asked about have rested for as long: they are candidates,
// too, so that the whole chain goes at once.
void IdleQueue::FreeOrQueue(std::vector<InstanceId>& candidates) {
  RuleInstance& instance = instances_[candidates.back()];
  candidates.pop_back();
  if (instance.rule == kNone || instance.awake || instance.open || instance.idle_queued) return;
  if (instance.resting_since >= history_.first()) {
    Queue(instance);
  } else if (CanBeFreed(instance)) {
    instances_.Free(instance.index, candidates);
  }
}

bool IdleQueue::CanBeFreed(const RuleInstance& instance) const {
  if (RuleOf(instance).form() != Form::kTouching && !instances_.GuardRests(instance)) return false;
  // An instance that asks about this one must be woken by it, unless it is made by it.
  const auto depends = [&](const Watcher& watcher) {
    return RuleOf(instances_[watcher.instance]).form() != Form::kAny;
  };
  if (std::ranges::any_of(instance.watchers, depends)) return false;
  const auto* composition = instance.If<ComposeState>();
  if (composition == nullptr) return true;
  const auto remembers = [](const std::vector<Span>& spans) { return !spans.empty(); };
  return std::ranges::none_of(composition->parts, remembers) && !MayOverlap(instance);
}

// A part is on its way that may begin before the end of the last composition; so that end has to be
// remembered.
bool IdleQueue::MayOverlap(const RuleInstance& instance) const {
  const auto& composition = RuleOf(instance).As<ComposeRule>();
  for (std::size_t part = 0; part < composition.parts.size(); ++part) {
    if (!composition.MayBegin(part)) continue;
    const InstanceId index = instances_.Find(instance, composition.parts[part]);
    if (index == kNone) continue;
    const RuleInstance& first = instances_[index];
    if (first.open || first.awake || !first.pending.empty() ||
        RuleOf(first).form() == Form::kCompose)
      return true;
  }
  return false;
}

}  // namespace prehend::grammar
