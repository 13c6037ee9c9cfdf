// SPDX-License-Identifier: Apache-2.0
// No event rule in C++: what an event means stands in a grammar, so the program knows none by name.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

namespace fs = std::filesystem;

std::set<std::string> EventsIn(const std::string& grammar) {
  std::set<std::string> names;
  const std::regex head("(?:^|\n)(?:symmetric )?event (\\w+)\\(");
  for (std::sregex_iterator at(grammar.begin(), grammar.end(), head), end; at != end; ++at)
    names.insert((*at)[1]);
  return names;
}

/// Texts of the file that are a name of an event and nothing else.
std::vector<std::string> NamesIn(const std::string& text, const std::set<std::string>& events) {
  std::vector<std::string> found;
  const std::regex literal("\"((?:[^\"\\\\\n]|\\\\.)*)\"");
  for (std::sregex_iterator at(text.begin(), text.end(), literal), end; at != end; ++at) {
    if (events.contains((*at)[1])) found.push_back((*at)[1]);
  }
  return found;
}

/// The oracle is a second opinion on the same events; the default grammar has the name of the event
/// that it is about. Examples in help texts may name events, as here texts are compared whole. HTML
/// has an attribute of the name of an event, and maps of imports have keys of such names, too.
bool MayNameEvents(const std::string& path) {
  return path == "harness/suite/report/report.cc" || path == "harness/suite/report/charts.cc" ||
         path == "harness/exchange/poses/import_map_format.cc" ||
         path.starts_with("harness/truth/oracle/") || path == "harness/base/base/project_paths.h";
}

TEST(EventNames, AreUnknownToTheProgram) {
  std::set<std::string> events;
  for (const auto& file : fs::directory_iterator(fs::path(PREHEND_SOURCE_DIR) / "grammar/library"))
    events.merge(EventsIn(Slurp(file.path())));
  ASSERT_GE(events.size(), 30u);
  for (const SourceFile& file : SourceFiles({"grammar", "harness", "physics"})) {
    if (MayNameEvents(file.path)) continue;
    for (const std::string& name : NamesIn(file.text, events))
      ADD_FAILURE() << file.path << " knows the event " << name
                    << "; let the grammar say what the program must know of it";
  }
}

TEST(EventNames, AreFoundInATextThatIsOne) {
  const std::set<std::string> events = EventsIn(
      "grammar g\nevent sliding(a: Hand) while x\nsymmetric event contact(a: A, b: A) while y\n"
      "condition near(a: Hand) while z\n");
  EXPECT_EQ(events, (std::set<std::string>{"contact", "sliding"}));
  EXPECT_EQ(NamesIn("if (e == \"sliding\" || e == \"near\") Say(\"sliding begins\");", events),
            std::vector<std::string>{"sliding"});
}

}  // namespace
}  // namespace prehend::architecture
