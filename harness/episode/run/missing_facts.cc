// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/missing_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "grammar/contents.h"
#include "grammar/never_recognised.h"
#include "harness/base/base/text_file.h"

namespace prehend::episode {
namespace {

/// What is not tracked for a while; of what never is, there is a warning of its own.
std::string GapsOfPlaced(const Recording& episode, const std::vector<bool>& placed) {
  std::vector<LookGaps> gaps = episode.gaps;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (!placed[i]) gaps[i] = {};
  }
  return GapsText(episode.header.entity_table, gaps);
}

/// A hand that is not marked as one looks like a thing.
std::string WithoutHands(const std::vector<grammar::EntityInfo>& entities,
                         const grammar::Program& program) {
  const auto has_hand = [](const auto& one) { return std::ranges::count(one.classes, "Hand") > 0; };
  if (std::ranges::any_of(entities, has_hand)) return "";
  std::vector<std::string> events;
  for (const grammar::EventSignature& event : grammar::EventSignatures(program)) {
    if (has_hand(event)) events.push_back(event.name);
  }
  if (events.empty()) return "";
  return fmt::format(
      "warning: no entity is a Hand, so what hands do is never recognised: {}\n"
      "  hint: 'hand: true' in a map of poses, '\"hand\": true' in a recording\n",
      fmt::join(events, ", "));
}

/// Whether contacts and grasps are made of motion already.
bool UsesMotion(const grammar::Program& program) {
  return std::ranges::any_of(program.rules, [](const grammar::Rule& rule) {
    return rule.file.ends_with("support_from_motion.grammar");
  });
}

std::string_view RemedyFor(std::string_view fact, bool uses_motion) {
  if (fact == "gazes") return "give persons or heads 'gazes_at' in their samples";
  if (fact == "forces")
    return "motion does not show forces: give touches 'force_n', or leave these events out";
  if (fact == "orientations")
    return "nothing ever turns in it: give samples 'quat_wxyz'; of poses, name the columns of "
           "quaternions in the map (docs/motion-capture.md)";
  if (uses_motion)
    return "these rules ask for what was measured; contact(a, b), supported_by(a, b) and "
           "grasping(a, b) are made of motion";
  return "make these facts of motion, 'use contact from motion' above the other lines, or "
         "pick_and_place_from_motion; docs/facts-from-motion.md";
}

}  // namespace

MissingFacts FindMissingFacts(Recording& episode, const grammar::Program& program) {
  MissingFacts missing;
  grammar::FactsOfEpisode facts;
  const std::vector<grammar::EntityInfo>& entities = episode.header.entity_table.entities;
  std::vector<bool> placed = episode.placed;
  placed.resize(entities.size());
  for (EpisodeFrame& frame : episode.frames) facts.Add(frame.View(), episode.header.entity_table);
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (placed[i]) continue;
    missing.warnings += fmt::format(
        "warning: no frame says where '{}' is, so no condition on its pose ever holds\n"
        "  hint: give it a sample in the first frame, or leave it out of 'entities'\n",
        entities[i].name);
  }
  missing.warnings += GapsOfPlaced(episode, placed);
  missing.warnings += WithoutHands(entities, program);
  const auto never = grammar::FindNeverRecognised(program, facts);
  std::map<std::string_view, std::vector<std::string>> events;
  for (const grammar::NeverRecognised& one : never) events[one.fact].push_back(one.event);
  for (const auto& [fact, names] : events) {
    const auto first = std::ranges::find(never, fact, &grammar::NeverRecognised::fact);
    missing.never.push_back(fmt::format(
        "{}:{}:{}: warning: this recording has no {}, so '{}' is never recognised{}\n"
        "  hint: {}\n",
        ReadableName(first->file), first->place.line, first->place.column, fact, names.front(),
        names.size() == 1
            ? std::string()
            : fmt::format(", nor {}", fmt::join(names.begin() + 1, names.end(), ", ")),
        RemedyFor(fact, UsesMotion(program))));
    missing.warnings += missing.never.back();
  }
  missing.nothing_left = never.size() == grammar::EventNames(program).size();
  return missing;
}

}  // namespace prehend::episode
