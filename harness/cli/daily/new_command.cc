// SPDX-License-Identifier: Apache-2.0
// prehend new: a commented scenario to start from, or a project of one's own. Tested by
// tests/program/command_line_test.cc and tests/program/project_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/templates/new_scenario.h"

namespace prehend::cli {
namespace {

constexpr const char* kDefaultSkill = kDefaultGrammar;

constexpr std::string_view kModeline = "# yaml-language-server: $schema=../scenario.schema.json\n";

/// The text that a new scenario starts from.
struct Model {
  std::string path;  ///< of the template: where it would stand in the default folder
  std::string text;
  std::string skill;
  std::optional<scenario::NewScenario> made;  ///< from a template
};

/// The text of the scenario for `path`, with the line that editors look for. Errors of the model
/// are reported in the model's own file or template; then nothing is returned.
std::optional<std::string> Composed(const Model& model, const std::filesystem::path& path,
                                    const CommandContext& context) {
  const scenario::ScenarioLibrary library = episode::ProjectLibrary(context.root);
  if (const auto as_it_is = scenario::ReadScenarioText(model.path, model.text, {}, library);
      !as_it_is) {
    grammar::Diagnostics errors = as_it_is.error();
    for (grammar::Diagnostic& error : errors)
      if (model.made && error.file == model.path)
        error = scenario::InTemplate(*model.made, std::move(error));
    Complain(context, errors);
    return std::nullopt;
  }
  Result<std::string> copy = scenario::CopyOfScenario(model.path, model.text, path);
  if (copy) {
    const bool has_modeline = copy->find("yaml-language-server:") != std::string::npos;
    if (!has_modeline) copy->insert(0, kModeline);
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // for paths that go through it
    const Result<scenario::Scenario> read =
        scenario::ReadScenarioText(path.string(), *copy, {}, library);
    if (read) return *copy;
    std::filesystem::remove(path.parent_path(), error);  // only when it is empty
    copy = tl::unexpected(read.error());
  }
  Complain(context, copy.error());
  return std::nullopt;
}

/// What a project starts with, as it ships but for the schema; the file that makes a project of the
/// folder comes last.
constexpr const char* kProject = "scenarios/templates/project";
constexpr const char* kSchema = "scenarios/scenario.schema.json";
constexpr const char* kProjectFiles[] = {"scenarios/pick_and_place/carton_is_held_still.yaml",
                                         kSchema,
                                         "grammars/my_rules.grammar",
                                         "README.md",
                                         ".vscode/settings.json",
                                         ".gitignore",
                                         kProjectFile};

/// `new --project DIR`.
ExitCode MakeProject(const std::string& typed, const CommandContext& context) {
  namespace fs = std::filesystem;
  const fs::path folder = typed;
  std::error_code error;
  if (ReadableName(typed) != typed)
    return Refuse(context, "--project: found " + ReadableName(typed) + ", wanted printable text");
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    return Refuse(context, "--project: found " + ReadableName(typed) +
                               ", which is not empty; wanted a new or an empty folder");
  for (const char* name : kProjectFiles) {
    const Result<std::string> text =
        name == kSchema ? scenario::ScenarioSchema()
                        : ReadTextFile((fs::path(ShippedRoot()) / kProject / name).string());
    if (!text) return Complain(context, text.error());
    const std::string problem = WriteTextFile(folder / name, *text);
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
    context.out << (folder / name).string() << "\n";
  }
  context.out << "next:\n  cd " << ShellQuoted(typed[0] == '-' ? "./" + typed : typed) << "\n";
  for (const std::string command : {"run", "check", "review"})
    context.out << "  " << CommandText({command, "carton_is_held_still"}) << "\n";
  context.out << "  " << CommandText({"accept", "carton_is_held_still"}) << " --reason \"...\"\n";
  return ExitCode::kAgrees;
}

/// `word` as a name, if it becomes one by small letters and '_'; else "".
std::string AsName(std::string word) {
  for (char& letter : word) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    if (letter == '-' || letter == ' ') letter = '_';
  }
  return episode::IsScenarioName(word) ? word : "";
}

/// "SKILL/NAME" or "NAME" as typed.
struct TypedName {
  std::string skill, name;
};

tl::expected<TypedName, ExitCode> ReadName(const std::string& typed,
                                           const CommandContext& context) {
  const std::size_t slash = typed.find('/');
  TypedName words{.skill = slash == typed.npos ? "" : typed.substr(0, slash),
                  .name = slash == typed.npos ? typed : typed.substr(slash + 1)};
  if (episode::IsScenarioName(words.name) &&
      (slash == typed.npos || episode::IsScenarioName(words.skill)))
    return words;
  const std::string fitting = slash == typed.npos ? AsName(words.name) : "";
  return tl::unexpected(
      Refuse(context, "'" + typed +
                          "' is not a scenario name; wanted a small letter, then small letters, "
                          "digits and '_', at most 64 in all, like " +
                          (fitting.empty() ? "slide_then_transport" : fitting) +
                          "; a folder may precede it, like slide/slide_then_transport"));
}

/// What the new scenario starts from: another one, or a template by its name.
tl::expected<Model, ExitCode> ModelFor(const std::string& name, const ParsedOptions& options,
                                       const CommandContext& context) {
  const std::string typed = options.Text("--like");
  const std::vector<std::string> verbs = scenario::VerbNames(context.root);
  if (!typed.empty() && std::ranges::count(verbs, typed) == 0) {
    if (!grammar::NearestName(typed, verbs).empty() &&
        !episode::FindEpisodes({&typed, 1}, "", context.root))
      return tl::unexpected(Refuse(context, "--like: " + scenario::WhyNoVerb(typed, verbs)));
    PREHEND_TRY(const auto like, FindScenarioOrComplain(typed, context));
    Result<std::string> read = ReadTextFile(like.path);
    if (!read) return tl::unexpected(Complain(context, read.error()));
    return Model{.path = like.path,
                 .text = std::move(*read),
                 .skill = like.skill.empty() ? kDefaultSkill : like.skill};
  }
  const Result<scenario::Templates> templates = scenario::ReadTemplates(context.root);
  if (!templates) return tl::unexpected(Complain(context, templates.error()));
  scenario::NewScenario made = scenario::ComposeScenario(*templates, name, typed);
  const auto path = std::filesystem::path(context.root) / "scenarios" / kDefaultSkill / "name.yaml";
  return Model{
      .path = path.string(), .text = made.text, .skill = kDefaultSkill, .made = std::move(made)};
}

/// Says what was written, and what comes next; `id` is what commands call it.
void SayWhatIsNext(const Model& model, const std::string& path, const std::string& id,
                   bool in_project, const CommandContext& context) {
  if (model.made && !model.made->note.empty()) context.err << "note: " << model.made->note << "\n";
  context.out << path << "\n";
  if (model.made) context.out << "shows: " << model.made->what << "\n";
  context.out << "next: edit it; write what it shows into 'shows' and 'expects' before its first "
                 "run; then\n";
  for (const char* command : {"validate", "run", "render"})
    context.out << "  " << CommandText({command, id}) << "\n";
  if (!in_project) {
    context.out
        << "this folder is in no project, so the file stands alone; a project keeps goldens: "
        << CommandText({"new", "--project", "DIR"}) << "\n";
    return;
  }
  for (const char* command : {"check", "review"})
    context.out << "  " << CommandText({command, id}) << "\n";
  context.out << "  " << CommandText({"accept", id}) << " --reason \"...\"\n";
}

/// In a folder that is in no project: a file there. It cannot go among the scenarios that ship.
ExitCode WriteHere(const Model& model, const std::string& name, const CommandContext& context) {
  namespace fs = std::filesystem;
  const fs::path path = fs::current_path() / (name + ".yaml");
  std::error_code error;
  if (fs::symlink_status(path, error).type() != fs::file_type::not_found)
    return Refuse(context, "this file exists: " + path.string());
  auto text = Composed(model, path, context);
  if (!text) return ExitCode::kBadInput;
  const std::string schema = (fs::path(context.root) / "scenarios/scenario.schema.json").string();
  if (text->starts_with(kModeline))
    text->replace(0, kModeline.size(), "# yaml-language-server: $schema=" + schema + "\n");
  const std::string problem = WriteTextFile(path, *text);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  SayWhatIsNext(model, path.string(), name + ".yaml", false, context);
  return ExitCode::kAgrees;
}

ExitCode RunNew(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--project")) {
    if (options.Has("name") || options.Has("--like"))
      return Refuse(context,
                    "--project makes a project, not a scenario: leave out the other words");
    return MakeProject(options.Text("--project"), context);
  }
  if (!options.Has("name"))
    return Refuse(context,
                  "the name of the scenario is missing, like 'new cup_is_lifted'; for a project of "
                  "your own: --project DIR");
  PREHEND_TRY(const auto typed, ReadName(options.Text("name"), context));
  const std::string& name = typed.name;
  PREHEND_TRY(const auto model, ModelFor(name, options, context));
  const std::string skill = typed.skill.empty() ? model.skill : typed.skill;
  if (skill == episode::kShowsErrors || skill == episode::kTemplates) {
    const std::string holds =
        skill == episode::kTemplates ? "templates of 'new'" : "examples of errors";
    return Refuse(context,
                  "scenarios/" + skill + "/ holds " + holds +
                      ", which no command reads as scenarios; choose another folder, like " +
                      std::string(kDefaultSkill) + "/" + name);
  }
  if (!IsOwnProject(context.root) && !IsCalledIn(context.root))
    return WriteHere(model, name, context);
  for (const episode::ScenarioFile& scenario : episode::ListScenarios(context.root)) {
    if (scenario.name == name)
      return Refuse(context, "a scenario of this name exists: " + scenario.path);
  }
  const auto path = std::filesystem::path(context.root) / "scenarios" / skill / (name + ".yaml");
  const auto text = Composed(model, path, context);
  if (!text) return ExitCode::kBadInput;
  const std::string problem = WriteTextFile(path, *text);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  SayWhatIsNext(model, path.string(), episode::ScenarioId(skill, name), true, context);
  return ExitCode::kAgrees;
}

}  // namespace

Command NewCommand() {
  return {
      .name = "new",
      .summary = "Write a commented scenario that does what its name says, or a project",
      .examples = {"new bottle_is_shaken", "new first_try --like pour",
                   "new slide/carton_slides_far --like carton_slides_then_is_transported",
                   "new --project my_kitchen"},
      .options =
          {Argument(
               "name",
               "what the scenario claims, like bottle_is_shaken; or skill/name. The verb and the "
               "thing are taken from it. In a folder of no project the file is written there"),
           Value("--like", "SCENARIO|VERB",
                 fmt::format(
                     "start from this scenario; or what happens, if the name does not say so: {}",
                     fmt::join(scenario::VerbNames(FindProjectRoot().value_or("")), ", "))),
           Value("--project", "DIR",
                 "make a project of your own in this new folder (docs/projects.md)")},
      .run = RunNew};
}

}  // namespace prehend::cli
