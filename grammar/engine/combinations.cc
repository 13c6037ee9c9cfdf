// SPDX-License-Identifier: Apache-2.0
// See grammar/engine/combinations.h. Tested by tests/grammar/engine/compose_test.cc
#include "grammar/engine/combinations.h"

#include <algorithm>
#include <limits>

#include "grammar/base/allen.h"
#include "grammar/base/check.h"

namespace prehend::grammar {
namespace {

constexpr Tick kEndless = std::numeric_limits<Tick>::max() / 4;

}  // namespace

void Combinations::LookAt(const ComposeRule& composition, const ComposeState& state,
                          const std::vector<Relations>& relations) {
  state_ = &state;
  count_ = state.parts.size();
  links_.clear();
  for (std::size_t i = 0; i < relations.size(); ++i) {
    const auto left = static_cast<std::size_t>(composition.clauses[i].left);
    const auto right = static_cast<std::size_t>(composition.clauses[i].right);
    if (left == right) continue;  // it equals itself, or the grammar is refused
    Add(left, right, false, relations[i]);
    Add(right, left, true, relations[i]);
  }
}

void Combinations::Add(std::size_t part, std::size_t other, bool mirrored,
                       const Relations& relations) {
  Link link{.part = part, .other = other, .mirrored = mirrored, .relations = &relations};
  for (std::size_t i = 0; i < relations.within.size(); ++i) {
    if ((relations.any >> i & 1) == 0) continue;
    const auto relation = static_cast<Allen>(i);
    const Allen seen = mirrored ? Inverse(relation) : relation;
    const bool is_gap = seen == Allen::kBefore || seen == Allen::kAfter;
    const Tick reach = relations.within[i] >= 0 ? relations.within[i] : is_gap ? kEndless : 0;
    if (seen != Allen::kAfter) link.ahead = std::max(link.ahead, reach);
    if (seen != Allen::kBefore) link.behind = std::max(link.behind, reach);
  }
  links_.push_back(link);
}

/// What is to come begins and ends no earlier than is known of it; so only what limits its begin or
/// its end from above can exclude it.
bool Combinations::Link::MayFit(const Span& span, const ToCome& to_come) const {
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
  for (; other != others.end() && (*other)->begin.tick <= span.end.tick + link.ahead; ++other) {
    const bool fits = std::ranges::all_of(links_, [&](const Link& all) {
      return all.part != link.part || all.other != link.other || all.Fit(span, **other);
    });
    if (fits) return true;
  }
  return false;
}

bool Combinations::IsHopeless(std::size_t part, const Span& span,
                              const std::vector<ToCome>& to_come) const {
  return std::ranges::any_of(links_, [&](const Link& link) {
    if (link.part != part || link.MayFit(span, to_come[link.other])) return false;
    const std::vector<Span>& others = state_->parts[link.other];
    auto other = std::ranges::lower_bound(others, span.begin.tick - link.behind, {},
                                          [](const Span& one) { return one.end.tick; });
    for (; other != others.end() && other->begin.tick <= span.end.tick + link.ahead; ++other) {
      if (link.Fit(span, *other)) return false;
    }
    return true;
  });
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
    // It ends after it begins.
    const auto keep = [&](Choices& some, const auto& fits) {
      changed |= std::erase_if(some, [&](const Span* span) { return !fits(*span); }) > 0;
    };
    for (std::size_t part = 0; part < count_; ++part)
      if (choices[part].empty()) return false;
    const Tick first_begin = choices.front().front()->begin.tick;
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

std::optional<Span> Combinations::Best(std::size_t part, const Span& newest) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto counts = [&](const Span& span) {
      return span.Complete().tick <= newest.Complete().tick &&
             (i > 0 || span.begin.frame >= state_->last_end);
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
  const Span& last = ChooseLeast(count_ - 1, [](const Span& span) { return span.end.tick; });
  const Span& first = ChooseLeast(0, [](const Span& span) { return -span.begin.tick; });
  return Span{.begin = first.begin,
              .end = last.end,
              .open_end = last.open_end,
              .completed = newest.Complete()};
}

}  // namespace prehend::grammar
