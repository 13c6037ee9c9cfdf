// SPDX-License-Identifier: Apache-2.0
// See harness/episode/run/segment_recording.h. Tested by tests/program/recording_test.cc
#include "harness/episode/run/segment_recording.h"

#include <algorithm>
#include <vector>

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
