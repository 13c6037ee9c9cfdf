// SPDX-License-Identifier: Apache-2.0
// prehend render. Tested by tests/program/command_line_test.cc
#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/base/atomic_file.h"
#include "harness/cli/command.h"
#include "harness/pictures/pictures.h"
#include "harness/run/event_time.h"
#include "harness/run/run_text.h"

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
  options
      .add_option("--camera",
                  "from where: front, left, right, top, three_quarter, or a camera of the scenario")
      ->type_name("CAMERA")
      ->expected(1);
  DeclareRunOptions(options);
  DeclareFlag(options, "--json", "the run as one JSON object, with the pictures' files");
}

/// What the command line asks for instead of the scenario's own pictures; nothing when it does not.
std::optional<PictureYaml> AskedPicture(const CLI::App& options, const Scenario& scenario) {
  if (!IsGiven(options, "--at") && !IsGiven(options, "--camera") && !IsGiven(options, "--output"))
    return std::nullopt;
  PictureYaml entry =
      scenario.pictures.empty() ? PictureYaml{.at = {"0", {}}} : scenario.pictures.front();
  entry.at.value = ValueOf(options, "--at", entry.at.value);
  entry.camera.value = ValueOf(options, "--camera", entry.camera.value);
  return entry;
}

PictureResult Draw(const CLI::App& options, const ScenarioFile& file, const LoadedRun& loaded,
                   const RunResult& run, const std::string& root) {
  const std::string output = ValueOf(options, "--output");
  if (!output.empty())
    return DrawPicture(loaded.scenario, run, loaded.scenario.pictures.front(), output);
  const fs::path folder = fs::path(root) / "build" / "pictures" / file.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  return DrawPictures(loaded.scenario, run, folder.string());
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  const auto file = FindScenarioOrComplain(ValueOf(options, "scenario"), context);
  if (!file) return ExitCode::kNothing;
  ReadResult<LoadedRun> loaded = LoadRun(RequestOf(options, file->path), context.root);
  if (!loaded.value) return Complain(context, loaded.diagnostics);
  if (auto asked = AskedPicture(options, loaded.value->scenario)) {
    const auto problem = WhyNoEventTime(asked->at.value, *loaded.value->program);
    if (problem && IsGiven(options, "--at")) {
      return Complain(context, ExitCode::kBadInput,
                      "--at: " + problem->message + "; " + problem->hint);
    }
    if (const auto why = WhyNoCamera(loaded.value->scenario, asked->camera.value))
      return Complain(context, ExitCode::kBadInput, "--" + *why);
    loaded.value->scenario.pictures = {std::move(*asked)};
  }
  if (loaded.value->scenario.pictures.empty()) {
    return Complain(context, ExitCode::kNothing,
                    "the scenario asks for no pictures; ask for one with --at");
  }

  if (IsGiven(options, "--output")) {
    const std::string output = ValueOf(options, "--output");
    const std::string why = output == "-" ? "found '-', wanted a file; pictures are not printed"
                                          : AtomicFile(output).problem();
    if (!why.empty()) return Complain(context, ExitCode::kBadInput, "--output: " + why);
  }

  const RunResult run =
      RunScenario(loaded.value->scenario, loaded.value->program, {.record = true});
  const PictureResult drawn = Draw(options, *file, *loaded.value, run, context.root);
  for (const WrittenPicture& picture : drawn.pictures) {
    if (!picture.missed.empty())
      context.err << "prehend: warning: " << picture.file << ": " << picture.missed
                  << "; it shows the end\n";
  }
  if (IsGiven(options, "--json")) {
    OrderedJson json = RunJson(loaded.value->scenario, run);
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
