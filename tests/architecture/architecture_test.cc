// SPDX-License-Identifier: Apache-2.0
// The house rules of ARCHITECTURE.md that a machine can check: which room may include which, where
// each library may appear, how long a file may grow, and how it is laid out. The checker itself is
// tested on made-up files, so that it can't rot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLines = 600;

const std::vector<std::string> kRooms = {"grammar", "physics", "render", "harness",
                                         "python",  "tests",   "bench"};

/// Rooms (or single headers) that a room may include besides itself.
const std::map<std::string, std::vector<std::string>> kArrows = {
    {"grammar", {}},
    {"physics", {}},
    {"render", {"physics/base/", "physics/scene/"}},
    {"harness", {"grammar/", "physics/", "render/"}},
    {"python", {"grammar/", "harness/library/"}},
    {"tests", {"grammar/", "physics/", "render/", "harness/", "tests/", "bench/"}},
    {"bench", {"grammar/", "physics/", "render/", "harness/"}},
};

/// Where a third-party header may be included: a pattern of the header, a pattern of the files.
struct LibraryRule {
  std::string name;
  std::regex header;
  std::regex files;
};

const std::vector<LibraryRule>& LibraryRules() {
  static const std::vector<LibraryRule> rules = {
      {"Bullet", std::regex("(bt[A-Z]|Bullet|LinearMath).*"),
       std::regex("(physics/bullet/|tests/physics/bullet/|bench/bullet_).*")},
      {"Box2D", std::regex("box2d/.*"), std::regex("physics/box2d/.*")},
      {"yaml-cpp", std::regex("yaml-cpp/.*"), std::regex("harness/.*")},
      {"JSON", std::regex("nlohmann/.*"), std::regex("(harness|tests|bench)/.*")},
      {"fmt", std::regex("fmt/.*"), std::regex("(harness|tests|bench)/.*")},
      {"pybind11", std::regex("pybind11/.*"), std::regex("python/module\\.cc")},
      {"CLI11", std::regex("CLI/.*"), std::regex("harness/cli/command/parse_arguments\\.cc")},
      {"pugixml", std::regex("pugixml\\.hpp"), std::regex("(harness|tests)/.*")},
      {"muParser", std::regex("muParser.*"), std::regex("tests/witnesses/.*/formula\\.cc")},
      {"tl::expected", std::regex("tl/.*"), std::regex("(harness|tests)/.*")},
      {"SLEEF", std::regex("sleef\\.h"), std::regex("physics/portable_math\\.cc")},
      {"xxHash", std::regex("xxhash\\.h"), std::regex("harness/(.*/)?content_hash\\.cc")},
      {"SQLite", std::regex("sqlite3\\.h"),
       std::regex("(harness/(episode/episodes|exchange/messages)|bench)/.*")},
      {"zstd", std::regex("zstd\\.h"),
       std::regex("harness/(episode/frames/columns|exchange/messages/log_file)\\.cc")},
      {"LZ4", std::regex("lz4.*\\.h"), std::regex("harness/exchange/messages/log_file\\.cc")},
      {"HDF5", std::regex("(hdf5|H5.*)\\.h"), std::regex("harness/exchange/hdf5/.*")},
      {"zlib", std::regex("zlib\\.h"),
       std::regex("harness/(show/replay/replay_data|exchange/(messages/log_file|hdf5/"
                  "hdf5_file|arrays/read_hdf5_poses)|"
                  "exchange/export/.*)\\.cc")},
      {"OpenGL and OSMesa", std::regex("(GL/.*|GLES.*|EGL/.*)"), std::regex("render/.*")},
      {"libpng", std::regex("png\\.h"), std::regex("(render|tests/render)/.*")},
      {"stb", std::regex("stb/.*"), std::regex("render/.*")},
      {"GoogleTest", std::regex("(gtest|gmock)/.*"), std::regex("tests/.*")},
      {"Google Benchmark", std::regex("benchmark/.*"), std::regex("bench/.*")},
  };
  return rules;
}

/// Standard headers that the grammar room must not know: files, clocks, logging.
const std::set<std::string> kForbiddenInGrammar = {"fstream", "iostream", "filesystem", "chrono",
                                                   "cstdio",  "ctime",    "thread",     "random"};

std::string RoomOf(const std::string& path) { return path.substr(0, path.find('/')); }

/// What is wrong with one file, as sentences; empty when nothing is.
std::vector<std::string> Violations(const std::string& path, const std::string& text) {
  std::vector<std::string> found;
  const std::string room = RoomOf(path);
  const auto count = std::ranges::count(text, '\n');
  for (const Include& include : IncludesOf(text)) {
    const std::string& header = include.header;
    const std::string where = path + ":" + std::to_string(include.line) + ": ";
    const std::string other = RoomOf(header);
    if (header.find('/') != std::string::npos && std::ranges::count(kRooms, other) &&
        other != room) {
      const auto& allowed = kArrows.at(room);
      const bool drawn =
          std::ranges::any_of(allowed, [&](const auto& a) { return header.starts_with(a); });
      if (!drawn) found.push_back(where + room + " must not include " + header);
    }
    for (const LibraryRule& rule : LibraryRules()) {
      if (std::regex_match(header, rule.header) && !std::regex_match(path, rule.files))
        found.push_back(where + rule.name + " does not belong here (" + header + ")");
    }
    if (room == "grammar" && kForbiddenInGrammar.contains(header))
      found.push_back(where + "the grammar room has no files, clocks or logging (<" + header +
                      ">)");
  }
  if (count > kMaxLines)
    found.push_back(path + ": " + std::to_string(count) + " lines; split it by stage (limit " +
                    std::to_string(kMaxLines) + ")");
  if (!text.starts_with("// SPDX-License-Identifier: Apache-2.0"))
    found.push_back(path + ": first line is not the SPDX line");
  return found;
}

TEST(Architecture, EveryFileKeepsTheBorders) {
  const auto files = SourceFiles(kRooms);
  ASSERT_GT(files.size(), 30u) << "the source tree was not found";
  for (const SourceFile& file : files) {
    for (const std::string& violation : Violations(file.path, file.text))
      ADD_FAILURE() << violation;
  }
}

TEST(Architecture, EveryFileIsLaidOutByClangFormat) {
  const fs::path list = fs::path(testing::TempDir()) / "source_files.txt";
  const fs::path complaints = fs::path(testing::TempDir()) / "layout_complaints.txt";
  {
    std::ofstream out(list);
    for (const SourceFile& file : SourceFiles(kRooms))
      out << (fs::path(PREHEND_SOURCE_DIR) / file.path).string() << "\n";
  }
  const std::string command = "xargs clang-format --dry-run -Werror < '" + list.string() +
                              "' 2> '" + complaints.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0)
      << Slurp(complaints).substr(0, 2000) << "\nmend with: clang-format -i FILE";
}

TEST(Architecture, MedianFileIsShort) {
  std::vector<long> lengths;
  for (const SourceFile& file : SourceFiles(kRooms))
    lengths.push_back(std::ranges::count(file.text, '\n'));
  std::ranges::nth_element(lengths, lengths.begin() + lengths.size() / 2);
  EXPECT_LE(lengths[lengths.size() / 2], 200);
}

// An evaluator of its own: it never sees what it judges.
TEST(Architecture, ClosedFormsSeeNeitherGrammarNorOracle) {
  for (const SourceFile& file : SourceFiles({"tests/witnesses/closed_form"})) {
    for (const Include& include : IncludesOf(file.text))
      EXPECT_FALSE((include.header.starts_with("grammar/") &&
                    !include.header.starts_with("grammar/base/")) ||
                   include.header.starts_with("harness/truth/oracle/") ||
                   include.header.starts_with("harness/episode/run/"))
          << file.path << ":" << include.line << ": " << include.header;
  }
}

TEST(Architecture, DataRoomsHoldNoCode) {
  for (const char* room : {"scenarios", "golden", "tests/witnesses/stories"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PREHEND_SOURCE_DIR) / room)) {
      const auto extension = entry.path().extension();
      EXPECT_TRUE(extension != ".cc" && extension != ".h" && extension != ".sh" &&
                  extension != ".py")
          << entry.path();
    }
  }
}

struct Case {
  const char* path;
  const char* include;
  const char* complaint;  ///< part of it; "" when the include is fine
};

class ArchitectureRule : public testing::TestWithParam<Case> {};

TEST_P(ArchitectureRule, Holds) {
  const Case& c = GetParam();
  const std::string text =
      "// SPDX-License-Identifier: Apache-2.0\n#include " + std::string(c.include) + "\n";
  const auto violations = Violations(c.path, text);
  if (std::string(c.complaint).empty()) {
    EXPECT_TRUE(violations.empty()) << violations.front();
  } else {
    ASSERT_EQ(violations.size(), 1u);
    EXPECT_NE(violations[0].find(c.complaint), std::string::npos) << violations[0];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Borders, ArchitectureRule,
    testing::Values(
        Case{"grammar/a.cc", "\"physics/scene/scene.h\"",
             "grammar must not include physics/scene/scene.h"},
        Case{"physics/a.cc", "\"grammar/base/frame.h\"",
             "physics must not include grammar/base/frame.h"},
        Case{"render/a.cc", "\"physics/simulation.h\"",
             "render must not include physics/simulation.h"},
        Case{"render/a.cc", "\"physics/scene/snapshot.h\"", ""},
        Case{"harness/a.cc", "\"render/picture.h\"", ""},
        Case{"harness/a.cc", "\"tests/helper.h\"", "harness must not include tests/helper.h"},
        Case{"grammar/a.cc", "<yaml-cpp/yaml.h>", "yaml-cpp does not belong here"},
        Case{"physics/world/world.cc", "<btBulletDynamicsCommon.h>", "Bullet does not belong here"},
        Case{"physics/bullet/world.cc", "<btBulletDynamicsCommon.h>", ""},
        Case{"harness/a.cc", "<GL/osmesa.h>", "OpenGL and OSMesa does not belong here"},
        Case{"harness/cli/cli/a.cc", "<CLI/CLI.hpp>", "CLI11 does not belong here"},
        Case{"harness/cli/command/parse_arguments.cc", "<CLI/CLI.hpp>", ""},
        Case{"grammar/a.cc", "<fstream>", "the grammar room has no files"},
        Case{"bench/a.cc", "<gtest/gtest.h>", "GoogleTest does not belong here"}));

TEST(ArchitectureRuleOfLength, ComplainsAboveTheLimit) {
  std::string text = "// SPDX-License-Identifier: Apache-2.0\n";
  for (int i = 0; i < kMaxLines; ++i) text += "\n";
  ASSERT_EQ(Violations("grammar/a.cc", text).size(), 1u);
  EXPECT_NE(Violations("grammar/a.cc", text)[0].find("601 lines"), std::string::npos);
}

}  // namespace
}  // namespace prehend::architecture
