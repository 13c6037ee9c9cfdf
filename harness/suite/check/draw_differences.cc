// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "harness/show/pictures/pictures.h"
#include "harness/suite/check/check_scenario.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;
using grammar::Tick;

/// What happens so long before and after is in the view.
constexpr double kAround_s = 0.15;
/// Paths of what hands do around an event that only one side has.
constexpr double kPathsAround_s = 1;
/// Of a longer event only its begin is in the view.
constexpr double kMostShown_s = 2;
/// Snapshots of a copied run; pictures need no more.
constexpr double kSnapshots_per_s = 60;

/// A boundary at two times, or the begin of an event that only one side has.
struct BoundaryDifference {
  std::string what;
  Tick expected = 0, recognised = 0;
  Tick end = 0;                       ///< of an event that only one side has
  std::vector<std::string> involved;  ///< hands and things of the event
  bool in_golden = true, in_run = true;

  bool IsOneSided() const { return !in_golden || !in_run; }
};

std::optional<BoundaryDifference> BoundaryDifferenceOf(const truth::Pairing& pairing) {
  BoundaryDifference difference;
  for (const grammar::Role& role : pairing.event().roles) difference.involved.push_back(role.value);
  const std::string label = pairing.event().Label();
  if (!pairing.expected || !pairing.actual) {
    difference.what = label;
    difference.expected = difference.recognised = pairing.event().interval.begin;
    difference.end = pairing.event().interval.end;
    difference.in_golden = pairing.expected.has_value();
    difference.in_run = pairing.actual.has_value();
    return difference;
  }
  const bool at_begin = std::abs(pairing.begin_offset) > pairing.tolerance;
  if (!at_begin && std::abs(pairing.end_offset) <= pairing.tolerance) return std::nullopt;
  const auto boundary = [&](const grammar::NamedEvent& event) {
    return at_begin ? event.interval.begin : event.interval.end;
  };
  difference.what = (at_begin ? "begin of " : "end of ") + label;
  difference.expected = boundary(*pairing.expected);
  difference.recognised = boundary(*pairing.actual);
  return difference;
}

/// The first ones; several events may share a boundary.
std::vector<BoundaryDifference> BoundaryDifferencesOf(const truth::Comparison& comparison) {
  std::vector<BoundaryDifference> differences;
  std::set<std::tuple<Tick, Tick, bool>> seen;
  for (const truth::Pairing* pairing : comparison.Differing()) {
    if (differences.size() == kMostDrawnDifferences) break;
    std::optional<BoundaryDifference> difference = BoundaryDifferenceOf(*pairing);
    if (!difference) continue;
    const auto [first, last] = std::minmax(difference->expected, difference->recognised);
    if (seen.emplace(first, last, difference->IsOneSided()).second)
      differences.push_back(std::move(*difference));
  }
  return differences;
}

/// The run with fewer snapshots; that at `kept` is among them.
episode::RunResult Thinned(const episode::RunResult& run, Tick kept) {
  episode::RunResult thin;
  thin.status = run.status;
  thin.ticks = run.ticks;
  thin.timeline = run.timeline;
  thin.drawings = run.drawings;
  const auto step = std::max<Tick>(
      1, static_cast<Tick>(static_cast<double>(run.timeline.ticks_per_second) / kSnapshots_per_s));
  for (const physics::Snapshot& snapshot : run.recording) {
    if (snapshot.tick % step == 0 || snapshot.tick == kept || &snapshot == &run.recording.back())
      thin.recording.push_back(snapshot);
  }
  return thin;
}

std::vector<grammar::NamedEvent> GoldenEvents(const truth::Comparison& comparison) {
  std::vector<grammar::NamedEvent> events;
  for (const truth::Pairing& pairing : comparison.pairings)
    if (pairing.expected) events.push_back(*pairing.expected);
  std::ranges::stable_sort(events, {},
                           [](const grammar::NamedEvent& event) { return event.interval.begin; });
  return events;
}

class DifferencePainter {
 public:
  DifferencePainter(const scenario::Scenario& scenario, const episode::RunResult& run,
                    const truth::Comparison& comparison, fs::path report_folder)
      : scenario_(scenario),
        run_(run),
        comparison_(comparison),
        report_folder_(std::move(report_folder)) {}

  /// nullopt if it cannot be drawn.
  std::optional<DrawnDifference> Draw(const BoundaryDifference& difference,
                                      std::size_t number) const {
    const auto [first, last] = std::minmax(difference.expected, difference.recognised);
    show::PictureFormat format{.width_px = 480,
                               .height_px = 270,
                               .framed = difference.involved,
                               .framed_from_s = Seconds(first) - kAround_s,
                               .framed_to_s = Seconds(last) + kAround_s,
                               .title = false,
                               .labels = false,
                               .strip = false,
                               .ghosts = false,
                               .paths = false};
    if (difference.IsOneSided()) {
      format.paths = true;
      const double end_s = std::min(Seconds(difference.end), Seconds(first) + kMostShown_s);
      format.framed_to_s = end_s + kAround_s;
      format.from_s = std::max(0.0, Seconds(first) - kPathsAround_s);
      format.to_s = end_s + kPathsAround_s;
    }
    // Both in one view, and so from the same snapshots.
    std::optional<episode::RunResult> told;
    if (difference.IsOneSided()) told = Thinned(run_, first);
    DrawnDifference moment{
        .what = difference.what, .in_golden = difference.in_golden, .in_run = difference.in_run};
    bool is_drawn = true;
    const auto draw = [&](const episode::RunResult& run, const char* side, Tick tick, bool has) {
      scenario::PictureYaml entry;
      entry.at.value = fmt::format("{:.6f}", Seconds(tick));
      entry.camera.value = "action";
      const std::string file =
          fmt::format("pictures/{}/{}.{}{}.png", scenario_.skill, scenario_.name, side, number);
      const show::PictureResult result =
          show::DrawPicture(scenario_, run, entry, (report_folder_ / file).string(), format);
      is_drawn = is_drawn && result.error.empty();
      return ReportedPicture{
          file, fmt::format("{}: {:.4f} s{}", side, Seconds(tick), has ? "" : ", no such event")};
    };
    if (told) told->timeline.events = GoldenEvents(comparison_);
    moment.expected =
        draw(told ? *told : run_, "golden", difference.expected, difference.in_golden);
    if (told) told->timeline.events = run_.timeline.events;
    moment.recognised =
        draw(told ? *told : run_, "recognised", difference.recognised, difference.in_run);
    return is_drawn ? std::optional(std::move(moment)) : std::nullopt;
  }

 private:
  double Seconds(Tick tick) const { return truth::SecondsOf(tick, comparison_.ticks_per_second); }

  const scenario::Scenario& scenario_;
  const episode::RunResult& run_;
  const truth::Comparison& comparison_;
  const fs::path report_folder_;
};

}  // namespace

std::vector<DrawnDifference> DrawDifferences(const scenario::Scenario& scenario,
                                             const episode::RunResult& run,
                                             const truth::Comparison& comparison,
                                             const std::string& report_folder) {
  std::error_code error;
  fs::create_directories(fs::path(report_folder) / "pictures" / scenario.skill, error);
  const DifferencePainter painter(scenario, run, comparison, report_folder);
  std::vector<DrawnDifference> moments;
  for (const BoundaryDifference& difference : BoundaryDifferencesOf(comparison)) {
    std::optional<DrawnDifference> moment = painter.Draw(difference, moments.size() + 1);
    if (!moment) return {};
    moments.push_back(std::move(*moment));
  }
  return moments;
}

}  // namespace prehend::suite
