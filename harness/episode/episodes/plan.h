// SPDX-License-Identifier: Apache-2.0
// Parts of something large: a suite or many trials, on several machines. The file of a part says
// what all parts owe and what of it is complete, so that work that was stopped goes on there, and
// what is missing has a name. Tested by tests/program/parts.py and
// tests/harness/suite/check/select_scenarios_test.cc
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/episode_file.h"

namespace prehend::episode {

/// All that is owed, and which part of it is to be recorded here.
struct Plan {
  std::string what;  ///< for people: "check slide/*"
  std::string uuid;  ///< of what is asked, of all files and of the program; not of the parts
  int number = 1, count = 1;
  struct Owed {
    std::string name;  ///< a scenario, or "SCENARIO, trial 7"
    int part = 1;      ///< 1 to count
  };
  std::vector<Owed> owed;  ///< of all parts, in the same order on every machine

  /// The UUID of the episode that pays it, whoever plays it: empty in a plan without a UUID.
  std::string UuidOfEpisode(const std::string& name) const;
};

/// The plan of what `words` ask of these files and of the scenarios, hands and grammars of the
/// project at `root`. Without parts, and nothing is owed yet.
Plan MakePlan(const std::vector<std::string>& words, std::vector<std::string> files,
              const std::string& root);

/// Writes the plan into an episode file, unless it is there; episodes of this part that were cut
/// off are removed. Returns those that are complete, by their names in the plan. A file that was
/// begun as the same part by another program, or of other files, is an error.
Result<std::map<std::string, EpisodeRow>> BeginPart(const std::string& file, const Plan& plan);

/// When all of a part is complete, its file gets the bytes that it would have if nothing had ever
/// been stopped. A plan without parts leaves the file, in which others may be writing, as it is.
/// "", or what went wrong.
std::string EndPart(const std::string& file, const Plan& plan);

/// A plan as some files have it, and what of it is complete in none of them.
struct Standing {
  Plan plan;  ///< its number: 0 if the files have several of its parts
  std::vector<Plan::Owed> missing;
};
/// Of many files, one after another.
class StandingFinder {
 public:
  void Add(const Database& database);
  /// Each plan once, in the order of their texts.
  std::vector<Standing> Standings() const;

 private:
  std::vector<Plan> plans_;
  std::set<std::string> complete_;  ///< UUIDs
};

/// The parts and the names of what is missing, a line each.
std::string TextOf(const std::vector<Standing>& standings);

void WritePlan(const Database& database, const Plan& plan);

struct Merged {
  std::size_t files = 0, episodes = 0, twice = 0;
  std::string missing;  ///< TextOf() what is complete in none
  std::string notes;    ///< what is not copied
};
/// One file of many: the episodes of plans in the order of these, then the others as they come.
/// What is complete in none stays away if it is of a plan. The same episode twice becomes one, if
/// all but its date is equal; otherwise it is an error. The bytes of the file depend on nothing but
/// what is in it: parts that were stopped, and one run without parts, give the same ones.
Result<Merged> MergeEpisodes(std::span<const std::string> files, const std::string& output);

}  // namespace prehend::episode
