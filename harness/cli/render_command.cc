// SPDX-License-Identifier: Apache-2.0
// prehend render. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
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

constexpr int kLeastSide_px = 64, kMostSide_px = 4096, kMostSheetSide_px = 8192;
constexpr int kMostColumns = 8;
constexpr std::size_t kMostPictures = 64;

struct Size {
  int width_px = 0, height_px = 0;
};

/// Of "1200x800".
std::optional<Size> SizeOf(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto [cross, width_error] = std::from_chars(text.data(), end, size.width_px);
  if (width_error != std::errc() || cross == end || *cross != 'x') return std::nullopt;
  const auto [stop, height_error] = std::from_chars(cross + 1, end, size.height_px);
  if (height_error != std::errc() || stop != end) return std::nullopt;
  const auto fits = [](int side_px) { return side_px >= kLeastSide_px && side_px <= kMostSide_px; };
  return fits(size.width_px) && fits(size.height_px) ? std::optional(size) : std::nullopt;
}

ValueRule Sizes() {
  return {
      fmt::format("WxH, each {} to {}", kLeastSide_px, kMostSide_px), [](const std::string& value) {
        return SizeOf(value)
                   ? ""
                   : fmt::format("expected a size like 1280x720, each side {} to {}, found '{}'",
                                 kLeastSide_px, kMostSide_px, value);
      }};
}

struct Part {
  const char* name;
  bool PictureFormat::*shown;
};
constexpr Part kParts[] = {{"title", &PictureFormat::title}, {"labels", &PictureFormat::labels},
                           {"strip", &PictureFormat::strip}, {"ghosts", &PictureFormat::ghosts},
                           {"paths", &PictureFormat::paths}, {"gaze", &PictureFormat::gaze}};

/// The words between commas.
std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

ValueRule PartsOfPicture() {
  return {"title, labels, strip, ghosts, paths, gaze", [](const std::string& value) {
            for (const std::string& word : Split(value)) {
              const auto is = [&](const Part& part) { return word == part.name; };
              if (std::ranges::none_of(kParts, is))
                return fmt::format(
                    "expected some of title, labels, strip, ghosts, paths, gaze, "
                    "with commas between them, found '{}'",
                    word);
            }
            return std::string();
          }};
}

ValueRule Themes() {
  return {"light or print", [](const std::string& value) {
            return value == "light" || value == "print"
                       ? std::string()
                       : fmt::format("expected light or print, found '{}'", value);
          }};
}

PictureFormat FormatOf(const ParsedOptions& options) {
  PictureFormat format{.text_scale = options.NumberOr("--text", 1),
                       .print = options.Text("--theme") == "print",
                       .only = options.Text("--only"),
                       .of = options.Text("--of")};
  if (const auto size = SizeOf(options.Text("--size"))) {
    format.width_px = size->width_px;
    format.height_px = size->height_px;
  }
  if (options.Has("--from")) format.from_s = options.NumberOr("--from", 0);
  if (options.Has("--to")) format.to_s = options.NumberOr("--to", 0);
  for (const std::string& words : options.All("--without")) {
    for (const std::string& word : Split(words))
      for (const Part& part : kParts)
        if (word == part.name) format.*part.shown = false;
  }
  return format;
}

/// What is wrong with the window, the hand or the thing, or "".
std::string WhyNotDrawn(const PictureFormat& format, const Scenario& scenario) {
  if (format.from_s.value_or(0) >= format.to_s.value_or(1e9))
    return fmt::format("--from: found {:g} s, wanted less than --to, {:g} s",
                       format.from_s.value_or(0), format.to_s.value_or(0));
  const auto unknown = [](const char* option, const std::string& name,
                          const std::vector<std::string>& known) -> std::string {
    if (name.empty() || std::ranges::find(known, name) != known.end()) return "";
    return fmt::format("{}: found '{}', wanted one of {}", option, name, fmt::join(known, ", "));
  };
  std::vector<std::string> hands, all;
  for (const physics::Hand& hand : scenario.scene.hands) hands.push_back(hand.name);
  for (const physics::Body& body : scenario.scene.bodies) all.push_back(body.name);
  all.insert(all.end(), hands.begin(), hands.end());
  const std::string why = unknown("--only", format.only, hands);
  return why.empty() ? unknown("--of", format.of, all) : why;
}

/// The pictures that the command line asks for instead of the scenario's own; none when it asks
/// for none.
std::vector<PictureYaml> AskedPictures(const ParsedOptions& options, const Scenario& scenario) {
  if (!options.Has("--at") && !options.Has("--camera") && !options.Has("--output")) return {};
  PictureYaml entry =
      scenario.pictures.empty() ? PictureYaml{.at = {"0", {}}} : scenario.pictures.front();
  entry.camera.value = options.TextOr("--camera", entry.camera.value);
  if (!options.Has("--at")) {
    if (options.Has("--sheet") && !scenario.pictures.empty()) return scenario.pictures;
    return {entry};
  }
  std::vector<PictureYaml> entries;
  for (const std::string& at : Split(options.Text("--at"))) {
    entries.push_back(entry);
    entries.back().at.value = at;
  }
  return entries;
}

/// Why these pictures do not fit on one sheet, or "".
std::string WhyNoSheet(const ParsedOptions& options, std::size_t pictures) {
  if (pictures > kMostPictures)
    return fmt::format("--at: found {} moments, wanted at most {}", pictures, kMostPictures);
  if (!options.Has("--sheet")) {
    return pictures > 1 && options.Has("--output")
               ? "--at: several moments in one file need --sheet, the number of columns"
               : "";
  }
  if (!options.Has("--output")) return "--sheet needs --output, the file of the sheet";
  const PictureFormat format = FormatOf(options);
  const int columns = options.IntOr("--sheet", 1);
  const int rows = (static_cast<int>(pictures) + columns - 1) / columns;
  if (columns * format.width_px <= kMostSheetSide_px &&
      rows * format.height_px <= kMostSheetSide_px)
    return "";
  return fmt::format(
      "--sheet: {} x {} pixels are too many, at most {} per side; choose a smaller "
      "--size",
      columns * format.width_px, rows * format.height_px, kMostSheetSide_px);
}

PictureResult Draw(const ParsedOptions& options, const LoadedRun& loaded, const RunResult& run,
                   const std::string& root) {
  const std::string output = options.Text("--output");
  const PictureFormat format = FormatOf(options);
  if (options.Has("--sheet"))
    return DrawSheet(loaded.scenario, run, loaded.scenario.pictures, options.IntOr("--sheet", 1),
                     output, format);
  if (!output.empty())
    return DrawPicture(loaded.scenario, run, loaded.scenario.pictures.front(), output, format);
  const fs::path folder = fs::path(root) / "build" / "pictures" / loaded.scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  return DrawPictures(loaded.scenario, run, folder.string(), format);
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
  auto asked = AskedPictures(options, loaded->scenario);
  for (const PictureYaml& entry : asked) {
    const auto problem = WhyNoEventTime(entry.at.value, *loaded->program);
    if (problem && options.Has("--at")) {
      return Complain(context, ExitCode::kBadInput,
                      "--at: " + problem->message + "; " + problem->hint);
    }
    if (const auto why = WhyNoCamera(loaded->scenario, entry.camera.value))
      return Complain(context, ExitCode::kBadInput, "--" + *why);
  }
  for (const std::string& why :
       {WhyNotDrawn(FormatOf(options), loaded->scenario), WhyNoSheet(options, asked.size())}) {
    if (!why.empty()) return Complain(context, ExitCode::kBadInput, why);
  }
  if (!asked.empty()) loaded->scenario.pictures = std::move(asked);
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
    std::string last;  // the pictures of a sheet have one file
    for (const WrittenPicture& picture : drawn.pictures) {
      if (picture.file != last) context.out << picture.file << "\n";
      last = picture.file;
    }
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
                   "render milk_carton_wrap --at transporting.begin --camera left -o left.png",
                   "render milk_carton_wrap --at reaching.begin,grasping.begin,putting_down.end "
                   "--sheet 3 --size 640x480 --theme print -o sheet.png"},
      .options = {EpisodeArgument(),
                  EpisodeOption(),
                  {.name = "--output",
                   .help = "the PNG file; default: build/pictures/SKILL/NAME.png",
                   .placeholder = "FILE",
                   .other_name = "-o",
                   .is_output = true},
                  {.name = "--at",
                   .help = "when: EVENT.begin, EVENT.end, or seconds; for a sheet several,\n"
                           "with commas between them",
                   .placeholder = "TIME"},
                  {.name = "--camera",
                   .help = "from where: front, left, right, top, three_quarter; hand, action or\n"
                           "body, which are nearer to what they name; or a camera of the scenario",
                   .placeholder = "CAMERA"},
                  {.name = "--sheet",
                   .help = "all pictures in one file, with so many columns",
                   .placeholder = "N",
                   .rule = IntegersFrom(1, kMostColumns)},
                  {.name = "--size",
                   .help = "pixels of a picture; default: 1280x720",
                   .placeholder = "WxH",
                   .rule = Sizes()},
                  {.name = "--text",
                   .help = "scale of all text; default: 1",
                   .placeholder = "SCALE",
                   .rule = NumbersFrom(0.3, 5)},
                  {.name = "--theme",
                   .help = "light, or print: on white paper",
                   .placeholder = "THEME",
                   .rule = Themes()},
                  {.name = "--from",
                   .help = "begin of the part whose events, paths and ghosts are shown, seconds",
                   .placeholder = "S",
                   .rule = NumbersFrom(0, 1e6)},
                  {.name = "--to",
                   .help = "end of that part; default: all, but paths and ghosts of an episode of\n"
                           "more than 15 s only around the moment",
                   .placeholder = "S",
                   .rule = NumbersFrom(0, 1e6)},
                  {.name = "--only",
                   .help = "paths, ghosts and rows of this hand only",
                   .placeholder = "HAND"},
                  {.name = "--of",
                   .help = "the path of this thing, and only events that it takes part in",
                   .placeholder = "NAME"},
                  {.name = "--without",
                   .help = "leave these out",
                   .placeholder = "PART,..",
                   .rule = PartsOfPicture(),
                   .repeatable = true},
                  GrammarOption(),
                  SettingsOption(),
                  {.name = "--json",
                   .help = "print the run as one JSON object, with the files of its pictures"}},
      .run = RunRender};
}

}  // namespace prehend::harness
