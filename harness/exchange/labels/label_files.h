// SPDX-License-Identifier: Apache-2.0
// Which file of labels belongs to an episode, and which grammar is its own. Tested by
// tests/program/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/run/episode_name.h"

namespace prehend::exchange {

/// The grammar that the recordings name for themselves, for commands without --grammar; of what was
/// simulated the default one. Reports recordings that name different grammars.
Result<std::string> OwnGrammar(const std::vector<episode::EpisodeName>& episodes);

/// The file of labels of each episode: as many as there are episodes, in their order; or, where
/// `given` is one folder, the file there with its name: of take1.jsonl take1.csv, take1.eaf, ..; of
/// an episode SKILL/NAME.csv or NAME.csv. "" and `problem` where one is missing.
std::vector<std::string> LabelFilesOf(const std::vector<episode::EpisodeName>& episodes,
                                      const std::vector<std::string>& given, std::string& problem);

}  // namespace prehend::exchange
