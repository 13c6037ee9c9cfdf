// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/message_definition.h"

#include <gtest/gtest.h>

namespace prehend::exchange {
namespace {

using Many = DefinedField::Many;

constexpr const char* kHands = R"(# Two hands.
uint8 LEFT=0
string WHICH = left # or right
builtin_interfaces/Time stamp
Finger[5] fingers      # of the same package
other_msgs/msg/Palm palm
string<=20 name "no # name"
string<=10[<=3] labels
float32[<=4] forces [1.0, 2.0]
int64 count -1
================================================================================
MSG: hands/Finger
bool[] bends

float64 length
===
MSG: other_msgs/Palm
char a
byte b
wstring w
)";

TEST(MessageDefinition, TypesOfFieldsAreReadWithTheirSizes) {
  MessageDefinition definition;
  ASSERT_EQ(ReadDefinition("hands/msg/Hands", kHands, /*ros1=*/false, definition), "");
  ASSERT_EQ(definition.types.size(), 3u);
  const DefinedType& hands = definition.types[0];
  EXPECT_EQ(hands.name, "hands/Hands");
  struct Field {
    const char* name;
    Basic basic;
    Many many;
    std::uint32_t count;
  };
  const Field fields[] = {
      {"stamp", Basic::kTime, Many::kOne, 0},   {"fingers", Basic::kMessage, Many::kFixed, 5},
      {"palm", Basic::kMessage, Many::kOne, 0}, {"name", Basic::kText, Many::kOne, 0},
      {"labels", Basic::kText, Many::kAny, 3},  {"forces", Basic::kFloat32, Many::kAny, 4},
      {"count", Basic::kInt64, Many::kOne, 0}};
  ASSERT_EQ(hands.fields.size(), std::size(fields));
  for (std::size_t i = 0; i < std::size(fields); ++i) {
    EXPECT_EQ(hands.fields[i].name, fields[i].name);
    EXPECT_EQ(hands.fields[i].basic, fields[i].basic) << fields[i].name;
    EXPECT_EQ(hands.fields[i].many, fields[i].many) << fields[i].name;
    EXPECT_EQ(hands.fields[i].count, fields[i].count) << fields[i].name;
  }
  EXPECT_EQ(definition.types[1].name, "hands/Finger");
  EXPECT_EQ(definition.types[1].least_bytes, 12u);
  EXPECT_EQ(definition.types[2].least_bytes, 6u);
  EXPECT_EQ(hands.least_bytes, 8u + 5 * 12 + 6 + 4 + 4 + 4 + 8);
  EXPECT_FALSE(hands.same_size);
}

TEST(MessageDefinition, TypesThatEverybodyUsesMayBeMissing) {
  MessageDefinition ros1, ros2;
  ASSERT_EQ(ReadDefinition("a/B", "Header header\ngeometry_msgs/Pose pose", true, ros1), "");
  ASSERT_EQ(ReadDefinition("a/B", "std_msgs/Header header\ngeometry_msgs/Pose pose", false, ros2),
            "");
  EXPECT_EQ(ros1.types[0].least_bytes, 16u + 56);
  EXPECT_EQ(ros2.types[0].least_bytes, 12u + 56);
}

TEST(MessageDefinition, EveryFaultIsNamedWithItsLine) {
  std::string deep = "L1 a\n", many;
  for (int i = 1; i < 40; ++i)
    deep += "===\nMSG: a/L" + std::to_string(i) + "\nL" + std::to_string(i + 1) + " a\n";
  for (int i = 0; i < 6000; ++i) many += "int8 a\n";
  const std::pair<std::string, std::string> faults[] = {
      {"float64 x\ngeometry_msgs/Po",
       "its definition, line 2: expected a type and a name, found 'geometry_msgs/Po'"},
      {"float64 x\n\nPosed pose\n", "its definition, line 3: no type 'a/Posed' is in it"},
      {"b/C c\n===\nMSG: b/C\nint8 i\nD d\n===\nMSG: b/D\nC[] cs",
       "its definition, line 8: 'b/C' is in itself"},
      {"A a", "its definition, line 1: 'a/A' is in itself"},
      {"float64[9999999999] x",
       "its definition, line 1: expected a type, found "
       "'float64[9999999999]'"},
      {"float64[ x", "its definition, line 1: expected a type, found 'float64['"},
      {"float64[<=] x", "its definition, line 1: expected a type, found 'float64[<=]'"},
      {"float64[4000000000] x",
       "its definition, line 1: a message of more than 64 MiB; no more are read"},
      {"B[4000000] x\n===\nMSG: a/B\nC[4000000] y\n===\nMSG: a/C\nC[4000000] z\n",
       "its definition, line 7: 'a/C' is in itself"},
      {"float64 7up", "its definition, line 1: expected a name, found '7up'"},
      {"a$b c", "its definition, line 1: expected a type, found 'a$b'"},
      {"int8 a\n===\nint8 b",
       "its definition, line 3: expected 'MSG: ' and a type, found 'int8 b'"},
      {"int8 a\n===\n", "its definition: it is cut off: it ends before the next type"},
      {deep, "its definition, line 88: more than 30 types, one in another"},
      {many, "its definition: more than 5000 fields"}};
  for (const auto& [text, says] : faults) {
    MessageDefinition definition;
    EXPECT_EQ(ReadDefinition("a/A", text, /*ros1=*/true, definition), says) << text.substr(0, 100);
  }
}

}  // namespace
}  // namespace prehend::exchange
