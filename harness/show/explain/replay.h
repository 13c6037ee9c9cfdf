// SPDX-License-Identifier: Apache-2.0
// Plays an episode and remembers all of it.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "grammar/replay_monitor.h"
#include "harness/episode/episode/episode.h"

namespace prehend::show {

/// More would take too much memory: at 240 frames per second, seven minutes.
inline constexpr grammar::FrameNumber kMaxFrames = 100'000;

struct Watched {
  std::unique_ptr<grammar::ReplayMonitor> past;
  std::string failure;  ///< empty, or why the simulation ended early
  std::string problem;  ///< empty, or why the grammar cannot watch this; then nothing may be asked
};

/// Calls its argument with every frame of an episode.
using PlayFrames =
    std::function<episode::Episode::End(const std::function<void(const grammar::Frame&)>&)>;

Watched Watch(const std::shared_ptr<const grammar::Program>& program,
              const grammar::EntityTable& entities, const PlayFrames& play);
Watched Watch(episode::Episode& episode);

}  // namespace prehend::show
