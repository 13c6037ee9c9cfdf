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

TEST(RegionsOf, AreThoseOfTheConditionsThatAnEventIsMadeOf) {
  const CompileResult compiled = Compile({"g.grammar", R"(grammar g
event reaching(hand: Hand, object: Thing)
  while in_sphere(object, ahead(hand, 30 cm), 20 cm) and not touching(hand, object)
condition away(hand: Hand, object: Movable)
  from touching(hand, object) begins
  to not in_cylinder(position(object), position(object)@begin, 9 cm, 12 cm) begins
condition above(hand: Hand, object: Movable)
  from touching(hand, object) begins
  to in_cylinder(position(object), position(object)@begin, 9 cm, 1000 m) begins
event carrying(hand: Hand, object: Movable)
  from touching(hand, object) begins to away(hand, object) ends
  requires above(hand, object)
event after(hand: Hand, object: Movable)
  from carrying(hand, object) ends to touching(hand, object) begins
)"},
                                         nullptr);
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  using Region = RegionOfInterest;
  EXPECT_EQ(RegionsOf(*compiled.program, "reaching"),
            (std::vector<Region>{{.shape = Region::Shape::kSphere,
                                  .middle = Region::Middle::kAhead,
                                  .role = 0,
                                  .inside = 1,
                                  .radius_m = 0.2,
                                  .height_m = 0,
                                  .ahead_m = 0.3}}));
  EXPECT_EQ(RegionsOf(*compiled.program, "carrying"),
            (std::vector<Region>{{.shape = Region::Shape::kCylinder,
                                  .middle = Region::Middle::kAtBegin,
                                  .role = 1,
                                  .inside = 1,
                                  .radius_m = 0.09,
                                  .height_m = 0.12}}))
      << "not a cylinder without end";
  EXPECT_TRUE(RegionsOf(*compiled.program, "after").empty()) << "another event has its own";
  EXPECT_TRUE(RegionsOf(*compiled.program, "unknown").empty());
}

}  // namespace
}  // namespace prehend::grammar
