// SPDX-License-Identifier: Apache-2.0
// See harness/pictures/choose_pictures.h. Tested by tests/program/render_test.cc
#include "harness/pictures/choose_pictures.h"

#include "harness/run/event_time.h"

namespace prehend::harness {

std::vector<PictureYaml> ChosenPictures(const PictureChoice& choice, const Scenario& scenario) {
  const std::vector<PictureYaml>& own = scenario.pictures;
  PictureYaml entry = own.empty() ? PictureYaml{.at = {"0", {}}} : own.front();
  if (!choice.camera.empty()) entry.camera.value = choice.camera;
  if (choice.at.empty()) return choice.all && !own.empty() ? own : std::vector{entry};
  std::vector<PictureYaml> chosen;
  for (const std::string& at : choice.at) {
    chosen.push_back(entry);
    chosen.back().at.value = at;
  }
  return chosen;
}

std::string WhyNotChosen(const PictureChoice& choice, const std::vector<PictureYaml>& chosen,
                         const Scenario& scenario, const grammar::Program& program) {
  for (const PictureYaml& entry : chosen) {
    const auto problem = WhyNoEventTime(entry.at.value, program);
    if (problem && !choice.at.empty()) return "--at: " + problem->message + "; " + problem->hint;
    if (const auto why = WhyNoCamera(scenario, entry.camera.value)) return "--" + *why;
  }
  return "";
}

}  // namespace prehend::harness
