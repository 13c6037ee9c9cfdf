// SPDX-License-Identifier: Apache-2.0
// Path consistency: a relation is narrowed by every way through a third interval until nothing
// changes.
#include "grammar/analysis/allen_network.h"

#include <array>
#include <utility>

namespace prehend::grammar {
namespace {

constexpr std::size_t kRelations = kAllenNames.size();

using Table = std::array<std::array<AllenSet, kRelations>, kRelations>;

// Three intervals have six ends, so that whatever can be can be between 0 and 5.
std::vector<Interval> AllIntervals() {
  std::vector<Interval> all;
  for (Tick begin = 0; begin < 5; ++begin) {
    for (Tick end = begin + 1; end <= 5; ++end) all.push_back({begin, end});
  }
  return all;
}

Table MakeTable() {
  Table table{};
  const std::vector<Interval> all = AllIntervals();
  for (const Interval& a : all) {
    for (const Interval& b : all) {
      for (const Interval& c : all) {
        table[static_cast<std::size_t>(Relate(a, b))][static_cast<std::size_t>(Relate(b, c))] |=
            Bit(Relate(a, c));
      }
    }
  }
  return table;
}

bool Has(AllenSet relations, std::size_t relation) { return (relations >> relation & 1U) != 0; }

}  // namespace

AllenSet Inverse(AllenSet relations) {
  AllenSet inverse = 0;
  for (std::size_t i = 0; i < kRelations;
       ++i) {  // they are listed so that before and after mirror each other, and so on
    if (Has(relations, i)) inverse |= Bit(static_cast<Allen>(kRelations - 1 - i));
  }
  return inverse;
}

AllenSet Composed(AllenSet a_to_b, AllenSet b_to_c) {
  static const Table kTable = MakeTable();
  AllenSet composed = 0;
  for (std::size_t i = 0; i < kRelations; ++i) {
    for (std::size_t j = 0; Has(a_to_b, i) && j < kRelations; ++j) {
      if (Has(b_to_c, j)) composed |= kTable[i][j];
    }
  }
  return composed;
}

AllenNetwork::AllenNetwork(int intervals)
    : size_(intervals), relations_(static_cast<std::size_t>(intervals * intervals), kAnyRelation) {
  for (int i = 0; i < size_; ++i) At(i, i) = Bit(Allen::kEquals);
}

bool AllenNetwork::Constrain(int left, int right, AllenSet relations) {
  if (!Narrow(left, right, relations)) return false;
  std::vector<std::pair<int, int>> changed = {{left, right}};
  while (!changed.empty()) {
    const auto [a, b] = changed.back();
    changed.pop_back();
    for (int c = 0; c < size_; ++c) {
      for (const auto& [from, by, to] : {std::array{a, b, c}, std::array{c, a, b}}) {
        const AllenSet before = At(from, to);
        if (!Narrow(from, to, Composed(At(from, by), At(by, to)))) return false;
        if (At(from, to) != before) changed.emplace_back(from, to);
      }
    }
  }
  return true;
}

bool AllenNetwork::Narrow(int left, int right, AllenSet relations) {
  At(left, right) &= relations;
  At(right, left) &= Inverse(relations);
  return At(left, right) != 0;
}

}  // namespace prehend::grammar
