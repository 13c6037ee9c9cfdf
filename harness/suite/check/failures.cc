// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/failures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace prehend::suite {
namespace {

constexpr std::size_t kMostTakes = 6;  // of a cause, as text

}  // namespace

Failures FailuresOf(const std::vector<ScenarioVerdict>& verdicts) {
  std::vector<const ScenarioVerdict*> of;
  std::vector<const Demonstration*> demonstrations;
  for (const ScenarioVerdict& verdict : verdicts) {
    if (!verdict.demonstration) continue;
    of.push_back(&verdict);
    demonstrations.push_back(&*verdict.demonstration);
  }
  const std::vector<std::optional<Mishap>> causes = FirstCauses(demonstrations);
  Failures failures{.demonstrations = of.size()};
  std::map<std::string, Failure> groups;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (!causes[i]) continue;
    ++failures.failed;
    const auto rate = static_cast<double>(demonstrations[i]->ticks_per_second);
    groups[causes[i]->what].takes.push_back({of[i]->scenario,
                                             static_cast<double>(causes[i]->tick) / rate,
                                             causes[i]->question.empty() || of[i]->explain.empty()
                                                 ? ""
                                                 : of[i]->explain + " " + causes[i]->question});
  }
  for (auto& [because, group] : groups) {
    group.because = because;
    failures.groups.push_back(std::move(group));
  }
  std::ranges::stable_sort(failures.groups, std::greater{},
                           [](const Failure& group) { return group.takes.size(); });
  return failures;
}

std::string FailuresText(const Failures& failures) {
  if (failures.failed == 0) return "";
  std::string text =
      fmt::format("{} of {} demonstrations failed:\n", failures.failed, failures.demonstrations);
  for (std::size_t i = 0; i < failures.groups.size(); ++i) {
    const auto& [because, takes] = failures.groups[i];
    text += fmt::format("{}. {}: {}\n    ", i + 1, because, takes.size());
    for (std::size_t k = 0; k < std::min(kMostTakes, takes.size()); ++k)
      text += fmt::format("{}{} at {:.2f} s", k == 0 ? "" : ", ", takes[k].scenario, takes[k].at_s);
    if (takes.size() > kMostTakes) text += fmt::format(" and {} more", takes.size() - kMostTakes);
    text += takes.front().command.empty() ? "\n" : "\n    why: " + takes.front().command + "\n";
  }
  return text;
}

nlohmann::ordered_json FailuresJson(const Failures& failures) {
  nlohmann::ordered_json groups = nlohmann::ordered_json::array();
  for (const Failure& group : failures.groups) {
    nlohmann::ordered_json takes = nlohmann::ordered_json::array();
    for (const FailedTake& take : group.takes)
      takes.push_back({{"episode", take.scenario}, {"at_s", take.at_s}, {"command", take.command}});
    groups.push_back({{"because", group.because}, {"takes", std::move(takes)}});
  }
  return {{"demonstrations", failures.demonstrations},
          {"failed", failures.failed},
          {"first_causes", std::move(groups)}};
}

}  // namespace prehend::suite
