// SPDX-License-Identifier: Apache-2.0
// Pictures that are asked for instead of a scenario's own. Tested by tests/program/render_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"

namespace prehend::show {

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

}  // namespace prehend::show
