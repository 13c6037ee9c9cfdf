// SPDX-License-Identifier: Apache-2.0
// The table on a small struct of its own: what is read, what is refused, what the schema says.
#include "harness/base/yaml/struct_format.h"

#include <gtest/gtest.h>

#include "tests/harness/scenario_fixture.h"

namespace prehend {
namespace {

enum class Material { kWood, kSteel };

struct Hub {
  double radius_m = 0.02;
};

struct Wheel {
  Where where;
  double radius_m = 0;
  int spokes = 12;
  Material material = Material::kWood;
  bool spins = true;
  std::optional<Located<std::string>> label;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  Hub hub;
  std::vector<Named<double>> loads_kg;
};

ValueFormat<Wheel> WheelFormat() {
  return StructFormat<Wheel>("a wheel")
      .Required("radius_m", &Wheel::radius_m, Number(0.01, 2), "Distance from axle to tread.")
      .Optional("spokes", &Wheel::spokes, Integer<int>(0, 100), "How many.")
      .Optional("material", &Wheel::material,
                Choice<Material>({{"wood", Material::kWood}, {"steel", Material::kSteel}}),
                "Of what.")
      .Optional("spins", &Wheel::spins, Flag(), "Does it turn.")
      .Optional("label", &Wheel::label, Text(), "On it.")
      .Optional("axis", &Wheel::axis, Vector<3>(-1, 1), "Unit vector.")
      .Optional("hub", &Wheel::hub,
                StructFormat<Hub>("a hub")
                    .Optional("radius_m", &Hub::radius_m, Number(0, 1), "Radius.")
                    .format(),
                "Hub.")
      .Optional("loads_kg", &Wheel::loads_kg, MapOf(Identifier(), Number(0, 9), 0, 2), "By name.")
      .AtMostOneOf({"spokes", "label"})
      .format();
}

Result<Wheel> ReadWheel(const std::string& text) {
  auto document = ParseYaml("probe.yaml", text);
  EXPECT_TRUE(document) << grammar::Format(ErrorsOf(document));
  DiagnosticList errors(*document);
  Wheel wheel;
  WheelFormat().Read(document->root, errors, wheel);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return wheel;
}

TEST(FieldTable, ReadsEveryKindOfField) {
  const auto read = ReadWheel(
      "radius_m: 0.5\nmaterial: steel\nspins: false\nlabel: 'front'\naxis: [0, 0, 1]\nhub: "
      "{radius_m: 0.1}\n"
      "loads_kg: {b: 1, a: 2}\n");
  ASSERT_TRUE(read) << grammar::Format(ErrorsOf(read));
  const Wheel& wheel = *read;
  EXPECT_EQ(wheel.radius_m, 0.5);
  EXPECT_EQ(wheel.spokes, 12) << "the default of the struct";
  EXPECT_EQ(wheel.material, Material::kSteel);
  EXPECT_FALSE(wheel.spins);
  EXPECT_EQ(wheel.label->value, "front");
  EXPECT_EQ(wheel.label->where.place.line, 4);
  EXPECT_EQ(wheel.axis, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(wheel.hub.radius_m, 0.1);
  ASSERT_EQ(wheel.loads_kg.size(), 2u);
  EXPECT_EQ(wheel.loads_kg[0].name, "b") << "the order of the file";
  EXPECT_EQ(wheel.where.place.line, 1);
}

TEST(FieldTable, CollectsAllComplaintsSortedByPlace) {
  EXPECT_EQ(
      scenario::Brief(ErrorsOf(
          ReadWheel("material: stel\nspokes: 1.5\naxis: [0, 2]\nweight: 3\nloads_kg: {A: 10}\n"))),
      "1:1: a wheel needs the key 'radius_m'\n"
      "1:11: material: expected one of wood, steel, found 'stel' | did you mean 'steel'?\n"
      "2:9: spokes: expected a whole number from 0 to 100, found '1.5'\n"
      "3:7: axis: expected 3 items, found 2\n"
      "4:1: unknown key 'weight' in a wheel | known: radius_m, spokes, material, spins, label, "
      "axis, hub, loads_kg\n"
      "5:12: expected a name like 'milk_carton', found 'A' | write 'a': small letters, digits and "
      "'_'\n"
      "5:15: A: expected a number from 0 to 9, found '10'\n");
}

TEST(FieldTable, AMisspeltRequiredKeyIsOneComplaint) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(ReadWheel("radius_mm: 5\n"))),
            "1:1: unknown key 'radius_mm' in a wheel | did you mean 'radius_m'?\n");
}

TEST(FieldTable, ACommaInBracesWantsQuotes) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(ReadWheel("{radius_m: 1, label: near(hub, rim)}"))),
            "1:32: unknown key 'rim)' in a wheel | in {..} a comma ends a value: put one with a "
            "comma in quotes\n");
}

TEST(FieldTable, ExclusiveKeys) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(ReadWheel("radius_m: 1\nspokes: 3\nlabel: x\n"))),
            "3:1: a wheel cannot have both 'spokes' and 'label'\n");
}

TEST(FieldTable, TheDocumentMustBeAMapping) {
  EXPECT_EQ(scenario::Brief(ErrorsOf(ReadWheel("- 1\n"))),
            "1:1: expected a mapping with the fields of a wheel, found a list\n");
}

TEST(FieldTable, TheSchemaIsMadeOnceAndOnlyWhenItIsAskedFor) {
  int made = 0;
  const ValueFormat<double> format(
      [&made] {
        ++made;
        return Json{{"type", "number"}};
      },
      [](const YamlNode&, DiagnosticList&, double& value) {
        value = 5;
        return true;
      });
  const auto list = ListOf(format, 1, 2);
  const auto document = ParseYaml("probe.yaml", "- 1\n");
  ASSERT_TRUE(document);
  DiagnosticList errors(*document);
  std::vector<double> read;
  ASSERT_TRUE(list.Read(document->root, errors, read));
  EXPECT_EQ(read, std::vector<double>{5});
  EXPECT_EQ(made, 0);
  EXPECT_EQ(list.schema().json()["items"], format.schema().json());
  EXPECT_EQ(AnyOf({format.schema(), format.schema()}).json()["anyOf"].size(), 2u);
  EXPECT_EQ(made, 1);
}

TEST(FieldTable, TheSchemaSaysTheSame) {
  const Json schema = WheelFormat().schema().json();
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], Json({"radius_m"}));
  EXPECT_EQ(schema["properties"]["radius_m"], Json({{"description", "Distance from axle to tread."},
                                                    {"type", "number"},
                                                    {"minimum", 0.01},
                                                    {"maximum", 2.0}}));
  EXPECT_EQ(schema["properties"]["spokes"]["default"], 12);
  EXPECT_EQ(schema["properties"]["material"]["default"], "wood");
  EXPECT_EQ(schema["properties"]["material"]["enum"], Json({"wood", "steel"}));
  EXPECT_EQ(schema["properties"]["axis"]["default"], Json({0.0, 1.0, 0.0}));
  EXPECT_FALSE(schema["properties"]["label"].contains("default"));
  EXPECT_EQ(schema["allOf"].dump(), R"([{"not":{"required":["spokes","label"]}}])");
}

}  // namespace
}  // namespace prehend
