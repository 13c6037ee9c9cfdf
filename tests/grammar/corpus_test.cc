// SPDX-License-Identifier: Apache-2.0
// Every case of every file in tests/grammar/corpus/, regular and as drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/grammar/corpus.h"

namespace prehend::grammar::testing {
namespace {

std::vector<std::string> CorpusFiles() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(PREHEND_SOURCE_DIR "/tests/grammar/corpus")) {
    if (entry.path().extension() == ".txt") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Row> Sorted(std::vector<Row> rows) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

TEST(Corpus, EveryCaseGivesItsEvents) {
  std::size_t count = 0;
  for (const std::string& file : CorpusFiles()) {
    for (const CorpusCase& corpus_case : ReadCorpus(file)) {
      SCOPED_TRACE(file + ":" + std::to_string(corpus_case.line) + " " + corpus_case.title);
      const CorpusRun run = RunCase(corpus_case);
      EXPECT_EQ(run.error, "");
      EXPECT_EQ(Text(Sorted(corpus_case.expected)), Text(Sorted(DrawEvents(corpus_case, run.timeline))));
      ++count;
    }
  }
  EXPECT_GE(count, 1u);
}

}  // namespace
}  // namespace prehend::grammar::testing
