// SPDX-License-Identifier: Apache-2.0
// The examples of docs/grammar-language.md: each is a whole grammar, and recognises in the drawing
// below it what it says.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/check_laws.h"
#include "tests/grammar/corpus.h"

namespace prehend::grammar::testing {
namespace {

// Texts between ``` and ```.
std::vector<std::string> Blocks(const std::string& docs) {
  std::vector<std::string> blocks;
  std::size_t at = 0;
  for (std::size_t open; (open = docs.find("```\n", at)) != std::string::npos;) {
    const std::size_t begin = open + 4;
    const std::size_t end = docs.find("```", begin);
    if (end == std::string::npos) break;
    blocks.push_back(docs.substr(begin, end - begin));
    at = end + 3;
  }
  return blocks;
}

std::vector<Row> Sorted(std::vector<Row> rows) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.name < b.name; });
  return rows;
}

// A row "violated NAME" per law that is broken, drawn where it is.
std::vector<Row> DrawViolations(const CorpusCase& drawn, const Program& program,
                                const Timeline& timeline) {
  const EntityTable entity_table{.ticks_per_second = kCorpusTicksPerSecond,
                                 .entities = drawn.entity_table};
  Timeline violations{.ticks_per_second = kCorpusTicksPerSecond};
  for (const LawViolation& violation : CheckLaws(program, entity_table, timeline))
    violations.events.push_back(
        {.event = "violated " + violation.law->name, .interval = violation.when});
  std::vector<Row> rows = DrawEvents(drawn, violations);
  for (Row& row : rows) row.name.resize(row.name.size() - 2);  // it has no roles: "()"
  return rows;
}

TEST(Docs, EveryExampleRecognisesWhatIsDrawnBelowIt) {
  const std::vector<std::string> blocks =
      Blocks(ReadFile(PREHEND_SOURCE_DIR "/docs/grammar-language.md"));
  int examples = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!blocks[i].starts_with("grammar ")) continue;
    const CompileResult compiled = Compile({"docs", blocks[i]}, LibraryIncluder());
    ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
    EXPECT_EQ(Format(compiled.warnings), "");
    ASSERT_TRUE(i + 1 < blocks.size() && blocks[i + 1].starts_with("entities "))
        << "nothing is drawn below\n"
        << blocks[i];
    const CorpusCase drawn = ReadCorpusText("docs", "== example\n" + blocks[i + 1]).front();
    const CorpusRun run = RunCase(drawn, compiled.program);
    EXPECT_EQ(run.error, "");
    EXPECT_FALSE(run.timeline.events.empty());
    std::vector<Row> rows = DrawEvents(drawn, run.timeline);
    for (Row& row : DrawViolations(drawn, *compiled.program, run.timeline))
      rows.push_back(std::move(row));
    EXPECT_EQ(Text(Sorted(drawn.expected)), Text(Sorted(std::move(rows)))) << blocks[i];
    ++examples;
  }
  EXPECT_GE(examples, 13);
}

}  // namespace
}  // namespace prehend::grammar::testing
