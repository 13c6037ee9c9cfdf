// SPDX-License-Identifier: Apache-2.0
// From what an instance is about to the instance: hash tables in one block of memory. Looked up
// only, never walked. Algorithm: linear probing; what is removed is filled by moving the rest of
// its run up (Knuth, TAOCP 6.4, algorithm R). Tested by tests/grammar/state/instance_index_test.cc
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "grammar/base/ids.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

// A growing sequence whose elements stay where they are, in blocks of many; an element is found by
// a shift and a mask. Tested by tests/grammar/state/stable_blocks_test.cc

template <typename Key, typename T>
class StableBlocks {
 public:
  std::size_t size() const { return size_; }
  /// The number of the next element to be added; all others are below it.
  Key end_id() const { return Key(size_); }

  T& operator[](Key key) {
    PREHEND_DCHECK(key.index() < size_);
    return (*blocks_[key.index() / kBlock])[key.index() % kBlock];
  }
  const T& operator[](Key key) const {
    PREHEND_DCHECK(key.index() < size_);
    return (*blocks_[key.index() / kBlock])[key.index() % kBlock];
  }

  T& PushBack() {
    if (size_ == kBlock * blocks_.size())
      blocks_.push_back(std::make_unique<std::array<T, kBlock>>());
    return (*this)[Key(size_++)];
  }

 private:
  static constexpr std::size_t kBlock = 64;  // a power of two
  std::vector<std::unique_ptr<std::array<T, kBlock>>> blocks_;
  std::size_t size_ = 0;
};

/// Any instance: a rule and whom it is bound to.
struct InstanceKey {
  RuleId rule;
  Binding entities = kUnbound;
  // Number by number: what was just written so is not ready to be read as one block.
  friend bool operator==(const InstanceKey& a, const InstanceKey& b) {
    return a.rule == b.rule && a.entities[0] == b.entities[0] && a.entities[1] == b.entities[1] &&
           a.entities[2] == b.entities[2] && a.entities[3] == b.entities[3];
  }
  std::uint32_t Hash() const {
    const auto pair = [&](int i) {
      return std::uint64_t{static_cast<std::uint32_t>(entities[i])} << 32 |
             static_cast<std::uint32_t>(entities[i + 1]);
    };
    std::uint64_t hash =
        (pair(0) ^ (static_cast<std::uint64_t>(rule.number()) << 20)) * 0x9E3779B97F4A7C15ULL;
    hash = (hash ^ (hash >> 32) ^ pair(2)) * 0xD6E8FEB86659FD93ULL;
    return static_cast<std::uint32_t>(hash >> 32);
  }
};

/// The instance of a touch: two entities in any order. A frame looks up each pair that it contains.
struct PairKey {
  std::uint64_t both = 0;
  PairKey() = default;
  PairKey(int a, int b)
      : both(std::uint64_t{static_cast<std::uint32_t>(std::min(a, b))} << 32 |
             static_cast<std::uint32_t>(std::max(a, b))) {}
  friend bool operator==(const PairKey&, const PairKey&) = default;
  std::uint32_t Hash() const {
    return static_cast<std::uint32_t>((both * 0x9E3779B97F4A7C15ULL) >> 32);
  }
};

template <typename Key>
class InstanceIndex {
 public:
  /// kNone if there is none.
  InstanceId Find(const Key& key) const {
    for (std::size_t at = Home(key); slots_[at].instance != kNone; at = Next(at)) {
      if (slots_[at].key == key) return slots_[at].instance;
    }
    return kNone;
  }

  /// The key is not in the table yet.
  void Insert(InstanceId instance, const Key& key) {
    if (2 * ++count_ > slots_.size()) {
      std::vector<Slot> old(2 * slots_.size());
      old.swap(slots_);
      last_ = slots_.size() - 1;
      for (const Slot& slot : old) {
        if (slot.instance != kNone) Put(slot);
      }
    }
    Put({key, instance});
  }

  /// The key is in the table.
  void Erase(const Key& key) {
    std::size_t hole = Home(key);
    while (!(slots_[hole].key == key)) hole = Next(hole);
    slots_[hole] = {};
    --count_;
    for (std::size_t at = Next(hole); slots_[at].instance != kNone; at = Next(at)) {
      const std::size_t way_from_home = (at - Home(slots_[at].key)) & last_;
      if (way_from_home < ((at - hole) & last_)) continue;
      slots_[hole] = std::exchange(slots_[at], {});
      hole = at;
    }
  }

 private:
  struct Slot {
    Key key;
    InstanceId instance;
  };

  std::size_t Home(const Key& key) const { return key.Hash() & last_; }
  std::size_t Next(std::size_t at) const { return (at + 1) & last_; }
  void Put(const Slot& slot) {
    std::size_t at = Home(slot.key);
    while (slots_[at].instance != kNone) at = Next(at);
    slots_[at] = slot;
  }

  static constexpr std::size_t kFewest =
      16;  // a power of two, and at most half of the slots are taken
  std::vector<Slot> slots_ = std::vector<Slot>(kFewest);
  std::size_t last_ = kFewest - 1;
  std::size_t count_ = 0;
};

}  // namespace prehend::grammar
