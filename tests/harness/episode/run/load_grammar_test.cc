// SPDX-License-Identifier: Apache-2.0
// Grammars that use other files, and warnings about what nobody in an episode is.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "grammar/program/program.h"
#include "harness/episode/run/load_run.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

class LoadGrammarFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("load_grammar_" + std::to_string(getpid()));
    fs::create_directories(folder_ / "shared");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static grammar::CompileResult Load(const std::string& file) {
    return LoadGrammar(PREHEND_SOURCE_DIR, file);
  }

  fs::path folder_;
};

TEST_F(LoadGrammarFiles, APathIsSeenFromTheFileThatUsesIt) {
  Write("shared/fast.grammar",
        "grammar fast\nuse \"limit.grammar\"\ncondition fast(x: Thing) while speed(x) > limit\n");
  Write("shared/limit.grammar", "grammar limit\nparam limit = 2 m/s\n");
  const auto loaded =
      Load(Write("g.grammar",
                 "grammar g\nuse \"shared/fast.grammar\"\nuse \"./shared/limit.grammar\"\n"
                 "event rush(x: Thing) while fast(x)\n"));
  EXPECT_TRUE(loaded.program) << Format(loaded.diagnostics);
}

TEST_F(LoadGrammarFiles, FilesThatUseEachOtherOrThemselvesAreReadOnce) {
  Write("b.grammar",
        "grammar b\nuse \"a.grammar\"\ncondition fast(x: Thing) while speed(x) > 1 m/s\n");
  const auto loaded = Load(Write(
      "a.grammar",
      "grammar a\nuse \"b.grammar\"\nuse \"a.grammar\"\nevent rush(x: Thing) while fast(x)\n"));
  EXPECT_TRUE(loaded.program) << Format(loaded.diagnostics);
}

TEST_F(LoadGrammarFiles, MissingOnesAreNamedWithWhereTheyWereLookedFor) {
  const std::string file =
      Write("g.grammar",
            "grammar g\nuse \"shared/no.grammar\"\nuse grsp\nuse \"../x.grammar\"\n"
            "event rush(x: Thing) while speed(x) > 1 m/s\n");
  EXPECT_EQ(Format(Load(file).diagnostics),
            file +
                ":2:1: error: there is no grammar 'shared/no.grammar' to use\n  use "
                "\"shared/no.grammar\"\n  ^\n"
                "  hint: looked for " +
                folder_.string() + "/shared/no.grammar\n" + file +
                ":3:1: error: there is no grammar 'grsp' to use\n  use grsp\n  ^\n  hint: did you "
                "mean 'grasp'?\n" +
                file +
                ":4:1: error: \"../x.grammar\" is not a file beside this one\n  use "
                "\"../x.grammar\"\n  ^\n"
                "  hint: a relative path that ends with .grammar and does not climb: use "
                "\"shared/pouring.grammar\"\n");
}

TEST_F(LoadGrammarFiles, WarnsOfClassesThatNobodyHas) {
  const std::string file =
      Write("g.grammar",
            "grammar g\nevent near(h: Hand, c: Cupp) while distance(h, c) < 1 cm\n"
            "event on(c: Cup) while near(any Hand, c) and is(c, Pot)\n");
  const auto loaded = Load(file);
  ASSERT_TRUE(loaded.program) << Format(loaded.diagnostics);
  const grammar::EntityTable entity_table{
      .entities = {{.name = "hand", .classes = {"Hand", "Entity"}},
                   {.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}}}};
  EXPECT_EQ(Format(Warnings(*loaded.program, entity_table)),
            file +
                ":2:21: warning: no entity of this episode is a 'Cupp'\n"
                "  event near(h: Hand, c: Cupp) while distance(h, c) < 1 cm\n"
                "                      ^\n  hint: did you mean 'Cup'?\n" +
                file +
                ":3:52: warning: no entity of this episode is a 'Pot'\n"
                "  event on(c: Cup) while near(any Hand, c) and is(c, Pot)\n"
                "                                                     ^\n"
                "  hint: an entity is one by its 'class', or by a line of the scenario's "
                "'classes'; without one, what needs it never happens\n");
}

TEST_F(LoadGrammarFiles, WhatTheLibraryTakesAlongIsNotWarnedOf) {
  const grammar::EntityTable entity_table{
      .entities = {{.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}}}};
  const auto warnings_of = [&](const std::string& grammar) {
    const auto loaded = Load(grammar);
    EXPECT_TRUE(loaded.program) << Format(loaded.diagnostics);
    return loaded.program ? Format(Warnings(*loaded.program, entity_table)) : "";
  };
  EXPECT_EQ(warnings_of("kitchen"), "") << "its 'use containers' is no typing error";
  const std::string container = "warning: no entity of this episode is a 'Container'";
  EXPECT_NE(warnings_of("containers").find(container), std::string::npos);
  EXPECT_NE(warnings_of("pick_and_place+containers").find(container), std::string::npos);
}

TEST_F(LoadGrammarFiles, WarnsOfSensorSetsThatNoHandHas) {
  const std::string file =
      Write("g.grammar",
            "grammar g\nevent held(h: Hand, c: Cup) while sensor_set(h, tumb, c) or "
            "sensor_set(h, \"left wing\", c)\n");
  const auto loaded = Load(file);
  ASSERT_TRUE(loaded.program) << Format(loaded.diagnostics);
  const grammar::EntityTable entity_table{
      .entities = {
          {.name = "hand", .classes = {"Hand", "Entity"}, .sensor_sets = {"thumb", "palm"}},
          {.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}}}};
  const std::string line =
      "  event held(h: Hand, c: Cup) while sensor_set(h, tumb, c) or sensor_set(h, \"left wing\", "
      "c)\n";
  EXPECT_EQ(Format(Warnings(*loaded.program, entity_table)),
            file + ":2:49: warning: no hand of this episode has a sensor set 'tumb'\n" + line +
                "  " + std::string(48, ' ') + "^\n  hint: did you mean 'thumb'?\n" + file +
                ":2:75: warning: no hand of this episode has a sensor set 'left wing'\n" + line +
                "  " + std::string(74, ' ') + "^\n  hint: there are: palm, thumb\n");
}

TEST_F(LoadGrammarFiles, WarnsOfNumbersOfSensorSetsThatNoHandHas) {
  const std::string file = Write("g.grammar",
                                 "grammar g\nevent held(h: Hand, c: Cup) while sensor_set(h, 2, c) "
                                 "and sensor_set(h, 3, c)\n");
  const auto loaded = Load(file);
  ASSERT_TRUE(loaded.program) << Format(loaded.diagnostics);
  const grammar::EntityTable entity_table{
      .entities = {
          {.name = "hand", .classes = {"Hand", "Entity"}, .sensor_sets = {"thumb", "palm"}},
          {.name = "cup", .classes = {"Cup", "Movable", "Thing", "Entity"}}}};
  EXPECT_EQ(
      Format(Warnings(*loaded.program, entity_table)),
      file +
          ":2:73: warning: no hand of this episode has a sensor set '3'\n"
          "  event held(h: Hand, c: Cup) while sensor_set(h, 2, c) and sensor_set(h, 3, c)\n  " +
          std::string(72, ' ') + "^\n  hint: a hand has 2 of them here at most\n");
}

TEST_F(LoadGrammarFiles, LibraryGrammarsGiveNoWarnings) {
  // These have definitions alone, for `contact_from_motion` and `pick_and_place`, which use them.
  const std::set<std::string> without_events = {"reach", "reach_from_motion"};
  for (const auto& entry : fs::directory_iterator(PREHEND_SOURCE_DIR "/grammar/library")) {
    if (entry.path().extension() != ".grammar") continue;
    const auto loaded = Load(entry.path().string());
    if (without_events.contains(entry.path().stem().string())) {
      ASSERT_EQ(loaded.diagnostics.size(), 1u) << entry.path();
      EXPECT_EQ(loaded.diagnostics.front().message, "the grammar defines no event");
      continue;
    }
    EXPECT_TRUE(loaded.program) << Format(loaded.diagnostics);
    EXPECT_EQ(Format(loaded.warnings), "") << entry.path();
  }
}

}  // namespace
}  // namespace prehend::episode
