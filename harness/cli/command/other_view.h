// SPDX-License-Identifier: Apache-2.0
// What somebody else says happened in a run: its golden, another grammar, another physics engine.
// For commands with --against. Tested by tests/program/render_test.cc
#pragma once

#include <string>

#include "harness/cli/command/typed_episode.h"
#include "harness/truth/golden/compare.h"

namespace prehend::cli {

/// For help and messages.
inline constexpr const char* kViewForm = "golden|GRAMMAR|ENGINE";

struct OtherView {
  std::string name;              ///< "golden", "original_2020", "box2d"
  episode::RunResult run;        ///< its timeline; another engine's also has the recording
  truth::Comparison comparison;  ///< `expected` is the other view, `actual` the run that was played
};

/// `view` is "golden", the name of an engine, or a grammar: its name or its file. Otherwise, after
/// reporting why there is none, the exit code.
tl::expected<OtherView, ExitCode> OtherViewOrComplain(const PlayedRun& played,
                                                      const std::string& view,
                                                      const CommandContext& context);

}  // namespace prehend::cli
