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
  // Number by number: what was just written so is not ready to be read as one block.
  friend bool operator==(const LaneKey& a, const LaneKey& b) {
    return a.rule == b.rule && a.entities[0] == b.entities[0] && a.entities[1] == b.entities[1] &&
           a.entities[2] == b.entities[2] && a.entities[3] == b.entities[3];
  }
};

class LaneIndex {
 public:
  /// kNone if there is none. `key_of(lane)` gives the key of a lane in the table.
  template <typename KeyOf>
  int Find(const LaneKey& key, const KeyOf& key_of) const {
    const std::uint32_t hash = Hash(key);
    for (std::size_t at = Home(hash); slots_[at].lane != kNone; at = Next(at)) {
      if (slots_[at].hash == hash && key_of(slots_[at].lane) == key) return slots_[at].lane;
    }
    return kNone;
  }

  /// The key is not in the table yet.
  void Insert(int lane, const LaneKey& key) {
    if (2 * ++count_ > slots_.size()) {
      std::vector<Slot> old(2 * slots_.size());
      old.swap(slots_);
      for (const Slot& slot : old) {
        if (slot.lane != kNone) Put(slot);
      }
    }
    Put({Hash(key), lane});
  }

  /// The lane is in the table, with this key.
  void Erase(int lane, const LaneKey& key) {
    std::size_t hole = Home(Hash(key));
    while (slots_[hole].lane != lane) hole = Next(hole);
    slots_[hole] = {};
    --count_;
    for (std::size_t at = Next(hole); slots_[at].lane != kNone; at = Next(at)) {
      const std::size_t way_from_home = (at - Home(slots_[at].hash)) & (slots_.size() - 1);
      if (way_from_home < ((at - hole) & (slots_.size() - 1))) continue;
      slots_[hole] = std::exchange(slots_[at], {});
      hole = at;
    }
  }

 private:
  struct Slot {
    std::uint32_t hash = 0;
    int lane = kNone;
  };

  static std::uint32_t Hash(const LaneKey& key) {
    const auto pair = [&](int i) {
      return std::uint64_t{static_cast<std::uint32_t>(key.entities[i])} << 32 | static_cast<std::uint32_t>(key.entities[i + 1]);
    };
    std::uint64_t hash = (pair(0) ^ (static_cast<std::uint64_t>(key.rule) << 20)) * 0x9E3779B97F4A7C15ULL;
    hash = (hash ^ (hash >> 32) ^ pair(2)) * 0xD6E8FEB86659FD93ULL;
    return static_cast<std::uint32_t>(hash >> 32);
  }
  std::size_t Home(std::uint32_t hash) const { return hash & (slots_.size() - 1); }
  std::size_t Next(std::size_t at) const { return (at + 1) & (slots_.size() - 1); }
  void Put(const Slot& slot) {
    std::size_t at = Home(slot.hash);
    while (slots_[at].lane != kNone) at = Next(at);
    slots_[at] = slot;
  }

  std::vector<Slot> slots_ = std::vector<Slot>(16);  // a power of two, at most half full
  std::size_t count_ = 0;
};

}  // namespace prehend::grammar
