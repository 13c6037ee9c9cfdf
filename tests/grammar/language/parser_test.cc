// SPDX-License-Identifier: Apache-2.0
// The parser through its dump: fully bracketed, in SI units.
#include "grammar/language/parser.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/grammar/corpus.h"
#include "tests/grammar/language/dump_file.h"

namespace prehend::grammar {
namespace {

std::string DumpOf(const std::string& text) {
  Diagnostics diagnostics;
  const ast::File file = Parse({"t", text}, diagnostics);
  return diagnostics.empty() ? ast::Dump(file) : Format(diagnostics);
}

TEST(Parser, BindsOperatorsAsDocumented) {
  const std::pair<const char*, const char*> cases[] = {
      {"while a(x) and b(x) or not c(x)", "while ((a(x) and b(x)) or (not c(x)))"},
      {"while s(x) + 1 * 2 >= -3 cm", "while ((s(x) + (1 * 2)) >= (-0.03 m))"},
      {"while s(x) - 1 - 2 < 4", "while (((s(x) - 1) - 2) < 4)"},
      {"from not a(x) begins to a(x) begins or b(x) ends",
       "from ((not a(x)) begins) to ((a(x) begins) or (b(x) ends))"},
      {"from a(x) begins to b(x) begins during c(x) or drop",
       "from (a(x) begins) to (b(x) begins) during c(x) or drop"},
      {"from a(x) begins to b(x) begins during c(x) or drop(x) > 1 cm",
       "from (a(x) begins) to (b(x) begins) during (c(x) or (drop(x) > 0.01 m))"},
      {"until a(x) begins since near(x, p(x)@end) approaching gap(x) receding at most 5 mm, slower "
       "than 2 cm/s at most "
       "0.5 s at most 3 s back",
       "until (a(x) begins) since near(x, p(x)@end) approaching gap(x) receding at most 0.005 m, "
       "slower than 0.02 m/s "
       "at most 0.5 s at most 3 s back"},
      {"until a(x) begins since b(x) approaching gap(x) receding at most 5 mm, slower than 2 cm/s "
       "at "
       "most 0.5 s, onset 1 mm/s at most 3 s back",
       "until (a(x) begins) since b(x) approaching gap(x) receding at most 0.005 m, slower than "
       "0.02 "
       "m/s at most 0.5 s, onset 0.001 m/s at most 3 s back"},
      {"while a(x) and s(x) >= 0.5 one p per x", "while (a(x) and (s(x) >= 0.5)) one p per x"},
      {"while s(x) < 2 one x per p and q, nearest within 1 s",
       "while (s(x) < 2) one x per p and q, nearest within 1 s"},
      {"while a(x) drawn as phase \"#d62728\" without ghost",
       "while a(x) drawn as phase \"#D62728\" without ghost"},
      {"while a(x) with b = c(x) drawn as phase with ghost at end lasting 1 s",
       "while a(x) lasting 1 s with b = c(x) drawn as phase with ghost at end"},
      {"while a(x) drawn \"#00000f\" without row", "while a(x) drawn \"#00000F\" without row"},
      {"while a(x) drawn as grasp with b = c(x)", "while a(x) with b = c(x) drawn as grasp"},
      {"while a(x) drawn as support with ghost = c(x)",
       "while a(x) with ghost = c(x) drawn as support"},
      {"rest of a(x) outside b(x, any), c(x) lasting 1 s",
       "rest of a(x) outside b(x, any), c(x) lasting 1 s"},
      {"compose p: a(x), q: b(x) where p before|meets q",
       "compose p: a(x), q: b(x) where p before|meets q"},
      {"from each a(x) begins to known not b(x) begins within 1 s",
       "from each (a(x) begins) to ((known (not b(x))) begins) within 1 s"},
      {"compose first p: a(x) or b(x), q: c(x) where p before q",
       "compose first p: a(x) or b(x), q: c(x) where p before q"},
      {"compose first: a(x), q: b(x) where first before q",
       "compose first: a(x), q: b(x) where first before q"},
      {"all of a(x) or b(x), q: c(x) within 1 s", "all of a(x) or b(x), q: c(x) within 1 s"},
      {"while a(x) bridging 60 ms requires rise(x) > 1 confirmed by b(x) within c(x) with style = "
       "style(x)",
       "while a(x) bridging 0.06 s requires (rise(x) > 1) confirmed by b(x) within c(x) with style "
       "= style(x)"},
  };
  for (const auto& [text, dumped] : cases) {
    const std::string head = "grammar g\nevent e(x: X) ";
    EXPECT_EQ(DumpOf(head + text), head + dumped + "\n");
  }
}

TEST(Parser, ReadsLaws) {
  const std::pair<const char*, const char*> cases[] = {
      {"rest of a(x, y) outside b(x, any Cup), c(y) is empty", ""},
      {"a(x, y), b(y, x) do not overlap", ""},
      {"a(x, y), b(y, x) lie inside c(any) or d(x)", "a(x, y), b(y, x) lies inside c(any) or d(x)"},
      {"a(x, y) meets|before b(x) or c(y)", ""},
  };
  for (const auto& [text, dumped] : cases) {
    const std::string head = "grammar g\nlaw l(x: X, y: Y) ";
    EXPECT_EQ(DumpOf(head + text), head + (*dumped ? dumped : text) + "\n");
  }
  // These words are names elsewhere.
  EXPECT_EQ(
      DumpOf("grammar g\nevent is(do: X) while empty(do)\nlaw lies(do: X) is(do) meets is(do)"),
      "grammar g\nevent is(do: X) while empty(do)\nlaw lies(do: X) is(do) meets is(do)\n");
}

TEST(Parser, ADumpReadsBackAsItself) {
  for (const char* name : {"contact", "grasp", "pick_and_place"}) {
    const std::string once = DumpOf(testing::LibraryIncluder()(name)->text);
    EXPECT_EQ(DumpOf(once), once);
    EXPECT_EQ(once.find("error"), std::string::npos) << once;
  }
}

TEST(Parser, GoesOnAfterAnError) {
  Diagnostics diagnostics;
  Parse({"t",
         "grammar g\nevent a(x: X) wile b\nevent b(x X) while c\nparam p = q\nevent d(x: X) while "
         "ok(x)\n"},
        diagnostics);
  EXPECT_EQ(diagnostics.size(), 3u) << Format(diagnostics);
}

// Any bytes end in a program or in diagnostics; the library's texts with bytes changed reach deep
// into the compiler.
TEST(Parser, SurvivesDamagedGrammars) {
  std::mt19937 random(7);
  std::vector<std::string> texts;
  for (const char* name : {"contact", "grasp", "pick_and_place"})
    texts.push_back(testing::LibraryIncluder()(name)->text);
  for (int round = 0; round < 3000; ++round) {
    std::string text = texts[random() % texts.size()];
    for (unsigned edits = 1 + random() % 6; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      const std::size_t length = std::min<std::size_t>(random() % 30, text.size() - at);
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), length));
          break;
        default:
          text[at] = "()@,:+-<>| \n"[random() % 12];
      }
    }
    const CompileResult result = Compile({"t", text}, testing::LibraryIncluder());
    EXPECT_EQ(result.program == nullptr, !result.diagnostics.empty());
  }
}

}  // namespace
}  // namespace prehend::grammar
