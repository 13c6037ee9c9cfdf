// SPDX-License-Identifier: Apache-2.0
// Sort and sweep along x, then separating axes. Each body is reported once, so that the output
// stays readable. Tested by tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/scenario/resolve/penetration_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "harness/scenario/resolve/resolve.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"
#include "physics/scene/landing.h"
#include "physics/scene/run_limits.h"

namespace prehend::scenario {
namespace {

constexpr double kMaxOverlap_m = 0.001;  // hidden by the collision margins

/// A body or a hand.
struct Occupant {
  std::string name;
  Where where;
  bool hand = false;
  bool fixed = false;
  bool person = false;
  bool grains = false;
  std::vector<PlacedSolid> solids;
  Eigen::AlignedBox3d bounds;
};

void AddSolid(const physics::Shape& shape, const physics::Pose& X_WS, Occupant& occupant) {
  occupant.solids.push_back({shape, X_WS});
  occupant.bounds.extend(physics::WorldBounds(shape, X_WS));
}

Occupant OccupantOf(const physics::Body& body, Where where) {
  Occupant occupant{
      .name = body.name, .where = where, .fixed = body.fixed, .person = body.kinematic};
  if (body.abstract != physics::Abstract::kNot) return occupant;  // it takes no space
  for (const auto& placed : body.shapes) AddSolid(placed.shape, body.X_WB * placed.X_BS, occupant);
  if (!body.grains) return occupant;
  occupant.grains = true;
  for (const Eigen::Vector3d& p_WG_m : body.grains->p_WG_m)
    AddSolid(physics::Sphere{body.grains->radius_m}, {p_WG_m}, occupant);
  return occupant;
}

/// Palm and fingers, open in the first style.
Occupant OccupantOf(const physics::Hand& hand, Where where) {
  Occupant occupant{.name = hand.name, .where = where, .hand = true};
  const physics::HandModel& model = hand.model;
  AddSolid(physics::Box{model.palm_size_m}, hand.X_WH, occupant);
  const std::vector<double> joints = model.styles.empty()
                                         ? std::vector<double>(model.links.size())
                                         : physics::JointTargets(model.styles[0], 0);
  const std::vector<physics::Pose> poses = physics::LinkPoses(model, joints);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    AddSolid(physics::Box{{link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m}},
             hand.X_WH * poses[i], occupant);
  }
  return occupant;
}

double Depth(const Occupant& a, const Occupant& b) {
  double deepest = 0;
  if (!a.bounds.intersects(b.bounds)) return 0;
  for (const PlacedSolid& solid_a : a.solids) {
    for (const PlacedSolid& solid_b : b.solids)
      deepest = std::max(deepest, Penetration(solid_a, solid_b));
  }
  return deepest;
}

/// Bodies on the two sides of a joint never collide: a drawer may overlap its cabinet.
bool Joined(const physics::Scene& scene, std::size_t a, std::size_t b) {
  if (std::max(a, b) >= scene.bodies.size()) return false;
  return physics::NeverTouch(scene, physics::BodyIndex(a), physics::BodyIndex(b));
}

/// A person does not collide with fixed bodies, hands and other persons.
bool MayOverlap(const Occupant& a, const Occupant& b) {
  if (!a.person) return b.person && MayOverlap(b, a);
  return b.person || b.hand || b.fixed;
}

void Complain(const Occupant& later, const Occupant& earlier, double depth_m,
              DiagnosticList& errors) {
  const double depth_mm = depth_m * 1000;
  if (later.person) {
    errors.Add(
        later.where,
        fmt::format("'{}' starts inside '{}', {:.0f} mm deep", later.name, earlier.name, depth_mm),
        "move the person");
  } else if (later.hand) {
    errors.Add(
        later.where,
        fmt::format("actor '{}' starts inside '{}', {:.0f} mm deep", later.name, earlier.name,
                    depth_mm),
        "start the hand in free space; the thumb of an open hand hangs 10 cm below its palm");
  } else if (earlier.grains || later.grains) {
    errors.Add(later.where,
               fmt::format("'{}' overlaps '{}' by {:.0f} mm", later.name, earlier.name, depth_mm),
               "grains are placed around the vessel's vertical axis; keep it free");
  } else {
    errors.Add(later.where,
               fmt::format("'{}' overlaps '{}' by {:.0f} mm", later.name, earlier.name, depth_mm),
               fmt::format("'on: {}' with at_m: [x, y] puts it on top", earlier.name));
  }
}

/// Of a body's place. After the entities come the parts of the persons.
Where WhereOf(const ScenarioYaml& entry, const physics::Scene& scene, std::size_t body) {
  if (body < entry.entities.size()) return PlaceOf(entry.entities[body].value);
  Where where;
  for (std::size_t i = 0; i < scene.persons.size(); ++i) {
    if (scene.persons[i].head <= physics::BodyIndex(body))
      where = entry.persons[i].value.at_m.where;
  }
  return where;
}

using Eigen::Vector3d;

double ReachOf(const physics::Shape& shape, const Vector3d& n_S) {
  return n_S.dot(physics::FarthestAlong(shape, n_S));
}

/// How far it reaches along a unit direction, from its own origin.
double ReachAlong(const PlacedSolid& solid, const Vector3d& n_W) {
  return ReachOf(solid.shape, solid.X_WS.q.conjugate() * n_W);
}

/// The point of the solid's bounding box nearest to `p_W`, for axes that meet a box's corner.
Vector3d NearestInBox(const PlacedSolid& solid, const Vector3d& p_W) {
  Vector3d p_S = solid.X_WS.inverse() * p_W;
  for (int i = 0; i < 3; ++i) {
    const double least = -ReachOf(solid.shape, -Vector3d::Unit(i));
    p_S[i] = std::clamp(p_S[i], least, ReachOf(solid.shape, Vector3d::Unit(i)));
  }
  return solid.X_WS * p_S;
}

/// The directions of the edges of a hull; of other shapes their axes.
std::vector<Vector3d> EdgesOf(const PlacedSolid& solid) {
  const auto* hull = std::get_if<physics::Hull>(&solid.shape);
  std::vector<Vector3d> edges =
      hull ? physics::EdgesOf(*hull)
           : std::vector<Vector3d>{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (Vector3d& edge : edges) edge = solid.X_WS.q * edge;
  return edges;
}

/// What can separate hulls, beyond what can separate boxes.
void AddAxesOfHulls(const PlacedSolid& a, const PlacedSolid& b, std::vector<Vector3d>& axes) {
  bool any = false;
  for (const PlacedSolid* solid : {&a, &b}) {
    const auto* hull = std::get_if<physics::Hull>(&solid->shape);
    if (!hull) continue;
    any = true;
    for (const auto& face : hull->faces) axes.push_back(solid->X_WS.q * face.nhat_S);
    const Vector3d other_W = (solid == &a ? b : a).X_WS.p_m;
    axes.push_back(other_W -
                   solid->X_WS * physics::NearestIn(*hull, solid->X_WS.inverse() * other_W));
  }
  if (!any) return;
  const std::vector<Vector3d> edges_b = EdgesOf(b);
  for (const Vector3d& edge_a : EdgesOf(a))
    for (const Vector3d& edge_b : edges_b) axes.push_back(edge_a.cross(edge_b));
}

std::vector<Vector3d> CandidateAxes(const PlacedSolid& a, const PlacedSolid& b) {
  const Eigen::Matrix3d R_a = a.X_WS.q.toRotationMatrix(), R_b = b.X_WS.q.toRotationMatrix();
  const Vector3d between = b.X_WS.p_m - a.X_WS.p_m;
  std::vector<Vector3d> axes = {between, b.X_WS.p_m - NearestInBox(a, b.X_WS.p_m),
                                a.X_WS.p_m - NearestInBox(b, a.X_WS.p_m)};
  for (int i = 0; i < 3; ++i) {
    axes.push_back(R_a.col(i));
    axes.push_back(R_b.col(i));
    for (int j = 0; j < 3; ++j) axes.push_back(R_a.col(i).cross(R_b.col(j)));
  }
  for (const Eigen::Matrix3d& R : {R_a, R_b}) {  // radial directions of round shapes
    axes.push_back(between - R.col(2) * R.col(2).dot(between));
    const Vector3d corner = b.X_WS.p_m - NearestInBox(a, b.X_WS.p_m);
    axes.push_back(corner - R.col(2) * R.col(2).dot(corner));
  }
  AddAxesOfHulls(a, b, axes);
  return axes;
}

// Tested by tests/harness/scenario/resolve/validate_put_downs_test.cc

using physics::BodyIndex;

/// Fingers shift what they close around: a thing is where its script carries it, give or take this.
constexpr double kInexact_m = 0.01;
/// What is nearer than this to the way of a thing may be moved, too.
constexpr double kAround_m = 0.02;

/// Where a body is by the script.
struct Whereabouts {
  physics::Pose X_WB;
  Eigen::AlignedBox3d bounds;
  bool known = false;  ///< the script says it
};

struct HandByScript {
  BodyIndex body = {};   ///< the one last reached for, or none
  double trigger = 0;    ///< what its grip was last commanded to
  bool carries = false;  ///< the body has been moved since it was taken or put down
};

/// Plays the script without physics.
class OnPaper {
 public:
  OnPaper(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors)
      : entry_(entry), scene_(scene), errors_(errors) {
    for (const physics::Body& body : scene.bodies) {
      Whereabouts& at = at_.emplace_back(Whereabouts{body.X_WB, {}, physics::IsThing(body)});
      if (at.known) at.bounds = physics::WorldBounds(body, body.X_WB);
    }
  }

  void Play() {
    for (const StageYaml& stage : entry_.script) {
      std::set<std::string> actors;
      for (const Named<StepYaml>& step : stage) actors.insert(step.name);
      const bool in_turn =
          actors.size() < stage.size() || std::ranges::any_of(stage, [](const auto& step) {
            return TimingOf(step.value).after.has_value();
          });
      // When several actors act in turn it is not known here what each finds.
      const bool unknown = in_turn && actors.size() > 1;
      if (unknown) LoseAll();
      for (const Named<StepYaml>& step : stage)
        if (!in_turn) Check(step);  // they begin together
      for (const Named<StepYaml>& step : stage) {
        if (in_turn) Check(step);
        Play(step);
      }
      if (unknown) LoseAll();
    }
  }

  void operator()(const ReachYaml& e) {
    if (Holds()) Lose(hand_->body);
    hand_->body = physics::FindBody(scene_, e.reach.value);
    hand_->carries = false;
  }
  void operator()(const CloseYaml& e) { Trigger(e.close_to); }
  void operator()(const OpenYaml& e) { Trigger(e.open_to); }
  void operator()(const LiftYaml& e) { MoveBy({0, 0, e.lift_by_m}); }
  void operator()(const MoveYaml& e) { MoveBy(e.move_by_m.value); }
  void operator()(const CarryYaml& e) {
    if (hand_->body == physics::kNone) return LoseAll();
    const Vector3d centre = CentreOf(hand_->body);
    MoveBy({e.carry_to_m.value.x() - centre.x(), e.carry_to_m.value.y() - centre.y(), 0});
  }
  void operator()(const PlaceYaml& e) {
    const BodyIndex support = physics::FindBody(scene_, e.place_on.value);
    if (!Holds() || support == physics::kNone) return;
    const std::optional<physics::Pose> standing = RestOn(support, hand_->body);
    if (!standing || !At(support).known) return Lose(hand_->body);
    MoveBy(standing->p_m - At(hand_->body).X_WB.p_m);
    hand_->carries = false;
  }
  void operator()(const RetreatYaml&) {
    if (hand_->trigger <= 0) return;
    if (hand_->body == physics::kNone) return LoseAll();
    Lose(hand_->body);
  }
  void operator()(const FollowJointYaml&) { LoseAll(); }
  void operator()(const TurnHandYaml&) {
    if (Holds()) LoseAll();
  }
  void operator()(const OrbitYaml&) { LoseAll(); }
  void operator()(const PressYaml&) {
    if (hand_->trigger <= 0) LoseAll();
  }
  void operator()(const PosesYaml& e) {
    for (const PoseYaml& pose : e.poses) Follow(pose.trigger);
    LoseAll();
  }
  void operator()(const RecordingYaml& e) {
    for (const physics::TimedPose& pose : e.poses) Follow(pose.trigger);
    LoseAll();
  }
  void operator()(const WalkYaml&) { LoseAll(); }
  void operator()(const LeanYaml&) { LoseAll(); }
  void operator()(const SwayYaml&) { LoseAll(); }
  void operator()(const MoveLimbYaml&) { LoseAll(); }
  /// Waiting and looking move nothing.
  void operator()(
      const physics::OneOf<WaitYaml, LookAtYaml, LookAtPointYaml, EyesYaml, TurnYaml> auto&) {}

 private:
  void Play(const Named<StepYaml>& step) {
    hand_ = &hands_[step.name];
    std::visit(*this, step.value);
    // It ends somewhere on its way.
    if (TimingOf(step.value).until) LoseAll();
  }

  void Check(const Named<StepYaml>& step) {
    if (const auto* place = std::get_if<PlaceYaml>(&step.value)) Check(*place, hands_[step.name]);
  }

  Whereabouts& At(BodyIndex body) { return physics::At(at_, body); }
  const physics::Body& BodyOf(BodyIndex body) const { return scene_.body(body); }
  bool Holds() const { return hand_->body != physics::kNone && hand_->trigger > 0; }

  Vector3d CentreOf(BodyIndex body) {
    return At(body).X_WB * physics::BoundingBox(BodyOf(body)).p_BC_m;
  }

  std::optional<physics::Pose> RestOn(BodyIndex support, BodyIndex object) {
    return physics::RestOn(BodyOf(support), At(support).X_WB, BodyOf(object), At(object).X_WB);
  }

  bool IsAbove(BodyIndex support, const Eigen::Vector2d& p_W_m) {
    for (const double x : {0.0, -kInexact_m, kInexact_m}) {
      for (const double y : {0.0, -kInexact_m, kInexact_m}) {
        const Eigen::Vector2d nearby_m = p_W_m + Eigen::Vector2d(x, y);
        if (physics::IsAbove(BodyOf(support), At(support).X_WB, nearby_m)) return true;
      }
    }
    return false;
  }

  /// Whether a hand other than this one holds the body.
  bool IsHeldByAnother(BodyIndex body, const HandByScript& than) const {
    return std::ranges::any_of(hands_, [&](const auto& named) {
      const HandByScript& hand = named.second;
      return &hand != &than && hand.body == body && hand.trigger > 0;
    });
  }

  void Follow(const std::optional<double>& trigger) {
    if (trigger) hand_->trigger = std::max(hand_->trigger, *trigger);
  }

  void Trigger(double to) {
    if (to < hand_->trigger && hand_->carries && hand_->body != physics::kNone) Lose(hand_->body);
    if (to < hand_->trigger) hand_->carries = false;
    hand_->trigger = to;
  }

  /// An open hand that goes up or down touches nothing; another one pushes who knows what.
  void MoveBy(const Vector3d& by_m) {
    const bool aside = by_m.head<2>().squaredNorm() > 0;
    if (hand_->trigger <= 0 && !aside) return;
    if (!Holds()) return LoseAll();
    const BodyIndex body = hand_->body;
    if (BodyOf(body).fixed) return;
    if (physics::JointThatMoves(scene_, body) >= 0) return LoseAll();
    if (physics::RootOf(scene_, body) != body || IsHeldByAnother(body, *hand_)) return Lose(body);
    Eigen::AlignedBox3d way = At(body).bounds;
    At(body).X_WB.p_m += by_m;
    At(body).bounds.translate(by_m);
    LoseWhatTouches(body, way.merged(At(body).bounds));
    hand_->carries = true;
  }

  void LoseAll() {
    for (std::size_t i = 0; i < at_.size(); ++i) at_[i].known &= scene_.bodies[i].fixed;
  }

  /// It may be anywhere now, and what is on it or beside it likewise.
  void Lose(BodyIndex body) {
    if (!At(body).known || BodyOf(body).fixed) return;
    At(body).known = false;
    LoseWhatTouches(body, At(body).bounds);
  }

  /// What a thing stands on stays where it is.
  void LoseWhatTouches(BodyIndex body, const Eigen::AlignedBox3d& way) {
    const Eigen::AlignedBox3d around(way.min() - Vector3d(kAround_m, kAround_m, 0),
                                     way.max() + Vector3d::Constant(kAround_m));
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const BodyIndex other(i);
      if (other == body || !at_[i].known || !at_[i].bounds.intersects(around)) continue;
      if (at_[i].bounds.max().z() > way.min().z() + 0.001) Lose(other);
    }
  }

  /// The deepest of the known things that the object would be in, and how deep.
  std::pair<BodyIndex, double> InTheWay(BodyIndex object, const physics::Pose& X_WO,
                                        BodyIndex support, const HandByScript& hand) {
    std::pair<BodyIndex, double> deepest{physics::kNone, kInexact_m};
    const physics::Body& held = BodyOf(object);
    const Eigen::AlignedBox3d bounds = physics::WorldBounds(held, X_WO);
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const BodyIndex other(i);
      const physics::Body& body = scene_.bodies[i];
      if (other == object || other == support || !at_[i].known || body.kinematic) continue;
      if (!at_[i].bounds.intersects(bounds) || IsHeldByAnother(other, hand)) continue;
      for (const physics::PlacedShape& a : held.shapes) {
        for (const physics::PlacedShape& b : body.shapes) {
          const double depth_m =
              Penetration({a.shape, X_WO * a.X_BS}, {b.shape, at_[i].X_WB * b.X_BS});
          if (depth_m > deepest.second) deepest = {other, depth_m};
        }
      }
    }
    return deepest;
  }

  void Check(const PlaceYaml& e, const HandByScript& hand) {
    const BodyIndex object = hand.body, support = physics::FindBody(scene_, e.place_on.value);
    if (object == physics::kNone || hand.trigger <= 0 || support == physics::kNone ||
        object == support)
      return;
    if (!At(object).known || !At(support).known || BodyOf(object).fixed) return;
    if (physics::JointThatMoves(scene_, object) >= 0 || IsHeldByAnother(object, hand)) return;
    const std::string &held = BodyOf(object).name, &below = BodyOf(support).name;
    const Vector3d centre = CentreOf(object);
    const std::string where =
        fmt::format("by the steps before, '{}' is at [{:.2f}, {:.2f}, {:.2f}]", held, centre.x(),
                    centre.y(), centre.z());
    const std::optional<physics::Pose> standing = RestOn(support, object);
    if (!standing) {
      return errors_.Add(e.place_on.where,
                         fmt::format("place_on: no part of '{}' is below '{}'", below, held),
                         where + "; carry it there first");
    }
    if (!IsAbove(support, centre.head<2>())) {
      return errors_.Add(
          e.place_on.where,
          fmt::format("place_on: the centre of '{}' is not above '{}': it would tip over", held,
                      below),
          where + "; carry its centre over it");
    }
    if (const auto [other, depth_m] = InTheWay(object, *standing, support, hand);
        other != physics::kNone) {
      errors_.Add(e.place_on.where,
                  fmt::format("place_on: '{}' is in the way: '{}' would overlap it by {:.0f} mm",
                              BodyOf(other).name, held, 1000 * depth_m),
                  where + "; carry it to a free place");
    }
  }

  const ScenarioYaml& entry_;
  const physics::Scene& scene_;
  DiagnosticList& errors_;
  std::vector<Whereabouts> at_;
  std::map<std::string, HandByScript> hands_;
  HandByScript* hand_ = nullptr;  ///< whose step is played
};

}  // namespace

void ValidateDistances(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors) {
  const auto check = [&](Where where, const Eigen::Vector3d& p_W_m) {
    if (p_W_m.norm() <= physics::kMaxDistance_m) return;
    errors.Add(where,
               fmt::format("at_m: expected a place within {} m of the origin, found one {:.1f} "
                           "m from it",
                           physics::kMaxDistance_m, p_W_m.norm()));
  };
  for (std::size_t i = 0; i < entry.entities.size(); ++i)
    check(WhereOf(entry, scene, i), scene.bodies[i].X_WB.p_m);
  for (const auto& person : entry.persons) check(person.value.at_m.where, person.value.at_m.value);
  for (const auto& hand : entry.hands) check(hand.value.at_m.where, hand.value.at_m.value);
}

void ValidatePlacement(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors) {
  std::vector<Occupant> occupants;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    occupants.push_back(OccupantOf(scene.bodies[i], WhereOf(entry, scene, i)));
  }
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    occupants.push_back(OccupantOf(scene.hands[i], entry.hands[i].value.at_m.where));
  }
  std::vector<std::size_t> by_x(occupants.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(occupants[a].bounds.min().x(), a) <
           std::tuple(occupants[b].bounds.min().x(), b);
  });

  std::set<std::size_t> complained;
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x.size(); ++j) {
      const auto [earlier, later] = std::minmax(by_x[i], by_x[j]);
      if (occupants[by_x[j]].bounds.min().x() > occupants[by_x[i]].bounds.max().x()) break;
      if (complained.contains(later)) continue;
      const double depth_m = Depth(occupants[earlier], occupants[later]);
      if (depth_m <= kMaxOverlap_m || Joined(scene, earlier, later)) continue;
      if (MayOverlap(occupants[earlier], occupants[later])) continue;
      Complain(occupants[later], occupants[earlier], depth_m, errors);
      complained.insert(later);
    }
  }
}

double Penetration(const PlacedSolid& a, const PlacedSolid& b) {
  constexpr double kTooShortForAnAxis = 1e-6;
  const Vector3d between = b.X_WS.p_m - a.X_WS.p_m;
  double depth = std::numeric_limits<double>::infinity();
  for (const Vector3d& axis : CandidateAxes(a, b)) {
    const double length = axis.norm();
    if (length < kTooShortForAnAxis) continue;
    const Vector3d n = axis / length;
    for (const Vector3d& way : {n, Vector3d(-n)})
      depth = std::min(depth, ReachAlong(a, way) + ReachAlong(b, -way) - way.dot(between));
    if (depth <= 0) return depth;
  }
  return depth;
}

void ValidatePutDowns(const ScenarioYaml& entry, const physics::Scene& scene,
                      DiagnosticList& errors) {
  OnPaper(entry, scene, errors).Play();
}

}  // namespace prehend::scenario
