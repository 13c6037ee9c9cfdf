// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command/write_recording.h. Tested by tests/program/import_test.cc
#include "harness/cli/command/write_recording.h"

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/episodes/schema.h"

namespace prehend::cli {

ExitCode WriteRecording(episode::Recording& recording, const std::string& output,
                        const std::string& source, const std::string& grammar,
                        const CommandContext& context) {
  if (episode::IsEpisodeFile(output)) {
    if (const std::string problem = episode::WhyNotRecordable(output); !problem.empty())
      return Complain(context, ExitCode::kBadInput, problem);
    const auto imported = episode::ImportRecording({.file = output,
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
  episode::EpisodeWriter writer(file.stream(), recording.header);
  for (episode::EpisodeFrame& frame : recording.frames) writer.Write(frame.View());
  if (recording.says_its_end) writer.Finish(recording.end_tick);
  const std::string problem = file.Commit();
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace prehend::cli
