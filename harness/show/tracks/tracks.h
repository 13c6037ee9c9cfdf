// SPDX-License-Identifier: Apache-2.0
// Every named condition and signal of a grammar over time, one value per frame: for plots.
// Tested by tests/harness/show/tracks/tracks_test.cc
#pragma once

#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "grammar/replay_monitor.h"
#include "harness/base/base/result.h"

namespace prehend::show {

inline constexpr std::size_t kMaxTracks = 10'000;
inline constexpr std::size_t kMaxTrackValues = 50'000'000;

struct Track {
  enum class Kind { kEvent, kCondition, kSignal };
  std::string name;  ///< "grasping(right_hand, milk)", "speed_along(milk, table)"
  Kind kind = Kind::kSignal;
  std::string unit;  ///< SI; empty for a plain number and for what is 0 or 1
  std::vector<std::optional<double>>
      values;  ///< nothing where it has none: of an interval, outside of it
};

struct Tracks {
  grammar::Tick ticks_per_second = 480;
  std::vector<grammar::Tick> ticks;  ///< of the frames
  std::vector<Track> tracks;
  std::string problem;  ///< empty, or why there are too many of them
};

/// What can be asked for: names of events, conditions, and of what signals begin with
/// ("speed_along").
std::vector<std::string> TrackNames(const grammar::Program& program);

/// `only`: these names; empty: all.
Tracks CollectTracks(grammar::ReplayMonitor& past, const std::set<std::string>& only);

/// One line per frame: time_s, tick, and a column per track, the unit in brackets. Values that are
/// none are empty.
void WriteCsv(const Tracks& tracks, std::ostream& out);
/// {"episode", "grammar", "ticks_per_second", "tick": [..], "tracks": [{"name", "kind", "unit",
/// "values": [..]}]}
void WriteJson(const Tracks& tracks, const std::string& episode, const std::string& grammar,
               std::ostream& out);

// By how much a rule holds or does not, frame by frame: the robustness of signal temporal logic.
// Tested by tests/harness/show/tracks/robustness_test.cc

struct Robustness {
  std::vector<double> values;  ///< per frame: above 0 where it holds, below where it does not
  std::string unit;            ///< "": of numbers of several kinds, or plain
};

/// Of the forms and modifiers that are a formula over frames (docs/explain.md); nothing of others.
std::optional<Robustness> RobustnessOf(grammar::ReplayMonitor& past, grammar::InstanceId instance);

}  // namespace prehend::show
