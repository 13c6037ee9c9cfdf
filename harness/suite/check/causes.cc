// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/causes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/median.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/suite/judge/judges.h"
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

/// A program that differs: by its source, or by who compiled it, and how.
std::string ProgramText(const LastPass& last_pass, const DifferingRun& now) {
  if (last_pass.build.empty() || last_pass.build == now.build) return "the program";
  return fmt::format("the program (now {}; then {})", now.build, last_pass.build);
}

/// "scenarios/slide/NAME.yaml" and the like, "the program", and the options of the command line. A
/// grammar that the command line chose did not change, nor did the one that it replaces.
std::vector<std::string> WhatChanged(const LastPass& last_pass, const DifferingRun& now,
                                     const std::string& root) {
  std::vector<std::string> changed;
  const auto add = [&](const std::string& path) { changed.push_back(RelativeTo(root, path)); };
  const auto add_unless_replaced = [&](const std::string& path) {
    if (!now.other_grammar || !path.ends_with(".grammar")) add(path);
  };
  for (const auto& [path, hash] : now.inputs) {
    const auto before = last_pass.verdict.inputs.find(path);
    if (before == last_pass.verdict.inputs.end()) {
      // A file that was looked for in vain did not change anything.
      if (hash != kNoFile) add_unless_replaced(path);
    } else if (before->second != hash) {
      add(path);
    }
  }
  for (const auto& [path, hash] : last_pass.verdict.inputs)
    if (hash != kNoFile && !now.inputs.contains(path)) add_unless_replaced(path);
  if (last_pass.program != now.program) changed.push_back(ProgramText(last_pass, now));
  changed.insert(changed.end(), now.options.begin(), now.options.end());
  return changed;
}

std::string PhysicsText(const Divergence& divergence, const DifferingRun& now) {
  const std::string when =
      fmt::format("{:.4f} s (tick {})", static_cast<double>(divergence.tick) / now.ticks_per_second,
                  divergence.tick);
  if (divergence.entity.empty())
    return "physics. Only one of this run and the last passing run reaches " + when;
  return fmt::format("physics. `{}` moves differently from the last passing run, first at {}",
                     divergence.entity, when);
}

/// What differs between the two runs, without a full stop.
std::string FirstCause(const StateTrace& before, const DifferingRun& now) {
  if (before.entities != now.trace.entities)
    return "physics. The entities are not those of the last passing run";
  if (const auto divergence = FirstDivergence(before, now.trace))
    return PhysicsText(*divergence, now);
  if (!SameTicks(before, now.trace))
    return "sensing. Frames are at other ticks than in the last passing run; where both have one, "
           "everything moves the same";
  return "the grammar or the golden. Everything moves as in the last passing run";
}

/// The same frames of a recorded run, with some parameters as they were.
std::optional<CheckedRun> RecordedWithout(const CheckRequest& request, const CheckedRun& checked,
                                          const std::vector<std::string>& settings) {
  Result<episode::Episode> episode =
      episode::OpenEpisode(request.episode, {request.changes.grammar, settings}, request.root);
  if (!episode) return std::nullopt;
  Result<episode::RunResult> result = episode->Run(/*frames=*/false);
  if (!result) return std::nullopt;
  return CheckedRun{
      .id = checked.id, .loaded = episode->loaded(), .result = std::move(*result), .explain = {}};
}

/// The same motion, with some parameters and clauses as they were.
std::optional<CheckedRun> RunWithout(const CheckRequest& request, const CheckedRun& checked,
                                     const FileHashes& inputs,
                                     const std::vector<const SettingChange*>& undone) {
  episode::RunRequest changed = request.Run();
  for (const SettingChange* change : undone) {
    const auto path = std::ranges::find_if(inputs, [&](const auto& one) {
      return RelativeTo(request.root, one.first) == change->file;
    });
    if (change->of == SettingChange::Of::kClause) {
      if (path == inputs.end() || !request.IsPlayed()) return std::nullopt;
      std::string& text = changed.instead[path->first];
      if (text.empty()) text = ReadTextFile(path->first).value_or("");
      text = WithClause(text, change->name, change->before);
    } else {
      const std::string name = change->name + "=";
      std::erase_if(changed.settings, [&](const auto& other) { return other.starts_with(name); });
      changed.settings.push_back(name + change->before);
    }
  }
  if (!request.IsPlayed()) return RecordedWithout(request, checked, changed.settings);
  Result<episode::LoadedRun> loaded = episode::LoadRun(changed, request.root);
  if (!loaded) return std::nullopt;
  CheckedRun run{.id = checked.id, .loaded = std::move(*loaded), .result = {}, .explain = {}};
  run.result.timeline = episode::Resegment(checked.loaded.scenario, checked.result.recording,
                                           run.loaded.program, checked.result.ticks + 1);
  return run;
}

bool CanUndo(const CheckRequest& request, const CheckedRun& checked) {
  return !checked.result.recording.empty() &&
         (request.IsPlayed() || request.episode.origin == episode::Origin::kRecordedRun);
}

DifferingRun NowOf(const CheckRequest& request, const CheckedRun& checked,
                   const ScenarioVerdict& verdict, bool traced) {
  const episode::RunResult& run = checked.result;
  FileHashes inputs = verdict.inputs;
  std::vector<std::string> options =
      OptionsOf({checked.task.run.grammar, checked.task.run.settings});
  std::ranges::copy(OptionsOf(request.changes), std::back_inserter(options));
  if (!checked.task.files.empty()) inputs.erase(request.episode.file);
  for (const auto& [path, text] : checked.task.files)
    inputs[(std::filesystem::path(request.root) / path).string()] = ContentHash(text);
  return {.program = request.program,
          .build = BuildText(),
          .inputs = std::move(inputs),
          .settings = verdict.settings,
          .options = std::move(options),
          .other_grammar = !request.changes.grammar.empty(),
          .trace = traced ? TraceOf(checked.loaded.scenario.scene, run.recording) : StateTrace(),
          .ticks_per_second = static_cast<double>(run.timeline.ticks_per_second)};
}

/// Laws and claims are what a grammar decides, besides the golden.
bool HoldsItself(const CheckedRun& run) {
  return JudgeLaws(run).empty() &&
         ClaimFindings(JudgeClaims(run.loaded, run.result.timeline)).empty();
}

void AddCause(const PossibleCauses& possible, const std::string& because,
              ScenarioVerdict& verdict) {
  verdict.cause += ChangesText(possible.changes);
  verdict.attributions.push_back({.event = {},
                                  .what = verdict.reason.empty() ? kPictureDiffers : verdict.reason,
                                  .because = because,
                                  .question = {}});
}

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
    if (of.scenarios.empty() || verdict.scenario < *of.scenarios.begin()) of.command = command;
    of.scenarios.insert(verdict.scenario);
    ++of.count;
    return &of;
  };
  for (const ScenarioVerdict& verdict : verdicts) {
    if (verdict.verdict != Verdict::kFailed && verdict.verdict != Verdict::kFlaky) continue;
    if (verdict.attributions.empty()) {
      // A check would say the same again; why each event is as it is, does not stand there yet.
      const bool is_claim = verdict.reason.starts_with("expects:") && !verdict.explain.empty();
      add("", {"", KindOfReason(verdict.reason)}, verdict,
          is_claim ? verdict.explain : verdict.command);
      continue;
    }
    for (const Attribution& difference : verdict.attributions) {
      if (difference.event.empty()) {
        add(difference.because, {"", KindOfReason(difference.what)}, verdict, verdict.command);
        continue;
      }
      const bool can_ask = !verdict.explain.empty() && !difference.question.empty();
      Gathered* of = add(difference.because, {difference.event, difference.what}, verdict,
                         can_ask ? verdict.explain + " " + difference.question : verdict.command);
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
    const double share = smallest->Left() / std::max(1.0, smallest->tolerance);
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

std::string CauseText(const std::optional<LastPass>& last_pass,
                      const std::optional<StateTrace>& its_trace, const DifferingRun& now,
                      const std::string& root) {
  if (!last_pass || !its_trace)
    return fmt::format("cause: unknown. This scenario has not passed here yet. This program: {}.\n",
                       now.build);
  const std::vector<std::string> changed = WhatChanged(*last_pass, now, root);
  return fmt::format(
      "cause: {}. Changed since: {}\n", FirstCause(*its_trace, now),
      changed.empty() ? "no known file" : fmt::format("{}", fmt::join(changed, ", ")));
}

std::optional<PossibleCauses> PossibleCausesOf(const std::optional<LastPass>& last_pass,
                                               const std::optional<StateTrace>& its_trace,
                                               const DifferingRun& now, const std::string& root) {
  if (!last_pass || !its_trace) return std::nullopt;
  PossibleCauses possible{.changes = ChangesBetween(last_pass->verdict.settings, now.settings),
                          .other_changes = WhatChanged(*last_pass, now, root),
                          .motion_differs = its_trace->entities != now.trace.entities ||
                                            FirstDivergence(*its_trace, now.trace).has_value()};
  // What is known more exactly.
  std::erase_if(possible.other_changes, [&](const std::string& changed) {
    return std::ranges::any_of(possible.changes, [&](const SettingChange& change) {
      return change.file == changed || changed.starts_with("--set " + change.name + "=") ||
             changed.starts_with("--set '" + change.name + "=");
    });
  });
  return possible;
}

std::string ChangesText(const std::vector<SettingChange>& changes) {
  constexpr std::size_t kMost = 10;
  std::string text;
  for (std::size_t i = 0; i < changes.size() && i < kMost; ++i)
    text += fmt::format("changed: {} in {}\n", ChangeText(changes[i]), changes[i].file);
  if (changes.size() > kMost) text += fmt::format("changed: {} more\n", changes.size() - kMost);
  return text;
}

void AttributeRun(const CheckRequest& request, const CheckedRun& checked,
                  const truth::Golden& golden, const truth::Comparison& comparison,
                  ScenarioVerdict& verdict) {
  const LastPasses records(request.root);
  const auto last_pass = records.Read(request.id);
  const auto trace = ReadTrace(records.TracePath(request.id));
  const DifferingRun now = NowOf(request, checked, verdict, last_pass && trace);
  verdict.cause = CauseText(last_pass, trace, now, request.root);
  const auto possible = PossibleCausesOf(last_pass, trace, now, request.root);
  if (possible) verdict.cause += ChangesText(possible->changes);
  verdict.attributions = AttributeDifferences(
      comparison, possible.value_or(PossibleCauses{}),
      [&](const std::vector<const SettingChange*>& undone) -> std::optional<truth::Comparison> {
        if (!CanUndo(request, checked)) return std::nullopt;
        const auto without = RunWithout(request, checked, verdict.inputs, undone);
        if (!without) return std::nullopt;
        return truth::Compare(golden, without->result.timeline,
                              scenario::DefaultTolerance(checked.loaded.scenario));
      });
}

void AttributeFailure(const CheckRequest& request, const CheckedRun& checked,
                      ScenarioVerdict& verdict) {
  const LastPasses records(request.root);
  const auto last_pass = records.Read(request.id);
  if (!last_pass) return;
  const auto trace = ReadTrace(records.TracePath(request.id));
  const auto possible = PossibleCausesOf(
      last_pass, trace, NowOf(request, checked, verdict, trace.has_value()), request.root);
  if (!possible) return;
  const bool is_of_grammar = !HoldsItself(checked);
  const std::string because = CauseOfFailure(*possible, [&](const auto& undone) {
    if (!is_of_grammar || !CanUndo(request, checked)) return false;
    const auto without = RunWithout(request, checked, verdict.inputs, undone);
    return without && HoldsItself(*without);
  });
  AddCause(*possible, because, verdict);
}

void AttributeUnread(const CheckRequest& request, ScenarioVerdict& verdict) {
  const auto last_pass = LastPasses(request.root).Read(request.id);
  if (!last_pass) return;
  const std::vector<std::string> changed = ChangedInputs(*last_pass);
  PossibleCauses possible{.changes = ChangesBetween(last_pass->verdict.settings,
                                                    SettingsOfFiles(changed, request.root)),
                          .other_changes = OptionsOf(request.changes)};
  for (const std::string& file : changed)
    possible.other_changes.push_back(RelativeTo(request.root, file));
  AddCause(possible, CauseOfFailure(possible, nullptr), verdict);
}

}  // namespace prehend::suite
