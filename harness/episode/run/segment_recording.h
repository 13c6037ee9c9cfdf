// SPDX-License-Identifier: Apache-2.0
// A recording (docs/recording-format.md) and the events that a grammar recognises in it. The loop
// that segments an episode which was played or recorded before, whatever it came from. (ScenarioRun
// in harness/episode/run/run_scenario.h is the other one: it segments while it simulates.) Tested
// by tests/program/recording_test.cc, tests/program/golden_of_recording_test.cc and
// tests/harness/episode/run/run_scenario_test.cc
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/sensing.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/snapshot.h"

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
  grammar::EntityTable entity_table;
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

/// Only its events. `each` sees each frame, too.
Result<grammar::Timeline> SegmentFrames(Recording& recording,
                                        const std::shared_ptr<const grammar::Program>& program,
                                        const std::string& file, const Recording::Look& each = {});

/// A frame, or what is new in it.
using FrameNews = std::variant<grammar::Frame, grammar::FrameChanges>;

/// Calls its argument with each frame of an episode, in their order. Returns the first tick after
/// the episode.
using FrameFeed = std::function<grammar::Tick(const std::function<void(const FrameNews&)>&)>;

struct Segmentation {
  grammar::Timeline timeline;
  std::string problem;  ///< empty, or why the grammar cannot be evaluated; then nothing is played
};

/// What holds now, as far as is known: what would be open if the episode ended with this frame.
/// That is found in a process of its own, as it changes what is known.
struct OpenEvents {
  static constexpr double kEvery_s = 0.05;
  std::function<std::string(const grammar::Timeline&)> describe;    ///< there
  std::function<void(grammar::Tick now, const std::string&)> take;  ///< what was described, here
};

/// What the grammar recognises. `decided`, if there is one, gets events as soon as they are.
Segmentation Segment(const std::shared_ptr<const grammar::Program>& program,
                     const grammar::EntityTable& entities, const FrameFeed& play,
                     const std::function<void(const grammar::Timeline&)>& decided = {},
                     const OpenEvents& open = {});

/// What another grammar recognises in the same episode, without simulating it again. `recording`
/// has a snapshot per tick, of which those are sensed that are due.
grammar::Timeline Resegment(const scenario::Scenario& scenario,
                            std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end);

}  // namespace prehend::episode
