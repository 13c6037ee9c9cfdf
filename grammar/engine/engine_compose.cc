// SPDX-License-Identifier: Apache-2.0
// Compositions: events made of finished events by Allen's relations.
//
// Needs: per composition and binding the combinations, one interval of each part, whose relations
// hold; each reaches from the begin of the first part to the end of the last. They do not overlap:
// the one that is complete first is taken, that is, whose last interval ends first; of those the
// one that ends first, then the one that begins last. Algorithm: parts deliver their intervals; a
// combination is judged as soon as no interval can still come that ends before it is complete. An
// interval that nothing to come can complete is forgotten. More than kMostRememberedSpans end the
// run: what is found never depends on memory. Tested by tests/grammar/engine/compose_test.cc
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grammar/engine/engine.h"

namespace prehend::grammar {
namespace {

std::size_t Remembered(const ComposeState& state) {
  std::size_t count = 0;
  for (const std::vector<Span>& spans : state.parts) count += spans.size();
  return count;
}

// Of some part there is no interval.
bool LacksOne(const ComposeRule& rule, const ComposeState& state) {
  return std::any_of(state.parts.begin(), state.parts.begin() + rule.count,
                     [](const std::vector<Span>& spans) { return spans.empty(); });
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
        const int list = whole.As<ComposeRule>().lists[static_cast<std::size_t>(part_of.part)];
        std::vector<Span>& spans = state.parts[static_cast<std::size_t>(list)];
        const auto later = std::ranges::upper_bound(
            spans, span.end.tick, {}, [](const Span& other) { return other.end.tick; });
        spans.insert(later, span)->judged = false;
        if (list < whole.As<ComposeRule>().count) ++state.unjudged;
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

// No interval of the instance that is still to come begins before this.
Moment Engine::BeginsFrom(const RuleInstance& instance) const {
  constexpr Tick kForgotten = 0;
  if (finishing_) return {kNever, kLatestTick + 1};
  if (RuleOf(instance).form() == Form::kCompose) {
    Moment from = PartsBeginFrom(instance.rule, instance.entities);
    const auto& rule = RuleOf(instance).As<ComposeRule>();
    for (std::size_t part = 0; part < rule.may_begin(); ++part) {
      for (const Span& span : instance.As<ComposeState>().parts[part]) {
        from = Earlier(from, span.begin);
        if (!rule.has_choices) break;
      }
    }
    return from;
  }
  Moment from = instance.open ? instance.begin : NextFrame();
  const FrameNumber known = instances_.KnownOf(instance);
  if (!instance.open && known <= history_.now())
    from = known < history_.first() ? Moment{known, kForgotten} : history_.At(known);
  for (const Pending& pending : instance.pending) from = Earlier(from, pending.span.begin);
  // Nobody asks how far back the next one may reach.
  const bool reaches_back =
      RuleOf(instance).form() == Form::kUntilSince && !RuleOf(instance).referenced;
  if (!reaches_back) return from;
  const bool lags = instance.awake && instance.next <= history_.now();
  return Earlier(from,
                 BackFrom(instance.rule, lags ? from.tick : history_.At(history_.now()).tick + 1));
}

// Likewise, of what a composition refers to, for these entities.
Moment Engine::BeginsFrom(const Reference& reference, const Binding& whole) const {
  Binding entities = kUnbound;
  for (std::size_t i = 0; i < program_->rules[reference.rule].roles.size(); ++i)
    entities[i] = whole[static_cast<std::size_t>(reference.roles[i])];
  const InstanceId index = instances_.Find(reference.rule, entities);
  if (index != kNone) return BeginsFrom(instances_[index]);
  // Nobody has looked at it yet.
  if (finishing_) return {kNever, kLatestTick + 1};
  const bool composed = program_->rules[reference.rule].form() == Form::kCompose;
  return composed ? PartsBeginFrom(reference.rule, entities)
                  : BackFrom(reference.rule, history_.At(history_.now()).tick + 1);
}

Moment Engine::PartsBeginFrom(RuleId rule, const Binding& entities) const {
  const auto& composition = program_->rules[rule].As<ComposeRule>();
  Moment from = NextFrame();
  for (std::size_t part = 0; part < composition.parts.size(); ++part) {
    if (!composition.MayBegin(part)) continue;
    const auto slot = static_cast<std::size_t>(composition.parts[part]);
    from = Earlier(from, BeginsFrom(program_->rules[rule].references[slot], entities));
  }
  return from;
}

// As far back as an interval of the rule may begin that ends at this tick or later.
Moment Engine::BackFrom(RuleId rule, Tick end) const {
  const Tick tick = end - rule_ticks_[rule].back;
  return {history_.FirstNotBefore(tick), tick};
}

// Of each part what is known of its intervals that are still to come. Those of a composition come
// when they are complete, not in the order of their ends.
void Engine::NoteWhatIsToCome(const RuleInstance& composition, FrameNumber settled) {
  to_come_.clear();
  const FrameNumber last = std::min(settled, history_.now());
  const auto& rule = RuleOf(composition).As<ComposeRule>();
  for (std::size_t part = 0; part < rule.parts.size(); ++part) {
    const auto slot = static_cast<std::size_t>(rule.parts[part]);
    const Reference& reference = RuleOf(composition).references[slot];
    const bool composed = program_->rules[reference.rule].form() == Form::kCompose;
    to_come_.push_back(
        {.begins_from = BeginsFrom(reference, composition.entities).tick,
         .ends_after = composed || last < history_.first() ? -1 : history_.At(last).tick});
    Combinations::ToCome& all = to_come_[static_cast<std::size_t>(rule.lists[part])];
    all.begins_from = std::min(all.begins_from, to_come_.back().begins_from);
    all.ends_after = std::min(all.ends_after, to_come_.back().ends_after);
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

// Of a composition that is not made yet: its first interval may be on its way.
FrameNumber Engine::SettledOfNone(const Reference& reference, const Binding& whole) const {
  FrameNumber settled = kNever;
  const auto* rule = program_->rules[reference.rule].If<ComposeRule>();
  if (rule == nullptr) return settled;
  Binding entities = kUnbound;
  for (std::size_t i = 0; i < program_->rules[reference.rule].roles.size(); ++i)
    entities[i] = whole[static_cast<std::size_t>(reference.roles[i])];
  for (const int slot : rule->parts) {
    const Reference& part =
        program_->rules[reference.rule].references[static_cast<std::size_t>(slot)];
    Binding of_part = kUnbound;
    for (std::size_t i = 0; i < program_->rules[part.rule].roles.size(); ++i)
      of_part[i] = entities[static_cast<std::size_t>(part.roles[i])];
    const InstanceId index = instances_.Find(part.rule, of_part);
    settled = std::min(settled,
                       index != kNone ? Settled(instances_[index]) : SettledOfNone(part, entities));
  }
  return settled;
}

FrameNumber Engine::PartsSettled(const RuleInstance& composition) const {
  FrameNumber settled = finishing_ ? kNever : history_.now();
  const auto& rule = RuleOf(composition).As<ComposeRule>();
  for (const int part : rule.parts) {
    const InstanceId index = instances_.Find(composition, part);
    if (index != kNone) {
      settled = std::min(settled, Settled(instances_[index]));
    } else {
      const Reference& reference = RuleOf(composition).references[static_cast<std::size_t>(part)];
      settled = std::min(settled, SettledOfNone(reference, composition.entities));
    }
  }
  // What must be absent may have begun long before it is out.
  for (const ComposeRule::Absence& absence : rule.absences) {
    const auto slot = static_cast<std::size_t>(rule.parts[static_cast<std::size_t>(absence.part)]);
    const Moment from = BeginsFrom(RuleOf(composition).references[slot], composition.entities);
    settled = std::min(settled, from.frame == kNever ? kNever : from.frame - 1);
  }
  return settled;
}

// Of some part there is no interval, and of the others none that may be forgotten later: each new
// one wakes it.
bool Engine::LacksAPart(const RuleInstance& composition) const {
  const auto& rule = RuleOf(composition).As<ComposeRule>();
  if (rule.at_least > 0) return false;
  const auto& parts = composition.As<ComposeState>().parts;
  const auto is_settled = [&](const Span& span) {
    return span.Complete().frame < composition.next;
  };
  return LacksOne(rule, composition.As<ComposeState>()) &&
         std::ranges::all_of(
             parts, [&](const auto& spans) { return std::ranges::all_of(spans, is_settled); });
}

void Engine::StepCompose(RuleInstance& instance) {
  auto& state = instance.As<ComposeState>();
  const auto& rule = RuleOf(instance).As<ComposeRule>();
  instance.by_itself = false;
  const FrameNumber settled = PartsSettled(instance);
  const auto next = [&] {
    return rule.at_least > 0 ? NextRepeated(instance, settled) : NextComposed(instance, settled);
  };
  while (const std::optional<Span> whole = next()) {
    state.last_end = whole->end.frame;
    // The next one begins with a first part that begins, and ends with a last part that ends, later
    // than this ends.
    for (std::size_t part = 0; part < rule.may_begin(); ++part)
      state.Drop(part, [&](const Span& span) { return span.begin.frame < state.last_end; });
    if (!rule.hull && rule.at_least == 0)
      state.Drop(static_cast<std::size_t>(rule.count) - 1,
                 [&](const Span& span) { return span.end.frame <= state.last_end; });
    Conclude(instance, *whole);
  }
  const bool looks = RuleOf(instance).referenced || Remembered(state) >= state.next_look;
  if (looks && rule.at_least == 0) ForgetHopeless(instance, settled);
  instance.next = instance.known = std::min(settled, history_.now()) + 1;
  if ((!RuleOf(instance).referenced && rule.at_least == 0) || finishing_) return;
  instance.known = std::min(instance.known, BeginsFrom(instance).frame);
  // What is decided when the time is over is out later than what ends then.
  if (rule.at_least > 0) instance.next = instance.known;
}

// `repeat .. within`: the first interval with which so many last no longer than the rule says, and
// as many as do.
std::optional<Span> Engine::NextRepeated(RuleInstance& instance, FrameNumber settled) {
  auto& state = instance.As<ComposeState>();
  const auto& rule = RuleOf(instance).As<ComposeRule>();
  const Tick known = finishing_                   ? kLatestTick + 1
                     : settled < history_.first() ? -1
                                                  : history_.At(settled).tick;
  for (std::size_t part = 0; part < state.parts.size(); ++part)
    state.Drop(part, [&](const Span& span) { return span.begin.frame < state.last_end; });
  for (;;) {
    const Span* first = nullptr;
    for (const std::vector<Span>& spans : state.parts) {
      if (!spans.empty() && (first == nullptr || spans.front().begin.tick < first->begin.tick))
        first = &spans.front();
    }
    if (first == nullptr) return std::nullopt;
    const Moment begin = first->begin;
    const Tick last = begin.tick + TicksOf(instance).within;
    // Some that begin or end sooner may be out later: what reaches back, and what is composed.
    NoteWhatIsToCome(instance, settled);
    const bool may_come = std::ranges::any_of(to_come_, [&](const Combinations::ToCome& part) {
      return part.begins_from < (part.ends_after < 0 ? last : begin.tick);
    });
    if (known < last || may_come) return std::nullopt;
    Span whole{.begin = begin, .end = begin};
    int count = 0;
    bool has_first = false;
    for (const std::vector<Span>& spans : state.parts) {
      for (const Span& span : spans) {
        if (span.end.tick > last) break;
        ++count;
        has_first = has_first || span.begin.tick == begin.tick;
        if (span.end.tick <= whole.end.tick) continue;
        whole.end = span.end;
        whole.open_end = span.open_end;
      }
    }
    if (count >= rule.at_least && has_first) return whole;
    const auto is_first = [&](const Span& span) { return span.begin.tick == begin.tick; };
    for (std::size_t part = 0; part < state.parts.size(); ++part) state.Drop(part, is_first);
  }
}

// The composition that is complete first, of those that no interval to come can complete sooner.
std::optional<Span> Engine::NextComposed(RuleInstance& instance, FrameNumber settled) {
  auto& state = instance.As<ComposeState>();
  const auto& rule = RuleOf(instance).As<ComposeRule>();
  while (state.unjudged > 0) {
    // Of the intervals that are new: those that are complete first.
    auto& newest = newest_;
    newest.clear();
    for (std::size_t part = 0; part < state.parts.size(); ++part) {
      if (part >= static_cast<std::size_t>(rule.count)) break;
      std::vector<Span>& spans = state.parts[part];
      for (auto one = spans.rbegin(); one != spans.rend(); ++one) {
        Span& span = *one;
        if (span.judged && !rule.has_choices) break;
        if (span.judged || span.Complete().frame > settled) continue;
        if (!newest.empty() && span.Complete().tick < newest.front().second->Complete().tick)
          newest.clear();
        if (newest.empty() || span.Complete().tick == newest.front().second->Complete().tick)
          newest.emplace_back(part, &span);
      }
    }
    if (newest.empty()) return std::nullopt;
    std::optional<Span> best;
    const bool has_all = !LacksOne(rule, state);
    if (has_all) combinations_.LookAt(rule, state, TicksOf(instance));
    for (const auto& [part, span] : newest) {
      if (!has_all) break;
      const std::optional<Span> one = combinations_.Best(part, *span);
      const auto key = [&](const Span& whole) {
        return rule.hull ? std::pair(-whole.begin.tick, whole.end.tick)
                         : std::pair(whole.end.tick, rule.BySkip(whole.begin.tick));
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
  state.next_look = 0;
  if (Remembered(state) == 0) return;
  NoteWhatIsToCome(instance, settled);
  combinations_.LookAt(RuleOf(instance).As<ComposeRule>(), state, TicksOf(instance));
  const auto count = static_cast<std::size_t>(RuleOf(instance).As<ComposeRule>().count);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t part = 0; part < state.parts.size(); ++part) {
      again |=
          std::erase_if(state.parts[part], [&](const Span& span) {
            return (span.judged || part >= count) && combinations_.IsHopeless(part, span, to_come_);
          }) > 0;
    }
  }
  constexpr std::size_t kFew = 64;
  const std::size_t left = Remembered(state);
  state.next_look = left <= kFew ? 0 : 2 * left;
}

}  // namespace prehend::grammar
