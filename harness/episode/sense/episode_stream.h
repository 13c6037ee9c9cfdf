// SPDX-License-Identifier: Apache-2.0
// A recording that is read while it is written: line by line. A faulty line changes nothing, so
// that the next ones can still be read. Tested by tests/program/watch_test.cc
#pragma once

#include <memory>
#include <string>

#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

struct FrameEntry;  // harness/episode/sense/episode_format.h

class EpisodeStream {
 public:
  /// `name` is that of the file, for messages. `keeps_all`: the frames, for Whole().
  explicit EpisodeStream(const std::string& name, bool keeps_all = false);
  ~EpisodeStream();
  EpisodeStream(const EpisodeStream&) = delete;
  EpisodeStream& operator=(const EpisodeStream&) = delete;

  /// A frame that is farther than this after the one before is faulty, unless the next one agrees
  /// with it: then there was a pause.
  void DoubtFrames(double ahead_s);
  /// Takes the next line, of at most kMaxEpisodeLineBytes. Returns what is wrong with it.
  grammar::Diagnostics Take(const std::string& line);
  /// The same of values that are within the limits of the format.
  grammar::Diagnostics Take(const FrameEntry& frame);

  bool has_header() const;
  const EpisodeHeader& header() const;
  /// The frame that the last line held, until the next line; null if it held none.
  EpisodeFrame* frame() { return frame_; }
  /// What was not tracked so far, and for how long: lines for people.
  std::string gaps() const;
  /// A line has said where the episode ends.
  bool says_its_end() const;
  /// The first tick after the episode, as far as it is known; 0 without any frame.
  grammar::Tick end_tick() const;
  /// All that was taken, at the end.
  Result<Recording> Whole(grammar::Tick end_tick);

 private:
  template <typename TakeOne>
  grammar::Diagnostics TakeAny(const TakeOne& take);
  struct Reader;
  std::unique_ptr<Reader> reader_;
  EpisodeFrame* frame_ = nullptr;
};

}  // namespace prehend::episode
