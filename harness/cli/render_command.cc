// SPDX-License-Identifier: Apache-2.0
// prehend render. Tested by tests/program/command_line_test.cc
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/base/atomic_file.h"
#include "harness/command/command.h"
#include "harness/command/recorded_episode.h"
#include "harness/episodes/schema.h"
#include "harness/pictures/pictures.h"
#include "harness/run/event_time.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

/// The picture that the command line asks for instead of the scenario's own; nothing when it asks
/// for none.
std::optional<PictureYaml> AskedPicture(const ParsedOptions& options, const Scenario& scenario) {
  if (!options.Has("--at") && !options.Has("--camera") && !options.Has("--output"))
    return std::nullopt;
  PictureYaml entry =
      scenario.pictures.empty() ? PictureYaml{.at = {"0", {}}} : scenario.pictures.front();
  entry.at.value = options.TextOr("--at", entry.at.value);
  entry.camera.value = options.TextOr("--camera", entry.camera.value);
  return entry;
}

PictureResult Draw(const ParsedOptions& options, const LoadedRun& loaded, const RunResult& run,
                   const std::string& root) {
  const std::string output = options.Text("--output");
  if (!output.empty())
    return DrawPicture(loaded.scenario, run, loaded.scenario.pictures.front(), output);
  const fs::path folder = fs::path(root) / "build" / "pictures" / loaded.scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  return DrawPictures(loaded.scenario, run, folder.string());
}

ExitCode RunRender(const ParsedOptions& options, const CommandContext& context) {
  const std::string typed = options.Text("scenario");
  std::optional<RecordedEpisode> recorded;
  Result<LoadedRun> loaded;
  if (episodes::IsEpisodeFile(typed)) {
    auto opened = OpenRecordedOrComplain(typed, options, context);
    if (!opened) return opened.error();
    recorded.emplace(std::move(*opened));
    loaded = recorded->loaded;
  } else {
    const auto file = FindScenarioOrComplain(typed, context);
    if (!file) return file.error();
    loaded = LoadRun(RequestOf(options, file->path), context.root);
  }
  if (!loaded) return Complain(context, loaded.error());
  if (auto asked = AskedPicture(options, loaded->scenario)) {
    const auto problem = WhyNoEventTime(asked->at.value, *loaded->program);
    if (problem && options.Has("--at")) {
      return Complain(context, ExitCode::kBadInput,
                      "--at: " + problem->message + "; " + problem->hint);
    }
    if (const auto why = WhyNoCamera(loaded->scenario, asked->camera.value))
      return Complain(context, ExitCode::kBadInput, "--" + *why);
    loaded->scenario.pictures = {std::move(*asked)};
  }
  if (loaded->scenario.pictures.empty()) {
    return Complain(context, ExitCode::kNothing,
                    "the scenario defines no pictures; --at asks for one");
  }

  if (options.Has("--output")) {
    const std::string output = options.Text("--output");
    const std::string why = output == "-" ? "found '-', wanted a file; pictures are not printed"
                                          : AtomicFile(output).problem();
    if (!why.empty()) return Complain(context, ExitCode::kBadInput, "--output: " + why);
  }

  const Result<RunResult> played =
      recorded ? episodes::Replay(recorded->file, recorded->row, *loaded)
               : RunScenario(loaded->scenario, loaded->program, {.record = true});
  if (!played) return Complain(context, played.error());
  const RunResult& run = *played;
  const PictureResult drawn = Draw(options, *loaded, run, context.root);
  for (const WrittenPicture& picture : drawn.pictures) {
    if (!picture.missed.empty())
      context.err << "prehend: warning: " << picture.file << ": " << picture.missed
                  << "; the picture shows the end of the run\n";
  }
  if (options.Has("--json")) {
    OrderedJson json = RunJson(loaded->scenario, run);
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
  return {
      .name = "render",
      .summary = "Draw a scenario's pictures, or one of your own",
      .examples = {"render milk_carton_wrap", "render milk_carton_wrap -o milk.png",
                   "render suite.episodes --episode slide/hop_divides_a_slide -o hop.png",
                   "render milk_carton_wrap --at transporting.begin --camera left -o left.png"},
      .options = {EpisodeArgument(),
                  EpisodeOption(),
                  {.name = "--output",
                   .help = "the PNG file; default: build/pictures/SKILL/NAME.png",
                   .placeholder = "FILE",
                   .other_name = "-o",
                   .is_output = true},
                  {.name = "--at",
                   .help = "when: EVENT.begin, EVENT.end, or seconds",
                   .placeholder = "TIME"},
                  {.name = "--camera",
                   .help = "from where: front, left, right, top, three_quarter, or a camera of\n"
                           "the scenario",
                   .placeholder = "CAMERA"},
                  GrammarOption(),
                  SettingsOption(),
                  {.name = "--json",
                   .help = "print the run as one JSON object, with the files of its pictures"}},
      .run = RunRender};
}

}  // namespace prehend::harness
