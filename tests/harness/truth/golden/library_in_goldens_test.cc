// SPDX-License-Identifier: Apache-2.0
// Every event of the grammar library occurs in at least two goldens: what no scenario shows, nobody
// would miss.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grammar/describe.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/golden/golden.h"

namespace prehend::truth {
namespace {

constexpr int kWanted = 2;

/// Grammars that no golden needs to watch, each with its reason.
const std::set<std::string> kExceptedGrammars = {
    "original_2020",  // the baseline: `score` and tests/harness/measure/score compare it with the
                      // others
    // They stand in for `contact`, `grasp`, `furniture`, `pouring` and `stirring` where a recording
    // has poses only, or the opening of grippers besides, and a scenario has more: judged by
    // tests/grammar/motion_test.cc, tests/grammar/motion_in_hands_test.cc,
    // tests/grammar/gripper_test.cc and tests/program/facts_from_motion.py.
    "furniture_by_holder",
    "grasp_from_gripper",
    "grasp_from_motion",
    // Judged by drawings and by three scenarios whose goldens watch `pick_and_place`:
    // tests/grammar/corpus/library.txt, tests/program/handing_over_test.cc.
    "handing_over",
    "handing_over_from_motion",
    "pouring_from_motion",
    "reached",
    "stirring_from_motion",
    "support_from_motion",
};

/// Grammars that define no event: others use what they define.
const std::set<std::string> kDefinitionsAlone = {"reach", "reach_from_motion"};

/// A grammar of the library.
struct Shipped {
  std::set<std::string> with;    ///< itself and what it uses
  std::set<std::string> prints;  ///< names of its events, with those of what it uses
};

std::map<std::string, Shipped> Library() {
  std::map<std::string, Shipped> library;
  const std::filesystem::path root(PREHEND_SOURCE_DIR);
  for (const auto& file : std::filesystem::directory_iterator(root / "grammar/library")) {
    if (file.path().extension() != ".grammar") continue;
    Shipped& shipped = library[file.path().stem().string()];
    if (kDefinitionsAlone.contains(file.path().stem().string())) continue;
    std::vector<std::string> files;
    const grammar::CompileResult compiled =
        episode::LoadGrammar(PREHEND_SOURCE_DIR, file.path().stem().string(), {}, &files);
    EXPECT_TRUE(compiled.program) << Format(compiled.diagnostics);
    if (!compiled.program) continue;
    shipped.with.insert(file.path().stem().string());
    for (const std::string& used : files)
      shipped.with.insert(std::filesystem::path(used).stem().string());
    for (const grammar::RuleDescription& rule : grammar::Describe(*compiled.program).rules) {
      if (rule.printed) shipped.prints.insert(rule.name);
    }
  }
  return library;
}

/// Events that a grammar defines itself.
std::set<std::string> OwnEvents(const std::string& name,
                                const std::map<std::string, Shipped>& library) {
  std::set<std::string> own = library.at(name).prints;
  for (const std::string& used : library.at(name).with) {
    if (used == name) continue;
    for (const std::string& event : library.at(used).prints) own.erase(event);
  }
  return own;
}

TEST(LibraryInGoldens, EveryEventOccursInTwoGoldens) {
  const std::map<std::string, Shipped> library = Library();
  std::map<std::pair<std::string, std::string>, int> goldens;
  for (const auto& [name, shipped] : library) {
    if (kExceptedGrammars.contains(name)) continue;
    for (const std::string& event : OwnEvents(name, library)) goldens[{name, event}] = 0;
  }
  ASSERT_GT(goldens.size(), 20u);
  for (const episode::ScenarioFile& file : episode::ListScenarios(PREHEND_SOURCE_DIR)) {
    const auto golden = GoldenFiles(PREHEND_SOURCE_DIR).ReadGoldenOf(episode::IdOf(file));
    if (!golden || !*golden) continue;  // oracle_agreement_test complains
    const auto watching = library.find((*golden)->grammar);
    if (watching == library.end()) continue;
    for (auto& [of, count] : goldens) {
      if (!watching->second.with.contains(of.first)) continue;
      count += std::ranges::any_of((*golden)->events, [&of = of](const GoldenEvent& line) {
        return line.event.event == of.second;
      });
    }
  }
  for (const auto& [of, count] : goldens)
    EXPECT_GE(count, kWanted) << of.second << " of grammar " << of.first
                              << " needs another scenario";
}

}  // namespace
}  // namespace prehend::truth
