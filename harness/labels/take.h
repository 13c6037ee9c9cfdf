// SPDX-License-Identifier: Apache-2.0
// A recording that any grammar can segment again: of a tracker (JSON Lines) or of a run (an episode
// file). And which file of labels belongs to it. Tested by tests/program/labels_test.cc
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/base/result.h"
#include "harness/episodes/resegment_many.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness::labels {

/// Where it is: `id` 0 means a recording as JSON Lines.
using TakeName = episodes::EpisodeName;

struct Take {
  std::vector<grammar::EntityInfo> entities;
  std::string grammar;                                   ///< its own
  std::shared_ptr<const grammar::Program> program = {};  ///< of a run, that grammar as it was
  grammar::Tick ticks_per_second = 1, end = 1;
  std::shared_ptr<Episode> recording = {};  ///< of what was not simulated
  std::function<Result<grammar::Timeline>(std::shared_ptr<const grammar::Program>)> segment;
};

/// `root`: the project, for its grammars and hands.
Result<Take> OpenTake(const TakeName& name, const std::string& root);

/// All takes of these files, of episode files each episode that `which` selects ("": all).
Result<std::vector<TakeName>> TakesOf(const std::vector<std::string>& files,
                                      const std::string& which);

/// The grammar that the recordings name for themselves, for commands without --grammar; of runs the
/// default one. Reports recordings that name different grammars.
Result<std::string> OwnGrammar(const std::vector<TakeName>& takes);

/// The file of labels of each take: as many as there are takes, in their order; or, where `given`
/// is one folder, the file there with the take's name: of take1.jsonl take1.csv, take1.eaf, ..; of
/// an episode SKILL/NAME.csv or NAME.csv. "" and `problem` where one is missing.
std::vector<std::string> LabelFilesOf(const std::vector<TakeName>& takes,
                                      const std::vector<std::string>& given, std::string& problem);

}  // namespace prehend::harness::labels
