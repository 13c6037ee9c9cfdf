// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/compile/compile.h"
#include "harness/show/pictures/scenery.h"
#include "render/draw_list.h"

namespace prehend::show {
namespace {

/// A hand that takes a cup from a tray, and the grammar that draws it.
class Stage {
 public:
  Stage() {
    const auto add = [&](const char* name, double mass_kg) {
      scenario.scene.bodies.push_back({.name = name,
                                       .shapes = {{physics::Box{}, {}}},
                                       .fixed = mass_kg == 0,
                                       .mass_kg = mass_kg});
      scenario.body_classes.push_back("Thing");
    };
    add("tray", 0);
    add("cup", 0.2);
    scenario.name = "stage";
    scenario.scene.hands.push_back({.name = "left", .model = {}, .X_WH = {}});
    const auto compiled = grammar::Compile(
        {"g",
         "grammar g\n"
         "event moves_to(h: Hand, x: Thing) while touching(x, h) drawn as phase \"#010203\"\n"
         "event holds(h: Hand, x: Thing) while touching(x, h) drawn as grasp\n"
         "event stands_on(x: Thing, y: Thing) while touching(x, y) drawn as support\n"
         "event falls(x: Thing) while height(x) < 1 m\n"
         "event hidden(x: Thing) while height(x) < 2 m drawn without row\n"},
        nullptr);
    EXPECT_TRUE(compiled.program);
    run.drawings = truth::EventDrawings(*compiled.program);
    run.ticks = 480;
    run.timeline.ticks_per_second = 480;
    for (grammar::Tick tick = 0; tick <= 480; tick += 48) {
      physics::Snapshot& snapshot = run.recording.emplace_back();
      snapshot.tick = tick;
      snapshot.bodies.resize(scenario.scene.bodies.size());
      snapshot.hands.resize(1);
      snapshot.hands[0].palm.X_WB.p_m.x() = static_cast<double>(tick) / 480;
    }
    Add("moves_to", {{"h", "left"}, {"x", "cup"}}, 48, 240);
    Add("holds", {{"h", "left"}, {"x", "cup"}}, 240, 480);
    Add("stands_on", {{"x", "cup"}, {"y", "tray"}}, 0, 240);
    Add("falls", {{"x", "cup"}}, 96, 144);
    Add("hidden", {{"x", "cup"}}, 96, 144);
  }

  void Add(const char* event, std::vector<grammar::Role> roles, grammar::Tick begin,
           grammar::Tick end) {
    run.timeline.events.push_back(
        {.event = event, .roles = std::move(roles), .interval = {begin, end}});
  }

  render::Picture At(const char* moment) const {
    return ComposePicture(scenario, run, {.at = {moment, {}}});
  }

  scenario::Scenario scenario;
  episode::RunResult run;
};

TEST(ComposePictureTest, TheStripHasARowForEachKindOfDrawing) {
  const render::TimelineStrip strip = Stage().At("0.5").strip;
  EXPECT_EQ(strip.end_s, 1);
  EXPECT_EQ(strip.playhead_s, 0.5);
  std::vector<std::pair<std::string, std::string>> rows;  // with the name of the first bar
  for (const render::StripRow& row : strip.rows) {
    ASSERT_EQ(row.segments.size(), 1u) << row.label;
    rows.emplace_back(row.label, row.segments[0].label);
  }
  EXPECT_EQ(rows,
            (std::vector<std::pair<std::string, std::string>>{
                {"phase", "moves to"}, {"grasp", "cup"}, {"falls", "cup"}, {"cup on", "tray"}}));
  EXPECT_EQ(strip.rows[0].segments[0].begin_s, 0.1);
  EXPECT_EQ(strip.rows[0].segments[0].end_s, 0.5);
}

TEST(ComposePictureTest, RowsBeyondTheSixthAreLeftOut) {
  Stage stage;
  for (const char* event : {"one", "two", "three", "four", "five"})
    stage.Add(event, {{"x", "cup"}}, 0, 48);
  const auto rows = stage.At("0.5").strip.rows;
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows.back().label, "three");
  EXPECT_EQ(stage.At("0.5").strip.rows_left_out, 3) << "four, five and cup on";
}

TEST(ComposePictureTest, OfManySupportsThoseOfWhatAHandHoldsAreShown) {
  Stage stage;
  for (const char* name : {"a", "b", "c", "d", "e", "held"}) {
    stage.scenario.scene.bodies.push_back(
        {.name = name, .shapes = {{physics::Box{}, {}}}, .mass_kg = 0.2});
    stage.scenario.body_classes.push_back("Thing");
    for (physics::Snapshot& snapshot : stage.run.recording) snapshot.bodies.emplace_back();
    stage.Add("stands_on", {{"x", name}, {"y", "tray"}}, 0, 480);
  }
  stage.Add("holds", {{"h", "left"}, {"x", "held"}}, 300, 400);
  const render::TimelineStrip strip = stage.At("0.7").strip;
  const auto labels = [&] {
    std::vector<std::string> all;
    for (const render::StripRow& row : strip.rows) all.push_back(row.label);
    return all;
  }();
  ASSERT_EQ(labels.size(), 5u) << "a to e stay where they are";
  EXPECT_EQ(labels[3], "cup on");
  EXPECT_EQ(labels[4], "held on");
  EXPECT_EQ(strip.rows_left_out, 5);
}

TEST(ComposePictureTest, ThePathIsCutWherePhasesChange) {
  const auto path = Stage().At("0.5").path;
  ASSERT_EQ(path.size(), 3u);
  EXPECT_EQ(path[0].label, "");
  EXPECT_EQ(path[1].label, "moves_to");
  EXPECT_EQ(path[2].label, "");
  EXPECT_EQ(path[1].points_m.front(), path[0].points_m.back());
}

TEST(ComposePictureTest, AGhostStandsWhereAPhaseBeganUnlessItIsNow) {
  const auto ghosts = Stage().At("0.5").ghosts;
  ASSERT_EQ(ghosts.size(), 1u);
  EXPECT_EQ(ghosts[0].snapshot.tick, 48);
  EXPECT_TRUE(Stage().At("0.1").ghosts.empty());
}

TEST(ComposePictureTest, SupportsOfTheMomentAreMarked) {
  ASSERT_EQ(Stage().At("0.1").markers.size(), 1u);
  EXPECT_EQ(Stage().At("0.1").markers[0].kind, render::MarkerKind::kSupport);
  EXPECT_TRUE(Stage().At("0.9").markers.empty());
}

TEST(ComposePictureTest, TheMarkOfASupportLiesOnTheSlope) {
  Stage stage;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d up = q * Eigen::Vector3d::UnitZ();
  for (physics::Snapshot& snapshot : stage.run.recording) {
    snapshot.bodies[1].X_WB.q = q;
    snapshot.contacts = {{.a = {.body = physics::BodyIndex(1)},
                          .b = {.body = physics::BodyIndex(0)},
                          .nhat_BA_W = up}};
  }
  const render::Marker mark = stage.At("0.1").markers.at(0);
  const physics::LocalBox box = physics::BoundingBox(stage.scenario.scene.bodies[1]);
  const Eigen::Vector3d foot = q * (box.p_BC_m - box.half_size_m.z() * Eigen::Vector3d::UnitZ());
  EXPECT_LT((mark.p_W_m.cast<double>() - foot).norm(), 1e-6);
  EXPECT_LT((mark.q_WM.cast<double>() * Eigen::Vector3d::UnitZ() - up).norm(), 1e-6);
}

TEST(ComposePictureTest, OfSeveralPersonsEachHasARow) {
  Stage stage;
  for (const char* name : {"anna", "ben"}) {
    stage.scenario.scene.persons.push_back({.name = name});
    for (physics::Snapshot& snapshot : stage.run.recording) snapshot.gazes.emplace_back();
    stage.Add("looks", {{"p", name}, {"x", "cup"}}, 0, 480);
  }
  std::vector<std::string> labels;
  for (const render::StripRow& row : stage.At("0.5").strip.rows) labels.push_back(row.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"phase", "grasp", "falls", "anna looks", "ben looks",
                                              "cup on"}));
}

TEST(ComposePictureTest, TheTitleSaysWhichMomentItIs) {
  EXPECT_EQ(Stage().At("0.5").title, "stage  ·  0.500 s  ·  pick_and_place");
  EXPECT_EQ(Stage().At("moves_to.begin").title,
            "stage  ·  moves_to.begin  ·  0.100 s  ·  pick_and_place");
}

TEST(ComposePictureTest, AWindowHoldsItsPathsGhostsAndRows) {
  const Stage stage;
  const auto window = [&](double from_s, double to_s) {
    return ComposePicture(stage.scenario, stage.run, {.at = {"0.6", {}}},
                          {.from_s = from_s, .to_s = to_s});
  };
  const render::Picture late = window(0.55, 1);
  EXPECT_EQ(late.strip.begin_s, 0.55);
  EXPECT_EQ(late.strip.end_s, 1);
  ASSERT_EQ(late.strip.rows.size(), 1u);
  EXPECT_EQ(late.strip.rows[0].label, "grasp");
  EXPECT_TRUE(late.ghosts.empty());
  ASSERT_EQ(late.path.size(), 1u);
  EXPECT_NEAR(late.path[0].points_m.front().x(), 0.6, 1e-6);
  EXPECT_EQ(window(0, 0.3).ghosts.size(), 1u);
}

TEST(ComposePictureTest, OneHandOrOneThingIsToldApart) {
  Stage stage;
  stage.Add("moves_to", {{"h", "left"}, {"x", "tray"}}, 240, 480);
  const auto rows = [&](const PictureFormat& format) {
    return ComposePicture(stage.scenario, stage.run, {.at = {"0.5", {}}}, format).strip.rows;
  };
  EXPECT_EQ(rows({})[0].segments.size(), 2u);
  EXPECT_EQ(rows({.of = "cup"})[0].segments.size(), 1u);
  EXPECT_EQ(rows({.of = "tray"})[0].segments.size(), 1u);
  const render::Picture other =
      ComposePicture(stage.scenario, stage.run, {.at = {"0.5", {}}}, {.only = "right"});
  EXPECT_TRUE(other.path.empty());
  EXPECT_TRUE(other.ghosts.empty());
}

TEST(ComposePictureTest, PartsAreLeftOutWhenAsked) {
  const Stage stage;
  const render::Picture bare = ComposePicture(
      stage.scenario, stage.run, {.at = {"0.5", {}}},
      {.title = false, .labels = false, .strip = false, .ghosts = false, .paths = false});
  EXPECT_EQ(bare.title, "");
  EXPECT_TRUE(bare.body_labels.empty() && bare.strip.rows.empty() && bare.ghosts.empty() &&
              bare.path.empty());
}

TEST(ComposePictureTest, TheTableIsWholeFromAbove) {
  const auto is_whole = [](double half_m, const char* camera) {
    Stage stage;
    const physics::Box top{{2 * half_m, 2 * half_m, 0.02}};
    stage.scenario.scene.bodies[0].shapes = {{top, {}}};
    const render::Picture picture =
        ComposePicture(stage.scenario, stage.run, {.at = {"0.5", {}}, .camera = {camera, {}}});
    const render::View view = MakeView(picture.camera, 1280, 720, 140, {});
    for (const double x : {-half_m, half_m})
      for (const double y : {-half_m, half_m})
        if (const auto at = ToPixel(view, Eigen::Vector3d(x, y, 0).cast<float>());
            !at || at->minCoeff() < 0 || at->y() > 580)
          return false;
    return true;
  };
  EXPECT_TRUE(is_whole(1.2, "top"));
  EXPECT_FALSE(is_whole(1.2, "front"));  // shows the action
  EXPECT_FALSE(is_whole(1.3, "top"));    // a large one is cut
}

TEST(ComposePictureTest, WhatMovesIsWholeHoweverLargeItIs) {
  const auto share = [](double edge_m, double way_m) {
    Stage stage;
    stage.scenario.scene.bodies[1].shapes = {{physics::Box{Eigen::Vector3d::Constant(edge_m)}, {}}};
    stage.scenario.scene.bodies[0].shapes = {{physics::Box{{9, 9, 0.02}}, {}}};
    stage.scenario.scene.hands.clear();
    for (physics::Snapshot& snapshot : stage.run.recording) {
      snapshot.hands.clear();
      snapshot.bodies[1].X_WB.p_m.z() = way_m * static_cast<double>(snapshot.tick) / 480;
    }
    const render::Picture picture =
        ComposePicture(stage.scenario, stage.run, {.at = {"0.5", {}}, .camera = {"front", {}}});
    const render::View view = MakeView(picture.camera, 1280, 720, 0, {});
    Eigen::AlignedBox2f seen;
    for (const double x : {-edge_m / 2, edge_m / 2})
      for (const double y : {-edge_m / 2, edge_m / 2})
        for (const double z : {-edge_m / 2, way_m + edge_m / 2})
          seen.extend(*ToPixel(view, Eigen::Vector3d(x, y, z).cast<float>()));
    EXPECT_GE(seen.min().minCoeff(), 0) << edge_m;
    EXPECT_LE(seen.max().x(), 1280) << edge_m;
    EXPECT_LE(seen.max().y(), 720) << edge_m;
    return seen.sizes().y() / 720;
  };
  for (const double edge_m : {0.2, 1.0, 4.0}) EXPECT_GT(share(edge_m, 0.5), 0.4) << edge_m;
  EXPECT_GT(share(1.5, 0), 0.4) << "there is nothing else";
  EXPECT_GT(share(0.005, 0), 0.1) << "a crumb can be seen";
}

TEST(ComposePictureTest, PicturesOfOneScenarioHaveOneCamera) {
  Stage stage;
  for (physics::Snapshot& snapshot : stage.run.recording)
    snapshot.bodies[1].X_WB.p_m.z() = static_cast<double>(snapshot.tick) / 480;
  const render::Camera early = stage.At("0.1").camera, late = stage.At("0.9").camera;
  EXPECT_EQ(early.eye_m, late.eye_m);
  EXPECT_EQ(early.look_at_m, late.look_at_m);
  const auto hand = [&](const char* at) {
    return ComposePicture(stage.scenario, stage.run, {.at = {at, {}}, .camera = {"hand", {}}})
        .camera;
  };
  EXPECT_NE(hand("0.1").eye_m, hand("0.9").eye_m) << "it follows the hand";
}

}  // namespace
}  // namespace prehend::show
