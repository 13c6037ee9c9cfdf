// SPDX-License-Identifier: Apache-2.0
// See grammar/engine/combinations.h. Tested by tests/grammar/engine/compose_test.cc
#include "grammar/engine/combinations.h"

#include <algorithm>
#include <bit>

#include "grammar/base/allen.h"
#include "grammar/base/check.h"

namespace prehend::grammar {
namespace {

/// Calls `visit` with the number of each bit that is set.
template <typename Visit>
void ForEachBit(std::uint64_t bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

Combinations::Combinations(const ComposeRule& composition, const ComposeState& state,
                           const std::vector<Tick>& gaps, FrameNumber settled)
    : state_(state), count_(state.parts.size()) {
  for (std::size_t part = 0; part < count_; ++part) {
    for (std::size_t i = 0; i < state.parts[part].size(); ++i)
      if (state.parts[part][i].Complete().frame <= settled) choices_[part] |= Choices{1} << i;
    if (choices_[part] == 0) return;
  }
  const std::vector<Span>& firsts = state.parts.front();
  for (std::size_t i = 0; i < firsts.size(); ++i)
    if (firsts[i].begin.frame < state.last_end) choices_.front() &= ~(Choices{1} << i);
  Relate(0, count_ - 1,
         [](const Span& first, const Span& last) { return first.begin.frame < last.end.frame; });
  for (std::size_t i = 0; i < composition.clauses.size(); ++i) {
    const ComposeRule::Clause& clause = composition.clauses[i];
    Relate(static_cast<std::size_t>(clause.left), static_cast<std::size_t>(clause.right),
           [&](const Span& left, const Span& right) {
             const bool is_near =
                 gaps[i] < 0 || GapBetween(TicksOf(left), TicksOf(right)) <= gaps[i];
             return is_near &&
                    (Bit(grammar::Relate(TicksOf(left), TicksOf(right))) & clause.relations) != 0;
           });
  }
}

/// Several relations between two parts must all hold.
template <typename Fits>
void Combinations::Relate(std::size_t left, std::size_t right, Fits fits) {
  const bool again = (related_[left] >> right & 1) != 0;
  Fitting there{}, back{};
  ForEachBit(choices_[left], [&](std::size_t i) {
    ForEachBit(choices_[right], [&](std::size_t k) {
      if (left == right && i != k) return;
      if (!fits(state_.parts[left][i], state_.parts[right][k])) return;
      there[i] |= Choices{1} << k;
      back[k] |= Choices{1} << i;
    });
  });
  const auto join = [&](Fitting& fitting, const Fitting& more) {
    for (std::size_t i = 0; i < fitting.size(); ++i)
      fitting[i] = again ? fitting[i] & more[i] : more[i];
  };
  join(fitting_[left][right], there);
  if (left != right) join(fitting_[right][left], back);
  related_[left] |= static_cast<std::uint8_t>(1 << right);
  related_[right] |= static_cast<std::uint8_t>(1 << left);
}

/// Removes what fits no choice of another part; false: some part has nothing left.
bool Combinations::MakeConsistent(AllChoices& choices) const {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t part = 0; part < count_; ++part) {
      Choices kept = 0;
      ForEachBit(choices[part], [&](std::size_t i) {
        bool fits = true;
        ForEachBit(related_[part], [&](std::size_t other) {
          fits = fits && (fitting_[part][other][i] & choices[other]) != 0;
        });
        if (fits) kept |= Choices{1} << i;
      });
      changed |= kept != choices[part];
      choices[part] = kept;
      if (kept == 0) return false;
    }
  }
  return true;
}

bool Combinations::CanCompleteWith(AllChoices choices, std::size_t part, std::size_t choice) const {
  choices[part] &= Choices{1} << choice;
  return choices[part] != 0 && CanComplete(choices);
}

bool Combinations::CanComplete(AllChoices choices) const {
  if (!MakeConsistent(choices)) return false;
  std::size_t open = count_;  // the part with the fewest choices, of those that have several
  for (std::size_t part = 0; part < count_; ++part) {
    const int left = std::popcount(choices[part]);
    if (left > 1 && (open == count_ || left < std::popcount(choices[open]))) open = part;
  }
  if (open == count_) return true;
  bool found = false;
  ForEachBit(choices[open],
             [&](std::size_t choice) { found = found || CanCompleteWith(choices, open, choice); });
  return found;
}

Combinations::AllChoices Combinations::CompleteBy(std::int64_t tick) const {
  AllChoices choices{};
  for (std::size_t part = 0; part < count_; ++part) {
    ForEachBit(choices_[part], [&](std::size_t i) {
      if (state_.parts[part][i].Complete().tick <= tick) choices[part] |= Choices{1} << i;
    });
  }
  return choices;
}

template <typename Key>
const Span& Combinations::ChooseLeast(AllChoices& choices, std::size_t part, Key key) const {
  const std::vector<Span>& spans = state_.parts[part];
  for (Choices left = choices[part];;) {
    std::size_t least = spans.size();
    ForEachBit(left, [&](std::size_t i) {
      if (least == spans.size() || key(spans[i]) < key(spans[least])) least = i;
    });
    PREHEND_CHECK(least < spans.size());
    if (CanCompleteWith(choices, part, least)) {
      choices[part] = Choices{1} << least;
      return spans[least];
    }
    left &= ~(Choices{1} << least);
  }
}

std::optional<Span> Combinations::Best() const {
  if (!CanComplete(choices_)) return std::nullopt;
  std::array<Moment, kMaxParts * kRememberedSpans> completes;
  auto end = completes.begin();
  for (std::size_t part = 0; part < count_; ++part)
    ForEachBit(choices_[part], [&](std::size_t i) { *end++ = state_.parts[part][i].Complete(); });
  std::sort(completes.begin(), end,
            [](const Moment& a, const Moment& b) { return a.tick < b.tick; });
  const Moment completed = *std::partition_point(completes.begin(), end, [&](const Moment& moment) {
    return !CanComplete(CompleteBy(moment.tick));
  });
  AllChoices choices = CompleteBy(completed.tick);
  const Span& last =
      ChooseLeast(choices, count_ - 1, [](const Span& span) { return span.end.tick; });
  const Span& first = ChooseLeast(choices, 0, [](const Span& span) { return -span.begin.tick; });
  return Span{
      .begin = first.begin, .end = last.end, .open_end = last.open_end, .completed = completed};
}

}  // namespace prehend::grammar
