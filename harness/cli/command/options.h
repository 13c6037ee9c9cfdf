// SPDX-License-Identifier: Apache-2.0
// What can be typed after a command's name, described as data, and what was typed for it. Knows no
// parser: harness/cli/command/parse_arguments.cc turns the description into one. Tested by
// tests/harness/cli/command/parse_arguments_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace prehend::cli {

/// Which values an option takes.
struct ValueRule {
  std::string range = {};  ///< for the help: "1 to 256", or ""
  /// What is wrong with a value, or "". It is printed after the option's name.
  std::function<std::string(const std::string& value)> problem = {};
};

/// Numbers from `least` to `most`, both included; whole ones only, or any.
ValueRule IntegersFrom(std::int64_t least, std::int64_t most);
ValueRule NumbersFrom(double least, double most);
/// One of these words; some of them, with commas between them.
ValueRule OneOf(const std::vector<std::string>& words);
ValueRule SomeOf(const std::vector<std::string>& words);

/// The words between commas.
std::vector<std::string> WordsOf(const std::string& text);

/// One thing that can be typed. A name with dashes is an option, any other name is an argument,
/// which is recognised by its place. An option without placeholder is a flag.
struct Option {
  std::string name;              ///< "--jobs", "scenario"
  std::string help;              ///< one line of `--help`
  std::string placeholder = {};  ///< what stands for the value in the help: "FILE"
  std::string other_name = {};   ///< "-j"
  ValueRule rule = {};
  bool required = false;
  bool repeatable = false;  ///< may be given several times
  bool is_output = false;   ///< names a file that is written
  bool unlisted = false;    ///< the program's help has it, not the command's
  std::string group = {};   ///< heading in the help; "" is the common one
};

/// The same options under a heading of the help.
std::vector<Option> InGroup(const std::string& group, std::vector<Option> options);

/// What is typed without dashes, by its place; an option without a value; one with a value, for
/// which the help has the placeholder.
Option Argument(const std::string& name, const std::string& help, ValueRule rule = {});
Option Flag(const std::string& name, const std::string& help);
Option Value(const std::string& name, const std::string& placeholder, const std::string& help,
             ValueRule rule = {});

/// The same option, which must be given; may be given several times; names a file that is written;
/// is told of in the program's help and not in the command's.
Option Required(Option option);
Option Repeatable(Option option);
Option WritesFile(Option option);
Option Unlisted(Option option);

/// Two lists of options, one after the other.
std::vector<Option> Joined(std::vector<Option> first, std::vector<Option> second);

/// What was typed for the options of one command. Asking for an option that the command does not
/// have is an error of the program: std::out_of_range.
class ParsedOptions {
 public:
  ParsedOptions() = default;
  /// One entry per option of the command, with what was typed for it; of a flag, anything.
  explicit ParsedOptions(std::map<std::string, std::vector<std::string>> values);

  bool Has(const std::string& name) const { return !All(name).empty(); }
  const std::vector<std::string>& All(const std::string& name) const { return values_.at(name); }

  // The value that was typed last, or the fallback. Numbers have passed their option's rule.
  std::string TextOr(const std::string& name, const std::string& fallback) const;
  int IntOr(const std::string& name, int fallback) const;
  std::uint64_t UnsignedOr(const std::string& name, std::uint64_t fallback) const;
  double NumberOr(const std::string& name, double fallback) const;

  /// "" when nothing was typed.
  std::string Text(const std::string& name) const { return TextOr(name, {}); }

 private:
  std::map<std::string, std::vector<std::string>> values_;
};

constexpr int kMaxJobs = 256;
constexpr double kDefaultCollar_ms = 50;
constexpr double kRecogniserLimit_s = 60;

Option ScenarioArgument();
Option EpisodeArgument();       ///< a scenario, an episode file or a recording
Option EpisodesArgument();      ///< any number of them
Option EpisodeFilesArgument();  ///< "files": no others
Option EpisodeOption();         ///< one of an episode file
Option EpisodesOption();        ///< some of episode files
Option GrammarOption();
Option PaceOption();             ///< of a recogniser
Option RecogniserLimitOption();  ///< for an episode
Option SettingsOption();         ///< of a grammar and a scenario
Option ParametersOption();       ///< of a grammar alone
Option OutputOption(const std::string& help, const std::string& placeholder = "FILE");
Option JobsOption();
Option FilterOption();
/// The program's help tells of --jobs, both limits and of their defaults.
Option TimeLimitOption(double least_s, double most_s);
Option MemoryLimitOption();
Option JsonOption();

Option MapOption();  ///< what labels mean
/// --truth, --map, --skip-bad-labels, --collar-ms.
std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder);

}  // namespace prehend::cli
