// SPDX-License-Identifier: Apache-2.0
// How long a sweep will take, and to a person how far it is. Tested by tests/program/sweep_test.cc
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <ostream>

namespace prehend::measure {

/// Says once, after the first settings, how long all will take, unless that is soon.
class SweepProgress {
 public:
  /// `is_person`: how far it is is shown, too, in a line that is written anew.
  SweepProgress(std::size_t episodes, bool is_person, std::ostream& out)
      : episodes_(episodes), is_person_(is_person), out_(out) {}
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  /// Settings, each on one episode.
  void Tell(std::size_t done, std::size_t all);

 private:
  using Clock = std::chrono::steady_clock;
  struct Counted {
    Clock::time_point at;
    std::size_t done = 0;
  };

  const std::size_t episodes_;
  const bool is_person_;
  std::ostream& out_;
  const Clock::time_point start_ = Clock::now();
  std::optional<Counted> first_;
  bool said_ = false;
};

}  // namespace prehend::measure
