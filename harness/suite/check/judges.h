// SPDX-License-Identifier: Apache-2.0
// Who judges an episode in a check, in which order, and what they find. They are functions of
// values; what they find out besides goes into the verdict. Tested by
// tests/harness/suite/check/check_scenario_test.cc
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/episode/run/segment_recording.h"
#include "harness/suite/check/check_request.h"
#include "harness/suite/check/verdict.h"
#include "harness/suite/judge/judge_golden.h"
#include "harness/suite/judge/judge_pictures.h"

namespace prehend::suite {

/// An episode on its way through the judges.
struct CheckedEpisode {
  const CheckRequest& request;
  CheckedRun run;                                        ///< of a recording what stands in for it
  std::optional<episode::SegmentedRecording> recording;  ///< of what was not simulated
  ScenarioVerdict verdict;                               ///< what is known of it so far
  // For Store() and for judges that come later.
  std::optional<GoldenComparison> golden = {};  ///< empty if the golden cannot be read
  std::string engine_difference = {};
  std::vector<PictureComparison> pictures = {};

  bool IsComplete() const { return run.result.status.kind == physics::RunStatus::Kind::kCompleted; }
};

/// Where the golden of a recording is: beside the file that it comes from. "" if that is not known,
/// since the recording cannot be read.
std::string GoldenOfRecording(const CheckRequest& request, const scenario::Scenario* scenario);

using Judge = Findings (*)(CheckedEpisode& checked);

/// Those that can judge this episode: of a recording only its golden, of a run that failed only
/// that.
std::span<const Judge> JudgesOf(const CheckedEpisode& checked);

}  // namespace prehend::suite
