// SPDX-License-Identifier: Apache-2.0
// The one place that opens an episode, of any kind. Tested by tests/program/episode_kinds_test.cc
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "harness/episode/episode/episode.h"

namespace prehend::episode {

/// Opens episodes one after another; what several of them need is read once.
class EpisodeOpener {
 public:
  /// `root`: the project's.
  explicit EpisodeOpener(std::string root) : root_(std::move(root)), loader_(root_) {}

  /// Reads the scenario and the grammar, of a recording its frames, too. `asked`: settings of a
  /// scenario may be fields of it. `files` receives what a scenario was read from.
  Result<Episode> Open(const EpisodeName& name, const GrammarChoice& asked = {},
                       std::vector<std::string>* files = nullptr);
  /// A recording that is no file.
  Result<Episode> Open(Recording recording, const EpisodeName& name, const GrammarChoice& choice);

  /// The grammar alone, with other values of its parameters; no frames are read.
  grammar::CompileResult Compile(const EpisodeName& name, const std::string& asked,
                                 const grammar::Overrides& parameters);

 private:
  Result<Episode> OpenLines(const EpisodeName& name, const GrammarChoice& choice);
  Result<Episode> OpenKept(const EpisodeName& name, const GrammarChoice& choice);
  Result<EpisodeRow> FindKept(const EpisodeName& name);

  std::string root_;
  EpisodeLoader loader_;
  std::shared_ptr<const EpisodeFile> file_;
  std::optional<EpisodeName> compiled_;  ///< whose own grammar is `own_`
  LoadedRun own_;
};

/// Empty if all were played or recorded with the same grammar.
grammar::Diagnostics WhyNotOneGrammar(std::span<const EpisodeName> episodes,
                                      const std::string& root);

/// A single one.
Result<Episode> OpenEpisode(const EpisodeName& name, const GrammarChoice& choice,
                            const std::string& root, std::vector<std::string>* files = nullptr);

}  // namespace prehend::episode
