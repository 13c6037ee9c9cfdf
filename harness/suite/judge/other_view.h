// SPDX-License-Identifier: Apache-2.0
// What somebody else says happened in a run: its golden, another grammar, another physics engine;
// and a sheet of both. Tested by tests/program/render_test.cc
#pragma once

#include <string>

#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/load_run.h"
#include "harness/show/figures/comparison_sheet.h"

namespace prehend::suite {

/// A run with every frame.
struct PlayedRun {
  episode::LoadedRun loaded;
  episode::RunResult run;
  bool simulated = true;  ///< otherwise its scene is a placeholder: its frames are not to be sensed
};

struct OtherView {
  std::string name;              ///< "golden", "original_2020", "box2d"
  episode::RunResult run;        ///< its timeline; another engine's also has the recording
  truth::Comparison comparison;  ///< `expected` is the other view, `actual` the run that was played
};

/// `view` is "golden", the name of an engine, or a grammar: its name or its file. `root`: the
/// project's.
tl::expected<OtherView, episode::NotFound> ViewOf(const PlayedRun& played, const std::string& view,
                                                  const std::string& root);

/// Both over time, and the scenes where they differ. `view` may also be "pictures": golden
/// pictures, those of now, and what differs. The name is that of the view.
struct NamedSheet {
  std::string name;
  show::Sheet sheet;
};
tl::expected<NamedSheet, episode::NotFound> SheetAgainst(const PlayedRun& played,
                                                         const std::string& view,
                                                         const show::Window& window,
                                                         const show::SceneFormat& format,
                                                         const std::string& root);

}  // namespace prehend::suite
