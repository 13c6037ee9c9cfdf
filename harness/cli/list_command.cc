// SPDX-License-Identifier: Apache-2.0
// prehend list. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "harness/base/shell_quote.h"
#include "harness/check/select_scenarios.h"
#include "harness/command/command.h"
#include "harness/episode/lacks.h"
#include "harness/read/read_scenario.h"
#include "harness/run/project_library.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

ExitCode RunList(const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::vector<std::string>> rows = {{"scenario", "shows", "tags"}};
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  grammar::Diagnostics diagnostics;
  const ScenarioLibrary library = ProjectLibrary(context.root);
  const auto selection =
      SelectScenarios(options.All("names"), options.All("--filter"), context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);
  for (const ScenarioFile& file : selection->scenarios) {
    if (file.episode)
      return Complain(context, ExitCode::kBadInput,
                      "list shows scenarios; '" + CommandText({"episode", "list", file.path}) +
                          "' shows what an episode file has");
    if (const std::string lack = Lacks(NameOf(file), Need::kScenario); !lack.empty())
      return Complain(context, ExitCode::kBadInput, lack);
    Result<Scenario> read = ReadScenario(file.path, {}, library);
    std::ranges::copy(ErrorsOf(read), std::back_inserter(diagnostics));
    const Scenario scenario = std::move(read).value_or(Scenario{.shows = "(cannot be read)"});
    const std::string id = ScenarioId(file.skill, file.name);
    rows.push_back({id, scenario.shows, fmt::format("{}", fmt::join(scenario.tags, " "))});
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
    for (const std::string& line : AlignColumns(rows)) context.out << line << "\n";
  }
  return diagnostics.empty() ? ExitCode::kAgrees : Complain(context, diagnostics);
}

}  // namespace

Command ListCommand() {
  return {.name = "list",
          .summary = "List the scenarios: name, what each shows, tags",
          .examples = {"list", "list 'slide/*' --filter tag:claim", "list --json"},
          .options = {{.name = "names",
                       .help = "which ones: names, skill/name, globs or files; default: all",
                       .repeatable = true},
                      {.name = "--filter",
                       .help = "only those that match this glob or tag:NAME, or with ! in front do "
                               "not;\nmay be repeated",
                       .placeholder = "PATTERN",
                       .repeatable = true},
                      {.name = "--json", .help = "print one JSON object instead of a table"}},
          .run = RunList};
}

}  // namespace prehend::harness
