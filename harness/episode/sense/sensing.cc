// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/sense/sensing.h"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "harness/episode/sense/episode_format.h"

namespace prehend::episode {
namespace {

constexpr int kFeelersPerLink = 3;
constexpr int kPalmFeelersPerSide = 3;

// If a touch has no force, as after a bounce, all of its points count equally.
constexpr double kJustPushed_n_s = 1e-12;

/// Spheres inside the palm's box, in the hand's frame.
std::vector<grammar::CollisionSphere> PalmFeelers(const physics::HandModel& model) {
  const double radius = model.palm_size_m.z() / 2;
  const Eigen::Vector2d reach = model.palm_size_m.head<2>() / 2 - Eigen::Vector2d::Constant(radius);
  std::vector<grammar::CollisionSphere> collision_spheres;
  for (int i = 0; i < kPalmFeelersPerSide; ++i) {
    for (int j = 0; j < kPalmFeelersPerSide; ++j) {
      const double u = 2.0 * i / (kPalmFeelersPerSide - 1) - 1,
                   v = 2.0 * j / (kPalmFeelersPerSide - 1) - 1;
      collision_spheres.push_back({{u * reach.x(), v * reach.y(), 0}, radius});
    }
  }
  return collision_spheres;
}

/// Spheres inside the box of each link, in that link's frame (x along the link).
std::vector<grammar::CollisionSphere> LinkFeelers(const physics::HandModel& model) {
  std::vector<grammar::CollisionSphere> collision_spheres;
  for (const physics::HandLink& link : model.links) {
    const double radius = std::min({link.half_thickness_m, link.half_width_m, link.length_m / 2});
    const double reach = link.length_m / 2 - radius;
    for (int i = 0; i < kFeelersPerLink; ++i)
      collision_spheres.push_back({{(2.0 * i / (kFeelersPerLink - 1) - 1) * reach, 0, 0}, radius});
  }
  return collision_spheres;
}

/// For each style of the hand, its index in `names`, which contains all of them.
std::vector<int> StyleIndices(const physics::HandModel& model,
                              const std::vector<std::string>& names) {
  std::vector<int> indices;
  for (const physics::GraspStyle& style : model.styles)
    indices.push_back(static_cast<int>(std::ranges::find(names, style.name) - names.begin()));
  return indices;
}

grammar::EntitySample LookAt(const physics::BodyState& body) {
  return {.p_WB_m = body.X_WB.p_m,
          .q_WB = body.X_WB.q,
          .v_WB_m_per_s = body.v_WB_m_per_s,
          .w_WB_rad_per_s = body.w_WB_rad_per_s,
          .asleep = body.asleep};
}

/// For each entity whether sensors measure its pose: it moves, or could. Where fixed things and
/// abstract entities are is known.
std::vector<bool> MeasuredOf(const physics::Scene& scene) {
  std::vector<bool> measured;
  for (const physics::Body& body : scene.bodies)
    measured.push_back(!body.fixed && body.abstract == physics::Abstract::kNot);
  measured.resize(scene.bodies.size() + scene.hands.size(), true);
  return measured;
}

constexpr std::uint64_t kFrames = ~std::uint64_t{0};  // the channel of losses of whole frames
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

Eigen::Vector3d NormalVector(physics::Random& random, double deviation) {
  Eigen::Vector3d vector;
  for (double& component : vector) component = random.Normal(0, deviation);
  return vector;
}

}  // namespace

Sensing::Sensing(const physics::Scene& scene, const scenario::SensingSettings& settings)
    : rate_hz_(scene.world.rate_hz),
      sensing_hz_(settings.sensing_hz),
      bearing_share_(settings.bearing_share),
      body_count_(static_cast<int>(scene.bodies.size())) {
  const std::vector<std::string> styles = StyleNames(scene);
  for (const physics::Hand& hand : scene.hands) {
    geometry_.push_back({hand.model, PalmFeelers(hand.model), LinkFeelers(hand.model),
                         StyleIndices(hand.model, styles)});
    collision_spheres_.emplace_back(geometry_.back().palm.size() + geometry_.back().links.size());
  }
  for (const physics::Person& person : scene.persons) heads_.push_back(person.head.number());
  for (const physics::Joint& joint : scene.joints) jointed_.push_back(joint.body.number());
  entities_.resize(scene.bodies.size() + scene.hands.size());
  hands_.resize(scene.hands.size());
  if (!settings.sensors.IsPerfect()) noise_.emplace(settings.sensors, MeasuredOf(scene));
}

grammar::FrameChanges Sensing::SenseChanges(const physics::Snapshot& snapshot) {
  if (snapshot.tick <= tick_) tick_ = -1;  // an earlier tick: any body may have moved
  shown_.clear();
  SenseBodies(snapshot);
  SenseHands(snapshot);
  SenseTouches(snapshot);
  tick_ = snapshot.tick;
  if (noise_) return noise_->Show(WithoutNoise());

  std::ranges::sort(shown_);
  shown_.erase(std::unique(shown_.begin(), shown_.end()), shown_.end());
  entity_changes_.clear();
  for (const int entity : shown_)
    entity_changes_.push_back({entity, entities_[static_cast<std::size_t>(entity)]});
  return {tick_, entity_changes_, hands_, touch_changes_, contact_ends_};
}

grammar::Frame Sensing::Whole() { return noise_ ? noise_->Shown() : WithoutNoise(); }

grammar::Frame Sensing::WithoutNoise() {
  touches_ = now_.All();
  return {tick_, entities_, hands_, touches_};
}

void Sensing::Show(int entity, const grammar::EntitySample& look) {
  grammar::EntitySample& before = entities_[static_cast<std::size_t>(entity)];
  if (!SameFacts(look, before)) shown_.push_back(entity);
  before = look;
}

void Sensing::SenseBodies(const physics::Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
    if (!snapshot.MayHaveMoved(i, tick_)) continue;
    grammar::EntitySample look = LookAt(snapshot.bodies[i]);
    look.joint_position = entities_[i].joint_position;
    look.joint_fraction = entities_[i].joint_fraction;
    look.gazes_at = entities_[i].gazes_at;
    Show(static_cast<int>(i), look);
  }
  for (std::size_t i = 0; i < snapshot.joints.size(); ++i) {
    grammar::EntitySample look = entities_[static_cast<std::size_t>(jointed_[i])];
    look.joint_position = snapshot.joints[i].position;
    look.joint_fraction = snapshot.joints[i].fraction;
    Show(jointed_[i], look);
  }
  for (std::size_t i = 0; i < snapshot.gazes.size(); ++i) {
    const physics::GazeState& gaze = snapshot.gazes[i];
    grammar::EntitySample look = entities_[static_cast<std::size_t>(heads_[i])];
    look.gazes_at = gaze.hand != physics::kNone   ? body_count_ + gaze.hand.number()
                    : gaze.body != physics::kNone ? gaze.body.number()
                                                  : grammar::kNoEntity;
    Show(heads_[i], look);
  }
}

void Sensing::SenseHands(const physics::Snapshot& snapshot) {
  for (std::size_t h = 0; h < snapshot.hands.size(); ++h) {
    const physics::HandState& hand = snapshot.hands[h];
    const HandGeometry& geometry = geometry_[h];
    std::vector<grammar::CollisionSphere>& collision_spheres = collision_spheres_[h];
    std::size_t next = 0;
    for (const grammar::CollisionSphere& collision_sphere : geometry.palm)
      collision_spheres[next++] = {hand.palm.X_WB * collision_sphere.p_W_m,
                                   collision_sphere.radius_m};
    for (std::size_t i = 0; i < geometry.links.size(); ++i) {
      const grammar::CollisionSphere& collision_sphere = geometry.links[i];
      collision_spheres[next++] = {hand.X_WL[i / kFeelersPerLink] * collision_sphere.p_W_m,
                                   collision_sphere.radius_m};
    }
    const int entity = body_count_ + static_cast<int>(h);
    Show(entity, LookAt(hand.palm));
    const auto style = static_cast<std::size_t>(hand.style);
    const int named = style < geometry.styles.size() ? geometry.styles[style] : grammar::kNoEntity;
    hands_[h] = {entity, hand.trigger, named, hand.palm.X_WB.q * geometry.model.ahead,
                 collision_spheres};
  }
}

void Sensing::SenseTouches(const physics::Snapshot& snapshot) {
  std::swap(now_.moving, before_.moving);
  ReadTouches(snapshot.contacts, now_.moving);
  touch_changes_.clear();
  contact_ends_.clear();
  if (snapshot.resting == resting_points_) return CompareTouches(before_.moving, now_.moving);
  std::swap(now_.resting, before_.resting);
  resting_points_ = snapshot.resting;
  ReadTouches(snapshot.AllContacts()[1], now_.resting);
  CompareTouches(before_.All(), now_.All());
}

Sensing::Touches Sensing::SensedTouches::All() const {
  Touches all;
  std::ranges::merge(moving, resting, std::back_inserter(all), {}, PairOf, PairOf);
  return all;
}

void Sensing::CompareTouches(const Touches& before, const Touches& now) {
  auto old = before.begin();
  for (const grammar::Touch& touch : now) {
    for (; old != before.end() && PairOf(*old) < PairOf(touch); ++old)
      contact_ends_.push_back({old->a, old->b});
    const bool touched = old != before.end() && PairOf(*old) == PairOf(touch);
    if (!touched || !(*old == touch)) touch_changes_.push_back(touch);
    if (touched) ++old;
  }
  for (; old != before.end(); ++old) contact_ends_.push_back({old->a, old->b});
}

void Sensing::ReadTouches(Points points, Touches& touches) {
  points_.clear();
  for (const physics::ContactPoint& contact : points) {
    const int a = EntityOf(contact.a), b = EntityOf(contact.b);
    if (a == b) continue;
    points_.push_back({std::minmax(a, b), a < b ? contact.nhat_BA_W : -contact.nhat_BA_W,
                       contact.normal_impulse_n_s, contact.p_W_m,
                       SensorSetOf(contact.a) | SensorSetOf(contact.b)});
  }
  std::ranges::stable_sort(points_, {}, &PairPoint::pair);

  touches.clear();
  for (std::size_t first = 0; first < points_.size();) {
    std::size_t last = first;
    double load = 0;
    grammar::Touch touch{.a = points_[first].pair.first, .b = points_[first].pair.second};
    for (; last < points_.size() && points_[last].pair == points_[first].pair; ++last) {
      load += points_[last].impulse_n_s;
      touch.sensor_sets |= points_[last].sensor_sets;
    }
    for (std::size_t i = first; i < last; ++i) {
      if (points_[i].impulse_n_s < bearing_share_ * load) continue;
      touch.up_on_a = std::max(touch.up_on_a, points_[i].nhat_W.z());
      touch.up_on_b = std::max(touch.up_on_b, -points_[i].nhat_W.z());
    }
    touch.normal_force_n = load * static_cast<double>(rate_hz_);
    LookAtBearing(std::span(points_).subspan(first, last - first), touch);
    touches.push_back(touch);
    first = last;
  }
}

void Sensing::LookAtBearing(std::span<const PairPoint> points, grammar::Touch& touch) const {
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero(), push_W = Eigen::Vector3d::Zero();
  double load = 0;
  for (const PairPoint& point : points) {
    const double bears = (point.impulse_n_s + kJustPushed_n_s) * std::abs(point.nhat_W.z());
    centre_W_m += bears * point.p_W_m;
    push_W += bears * point.nhat_W;
    load += bears;
  }
  if (load <= 0) return;
  touch.p_W_m = centre_W_m / load;
  touch.nhat_BA_W = push_W.normalized();  // zero where equal loads push both ways
  touch.vertical_speed_m_per_s =
      grammar::VerticalSpeedBetween(entities_[static_cast<std::size_t>(touch.a)],
                                    entities_[static_cast<std::size_t>(touch.b)], touch.p_W_m);
}

int Sensing::EntityOf(const physics::ContactSide& side) const {
  return side.hand != physics::kNone ? body_count_ + side.hand.number() : side.body.number();
}

std::uint32_t Sensing::SensorSetOf(const physics::ContactSide& side) const {
  if (side.hand == physics::kNone) return 0;
  const physics::HandModel& model = At(geometry_, side.hand).model;
  return 1u << (side.link == physics::kNone ? model.palm_sensor_set
                                            : model.link(side.link).sensor_set);
}

SensorNoise::SensorNoise(const scenario::SensorSettings& settings, std::vector<bool> measured)
    : settings_(settings), measured_(std::move(measured)) {}

physics::Random SensorNoise::At(grammar::Tick tick, std::uint64_t channel) const {
  const std::uint64_t of_tick =
      physics::Random(settings_.seed).Next() ^ static_cast<std::uint64_t>(tick);
  return physics::Random(physics::Random(of_tick).Next() ^ channel);
}

bool SensorNoise::Loses(grammar::Tick tick) const {
  return At(tick, kFrames).Share() < settings_.lost_frames_share;
}

SensorNoise::Offset SensorNoise::OffsetOf(grammar::Tick tick, int entity) const {
  Offset offset;
  if (!measured_[static_cast<std::size_t>(entity)]) return offset;
  physics::Random random = At(tick, static_cast<std::uint64_t>(entity));
  offset.p_m = NormalVector(random, settings_.position_noise_m);
  const Eigen::Vector3d turn =
      NormalVector(random, settings_.rotation_noise_deg * kRadiansPerDegree);
  if (turn.norm() > 0) offset.q = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return offset;
}

void SensorNoise::ShowPoses(const grammar::Frame& truth) {
  entities_.assign(truth.entities.begin(), truth.entities.end());
  hands_.assign(truth.hands.begin(), truth.hands.end());
  collision_spheres_.resize(hands_.size());
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    grammar::HandSample& hand = hands_[h];
    const Offset offset = OffsetOf(truth.tick, hand.entity);
    const Eigen::Vector3d& palm_m = truth.entities[static_cast<std::size_t>(hand.entity)].p_WB_m;
    // The hand is measured as a whole: all of it is off as its palm is.
    auto& spheres = collision_spheres_[h];
    spheres.assign(hand.collision_spheres.begin(), hand.collision_spheres.end());
    for (grammar::CollisionSphere& sphere : spheres)
      sphere.p_W_m = palm_m + offset.p_m + offset.q * (sphere.p_W_m - palm_m);
    hand.collision_spheres = spheres;
    hand.ahead_W = offset.q * hand.ahead_W;
  }
  entity_changes_.clear();
  for (std::size_t i = 0; i < entities_.size(); ++i) {
    grammar::EntitySample& look = entities_[i];
    if (measured_[i]) {
      const Offset offset = OffsetOf(truth.tick, static_cast<int>(i));
      look.p_WB_m += offset.p_m;
      look.q_WB = offset.q * look.q_WB;
      look.asleep = false;
    }
    entity_changes_.push_back({static_cast<int>(i), look});
  }
}

void SensorNoise::ShowTouches(const grammar::Frame& truth) {
  std::swap(touches_, before_);
  touches_.clear();
  for (const grammar::Touch& touch : truth.touches) {
    const auto channel = (static_cast<std::uint64_t>(touch.a) << 32 | 1u << 31) +
                         static_cast<std::uint64_t>(touch.b);
    if (At(truth.tick, channel).Share() >= settings_.contact_dropout_share)
      touches_.push_back(touch);
  }
  contact_ends_.clear();
  for (const grammar::Touch& touch : before_) {
    if (!std::ranges::binary_search(touches_, PairOf(touch), {}, PairOf))
      contact_ends_.push_back({touch.a, touch.b});
  }
}

grammar::FrameChanges SensorNoise::Show(const grammar::Frame& truth) {
  tick_ = truth.tick;
  ShowPoses(truth);
  ShowTouches(truth);
  return {tick_, entity_changes_, hands_, touches_, contact_ends_};
}

}  // namespace prehend::episode
