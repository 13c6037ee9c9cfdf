// SPDX-License-Identifier: Apache-2.0
// A person as an artist's mannequin: limbs that taper between ball joints, a trunk in three parts,
// a head with a face. Physics has capsules; the mannequin stands for them and hides less. Tested by
// tests/render/draw_person_test.cc
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "render/draw_list.h"

namespace prehend::render {
namespace {

using Eigen::Affine3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kJointShade = 0.72f;
constexpr int kAround = 28;  ///< corners of a cross section

/// Height and radius, from the lower end to the upper one.
using Profile = std::vector<Vector2f>;

// Limbs: height as a share of the bone's length, radius as a share of the person's height.
const Profile kUpperArm = {{0.06f, 0.0f},    {0.07f, 0.0140f}, {0.12f, 0.0185f}, {0.45f, 0.0225f},
                           {0.75f, 0.0250f}, {0.90f, 0.0235f}, {0.96f, 0.0170f}, {0.97f, 0.0f}};
const Profile kForearm = {{0.03f, 0.0f},    {0.04f, 0.0100f}, {0.08f, 0.0132f}, {0.40f, 0.0175f},
                          {0.70f, 0.0205f}, {0.88f, 0.0185f}, {0.94f, 0.0130f}, {0.95f, 0.0f}};
const Profile kThigh = {{0.07f, 0.0f},    {0.08f, 0.0200f}, {0.13f, 0.0270f}, {0.45f, 0.0360f},
                        {0.75f, 0.0415f}, {0.92f, 0.0400f}, {0.98f, 0.0300f}, {1.0f, 0.0f}};
const Profile kShank = {{0.03f, 0.0f},    {0.04f, 0.0130f}, {0.10f, 0.0165f}, {0.40f, 0.0250f},
                        {0.66f, 0.0295f}, {0.86f, 0.0265f}, {0.93f, 0.0190f}, {0.94f, 0.0f}};
const Profile kNeck = {
    {-0.3f, 0.0f}, {-0.3f, 0.034f}, {0.2f, 0.027f}, {1.2f, 0.025f}, {1.2f, 0.0f}};

// Trunk, head, hands and feet: both as shares of the person's height.
const Profile kChest = {{-0.095f, 0.0f},  {-0.092f, 0.030f}, {-0.080f, 0.056f}, {-0.050f, 0.072f},
                        {0.000f, 0.085f}, {0.045f, 0.092f},  {0.078f, 0.088f},  {0.098f, 0.070f},
                        {0.108f, 0.040f}, {0.110f, 0.0f}};
const Profile kWaist = {{-0.060f, 0.0f},  {-0.052f, 0.034f}, {-0.030f, 0.056f}, {0.000f, 0.062f},
                        {0.030f, 0.056f}, {0.052f, 0.034f},  {0.060f, 0.0f}};
const Profile kPelvis = {{-0.058f, 0.0f},  {-0.054f, 0.030f}, {-0.038f, 0.062f}, {-0.010f, 0.084f},
                         {0.020f, 0.086f}, {0.045f, 0.074f},  {0.060f, 0.048f},  {0.065f, 0.0f}};
const Profile kHead = {{-0.066f, 0.0f},   {-0.063f, 0.018f}, {-0.052f, 0.031f}, {-0.034f, 0.040f},
                       {-0.010f, 0.047f}, {0.014f, 0.050f},  {0.034f, 0.046f},  {0.051f, 0.035f},
                       {0.062f, 0.018f},  {0.066f, 0.0f}};
const Profile kHand = {{-0.056f, 0.0f},  {-0.053f, 0.008f}, {-0.040f, 0.015f}, {-0.005f, 0.021f},
                       {0.025f, 0.020f}, {0.048f, 0.012f},  {0.052f, 0.0f}};
const Profile kFoot = {{-0.066f, 0.0f},  {-0.062f, 0.011f}, {-0.045f, 0.018f}, {-0.010f, 0.020f},
                       {0.040f, 0.021f}, {0.066f, 0.017f},  {0.070f, 0.0f}};
const Profile kToes = {{-0.030f, 0.0f},  {-0.027f, 0.012f}, {-0.010f, 0.017f},
                       {0.012f, 0.015f}, {0.026f, 0.008f},  {0.030f, 0.0f}};

/// Around z; corners are the surface itself.
Mesh TurnedMesh(const Profile& profile, float z_scale, float radius_scale) {
  Mesh mesh;
  const auto slope = [&](std::size_t i) {
    const Vector2f &before = profile[i > 0 ? i - 1 : i],
                   &after = profile[std::min(i + 1, profile.size() - 1)];
    return Vector2f((after.x() - before.x()) * z_scale, (after.y() - before.y()) * radius_scale);
  };
  for (std::size_t ring = profile.size(); ring-- > 0;) {  // from the top, as Revolve does
    const Vector2f way = slope(ring);
    const Vector2f out = Vector2f(way.x(), -way.y()).normalized();  // radial, along z
    for (int i = 0; i <= kAround; ++i) {
      const float angle = 2 * static_cast<float>(M_PI) * static_cast<float>(i % kAround) / kAround;
      const float c = std::cos(angle), s = std::sin(angle), r = profile[ring].y() * radius_scale;
      mesh.vertices.push_back(
          {{r * c, r * s, profile[ring].x() * z_scale}, {out.x() * c, out.x() * s, out.y()}});
    }
  }
  constexpr std::uint32_t kRow = kAround + 1;
  for (std::uint32_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (std::uint32_t i = 0; i + 1 < kRow; ++i) {
      const std::uint32_t upper = ring * kRow + i, lower = upper + kRow;
      mesh.triangles.insert(mesh.triangles.end(),
                            {upper, lower, upper + 1, upper + 1, lower, lower + 1});
    }
  }
  return mesh;
}

const physics::Capsule* CapsuleOf(const physics::Body& body) {
  return body.shapes.size() == 1 ? std::get_if<physics::Capsule>(&body.shapes.front().shape)
                                 : nullptr;
}

/// The name of a person's part without hers: "right_forearm"; "head" for her head.
std::optional<std::string> PartName(const physics::Scene& scene, const physics::Person& person,
                                    std::size_t body) {
  if (body >= scene.bodies.size() || !CapsuleOf(scene.bodies[body])) return std::nullopt;
  if (physics::BodyIndex(body) == person.head) return "head";
  const std::string& name = scene.bodies[body].name;
  if (!person.has_body || !scene.bodies[body].kinematic || !name.starts_with(person.name + "_"))
    return std::nullopt;
  return name.substr(person.name.size() + 1);
}

std::string WithoutSide(const std::string& part) {
  for (const std::string_view side : {"right_", "left_"})
    if (part.starts_with(side)) return part.substr(side.size());
  return part;
}

class Mannequin {
 public:
  Mannequin(const Picture& picture, const physics::Person& person, DrawList* list)
      : picture_(picture), list_(*list), height_(static_cast<float>(person.height_m)) {
    const physics::Scene& scene = *picture.scene;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (const auto part = PartName(scene, person, i)) bodies_[*part] = i;
    }
  }

  void Add() {
    for (const auto& [part, body] : bodies_) AddPart(part, body);
    if (!translucent_.empty()) list_.ghosts.push_back(std::move(translucent_));
  }

 private:
  Affine3f PoseOf(std::size_t body) const {
    const auto& placed = picture_.snapshot.bodies;
    const physics::Pose X_WB =
        body < placed.size() ? placed[body].X_WB : picture_.scene->bodies[body].X_WB;
    return Eigen::Translation3f(X_WB.p_m.cast<float>()) * X_WB.q.cast<float>();
  }
  float LengthOf(std::size_t body) const {
    return static_cast<float>(CapsuleOf(picture_.scene->bodies[body])->length_m);
  }
  /// The lower (-1) or upper (1) end of a part.
  std::optional<Vector3f> EndOf(const std::string& part, float end) const {
    const auto found = bodies_.find(part);
    if (found == bodies_.end()) return std::nullopt;
    return PoseOf(found->second) * Vector3f(0, 0, end * LengthOf(found->second) / 2);
  }

  /// From her right to her left, of the shoulders or the hips; from the heel to the toes' right
  /// side, of a foot.
  Vector3f Across(const std::string& part, const Vector3f& axis) const {
    const bool of_hips = part == "pelvis" || part == "abdomen";
    const std::string limb = of_hips ? "thigh" : "upper_arm";
    const auto right = EndOf("right_" + limb, 1), left = EndOf("left_" + limb, 1);
    const Vector3f across = right && left ? Vector3f(*left - *right) : Vector3f::UnitY();
    const Vector3f level = across - across.dot(axis) * axis;
    return level.norm() > 1e-4f ? Vector3f(level.normalized()) : axis.unitOrthogonal();
  }
  /// Along the trunk, from the hips to the shoulders.
  Vector3f TrunkUp() const {
    const auto pelvis = bodies_.find("pelvis"), chest = bodies_.find("chest");
    if (pelvis == bodies_.end() || chest == bodies_.end()) return Vector3f::UnitZ();
    const Vector3f up = PoseOf(chest->second).translation() - PoseOf(pelvis->second).translation();
    return up.norm() > 1e-4f ? Vector3f(up.normalized()) : Vector3f::UnitZ();
  }

  /// z along the part, y to her left.
  static Affine3f Frame(const Vector3f& p_m, const Vector3f& axis, const Vector3f& left) {
    Affine3f frame = Affine3f::Identity();
    frame.linear().col(2) = axis;
    frame.linear().col(1) = left;
    frame.linear().col(0) = left.cross(axis);
    frame.translation() = p_m;
    return frame;
  }

  void AddItemOf(std::size_t body, Item item, float shade) {
    item.color = shade * BodyColor(picture_, body);
    item.alpha = body < picture_.body_alphas.size() ? picture_.body_alphas[body] : 1;
    item.gloss = 0.2f;
    item.object = list_.first_body + static_cast<int>(body);
    AddItem(item, item.alpha < 1 ? &translucent_ : &list_.solids, &list_);
  }
  void AddTurned(std::size_t body, const Profile& profile, float z_scale, const Affine3f& X_WI,
                 float shade = 1) {
    list_.meshes.push_back(TurnedMesh(profile, z_scale, height_));
    AddItemOf(body,
              {.primitive = Primitive::kMesh,
               .mesh = static_cast<int>(list_.meshes.size()) - 1,
               .X_WI = X_WI,
               .half_size_m = Vector3f::Ones()},
              shade);
  }
  void AddBall(std::size_t body, const Affine3f& X_WI, float shade = kJointShade) {
    AddItemOf(body, {.primitive = Primitive::kBall, .X_WI = X_WI, .rounding_m = 1}, shade);
  }
  void AddJoint(std::size_t body, const Vector3f& p_m, float radius) {
    AddBall(body, Eigen::Translation3f(p_m) * Eigen::Scaling(radius * height_));
  }

  /// Between its joints, with a ball at its upper end, and at its lower one if it is the last.
  void AddLimb(std::size_t body, const Profile& profile, float upper_ball, float lower_ball) {
    const float length = LengthOf(body);
    const Affine3f X_WB = PoseOf(body);
    AddTurned(body, profile, length, X_WB * Eigen::Translation3f(0, 0, -length / 2));
    if (upper_ball > 0) AddJoint(body, X_WB * Vector3f(0, 0, length / 2), upper_ball);
    if (lower_ball > 0) AddJoint(body, X_WB * Vector3f(0, 0, -length / 2), lower_ball);
  }
  /// Wider than deep. `wide` and `deep` scale the profile's radius.
  void AddFlat(std::size_t body, const Profile& profile, const Affine3f& frame, float deep,
               float wide = 1, float shade = 1) {
    AddTurned(body, profile, height_, frame * Eigen::Scaling(deep, wide, 1.0f), shade);
  }
  void AddPart(const std::string& part, std::size_t body) {
    const Affine3f X_WB = PoseOf(body);
    const Vector3f middle = X_WB.translation(), axis = X_WB.linear().col(2);
    const Vector3f up = TrunkUp();
    const std::string kind = WithoutSide(part);
    if (kind == "head") return AddHead(body, X_WB);
    if (kind == "neck") return AddLimb(body, kNeck, 0, 0);
    if (kind == "chest") return AddFlat(body, kChest, Frame(middle, up, Across(part, up)), 0.66f);
    if (kind == "abdomen")
      return AddFlat(body, kWaist, Frame(middle, up, Across(part, up)), 0.78f, 1, kJointShade);
    if (kind == "pelvis") return AddFlat(body, kPelvis, Frame(middle, up, Across(part, up)), 0.74f);
    if (kind == "upper_arm") return AddLimb(body, kUpperArm, 0.027f, 0);
    if (kind == "forearm") return AddLimb(body, kForearm, 0.0195f, 0.0135f);
    if (kind == "thigh") return AddLimb(body, kThigh, 0.040f, 0);
    if (kind == "shank") return AddLimb(body, kShank, 0.0295f, 0.0185f);
    const Vector3f left = Across(part, axis);
    if (kind == "hand") return AddFlat(body, kHand, Frame(middle, axis, left), 1, 0.45f);
    if (kind == "foot") return AddFlat(body, kFoot, Frame(middle, axis, left), 0.95f, 1.15f);
    if (kind == "toes") return AddFlat(body, kToes, Frame(middle, axis, left), 0.75f, 1.25f);
    AddLimb(body, kForearm, 0, 0);
  }
  /// x ahead, y to her left, z up.
  void AddHead(std::size_t body, const Affine3f& X_WHead) {
    AddFlat(body, kHead, X_WHead, 1, 0.84f);
    const float r = 0.05f * height_;
    const auto feature = [&](const Vector3f& p, const Vector3f& half, float shade) {
      AddBall(body, X_WHead * Eigen::Translation3f(r * p) * Eigen::Scaling(Vector3f(r * half)),
              shade);
    };
    for (const float side : {-1.0f, 1.0f}) {
      feature({0.86f, 0.34f * side, 0.14f}, {0.10f, 0.13f, 0.11f}, 0.16f);   // eye
      feature({0.89f, 0.36f * side, 0.36f}, {0.07f, 0.18f, 0.035f}, 0.45f);  // brow
      feature({0.02f, 0.83f * side, 0.02f}, {0.16f, 0.07f, 0.24f}, 0.9f);    // ear
    }
    feature({0.98f, 0, -0.14f}, {0.17f, 0.10f, 0.22f}, 0.93f);   // nose
    feature({0.80f, 0, -0.60f}, {0.07f, 0.22f, 0.045f}, 0.42f);  // mouth
  }

  const Picture& picture_;
  DrawList& list_;
  const float height_;
  std::map<std::string, std::size_t> bodies_;  ///< by the part's name
  std::vector<Item> translucent_;
};

}  // namespace

std::vector<bool> DrawnAsMannequin(const physics::Scene& scene) {
  std::vector<bool> drawn(scene.bodies.size(), false);
  for (const physics::Person& person : scene.persons) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (PartName(scene, person, i)) drawn[i] = true;
  }
  return drawn;
}

void AddPersons(const Picture& picture, DrawList* list) {
  for (const physics::Person& person : picture.scene->persons)
    Mannequin(picture, person, list).Add();
}

}  // namespace prehend::render
