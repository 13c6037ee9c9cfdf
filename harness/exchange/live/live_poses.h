// SPDX-License-Identifier: Apache-2.0
// Lines of a table of poses, or of JSON, while a tracker writes them, by the map of an import: each
// row, or all rows of a time, becomes a frame of a recording. Tested by
// tests/program/watch_map_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

class LivePoses {
 public:
  /// `name`: what messages call the lines.
  LivePoses(std::string name, std::string map_path)
      : name_(std::move(name)), map_path_(std::move(map_path)) {}

  /// The stream gets the head of the recording with the first row, and then each frame. Returns
  /// what is wrong; without a head in the stream nothing comes of the lines.
  grammar::Diagnostics Take(const std::string& line, episode::EpisodeStream& stream);
  /// No line comes any more.
  grammar::Diagnostics Finish(episode::EpisodeStream& stream);
  /// The last call gave the stream a frame.
  bool has_frame() const { return has_frame_; }
  /// What of the map cannot be done before the end is known.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  grammar::Diagnostics Begin(const std::string& row, episode::EpisodeStream& stream);
  grammar::Diagnostics TakeRow(episode::EpisodeStream& stream);
  std::string Known(double row_s) const;
  void Add(std::size_t entity, PoseSample sample);
  void AddOpening(const OpeningSeries& opening);
  void TellLosses(episode::FrameEntry& frame);
  grammar::Diagnostics Emit(episode::EpisodeStream& stream);

  const std::string name_, map_path_;
  std::string head_;  ///< the lines before the first row, and that one
  int line_ = 0;
  int waits_line_ = 0;  ///< of a frame that is left out unless the next one agrees with it
  std::optional<MapFile> map_;
  std::optional<PoseLines> lines_;
  bool collects_ = false;                        ///< a frame may be of several lines
  std::optional<double> last_s_;                 ///< of the frame before
  std::optional<double> given_s_;                ///< likewise, also if that was left out
  std::optional<double> frame_s_;                ///< of the frame that is being collected
  std::vector<double> steps_s_;                  ///< from frame to frame, of the first ones
  std::vector<episode::SampleEntry> samples_;    ///< of it, by entity
  std::vector<std::optional<double>> seen_s_;    ///< by entity: when it was last
  std::vector<bool> opened_;                     ///< of it, which of the openings are known
  std::vector<std::optional<double>> triggers_;  ///< by entity: the last ones
  std::vector<std::optional<Eigen::Quaterniond>> upright_;  ///< by entity, in the file's axes
  std::string too_far_;  ///< what of it is beyond what a recording may say, or ""
  bool has_frame_ = false;
  std::vector<std::string> notes_;
};

}  // namespace prehend::exchange
