// SPDX-License-Identifier: Apache-2.0
// An episode to look at once more, from a scenario that is played or from a recording, with the
// grammar that watches it. Tested by tests/program/explain_command_test.cc
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/read_result.h"

namespace prehend::harness {

struct EpisodeSource {
  using Watcher = std::function<void(const grammar::Frame&)>;
  struct Played {
    grammar::Tick end = 0;  ///< the first tick that no longer belongs to it
    std::string failure;    ///< empty, or why the simulation ended early
  };

  std::string name;
  std::shared_ptr<const grammar::Program> program;
  grammar::EntityTable entity_table;
  std::function<Played(const Watcher&)> play;  ///< shows every frame
};

/// Whether what was typed is a recording (docs/recording-format.md) and no scenario: a file that
/// begins with `{`.
bool IsRecording(const std::string& typed);

/// `grammar` empty: the episode's own. `settings` as for `prehend run --set`; of a recording, only
/// parameters.
ReadResult<EpisodeSource> OpenScenario(const std::string& file, const std::string& grammar,
                                       const std::vector<std::string>& settings,
                                       const std::string& root);
ReadResult<EpisodeSource> OpenRecording(const std::string& file, const std::string& grammar,
                                        const std::vector<std::string>& settings,
                                        const std::string& root);

}  // namespace prehend::harness
