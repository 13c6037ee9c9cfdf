// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command/shared_options.h. Tested by tests/harness/cli/cli/command_tree_test.cc
#include "harness/cli/command/shared_options.h"

#include <fmt/format.h>

namespace prehend::cli {
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
              "episode files (docs/episodes.md), recordings (docs/recording-format.md) or "
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
              "only these of episode files: a number, or a scenario (a name, skill/name or a "
              "glob)",
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

Option JobsOption(const std::string& of_what) {
  return {.name = "--jobs",
          .help = of_what + " at a time; default: one per core",
          .placeholder = "N",
          .other_name = "-j",
          .rule = IntegersFrom(1, kMaxJobs)};
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

Option JsonOption() { return {.name = "--json", .help = "print JSON instead of text"}; }

std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder) {
  return {{.name = "--truth", .help = help, .placeholder = placeholder, .repeatable = true},
          {.name = "--map",
           .help = "what labels mean: a YAML file; without it they are events, like "
                   "grasping(right_hand, cup)",
           .placeholder = "FILE"},
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
