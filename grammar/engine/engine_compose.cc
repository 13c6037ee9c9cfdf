// SPDX-License-Identifier: Apache-2.0
// Compositions: events made of finished events by Allen's relations.
//
// Needs: per composition and binding the combinations, one interval of each part, whose relations
// hold; each reaches from the begin of the first part to the end of the last. They do not overlap:
// the one that is complete first is taken, that is, whose last interval ends first; of those the
// one that ends first, then the one that begins last. Algorithm: parts deliver their intervals; a
// combination is judged as soon as no interval can still come that ends before it is complete. An
// interval that nothing to come can complete is forgotten, and of the others only the last
// kRememberedSpans of a part are kept.
// Tested by tests/grammar/engine/compose_test.cc
#include <algorithm>
#include <optional>

#include "grammar/base/allen.h"
#include "grammar/engine/combinations.h"
#include "grammar/engine/engine.h"

namespace prehend::grammar {
namespace {

constexpr AllenSet Bits(std::initializer_list<Allen> relations) {
  AllenSet bits = 0;
  for (const Allen relation : relations) bits |= Bit(relation);
  return bits;
}

// How an interval lies to one that ends earlier, and to one that ends later.
constexpr AllenSet kToEarlier =
    Bits({Allen::kContains, Allen::kStartedBy, Allen::kOverlappedBy, Allen::kMetBy, Allen::kAfter});
constexpr AllenSet kToLater =
    Bits({Allen::kBefore, Allen::kMeets, Allen::kOverlaps, Allen::kStarts, Allen::kDuring});

// Some relation to another part holds to none of the remembered intervals, nor to one that ends
// later than all of them. Compositions come in the order in which they are complete, not in that of
// their ends, so all may still be hoped of them.
bool IsHopeless(const Program& program, const Rule& rule, const ComposeState& state, int part,
                const Span& span) {
  const ComposeRule& composition = rule.As<ComposeRule>();
  return std::any_of(
      composition.clauses.begin(), composition.clauses.end(),
      [&](const ComposeRule::Clause& clause) {
        if (clause.left == clause.right || (clause.left != part && clause.right != part))
          return false;
        const bool is_left = clause.left == part;
        const int other = is_left ? clause.right : clause.left;
        if (program.rules[rule.references[composition.parts[other]].rule].form() == Form::kCompose)
          return false;
        if ((clause.relations & (is_left ? kToLater : kToEarlier)) != 0) return false;
        const std::vector<Span>& others = state.parts[other];
        return std::none_of(others.begin(), others.end(), [&](const Span& one) {
          const Allen relation =
              is_left ? Relate(TicksOf(span), TicksOf(one)) : Relate(TicksOf(one), TicksOf(span));
          return (Bit(relation) & clause.relations) != 0;
        });
      });
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
        std::vector<Span>& spans = instances_[index].As<ComposeState>().parts[part_of.part];
        if (spans.size() == kRememberedSpans) spans.erase(spans.begin());
        spans.push_back(span);
        Wake(index);
      }
    }
  }
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
  const Rule& rule = RuleOf(instance);
  auto& state = instance.As<ComposeState>();
  instance.by_itself = false;
  const FrameNumber settled = PartsSettled(instance);
  for (;;) {
    const std::optional<Span> whole =
        Combinations(rule.As<ComposeRule>(), state, TicksOf(instance).gaps, settled).Best();
    if (!whole) break;
    state.last_end = whole->end.frame;
    // The next one begins with a first part that begins, and ends with a last part that ends, later
    // than this ends.
    std::erase_if(state.parts.front(),
                  [&](const Span& span) { return span.begin.frame < state.last_end; });
    std::erase_if(state.parts.back(),
                  [&](const Span& span) { return span.end.frame <= state.last_end; });
    Conclude(instance, *whole);
  }
  for (bool again = true; again;) {
    again = false;
    for (std::size_t part = 0; part < state.parts.size(); ++part) {
      again |= std::erase_if(state.parts[part], [&](const Span& span) {
                 return span.Complete().frame <= settled &&
                        IsHopeless(*program_, rule, state, static_cast<int>(part), span);
               }) > 0;
    }
  }
  instance.next = instance.known = std::min(settled, history_.now()) + 1;
}

}  // namespace prehend::grammar
