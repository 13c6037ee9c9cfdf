// SPDX-License-Identifier: Apache-2.0
// Plays an episode and remembers all of it.
// Tested by tests/harness/explain/explain_test.cc
#pragma once

#include <memory>

#include "grammar/replay_monitor.h"
#include "harness/run/open_episode.h"

namespace prehend::harness::explain {

/// More would take too much memory: at 240 frames per second, seven minutes.
inline constexpr grammar::FrameNumber kMaxFrames = 100'000;

struct Watched {
  std::unique_ptr<grammar::ReplayMonitor> past;
  std::string failure;  ///< empty, or why the simulation ended early
  std::string problem;  ///< empty, or why the grammar cannot watch this; then nothing may be asked
};

Watched Watch(const EpisodeSource& source);

}  // namespace prehend::harness::explain
