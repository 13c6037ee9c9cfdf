// SPDX-License-Identifier: Apache-2.0
// docs/claims.md says what the shipped grammars make of the scenarios that prove the claims. Every
// row of its tables is played here: what it says must be what comes out, ours must be what truly
// happened, and where the page says that the authors' rules fail, they must. A row is
//   | claim | `skill/scenario` | `event(role, ..)` | ours | original_2020 |
// with intervals in seconds, "1.10-2.25, 3.00-4.10", "none", or "the same" for what ours says, to a
// frame or two.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "harness/base/base/text_file.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/oracle/oracle.h"
#include "harness/truth/timeline/match_events.h"
#include "tests/harness/suite/judge/played_scenario.h"

namespace prehend::suite {
namespace {

struct Row {
  std::string claim, scenario, event, ours, original;
};

std::string WithoutBlanksAndQuotes(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of(" `"), last = cell.find_last_not_of(" `");
  return first == std::string::npos ? "" : cell.substr(first, last - first + 1);
}

/// The rows whose second cell is the name of a scenario.
std::vector<Row> Rows() {
  const Result<std::string> page =
      ReadTextFile(std::string(PREHEND_SOURCE_DIR) + "/docs/claims.md");
  EXPECT_TRUE(page);
  std::vector<Row> rows;
  std::istringstream lines(page.value_or(""));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, '|');)
      cells.push_back(WithoutBlanksAndQuotes(cell));
    if (cells.size() == 6 && cells[2].find('/') != std::string::npos)
      rows.push_back({cells[1], cells[2], cells[3], cells[4], cells[5]});
  }
  return rows;
}

/// The timeline's events with this label.
grammar::Timeline Only(const grammar::Timeline& timeline, const std::string& label) {
  grammar::Timeline only{timeline.ticks_per_second, {}};
  for (const grammar::NamedEvent& event : timeline.events)
    if (event.Label() == label) only.events.push_back(event);
  return only;
}

std::string Intervals(const grammar::Timeline& timeline) {
  std::string text;
  const auto per_s = static_cast<double>(timeline.ticks_per_second);
  for (const grammar::NamedEvent& event : timeline.events) {
    char interval[64];
    std::snprintf(interval, sizeof interval, "%.2f-%.2f",
                  static_cast<double>(event.interval.begin) / per_s,
                  static_cast<double>(event.interval.end) / per_s);
    text += (text.empty() ? "" : ", ") + std::string(interval);
  }
  return text.empty() ? "none" : text;
}

/// Whether docs/truth.md has a row for this event of the scenario.
bool IsExplained(const std::string& scenario, const std::string& label) {
  static const std::string page = ReadTextFile(PREHEND_SOURCE_DIR "/docs/truth.md").value();
  const std::size_t row = page.find("| `" + scenario + "` | ");
  if (row == std::string::npos) return false;
  const std::string line = page.substr(row, page.find('\n', row) - row);
  return line.find("`" + label.substr(0, label.find('(')) + "`") != std::string::npos;
}

TEST(Claims, AreWhatComesOutOfTheScenarios) {
  const std::vector<Row> rows = Rows();
  ASSERT_GE(rows.size(), 25u);
  const auto original = episode::LoadGrammar(PREHEND_SOURCE_DIR, "original_2020").program;
  ASSERT_TRUE(original);
  std::map<std::string, PlayedScenario> played;
  for (const Row& row : rows) {
    SCOPED_TRACE(row.claim + ", " + row.scenario + ", " + row.event);
    if (!played.contains(row.scenario)) played.emplace(row.scenario, Play(row.scenario));
    const PlayedScenario& play = played.at(row.scenario);
    const grammar::Tick tolerance = scenario::DefaultTolerance(play.scenario);
    std::vector<grammar::Timeline> possible;
    for (const grammar::Timeline& truth :
         truth::PossibleTimelines(play.scenario.scene, play.run.recording, play.end()))
      possible.push_back(Only(truth, row.event));
    const grammar::Timeline ours = Only(play.run.timeline, row.event);
    const grammar::Timeline theirs = Only(play.WatchedBy(original), row.event);
    const std::string differs =
        truth::DescribeDisagreement(truth::AgreeWithin(possible, ours, tolerance), tolerance);
    EXPECT_EQ(!differs.empty(), IsExplained(row.scenario, row.event)) << differs;
    EXPECT_EQ(row.ours, Intervals(ours));
    const bool same = truth::Agree(ours, theirs, tolerance).Within(tolerance);
    EXPECT_EQ(row.original, same ? "the same" : Intervals(theirs));
  }
}

}  // namespace
}  // namespace prehend::suite
