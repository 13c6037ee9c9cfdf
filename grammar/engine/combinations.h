// SPDX-License-Identifier: Apache-2.0
// Chooses one interval of each part of a composition, so that all relations hold.
//
// Needs: of all combinations the one that is complete first, of those the one that ends first, then
// the one that begins last. Parts: at most kMaxParts, with at most kRememberedSpans intervals each.
// Algorithm: a constraint network. What a part can still choose is one machine word; choosing for
// one part removes from the others what no longer fits anything (arc consistency: A. Mackworth,
// "Consistency in networks of relations", Artificial Intelligence 8 (1977)). Where the relations
// form no circle, no choice is ever taken back (E. Freuder, "A sufficient condition for
// backtrack-free search", JACM 29 (1982)). Tested by tests/grammar/engine/compose_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "grammar/base/span.h"
#include "grammar/program/program.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {

inline Interval TicksOf(const Span& span) { return {span.begin.tick, span.end.tick}; }

class Combinations {
 public:
  /// Intervals that are complete after the frame `settled` do not count yet. The arguments outlive
  /// this object.
  /// `gaps`: in ticks, by clause; negative: any gap.
  Combinations(const ComposeRule& composition, const ComposeState& state,
               const std::vector<Tick>& gaps, FrameNumber settled);

  /// From the begin of the first part to the end of the last; nullopt: no combination fits.
  std::optional<Span> Best() const;

 private:
  /// A bit for each interval that a part may choose.
  using Choices = std::uint64_t;
  using AllChoices = std::array<Choices, kMaxParts>;
  static_assert(kRememberedSpans <= 64);

  /// By choice of one part: what fits it among the choices of another.
  using Fitting = std::array<Choices, kRememberedSpans>;

  template <typename Fits>
  void Relate(std::size_t left, std::size_t right, Fits fits);
  bool MakeConsistent(AllChoices& choices) const;
  bool CanComplete(AllChoices choices) const;
  /// Chooses the interval with the least key that a combination has.
  template <typename Key>
  const Span& ChooseLeast(AllChoices& choices, std::size_t part, Key key) const;
  bool CanCompleteWith(AllChoices choices, std::size_t part, std::size_t choice) const;
  AllChoices CompleteBy(std::int64_t tick) const;
  const ComposeState& state_;
  std::size_t count_;  ///< of parts
  AllChoices choices_{};
  std::array<std::uint8_t, kMaxParts> related_{};  ///< a bit per part to which it has a relation
  std::array<std::array<Fitting, kMaxParts>, kMaxParts> fitting_;  ///< set where related
};

}  // namespace prehend::grammar
