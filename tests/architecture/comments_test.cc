// SPDX-License-Identifier: Apache-2.0
// What comments and documents point at exists: every path of the project that they name, and every
// test after "Tested by". The checker itself is tested on made-up text, so that it can't rot.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Whether the tree has what a path means.
using Exists = std::function<bool(const std::string& path)>;

/// The comment of one line of a source; empty when it has none. A "//" in a string starts none.
std::string_view CommentIn(std::string_view line, bool is_cmake) {
  const std::string_view mark = is_cmake ? "#" : "//";
  bool in_string = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\\') {
      ++i;
    } else if (line[i] == '"') {
      in_string = !in_string;
    } else if (!in_string && line.substr(i).starts_with(mark)) {
      return line.substr(i + mark.size());
    }
  }
  return {};
}

/// The paths of the project in a text, from its root: "harness/suite/report/history.cc". The last
/// character is none of a sentence.
std::vector<std::string> PathsIn(std::string_view text) {
  static const std::regex path(
      "(^|[^A-Za-z0-9_./-])((grammar|physics|render|harness|tests|bench|docs|scenarios|golden)"
      "/[A-Za-z0-9_./*{},<>-]*[A-Za-z0-9_/*}>])");
  std::vector<std::string> paths;
  using Matches = std::regex_iterator<std::string_view::const_iterator>;
  for (Matches match(text.begin(), text.end(), path); match != Matches(); ++match)
    paths.push_back((*match)[2]);
  return paths;
}

/// Names of sources that a text gives without their folder: a script that moves files misses them.
std::vector<std::string> BareNamesIn(std::string_view text) {
  static const std::regex name("(^|[^A-Za-z0-9_./*{}-])([a-z0-9_]+\\.(h|cc))($|[^A-Za-z0-9_])");
  static const std::set<std::string> of_the_system = {"gl.h", "osmesa.h"};
  std::vector<std::string> names;
  using Matches = std::regex_iterator<std::string_view::const_iterator>;
  for (Matches match(text.begin(), text.end(), name); match != Matches(); ++match) {
    if (!of_the_system.contains((*match)[2])) names.push_back((*match)[2]);
  }
  return names;
}

/// "a/{b,c}.h" is "a/b.h" and "a/c.h".
std::vector<std::string> Expanded(const std::string& path) {
  const std::size_t open = path.find('{'), close = path.find('}', open);
  if (close == path.npos) return {path};
  std::vector<std::string> all;
  std::istringstream choices(path.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(choices, choice, ',');) {
    for (std::string& one : Expanded(path.substr(0, open) + choice + path.substr(close + 1)))
      all.push_back(std::move(one));
  }
  return all;
}

/// A path with a part that the reader replaces: "golden/SKILL/NAME.timeline", "tests/<room>/".
bool IsPattern(const std::string& path) {
  static const std::regex part("<[a-z]+>|[A-Z][A-Z]+|\\bID\\b");
  return std::regex_search(path, part);
}

/// Documents show scenarios that the reader makes, in examples between lines of ```.
bool IsAReadersOwn(const std::string& path) {
  return path.starts_with("scenarios/") || path.starts_with("golden/");
}

/// One sentence per path that does not exist or has no folder, and per "Tested by" without a test.
std::vector<std::string> DeadReferences(const std::string& file, const std::string& text,
                                        const Exists& exists) {
  const bool is_document = file.ends_with(".md"), is_cmake = file.ends_with("CMakeLists.txt");
  const bool is_test = file.starts_with("tests/");
  std::vector<std::string> found;
  std::istringstream lines(text);
  bool in_example = false, test_must_follow = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = file + ":" + std::to_string(++number) + ": ";
    if (is_document && line.starts_with("```")) in_example = !in_example;
    const std::string_view comment = is_document ? line : CommentIn(line, is_cmake);
    const std::vector<std::string> paths = PathsIn(comment);
    for (const std::string& whole : paths) {
      if (IsPattern(whole) || (in_example && IsAReadersOwn(whole))) continue;
      for (const std::string& path : Expanded(whole)) {
        if (!exists(path)) found.push_back(where + path + " does not exist");
      }
    }
    if (is_document) continue;
    for (const std::string& name : BareNamesIn(comment))
      found.push_back(where + name + ": write its path from the root");
    if (is_test) continue;
    constexpr std::string_view kTestedBy = "Tested by";
    const std::size_t at = comment.find(kTestedBy);
    const auto names_test = [](std::string_view words) {
      words.remove_prefix(std::min(words.size(), words.find_first_not_of(' ')));
      return words.starts_with("tests/");
    };
    if (test_must_follow && !names_test(comment)) found.push_back(where + "Tested by which test?");
    const std::string_view after =
        at == comment.npos ? std::string_view() : comment.substr(at + kTestedBy.size());
    const bool is_at_end = at != comment.npos && after.empty();
    if (at != comment.npos && !is_at_end && !names_test(after))
      found.push_back(where + "Tested by which test?");
    test_must_follow = is_at_end;
  }
  return found;
}

/// A file, a folder, a unit named without its ending ("grammar/state/ring_buffer"), or a pattern
/// with a "*" that fits one.
bool IsInTree(const std::string& path, const std::set<std::string>& tree) {
  if (path.find('*') == path.npos) {
    return tree.contains(path) || tree.contains(path + ".h") || tree.contains(path + ".cc");
  }
  const std::string escaped = std::regex_replace(path, std::regex("[.+]"), "\\$&");
  const std::regex pattern(std::regex_replace(escaped, std::regex("\\*"), "[^/]*"));
  return std::ranges::any_of(tree, [&](const auto& one) { return std::regex_match(one, pattern); });
}

/// Files and folders from the root, a folder with and without its last "/".
std::set<std::string> Tree() {
  std::set<std::string> tree;
  for (const char* room : {"grammar", "physics", "render", "harness", "tests", "bench", "docs",
                           "scenarios", "golden"}) {
    tree.insert({room, std::string(room) + "/"});
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PREHEND_SOURCE_DIR) / room)) {
      const std::string path = entry.path().lexically_relative(PREHEND_SOURCE_DIR).generic_string();
      tree.insert(path);
      if (entry.is_directory()) tree.insert(path + "/");
    }
  }
  return tree;
}

bool HasReferences(const std::string& path) {
  const bool is_source = path.ends_with(".h") || path.ends_with(".cc");
  return is_source || path.ends_with("CMakeLists.txt") || path.ends_with(".md");
}

TEST(Comments, WhatTheyPointAtExists) {
  const std::set<std::string> tree = Tree();
  std::vector<std::string> files = {"ARCHITECTURE.md", "CMakeLists.txt", "CONTRIBUTING.md",
                                    "README.md"};
  std::ranges::copy_if(tree, std::back_inserter(files), HasReferences);
  ASSERT_GT(files.size(), 500u);
  for (const std::string& file : files) {
    std::ifstream in(fs::path(PREHEND_SOURCE_DIR) / file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto exists = [&](const std::string& path) { return IsInTree(path, tree); };
    for (const std::string& dead : DeadReferences(file, text, exists)) ADD_FAILURE() << dead;
  }
}

using Sentences = std::vector<std::string>;

Sentences Dead(const std::string& file, const std::string& text) {
  const std::set<std::string> tree = {"grammar/state/ring_buffer.h", "grammar/",
                                      "tests/grammar/state/ring_buffer_test.cc", "docs/speed.md",
                                      "scenarios/slide/there.yaml"};
  return DeadReferences(file, text, [&](const auto& path) { return IsInTree(path, tree); });
}

TEST(Comments, ADeadPathIsFoundInEveryKindOfFile) {
  EXPECT_EQ(Dead("grammar/a.h", "int a;\n// See grammar/state/ring_buffer.h, grammar/gone.h.\n"),
            Sentences{"grammar/a.h:2: grammar/gone.h does not exist"});
  EXPECT_EQ(Dead("grammar/a.cc", "int a;  ///< (as in grammar/gone)\n"),
            Sentences{"grammar/a.cc:1: grammar/gone does not exist"});
  EXPECT_EQ(Dead("CMakeLists.txt", "# Checked by tests/gone_test.cc\n"),
            Sentences{"CMakeLists.txt:1: tests/gone_test.cc does not exist"});
  EXPECT_EQ(Dead("docs/a.md", "| speed | `docs/speed.md`, `docs/{speed,gone}.md`. |\n"),
            Sentences{"docs/a.md:1: docs/gone.md does not exist"});
  EXPECT_EQ(Dead("docs/a.md", "See `scenarios/slide/gone.yaml`.\n"),
            Sentences{"docs/a.md:1: scenarios/slide/gone.yaml does not exist"});
}

TEST(Comments, FoldersUnitsAndPatternsExist) {
  EXPECT_EQ(Dead("grammar/a.h",
                 "// grammar/state/ring_buffer, grammar/, grammar/state/r*.h, "
                 "tests/*/*/ring_buffer_test.cc\n"),
            Sentences{});
  EXPECT_EQ(Dead("grammar/a.h", "// grammar/b*.h\n"),
            Sentences{"grammar/a.h:1: grammar/b*.h does not exist"});
}

TEST(Comments, WhatIsNoPathOfTheTreeIsLeftAlone) {
  EXPECT_EQ(Dead("grammar/a.cc", "const char* a = \"// grammar/gone.h\";\n"), Sentences{});
  EXPECT_EQ(Dead("grammar/a.cc", "#include \"grammar/gone.h\"\n"), Sentences{}) << "the compiler";
  EXPECT_EQ(Dead("grammar/a.h", "// golden/SKILL/NAME.timeline, build/grammar/gone.h\n"),
            Sentences{});
  EXPECT_EQ(Dead("docs/a.md", "```sh\n./run new it  # scenarios/slide/it.yaml\n```\n"),
            Sentences{});
}

TEST(Comments, SourcesAreNamedFromTheRoot) {
  EXPECT_EQ(Dead("grammar/a.cc", "// See ring.h.\n"),
            Sentences{"grammar/a.cc:1: ring.h: write its path from the root"});
  EXPECT_EQ(Dead("render/a.cc", "// What osmesa.h wants.\n"), Sentences{});
}

TEST(Comments, TestedByNamesATest) {
  EXPECT_EQ(Dead("grammar/a.h", "// Tested by tests/grammar/state/ring_buffer_test.cc\n"),
            Sentences{});
  EXPECT_EQ(
      Dead("grammar/a.h", "// It is. Tested by\n// tests/grammar/state/ring_buffer_test.cc\n"),
      Sentences{});
  EXPECT_EQ(Dead("grammar/a.h", "// Tested by hand\n"),
            Sentences{"grammar/a.h:1: Tested by which test?"});
  EXPECT_EQ(Dead("grammar/a.h", "// Tested by\n// hand\n"),
            Sentences{"grammar/a.h:2: Tested by which test?"});
  EXPECT_EQ(Dead("tests/grammar/a.h", "// Tested by what uses it\n"), Sentences{});
}

}  // namespace
