// SPDX-License-Identifier: Apache-2.0
// See harness/command/write_recording.h. Tested by tests/program/import_test.cc
#include "harness/command/write_recording.h"

#include "harness/base/atomic_file.h"
#include "harness/base/content_hash.h"
#include "harness/episodes/record_episode.h"
#include "harness/episodes/recordings.h"
#include "harness/episodes/schema.h"

namespace prehend::harness {

ExitCode WriteRecording(Recording& recording, const std::string& output, const std::string& source,
                        const std::string& grammar, const CommandContext& context) {
  if (episodes::IsEpisodeFile(output)) {
    if (const std::string problem = episodes::WhyNotRecordable(output); !problem.empty())
      return Complain(context, ExitCode::kBadInput, problem);
    const auto imported = episodes::ImportRecording({.file = output,
                                                     .root = context.root,
                                                     .source = source,
                                                     .grammar = grammar,
                                                     .recorded_on = context.today,
                                                     .program_hash = ProgramHash()},
                                                    recording);
    if (!imported) return Complain(context, imported.error());
    if (imported->problem.empty()) return ExitCode::kAgrees;
    return Complain(context, ExitCode::kFailure, imported->problem);
  }
  AtomicFile file(output);
  if (!file.problem().empty()) return Complain(context, ExitCode::kBadInput, file.problem());
  EpisodeWriter writer(file.stream(), recording.header);
  for (EpisodeFrame& frame : recording.frames) writer.Write(frame.View());
  if (recording.says_its_end) writer.Finish(recording.end_tick);
  const std::string problem = file.Commit();
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace prehend::harness
