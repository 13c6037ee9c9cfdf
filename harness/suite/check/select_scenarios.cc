// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/select_scenarios.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <tuple>

#include "harness/episode/episode/find_episodes.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/suite/check/last_pass.h"

namespace prehend::suite {
namespace {

constexpr std::string_view kTag = "tag:";

bool Matches(const std::string& pattern, const episode::ScenarioFile& file) {
  return fnmatch(pattern.c_str(), file.name.c_str(), 0) == 0 ||
         fnmatch(pattern.c_str(), episode::IdOf(file).c_str(), 0) == 0;
}

/// A file that cannot be read has no tags; it is still checked when it is named.
bool HasTag(const episode::ScenarioFile& file, const std::string& tag,
            const scenario::ScenarioLibrary& library) {
  const Result<scenario::Scenario> scenario = scenario::ReadScenario(file.path, {}, library);
  return scenario && std::count(scenario->tags.begin(), scenario->tags.end(), tag) > 0;
}

bool PassesFilter(const episode::ScenarioFile& file, const std::string& filter,
                  const scenario::ScenarioLibrary& library) {
  if (filter.starts_with('!')) return !PassesFilter(file, filter.substr(1), library);
  if (filter.starts_with(kTag)) return HasTag(file, filter.substr(kTag.size()), library);
  return Matches(filter, file);
}

/// Why no scenario passes this filter, with the nearest tag; "" if some do, or if it begins with
/// '!'.
std::string WhyNonePasses(const std::string& filter, const std::vector<episode::ScenarioFile>& all,
                          const scenario::ScenarioLibrary& library) {
  if (filter.starts_with('!')) return "";
  const bool some = std::ranges::any_of(
      all, [&](const auto& file) { return PassesFilter(file, filter, library); });
  if (some || !filter.starts_with(kTag))
    return some ? "" : "--filter: no scenario matches '" + filter + "'";
  std::vector<std::string> tags;
  for (const episode::ScenarioFile& file : all) {
    const Result<scenario::Scenario> scenario = scenario::ReadScenario(file.path, {}, library);
    if (scenario) tags.insert(tags.end(), scenario->tags.begin(), scenario->tags.end());
  }
  const std::string tag = filter.substr(kTag.size());
  const std::string near = grammar::NearestName(tag, tags);
  return "--filter: no scenario has the tag '" + tag + "'" +
         (near.empty() ? "" : "; did you mean '" + near + "'?");
}

bool IsFile(const std::string& typed) {
  std::error_code error;
  const bool is_there =
      std::filesystem::exists(typed, error) && !std::filesystem::is_directory(typed, error);
  const auto ends_so = [&](const char* ending) { return typed.ends_with(ending); };
  return is_there ||
         std::ranges::any_of(std::array{".yaml", ".yml", ".jsonl", ".episodes"}, ends_so);
}

/// Why a pattern matches no scenario. For the name of a folder, the pattern of its scenarios is
/// suggested.
std::string WhyNoMatch(const std::string& typed, const std::vector<episode::ScenarioFile>& all) {
  std::string folder = typed.starts_with("scenarios/") ? typed.substr(10) : typed;
  if (const std::size_t slash = folder.find('/'); slash != std::string::npos) folder.resize(slash);
  const bool is_folder = folder == typed || typed.ends_with("/" + folder) || typed.ends_with('/');
  std::vector<std::string> skills;
  for (const episode::ScenarioFile& file : all) skills.push_back(file.skill);
  std::string hint = is_folder && std::ranges::count(skills, folder) > 0
                         ? "did you mean '" + folder + "/*'?"
                         : episode::HintForScenario(all, typed);
  const std::string near = grammar::NearestName(folder, skills);
  if (hint.empty() && !near.empty()) hint = "did you mean '" + near + "/*'?";
  return "no scenario matches '" + typed + "'" + (hint.empty() ? "" : "; " + hint) +
         " ('prehend list' shows all)";
}

/// The episodes of a file, each as the scenario that it was.
std::vector<episode::ScenarioFile> KeptIn(const std::string& path,
                                          const std::vector<episode::ScenarioFile>& all,
                                          NoSelection& none) {
  std::vector<episode::ScenarioFile> found;
  const auto kept = episode::EpisodesOf(path);
  if (!kept) none = {ExitCode::kBadInput, path + ": " + kept.error().front().message};
  if (!kept) return found;
  for (const episode::EpisodeName& episode : *kept)
    found.push_back(episode::ScenarioOf(episode, all));
  return found;
}

}  // namespace

tl::expected<ScenarioSelection, NoSelection> SelectScenarios(
    const std::vector<std::string>& patterns, const std::vector<std::string>& filters,
    const std::string& root) {
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(root);
  std::vector<episode::ScenarioFile> named =
      patterns.empty() ? all : std::vector<episode::ScenarioFile>();
  for (const std::string& pattern : patterns) {
    const std::size_t before = named.size();
    std::ranges::copy_if(all, std::back_inserter(named),
                         [&](const episode::ScenarioFile& file) { return Matches(pattern, file); });
    if (named.size() > before) continue;
    for (const episode::ScenarioFile& shipped : episode::ShippedScenarios(root))
      if (Matches(pattern, shipped)) named.push_back(episode::ScenarioAt(all, shipped.path));
    if (named.size() > before) continue;
    if (!IsFile(pattern)) return tl::unexpected(NoSelection{.why = WhyNoMatch(pattern, all)});
    const episode::EpisodeKind kind = episode::EpisodeKindOf(pattern);
    if (kind == episode::EpisodeKind::kTakes) {
      const auto takes = episode::FindTakes({&pattern, 1}, "", root);
      if (!takes)
        return tl::unexpected(
            NoSelection{takes.error().exit_code, takes.error().message.empty()
                                                     ? grammar::Format(takes.error().diagnostics)
                                                     : takes.error().message});
      for (const episode::Take& take : *takes)
        named.push_back(episode::ScenarioOf(take.episode, all));
      continue;
    }
    if (kind != episode::EpisodeKind::kEpisodeFile) {
      named.push_back(episode::ScenarioAt(all, pattern));
      if (kind == episode::EpisodeKind::kJsonLines)
        named.back().origin = episode::Origin::kRecording;
      continue;
    }
    NoSelection none;
    std::ranges::move(KeptIn(pattern, all, none), std::back_inserter(named));
    if (!none.why.empty()) return tl::unexpected(std::move(none));
  }
  std::ranges::sort(named, {}, [](const episode::ScenarioFile& file) {
    return std::tuple(!file.in_project, file.skill, file.name, file.path, file.episode);
  });
  const auto same = [](const episode::ScenarioFile& a, const episode::ScenarioFile& b) {
    return a.path == b.path && a.episode == b.episode;
  };
  named.erase(std::unique(named.begin(), named.end(), same), named.end());
  const scenario::ScenarioLibrary library = episode::ProjectLibrary(root);
  ScenarioSelection selection;
  std::ranges::copy_if(named, std::back_inserter(selection.scenarios),
                       [&](const episode::ScenarioFile& file) {
                         return std::ranges::all_of(filters, [&](const std::string& filter) {
                           return PassesFilter(file, filter, library);
                         });
                       });
  if (patterns.empty() && filters.empty()) selection.orphans = FindUnreferencedGoldens(all, root);
  if (!selection.scenarios.empty() || !selection.orphans.empty()) return selection;
  std::string problem = "no scenario is selected";
  for (const std::string& filter : filters)
    if (const std::string why = WhyNonePasses(filter, all, library); !why.empty()) problem = why;
  return tl::unexpected(NoSelection{.why = problem + " ('prehend list' shows all)"});
}

std::optional<Shard> ParseShard(std::string_view text) {
  constexpr int kMaxShards = 10'000;
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_number] = std::from_chars(text.data(), end, shard.number);
  if (bad_number != std::errc() || slash == end || *slash != '/') return std::nullopt;
  const auto [rest, bad_count] = std::from_chars(slash + 1, end, shard.count);
  if (bad_count != std::errc() || (rest != end && (*rest != ':' || rest + 1 == end)))
    return std::nullopt;
  if (rest != end) shard.costs.assign(rest + 1, end);
  if (shard.count > kMaxShards || shard.number < 1 || shard.number > shard.count)
    return std::nullopt;
  return shard;
}

std::string ShardProblem(const std::string& text) {
  return ParseShard(text) ? ""
                          : "found '" + text + "', wanted I/N, like 2/3 for the second of three";
}

Result<std::vector<int>> PartsOf(const Shard& shard, const std::vector<std::string>& names,
                                 std::string* note) {
  std::vector<int> parts(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) parts[i] = static_cast<int>(i) % shard.count + 1;
  if (shard.costs.empty()) return parts;
  const LastPasses::Costs known = LastPasses::ReadCostsOf(shard.costs);
  double sum = 0;
  for (const auto& [name, cost] : known) sum += cost;
  if (!(sum > 0))
    return tl::unexpected(grammar::Diagnostics{
        {.file = shard.costs,
         .message = "no file of costs: wanted a JSON object, {\"SKILL/NAME\": SECONDS, ..}",
         .hint = "'prehend check' writes build/check/costs.json; copy that"}});
  std::vector<std::pair<double, std::size_t>> costs;  // of them the dearest first, then by place
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto cost = known.find(names[i]);
    costs.emplace_back(
        -(cost == known.end() ? sum / static_cast<double>(known.size()) : cost->second), i);
  }
  std::ranges::sort(costs);
  std::vector<double> loads(static_cast<std::size_t>(shard.count));
  double all = 0;
  for (const auto& [cost, i] : costs) {
    const auto least = std::ranges::min_element(loads);
    parts[i] = static_cast<int>(least - loads.begin()) + 1;
    *least -= cost;
    all -= cost;
  }
  const double share = costs.empty() ? 0 : -costs.front().first / all;
  if (note && share > 0 && shard.count > std::ceil(1 / share))
    *note = fmt::format(
        "--shard: {} alone is {:.1f} % of all costs: more than {:.0f} parts end no sooner\n",
        names[costs.front().second], 100 * share, std::ceil(1 / share));
  return parts;
}

void KeepShard(const Shard& shard, const std::vector<int>& parts, ScenarioSelection& selection) {
  std::vector<episode::ScenarioFile> kept;
  for (std::size_t i = 0; i < selection.scenarios.size(); ++i)
    if (parts[i] == shard.number) kept.push_back(selection.scenarios[i]);
  selection.scenarios = std::move(kept);
  if (shard.number != 1) selection.orphans.clear();
}

}  // namespace prehend::suite
