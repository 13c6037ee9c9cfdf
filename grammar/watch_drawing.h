// SPDX-License-Identifier: Apache-2.0
// What a grammar recognises in a drawn episode. Tested by
// tests/grammar/drawing/read_drawings_test.cc
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/drawing/drawn_episode.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

struct WatchedDrawing {
  std::string error;  ///< of the monitor; empty: none
  Timeline timeline;
};

WatchedDrawing WatchDrawing(const std::shared_ptr<const Program>& program,
                            const DrawnEpisode& drawn, int frames_per_second = 100);

/// What the timeline shows of the events, and below them a row "violated NAME" for each law that is
/// broken, where it is.
std::vector<DrawnRow> DrawWatched(const Program& program, const DrawnEpisode& drawn,
                                  const Timeline& timeline);

/// Expected rows that name no event, no law or nobody. `file` is what the episode was read from.
Diagnostics CheckExpected(const Program& program, const DrawnEpisode& drawn,
                          const GrammarText& file);

}  // namespace prehend::grammar
