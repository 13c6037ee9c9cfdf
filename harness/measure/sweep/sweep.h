// SPDX-License-Identifier: Apache-2.0
// A grammar on recorded episodes, once for each setting of its parameters. Tested by
// tests/program/sweep_test.cc
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/episode/take.h"

namespace prehend::measure {

inline constexpr std::size_t kMostSettings = 10'000;

/// "reach_radius=10cm..50cm:9": so many values, evenly from the first to the last.
struct Axis {
  std::string parameter, unit;
  std::vector<double> values;

  /// "15cm".
  std::string ValueText(std::size_t i) const;
};
/// Nothing, and `problem`, if the text is not of that form.
std::optional<Axis> ParseAxis(const std::string& text, std::string& problem);

/// What the events are compared with.
enum class Truth {
  kGolden,    ///< the project's golden of the scenario, if it is one of the same grammar
  kOracle,    ///< the physical oracle with the numbers of docs/events.md
  kRecorded,  ///< what was recognised when the episode was recorded
  kLabels     ///< files of labels (docs/labels.md); recordings as JSON Lines have no other truth
};

struct SweepRequest {
  std::string root;
  std::string grammar;                ///< "": what the episodes were played or recorded with
  std::vector<std::string> settings;  ///< of parameters that stay as they are
  std::vector<Axis> axes;
  bool one_at_a_time = false;  ///< of several axes one is varied, the others are as they are;
                               ///< points of the first axis come first
  Truth truth = Truth::kGolden;
  std::vector<std::string> label_files;  ///< one per episode, one of all, or one folder
  std::string label_map;                 ///< "": labels are events
  double collar_s = 0.05;
  bool by_overlap = false;  ///< right is not what lies within the collar, but what has half of the
                            ///< union with its label in common
  bool skip_bad_labels = false;  ///< leave out those that end before they begin
  int jobs = 1;
  /// Called some times a second with how many settings have been measured, each on one episode, of
  /// how many.
  std::function<void(std::size_t done, std::size_t all)> progress = {};
};

/// Sets what the events are compared with: {"golden"}, {"oracle"}, {"recorded"}, or files of
/// labels, or a folder of them; golden if nothing is given. Returns "" or what is wrong with that.
std::string SetTruth(const std::vector<std::string>& given, SweepRequest& request);

/// Adds axes, each a text that ParseAxis() takes. Returns "" or why they cannot be tried together.
std::string SetAxes(const std::vector<std::string>& texts, SweepRequest& request);

/// How one setting did, over all episodes.
struct SweepPoint {
  std::vector<std::size_t> at;                      ///< per axis, the index of its value; one at
                                                    ///< a time: empty
  int correct = 0, extra = 0, missed = 0;           ///< events
  std::vector<int> of_each;                         ///< the same of each episode
  double f1 = 1;                                    ///< of these; 1 if there is nothing
  double begin_ms = 0, end_ms = 0, latency_ms = 0;  ///< medians; NaN of nothing
};

struct SweepResult {
  std::vector<SweepPoint> points;  ///< the last axis is the fastest
  int episodes = 0;
  std::string grammar;                ///< its name
  std::string measure;                ///< "F1@50: .." for people
  std::string label_warning;          ///< of labels that were left out, and clocks; or ""
  std::string counted;                ///< labels: lines for people, or ""
  std::vector<std::string> left_out;  ///< "SCENARIO: why"
  std::vector<std::string> unread;    ///< of these, what cannot be read

  /// Something cannot be read, or labels do not fit.
  bool IsRefused(const SweepRequest& request) const {
    return !unread.empty() || (request.truth == Truth::kLabels && !left_out.empty());
  }
};

/// What makes an event right, for people.
std::string MeasureText(const SweepRequest& request);

/// One point per setting, or why the grammar cannot be compiled with one.
Result<SweepResult> Sweep(const std::vector<episode::Take>& takes, const SweepRequest& request);

/// Says once, after the first settings, how long all will take, unless that is soon.
class SweepProgress {
 public:
  /// `is_person`: how far it is is shown, too, in a line that is written anew.
  SweepProgress(std::size_t episodes, bool is_person, std::ostream& out)
      : episodes_(episodes), is_person_(is_person), out_(out) {}
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  /// Settings, each on one episode.
  void Tell(std::size_t done, std::size_t all);

 private:
  using Clock = std::chrono::steady_clock;
  struct Counted {
    Clock::time_point at;
    std::size_t done = 0;
  };

  const std::size_t episodes_;
  const bool is_person_;
  std::ostream& out_;
  const Clock::time_point start_ = Clock::now();
  std::optional<Counted> first_;
  bool said_ = false;
};

// How far each parameter of a grammar may be from its value before the score drops.

/// One parameter, while the others keep their values.
struct Margin {
  std::string parameter, value;
  double f1 = 0;         ///< with its value
  std::string from, to;  ///< the range around the value in which F1 is within the distance of the
                         ///< best; empty: the value is not in such a range
  bool open_below = false, open_above = false;  ///< it holds as far as was tried
  double best = 0;
  std::string best_at;
  bool has_effect = false;  ///< some value that was tried has another F1
  bool near_edge = false;   ///< the next value that was tried, a fifth away, is out of the range
};

struct Margins {
  std::vector<Margin> margins;       ///< those with the smallest range first
  std::vector<std::string> without;  ///< parameters that are zero, and were not tried
  SweepResult sweep;                 ///< its episodes, and what was left out
};

/// Tries an eighth to eight times of each value, in steps of 19 or 41 percent. `within` is a share
/// of F1; `only` these parameters, all if there are none. `request.axes` is not used. `so_far` is
/// called with the result as it is after each parameter, of scenarios after sixteen.
Result<Margins> FindMargins(const std::vector<episode::Take>& takes, SweepRequest request,
                            double within, const std::vector<std::string>& only = {},
                            const std::function<void(const Margins&)>& so_far = {});

std::string MarginsText(const Margins& margins, double within);
std::string MarginsCsv(const Margins& margins);

// Where a sweep is good and stays good, as text, CSV and a heat map. Tested by
// tests/harness/measure/sweep/robust_settings_test.cc

/// The settings whose score is within a distance of the best, and that hang together with the
/// chosen one: of all such settings the one that is farthest, in steps, from any worse one and from
/// what was not tried, which may be worse, too; of equals the one that is so along each axis alone,
/// the nearest first, and so in the middle; then the best, then the first. Without members if no
/// setting has a score above 0.
struct RobustSettings {
  double best = 0;
  std::size_t chosen = 0;            ///< index of a point
  std::size_t steps = 0;             ///< how many steps away the nearest worse one is
  std::vector<std::size_t> members;  ///< indices of points, rising
};
RobustSettings FindRobustSettings(const std::vector<Axis>& axes,
                                  const std::vector<SweepPoint>& points, double within);

std::string CsvText(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points);

/// What it says about the best region, for people.
std::string RobustSettingsText(const std::vector<Axis>& axes, const SweepResult& result,
                               double within);

/// The score over one or two axes as SVG; of more axes the others are as in the chosen setting.
std::string HeatMapSvg(const std::vector<Axis>& axes, const std::vector<SweepPoint>& points,
                       const RobustSettings& robust);

}  // namespace prehend::measure
