// SPDX-License-Identifier: Apache-2.0
// Which of a grammar's thresholds a touch or a grip has crossed: a measured value is compared once,
// when a frame gives it. Tested by tests/grammar/program/thresholds_test.cc
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace prehend::grammar {

/// A number that a measured value is compared with. The value has crossed the threshold if it is at
/// least that number (for `> x`, the next larger one). While a value stays on the same side of
/// every threshold, every comparison of it keeps its result.
struct Threshold {
  enum class Value : std::uint8_t {
    kSensorSets,
    kUpOnFirst,
    kUpOnSecond,
    kForce,
    kVerticalSpeed,
    kTrigger
  };
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
    for (std::uint32_t sets = 0; sets < sets_.size(); ++sets) sets_[sets] = OfSets(sets);
    no_touch_ = OfTouch(-1, -1, 0, 0, 0);
  }

  /// Of a touch; bits of other values are not set.
  ThresholdSet OfTouch(double up_on_first, double up_on_second, double force_n,
                       double vertical_speed_m_per_s, std::uint32_t sensor_sets) const {
    const std::array<double, 4> measured = {up_on_first, up_on_second, force_n,
                                            vertical_speed_m_per_s};
    ThresholdSet crossed = sensor_sets < sets_.size() ? sets_[sensor_sets] : OfSets(sensor_sets);
    for (const Cut& cut : touches_) crossed |= measured[cut.value] >= cut.at_least ? cut.bit : 0;
    return crossed;
  }
  ThresholdSet OfNoTouch() const { return no_touch_; }
  /// Of how far a hand is closed; likewise.
  ThresholdSet OfGrip(double trigger) const {
    ThresholdSet crossed = 0;
    for (const Cut& cut : grips_) crossed |= trigger >= cut.at_least ? cut.bit : 0;
    return crossed;
  }

 private:
  struct Cut {
    std::size_t value = 0;  // of a touch: which of the four
    double at_least = 0;
    ThresholdSet bit = 0;
  };

  void Add(const Threshold& threshold, ThresholdSet bit) {
    switch (threshold.value) {
      case Threshold::Value::kSensorSets:
        set_counts_.push_back({0, threshold.at_least, bit});
        break;
      case Threshold::Value::kUpOnFirst:
        touches_.push_back({0, threshold.at_least, bit});
        break;
      case Threshold::Value::kUpOnSecond:
        touches_.push_back({1, threshold.at_least, bit});
        break;
      case Threshold::Value::kForce:
        touches_.push_back({2, threshold.at_least, bit});
        break;
      case Threshold::Value::kVerticalSpeed:
        touches_.push_back({3, threshold.at_least, bit});
        break;
      case Threshold::Value::kTrigger:
        grips_.push_back({0, threshold.at_least, bit});
        break;
    }
  }
  ThresholdSet OfSets(std::uint32_t sensor_sets) const {
    ThresholdSet crossed = 0;
    for (const Cut& cut : set_counts_)
      crossed |= std::popcount(sensor_sets) >= cut.at_least ? cut.bit : 0;
    return crossed;
  }

  std::vector<Cut> touches_;
  std::vector<Cut> grips_;
  std::vector<Cut> set_counts_;
  std::array<ThresholdSet, 64> sets_ = {};  // OfSets() of up to six sets: most hands have no more
  ThresholdSet no_touch_ = 0;
};

}  // namespace prehend::grammar
