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

}  // namespace
}  // namespace prehend::grammar::testing
