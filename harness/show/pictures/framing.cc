// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/compose_picture.h"
#include "harness/show/pictures/scenery.h"
#include "physics/scene/geometry.h"

namespace prehend::show {
namespace {

/// A larger body is scenery: it does not affect what the camera frames.
constexpr double kSceneryFrom_m = 0.5;
/// A body that moves farther than this takes part in the action.
constexpr double kMoves_m = 0.02;
/// What is nearer to a hand than this is framed with it.
constexpr double kNearHand_m = 0.18;
constexpr double kNearStar_m = 0.08;
/// A table larger than this is cut by `top`.
constexpr double kMostTable_m = 2.5;
constexpr double kPalmReach_m = 0.11;
constexpr double kLeastRise =
    0.25;                           ///< of the eye of `hand` above what it looks at, per way across
constexpr float kLeastFrom = 0.1f;  ///< shorter: the hands look in opposite directions
/// Snapshots that are looked at per episode, at most.
constexpr std::size_t kLooks = 400;

class Framing {
 public:
  Framing(const scenario::Scenario& scenario, const episode::RunResult& run,
          const PictureFormat& format)
      : scenario_(scenario), run_(run) {
    const double rate_hz = static_cast<double>(run.timeline.ticks_per_second);
    const auto index_of = [&](double time_s) {
      const auto tick = static_cast<grammar::Tick>(time_s * rate_hz);
      const auto at = std::ranges::lower_bound(run.recording, tick, {}, &physics::Snapshot::tick);
      return std::min(run.recording.size() - 1,
                      static_cast<std::size_t>(at - run.recording.begin()));
    };
    if (format.framed_from_s) first_ = index_of(*format.framed_from_s);
    last_ = format.framed_to_s ? std::max(first_, index_of(*format.framed_to_s))
                               : run.recording.size() - 1;
  }

  void AddBody(std::size_t body, const physics::Snapshot& now) {
    const physics::LocalBox local = physics::BoundingBox(scenario_.scene.bodies[body]);
    AddBall((now.bodies[body].X_WB * local.p_BC_m), local.half_size_m.norm());
  }
  void AddBall(const Eigen::Vector3d& p_W_m, double radius_m) {
    box_.extend(Eigen::Vector3d(p_W_m.array() - radius_m));
    box_.extend(Eigen::Vector3d(p_W_m.array() + radius_m));
  }
  void AddHand(const physics::HandState& hand) { AddBall(hand.palm.X_WB.p_m, kPalmReach_m); }
  void AddHands(const physics::Snapshot& now) {
    for (const physics::HandState& hand : now.hands) AddHand(hand);
  }
  /// Of the time that is framed, evenly.
  template <class Visit>
  void ForEachLook(const Visit& visit) const {
    const std::size_t step = std::max<std::size_t>(1, (last_ - first_ + 1) / kLooks);
    for (std::size_t i = first_; i <= last_; i += step) visit(run_.recording[i]);
    visit(run_.recording[last_]);
  }
  bool Moves(std::size_t body) const {
    double most_m = 0;
    const Eigen::Vector3d begin = run_.recording.front().bodies[body].X_WB.p_m;
    ForEachLook([&](const physics::Snapshot& now) {
      most_m = std::max(most_m, (now.bodies[body].X_WB.p_m - begin).norm());
    });
    return most_m > kMoves_m;
  }
  bool IsSmall(std::size_t body) const {
    return 2 * physics::BoundingBox(scenario_.scene.bodies[body]).half_size_m.maxCoeff() <=
           kSceneryFrom_m;
  }
  /// Fixed things that what is framed stands on or beside.
  void AddTables(const physics::Snapshot& now) {
    const Eigen::AlignedBox3d framed = box_;
    for (std::size_t i = 0; i < scenario_.scene.bodies.size(); ++i) {
      const physics::Body& body = scenario_.scene.bodies[i];
      if (!body.fixed || !physics::IsThing(body) || body.shapes.empty()) continue;
      const Eigen::AlignedBox3d table = physics::WorldBounds(body, now.bodies[i].X_WB);
      if (table.intersects(framed) && table.sizes().maxCoeff() <= kMostTable_m) box_.extend(table);
    }
  }
  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  const scenario::Scenario& scenario_;
  const episode::RunResult& run_;
  std::size_t first_ = 0, last_ = 0;  ///< in the recording
  Eigen::AlignedBox3d box_;
};

/// Returns from where one looks into the open side of their grips: between thumb and fingers, from
/// the side of the palm, not from below.
Eigen::Vector3f FrameHands(const scenario::Scenario& scenario, const physics::Snapshot& now,
                           const std::vector<std::string>& framed, Framing& framing) {
  const physics::Scene& scene = scenario.scene;
  const auto is_named = [&](const auto& entity) {
    return std::ranges::find(framed, entity.name) != framed.end();
  };
  const bool names_hands = std::ranges::any_of(scene.hands, is_named);
  std::vector<physics::HandState> hands;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < now.hands.size(); ++i) {
    if (names_hands && !is_named(scene.hands[i])) continue;
    hands.push_back(now.hands[i]);
    const double thumb = scene.hands[i].model.left ? -1 : 1;
    from += now.hands[i].palm.X_WB.q * Eigen::Vector3d(0.5, 0.7 * thumb, -0.5);
  }
  for (const physics::HandState& hand : hands) framing.AddHand(hand);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!physics::IsThing(scene.bodies[i]) || !framing.IsSmall(i)) continue;
    const bool is_near = std::ranges::any_of(hands, [&](const physics::HandState& hand) {
      return (now.bodies[i].X_WB.p_m - hand.palm.X_WB.p_m).norm() < kNearHand_m;
    });
    if (is_near || is_named(scene.bodies[i])) framing.AddBody(i, now);
    if (is_near && !physics::MovesFreely(scene, physics::BodyIndex(i)))
      from.setZero();  // furniture hides the open side
  }
  from.z() = std::max(from.z(), kLeastRise * from.head<2>().norm());
  return from.cast<float>();
}

/// Of what is framed.
void FrameStars(const std::vector<render::Marker>& markers, Framing& framing) {
  const Eigen::AlignedBox3d framed = framing.box();
  for (const render::Marker& marker : markers) {
    const Eigen::Vector3d p_W_m = marker.p_W_m.cast<double>();
    if (marker.kind == render::MarkerKind::kCandidate &&
        framed.exteriorDistance(p_W_m) < kNearStar_m)
      framing.AddBall(p_W_m, marker.half_size_m.x());
  }
}

void FramePaths(const std::vector<render::PathInterval>& path, Framing& framing) {
  for (const render::PathInterval& interval : path)
    for (const Eigen::Vector3f& point_m : interval.points_m)
      framing.AddBall(point_m.cast<double>(), 0);
}

/// A person who has a body and a hand of the scene is looked over the shoulder: only her hands are
/// framed, unless `body` asks for all of her.
bool IsFramed(const scenario::Scenario& scenario, std::size_t body, const std::string& camera) {
  const physics::Body& of_scene = scenario.scene.bodies[body];
  if (!IsSeen(of_scene)) return false;
  if (!of_scene.kinematic) return true;
  const bool has_bodies = std::ranges::any_of(scenario.scene.persons, &physics::Person::has_body);
  return camera == "body" || scenario.scene.hands.empty() || !has_bodies;
}

}  // namespace

render::Camera CameraFor(const scenario::Scenario& scenario, const episode::RunResult& run,
                         const render::Picture& picture, const std::string& name,
                         const PictureFormat& format) {
  if (const auto own = scenario::ParseOwnCamera(name)) {
    return {.eye_m = own->eye_m.cast<float>(),
            .look_at_m = own->look_at_m.cast<float>(),
            .vertical_field_of_view_deg = static_cast<float>(own->view_deg)};
  }
  for (const physics::Body& body : scenario.scene.bodies) {
    if (body.name != name || body.abstract != physics::Abstract::kCamera) continue;
    const Eigen::Vector3d ahead_m = body.X_WB * Eigen::Vector3d::UnitX();
    return {.eye_m = body.X_WB.p_m.cast<float>(),
            .look_at_m = ahead_m.cast<float>(),
            .vertical_field_of_view_deg = static_cast<float>(body.view_deg)};
  }
  Framing framing(scenario, run, format);
  std::optional<Eigen::Vector3f> from;
  if (name == "hand" && !scenario.scene.hands.empty()) {
    from = FrameHands(scenario, picture.snapshot, format.framed, framing);
    if (format.framed_from_s) FramePaths(picture.path, framing);
    FrameStars(picture.markers, framing);
  } else {
    framing.ForEachLook([&](const physics::Snapshot& now) { framing.AddHands(now); });
    for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
      if (!framing.IsSmall(i) || !IsFramed(scenario, i, name)) continue;
      const bool is_named =
          std::ranges::find(format.framed, scenario.scene.bodies[i].name) != format.framed.end();
      if (is_named || framing.Moves(i))
        framing.ForEachLook([&](const physics::Snapshot& now) { framing.AddBody(i, now); });
      else if (name != "action")
        framing.AddBody(i, run.recording.front());
    }
    if (name == "top") framing.AddTables(run.recording.front());
  }
  Eigen::AlignedBox3f box = framing.box().cast<float>();
  if (box.isEmpty()) box = {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 1, 1)};
  const double aspect = static_cast<double>(picture.width_px) / picture.height_px;
  return from && from->norm() > kLeastFrom
             ? render::CameraFrom(*from, box.min(), box.max(), aspect)
             : render::NamedCamera(name, box.min(), box.max(), aspect);
}

}  // namespace prehend::show
