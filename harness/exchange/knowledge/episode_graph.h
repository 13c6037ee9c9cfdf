// SPDX-License-Identifier: Apache-2.0
// A recorded task and its episodes as statements (docs/knowledge.md): a semantic map of the
// entities, and the events with their participants. Tested by
// tests/program/knowledge_test.cc
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/episode/episodes/episode_file.h"
#include "harness/exchange/knowledge/vocabulary.h"
#include "physics/base/pose.h"

namespace prehend::exchange {

/// A task as a map shows it. Entities stand in the order of their numbers.
struct MapOfTask {
  episode::KeptTask task;
  std::string scenario;
  std::vector<episode::KeptEntity> entities;
  std::vector<physics::Pose> poses;  ///< when an episode begins; missing ones are left out
};

std::vector<Triple> MapTriples(const MapOfTask& map, const Vocabulary& vocabulary);

/// An episode with what was recognised in it.
struct EpisodeOfTask {
  episode::EpisodeRow row;
  std::string file;  ///< in which it is recorded
  grammar::Timeline timeline;
  std::set<std::string> composed;  ///< events that consist of others
};

std::vector<Triple> EpisodeTriples(const EpisodeOfTask& episode, const MapOfTask& map,
                                   const Vocabulary& vocabulary);

/// "log:UUID" of the event that stands at this place of its timeline.
std::string NameOfEvent(const std::string& episode_uuid, std::size_t index);

/// Names of the map of a task, and of the task.
std::string NameOfMap(const std::string& task_uuid);

}  // namespace prehend::exchange
