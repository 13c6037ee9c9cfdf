// SPDX-License-Identifier: Apache-2.0
// A scenario that is read, checked and resolved: names are indices, entities are bodies, actors are
// hands and persons. What the file says is ScenarioYaml (harness/scenario/format/scenario_yaml.h);
// harness/scenario/read/read_scenario.h turns one into the other. Colours of things in pictures,
// 0xRRGGBB: by a word ("blue"), by a word in a name (`blue_cup`), or by class. The trials of a
// scenario: `vary:`, what differs between them, and `outcomes:`, how one can end.
// harness/scenario/format/scenario_fields.cc declares their keys. Tested by
// tests/harness/scenario/scenario/scenario_test.cc, tests/harness/scenario/scenario/colors_test.cc,
// tests/harness/scenario/read/sample_variations_test.cc and
// tests/harness/episode/run/outcome_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/located.h"
#include "harness/base/base/project_paths.h"
#include "harness/truth/claims/claim.h"
#include "physics/base/ids.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// One sample for all its fields. Exactly one distribution is set.
struct VariationYaml {
  Where where;
  std::vector<std::string> fields;         ///< paths as for --set
  std::optional<Eigen::Vector2d> uniform;  ///< [min, max]
  std::optional<Eigen::Vector2d> normal;   ///< [mean, standard deviation]
  std::optional<Eigen::Vector2d> plus;     ///< uniform, added to the written value
  std::optional<Eigen::Vector2d> times;    ///< uniform, multiplied with the written value
  std::optional<std::vector<std::string>> choose;
};

/// A condition on one entity; it holds when everything that is set holds.
struct ConditionYaml {
  Where where;
  std::string entity;
  std::optional<double> at_s;                 ///< when; default: at the end
  std::optional<std::vector<double>> near_m;  ///< its centre is near [x, y] or [x, y, z]
  double within_m = 0.05;
  std::optional<double> above_m, below_m;                ///< its centre's height
  std::optional<double> tilt_below_deg, tilt_above_deg;  ///< since it was placed
  std::optional<double> slower_than_m_per_s;
  std::optional<double> joint_above, joint_below;  ///< fraction of its joint's range
  std::optional<Located<std::string>>
      inside;        ///< its centre is in the bounding box of this entity ...
  double share = 1;  ///< ... or, of grains, at least this share of them
};

/// An outcome whose entities are resolved; it holds when all its conditions do.
struct Outcome {
  struct Condition {
    physics::BodyIndex body = physics::BodyIndex(0);
    int joint = -1;                  ///< index into Scene::joints
    physics::BodyIndex vessel = {};  ///< that it must be inside, or none
    ConditionYaml wanted;
  };
  std::string name;
  std::vector<Condition> conditions;
};

// A camera as people type it: where it stands and what it looks at. Tested by
// tests/harness/scenario/scenario/own_camera_test.cc

struct OwnCamera {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero(), look_at_m = Eigen::Vector3d::UnitX();
  double view_deg = 33;  ///< vertical field of view
};

/// For messages and help.
inline constexpr const char* kOwnCameraForm = "X,Y,Z:X,Y,Z[:DEG]";

/// "0.9,-0.8,1.3:0.2,-0.1,0.9": a place and what is looked at from there, in metres, and perhaps
/// the vertical field of view, 5 to 120 degrees. Nothing of any other text, of places farther than
/// 100 m, and of two places that are nearer to each other than 1 cm.
std::optional<OwnCamera> ParseOwnCamera(const std::string& text);

/// How imperfect sensors see the scene. They change what grammars see, and nothing else. The
/// default is without errors.
struct SensorSettings {
  double position_noise_m = 0;       ///< standard deviation of each coordinate of a pose
  double rotation_noise_deg = 0;     ///< standard deviation of each component of a rotation vector
  double contact_dropout_share = 0;  ///< of the touches in each frame that are not seen
  double lost_frames_share = 0;      ///< of the frames
  std::uint64_t seed = 1;

  bool IsPerfect() const {
    return position_noise_m == 0 && rotation_noise_deg == 0 && contact_dropout_share == 0 &&
           lost_frames_share == 0;
  }
};

/// When the grammar sees the scene, and which contacts count as support.
struct SensingSettings {
  int sensing_hz = 240;         ///< at most the world's rate
  double bearing_share = 0.05;  ///< contact points with less of the load are not support
  SensorSettings sensors = {};
};

/// A class and its base class: every Mug is a Cup.
struct BaseClass {
  std::string name;
  std::string of;
};

struct PictureYaml {
  Located<std::string> at;  ///< "reaching.begin", "putting_down.end", or a time: "1.25"; see
                            ///< harness/episode/run/run_scenario.h
  Located<std::string> camera{"three_quarter",
                              {}};  ///< one of CameraWords(), or an entity that is a camera
};
/// Cameras that every scenario has. The same as render::CameraNames(), which exists only in builds
/// with rendering.
const std::vector<std::string>& CameraWords();

/// A whole scenario.
struct Scenario {
  // Compiled once, not wherever one is made or destroyed.
  Scenario();
  Scenario(const Scenario& other);
  Scenario(Scenario&& other) noexcept;
  Scenario& operator=(const Scenario& other);
  Scenario& operator=(Scenario&& other) noexcept;
  ~Scenario();

  std::string name;
  std::string file;   ///< where it was read from
  std::string skill;  ///< the folder below scenarios/, or ""
  std::string shows;
  std::vector<truth::Claim> expects;
  std::string grammar = kDefaultGrammar;
  std::vector<std::string> tags;
  physics::Scene scene;  ///< its world has the engine, the rate and the seed
  SensingSettings sensing;
  std::vector<std::string> body_classes;  ///< one per scene body
  /// 0xRRGGBB of entities that say `color`, by name. Only pictures use them.
  std::map<std::string, std::uint32_t> colors;
  std::vector<BaseClass> base_classes;  ///< each class at most once
  std::vector<int> body_part_of;        ///< one per scene body: a scene body, or grammar::kNoEntity
  physics::Script script;
  std::vector<VariationYaml> variations;
  std::vector<Outcome> outcomes;
  std::vector<PictureYaml> pictures;
  grammar::Diagnostics warnings;  ///< about valid but suspicious input
};

/// Two frames of sensing, in ticks: a boundary is not known better than to the frame that shows it.
/// Boundaries may differ by this much where a golden line has no tolerance of its own.
grammar::Tick DefaultTolerance(const Scenario& scenario);

/// The names that `camera:` accepts: CameraWords() and the entities that are cameras.
std::vector<std::string> CamerasOf(const Scenario& scenario);

/// An error message if there is no such camera.
std::optional<std::string> WhyNoCamera(const Scenario& scenario, const std::string& camera);

// Classes of entities and their base classes: the built-in ones, and those that a scenario
// declares. Tested by tests/harness/scenario/resolve/classes_test.cc

/// A class and its base classes, the most special first.
std::vector<std::string> WithBaseClasses(const std::string& class_name,
                                         const std::vector<BaseClass>& base_classes);

/// All classes of a body of the scenario, most special first: its own and their base classes, then
/// the built-in ones.
std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body);

/// The words that `color:` accepts.
const std::vector<std::string>& ColorWords();

/// Of a word, or of "#RRGGBB"; no value for anything else.
std::optional<std::uint32_t> ColorOfText(std::string_view text);

/// Of the first colour word among the parts of a name that are joined by underscores.
std::optional<std::uint32_t> ColorInName(std::string_view name);

/// What things of a class usually look like: cartons are white, cans steel.
std::optional<std::uint32_t> ColorOfClass(std::string_view class_name);

}  // namespace prehend::scenario
