// SPDX-License-Identifier: Apache-2.0
// See harness/show/pictures/pictures.h. Tested by tests/program/render_test.cc
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

}  // namespace prehend::show
