// SPDX-License-Identifier: Apache-2.0
// Recordings of trackers and other programs (frames as a grammar sees them, without physics) as
// episodes of an episode file, and back. Tested by
// tests/harness/episode/episodes/recordings_test.cc
#pragma once

#include <string>

#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {

/// The file of a task that holds the first line of a recording.
inline constexpr const char* kHeaderFile = "recording.json";

struct ImportRequest {
  std::string file;          ///< the episode file; it is created if it is not there
  std::string root;          ///< the project's; files below it are named relative to it
  std::string source;        ///< what the recording was read from
  std::string grammar;       ///< name or path; empty: the recording's own
  std::string recorded_on;   ///< YYYY-MM-DD
  std::string program_hash;  ///< ProgramHash()
  bool once = false;         ///< a recording that the file has, by the same program, stays away
};

struct ImportedRecording {
  SegmentedRecording segmented;  ///< what the grammar recognises in it
  std::string problem;           ///< empty, or why it is not in the file: "FILE: the disk is full"
  bool was_there = false;        ///< and is not added again
};

/// Adds a recording to an episode file, with the events that the grammar recognises; all of it or
/// nothing. Reports a grammar that cannot be read or cannot segment it.
Result<ImportedRecording> ImportRecording(const ImportRequest& request, Recording& recording);

/// The recording again, bit by bit, if its frames are those that were recorded. Its first line went
/// through JSON; its frames stay in the file, which outlives it.
Result<Recording> ReadRecording(const EpisodeFile& file, const EpisodeRow& row);

/// Only its first line.
Result<EpisodeHeader> ReadRecordingHeader(const EpisodeFile& file, const EpisodeRow& row);

/// What EpisodeRow::state_hash is of a recording.
std::uint64_t HashOfFrames(Recording& recording);

// A scene that stands in for a recording, so that pictures of it can be drawn: what is not known is
// not made up. Things have the shapes that the recording gives, hands a palm without fingers; there
// are no joints, no grains and no gazes.

/// Bodies and hands in the order of the recording's entities, hands apart.
scenario::Scenario PlaceholderFor(const EpisodeHeader& header);

/// The world of that scene in a frame.
physics::Snapshot PlaceholderSnapshotAt(const EpisodeHeader& header, const EpisodeFrame& frame);

}  // namespace prehend::episode
