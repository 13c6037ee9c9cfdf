// SPDX-License-Identifier: Apache-2.0
// Which of a grammar's thresholds a touch or a grip is beyond: what is measured is compared once, where it is seen.
// Tested by tests/grammar/thresholds_test.cc
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace prehend::grammar {

/// A number that a measured value is compared with: it is beyond the threshold if it is at least that number (for `> x`,
/// the next larger one). While a value stays on the same side of every threshold, whatever is said by comparing it stays
/// as it is.
struct Threshold {
  enum class Value : std::uint8_t { kSensorSets, kUpOnFirst, kUpOnSecond, kForce, kTrigger };
  Value value = Value::kSensorSets;
  double at_least = 0;
  friend bool operator==(const Threshold&, const Threshold&) = default;
};

/// A set of thresholds, bit i for Program::thresholds[i], and of anything else that may change.
using ThresholdSet = std::uint64_t;
inline constexpr int kMaxThresholds = 63;
inline constexpr ThresholdSet kAnyChange = ThresholdSet{1} << kMaxThresholds;

/// Compares with all thresholds of a program.
class Thresholds {
 public:
  explicit Thresholds(const std::vector<Threshold>& thresholds) {
    for (std::size_t i = 0; i < thresholds.size(); ++i) Add(thresholds[i], ThresholdSet{1} << i);
    no_touch_ = OfTouch(-1, -1, 0, 0);
  }

  /// Of a touch; bits of other values are not set.
  ThresholdSet OfTouch(double up_on_first, double up_on_second, double force_n, std::uint32_t sensor_sets) const {
    return (any_sets_ ? sets_[static_cast<std::size_t>(std::popcount(sensor_sets))] : 0) |
           Beyond(Threshold::Value::kUpOnFirst, up_on_first) | Beyond(Threshold::Value::kUpOnSecond, up_on_second) |
           Beyond(Threshold::Value::kForce, force_n);
  }
  ThresholdSet OfNoTouch() const { return no_touch_; }
  /// Of how far a hand is closed; likewise.
  ThresholdSet OfGrip(double trigger) const { return Beyond(Threshold::Value::kTrigger, trigger); }

 private:
  struct Cut {
    double at_least = 0;
    ThresholdSet bit = 0;
  };
  static constexpr std::size_t kMostSets = 32;

  void Add(const Threshold& threshold, ThresholdSet bit) {
    if (threshold.value != Threshold::Value::kSensorSets) {
      cuts_[static_cast<std::size_t>(threshold.value)].push_back({threshold.at_least, bit});
      return;
    }
    any_sets_ = true;
    for (std::size_t count = 0; count <= kMostSets; ++count) {
      if (static_cast<double>(count) >= threshold.at_least) sets_[count] |= bit;
    }
  }
  ThresholdSet Beyond(Threshold::Value value, double measured) const {
    ThresholdSet beyond = 0;
    for (const Cut& cut : cuts_[static_cast<std::size_t>(value)]) beyond |= measured >= cut.at_least ? cut.bit : 0;
    return beyond;
  }

  std::array<std::vector<Cut>, 5> cuts_;  // by value; of sensor sets there are whole numbers only
  std::array<ThresholdSet, kMostSets + 1> sets_ = {};  // by how many
  bool any_sets_ = false;
  ThresholdSet no_touch_ = 0;
};

}  // namespace prehend::grammar
