// SPDX-License-Identifier: Apache-2.0
// prehend validate: reads, never runs. Tested by tests/program/command_line_test.cc
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "grammar/describe.h"
#include "harness/base/content_hash.h"
#include "harness/base/text_file.h"
#include "harness/check/validate_golden.h"
#include "harness/cli/command.h"
#include "harness/cli/warn.h"
#include "harness/golden/golden_files.h"
#include "harness/judge/unreferenced_goldens.h"
#include "harness/run/load_grammar.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

struct Validated {
  std::string file;
  grammar::Diagnostics diagnostics;
  std::string description = {};  ///< of a grammar without errors
  grammar::Diagnostics warnings = {};
  std::vector<std::string> inputs = {};  ///< every file that was looked at
};

void Declare(CLI::App& options) {
  options
      .add_option("files",
                  "scenarios (names or files), .grammar or .timeline files; nothing: all scenarios")
      ->expected(-1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  DeclareRunOptions(options);
  DeclareFlag(options, "--json", "one JSON object");
  DeclareFlag(options, "--watch", "go on until interrupted: read again what a save affects");
}

/// With the parameters that `--set` gives.
Validated ValidateGrammar(const std::string& name_or_path, const CLI::App& options,
                          const std::string& root) {
  Validated validated{.file = GrammarFile(root, name_or_path)};
  ReadResult<grammar::Overrides> settings = ParameterSettings(ValuesOf(options, "--set"));
  if (!settings.value) {
    validated.diagnostics = std::move(settings.diagnostics);
    return validated;
  }
  grammar::CompileResult compiled =
      LoadGrammar(root, name_or_path, *settings.value, &validated.inputs);
  validated.diagnostics = std::move(compiled.diagnostics);
  if (compiled.program) validated.description = Text(Describe(*compiled.program));
  validated.warnings = std::move(compiled.warnings);
  return validated;
}

/// What is kept in golden/ for a scenario. Its events are those of the scenario's own grammar, not
/// of another.
void AddGolden(const ScenarioFile& file, const CLI::App& options,
               const std::optional<LoadedRun>& loaded, const std::string& root,
               Validated& validated) {
  const GoldenFiles goldens(root);
  const std::string path = goldens.GoldenPath(IdOf(file)).string();
  validated.inputs.push_back(path);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  const bool as_it_is = !IsGiven(options, "--grammar") && !IsGiven(options, "--set");
  std::ranges::move(loaded && as_it_is ? CheckGoldenFile(path, IdOf(file), *loaded)
                                       : goldens.ReadGoldenOf(IdOf(file)).diagnostics,
                    std::back_inserter(validated.diagnostics));
  if (!loaded || !as_it_is) return;
  const std::size_t asked = loaded->scenario.pictures.size();
  for (const fs::path& picture : UnaskedPictures(IdOf(file), asked, root))
    validated.diagnostics.push_back(grammar::Diagnostic{.file = file.path,
                                                        .place = {},
                                                        .message = UnaskedText(picture, asked),
                                                        .source_line = {},
                                                        .hint = {}});
}

/// What is kept in golden/ for scenarios that are gone.
Validated ValidateOrphan(const Orphan& orphan) {
  Validated validated{.file = orphan.files.front().string(), .diagnostics = {}};
  for (const fs::path& file : orphan.files)
    validated.diagnostics.push_back(grammar::Diagnostic{
        .file = file.string(),
        .place = {},
        .message = "belongs to no scenario",
        .source_line = {},
        .hint = "remove it, or bring scenarios/" + orphan.scenario + ".yaml back"});
  return validated;
}

/// Nothing when it is the name of no scenario.
std::optional<Validated> Validate(const std::string& typed, const CLI::App& options,
                                  const CommandContext& context) {
  if (typed.ends_with(".grammar")) return ValidateGrammar(typed, options, context.root);
  if (typed.ends_with(".timeline")) {
    Validated validated{.file = typed, .diagnostics = {}};
    validated.diagnostics = CheckGoldenAlone(typed, context.root, validated.inputs);
    return validated;
  }
  const auto file = FindScenarioOrComplain(typed, context);
  if (!file) return std::nullopt;
  Validated validated{.file = file->path};
  ReadResult<LoadedRun> loaded =
      LoadRun(RequestOf(options, file->path), context.root, &validated.inputs);
  validated.diagnostics = std::move(loaded.diagnostics);
  if (file->in_project) AddGolden(*file, options, loaded.value, context.root, validated);
  if (loaded.value) validated.warnings = std::move(loaded.value->warnings);
  return validated;
}

nlohmann::ordered_json ToJson(const grammar::Diagnostics& diagnostics) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const grammar::Diagnostic& diagnostic : diagnostics) {
    all.push_back({{"file", diagnostic.file},
                   {"line", diagnostic.place.line},
                   {"column", diagnostic.place.column},
                   {"message", diagnostic.message},
                   {"hint", diagnostic.hint}});
  }
  return all;
}

nlohmann::ordered_json ToJson(const Validated& validated) {
  return {{"file", validated.file},
          {"ok", validated.diagnostics.empty()},
          {"diagnostics", ToJson(validated.diagnostics)},
          {"warnings", ToJson(validated.warnings)}};
}

/// What was typed; nothing typed is every scenario, or the grammar of --grammar alone.
std::vector<std::string> Names(const CLI::App& options, const CommandContext& context) {
  std::vector<std::string> names = ValuesOf(options, "files");
  if (!names.empty()) return names;
  if (IsGiven(options, "--grammar"))
    return {GrammarFile(context.root, ValueOf(options, "--grammar"))};
  for (const ScenarioFile& file : ListScenarios(context.root)) names.push_back(IdOf(file));
  return names;
}

/// Reads everything; after each save again what it affects, and scenarios that are new.
[[noreturn]] void Watch(const CLI::App& options, const CommandContext& context) {
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
                  << Format(validated->diagnostics) << std::flush;
    }
  }
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  if (IsGiven(options, "--watch")) Watch(options, context);
  const std::vector<std::string> names = Names(options, context);
  if (names.empty())
    return Complain(context, ExitCode::kNothing,
                    "no scenarios below " + context.root + "/scenarios");
  std::vector<Validated> all;
  for (const std::string& name : names) {
    auto validated = Validate(name, options, context);
    if (!validated) return ExitCode::kNothing;
    all.push_back(std::move(*validated));
  }
  const bool everything = ValuesOf(options, "files").empty() && !IsGiven(options, "--grammar");
  for (const Orphan& orphan :
       everything ? OrphansAmong(ListScenarios(context.root), context.root) : std::vector<Orphan>())
    all.push_back(ValidateOrphan(orphan));

  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  grammar::Diagnostics diagnostics;
  for (const Validated& validated : all) {
    json.push_back(ToJson(validated));
    diagnostics.insert(diagnostics.end(), validated.diagnostics.begin(),
                       validated.diagnostics.end());
    Warn(context, validated.warnings);
    if (!IsGiven(options, "--json") && validated.diagnostics.empty())
      context.out << "ok: " << validated.file << "\n" << validated.description;
  }
  if (IsGiven(options, "--json"))
    context.out << nlohmann::ordered_json{{"files", json}}.dump(2) << "\n";
  return diagnostics.empty() ? ExitCode::kAgrees : Complain(context, diagnostics);
}

}  // namespace

Command ValidateCommand() {
  return {.name = "validate",
          .summary = "Read scenarios, grammars and goldens without running anything",
          .examples =
              "prehend validate\n"
              "prehend validate milk_carton_wrap my/scenario.yaml\n"
              "prehend validate my/rules.grammar\n"
              "prehend validate --grammar pick_and_place\n"
              "prehend validate --watch",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
