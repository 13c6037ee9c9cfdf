// SPDX-License-Identifier: Apache-2.0
// The links of the pages lead somewhere: to a file that is there and, after a "#", to one of its
// headings, by the names that GitHub gives them. The pages are found from their index in two
// clicks.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

namespace fs = std::filesystem;

/// The lines outside of blocks of code.
std::vector<std::string> ProseOf(const fs::path& page) {
  std::vector<std::string> lines;
  std::istringstream text(Slurp(page));
  bool in_block = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) in_block = !in_block;
    if (!in_block) lines.push_back(line);
  }
  return lines;
}

/// The anchors of its headings: small letters, blanks as "-", nothing but letters, digits, "-" and
/// "_".
std::set<std::string> AnchorsOf(const fs::path& page) {
  std::set<std::string> anchors;
  for (const std::string& line : ProseOf(page)) {
    const std::size_t begin = line.find_first_not_of('#');
    if (begin == 0 || begin == std::string::npos || line[begin] != ' ') continue;
    std::string anchor;
    for (const char c : line.substr(begin + 1)) {
      const auto letter = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      if (std::isalnum(letter) || c == '-' || c == '_')
        anchor += static_cast<char>(std::tolower(letter));
    }
    anchors.insert(anchor);
  }
  return anchors;
}

struct Link {
  std::string text;
  fs::path page;
  std::string anchor;
};

std::vector<Link> LinksOf(const fs::path& page) {
  static const std::regex link("\\]\\(([^)\\s]+)\\)"), code("`[^`]*`");
  std::vector<Link> links;
  for (const std::string& line : ProseOf(page)) {
    const std::string prose = std::regex_replace(line, code, "");
    for (std::sregex_iterator at(prose.begin(), prose.end(), link), end; at != end; ++at) {
      const std::string target = (*at)[1];
      if (target.starts_with("http")) continue;
      const std::size_t hash = target.find('#');
      const std::string file = target.substr(0, hash);
      links.push_back({target, file.empty() ? page : (page.parent_path() / file).lexically_normal(),
                       hash == std::string::npos ? "" : target.substr(hash + 1)});
    }
  }
  return links;
}

std::vector<fs::path> Pages() {
  const fs::path root = PREHEND_SOURCE_DIR;
  std::vector<fs::path> pages = {root / "README.md", root / "CONTRIBUTING.md",
                                 root / "ARCHITECTURE.md"};
  for (const char* folder : {"docs", "tests", "physics"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  return pages;
}

TEST(Links, OfThePagesLeadSomewhere) {
  int links = 0;
  for (const fs::path& page : Pages()) {
    for (const Link& link : LinksOf(page)) {
      ++links;
      EXPECT_TRUE(fs::exists(link.page)) << page << " links to " << link.text;
      if (link.anchor.empty() || !fs::exists(link.page)) continue;
      EXPECT_TRUE(AnchorsOf(link.page).contains(link.anchor)) << page << " links to " << link.text;
    }
  }
  EXPECT_GT(links, 400);
}

TEST(Links, TheIndexLeadsToEachPageInTwoClicks) {
  const fs::path docs = fs::path(PREHEND_SOURCE_DIR) / "docs";
  std::set<fs::path> reached = {docs / "README.md"};
  for (int click = 0; click < 2; ++click) {
    for (const fs::path& page : std::set(reached)) {
      if (page.extension() != ".md") continue;
      for (const Link& link : LinksOf(page)) reached.insert(link.page);
    }
  }
  for (const auto& entry : fs::recursive_directory_iterator(docs)) {
    if (entry.path().extension() != ".md") continue;
    EXPECT_TRUE(reached.contains(entry.path())) << entry.path();
  }
}

}  // namespace
}  // namespace prehend::architecture
