// SPDX-License-Identifier: Apache-2.0
// What the recording shows before any number of the definitions is applied: who touches whom, with
// which force, moving how; how far hands are from things. It is computed once per recording and
// serves every choice of numbers. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "harness/truth/oracle/recording.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

/// How one body bears on another in one frame.
struct Bearing {
  bool touching = false;
  double up = -1;    ///< upward component of the direction of the force on the object
  double share = 0;  ///< upward force over the object's weight; infinite without known forces
  /// Of the object relative to the support, vertical: the slower of its middle and of the point
  /// where it is borne.
  double vertical_m_per_s = std::numeric_limits<double>::infinity();
  /// Of the object's material relative to the support's, along their common tangent plane, where
  /// the load has its centre or below the object's middle: the slower of the two, so that it does
  /// not slide where it turns about either.
  double along_m_per_s = 0;
  /// Sums of that motion since the first frame, as seen from the support: of the load, the middle.
  std::array<Eigen::Vector3d, 2> along_m = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// One per frame. What rests bears as in the frame before, which is kept once.
struct Bearings {
  std::vector<Bearing> kept;
  std::vector<std::size_t> which;  ///< by frame
  const Bearing& operator[](int frame) const { return kept[which[frame]]; }
};

class Evidence {
 public:
  explicit Evidence(const Recording& recording);

  /// Entities a < b that ever touch, and when.
  std::map<Pair, Spans> touching;
  /// Of (hand index, body): which sensor sets touch, one bit each, by frame.
  std::map<Pair, std::vector<std::uint32_t>> sensor_sets;
  /// Of (hand index, body): the normal force between them, newtons, by frame.
  std::map<Pair, std::vector<double>> forces_n;
  /// Of (object, support), the object movable, the support a thing: by frame.
  std::map<Pair, Bearings> bearings;

  const Recording& recording;

  /// Between the surfaces of a hand (palm and links) and a body, metres; 0 when they touch.
  double Distance_m(int hand, int body, int frame) const;
  /// How fast palm and fingers moved since the frame before: the fastest of them, m/s.
  double Motion_m_per_s(int hand, int frame) const;
  /// How far palm or a finger is in one frame from where it is in another: the farthest, metres.
  double Apart_m(int hand, int frame, int other) const;
  /// Whether palm or a finger gets farther than this from where it is, within `window_s` / 2 before
  /// or after, in frames before `end`.
  bool Leaves(int hand, int frame, double distance_m, double window_s, int end) const;
  /// Whether the body's true shape reaches into the hand's region of interest: the sphere ahead of
  /// the palm that touches its centre.
  bool InReachRegion(int hand, int body, int frame, double radius_m) const;

 private:
  mutable std::map<Pair, std::vector<double>> distances_;
  mutable std::map<int, std::vector<double>> motions_;
  mutable std::map<std::tuple<int, double, double>, std::vector<double>> leaves_;
  mutable std::map<std::tuple<int, int, double>, std::vector<double>> in_reach_;
};

// Distances between true surfaces: boxes, spheres, cylinders, capsules, hulls and what is made of
// them. Tested by tests/harness/truth/oracle/oracle_test.cc

/// Between the surfaces of the hand (palm and links) and of the body, metres; 0 when they touch or
/// overlap. Within 0.01 mm.
double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state);

/// Of a point from the body, metres; 0 inside.
double PointDistance(const Eigen::Vector3d& p_W_m, const physics::Body& body,
                     const physics::BodyState& state);

// Contacts, supports and grasps: what follows from touching alone.

struct Grasp {
  int hand = 0;  ///< index into Scene::hands
  int body = 0;
  Span span;
  int touched_since = 0;  ///< the hand touches it, and has not grasped it in between
  auto operator<=>(const Grasp&) const = default;
};

/// Gaps are bridged as the definitions allow.
struct Touches {
  std::map<Pair, Spans> contacts;  ///< entities a < b
  std::map<Pair, Spans> supports;  ///< (object, support), both bodies, the object movable
};
Touches FindTouches(const Evidence& evidence, const SupportSettings& settings);

/// Sorted by hand, body, time; without `touched_since`.
std::vector<Grasp> FindGrasps(const Evidence& evidence, const GraspSettings& settings);

// What a hand does with an object during one grasp.

struct Carrying {
  Spans slides, pick_ups, hovers, transports, put_downs;
};

/// `supports`: when the grasped object was supported, by support. Only for movable objects: a wall
/// that is grasped is not carried, however little supports it.
Carrying FindCarrying(const Evidence& evidence, const OracleSettings& settings, const Grasp& grasp,
                      const std::map<int, Spans>& supports);

// How something came to a place: the moment since which it was coming.

struct DistanceAt {
  double t_s = 0;
  double distance_m = 0;
};

/// Where the last uninterrupted approach to the end of `path` begins: an index. Going away by up to
/// `dead_band_m` does not interrupt. After a longer retreat the approach begins at the turning
/// point; if it pauses there, when it returns.
int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings);

/// Where the last approach to a landing begins: an index. Distances are medians over a window, so
/// that single errors are no retreat. After a retreat it begins with the movement that leaves the
/// turning point; a pause there does not belong to it.
int LandingApproachBegin(std::span<const DistanceAt> path, const OracleSettings& settings);

/// The frame, in [earliest, touch], at which the hand's reach for the body began that ended with
/// touching it.
int ReachBegin(const Evidence& evidence, const OracleSettings& settings, int hand, int body,
               int earliest, int touch);

}  // namespace prehend::truth
