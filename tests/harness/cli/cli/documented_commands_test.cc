// SPDX-License-Identifier: Apache-2.0
// Commands that the documents print: each is one of the program's, with options that it has. None
// is run here.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "harness/cli/cli/command_line.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// The words as a shell has them, up to a comment, a pipe or a redirection.
std::vector<std::string> ShellWords(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  bool has_word = false;
  char quote = 0;
  for (const char c : line + " ") {
    if (quote) {
      if (c == quote)
        quote = 0;
      else
        word += c;
      continue;
    }
    if (c == '\'' || c == '"') {
      quote = c;
      has_word = true;
    } else if (c == ' ') {
      if (has_word && (word == "#" || word == "|" || word == ">" || word == "&&")) return words;
      if (has_word) words.push_back(word);
      word.clear();
      has_word = false;
    } else {
      word += c;
      has_word = true;
    }
  }
  return words;
}

struct Documented {
  std::string where;
  std::string text;       ///< after the program's name
  bool is_whole = false;  ///< can be typed as it is; otherwise there may be placeholders
};

/// Those of blocks, one a line, and of `inline code`.
std::vector<Documented> CommandsOf(const fs::path& page) {
  std::vector<Documented> found;
  std::ifstream file(page);
  bool in_block = false;
  int number = 0;
  const std::regex typed("(?:^|\\| |\\$ )(?:prehend|\\./run) (\\S.*)"), code("`([^`]+)`");
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string where = page.filename().string() + ":" + std::to_string(number);
    std::smatch match;
    if (line.starts_with("```")) {
      in_block = !in_block;
    } else if (in_block) {
      for (std::string more; line.ends_with('\\') && std::getline(file, more); ++number)
        line.replace(line.size() - 1, 1, more);
      if (std::regex_search(line, match, typed)) found.push_back({where, match[1], true});
    } else {
      for (std::sregex_iterator at(line.begin(), line.end(), code), end; at != end; ++at) {
        const std::string inside = (*at)[1];
        if (std::regex_search(inside, match, typed)) found.push_back({where, match[1]});
      }
    }
  }
  return found;
}

/// Why the command cannot be typed, or "".
std::string WhyWrong(const Documented& documented) {
  static const std::vector<Command> commands = AllCommands();
  std::vector<std::string> words = ShellWords(documented.text);
  if (documented.is_whole) {
    const ParsedArguments parsed = ParseArguments(DescribeProgram("prehend 1"), commands, words);
    const auto* const error = std::get_if<UsageError>(&parsed);
    return error ? error->message : "";
  }
  // Its words may stand for others, but its command and its options are there.
  if (words.front() == "COMMAND" || words.front() == "ARGS") return "";
  const auto first_option =
      std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("-"); });
  for (std::vector<std::string> name(words.begin(), first_option); !name.empty(); name.pop_back()) {
    std::vector<std::string> asked = name;
    asked.push_back("--help");
    const ParsedArguments help = ParseArguments(DescribeProgram("prehend 1"), commands, asked);
    const auto* const info = std::get_if<InfoText>(&help);
    if (!info) continue;
    for (auto word = first_option; word != words.end(); ++word) {
      const std::string option = word->substr(0, word->find('='));
      if (!option.starts_with("--") || option == "--help" || option.ends_with("limit-s")) continue;
      if (!std::regex_search(info->text, std::regex(option + "\\b"))) return "no option " + option;
    }
    return "";
  }
  return first_option == words.begin() ? "" : "no such command";
}

TEST(DocumentedCommands, CanBeTyped) {
  const fs::path root = PREHEND_SOURCE_DIR;
  std::vector<fs::path> pages = {root / "README.md", root / "CONTRIBUTING.md",
                                 root / "ARCHITECTURE.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  std::size_t whole = 0, parts = 0;
  for (const fs::path& page : pages) {
    for (const Documented& documented : CommandsOf(page)) {
      ++(documented.is_whole ? whole : parts);
      EXPECT_EQ(WhyWrong(documented), "") << documented.where << ": " << documented.text;
    }
  }
  EXPECT_GE(whole, 120u);
  EXPECT_GE(parts, 50u);
}

}  // namespace
}  // namespace prehend::cli
