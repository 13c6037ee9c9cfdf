// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/sense/episode_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/harness/scenario_fixture.h"

namespace prehend::episode {
namespace {

constexpr const char* kHeader =
    R"({"recording": 1, "episode": "cup", "ticks_per_second": 100, "styles": ["wrap", "pinch"], "entities": {)"
    R"("table": {"class": "Table", "fixed": true, "size_m": [1, 1, 0.1]}, "cup": {"class": "Cup", "size_m": [0.1, 0.1, 0.1]}, )"
    R"("hand": {"hand": true, "size_m": [0.1, 0.1, 0.03]}}})"
    "\n";

Result<Recording> ReadText(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("prehend_episode_" + std::to_string(getpid()) + ".jsonl");
  std::ofstream(file, std::ios::binary) << text;
  return ReadRecording(file.string());
}

/// Without the file's name.
std::string Complaint(const std::string& frames) {
  std::string all = scenario::Brief(ErrorsOf(ReadText(kHeader + frames)));
  return all.substr(std::min(all.find(".jsonl:"), all.size() - 7) + 7);
}

TEST(EpisodeFile, WhatIsLeftOutHasADefault) {
  const auto episode = ReadText(
      std::string(kHeader) +
      R"({"tick": 0, "samples": {"cup": {"at_m": [0, 0, 1]}, "hand": {"at_m": [0, 0, 2]}}, "hands": {"hand": {}}})"
      "\n"
      R"({"tick": 10, "samples": {"cup": {"at_m": [0, 0, 1.2]}}, )"
      R"("touches": [{"a": "hand", "b": "cup", "up_on_a": 0.5, "sensor_sets": ["thumb"]}]})");
  ASSERT_TRUE(episode) << scenario::Brief(ErrorsOf(episode));
  const EpisodeFrame& last = episode->frames[1];
  EXPECT_DOUBLE_EQ(last.entities[1].v_WB_m_per_s.z(), 2);
  EXPECT_EQ(last.entities[2].p_WB_m.z(), 2) << "what is not mentioned stays where it was";
  EXPECT_EQ(last.touches[0].a, 1) << "the pair is in the order of the entities";
  EXPECT_EQ(last.touches[0].up_on_b, 0.5);
  EXPECT_EQ(last.touches[0].up_on_a, -0.5);
  EXPECT_EQ(last.touches[0].sensor_sets, 2u);
  EXPECT_EQ(last.collision_spheres[0].size(), 1u);
  EXPECT_EQ(episode->end_tick, 11);
  EXPECT_EQ(episode->header.grammar, "pick_and_place");
}

TEST(EpisodeFile, AHandWithoutSurfaceIsWhereItsSampleIs) {
  const auto episode = ReadText(
      std::string(kHeader) +
      R"({"tick": 0, "samples": {"hand": {"at_m": [0, 0, 1]}}})"
      "\n"
      R"({"tick": 10, "samples": {"hand": {"at_m": [0, 0, 2], "quat_wxyz": [0, 0, 0, 1]}}})"
      "\n"
      R"({"tick": 20, "hands": {"hand": {"ahead": [0, 1, 0], "collision_spheres_m": [[0, 0, 3, 0.1]]}}})"
      "\n"
      R"({"tick": 30, "samples": {"hand": {"at_m": [0, 0, 4]}}})");
  ASSERT_TRUE(episode) << scenario::Brief(ErrorsOf(episode));
  const auto sphere = [&](std::size_t frame) {
    const auto& spheres = episode->frames[frame].collision_spheres[0];
    EXPECT_EQ(spheres.size(), 1u);
    return spheres.empty() ? -1 : spheres[0].p_W_m.z();
  };
  EXPECT_EQ(sphere(0), 1) << "never mentioned among the hands";
  EXPECT_EQ(sphere(1), 2);
  EXPECT_EQ(sphere(2), 3);
  EXPECT_EQ(sphere(3), 3) << "what was given stays";
  EXPECT_EQ(episode->frames[0].hands[0].ahead_W, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(episode->frames[1].hands[0].ahead_W.isApprox(-Eigen::Vector3d::UnitX()));
  EXPECT_EQ(episode->frames[3].hands[0].ahead_W, Eigen::Vector3d::UnitY());
}

TEST(EpisodeFile, IsReadAsItWasWritten) {
  const auto read = ReadText(
      std::string(kHeader) +
      R"({"tick": 3, "samples": {"cup": {"at_m": [0.1, 0.2, 0.3], "quat_wxyz": [0.6, 0.8, 0, 0], "asleep": true, "joint_fraction": 0.25}}, )"
      R"("hands": {"hand": {"trigger": 0.4, "style": "pinch", "ahead": [0, 0, -1], "collision_spheres_m": [[1, 2, 3, 0.01]]}}, )"
      R"("touches": [{"a": "cup", "b": "table", "up_on_a": 1, "force_n": 2, "at_m": [0.1, 0.2, 0.25], "normal": [0, 0, 1]}]})"
      "\n{\"end_tick\": 9}\n");
  ASSERT_TRUE(read) << scenario::Brief(ErrorsOf(read));
  Recording episode = *read;
  std::ostringstream written;
  EpisodeWriter writer(written, episode.header);
  episode.frames[0].entities[1].v_WB_m_per_s = {-1e-7, 2.0 / 3, -0.0};
  for (EpisodeFrame& frame : episode.frames) writer.Write(frame.View());
  writer.Finish(episode.end_tick);
  std::istringstream lines(written.str());
  for (std::string line; std::getline(lines, line);)
    EXPECT_EQ(nlohmann::ordered_json::parse(line).dump(), line);
  const auto again = ReadText(written.str());
  ASSERT_TRUE(again) << scenario::Brief(ErrorsOf(again));
  EXPECT_EQ(again->end_tick, 9);
  const EpisodeFrame &a = episode.frames[0], &b = again->frames[0];
  EXPECT_EQ(b.entities[1].p_WB_m, a.entities[1].p_WB_m);
  EXPECT_TRUE(b.entities[1].q_WB.isApprox(a.entities[1].q_WB));
  EXPECT_TRUE(b.entities[1].asleep);
  EXPECT_EQ(b.entities[1].joint_fraction, 0.25);
  EXPECT_EQ(b.hands[0].style, 1);
  EXPECT_EQ(b.hands[0].trigger, 0.4);
  EXPECT_EQ(b.collision_spheres[0][0].radius_m, 0.01);
  EXPECT_EQ(b.touches[0].up_on_b, 1);
  EXPECT_EQ(b.touches[0].p_W_m, Eigen::Vector3d(0.1, 0.2, 0.25));
  EXPECT_EQ(b.touches[0].nhat_BA_W, Eigen::Vector3d(0, 0, -1)) << "on the first of the two";
  EXPECT_EQ(b.touches[0].normal_force_n, 2);
}

TEST(EpisodeFile, ClassesAndPartsOfAreReadAsTheyWereWritten) {
  const auto read = ReadText(
      R"({"recording": 1, "episode": "cup", "ticks_per_second": 100, "entities": {)"
      R"("mug": {"class": "Mug", "kinds": ["Cup", "Container"], "size_m": [0.1, 0.1, 0.1]}, )"
      R"("drawer": {"class": "Drawer", "kinds": ["Container"], "jointed": true, "part_of": "chest", "size_m": [0.4, 0.4, 0.1]}, )"
      R"("chest": {"fixed": true, "size_m": [0.5, 0.5, 1]}, )"
      R"("anna": {"class": "Person", "person": true, "size_m": [0.2, 0.2, 0.2]}, )"
      R"("bob": {"person": true, "size_m": [0.2, 0.2, 0.2]}, )"
      R"("anna_neck": {"class": "Neck", "person": true, "part_of": "anna", "size_m": [0.1, 0.1, 0.1]}, )"
      R"("hand": {"hand": true, "part_of": "anna", "size_m": [0.1, 0.1, 0.03]}}})"
      "\n{\"tick\": 0}\n");
  ASSERT_TRUE(read) << scenario::Brief(ErrorsOf(read));
  std::ostringstream written;
  EpisodeWriter writer(written, read->header);
  Recording episode = *read;
  writer.Write(episode.frames[0].View());
  const auto again = ReadText(written.str());
  ASSERT_TRUE(again) << scenario::Brief(ErrorsOf(again)) << written.str();
  using Classes = std::vector<std::string>;
  for (const auto& one : {read, again}) {
    const auto& entities = one->header.entity_table.entities;
    ASSERT_EQ(entities.size(), 7u);
    std::map<std::string, const grammar::EntityInfo*> named;
    for (const auto& entity : entities) named[entity.name] = &entity;
    EXPECT_EQ(named["mug"]->classes,
              (Classes{"Mug", "Cup", "Container", "Movable", "Thing", "Entity"}));
    EXPECT_EQ(named["drawer"]->classes,
              (Classes{"Drawer", "Container", "Jointed", "Thing", "Entity"}));
    EXPECT_EQ(named["chest"]->classes, (Classes{"Object", "Fixed", "Thing", "Entity"}));
    EXPECT_EQ(named["anna"]->classes, (Classes{"Person", "Entity"}));
    EXPECT_EQ(named["bob"]->classes, (Classes{"Object", "Person", "Entity"})) << "by its key";
    EXPECT_EQ(named["anna_neck"]->classes, (Classes{"Neck", "BodyPart", "Entity"}));
    EXPECT_EQ(named["hand"]->classes, (Classes{"Hand", "Entity"}));
    EXPECT_EQ(&entities[static_cast<std::size_t>(named["drawer"]->part_of)], named["chest"]);
    EXPECT_EQ(&entities[static_cast<std::size_t>(named["hand"]->part_of)], named["anna"]);
    EXPECT_EQ(named["mug"]->part_of, grammar::kNoEntity);
  }
}

/// A recording of a cup with these parts, and one frame.
std::string CupOf(const std::string& parts) {
  return R"({"recording": 1, "episode": "cup", "ticks_per_second": 100, "entities": {"cup": {"size_m": [1, 1, 1], "parts": )" +
         parts + "}}}\n{\"tick\": 0}\n";
}

TEST(EpisodeFile, PartsAreReadAsTheyWereWritten) {
  const auto read = ReadText(CupOf(
      R"([{"box": {"size_m": [0.2, 0.2, 0.02]}, "at_m": [0, 0, 0.01]}, )"
      R"({"cylinder": {"radius_m": 0.1, "length_m": 0.4}, "at_m": [1, 0, 0], "quat_wxyz": [0, 0.6, 0, 0.8]}, )"
      R"({"capsule": {"radius_m": 0.01, "length_m": 0.3}}, {"sphere": {"radius_m": 0.05}, "at_m": [0, 2, 0]}, )"
      R"({"hull": {"points_m": [[0, 0, 3], [0.1, 0, 3], [0, 0.1, 3], [0, 0, 3.1]]}}])"));
  ASSERT_TRUE(read) << scenario::Brief(ErrorsOf(read));
  std::ostringstream written;
  EpisodeWriter writer(written, read->header);
  Recording episode = *read;
  writer.Write(episode.frames[0].View());
  const auto again = ReadText(written.str());
  ASSERT_TRUE(again) << scenario::Brief(ErrorsOf(again)) << written.str();
  for (const auto& one : {read, again}) {
    const grammar::Solid& solid = one->header.entity_table.entities[0].solid;
    ASSERT_EQ(solid.parts().size(), 5u);
    EXPECT_NEAR(solid.DistanceTo({0.1, 0.1, 0.05}), 0.03, 1e-9) << "the box";
    EXPECT_NEAR(solid.DistanceTo({1 - 0.96 * 0.3, 0, -0.28 * 0.3}), 0.1, 1e-9) << "the cylinder";
    EXPECT_NEAR(solid.DistanceTo({0, 0, 0.2}), 0.04, 1e-9) << "the capsule";
    EXPECT_NEAR(solid.DistanceTo({0, 2.25, 0}), 0.2, 1e-9) << "the sphere";
    EXPECT_NEAR(solid.DistanceTo({0, 0, 3.3}), 0.2, 1e-9) << "the hull";
  }
}

TEST(EpisodeFile, WithoutPartsAnEntityIsItsBoundingBox) {
  const auto read = ReadText(std::string(kHeader) + "{\"tick\": 0}\n");
  ASSERT_TRUE(read) << scenario::Brief(ErrorsOf(read));
  EXPECT_TRUE(read->header.entity_table.entities[1].solid.IsEmpty());
}

TEST(EpisodeFile, BadPartsHaveTheirPlace) {
  const auto complaint = [](const std::string& parts) {
    const std::string all = scenario::Brief(ErrorsOf(ReadText(CupOf(parts))));
    return all.substr(std::min(all.find(".jsonl:"), all.size() - 7) + 7);
  };
  EXPECT_EQ(complaint("[]"), "1:112: parts: expected at least 1 item, found 0\n");
  EXPECT_EQ(complaint(R"([{"sphere": {"radius_m": -1}}])"),
            "1:137: radius_m: expected a number from 0 to 10000, found '-1'\n");
  EXPECT_EQ(complaint("[{}]"),
            "1:113: a part needs one of the keys box, sphere, cylinder, capsule, hull\n");
  EXPECT_EQ(complaint(R"([{"sphere": {"radius_m": 1}, "box": {"size_m": [1, 1, 1]}}])"),
            "1:141: a part cannot have both 'sphere' and 'box'\n");
  EXPECT_EQ(complaint(R"([{"cylinder": {"radius_m": 1}}])"),
            "1:114: a cylinder needs the key 'length_m'\n");
  EXPECT_EQ(complaint(R"([{"hull": {"points_m": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}}])"),
            "1:135: points_m: expected at least 4 items, found 3\n");
  EXPECT_EQ(
      complaint(R"([{"sphere": {"radius_m": 1}, "quat_wxyz": [1, 1, 0, 0]}])"),
      "1:154: quat_wxyz: expected a unit quaternion [w, x, y, z], found one of length 1.414\n");
  std::string many = R"({"sphere": {"radius_m": 1}})";
  for (int i = 0; i < 256; ++i) many += R"(, {"sphere": {"radius_m": 1}})";
  EXPECT_EQ(complaint("[" + many + "]"), "1:112: parts: expected at most 256 items, found 257\n");
}

TEST(EpisodeFile, WhatIsNoJsonHasItsRealCause) {
  EXPECT_EQ(Complaint("{\"tick\": 0, \"samples\": {\"cup\": {\"at_m\": [0, 0,"),
            "2:46: the line ends within a value | if it is the last line, the file was cut off\n");
  EXPECT_EQ(Complaint("{\"tick\": 0, \"samples\": [}"),
            "2:25: not valid JSON: unexpected text here | each line is one JSON object\n");
}

// A recording is refused what a scenario or a hand file is refused.
TEST(EpisodeFile, WhatCannotBeIsRefused) {
  const auto complaint = [](const std::string& entities) {
    const std::string header =
        R"({"recording": 1, "episode": "x", "ticks_per_second": 100, "entities": {)" + entities +
        "}}\n{\"tick\": 1}\n";
    const std::string all = scenario::Brief(ErrorsOf(ReadText(header)));
    return all.substr(std::min(all.find(": "), all.size() - 2) + 2);
  };
  EXPECT_EQ(complaint(R"("a": {"class": "A", "size_m": [1, 1, 1], "part_of": "b"}, )"
                      R"("b": {"class": "B", "size_m": [1, 1, 1], "part_of": "a"})"),
            "'a' is a part of itself\n");
  EXPECT_EQ(
      complaint(R"("a": {"class": "Hand", "size_m": [1, 1, 1]})"),
      "'a': the class 'Hand' is built in, and by its keys it is Movable | say it by keys, like "
      "'fixed' or 'hand'; name your own classes otherwise\n");
  for (const char* wrong : {R"("class": "Fixed")", R"("class": "Region")", R"("kinds": ["Hand"])",
                            R"("class": "Movable", "fixed": true)", R"("class": "Person")",
                            R"("abstract": "Region", "class": "Thing")"})
    EXPECT_NE(complaint(std::string(R"("a": {"size_m": [1, 1, 1], )") + wrong + "}")
                  .find("is built in, and by its keys it is "),
              std::string::npos)
        << wrong;
  for (const char* right :
       {R"("class": "Fixed", "fixed": true)", R"("class": "Thing")",
        R"("class": "Person", "person": true)", R"("abstract": "Region", "class": "Region")",
        R"("class": "Cup", "kinds": ["Movable"])"})
    EXPECT_EQ(complaint(std::string(R"("a": {"size_m": [1, 1, 1], )") + right + "}"), "") << right;
  EXPECT_EQ(complaint(R"("a": {"class": "A", "size_m": [1, 1, 1], "kinds": ["B", "B"]})"),
            "'a': the kind 'B' is given twice\n");
  EXPECT_EQ(complaint(R"("any": {"class": "A", "size_m": [1, 1, 1]})"),
            "'any': this name stands for everybody, in claims and queries\n");
  EXPECT_EQ(complaint(R"("r": {"abstract": "Region", "round": true, "size_m": [1, 1, 1]})"), "");
  EXPECT_EQ(complaint(R"("r": {"abstract": "Region", "round": true, "size_m": [1, 1, 2]})"),
            "'r': round: it is a ball, and its edges are 1, 1 and 2 m | size_m: three times its "
            "diameter\n");
  EXPECT_EQ(complaint(R"("h": {"hand": true, "size_m": [1, 1, 1], "sensor_sets": ["t", "t"]})"),
            "'h': the sensor set 't' is given twice\n");
  EXPECT_NE(Complaint("{\"tick\": 1}\n{\"end_tick\": 5}\n{\"end_tick\": 6}\n")
                .find("a second line with 'end_tick'"),
            std::string::npos);
  EXPECT_NE(Complaint("{\"tick\": 1, \"hands\": {\"hand\": {\"ahead\": [0, 0, 0]}}}\n")
                .find("'hand': ahead: expected a direction, found [0, 0, 0]"),
            std::string::npos);
  EXPECT_NE(
      Complaint(
          "{\"tick\": 1, \"hands\": {\"hand\": {\"collision_spheres_m\": [[0, 0, 0, -1]]}}}\n")
          .find("'hand': a collision sphere of radius -1"),
      std::string::npos);
}

TEST(EpisodeFile, ComplaintsHaveTheirPlace) {
  EXPECT_EQ(
      Complaint(""),
      "1:1: the recording has no frames | each line after the first is one: {\"tick\": 0, ...}\n");
  EXPECT_EQ(Complaint("{\"tick\": 1}\n{\"tick\": 1}\n"),
            "3:10: the ticks must increase: 1 comes after 1\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"samples\": {\"cip\": {\"at_m\": [0, 0, 0]}}}\n"),
            "2:25: no entity is called 'cip' | did you mean 'cup'?\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"hands\": {\"cup\": {}}}\n"),
            "2:23: 'cup' is not a hand | its entity has no 'hand: true'\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"touches\": [{\"a\": \"cup\", \"b\": \"cup\"}]}\n"),
            "2:43: 'cup' cannot touch itself\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"touches\": [{\"a\": \"cup\", \"b\": \"table\"}, {\"a\": "
                      "\"table\", \"b\": \"cup\"}]}\n"),
            "2:59: the touch of 'table' and 'cup' is given twice\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"toches\": []}\n"),
            "2:13: unknown key 'toches' in a frame | did you mean 'touches'?\n");
  EXPECT_EQ(Complaint("{\"tick\": 1, \"looks\": {}}\n"),
            "2:13: unknown key 'looks' in a frame | it is called 'samples' now\n");
  EXPECT_EQ(
      Complaint("{\"tick\": 1, \"hands\": {\"hand\": {\"feelers_m\": [[0, 0, 0, 1]]}}}\n"),
      "2:32: unknown key 'feelers_m' in hand 'hand' | it is called 'collision_spheres_m' now\n");
  EXPECT_EQ(Complaint("{\"tick\": 1}\n{\"end_tick\": 1}\n"),
            "3:14: end_tick: expected more than 1, the tick of the last frame, found 1\n");
  EXPECT_NE(Complaint("{\"tick\": 1, \"samples\": {\"cup\": {\"at_m\": [0, 0, 1e99]}}}\n")
                .find(" at_m[2]: expected a number"),
            std::string::npos);
  EXPECT_NE(Complaint("{\"tick\": 1").find("2:"), std::string::npos);
  EXPECT_NE(scenario::Brief(ErrorsOf(ReadText(""))).find("1:1: the file is empty"),
            std::string::npos);
}

}  // namespace
}  // namespace prehend::episode
