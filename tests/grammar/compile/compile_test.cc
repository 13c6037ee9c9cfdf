// SPDX-License-Identifier: Apache-2.0
// What is said about wrong grammars (errors.txt), parameters from outside, and input that is no
// grammar at all.
#include "grammar/compile/compile.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "grammar/program/program.h"
#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

struct ErrorCase {
  std::string title;
  std::string grammar;
  std::string expected;
};

std::vector<ErrorCase> ReadErrorCases() {
  std::vector<ErrorCase> cases;
  std::istringstream lines(testing::ReadFile(PREHEND_SOURCE_DIR "/tests/grammar/errors.txt"));
  bool in_expected = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("== ")) {
      cases.push_back({.title = line.substr(3)});
      in_expected = false;
    } else if (line == "--") {
      in_expected = true;
    } else if (!cases.empty() && (!in_expected || !line.empty())) {
      (in_expected ? cases.back().expected : cases.back().grammar) += line + "\n";
    }
  }
  return cases;
}

TEST(Compile, SaysExactlyWhatIsWrong) {
  const std::vector<ErrorCase> cases = ReadErrorCases();
  EXPECT_GE(cases.size(), 25u);
  for (const ErrorCase& c : cases) {
    const CompileResult result = Compile({"g", c.grammar}, testing::LibraryIncluder(), {},
                                         {"contact", "grasp", "pick_and_place"});
    EXPECT_EQ(result.program, nullptr);
    EXPECT_EQ(Format(result.diagnostics), c.expected) << c.title;
  }
}

CompileResult CompileText(const std::string& text, const Overrides& overrides = {}) {
  return Compile({"g", text}, testing::LibraryIncluder(), overrides);
}

constexpr const char* kSmall =
    "grammar g\nparam limit = 2 cm\nevent high(x: Thing) while height(x) > limit\n";

TEST(Compile, AVariantTakesThePlaceOfAGrammarThatOthersUse) {
  const CompileResult result =
      CompileText("grammar g\nuse contact from motion\nuse pick_and_place with lift_rise = 5 cm\n");
  ASSERT_TRUE(result.program) << Format(result.diagnostics);
  std::set<std::string> files;
  for (const Rule& rule : result.program->rules) files.insert(rule.file);
  EXPECT_TRUE(files.contains("grammar/library/support_from_motion.grammar"));
  EXPECT_TRUE(files.contains("grammar/library/grasp_from_motion.grammar"));
  EXPECT_FALSE(files.contains("grammar/library/contact.grammar"));
  EXPECT_FALSE(files.contains("grammar/library/grasp.grammar"));
  for (const ProgramParam& param : result.program->params) {
    if (param.name != "lift_rise") continue;
    EXPECT_DOUBLE_EQ(param.value.value, 0.05);
    EXPECT_FALSE(param.overridden);
  }
}

TEST(Compile, TakesParametersFromOutside) {
  const CompileResult result = CompileText(kSmall, {{"limit", "30 mm"}});
  ASSERT_TRUE(result.program);
  EXPECT_DOUBLE_EQ(result.program->params[0].value.value, 0.03);
  EXPECT_TRUE(result.program->params[0].overridden);
}

TEST(Compile, RefusesWrongParametersFromOutside) {
  EXPECT_EQ(Format(CompileText(kSmall, {{"limt", "1 cm"}}).diagnostics),
            "parameter limt:1:1: error: the grammar has no parameter 'limt'\n  1 cm\n  ^\n  hint: "
            "did you mean 'limit'?\n");
  EXPECT_EQ(Format(CompileText(kSmall, {{"limit", "1 s"}}).diagnostics),
            "parameter limit:1:1: error: 'limit' is in m, this is s\n  1 s\n  ^\n  hint: its value "
            "in the grammar is 0.02 m\n");
  EXPECT_EQ(Format(CompileText(kSmall, {{"limit", "wide"}}).diagnostics),
            "parameter limit:1:1: error: expected a number, found 'wide'\n  wide\n  ^\n");
}

// A part of an `and` that says nothing, and the edge of a range that somebody else tries.
TEST(Compile, WarnsOfWhatSaysNothingButMayBeMeant) {
  const std::string text =
      "grammar g\n"
      "param limit = 2 cm/s\n"
      "define fast(x: Movable, v: cm/s) = speed(x) >= v\n"
      "event a(x: Movable, y: Movable) while touching(x, y) and speed(x) >= 0 m/s\n"
      "event b(x: Movable) while fast(x, 0 cm/s)\n"
      "event d(x: Movable) while speed(x) > limit and speed(x) < 3 cm/s\n"
      "event e(x: Movable) while speed(x) < limit\n";
  const std::string by_itself =
      "g:4:67: warning: this is always true: 'speed' is never below 0 m/s\n"
      "  event a(x: Movable, y: Movable) while touching(x, y) and speed(x) >= 0 m/s\n"
      "                                                                    ^\n"
      "  hint: leave it out, or choose a bound that can be missed; 'known ..' asks whether there "
      "is a value\n"
      "g:3:45: warning: this is always true: 'speed' is never below 0 m/s\n"
      "  define fast(x: Movable, v: cm/s) = speed(x) >= v\n"
      "                                              ^\n"
      "  hint: 'v' is 0 m/s here; leave it out, or choose a bound that can be missed; 'known ..' "
      "asks whether there is a value\n";
  const CompileResult plain = CompileText(text);
  EXPECT_TRUE(plain.program) << Format(plain.diagnostics);
  EXPECT_EQ(Format(plain.warnings), by_itself);
  const CompileResult low = CompileText(text, {{"limit", "0 cm/s"}});
  EXPECT_TRUE(low.program) << Format(low.diagnostics);
  EXPECT_EQ(Format(low.warnings),
            by_itself +
                "g:7:36: warning: this is never true: 'speed' is never below 0 m/s\n"
                "  event e(x: Movable) while speed(x) < limit\n"
                "                                     ^\n"
                "  hint: 'limit' is 0 m/s, set from outside; choose a bound that can be reached\n");
  const CompileResult high = CompileText(text, {{"limit", "4 cm/s"}});
  EXPECT_TRUE(high.program) << Format(high.diagnostics);
  EXPECT_EQ(Format(high.warnings),
            by_itself +
                "g:6:57: warning: this is never true together with what stands before it: "
                "(speed(x) < 0.03 m/s)\n"
                "  event d(x: Movable) while speed(x) > limit and speed(x) < 3 cm/s\n"
                "                                                          ^\n"
                "  hint: use 'or', or change one of the bounds\n");
}

// 570 ms and 0.57 s, 0.1 + 0.2 and 0.3 are the same, although their products and sums are not.
TEST(Compile, ComparesNumbersAsTheyAreWritten) {
  const CompileResult result = CompileText(
      "grammar g\nparam s = 0.1 s\nparam t = 0.2 s\n"
      "event a(h: Hand, x: Thing) while touching(h, x) lasting 570 ms to 0.57 s\n"
      "event b(h: Hand, x: Thing) while touching(h, x) lasting s + t to 0.3 s\n"
      "event c(h: Hand, x: Thing) from touching(h, x) begins to touching(h, x) ends within 0.57 s "
      "lasting 570 ms\n"
      "event d(h: Hand) while trigger(h) >= 0.1 + 0.2 and trigger(h) <= 0.3\n"
      "event e(h: Hand, x: Thing) while touching(h, x) lasting 571 ms to 0.57 s\n");
  EXPECT_EQ(Format(result.diagnostics),
            "g:8:67: error: no interval lasts that long and no longer than this\n"
            "  event e(h: Hand, x: Thing) while touching(h, x) lasting 571 ms to 0.57 s\n"
            "                                                                    ^\n"
            "  hint: the shorter time stands first: lasting 1 s to 2 s\n");
}

std::string Times(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(Compile, RefusesWhatIsNoGrammar) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "the file is empty"},
      {std::string("grammar\0g", 9), "g: error: this is a binary file, not a grammar"},
      {"grammar \xff\xfe", "g: error: the file is not valid UTF-8 text"},
      {std::string(50 << 20, ' '), "g: error: the file is larger than 1 MiB"},
      {"grammar g event a(x: T) while " + std::string(10000, '('), "nested more than 64 deep"},
      {"grammar g event a(x: T) while 1" + Times(" + 1", 64) + " > 0",
       "more than 64 steps in a row"},
      {"grammar g event a(x: T) while 1" + Times(" * 1", 64) + " > 0",
       "more than 64 steps in a row"},
      {"grammar g param p = 1 m" + Times("/s", 9), "a unit with more than 8 divisors"},
  };
  for (const auto& [text, message] : cases) {
    const CompileResult result = CompileText(text);
    EXPECT_EQ(result.program, nullptr);
    EXPECT_NE(Format(result.diagnostics).find(message), std::string::npos)
        << Format(result.diagnostics);
  }
}

TEST(Compile, LimitsTheSizeOfAGrammar) {
  std::string rules = "grammar g\n";
  for (int i = 0; i < 1001; ++i)
    rules += "event e" + std::to_string(i) + "(x: Thing) while speed(x) > 1 m/s\n";
  EXPECT_NE(Format(CompileText(rules).diagnostics).find("more than 1000 "), std::string::npos);
  std::string terms = "grammar g\nevent e(x: Thing) while speed(x) > 1 m/s";
  for (int i = 0; i < 5000; ++i) terms += " and speed(x) > 1 m/s";
  EXPECT_NE(Format(CompileText(terms).diagnostics).find("more than 10000 expressions"),
            std::string::npos);
}

// Each doubles what the one before makes.
TEST(Compile, SaysOnceOfEachDefinitionThatItIsTooDeep) {
  std::string text = "grammar g\ndefine d0 = 1\n";
  for (int i = 1; i <= 30; ++i) {
    const std::string before = "d" + std::to_string(i - 1);
    text += "define d" + std::to_string(i) + " = " + before + " + " + before + "\n";
  }
  const CompileResult result =
      CompileText(text + "event e(x: Thing) while speed(x) > d2 * (1 m/s)\n");
  std::set<std::pair<int, int>> places;
  std::size_t too_deep = 0;
  for (const Diagnostic& one : result.diagnostics) {
    EXPECT_TRUE(places.insert({one.place.line, one.place.column}).second) << one.place.line;
    too_deep += one.message.find("more than 16 deep") != std::string::npos;
  }
  EXPECT_EQ(too_deep, 15u);  // of d16 to d30
}

TEST(Compile, ReadsEachUsedGrammarOnceAndSurvivesCircles) {
  int asked = 0;
  const Includer circular = [&](std::string_view name) -> std::optional<GrammarText> {
    ++asked;
    const std::string other = name == "a" ? "b" : "a";
    return GrammarText{std::string(name), "grammar " + std::string(name) + "\nuse " + other +
                                              "\ncondition c_" + std::string(name) +
                                              "(x: Thing) while speed(x) > 1 m/s\n"};
  };
  const CompileResult result = Compile(
      {"g", "grammar g\nuse a\nuse b\nevent e(x: Thing) while c_a(x) and c_b(x)\n"}, circular);
  EXPECT_TRUE(result.program) << Format(result.diagnostics);
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace prehend::grammar
