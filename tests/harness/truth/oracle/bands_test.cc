// SPDX-License-Identifier: Apache-2.0
// The table of numbers in docs/events.md owns the numbers: the oracle's bands are its bands, the
// parameters of the library lie within them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "grammar/program/program.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/oracle/recording.h"

namespace prehend::truth {
namespace {

struct Row {
  std::string number;
  double value = 0, low = 0, high = 0;  ///< SI
  std::set<std::string> parameters;
};

double UnitOf(const std::string& unit) {
  static const std::map<std::string, double> kUnits = {{"", 1},
                                                       {"%", 0.01},
                                                       {"s", 1},
                                                       {"ms", 1e-3},
                                                       {"cm", 1e-2},
                                                       {"mm", 1e-3},
                                                       {"cm/s", 1e-2},
                                                       {"mm/s", 1e-3},
                                                       {"N", 1},
                                                       {"/s", 1},
                                                       {"deg", std::numbers::pi / 180}};
  return kUnits.at(unit);
}

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, '|');) {
    const auto begin = cell.find_first_not_of(' ');
    cells.push_back(begin == std::string::npos
                        ? ""
                        : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
  }
  return cells;
}

/// The rows whose second and third cells are a number and a band.
std::vector<Row> TableOfThePage() {
  static const std::regex kValue(R"(([0-9.]+) ?(\S*))"), kBand(R"(([0-9.]+) to ([0-9.]+) ?(\S*))"),
      kName("`([a-z_]+)`");
  std::ifstream page(PREHEND_SOURCE_DIR "/docs/events.md");
  std::vector<Row> rows;
  for (std::string line; std::getline(page, line);) {
    const std::vector<std::string> cells = CellsOf(line);
    std::smatch value, band;
    if (cells.size() < 8 || !std::regex_match(cells[2], value, kValue) ||
        !std::regex_match(cells[3], band, kBand))
      continue;
    Row& row = rows.emplace_back();
    row.number = cells[1];
    row.value = std::stod(value[1]) * UnitOf(value[2]);
    row.low = std::stod(band[1]) * UnitOf(band[3]);
    row.high = std::stod(band[2]) * UnitOf(band[3]);
    for (std::sregex_iterator name(cells[4].begin(), cells[4].end(), kName), end; name != end;
         ++name)
      row.parameters.insert((*name)[1]);
  }
  return rows;
}

TEST(DefinitionBands, AreThoseOfThePage) {
  const std::vector<Row> rows = TableOfThePage();
  ASSERT_EQ(rows.size(), DefinitionBands().size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Band& band = DefinitionBands()[i];
    EXPECT_EQ(band.number, rows[i].number);
    EXPECT_NEAR(band.low, rows[i].low, 1e-12) << rows[i].number;
    EXPECT_NEAR(band.high, rows[i].high, 1e-12) << rows[i].number;
    EXPECT_NEAR(OracleSettings{}.*band.setting, rows[i].value, 1e-12) << rows[i].number;
    EXPECT_LT(band.low, rows[i].value) << rows[i].number;
    EXPECT_GT(band.high, rows[i].value) << rows[i].number;
  }
}

TEST(DefinitionBands, HoldEveryParameterOfTheGrammarsThatAreJudged) {
  std::set<std::string> on_the_page = {"grip_sides", "grip_window", "lift_sky",   "closed_below",
                                       "half_below", "open_from",   "band_slack", "part_moment"};
  std::map<std::string, double> parameters;
  for (const char* grammar : {"pick_and_place", "furniture"}) {
    const auto compiled = episode::LoadGrammar(PREHEND_SOURCE_DIR, grammar);
    ASSERT_TRUE(compiled.program);
    for (const grammar::ProgramParam& parameter : compiled.program->params)
      parameters[parameter.name] = parameter.value.value;
  }
  for (const Row& row : TableOfThePage()) {
    for (const std::string& name : row.parameters) {
      on_the_page.insert(name);
      ASSERT_TRUE(parameters.contains(name)) << name;
      EXPECT_GE(parameters[name], row.low - 1e-12) << name;
      EXPECT_LE(parameters[name], row.high + 1e-12) << name;
    }
  }
  for (const auto& [name, value] : parameters)
    EXPECT_TRUE(on_the_page.contains(name)) << name << " is a number that no definition has";
}

TEST(DefinitionChoices, ChangeOneNumberAtATime) {
  const std::vector<OracleSettings> choices = DefinitionChoices();
  ASSERT_EQ(choices.size(), 1 + 2 * DefinitionBands().size());
  for (std::size_t i = 1; i < choices.size(); ++i) {
    const auto changed = std::ranges::count_if(DefinitionBands(), [&](const Band& band) {
      return choices[i].*band.setting != choices[0].*band.setting;
    });
    EXPECT_EQ(changed, 1);
  }
}

}  // namespace
}  // namespace prehend::truth
