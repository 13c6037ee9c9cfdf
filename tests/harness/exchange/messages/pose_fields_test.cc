// SPDX-License-Identifier: Apache-2.0
// What in messages of drivers counts as a pose, and how a map says which is meant.
#include "harness/exchange/messages/pose_fields.h"

#include <gtest/gtest.h>

namespace prehend::exchange {
namespace {

std::vector<PoseField> FieldsOfText(const std::string& text) {
  MessageDefinition definition;
  EXPECT_EQ(ReadDefinition("a/A", text, /*ros1=*/true, definition), "") << text;
  return LayoutOf(std::move(definition)).fields;
}

/// "bodies[].pose", with a ? after positions.
std::string Text(const PoseField& field) {
  std::string text;
  for (const PoseField::Step& step : field.steps)
    text += (text.empty() ? "" : ".") + step.field + (step.list ? "[]" : "");
  return field.oriented ? text : text + "?";
}

std::string AllFields(const std::string& text) {
  std::string all;
  for (const PoseField& field : FieldsOfText(text)) all += Text(field) + " ";
  return all;
}

constexpr const char* kFrame = R"(Header header
Body[] bodies
Skeleton[] skeletons
Marker[] labeled
geometry_msgs/Point[] others
===
MSG: a/Body
int32 id
string name
geometry_msgs/Pose pose
===
MSG: a/Skeleton
int32 id
Body[] bodies
===
MSG: a/Marker
int32 id
geometry_msgs/Point position
)";

TEST(PoseFields, WhatIsAPoseDependsOnNamesAndTypes) {
  const std::pair<std::string, std::string> cases[] = {
      {kFrame, "bodies[].pose skeletons[].bodies[].pose labeled[].position? others[]? "},
      {"geometry_msgs/PoseStamped p", "p.pose "},
      {"geometry_msgs/Transform left\ngeometry_msgs/Transform right", "left right "},
      {"geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation", " "},
      {"string name\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion q", " "},
      {"float32[3] position\nfloat32[4] q", " "},
      {"float32[3] position", "? "},
      {"uint32 id\nfloat32 x\nfloat32 y\nfloat32 z\nfloat32 qw\nfloat32 qx\nfloat32 qy\nfloat32 qz",
       " "},
      // Velocities, sizes, directions, what has no z, and orientations alone are no poses.
      {"geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular", ""},
      {"geometry_msgs/Quaternion orientation\ngeometry_msgs/Vector3 linear_acceleration", ""},
      {"float64 x\nfloat64 y\nfloat64 theta", ""},
      {"float64 x\nfloat64 y\nfloat64 z", ""},
      {"float64[36] covariance\nint32[3] position", ""}};
  for (const auto& [text, fields] : cases) EXPECT_EQ(AllFields(text), fields) << text;
}

TEST(PoseFields, TypesThatGrowWithoutEndCostLittle) {
  std::string text = "L1[] a\nL1[] b\n";
  for (int i = 1; i < 28; ++i) {
    const std::string next = i == 27 ? "geometry_msgs/Vector3" : "L" + std::to_string(i + 1);
    text += "===\nMSG: a/L" + std::to_string(i) + "\n" + next + "[] a\n" + next + "[] b\n";
  }
  EXPECT_EQ(AllFields(text), "") << "2^28 ways lead to no pose";
  text.replace(text.find("geometry_msgs/Vector3"), 21, "geometry_msgs/Pose");
  EXPECT_EQ(FieldsOfText(text).size(), kMostPoseFields);
}

TEST(BodyAddress, MeansTheFieldsThatItCan) {
  const std::vector<PoseField> fields = FieldsOfText(kFrame);
  const std::vector<std::pair<std::string, std::vector<std::size_t>>> cases = {
      {"[Cup]", {0}},
      {"[Arm][Cup]", {1}},
      {":bodies[Cup]", {0}},
      {":bodies[Cup].pose", {0}},
      {":skeletons[Arm].bodies[Cup]", {1}},
      {":labeled[3]", {2}},
      {":others[3]", {3}},
      {"", {}},
      {":bodies", {}},
      {":skeletons[Arm]", {}},
      {":header[Cup]", {}}};
  for (const auto& [text, meant] : cases) {
    const auto address = ParseBodyAddress(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(FieldsOf(*address, fields), meant) << text;
  }
  for (const char* text : {"[", "[Cup", "x", ":", ":.a", ":a..b", "[Cup]x", ":a[Cup]b", "]"})
    EXPECT_FALSE(ParseBodyAddress(text)) << text;
  EXPECT_EQ(ParseBodyAddress("[a[0]]")->keys, std::vector<std::string>{"a[0]"});
}

TEST(BodyAddress, TheShortestOneIsOffered) {
  const std::vector<PoseField> frame = FieldsOfText(kFrame);
  EXPECT_EQ(AddressOf("/f", frame, 0, {"Cup"}), "/f[Cup]");
  EXPECT_EQ(AddressOf("/f", frame, 1, {"Arm", "Cup"}), "/f[Arm][Cup]");
  EXPECT_EQ(AddressOf("/f", frame, 2, {"3"}), "/f:labeled[3]");
  const std::vector<PoseField> two =
      FieldsOfText("geometry_msgs/PoseStamped left\ngeometry_msgs/PoseStamped right");
  EXPECT_EQ(AddressOf("/f", two, 1, {}), "/f:right");
  EXPECT_EQ(FieldsOf(*ParseBodyAddress(""), two).size(), 2u);
}

}  // namespace
}  // namespace prehend::exchange
