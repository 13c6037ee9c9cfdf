// SPDX-License-Identifier: Apache-2.0
// What commands share. Tested by tests/program/command_line_test.cc
#include "harness/cli/command.h"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "harness/base/shell_quote.h"

namespace prehend::harness {

int CoreCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

Option ScenarioArgument() {
  return {.name = "scenario", .help = "a name, skill/name or a file", .required = true};
}

Option EpisodeArgument() {
  return {.name = "scenario",
          .help = "a scenario (name, skill/name or file), an episode file or a recording",
          .required = true};
}

Option GrammarOption() {
  return {.name = "--grammar",
          .help = "use another grammar: a name of the library or a .grammar file",
          .placeholder = "NAME|FILE"};
}

Option SettingsOption() {
  return {.name = "--set",
          .help =
              "set a parameter of the grammar (reach_radius=25cm) or a field of the scenario\n"
              "(entities.milk.mass_kg=8); may be repeated",
          .placeholder = "NAME=VALUE",
          .repeatable = true};
}

RunRequest RequestOf(const ParsedOptions& options, const std::string& scenario_file) {
  return {.scenario_file = scenario_file,
          .grammar = options.Text("--grammar"),
          .settings = options.All("--set")};
}

std::optional<ExitCode> RefuseRecording(const std::string& typed, const CommandContext& context) {
  std::error_code error;
  if (!IsRecording(typed) || !std::filesystem::exists(typed, error)) return std::nullopt;
  return Complain(context, ExitCode::kBadInput,
                  typed + " is a recording, not a scenario; use '" + CommandText({"resegment"}) +
                      "', 'explain' or 'tracks'");
}

tl::expected<ScenarioFile, ExitCode> FindScenarioOrComplain(const std::string& typed,
                                                            const CommandContext& context) {
  if (const auto refused = RefuseRecording(typed, context)) return tl::unexpected(*refused);
  const std::vector<ScenarioFile> scenarios = ListScenarios(context.root);
  if (const auto path = FindScenario(scenarios, typed)) return ScenarioAt(scenarios, *path);
  std::string message = "no scenario '" + typed + "'";
  const std::string hint = HintForScenario(scenarios, typed);
  if (!hint.empty()) message += "; " + hint;
  message += " ('" + CommandText({"list"}) + "' shows all)";
  std::vector<std::string> corrected;
  if (const std::string near = NearestScenario(scenarios, typed); !near.empty()) {
    corrected = context.words;
    std::ranges::replace(corrected, typed, near);
  }
  return tl::unexpected(ComplainWithCorrection(context, ExitCode::kNothing, message, corrected));
}

ExitCode Complain(const CommandContext& context, ExitCode code, const std::string& message) {
  // What cannot have succeeded is not worth repeating; what failed may be looked into.
  return ComplainWithCorrection(
      context, code, message,
      code == ExitCode::kFailure ? context.words : std::vector<std::string>());
}

ExitCode ComplainWithCorrection(const CommandContext& context, ExitCode code,
                                const std::string& message,
                                const std::vector<std::string>& corrected) {
  context.err << "prehend: " << message << "\n";
  if (!corrected.empty()) context.err << "  again: " << CommandText(corrected) << "\n";
  return code;
}

ExitCode Complain(const CommandContext& context, const grammar::Diagnostics& diagnostics) {
  constexpr std::size_t kMaxPrinted = 100;  // nobody reads on
  const std::size_t printed = std::min(diagnostics.size(), kMaxPrinted);
  for (std::size_t i = 0; i < printed; ++i) context.err << Format(diagnostics[i]);
  if (printed < diagnostics.size())
    context.err << "and " << (diagnostics.size() < grammar::kMostDiagnostics ? "" : "at least ")
                << diagnostics.size() - printed << " more\n";
  const bool can_be_fixed = std::ranges::any_of(diagnostics, [](const auto& diagnostic) {
    std::error_code error;
    return std::filesystem::exists(diagnostic.file, error);
  });
  if (can_be_fixed) context.err << "  again: " << CommandText(context.words) << "\n";
  return ExitCode::kBadInput;
}

void Warn(const CommandContext& context, const grammar::Diagnostics& warnings) {
  if (!warnings.empty()) context.err << Format(warnings);
}

}  // namespace prehend::harness
