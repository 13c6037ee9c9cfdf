// SPDX-License-Identifier: Apache-2.0
// strength_by_angle crate [STEP_KG]: how heavy a crate one hand lifts by its bar, with everything
// turned by several angles. strength_by_angle trials [COUNT [NAME..]]: how many trials of
// scenarios/trials end with their first outcome as written, turned by 40 degrees, mirrored (the
// left hand) and both. Prints a table in Markdown. Exit status 0: the heaviest crates are within 3
// % (and one step) of each other, the counts of a scenario within 2 of 200 (at least 1).
// docs/physics.md has what came out. A small run of each is in ctest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_trials.h"
#include "physics/scene/geometry.h"
#include "physics/simulation.h"
#include "tests/witnesses/metamorphic/move_scenario.h"

namespace prehend::witnesses {
namespace {

const std::string kRoot = PREHEND_SOURCE_DIR;

episode::RunRequest RequestFor(const std::string& scenario) {
  return {.scenario_file = kRoot + "/scenarios/" + scenario + ".yaml"};
}

template <typename T>
T OrExit(Result<T> result) {
  if (result) return std::move(*result);
  std::printf("%s", grammar::Format(result.error()).c_str());
  std::exit(2);
}

scenario::Scenario Turned(const scenario::Scenario& scenario, double yaw_deg) {
  return Moved(scenario, {.X = {.q = physics::FromRollPitchYaw({0, 0, yaw_deg})}});
}

/// How far the centre of `body` rises above where it stands at first.
double Rise_m(const scenario::Scenario& scenario, const std::string& body) {
  const auto index = physics::FindBody(scenario.scene, body).index();
  const double stands_m = scenario.scene.bodies[index].X_WB.p_m.z();
  physics::Simulation simulation(scenario.scene, scenario.script);
  double rise_m = 0;
  while (simulation.Step())
    rise_m = std::max(rise_m, simulation.snapshot().bodies[index].X_WB.p_m.z() - stands_m);
  return rise_m;
}

int Crate(double step_kg) {
  constexpr double kYaws_deg[] = {0, 1, 5, 15, 30, 45, 60, 90};
  constexpr int kLeast_kg = 4, kMost_kg = 8;
  constexpr double kLifted_m = 0.15;  // the hand rises by 0.2 m
  const auto rise_m = [](double mass_kg, double yaw_deg) {
    episode::RunRequest request = RequestFor("bimanual/one_hand_cannot_lift_nine_kilograms");
    request.settings = {"entities.crate.mass_kg=" + std::to_string(mass_kg)};
    const episode::LoadedRun loaded = OrExit(episode::LoadRun(request, kRoot));
    return Rise_m(Turned(loaded.scenario, yaw_deg), "crate");
  };
  std::printf("| yaw |");
  for (int mass_kg = kLeast_kg; mass_kg <= kMost_kg; ++mass_kg) std::printf(" %d kg |", mass_kg);
  std::printf(" lifted up to |\n|---|---|---|---|---|---|---|\n");
  double least_kg = 1e9, most_kg = 0;
  for (const double yaw_deg : kYaws_deg) {
    std::printf("| %g |", yaw_deg);
    int lifted = 0;
    for (int mass_kg = kLeast_kg; mass_kg <= kMost_kg; ++mass_kg) {
      const double rises_m = rise_m(mass_kg, yaw_deg);
      if (rises_m > kLifted_m && lifted == mass_kg - kLeast_kg) ++lifted;
      std::printf(" %.0f mm |", 1000 * rises_m);
      std::fflush(stdout);
    }
    double limit_kg = kLeast_kg + lifted - 1;
    while (rise_m(limit_kg + step_kg, yaw_deg) > kLifted_m) limit_kg += step_kg;
    least_kg = std::min(least_kg, limit_kg);
    most_kg = std::max(most_kg, limit_kg);
    std::printf(" %.2f kg |\n", limit_kg);
  }
  return most_kg - least_kg <= 0.03 * least_kg + step_kg ? 0 : 1;
}

bool EndsAsIntended(const scenario::Scenario& scenario) {
  physics::Simulation simulation(scenario.scene, scenario.script);
  episode::OutcomeWatch watch(scenario.scene, scenario.outcomes);
  while (simulation.Step()) watch.Look(simulation.snapshot());
  return simulation.status().kind == physics::RunStatus::Kind::kCompleted &&
         watch.Judge(simulation.snapshot()) == scenario.outcomes.front().name;
}

int Trials(int count, const std::vector<std::string>& names) {
  constexpr double kYaw_deg = 40;
  bool same = true;
  std::printf("| `trials/` | right, 0 | right, %g | left, 0 | left, %g |\n|---|---|---|---|---|\n",
              kYaw_deg, kYaw_deg);
  for (const std::string& name : names) {
    const episode::RunRequest request = RequestFor("trials/" + name);
    std::vector<int> placed(4, 0);
    for (int trial = 1; trial <= count; ++trial) {
      const episode::RunRequest drawn = OrExit(episode::RequestOfTrial(request, kRoot, trial));
      const scenario::Scenario right = OrExit(episode::LoadRun(drawn, kRoot)).scenario;
      const scenario::Scenario left = Moved(right, {.mirrors = true, .X = {}});
      placed[0] += EndsAsIntended(right);
      placed[1] += EndsAsIntended(Turned(right, kYaw_deg));
      placed[2] += EndsAsIntended(left);
      placed[3] += EndsAsIntended(Turned(left, kYaw_deg));
    }
    std::printf("| `%s` | %d | %d | %d | %d |\n", name.c_str(), placed[0], placed[1], placed[2],
                placed[3]);
    std::fflush(stdout);
    const auto [least, most] = std::ranges::minmax(placed);
    same = same && most - least <= std::max(1, count / 100);
  }
  return same ? 0 : 1;
}

}  // namespace
}  // namespace prehend::witnesses

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "crate") return prehend::witnesses::Crate(argc > 2 ? std::atof(argv[2]) : 0.05);
  if (what != "trials") {
    std::printf("usage: strength_by_angle crate [STEP_KG] | trials [COUNT [NAME..]]\n");
    return 2;
  }
  std::vector<std::string> names(argv + std::min(argc, 3), argv + argc);
  if (names.empty())
    names = {"wrap_places_a_carton",           "pinch_places_a_box",    "tripod_places_a_box",
             "precision_sphere_places_a_ball", "lateral_places_a_slab", "gripper_places_a_box",
             "sliding_jaws_place_a_box"};
  return prehend::witnesses::Trials(argc > 2 ? std::atoi(argv[2]) : 200, names);
}
