// SPDX-License-Identifier: Apache-2.0
// For commands that ask an episode file: what is in none is played, or imported, into one first.
// Tested by tests/program/episode_kinds_test.cc
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/base/base/temporary_folder.h"
#include "harness/episode/run/episode_name.h"

namespace prehend::episode {

class EpisodeKeeper {
 public:
  /// `root`: the project's; `today`: YYYY-MM-DD; `folder` gets the files; "": one that is removed
  /// at the end.
  EpisodeKeeper(std::string root, std::string today, std::string folder = "");

  /// The same episode in a file.
  Result<EpisodeName> Keep(const EpisodeName& episode);
  Result<std::vector<EpisodeName>> KeepAll(std::vector<EpisodeName> episodes);
  /// Of a file that was made here, the scenario or recording in it; any other is as it is.
  std::string SourceOf(const std::string& file) const;

 private:
  TemporaryFolder temporary_;
  std::string root_, today_, folder_;
  std::map<std::string, std::string> sources_;
};

}  // namespace prehend::episode
