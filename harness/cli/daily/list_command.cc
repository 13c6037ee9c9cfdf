// SPDX-License-Identifier: Apache-2.0
// prehend list. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/suite/check/run_suite.h"

namespace prehend::cli {
namespace {

constexpr std::size_t kColumns = 100;
const std::string kIndent = "    ";

std::string TagsText(const std::vector<std::string>& tags) {
  return tags.empty() ? "" : fmt::format("  [{}]", fmt::join(tags, " "));
}

ExitCode RunList(const ParsedOptions& options, const CommandContext& context) {
  std::string text;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  grammar::Diagnostics diagnostics;
  const ExitCode strays = options.Has("names") ? ExitCode::kAgrees : WarnOfScenariosNotRun(context);
  const scenario::ScenarioLibrary library = episode::ProjectLibrary(context.root);
  const auto selection =
      suite::SelectScenarios(options.All("names"), options.All("--filter"), context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);
  for (const episode::ScenarioFile& file : selection->scenarios) {
    if (file.episode)
      return Refuse(context, "list shows scenarios; '" +
                                 CommandText({"episode", "list", file.path}) +
                                 "' shows what an episode file has");
    if (const std::string lack = episode::Lacks(NameOf(file), episode::Need::kScenario);
        !lack.empty())
      return Refuse(context, lack);
    Result<scenario::Scenario> read = scenario::ReadScenario(file.path, {}, library);
    std::ranges::copy(ErrorsOf(read), std::back_inserter(diagnostics));
    scenario::Scenario scenario;
    scenario.shows = "(cannot be read)";
    if (read) scenario = std::move(*read);
    const std::string id = episode::ScenarioId(file.skill, file.name);
    text += fmt::format("{}{}\n", id, TagsText(scenario.tags)) +
            Wrapped(kIndent + scenario.shows, kColumns, kIndent.size()) + "\n";
    list.push_back({{"scenario", id},
                    {"shows", scenario.shows},
                    {"tags", scenario.tags},
                    {"grammar", scenario.grammar}});
  }
  if (list.empty())
    return Complain(context, ExitCode::kNothing,
                    "there is no scenario in " + context.root + "/scenarios");
  if (options.Has("--json")) {
    context.out << nlohmann::ordered_json{{"scenarios", list}}.dump(2) << "\n";
  } else {
    context.out << text;
  }
  return diagnostics.empty() ? strays : Complain(context, diagnostics);
}

}  // namespace

Command ListCommand() {
  return {.name = "list",
          .summary = "List the scenarios: name, what each shows, tags",
          .examples = {"list", "list 'slide/*' --filter tag:claim", "list --json"},
          .options = {Repeatable(Argument(
                          "names", "which ones: names, skill/name, globs or files; default: all")),
                      FilterOption(), JsonOption()},
          .run = RunList};
}

}  // namespace prehend::cli
