// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/column_names.h"

#include <gtest/gtest.h>

namespace prehend::exchange {
namespace {

using Names = std::vector<std::string>;

NamedColumns Of(const std::string& text) {
  const auto columns = ColumnsOf(text);
  EXPECT_TRUE(columns) << text;
  return columns.value_or(NamedColumns{});
}

TEST(ColumnNames, AreSpelledInManyWays) {
  const struct {
    const char* head;
    Names position, orientation;
  } all[] = {
      {"t,Cup_x,Cup_y,Cup_z,Hand_x,Hand_y,Hand_z", {"{}_x", "{}_y", "{}_z"}, {}},
      {"t,left_hand_x,left_hand_y,left_hand_z,right_hand_x,right_hand_y,right_hand_z",
       {"{}_x", "{}_y", "{}_z"},
       {}},
      {"t,Cup X,Cup Y,Cup Z,Cup QX,Cup QY,Cup QZ,Cup QW,B X,B Y,B Z,B QX,B QY,B QZ,B QW",
       {"{} X", "{} Y", "{} Z"},
       {"{} QX", "{} QY", "{} QZ", "{} QW"}},
      {"t,CupPosX,CupPosY,CupPosZ,HandPosX,HandPosY,HandPosZ", {"{}PosX", "{}PosY", "{}PosZ"}, {}},
      {"t,x_cup,y_cup,z_cup,x_hand,y_hand,z_hand", {"x_{}", "y_{}", "z_{}"}, {}},
      {"t,cup.pose.position.x,cup.pose.position.y,cup.pose.position.z,cup.pose.orientation.x,"
       "cup.pose.orientation.y,cup.pose.orientation.z,cup.pose.orientation.w,h.pose.position.x,"
       "h.pose.position.y,h.pose.position.z,h.pose.orientation.x,h.pose.orientation.y,"
       "h.pose.orientation.z,h.pose.orientation.w",
       {"{}.position.x", "{}.position.y", "{}.position.z"},
       {"{}.orientation.x", "{}.orientation.y", "{}.orientation.z", "{}.orientation.w"}},
      // One letter is a kind of values, or the side of a hand.
      {"t,hand_r_x,hand_r_y,hand_r_z,hand_l_x,hand_l_y,hand_l_z", {"{}_x", "{}_y", "{}_z"}, {}},
      {"t,Hand R X,Hand R Y,Hand R Z,Hand R RX,Hand R RY,Hand R RZ,Cup X,Cup Y,Cup Z,Cup RX,Cup "
       "RY,Cup RZ",
       {"{} X", "{} Y", "{} Z"},
       {"{} RX", "{} RY", "{} RZ"}},
      {"t,a_t_x,a_t_y,a_t_z,a_r_x,a_r_y,a_r_z,b_t_x,b_t_y,b_t_z,b_r_x,b_r_y,b_r_z",
       {"{}_t_x", "{}_t_y", "{}_t_z"},
       {"{}_r_x", "{}_r_y", "{}_r_z"}},
      {"t,a_x,a_y,a_z,a_roll,a_pitch,a_yaw,b_x,b_y,b_z,b_roll,b_pitch,b_yaw",
       {"{}_x", "{}_y", "{}_z"},
       {"{}_roll", "{}_pitch", "{}_yaw"}},
      // Of one body: as they are.
      {"time,pos_x,pos_y,pos_z,qw,qx,qy,qz", {"pos_x", "pos_y", "pos_z"}, {"qx", "qy", "qz", "qw"}},
  };
  for (const auto& one : all) {
    const NamedColumns columns = Of(std::string(one.head) + "\n0,1,2,3\n");
    EXPECT_EQ(columns.position, one.position) << one.head;
    EXPECT_EQ(columns.orientation, one.orientation) << one.head;
    EXPECT_EQ(columns.header_line, 1);
  }
}

TEST(ColumnNames, TimesAndTheirUnits) {
  const std::string head = ",x,y,z\n";
  const auto unit = [&](const std::string& name, const std::string& first,
                        const std::string& second) {
    return Of(name + head + first + ",0,0,0\n" + second + ",0,0,0\n").time_unit;
  };
  EXPECT_EQ(unit("t", "0", "0.01"), "s");
  EXPECT_EQ(unit("time_ms", "0", "0.01"), "ms");
  EXPECT_EQ(unit("Time (Seconds)", "0", "0.01"), "s");
  EXPECT_EQ(unit("ms", "0", "0.5"), "ms");
  EXPECT_EQ(unit("unix_ms", "1780000000000", "1780000000020"), "ms");
  EXPECT_EQ(unit("epoch", "1780000000.00", "1780000000.02"), "s");
  EXPECT_EQ(unit("timestamp", "1000", "1016"), "ms");
  EXPECT_EQ(unit("timestamp", "1000000", "1016000"), "us");
  EXPECT_EQ(unit("timestamp [ns]", "0", "1"), "ns");
  EXPECT_EQ(unit("timestamp", "1403636579758555392", "1403636579763555328"), "ns");
  EXPECT_EQ(unit("time", "2026-01-31T10:00:00.25Z", "2026-01-31T10:00:00.26Z"), "iso");
  EXPECT_EQ(unit("Frame", "0", "1"), "frame");
  EXPECT_EQ(Of("a,x,y,z\n1,1,1,1\n").time, "");
}

TEST(ColumnNames, SeparatorsHeadsKeysAndUnits) {
  const NamedColumns own = Of("# by us\n\nt;name;x [mm];y [mm];z [mm];note\n0,5;a;1,5;2;3;-\n");
  EXPECT_EQ(own.separator, Separator::kSemicolon);
  EXPECT_TRUE(own.decimal_comma);
  EXPECT_EQ(own.header_line, 3);
  EXPECT_EQ(own.unit, "mm");
  EXPECT_EQ(own.keys, Names{"name"});
  EXPECT_EQ(own.others, Names{"note"});
  const NamedColumns landmarks = Of("frame,hand,landmark,x,y,z\n0,Left,0,1,2,3\n0,Left,1,1,2,3\n");
  EXPECT_EQ(landmarks.keys, (Names{"hand", "landmark"}));
  EXPECT_EQ(Of("t x y z rx ry rz\n0 1 2 3 90 0 0\n").form, OrientationForm::kEuler);
  EXPECT_TRUE(Of("t x y z rx ry rz\n0 1 2 3 90 0 0\n").in_degrees);
  EXPECT_EQ(Of("t,head_r_x,head_r_y,head_r_z,cup_x,cup_y,cup_z\n0,1,2,3,1,2,3\n").position,
            (Names{"cup_x", "cup_y", "cup_z"}));
  // Bodies whose columns are called in another way are left aside, and said.
  EXPECT_EQ(Of("t,a_x,a_y,a_z,b_x,b_y,b_z,c.x,c.y,c.z\n0,1,2,3,1,2,3,1,2,3\n").others,
            (Names{"c.x", "c.y", "c.z"}));
  // These are read: one is the body "c_pos", the other is called R, and is no rotation.
  EXPECT_EQ(Of("t,a_x,a_y,a_z,b_x,b_y,b_z,c_pos_x,c_pos_y,c_pos_z\n0,1,2,3,1,2,3,1,2,3\n").others,
            Names{});
  EXPECT_EQ(Of("t,R_x,R_y,R_z,C_x,C_y,C_z,B_x,B_y,B_z\n0,1,2,3,1,2,3,1,2,3\n").others, Names{});
  EXPECT_FALSE(ColumnsOf("when,what\n1,2\n"));
  EXPECT_FALSE(ColumnsOf("1,2,3\n4,5,6\n"));
  EXPECT_FALSE(ColumnsOf(""));
}

}  // namespace
}  // namespace prehend::exchange
