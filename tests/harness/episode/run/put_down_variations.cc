// SPDX-License-Identifier: Apache-2.0
// put_down_variations [COUNT [SEED [STORY..]]]: does it matter for put-downs how long the steps of
// a script take? Plays shipped stories with `place_on`, each step 0.3 to 2.3 times as long as
// written, at random. Reports things that do not stand when the hand begins to open or are lifted
// off again, and claims (`expects`) that are contradicted. Exit status 0: all stand, and the claims
// hold in 99 of 100 variations. A small run is in ctest, a longer one is made by hand.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/claims/judge_claims.h"
#include "physics/base/random.h"
#include "physics/scene/geometry.h"

namespace prehend::episode {
namespace {

constexpr double kShortest = 0.3, kLongest = 2.3;  // times the written duration

/// Things of all shapes, several hands, onto what is level, tilted, hollow or movable.
const std::vector<std::string> kStories = {
    "hands/each_hand_carries_its_own",
    "long/two_cans_change_places",
    "pick_and_place/carton_is_picked_from_above_and_placed",
    "pick_and_place/milk_carton_wrap",
    "planar/gripper_carries_box",
    "put_down/put_into_a_bowl",
    "put_down/put_onto_a_box",
    "put_down/put_onto_a_sloping_board",
    "styles/tripod_takes_a_can_from_the_side",
    "support/can_is_put_into_a_shelf",
};

void Vary(physics::Script& script, physics::Random& random) {
  for (physics::ScriptStage& stage : script.stages) {
    for (physics::Step& step : stage.steps) step.over_s *= random.Between(kShortest, kLongest);
  }
}

/// A hand opens, perhaps after it has placed a thing.
struct Opening {
  physics::BodyIndex body = {}, support = {};  ///< none: nothing was placed
  std::int64_t tick = -1;                      ///< at which it began; -1: not yet
  bool stood = false;                          ///< then
};

/// The openings of one hand, in their order.
std::vector<Opening> OpeningsOf(const scenario::Scenario& scenario, physics::HandIndex hand) {
  std::vector<Opening> openings;
  Opening next;
  double trigger = 0;
  for (const physics::ScriptStage& stage : scenario.script.stages) {
    for (const physics::Step& step : stage.steps) {
      if (step.hand != hand) continue;
      if (const auto* reach = std::get_if<physics::ReachStep>(&step.action)) {
        next.body = physics::FindBody(scenario.scene, reach->object);
        next.support = physics::kNone;
      } else if (const auto* place = std::get_if<physics::PlaceStep>(&step.action)) {
        next.support = physics::FindBody(scenario.scene, place->support);
      } else if (const auto* moved = std::get_if<physics::TriggerStep>(&step.action)) {
        if (moved->trigger < trigger) openings.push_back(next);
        if (moved->trigger != trigger) next.support = physics::kNone;
        trigger = moved->trigger;
      }
    }
  }
  return openings;
}

bool Touch(const physics::Snapshot& now, physics::BodyIndex a, physics::BodyIndex b) {
  for (const auto& points : now.AllContacts()) {
    for (const physics::ContactPoint& point : points) {
      if (point.a.hand != physics::kNone || point.b.hand != physics::kNone) continue;
      if ((point.a.body == a && point.b.body == b) || (point.a.body == b && point.b.body == a))
        return true;
    }
  }
  return false;
}

/// What is wrong with one variation.
struct Complaints {
  std::string hovering, claims;  ///< a line each, or empty
};

Complaints Play(const LoadedRun& loaded, const scenario::Scenario& scenario) {
  Complaints complaints;
  const std::size_t hands = scenario.scene.hands.size();
  std::vector<std::vector<Opening>> openings;
  for (std::size_t h = 0; h < hands; ++h)
    openings.push_back(OpeningsOf(scenario, physics::HandIndex(h)));
  std::vector<std::size_t> begun(hands, 0);
  std::vector<double> trigger(hands, 0);
  std::vector<bool> opening(hands, false);

  ScenarioRun run(scenario, loaded.program);
  while (run.Step()) {
    const physics::Snapshot& now = run.snapshot();
    for (std::size_t h = 0; h < hands; ++h) {
      const double is = now.hands[h].trigger;
      const bool opens = is < trigger[h];
      if (opens && !opening[h] && begun[h] < openings[h].size()) {
        Opening& begins = openings[h][begun[h]++];
        begins.tick = now.tick;
        begins.stood = begins.support == physics::kNone || Touch(now, begins.body, begins.support);
      }
      opening[h] = is != trigger[h] ? opens : opening[h] && is > 0;
      trigger[h] = is;
    }
  }
  const RunResult result = run.Finish();
  if (result.status.kind != physics::RunStatus::Kind::kCompleted)
    complaints.claims = "    " + result.status.reason + "\n";

  const double rate_hz = scenario.scene.world.rate_hz;
  for (std::size_t h = 0; h < hands; ++h) {
    for (const Opening& placed : openings[h]) {
      if (placed.support == physics::kNone) continue;
      const std::string& name = scenario.scene.body(placed.body).name;
      const std::string roles = "(" + scenario.scene.hands[h].name + ", " + name + ")";
      std::string hovers = placed.stood ? "" : "does not stand when the hand opens";
      grammar::Tick down = -1;
      for (const grammar::NamedEvent& event : result.timeline.events) {
        if (event.Label() == "putting_down" + roles && event.interval.end <= placed.tick)
          down = event.interval.end;
        if (event.Label() == "transporting" + roles && down >= 0 && event.interval.begin >= down &&
            event.interval.begin < placed.tick && event.interval.end >= placed.tick)
          hovers += " is lifted off again after its put-down";
      }
      if (!hovers.empty())
        complaints.hovering += "    " + name + " " + hovers + " (" +
                               std::to_string(static_cast<double>(placed.tick) / rate_hz) + " s)\n";
    }
  }
  complaints.claims += truth::TextOfContradicted(JudgeClaims(
      scenario.expects, scenario.file, ClaimableIn(scenario, *loaded.program), result.timeline));
  return complaints;
}

int Run(int count, std::uint64_t seed, const std::vector<std::string>& stories) {
  std::vector<LoadedRun> loaded;
  for (const std::string& story : stories) {
    Result<LoadedRun> read = LoadRun(
        {.scenario_file = std::string(PREHEND_SOURCE_DIR) + "/scenarios/" + story + ".yaml"},
        PREHEND_SOURCE_DIR);
    if (!read) {
      std::printf("%s", grammar::Format(read.error()).c_str());
      return 2;
    }
    loaded.push_back(std::move(*read));
  }
  physics::Random random(seed);
  int hovering = 0, contradicted = 0;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i) % stories.size();
    scenario::Scenario varied = loaded[k].scenario;
    Vary(varied.script, random);
    const Complaints complaints = Play(loaded[k], varied);
    hovering += !complaints.hovering.empty();
    contradicted += !complaints.claims.empty();
    if (complaints.hovering.empty() && complaints.claims.empty()) continue;
    std::printf("variation %d, %s:\n%s%s", i, stories[k].c_str(), complaints.hovering.c_str(),
                complaints.claims.c_str());
    std::fflush(stdout);
  }
  std::printf("%d variations: in %d not all stands, in %d not all claims hold\n", count, hovering,
              contradicted);
  return hovering == 0 && contradicted * 100 <= count ? 0 : 1;
}

}  // namespace
}  // namespace prehend::episode

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::vector<std::string> stories(argv + (argc > 3 ? 3 : argc), argv + argc);
  return prehend::episode::Run(count, seed, stories.empty() ? prehend::episode::kStories : stories);
}
