// SPDX-License-Identifier: Apache-2.0
// Does the suite find mistakes in a grammar? Each mutant is the shipped grammar with one mistake in
// it: another threshold, a clause less, a relation or a role swapped. It is killed by the first
// scenario whose golden it disagrees with, within the tolerance of `prehend check`. Some fifteen of
// the shipped scenarios are enough to kill them.
#include <gtest/gtest.h>

#include <iostream>
#include <map>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"
#include "tests/harness/suite/judge/played_scenario.h"

namespace prehend::suite {
namespace {

struct Mutant {
  std::string name;
  std::string file;      ///< of grammar/library
  std::string from, to;  ///< `from` occurs once
  std::string survives;  ///< why no scenario can kill it; empty: it has to be killed
};

const std::vector<Mutant> kMutants = {
    {"contacts are hardly bridged", "contact", "contact_bridge  = 100 ms", "contact_bridge  = 5 ms",
     ""},
    {"contacts are bridged too long", "contact", "contact_bridge  = 100 ms",
     "contact_bridge  = 250 ms", ""},
    {"support is not bridged", "contact", "support_bridge  = 100 ms", "support_bridge  = 0 ms", ""},
    {"whatever touches supports", "contact", "support_up      = 0.5 ", "support_up      = -0.5 ",
     ""},
    {"support waits until all is still", "contact", "support_settled = 2 cm/s",
     "support_settled = 1 mm/s", ""},
    {"what tips is not supported", "contact", "until not borne(object, support)",
     "until not (borne(object, support) and abs(relative_vertical_speed(object, support)) <= "
     "support_settled)",
     ""},
    {"an edge bears nothing", "contact", "touch_speed(object, support) <= support_settled or ", "",
     ""},
    {"a blow supports", "contact", "\n  lasting support_min", "", ""},
    {"the lower one is supported", "contact", "up(object, support)", "up(support, object)", ""},
    {"one side is a grasp", "grasp", "grip_sides   = 2", "grip_sides   = 1", ""},
    {"three sides are a grasp", "grasp", "grip_sides   = 2", "grip_sides   = 3", ""},
    {"the grip counts when it is closed", "grasp", "grip_on      = 0.3", "grip_on      = 0.9", ""},
    {"the grip does not count", "grasp",
     "trigger(hand) < grip_on and not held_between(hand, object) or ", "", ""},
    {"a brush is a grasp", "grasp", "\n  lasting grip_min", "", ""},
    {"grasps are bridged too long", "grasp", "grasp_bridge = 60 ms", "grasp_bridge = 200 ms", ""},
    {"a small retreat restarts the reach", "pick_and_place", "reach_slack  = 25 mm",
     "reach_slack  = 5 mm", ""},
    {"idling is reaching", "pick_and_place", "reach_idle   = 0.5 s", "reach_idle   = 5 s", ""},
    {"a grasp drops no other reach", "pick_and_place", "\n    and not taking(hand, any)", "", ""},
    {"a fast approach is no reach", "pick_and_place", "reach_min    = 100 ms",
     "reach_min    = 300 ms", ""},
    {"the region of interest is smaller", "pick_and_place", "reach_radius = 30 cm",
     "reach_radius = 20 cm", ""},
    {"a reach needs no grasp", "pick_and_place",
     "  confirmed by grasping(hand, object) within contact(hand, object)\n", "", ""},
    {"trembling is sliding", "pick_and_place",
     "\n    and drift_along(object, support, slide_window) >= slide_speed", "", ""},
    {"a jerk is a slide", "pick_and_place", "\n  lasting slide_jerk", "", ""},
    {"short slides are none", "pick_and_place", "slide_distance = 2 cm", "slide_distance = 6 cm",
     ""},
    {"there and back is no slide", "pick_and_place", "requires got_far(hand, object, support)",
     "requires displacement_along(object, support) >= slide_distance", ""},
    {"rising off the support is sliding", "pick_and_place",
     "to (displacement_along(object, support) >= slide_distance and moving_on_it(hand, object, "
     "support)) begins",
     "to displacement(object, support) >= slide_distance begins", ""},
    {"pauses do not end a slide", "pick_and_place", "slide_pause    = 150 ms",
     "slide_pause    = 800 ms", ""},
    {"what was pushed slides from the grasp on", "pick_and_place",
     "while grasping(hand, object) and supported_by(object, support) and speed_along",
     "while touching(hand, object) and supported_by(object, support) and speed_along", ""},
    {"a pick-up may go far to the side", "pick_and_place", "lift_radius = 9 cm",
     "lift_radius = 30 cm", ""},
    {"a pick-up ends low", "pick_and_place", "lift_height = 12 cm", "lift_height = 6 cm", ""},
    {"a low carry is a pick-up", "pick_and_place", "lift_rise   = 3 cm", "lift_rise   = 1 cm", ""},
    {"a pick-up begins with the grasp", "pick_and_place",
     "from supported_by(object, any) ends or scooping(hand, object) ends\n",
     "from grasping(hand, object) begins\n", ""},
    {"what a closing hand lifts is caught", "pick_and_place", " or scooping(hand, object) ends", "",
     "what fingers lift before they grasp it still has an edge on the table; the corpus draws one "
     "that has not"},
    {"a pick-up knows no put-down", "pick_and_place", " or putting_down(hand, object) begins", "",
     ""},
    {"moving away is putting down", "pick_and_place", "put_slack  = 5 mm", "put_slack  = 50 mm",
     ""},
    {"a put-down comes from higher above", "pick_and_place", "put_drop   = 2 cm",
     "put_drop   = 4 cm", ""},
    {"slow put-downs are cut short", "pick_and_place", "put_back   = 3.3 s", "put_back   = 1 s",
     ""},
    {"a put-down ends with the grasp", "pick_and_place",
     "until landed(hand, object) begins\n  since in_the_air(hand, object) and in_cylinder",
     "until grasping(hand, object) ends\n  since in_the_air(hand, object) and in_cylinder", ""},
    {"a put-down need not come from above", "pick_and_place",
     "from from_above(hand, object) begins", "from nearing(hand, object) begins", ""},
    {"beside its region it is picked up, too", "pick_and_place",
     " and in_cylinder(position(object), place, lift_radius, lift_sky)", "", ""},
    {"a pick-up must end high", "pick_and_place", " or raised(object)", "", ""},
    {"a transport includes the put-down", "pick_and_place",
     ", picking_up(hand, object), putting_down(hand, object)", ", picking_up(hand, object)", ""},
    {"the put-down comes before the grasp", "pick_and_place", "hold contains|finished_by put",
     "put before|meets hold", ""},
};

// In the order in which they kill most.
const char* const kScenarios[] = {
    "put_down/moving_away_cuts_the_put_down_short",
    "reach/idling_beside_the_object_is_no_reach",
    "slide/four_centimetres_are_a_slide",
    "slide/two_slides_with_a_rest_between",
    "pick_up/low_carry_is_a_transport_without_pick_up",
    "pick_up/leaving_sideways_ends_the_pick_up",
    "pick_up/lift_and_put_back_in_place",
    "reach/fast_approach_is_a_reach",
    "reach/small_retreat_does_not_restart_the_reach",
    "grasp/fixation_comes_before_the_grasp",
    "grasp/letting_go_for_a_twentieth_of_a_second_ends_the_grasp",
    "grasp/open_hand_that_pushes_does_not_grasp",
    "support/side_by_side_is_no_support",
    "support/bounces_are_contacts_of_their_own",
    "support/rolling_over_a_bar_is_no_support",
    "support/tipped_up_at_one_end_it_stands_on_the_other",
    "sensors/missed_touches_are_bridged",
    "put_down/slow_put_down",
    "pick_up/low_arch_is_a_pick_up",
    "put_down/low_last_approach_is_no_put_down",
    "slide/carton_slides_then_is_transported",
    "slide/push_before_the_grasp_is_no_part_of_the_slide",
    "reach/a_grasp_drops_the_reach_for_its_neighbour",
    "recorded/recorded_controller_grasps_the_can",
    "slide/there_and_back_is_a_slide",
    "slide/quick_lift_seen_slowly_is_no_slide",
    "rates/aside_and_up_is_no_pick_up_at_60_hz",
    "physics/tower_is_knocked_over",
    "tracking/jitter_of_a_millimetre_leaves_one_reach_and_one_grasp",
};

/// The mutant's program; no value: the mutation did not apply, or made no grammar.
std::shared_ptr<const grammar::Program> Mutate(const Mutant& mutant) {
  const auto read = [&mutant](std::string_view name) -> std::optional<grammar::GrammarText> {
    const std::string file = GrammarPath(PREHEND_SOURCE_DIR, std::string(name));
    Result<std::string> text = ReadTextFile(file);
    if (!text) return std::nullopt;
    if (name == mutant.file) {
      const std::size_t at = text->find(mutant.from);
      EXPECT_NE(at, std::string::npos)
          << mutant.name << ": '" << mutant.from << "' is not in " << mutant.file;
      if (at == std::string::npos) return std::nullopt;
      EXPECT_EQ(text->find(mutant.from, at + 1), std::string::npos)
          << mutant.name << ": occurs twice";
      text->replace(at, mutant.from.size(), mutant.to);
    }
    return grammar::GrammarText{file, *text};
  };
  const auto main = read("pick_and_place");
  if (!main) return nullptr;
  const grammar::CompileResult compiled = grammar::Compile(*main, read);
  EXPECT_TRUE(compiled.program) << mutant.name << ":\n" << grammar::Format(compiled.diagnostics);
  return compiled.program;
}

struct Evaluator {
  std::string id;
  PlayedScenario played;
  truth::Golden golden;

  bool Agrees(const grammar::Timeline& timeline) const {
    return truth::Compare(golden, timeline, scenario::DefaultTolerance(played.scenario)).Agrees();
  }
};

std::vector<Evaluator> Evaluators() {
  std::vector<Evaluator> evaluators;
  for (const char* id : kScenarios) {
    const auto golden = truth::GoldenFiles(PREHEND_SOURCE_DIR).ReadGoldenOf(id);
    const bool is_there = golden && *golden;
    EXPECT_TRUE(is_there) << id << " has no golden";
    if (is_there) evaluators.push_back({id, Play(id), **golden});
  }
  return evaluators;
}

TEST(Mutants, AreKilledByTheSuite) {
  const std::vector<Evaluator> evaluators = Evaluators();
  for (const Evaluator& evaluator : evaluators)
    EXPECT_TRUE(evaluator.Agrees(evaluator.played.run.timeline))
        << evaluator.id << ": the grammar itself has to agree";
  std::size_t killed = 0;
  for (const Mutant& mutant : kMutants) {
    const auto program = Mutate(mutant);
    if (!program) continue;
    const auto killer = std::ranges::find_if(evaluators, [&](const Evaluator& evaluator) {
      return !evaluator.Agrees(evaluator.played.WatchedBy(program));
    });
    EXPECT_EQ(killer == evaluators.end(), !mutant.survives.empty()) << mutant.name;
    killed += killer != evaluators.end();
    std::cout << mutant.name << ": "
              << (killer == evaluators.end() ? "survives, " + mutant.survives
                                             : "killed by " + killer->id)
              << "\n";
  }
  std::cout << killed << " of " << kMutants.size() << " mutants killed\n";
  EXPECT_GE(10 * killed, 9 * kMutants.size());
}

}  // namespace
}  // namespace prehend::suite
