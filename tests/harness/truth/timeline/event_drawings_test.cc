// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "grammar/compile/compile.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::DrawnAs;
using grammar::Ghost;

EventDrawings DrawingsOf(const std::string& rules) {
  const grammar::CompileResult compiled = grammar::Compile({"g", "grammar g\n" + rules}, nullptr);
  EXPECT_TRUE(compiled.program) << Format(compiled.diagnostics);
  return EventDrawings(*compiled.program);
}

TEST(EventDrawings, AreWhatTheGrammarSays) {
  const EventDrawings drawings = DrawingsOf(
      "event a(x: Thing, h: Hand) while touching(x, h) drawn as phase \"#010203\" with ghost at "
      "end\n"
      "event b(x: Thing, h: Hand) while touching(x, h) drawn as grasp\n"
      "event c(h: Hand, x: Thing) while touching(x, h) drawn as grasp\n"
      "event d(x: Thing, y: Thing) while touching(x, y) drawn as support\n"
      "event e(x: Thing, y: Thing) while touching(x, y) drawn without row\n"
      "event f(h: Hand) while trigger(h) > 0.5 drawn as phase without ghost\n");
  EXPECT_EQ(drawings.Of("a").as, DrawnAs::kPhase);
  EXPECT_EQ(drawings.Of("a").color, 0x010203u);
  EXPECT_EQ(drawings.Of("a").ghost, Ghost::kAtEnd);
  EXPECT_EQ(drawings.Of("a").hand, 1u);
  EXPECT_EQ(drawings.Of("b").as, DrawnAs::kGrasp);
  EXPECT_EQ(drawings.Of("b").hand, 1u);
  EXPECT_EQ(drawings.Of("b").first, 0u);
  EXPECT_EQ(drawings.Of("c").hand, 0u);
  EXPECT_EQ(drawings.Of("c").first, 1u);
  EXPECT_EQ(drawings.Of("d").as, DrawnAs::kSupport);
  EXPECT_EQ(drawings.Of("d").first, 0u);
  EXPECT_EQ(drawings.Of("d").last, 1u);
  EXPECT_EQ(drawings.Of("e").as, DrawnAs::kNothing);
  EXPECT_EQ(drawings.Of("f").ghost, Ghost::kNoGhost);
}

TEST(EventDrawings, GiveEventsWithoutAColourOneEach) {
  const EventDrawings drawings = DrawingsOf(
      "event a(x: Thing) while height(x) > 1 m\n"
      "condition none(x: Thing) while height(x) > 2 m\n"
      "event b(x: Thing) while none(x) drawn \"#FFFFFF\"\n"
      "event c(x: Thing) while height(x) > 3 m\n");
  EXPECT_EQ(drawings.Of("a").as, DrawnAs::kRow);
  EXPECT_EQ(drawings.Of("a").color, 0x0072B2u);
  EXPECT_EQ(drawings.Of("b").color, 0xFFFFFFu);
  EXPECT_EQ(drawings.Of("c").color, 0xE69F00u);
  EXPECT_EQ(drawings.Of("stranger").as, DrawnAs::kRow);
  EXPECT_EQ(drawings.Of("stranger").color, 0x7A828Cu);
}

TEST(EventDrawings, NoTwoHaveOneColourWhileThereAreOthers) {
  const EventDrawings drawings = DrawingsOf(
      "event a(x: Thing) while height(x) > 1 m\n"
      "event b(x: Thing) while height(x) > 2 m drawn \"#0072B2\"\n"
      "event c(x: Thing) while height(x) > 3 m drawn \"#0072B2\"\n");
  EXPECT_EQ(drawings.Of("a").color, 0xE69F00u);
  EXPECT_EQ(drawings.Of("b").color, 0x0072B2u);
  EXPECT_EQ(drawings.Of("c").color, 0x009E73u);
  std::string many;
  for (const char name : std::string("abcdefghijklm"))
    many += std::string("event ") + name + "(x: Thing) while height(x) > 1 m\n";
  const EventDrawings all = DrawingsOf(many);
  std::set<std::uint32_t> colors;
  for (const char name : std::string("abcdefghijklm"))
    colors.insert(all.Of(std::string(1, name)).color);
  EXPECT_EQ(colors.size(), 13u);
}

}  // namespace
}  // namespace prehend::truth
