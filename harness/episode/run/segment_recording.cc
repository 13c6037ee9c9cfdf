// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/segment_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/segment.h"

namespace prehend::episode {
namespace {

grammar::Tick MedianStep(const std::vector<EpisodeFrame>& frames) {
  std::vector<grammar::Tick> steps;
  for (std::size_t i = 1; i < frames.size(); ++i)
    steps.push_back(frames[i].tick - frames[i - 1].tick);
  if (steps.empty()) return 1;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// From where it was seen last, by `bridge_s`, to where it is found again.
std::vector<grammar::Interval> LossesOf(const Recording& recording, std::size_t entity,
                                        grammar::Tick bridge) {
  std::vector<grammar::Interval> losses;
  bool is_lost = false;
  for (const EpisodeFrame& frame : recording.frames) {
    const bool was_lost = std::exchange(is_lost, !grammar::IsTracked(frame.entities[entity]));
    if (is_lost && !was_lost) losses.push_back({frame.tick - bridge, recording.end_tick});
    if (was_lost && !is_lost) losses.back().end = frame.tick;
  }
  return losses;
}

/// A line for each event in which somebody who has a role is lost: for how long that was assumed.
std::string AssumedText(const Recording& recording, const grammar::Timeline& timeline) {
  const auto& entities = recording.header.entity_table.entities;
  const auto rate = static_cast<double>(timeline.ticks_per_second);
  const auto bridge = static_cast<grammar::Tick>(recording.header.bridge_s * rate);
  std::vector<std::vector<grammar::Interval>> losses;
  for (std::size_t i = 0; i < entities.size(); ++i)
    losses.push_back(LossesOf(recording, i, bridge));
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

}  // namespace

Result<SegmentedRecording> SegmentRecording(Recording& recording,
                                            std::shared_ptr<const grammar::Program> program,
                                            const std::string& file) {
  const grammar::EntityTable& entities = recording.header.entity_table;
  SegmentedRecording segmented{.name = recording.header.episode,
                               .program = program,
                               .timeline = {},
                               .end = recording.end_tick,
                               .frame_ticks = MedianStep(recording.frames),
                               .says_its_end = recording.says_its_end,
                               .warnings = Warnings(*program, entities),
                               .missing = FindMissingFacts(recording, *program)};
  Result<grammar::Timeline> timeline = SegmentFrames(recording, program, file);
  if (!timeline) return tl::unexpected(std::move(timeline.error()));
  segmented.timeline = std::move(*timeline);
  segmented.missing.warnings += AssumedText(recording, segmented.timeline);
  return segmented;
}

Result<grammar::Timeline> SegmentFrames(Recording& recording,
                                        const std::shared_ptr<const grammar::Program>& program,
                                        const std::string& file) {
  Segmentation segmentation = Segment(program, recording.header.entity_table,
                                      [&](const std::function<void(const FrameNews&)>& take) {
                                        for (EpisodeFrame& frame : recording.frames)
                                          take(frame.View());
                                        return recording.end_tick;
                                      });
  if (!segmentation.problem.empty()) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = file,
         .place = {},
         .message = "the grammar cannot segment this recording: " + segmentation.problem,
         .source_line = {},
         .hint = {}}});
  }
  return std::move(segmentation.timeline);
}

}  // namespace prehend::episode
