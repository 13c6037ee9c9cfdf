// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/attribute.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

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

}  // namespace

std::vector<Attribution> AttributeDifferences(const truth::Comparison& comparison,
                                              const PossibleCauses& possible,
                                              const CompareWith& compare_with) {
  const std::vector<const truth::Pairing*> differing = comparison.Differing();
  std::vector<Attribution> attributions;
  for (const truth::Pairing* pairing : differing)
    attributions.push_back(Described(*pairing, comparison.ticks_per_second));
  std::vector<const SettingChange*> of_grammar;
  for (const SettingChange& change : possible.changes) {
    const bool is_whole = change.before.empty() || change.after.empty();
    if (change.of == SettingChange::Of::kField || of_grammar.size() >= kMostUndone) continue;
    if (change.of == SettingChange::Of::kClause || !is_whole) of_grammar.push_back(&change);
  }
  const auto undo = [&](const std::vector<const SettingChange*>& undone) {
    const auto without = compare_with(undone);
    for (std::size_t i = 0; without && i < differing.size(); ++i) {
      if (attributions[i].because.empty() && IsGone(*differing[i], *without))
        attributions[i].because = ListOf(undone);
    }
  };
  for (const SettingChange* change : of_grammar) undo({change});
  const auto is_open = [](const Attribution& attribution) { return attribution.because.empty(); };
  if (of_grammar.size() > 1 && std::ranges::any_of(attributions, is_open)) undo(of_grammar);
  for (Attribution& attribution : attributions) {
    if (is_open(attribution)) attribution.because = OtherCause(possible);
  }
  return attributions;
}

}  // namespace prehend::suite
