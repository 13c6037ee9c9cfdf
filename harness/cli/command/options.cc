// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/base/base/number_text.h"
#include "harness/cli/command/command.h"

namespace prehend::cli {
namespace {

template <typename Number>
ValueRule RuleFor(const char* what, Number least, Number most) {
  const std::string range = fmt::format("{} to {}", least, most);
  return {.range = range, .problem = [=](const std::string& value) {
            const auto number = NumberFrom<Number>(value);
            // A comparison with nan is false: it is refused, too.
            if (number && *number >= least && *number <= most) return std::string();
            return fmt::format("found '{}', wanted {} from {}", value, what, range);
          }};
}

Option With(Option option, bool Option::*said) {
  option.*said = true;
  return option;
}

std::string FilterProblem(const std::string& filter) {
  const bool negated = filter.starts_with('!');
  const std::string rest = filter.substr(negated ? 1 : 0);
  if (!rest.empty() && rest != "tag:") return "";
  return fmt::format("found '{0}', wanted {1}, like {0}{2}", filter,
                     rest.empty() ? "what must not match" : "a tag after it",
                     rest.empty() ? "reach/*" : "smoke");
}

}  // namespace

ValueRule IntegersFrom(std::int64_t least, std::int64_t most) {
  return RuleFor("a whole number", least, most);
}

ValueRule NumbersFrom(double least, double most) { return RuleFor("a number", least, most); }

ValueRule OneOf(const std::vector<std::string>& words) {
  return {.problem = [words](const std::string& value) {
    if (std::ranges::count(words, value) > 0) return std::string();
    std::string wanted = fmt::format("{}", fmt::join(words, ", "));
    if (const std::size_t last = wanted.rfind(", "); last != wanted.npos)
      wanted.replace(last, 2, " or ");
    return fmt::format("found '{}', wanted {}", value, wanted);
  }};
}

ValueRule SomeOf(const std::vector<std::string>& words) {
  return {fmt::format("{}", fmt::join(words, ", ")), [words](const std::string& value) {
            for (const std::string& word : SplitAt(value, ',')) {
              if (std::ranges::count(words, word) == 0)
                return fmt::format("found '{}', wanted some of {}, with commas between them", word,
                                   fmt::join(words, ", "));
            }
            return std::string();
          }};
}

std::vector<Option> InGroup(const std::string& group, std::vector<Option> options) {
  for (Option& option : options) option.group = group;
  return options;
}

Option Argument(const std::string& name, const std::string& help, ValueRule rule) {
  return {.name = name, .help = help, .rule = std::move(rule)};
}

Option Flag(const std::string& name, const std::string& help) {
  return {.name = name, .help = help};
}

Option Value(const std::string& name, const std::string& placeholder, const std::string& help,
             ValueRule rule) {
  return {.name = name, .help = help, .placeholder = placeholder, .rule = std::move(rule)};
}

Option Required(Option option) { return With(std::move(option), &Option::required); }
Option Repeatable(Option option) { return With(std::move(option), &Option::repeatable); }
Option WritesFile(Option option) { return With(std::move(option), &Option::is_output); }
Option Unlisted(Option option) { return With(std::move(option), &Option::unlisted); }

std::vector<Option> Joined(std::vector<Option> first, std::vector<Option> second) {
  std::ranges::move(second, std::back_inserter(first));
  return first;
}

ParsedOptions::ParsedOptions(std::map<std::string, std::vector<std::string>> values)
    : values_(std::move(values)) {}

std::string ParsedOptions::TextOr(const std::string& name, const std::string& fallback) const {
  return Has(name) ? All(name).back() : fallback;
}

int ParsedOptions::IntOr(const std::string& name, int fallback) const {
  return Has(name) ? NumberFrom<int>(All(name).back()).value() : fallback;
}

std::uint64_t ParsedOptions::UnsignedOr(const std::string& name, std::uint64_t fallback) const {
  return Has(name) ? NumberFrom<std::uint64_t>(All(name).back()).value() : fallback;
}

double ParsedOptions::NumberOr(const std::string& name, double fallback) const {
  return Has(name) ? NumberFrom<double>(All(name).back()).value() : fallback;
}

Option ScenarioArgument() { return Required(Argument("scenario", "a name, skill/name or a file")); }

Option EpisodeArgument() {
  return Required(
      Argument("EPISODE", "a scenario (name, skill/name or file), an episode file or a recording"));
}

Option EpisodesArgument() {
  return Repeatable(
      Required(Argument("EPISODES",
                        "episode files (docs/episodes.md), recordings (docs/recording-format.md), "
                        "files of takes (docs/labels.md) or scenarios, which are played first")));
}

Option EpisodeFilesArgument() {
  return Repeatable(Required(
      Argument("files", "files from 'run --record' or 'check --record' (docs/episodes.md)")));
}

Option EpisodeOption() {
  return Value("--episode", "WHICH",
               "which one of an episode file that holds several: its number, or its scenario (a "
               "name, skill/name or a glob)");
}

Option EpisodesOption() {
  return Value("--episode", "WHICH",
               "only these of episode files: a number, a scenario (a name, skill/name or a glob), "
               "status=failed or outcome=NAME");
}

Option GrammarOption() {
  return Value("--grammar", "NAME|FILE",
               "use another grammar: a name of the library or a .grammar file");
}

Option ParametersOption() {
  return Repeatable(Value("--set", "NAME=VALUE",
                          "set a parameter of the grammar (reach_radius=25cm); may be repeated"));
}

Option SettingsOption() {
  Option option = ParametersOption();
  option.help =
      "set a parameter of the grammar (reach_radius=25cm) or a field of the scenario "
      "(entities.milk.mass_kg=8); may be repeated";
  return option;
}

Option OutputOption(const std::string& help, const std::string& placeholder, ValueRule rule) {
  return {.name = "--output",
          .help = help,
          .placeholder = placeholder,
          .other_name = "-o",
          .rule = std::move(rule),
          .is_output = true};
}

Option JobsOption() {
  return {.name = "--jobs",
          .help = "work on so many at a time; default: one per core",
          .placeholder = "N",
          .other_name = "-j",
          .rule = IntegersFrom(1, kMaxJobs)};
}

Option FilterOption() {
  return Repeatable(Value("--filter", "[!]GLOB|[!]tag:NAME",
                          "keep those that match this glob or have the tag; with a leading '!' "
                          "drop them; may be repeated, then all must hold",
                          {.problem = FilterProblem}));
}

Option TimeLimitOption(double least_s, double most_s) {
  return Unlisted(Value("--time-limit-s", "S", "", NumbersFrom(least_s, most_s)));
}

Option MemoryLimitOption() {
  return Unlisted(Value("--memory-limit-mb", "MB", "", IntegersFrom(0, 1'000'000)));
}

Option JsonOption() { return Unlisted(Flag("--json", "print JSON instead of text")); }

Option PaceOption() {
  return Value("--pace", "online|real_time",
               "online: a program gets its next frame when it has answered the last one; "
               "real_time: when its time comes; default: at once",
               OneOf({"online", "real_time"}));
}

Option RecogniserLimitOption() {
  return Value(
      "--recogniser-limit-s", "S",
      fmt::format("seconds for a program and an episode; default: {:g}", kRecogniserLimit_s),
      NumbersFrom(1, 86400));
}

Option MapOption() {
  return Value(
      "--map", "FILE",
      "what labels mean: a YAML file; without it they are events, like grasping(right_hand, cup)");
}

std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder) {
  return {
      Repeatable(Value("--truth", placeholder, help)), MapOption(),
      Flag("--skip-bad-labels", "leave out labels that end before they begin, and count them"),
      Value("--collar-ms", "MS",
            fmt::format(
                "an event is right if both boundaries are so near; default: {:g}, and in a sweep "
                "with labels by people what has half of the union with its label in common (F1@50)",
                kDefaultCollar_ms),
            NumbersFrom(0, 10000))};
}

}  // namespace prehend::cli
