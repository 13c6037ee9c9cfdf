// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/sense/episode_format.h"

#include <algorithm>

#include "harness/scenario/format/scenario_fields.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kMaxMembers = 10'000;
constexpr std::size_t kMaxSets = 32;
constexpr std::size_t kMaxClasses = 100;
constexpr std::size_t kMaxParts = 256;
constexpr std::size_t kMinHullPoints = 4;
constexpr std::size_t kMaxHullPoints = 64;

ValueFormat<std::string> Name() {
  return Word("[A-Za-z_][A-Za-z0-9_]*", "a name like 'milk_carton'");
}
ValueFormat<std::string> ClassName() {
  return Word("[A-Z][A-Za-z0-9]*", "a class name like 'Cup'");
}
ValueFormat<Eigen::Vector3d> Position() { return Vector<3>(-kMaxPosition_m, kMaxPosition_m); }
ValueFormat<double> Length() { return Number(0, kMaxPosition_m); }
ValueFormat<Eigen::Vector3d> Velocity() { return Vector<3>(-kMaxVelocity, kMaxVelocity); }

/// A value that is kept halved: an edge length as half of it.
template <class T>
ValueFormat<T> Halved(const ValueFormat<T>& whole) {
  return ValueFormat<T>(whole.schema(),
                        [whole](const YamlNode& node, DiagnosticList& errors, T& half) {
                          T read{};
                          if (!whole.Read(node, errors, read)) return false;
                          half = read / 2;
                          return true;
                        });
}

/// A sample, or null where the entity is not tracked.
ValueFormat<SampleEntry> OrNull(const ValueFormat<SampleEntry>& sample) {
  return ValueFormat<SampleEntry>(
      AnyOf({sample.schema(),
             [] {
               return Json{{"type", "null"}};
             }}),
      [sample](const YamlNode& node, DiagnosticList& errors, SampleEntry& entry) {
        entry.not_tracked = node.kind == YamlNode::Kind::kNull;
        return entry.not_tracked || sample.Read(node, errors, entry);
      });
}

template <class Round>
ValueFormat<Round> RoundFormat(const std::string& noun) {
  return StructFormat<Round>(noun)
      .Required("radius_m", &Round::radius_m, Length(), "")
      .Required("length_m", &Round::half_length_m, Halved(Length()), "")
      .format();
}

ValueFormat<PartEntry> PartFormat() {
  using grammar::Ball, grammar::Box, grammar::Hull;
  const ValueFormat<Box> box =
      StructFormat<Box>("a box")
          .Required("size_m", &Box::half_size_m, Halved(Vector<3>(0, kMaxPosition_m)), "")
          .format();
  const ValueFormat<Ball> sphere =
      StructFormat<Ball>("a sphere").Required("radius_m", &Ball::radius_m, Length(), "").format();
  const ValueFormat<Hull> hull =
      StructFormat<Hull>("a hull")
          .Required("points_m", &Hull::points_m, ListOf(Position(), kMinHullPoints, kMaxHullPoints),
                    "")
          .format();
  using P = PartEntry;
  return StructFormat<P>("a part")
      .Optional("box", &P::box, box, "")
      .Optional("sphere", &P::sphere, sphere, "")
      .Optional("cylinder", &P::cylinder, RoundFormat<grammar::Cylinder>("a cylinder"), "")
      .Optional("capsule", &P::capsule, RoundFormat<grammar::Capsule>("a capsule"), "")
      .Optional("hull", &P::hull, hull, "")
      .Optional("at_m", &P::at_m, Position(), "")
      .Optional("quat_wxyz", &P::quat_wxyz, UnitQuaternion(), "")
      .ExactlyOneOf({"box", "sphere", "cylinder", "capsule", "hull"})
      .format();
}

/// The entity that stands for the person whose hand this is, her head; otherwise kNoEntity.
int PersonOf(const physics::Scene& scene, physics::HandIndex hand) {
  for (const physics::Person& person : scene.persons) {
    if (person.right_hand == hand || person.left_hand == hand) return person.head.number();
  }
  return grammar::kNoEntity;
}

struct ShapeSeen {
  grammar::Shape operator()(const physics::Box& box) const { return grammar::Box{box.size_m / 2}; }
  grammar::Shape operator()(const physics::Sphere& sphere) const {
    return grammar::Ball{sphere.radius_m};
  }
  grammar::Shape operator()(const physics::Cylinder& cylinder) const {
    return grammar::Cylinder{cylinder.radius_m, cylinder.length_m / 2};
  }
  grammar::Shape operator()(const physics::Capsule& capsule) const {
    return grammar::Capsule{capsule.radius_m, capsule.length_m / 2};
  }
  grammar::Shape operator()(const physics::Hull& hull) const {
    return grammar::Hull{hull.corners_m};
  }
};

/// Empty if it fills its bounding box.
grammar::Solid SolidOf(const physics::Body& body) {
  const bool is_box = body.shapes.size() == 1 &&
                      std::holds_alternative<physics::Box>(body.shapes.front().shape) &&
                      body.shapes.front().X_BS.q.isApprox(Eigen::Quaterniond::Identity());
  if (is_box) return {};
  std::vector<grammar::SolidPart> parts;
  for (const physics::PlacedShape& part : body.shapes)
    parts.push_back({std::visit(ShapeSeen{}, part.shape), part.X_BS.p_m, part.X_BS.q});
  return grammar::Solid(std::move(parts));
}

}  // namespace

ValueFormat<HeaderEntry> HeaderFormat() {
  using M = MemberEntry;
  const ValueFormat<M> member =
      StructFormat<M>("entity")
          .NamedByKey()
          .Optional("class", &M::class_name, ClassName(), "")
          .Optional("fixed", &M::fixed, Flag(), "")
          .Optional("jointed", &M::jointed, Flag(), "")
          .Optional("attached", &M::attached, Flag(), "")
          .Optional("person", &M::person, Flag(), "")
          .Optional("grains", &M::grains, Flag(), "")
          .Optional("abstract", &M::abstract, Choice({"Region", "GazeTarget", "Camera", "Light"}),
                    "")
          .Optional("round", &M::round, Flag(), "")
          .Optional("kinds", &M::kinds, ListOf(ClassName(), 0, kMaxClasses), "")
          .Optional("hand", &M::hand, Flag(), "")
          .Optional("centre_m", &M::centre_m, Position(), "")
          .Required("size_m", &M::size_m, Vector<3>(0, kMaxPosition_m), "")
          .Optional("parts", &M::parts, ListOf(PartFormat(), 1, kMaxParts), "")
          .Optional("mass_kg", &M::mass_kg, Number(0, 1e6), "")
          .Optional("strength_n", &M::strength_n, Number(0, 1e6), "")
          .Optional("part_of", &M::part_of, Name(), "")
          .Optional("sensor_sets", &M::sensor_sets, ListOf(Name(), 1, kMaxSets), "")
          .format();
  using H = HeaderEntry;
  return StructFormat<H>("the first line")
      .Required("recording", &H::version, Integer<int>(kEpisodeVersion, kEpisodeVersion), "")
      .Required("episode", &H::episode, Name(), "")
      .Optional("grammar", &H::grammar, scenario::OneOrJoined(Name()), "")
      .Required("ticks_per_second", &H::ticks_per_second, Integer<std::int64_t>(1, 1'000'000), "")
      .Optional("bridge_s", &H::bridge_s, Number(0, 60), "")
      .Optional("success", &H::success, Flag(), "")
      .Optional("language", &H::language, Text(kMaxLanguageBytes), "")
      .Optional("styles", &H::styles, ListOf(Name(), 0, 1000), "")
      .Required("entities", &H::entities, MapOf(Name(), member, 1, kMaxMembers), "")
      .format();
}

ValueFormat<LineEntry> LineFormat() {
  using L = SampleEntry;
  const ValueFormat<L> sample =
      StructFormat<L>("sample")
          .NamedByKey()
          .Required("at_m", &L::at_m, Position(), "")
          .Optional("quat_wxyz", &L::quat_wxyz, UnitQuaternion(), "")
          .Optional("v_m_per_s", &L::v_m_per_s, Velocity(), "")
          .Optional("w_rad_per_s", &L::w_rad_per_s, Velocity(), "")
          .Optional("asleep", &L::asleep, Flag(), "")
          .Optional("joint_position", &L::joint_position, Number(-1e4, 1e4), "")
          .Optional("joint_fraction", &L::joint_fraction, Number(0, 1), "")
          .Optional("gazes_at", &L::gazes_at, Name(), "")
          .format();
  using H = HandEntry;
  const ValueFormat<H> hand =
      StructFormat<H>("hand")
          .NamedByKey()
          .Optional("trigger", &H::trigger, Number(0, 1), "")
          .Optional("ahead", &H::ahead, Vector<3>(-1.01, 1.01), "")
          .Optional("collision_spheres_m", &H::collision_spheres_m,
                    ListOf(Vector<4>(-kMaxPosition_m, kMaxPosition_m), 1, kMaxCollisionSpheres), "")
          .Renamed("feelers_m", "collision_spheres_m")
          .Optional("style", &H::style, Name(), "")
          .format();
  using T = TouchEntry;
  const ValueFormat<T> touch =
      StructFormat<T>("a touch")
          .Required("a", &T::a, Name(), "")
          .Required("b", &T::b, Name(), "")
          .Optional("up_on_a", &T::up_on_a, Number(-1.01, 1.01), "")
          .Optional("up_on_b", &T::up_on_b, Number(-1.01, 1.01), "")
          .Optional("force_n", &T::force_n, Number(0, 1e9), "")
          .Optional("vertical_speed_m_per_s", &T::vertical_speed_m_per_s, Number(0, 1e9), "")
          .Optional("at_m", &T::at_m, Position(), "")
          .Optional("normal", &T::normal, Vector<3>(-1.01, 1.01), "")
          .Optional("sensor_sets", &T::sensor_sets, ListOf(WithPlace(Name()), 0, kMaxSets), "")
          .format();
  using F = FrameEntry;
  const auto tick = Integer<std::int64_t>(-kLatestTick, kLatestTick);
  return ByKey<LineEntry>(
      "a line",
      {{"tick",
        AsAlternative<LineEntry>(
            StructFormat<F>("a frame")
                .Required("tick", &F::tick, tick, "")
                .Optional("samples", &F::samples, MapOf(Name(), OrNull(sample), 0, kMaxMembers), "")
                .Renamed("looks", "samples")
                .Optional("hands", &F::hands, MapOf(Name(), hand, 0, kMaxMembers), "")
                .Optional("touches", &F::touches, ListOf(touch, 0, 100'000), "")
                .format())},
       {"end_tick",
        AsAlternative<LineEntry>(StructFormat<EndEntry>("the last line")
                                     .Required("end_tick", &EndEntry::end_tick, tick, "")
                                     .format())}});
}

std::vector<std::string> StyleNames(const physics::Scene& scene) {
  std::vector<std::string> names;
  for (const physics::Hand& hand : scene.hands) {
    for (const physics::GraspStyle& style : hand.model.styles) {
      if (std::ranges::find(names, style.name) == names.end()) names.push_back(style.name);
    }
  }
  return names;
}

grammar::EntityTable MakeEntityTable(const scenario::Scenario& scenario) {
  grammar::EntityTable entity_table;
  entity_table.ticks_per_second = scenario.scene.world.rate_hz;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    const physics::LocalBox box = physics::BoundingBox(body);
    grammar::EntityInfo& member = entity_table.entities.emplace_back();
    member.name = body.name;
    member.classes = scenario::ClassesOf(scenario, i);
    member.part_of = scenario.body_part_of[i];
    member.p_BC_m = box.p_BC_m;
    member.half_size_m = box.half_size_m;
    member.solid = SolidOf(body);
    member.round = body.abstract == physics::Abstract::kRegion &&
                   std::holds_alternative<physics::Sphere>(body.shapes.front().shape);
    member.mass_kg = body.fixed ? 0 : body.mass_kg;
  }
  for (std::size_t i = 0; i < scenario.scene.hands.size(); ++i) {
    const physics::Hand& hand = scenario.scene.hands[i];
    grammar::EntityInfo& member = entity_table.entities.emplace_back();
    member.name = hand.name;
    member.part_of = PersonOf(scenario.scene, physics::HandIndex(i));
    member.classes = {"Hand", "Entity"};
    member.half_size_m = hand.model.palm_size_m / 2;
    member.sensor_sets = hand.model.sensor_sets;
    member.strength_n = hand.model.translation.limit;
  }
  entity_table.styles = StyleNames(scenario.scene);
  return entity_table;
}

}  // namespace prehend::episode
