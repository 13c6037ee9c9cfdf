// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "harness/show/figures/figures.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::NamedEvent;
using grammar::Tick;

constexpr std::size_t kAgreedMoments = 4;
constexpr double kAround_s = 0.15;  ///< what happens so long before and after is in the view

class Differ {
 public:
  Differ(const truth::Comparison& comparison, const Window& window,
         const scenario::Scenario& scenario)
      : comparison_(comparison), window_(window), scenario_(scenario) {}

  /// In the order of time. Boundaries that are at one time for both sides are one difference.
  std::vector<BoundaryDifference> Differences() const {
    std::vector<BoundaryDifference> differences;
    for (const truth::Pairing* pairing : comparison_.Differing()) {
      if (!window_.Shows(scenario_, pairing->event())) continue;
      for (BoundaryDifference& difference : BoundaryDifferencesOf(*pairing)) {
        if (difference.Begin_s() < window_.from_s || difference.Begin_s() > window_.to_s) continue;
        const auto twin = std::ranges::find_if(differences, [&](const BoundaryDifference& other) {
          return difference.IsAtTheTimesOf(other);
        });
        if (twin == differences.end())
          differences.push_back(std::move(difference));
        else
          twin->boundary += ", " + difference.boundary;
      }
    }
    std::ranges::stable_sort(differences, {}, &BoundaryDifference::Begin_s);
    return differences;
  }

  /// Marks in the charts of both sides where they differ.
  void HatchRows(Chart& first, Chart& second) const {
    for (const truth::Pairing& pairing : comparison_.pairings) {
      if (pairing.agreement == truth::LineVerdict::kMatched) continue;
      const auto& [expected, actual] = std::pair(pairing.expected, pairing.actual);
      if (!expected || !actual) {
        HatchBar(expected ? first : second, pairing.event(), Whole(pairing.event()));
        continue;
      }
      std::vector<Hatch> hatches;
      if (IsOut(pairing, pairing.begin_offset))
        hatches.push_back(Between(expected->interval.begin, actual->interval.begin));
      if (IsOut(pairing, pairing.end_offset))
        hatches.push_back(Between(expected->interval.end, actual->interval.end));
      if (hatches.empty()) hatches.push_back(Whole(*actual));  // other roles, another event
      for (const Hatch& hatch : hatches) {
        HatchBar(first, *expected, hatch);
        HatchBar(second, *actual, hatch);
      }
    }
  }

 private:
  double Seconds(Tick tick) const { return truth::SecondsOf(tick, comparison_.ticks_per_second); }
  static bool IsOut(const truth::Pairing& pairing, Tick offset) {
    return std::abs(offset) > pairing.tolerance;
  }
  Hatch Between(Tick a, Tick b) const {
    return {.begin_s = Seconds(std::min(a, b)), .end_s = Seconds(std::max(a, b))};
  }
  Hatch Whole(const NamedEvent& event) const {
    return {.begin_s = Seconds(event.interval.begin), .end_s = Seconds(event.interval.end)};
  }

  void HatchBar(Chart& chart, const NamedEvent& event, const Hatch& hatch) const {
    const double begin_s = Seconds(event.interval.begin);
    const std::string label = event.Label();
    for (Row& row : chart.rows) {
      for (const Bar& bar : row.bars) {
        if (bar.tip != label || std::abs(bar.begin_s - begin_s) > 1e-6) continue;
        row.hatches.push_back(hatch);
        return;
      }
    }
  }

  static std::vector<std::string> Involved(const truth::Pairing& pairing) {
    std::vector<std::string> names;
    for (const grammar::Role& role : pairing.event().roles) names.push_back(role.value);
    return names;
  }

  std::vector<BoundaryDifference> BoundaryDifferencesOf(const truth::Pairing& pairing) const {
    const std::string label = pairing.event().Label();
    if (!pairing.expected || !pairing.actual) {
      const bool has = pairing.expected.has_value();
      const Hatch whole = Whole(pairing.event());
      return {{.boundary = label,
               .how = fmt::format("{:.2f} to {:.2f} s", whole.begin_s, whole.end_s),
               .involved = Involved(pairing),
               .first_s = whole.begin_s,
               .second_s = whole.begin_s,
               .end_s = whole.end_s,
               .first_has = has,
               .second_has = !has}};
    }
    std::vector<BoundaryDifference> differences;
    const std::string changes = fmt::format("{}", fmt::join(pairing.changes, ", "));
    const auto add = [&](const char* boundary, Tick offset, Tick first, Tick second) {
      if (!IsOut(pairing, offset)) return;
      const double off_ms = truth::MillisecondsOf(offset, comparison_.ticks_per_second);
      differences.push_back({.boundary = fmt::format("{} of {}", boundary, label),
                             .how = fmt::format("{:.1f} ms {}{}{}", std::abs(off_ms),
                                                off_ms > 0 ? "later" : "earlier",
                                                changes.empty() ? "" : ", ", changes),
                             .involved = Involved(pairing),
                             .first_s = Seconds(first),
                             .second_s = Seconds(second)});
    };
    add("begin", pairing.begin_offset, pairing.expected->interval.begin,
        pairing.actual->interval.begin);
    add("end", pairing.end_offset, pairing.expected->interval.end, pairing.actual->interval.end);
    if (differences.empty()) {
      const double begin_s = Seconds(pairing.actual->interval.begin);
      differences.push_back(
          {.boundary = label,
           .how = changes.empty() ? std::string(truth::Name(pairing.agreement)) : changes,
           .involved = Involved(pairing),
           .first_s = begin_s,
           .second_s = begin_s});
    }
    return differences;
  }

  const truth::Comparison& comparison_;
  const Window& window_;
  const scenario::Scenario& scenario_;
};

/// Draws the scenes of both sides beside each other.
class SceneRows {
 public:
  SceneRows(const scenario::Scenario& scenario, const Side& first, const Side& second,
            const SceneFormat& format, ScenePainter& painter)
      : scenario_(scenario),
        first_(first),
        second_(second),
        camera_(format.camera),
        format_(format),
        painter_(painter) {
    format_.picture.ghosts = format_.picture.paths = format_.picture.labels = false;
  }

  /// In each side's own scene but in one view, and what differs between them.
  TileRow BothAt(const std::string& heading, double first_s, double second_s,
                 const std::vector<std::string>& involved) {
    TileRow row{.heading = heading, .columns = 3, .height_share = kWideScene};
    format_.camera = ViewAround(std::min(first_s, second_s), std::max(first_s, second_s), involved);
    const std::string one = Draw(first_, first_s, row), other = Draw(second_, second_s, row);
    const SceneDifference difference = DifferenceOf(one, other);
    row.tiles.push_back(
        {.png = difference.png,
         .caption = fmt::format("difference: {:.2g} % of the pixels", 100 * difference.share)});
    return row;
  }

  /// Adds the scene in which an event begins that only one side has.
  void AddOnlyOf(const std::string& caption, const Side& side, double time_s,
                 const std::vector<std::string>& involved, TileRow& row) {
    format_.camera = ViewAround(time_s, time_s, involved);
    AddScene(scenario_, *side.scenes, time_s, caption, format_, painter_, row);
  }

 private:
  /// Near to what happens then; as of the first side, whose scenes may be another engine's.
  std::string ViewAround(double from_s, double to_s,
                         const std::vector<std::string>& involved) const {
    SceneFormat around = format_;
    around.camera = camera_;
    around.picture.framed_from_s = from_s - kAround_s;
    around.picture.framed_to_s = to_s + kAround_s;
    around.picture.framed = involved;
    return WideView(scenario_, *first_.scenes, from_s, around);
  }

  std::string Draw(const Side& side, double time_s, TileRow& row) {
    return AddScene(scenario_, *side.scenes, time_s, fmt::format("{}: {:.4f} s", side.name, time_s),
                    format_, painter_, row);
  }

  const scenario::Scenario& scenario_;
  const Side& first_;
  const Side& second_;
  std::string camera_;  ///< that was asked for
  SceneFormat format_;
  ScenePainter& painter_;
};

/// What is one row in both, and not hatched, is shown once.
Chart WithoutTwins(Chart chart, const std::string& first, const std::string& second) {
  const auto name_of = [](const Row& row, const std::string& whose) {
    const std::string ending = " (" + whose + ")";
    return row.name.ends_with(ending) ? row.name.substr(0, row.name.size() - ending.size())
                                      : std::string();
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    Row row = chart.rows[i];
    const std::string name = name_of(row, first);
    const Row* twin = i + 1 < chart.rows.size() ? &chart.rows[i + 1] : nullptr;
    const bool same = twin && !name.empty() && name_of(*twin, second) == name &&
                      row.hatches.empty() && twin->hatches.empty() &&
                      row.bars.size() == twin->bars.size();
    if (same) {
      row.name = name;
      ++i;
    }
    rows.push_back(std::move(row));
  }
  chart.rows = std::move(rows);
  return chart;
}

std::string AgreementText(const truth::Comparison& comparison) {
  double most = 0;
  for (const truth::Pairing& pairing : comparison.pairings)
    most = std::max(most, pairing.tolerance);
  return fmt::format(
      "Both agree: no boundary is off by more than its tolerance, at most {:.1f} ms.",
      truth::MillisecondsOf(most, comparison.ticks_per_second));
}

}  // namespace

std::vector<BoundaryDifference> BoundaryDifferences(const truth::Comparison& comparison,
                                                    const Window& window,
                                                    const scenario::Scenario& scenario) {
  return Differ(comparison, window, scenario).Differences();
}

Chart ComparisonChart(const scenario::Scenario& scenario, const Side& first, const Side& second,
                      const truth::Comparison& comparison, const Window& window) {
  Chart of_first = PhasesChart(scenario, *first.events, window),
        of_second = PhasesChart(scenario, *second.events, window);
  Differ(comparison, window, scenario).HatchRows(of_first, of_second);
  Chart chart = SideBySide(std::move(of_first), first.name, of_second, second.name);
  chart.title = fmt::format("{}: {} and {}", scenario.name, first.name, second.name);
  return chart;
}

Sheet ComparisonSheet(const scenario::Scenario& scenario, const Side& first, const Side& second,
                      const truth::Comparison& comparison, const Window& window,
                      const SceneFormat& format, ScenePainter& painter) {
  Sheet sheet{.chart_first = true};
  Chart chart = WithoutTwins(ComparisonChart(scenario, first, second, comparison, window),
                             first.name, second.name);
  const std::vector<BoundaryDifference> differences =
      BoundaryDifferences(comparison, window, scenario);
  SceneRows scenes(scenario, first, second, format, painter);
  std::size_t number = 0;
  const auto mark = [&](double time_s) {
    chart.marks.push_back({.time_s = time_s, .letter = LetterOf(number)});
    return fmt::format("({}) ", LetterOf(number++));
  };
  TileRow only{.heading = "Only one side has:", .columns = 3, .height_share = kWideScene};
  for (const BoundaryDifference& difference : differences) {
    if (number == kMostDifferences) break;
    const std::string letter = mark(difference.Begin_s());
    if (difference.HaveBoth()) {
      sheet.rows.push_back(
          scenes.BothAt(fmt::format("{}{}: {}", letter, difference.boundary, difference.how),
                        difference.first_s, difference.second_s, difference.involved));
      continue;
    }
    const Side& has = difference.first_has ? first : second;
    scenes.AddOnlyOf(
        fmt::format("{}{}\nonly in {}: {}", letter, difference.boundary, has.name, difference.how),
        has, difference.first_s, difference.involved, only);
  }
  if (!only.tiles.empty()) sheet.rows.push_back(std::move(only));
  if (differences.size() > kMostDifferences)
    sheet.note = fmt::format(
        "{} more differences have no scenes here; --from, --to, --hand and --of choose a part",
        differences.size() - kMostDifferences);
  if (differences.empty()) sheet.note = AgreementText(comparison);
  if (differences.empty() && first.scenes != second.scenes) {
    for (const KeyMoment& moment : KeyMoments(*second.events, window, kAgreedMoments))
      sheet.rows.push_back(scenes.BothAt(mark(moment.time_s) + moment.caption, moment.time_s,
                                         moment.time_s, moment.involved));
  }
  sheet.chart = std::move(chart);
  return sheet;
}

Sheet GoldenPicturesSheet(const std::string& id, const scenario::Scenario& scenario,
                          const episode::RunResult& run,
                          const std::vector<truth::KeptPicture>& goldens, ScenePainter& painter) {
  Sheet sheet{.title = id + ": golden pictures and those of now"};
  for (const truth::KeptPicture& golden : goldens) {
    const auto index = static_cast<std::size_t>(golden.number) - 1;
    if (index >= scenario.pictures.size()) continue;
    std::ifstream file(golden.path, std::ios::binary);
    const std::string kept{std::istreambuf_iterator<char>(file), {}};
    const scenario::PictureYaml& entry = scenario.pictures[index];
    const DrawnScene now = painter.Draw(scenario, run, entry, kGoldenFormat);
    const SceneDifference difference = DifferenceOf(kept, now.png);
    sheet.rows.push_back(
        {.heading = fmt::format("picture {}: {}", golden.number, entry.at.value),
         .tiles = {{kept, "golden"},
                   {now.png, "now"},
                   {difference.png,
                    fmt::format("difference: {:.2g} % of the pixels", 100 * difference.share)}},
         .columns = 3,
         .height_share = 9.0 / 16});
  }
  return sheet;
}

}  // namespace prehend::show
