// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/attribute.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

constexpr std::size_t kMostUndone = 8;
constexpr std::size_t kMostNamed = 4;

/// The same difference is not there any more.
bool IsGone(const truth::Pairing& difference, const truth::Comparison& without) {
  if (difference.expected) {
    return std::ranges::any_of(without.pairings, [&](const truth::Pairing& pairing) {
      return pairing.agreement == truth::LineVerdict::kMatched &&
             pairing.golden_line == difference.golden_line;
    });
  }
  return std::ranges::none_of(without.pairings, [&](const truth::Pairing& pairing) {
    return pairing.agreement != truth::LineVerdict::kMatched && pairing.actual &&
           pairing.actual->event == difference.actual->event &&
           pairing.actual->interval.begin == difference.actual->interval.begin;
  });
}

/// "begins later", "begins and ends earlier", "missing", "object: milk -> cup".
std::string WhatDiffers(const truth::Pairing& pairing) {
  if (pairing.agreement == truth::LineVerdict::kChanged && !pairing.changes.empty())
    return fmt::format("{}", fmt::join(pairing.changes, ", "));
  if (pairing.agreement == truth::LineVerdict::kRelabelled && pairing.actual)
    return "recognised as " + pairing.actual->event;
  if (pairing.agreement != truth::LineVerdict::kShifted)
    return std::string(Name(pairing.agreement));
  const auto moved = [&](grammar::Tick offset) { return std::abs(offset) > pairing.tolerance; };
  const auto direction = [](grammar::Tick offset) { return offset > 0 ? "later" : "earlier"; };
  const bool begin = moved(pairing.begin_offset), end = moved(pairing.end_offset);
  if (begin && end && (pairing.begin_offset > 0) == (pairing.end_offset > 0))
    return fmt::format("begins and ends {}", direction(pairing.begin_offset));
  if (begin && end)
    return fmt::format("begins {}, ends {}", direction(pairing.begin_offset),
                       direction(pairing.end_offset));
  return begin ? fmt::format("begins {}", direction(pairing.begin_offset))
               : fmt::format("ends {}", direction(pairing.end_offset));
}

Attribution Described(const truth::Pairing& pairing, grammar::Tick ticks_per_second) {
  const bool is_shift = pairing.agreement == truth::LineVerdict::kShifted;
  const grammar::Tick most = std::abs(pairing.begin_offset) >= std::abs(pairing.end_offset)
                                 ? pairing.begin_offset
                                 : pairing.end_offset;
  return {.event = pairing.event().event,
          .what = WhatDiffers(pairing),
          .shift_ms = is_shift ? truth::MillisecondsOf(most, ticks_per_second) : 0,
          .question = truth::QuestionAbout(pairing, ticks_per_second)};
}

/// "`milk.mass_kg` 0.4 -> 8 in slide/x.yaml", of at most so many.
std::string ListOf(const std::vector<const SettingChange*>& changes) {
  std::string text;
  for (std::size_t i = 0; i < changes.size() && i < kMostNamed; ++i) {
    const bool last_of_file =
        i + 1 >= std::min(changes.size(), kMostNamed) || changes[i + 1]->file != changes[i]->file;
    text += (i == 0 ? "" : ", ") + ChangeText(*changes[i]) +
            (last_of_file ? " in " + changes[i]->file : "");
  }
  if (changes.size() > kMostNamed) text += fmt::format(" and {} more", changes.size() - kMostNamed);
  return text;
}

/// What nothing explains that could be undone.
std::string OtherCause(const PossibleCauses& possible) {
  std::vector<const SettingChange*> fields, clauses;
  for (const SettingChange& change : possible.changes) {
    if (change.of == SettingChange::Of::kField) fields.push_back(&change);
    if (change.of == SettingChange::Of::kClause) clauses.push_back(&change);
  }
  if (possible.motion_differs && !fields.empty()) return ListOf(fields);
  fields.insert(fields.begin(), clauses.begin(), clauses.end());
  return possible.other_changes.empty()
             ? ListOf(fields)
             : fmt::format("{}", fmt::join(possible.other_changes, ", "));
}

/// Each change of the grammar by itself, then all of a rule, then all.
std::vector<std::vector<const SettingChange*>> ToUndo(const PossibleCauses& possible) {
  std::vector<const SettingChange*> of_grammar;
  for (const SettingChange& change : possible.changes) {
    const bool is_whole = change.before.empty() || change.after.empty();
    if (change.of == SettingChange::Of::kField || of_grammar.size() >= kMostUndone) continue;
    if (change.of == SettingChange::Of::kClause || !is_whole) of_grammar.push_back(&change);
  }
  std::vector<std::vector<const SettingChange*>> sets;
  std::map<std::string, std::vector<const SettingChange*>> rules;
  for (const SettingChange* change : of_grammar) {
    sets.push_back({change});
    if (change->of == SettingChange::Of::kClause)
      rules[change->file + change->name.substr(0, change->name.find(' '))].push_back(change);
  }
  for (auto& [rule, changes] : rules)
    if (changes.size() > 1 && changes.size() < of_grammar.size()) sets.push_back(changes);
  if (of_grammar.size() > 1) sets.push_back(std::move(of_grammar));
  return sets;
}

}  // namespace

std::vector<Attribution> AttributeDifferences(const truth::Comparison& comparison,
                                              const PossibleCauses& possible,
                                              const CompareWith& compare_with) {
  const std::vector<const truth::Pairing*> differing = comparison.Differing();
  std::vector<Attribution> attributions;
  for (const truth::Pairing* pairing : differing)
    attributions.push_back(Described(*pairing, comparison.ticks_per_second));
  const auto is_open = [](const Attribution& attribution) { return attribution.because.empty(); };
  const auto gone_without = [&](const std::vector<const SettingChange*>& undone) {
    std::vector<std::size_t> gone;
    const auto without = compare_with(undone);
    for (std::size_t i = 0; without && i < differing.size(); ++i)
      if (is_open(attributions[i]) && IsGone(*differing[i], *without)) gone.push_back(i);
    return gone;
  };
  for (std::vector<const SettingChange*> undone : ToUndo(possible)) {
    if (undone.size() > 1 && std::ranges::none_of(attributions, is_open)) break;
    const std::vector<std::size_t> gone = gone_without(undone);
    // Of several together those that are needed.
    for (std::size_t k = undone.size(); !gone.empty() && undone.size() > 1 && k-- > 0;) {
      std::vector<const SettingChange*> fewer = undone;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (gone_without(fewer) == gone) undone = std::move(fewer);
    }
    for (const std::size_t i : gone) attributions[i].because = ListOf(undone);
  }
  for (Attribution& attribution : attributions)
    if (is_open(attribution)) attribution.because = OtherCause(possible);
  return attributions;
}

std::string CauseOfFailure(
    const PossibleCauses& possible,
    const std::function<bool(const std::vector<const SettingChange*>& undone)>& holds_without) {
  if (holds_without) {
    for (const auto& undone : ToUndo(possible))
      if (holds_without(undone)) return ListOf(undone);
    const std::string other = possible.motion_differs ? OtherCause(possible) : "";
    if (!other.empty()) return other;
  }
  std::vector<const SettingChange*> all;
  for (const SettingChange& change : possible.changes) all.push_back(&change);
  return all.empty() ? OtherCause(possible) : ListOf(all);
}

}  // namespace prehend::suite
