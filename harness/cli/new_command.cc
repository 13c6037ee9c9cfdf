// SPDX-License-Identifier: Apache-2.0
// prehend new: a commented scenario to start from, or a project of one's own. Tested by
// tests/program/command_line_test.cc and tests/program/project_test.cc
#include <filesystem>

#include "harness/base/atomic_file.h"
#include "harness/base/default_grammar.h"
#include "harness/base/project_paths.h"
#include "harness/base/shell_quote.h"
#include "harness/base/text_file.h"
#include "harness/command/command.h"
#include "harness/format/scenario_copy.h"
#include "harness/format/scenario_fields.h"
#include "harness/read/read_scenario.h"
#include "harness/run/project_library.h"

namespace prehend::harness {
namespace {

constexpr const char* kDefaultSkill = kDefaultGrammar;

constexpr const char* kTemplate = R"(# yaml-language-server: $schema=../scenario.schema.json
# Every key is explained in docs/scenario-format.md. Units are the last word of a key; z is up.
scenario: name
shows: a carton is picked up with a wrap grasp and put down further to the right   # what it proves, as a sentence
grammar: pick_and_place            # a file of grammar/library/, without ".grammar"
tags: []

# What must be recognised if the sentence is true. Write it before the first run: afterwards it is easy to expect
# whatever came out. `any` fits everybody. `check` fails on what contradicts a line, and `accept` refuses it.
expects:
  - one pick_and_place(right_hand, carton)
  - reaching(right_hand, carton) then grasping(right_hand, carton, style=wrap)
  - no sliding

# Things. `on` puts one onto another; then at_m gives x and y only.
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  carton: {class: MilkCarton, box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, friction: 0.8, on: table, at_m: [0.2, 0.1]}

# Hands, and where they start.
actors:
  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}

# One step after another. Hands named in one entry act at the same time.
script:
  - right_hand: {reach: carton, style: wrap, over_s: 0.8}
  - right_hand: {close_to: 1.0, over_s: 0.6}
  - right_hand: {lift_by_m: 0.25, over_s: 0.6}
  - right_hand: {carry_to_m: [0.2, -0.3], over_s: 1.0}
  - right_hand: {place_on: table, over_s: 0.6}
  - right_hand: {open_to: 0.0, over_s: 0.45}
  - right_hand: {retreat_by_m: 0.2, over_s: 0.6}

# Pictures for the report: at an event's begin or end, or at a time in seconds.
pictures:
  - {at: transporting.begin, camera: three_quarter}
)";

constexpr std::string_view kModeline = "# yaml-language-server: $schema=../scenario.schema.json\n";

/// The text that a new scenario starts from.
struct Model {
  std::string path;  ///< of the template: where it would stand in the default folder
  std::string text = kTemplate;
  std::string skill = kDefaultSkill;
};

/// The text of the scenario for `path`, with the line that editors look for. Errors of the model
/// are reported in the model's own file; then nothing is returned.
std::optional<std::string> Composed(const Model& model, const std::filesystem::path& path,
                                    const CommandContext& context) {
  const ScenarioLibrary library = ProjectLibrary(context.root);
  if (const auto as_it_is = ReadScenarioText(model.path, model.text, {}, library); !as_it_is) {
    Complain(context, as_it_is.error());
    return std::nullopt;
  }
  Result<std::string> copy = CopyOfScenario(model.path, model.text, path);
  if (copy) {
    const bool has_modeline = copy->find("yaml-language-server:") != std::string::npos;
    if (!has_modeline) copy->insert(0, kModeline);
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // for paths that go through it
    const Result<Scenario> read = ReadScenarioText(path.string(), *copy, {}, library);
    if (read) return *copy;
    std::filesystem::remove(path.parent_path(), error);  // only when it is empty
    copy = tl::unexpected(read.error());
  }
  Complain(context, copy.error());
  return std::nullopt;
}

constexpr const char* kOwnGrammar =
    R"(# Rules of your own. The language: docs/grammar-tutorial.md of prehend teaches it.
grammar my_rules

use pick_and_place      # from what ships with prehend: reaching, grasping, picking_up, transporting, ..

param still_below = 5 cm/s
param still_for   = 0.3 s

# A thing is held in the air and does not move.
event held_still(hand: Hand, object: Movable)
  while grasping(hand, object) and not supported_by(object, any) and speed(object) < still_below
  bridging 50 ms
  lasting still_for
)";

constexpr const char* kProjectText =
    R"(# The root of a project of prehend. Only the place of this file matters: prehend, called in this folder or
# below it, uses its scenarios, goldens, grammars and hands first, and what ships with prehend second.
)";

constexpr const char* kProjectReadme = R"(# A project of prehend

| folder | holds |
|---|---|
| `scenarios/SKILL/NAME.yaml` | what happens, and what must be recognised |
| `golden/SKILL/NAME.timeline` | what was accepted, written by `prehend accept` |
| `grammars/NAME.grammar` | your rules; a file here comes before one of the same name that ships with prehend |
| `hands/NAME.hand.yaml` | your hands, likewise |
| `build/` | reports and what waits for review; can be deleted |

    prehend check                   # all scenarios of this project, with a web page
    prehend review                  # what is new or differs
    prehend accept carton_is_held_still --reason "..."
    prehend new cup_is_lifted       # one more scenario
    prehend run milk_carton_wrap    # scenarios that ship with prehend can be run, too
)";

constexpr const char* kEditorSettings = R"({
  "yaml.schemas": {"./scenarios/scenario.schema.json": "scenarios/**/*.yaml"}
}
)";

/// The template as the scenario of a project with rules of its own.
std::string FirstScenario() {
  std::string text = kTemplate;
  const auto replace = [&](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("scenario: name", "scenario: carton_is_held_still");
  replace("a carton is picked up with a wrap grasp and put down further to the right",
          "a carton is picked up, held still for a moment and put down further to the right");
  replace("grammar: pick_and_place            # a file of grammar/library/, without \".grammar\"",
          "grammar: my_rules                  # grammars/my_rules.grammar");
  replace("  - no sliding\n", "  - no sliding\n  - one held_still(right_hand, carton)\n");
  replace("  - right_hand: {carry_to_m",
          "  - right_hand: {wait_s: 0.5}\n  - right_hand: {carry_to_m");
  replace("at: transporting.begin", "at: held_still.begin");
  return text;
}

/// `new --project DIR`.
ExitCode MakeProject(const std::string& typed, const CommandContext& context) {
  namespace fs = std::filesystem;
  const fs::path folder = typed;
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    return Complain(context, ExitCode::kBadInput,
                    "--project: found " + ReadableName(typed) +
                        ", which is not empty; wanted a new or an empty folder");
  const std::pair<const char*, std::string> files[] = {
      {"scenarios/pick_and_place/carton_is_held_still.yaml", FirstScenario()},
      {"scenarios/scenario.schema.json", ScenarioSchema()},
      {"grammars/my_rules.grammar", kOwnGrammar},
      {"README.md", kProjectReadme},
      {".vscode/settings.json", kEditorSettings},
      {".gitignore", "build/\n"},
      {kProjectFile, kProjectText},  // last: without it the folder is no project
  };
  for (const auto& [name, text] : files) {
    const std::string problem = WriteTextFile(folder / name, text);
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
    context.out << (folder / name).string() << "\n";
  }
  context.out << "next:\n  cd " << ShellQuoted(typed) << "\n";
  for (const char* command : {"run", "check", "review"}) {
    const std::vector<std::string> words = {command, "carton_is_held_still"};
    context.out << "  " << CommandText(words) << "\n";
  }
  context.out << "  " << CommandText({"accept", "carton_is_held_still"}) << " --reason \"...\"\n";
  return ExitCode::kAgrees;
}

/// A small letter, then small letters, digits and '_', at most 64 in all.
bool IsName(std::string_view word) {
  return !word.empty() && word.size() <= 64 && word.front() >= 'a' && word.front() <= 'z' &&
         word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == word.npos;
}

ExitCode RunNew(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--project")) {
    if (options.Has("name") || options.Has("--like"))
      return Complain(context, ExitCode::kBadInput,
                      "--project makes a project, not a scenario: leave out the other words");
    return MakeProject(options.Text("--project"), context);
  }
  if (!options.Has("name"))
    return Complain(context, ExitCode::kBadInput,
                    "the name of the scenario is missing, like 'new cup_is_lifted'; for a project "
                    "of your own: --project DIR");
  const std::string typed = options.Text("name");
  const std::size_t slash = typed.find('/');
  const std::string name = slash == std::string::npos ? typed : typed.substr(slash + 1);
  const bool has_folder = slash != std::string::npos;
  if (!IsName(name) || (has_folder && !IsName(typed.substr(0, slash)))) {
    return Complain(
        context, ExitCode::kBadInput,
        "'" + typed +
            "' is not a scenario name; wanted a small letter, then small letters, digits and '_', "
            "at most 64 in all, like slide_then_transport; a folder may precede it, like "
            "slide/slide_then_transport");
  }
  namespace fs = std::filesystem;
  const fs::path scenarios = fs::path(context.root) / "scenarios";
  Model model{.path = (scenarios / kDefaultSkill / "name.yaml").string()};
  if (options.Has("--like")) {
    const auto like = FindScenarioOrComplain(options.Text("--like"), context);
    if (!like) return like.error();
    Result<std::string> read = ReadTextFile(like->path);
    if (!read) return Complain(context, read.error());
    model = {.path = like->path,
             .text = std::move(*read),
             .skill = like->skill.empty() ? kDefaultSkill : like->skill};
  }
  const std::string skill = has_folder ? typed.substr(0, slash) : model.skill;
  if (skill == kShowsErrors) {
    return Complain(context, ExitCode::kBadInput,
                    "scenarios/invalid/ holds examples of errors, which no command reads as "
                    "scenarios; choose another folder, like " +
                        std::string(kDefaultSkill) + "/" + name);
  }
  for (const ScenarioFile& scenario : ListScenarios(context.root)) {
    if (scenario.name == name)
      return Complain(context, ExitCode::kBadInput,
                      "a scenario of this name exists: " + scenario.path);
  }
  const fs::path path = scenarios / skill / (name + ".yaml");
  const auto text = Composed(model, path, context);
  if (!text) return ExitCode::kBadInput;
  const std::string problem = WriteTextFile(path, *text);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const std::string id = ScenarioId(skill, name);
  context.out << path.string()
              << "\nnext: edit it; write what it shows into 'shows' and 'expects' before its "
                 "first run; then\n";
  for (const char* command : {"validate", "run", "render", "check", "review"})
    context.out << "  " << CommandText({command, id}) << "\n";
  context.out << "  " << CommandText({"accept", id}) << " --reason \"...\"\n";
  return ExitCode::kAgrees;
}

}  // namespace

Command NewCommand() {
  return {.name = "new",
          .summary = "Write a commented, runnable scenario to start from, or a project",
          .examples = {"new carton_is_lifted",
                       "new slide/carton_slides_far --like carton_slides_then_is_transported",
                       "new --project my_kitchen"},
          .options = {{.name = "name",
                       .help = "what the scenario claims, like carton_slides_then_is_lifted; or "
                               "skill/name"},
                      {.name = "--like",
                       .help = "start from this scenario instead of the template",
                       .placeholder = "SCENARIO"},
                      {.name = "--project",
                       .help = "make a project of your own in this new folder (docs/projects.md)",
                       .placeholder = "DIR"}},
          .run = RunNew};
}

}  // namespace prehend::harness
