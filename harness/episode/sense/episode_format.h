// SPDX-License-Identifier: Apache-2.0
// The lines of an episode file, as structs and their formats: docs/recording-format.md. The reader
// is harness/episode/sense/read_episode.cc. What a grammar knows of a scenario before its first
// frame: the entities, in the order of their indices in a Frame. Tested by
// tests/harness/episode/sense/episode_file_test.cc,
// tests/harness/scenario/read/read_scenario_test.cc and tests/harness/episode/sense/sensing_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/scene.h"

namespace prehend::episode {

inline constexpr double kMaxPosition_m = 1e4;
inline constexpr double kMaxVelocity = 1e11;  ///< m/s, rad/s: more than any way within a tick gives
inline constexpr std::int64_t kLatestTick = 1'000'000'000'000;
inline constexpr std::size_t kMaxCollisionSpheres = 1000;

/// A convex piece of an entity, in the first line.
struct PartEntry {
  std::optional<grammar::Box> box;
  std::optional<grammar::Ball> sphere;
  std::optional<grammar::Cylinder> cylinder;
  std::optional<grammar::Capsule> capsule;
  std::optional<grammar::Hull> hull;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector4d quat_wxyz = {1, 0, 0, 0};
};

/// One entity, in the first line.
struct MemberEntry {
  std::string class_name = "Object";
  bool fixed = false;
  bool jointed = false;
  bool attached = false;
  bool grains = false;
  bool person = false;
  bool hand = false;
  bool round = false;
  std::string abstract;            ///< its class, if that is an abstract one; else ""
  std::vector<std::string> kinds;  ///< the base classes of its class
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::vector<PartEntry> parts;
  double mass_kg = 0, strength_n = 0;
  std::optional<Located<std::string>> part_of;
  std::vector<std::string> sensor_sets = {"fingers", "thumb", "palm"};
};

/// The first line.
struct HeaderEntry {
  int version = kEpisodeVersion;
  std::string episode;
  Located<std::string> grammar = {kDefaultGrammar, {}};
  std::int64_t ticks_per_second = 0;
  double bridge_s = kBridge_s;
  std::optional<bool> success;
  std::string language;
  std::vector<std::string> styles;
  std::vector<Named<MemberEntry>> entities;
};

/// How an entity is, in a frame.
struct SampleEntry {
  bool not_tracked = false;  ///< null
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  std::optional<Located<Eigen::Vector4d>> quat_wxyz;
  std::optional<Eigen::Vector3d> v_m_per_s, w_rad_per_s;
  bool asleep = false;
  double joint_position = 0, joint_fraction = 0;
  std::optional<Located<std::string>> gazes_at;
};

/// How a hand is, in a frame.
struct HandEntry {
  double trigger = 0;
  std::optional<Eigen::Vector3d> ahead;
  std::vector<Eigen::Vector4d> collision_spheres_m;
  std::optional<Located<std::string>> style;
};

/// A touch, in a frame.
struct TouchEntry {
  Located<std::string> a, b;
  double up_on_a = 0;
  std::optional<double> up_on_b;
  double force_n = 0;
  std::optional<double> vertical_speed_m_per_s;
  std::optional<Eigen::Vector3d> at_m, normal;
  std::vector<Located<std::string>> sensor_sets;
};

/// A frame: a line.
struct FrameEntry {
  Located<std::int64_t> tick;
  std::vector<Named<SampleEntry>> samples;
  std::vector<Named<HandEntry>> hands;
  std::vector<TouchEntry> touches;
  std::vector<FrameEntry> before = {};  ///< that come with it, or not at all
};

/// The last line, which may be missing.
struct EndEntry {
  Located<std::int64_t> end_tick;
};

using LineEntry = std::variant<FrameEntry, EndEntry>;

ValueFormat<HeaderEntry> HeaderFormat();
ValueFormat<LineEntry> LineFormat();

// The usual frame of a recording, read straight from its text: nothing but numbers, plain names and
// known keys, as `import` and trackers write them. It gives what the field tables of
// harness/episode/sense/episode_format.h give, some twenty times faster, and leaves everything else
// to them: every mistake, and what is rare. Tested by
// tests/harness/episode/sense/scan_frame_test.cc

/// False if the line is anything else than a frame without touches, or has a mistake, a value out
/// of its bounds or a key twice; then `frame` means nothing. Places are not filled in. Memory of
/// `frame` is used again.
bool ScanFrame(std::string_view line, FrameEntry& frame);

/// The grasp styles of all hands, each name once, in the order of the hands.
/// grammar::HandSample::style is an index into this list; a snapshot's style is one into the list
/// of its own hand.
std::vector<std::string> StyleNames(const physics::Scene& scene);

/// The entities that can be bound to roles: the scene's bodies (same index), then its hands.
grammar::EntityTable MakeEntityTable(const scenario::Scenario& scenario);

}  // namespace prehend::episode
