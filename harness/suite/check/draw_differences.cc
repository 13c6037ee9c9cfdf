// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "harness/show/figures/figures.h"
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
  std::optional<DrawnDifference> Draw(const show::BoundaryDifference& difference,
                                      std::size_t number) const {
    const auto [first_s, last_s] = std::minmax(difference.first_s, difference.second_s);
    const bool is_of_both = difference.HaveBoth();
    show::PictureFormat format{.width_px = 480,
                               .height_px = 270,
                               .framed = difference.involved,
                               .framed_from_s = first_s - kAround_s,
                               .framed_to_s = last_s + kAround_s,
                               .title = false,
                               .labels = false,
                               .strip = false,
                               .ghosts = false,
                               .paths = false};
    // Both in one view, and so from the same snapshots.
    std::optional<episode::RunResult> told;
    if (!is_of_both) {
      format.paths = true;
      const double end_s = std::min(difference.end_s, first_s + kMostShown_s);
      format.framed_to_s = end_s + kAround_s;
      format.from_s = std::max(0.0, first_s - kPathsAround_s);
      format.to_s = end_s + kPathsAround_s;
      told = Thinned(run_, truth::TickAt(first_s, comparison_.ticks_per_second));
    }
    DrawnDifference moment{.what = difference.boundary,
                           .in_golden = difference.first_has,
                           .in_run = difference.second_has};
    bool is_drawn = true;
    const auto draw = [&](const episode::RunResult& run, const char* side, double at_s, bool has) {
      scenario::PictureYaml entry;
      entry.at.value = fmt::format("{:.6f}", at_s);
      entry.camera.value = "action";
      const std::string file =
          fmt::format("pictures/{}/{}.{}{}.png", scenario_.skill, scenario_.name, side, number);
      const show::PictureResult result =
          show::DrawPicture(scenario_, run, entry, (report_folder_ / file).string(), format);
      is_drawn = is_drawn && result.error.empty();
      return ReportedPicture{
          file, fmt::format("{}: {:.4f} s{}", side, at_s, has ? "" : ", no such event")};
    };
    if (told) told->timeline.events = GoldenEvents(comparison_);
    moment.expected = draw(told ? *told : run_, "golden", difference.first_s, moment.in_golden);
    if (told) told->timeline.events = run_.timeline.events;
    moment.recognised = draw(told ? *told : run_, "recognised", difference.second_s, moment.in_run);
    return is_drawn ? std::optional(std::move(moment)) : std::nullopt;
  }

 private:
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
  for (const auto& difference :
       show::BoundaryDifferences(comparison, show::WholeOf(run), scenario)) {
    // At one time there is one picture.
    if (difference.HaveBoth() && difference.first_s == difference.second_s) continue;
    std::optional<DrawnDifference> moment = painter.Draw(difference, moments.size() + 1);
    if (!moment) return {};
    moments.push_back(std::move(*moment));
    if (moments.size() == kMostDrawnDifferences) break;
  }
  return moments;
}

}  // namespace prehend::suite
