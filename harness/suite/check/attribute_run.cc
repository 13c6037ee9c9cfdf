// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/attribute_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/suite/judge/clauses.h"

namespace prehend::suite {
namespace {

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
    if (!now.inputs.contains(path)) add_unless_replaced(path);
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
      if (path == inputs.end()) return std::nullopt;
      std::string& text = changed.instead[path->first];
      if (text.empty()) text = ReadTextFile(path->first).value_or("");
      text = WithClause(text, change->name, change->before);
    } else {
      const std::string name = change->name + "=";
      std::erase_if(changed.settings, [&](const auto& other) { return other.starts_with(name); });
      changed.settings.push_back(name + change->before);
    }
  }
  Result<episode::LoadedRun> loaded = episode::LoadRun(changed, request.root);
  if (!loaded) return std::nullopt;
  CheckedRun run{.id = checked.id, .loaded = std::move(*loaded), .result = {}, .explain = {}};
  run.result.timeline = episode::Resegment(checked.loaded.scenario, checked.result.recording,
                                           run.loaded.program, checked.result.ticks + 1);
  return run;
}

bool CanUndo(const CheckRequest& request, const CheckedRun& checked) {
  return request.IsPlayed() && !checked.result.recording.empty();
}

DifferingRun NowOf(const CheckRequest& request, const CheckedRun& checked,
                   const ScenarioVerdict& verdict) {
  const episode::RunResult& run = checked.result;
  return {.program = request.program,
          .build = BuildText(),
          .inputs = verdict.inputs,
          .settings = verdict.settings,
          .options = OptionsOf(request.changes),
          .other_grammar = !request.changes.grammar.empty(),
          .trace = TraceOf(checked.loaded.scenario.scene, run.recording),
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
  verdict.attributions.push_back(
      {.event = {}, .what = verdict.reason, .because = because, .question = {}});
}

}  // namespace

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
  const DifferingRun now = NowOf(request, checked, verdict);
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
  const auto possible =
      PossibleCausesOf(records.Read(request.id), ReadTrace(records.TracePath(request.id)),
                       NowOf(request, checked, verdict), request.root);
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
