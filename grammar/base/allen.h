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

/// From the end of the one to the begin of the other; 0 if they meet or overlap.
constexpr Tick GapBetween(const Interval& a, const Interval& b) {
  const Tick gap = a.begin < b.begin ? b.begin - a.end : a.begin - b.end;
  return gap > 0 ? gap : 0;
}

constexpr std::optional<Allen> AllenNamed(std::string_view name) {
  for (std::size_t i = 0; i < kAllenNames.size(); ++i) {
    if (kAllenNames[i] == name) return static_cast<Allen>(i);
  }
  return std::nullopt;
}

}  // namespace prehend::grammar
