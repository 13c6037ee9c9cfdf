// SPDX-License-Identifier: Apache-2.0
// See harness/run/segment_recording.h. Tested by tests/program/recording_test.cc
#include "harness/run/segment_recording.h"

#include <algorithm>
#include <vector>

#include "grammar/name_events.h"
#include "harness/run/load_grammar.h"

namespace prehend::harness {
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

Result<SegmentedRecording> SegmentRecording(const RunRequest& request, const std::string& root) {
  Result<Episode> episode = ReadEpisode(request.scenario_file);
  if (!episode) return tl::unexpected(std::move(episode.error()));
  const Result<grammar::Overrides> parameters = ParameterSettings(request.settings);
  if (!parameters) return tl::unexpected(parameters.error());
  grammar::CompileResult compiled =
      LoadGrammarOf(episode->header, request.grammar, root, *parameters);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  return SegmentEpisode(*episode, std::move(compiled.program), request.scenario_file);
}

Result<SegmentedRecording> SegmentEpisode(Episode& episode,
                                          std::shared_ptr<const grammar::Program> program,
                                          const std::string& file) {
  const grammar::EntityTable& entities = episode.header.entity_table;
  SegmentedRecording segmented{.name = episode.header.episode,
                               .program = program,
                               .timeline = {},
                               .end = episode.end_tick,
                               .frame_ticks = MedianStep(episode.frames),
                               .says_its_end = episode.says_its_end,
                               .warnings = Warnings(*program, entities),
                               .missing = FindMissingFacts(episode, *program)};
  grammar::Monitor monitor(program, entities);
  std::vector<grammar::Event> events;
  for (EpisodeFrame& frame : episode.frames) monitor.Advance(frame.View(), events);
  monitor.Finish(episode.end_tick, events);
  if (!monitor.error().empty()) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = file,
         .place = {},
         .message = "the grammar cannot segment this recording: " + monitor.error(),
         .source_line = {},
         .hint = {}}});
  }
  segmented.timeline = grammar::NameEvents(*program, entities, events);
  return segmented;
}

}  // namespace prehend::harness
