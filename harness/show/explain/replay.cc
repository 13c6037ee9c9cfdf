// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/replay.h"

#include <fmt/format.h>

namespace prehend::show {

Watched Watch(const std::shared_ptr<const grammar::Program>& program,
              const grammar::EntityTable& entities, const PlayFrames& play) {
  Watched watched;
  watched.past = std::make_unique<grammar::ReplayMonitor>(program, entities);
  grammar::ReplayMonitor& past = *watched.past;
  bool too_long = false;
  const episode::Episode::End played = play([&](const grammar::Frame& frame) {
    too_long = too_long || past.frames() >= kMaxFrames;
    if (!too_long) past.Advance(frame);
  });
  past.Finish(played.tick);
  watched.failure = played.failure;
  if (!past.error().empty()) {
    watched.problem = "the grammar cannot be evaluated on this episode: " + past.error();
  } else if (too_long) {
    watched.problem = fmt::format(
        "the episode has more than {} frames, and all of them would have to be remembered",
        kMaxFrames);
  } else if (past.frames() == 0) {
    watched.problem = played.failure.empty() ? "the episode has no frames" : played.failure;
  }
  return watched;
}

Watched Watch(episode::Episode& episode) {
  return Watch(episode.program(), episode.entities(),
               [&](const auto& look) { return episode.EachFrame(look); });
}

}  // namespace prehend::show
