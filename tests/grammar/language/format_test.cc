// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "grammar/language/parser.h"
#include "grammar/language/token_reader.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/language/dump_file.h"

namespace prehend::grammar {
namespace {

std::string Formatted(const std::string& text) { return FormatText({"g", text}); }

std::vector<std::string> Library() {
  std::vector<std::string> texts;
  for (const auto& file :
       std::filesystem::directory_iterator(PREHEND_SOURCE_DIR "/grammar/library"))
    if (file.path().extension() == ".grammar")
      texts.push_back(testing::ReadFile(file.path().string()));
  EXPECT_GT(texts.size(), 30u);
  return texts;
}

std::vector<std::string> Comments(const std::string& text) {
  std::vector<std::string> comments;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(" #") != line.npos ? line.find(" #") + 1 : line.find('#');
    if (at == line.npos || line.find('"') < at) continue;
    line = line.substr(at);
    comments.push_back(line.substr(0, line.find_last_not_of(" \t\r") + 1));
  }
  return comments;
}

std::string Meaning(const std::string& text) {
  Diagnostics diagnostics;
  const ast::File file = Parse({"g", text}, diagnostics);
  return Format(diagnostics) + Dump(file);
}

TEST(Format, TheLibraryIsAFixedPoint) {
  for (const std::string& text : Library()) EXPECT_EQ(Formatted(text), text);
}

TEST(Format, LaysOutWhatWasTypedInAnyWay) {
  EXPECT_EQ(Formatted("grammar   g # name\r\n\n\n\nuse contact\nparam  a=3cm   # wide\n"
                      "event e(h :Hand,c:Cup)while speed( c )>-a+2 cm / s and not(touching(h,c))\n"
                      "lasting 1s\n   # last\nrequires rise(c)@ end>3"),
            "grammar g # name\n\nuse contact\nparam a = 3 cm   # wide\n"
            "event e(h: Hand, c: Cup) while speed(c) > -a + 2 cm/s and not (touching(h, c))\n"
            "  lasting 1 s\n  # last\n  requires rise(c)@end > 3\n");
}

// Blanks are taken away where they do not matter, and put in anywhere between tokens.
TEST(Format, KeepsMeaningAndCommentsAndIsIdempotent) {
  std::mt19937 random(3);
  const std::vector<std::string> library = Library();
  for (int round = 0; round < 1000; ++round) {
    const std::string& text = library[random() % library.size()];
    std::string typed;
    bool in_comment = false, in_quotes = false;
    for (const char c : text) {
      in_comment = c != '\n' && (in_comment || (c == '#' && !in_quotes));
      if (c == '"' && !in_comment) in_quotes = !in_quotes;
      typed += c;
      const bool may = c == ' ' && !in_comment && !in_quotes;
      if (may && random() % 8 == 0) typed += std::string(random() % 4, " \t\n"[random() % 3]);
    }
    const std::string once = Formatted(typed);
    ASSERT_EQ(Formatted(once), once);
    ASSERT_EQ(Meaning(once), Meaning(text));
    ASSERT_EQ(Comments(once), Comments(text));
  }
}

}  // namespace
}  // namespace prehend::grammar
