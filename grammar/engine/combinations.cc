// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine/combinations.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "grammar/base/allen.h"
#include "grammar/base/check.h"

namespace prehend::grammar {
namespace {

constexpr Tick kEndless = std::numeric_limits<Tick>::max() / 4;

}  // namespace

void Combinations::LookAt(const ComposeRule& composition, const ComposeState& state,
                          const RuleTicks& ticks) {
  rule_ = &composition;
  state_ = &state;
  within_ = ticks.within;
  count_ = static_cast<std::size_t>(composition.count);
  links_.clear();
  for (std::size_t i = 0; i < composition.clauses.size(); ++i) {
    const ComposeRule::Clause& clause = composition.clauses[i];
    Add({.part = static_cast<std::size_t>(clause.left),
         .other = static_cast<std::size_t>(clause.right),
         .relations = &ticks.clauses[i]});
  }
  for (const ComposeRule::Absence& absence : composition.absences) {
    Add({.part = static_cast<std::size_t>(absence.left),
         .other = static_cast<std::size_t>(absence.right),
         .absent = &state.parts[static_cast<std::size_t>(absence.part)]});
  }
}

// There and back.
void Combinations::Add(Link link) {
  if (link.part == link.other) return;  // it equals itself, or the grammar is refused
  for (int way = 0; way < 2; ++way) {
    AddReach(link);
    links_.push_back(link);
    std::swap(link.part, link.other);
    link.mirrored = true;
  }
}

void Combinations::AddReach(Link& link) const {
  link.ahead = link.behind = link.relations == nullptr ? kEndless : 0;
  for (std::size_t i = 0; link.relations != nullptr && i < kAllenNames.size(); ++i) {
    if ((link.relations->any >> i & 1) == 0) continue;
    const auto relation = static_cast<Allen>(i);
    const Allen seen = link.mirrored ? Inverse(relation) : relation;
    const bool is_gap = seen == Allen::kBefore || seen == Allen::kAfter;
    const Tick said = link.relations->within[i];
    const Tick reach = said >= 0 ? said : is_gap ? kEndless : 0;
    if (seen != Allen::kAfter) link.ahead = std::max(link.ahead, reach);
    if (seen != Allen::kBefore) link.behind = std::max(link.behind, reach);
  }
}

namespace {

// Some of these intervals holds somewhere from one tick to another.
bool SomeHolds(const std::vector<Span>& spans, Tick from, Tick to) {
  const auto first =
      std::ranges::upper_bound(spans, from, {}, [](const Span& span) { return span.end.tick; });
  return from < to && first != spans.end() && first->begin.tick < to;
}

}  // namespace

bool Combinations::Link::Fit(const Span& span, const Span& of_other) const {
  const Interval left = TicksOf(mirrored ? of_other : span);
  const Interval right = TicksOf(mirrored ? span : of_other);
  return relations != nullptr ? relations->Fit(left, right)
                              : !SomeHolds(*absent, left.end, right.begin);
}

/// What is to come begins and ends no earlier than is known of it; so only what limits its begin or
/// its end from above can exclude it.
bool Combinations::Link::MayFit(const Span& span, const ToCome& to_come) const {
  if (relations == nullptr)
    return mirrored || !SomeHolds(*absent, span.end.tick, to_come.begins_from);
  for (std::size_t i = 0; i < relations->within.size(); ++i) {
    if ((relations->any >> i & 1) == 0) continue;
    const auto relation = static_cast<Allen>(i);
    const Tick within = relations->within[i];
    const Tick apart = std::max<Tick>(within, 0);
    Tick begin = kEndless, end = kEndless;              // the latest that the other one can have
    switch (mirrored ? Inverse(relation) : relation) {  // the interval lies to it
      case Allen::kBefore:
        begin = within < 0 ? kEndless : span.end.tick + within;
        break;
      case Allen::kMeets:
        begin = span.end.tick + apart;
        break;
      case Allen::kOverlaps:
        begin = span.end.tick - 1;
        break;
      case Allen::kStarts:
        begin = span.begin.tick + apart;
        break;
      case Allen::kDuring:
        begin = span.begin.tick - 1;
        break;
      case Allen::kFinishes:
        begin = span.begin.tick - 1;
        end = span.end.tick + apart;
        break;
      case Allen::kEquals:
        begin = span.begin.tick + apart;
        end = span.end.tick + apart;
        break;
      case Allen::kFinishedBy:
        end = span.end.tick + apart;
        break;
      case Allen::kStartedBy:
        begin = span.begin.tick + apart;
        [[fallthrough]];
      case Allen::kContains:
      case Allen::kOverlappedBy:
        end = span.end.tick - 1;
        break;
      case Allen::kMetBy:
        end = span.begin.tick + apart;
        break;
      case Allen::kAfter:
        end = span.begin.tick - 1;
        break;
    }
    if (begin >= to_come.begins_from && end > to_come.ends_after) return true;
  }
  return false;
}

bool Combinations::HasPartner(const Span& span, const Link& link, const Choices& others) const {
  auto other = std::ranges::lower_bound(others, span.begin.tick - link.behind, {},
                                        [](const Span* one) { return one->end.tick; });
  for (; other != others.end(); ++other) {
    if ((*other)->begin.tick > span.end.tick + link.ahead) {
      if (!rule_->has_choices) break;
      continue;
    }
    const bool fits = std::ranges::all_of(links_, [&](const Link& all) {
      return all.part != link.part || all.other != link.other || all.Fit(span, **other);
    });
    if (fits) return true;
  }
  return false;
}

// What must be absent matters as long as some interval may end before it.
bool Combinations::IsAbsenceOver(std::size_t part, const Span& span,
                                 const std::vector<ToCome>& to_come) const {
  return std::ranges::all_of(rule_->absences, [&](const ComposeRule::Absence& absence) {
    const auto left = static_cast<std::size_t>(absence.left);
    const std::vector<Span>& before = state_->parts[left];
    return static_cast<std::size_t>(absence.part) != part ||
           (span.end.tick <= to_come[left].last_tick_before_end() &&
            (before.empty() || before.front().end.tick >= span.end.tick));
  });
}

bool Combinations::IsHopeless(std::size_t part, const Span& span,
                              const std::vector<ToCome>& to_come) const {
  if (part >= count_) return IsAbsenceOver(part, span, to_come);
  if (rule_->hull) {  // whatever completes it ends too late
    bool is_too_late = true;
    for (std::size_t other = 0; other < count_; ++other) {
      const Tick after =
          state_->unjudged > 0 ? to_come[other].ends_after : to_come[other].last_tick_before_end();
      is_too_late = is_too_late && (other == part || after >= span.begin.tick + within_);
    }
    if (is_too_late) return true;
  }
  return std::ranges::any_of(links_, [&](const Link& link) {
    if (link.part != part || link.MayFit(span, to_come[link.other])) return false;
    const std::vector<Span>& others = state_->parts[link.other];
    auto other = std::ranges::lower_bound(others, span.begin.tick - link.behind, {},
                                          [](const Span& one) { return one.end.tick; });
    for (; other != others.end(); ++other) {
      const bool is_far = other->begin.tick > span.end.tick + link.ahead;
      if (is_far && !rule_->has_choices) break;
      if (!is_far && link.Fit(span, *other)) return false;
    }
    return true;
  });
}

bool Combinations::IsSomeEmpty(const AllChoices& choices) const {
  return std::any_of(choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(count_),
                     [](const Choices& some) { return some.empty(); });
}

/// Removes what fits no choice of another part; false: some part has nothing left.
bool Combinations::MakeConsistent(AllChoices& choices) const {
  for (bool changed = true; changed;) {
    changed = false;
    for (const Link& link : links_) {
      changed |= std::erase_if(choices[link.part], [&](const Span* span) {
                   return !HasPartner(*span, link, choices[link.other]);
                 }) > 0;
    }
    if (IsSomeEmpty(choices)) return false;
    if (rule_->hull) continue;
    // It ends after it begins.
    const auto keep = [&](Choices& some, const auto& fits) {
      changed |= std::erase_if(some, [&](const Span* span) { return !fits(*span); }) > 0;
    };
    const Span* const first = *std::ranges::min_element(
        choices.front(), {}, [](const Span* span) { return span->begin.tick; });
    const Tick first_begin = first->begin.tick;
    keep(choices[count_ - 1], [&](const Span& span) { return span.end.tick > first_begin; });
    if (choices[count_ - 1].empty()) return false;
    const Tick last_end = choices[count_ - 1].back()->end.tick;
    keep(choices.front(), [&](const Span& span) { return span.begin.tick < last_end; });
    if (choices.front().empty()) return false;
  }
  return true;
}

bool Combinations::CanCompleteWith(const AllChoices& choices, std::size_t part, const Span* choice,
                                   std::size_t depth) {
  AllChoices& tried = tried_[depth];
  tried = choices;
  tried[part].assign(1, choice);
  return CanComplete(tried, depth);
}

bool Combinations::CanComplete(const AllChoices& choices, std::size_t depth) {
  AllChoices& left = tried_[depth];
  if (&left != &choices) left = choices;
  if (!MakeConsistent(left)) return false;
  std::size_t open = count_;  // the part with the fewest choices, of those that have several
  for (std::size_t part = 0; part < count_; ++part) {
    const std::size_t some = left[part].size();
    if (some > 1 && (open == count_ || some < left[open].size())) open = part;
  }
  return open == count_ || std::ranges::any_of(left[open], [&](const Span* choice) {
           return CanCompleteWith(left, open, choice, depth + 1);
         });
}

template <typename Key>
const Span& Combinations::ChooseLeast(std::size_t part, Key key) {
  sorted_ = choices_[part];
  std::ranges::sort(sorted_, {}, [&](const Span* span) { return key(*span); });
  const auto chosen = std::ranges::find_if(
      sorted_, [&](const Span* span) { return CanCompleteWith(choices_, part, span, 0); });
  PREHEND_CHECK(chosen != sorted_.end());
  choices_[part].assign(1, *chosen);
  return **chosen;
}

// The last begin such that all can begin there or later, and end in time; then the first end.
std::optional<Span> Combinations::BestHull(const Span& newest) {
  begins_.clear();
  ends_.clear();
  for (std::size_t part = 0; part < count_; ++part) {
    for (const Span* span : choices_[part]) {
      begins_.push_back(span->begin);
      ends_.push_back(span->end);
    }
  }
  std::ranges::sort(begins_, std::greater(), &Moment::tick);
  std::ranges::sort(ends_, {}, &Moment::tick);
  const auto inside = [&](Tick from, Tick to) {
    inside_ = choices_;
    for (std::size_t part = 0; part < count_; ++part) {
      std::erase_if(inside_[part], [&](const Span* span) {
        return span->begin.tick < from || span->end.tick > to;
      });
      if (inside_[part].empty()) return false;
    }
    return CanComplete(inside_, 0);
  };
  const auto begin = std::ranges::find_if(begins_, [&](const Moment& from) {
    return from.tick <= newest.begin.tick && inside(from.tick, from.tick + within_);
  });
  if (begin == begins_.end()) return std::nullopt;
  const auto end = std::ranges::find_if(ends_, [&](const Moment& to) {
    return to.tick >= newest.end.tick &&
           inside(begin->tick, std::min(to.tick, begin->tick + within_));
  });
  return Span{.begin = *begin,
              .end = *end,
              .open_end = newest.open_end && newest.end.tick == end->tick,
              .completed = newest.Complete()};
}

std::optional<Span> Combinations::Best(std::size_t part, const Span& newest) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto counts = [&](const Span& span) {
      return span.Complete().tick <= newest.Complete().tick &&
             (i >= rule_->may_begin() || span.begin.frame >= state_->last_end) &&
             (!rule_->hull || span.begin.tick >= newest.end.tick - within_);
    };
    choices_[i].clear();
    if (i == part) {
      if (counts(newest)) choices_[i].push_back(&newest);
    } else {
      for (const Span& span : state_->parts[i])
        if (counts(span)) choices_[i].push_back(&span);
    }
    if (choices_[i].empty()) return std::nullopt;
  }
  if (!CanComplete(choices_, 0)) return std::nullopt;
  if (rule_->hull) return BestHull(newest);
  const Span& last = ChooseLeast(count_ - 1, [](const Span& span) { return span.end.tick; });
  const Span& first =
      ChooseLeast(0, [this](const Span& span) { return rule_->BySkip(span.begin.tick); });
  return Span{.begin = first.begin,
              .end = last.end,
              .open_end = last.open_end,
              .completed = newest.Complete()};
}

}  // namespace prehend::grammar
