// SPDX-License-Identifier: Apache-2.0
// Answers and queries on the edge: words that JSON has for itself, labels, moments that are no
// numbers, an empty query.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

/// A knowledge base in which the carton is called `null`.
struct Called {
  std::string file, kb;
};

const Called& CalledNull() {
  static const Called made = [] {
    const fs::path folder = FreshFolder("ask");
    const Called paths{.file = folder / "a.episodes", .kb = folder / "kb"};
    EXPECT_EQ(Prehend({"run", "pick_and_place/milk_carton_wrap", "--record", paths.file}).exit_code,
              0);
    EXPECT_EQ(Prehend({"episode", "knowledge", paths.file, "-o", paths.kb}).exit_code, 0);
    for (const auto& file : fs::recursive_directory_iterator(paths.kb)) {
      if (file.path().extension() != ".ttl") continue;
      std::string text = ReadFile(file.path());
      const std::string label = "rdfs:label \"milk\"";
      for (std::size_t at = 0; (at = text.find(label, at)) != std::string::npos;)
        text.replace(at, label.size(), "rdfs:label \"null\"");
      WriteFile(file.path(), text);
    }
    return paths;
  }();
  return made;
}

TEST(Ask, WordsOfJsonAreTexts) {
  for (const auto& [query, out] : std::vector<std::pair<std::string, std::string>>{
           {"X = null", "X\nnull\n1 answer\n"},
           {"X = [true, false]", "X\n[true, false]\n1 answer\n"},
           {"X = 'a\\nb'", "X\na\\nb\n1 answer\n"},
           {"entity(O, [an, object, [name, null]])", "O\nnull\n1 answer\n"}}) {
    const Said said = Prehend({"episode", "ask", CalledNull().kb, query});
    EXPECT_EQ(said.exit_code, 0) << query << said.err;
    EXPECT_EQ(said.out, out) << query;
  }
  const Said unknown =
      Prehend({"episode", "ask", CalledNull().kb, "entity(O, [an, object, [name, nul]])"});
  EXPECT_EQ(unknown.exit_code, 4) << unknown.err;
  EXPECT_NE(unknown.err.find("nothing is called 'nul' in these episodes; did you mean 'null'?"),
            std::string::npos)
      << unknown.err;
}

// And a class that is said of nothing has some below it.
TEST(Ask, LabelsStandWhereIndividualsDo) {
  for (const char* query : {"holds(type(table, T))", "holds(type(X, dul:'Object'))",
                            "holds(type(table, dul:'Object'))"})
    EXPECT_EQ(Prehend({"episode", "ask", CalledNull().kb, query}).exit_code, 0) << query;
  for (const char* query : {"holds(type(table, 'Grasping'))", "holds(graspType(table, S))"})
    EXPECT_EQ(Prehend({"episode", "ask", CalledNull().kb, query}).exit_code, 4) << query;
}

TEST(Ask, WhatCannotBeAskedIsRefused) {
  for (const auto& [query, why] : std::vector<std::pair<std::string, std::string>>{
           {"  ", "the query is empty"},
           {"% a remark", "the query is empty"},
           {"X is " + std::string(20'000, '9'), "needs an integer of more than 65536 bits"},
           {"occurs(A, [S, E]), X is nan, show(world(X))",
            "found show(world(1.5NaN), none), wanted"},
           {"occurs(A, [S, E]), X is inf, show(world(X))",
            "found show(world(1.0Inf), none), wanted"},
           {"occurs(A, [S, E]), X is 10 ** 400, show(world(X))", "found show(world(1000"}}) {
    const Said said = Prehend({"episode", "ask", CalledNull().kb, query});
    EXPECT_EQ(said.exit_code, 2) << query << said.out;
    EXPECT_NE(said.err.find(why), std::string::npos) << query << ": " << said.err;
  }
}

}  // namespace
}  // namespace prehend::house
