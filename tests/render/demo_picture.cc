// SPDX-License-Identifier: Apache-2.0
// The demo picture. The hand is posed by plain forward kinematics, which is all that a still
// picture needs.
#include "tests/render/demo_picture.h"

#include <cmath>

#include "render/gl/gl_objects.h"

namespace prehend::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using physics::Pose;

constexpr double kTableTop_m = 0.76;

const Color kReaching = {0.86f, 0.15f, 0.15f}, kFixation = {0.96f, 0.75f, 0.06f},
            kPickingUp = {0.17f, 0.63f, 0.17f}, kTransporting = {0.09f, 0.65f, 0.67f},
            kPuttingDown = {0.16f, 0.36f, 0.84f}, kSliding = {0.56f, 0.27f, 0.68f};

physics::Body MakeBody(const std::string& name, const physics::Shape& shape, const Vector3d& p_m,
                       bool fixed = false) {
  return {.name = name,
          .shapes = {{shape, {}}},
          .fixed = fixed,
          .mass_kg = fixed ? 0 : 0.4,
          .X_WB = {p_m, {1, 0, 0, 0}}};
}

// The back of the hand to the left, fingers forward: the way to take a carton from its right side.
Pose GraspPose(const Vector3f& p_m) {
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(2.4, Vector3d::UnitZ()) * Eigen::AngleAxisd(-1.45, Vector3d::UnitX());
  return {p_m.cast<double>(), q};
}

std::vector<Vector3f> Curve(const Vector3f& a, const Vector3f& b, const Vector3f& c,
                            const Vector3f& d, int count) {
  std::vector<Vector3f> points;
  for (int i = 0; i <= count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count), u = 1 - t;
    points.push_back(u * u * u * a + 3 * u * u * t * b + 3 * u * t * t * c + t * t * t * d);
  }
  return points;
}

std::vector<PathInterval> DemoPath() {
  const Vector3f start(0.60f, -0.58f, 1.0f), touch(0.20f, 0.02f, 0.90f), held(0.19f, 0.03f, 0.88f),
      lifted(0.19f, 0.03f, 1.03f), above(-0.33f, 0.02f, 1.06f), landed(-0.38f, -0.02f, 0.90f),
      rest(-0.56f, 0.0f, 0.90f);
  return {
      {"reaching", kReaching, Curve(start, {0.5f, -0.4f, 1.1f}, {0.32f, -0.2f, 1.03f}, touch, 58),
       60},
      {"fixation", kFixation, Curve(touch, touch, held, held, 14), 60},
      {"picking_up", kPickingUp,
       Curve(held, {0.19f, 0.03f, 0.93f}, {0.2f, 0.03f, 0.98f}, lifted, 28), 60},
      {"transporting", kTransporting,
       Curve(lifted, {0.17f, 0.07f, 1.22f}, {-0.22f, 0.07f, 1.22f}, above, 70), 60},
      {"putting_down", kPuttingDown,
       Curve(above, {-0.37f, 0, 1.0f}, {-0.38f, -0.02f, 0.94f}, landed, 28), 60},
      {"sliding", kSliding, Curve(landed, {-0.45f, -0.02f, 0.9f}, {-0.5f, 0, 0.9f}, rest, 36), 60},
      {"",
       {0.54f, 0.56f, 0.60f},
       Curve(rest, {-0.5f, -0.2f, 0.95f}, {-0.4f, -0.3f, 1.0f}, {-0.3f, -0.4f, 1.05f}, 40),
       60}};
}

TimelineStrip DemoStrip() {
  const Color gray = {0.62f, 0.66f, 0.71f}, amber = {0.93f, 0.62f, 0.20f},
              green = {0.36f, 0.72f, 0.42f};
  return {.begin_s = 0,
          .end_s = 4.8,
          .playhead_s = 1.62,
          .rows = {{"right_hand",
                    {{"reaching", 0.42, 1.38, kReaching},
                     {"fixation", 1.38, 1.62, kFixation},
                     {"picking_up", 1.62, 2.08, kPickingUp},
                     {"transporting", 2.08, 3.26, kTransporting},
                     {"putting_down", 3.26, 3.74, kPuttingDown},
                     {"sliding", 3.74, 4.36, kSliding}}},
                   {"grasping", {{"milk", 1.62, 4.36, gray}}},
                   {"contact",
                    {{"right_hand milk", 1.38, 4.40, amber},
                     {"milk table", 0, 1.66, amber},
                     {"milk table", 3.74, 4.8, amber}}},
                   {"supported_by",
                    {{"milk on table", 0, 1.66, green}, {"milk on table", 3.74, 4.8, green}}}}};
}

// The whole scene with the hand and the carton where they are at a moment of the path.
physics::Snapshot At(const physics::Scene& scene, const Vector3f& hand_m, double curl_rad,
                     bool held) {
  physics::Snapshot snapshot;
  for (const physics::Body& body : scene.bodies) snapshot.bodies.push_back({.X_WB = body.X_WB});
  snapshot.hands.push_back(DemoHandState(scene.hands[0].model, GraspPose(hand_m), curl_rad));
  if (held) snapshot.bodies[1].X_WB.p_m = hand_m.cast<double>() + Vector3d(-0.055, 0.04, -0.02);
  return snapshot;
}

}  // namespace

physics::HandModel DemoHandModel() {
  physics::HandModel model{.name = "demo"};
  const double lengths_m[] = {0.045, 0.026, 0.022};
  for (int finger = 0; finger < 5; ++finger) {
    const bool thumb = finger == 4;
    Vector3d pivot =
        thumb ? Vector3d(-0.012, 0.042, -0.008) : Vector3d(0.045, 0.031 - 0.0207 * finger, 0);
    const Vector3d direction = thumb ? Vector3d(0.62, 0.62, -0.48).normalized() : Vector3d::UnitX();
    const Vector3d axis =
        thumb ? Vector3d(0.3, 0.3, 0.9).cross(direction).normalized() : Vector3d::UnitY();
    for (int i = 0; i < 3; ++i) {
      const physics::LinkIndex parent(i == 0 ? -1 : static_cast<int>(model.links.size()) - 1);
      model.links.push_back({.name = "link",
                             .parent = parent,
                             .pivot_m = pivot,
                             .direction = direction,
                             .joint_axis = thumb ? Vector3d(-axis) : axis,
                             .length_m = lengths_m[i],
                             .half_width_m = 0.0088 - 0.0008 * i,
                             .half_thickness_m = 0.0080 - 0.0008 * i});
      pivot += direction * lengths_m[i];
    }
  }
  return model;
}

physics::HandState DemoHandState(const physics::HandModel& model, const Pose& X_WH,
                                 double curl_rad) {
  physics::HandState state;
  state.palm.X_WB = X_WH;
  // X_WJ: the hand's frame carried along by all joints up to a link.
  std::vector<Pose> X_WJ;
  for (const physics::HandLink& link : model.links) {
    const Pose X_WP = link.parent == physics::kNone ? X_WH : At(X_WJ, link.parent);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(curl_rad, link.joint_axis));
    X_WJ.push_back(X_WP * Pose{link.pivot_m, turn} *
                   Pose{-link.pivot_m, Eigen::Quaterniond::Identity()});
    const Pose X_HL{
        link.pivot_m + link.direction * link.length_m / 2,
        RotationBetween(Eigen::Vector3f::UnitX(), link.direction.cast<float>()).cast<double>()};
    state.X_WL.push_back(X_WJ.back() * X_HL);
  }
  return state;
}

physics::Scene DemoScene() {
  physics::Scene scene;
  scene.bodies = {
      MakeBody("table", physics::Box{{1.5, 0.9, 0.04}}, {0, 0.1, kTableTop_m - 0.02}, true),
      MakeBody("milk", physics::Box{{0.07, 0.07, 0.20}}, {0.135, 0.07, kTableTop_m + 0.1}),
      MakeBody("cereal", physics::Box{{0.19, 0.06, 0.28}}, {0.42, 0.36, kTableTop_m + 0.14}),
      MakeBody("mug", physics::Cylinder{0.04, 0.095}, {-0.02, 0.36, kTableTop_m + 0.048}),
      MakeBody("apple", physics::Sphere{0.04}, {0.36, -0.08, kTableTop_m + 0.04}),
      MakeBody("plate", physics::Cylinder{0.12, 0.018}, {-0.30, -0.18, kTableTop_m + 0.009}),
      MakeBody("can", physics::Capsule{0.03, 0.08}, {-0.55, 0.35, kTableTop_m + 0.07})};
  for (int leg = 0; leg < 4; ++leg) {
    const Vector3d p(leg % 2 == 0 ? -0.68 : 0.68, leg < 2 ? -0.28 : 0.48, (kTableTop_m - 0.04) / 2);
    scene.bodies[0].shapes.push_back(
        {physics::Box{{0.06, 0.06, kTableTop_m - 0.04}},
         {p - scene.bodies[0].X_WB.p_m, Eigen::Quaterniond::Identity()}});
  }
  scene.hands = {
      {.name = "right_hand", .model = DemoHandModel(), .X_WH = GraspPose({0.2f, 0.02f, 0.9f})}};
  return scene;
}

Picture DemoPicture(const physics::Scene& scene) {
  Picture picture{.scene = &scene};
  picture.path = DemoPath();
  const auto point = [&](int interval, int i) { return picture.path[interval].points_m[i]; };
  picture.snapshot = At(scene, point(1, 14), 0.62, false);
  picture.ghosts = {{.hand = physics::HandIndex(0),
                     .snapshot = At(scene, point(0, 0), 0.15, false),
                     .tint = kReaching},
                    {.hand = physics::HandIndex(0),
                     .snapshot = At(scene, point(0, 30), 0.2, false),
                     .tint = kReaching},
                    {.hand = physics::HandIndex(0),
                     .bodies = {physics::BodyIndex(1)},
                     .snapshot = At(scene, point(3, 34), 0.62, true),
                     .tint = kTransporting},
                    {.hand = physics::HandIndex(0),
                     .bodies = {physics::BodyIndex(1)},
                     .snapshot = At(scene, point(5, 36), 0.62, true),
                     .tint = kSliding}};
  picture.markers = {{MarkerKind::kContact, {0.172f, 0.055f, 0.88f}, {0.012f, 0.02f, 0.03f}},
                     {MarkerKind::kSupport, {0.135f, 0.07f, 0.762f}, {0.06f, 0.06f, 0.01f}},
                     {MarkerKind::kRegion, {0.14f, 0.09f, 0.88f}, {0.22f, 0.22f, 0.19f}}};
  picture.body_labels = {"", "milk", "cereal", "mug", "apple", "plate", "can"};
  picture.hand_labels = {"right_hand"};
  picture.strip = DemoStrip();
  picture.title = "milk_carton_wrap: picking_up begins";
  picture.camera = {.eye_m = {-0.95f, -1.62f, 1.86f}, .look_at_m = {0.02f, -0.02f, 0.86f}};
  return picture;
}

}  // namespace prehend::render
