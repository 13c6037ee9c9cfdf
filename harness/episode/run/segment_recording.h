// SPDX-License-Identifier: Apache-2.0
// A recording (docs/recording-format.md) and the events that a grammar recognises in it. Tested by
// tests/program/recording_test.cc and tests/program/golden_of_recording_test.cc
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

// What a grammar asks for and a recording does not have. Tested by
// tests/program/missing_facts_test.cc

struct MissingFacts {
  /// Warnings of events that need facts which the recording does not have, and of entities of which
  /// it never says where they are; or "".
  std::string warnings;
  /// Of these, those of events that are never recognised, a line and its hint each.
  std::vector<std::string> never;
  bool nothing_left = false;  ///< no event is left that could be recognised
};

MissingFacts FindMissingFacts(Recording& episode, const grammar::Program& program);

struct SegmentedRecording {
  std::string name;  ///< of the episode
  std::shared_ptr<const grammar::Program> program;
  grammar::Timeline timeline;
  grammar::Tick end = 1;          ///< the first tick after the episode
  grammar::Tick frame_ticks = 1;  ///< from one frame to the next: the median
  bool says_its_end = false;      ///< otherwise it may be cut off
  grammar::Diagnostics warnings;  ///< of the grammar
  MissingFacts missing;           ///< what the grammar asks for and the recording does not have
};

/// `file` is for messages.
Result<SegmentedRecording> SegmentRecording(Recording& recording,
                                            std::shared_ptr<const grammar::Program> program,
                                            const std::string& file);

/// Only its events.
Result<grammar::Timeline> SegmentFrames(Recording& recording,
                                        const std::shared_ptr<const grammar::Program>& program,
                                        const std::string& file);

}  // namespace prehend::episode
