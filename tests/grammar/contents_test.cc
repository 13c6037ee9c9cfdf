// SPDX-License-Identifier: Apache-2.0
#include "grammar/contents.h"

#include <gtest/gtest.h>

#include "grammar/compile/compile.h"

namespace prehend::grammar {
namespace {

constexpr const char* kGrammar = R"(grammar kitchen
condition near(hand: Hand, object: Cup) while distance(hand, object) < 10 cm
event holding(hand: Hand, object: Cup) while sensor_set(hand, palm, object)
  with style = style(hand)
  with force = force(hand, object)
symmetric event meeting(a: Thing, b: Thing) while touching(a, b)
event pinching(hand: Hand, object: Cup) while sensor_set(hand, 3, object) drawn as grasp
)";

std::vector<std::string> NamesOf(const std::vector<NameInSource>& names) {
  std::vector<std::string> texts;
  for (const NameInSource& name : names) texts.push_back(name.name);
  return texts;
}

class Contents : public ::testing::Test {
 protected:
  void SetUp() override {
    compiled_ = Compile({"kitchen.grammar", kGrammar}, nullptr);
    ASSERT_TRUE(compiled_.program) << Format(compiled_.diagnostics);
  }
  const Program& program() const { return *compiled_.program; }
  CompileResult compiled_;
};

TEST_F(Contents, NamesEventsButNoConditions) {
  EXPECT_EQ(GrammarName(program()), "kitchen");
  EXPECT_EQ(EventNames(program()), (std::vector<std::string>{"holding", "meeting", "pinching"}));
  EXPECT_TRUE(HasEvent(program(), "meeting"));
  EXPECT_FALSE(HasEvent(program(), "near"));
  EXPECT_FALSE(HasEvent(program(), "touching"));
}

TEST_F(Contents, TellsWhatAnEventIsAbout) {
  const std::vector<EventSignature> events = EventSignatures(program());
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].name, "holding");
  EXPECT_EQ(events[0].roles, (std::vector<std::string>{"hand", "object"}));
  EXPECT_EQ(events[0].classes, (std::vector<std::string>{"Hand", "Cup"}));
  EXPECT_EQ(events[0].attributes, std::vector<std::string>{"force"});
  EXPECT_TRUE(events[0].has_style);
  EXPECT_TRUE(events[1].attributes.empty());
  EXPECT_FALSE(events[1].has_style);
  EXPECT_EQ(events[1].drawing.as, DrawnAs::kRow);
  EXPECT_EQ(events[2].drawing.as, DrawnAs::kGrasp);
}

TEST_F(Contents, ListsWhatAnEpisodeMayNotHave) {
  EXPECT_EQ(NamesOf(NamedClasses(program())), std::vector<std::string>{"Cup"});
  EXPECT_EQ(NamesOf(NamedSensorSets(program())), std::vector<std::string>{"palm"});
  EXPECT_EQ(NamesOf(NumberedSensorSets(program())), std::vector<std::string>{"3"});
  EXPECT_EQ(NamedClasses(program())[0].file, "kitchen.grammar");
  EXPECT_EQ(NamedClasses(program())[0].place.line, 2);
}

TEST_F(Contents, HasWhatCompileWarnedOf) {
  const Diagnostics& warnings = CompileWarnings(program());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].message, "no event uses the condition 'near'");
}

}  // namespace
}  // namespace prehend::grammar
