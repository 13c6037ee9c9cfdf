// SPDX-License-Identifier: Apache-2.0
// Compositions: events made of finished events by Allen's relations.
//
// Needs: per composition and binding the combinations, one interval of each part, whose relations
// hold; each reaches from the begin of the first part to the end of the last. They do not overlap:
// the one that is complete first is taken, that is, whose last interval ends first; of those the
// one that ends first, then the one that begins last. Algorithm: parts deliver their intervals; a
// combination is judged as soon as no interval can still come that ends before it is complete. An
// interval that nothing to come can complete is forgotten. More than kMostRememberedSpans end the
// run: what is found never depends on memory.
// Tested by tests/grammar/engine/compose_test.cc
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grammar/engine/engine.h"
#include "grammar/engine/frame_checks.h"

namespace prehend::grammar {
namespace {

std::size_t Remembered(const ComposeState& state) {
  std::size_t count = 0;
  for (const std::vector<Span>& spans : state.parts) count += spans.size();
  return count;
}

}  // namespace

// Roles of the composition that the part does not name are free: its interval counts for every
// entity that can play them.
void Engine::NotifyCompositions(const RuleInstance& part, const Span& span) {
  for (const PartOf& part_of : RuleOf(part).part_of) {
    const Rule& whole = program_->rules[part_of.rule];
    const Reference& reference = whole.references[whole.As<ComposeRule>().parts[part_of.part]];
    for (int order = 0; order < (RuleOf(part).symmetric ? 2 : 1); ++order) {
      Binding from = part.entities;
      if (order == 1) std::swap(from[0], from[1]);
      Binding entities = kUnbound;
      for (std::size_t i = 0; i < RuleOf(part).roles.size(); ++i)
        entities[reference.roles[i]] = from[i];
      notified_.clear();
      instances_.EnsureAll(part_of.rule, entities, notified_);
      for (const InstanceId index : notified_) {
        auto& state = instances_[index].As<ComposeState>();
        std::vector<Span>& spans = state.parts[part_of.part];
        const auto later = std::ranges::upper_bound(
            spans, span.end.tick, {}, [](const Span& other) { return other.end.tick; });
        spans.insert(later, span)->judged = false;
        ++state.unjudged;
        if (Remembered(state) > kMostRememberedSpans) error_ = WhyTooMany(whole);
        Wake(index);
      }
    }
  }
}

std::string Engine::WhyTooMany(const Rule& composition) {
  return "more than " + std::to_string(kMostRememberedSpans) +
         " intervals may still become part of '" + composition.name +
         "': say how far apart its parts are at most: a before within 10 s b";
}

// No interval of the instance that is still to come begins before this tick.
Tick Engine::BeginsFrom(const RuleInstance& instance) const {
  if (finishing_) return kLatestTick + 1;
  const Tick now = history_.At(history_.now()).tick;
  Tick from = now + 1;
  const Rule& rule = RuleOf(instance);
  if (rule.form() == Form::kCompose) {
    const InstanceId first = instances_.Find(instance, rule.As<ComposeRule>().parts.front());
    if (first != kNone) from = BeginsFrom(instances_[first]);
    for (const Span& span : instance.As<ComposeState>().parts.front())
      from = std::min(from, span.begin.tick);
    return from;
  }
  if (instance.open) return instance.begin.tick;
  const FrameNumber known = instances_.KnownOf(instance);
  if (known <= history_.now()) from = known < history_.first() ? 0 : history_.At(known).tick;
  for (const Pending& pending : instance.pending) from = std::min(from, pending.span.begin.tick);
  // Nobody asks how far back the next one may reach.
  if (rule.form() == Form::kUntilSince && !rule.referenced)
    from = std::min(from, now + 1 - TicksOf(instance).back);
  return from;
}

// Of each part what is known of its intervals that are still to come. Those of a composition come
// when they are complete, not in the order of their ends.
void Engine::NoteWhatIsToCome(const RuleInstance& composition, FrameNumber settled) {
  to_come_.clear();
  const FrameNumber last = std::min(settled, history_.now());
  for (const int slot : RuleOf(composition).As<ComposeRule>().parts) {
    const InstanceId index = instances_.Find(composition, slot);
    const bool composed =
        program_->rules[RuleOf(composition).references[slot].rule].form() == Form::kCompose;
    to_come_.push_back(
        {.begins_from =
             index != kNone ? BeginsFrom(instances_[index]) : UnbornFrom(slot, composition),
         .ends_after = composed || last < history_.first() ? -1 : history_.At(last).tick});
  }
}

// Likewise, of one that nobody has looked at yet.
Tick Engine::UnbornFrom(int slot, const RuleInstance& composition) const {
  const RuleId rule = RuleOf(composition).references[slot].rule;
  return finishing_ ? kLatestTick + 1
                    : history_.At(history_.now()).tick + 1 - rule_ticks_[rule].back;
}

// All intervals of the instance that end at or before this frame are out; of a composition, all
// that are complete by then.
FrameNumber Engine::Settled(const RuleInstance& instance) const {
  // A composition rests though its parts do not, as each of their intervals wakes it.
  if (RuleOf(instance).form() == Form::kCompose && !instance.awake) return PartsSettled(instance);
  if (instance.follows) instances_.KnownOf(instance);  // brings it up to date
  FrameNumber settled = instance.awake ? instance.next - 1 : finishing_ ? kNever : history_.now();
  if (instance.in_gap) settled = std::min(settled, instance.gap.frame - 1);
  for (const Pending& pending : instance.pending)
    settled = std::min(settled, pending.span.end.frame - 1);
  return settled;
}

FrameNumber Engine::PartsSettled(const RuleInstance& composition) const {
  FrameNumber settled = finishing_ ? kNever : history_.now();
  for (const int part : RuleOf(composition).As<ComposeRule>().parts) {
    const InstanceId index = instances_.Find(composition, part);
    if (index != kNone) settled = std::min(settled, Settled(instances_[index]));
  }
  return settled;
}

// Of some part there is no interval, and of the others none that may be forgotten later: each new
// one wakes it.
bool Engine::LacksAPart(const RuleInstance& composition) {
  const auto& parts = composition.As<ComposeState>().parts;
  const auto is_settled = [&](const Span& span) {
    return span.Complete().frame < composition.next;
  };
  return std::ranges::any_of(parts, [](const auto& spans) { return spans.empty(); }) &&
         std::ranges::all_of(
             parts, [&](const auto& spans) { return std::ranges::all_of(spans, is_settled); });
}

void Engine::StepCompose(RuleInstance& instance) {
  auto& state = instance.As<ComposeState>();
  instance.by_itself = false;
  const FrameNumber settled = PartsSettled(instance);
  while (const std::optional<Span> whole = NextComposed(instance, settled)) {
    state.last_end = whole->end.frame;
    // The next one begins with a first part that begins, and ends with a last part that ends, later
    // than this ends.
    const auto drop = [&](std::vector<Span>& spans, const auto& is_over) {
      state.unjudged -= static_cast<std::size_t>(std::ranges::count_if(
          spans, [&](const Span& span) { return is_over(span) && !span.judged; }));
      std::erase_if(spans, is_over);
    };
    drop(state.parts.front(), [&](const Span& span) { return span.begin.frame < state.last_end; });
    drop(state.parts.back(), [&](const Span& span) { return span.end.frame <= state.last_end; });
    Conclude(instance, *whole);
  }
  if (Remembered(state) >= state.next_look) ForgetHopeless(instance, settled);
  instance.next = instance.known = std::min(settled, history_.now()) + 1;
}

// The composition that is complete first, of those that no interval to come can complete sooner.
std::optional<Span> Engine::NextComposed(RuleInstance& instance, FrameNumber settled) {
  auto& state = instance.As<ComposeState>();
  while (state.unjudged > 0) {
    // Of the intervals that are new: those that are complete first.
    auto& newest = newest_;
    newest.clear();
    for (std::size_t part = 0; part < state.parts.size(); ++part) {
      std::vector<Span>& spans = state.parts[part];
      for (auto one = spans.rbegin(); one != spans.rend() && !one->judged; ++one) {
        Span& span = *one;
        if (span.Complete().frame > settled) continue;
        if (!newest.empty() && span.Complete().tick < newest.front().second->Complete().tick)
          newest.clear();
        if (newest.empty() || span.Complete().tick == newest.front().second->Complete().tick)
          newest.emplace_back(part, &span);
      }
    }
    if (newest.empty()) return std::nullopt;
    combinations_.LookAt(RuleOf(instance).As<ComposeRule>(), state, TicksOf(instance).clauses);
    std::optional<Span> best;
    for (const auto& [part, span] : newest) {
      const std::optional<Span> one = combinations_.Best(part, *span);
      const auto key = [](const Span& whole) {
        return std::pair(whole.end.tick, -whole.begin.tick);
      };
      if (one && (!best || key(*one) < key(*best))) best = one;
    }
    if (best) return best;
    for (const auto& [part, span] : newest) span->judged = true;
    state.unjudged -= newest.size();
  }
  return std::nullopt;
}

void Engine::ForgetHopeless(RuleInstance& instance, FrameNumber settled) {
  auto& state = instance.As<ComposeState>();
  NoteWhatIsToCome(instance, settled);
  combinations_.LookAt(RuleOf(instance).As<ComposeRule>(), state, TicksOf(instance).clauses);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t part = 0; part < state.parts.size(); ++part) {
      again |= std::erase_if(state.parts[part], [&](const Span& span) {
                 return span.judged && combinations_.IsHopeless(part, span, to_come_);
               }) > 0;
    }
  }
  constexpr std::size_t kFew = 64;
  const std::size_t left = Remembered(state);
  state.next_look = left <= kFew ? 0 : 2 * left;
}

}  // namespace prehend::grammar
