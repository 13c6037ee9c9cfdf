// SPDX-License-Identifier: Apache-2.0
// See harness/measure/sweep/sweep_progress.h. Tested by tests/program/sweep_test.cc
#include "harness/measure/sweep/sweep_progress.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace prehend::measure {
namespace {

/// "40 seconds", "12 minutes", "3.5 hours"
std::string TimeText(double seconds) {
  constexpr double kMinute_s = 60, kHour_s = 3600;
  if (seconds < 1.5 * kMinute_s) return fmt::format("{:.0f} seconds", std::ceil(seconds));
  if (seconds < 1.5 * kHour_s) return fmt::format("{:.0f} minutes", seconds / kMinute_s);
  return fmt::format("{:.1f} hours", seconds / kHour_s);
}

double Seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

SweepProgress::~SweepProgress() {
  if (said_ && is_person_) out_ << "\r\033[K" << std::flush;
}

void SweepProgress::Tell(std::size_t done, std::size_t all) {
  constexpr double kSoon_s = 2, kMeasured_s = 1;
  const Clock::time_point now = Clock::now();
  if (done > 0 && !first_) first_ = {now, done};
  if (!first_ || done == first_->done) return;
  // The first ones came with what happens once: grammars are compiled, recordings read.
  const double measured_s = Seconds(now - first_->at);
  const double more_s =
      measured_s * static_cast<double>(all - done) / static_cast<double>(done - first_->done);
  const double passed_s = Seconds(now - start_);
  if (!said_ && (measured_s < kMeasured_s || passed_s + more_s < kSoon_s)) return;
  if (!said_) {
    const std::size_t settings = all / episodes_;
    out_ << fmt::format("prehend: {} setting{} on {} recording{}, about {}\n", settings,
                        settings == 1 ? "" : "s", episodes_, episodes_ == 1 ? "" : "s",
                        TimeText(passed_s + more_s))
         << std::flush;
  }
  said_ = true;
  if (is_person_)
    out_ << fmt::format("\r\033[K{} %, about {} more", 100 * done / all, TimeText(more_s))
         << std::flush;
}

}  // namespace prehend::measure
