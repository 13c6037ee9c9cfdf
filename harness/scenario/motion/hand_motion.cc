// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/motion/hand_motion_test.cc
#include "harness/scenario/motion/hand_motion.h"

#include <fmt/format.h>

#include <algorithm>

namespace prehend::scenario {
namespace {

/// An uneven rate is not a gap, nor is a single missing sample at 90 Hz.
constexpr double kMinGap_s = 0.05;
constexpr double kGapOfMedian = 4;
/// Hands are slower than this, and noise moves them less far.
constexpr double kJumpSpeed_m_per_s = 8;
constexpr double kMinJump_m = 0.03;
constexpr std::size_t kMaxReported = 12;

double MedianInterval(const std::vector<TrackSample>& samples) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals.push_back(samples[i].t_s - samples[i - 1].t_s);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

class TrackChecker {
 public:
  TrackChecker(const MotionTrack& track, const TrackLimits& limits)
      : track_(track), limits_(limits) {}

  grammar::Diagnostics Check() {
    const double usual_s = MedianInterval(track_.samples);
    if (usual_s > limits_.gap_s) {
      Add(track_.samples[1], false,
          fmt::format("samples are typically {:.3f} s apart; gaps of at most {} s are bridged",
                      usual_s, limits_.gap_s),
          "milliseconds need a column t_ms; otherwise raise max_gap_s");
      return std::move(found_);
    }
    const double gap_s = std::max(kMinGap_s, kGapOfMedian * usual_s);
    for (std::size_t i = 1; i < track_.samples.size(); ++i) {
      const TrackSample &before = track_.samples[i - 1], &sample = track_.samples[i];
      const double dt_s = sample.t_s - before.t_s;
      const double way_m = (sample.X_RD.p_m - before.X_RD.p_m).norm();
      if (dt_s > limits_.gap_s) {
        Add(sample, false,
            fmt::format("gap: no sample for {:.3f} s before this one, at {:.3f} s; at most {} s "
                        "are bridged",
                        dt_s, sample.t_s, limits_.gap_s),
            "cut the recording with from_s and to_s, or raise max_gap_s");
      } else if (dt_s > gap_s) {
        Add(sample, true,
            fmt::format("gap: no sample for {:.3f} s before this one, at {:.3f} s; it is bridged",
                        dt_s, sample.t_s));
      }
      if (way_m <= kMinJump_m || way_m <= kJumpSpeed_m_per_s * dt_s) continue;
      const std::string jump =
          fmt::format("jump: {:.3f} m within {:.3f} s, at {:.3f} s", way_m, dt_s, sample.t_s);
      if (way_m > limits_.jump_m) {
        Add(sample, false, jump + fmt::format("; at most {} m are followed", limits_.jump_m),
            "cut the recording with from_s and to_s, or raise max_jump_m");
      } else {
        Add(sample, true, jump);
      }
    }
    return std::move(found_);
  }

 private:
  void Add(const TrackSample& sample, bool is_warning, std::string message, std::string hint = {}) {
    if (found_.size() == kMaxReported) return;
    found_.push_back(grammar::DiagnosticAt(track_.file, track_.text, sample.place,
                                           std::move(message), std::move(hint)));
    found_.back().is_warning = is_warning;
  }

  const MotionTrack& track_;
  const TrackLimits& limits_;
  grammar::Diagnostics found_;
};

}  // namespace

grammar::Diagnostics CheckTrack(const MotionTrack& track, const TrackLimits& limits) {
  return TrackChecker(track, limits).Check();
}

}  // namespace prehend::scenario
