// SPDX-License-Identifier: Apache-2.0
// The vocabulary of what can be observed: who takes part (EntityTable, fixed for a run) and what
// one look at the world says (Frame). A grammar sees nothing else; simulated, recorded and
// hand-written episodes all enter here.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/solid.h"

namespace prehend::grammar {

/// One physics step. Seconds exist only in text.
using Tick = std::int64_t;

/// Half-open [begin, end) in ticks.
struct Interval {
  Tick begin = 0;
  Tick end = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

inline constexpr int kNoEntity = -1;

/// One entity that can be bound to a role. Its index in EntityTable::entities is its id.
struct EntityInfo {
  std::string name;
  /// Most specific first, e.g. {"MilkCarton", "Movable", "Thing", "Entity"} or {"Hand", "Entity"}.
  /// The built-in roots are Entity; Hand; Thing, and of these Movable, Fixed, Jointed (on a slider
  /// or a hinge, as a drawer is) and Attached (glued to a Thing, or on a ball joint); Abstract (no
  /// matter: a Region, say) and Grains, which are no Things.
  std::vector<std::string> classes;
  int part_of = kNoEntity;
  /// Centre and half sizes of the oriented bounding box, in the entity's own frame, metres.
  Eigen::Vector3d p_BC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  /// Its true shape, for distances from its surface. Empty: it fills its bounding box.
  Solid solid;
  bool round = false;  ///< it is the ball in that box: a region may be one
  /// Hands only: names of the sensor sets; bit i of Touch::sensor_sets is set i. At most 32.
  std::vector<std::string> sensor_sets;
  double mass_kg = 0;  ///< 0: not known, nothing is too heavy
  double strength_n =
      0;  ///< hands only: the weight that it can lift; 0: not known, it lifts everything
};

/// Whether it is one of the classes that an entity has by what it is; nobody declares these.
inline bool IsRootClass(std::string_view name) {
  constexpr std::array<std::string_view, 15> kRoots = {
      "Entity",   "Thing",  "Movable",  "Fixed",  "Jointed",    "Attached", "Hand", "Person",
      "BodyPart", "Grains", "Abstract", "Region", "GazeTarget", "Camera",   "Light"};
  return std::ranges::find(kRoots, name) != kRoots.end();
}
/// Of the classes that somebody gives an entity the first that is a root, but none of its `own`;
/// "" if there is none.
inline std::string WrongRoot(const std::vector<std::string>& given,
                             const std::vector<std::string>& own) {
  for (const std::string& name : given)
    if (IsRootClass(name) && std::ranges::find(own, name) == own.end()) return name;
  return "";
}

struct EntityTable {
  Tick ticks_per_second = 480;
  std::vector<EntityInfo> entities;
  std::vector<std::string> styles;  ///< names of grasp styles; HandSample::style indexes them
};

/// Pose and velocity of one entity's body frame B in the world W (z up).
struct EntitySample {
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_m_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_rad_per_s = Eigen::Vector3d::Zero();
  bool asleep = false;
  bool bridged = false;  ///< nothing was seen: the last look still counts
  /// Of a moving part of furniture: radians of a hinge, metres of a slide; and 0 closed .. 1 open.
  double joint_position = 0;
  double joint_fraction = 0;
  /// Of a person, camera or head: the entity it looks at.
  int gazes_at = kNoEntity;
};

// Not tracked is a value: a look of which nobody knows where its entity is. No condition that reads
// such a look holds, and neither does its opposite (docs/recording-format.md). Tested by
// tests/grammar/engine/tracking_test.cc

inline bool IsTracked(const EntitySample& look) { return !std::isnan(look.p_WB_m.x()); }
/// What a grammar sees counts for a short time without it; what is written for others is this.
inline bool IsMeasured(const EntitySample& look) { return IsTracked(look) && !look.bridged; }

/// Of two numbers or none.
inline bool SameNumber(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Whether no grammar can tell one look from the other: in all but `asleep` and `bridged` they are
/// the same.
inline bool SameFacts(const EntitySample& a, const EntitySample& b) {
  // All are named, so that a new one does not compile before it is here.
  const auto& [p_WB_m, q_WB, v_WB, w_WB, asleep, bridged, joint_position, joint_fraction,
               gazes_at] = a;
  if (!IsTracked(a) && !IsTracked(b)) {
    const auto same = [](const auto& x, const auto& y) {
      return std::equal(x.data(), x.data() + x.size(), y.data(), SameNumber);
    };
    return same(p_WB_m, b.p_WB_m) && same(q_WB.coeffs(), b.q_WB.coeffs()) &&
           same(v_WB, b.v_WB_m_per_s) && same(w_WB, b.w_WB_rad_per_s) &&
           SameNumber(joint_position, b.joint_position) &&
           SameNumber(joint_fraction, b.joint_fraction) && gazes_at == b.gazes_at;
  }
  return p_WB_m == b.p_WB_m && q_WB.coeffs() == b.q_WB.coeffs() && v_WB == b.v_WB_m_per_s &&
         w_WB == b.w_WB_rad_per_s && joint_position == b.joint_position &&
         joint_fraction == b.joint_fraction && gazes_at == b.gazes_at;
}

/// A ball that stands for a piece of a hand's surface, for distances from hand to object.
struct CollisionSphere {
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  double radius_m = 0;
  friend bool operator==(const CollisionSphere&, const CollisionSphere&) = default;
};

/// How fast, up or down, their material moves against each other at a point, m/s.
inline double VerticalSpeedBetween(const EntitySample& a, const EntitySample& b,
                                   const Eigen::Vector3d& p_W_m) {
  const auto velocity = [&](const EntitySample& look) -> Eigen::Vector3d {
    return look.v_WB_m_per_s + look.w_WB_rad_per_s.cross(p_W_m - look.p_WB_m);
  };
  return std::abs(velocity(a).z() - velocity(b).z());
}

/// What is only known of hands.
struct HandSample {
  int entity = kNoEntity;
  double trigger = 0;  ///< commanded grip, 0 open .. 1 closed
  int style = 0;       ///< index into EntityTable::styles
  Eigen::Vector3d ahead_W =
      Eigen::Vector3d::UnitX();  ///< unit vector from the palm to where the hand reaches
  std::span<const CollisionSphere> collision_spheres;  ///< at least one
};

/// Two entities whose surfaces touch now. At most one per pair, however many points or links touch.
struct Touch {
  int a = kNoEntity;  ///< a < b
  int b = kNoEntity;
  /// Largest up (world z) component, over the touching points that carry load, of the contact
  /// normal on a (pointing out of b into a), and the same for b. 1: held from below. 0: side by
  /// side. -1: it lies below.
  double up_on_a = -1;
  double up_on_b = -1;
  double normal_force_n = 0;
  /// How fast, up or down, the two surfaces move against each other where the touch bears load:
  /// about 0 while one stands, tips or rolls on the other, more while they bounce off. No number if
  /// it is not known.
  double vertical_speed_m_per_s = 0;
  /// Where the touch bears load, and the contact normal on a there (out of b into a). Without a
  /// normal (zero) neither is known.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d nhat_BA_W = Eigen::Vector3d::Zero();
  std::uint32_t sensor_sets = 0;  ///< when one of the two is a hand: which of its sensor sets touch
  friend bool operator==(const Touch&, const Touch&) = default;
};

/// One look at the world. Ticks increase from frame to frame by any amount. Spans live until the
/// next frame.
struct Frame {
  Tick tick = 0;
  std::span<const EntitySample> entities;  ///< one per EntityTable::entities, same order
  std::span<const HandSample> hands;       ///< sorted by entity
  std::span<const Touch> touches;          ///< sorted by (a, b)
};

/// One entity whose pose or velocity is not as it was.
struct EntityChange {
  int entity = kNoEntity;
  EntitySample look;
};

/// Two entities that have stopped touching, in any order.
struct ContactEnd {
  int a = kNoEntity;
  int b = kNoEntity;
};

/// One look at the world as what is new in it: whatever is not mentioned is as it was in the frame
/// before. Before the first one, everything is at the origin and nothing touches. A pair among both
/// touches and contact ends touches.
struct FrameChanges {
  Tick tick = 0;
  std::span<const EntityChange> entities;  ///< each entity at most once
  std::span<const HandSample> hands;       ///< each hand at most once
  std::span<const Touch> touches;          ///< that began, or whose measured values changed
  std::span<const ContactEnd> contact_ends;
};

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// `vertical_speed_m_per_s` where no contact point is known: the upper entity is close to it. Side
/// by side, nothing bears load.
inline double SpeedAtTheUpper(const Touch& touch, const EntitySample& a, const EntitySample& b) {
  const bool is_beside = touch.up_on_a == 0 && touch.up_on_b == 0;
  if (!IsTracked(a) || !IsTracked(b)) return kNotKnown;
  if (is_beside) return 0;
  return VerticalSpeedBetween(a, b, (touch.up_on_a >= touch.up_on_b ? a : b).p_WB_m);
}

/// All that is measured of it is no number.
inline EntitySample NotTracked() {
  EntitySample look;
  look.p_WB_m.setConstant(kNotKnown);
  look.q_WB.coeffs().setConstant(kNotKnown);
  look.v_WB_m_per_s.setConstant(kNotKnown);
  look.w_WB_rad_per_s.setConstant(kNotKnown);
  look.joint_position = look.joint_fraction = kNotKnown;
  return look;
}

}  // namespace prehend::grammar
