// SPDX-License-Identifier: Apache-2.0
// Pictures of the answers to a question: the world when an event begins, and the paths of its hand
// and its thing until it ends. Tested by tests/program/query_test.cc
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/episodes/query_events.h"

namespace prehend::harness {

/// More answers than this are not drawn.
inline constexpr std::size_t kMostQueryPictures = 100;

struct QueryPictures {
  std::vector<std::string> files;  ///< one per answer; empty: not drawn
  std::string error;               ///< empty, or why (some) could not be drawn
};

/// Draws each answer as FOLDER/NUMBER-SCENARIO-EVENT.png; makes the folder. `root`: the project's.
QueryPictures DrawAnswers(const std::vector<episodes::EventAnswer>& answers,
                          const std::string& folder, const std::string& root);

}  // namespace prehend::harness
