// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/command/picture_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "harness/base/base/number_text.h"

namespace prehend::cli {
namespace {

bool Looks(const ParsedOptions& options, const char* word) {
  return options.Has("--look") &&
         std::ranges::count(SplitAt(options.Text("--look"), ','), word) > 0;
}

/// Of SVG.
constexpr double kPixelsPerInch = 96;

/// Of "89mm" or "89".
std::optional<double> Millimetres(std::string_view text) {
  if (text.ends_with("mm")) text.remove_suffix(2);
  const auto width_mm = NumberFrom<double>(text);
  return width_mm && *width_mm >= 30 && *width_mm <= 500 ? width_mm : std::nullopt;
}

}  // namespace

std::vector<Option> PartOptions() {
  return {
      Value("--from", "S", "begin of the part whose events, paths and ghosts are shown, seconds",
            NumbersFrom(0, 1e6)),
      Value("--to", "S",
            "end of that part; default: all, but paths and ghosts of an episode of more than 15 s "
            "only around the moment",
            NumbersFrom(0, 1e6)),
      Value("--hand", "HAND", "paths, ghosts and rows of this hand only"),
      Value("--of", "NAME", "the path of this thing, and only events that it takes part in")};
}

std::vector<Option> LookOptions() {
  return {Value("--camera", "CAMERA",
                "from where: front, left, right, top, three_quarter; hand, action or body, which "
                "are nearer to what they name; a camera of the scenario; or X,Y,Z:X,Y,Z[:DEG], a "
                "place, what it looks at, and the view's height"),
          Value("--text", "SCALE", "scale of all text; default: 1", NumbersFrom(0.3, 5)),
          Value("--look", "LOOK,..",
                "print: on white paper; transparent: without a ground, for slides and posters; "
                "regions: with the regions of interest of what hands do at the moment, and a star "
                "above each thing that a hand may be reaching for",
                SomeOf({"print", "transparent", "regions"}))};
}

Option WidthOption() {
  return Value(
      "--width", "MM",
      "width on paper, such as 89mm; texts have 7 pt there (times --text), PNG 600 dots per inch",
      {"30mm to 500mm", [](const std::string& value) {
         return Millimetres(value) ? ""
                                   : "expected a width like 89mm, 30 to 500, found '" + value + "'";
       }});
}

double PixelsOf(const ParsedOptions& options) {
  return options.Has("--width") ? 600 / kPixelsPerInch : 2;
}

show::PictureFormat FormatOfOptions(const ParsedOptions& options) {
  show::PictureFormat format{.text_scale = options.NumberOr("--text", 1),
                             .print = Looks(options, "print"),
                             .transparent = Looks(options, "transparent"),
                             .only = options.Text("--hand"),
                             .of = options.Text("--of"),
                             .regions = Looks(options, "regions")};
  if (options.Has("--from")) format.from_s = options.NumberOr("--from", 0);
  if (options.Has("--to")) format.to_s = options.NumberOr("--to", 0);
  return format;
}

std::string WhyNoPart(const show::PictureFormat& format, const scenario::Scenario& scenario) {
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
  const std::string why = unknown("--hand", format.only, hands);
  return why.empty() ? unknown("--of", format.of, all) : why;
}

std::string WhyNotShown(const ParsedOptions& options, const scenario::Scenario& scenario,
                        const episode::RunResult& run) {
  std::string why = WhyNoPart(FormatOfOptions(options), scenario);
  const double from_s = options.NumberOr("--from", 0), end_s = show::WholeOf(run).to_s;
  if (why.empty() && from_s >= end_s)
    why = fmt::format("--from: found {:g} s, wanted less than the episode's end, {:g} s", from_s,
                      end_s);
  if (!why.empty() || !options.Has("--camera")) return why;
  const auto no_camera = scenario::WhyNoCamera(scenario, options.Text("--camera"));
  return no_camera ? "--" + *no_camera : "";
}

show::Window WindowOf(const ParsedOptions& options, const episode::RunResult& run) {
  show::Window window = show::WholeOf(run);
  window.from_s = options.NumberOr("--from", window.from_s);
  window.to_s = std::min(window.to_s, options.NumberOr("--to", window.to_s));
  window.hand = options.Text("--hand");
  window.entity = options.Text("--of");
  return window;
}

show::SceneFormat SceneFormatOf(const ParsedOptions& options, const std::string& camera,
                                double width_px) {
  const auto paper_mm = Millimetres(options.Text("--width"));
  const double text_px = paper_mm ? 7 * kPixelsPerInch / 72 : 12;
  return {.camera = options.TextOr("--camera", camera),
          .picture = FormatOfOptions(options),
          .chart = {.width_px = paper_mm ? *paper_mm / 25.4 * kPixelsPerInch : width_px,
                    .text_px = text_px * options.NumberOr("--text", 1),
                    .transparent = Looks(options, "transparent")}};
}

}  // namespace prehend::cli
