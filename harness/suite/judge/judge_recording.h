// SPDX-License-Identifier: Apache-2.0
// A recording of a tracker against its golden, which lies beside it: take.timeline beside
// take.jsonl. Nothing is simulated, so neither claims nor the oracle are asked. Tested by
// tests/program/golden_of_recording_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/episode/run/segment_recording.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {

struct JudgedRecording {
  episode::SegmentedRecording segmented;
  std::optional<truth::Golden> golden;
  truth::Comparison comparison;  ///< with the golden, or with an empty one
  truth::Golden
      proposed;  ///< what the recording yields now, with what people wrote into the golden

  bool Agrees() const { return golden && comparison.Agrees(); }
};

/// Where the golden of a recording is.
std::string GoldenBeside(const std::string& recording);

/// `request.scenario_file` is the recording. A line of the golden without a tolerance of its own
/// has that of two frames.
Result<JudgedRecording> JudgeRecording(const episode::RunRequest& request, const std::string& root);
/// The same of one that is segmented, with this golden.
Result<JudgedRecording> JudgeSegmented(episode::SegmentedRecording segmented,
                                       const std::string& golden_file);

/// A line that says so if the golden is of another grammar than the recording was segmented with.
std::string OtherGrammarText(const JudgedRecording& judged);

/// What there is to accept: all events where there is no golden, else how they differ from it.
/// `explain`: the command that asks about them.
std::string ReviewText(const JudgedRecording& judged, const std::string& explain);

/// JudgedRecording::proposed with the reason why it is right. `derived`: how it follows from the
/// definitions; empty: as the golden says.
truth::Golden AcceptedRecording(const JudgedRecording& judged,
                                const std::vector<std::string>& derived,
                                truth::Acceptance acceptance);

}  // namespace prehend::suite
