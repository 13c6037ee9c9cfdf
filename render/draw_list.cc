// SPDX-License-Identifier: Apache-2.0
// Bodies, hands, ghosts and markers as placed primitives.
#include "render/draw_list.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "physics/base/visitors.h"

namespace prehend::render {
namespace {

using Eigen::Affine3f;
using Eigen::Vector3f;

constexpr float kGhostAlpha = 0.40f;
constexpr float kForearmAlpha = 0.55f;
constexpr float kUsualDistance_m =
    2.1f;  // distance of eye and scene for which beads and tubes are sized

Affine3f ToAffine(const physics::Pose& pose) {
  return Eigen::Translation3f(pose.p_m.cast<float>()) * pose.q.cast<float>();
}

// A box with these outer half sizes; edges are rounded inwards.
void SetRoundedBox(const Vector3f& outer_half_m, float rounding_m, Item* item) {
  item->primitive = Primitive::kBox;
  item->rounding_m = std::min(rounding_m, 0.98f * outer_half_m.minCoeff());
  item->half_size_m = outer_half_m.array() - item->rounding_m;
}

void SetShape(const physics::Shape& shape, Item* item, DrawList* list) {
  std::visit(
      physics::Overloaded{[&](const physics::Box& box) {
                            const Vector3f half = box.size_m.cast<float>() / 2;
                            SetRoundedBox(half, std::min(0.008f, 0.16f * half.minCoeff()), item);
                          },
                          [&](const physics::Sphere& sphere) {
                            item->primitive = Primitive::kBall;
                            item->rounding_m = static_cast<float>(sphere.radius_m);
                          },
                          [&](const physics::Cylinder& cylinder) {
                            const auto r = static_cast<float>(cylinder.radius_m);
                            const auto h = static_cast<float>(cylinder.length_m) / 2;
                            item->primitive = Primitive::kCylinder;
                            item->rounding_m = std::min(0.005f, 0.2f * std::min(r, h));
                            item->half_size_m = Vector3f(r, r, h).array() - item->rounding_m;
                          },
                          [&](const physics::Capsule& capsule) {
                            item->primitive = Primitive::kBall;
                            item->rounding_m = static_cast<float>(capsule.radius_m);
                            item->half_size_m = {0, 0, static_cast<float>(capsule.length_m) / 2};
                          },
                          [&](const physics::Hull& hull) {
                            item->primitive = Primitive::kMesh;
                            item->mesh = static_cast<int>(list->meshes.size());
                            item->half_size_m.setOnes();
                            list->meshes.push_back(HullMesh(hull));
                          }},
      shape);
}

// Appearance and object number of a body or hand that is added to the list.
struct Appearance {
  Color color = {0.5f, 0.5f, 0.5f};
  float alpha = 1;
  float gloss = 0.25f;
  int object = 0;
};

Item MakeItem(const Affine3f& X_WI, const Appearance& look) {
  return {.X_WI = X_WI,
          .color = look.color,
          .alpha = look.alpha,
          .gloss = look.gloss,
          .object = look.object};
}

void AddBody(const physics::Body& body, const physics::Pose& X_WB, const Appearance& look,
             std::vector<Item>* items, DrawList* list) {
  for (const physics::PlacedShape& placed : body.shapes) {
    Item item = MakeItem(ToAffine(X_WB * placed.X_BS), look);
    SetShape(placed.shape, &item, list);
    AddItem(item, items, list);
  }
}

/// Regions and gaze targets are translucent; cameras and lights are invisible.
void AddAbstract(const physics::Body& body, int object, DrawList* list) {
  constexpr float kAbstractAlpha = 0.22f;
  using physics::Abstract;
  if (body.abstract == Abstract::kCamera || body.abstract == Abstract::kLight) return;
  const Appearance look{.color = body.abstract == Abstract::kRegion ? Color(0.42f, 0.66f, 1.0f)
                                                                    : Color(0.95f, 0.45f, 0.75f),
                        .alpha = kAbstractAlpha,
                        .gloss = 0,
                        .object = object};
  for (const physics::PlacedShape& placed : body.shapes) {
    Item item = MakeItem(ToAffine(body.X_WB * placed.X_BS), look);
    SetShape(placed.shape, &item, list);
    AddItem(item, &list->markers, list);
  }
}

/// `first`: index of the body's first grain in the snapshot; a snapshot without grains shows the
/// initial positions.
void AddGrains(const physics::Grains& grains, const physics::Snapshot& snapshot, std::size_t first,
               const Appearance& look, std::vector<Item>* items, DrawList* list) {
  const bool moved = first + grains.p_WG_m.size() <= snapshot.grains.size();
  for (std::size_t i = 0; i < grains.p_WG_m.size(); ++i) {
    const physics::Pose X_WG{moved ? snapshot.grains[first + i] : grains.p_WG_m[i]};
    Item item = MakeItem(ToAffine(X_WG), look);
    SetShape(physics::Sphere{grains.radius_m}, &item, list);
    AddItem(item, items, list);
  }
}

/// `colors`: of palm and links; of the others the colour is that of `look`.
void AddHand(const physics::HandModel& model, const physics::HandState& state,
             const Appearance& look, const std::vector<Color>& colors, std::vector<Item>* items,
             DrawList* list) {
  Item palm = MakeItem(ToAffine(state.palm.X_WB), look);
  if (!colors.empty()) palm.color = colors.front();
  SetRoundedBox(model.palm_size_m.cast<float>() / 2, 0.012f, &palm);
  AddItem(palm, items, list);
  for (std::size_t i = 0; i < std::min(model.links.size(), state.X_WL.size()); ++i) {
    const physics::HandLink& link = model.links[i];
    Item item = MakeItem(ToAffine(state.X_WL[i]), look);
    if (i + 1 < colors.size()) item.color = colors[i + 1];
    const Vector3f half(link.length_m / 2, link.half_width_m, link.half_thickness_m);
    const float rounding = 0.95f * std::min(half.y(), half.z());
    // Round ends would leave notches at the joints, so links are lengthened and overlap.
    SetRoundedBox(half + Vector3f(0.45f * rounding, 0, 0), rounding, &item);
    AddItem(item, items, list);
  }
}

// A hint of the forearm, which does not exist in the physics.
void AddForearm(const physics::HandModel& model, const physics::HandState& state,
                const Appearance& look, std::vector<Item>* items, DrawList* list) {
  constexpr float kLength_m = 0.17f;
  const float wrist = static_cast<float>(model.palm_size_m.x()) / 2;
  const float radius = 0.36f * static_cast<float>(model.palm_size_m.y());
  const Affine3f X_HA = Eigen::Translation3f(-wrist - kLength_m / 2 - 0.6f * radius, 0, 0) *
                        Eigen::AngleAxisf(static_cast<float>(M_PI_2), Vector3f::UnitY());
  Item item = MakeItem(ToAffine(state.palm.X_WB) * X_HA, look);
  item.primitive = Primitive::kBall;
  item.half_size_m = {0, 0, kLength_m / 2};
  item.rounding_m = radius;
  AddItem(item, items, list);
}

int AddObject(const std::string& name, DrawList* list) {
  list->objects.push_back({name, {}});
  return static_cast<int>(list->objects.size()) - 1;
}

physics::Pose BodyPose(const physics::Scene& scene, const physics::Snapshot& snapshot,
                       std::size_t body) {
  return body < snapshot.bodies.size() ? snapshot.bodies[body].X_WB : scene.bodies[body].X_WB;
}

/// Whether a person's body gives the hand its arm.
bool HasArm(const physics::Scene& scene, physics::HandIndex hand) {
  return std::ranges::any_of(scene.persons, [&](const physics::Person& person) {
    return person.has_body && (person.right_hand == hand || person.left_hand == hand);
  });
}

void AddProp(const Prop& prop, DrawList* list) {
  Item item = MakeItem(Affine3f(Eigen::Translation3f(prop.center_m)),
                       {.color = prop.color, .object = AddObject(prop.name, list)});
  if (!(prop.half_size_m.minCoeff() > 0)) return;
  SetRoundedBox(prop.half_size_m, 0.004f, &item);
  AddItem(item, &list->solids, list);
}

/// A thin rod from the eyes, and a ball where it ends at something. `scale` as of paths.
void AddGaze(const GazeRay& ray, std::size_t number, float scale, DrawList* list) {
  constexpr float kRadius_m = 0.0035f, kBall_m = 0.014f;
  const Appearance look{.color = {0.80f, 0.10f, 0.52f},
                        .alpha = 0.85f,
                        .gloss = 0,
                        .object = AddObject("gaze:" + std::to_string(number), list)};
  const Vector3f way = ray.to_m - ray.from_m;
  if (!way.allFinite() || !(way.norm() > 1e-3f)) return;
  Item rod = MakeItem(Eigen::Translation3f((ray.from_m + ray.to_m) / 2) *
                          RotationBetween(Vector3f::UnitZ(), way.normalized()),
                      look);
  rod.primitive = Primitive::kBall;
  rod.half_size_m = {0, 0, way.norm() / 2};
  rod.rounding_m = kRadius_m * scale;
  AddItem(rod, &list->paths, list);
  if (!ray.hits) return;
  Item ball = MakeItem(Affine3f(Eigen::Translation3f(ray.to_m)), look);
  ball.primitive = Primitive::kBall;
  ball.rounding_m = kBall_m * scale;
  AddItem(ball, &list->paths, list);
}

void AddBodiesAndHands(const Picture& picture, DrawList* list) {
  const physics::Scene& scene = *picture.scene;
  list->first_body = static_cast<int>(list->objects.size());
  std::size_t first_grain = 0;
  std::vector<Item> translucent;
  const std::vector<bool> is_person = DrawnAsMannequin(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Appearance look{.color = BodyColor(picture, i),
                          .object = AddObject("body:" + scene.bodies[i].name, list)};
    if (scene.bodies[i].abstract != physics::Abstract::kNot) {
      AddAbstract(scene.bodies[i], look.object, list);
      continue;
    }
    if (is_person[i]) continue;
    if (i < picture.body_alphas.size() && picture.body_alphas[i] < 1) {
      Appearance pale = look;
      pale.alpha = picture.body_alphas[i];
      AddBody(scene.bodies[i], BodyPose(scene, picture.snapshot, i), pale, &translucent, list);
      continue;
    }
    AddBody(scene.bodies[i], BodyPose(scene, picture.snapshot, i), look, &list->solids, list);
    if (const auto& grains = scene.bodies[i].grains) {
      AddGrains(*grains, picture.snapshot, first_grain, look, &list->solids, list);
      first_grain += grains->p_WG_m.size();
    }
  }
  if (!translucent.empty()) list->ghosts.push_back(std::move(translucent));
  AddPersons(picture, list);
  list->first_hand = static_cast<int>(list->objects.size());
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    const Appearance look{.color = kSkinColor,
                          .gloss = 0.15f,
                          .object = AddObject("hand:" + scene.hands[i].name, list)};
    if (i >= picture.snapshot.hands.size()) continue;
    const bool has_colors = i < picture.hand_colors.size();
    AddHand(scene.hands[i].model, picture.snapshot.hands[i], look,
            has_colors ? picture.hand_colors[i] : std::vector<Color>(), &list->solids, list);
  }
  for (std::size_t i = 0; i < std::min(scene.hands.size(), picture.snapshot.hands.size()); ++i) {
    const Appearance look{.color = kSkinColor,
                          .alpha = kForearmAlpha,
                          .gloss = 0.15f,
                          .object = AddObject("forearm:" + scene.hands[i].name, list)};
    if (HasArm(scene, physics::HandIndex(i))) continue;
    AddForearm(scene.hands[i].model, picture.snapshot.hands[i], look, &list->ghosts.emplace_back(),
               list);
  }
}

void AddGhost(const Picture& picture, std::size_t number, DrawList* list) {
  const physics::Scene& scene = *picture.scene;
  const Ghost& ghost = picture.ghosts[number];
  const bool has_hand =
      ghost.hand.IsBelow(scene.hands.size()) && ghost.hand.IsBelow(ghost.snapshot.hands.size());
  const std::string who = has_hand ? scene.hand(ghost.hand).name : "";
  Appearance look{.alpha = kGhostAlpha, .gloss = 0.1f};
  look.object = AddObject("ghost:" + std::to_string(number) + ":" + who, list);
  std::vector<Item> items;
  if (has_hand) {
    look.color = 0.6f * ghost.tint + 0.4f * kSkinColor;
    AddHand(scene.hand(ghost.hand).model, ghost.snapshot.hand(ghost.hand), look, {}, &items, list);
  }
  for (const physics::BodyIndex body : ghost.bodies) {
    if (!body.IsBelow(scene.bodies.size())) continue;
    const std::size_t i = body.index();
    look.color = 0.75f * BodyColor(picture, i) + 0.25f * ghost.tint;
    AddBody(scene.bodies[i], BodyPose(scene, ghost.snapshot, i), look, &items, list);
  }
  list->ghosts.push_back(std::move(items));
}

/// Three thin boards through one line, crossed.
void AddStar(Item item, DrawList* list) {
  const Vector3f half = item.X_WI.linear().diagonal();
  const Affine3f X_WS(Eigen::Translation3f(item.X_WI.translation()));
  item.primitive = Primitive::kBox;
  SetRoundedBox({half.x(), 0.22f * half.y(), 0.28f * half.z()}, 0.1f * half.z(), &item);
  for (int i = 0; i < 3; ++i) {
    const auto angle = static_cast<float>(i * M_PI / 3);
    item.X_WI = X_WS * Eigen::AngleAxisf(angle, Vector3f::UnitY());
    AddItem(item, &list->markers, list);
  }
}

void AddMarker(const Picture& picture, std::size_t number, DrawList* list) {
  const Marker& marker = picture.markers[number];
  struct MarkerSample {
    const char* name;
    Color color;
    float alpha;
  };
  static const MarkerSample kLooks[] = {
      {"contact", {1.0f, 0.83f, 0.0f}, 0.9f},    {"support", {0.18f, 0.80f, 0.25f}, 0.75f},
      {"region", {0.42f, 0.66f, 1.0f}, 0.30f},   {"contact", {1.0f, 0.83f, 0.0f}, 0.9f},
      {"sphere", {0.42f, 0.66f, 1.0f}, 0.30f},   {"cylinder", {0.42f, 0.66f, 1.0f}, 0.30f},
      {"candidate", {0.93f, 0.49f, 0.0f}, 0.95f}};
  const MarkerSample& look = kLooks[static_cast<int>(marker.kind)];
  const std::string name = "marker:" + std::to_string(number) + ":" + look.name;
  if (!(marker.half_size_m.minCoeff() > 0)) return;
  Item item{
      .primitive = Primitive::kBall,
      .X_WI = Eigen::Translation3f(marker.p_W_m) * marker.q_WM * Eigen::Scaling(marker.half_size_m),
      .rounding_m = 1,
      .color = marker.color.value_or(look.color),
      .alpha = look.alpha,
      .gloss = 0,
      .object = AddObject(name, list),
      .shines_through =
          marker.kind == MarkerKind::kPersonsContact || marker.kind == MarkerKind::kCandidate};
  if (marker.kind == MarkerKind::kCandidate) return AddStar(item, list);
  if (marker.kind == MarkerKind::kCylinder) {
    item.X_WI = Eigen::Translation3f(marker.p_W_m);
    item.primitive = Primitive::kCylinder;
    item.rounding_m = 0.08f * marker.half_size_m.minCoeff();
    item.half_size_m = marker.half_size_m.array() - item.rounding_m;
  }
  AddItem(item, &list->markers, list);
}

/// Of beads and tubes: they grow with the distance, within bounds, but shrink again near a hand,
/// which they would hide.
float ScaleAt(float distance_m) {
  constexpr float kLeast = 0.6f, kMost = 4, kNear_m = 0.9f;
  return std::min(std::clamp(distance_m / kUsualDistance_m, kLeast, kMost),
                  kLeast * distance_m / kNear_m);
}

/// What there is one of per body or hand may be missing, but there is no more of it.
void CheckSizes(const Picture& picture, std::size_t bodies, std::size_t hands) {
  PREHEND_CHECK(picture.snapshot.bodies.size() <= bodies);
  PREHEND_CHECK(picture.snapshot.hands.size() <= hands);
  PREHEND_CHECK(picture.body_colors.size() <= bodies && picture.body_alphas.size() <= bodies);
  PREHEND_CHECK(picture.hand_colors.size() <= hands);
}

}  // namespace

void AddItem(const Item& item, std::vector<Item>* items, DrawList* list) {
  if (!item.X_WI.matrix().allFinite() || !item.half_size_m.allFinite() ||
      !std::isfinite(item.rounding_m) || !item.color.allFinite()) {
    return;
  }
  PREHEND_DCHECK(item.object >= 0 && item.object < std::ssize(list->objects));
  PREHEND_DCHECK(item.primitive != Primitive::kMesh ||
                 (item.mesh >= 0 && item.mesh < std::ssize(list->meshes)));
  Bounds bounds;
  if (item.primitive == Primitive::kMesh) {
    for (const Vertex& vertex : list->meshes[item.mesh].vertices)
      bounds.Add(Vector3f(item.X_WI * vertex.corner));
  } else {
    const Vector3f reach =
        item.X_WI.linear().cwiseAbs() * (item.half_size_m.array() + item.rounding_m).matrix();
    bounds.Add(Vector3f(item.X_WI.translation() - reach));
    bounds.Add(Vector3f(item.X_WI.translation() + reach));
  }
  DrawnObject& object = list->objects[item.object];
  object.bounds.Add(bounds);
  if (!object.color) {
    object.color = item.color;
    object.alpha = item.alpha;
  }
  list->bounds.Add(bounds);
  items->push_back(item);
}

Color BodyColor(const Picture& picture, std::size_t body) {
  static const Color kPalette[] = {
      {0.91f, 0.93f, 0.95f}, {0.88f, 0.48f, 0.25f}, {0.25f, 0.43f, 0.55f}, {0.61f, 0.77f, 0.24f},
      {0.78f, 0.16f, 0.20f}, {0.89f, 0.70f, 0.39f}, {0.42f, 0.56f, 0.68f}, {0.55f, 0.36f, 0.29f}};
  if (body < picture.body_colors.size()) return picture.body_colors[body];
  if (picture.scene->bodies[body].fixed) return {0.80f, 0.62f, 0.44f};
  return kPalette[body % std::size(kPalette)];
}

DrawList MakeDrawList(const Picture& picture) {
  DrawList list;
  list.objects = {{"background", {}}, {"ground", {}}};
  if (picture.to_light.allFinite() && picture.to_light.norm() > 0)
    list.to_light = picture.to_light.normalized();
  if (picture.scene != nullptr) {
    CheckSizes(picture, picture.scene->bodies.size(), picture.scene->hands.size());
    AddBodiesAndHands(picture, &list);
  }
  const float distance = (picture.camera.eye_m - picture.camera.look_at_m).norm();
  const float scale = std::isfinite(distance) ? ScaleAt(distance) : 1.0f;
  AddPath(picture.path, scale, &list);
  if (picture.scene != nullptr) {
    for (std::size_t i = 0; i < picture.ghosts.size(); ++i) AddGhost(picture, i, &list);
  }
  for (std::size_t i = 0; i < picture.markers.size(); ++i) AddMarker(picture, i, &list);
  for (const Prop& prop : picture.props) AddProp(prop, &list);
  for (std::size_t i = 0; i < picture.gazes.size(); ++i) AddGaze(picture.gazes[i], i, scale, &list);
  list.theme = picture.theme;
  list.paper = picture.paper;
  return list;
}

}  // namespace prehend::render
