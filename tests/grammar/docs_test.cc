// SPDX-License-Identifier: Apache-2.0
// The examples of the pages about the grammar language: each is a whole grammar, and recognises in
// the drawing below it what the drawing says.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/grammar/corpus.h"

namespace prehend::grammar::testing {
namespace {

// What stands between two lines that begin with ```.
std::vector<std::string> Blocks(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.emplace_back();
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

std::vector<Row> Sorted(std::vector<Row> rows) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

/// Runs the examples of a page; returns how many there are.
int RunExamples(const std::string& page) {
  const std::vector<std::string> blocks = Blocks(ReadFile(PREHEND_SOURCE_DIR "/docs/" + page));
  int examples = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!blocks[i].starts_with("grammar ")) continue;
    ++examples;
    const CompileResult compiled = Compile({page, blocks[i]}, LibraryIncluder());
    EXPECT_TRUE(compiled.program) << Format(compiled.diagnostics);
    EXPECT_EQ(Format(compiled.warnings), "");
    const bool is_drawn = i + 1 < blocks.size() && (blocks[i + 1].starts_with("entities ") ||
                                                    blocks[i + 1].starts_with("== "));
    EXPECT_TRUE(is_drawn) << "nothing is drawn below\n" << blocks[i];
    if (!compiled.program || !is_drawn) continue;
    for (const CorpusCase& drawn : ReadCorpusText(page, blocks[i + 1])) {
      const CorpusRun run = RunCase(drawn, compiled.program);
      EXPECT_EQ(run.error, "");
      EXPECT_FALSE(run.timeline.events.empty());
      std::vector<Row> rows = DrawWatched(*compiled.program, drawn, run.timeline);
      EXPECT_EQ(Text(Sorted(drawn.expected)), Text(Sorted(std::move(rows)))) << blocks[i];
    }
  }
  return examples;
}

TEST(Docs, EveryExampleRecognisesWhatIsDrawnBelowIt) {
  EXPECT_EQ(RunExamples("grammar-tutorial.md"), 30);
  EXPECT_EQ(RunExamples("cookbook.md"), 15);
  EXPECT_EQ(RunExamples("drawings.md"), 1);
  EXPECT_EQ(RunExamples("grammar-language.md"), 7);
  EXPECT_EQ(RunExamples("semantics.md"), 8);
}

}  // namespace
}  // namespace prehend::grammar::testing
