// SPDX-License-Identifier: Apache-2.0
// See harness/show/pictures/pictures.h. Tested by tests/program/render_test.cc
#include <fmt/format.h>

#include "harness/base/base/atomic_file.h"
#include "harness/base/process/child_process.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::show {

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
