// SPDX-License-Identifier: Apache-2.0
// prehend render. Tested by tests/house/command_line_test.cc
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/commands/command.h"
#include "harness/pictures.h"
#include "harness/run_output.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

void Declare(CLI::App& options) {
  options.add_option("scenario", "a name, skill/name or a file")->required()->expected(1);
  options.add_option("-o,--output", "the PNG file; otherwise build/pictures/SKILL/NAME.png")
      ->type_name("FILE")
      ->expected(1);
  options.add_option("--at", "the moment: EVENT.begin, EVENT.end, or seconds")
      ->type_name("MOMENT")
      ->expected(1);
  options.add_option("--camera", "front, left, right, top or three_quarter")
      ->type_name("NAME")
      ->expected(1);
  DeclareRunOptions(options);
  DeclareFlag(options, "--json", "the run as one JSON object, with the pictures' files");
}

/// What the command line asks for instead of the scenario's own pictures, as YAML; empty when it
/// asks for nothing.
std::string AskedPicture(const CLI::App& options, const Scenario& scenario) {
  if (!IsGiven(options, "--at") && !IsGiven(options, "--camera") && !IsGiven(options, "--output"))
    return "";
  PictureEntry entry =
      scenario.pictures.empty() ? PictureEntry{.at = "0"} : scenario.pictures.front();
  entry.at = ValueOf(options, "--at", entry.at);
  entry.camera = ValueOf(options, "--camera", entry.camera);
  return fmt::format("[{{at: {}, camera: {}}}]", entry.at, entry.camera);
}

PictureResult Draw(const CLI::App& options, const ScenarioFile& file, const PreparedRun& prepared,
                   const RunResult& run, const std::string& root) {
  const std::string output = ValueOf(options, "--output");
  if (!output.empty())
    return DrawPicture(prepared.scenario, run, prepared.scenario.pictures.front(), output);
  const fs::path folder = fs::path(root) / "build" / "pictures" / file.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  return DrawPictures(prepared.scenario, run, folder.string());
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  const auto file = FindScenarioOrComplain(ValueOf(options, "scenario"), context);
  if (!file) return ExitCode::kNothing;
  RunRequest request = RequestOf(options, file->path);
  ReadResult<PreparedRun> prepared = PrepareRun(request, context.root);
  if (prepared.value) {
    request.pictures = AskedPicture(options, prepared.value->scenario);
    if (!request.pictures.empty()) prepared = PrepareRun(request, context.root);
  }
  if (!prepared.value) return Complain(context, prepared.diagnostics);
  if (prepared.value->scenario.pictures.empty()) {
    return Complain(context, ExitCode::kNothing,
                    "the scenario asks for no pictures; ask for one with --at");
  }

  const RunResult run =
      RunScenario(prepared.value->scenario, prepared.value->program, {.record = true});
  const PictureResult drawn = Draw(options, *file, *prepared.value, run, context.root);
  if (IsGiven(options, "--json")) {
    OrderedJson json = RunJson(prepared.value->scenario, run);
    json["pictures"] = OrderedJson::array();
    for (const WrittenPicture& picture : drawn.pictures) {
      json["pictures"].push_back({{"file", picture.file}, {"caption", picture.caption}});
    }
    context.out << json.dump(2) << "\n";
  } else {
    for (const WrittenPicture& picture : drawn.pictures) context.out << picture.file << "\n";
  }
  if (!drawn.error.empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + drawn.error);
  if (run.status.kind == physics::RunStatus::Kind::kCompleted) return ExitCode::kAgrees;
  return Complain(context, ExitCode::kFailure, StatusText(run));
}

}  // namespace

Command RenderCommand() {
  return {.name = "render",
          .summary = "Draw a scenario's pictures, or one of your own",
          .examples =
              "prehend render milk_carton_wrap\n"
              "prehend render milk_carton_wrap -o milk.png\n"
              "prehend render milk_carton_wrap --at transporting.begin --camera left -o left.png",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
