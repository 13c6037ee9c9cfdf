// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/command/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

namespace prehend::cli {
namespace {

/// The number that all of `text` is; nothing when it is none, or too large for the type.
template <typename Number>
std::optional<Number> NumberFrom(const std::string& text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

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
            for (const std::string& word : WordsOf(value)) {
              if (std::ranges::count(words, word) == 0)
                return fmt::format("found '{}', wanted some of {}, with commas between them", word,
                                   fmt::join(words, ", "));
            }
            return std::string();
          }};
}

std::vector<std::string> WordsOf(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::vector<Option> InGroup(const std::string& group, std::vector<Option> options) {
  for (Option& option : options) option.group = group;
  return options;
}

Option Required(Option option) {
  option.required = true;
  return option;
}

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

namespace {

std::string FilterProblem(const std::string& filter) {
  const bool negated = filter.starts_with('!');
  const std::string rest = filter.substr(negated ? 1 : 0);
  if (!rest.empty() && rest != "tag:") return "";
  return fmt::format("found '{0}', wanted {1}, like {0}{2}", filter,
                     rest.empty() ? "what must not match" : "a tag after it",
                     rest.empty() ? "reach/*" : "smoke");
}

}  // namespace

Option ScenarioArgument() {
  return {.name = "scenario", .help = "a name, skill/name or a file", .required = true};
}

Option EpisodeArgument() {
  return {.name = "EPISODE",
          .help = "a scenario (name, skill/name or file), an episode file or a recording",
          .required = true};
}

Option EpisodesArgument() {
  return {.name = "EPISODES",
          .help =
              "episode files (docs/episodes.md), recordings (docs/recording-format.md), files of "
              "takes (docs/labels.md) or "
              "scenarios, which are played first",
          .required = true,
          .repeatable = true};
}

Option EpisodeFilesArgument() {
  return {.name = "files",
          .help = "files from 'run --record' or 'check --record' (docs/episodes.md)",
          .required = true,
          .repeatable = true};
}

Option EpisodeOption() {
  return {.name = "--episode",
          .help =
              "which one of an episode file that holds several: its number, or its scenario "
              "(a name, skill/name or a glob)",
          .placeholder = "WHICH"};
}

Option EpisodesOption() {
  return {.name = "--episode",
          .help =
              "only these of episode files: a number, a scenario (a name, skill/name or a glob), "
              "status=failed or outcome=NAME",
          .placeholder = "WHICH"};
}

Option GrammarOption() {
  return {.name = "--grammar",
          .help = "use another grammar: a name of the library or a .grammar file",
          .placeholder = "NAME|FILE"};
}

Option ParametersOption() {
  return {.name = "--set",
          .help = "set a parameter of the grammar (reach_radius=25cm); may be repeated",
          .placeholder = "NAME=VALUE",
          .repeatable = true};
}

Option SettingsOption() {
  Option option = ParametersOption();
  option.help =
      "set a parameter of the grammar (reach_radius=25cm) or a field of the scenario "
      "(entities.milk.mass_kg=8); may be repeated";
  return option;
}

Option OutputOption(const std::string& help, const std::string& placeholder) {
  return {.name = "--output",
          .help = help,
          .placeholder = placeholder,
          .other_name = "-o",
          .is_output = true};
}

Option JobsOption() {
  return {.name = "--jobs",
          .help = {},
          .placeholder = "N",
          .other_name = "-j",
          .rule = IntegersFrom(1, kMaxJobs),
          .unlisted = true};
}

Option FilterOption() {
  return {.name = "--filter",
          .help =
              "keep those that match this glob or have the tag; with a leading '!' drop them; "
              "may be repeated, then all must hold",
          .placeholder = "[!]GLOB|[!]tag:NAME",
          .rule = {.problem = FilterProblem},
          .repeatable = true};
}

Option TimeLimitOption(double least_s, double most_s) {
  return {.name = "--time-limit-s",
          .help = {},
          .placeholder = "S",
          .rule = NumbersFrom(least_s, most_s),
          .unlisted = true};
}

Option MemoryLimitOption() {
  return {.name = "--memory-limit-mb",
          .help = {},
          .placeholder = "MB",
          .rule = IntegersFrom(0, 1'000'000),
          .unlisted = true};
}

Option JsonOption() {
  return {.name = "--json", .help = "print JSON instead of text", .unlisted = true};
}

Option PaceOption() {
  return {.name = "--pace",
          .help =
              "online: a program gets its next frame when it has answered the last one; real_time: "
              "when its time comes; default: at once",
          .placeholder = "online|real_time",
          .rule = OneOf({"online", "real_time"})};
}

Option RecogniserLimitOption() {
  return {.name = "--recogniser-limit-s",
          .help = fmt::format("seconds for a program and an episode; default: {:g}",
                              kRecogniserLimit_s),
          .placeholder = "S",
          .rule = NumbersFrom(1, 86400)};
}

Option MapOption() {
  return {.name = "--map",
          .help =
              "what labels mean: a YAML file; without it they are events, like "
              "grasping(right_hand, cup)",
          .placeholder = "FILE"};
}

std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder) {
  return {{.name = "--truth", .help = help, .placeholder = placeholder, .repeatable = true},
          MapOption(),
          {.name = "--skip-bad-labels",
           .help = "leave out labels that end before they begin, and count them"},
          {.name = "--collar-ms",
           .help = fmt::format("an event is right if both boundaries are so near; default: {:g}, "
                               "and in a sweep with labels by people what has half of the union "
                               "with its label in common (F1@50)",
                               kDefaultCollar_ms),
           .placeholder = "MS",
           .rule = NumbersFrom(0, 10000)}};
}

}  // namespace prehend::cli
