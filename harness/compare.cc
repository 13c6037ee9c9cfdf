// SPDX-License-Identifier: Apache-2.0
// Pairs events. Within one label, maximal intervals don't overlap, so an order-preserving alignment
// (Needleman and Wunsch 1970) finds the largest and then closest set of partners. Tested by
// tests/harness/compare_test.cc
#include "harness/compare.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <tuple>

#include "harness/changed_relations.h"
#include "harness/event_text.h"

namespace prehend::harness {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

/// Events this far apart in time may still be the same one, shifted.
constexpr double kMaxGapBetweenPartners_s = 0.25;
/// Two events that differ in a role are one changed event when they share this much of their common
/// span.
constexpr double kMinSharedSpan = 0.5;

Tick Overlap(Interval a, Interval b) { return std::min(a.end, b.end) - std::max(a.begin, b.begin); }

bool AtTheSameTime(Interval a, Interval b) {
  const Tick span = std::max(a.end, b.end) - std::min(a.begin, b.begin);
  return static_cast<double>(Overlap(a, b)) >= kMinSharedSpan * static_cast<double>(span);
}

Tick Distance(Interval a, Interval b) {
  return std::abs(a.begin - b.begin) + std::abs(a.end - b.end);
}

/// Quality of a set of pairs: first how many, then how close.
struct Quality {
  int pairs = 0;
  Tick distance = 0;
  bool BetterThan(const Quality& other) const {
    return pairs != other.pairs ? pairs > other.pairs : distance < other.distance;
  }
};

using IndexPair = std::pair<std::size_t, std::size_t>;

/// The best order-preserving pairs of two lists sorted by time.
std::vector<IndexPair> Align(const std::vector<Interval>& expected,
                             const std::vector<Interval>& actual, Tick max_gap) {
  const std::size_t rows = expected.size();
  const std::size_t columns = actual.size();
  const auto may_pair = [&](std::size_t i, std::size_t j) {
    return Overlap(expected[i], actual[j]) > -max_gap;
  };
  const auto extended = [&](Quality quality, std::size_t i, std::size_t j) {
    return Quality{quality.pairs + 1, quality.distance + Distance(expected[i], actual[j])};
  };
  // best[i][j]: of the events from i and from j on.
  std::vector<std::vector<Quality>> best(rows + 1, std::vector<Quality>(columns + 1));
  const auto better = [](Quality a, Quality b) { return b.BetterThan(a) ? b : a; };
  for (std::size_t i = rows; i-- > 0;) {
    for (std::size_t j = columns; j-- > 0;) {
      best[i][j] = better(best[i + 1][j], best[i][j + 1]);
      if (may_pair(i, j)) best[i][j] = better(extended(best[i + 1][j + 1], i, j), best[i][j]);
    }
  }
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0, j = 0; i < rows && j < columns;) {
    if (may_pair(i, j) && !best[i][j].BetterThan(extended(best[i + 1][j + 1], i, j))) {
      pairs.push_back({i++, j++});
    } else if (!best[i][j].BetterThan(best[i + 1][j])) {
      ++i;
    } else {
      ++j;
    }
  }
  return pairs;
}

/// "object: milk -> cup" for every role, attribute or ending that differs.
std::vector<std::string> Changes(const NamedEvent& expected, const NamedEvent& actual) {
  std::vector<std::string> changes;
  const auto add = [&](const std::string& name, const std::string& was, const std::string& is) {
    if (was != is)
      changes.push_back(name + ": " + (was.empty() ? "none" : was) + " -> " +
                        (is.empty() ? "none" : is));
  };
  for (const auto& role : expected.roles) add(role.name, role.value, RoleValue(actual, role.name));
  for (const auto& role : actual.roles) {
    if (RoleValue(expected, role.name).empty()) add(role.name, "", role.value);
  }
  if (expected.event != actual.event) add("event", expected.event, actual.event);
  for (const auto& value : expected.values) {
    const auto same_name = [&](const grammar::NamedValue& other) {
      return other.name == value.name;
    };
    const auto found = std::ranges::find_if(actual.values, same_name);
    if (found == actual.values.end()) {
      add(value.name, ValueText(value), "");
    } else if (found->unit != value.unit || !ValuesAgree(value.value, found->value)) {
      add(value.name, ValueText(value), ValueText(*found));
    }
  }
  const auto ending = [](const NamedEvent& event) {
    return event.open_end ? "of the episode" : "of its own";
  };
  add("end", ending(expected), ending(actual));
  return changes;
}

/// How many roles (attributes aside) differ; and whether at least one is the same.
std::pair<int, bool> RoleDifference(const NamedEvent& expected, const NamedEvent& actual) {
  int different = 0;
  bool some_equal = false;
  for (const auto& role : expected.roles) {
    if (IsAttribute(role)) continue;
    (RoleValue(actual, role.name) == role.value ? some_equal = true : ++different != 0);
  }
  return {different, some_equal};
}

bool SameRoles(const NamedEvent& a, const NamedEvent& b) {
  const auto roles = [](const NamedEvent& event) {
    std::vector<grammar::Role> kept = event.roles;
    std::erase_if(kept, [](const auto& role) { return IsAttribute(role); });
    std::ranges::sort(kept);
    return kept;
  };
  return roles(a) == roles(b);
}

/// How unlike two events of the same time are: the number of roles that differ, more than any such
/// number when it is another event of the same roles; nothing when they have nothing in common.
std::optional<int> Unlikeness(const NamedEvent& expected, const NamedEvent& actual) {
  constexpr int kOtherEvent = 1000;
  if (expected.event != actual.event)
    return SameRoles(expected, actual) ? std::optional(kOtherEvent) : std::nullopt;
  const auto [different, some_equal] = RoleDifference(expected, actual);
  return some_equal ? std::optional(different) : std::nullopt;
}

class Pairer {
 public:
  Pairer(const Golden& golden, const grammar::Timeline& actual, Tick default_tolerance)
      : actual_(actual.events),
        default_tolerance_(default_tolerance),
        ticks_per_second_(actual.ticks_per_second) {
    for (const GoldenEvent& line : golden.events) {
      expected_.push_back(line);
      Interval& interval = expected_.back().event.interval;
      interval = {Converted(interval.begin, golden.ticks_per_second),
                  Converted(interval.end, golden.ticks_per_second)};
    }
    expected_taken_.resize(expected_.size());
    actual_taken_.resize(actual_.size());
  }

  Comparison Pair() {
    PairEqualLabels();
    PairAcrossLabels();
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      if (expected_taken_[i]) continue;
      AddAlone(LineVerdict::kMissing, expected_[i].event);
      comparison_.pairings.back().golden_line = i;
    }
    for (std::size_t j = 0; j < actual_.size(); ++j) {
      if (!actual_taken_[j]) AddAlone(LineVerdict::kExtra, actual_[j]);
    }
    std::stable_sort(
        comparison_.pairings.begin(), comparison_.pairings.end(),
        [](const Pairing& a, const Pairing& b) { return ComesBefore(a.event(), b.event()); });
    comparison_.ticks_per_second = ticks_per_second_;
    comparison_.relations = ChangedRelations(comparison_.pairings);
    for (const Pairing& pairing : comparison_.pairings) {
      if (pairing.agreement != LineVerdict::kMatched) continue;
      NoteHeadroom("begin of ", pairing, pairing.begin_offset);
      NoteHeadroom("end of ", pairing, pairing.end_offset);
    }
    return std::move(comparison_);
  }

 private:
  Tick Converted(Tick tick, Tick from_ticks_per_second) const {
    return TickAt(static_cast<double>(tick) / static_cast<double>(from_ticks_per_second),
                  ticks_per_second_);
  }

  void PairEqualLabels() {
    struct Group {
      std::vector<std::size_t> expected, actual;
    };
    std::map<std::string, Group> groups;
    for (std::size_t i = 0; i < expected_.size(); ++i)
      groups[expected_[i].event.Label()].expected.push_back(i);
    for (std::size_t j = 0; j < actual_.size(); ++j) groups[actual_[j].Label()].actual.push_back(j);
    for (const auto& [label, group] : groups) {
      const std::size_t first_pair = comparison_.pairings.size();
      std::vector<Interval> expected, actual;
      for (const std::size_t i : group.expected) expected.push_back(expected_[i].event.interval);
      for (const std::size_t j : group.actual) actual.push_back(actual_[j].interval);
      const Tick max_gap = TickAt(kMaxGapBetweenPartners_s, ticks_per_second_);
      for (const auto& [i, j] : Align(expected, actual, max_gap))
        AddPair(group.expected[i], group.actual[j]);
      const std::size_t end_of_pairs = comparison_.pairings.size();
      for (const std::size_t j : group.actual) {
        if (!actual_taken_[j]) AddFragment(j, first_pair, end_of_pairs);
      }
      for (const std::size_t i : group.expected) {
        if (!expected_taken_[i]) AddMerged(i, first_pair, end_of_pairs);
      }
    }
  }

  /// A recognised event that overlaps the expected one of a pair of its label is a piece of it.
  void AddFragment(std::size_t j, std::size_t first_pair, std::size_t end_of_pairs) {
    const Interval interval = actual_[j].interval;
    for (std::size_t pair = first_pair; pair < end_of_pairs; ++pair) {
      if (Overlap(comparison_.pairings[pair].expected->interval, interval) <= 0) continue;
      AddAlone(LineVerdict::kFragmented, actual_[j]);
      actual_taken_[j] = true;
      return AddPiece(comparison_.pairings[pair], LineVerdict::kFragmented,
                      comparison_.pairings[pair].actual->interval, interval);
    }
  }

  /// An expected event that overlaps the recognised one of a pair of its label is merged into it.
  void AddMerged(std::size_t i, std::size_t first_pair, std::size_t end_of_pairs) {
    const Interval interval = expected_[i].event.interval;
    for (std::size_t pair = first_pair; pair < end_of_pairs; ++pair) {
      if (Overlap(comparison_.pairings[pair].actual->interval, interval) <= 0) continue;
      AddAlone(LineVerdict::kMerged, expected_[i].event);
      comparison_.pairings.back().golden_line = i;
      expected_taken_[i] = true;
      return AddPiece(comparison_.pairings[pair], LineVerdict::kMerged,
                      comparison_.pairings[pair].expected->interval, interval);
    }
  }

  static void AddPiece(Pairing& pairing, LineVerdict agreement, Interval own, Interval piece) {
    if (pairing.pieces.empty()) pairing.pieces.push_back(own);
    pairing.pieces.push_back(piece);
    std::ranges::sort(pairing.pieces, {}, &Interval::begin);
    pairing.agreement = agreement;
  }

  /// What is left over, nearest first: fewest roles changed, then closest in time.
  void PairAcrossLabels() {
    std::vector<std::tuple<int, Tick, std::size_t, std::size_t>> candidates;
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      for (std::size_t j = 0; j < actual_.size(); ++j) {
        if (expected_taken_[i] || actual_taken_[j]) continue;
        const NamedEvent& expected = expected_[i].event;
        const std::optional<int> unlike = Unlikeness(expected, actual_[j]);
        if (!unlike || !AtTheSameTime(expected.interval, actual_[j].interval)) continue;
        candidates.emplace_back(*unlike, Distance(expected.interval, actual_[j].interval), i, j);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [unlike, distance, i, j] : candidates) {
      if (!expected_taken_[i] && !actual_taken_[j]) AddPair(i, j);
    }
  }

  void AddPair(std::size_t i, std::size_t j) {
    const GoldenEvent& line = expected_[i];
    const NamedEvent& actual = actual_[j];
    Pairing pairing{.agreement = LineVerdict::kMatched,
                    .expected = line.event,
                    .actual = actual,
                    .golden_line = i};
    pairing.begin_offset = actual.interval.begin - line.event.interval.begin;
    pairing.end_offset = actual.interval.end - line.event.interval.end;
    pairing.tolerance =
        line.tolerance_ms ? *line.tolerance_ms * ticks_per_second_ / 1000 : default_tolerance_;
    pairing.changes = Changes(line.event, actual);
    if (line.event.event != actual.event) {
      pairing.agreement = LineVerdict::kRelabelled;
    } else if (!pairing.changes.empty()) {
      pairing.agreement = LineVerdict::kChanged;
    } else if (std::max(std::abs(pairing.begin_offset), std::abs(pairing.end_offset)) >
               pairing.tolerance) {
      pairing.agreement = LineVerdict::kShifted;
    }
    expected_taken_[i] = actual_taken_[j] = true;
    comparison_.pairings.push_back(std::move(pairing));
  }

  void NoteHeadroom(const char* boundary, const Pairing& pairing, Tick offset) {
    comparison_.headroom.push_back({boundary + pairing.event().Label(), offset, pairing.tolerance});
  }

  void AddAlone(LineVerdict agreement, const NamedEvent& event) {
    Pairing pairing{.agreement = agreement, .expected = {}, .actual = {}};
    const bool of_golden = agreement == LineVerdict::kMissing || agreement == LineVerdict::kMerged;
    (of_golden ? pairing.expected : pairing.actual) = event;
    comparison_.pairings.push_back(std::move(pairing));
  }

  std::vector<GoldenEvent> expected_;  ///< in the ticks of the actual timeline
  const std::vector<NamedEvent>& actual_;
  std::vector<bool> expected_taken_, actual_taken_;
  Tick default_tolerance_;
  Tick ticks_per_second_;
  Comparison comparison_;
};

}  // namespace

bool Pairing::IsFurtherPiece() const {
  return pieces.empty() &&
         (agreement == LineVerdict::kFragmented || agreement == LineVerdict::kMerged);
}

Tick Pairing::DivergenceTick() const {
  if (!expected || !actual) return event().interval.begin;
  const Interval was = expected->interval, is = actual->interval;
  if (agreement == LineVerdict::kFragmented || agreement == LineVerdict::kMerged)
    return pieces.front().end;
  const bool only_the_end = expected->Label() == actual->Label() &&
                            std::abs(begin_offset) <= tolerance && std::abs(end_offset) > tolerance;
  return only_the_end ? std::min(was.end, is.end) : std::min(was.begin, is.begin);
}

const Headroom* Comparison::Tightest() const {
  const auto found = std::ranges::min_element(headroom, {}, &Headroom::Left);
  return found == headroom.end() ? nullptr : &*found;
}

std::vector<const Pairing*> Comparison::Differing() const {
  std::vector<const Pairing*> differing;
  for (const Pairing& pairing : pairings) {
    if (pairing.agreement != LineVerdict::kMatched && !pairing.IsFurtherPiece())
      differing.push_back(&pairing);
  }
  std::ranges::stable_sort(differing, {}, &Pairing::DivergenceTick);
  return differing;
}

const Pairing* Comparison::FirstDivergence() const {
  const std::vector<const Pairing*> differing = Differing();
  return differing.empty() ? nullptr : differing.front();
}

bool ValuesAgree(double expected, double actual) {
  constexpr double kRelative = 0.05, kAbsolute = 0.001;
  return std::abs(actual - expected) <= std::max(kRelative * std::abs(expected), kAbsolute);
}

bool Comparison::Agrees() const {
  return Count(LineVerdict::kMatched) == static_cast<int>(pairings.size());
}

int Comparison::Count(LineVerdict agreement) const {
  return static_cast<int>(
      std::count_if(pairings.begin(), pairings.end(),
                    [&](const Pairing& pairing) { return pairing.agreement == agreement; }));
}

Comparison Compare(const Golden& expected, const grammar::Timeline& actual,
                   Tick default_tolerance) {
  return Pairer(expected, actual, default_tolerance).Pair();
}

Tick DefaultTolerance(int rate_hz, int sensing_hz) {
  const Tick ticks_per_frame = (rate_hz + sensing_hz - 1) / sensing_hz;
  return 2 * ticks_per_frame;
}

}  // namespace prehend::harness
