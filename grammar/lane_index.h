// SPDX-License-Identifier: Apache-2.0
// From (rule, entities) to a lane: a hash table of lane numbers in one block of memory. Whoever owns the lanes says how
// to tell them apart. Looked up only, never walked.
// Algorithm: linear probing; what is removed is filled by moving the rest of its run up (Knuth, TAOCP 6.4, algorithm R).
// Tested by tests/grammar/lane_index_test.cc
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "grammar/program.h"

namespace prehend::grammar {

struct LaneKey {
  int rule = kNone;
  Binding entities = kUnbound;
  friend bool operator==(const LaneKey&, const LaneKey&) = default;
};

class LaneIndex {
 public:
  /// kNone if there is none. `key_of(lane)` gives the key of a lane in the table, here and below.
  template <typename KeyOf>
  int Find(const LaneKey& key, const KeyOf& key_of) const {
    for (std::size_t slot = Home(key); slots_[slot] != kNone; slot = Next(slot)) {
      if (key_of(slots_[slot]) == key) return slots_[slot];
    }
    return kNone;
  }

  /// The lane's key is not in the table yet.
  template <typename KeyOf>
  void Insert(int lane, const KeyOf& key_of) {
    if (2 * ++count_ > slots_.size()) {
      std::vector<int> old(2 * slots_.size(), kNone);
      old.swap(slots_);
      for (const int other : old) {
        if (other != kNone) Put(other, key_of(other));
      }
    }
    Put(lane, key_of(lane));
  }

  /// The lane is in the table.
  template <typename KeyOf>
  void Erase(int lane, const KeyOf& key_of) {
    std::size_t hole = Home(key_of(lane));
    while (slots_[hole] != lane) hole = Next(hole);
    slots_[hole] = kNone;
    --count_;
    for (std::size_t slot = Next(hole); slots_[slot] != kNone; slot = Next(slot)) {
      const std::size_t way_from_home = (slot - Home(key_of(slots_[slot]))) & (slots_.size() - 1);
      if (way_from_home < ((slot - hole) & (slots_.size() - 1))) continue;
      slots_[hole] = std::exchange(slots_[slot], kNone);
      hole = slot;
    }
  }

 private:
  std::size_t Home(const LaneKey& key) const {
    std::uint64_t hash = static_cast<std::uint64_t>(key.rule) + 1;
    for (const int entity : key.entities) {
      hash = (hash ^ static_cast<std::uint32_t>(entity)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash) & (slots_.size() - 1);
  }
  std::size_t Next(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }
  void Put(int lane, const LaneKey& key) {
    std::size_t slot = Home(key);
    while (slots_[slot] != kNone) slot = Next(slot);
    slots_[slot] = lane;
  }

  std::vector<int> slots_ = std::vector<int>(16, kNone);  // a power of two, at most half full
  std::size_t count_ = 0;
};

}  // namespace prehend::grammar
