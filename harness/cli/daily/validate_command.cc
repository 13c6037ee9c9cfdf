// SPDX-License-Identifier: Apache-2.0
// prehend validate: reads, never runs. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "grammar/describe.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/check/verdict.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

struct Validated {
  std::string file;
  grammar::Diagnostics diagnostics;
  std::string description = {};  ///< of a grammar without errors
  grammar::Diagnostics warnings = {};
  std::vector<std::string> inputs = {};  ///< every file that was read
};

/// With the parameters that `--set` gives.
Validated ValidateGrammar(const std::string& name_or_path, const ParsedOptions& options,
                          const std::string& root) {
  const bool is_joined = name_or_path.find('+') != std::string::npos;  // a file may be called so
  Validated validated{.file = is_joined ? name_or_path : episode::GrammarFile(root, name_or_path)};
  Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
  if (!settings) {
    validated.diagnostics = std::move(settings.error());
    return validated;
  }
  grammar::CompileResult compiled =
      episode::LoadGrammar(root, name_or_path, *settings, &validated.inputs);
  validated.diagnostics = std::move(compiled.diagnostics);
  if (compiled.program) validated.description = Text(Describe(*compiled.program));
  validated.warnings = std::move(compiled.warnings);
  return validated;
}

/// Checks the golden of a scenario. Its events belong to the scenario's own grammar: with another
/// one only its syntax is checked.
void AddGolden(const episode::ScenarioFile& file, const ParsedOptions& options,
               const Result<episode::LoadedRun>& loaded, const std::string& root,
               Validated& validated) {
  const truth::GoldenFiles goldens(root);
  const std::string path = goldens.GoldenPath(episode::IdOf(file)).string();
  validated.inputs.push_back(path);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  const bool as_it_is = !options.Has("--grammar") && !options.Has("--set");
  std::ranges::move(loaded && as_it_is ? suite::ValidateGolden(path, episode::IdOf(file), *loaded)
                                       : ErrorsOf(goldens.ReadGoldenOf(episode::IdOf(file))),
                    std::back_inserter(validated.diagnostics));
  if (!loaded || !as_it_is) return;
  const std::size_t asked = loaded->scenario.pictures.size();
  for (const fs::path& picture : suite::UnrequestedPictures(episode::IdOf(file), asked, root))
    validated.diagnostics.push_back(grammar::Diagnostic{
        .file = ReadableName(file.path), .message = suite::UnrequestedText(picture, asked)});
}

/// A golden whose scenario no longer exists.
Validated ValidateOrphan(const suite::UnreferencedGolden& orphan) {
  Validated validated{.file = ReadableName(orphan.files.front().string()), .diagnostics = {}};
  for (const fs::path& file : orphan.files)
    validated.diagnostics.push_back(grammar::Diagnostic{
        .file = ReadableName(file.string()),
        .message = "belongs to no scenario",
        .hint = "remove it, or bring scenarios/" + orphan.scenario + ".yaml back"});
  return validated;
}

/// After reporting that there is no such file or scenario, the exit code.
tl::expected<Validated, ExitCode> Validate(const std::string& typed, const ParsedOptions& options,
                                           const CommandContext& context) {
  const bool is_grammar = options.All("files").empty() && options.Has("--grammar");
  if (is_grammar || typed.ends_with(".grammar"))
    return ValidateGrammar(typed, options, context.root);
  if (typed.ends_with(".timeline")) {
    Validated validated{.file = typed, .diagnostics = {}};
    validated.diagnostics = suite::ValidateGoldenFile(typed, context.root, validated.inputs);
    return validated;
  }
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(context.root);
  const auto listed = std::ranges::find(all, typed, &episode::ScenarioFile::path);
  PREHEND_TRY(const auto file, listed == all.end()
                                   ? FindScenarioOrComplain(typed, context)
                                   : tl::expected<episode::ScenarioFile, ExitCode>(*listed));
  Validated validated{.file = ReadableName(file.path)};
  Result<episode::LoadedRun> loaded =
      episode::LoadRun(RequestOf(options, file.path), context.root, &validated.inputs);
  validated.diagnostics = ErrorsOf(loaded);
  if (file.in_project) AddGolden(file, options, loaded, context.root, validated);
  if (!loaded) return validated;
  validated.warnings = std::move(loaded->warnings);
  std::ranges::move(episode::UndecidedClaims(loaded->scenario, loaded->document, *loaded->program),
                    std::back_inserter(validated.warnings));
  return validated;
}

nlohmann::ordered_json ToJson(const Validated& validated) {
  return {{"file", validated.file},
          {"ok", validated.diagnostics.empty()},
          {"diagnostics", suite::DiagnosticsJson(validated.diagnostics)},
          {"warnings", suite::DiagnosticsJson(validated.warnings)}};
}

/// What was typed; by default every scenario, or with --grammar that grammar alone.
std::vector<std::string> Names(const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::string> names = options.All("files");
  if (!names.empty()) return names;
  if (options.Has("--grammar")) return {options.Text("--grammar")};
  for (const episode::ScenarioFile& file : episode::ListScenarios(context.root))
    names.push_back(file.path);  // a name may be that of several
  return names;
}

/// Validates everything, then again what a saved file affects, and new scenarios.
[[noreturn]] void Watch(const ParsedOptions& options, const CommandContext& context) {
  constexpr auto kPeriod = std::chrono::milliseconds(300);
  std::map<std::string, FileHashes> seen;
  for (;; std::this_thread::sleep_for(kPeriod)) {
    for (const std::string& name : Names(options, context)) {
      const auto known = seen.find(name);
      const bool affected =
          known == seen.end() || std::ranges::any_of(known->second, [](const auto& file) {
            return FileHash(file.first) != file.second;
          });
      if (!affected) continue;
      const auto validated = Validate(name, options, context);
      seen[name] = validated ? HashFiles(validated->inputs) : FileHashes{};
      if (!validated) continue;
      context.out << (validated->diagnostics.empty() ? "ok: " : "wrong: ") << validated->file
                  << "\n"
                  << grammar::Format(validated->diagnostics) << std::flush;
    }
  }
}

ExitCode RunValidate(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--on-save")) Watch(options, context);
  const std::vector<std::string> names = Names(options, context);
  if (names.empty())
    return Complain(context, ExitCode::kNothing,
                    "there is no scenario in " + context.root + "/scenarios");
  std::vector<Validated> all;
  for (const std::string& name : names) {
    PREHEND_TRY(auto validated, Validate(name, options, context));
    all.push_back(std::move(validated));
  }
  const bool everything = options.All("files").empty() && !options.Has("--grammar");
  const ExitCode strays = everything ? WarnOfScenariosNotRun(context) : ExitCode::kAgrees;
  for (const suite::UnreferencedGolden& orphan :
       everything
           ? suite::FindUnreferencedGoldens(episode::ListScenarios(context.root), context.root)
           : std::vector<suite::UnreferencedGolden>())
    all.push_back(ValidateOrphan(orphan));

  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  grammar::Diagnostics diagnostics;
  for (const Validated& validated : all) {
    json.push_back(ToJson(validated));
    diagnostics.insert(diagnostics.end(), validated.diagnostics.begin(),
                       validated.diagnostics.end());
    Warn(context, validated.warnings);
    if (!options.Has("--json") && validated.diagnostics.empty())
      context.out << "ok: " << validated.file << "\n" << validated.description;
  }
  if (options.Has("--json")) context.out << nlohmann::ordered_json{{"files", json}}.dump(2) << "\n";
  return diagnostics.empty() ? strays : Complain(context, diagnostics);
}

}  // namespace

Command ValidateCommand() {
  return {
      .name = "validate",
      .summary = "Read scenarios, grammars and goldens without running anything",
      .examples = {"validate", "validate milk_carton_wrap my/scenario.yaml",
                   "validate my/rules.grammar", "validate --grammar pick_and_place",
                   "validate --on-save"},
      .options = {Repeatable(
                      Argument("files",
                               "scenarios (names or files), .grammar or .timeline files; default: "
                               "all scenarios")),
                  GrammarOption(), SettingsOption(), JsonOption(),
                  Flag("--on-save", "validate again what a saved file affects, until interrupted")},
      .run = RunValidate};
}

// prehend list. Tested by tests/program/command_line_test.cc
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
