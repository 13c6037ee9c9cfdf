// SPDX-License-Identifier: Apache-2.0
// A scene that stands in for a recording, so that pictures of it can be drawn: what is not known is
// not made up. Things have the shapes that the recording gives, hands a palm without fingers; there
// are no joints, no grains and no gazes. Tested by
// tests/harness/episode/episodes/recordings_test.cc
#pragma once

#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {

/// Bodies and hands in the order of the recording's entities, hands apart.
scenario::Scenario PlaceholderFor(const EpisodeHeader& header);

/// The world of that scene in a frame.
physics::Snapshot PlaceholderSnapshotAt(const EpisodeHeader& header, const EpisodeFrame& frame);

}  // namespace prehend::episode
