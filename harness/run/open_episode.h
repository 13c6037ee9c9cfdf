// SPDX-License-Identifier: Apache-2.0
// An episode and the grammar that segments it, from a scenario (which is simulated) or from a
// recording. Tested by tests/program/explain_command_test.cc
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/result.h"

namespace prehend::harness {

struct EpisodeSource {
  using Watcher = std::function<void(const grammar::Frame&)>;
  struct Played {
    grammar::Tick end = 0;  ///< the first tick after the episode
    std::string failure;    ///< empty, or why the simulation ended early
  };

  std::string name;
  std::shared_ptr<const grammar::Program> program;
  grammar::EntityTable entity_table;
  std::function<Played(const Watcher&)> play;  ///< calls the watcher with every frame
};

/// Whether this is a recording (docs/recording-format.md) and not a scenario: a file that begins
/// with `{`.
bool IsRecording(const std::string& typed);

/// If `grammar` is empty, the episode's own. `settings` are those of `prehend run --set`; for a
/// recording, only parameters of the grammar.
Result<EpisodeSource> OpenScenario(const std::string& file, const std::string& grammar,
                                   const std::vector<std::string>& settings,
                                   const std::string& root);
Result<EpisodeSource> OpenRecording(const std::string& file, const std::string& grammar,
                                    const std::vector<std::string>& settings,
                                    const std::string& root);

}  // namespace prehend::harness
