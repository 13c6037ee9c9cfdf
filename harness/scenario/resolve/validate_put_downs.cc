// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/validate_put_downs_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "harness/scenario/resolve/resolve.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"
#include "physics/scene/landing.h"

namespace prehend::scenario {
namespace {

using physics::BodyIndex;

using Eigen::Vector3d;

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
          where + "; carry it farther");
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

void ValidatePutDowns(const ScenarioYaml& entry, const physics::Scene& scene,
                      DiagnosticList& errors) {
  OnPaper(entry, scene, errors).Play();
}

}  // namespace prehend::scenario
