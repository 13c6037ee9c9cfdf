// SPDX-License-Identifier: Apache-2.0
// A recorded task and its episodes as statements (docs/knowledge.md): a semantic map of the
// entities, and the events with their participants. Tested by
// tests/program/knowledge_test.cc
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/exchange/knowledge/triples.h"
#include "physics/base/pose.h"

namespace prehend::exchange {

/// How an event is written down.
struct EventTerm {
  std::string name;      ///< "knowrob:Reaching"
  std::string base;      ///< a class of DUL or SOMA above it; of another grammar's event empty
  std::string relation;  ///< to `concept_name`: "dul:executesTask", "dul:isClassifiedBy"; or empty
  std::string concept_name;  ///< "knowrob:ReachingTask"
};

class Vocabulary {
 public:
  /// Reads harness/exchange/knowledge/prehend.ttl of what ships.
  static Result<Vocabulary> Load();

  /// The terminology as it stands in its file.
  const std::string& text() const { return text_; }

  EventTerm TermOf(const std::string& event) const;
  /// "knowrob:performedBy" of "hand".
  std::string PropertyOf(const std::string& role) const;
  /// "knowrob:WrapStyle" of "wrap".
  std::string StyleOf(const std::string& style) const;
  /// "knowrob:MilkCarton". A class that is called like a word that means something else gets
  /// "Object" behind it.
  std::string ClassOf(const std::string& name) const;
  /// Whether the terminology has this name.
  bool Has(const std::string& name) const { return known_.contains(name); }

 private:
  std::string text_;
  std::map<std::string, EventTerm> events_;
  std::map<std::string, std::string> roles_, styles_;
  std::set<std::string> known_, things_;
};

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

}  // namespace prehend::exchange
