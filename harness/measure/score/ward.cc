// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_metrics_test.cc
#include "harness/measure/score/ward.h"

#include <algorithm>
#include <set>

#include "harness/measure/score/segments.h"

namespace prehend::measure {
namespace {

using grammar::Interval;
using grammar::Tick;

/// An interval between two successive boundaries of either side.
struct Piece {
  Tick length = 0;
  bool is_true = false;
  bool is_said = false;

  bool Correct() const { return is_true && is_said; }
};

bool Covers(const std::vector<Interval>& side, Tick tick) {
  return std::any_of(side.begin(), side.end(),
                     [&](const Interval& i) { return i.begin <= tick && tick < i.end; });
}

std::vector<Piece> Cut(const std::vector<Interval>& truth, const std::vector<Interval>& said) {
  std::set<Tick> cuts;
  for (const auto* side : {&truth, &said}) {
    for (const Interval& interval : *side) cuts.insert({interval.begin, interval.end});
  }
  std::vector<Piece> pieces = {{}};  // before the first
  for (auto cut = cuts.begin(); cut != cuts.end() && std::next(cut) != cuts.end(); ++cut) {
    pieces.push_back({*std::next(cut) - *cut, Covers(truth, *cut), Covers(said, *cut)});
  }
  pieces.push_back({});  // after the last
  return pieces;
}

WardTicks CountTicks(const std::vector<Piece>& pieces) {
  WardTicks ticks;
  for (std::size_t i = 1; i + 1 < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    const bool after_correct = pieces[i - 1].Correct(), before_correct = pieces[i + 1].Correct();
    Tick* kind = nullptr;
    if (piece.Correct()) {
      kind = &ticks.correct;
    } else if (piece.is_said) {
      kind = after_correct ? (before_correct ? &ticks.merged : &ticks.overfilled_end)
                           : (before_correct ? &ticks.overfilled_begin : &ticks.inserted);
    } else if (piece.is_true) {
      kind = after_correct ? (before_correct ? &ticks.fragmented : &ticks.underfilled_end)
                           : (before_correct ? &ticks.underfilled_begin : &ticks.deleted);
    }
    if (kind) *kind += piece.length;
  }
  return ticks;
}

int Meeting(const Interval& one, const std::vector<Interval>& others) {
  return static_cast<int>(std::count_if(others.begin(), others.end(), [&](const Interval& other) {
    return Overlap(one, other) > 0;
  }));
}

/// Whether an interval that overlaps `one` also overlaps another interval of its side.
bool SharesPartner(const Interval& one, const std::vector<Interval>& others,
                   const std::vector<Interval>& own) {
  return std::any_of(others.begin(), others.end(), [&](const Interval& other) {
    return Overlap(one, other) > 0 && Meeting(other, own) > 1;
  });
}

}  // namespace

WardTicks& WardTicks::operator+=(const WardTicks& other) {
  correct += other.correct;
  inserted += other.inserted;
  merged += other.merged;
  overfilled_begin += other.overfilled_begin;
  overfilled_end += other.overfilled_end;
  deleted += other.deleted;
  fragmented += other.fragmented;
  underfilled_begin += other.underfilled_begin;
  underfilled_end += other.underfilled_end;
  return *this;
}

WardEvents& WardEvents::operator+=(const WardEvents& other) {
  correct += other.correct;
  deleted += other.deleted;
  fragmented += other.fragmented;
  merged += other.merged;
  fragmented_and_merged += other.fragmented_and_merged;
  said_correct += other.said_correct;
  inserted += other.inserted;
  fragmenting += other.fragmenting;
  merging += other.merging;
  fragmenting_and_merging += other.fragmenting_and_merging;
  return *this;
}

Ward CompareByWard(const std::vector<Interval>& truth, const std::vector<Interval>& said) {
  Ward ward{.ticks = CountTicks(Cut(truth, said)), .events = {}};
  WardEvents& events = ward.events;
  for (const Interval& one : truth) {
    const int pieces = Meeting(one, said);
    const bool merged = SharesPartner(one, said, truth);
    ++(pieces == 0            ? events.deleted
       : pieces > 1 && merged ? events.fragmented_and_merged
       : pieces > 1           ? events.fragmented
       : merged               ? events.merged
                              : events.correct);
  }
  for (const Interval& one : said) {
    const int covered = Meeting(one, truth);
    const bool fragment = SharesPartner(one, truth, said);
    ++(covered == 0              ? events.inserted
       : covered > 1 && fragment ? events.fragmenting_and_merging
       : covered > 1             ? events.merging
       : fragment                ? events.fragmenting
                                 : events.said_correct);
  }
  return ward;
}

}  // namespace prehend::measure
