// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/segment_recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "grammar/base/frame.h"
#include "grammar/contents.h"
#include "grammar/name_events.h"
#include "grammar/never_recognised.h"
#include "harness/base/base/median.h"
#include "harness/base/base/text_file.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/sense/episode_format.h"

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

/// By entity, the times from where it was seen last, by `bridge_s`, to where it is found again.
using Losses = std::vector<std::vector<grammar::Interval>>;

/// `before`: the frame before. What it says holds up to this one; within `bridge_s` it is bridged.
void AddLosses(const EpisodeFrame& frame, std::optional<grammar::Tick> before,
               const Recording& recording, Losses& losses) {
  const auto bridge = static_cast<grammar::Tick>(
      recording.header.bridge_s *
      static_cast<double>(recording.header.entity_table.ticks_per_second));
  const bool bridged = before && frame.tick - *before <= bridge;
  for (std::size_t i = 0; i < losses.size(); ++i) {
    const bool was_lost = !losses[i].empty() && losses[i].back().end == recording.end_tick;
    if (was_lost && grammar::IsTracked(frame.entities[i])) losses[i].back().end = frame.tick;
    if (!was_lost && !grammar::IsTracked(frame.entities[i]))
      losses[i].push_back({frame.tick - (bridged ? bridge : 0), recording.end_tick});
  }
}

/// A line for each event in which somebody who has a role is lost: for how long that was assumed.
std::string AssumedText(const std::vector<grammar::EntityInfo>& entities, const Losses& losses,
                        const grammar::Timeline& timeline) {
  const auto rate = static_cast<double>(timeline.ticks_per_second);
  std::string text;
  for (const grammar::NamedEvent& event : timeline.events) {
    std::string names, lacks;
    for (const grammar::Role& role : event.roles) {
      names += (names.empty() ? "" : ", ") + role.value;
      const auto entity = std::ranges::find(entities, role.value, &grammar::EntityInfo::name);
      if (entity == entities.end()) continue;
      grammar::Tick assumed = 0;
      for (const grammar::Interval& loss :
           losses[static_cast<std::size_t>(entity - entities.begin())])
        assumed += std::max<grammar::Tick>(
            std::min(loss.end, event.interval.end) - std::max(loss.begin, event.interval.begin), 0);
      if (assumed > 0)
        lacks += fmt::format("{}'{}' is not seen for {:.3f} s", lacks.empty() ? "" : ", ",
                             role.value, static_cast<double>(assumed) / rate);
    }
    if (!lacks.empty())
      text += fmt::format("assumed: in {}({}), {:.4f}..{:.4f} s, {}\n", event.event, names,
                          static_cast<double>(event.interval.begin) / rate,
                          static_cast<double>(event.interval.end) / rate, lacks);
  }
  return text;
}

MissingFacts MissingOf(const Recording& episode, const grammar::FactsOfEpisode& facts,
                       const grammar::Program& program) {
  MissingFacts missing{.warnings = MovedText(episode.header, episode.moved)};
  const std::vector<grammar::EntityInfo>& entities = episode.header.entity_table.entities;
  std::vector<bool> placed = episode.placed;
  placed.resize(entities.size());
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

}  // namespace

MissingFacts FindMissingFacts(Recording& episode, const grammar::Program& program) {
  grammar::FactsOfEpisode facts;
  episode.EachFrame(
      [&](EpisodeFrame& frame) { facts.Add(frame.View(), episode.header.entity_table); });
  return MissingOf(episode, facts, program);
}

Result<SegmentedRecording> SegmentRecording(Recording& recording,
                                            std::shared_ptr<const grammar::Program> program,
                                            const std::string& file) {
  const grammar::EntityTable& entities = recording.header.entity_table;
  SegmentedRecording segmented{.name = recording.header.episode,
                               .program = program,
                               .entity_table = entities,
                               .end = recording.end_tick,
                               .says_its_end = recording.says_its_end,
                               .warnings = Warnings(*program, entities)};
  grammar::FactsOfEpisode facts;
  Losses losses(entities.entities.size());
  std::vector<grammar::Tick> steps;
  std::optional<grammar::Tick> before;
  const auto look = [&](EpisodeFrame& frame) {
    if (before) steps.push_back(frame.tick - *before);
    AddLosses(frame, before, recording, losses);
    before = frame.tick;
    facts.Add(frame.View(), entities);
  };
  PREHEND_TRY(segmented.timeline, SegmentFrames(recording, program, file, look));
  segmented.frame_ticks = steps.empty() ? 1 : Median(std::move(steps));
  segmented.missing = MissingOf(recording, facts, *program);
  segmented.missing.warnings += AssumedText(entities.entities, losses, segmented.timeline);
  return segmented;
}

Result<grammar::Timeline> SegmentFrames(Recording& recording,
                                        const std::shared_ptr<const grammar::Program>& program,
                                        const std::string& file, const Recording::Look& each) {
  Segmentation segmentation = Segment(program, recording.header.entity_table,
                                      [&](const std::function<void(const FrameNews&)>& take) {
                                        recording.EachFrame([&](EpisodeFrame& frame) {
                                          if (each) each(frame);
                                          take(frame.View());
                                        });
                                        return recording.end_tick;
                                      });
  if (!segmentation.problem.empty()) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = file,
         .message = "the grammar cannot segment this recording: " + segmentation.problem}});
  }
  return std::move(segmentation.timeline);
}

Segmentation Segment(const std::shared_ptr<const grammar::Program>& program,
                     const grammar::EntityTable& entities, const FrameFeed& play,
                     const std::function<void(const grammar::Timeline&)>& decided,
                     const OpenEvents& open) {
  grammar::Monitor monitor(program, entities);
  std::vector<grammar::Event> events;
  if (!monitor.error().empty())
    return {grammar::NameEvents(*program, entities, events), monitor.error()};
  const auto tell = [&] {
    if (!decided || events.empty()) return;
    decided(grammar::NameEvents(*program, entities, events));
    events.clear();
  };
  const auto every = static_cast<grammar::Tick>(OpenEvents::kEvery_s *
                                                static_cast<double>(entities.ticks_per_second));
  grammar::Tick next = 0;
  const auto tell_open = [&](grammar::Tick now) {
    if (!open.take || now < next) return;
    next = now + every;
    const auto end_here = [&] {
      monitor.Finish(now + 1, events);
      std::erase_if(events, [](const grammar::Event& event) { return !event.open_end; });
      return open.describe(grammar::NameEvents(*program, entities, events));
    };
    const WorkerResult found = RunInWorkers({end_here}, {.time_limit_s = 10}).front();
    if (found.finished) open.take(now, found.output);
  };
  const grammar::Tick end = play([&](const FrameNews& news) {
    const auto* whole = std::get_if<grammar::Frame>(&news);
    if (whole)
      monitor.Advance(*whole, events);
    else
      monitor.AdvanceBy(std::get<grammar::FrameChanges>(news), events);
    tell();
    tell_open(whole ? whole->tick : std::get<grammar::FrameChanges>(news).tick);
  });
  monitor.Finish(end, events);
  tell();
  return {grammar::NameEvents(*program, entities, events), monitor.error()};
}

grammar::Timeline Resegment(const scenario::Scenario& scenario,
                            std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end) {
  Sensing sensing(scenario.scene, scenario.sensing);
  const FrameFeed play = [&](const std::function<void(const FrameNews&)>& take) {
    for (const physics::Snapshot& snapshot : recording) {
      if (sensing.Due(snapshot.tick)) take(sensing.SenseChanges(snapshot));
    }
    return end;
  };
  return Segment(program, MakeEntityTable(scenario), play).timeline;
}

}  // namespace prehend::episode
