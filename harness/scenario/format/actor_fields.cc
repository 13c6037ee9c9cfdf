// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/scenario_fields_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

ValueFormat<PidOverride> PidFormat(const std::string& noun, const std::string (&keys)[4]) {
  return StructFormat<PidOverride>(noun)
      .Optional(keys[0], &PidOverride::proportional, Number(0, 1e6), "Force or torque per error.")
      .Optional(keys[1], &PidOverride::derivative, Number(0, 1e5),
                "Force or torque per speed of the error.")
      .Optional(keys[2], &PidOverride::integral, Number(0, 1e6),
                "Force or torque per error and second.")
      .Optional(keys[3], &PidOverride::limit, Number(0, 1e4), "Largest force or torque.")
      .format();
}

ValueFormat<GainsOverride> GainsOverrideFormat() {
  return StructFormat<GainsOverride>("the gains")
      .Optional("translation", &GainsOverride::translation,
                PidFormat("the translation gains", {"proportional_n_per_m", "derivative_n_s_per_m",
                                                    "integral_n_per_m_s", "limit_n"}),
                "How the palm follows the position of its tracked target.")
      .Optional(
          "rotation", &GainsOverride::rotation,
          PidFormat("the rotation gains", {"proportional_nm_per_rad", "derivative_nm_s_per_rad",
                                           "integral_nm_per_rad_s", "limit_nm"}),
          "How the palm follows the orientation of its tracked target.")
      .format();
}

/// Reports a share of lost samples that losses of the given mean length cannot reach.
void CheckLosses(const YamlNode& node, const physics::TrackerSettings& t, DiagnosticList& errors) {
  if (t.dropped_run_s <= 0) return;
  const double run_samples = std::max(1.0, t.dropped_run_s * t.tracker_hz);
  const double min_samples = t.dropped_share / (1 - t.dropped_share);
  if (run_samples >= min_samples) return;
  errors.Add(node.Find("dropped_run_s")->where,
             fmt::format("dropped_run_s: a share of {} needs losses of at least {:.3f} s",
                         t.dropped_share, min_samples / t.tracker_hz));
}

ValueFormat<physics::TrackerSettings> TrackingFormat() {
  using T = physics::TrackerSettings;
  return StructFormat<T>("the tracking")
      .Optional("tracker_hz", &T::tracker_hz, Integer<int>(1, 4800),
                "Samples of the tracker per second, at most rate_hz.")
      .Optional("latency_s", &T::latency_s, Number(0, 2), "Delay from a sample to its arrival.")
      .Optional("jitter_mm", &T::jitter_mm, Number(0, 100),
                "Standard deviation of each coordinate of a sample.")
      .Optional("jitter_deg", &T::jitter_deg, Number(0, 45),
                "Standard deviation of each component of a sample's rotation vector.")
      .Optional("dropped_share", &T::dropped_share, Number(0, 0.95),
                "Share of the samples that are lost.")
      .Optional("dropped_run_s", &T::dropped_run_s, Number(0, 10),
                "Mean length of a loss; 0: losses are independent.")
      .Optional("tremor_mm", &T::tremor_mm, Number(0, 50), "Amplitude of the tremor on each axis.")
      .Optional("tremor_hz", &T::tremor_hz, Number(0.1, 60), "Frequency of the tremor.")
      .Check(CheckLosses)
      .format();
}

/// What hands and persons have in common.
ValueFormat<Eigen::Vector3d> Position() { return Vector<3>(-kMaxDistance_m, kMaxDistance_m); }

ValueFormat<HandActorYaml> HandActorFormat() {
  using A = HandActorYaml;
  return StructFormat<A>("actor")
      .NamedByKey()
      .Required("hand", &A::hand,
                Word("[A-Za-z0-9_./-]+", "a hand like 'human_right', or a .hand.yaml file", 255),
                "A hand of the library, or a .hand.yaml file beside the scenario.")
      .Optional(
          "grasps", &A::grasps,
          ListOf(WithPlace(Word("[A-Za-z0-9_./-]+\\.grasps\\.yaml", "a .grasps.yaml file", 255)), 1,
                 16),
          "Files beside the scenario with more grasp styles for the hand; a style replaces an "
          "earlier one of the same name.")
      .Required("at_m", &A::at_m, Position(),
                "World coordinates of the palm's centre at the start.")
      .Optional("rpy_deg", &A::rpy_deg, Vector<3>(-360, 360),
                "Roll, pitch and yaw in degrees: turns about the world's x, then y, then z axis. "
                "At 0 the fingers point along x and the palm faces down.")
      .Optional("gains", &A::gains, GainsOverrideFormat(),
                "Replaces gains of the hand file; gains not given here stay.")
      .Optional("tracking", &A::tracking, TrackingFormat(),
                "An imperfect tracker between the wanted pose and the tracked target.")
      .format();
}

ValueFormat<PersonActorYaml> PersonActorFormat() {
  using P = PersonActorYaml;
  return StructFormat<P>("actor")
      .NamedByKey()
      .Required("person", &P::person,
                Choice<PersonKind>({{"head", PersonKind::kHead}, {"body", PersonKind::kBody}}),
                "How much of the person is simulated: a head that looks, or a whole body.")
      .Required("at_m", &P::at_m, Position(),
                "World coordinates of the point between the feet, on the floor.")
      .Optional("yaw_deg", &P::yaw_deg, Number(-360, 360), "The direction she faces; 0 is along x.")
      .Optional("height_m", &P::height_m, Number(1, 2.3), "Height from the floor to the crown.")
      .Optional("eyes", &P::eyes, EyesFormat(),
                "Where she looks when no step says so: where her hands go next, or ahead.")
      .Optional("right_hand", &P::right_hand, Identifier(), "The actor that is her right hand.")
      .Optional("left_hand", &P::left_hand, Identifier(), "The actor that is her left hand.")
      .format();
}

}  // namespace

ValueFormat<physics::Eyes> EyesFormat() {
  return Choice<physics::Eyes>({{"lead", physics::Eyes::kLead}, {"ahead", physics::Eyes::kAhead}});
}

ValueFormat<ActorYaml> ActorFormat() {
  return ByKey<ActorYaml>("an actor", {{"hand", AsAlternative<ActorYaml>(HandActorFormat())},
                                       {"person", AsAlternative<ActorYaml>(PersonActorFormat())}});
}

void SortActors(ScenarioYaml& entry) {
  for (const Named<ActorYaml>& actor : entry.actors) {
    if (const auto* hand = std::get_if<HandActorYaml>(&actor.value))
      entry.hands.push_back({actor.name, actor.name_where, *hand});
    if (const auto* person = std::get_if<PersonActorYaml>(&actor.value))
      entry.persons.push_back({actor.name, actor.name_where, *person});
  }
}

}  // namespace prehend::scenario
