// SPDX-License-Identifier: Apache-2.0
// A program of somebody else that says what happens in an episode: frames go in, events come out
// (docs/recognisers.md). Tested by tests/program/recogniser_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/labels/read_labels.h"

namespace prehend::measure {

/// When the next frame is sent: at once, after an answer to the last one, or when its time comes.
enum class Pace { kOffline, kOnline, kRealTime };

struct RecogniserChoice {
  std::string command;  ///< for the shell
  Pace pace = Pace::kOffline;
  double time_limit_s = 60;  ///< for an episode
};

/// What is sent.
struct WatchedEpisode {
  std::string name;
  grammar::EntityTable entities;
  /// Calls its argument with each frame; returns the first tick after the episode.
  std::function<grammar::Tick(const std::function<void(const grammar::Frame&)>&)> each_frame;
};

/// What a recogniser keeps to, in the order of docs/recognisers.md.
enum class Rule { kHeader, kLines, kEvents, kTicks, kReady, kNoError, kEnds };
struct BrokenRule {
  Rule rule = Rule::kHeader;
  grammar::Diagnostic what;  ///< with the line
};

struct Recognised {
  exchange::LabelFile events;        ///< its lines, as labels
  std::optional<BrokenRule> broken;  ///< then the events are not all
  std::vector<std::string> covers;   ///< the events of its first line
  std::string stderr_tail;
  double cpu_s = 0;     ///< of its process, which of several episodes has only the last
  int late_frames = 0;  ///< answers that came after the next frame had been sent
};

class Recogniser {
 public:
  explicit Recogniser(RecogniserChoice choice);
  ~Recogniser();
  const RecogniserChoice& choice() const { return choice_; }

  /// Starts it, unless it takes one episode after another and still runs.
  Recognised Recognise(const WatchedEpisode& episode);

 private:
  class Talk;
  const RecogniserChoice choice_;
  std::unique_ptr<Talk> talk_;
};

}  // namespace prehend::measure
