// SPDX-License-Identifier: Apache-2.0
// The scenario format, version 1, as one struct. Its YAML face is the field table in
// harness/format/scenario_fields.cc, which drives both the reader (harness/read/read_scenario.h)
// and the JSON Schema. What it means to physics and grammar is what BuildScene() etc. make of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/default_grammar.h"
#include "harness/base/located.h"
#include "harness/scenario/variations.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// When the grammar sees the scene, and what of it.
struct SensingSettings {
  int sensing_hz = 240;         ///< at most the world's rate
  double bearing_share = 0.05;  ///< of the load of two that touch: a point with less bears nothing
};

/// A class and what it is a kind of: every Mug is a Cup.
struct BaseClass {
  std::string name;
  std::string of;
};

struct PictureYaml {
  Located<std::string> at;  ///< "reaching.begin", "putting_down.end", or a time: "1.25"; see
                            ///< harness/run/event_time.h
  Located<std::string> camera{"three_quarter",
                              {}};  ///< one of CameraWords(), or an entity that is a camera
};
/// Cameras that every scenario has; the same as render::CameraNames(), which is there only with the
/// render room.
const std::vector<std::string>& CameraWords();

/// A whole scenario, read, checked and resolved: entities and actors are already bodies and hands.
struct Scenario {
  std::string name;
  std::string file;   ///< where it was read from
  std::string skill;  ///< the folder below scenarios/, or ""
  std::string shows;
  std::string grammar = kDefaultGrammar;
  std::vector<std::string> tags;
  physics::Scene scene;  ///< its world has the engine, the rate and the seed
  SensingSettings sensing;
  std::vector<std::string> body_classes;  ///< one per scene body
  std::vector<BaseClass> kinds;           ///< each class at most once
  std::vector<int> body_part_of;  ///< one per scene body: a scene body, or grammar::kNoEntity
  physics::Script script;
  std::vector<VariationYaml> variations;
  std::vector<Outcome> outcomes;
  std::vector<PictureYaml> pictures;
  grammar::Diagnostics warnings;  ///< about what can be used, but is odd
};

/// From where pictures can be made: CameraWords(), and the entities that are cameras.
std::vector<std::string> CamerasOf(const Scenario& scenario);

/// Why no picture can be made from this camera, or nothing.
std::optional<std::string> WhyNoCamera(const Scenario& scenario, const std::string& camera);

}  // namespace prehend::harness
