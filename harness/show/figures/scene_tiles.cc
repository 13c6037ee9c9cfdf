// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/scene_tiles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>

#include "harness/base/base/quoting.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {
namespace {

constexpr int kMostColumns = 5, kGraspColumns = 4;
constexpr double kScenePixels = 2.5;  ///< of a scene for each pixel of the drawing
constexpr double kTextScale = 2;      ///< of labels, as scenes are shown small

/// Okabe and Ito's palette ("Color Universal Design", 2008), for sets of sensors.
constexpr std::array<std::uint32_t, 7> kSetColors = {0x56B4E9, 0xE69F00, 0x009E73, 0xCC79A7,
                                                     0xF0E442, 0xD55E00, 0x0072B2};

/// So that a short caption has room below each.
int ColumnsFor(std::size_t tiles, int most, const ChartFormat& format) {
  constexpr double kCaption = 12;  // heights of the text
  const int count = std::max(1, static_cast<int>(tiles));
  most = std::clamp(static_cast<int>(format.width_px / (kCaption * format.text_px)), 1, most);
  const int rows = (count + most - 1) / most;
  return (count + rows - 1) / rows;
}

/// Hands and small things; a text for each would hide what is small.
SceneFormat Bare(SceneFormat format) {
  format.picture.ghosts = format.picture.paths = format.picture.labels = false;
  return format;
}

constexpr double kMargin_px = 10, kGap_px = 8;

class SheetDrawing {
 public:
  SheetDrawing(const Sheet& sheet, const ChartFormat& format) : sheet_(sheet), format_(format) {}

  std::string Run() {
    // The size is known at the end only: everything is drawn into a group first.
    pugi::xml_document parts;
    svg_ = AddElement(parts, "g");
    y_ = kMargin_px;
    if (!sheet_.title.empty()) Line(sheet_.title, "bold");
    if (sheet_.chart_first) DrawChart();
    for (const TileRow& row : sheet_.rows) DrawTiles(row);
    if (!sheet_.chart_first) DrawChart();
    if (!sheet_.note.empty()) Line(sheet_.note, "normal");
    DrawLegend();
    pugi::xml_document document;
    AddDrawing(document, format_, y_ + kMargin_px).append_copy(svg_);
    return ToText(document, Layout::kIndented);
  }

 private:
  void Text(double x, double y, const std::string& text, const char* weight) {
    AddElement(svg_, "text",
               {{"x", SvgNumber(x)}, {"y", SvgNumber(y)}, {"font-weight", weight}, {"fill", kInk}},
               text);
  }
  void Line(const std::string& text, const char* weight) {
    const double line_px = 1.3 * format_.text_px;
    y_ += line_px * DrawLines(text, weight, kMargin_px, y_ - 0.2 * format_.text_px,
                              format_.width_px - 2 * kMargin_px, line_px) +
          0.5 * format_.text_px;
  }

  void DrawChart() {
    if (sheet_.chart) y_ += AddChart(svg_, *sheet_.chart, format_, y_);
  }

  void DrawTiles(const TileRow& row) {
    if (!row.heading.empty()) {
      y_ += 0.5 * format_.text_px;
      Line(row.heading, "bold");
    }
    const double width = TileWidth(format_, row.columns), height = row.height_share * width,
                 line_px = 1.3 * format_.text_px;
    for (std::size_t first = 0; first < row.tiles.size();
         first += static_cast<std::size_t>(row.columns)) {
      const std::size_t end =
          std::min(row.tiles.size(), first + static_cast<std::size_t>(row.columns));
      double lines = 1;
      for (std::size_t i = first; i < end; ++i) {
        const Tile& tile = row.tiles[i];
        const double x = kMargin_px + static_cast<double>(i - first) * (width + kGap_px);
        AddElement(svg_, "image",
                   {{"x", SvgNumber(x)},
                    {"y", SvgNumber(y_)},
                    {"width", SvgNumber(width)},
                    {"height", SvgNumber(height)},
                    {"xlink:href", "data:image/png;base64," + Base64(tile.png)}});
        lines = std::max(lines, DrawLines(tile.caption, "normal", x, y_ + height, width, line_px));
      }
      y_ += height + lines * line_px + 0.9 * format_.text_px;
    }
  }

  /// Broken where it says and where it would be too wide. Returns the number of lines.
  double DrawLines(const std::string& text, const char* weight, double x, double top, double width,
                   double line_px) {
    double lines = 0;
    for (const std::string& line : BrokenLines(
             text, static_cast<std::size_t>(std::max(8.0, width / (0.62 * format_.text_px)))))
      Text(x, top + ++lines * line_px, line, weight);
    return lines;
  }

  void DrawLegend() {
    if (sheet_.legend.empty()) return;
    double x = kMargin_px;
    for (const auto& [name, color] : sheet_.legend) {
      const double width =
          2.6 * format_.text_px + 0.62 * format_.text_px * static_cast<double>(name.size());
      if (x > kMargin_px && x + width > format_.width_px - kMargin_px) {
        x = kMargin_px;
        y_ += 1.6 * format_.text_px;
      }
      AddElement(svg_, "rect",
                 {{"x", SvgNumber(x)},
                  {"y", SvgNumber(y_ + 0.2 * format_.text_px)},
                  {"width", SvgNumber(format_.text_px)},
                  {"height", SvgNumber(format_.text_px)},
                  {"fill", fmt::format("#{:06X}", color)}});
      Text(x + 1.4 * format_.text_px, y_ + 1.1 * format_.text_px, name, "normal");
      x += width;
    }
    y_ += 1.6 * format_.text_px;
  }

  const Sheet& sheet_;
  const ChartFormat& format_;
  double y_ = 0;
  pugi::xml_node svg_;
};

/// The styles in which the scenario's hands reach.
std::vector<std::string> StylesOf(const scenario::Scenario& scenario) {
  std::vector<std::string> styles;
  for (const physics::ScriptStage& stage : scenario.script.stages) {
    for (const physics::Step& step : stage.steps)
      if (const auto* reach = std::get_if<physics::ReachStep>(&step.action))
        styles.push_back(reach->style);
  }
  return styles;
}

}  // namespace

std::string AddScene(const scenario::Scenario& scenario, const episode::RunResult& run,
                     double time_s, const std::string& caption, const SceneFormat& format,
                     ScenePainter& painter, TileRow& row) {
  PictureFormat picture = format.picture;
  const double width_px = kScenePixels * TileWidth(format.chart, row.columns);
  picture.width_px = static_cast<int>(width_px);
  picture.height_px = static_cast<int>(row.height_share * width_px);
  picture.title = picture.strip = false;
  picture.text_scale *= kTextScale;
  scenario::PictureYaml entry;
  entry.at.value = fmt::format("{:.6f}", time_s);
  entry.camera.value = format.camera;
  const DrawnScene drawn = painter.Draw(scenario, run, entry, picture);
  row.tiles.push_back({.png = drawn.png, .caption = caption});
  return drawn.png;
}

std::string WideView(const scenario::Scenario& scenario, const episode::RunResult& run,
                     double time_s, const SceneFormat& format) {
  constexpr double kNearer = 0.75;
  PictureFormat picture = format.picture;
  picture.width_px = 1000;
  picture.height_px = static_cast<int>(1000 * kWideScene);
  picture.strip = false;
  scenario::PictureYaml entry;
  entry.at.value = fmt::format("{:.6f}", time_s);
  entry.camera.value = format.camera;
  const std::string camera = ScenePainter::CameraOf(scenario, run, entry, picture);
  const auto view = scenario::ParseOwnCamera(camera);
  if (!view || format.camera != "action") return camera;
  return fmt::format("{}:{:.3f}", camera.substr(0, camera.rfind(':')), kNearer * view->view_deg);
}

void AddKeyFrames(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const std::vector<KeyMoment>& moments, const SceneFormat& format,
                  ScenePainter& painter, TileRow& row) {
  SceneFormat bare = Bare(format);
  bare.picture.regions = bare.picture.paths = bare.picture.path_so_far = true;
  for (const KeyMoment& moment : moments) {
    bare.picture.framed = moment.involved;
    bare.picture.from_s = bare.picture.framed_from_s = moment.time_s - moment.track_s;
    bare.picture.to_s = bare.picture.framed_to_s = moment.time_s;
    bare.picture.kept_from_s = moment.keeps_track ? bare.picture.from_s : std::optional<double>();
    const std::string caption =
        fmt::format("({}) {}\n{:.2f} s", LetterOf(row.tiles.size()), moment.caption, moment.time_s);
    AddScene(scenario, run, moment.time_s, caption, bare, painter, row);
  }
}

Sheet KeyFrameSheet(const scenario::Scenario& scenario, const episode::RunResult& run,
                    const std::vector<KeyMoment>& moments, const SceneFormat& format,
                    ScenePainter& painter) {
  TileRow row{.columns = ColumnsFor(moments.size(), kMostColumns, format.chart)};
  AddKeyFrames(scenario, run, moments, format, painter, row);
  return {.title = scenario.name + ", " + scenario.grammar, .rows = {std::move(row)}};
}

Sheet WithScenes(Chart chart, const scenario::Scenario& scenario, const episode::RunResult& run,
                 const std::vector<KeyMoment>& moments, const SceneFormat& format,
                 ScenePainter& painter, TileRow row) {
  Sheet sheet;
  if (row.columns == 0) row.columns = ColumnsFor(moments.size(), kMostColumns, format.chart);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double time_s = moments[i].time_s;
    SceneFormat wide = format;
    if (!moments[i].camera.empty()) wide.camera = moments[i].camera;
    if (wide.camera != "hand") wide.camera = WideView(scenario, run, 0, wide);
    chart.marks.push_back({.time_s = time_s, .letter = LetterOf(i)});
    AddScene(scenario, run, time_s,
             fmt::format("({}) {}{:.2f} s", LetterOf(i),
                         moments[i].caption.empty() ? "" : moments[i].caption + "\n", time_s),
             wide, painter, row);
  }
  sheet.title = std::exchange(chart.title, {});
  if (!row.tiles.empty()) sheet.rows.push_back(std::move(row));
  sheet.chart = std::move(chart);
  return sheet;
}

std::vector<KeyMoment> LongestLooks(const scenario::Scenario& scenario,
                                    const episode::RunResult& run, const Window& window,
                                    std::size_t most) {
  std::vector<Look> looks = Looks(scenario, run, window);
  std::ranges::stable_sort(looks, std::greater<>(), &Look::Dwell_s);
  looks.resize(std::min(most, looks.size()));
  std::ranges::stable_sort(looks, {}, &Look::begin_s);
  std::vector<KeyMoment> moments;
  for (const Look& look : looks) {
    moments.push_back({.time_s = look.Middle_s(),
                       .caption = fmt::format("{} sees {} for {:.2f} s, {:.2f} m away", look.person,
                                              look.seen, look.Dwell_s(), look.distance_m),
                       .involved = {look.person, look.seen}});
  }
  return moments;
}

Sheet GraspSheet(const std::vector<HeldScene>& scenes, const SceneFormat& format,
                 ScenePainter& painter) {
  Sheet sheet;
  TileRow row{.columns = ColumnsFor(scenes.size(), kGraspColumns, format.chart)};
  SceneFormat bare = Bare(format);
  // Only sets that touch something somewhere have a colour, in the order in which they appear.
  for (const HeldScene& scene : scenes) {
    for (const std::string& set : scene.held.sensor_sets) {
      auto& colors = bare.picture.sensor_colors;
      if (colors.count(set) > 0) continue;
      const std::uint32_t color = kSetColors[colors.size() % kSetColors.size()];
      colors[set] = color;
      sheet.legend.emplace_back(set, color);
    }
  }
  const auto all = bare.picture.sensor_colors;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const HeldScene& scene = scenes[i];
    bare.picture.sensor_colors.clear();
    for (const std::string& set : scene.held.sensor_sets)
      bare.picture.sensor_colors[set] = all.at(set);
    const std::string caption = fmt::format("({}) {}\n{}", LetterOf(i), scene.held.style,
                                            fmt::join(scene.held.sensor_sets, ", "));
    AddScene(*scene.scenario, *scene.run, scene.held.time_s, caption, bare, painter, row);
  }
  sheet.rows.push_back(std::move(row));
  if (!sheet.legend.empty()) sheet.note = "Sensors that touch what is held:";
  return sheet;
}

Result<std::vector<PlayedGrasp>> FindGrasps(std::vector<episode::RunRequest> scenarios,
                                            const std::string& root) {
  // Short ones show little else.
  std::ranges::stable_sort(scenarios, {}, [](const episode::RunRequest& scenario) {
    std::error_code error;
    return std::filesystem::file_size(scenario.scenario_file, error);
  });
  std::vector<PlayedGrasp> grasps;
  const auto is_known = [&](const std::string& style) {
    return std::ranges::any_of(grasps,
                               [&](const PlayedGrasp& grasp) { return grasp.held.style == style; });
  };
  for (const episode::RunRequest& scenario : scenarios) {
    PREHEND_TRY(episode::LoadedRun loaded, episode::LoadRun(scenario, root));
    if (std::ranges::all_of(StylesOf(loaded.scenario), is_known)) continue;
    episode::RunResult run =
        episode::RunScenario(loaded.scenario, loaded.program, {.record = true});
    auto held = LongestGrasp(loaded.scenario, run);
    if (held && !is_known(held->style))
      grasps.push_back({std::move(loaded), std::move(run), std::move(*held)});
  }
  return grasps;
}

std::vector<HeldScene> ScenesOf(const std::vector<PlayedGrasp>& grasps) {
  std::vector<HeldScene> scenes;
  for (const PlayedGrasp& grasp : grasps)
    scenes.push_back({&grasp.loaded.scenario, &grasp.run, grasp.held});
  return scenes;
}

double TileWidth(const ChartFormat& format, int columns) {
  return (format.width_px - 2 * kMargin_px - (columns - 1) * kGap_px) / columns;
}

std::string SheetSvg(const Sheet& sheet, const ChartFormat& format) {
  return SheetDrawing(sheet, format).Run();
}

std::string BesideEachOther(const std::vector<std::string>& svgs, const ChartFormat& format,
                            std::size_t columns) {
  std::vector<pugi::xml_document> parts(svgs.size());
  double top = 0, bottom = 0;
  for (std::size_t i = 0; i < svgs.size(); ++i) {
    if (i % columns == 0) top = bottom;
    parts[i].load_string(svgs[i].c_str());
    pugi::xml_node svg = parts[i].child("svg");
    svg.append_attribute("x").set_value(format.width_px * static_cast<double>(i % columns));
    svg.append_attribute("y").set_value(top);
    bottom = std::max(bottom, top + svg.attribute("height").as_double());
  }
  ChartFormat all = format;
  all.width_px *= static_cast<double>(columns);
  pugi::xml_document document;
  pugi::xml_node svg = AddDrawing(document, all, bottom);
  for (const pugi::xml_document& part : parts) svg.append_copy(part.child("svg"));
  return ToText(document, Layout::kIndented);
}

std::string LetterOf(std::size_t number) {
  const char last = static_cast<char>('a' + number % 26);
  return number < 26 ? std::string(1, last) : LetterOf(number / 26 - 1) + last;
}

}  // namespace prehend::show
