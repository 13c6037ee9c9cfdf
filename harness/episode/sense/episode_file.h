// SPDX-License-Identifier: Apache-2.0
// An episode as a file of JSON Lines: first the entities, then one line per frame. It holds what a
// grammar needs to segment the episode again, and nothing more (docs/recording-format.md). It is
// written by `prehend run --record`, by trackers or by hand. Tested by
// tests/harness/episode/sense/episode_file_test.cc
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/result.h"
#include "harness/episode/sense/gap_tolerance.h"

namespace prehend::episode {

inline constexpr int kEpisodeVersion = 1;
inline constexpr std::size_t kMaxEpisodeFrames = 1'000'000;
inline constexpr std::size_t kMaxEpisodeBytes = std::size_t{1} << 30;
inline constexpr std::size_t kMaxEpisodeLineBytes = 1 << 20;
inline constexpr std::size_t kMaxLanguageBytes = 1000;
inline constexpr double kBridge_s = 0.1;

/// What is known of an episode beside its frames.
struct EpisodeAttributes {
  std::optional<bool> success;
  std::string language;  ///< what was to be done, in words; "": nothing says it
};

/// The first line.
struct EpisodeHeader {
  std::string episode;  ///< its name: of the scenario that was recorded
  std::string grammar;  ///< which grammar segments it unless another one is asked for
  /// Where a file names the grammar: the rest of an error about it. Without a file: nowhere.
  grammar::Diagnostic grammar_named = {};
  double bridge_s = kBridge_s;  ///< for so long a missing look is as the last one
  EpisodeAttributes attributes;
  grammar::EntityTable entity_table;
};

/// A frame that owns its data.
struct EpisodeFrame {
  grammar::Tick tick = 0;
  std::vector<grammar::EntitySample> entities;
  std::vector<grammar::HandSample> hands;  ///< their spans are empty, see `collision_spheres`
  std::vector<std::vector<grammar::CollisionSphere>> collision_spheres;  ///< per hand
  std::vector<grammar::Touch> touches;

  /// Valid as long as this frame, until it changes.
  grammar::Frame View();
};

struct Recording {
  EpisodeHeader header;
  std::vector<EpisodeFrame> frames;
  grammar::Tick end_tick = 0;  ///< the first tick after the episode
  std::vector<bool> placed;    ///< by entity: some frame says where it is
  std::vector<LookGaps> gaps;  ///< by entity: how long it is not tracked
  bool says_its_end = false;   ///< it has a line with 'end_tick'; otherwise it may be cut off
};

/// For frames that were not read from a file: what is not tracked for a short time is as it was
/// seen last.
void BridgeLooks(Recording& episode);

/// Reports errors with file, line and column. The limits are those above.
Result<Recording> ReadRecording(const std::string& path);

/// Facts of frames beside the poses; without triggers there are no styles, either.
struct WrittenFacts {
  bool touches = true, trigger = true, joints = true, gazes = true;
};

/// Writes each frame as it comes.
class EpisodeWriter {
 public:
  EpisodeWriter(std::ostream& out, const EpisodeHeader& header, const WrittenFacts& facts = {});
  void Write(const grammar::Frame& frame);
  void Finish(grammar::Tick end_tick);

 private:
  std::ostream& out_;
  const WrittenFacts facts_;
  grammar::EntityTable entity_table_;
  std::vector<std::string> shown_;  ///< per entity: its last line, as only changes are written
};

}  // namespace prehend::episode
