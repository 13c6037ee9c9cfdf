// SPDX-License-Identifier: Apache-2.0
// Pictures of a recorded run: what the scenario asks for, composed from the recording and its
// timeline; scenes as PNGs in memory, for sheets, comparisons and films that are put together of
// several. Built with the render room (harness/show/pictures/pictures_with_render.cc) or without it
// (harness/show/pictures/pictures_without_render.cc). Tested by tests/program/acceptance_test.cc
// and tests/harness/show/pictures/scene_painter_test.cc
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {

/// What tells a picture from its golden.
struct PictureDifference {
  std::vector<std::string> told;  ///< "thing `cup` is missing, ..", most telling first; empty: same
  bool same_size = false;         ///< both could be read and have the same size
};

struct WrittenPicture {
  std::string file;     ///< path as written
  std::string caption;  ///< "reaching.begin, 0.412 s"
  std::string missed;   ///< empty, or why the end is shown instead of the moment that was asked for
  std::string golden = "";            ///< path of the golden that it was compared with; empty: none
  PictureDifference difference = {};  ///< from it
};

/// How pictures are drawn, whatever they show.
struct PictureFormat {
  int width_px = 1280, height_px = 720;
  double text_scale = 1;
  bool print = false;                  ///< on white paper
  bool transparent = false;            ///< without paper
  std::optional<double> from_s, to_s;  ///< the strip, paths and ghosts of this part of the episode
  std::string only;                    ///< this hand's paths, ghosts and rows; empty: all
  std::string of;  ///< the path of this entity, and events with it in a role; empty: all events
  std::vector<std::string> marked;  ///< things that get a bubble around them
  std::vector<std::string> framed;  ///< the camera shows these things, too, wherever they are
  /// What happens between these times. Empty: in the whole episode, with the camera `hand` nothing.
  std::optional<double> framed_from_s, framed_to_s;
  /// 0xRRGGBB of the parts of hands with sensors of the set of this name; others look like skin.
  std::map<std::string, std::uint32_t> sensor_colors = {};
  bool path_so_far = false;  ///< paths end at the moment, as in a film
  /// Since then, what a hand did before its phase of the moment is pale green: a track that was
  /// kept until that phase was recognised.
  std::optional<double> kept_from_s = {};
  bool regions = false;  ///< of interest of the phases at the moment, and candidates
  bool title = true, labels = true, strip = true, ghosts = true, paths = true, gaze = true;
};

struct PictureResult {
  std::vector<WrittenPicture> pictures;
  std::string error;  ///< empty, or why (some) pictures could not be drawn
};

/// When the first of a row's bars begins or ends between these times, but not at once; infinity:
/// nothing changes.
template <typename Bars>
double FirstChange_s(const Bars& bars, double from_s, double to_s) {
  constexpr double kAtOnce_s = 0.1;
  double first_s = std::numeric_limits<double>::infinity();
  for (const auto& bar : bars)
    for (const double at_s : {bar.begin_s, bar.end_s})
      if (at_s > from_s + kAtOnce_s && at_s < to_s - kAtOnce_s) first_s = std::min(first_s, at_s);
  return first_s;
}

/// Whether this build can draw at all.
bool CanDrawPictures();

/// Loads what drawing needs. To be called before processes are forked that draw.
void PrepareToDraw();

/// Draws the scenario's pictures from a run made with RunOptions::record, as
/// DIRECTORY/NAME[-2..].png. The directory must exist.
PictureResult DrawPictures(const scenario::Scenario& scenario, const episode::RunResult& run,
                           const std::string& directory, const PictureFormat& format = {});

/// The format of the suite's pictures, and so of golden ones: a smaller one shows a boundary that
/// is off by 20 ms in too few pixels.
inline const PictureFormat kGoldenFormat = {.width_px = 960, .height_px = 540};

/// What a picture shows, thing by thing, is kept beside it: NAME.png, NAME.things.
inline std::string ThingsFile(const std::string& picture_file) {
  return std::filesystem::path(picture_file).replace_extension(".things").string();
}

/// The golden of a picture with this file name, or "" if there is none.
using GoldenOf = std::function<std::string(const std::string& file_name)>;

/// DrawPictures() in the golden format; each picture that has a golden is compared with it.
PictureResult DrawAndCompare(const scenario::Scenario& scenario, const episode::RunResult& run,
                             const std::string& directory, const GoldenOf& golden_of);

/// DrawPictures() in the golden format, with a THINGS file beside each: what a golden consists of.
PictureResult DrawGoldens(const scenario::Scenario& scenario, const episode::RunResult& run,
                          const std::string& directory);

/// One picture into one file.
PictureResult DrawPicture(const scenario::Scenario& scenario, const episode::RunResult& run,
                          const scenario::PictureYaml& entry, const std::string& file,
                          const PictureFormat& format = {});

/// Writes the golden in pale grey with every pixel that differs in red; both must have one size.
/// False when it cannot.
bool WritePictureDifference(const std::string& golden_file, const std::string& drawn_file,
                            const std::string& file);

struct PictureChoice {
  std::vector<std::string> at;  ///< a picture each: "grasping.begin", "1.5"; none: the scenario's
  std::string camera;           ///< "": as the scenario's first picture says
  bool all = false;             ///< without `at` all pictures of the scenario, not the first one
};

std::vector<scenario::PictureYaml> ChosenPictures(const PictureChoice& choice,
                                                  const scenario::Scenario& scenario);

/// Why they cannot be drawn of an episode with this grammar: "--at: ..", "--camera: .."; or "".
std::string WhyNotChosen(const PictureChoice& choice,
                         const std::vector<scenario::PictureYaml>& chosen,
                         const scenario::Scenario& scenario, const grammar::Program& program);

/// A scene at one moment of a run.
struct DrawnScene {
  std::string png;  ///< the bytes of a PNG file; empty: it could not be drawn
  double time_s = 0;
  std::string missed;  ///< empty, or why the end is shown instead of the moment that was asked for
};

/// Draws scenes one after another. The first one costs more: the shaders are compiled.
class ScenePainter {
 public:
  ScenePainter();
  ~ScenePainter();

  /// Why nothing can be drawn, or "".
  const std::string& error() const;

  /// Of a run with a recording. On failure error() has the reason.
  DrawnScene Draw(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const scenario::PictureYaml& entry, const PictureFormat& format);

  /// The camera of such a scene as text (harness/scenario/scenario/scenario.h), for other scenes
  /// in the same view.
  static std::string CameraOf(const scenario::Scenario& scenario, const episode::RunResult& run,
                              const scenario::PictureYaml& entry, const PictureFormat& format);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Two pictures of one size on top of each other.
struct SceneDifference {
  std::string png;   ///< the first one, pale, and what differs in red; empty: not of one size
  double share = 0;  ///< of the pixels that differ
};
SceneDifference DifferenceOf(const std::string& first_png, const std::string& second_png);

// A drawing as a file: SVG as it is, PNG and PDF by rsvg-convert. Tested by
// tests/harness/show/pictures/svg_file_test.cc

/// Empty, or why no drawing can have this name: "found 'a.gif', wanted a file NAME.svg, ..".
std::string WhyNoDrawingFile(const std::string& path);

/// Writes a drawing as what the file's ending says. Returns "", or what went wrong; then an older
/// file is as it was. PNG has so many pixels for each of the drawing's.
std::string WriteDrawing(const std::filesystem::path& path, const std::string& svg,
                         double pixels = 2);

// An episode as a film: a folder of frames, an animated WebP (by libwebp's img2webp), or what
// ffmpeg makes of them. Tested by tests/harness/show/pictures/film_test.cc and
// tests/program/render_test.cc

/// More are refused: a frame takes a tenth of a second and more.
inline constexpr std::size_t kMostFrames = 3000;

struct FilmFormat {
  double from_s = 0, to_s = 1;  ///< of the episode
  double frames_per_s = 30;     ///< of the film
  double speed = 1;             ///< seconds of the episode in a second of the film
};

/// At which times of the episode frames are; at least one.
std::vector<double> FrameTimes(const FilmFormat& film);

/// Why these make no film, or "": "found 5000 frames, wanted at most 3000; ..".
std::string WhyTooLong(const FilmFormat& film);

/// Why there can be no film of this name, or "". A name without ending is a folder, which must be
/// new or empty.
std::string WhyNoFilm(const std::string& path);

/// Draws the film from `camera`. Returns "", or why there is none; then an older file is as it was.
std::string DrawFilm(const scenario::Scenario& scenario, const episode::RunResult& run,
                     const std::string& camera, const FilmFormat& film, const PictureFormat& format,
                     const std::string& path);

}  // namespace prehend::show
