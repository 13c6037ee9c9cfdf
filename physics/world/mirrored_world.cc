// SPDX-License-Identifier: Apache-2.0
// Commands are mirrored on their way in, states on their way out; what rests is not mirrored again.
#include "physics/world/mirrored_world.h"

#include <algorithm>
#include <utility>

#include "physics/world/contact_hold.h"

namespace prehend::physics {
namespace {

void Mirror(Hull& hull) {
  for (Eigen::Vector3d& corner_m : hull.corners_m) corner_m = InMirror(corner_m);
  for (Hull::Face& face : hull.faces) {
    std::ranges::reverse(face.corners);  // counter-clockwise again
    face.nhat_S = InMirror(face.nhat_S);
  }
  hull.X_SC = InMirror(hull.X_SC);
}

BodyState StateInMirror(const BodyState& state) {
  return {.X_WB = InMirror(state.X_WB),
          .v_WB_m_per_s = InMirror(state.v_WB_m_per_s),
          .w_WB_rad_per_s = AxisInMirror(state.w_WB_rad_per_s),
          .asleep = state.asleep};
}

void Mirror(const HandState& image, HandState& hand) {
  hand = image;
  hand.palm = StateInMirror(image.palm);
  for (Pose& X_WL : hand.X_WL) X_WL = InMirror(X_WL);
  hand.X_WTarget = InMirror(image.X_WTarget);
}

void Mirror(const std::vector<ContactPoint>& image, std::vector<ContactPoint>& points) {
  points = image;
  for (ContactPoint& point : points) {
    point.p_W_m = InMirror(point.p_W_m);
    point.nhat_BA_W = InMirror(point.nhat_BA_W);
  }
  std::ranges::sort(points, ComesBefore);
}

class MirroredWorld final : public World {
 public:
  explicit MirroredWorld(std::unique_ptr<World> image) : image_(std::move(image)) {}

  void Step(const std::vector<HandCommand>& commands) override {
    commands_ = commands;
    for (HandCommand& command : commands_) {
      TargetState& target = command.target;
      target.X_WH = InMirror(target.X_WH);
      target.v_m_per_s = InMirror(target.v_m_per_s);
      target.w_rad_per_s = AxisInMirror(target.w_rad_per_s);
    }
    image_->Step(commands_);
  }

  void Describe(Snapshot& snapshot) const override {
    image_->Describe(seen_);
    snapshot.bodies.resize(seen_.bodies.size());
    for (std::size_t i = 0; i < seen_.bodies.size(); ++i) {
      const bool known = !snapshot.moved_tick.empty() && !seen_.MayHaveMoved(i, snapshot.tick);
      if (!known) snapshot.bodies[i] = StateInMirror(seen_.bodies[i]);
    }
    snapshot.moved_tick = seen_.moved_tick;
    snapshot.tick = seen_.tick;
    snapshot.grains = seen_.grains;
    for (Eigen::Vector3d& p_W_m : snapshot.grains) p_W_m = InMirror(p_W_m);
    snapshot.joints = seen_.joints;
    snapshot.hands.resize(seen_.hands.size());
    for (std::size_t i = 0; i < seen_.hands.size(); ++i) Mirror(seen_.hands[i], snapshot.hands[i]);
    Mirror(seen_.contacts, snapshot.contacts);
    snapshot.resting = Resting();
  }

  void MoveKinematic(BodyIndex body, const Pose& X_WB, bool jumps) override {
    image_->MoveKinematic(body, InMirror(X_WB), jumps);
  }

  Sight Look(const SightLine& line) const override {
    SightLine image = line;
    image.from_W_m = InMirror(line.from_W_m);
    image.toward_W = InMirror(line.toward_W);
    return image_->Look(image);
  }

 private:
  /// Snapshots share them until they change, here as in the image.
  std::shared_ptr<const std::vector<ContactPoint>> Resting() const {
    if (seen_.resting == mirrored_) return resting_;
    mirrored_ = seen_.resting;
    resting_ = nullptr;
    if (mirrored_) {
      auto points = std::make_shared<std::vector<ContactPoint>>();
      Mirror(*mirrored_, *points);
      resting_ = std::move(points);
    }
    return resting_;
  }

  const std::unique_ptr<World> image_;
  std::vector<HandCommand> commands_;
  mutable Snapshot seen_;  ///< the last state of the image that was described
  mutable std::shared_ptr<const std::vector<ContactPoint>> mirrored_, resting_;
};

}  // namespace

PlacedShape InMirror(PlacedShape placed) {
  placed.X_BS = InMirror(placed.X_BS);
  if (auto* const hull = std::get_if<Hull>(&placed.shape)) Mirror(*hull);
  return placed;
}

Body InMirror(Body body) {
  body.X_WB = InMirror(body.X_WB);
  if (body.grains)
    for (Eigen::Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m = InMirror(p_WG_m);
  for (PlacedShape& placed : body.shapes) placed = InMirror(std::move(placed));
  return body;
}

Joint InMirror(Joint joint) {
  joint.pivot_W_m = InMirror(joint.pivot_W_m);
  joint.axis_W =
      joint.kind == JointKind::kHinge ? AxisInMirror(joint.axis_W) : InMirror(joint.axis_W);
  return joint;
}

Hand InMirror(Hand hand) {
  hand.X_WH = InMirror(hand.X_WH);
  hand.model = Mirrored(std::move(hand.model));
  return hand;
}

Scene InMirror(Scene scene) {
  for (Body& body : scene.bodies) body = InMirror(std::move(body));
  for (Joint& joint : scene.joints) joint = InMirror(std::move(joint));
  for (Hand& hand : scene.hands) hand = InMirror(std::move(hand));
  return scene;
}

bool LeftHandLeads(const Scene& scene, const Script& script) {
  const auto is_left = [&](const Hand& hand) { return hand.model.left; };
  const auto lefts = std::ranges::count_if(scene.hands, is_left);
  if (lefts == 0) return false;
  if (lefts == std::ssize(scene.hands)) return true;
  for (const ScriptStage& stage : script.stages) {
    std::ptrdiff_t more_left = 0;
    for (const Step& step : stage.steps) more_left += is_left(scene.hand(step.hand)) ? 1 : -1;
    if (more_left != 0) return more_left > 0;
  }
  return false;
}

std::unique_ptr<World> MirrorImageOf(std::unique_ptr<World> image) {
  return std::make_unique<MirroredWorld>(std::move(image));
}

}  // namespace prehend::physics
