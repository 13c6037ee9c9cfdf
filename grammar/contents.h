// SPDX-License-Identifier: Apache-2.0
// What a compiled grammar names: its events, and what it expects of an episode. For callers
// that need no more of a program than that. Tested by tests/grammar/contents_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/drawing.h"
#include "grammar/base/source.h"

namespace prehend::grammar {

struct Program;  // grammar/program/program.h

/// As in the text: "grammar pick_and_place".
const std::string& GrammarName(const Program& program);
/// Whether both were compiled from the same texts; parameters may have other values.
bool SameTexts(const Program& a, const Program& b);

/// Names of the events, in the order of the files. Conditions are not among them.
std::vector<std::string> EventNames(const Program& program);
bool HasEvent(const Program& program, std::string_view name);

/// What an event is about, as it is declared.
struct EventSignature {
  std::string name;
  std::vector<std::string> roles;       ///< in the order of the head
  std::vector<std::string> classes;     ///< of the roles
  std::vector<std::string> attributes;  ///< of `with NAME = value`
  bool has_style = false;               ///< `with style = style(hand)`
  bool symmetric = false;               ///< its first two roles may be exchanged
  bool composed = false;                ///< `compose ..`: it consists of other events
  Drawing drawing;                      ///< `drawn as ..`
};
/// Of the events, in the order of EventNames().
std::vector<EventSignature> EventSignatures(const Program& program);

/// A part of space that a rule asks about: `in_sphere(object, ahead(hand, 30 cm), 30 cm)`.
struct RegionOfInterest {
  enum class Shape : std::uint8_t { kSphere, kCylinder };
  /// Where its middle is: in front of a hand's palm, or where an entity is at the moment, or was or
  /// will be when the event begins or ends.
  enum class Middle : std::uint8_t { kAhead, kNow, kAtBegin, kAtEnd };
  Shape shape = Shape::kSphere;
  Middle middle = Middle::kNow;
  int role = 0;    ///< of the event: whose place that is
  int inside = 0;  ///< of the event: who is to be inside
  double radius_m = 0;
  double height_m = 0;  ///< of a cylinder: so far above its middle, and below it
  double ahead_m = 0;   ///< Middle::kAhead: so far from the palm

  friend bool operator==(const RegionOfInterest&, const RegionOfInterest&) = default;
};
/// Those of the conditions that an event is made of, other events left out; with numbers that the
/// grammar fixes, and no larger than a room.
std::vector<RegionOfInterest> RegionsOf(const Program& program, std::string_view event);

/// What Compile() warned of.
const Diagnostics& CompileWarnings(const Program& program);

// What the grammar asks for by name and an episode may have or not, where the name first stands.
const std::vector<NameInSource>& NamedClasses(const Program& program);  ///< none is built in
const std::vector<NameInSource>& NamedSensorSets(const Program& program);
/// Sensor sets that are asked for by number: "3".
const std::vector<NameInSource>& NumberedSensorSets(const Program& program);

}  // namespace prehend::grammar
