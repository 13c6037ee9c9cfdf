// SPDX-License-Identifier: Apache-2.0
// Allen's thirteen relations between two intervals, here half-open intervals of ticks: of any two
// non-empty ones exactly one holds. After J. F. Allen, "Maintaining knowledge about temporal
// intervals", CACM 26 (1983). Tested by tests/grammar/analysis/allen_network_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "grammar/base/frame.h"

namespace prehend::grammar {

enum class Allen : std::uint8_t {
  kBefore,
  kMeets,
  kOverlaps,
  kStarts,
  kDuring,
  kFinishes,
  kEquals,
  kFinishedBy,
  kContains,
  kStartedBy,
  kOverlappedBy,
  kMetBy,
  kAfter,
};

/// Bit i stands for relation i.
using AllenSet = std::uint16_t;

inline constexpr std::array<std::string_view, 13> kAllenNames = {
    "before",      "meets",    "overlaps",   "starts",        "inside", "finishes", "equals",
    "finished_by", "contains", "started_by", "overlapped_by", "met_by", "after"};

constexpr AllenSet Bit(Allen relation) {
  return static_cast<AllenSet>(1U << static_cast<unsigned>(relation));
}

/// How `a` lies to `b`; both must be non-empty.
constexpr Allen Relate(const Interval& a, const Interval& b) {
  if (a.end < b.begin) return Allen::kBefore;
  if (a.end == b.begin) return Allen::kMeets;
  if (b.end < a.begin) return Allen::kAfter;
  if (b.end == a.begin) return Allen::kMetBy;
  if (a.begin == b.begin) {
    if (a.end == b.end) return Allen::kEquals;
    return a.end < b.end ? Allen::kStarts : Allen::kStartedBy;
  }
  if (a.end == b.end) return a.begin > b.begin ? Allen::kFinishes : Allen::kFinishedBy;
  if (a.begin < b.begin) return a.end < b.end ? Allen::kOverlaps : Allen::kContains;
  return a.end < b.end ? Allen::kDuring : Allen::kOverlappedBy;
}

/// How `b` lies to `a`: they are listed so that before and after mirror each other, and so on.
constexpr Allen Inverse(Allen relation) {
  return static_cast<Allen>(kAllenNames.size() - 1 - static_cast<std::size_t>(relation));
}

/// What may be said with a time: before and after, whose gap is at most so long, and what wants
/// boundaries to be equal, which are at most so far apart.
inline constexpr AllenSet kBounded =
    Bit(Allen::kBefore) | Bit(Allen::kMeets) | Bit(Allen::kStarts) | Bit(Allen::kFinishes) |
    Bit(Allen::kEquals) | Bit(Allen::kFinishedBy) | Bit(Allen::kStartedBy) | Bit(Allen::kMetBy) |
    Bit(Allen::kAfter);

/// Whether the relation holds with such a time; negative: none was said.
constexpr bool Holds(Allen relation, const Interval& a, const Interval& b, Tick within) {
  if (relation > Allen::kEquals) return Holds(Inverse(relation), b, a, within);
  if (within < 0) return Relate(a, b) == relation;
  const auto near = [within](Tick x, Tick y) { return x - y <= within && y - x <= within; };
  switch (relation) {
    case Allen::kBefore:
      return a.end < b.begin && near(a.end, b.begin);
    case Allen::kMeets:
      return near(a.end, b.begin) && a.begin < b.begin && a.end < b.end;
    case Allen::kStarts:
      return near(a.begin, b.begin) && a.end < b.end;
    case Allen::kFinishes:
      return near(a.end, b.end) && a.begin > b.begin;
    case Allen::kEquals:
      return near(a.begin, b.begin) && near(a.end, b.end);
    case Allen::kOverlaps:
    case Allen::kDuring:
    case Allen::kFinishedBy:
    case Allen::kContains:
    case Allen::kStartedBy:
    case Allen::kOverlappedBy:
    case Allen::kMetBy:
    case Allen::kAfter:
      break;
  }
  return Relate(a, b) == relation;
}

/// How two intervals that lie to each other as the relation says with a time may really lie.
constexpr AllenSet MayBe(Allen relation) {
  AllenSet set = 0;
  constexpr Tick kMost = 5;
  for (Tick i = 0; i < kMost * kMost * kMost * kMost; ++i) {
    const Interval a{i % kMost, i / kMost % kMost + 1}, b{i / 25 % kMost, i / 125 + 1};
    if (a.begin < a.end && b.begin < b.end && Holds(relation, a, b, kMost))
      set |= Bit(Relate(a, b));
  }
  return set;
}

/// Relations of which one must hold, some with a time.
struct Relations {
  AllenSet any = 0;
  std::array<Tick, kAllenNames.size()> within = {};  ///< negative: none was said

  constexpr bool Fit(const Interval& a, const Interval& b) const {
    for (std::size_t i = 0; i < within.size(); ++i) {
      if ((any >> i & 1) != 0 && Holds(static_cast<Allen>(i), a, b, within[i])) return true;
    }
    return false;
  }
};

constexpr std::optional<Allen> AllenNamed(std::string_view name) {
  for (std::size_t i = 0; i < kAllenNames.size(); ++i) {
    if (kAllenNames[i] == name) return static_cast<Allen>(i);
  }
  return std::nullopt;
}

}  // namespace prehend::grammar
