// SPDX-License-Identifier: Apache-2.0
// A scenario as written, before names are resolved and positions computed.
// harness/scenario/format/scenario_fields.cc says how each field is called and bounded;
// harness/scenario/resolve/resolve.h and harness/scenario/resolve/resolve.h make bodies,
// hands and steps of it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/motion/script.h"
#include "physics/scene/compounds.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// One of the shapes of a compound.
struct PartYaml {
  physics::Shape shape;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
};

/// Loose balls that lie in a vessel.
struct GrainsYaml {
  int count = 0;
  double radius_m = 0;
};

// Abstract entities have a position but no mass.
struct RegionYaml {
  std::optional<Eigen::Vector3d> size_m;  ///< of a box
  std::optional<double> radius_m;         ///< of a ball
};
struct GazeTargetYaml {
  double radius_m = 0.02;
};
struct CameraYaml {
  Located<Eigen::Vector3d> toward_m{Eigen::Vector3d::Zero(), {}};
  double view_deg = physics::Body{}.view_deg;
};
struct LightYaml {};

/// A joint to another entity; which numbers are read depends on its kind, and angles are in
/// degrees.
struct JointYaml : physics::Joint {
  std::string key = {};  ///< "slider"
  Located<std::string> to = {};
  Located<Eigen::Vector2d> range{Eigen::Vector2d::Zero(), {}};
};

struct EntityYaml {
  Where where;
  Located<std::string> class_name{"Object", {}};
  std::optional<Located<std::string>> part_of;
  std::optional<Located<std::string>> color;  ///< see harness/scenario/scenario/scenario.h
  std::optional<physics::Shape> shape;
  std::vector<physics::PlacedShape> parts;  ///< of a compound
  std::optional<GrainsYaml> grains;
  std::optional<RegionYaml> region;
  std::optional<GazeTargetYaml> gaze_target;
  std::optional<CameraYaml> camera;
  std::optional<LightYaml> light;
  bool fixed = false;
  std::optional<Located<double>> mass_kg;
  std::optional<Located<double>> friction;  ///< default: that of physics::Body
  std::optional<double> rolling_friction;
  double restitution = 0;
  double linear_damping_per_s = 0;
  double angular_damping_per_s = 0;
  std::optional<Located<JointYaml>> joint;
  std::optional<Located<std::string>> on;
  std::optional<Located<std::string>> in;  ///< the vessel of grains, which have no at_m
  Located<std::vector<double>> at_m;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// The entity that it is glued to, or null.
inline const Located<std::string>* FixedTo(const EntityYaml& entity) {
  const bool is_fixed = entity.joint && entity.joint->value.kind == physics::JointKind::kFixed;
  return is_fixed ? &entity.joint->value.to : nullptr;
}

inline physics::Abstract AbstractOf(const EntityYaml& entity) {
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

/// The place in the file of the key that says where the entity is.
inline const Where& PlaceOf(const EntityYaml& entity) {
  return entity.in ? entity.in->where : entity.at_m.where;
}

/// Values that are not set keep those of the hand file.
struct PidOverride {
  std::optional<double> proportional, derivative, integral, limit;
};
struct GainsOverride {
  PidOverride translation, rotation;
};

struct HandActorYaml {
  Where where;
  Located<std::string> hand;
  std::vector<Located<std::string>>
      grasps;  ///< paths of grasp files, relative to the scenario's folder
  Located<Eigen::Vector3d> at_m;
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  std::optional<Located<GainsOverride>> gains;
  std::optional<Located<physics::TrackerSettings>> tracking;
};

enum class PersonKind { kHead, kBody };

struct PersonActorYaml {
  Where where;
  PersonKind person = PersonKind::kBody;
  Located<Eigen::Vector3d> at_m;
  double yaw_deg = 0;
  double height_m = physics::Person{}.height_m;
  physics::Eyes eyes = physics::Eyes::kLead;
  std::optional<Located<std::string>> right_hand, left_hand;
};
using ActorYaml = std::variant<HandActorYaml, PersonActorYaml>;

/// When a step of the script begins; see StepOrder in physics/motion/script.h. What ends it before
/// its time: only some steps have this key.
struct StepTimingYaml {
  std::optional<Located<std::string>> name, after, with;
  double delay_s = 0;
  std::optional<Located<physics::Until>> until;
};

// The steps of the script. Default durations are human-like (docs/scenario-format.md).
struct ReachYaml : StepTimingYaml {
  Located<std::string> reach;
  Located<std::string> style{"wrap", {}};
  physics::Approach from = physics::Approach::kAuto;
  Located<Eigen::Vector3d> offset_m{Eigen::Vector3d::Zero(), {}};
  std::optional<Located<Eigen::Vector3d>> point_m;
  double over_s = 0.8;
};
struct CloseYaml : StepTimingYaml {
  double close_to = 1;
  double over_s = 0.6;
};
struct OpenYaml : StepTimingYaml {
  double open_to = 0;
  double over_s = 0.45;
};
struct LiftYaml : StepTimingYaml {
  double lift_by_m = 0;
  std::optional<bool> keep_upright;
  double over_s = 0.6;
};
struct MoveYaml : StepTimingYaml {
  Located<Eigen::Vector3d> move_by_m{Eigen::Vector3d::Zero(), {}};
  std::optional<bool> keep_upright;
  double over_s = 0.8;
};
struct CarryYaml : StepTimingYaml {
  Where where;
  Located<Eigen::Vector2d> carry_to_m{Eigen::Vector2d::Zero(), {}};
  std::optional<bool> keep_upright;
  double over_s = 1.0;
};
struct PlaceYaml : StepTimingYaml {
  Where where;
  Located<std::string> place_on;
  std::optional<bool> keep_upright;
  double over_s = 0.6;
};
struct RetreatYaml : StepTimingYaml {
  double retreat_by_m = 0;
  double over_s = 0.6;
};
struct FollowJointYaml : StepTimingYaml {
  Located<std::string> follow_joint;
  double to = 1;
  double over_s = 1.5;
};
struct WaitYaml : StepTimingYaml {
  double wait_s = 0;
};
struct PoseYaml {
  Where where;
  double t_s = 0;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::optional<double> trigger;
  std::optional<Located<std::string>> relative_to;  ///< else that of the step
};
struct PosesYaml : StepTimingYaml {
  std::vector<PoseYaml> poses;
  Located<std::string> style;  ///< "": stays
  bool world_axes = false;
  Located<std::string> relative_to{"world", {}};  ///< "world", "hand", an entity or another hand
};
struct RecordingYaml : StepTimingYaml {
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
  double max_gap_s = 0.25;
  double max_jump_m = 0.1;
  std::optional<Located<double>> scale;  ///< metres per unit of a .bvh file
  // What harness/scenario/read/read_parts.h makes of the file: poses of the palm or head, or
  // postures of a body.
  std::vector<physics::TimedPose> poses;
  std::vector<physics::TimedPosture> postures;
};
struct TurnHandYaml : StepTimingYaml {
  Located<Eigen::Vector3d> turn_by_deg{Eigen::Vector3d::Zero(), {}};
  bool own_axes = false;
  double over_s = 0.8;
};
struct OrbitYaml : StepTimingYaml {
  struct Around {
    Located<std::string> around;
    double by_deg = 90;
    std::optional<double> at_m;
  };
  Around orbit;
  double over_s = 1.5;
};
struct PressYaml : StepTimingYaml {
  double press_n = 0;
  Located<std::string> against;
  Located<Eigen::Vector3d> along{-Eigen::Vector3d::UnitZ(), {}};
  double over_s = 1.0;
};
// Steps of persons.
struct LookAtYaml : StepTimingYaml {
  Located<std::string> look_at;
  double over_s = 0.5;
};
struct LookAtPointYaml : StepTimingYaml {
  Eigen::Vector3d look_at_m = Eigen::Vector3d::Zero();
  double over_s = 0.5;
};
struct EyesYaml : StepTimingYaml {
  physics::Eyes eyes = physics::Eyes::kLead;
  double over_s = 0.5;
};
struct WalkYaml : StepTimingYaml {
  Eigen::Vector2d walk_to_m = Eigen::Vector2d::Zero();
  std::optional<double> max_force_n;
  double over_s = 1.0;
};
struct TurnYaml : StepTimingYaml {
  double turn_to_deg = 0;
  double over_s = 0.8;
};
struct LeanYaml : StepTimingYaml {
  double lean_deg = 0;
  double over_s = 0.8;
};
struct SwayYaml : StepTimingYaml {
  Located<Eigen::Vector2d> sway_by_m{Eigen::Vector2d::Zero(), {}};
  double over_s = 0.8;
};
struct MoveLimbYaml : StepTimingYaml {
  Located<physics::LimbEnd> move_limb;
  std::optional<Eigen::Vector3d> to_m;
  std::optional<double> max_force_n;
  double over_s = 0.8;
};

using StepYaml =
    std::variant<WaitYaml, ReachYaml, CloseYaml, OpenYaml, LiftYaml, MoveYaml, CarryYaml, PlaceYaml,
                 RetreatYaml, FollowJointYaml, PosesYaml, RecordingYaml, TurnHandYaml, OrbitYaml,
                 PressYaml, LookAtYaml, LookAtPointYaml, EyesYaml, WalkYaml, TurnYaml, LeanYaml,
                 SwayYaml, MoveLimbYaml>;
/// Steps that only hands, or only persons can do. Recordings and waiting are for both.
template <class T>
concept StepOfHand =
    physics::OneOf<T, ReachYaml, CloseYaml, OpenYaml, LiftYaml, MoveYaml, CarryYaml, PlaceYaml,
                   RetreatYaml, FollowJointYaml, PosesYaml, TurnHandYaml, OrbitYaml, PressYaml>;
template <class T>
concept StepOfPerson = physics::OneOf<T, LookAtYaml, LookAtPointYaml, EyesYaml, WalkYaml, TurnYaml,
                                      LeanYaml, SwayYaml, MoveLimbYaml>;

/// One item of the script: what each named actor does at the same time. The steps of an actor that
/// does several stand one after another.
using StageYaml = std::vector<Named<StepYaml>>;

struct WorldYaml {
  physics::Engine engine = physics::Engine::kBullet;
  std::optional<Located<bool>> planar;  ///< default: as the engine needs it
  int rate_hz = physics::WorldSettings{}.rate_hz;
  int sensing_hz = SensingSettings{}.sensing_hz;
  double bearing_share = SensingSettings{}.bearing_share;
  std::uint64_t seed = physics::WorldSettings{}.seed;
};

struct ScenarioYaml {
  Where where;
  Located<std::string> name;
  std::string shows;
  std::vector<Located<std::string>> expects;
  Located<std::string> grammar{kDefaultGrammar, {}};
  std::vector<std::string> tags;
  WorldYaml world;
  SensorSettings sensors;
  std::vector<Named<EntityYaml>> entities;
  std::vector<Named<Located<std::string>>> classes;  ///< each with its base class
  std::vector<Named<ActorYaml>> actors;
  std::vector<Named<HandActorYaml>> hands;      ///< those of the actors; see SortActors()
  std::vector<Named<PersonActorYaml>> persons;  ///< the others
  std::vector<StageYaml> script;
  double settle_s = physics::Script{}.settle_s;
  std::vector<VariationYaml> vary;
  std::vector<Named<std::vector<ConditionYaml>>> outcomes;
  std::vector<PictureYaml> pictures;
};

/// Fills in `hands` and `persons`, in the order of the actors.
void SortActors(ScenarioYaml& entry);

}  // namespace prehend::scenario
