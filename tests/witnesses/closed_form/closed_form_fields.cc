// SPDX-License-Identifier: Apache-2.0
// Tested by tests/witnesses/closed_form/read_closed_form_test.cc
#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"
#include "tests/witnesses/closed_form/closed_form_yaml.h"

namespace prehend::witnesses {
namespace {

constexpr std::size_t kMaxFormulaBytes = 400;
constexpr std::size_t kMaxNames = 100;
constexpr std::size_t kMaxKinematicEntities = 50;
constexpr std::size_t kMaxKinematicHands = 4;
constexpr std::size_t kMaxSides = 8;
constexpr std::size_t kMaxTouches = 100;
constexpr std::size_t kMaxSamplings = 12;
constexpr std::size_t kMaxKnownEvents = 200;
constexpr double kMaxRecording_s = 60;
constexpr double kMaxPart_m = 1;

/// A number, or text; whether it is a formula is found where it is computed.
ValueFormat<FormulaYaml> FormulaText() {
  return ValueFormat<FormulaYaml>(
      []() -> Json {
        return {{"type", {"number", "string"}}, {"maxLength", kMaxFormulaBytes}};
      },
      [](const YamlNode& node, DiagnosticList& errors, FormulaYaml& formula) {
        if (node.kind != YamlNode::Kind::kScalar || node.text.empty() ||
            node.text.size() > kMaxFormulaBytes)
          return ReportExpected(
              node, errors, "a formula of at most " + std::to_string(kMaxFormulaBytes) + " bytes");
        formula = {node.text, node.where};
        if (node.quoted) ++formula.where.place.column;
        return true;
      });
}

ValueFormat<VectorFormula> FormulaVector() { return ListOf(FormulaText(), 3, 3); }

ValueFormat<MotionYaml> MotionFormat() {
  using M = MotionYaml;
  return StructFormat<M>("a motion")
      .Optional("by_m", &M::by_m, FormulaVector(), "Displacement from where it is placed.")
      .Optional("rpy_deg", &M::rpy_deg, FormulaVector(),
                "Roll, pitch and yaw in degrees; default: as it is placed.")
      .format();
}

ValueFormat<HandSideYaml> HandSideFormat() {
  using S = HandSideYaml;
  return StructFormat<S>("a side of a hand")
      .Optional("size_m", &S::size_m, Vector<3>(0.001, kMaxPart_m), "Full edge lengths.")
      .Optional("at_m", &S::at_m, FormulaVector(),
                "Its middle in the hand's frame; default: the palm's.")
      .format();
}

ValueFormat<KinematicHandYaml> KinematicHandFormat() {
  using H = KinematicHandYaml;
  return StructFormat<H>("hand")
      .NamedByKey()
      .Required("at_m", &H::at_m, FormulaVector(), "Where the palm's centre is.")
      .Optional("rpy_deg", &H::rpy_deg, FormulaVector(), "Roll, pitch and yaw in degrees.")
      .Optional("trigger", &H::trigger, FormulaText(), "The commanded grip, 0 open .. 1 closed.")
      .Optional("ahead", &H::ahead, Vector<3>(-1, 1), "In the hand's frame: where it reaches.")
      .Optional("palm_m", &H::palm_m, Vector<3>(0.001, kMaxPart_m), "Full edge lengths.")
      .Optional("sides", &H::sides, MapOf(Identifier(), HandSideFormat(), 1, kMaxSides),
                "Fingers, each with sensors of its own; default: thumb and fingers.")
      .format();
}

ValueFormat<TouchYaml> TouchFormat() {
  using T = TouchYaml;
  const auto side =
      Word("[a-z][a-z0-9_]*(\\.[a-z][a-z0-9_]*)?", "a name like 'cup' or 'hand.thumb'", 130);
  return StructFormat<T>("a contact")
      .Required("between", &T::between, ListOf(WithPlace(side), 2, 2),
                "Two entities; of a hand, which side.")
      .Required("while", &T::during, FormulaText(), "They touch while this is true.")
      .Optional("normal", &T::normal, FormulaVector(),
                "Unit vector out of the second into the first; default: up.")
      .Optional("at_m", &T::at_m, FormulaVector(), "The point; default: where the first one is.")
      .Optional("force_n", &T::force_n, FormulaText(),
                "Normal force; default: the weight of the first one.")
      .format();
}

ValueFormat<SamplingYaml> SamplingFormat() {
  using S = SamplingYaml;
  return StructFormat<S>("a sampling")
      .Required("hz", &S::hz, Integer<int>(1, 480), "Frames per second.")
      .Optional("lost", &S::lost, FormulaText(),
                "Frames for which this is true are missing; n is their number, from 0.")
      .format();
}

/// `- reaching(hand, cup): [begin, end]`
ValueFormat<KnownEventYaml> KnownEventFormat() {
  const auto label =
      Word("[a-z_]+\\([a-z0-9_]+, [a-z0-9_]+\\)", "an event like 'reaching(hand, cup)'", 200);
  const auto event = MapOf(label, ListOf(FormulaText(), 2, 2), 1, 1);
  return ValueFormat<KnownEventYaml>(
      event.schema(), [event](const YamlNode& node, DiagnosticList& errors, KnownEventYaml& known) {
        std::vector<Named<VectorFormula>> read;
        if (!event.Read(node, errors, read)) return false;
        known = {{read[0].name, read[0].name_where}, read[0].value[0], read[0].value[1]};
        return true;
      });
}

}  // namespace

ValueFormat<ClosedFormYaml> ClosedFormFormat() {
  using C = ClosedFormYaml;
  const auto named = MapOf(Identifier(), FormulaText(), 0, kMaxNames);
  return StructFormat<C>("a closed form")
      .Required("closed_form", &C::name, Identifier(), "Its name, as that of the file.")
      .Required("shows", &C::shows, Text(), "What it shows, in a sentence.")
      .Required("lasts_s", &C::lasts_s, Number(0.01, kMaxRecording_s), "How long it lasts.")
      .Optional("numbers", &C::numbers, named,
                "Names for numbers; each may use those before it, and t_end.")
      .Optional("curves", &C::curves, named,
                "Names for what changes with t; each may use those before it.")
      .Required("entities", &C::entities,
                MapOf(Identifier(), scenario::EntityFormat(), 1, kMaxKinematicEntities),
                "Things, as in a scenario.")
      .Optional("motions", &C::motions,
                MapOf(Identifier(), MotionFormat(), 0, kMaxKinematicEntities), "How entities move.")
      .Required("hands", &C::hands,
                MapOf(Identifier(), KinematicHandFormat(), 1, kMaxKinematicHands),
                "Hands: boxes that move as they are told.")
      .Optional("contacts", &C::contacts, ListOf(TouchFormat(), 0, kMaxTouches),
                "What touches what.")
      .Optional("sampled", &C::sampled, ListOf(SamplingFormat(), 1, kMaxSamplings),
                "How it is sampled, each time a recording of its own.")
      .Required("truth", &C::truth, ListOf(KnownEventFormat(), 1, kMaxKnownEvents),
                "Every event, with begin and end in seconds.")
      .format();
}

}  // namespace prehend::witnesses
