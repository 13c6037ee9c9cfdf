// SPDX-License-Identifier: Apache-2.0
// What episodes show of a grammar: which rules have intervals, which clauses decide, on which sides
// of its threshold each was, and how near. Asks the engine's own record of an episode, so it
// changes no event. Tested by tests/program/coverage_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/replay_monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/run/find_scenario.h"

namespace prehend::measure {

/// What was seen of a clause: [0] while it was false, [1] while it was true.
struct Sides {
  /// Frames in which it decided: its rule's condition would have been otherwise, had it been. Of a
  /// clause about whole intervals, these.
  std::array<std::int64_t, 2> decided = {};
  /// Of a threshold, how near the value came, in the unit of the clause.
  std::array<double, 2> nearest = {kFar, kFar};
  static constexpr double kFar = std::numeric_limits<double>::infinity();  ///< in JSON: null

  bool IsSeen(bool truth) const { return decided[truth] > 0; }
  void Add(bool truth, double distance = kFar, std::int64_t times = 1);
};

/// What stands at one place of a grammar. What is named with `define` is one clause, however many
/// rules use it.
struct Clause {
  std::string file;
  int line = 0, column = 0;
  std::string rule;  ///< the first one that asks for it
  std::string part;  ///< "while", "from", .. of that rule
  std::string text;
  std::string unit;  ///< SI; "" of a plain number
  bool is_threshold = false;
  std::int64_t began = 0, ended = 0;  ///< intervals that it began or ended, by turning
  std::map<std::size_t, Sides> seen;  ///< by episode
  Sides all;
  bool HasBothSides() const { return all.IsSeen(false) && all.IsSeen(true); }
};

struct CoveredRule {
  std::string name, file;
  int line = 0, column = 0;
  bool is_event = false;
  std::int64_t bound = 0;  ///< bindings that were looked at
  std::int64_t begun = 0;  ///< runs, whatever became of them
  std::int64_t open_end = 0;
  std::map<std::string, std::int64_t> became;  ///< "interval", "too short", "refused", ..
  std::vector<std::size_t> episodes;           ///< with an interval
};

struct Coverage {
  std::string grammar;
  std::vector<std::string> episodes;
  std::vector<std::size_t> smallest;  ///< these show as much as all of them
  std::vector<CoveredRule> rules;
  std::vector<Clause> clauses;  ///< by place
  struct Share {
    std::size_t covered = 0, all = 0;
    double percent() const {
      return all == 0 ? 100 : 100 * static_cast<double>(covered) / static_cast<double>(all);
    }
  };
  Share Rules() const;       ///< with an interval
  Share Decided() const;     ///< clauses that decided, on any side
  Share Clauses() const;     ///< that decided on both sides
  Share Thresholds() const;  ///< likewise, of those that compare
};

/// What one episode shows: episode 0.
Coverage CoverageOf(grammar::ReplayMonitor& past);

struct CoverageRequest {
  std::string root;
  std::string grammar;  ///< "": that of the episodes
  int jobs = 1;
};
/// Or why an episode cannot be watched.
Result<Coverage> CoverageOf(const std::vector<episode::EpisodeName>& episodes,
                            const CoverageRequest& request);

std::string CoverageText(const Coverage& coverage);
nlohmann::json CoverageJson(const Coverage& coverage);
/// For editors and CI: the format of lcov.
std::string CoverageLcov(const Coverage& coverage);

}  // namespace prehend::measure
