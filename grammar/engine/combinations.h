// SPDX-License-Identifier: Apache-2.0
// Chooses one interval of each part of a composition, so that all relations hold.
//
// Needs: of all combinations that are complete with a given interval, the one that ends first, then
// the one that begins last; of `all of`, the one that begins last, then the one that ends first; of
// any number of intervals per part. Algorithm: a constraint network.
// What a part can still choose is a list; choosing for one part removes from the others what no
// longer fits anything (arc consistency: A. Mackworth, "Consistency in networks of relations",
// Artificial Intelligence 8 (1977)). Where the relations form no circle, no choice is ever taken
// back (E. Freuder, "A sufficient condition for backtrack-free search", JACM 29 (1982)). Intervals
// of one part do not overlap, unless it has choices, so in a list by time those that can fit
// another one stand together. Tested by tests/grammar/engine/compose_test.cc
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "grammar/base/span.h"
#include "grammar/program/program.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {

inline Interval TicksOf(const Span& span) { return {span.begin.tick, span.end.tick}; }

class Combinations {
 public:
  /// What is asked from now on is asked of these, which outlive it; memory is kept for the next
  /// ones.
  void LookAt(const ComposeRule& composition, const ComposeState& state, const RuleTicks& ticks);

  /// What is composed where nothing is complete later than this interval of the part; nullopt: no
  /// combination fits.
  std::optional<Span> Best(std::size_t part, const Span& newest);

  /// What is known of the intervals of a part that are still to come.
  struct ToCome {
    Tick begins_from = 0;  ///< none begins earlier
    Tick ends_after = 0;   ///< none ends earlier, or then
    /// Likewise, by both.
    Tick last_tick_before_end() const {
      return begins_from > ends_after ? begins_from : ends_after;
    }
  };
  /// Nothing to come can make a composition with this interval: some relation to another part holds
  /// to none that is remembered, nor to one that is still to come.
  bool IsHopeless(std::size_t part, const Span& span, const std::vector<ToCome>& to_come) const;

 private:
  using Choices = std::vector<const Span*>;  ///< of one part, by time
  using AllChoices = std::array<Choices, kMaxParts>;
  /// A relation of a part to another one.
  struct Link {
    std::size_t part = 0, other = 0;
    bool mirrored = false;  ///< `other` stands first in the clause
    const Relations* relations = nullptr;
    const std::vector<Span>* absent = nullptr;  ///< or: of these there is none between the two
    Tick ahead = 0;   ///< so long after an interval of the part the other one may begin
    Tick behind = 0;  ///< so long before it the other one may end
    bool Fit(const Span& span, const Span& of_other) const;
    bool MayFit(const Span& span, const ToCome& to_come) const;
  };

  void Add(Link link);
  void AddReach(Link& link) const;
  std::optional<Span> BestHull(const Span& newest);
  bool IsAbsenceOver(std::size_t part, const Span& span, const std::vector<ToCome>& to_come) const;
  bool HasPartner(const Span& span, const Link& link, const Choices& others) const;
  bool IsSomeEmpty(const AllChoices& choices) const;
  bool MakeConsistent(AllChoices& choices) const;
  bool CanComplete(const AllChoices& choices, std::size_t depth);
  bool CanCompleteWith(const AllChoices& choices, std::size_t part, const Span* choice,
                       std::size_t depth);
  /// Chooses the interval with the least key that a combination has.
  template <typename Key>
  const Span& ChooseLeast(std::size_t part, Key key);

  const ComposeRule* rule_ = nullptr;
  const ComposeState* state_ = nullptr;
  Tick within_ = 0;
  std::size_t count_ = 0;  ///< of parts
  std::vector<Link> links_;
  AllChoices choices_;
  AllChoices inside_;
  std::vector<Moment> begins_, ends_;
  Choices sorted_;
  std::array<AllChoices, kMaxParts + 2> tried_;  ///< by depth: each step chooses for a part
};

}  // namespace prehend::grammar
