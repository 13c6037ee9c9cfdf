// SPDX-License-Identifier: Apache-2.0
// Writes recorded episodes as a folder for knowledge bases (docs/knowledge.md): the terminology, a
// map per task, a file per episode. Tested by tests/program/knowledge_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/run/find_scenario.h"

namespace prehend::exchange {

struct KnowledgeRequest {
  std::string root;        ///< the project's
  std::string folder;      ///< made if it is not there; files of the same episodes are replaced
  std::string unfinished;  ///< another one, of which `folder` gets all when nothing went wrong
  bool owl = false;        ///< RDF/XML beside each Turtle file, by rapper
  bool neem = false;       ///< the collections of a NEEM per episode
};

struct KnowledgeWritten {
  std::size_t episodes = 0, tasks = 0, events = 0, statements = 0;
};

/// `episodes` are runs kept in files. Writes nothing if one cannot be read. Reports what cannot be
/// written.
Result<KnowledgeWritten> WriteKnowledge(const std::vector<episode::EpisodeName>& episodes,
                                        const KnowledgeRequest& request);

}  // namespace prehend::exchange
