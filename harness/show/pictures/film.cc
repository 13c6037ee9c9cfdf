// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "harness/base/base/atomic_file.h"
#include "harness/base/process/child_process.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::show {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestEncoding_s = 900;

fs::path FrameFile(const fs::path& folder, std::size_t number) {
  return folder / fmt::format("frame_{:05}.png", number);
}

/// Returns "", or what went wrong.
std::string DrawFrames(const scenario::Scenario& scenario, const episode::RunResult& run,
                       const std::string& camera, const FilmFormat& film, PictureFormat format,
                       const fs::path& folder) {
  format.path_so_far = true;
  ScenePainter painter;
  const std::vector<double> times_s = FrameTimes(film);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    scenario::PictureYaml entry;
    entry.at.value = fmt::format("{:.6f}", times_s[i]);
    entry.camera.value = camera;
    const DrawnScene scene = painter.Draw(scenario, run, entry, format);
    if (scene.png.empty()) return painter.error();
    const std::string why = WriteTextFile(FrameFile(folder, i + 1), scene.png);
    if (!why.empty()) return why;
  }
  return "";
}

/// What makes a file with this ending.
struct Encoder {
  const char* ending;
  const char* tool;
  const char* package;  ///< of Debian
};
constexpr Encoder kEncoders[] = {{".webp", "img2webp", "webp"}, {".mp4", "ffmpeg", "ffmpeg"}};

/// "", or why there is no such tool here.
std::string WhyNoTool(const Encoder& encoder) {
  const ToolResult said = RunTool({encoder.tool, "-version"}, "", {.time_s = 10});
  if (said.problem.empty()) return "";
  return fmt::format(
      "{}; Debian's package {} has it, and a name without ending is a folder of "
      "frames, which needs no other program",
      said.problem, encoder.package);
}

/// The frames of a folder as one file of the encoder's; "", or what went wrong.
std::string Encode(const fs::path& folder, std::size_t frames, double frames_per_s,
                   const fs::path& file) {
  std::vector<std::string> words;
  if (file.extension() == ".webp") {
    words = {"img2webp", "-loop", "0", "-lossy", "-q", "80", "-m", "2"};
    double shown_ms = 0;
    for (std::size_t i = 1; i <= frames; ++i) {
      // Durations are whole milliseconds; together they take as long as they should.
      const double until_ms = std::round(1000 * static_cast<double>(i) / frames_per_s);
      words.insert(words.end(), {"-d", fmt::format("{:.0f}", until_ms - shown_ms)});
      words.push_back(FrameFile(folder, i).string());
      shown_ms = until_ms;
    }
    words.insert(words.end(), {"-o", file.string()});
  } else {
    words = {"ffmpeg", "-loglevel", "error", "-nostdin", "-y", "-framerate",
             fmt::format("{:g}", frames_per_s), "-i", (folder / "frame_%05d.png").string(),
             // H.264 wants even sides.
             "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-movflags",
             "+faststart", file.string()};
  }
  const ToolResult encoded = RunTool(words, "", {.time_s = kLongestEncoding_s});
  if (encoded.Succeeded()) return "";
  return encoded.problem.empty() ? words.front() + ": " + encoded.err : encoded.problem;
}

}  // namespace

std::vector<double> FrameTimes(const FilmFormat& film) {
  const double step_s = film.speed / film.frames_per_s;
  const auto count =
      static_cast<std::size_t>(std::floor((film.to_s - film.from_s) / step_s + 1e-9)) + 1;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < count; ++i)
    times_s.push_back(film.from_s + static_cast<double>(i) * step_s);
  return times_s;
}

std::string WhyTooLong(const FilmFormat& film) {
  const double frames = std::floor((film.to_s - film.from_s) * film.frames_per_s / film.speed) + 1;
  if (frames <= static_cast<double>(kMostFrames)) return "";
  return fmt::format(
      "found {:.0f} frames, wanted at most {}; choose a part with --from and --to, a lower --fps "
      "or a higher --speed",
      frames, kMostFrames);
}

std::string WhyNoFilm(const std::string& path) {
  const fs::path ending = fs::path(path).extension();
  if (ending == ".webp" || ending == ".mp4") return WhyNotWritable(path);
  if (!ending.empty())
    return fmt::format("found '{}', wanted NAME.webp, NAME.mp4, or a folder for the frames", path);
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    return path + " is a file, wanted a folder for the frames";
  if (fs::is_directory(path, error) && !fs::is_empty(path, error))
    return path + " is not empty, wanted a new folder for the frames";
  return WhyNotWritable(fs::path(path) / "frame");
}

std::string DrawFilm(const scenario::Scenario& scenario, const episode::RunResult& run,
                     const std::string& camera, const FilmFormat& film, const PictureFormat& format,
                     const std::string& path) {
  if (!fs::path(path).has_extension()) return DrawFrames(scenario, run, camera, film, format, path);
  // Before the frames are drawn, which takes long.
  const auto encoder =
      std::ranges::find(kEncoders, fs::path(path).extension().string(),
                        [](const Encoder& one) { return std::string(one.ending); });
  std::string why = WhyNoTool(*encoder);
  if (!why.empty()) return why;
  const TemporaryFolder frames;
  if (!frames.problem().empty()) return frames.problem();
  why = DrawFrames(scenario, run, camera, film, format, frames.path());
  if (!why.empty()) return why;
  const fs::path encoded = frames.path() / ("film" + fs::path(path).extension().string());
  why = Encode(frames.path(), FrameTimes(film).size(), film.frames_per_s, encoded);
  if (!why.empty()) return why;
  std::ifstream bytes(encoded, std::ios::binary);
  return WriteTextFile(path, std::string{std::istreambuf_iterator<char>(bytes), {}});
}

// See harness/show/pictures/pictures.h. Tested by tests/program/render_test.cc

std::vector<scenario::PictureYaml> ChosenPictures(const PictureChoice& choice,
                                                  const scenario::Scenario& scenario) {
  const std::vector<scenario::PictureYaml>& own = scenario.pictures;
  scenario::PictureYaml entry = own.empty() ? scenario::PictureYaml{.at = {"0", {}}} : own.front();
  if (!choice.camera.empty()) entry.camera.value = choice.camera;
  if (choice.at.empty()) return choice.all && !own.empty() ? own : std::vector{entry};
  std::vector<scenario::PictureYaml> chosen;
  for (const std::string& at : choice.at) {
    chosen.push_back(entry);
    chosen.back().at.value = at;
  }
  return chosen;
}

std::string WhyNotChosen(const PictureChoice& choice,
                         const std::vector<scenario::PictureYaml>& chosen,
                         const scenario::Scenario& scenario, const grammar::Program& program) {
  for (const scenario::PictureYaml& entry : chosen) {
    const auto problem = episode::WhyNoEventTime(entry.at.value, program);
    if (problem && !choice.at.empty()) return "--at: " + problem->message + "; " + problem->hint;
    if (const auto why = scenario::WhyNoCamera(scenario, entry.camera.value)) return "--" + *why;
  }
  return "";
}

std::string WhyNoDrawingFile(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".svg" || ending == ".png" || ending == ".pdf"
             ? ""
             : "found '" + path + "', wanted a file NAME.svg, NAME.png or NAME.pdf";
}

std::string WriteDrawing(const std::filesystem::path& path, const std::string& svg, double pixels) {
  if (path.extension() == ".svg") return WriteTextFile(path, svg);
  const bool is_pdf = path.extension() == ".pdf";
  const ToolResult drawn =
      RunTool({"rsvg-convert", is_pdf ? "--format=pdf" : "--format=png",
               fmt::format("--zoom={}", is_pdf ? 1 : pixels), "--background-color=white"},
              svg);
  if (drawn.Succeeded()) return WriteTextFile(path, drawn.out);
  std::string why = drawn.problem.empty() ? "rsvg-convert: " + drawn.err : drawn.problem;
  if (why.ends_with("is not installed")) why += "; Debian's package librsvg2-bin has it";
  return path.string() + ": " + why + "; a file NAME.svg needs no other program";
}

}  // namespace prehend::show
