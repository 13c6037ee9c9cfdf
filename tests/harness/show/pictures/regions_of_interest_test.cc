// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/compile/compile.h"
#include "harness/show/pictures/scenery.h"

namespace prehend::show {
namespace {

using render::Marker;
using render::MarkerKind;

/// A hand at the origin with two cups ahead of it, one of them too far away, and a table.
class RegionsOfInterestTest : public ::testing::Test {
 protected:
  RegionsOfInterestTest() {
    const auto add = [&](const char* name, const Eigen::Vector3d& at_m, bool fixed) {
      scenario_.scene.bodies.push_back(
          {.name = name,
           .shapes = {{physics::Box{Eigen::Vector3d(0.1, 0.1, 0.1)}, {}}},
           .fixed = fixed,
           .mass_kg = fixed ? 0 : 0.2});
      now_.bodies.emplace_back().X_WB.p_m = at_m;
    };
    add("cup", {0.3, 0, 0}, false);
    add("far_cup", {0.9, 0, 0}, false);
    add("table", {0.2, 0, -0.1}, true);
    scenario_.scene.hands.push_back({.name = "left", .model = {}, .X_WH = {}});
    scenario_.scene.hands[0].model.ahead = {1, 0, 0};
    now_.hands.resize(1);
    const auto compiled = grammar::Compile(
        {"g",
         "grammar g\n"
         "event near(h: Hand, x: Thing) while in_sphere(x, ahead(h, 30 cm), 30 cm)\n"
         "  drawn as phase \"#FF0000\"\n"
         "event away(h: Hand, x: Thing) from touching(h, x) begins\n"
         "  to not in_cylinder(position(x), position(x)@begin, 9 cm, 12 cm) begins\n"
         "  drawn as phase\n"},
        nullptr);
    EXPECT_TRUE(compiled.program) << grammar::Format(compiled.diagnostics);
    run_.drawings = truth::EventDrawings(*compiled.program);
    for (grammar::Tick tick = 0; tick <= 100; tick += 10) {
      now_.tick = tick;
      now_.bodies[0].X_WB.p_m.y() = static_cast<double>(tick) / 1000;
      run_.recording.push_back(now_);
    }
  }
  void Add(const char* event, grammar::Tick begin, grammar::Tick end) {
    run_.timeline.events.push_back(
        {.event = event, .roles = {{"h", "left"}, {"x", "cup"}}, .interval = {begin, end}});
  }
  std::vector<Marker> At(std::size_t snapshot) const {
    return RegionMarkers(scenario_, run_, run_.recording[snapshot],
                         [](const grammar::NamedEvent&) { return true; });
  }

  scenario::Scenario scenario_;
  episode::RunResult run_;
  physics::Snapshot now_;
};

TEST_F(RegionsOfInterestTest, ASphereLiesBeforeTheHandAndItsCandidatesHaveStars) {
  Add("near", 10, 30);
  EXPECT_TRUE(At(0).empty()) << "before the phase";
  const std::vector<Marker> markers = At(1);
  ASSERT_EQ(markers.size(), 2u) << "neither the far cup nor the table is a candidate";
  EXPECT_EQ(markers[0].kind, MarkerKind::kSphere);
  EXPECT_LT((markers[0].p_W_m - Eigen::Vector3f(0.3f, 0, 0)).norm(), 1e-6f);
  EXPECT_EQ(markers[0].half_size_m, Eigen::Vector3f::Constant(0.3f));
  EXPECT_EQ(markers[0].color, render::Color(1, 0, 0)) << "that of the phase";
  EXPECT_EQ(markers[1].kind, MarkerKind::kCandidate);
  EXPECT_GT(markers[1].p_W_m.z(), 0.05f) << "above the cup";
}

TEST_F(RegionsOfInterestTest, ACylinderStaysWhereTheThingWasWhenThePhaseBegan) {
  Add("away", 20, 90);
  const std::vector<Marker> markers = At(8);
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(markers[0].kind, MarkerKind::kCylinder);
  EXPECT_NEAR(markers[0].p_W_m.y(), 0.02f, 1e-6f);
  EXPECT_LT((markers[0].half_size_m - Eigen::Vector3f(0.09f, 0.09f, 0.12f)).norm(), 1e-6f);
}

}  // namespace
}  // namespace prehend::show
