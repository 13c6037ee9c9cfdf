// SPDX-License-Identifier: Apache-2.0
// prehend scenario rename. Tested by tests/program/suite_edge_test.cc
#include <fmt/format.h>

#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/golden/golden.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// The scenario under its new name, and where it is to lie.
struct Renamed {
  episode::ScenarioFile from;
  std::string id, skill, name;
  fs::path path;
};

/// "" or why it cannot have this name.
std::string WhyNotRenamed(const std::string& typed, const std::string& root, Renamed& renamed) {
  const std::size_t slash = typed.find('/');
  renamed.skill = slash == typed.npos ? renamed.from.skill : typed.substr(0, slash);
  renamed.name = slash == typed.npos ? typed : typed.substr(slash + 1);
  renamed.id = episode::ScenarioId(renamed.skill, renamed.name);
  if (!episode::IsScenarioName(renamed.name) ||
      (slash != typed.npos && !episode::IsScenarioName(renamed.skill)))
    return fmt::format(
        "found '{}', wanted NAME or SKILL/NAME of small letters, digits and '_', a letter first",
        typed);
  if (!renamed.from.in_project) return renamed.from.path + " is no scenario of this project";
  renamed.path = fs::path(root) / "scenarios" / renamed.skill / (renamed.name + ".yaml");
  std::error_code error;
  if (fs::exists(renamed.path, error)) return renamed.path.string() + " is there already";
  const truth::GoldenFiles goldens(root);
  if (fs::exists(goldens.GoldenPath(renamed.id), error) || !goldens.PicturesOf(renamed.id).empty())
    return "there is a golden of '" + renamed.id + "' already";
  return "";
}

/// A file whose text names the scenario: a line that begins with `key`.
Result<std::string> WithName(const fs::path& file, const std::string& key, const std::string& from,
                             const std::string& to) {
  Result<std::string> text = ReadTextFile(file.string());
  if (!text) return text;
  for (const std::string quote : {"", "\"", "'"}) {
    const std::string line = key + quote + from + quote;
    const std::size_t at = text->starts_with(line) ? 0 : text->find("\n" + line);
    if (at == std::string::npos) continue;
    text->replace(at + (at == 0 ? 0 : 1), line.size(), key + to);
    return text;
  }
  return tl::unexpected(
      grammar::Diagnostics{{.file = file.string(), .message = "no line '" + key + from + "'"}});
}

/// Moves a file, its new text instead of the old. "" or what went wrong.
std::string Move(const fs::path& from, const fs::path& to, const std::string& text,
                 const CommandContext& context) {
  std::string problem = WriteTextFile(to, text);
  std::error_code error;
  if (problem.empty() && !fs::remove(from, error)) problem = from.string() + ": cannot be removed";
  if (problem.empty()) context.out << from.string() << " -> " << to.string() << "\n";
  return problem;
}

ExitCode RunRename(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto found, FindScenarioOrComplain(options.Text("OLD"), context));
  Renamed renamed{.from = found, .skill = {}, .name = {}};
  std::string problem = WhyNotRenamed(options.Text("NEW"), context.root, renamed);
  if (!problem.empty()) return Refuse(context, problem);
  const std::string id = episode::IdOf(found);
  const auto text = WithName(found.path, "scenario: ", found.name, renamed.name);
  if (!text) return Complain(context, text.error());
  const truth::GoldenFiles goldens(context.root);
  const fs::path golden = goldens.GoldenPath(id);
  std::error_code error;
  const bool has_golden = fs::exists(golden, error);
  const auto golden_text =
      has_golden ? WithName(golden, "# scenario: ", id, renamed.id) : Result<std::string>("");
  if (!golden_text) return Complain(context, golden_text.error());
  // What it names beside itself may not be beside its new place.
  problem = WriteTextFile(renamed.path, *text);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const auto loaded = episode::LoadRun({renamed.path.string(), "", {}}, context.root);
  fs::remove(renamed.path, error);
  if (!loaded && episode::LoadRun({found.path, "", {}}, context.root))
    return Complain(context, loaded.error());
  problem = Move(found.path, renamed.path, *text, context);
  if (problem.empty() && has_golden)
    problem = Move(golden, goldens.GoldenPath(renamed.id), *golden_text, context);
  for (const truth::KeptPicture& picture : goldens.PicturesOf(id)) {
    const std::string name =
        renamed.name + picture.path.filename().string().substr(found.name.size());
    const fs::path to = goldens.PicturePath(renamed.id, name);
    fs::create_directories(to.parent_path(), error);
    fs::rename(picture.path, to, error);
    if (error && problem.empty()) problem = to.string() + ": " + error.message();
    if (!error) context.out << picture.path.string() << " -> " << to.string() << "\n";
  }
  goldens.RemovePending(id);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace

Command RenameCommand() {
  return {.name = "scenario rename",
          .summary = "Give a scenario another name: its file, golden, pictures and reasons move",
          .examples = {"scenario rename milk_carton_wrap milk_is_carried",
                       "scenario rename milk_carton_wrap carry/milk"},
          .options = {Required(Argument("OLD", "a name or skill/name")),
                      Required(Argument("NEW", "a name, in the same folder, or skill/name"))},
          .run = RunRename};
}

}  // namespace prehend::cli
