// SPDX-License-Identifier: Apache-2.0
// Every case of every file in tests/grammar/corpus/, regular and as drawn.
#include "tests/grammar/corpus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace prehend::grammar::testing {
namespace {

std::vector<std::string> CorpusFiles() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(PREHEND_SOURCE_DIR "/tests/grammar/corpus")) {
    if (entry.path().extension() == ".txt") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Row> Sorted(std::vector<Row> rows) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

// Begin and end of each event of a row, in seconds.
using Times = std::multimap<std::string, std::pair<double, double>>;

Times TimesOf(const std::vector<Row>& rows) {
  constexpr double kColumn_s = 1.0 * kCorpusColumnTicks / kCorpusTicksPerSecond;
  Times times;
  for (const Row& row : rows) {
    for (std::size_t begin = row.cells.find('['); begin != std::string::npos;
         begin = row.cells.find('[', begin + 1)) {
      const std::size_t end =
          std::min(row.cells.find_first_not_of('=', begin + 1), row.cells.size());
      times.emplace(row.name, std::pair(kColumn_s * static_cast<double>(begin),
                                        kColumn_s * static_cast<double>(end)));
    }
  }
  return times;
}

Times TimesOf(const Timeline& timeline, const Times& wanted) {
  Times times;
  for (const NamedEvent& event : timeline.events) {
    if (event.event == "contact" || event.event == "supported_by") continue;
    times.emplace(event.Label(), std::pair(1.0 * event.interval.begin / kCorpusTicksPerSecond,
                                           1.0 * event.interval.end / kCorpusTicksPerSecond));
  }
  EXPECT_EQ(times.size(), wanted.size());
  return times;
}

// However often one looks, an event is where it is drawn: half a column is lost by drawing, and two
// frames because a window of time begins and ends with a frame.
TEST(Corpus, FramesPerSecondDoNotMatter) {
  int count = 0;
  for (const std::string& file : CorpusFiles()) {
    for (const CorpusCase& corpus_case : ReadCorpus(file)) {
      const Times expected = TimesOf(corpus_case.expected);
      for (const int rate : corpus_case.rates) {
        SCOPED_TRACE(corpus_case.title + " at " + std::to_string(rate) + " Hz");
        const Times found = TimesOf(RunCase(corpus_case, rate).timeline, expected);
        ++count;
        for (auto e = expected.begin(), f = found.begin(); e != expected.end() && f != found.end();
             ++e, ++f) {
          EXPECT_EQ(e->first, f->first);
          EXPECT_NEAR(e->second.first, f->second.first, 0.025 + 2.0 / rate)
              << e->first << " begins";
          EXPECT_NEAR(e->second.second, f->second.second, 0.025 + 2.0 / rate)
              << e->first << " ends";
        }
      }
    }
  }
  EXPECT_GE(count, 5);
}

TEST(Corpus, EveryCaseGivesItsEvents) {
  std::size_t count = 0;
  for (const std::string& file : CorpusFiles()) {
    for (const CorpusCase& corpus_case : ReadCorpus(file)) {
      SCOPED_TRACE(file + ":" + std::to_string(corpus_case.line) + " " + corpus_case.title);
      const CorpusRun run = RunCase(corpus_case);
      EXPECT_EQ(run.error, "");
      EXPECT_EQ(Text(Sorted(corpus_case.expected)),
                Text(Sorted(DrawEvents(corpus_case, run.timeline, {"contact", "supported_by"}))));
      ++count;
    }
  }
  EXPECT_GE(count, 1u);
}

// A column lasts 50 ms, so a touch of two columns is a brush where 160 ms are none.
TEST(Corpus, ABrushOnTheWayEndsNoApproach) {
  const std::string scene =
      "hand x                      |0123456789abcdefghijklmnopqrstuvvvvvvvvv|\n"
      "cup x                       |vvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvvv|\n"
      "cup on table                |########################################|\n"
      "hand grip                   |................................########|\n";
  struct Case {
    std::string touches, reach, grasp;
    std::string going_to = "";  ///< to the grasp; if it differs
  };
  const std::vector<Case> cases = {
      // The brush is over, for more than 100 ms, when the hand takes the cup.
      {"|......................11.........2222222|", "|[================================.......|",
       "|.................................[======|"},
      // A longer touch is none: the approach begins after it.
      {"|....................1111.........2222222|", "|........................[========.......|",
       "|.................................[======|"},
      // What grasps in so short a touch does not brush, be it at once or later.
      {"|.................................22.....|", "|[================================.......|",
       "|.................................[=.....|"},
      {"|................................12......|", "|[===============================........|",
       "|.................................[......|", "|[================================.......|"},
  };
  for (const auto& [grammar, reach, brush] :
       {std::tuple{"pick_and_place", "reaching", "reach_brush"},
        std::tuple{"hand_actions", "going_to", "act_brush"}}) {
    const auto program = CompileLibrary(grammar, {{brush, "160 ms"}});
    for (const Case& of : cases) {
      SCOPED_TRACE(grammar + of.touches);
      const CorpusCase drawn =
          ReadCorpusText("brush",
                         "== a brush\n" + scene + "hand holds cup              " + of.touches +
                             "\n--\n" + reach + "(hand, cup) " +
                             (reach[0] == 'g' && !of.going_to.empty() ? of.going_to : of.reach) +
                             "\ngrasping(hand, cup) " + of.grasp + "\n")
              .at(0);
      std::vector<Row> found;
      for (const Row& row : DrawEvents(drawn, RunCase(drawn, program).timeline, {}))
        if (row.name.starts_with(reach) || row.name.starts_with("grasping")) found.push_back(row);
      EXPECT_EQ(Text(Sorted(drawn.expected)), Text(Sorted(found)));
    }
  }
}

}  // namespace
}  // namespace prehend::grammar::testing
