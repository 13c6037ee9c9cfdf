// SPDX-License-Identifier: Apache-2.0
// How well a timeline agrees with the true one: which events match and by how much their boundaries
// are off. Tested by tests/harness/agreement_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/timeline.h"

namespace prehend::harness {

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

/// Pairs events with the same label (event and roles; attributes are not compared), each at most
/// once, the closest first. Two can be a pair if their intervals overlap, or if both boundaries are
/// at most `collar` apart: short events may miss each other altogether and still be the same.
Agreement Agree(const grammar::Timeline& truth, const grammar::Timeline& found,
                grammar::Tick collar);

/// One line per event that is missing, extra or off by more than `tolerance`; empty when there is
/// none. E.g.
///   off      reaching(right_hand, milk)  true 1.0000..2.0000 s  found 1.0250..2.0000 s  begin
///   +25.0 ms, end +0.0 ms missing  sliding(right_hand, milk)   true 2.5000..3.0000 s
std::string DescribeDisagreement(const Agreement& agreement, grammar::Tick tolerance);

}  // namespace prehend::harness
