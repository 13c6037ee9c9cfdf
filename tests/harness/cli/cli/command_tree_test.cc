// SPDX-License-Identifier: Apache-2.0
// The tree of commands: its screens, and what becomes of names that are in it no longer.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

#include "harness/cli/cli/command_line.h"

namespace prehend::cli {
namespace {

ParsedArguments Typed(const std::vector<std::string>& words) {
  static const std::vector<Command> commands = AllCommands();
  return ParseArguments(DescribeProgram("prehend 1"), commands, words);
}

std::string Screen(const std::vector<std::string>& words) {
  const ParsedArguments parsed = Typed(words);
  const auto* const info = std::get_if<InfoText>(&parsed);
  return info ? info->text : "";
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> WordsIn(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

TEST(CommandTree, HelpIsOneScreen) {
  const std::vector<std::string> lines = LinesOf(Screen({"--help"}));
  EXPECT_LE(lines.size(), 40u);
  std::set<std::string> words;
  for (const std::string& line : lines) {
    EXPECT_LE(line.size(), 100u) << line;
    if (line.starts_with("  ") && line[2] != ' ' && line[2] != '-') words.insert(WordsIn(line)[0]);
  }
  std::set<std::string> first;
  for (const Command& command : AllCommands()) first.insert(WordsIn(command.name)[0]);
  EXPECT_EQ(words, first);
  EXPECT_EQ(first.size(), 16u);
}

// The program's help tells of what nearly every command takes.
TEST(CommandTree, AHelpListsJobsWhereTheyAreTaken) {
  EXPECT_EQ(Screen({"--help"}).find("--jobs"), std::string::npos);
  for (const Command& command : AllCommands()) {
    std::vector<std::string> words = WordsIn(command.name);
    words.push_back("--help");
    const bool takes_jobs = std::ranges::any_of(
        command.options, [](const Option& option) { return option.name == "--jobs"; });
    EXPECT_EQ(Screen(words).find("-j,--jobs N") != std::string::npos, takes_jobs) << command.name;
  }
}

TEST(CommandTree, ANounAloneIsUsageAndItsHelpListsItsCommands) {
  for (const Noun& noun : DescribeProgram("prehend 1").nouns) {
    const ParsedArguments alone = Typed({noun.name});
    ASSERT_TRUE(std::holds_alternative<InfoText>(alone));
    EXPECT_FALSE(std::get<InfoText>(alone).asked_for);
    const std::string help = Screen({noun.name, "--help"});
    EXPECT_EQ(help, std::get<InfoText>(alone).text);
    for (const Command& command : AllCommands()) {
      const std::vector<std::string> words = WordsIn(command.name);
      if (words[0] != noun.name) continue;
      EXPECT_NE(help.find("\n  " + words[1] + " "), std::string::npos) << help;
      EXPECT_NE(Screen({words[0], words[1], "-h"}).find("Usage: prehend " + command.name + " ["),
                std::string::npos);
    }
  }
}

TEST(CommandTree, AnOldNameIsAnErrorThatSaysTheNewOne) {
  ASSERT_EQ(DescribeProgram("prehend 1").old_commands.size(), 14u);
  for (const OldName& name : DescribeProgram("prehend 1").old_commands) {
    std::vector<std::string> corrected = WordsIn(name.now);
    const std::vector<std::string> start = corrected;
    corrected.push_back("--help");
    EXPECT_TRUE(std::holds_alternative<InfoText>(Typed(corrected))) << name.now;
    for (std::vector<std::string> words :
         {std::vector<std::string>{name.old, "--help"}, {start[0], name.old, "--help"}}) {
      const ParsedArguments parsed = Typed(words);
      if (words.size() == 3 && start[1] == name.old) continue;  // it is the new name
      ASSERT_TRUE(std::holds_alternative<UsageError>(parsed)) << name.old;
      words.pop_back();
      EXPECT_EQ(std::get<UsageError>(parsed).message,
                "'" + words.front() + (words.size() > 1 ? " " + words.back() : "") +
                    "' is called '" + name.now + "' now");
      EXPECT_EQ(std::get<UsageError>(parsed).corrected, corrected);
    }
  }
}

TEST(CommandTree, AnOldOptionIsAnErrorThatSaysTheNewOne) {
  for (const OldName& name : DescribeProgram("prehend 1").old_options) {
    std::vector<std::string> words = WordsIn(name.old);
    const std::string option = words.back();
    words.insert(words.end(), {"a", "b", "-o", "c", "--map", "d"});  // what some commands must have
    const ParsedArguments parsed = Typed(words);
    ASSERT_TRUE(std::holds_alternative<UsageError>(parsed)) << name.old;
    EXPECT_EQ(std::get<UsageError>(parsed).message,
              "'" + option + "' is called '" + name.now + "' now");
    std::ranges::replace(words, option, name.now);
    EXPECT_EQ(std::get<UsageError>(parsed).corrected, words);
  }
}

TEST(CommandTree, ScreensAreNarrowAndOptionsFew) {
  std::size_t options = 5;  // of the program's own screen
  for (const Command& command : AllCommands()) {
    std::vector<std::string> words = WordsIn(command.name);
    words.push_back("--help");
    const std::string screen = Screen(words);
    for (const std::string& line : LinesOf(screen)) {
      EXPECT_LE(line.size(), 100u) << command.name << ": " << line;
      if (!line.starts_with("  -")) continue;
      ++options;
      for (const Option& option : command.options)
        EXPECT_FALSE(option.unlisted && WordsIn(line)[0] == option.name) << screen;
    }
    for (const Option& option : command.options)
      EXPECT_TRUE(option.unlisted || screen.find(option.name) != std::string::npos) << screen;
  }
  EXPECT_LE(options, 200u);
  RecordProperty("options", std::to_string(options));
}

TEST(CommandTree, AnUnknownCommandIsAnErrorAlsoWhenItsHelpIsAsked) {
  const struct {
    const char* typed;
    const char* message;
    const char* corrected;
    const char* see;
  } all[] = {
      {"chekc --help", "unknown command 'chekc'; did you mean 'check'?", "check --help", ""},
      {"zzz -h", "unknown command 'zzz'", "", ""},
      {"episod --help", "unknown command 'episod'; did you mean 'episode'?", "episode --help", ""},
      {"episode lst a.episodes", "unknown command 'episode lst'; did you mean 'episode list'?",
       "episode list a.episodes", "episode"},
      {"grammar qqqqq", "unknown command 'grammar qqqqq'", "", "grammar"},
  };
  for (const auto& one : all) {
    const ParsedArguments parsed = Typed(WordsIn(one.typed));
    ASSERT_TRUE(std::holds_alternative<UsageError>(parsed)) << one.typed;
    const auto& error = std::get<UsageError>(parsed);
    EXPECT_EQ(error.message, one.message);
    EXPECT_EQ(error.corrected, WordsIn(one.corrected));
    EXPECT_EQ(error.command, one.see);
  }
}

}  // namespace
}  // namespace prehend::cli
