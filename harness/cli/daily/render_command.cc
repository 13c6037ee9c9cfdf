// SPDX-License-Identifier: Apache-2.0
// prehend render. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/cli/command/command.h"
#include "harness/cli/command/picture_options.h"
#include "harness/cli/daily/recogniser_choice.h"
#include "harness/episode/run/run_text.h"
#include "harness/show/figures/figures.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastSide_px = 64, kMostSide_px = 4096, kMostSheetSide_px = 8192;
constexpr int kMostColumns = 8;
constexpr std::size_t kMostPictures = 64;
constexpr double kComparisonWidth_px = 900;
constexpr int kSheetTile_px = 360;  ///< width of a scene of a sheet, in pixels of the drawing

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
  bool show::PictureFormat::*shown;
};
constexpr Part kParts[] = {
    {"title", &show::PictureFormat::title}, {"labels", &show::PictureFormat::labels},
    {"strip", &show::PictureFormat::strip}, {"ghosts", &show::PictureFormat::ghosts},
    {"paths", &show::PictureFormat::paths}, {"gaze", &show::PictureFormat::gaze}};

std::vector<std::string> PartNames() {
  std::vector<std::string> names;
  for (const Part& part : kParts) names.emplace_back(part.name);
  return names;
}

show::PictureFormat FormatOf(const ParsedOptions& options) {
  show::PictureFormat format = FormatOfOptions(options);
  if (const auto size = SizeOf(options.Text("--size"))) {
    format.width_px = size->width_px;
    format.height_px = size->height_px;
  }
  for (const std::string& words : options.All("--without")) {
    for (const std::string& word : SplitAt(words, ','))
      for (const Part& part : kParts)
        if (word == part.name) format.*part.shown = false;
  }
  return format;
}

show::PictureChoice ChoiceOf(const ParsedOptions& options) {
  show::PictureChoice choice{.camera = options.Text("--camera"), .all = options.Has("--sheet")};
  if (options.Has("--at")) choice.at = SplitAt(options.Text("--at"), ',');
  // A sheet's scenes are small.
  if (choice.all && options.Has("--at") && choice.camera.empty()) choice.camera = "action";
  return choice;
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
  const show::PictureFormat format = FormatOf(options);
  const int columns = options.IntOr("--sheet", 1);
  const int rows = (static_cast<int>(pictures) + columns - 1) / columns;
  if (columns * format.width_px <= kMostSheetSide_px &&
      rows * format.height_px <= kMostSheetSide_px)
    return "";
  return fmt::format(
      "--sheet: {} x {} pixels are too many, at most {} per side; choose a smaller --size",
      columns * format.width_px, rows * format.height_px, kMostSheetSide_px);
}

/// Scenes with letters in one view each, and the timeline below them.
show::PictureResult DrawSheet(const ParsedOptions& options, const scenario::Scenario& scenario,
                              const episode::RunResult& run) {
  const show::PictureFormat picture = FormatOf(options);
  show::TileRow row{.columns = options.IntOr("--sheet", 1),
                    .height_share = static_cast<double>(picture.height_px) / picture.width_px};
  const int tile_px = options.Has("--size") ? picture.width_px / 2 : kSheetTile_px;
  show::SceneFormat format = SceneFormatOf(options, "action", row.columns * tile_px);
  format.picture = picture;
  std::vector<show::KeyMoment> moments;
  show::PictureResult result;
  for (const scenario::PictureYaml& entry : scenario.pictures) {
    const episode::FoundTime found = episode::FindEventTime(entry.at.value, run);
    const auto at = episode::ParseEventTime(entry.at.value);
    moments.push_back({.time_s = show::SecondsOf(run, found.tick),
                       .caption = at && at->time_s ? "" : entry.at.value,
                       .camera = entry.camera.value});
    result.pictures.push_back(
        {.file = options.Text("--output"),
         .caption = fmt::format("{}  ·  {:.3f} s", entry.at.value, moments.back().time_s),
         .missed = found.missed});
  }
  show::Chart chart = show::PhasesChart(scenario, run, WindowOf(options, run));
  if (!picture.title) chart.title.clear();
  show::ScenePainter painter;
  show::Sheet sheet =
      show::WithScenes(std::move(chart), scenario, run, moments, format, painter, std::move(row));
  if (!picture.strip) sheet.chart.reset();
  result.error = painter.error();
  if (result.error.empty())
    result.error = show::WriteDrawing(options.Text("--output"), SheetSvg(sheet, format.chart),
                                      PixelsOf(options));
  return result;
}

/// Below the project's build folder, or, for who is somewhere else, below one there.
fs::path PicturesFolder(const std::string& root, const scenario::Scenario& scenario) {
  const fs::path folder = fs::path(IsCalledIn(root) ? BuildFolder(root) : "build") / "pictures";
  return scenario.skill.empty() ? folder : folder / scenario.skill;
}

show::PictureResult Draw(const ParsedOptions& options, const episode::LoadedRun& loaded,
                         const episode::RunResult& run, const std::string& root) {
  const std::string output = options.Text("--output");
  const show::PictureFormat format = FormatOf(options);
  if (options.Has("--sheet")) return DrawSheet(options, loaded.scenario, run);
  if (!output.empty())
    return show::DrawPicture(loaded.scenario, run, loaded.scenario.pictures.front(), output,
                             format);
  const fs::path folder = PicturesFolder(root, loaded.scenario);
  std::error_code error;
  fs::create_directories(folder, error);
  return show::DrawPictures(loaded.scenario, run, folder.string(), format);
}

/// What is made instead of pictures, and which options it has no use for.
struct Product {
  const char* option;
  std::vector<const char*> unused;
};
const Product kProducts[] = {{"--strip", {"--at", "--sheet", "--json", "--size", "--camera"}},
                             {"--against", {"--at", "--sheet", "--json", "--size", "--without"}},
                             {"--film", {"--at", "--sheet", "--json", "--output"}}};

/// Lines and texts, scenes as pictures in it: a file of any kind, of any width.
bool IsDrawing(const ParsedOptions& options) {
  return options.Has("--strip") || options.Has("--against") || options.Has("--sheet");
}

/// Why these options do not go together, or "".
std::string WhyNotTogether(const ParsedOptions& options) {
  const char* asked = nullptr;
  for (const Product& product : kProducts) {
    if (!options.Has(product.option)) continue;
    if (asked) return fmt::format("{} and {} exclude each other", asked, product.option);
    asked = product.option;
    for (const char* option : product.unused) {
      if (options.Has(option)) return fmt::format("{} does not go with {}", option, asked);
    }
  }
  for (const std::string& look : SplitAt(options.Text("--look"), ',')) {
    if (options.Has("--strip") && !look.empty() && look != "transparent")
      return fmt::format("--look {} does not go with --strip", look);
  }
  if (options.Has("--width") && !IsDrawing(options))
    return "--width is for --strip, --sheet and --against; a picture has a --size";
  for (const char* of_film : {"--fps", "--speed"}) {
    if (options.Has(of_film) && !options.Has("--film"))
      return fmt::format("{} is for --film", of_film);
  }
  return "";
}

/// The run of a scenario or of an episode, with every frame. `listen` is asked into `heard`.
tl::expected<suite::PlayedRun, ExitCode> Play(const ParsedOptions& options,
                                              const CommandContext& context,
                                              const suite::Listen& listen = {},
                                              std::optional<suite::Heard>* heard = nullptr) {
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  if (listen) {
    Result<suite::Heard> said = listen(episode);
    if (!said) return tl::unexpected(Complain(context, said.error()));
    context.err << said->notes;
    *heard = std::move(*said);
  }
  auto played = PlayOrComplain(std::move(episode), context);
  if (!played) return played;
  const std::string why = WhyNotShown(options, played->loaded.scenario, played->run);
  if (!why.empty()) return tl::unexpected(Refuse(context, why));
  return played;
}

/// Writes it where the command line says, or below build/pictures.
ExitCode WriteOut(const std::string& svg, const ParsedOptions& options,
                  const scenario::Scenario& scenario, const std::string& ending,
                  const CommandContext& context) {
  const fs::path file = options.TextOr(
      "--output", (PicturesFolder(context.root, scenario) / (scenario.name + ending)).string());
  const std::string problem = show::WriteDrawing(file, svg, PixelsOf(options));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << file.string() << "\n";
  return ExitCode::kAgrees;
}

ExitCode RenderStrip(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto played, Play(options, context));
  const episode::LoadedRun& loaded = played.loaded;
  const episode::RunResult& run = played.run;
  show::Chart chart = show::PhasesChart(loaded.scenario, run, WindowOf(options, run));
  for (const std::string& words : options.All("--without")) {
    if (std::ranges::count(SplitAt(words, ','), "title") > 0) chart.title.clear();
  }
  return WriteOut(show::ChartSvg(chart, SceneFormatOf(options, "", kComparisonWidth_px).chart),
                  options, loaded.scenario, ".strip.svg", context);
}

ExitCode RenderComparison(const ParsedOptions& options, const CommandContext& context) {
  const std::string view = options.Text("--against");
  // Other words are those of grammars.
  const bool is_command =
      view.starts_with("files:") ||
      (view.find_first_of(" /") != std::string::npos && !view.ends_with(".grammar"));
  std::optional<suite::Heard> heard;
  PREHEND_TRY(const auto played,
              Play(options, context, is_command ? ListenTo(view) : suite::Listen(), &heard));
  const show::SceneFormat format = SceneFormatOf(options, "action", kComparisonWidth_px);
  const auto made = suite::SheetAgainst(played, view, WindowOf(options, played.run), format,
                                        context.root, heard ? &*heard : nullptr);
  if (!made) return Complain(context, made.error());
  return WriteOut(SheetSvg(made->sheet, format.chart), options, played.loaded.scenario,
                  ".against-" + made->name + ".png", context);
}

ExitCode RenderFilm(const ParsedOptions& options, const CommandContext& context) {
  const std::string path = options.Text("--film");
  if (const std::string why = show::WhyNoFilm(path); !why.empty())
    return Refuse(context, "--film: " + why);
  PREHEND_TRY(const auto played, Play(options, context));
  const episode::LoadedRun& loaded = played.loaded;
  const episode::RunResult& run = played.run;
  const show::Window window = WindowOf(options, run);
  const show::FilmFormat film{.from_s = window.from_s,
                              .to_s = window.to_s,
                              .frames_per_s = options.NumberOr("--fps", 30),
                              .speed = options.NumberOr("--speed", 1)};
  if (const std::string why = show::WhyTooLong(film); !why.empty())
    return Refuse(context, "--film: " + why);
  show::PictureFormat format = FormatOf(options);
  if (!options.Has("--size")) format.width_px = 960, format.height_px = 540;
  format.ghosts = false;
  const std::string why = show::DrawFilm(loaded.scenario, run, options.TextOr("--camera", "action"),
                                         film, format, path);
  if (!why.empty()) return Complain(context, ExitCode::kFailure, "no film: " + why);
  context.out << path << "\n";
  return ExitCode::kAgrees;
}

ExitCode RenderPictures(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  episode::LoadedRun* loaded = &episode.loaded();
  const show::PictureChoice choice = ChoiceOf(options);
  std::vector<scenario::PictureYaml> asked;
  if (options.Has("--at") || options.Has("--camera") || options.Has("--output"))
    asked = show::ChosenPictures(choice, loaded->scenario);
  for (const std::string& why :
       {show::WhyNotChosen(choice, asked, loaded->scenario, *loaded->program),
        WhyNoPart(FormatOf(options), loaded->scenario), WhyNoSheet(options, asked.size())}) {
    if (!why.empty()) return Refuse(context, why);
  }
  if (!asked.empty()) loaded->scenario.pictures = std::move(asked);
  if (loaded->scenario.pictures.empty()) {
    return Complain(context, ExitCode::kNothing,
                    "the scenario defines no pictures; --at asks for one");
  }

  const Result<episode::RunResult> played = episode.Run(true);
  if (!played) return Complain(context, played.error());
  const episode::RunResult& run = *played;
  const show::PictureResult drawn = Draw(options, *loaded, run, context.root);
  for (const show::WrittenPicture& picture : drawn.pictures) {
    if (!picture.missed.empty())
      context.err << "prehend: warning: " << picture.file << ": " << picture.missed
                  << "; the picture shows the end of the run\n";
  }
  if (options.Has("--json")) {
    episode::OrderedJson json = episode::RunJson(episode::HeadingOf(loaded->scenario, run), run);
    json["pictures"] = episode::OrderedJson::array();
    for (const show::WrittenPicture& picture : drawn.pictures) {
      json["pictures"].push_back({{"file", picture.file}, {"caption", picture.caption}});
    }
    context.out << json.dump(2) << "\n";
  } else {
    std::string last;  // the pictures of a sheet have one file
    for (const show::WrittenPicture& picture : drawn.pictures) {
      if (picture.file != last) context.out << picture.file << "\n";
      last = picture.file;
    }
  }
  if (!drawn.error.empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + drawn.error);
  if (run.status.kind == physics::RunStatus::Kind::kCompleted) return ExitCode::kAgrees;
  return Complain(context, ExitCode::kFailure, episode::StatusText(run));
}

/// Why there can be no such file, or "".
std::string WhyNoOutput(const ParsedOptions& options) {
  if (!options.Has("--output")) return "";
  const std::string output = options.Text("--output");
  std::string why;
  if (output == "-")
    why = "found '-', wanted a file; pictures are not printed";
  else if (IsDrawing(options))
    why = show::WhyNoDrawingFile(output);
  else if (output.ends_with(".svg") || output.ends_with(".pdf"))
    why = fmt::format(
        "found '{}', wanted a file NAME.png; scenes are drawn in pixels, --strip is the timeline "
        "alone",
        output);
  if (why.empty()) why = AtomicFile(output).problem();
  // A picture is a PNG, whatever its file is called.
  if (why.empty() && !IsDrawing(options) && !output.ends_with(".png"))
    why = fmt::format("found '{}', wanted a file NAME.png", output);
  return why.empty() ? "" : "--output: " + why;
}

ExitCode RunRender(const ParsedOptions& options, const CommandContext& context) {
  for (const std::string& why : {WhyNotTogether(options), WhyNoOutput(options)})
    if (!why.empty()) return Refuse(context, why);
  if (options.Has("--strip")) return RenderStrip(options, context);
  if (options.Has("--against")) return RenderComparison(options, context);
  if (options.Has("--film")) return RenderFilm(options, context);
  return RenderPictures(options, context);
}

std::vector<Option> OptionsInsteadOfPictures() {
  return InGroup(
      "Instead of pictures",
      {Flag("--strip", "the timeline alone"),
       Value("--against", "golden|pictures|GRAMMAR|ENGINE|CMD",
             "compare with the golden, another grammar, the other engine (bullet, box2d), a "
             "recogniser (docs/recognisers.md): both timelines, and the scenes at each boundary "
             "that differs. 'pictures': golden pictures, those of now, and what differs"),
       WritesFile(Value("--film", "FILE|FOLDER",
                        "a film: NAME.webp (img2webp), NAME.mp4 (ffmpeg), or a folder of frames; "
                        "960x540 unless --size says otherwise")),
       Value("--fps", "N", "frames in a second of the film; default: 30", NumbersFrom(1, 120)),
       Value("--speed", "N", "seconds of the episode in a second of the film; default: 1",
             NumbersFrom(0.01, 100))});
}

}  // namespace

Command RenderCommand() {
  return {
      .name = "render",
      .summary = "Draw a scenario's pictures, one of your own, a comparison, a film",
      .examples =
          {"render milk_carton_wrap", "render milk_carton_wrap -o milk.png",
           "render suite.episodes --episode slide/hop_divides_a_slide -o hop.png",
           "render milk_carton_wrap --at transporting.begin --camera left -o left.png",
           "render milk_carton_wrap --at reaching.begin,putting_down.end --sheet 2 -o sheet.png",
           "render milk_carton_wrap --strip -o strip.pdf",
           "render milk_carton_wrap --against original_2020 -o two_grammars.png",
           "render milk_carton_wrap --film milk.webp --speed 0.5"},
      .options = Joined(
          Joined({EpisodeArgument(), EpisodeOption(),
                  OutputOption("the PNG file; default: build/pictures/SKILL/NAME.png. --strip, "
                               "--sheet and --against also write .svg and .pdf"),
                  Value("--at", "TIME",
                        "when: EVENT.begin, EVENT.end, or seconds; for a sheet several, with "
                        "commas between them"),
                  Value("--sheet", "N",
                        "all pictures in one file, with so many columns, above one timeline",
                        IntegersFrom(1, kMostColumns))},
                 OptionsInsteadOfPictures()),
          Joined(Joined(LookOptions(), PartOptions()),
                 {WidthOption(),
                  Value("--size", "WxH", "pixels of a picture; default: 1280x720", Sizes()),
                  Repeatable(Value("--without", "PART,..", "leave these out", SomeOf(PartNames()))),
                  GrammarOption(), SettingsOption(),
                  Flag("--json",
                       "print the run as one JSON object, with the files of its pictures")})),
      .run = RunRender};
}

}  // namespace prehend::cli
