// SPDX-License-Identifier: Apache-2.0
// See select_scenarios.h. Tested by tests/house/command_line_test.cc
#include "harness/select_scenarios.h"

#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "harness/golden_files.h"
#include "harness/prepare_run.h"

namespace prehend::harness {
namespace {

std::string IdOf(const ScenarioFile& file) { return ScenarioId(file.skill, file.name); }

bool Matches(const std::string& pattern, const ScenarioFile& file) {
  return fnmatch(pattern.c_str(), file.name.c_str(), 0) == 0 ||
         fnmatch(pattern.c_str(), IdOf(file).c_str(), 0) == 0;
}

/// A file that cannot be read has no tags, but is checked when it is named.
bool HasTag(const ScenarioFile& file, const std::string& tag, const std::string& root) {
  const ReadResult<Scenario> scenario = ReadScenario(file.path, {}, ProjectLibrary(root));
  return scenario.value &&
         std::count(scenario.value->tags.begin(), scenario.value->tags.end(), tag) > 0;
}

bool PassesFilter(const ScenarioFile& file, const std::string& filter, const std::string& root) {
  if (filter.starts_with('!')) return !PassesFilter(file, filter.substr(1), root);
  if (filter.starts_with("tag:")) return HasTag(file, filter.substr(4), root);
  return Matches(filter, file);
}

std::vector<std::string> OrphanGoldens(const std::vector<ScenarioFile>& all,
                                       const std::string& root) {
  std::set<std::string> known;
  for (const ScenarioFile& file : all) known.insert(IdOf(file));
  const std::vector<std::string> goldens = GoldenFiles(root).List();
  std::vector<std::string> orphans;
  std::set_difference(goldens.begin(), goldens.end(), known.begin(), known.end(),
                      std::back_inserter(orphans));
  return orphans;
}

}  // namespace

std::optional<ScenarioSelection> SelectScenarios(const std::vector<std::string>& patterns,
                                                 const std::vector<std::string>& filters,
                                                 const std::string& root, std::string& problem) {
  const std::vector<ScenarioFile> all = ListScenarios(root);
  for (const std::string& pattern : patterns) {
    if (std::any_of(all.begin(), all.end(),
                    [&](const ScenarioFile& file) { return Matches(pattern, file); }))
      continue;
    const std::string hint = HintForScenario(all, pattern);
    problem = "no scenario matches '" + pattern + "'" + (hint.empty() ? "" : "; " + hint) +
              " ('prehend list' shows all)";
    return std::nullopt;
  }
  ScenarioSelection selection;
  for (const ScenarioFile& file : all) {
    const bool named = patterns.empty() || std::any_of(patterns.begin(), patterns.end(),
                                                       [&](const std::string& pattern) {
                                                         return Matches(pattern, file);
                                                       });
    const bool passes = std::all_of(filters.begin(), filters.end(), [&](const std::string& filter) {
      return PassesFilter(file, filter, root);
    });
    if (named && passes) selection.scenarios.push_back(file);
  }
  if (patterns.empty() && filters.empty()) selection.orphans = OrphanGoldens(all, root);
  if (!selection.scenarios.empty() || !selection.orphans.empty()) return selection;
  problem = "no scenario is selected ('prehend list' shows all)";
  return std::nullopt;
}

std::optional<Shard> ParseShard(std::string_view text) {
  constexpr int kMaxShards = 10'000;
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_number] = std::from_chars(text.data(), end, shard.number);
  if (bad_number != std::errc() || slash == end || *slash != '/') return std::nullopt;
  const auto [rest, bad_count] = std::from_chars(slash + 1, end, shard.count);
  if (bad_count != std::errc() || rest != end) return std::nullopt;
  if (shard.count > kMaxShards || shard.number < 1 || shard.number > shard.count)
    return std::nullopt;
  return shard;
}

void KeepShard(const Shard& shard, ScenarioSelection& selection) {
  std::vector<ScenarioFile> kept;
  for (std::size_t i = 0; i < selection.scenarios.size(); ++i) {
    if (static_cast<int>(i % shard.count) == shard.number - 1)
      kept.push_back(selection.scenarios[i]);
  }
  selection.scenarios = std::move(kept);
  if (shard.number != 1) selection.orphans.clear();
}

}  // namespace prehend::harness
