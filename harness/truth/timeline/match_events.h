// SPDX-License-Identifier: Apache-2.0
// The matcher of two timelines: which event of the one is which of the other. Goldens, scores and
// the comparison with the physical oracle all use it; what may be the same event is their policy.
// Tested by tests/harness/truth/timeline/match_events_test.cc
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/timeline.h"

namespace prehend::truth {

/// Two events of one label may be the same one if they lie less than `max_gap` apart (0: if they
/// overlap), or if both of their boundaries are at most `collar` apart. In ticks.
struct MatchPolicy {
  grammar::Tick max_gap = 0;
  grammar::Tick collar = 0;
};

/// The events of one label (name and roles; attributes are not compared), as indices into the two
/// lists, all in the order of time.
struct LabelMatches {
  std::string label;                                       ///< "reaching(right_hand, milk)"
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< expected, actual
  std::vector<std::size_t> only_expected, only_actual;     ///< left without a partner
};

/// Pairs the events of each label so that as many as possible have a partner, and of all ways to do
/// that the one whose boundaries are the closest in sum. Partners are in the same order on both
/// sides. Both lists are in the order of time; events of one label do not overlap within a list.
/// Sorted by label.
std::vector<LabelMatches> MatchEvents(std::span<const grammar::NamedEvent> expected,
                                      std::span<const grammar::NamedEvent> actual,
                                      const MatchPolicy& policy);

struct Match {
  grammar::NamedEvent truth, found;
  grammar::Tick begin_offset() const { return found.interval.begin - truth.interval.begin; }
  grammar::Tick end_offset() const { return found.interval.end - truth.interval.end; }
};

/// Everything there is to say about one label, e.g. "reaching(right_hand, milk)". All in the order
/// of time.
struct LabelAgreement {
  std::string label;
  std::vector<Match> matches;
  std::vector<grammar::NamedEvent> missing;  ///< true, but not found
  std::vector<grammar::NamedEvent> extra;    ///< found, but not true
};

struct Agreement {
  std::vector<LabelAgreement> labels;  ///< sorted by label
  grammar::Tick ticks_per_second = 1;  ///< of the true timeline

  int matched() const;
  int missing() const;
  int extra() const;
  /// Nothing missing, nothing extra, every boundary at most so far off.
  bool Within(grammar::Tick tolerance) const;
  /// Largest absolute offset of a matched boundary.
  grammar::Tick largest_offset() const;
};

/// How well a timeline agrees with the true one. Events match if they overlap or lie within the
/// collar: short ones may miss each other altogether and still be the same.
Agreement Agree(const grammar::Timeline& truth, const grammar::Timeline& found,
                grammar::Tick collar);

/// One line per event that is missing, extra or off by more than `tolerance`; empty when there is
/// none. E.g.
///   off      reaching(right_hand, milk)  true 1.0000..2.0000 s  found 1.0250..2.0000 s  begin
///   +25.0 ms, end +0.0 ms missing  sliding(right_hand, milk)   true 2.5000..3.0000 s
std::string DescribeDisagreement(const Agreement& agreement, grammar::Tick tolerance);

/// How well a timeline agrees with the timelines that the definitions allow; the first has the
/// definitions' own numbers.
/// - Found events that some of them have match. A boundary between the earliest and the latest of
///   theirs has no offset: the match's `truth` has it where it was found. Otherwise `truth` has the
///   nearer of the two.
/// - An event that none of them has is extra.
/// - An event of the first is missing if each of the others lacks a partner for one there, too. One
///   that is not longer than the collar may lie between two frames: it is not missed.
Agreement AgreeWithin(std::span<const grammar::Timeline> possible, const grammar::Timeline& found,
                      grammar::Tick collar);

}  // namespace prehend::truth
