// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "harness/base/base/median.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

constexpr std::size_t kMostEffects = 6;
constexpr std::size_t kMostNearLimit = 10;

using Json = nlohmann::ordered_json;

/// "claims contradict it: expects .." and the like as one kind of failure: what stands before its
/// particulars.
std::string KindOfReason(const std::string& reason) {
  std::string kind = reason.substr(0, reason.find(':'));
  return kind == "expects" ? "a claim does not hold" : kind;
}

struct Gathered {
  std::vector<double> shifts_ms;
  std::set<std::string> scenarios;
  std::string command;
  int count = 0;
};

using EffectKey = std::tuple<std::string, std::string>;  // event, what

std::string Counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

Effect Summed(const EffectKey& key, Gathered& gathered) {
  Effect effect{.event = std::get<0>(key), .what = std::get<1>(key), .count = gathered.count};
  std::ranges::sort(gathered.shifts_ms, {}, [](double shift) { return std::abs(shift); });
  if (!gathered.shifts_ms.empty()) {
    effect.median_ms = Median(gathered.shifts_ms);
    effect.least_ms = gathered.shifts_ms.front();
    effect.most_ms = gathered.shifts_ms.back();
  }
  effect.scenarios.assign(gathered.scenarios.begin(), gathered.scenarios.end());
  effect.command = gathered.command;
  return effect;
}

constexpr std::size_t kMostTakes = 6;  // of a cause, as text

}  // namespace

std::string EffectText(const Effect& effect) {
  if (effect.event.empty()) return effect.what;
  std::string text = effect.event + " " + effect.what;
  if (effect.median_ms != 0) {
    text += effect.count == 1 ? fmt::format(", {:+.1f} ms", effect.median_ms)
                              : fmt::format(", median {:+.1f} ms ({:+.1f} to {:+.1f})",
                                            effect.median_ms, effect.least_ms, effect.most_ms);
  }
  return text;
}

std::vector<Cause> CausesOf(const std::vector<ScenarioVerdict>& verdicts) {
  std::map<std::string, std::map<EffectKey, Gathered>> gathered;
  const auto add = [&](const std::string& because, const EffectKey& key,
                       const ScenarioVerdict& verdict, const std::string& command) {
    Gathered& of = gathered[because][key];
    if (of.scenarios.empty()) of.command = command;
    of.scenarios.insert(verdict.scenario);
    ++of.count;
    return &of;
  };
  for (const ScenarioVerdict& verdict : verdicts) {
    if (verdict.verdict != Verdict::kFailed && verdict.verdict != Verdict::kFlaky) continue;
    if (verdict.attributions.empty()) {
      add("", {"", KindOfReason(verdict.reason)}, verdict, verdict.command);
      continue;
    }
    for (const Attribution& difference : verdict.attributions) {
      if (difference.event.empty()) {
        add(difference.because, {"", KindOfReason(difference.what)}, verdict, verdict.command);
        continue;
      }
      Gathered* of = add(difference.because, {difference.event, difference.what}, verdict,
                         verdict.explain + " " + difference.question);
      if (difference.shift_ms != 0) of->shifts_ms.push_back(difference.shift_ms);
    }
  }
  std::vector<Cause> causes;
  for (auto& [because, effects] : gathered) {
    Cause cause{.because = because};
    std::set<std::string> scenarios;
    for (auto& [key, of] : effects) {
      scenarios.insert(of.scenarios.begin(), of.scenarios.end());
      cause.effects.push_back(Summed(key, of));
    }
    std::ranges::stable_sort(cause.effects, std::greater{}, &Effect::count);
    cause.scenarios.assign(scenarios.begin(), scenarios.end());
    causes.push_back(std::move(cause));
  }
  std::ranges::stable_sort(causes, std::greater{},
                           [](const Cause& cause) { return cause.scenarios.size(); });
  return causes;
}

std::string CausesText(const std::vector<Cause>& causes) {
  if (causes.empty()) return "";
  std::string text = Counted(causes.size(), "cause") + ":\n";
  for (std::size_t i = 0; i < causes.size(); ++i) {
    const Cause& cause = causes[i];
    text += fmt::format("{}. {}: {}\n", i + 1, cause.Title(),
                        cause.scenarios.size() == 1 ? cause.scenarios.front()
                                                    : Counted(cause.scenarios.size(), "scenario"));
    for (std::size_t k = 0; k < cause.effects.size() && k < kMostEffects; ++k)
      text += fmt::format("     {} x {}\n", cause.effects[k].count, EffectText(cause.effects[k]));
    if (cause.effects.size() > kMostEffects)
      text += fmt::format("     and {} of difference more\n",
                          Counted(cause.effects.size() - kMostEffects, "kind"));
    text += "     look: " + cause.effects.front().command + "\n";
  }
  return text;
}

std::vector<NearLimitPass> NearLimitPasses(const std::vector<ScenarioVerdict>& verdicts) {
  std::vector<std::pair<double, NearLimitPass>> found;  // with the share of tolerance left
  for (const ScenarioVerdict& verdict : verdicts) {
    const bool good = verdict.verdict == Verdict::kPassed || verdict.verdict == Verdict::kUnchanged;
    if (!good || !verdict.has_golden || !verdict.comparison) continue;
    const truth::Margin* smallest = verdict.comparison->Smallest();
    if (!smallest || smallest->Left() * 10 > smallest->tolerance) continue;
    const grammar::Tick rate = verdict.comparison->ticks_per_second;
    const double share = static_cast<double>(smallest->Left()) /
                         static_cast<double>(std::max<grammar::Tick>(1, smallest->tolerance));
    found.emplace_back(
        share, NearLimitPass{.scenario = verdict.scenario,
                             .boundary = smallest->Boundary(),
                             .offset_ms = truth::MillisecondsOf(smallest->offset, rate),
                             .tolerance_ms = truth::MillisecondsOf(smallest->tolerance, rate)});
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first; });
  std::vector<NearLimitPass> near_limit;
  for (auto& [share, entry] : found) near_limit.push_back(std::move(entry));
  return near_limit;
}

std::string NearLimitText(const std::vector<NearLimitPass>& near_limit) {
  if (near_limit.empty()) return "";
  std::string text = fmt::format("warning: {} passed at the limit of a tolerance:\n",
                                 Counted(near_limit.size(), "scenario"));
  for (std::size_t i = 0; i < near_limit.size() && i < kMostNearLimit; ++i)
    text +=
        fmt::format("  {}  {} is {:+.1f} ms off (tolerance {:.1f} ms)\n", near_limit[i].scenario,
                    near_limit[i].boundary, near_limit[i].offset_ms, near_limit[i].tolerance_ms);
  if (near_limit.size() > kMostNearLimit)
    text += fmt::format("  and {} more\n", near_limit.size() - kMostNearLimit);
  return text;
}

Json CausesJson(const std::vector<Cause>& causes) {
  Json list = Json::array();
  for (const Cause& cause : causes) {
    Json effects = Json::array();
    for (const Effect& effect : cause.effects)
      effects.push_back({{"event", effect.event},
                         {"what", effect.what},
                         {"count", effect.count},
                         {"median_ms", effect.median_ms},
                         {"least_ms", effect.least_ms},
                         {"most_ms", effect.most_ms},
                         {"scenarios", effect.scenarios},
                         {"command", effect.command}});
    list.push_back({{"because", cause.because},
                    {"scenarios", cause.scenarios},
                    {"effects", std::move(effects)}});
  }
  return list;
}

Json NearLimitJson(const std::vector<NearLimitPass>& near_limit) {
  Json list = Json::array();
  for (const NearLimitPass& entry : near_limit)
    list.push_back({{"scenario", entry.scenario},
                    {"boundary", entry.boundary},
                    {"offset_ms", entry.offset_ms},
                    {"tolerance_ms", entry.tolerance_ms}});
  return list;
}

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
