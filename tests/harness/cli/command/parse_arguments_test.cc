// SPDX-License-Identifier: Apache-2.0
// Options as data: what is typed, what becomes of it, and what is said of what is wrong.
#include "harness/cli/command/parse_arguments.h"

#include <gtest/gtest.h>

namespace prehend::cli {
namespace {

const std::vector<Command>& Commands() {
  static const std::vector<Command> commands = {
      {.name = "pour",
       .summary = "Pour something",
       .examples = {"pour milk", "pour milk --into cup"},
       .options =
           {{.name = "liquid", .help = "what is poured", .required = true},
            {.name = "--into", .help = "the vessel", .placeholder = "VESSEL", .other_name = "-i"},
            {.name = "--stir",
             .help = "how often",
             .placeholder = "N",
             .rule = IntegersFrom(1, 20)},
            {.name = "--tilt",
             .help = "how far",
             .placeholder = "DEG",
             .rule = NumbersFrom(0.5, 90)},
            {.name = "--add", .help = "more", .placeholder = "WHAT", .repeatable = true},
            {.name = "--dry", .help = "pour nothing"}}},
      {.name = "wash",
       .summary = "Wash things",
       .examples = {"wash"},
       .options = {{.name = "things", .help = "what; default: all", .repeatable = true}}}};
  return commands;
}

ParsedArguments Parse(const std::vector<std::string>& words) {
  return ParseArguments({.version = "kitchen 1.0",
                         .summary = "A kitchen.",
                         .footer = "Mind the step.",
                         .groups = {{"Chores", {"pour", "wash"}}}},
                        Commands(), words);
}

ParsedOptions OptionsOf(const std::vector<std::string>& words) {
  const ParsedArguments parsed = Parse(words);
  if (const auto* error = std::get_if<UsageError>(&parsed)) ADD_FAILURE() << error->message;
  const auto* const chosen = std::get_if<ChosenCommand>(&parsed);
  return chosen ? chosen->options : ParsedOptions();
}

TEST(ParseArguments, GivesTheCommandAndTypedValues) {
  const ParsedArguments parsed = Parse({"pour", "milk", "--stir", "3"});
  ASSERT_TRUE(std::holds_alternative<ChosenCommand>(parsed));
  EXPECT_EQ(std::get<ChosenCommand>(parsed).command, &Commands()[0]);

  const ParsedOptions options = OptionsOf(
      {"pour", "-i", "cup", "milk", "--stir=3", "--tilt", "12.5", "--add", "a", "--add", "b"});
  EXPECT_EQ(options.Text("liquid"), "milk");
  EXPECT_EQ(options.Text("--into"), "cup");
  EXPECT_EQ(options.IntOr("--stir", 1), 3);
  EXPECT_EQ(options.UnsignedOr("--stir", 1), 3u);
  EXPECT_EQ(options.NumberOr("--tilt", 0), 12.5);
  EXPECT_EQ(options.All("--add"), (std::vector<std::string>{"a", "b"}));
  EXPECT_FALSE(options.Has("--dry"));
  EXPECT_TRUE(OptionsOf({"pour", "milk", "--dry"}).Has("--dry"));
  EXPECT_EQ(OptionsOf({"wash", "cup", "pan"}).All("things"),
            (std::vector<std::string>{"cup", "pan"}));
}

TEST(ParseArguments, WhatIsNotTypedHasTheFallback) {
  const ParsedOptions options = OptionsOf({"pour", "milk"});
  EXPECT_EQ(options.Text("--into"), "");
  EXPECT_EQ(options.TextOr("--into", "bowl"), "bowl");
  EXPECT_EQ(options.IntOr("--stir", 7), 7);
  EXPECT_EQ(options.NumberOr("--tilt", 45.5), 45.5);
  EXPECT_TRUE(options.All("--add").empty());
  EXPECT_THROW(options.Has("--unheard-of"), std::out_of_range) << "an error of the program";
}

struct Wrong {
  std::vector<std::string> words;
  std::string message;
  std::string command;                 ///< whose help is pointed at
  std::vector<std::string> corrected;  ///< or empty
};

TEST(ParseArguments, UsageErrorsSayWhatWasFoundAndWanted) {
  const std::vector<Wrong> all = {
      {{"puor", "milk"}, "unknown command 'puor'; did you mean 'pour'?", "", {"pour", "milk"}},
      {{"fry"}, "unknown command 'fry'", "", {}},
      {{"--versoin"}, "unknown option '--versoin'; did you mean '--version'?", "", {"--version"}},
      {{"pour", "milk", "--itno=cup"},
       "unknown option '--itno'; did you mean '--into'?",
       "pour",
       {"pour", "milk", "--into=cup"}},
      {{"pour", "milk", "--zzzzzz"}, "unknown option '--zzzzzz'", "pour", {}},
      {{"pour", "milk", "tea"}, "unexpected argument 'tea'", "pour", {}},
      {{"pour"}, "the argument 'liquid' is missing", "pour", {}},
      {{"pour", ""}, "liquid: the value is empty", "pour", {}},
      {{"pour", "milk", "--into"}, "--into: the value is missing; write --into VESSEL", "pour", {}},
      {{"pour", "milk", "-i", "a", "--into", "b"}, "--into is given more than once", "pour", {}},
      {{"pour", "milk", "--dry=3"}, "--dry takes no value", "pour", {}},
      {{"pour", "milk", "--stir", "0"},
       "--stir: found '0', wanted a whole number from 1 to 20",
       "pour",
       {}},
      {{"pour", "milk", "--stir", "2.5"},
       "--stir: found '2.5', wanted a whole number from 1 to 20",
       "pour",
       {}},
      {{"pour", "milk", "--stir", "99999999999999999999"},
       "--stir: found '99999999999999999999', wanted a whole number from 1 to 20",
       "pour",
       {}},
      {{"pour", "milk", "--tilt", "nan"},
       "--tilt: found 'nan', wanted a number from 0.5 to 90",
       "pour",
       {}},
      {{"pour", "milk", "--add", "a", "--add", ""}, "--add: the value is empty", "pour", {}},
  };
  for (const Wrong& wrong : all) {
    const ParsedArguments parsed = Parse(wrong.words);
    const auto* const error = std::get_if<UsageError>(&parsed);
    ASSERT_TRUE(error) << wrong.message;
    EXPECT_EQ(error->message, wrong.message);
    EXPECT_EQ(error->command, wrong.command) << wrong.message;
    EXPECT_EQ(error->corrected, wrong.corrected) << wrong.message;
  }
}

TEST(ParseArguments, HelpIsMadeOfTheData) {
  const ParsedArguments parsed = Parse({"pour", "--help"});
  ASSERT_TRUE(std::holds_alternative<InfoText>(parsed));
  EXPECT_TRUE(std::get<InfoText>(parsed).asked_for);
  EXPECT_EQ(std::get<InfoText>(parsed).text,
            "Pour something\n"
            "Usage: prehend pour [OPTIONS] liquid\n"
            "\n"
            "Positionals:\n"
            "  liquid REQUIRED             what is poured\n"
            "\n"
            "Options:\n"
            "  -i,--into VESSEL            the vessel\n"
            "  --stir N                    how often (1 to 20)\n"
            "  --tilt DEG                  how far (0.5 to 90)\n"
            "  --add WHAT                  more\n"
            "  --dry                       pour nothing\n"
            "\n"
            "Examples:\n"
            "  prehend pour milk\n"
            "  prehend pour milk --into cup\n");
}

TEST(ParseArguments, VersionAndNothingAtAll) {
  const ParsedArguments version = Parse({"--version"});
  ASSERT_TRUE(std::holds_alternative<InfoText>(version));
  EXPECT_EQ(std::get<InfoText>(version).text, "kitchen 1.0\n");
  const ParsedArguments nothing = Parse({});
  ASSERT_TRUE(std::holds_alternative<InfoText>(nothing));
  EXPECT_FALSE(std::get<InfoText>(nothing).asked_for);
  EXPECT_NE(std::get<InfoText>(nothing).text.find("\n  wash "), std::string::npos);
}

}  // namespace
}  // namespace prehend::cli
