// SPDX-License-Identifier: Apache-2.0
// Which moments of an episode a figure shows. Pictures of moments in recorded episodes: the world
// at a time, and the paths of a hand and of a thing over a while. Tested by
// tests/harness/show/figures/moments_test.cc and tests/program/query_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/episode/episodes/query_events.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {

struct Window {
  double from_s = 0, to_s = 0;
  std::string hand = {};    ///< nothing of other hands; empty: all
  std::string entity = {};  ///< events in which it takes part; empty: all

  /// Whether it shows this event, whenever that is.
  bool Shows(const scenario::Scenario& scenario, const grammar::NamedEvent& event) const;
};
Window WholeOf(const episode::RunResult& run);

/// The hand of a phase or a grasp, or "".
std::string HandOf(const episode::RunResult& run, const grammar::NamedEvent& event);

double SecondsOf(const episode::RunResult& run, grammar::Tick tick);

/// Moments that tell the story: the begins of what hands do, the end of the last of it, and in
/// between the middle of what takes longest; at most `most`, in the order of time.
struct KeyMoment {
  double time_s = 0;
  std::string caption;                ///< "reaching begins"
  std::vector<std::string> involved;  ///< the hand and the things that it is about
  std::string camera = {};            ///< empty: as of the other scenes
  double track_s = 1;                 ///< so much of the way of its hand leads to it
  bool keeps_track = false;           ///< that way was kept until the phase was recognised
};
std::vector<KeyMoment> KeyMoments(const episode::RunResult& run, const Window& window,
                                  std::size_t most);

/// Key moments but begin and end of the episode, which a chart shows anyway.
std::vector<KeyMoment> EventMoments(const episode::RunResult& run, const Window& window,
                                    std::size_t count);

/// Those that are named, as for FindEventTime(), or why there is no such moment.
tl::expected<std::vector<KeyMoment>, std::string> NamedMoments(
    const std::vector<std::string>& names, const grammar::Program& program,
    const episode::RunResult& run);

/// A person sees something for a while.
struct Look {
  double begin_s = 0, end_s = 0, distance_m = 0;  ///< the distance in the middle
  std::string person, seen;

  double Dwell_s() const { return end_s - begin_s; }
  double Middle_s() const { return (begin_s + end_s) / 2; }
};
/// All looks of all persons in the window, in the order of their begins.
std::vector<Look> Looks(const scenario::Scenario& scenario, const episode::RunResult& run,
                        const Window& window);

/// A hand holds something in some style: when, and with which sensors.
struct HeldMoment {
  double time_s = 0;
  std::string style;
  std::vector<std::string> sensor_sets;  ///< that touch what is held, in the hand's order
};
/// The middle of the longest grasp that has a style.
std::optional<HeldMoment> LongestGrasp(const scenario::Scenario& scenario,
                                       const episode::RunResult& run);

/// More than these are not drawn.
inline constexpr std::size_t kMostMoments = 100;

struct Moment {
  std::string file;
  std::int64_t episode = 0;
  std::string scenario, name;       ///< of these the picture's name is made
  double at_s = 0;                  ///< the world at this time
  double from_s = 0, to_s = 0;      ///< paths between these times
  std::vector<std::string> of;      ///< of the first hand and the first thing among these
  std::vector<std::string> marked;  ///< things that get a marker
};

/// The moment of an answer: when its event begins.
Moment MomentOf(const episode::EventAnswer& answer);

struct MomentPictures {
  std::vector<std::string> files;  ///< one per moment; empty: not drawn
  std::string error;               ///< empty, or why (some) could not be drawn
};

/// Draws each moment as FOLDER/NUMBER-SCENARIO-NAME.png; makes the folder. `root`: the project's.
/// Moments of one episode should follow each other, so that it is replayed once.
MomentPictures DrawMoments(const std::vector<Moment>& moments, const std::string& folder,
                           const std::string& root);

}  // namespace prehend::show
