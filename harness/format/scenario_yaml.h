// SPDX-License-Identifier: Apache-2.0
// A scenario as it is written, before names are resolved and places computed.
// harness/format/scenario_fields.cc says how each field is called and bounded;
// harness/build/build_scene.h and harness/build/build_script.h make bodies, hands and steps of it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/default_grammar.h"
#include "harness/scenario/scenario.h"
#include "harness/yaml/value_format.h"
#include "physics/motion/script.h"
#include "physics/scene/compounds.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// One of the shapes of a compound; exactly one of the first five is given.
struct PartEntry {
  std::optional<physics::Box> box;
  std::optional<physics::Sphere> sphere;
  std::optional<physics::Cylinder> cylinder;
  std::optional<physics::Capsule> capsule;
  std::optional<physics::Hull> hull;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
};

/// Loose balls that lie in a vessel.
struct GrainsEntry {
  int count = 0;
  double radius_m = 0;
};

// What is abstract: it has a place, and no matter.
struct RegionEntry {
  std::optional<Eigen::Vector3d> size_m;  ///< of a box
  std::optional<double> radius_m;         ///< of a ball
};
struct GazeTargetEntry {
  double radius_m = 0.02;
};
struct CameraEntry {
  Located<Eigen::Vector3d> toward_m{Eigen::Vector3d::Zero(), {}};
  double view_deg = physics::Body{}.view_deg;
};
struct LightEntry {};

/// A joint to another entity; which numbers are read depends on its kind.
struct JointEntry {
  Located<std::string> to;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Located<Eigen::Vector2d> range{Eigen::Vector2d::Zero(), {}};  ///< metres or degrees
  double friction = 0;
  double damping = 0;
  double spring = 0;  ///< per metre or per radian
  double rest = 0;    ///< metres or degrees
};

struct EntityEntry {
  Where where;
  Located<std::string> class_name{"Object", {}};
  std::optional<Located<std::string>> part_of;
  std::optional<physics::Box> box;
  std::optional<physics::Sphere> sphere;
  std::optional<physics::Cylinder> cylinder;
  std::optional<physics::Capsule> capsule;
  std::optional<physics::Hull> hull;
  std::optional<physics::Tray> tray;
  std::optional<physics::Mug> mug;
  std::optional<physics::Bowl> bowl;
  std::optional<physics::Shelf> shelf;
  std::vector<PartEntry> parts;
  std::optional<GrainsEntry> grains;
  std::optional<RegionEntry> region;
  std::optional<GazeTargetEntry> gaze_target;
  std::optional<CameraEntry> camera;
  std::optional<LightEntry> light;
  bool fixed = false;
  std::optional<Located<double>> mass_kg;
  std::optional<Located<double>> friction;  ///< default: that of physics::Body
  std::optional<double> rolling_friction;
  double restitution = 0;
  double linear_damping_per_s = 0;
  double angular_damping_per_s = 0;
  std::optional<Located<std::string>> fixed_to;
  std::optional<Located<JointEntry>> slider, hinge, ball_joint;
  std::optional<Located<std::string>> on;
  std::optional<Located<std::string>> in;  ///< the vessel of grains, which have no at_m
  Located<std::vector<double>> at_m;
  std::optional<Eigen::Vector3d> rpy_deg;
  std::optional<double> yaw_deg;
};

inline physics::Abstract AbstractOf(const EntityEntry& entity) {
  using enum physics::Abstract;
  return entity.region        ? kRegion
         : entity.gaze_target ? kGazeTarget
         : entity.camera      ? kCamera
         : entity.light       ? kLight
                              : kNot;
}

/// "a region", and so on; "" for what is not abstract.
inline const char* NounOf(physics::Abstract abstract) {
  using physics::Abstract;
  switch (abstract) {
    case Abstract::kNot:
      return "";
    case Abstract::kRegion:
      return "a region";
    case Abstract::kGazeTarget:
      return "a gaze target";
    case Abstract::kCamera:
      return "a camera";
    case Abstract::kLight:
      return "a light";
  }
  return "";
}

/// Where it is said where it is.
inline const Where& PlaceOf(const EntityEntry& entity) {
  return entity.in ? entity.in->where : entity.at_m.where;
}

/// What is not given keeps the value of the hand file.
struct PidOverride {
  std::optional<double> proportional, derivative, integral, limit;
};
struct GainsOverride {
  PidOverride translation, rotation;
};

struct HandActor {
  Where where;
  Located<std::string> hand;
  std::vector<Located<std::string>>
      grasps;  ///< paths of grasp files, seen from the scenario's folder
  Located<Eigen::Vector3d> at_m;
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  std::optional<Located<GainsOverride>> gains;
  std::optional<Located<physics::TrackerSettings>> tracking;
};

enum class PersonKind { kHead, kBody };

struct PersonActor {
  Where where;
  PersonKind person = PersonKind::kBody;
  Located<Eigen::Vector3d> at_m;
  double yaw_deg = 0;
  double height_m = physics::Person{}.height_m;
  physics::Eyes eyes = physics::Eyes::kLead;
  std::optional<Located<std::string>> right_hand, left_hand;
};
using ActorEntry = std::variant<HandActor, PersonActor>;

// The steps of the script. Default durations are human-like (docs/scenario-format.md).
struct ReachEntry {
  Located<std::string> reach;
  Located<std::string> style{"wrap", {}};
  physics::Approach from = physics::Approach::kAuto;
  Located<Eigen::Vector3d> offset_m{Eigen::Vector3d::Zero(), {}};
  std::optional<Located<Eigen::Vector3d>> point_m;
  double over_s = 0.8;
};
struct CloseEntry {
  double close_to = 1;
  double over_s = 0.6;
};
struct OpenEntry {
  double open_to = 0;
  double over_s = 0.45;
};
struct LiftEntry {
  double lift_by_m = 0;
  double over_s = 0.6;
};
struct MoveEntry {
  Located<Eigen::Vector3d> move_by_m{Eigen::Vector3d::Zero(), {}};
  double over_s = 0.8;
};
struct CarryEntry {
  Where where;
  Located<Eigen::Vector2d> carry_to_m{Eigen::Vector2d::Zero(), {}};
  double over_s = 1.0;
};
struct PlaceEntry {
  Where where;
  Located<std::string> place_on;
  double over_s = 0.6;
};
struct RetreatEntry {
  double retreat_by_m = 0;
  double over_s = 0.6;
};
struct FollowJointEntry {
  Located<std::string> follow_joint;
  double to = 1;
  double over_s = 1.5;
};
struct WaitEntry {
  double wait_s = 0;
};
struct PoseEntry {
  Where where;
  double t_s = 0;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> rpy_deg;
  std::optional<Eigen::Vector4d> quat_wxyz;
  std::optional<double> trigger;
};
struct PosesEntry {
  std::vector<PoseEntry> poses;
  Located<std::string> style;  ///< "": stays
};
struct RecordingEntry {
  Located<std::string> recording;
  std::optional<Located<std::string>> device;
  std::optional<Located<int>> button;
  double press_s = 0.25;
  Located<std::string> style;
  Located<double> from_s;
  std::optional<Located<double>> to_s;
  std::optional<Eigen::Vector3d> start_at_m;
  double yaw_deg = 0;
  Eigen::Vector3d palm_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d palm_rpy_deg = Eigen::Vector3d::Zero();
  double join_s = 0.5;
  double most_gap_s = 0.25;
  double most_jump_m = 0.1;
  std::optional<Located<double>> scale;  ///< metres per unit of a .bvh file
  // What harness/read/place_recordings.h makes of the file: poses of the palm or head, or figures
  // of a body.
  std::vector<physics::TimedPose> poses;
  std::vector<physics::TimedFigure> figures;
};
// Steps of persons.
struct LookAtEntry {
  Located<std::string> look_at;
  double over_s = 0.5;
};
struct LookAtPointEntry {
  Eigen::Vector3d look_at_m = Eigen::Vector3d::Zero();
  double over_s = 0.5;
};
struct EyesEntry {
  physics::Eyes eyes = physics::Eyes::kLead;
  double over_s = 0.5;
};
struct WalkEntry {
  Eigen::Vector2d walk_to_m = Eigen::Vector2d::Zero();
  double over_s = 1.0;
};
struct TurnEntry {
  double turn_to_deg = 0;
  double over_s = 0.8;
};
struct LeanEntry {
  double lean_deg = 0;
  double over_s = 0.8;
};
struct SwayEntry {
  Located<Eigen::Vector2d> sway_by_m{Eigen::Vector2d::Zero(), {}};
  double over_s = 0.8;
};
struct MoveLimbEntry {
  Located<physics::LimbEnd> move_limb;
  std::optional<Eigen::Vector3d> to_m;
  std::optional<double> most_n;
  double over_s = 0.8;
};

using StepEntry = std::variant<WaitEntry, ReachEntry, CloseEntry, OpenEntry, LiftEntry, MoveEntry,
                               CarryEntry, PlaceEntry, RetreatEntry, FollowJointEntry, PosesEntry,
                               RecordingEntry, LookAtEntry, LookAtPointEntry, EyesEntry, WalkEntry,
                               TurnEntry, LeanEntry, SwayEntry, MoveLimbEntry>;

/// One item of the script: what each named actor does at the same time.
using BeatEntry = std::vector<Named<StepEntry>>;

struct ScenarioEntry {
  Where where;
  Located<std::string> name;
  std::string shows;
  Located<std::string> grammar{kDefaultGrammar, {}};
  std::vector<std::string> tags;
  WorldEntry world;
  std::vector<Named<EntityEntry>> entities;
  std::vector<Named<Located<std::string>>> classes;  ///< and what each is a kind of
  std::vector<Named<ActorEntry>> actors;
  std::vector<Named<HandActor>> hands;      ///< those of the actors; see SortActors()
  std::vector<Named<PersonActor>> persons;  ///< the others
  std::vector<BeatEntry> script;
  double settle_s = physics::Script{}.settle_s;
  std::vector<VariationEntry> vary;
  std::vector<Named<std::vector<ConditionEntry>>> outcomes;
  std::vector<PictureEntry> pictures;
};

/// Fills in `hands` and `persons`, in the order of the actors.
void SortActors(ScenarioEntry& entry);

}  // namespace prehend::harness
