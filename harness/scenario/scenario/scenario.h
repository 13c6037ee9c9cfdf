// SPDX-License-Identifier: Apache-2.0
// A scenario that is read, checked and resolved: names are indices, entities are bodies, actors are
// hands and persons. What the file says is ScenarioYaml (harness/scenario/format/scenario_yaml.h);
// harness/scenario/read/read_scenario.h turns one into the other. Tested by
// tests/harness/scenario/scenario/scenario_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/default_grammar.h"
#include "harness/base/base/located.h"
#include "harness/scenario/scenario/variations.h"
#include "harness/truth/claims/claim.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

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

/// Whether every scenario has this class; a scenario may not declare one of the same name.
bool IsScenarioBuiltinClass(const std::string& name);

/// A class and its base classes, the most special first.
std::vector<std::string> WithBaseClasses(const std::string& class_name,
                                         const std::vector<BaseClass>& base_classes);

/// All classes of a body of the scenario, most special first: its own and their base classes, then
/// the built-in ones.
std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body);

}  // namespace prehend::scenario
