// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/scenario/resolve/build_joints_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/scenario/resolve/resolve.h"
#include "physics/base/random.h"
#include "physics/motion/stage_clock.h"
#include "physics/scene/fill_vessel.h"
#include "physics/scene/geometry.h"
#include "physics/scene/landing.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;

constexpr double kDefaultSphereRollingFriction =
    0.006;  // a ball on a table stops within a metre (docs/physics.md)

/// Everything except the position.
physics::Body MakeBody(const Named<EntityYaml>& named) {
  const EntityYaml& entity = named.value;
  physics::Body body;
  body.name = named.name;
  body.shapes = entity.parts;
  if (entity.shape) body.shapes = {{*entity.shape, {}}};
  body.fixed = entity.fixed;
  body.mass_kg = entity.mass_kg ? entity.mass_kg->value : 0;
  if (entity.friction) body.friction = entity.friction->value;
  const bool is_ball = entity.shape && std::holds_alternative<physics::Sphere>(*entity.shape);
  body.rolling_friction = entity.rolling_friction.value_or(
      is_ball || entity.grains ? kDefaultSphereRollingFriction : 0);
  if (entity.grains) body.grains = physics::Grains{.radius_m = entity.grains->radius_m};
  body.restitution = entity.restitution;
  body.linear_damping_per_s = entity.linear_damping_per_s;
  body.angular_damping_per_s = entity.angular_damping_per_s;
  body.X_WB.q = entity.q;
  if (AbstractOf(entity) != physics::Abstract::kNot) MakeAbstract(entity, body);
  return body;
}

/// Cosine of the tilt: 1 upright, -1 upside down.
double Uprightness(const physics::Body& body) { return (body.X_WB.q * Vector3d::UnitZ()).z(); }
constexpr double kUpright = 0.999;

/// Places every body after the one it stands on.
class Stacking {
 public:
  Stacking(const ScenarioYaml& entry, DiagnosticList& errors) : entry_(entry), errors_(errors) {
    for (const auto& named : entry.entities) {
      index_[named.name] = bodies.size();
      bodies.push_back(MakeBody(named));
    }
    progress_.resize(bodies.size(), Progress::kWaiting);
  }

  /// Iterative, since a stack may be thousands high.
  void Place(std::size_t i) {
    std::vector<std::size_t> above;  // placed once their support is
    std::optional<std::size_t> next = i;
    while (next && progress_[*next] == Progress::kWaiting) {
      progress_[*next] = Progress::kBegun;
      above.push_back(*next);
      next = SupportOf(*next);
    }
    if (next && progress_[*next] == Progress::kBegun) {
      const EntityYaml& entity = entry_.entities[above.back()].value;
      const auto& below = entity.in ? entity.in : entity.on;
      errors_.Add(below->where, fmt::format("on: '{}' stands, directly or not, on itself",
                                            entry_.entities[*next].name));
    }
    for (; !above.empty(); above.pop_back()) {
      if (entry_.entities[above.back()].value.in)
        PlaceInVessel(above.back());
      else
        PlaceOnSupport(above.back());
      progress_[above.back()] = Progress::kDone;
    }
  }

  std::vector<physics::Body> bodies;

 private:
  enum class Progress { kWaiting, kBegun, kDone };

  std::optional<std::size_t> SupportOf(std::size_t i) {
    const EntityYaml& entity = entry_.entities[i].value;
    const auto& below = entity.in ? entity.in : entity.on;
    if (!below) return std::nullopt;
    const char* key = entity.in ? "in" : "on";
    const auto found = FindEntity(entry_, *below, key, errors_);
    if (!found) return std::nullopt;
    if (const std::string what = WhyNoThing(bodies[*found]); !what.empty()) {
      errors_.Add(below->where, fmt::format("{}: '{}' is {}, which cannot support anything", key,
                                            below->value, what));
      return std::nullopt;
    }
    return found;
  }

  /// The index of a physical body that has been placed already.
  const physics::Body* Placed(const std::optional<Located<std::string>>& name) const {
    const auto found = name ? index_.find(name->value) : index_.end();
    if (found == index_.end() || progress_[found->second] != Progress::kDone) return nullptr;
    const physics::Body& body = bodies[found->second];
    return physics::IsThing(body) ? &body : nullptr;
  }

  void PlaceInVessel(std::size_t i) {
    const EntityYaml& entity = entry_.entities[i].value;
    physics::Body& body = bodies[i];
    const physics::Body* vessel = Placed(entity.in);
    if (!vessel || !entity.grains) return;  // already reported
    if (Uprightness(*vessel) < kUpright) {
      return errors_.Add(entity.in->where, fmt::format("in: '{}' is not upright", vessel->name));
    }
    constexpr int kMaxGrains = 500;
    grains_so_far_ += entity.grains->count;
    if (grains_so_far_ > kMaxGrains) {
      return errors_.Add(entity.in->where,
                         fmt::format("more than {} grains in the scenario", kMaxGrains));
    }
    const std::uint64_t seed =
        physics::Random(entry_.world.seed ^ physics::Random(i).Next()).Next();
    const GrainsYaml& grains = *entity.grains;
    for (const Vector3d& p_B_m :
         physics::FillVessel(*vessel, grains.radius_m, grains.count, seed)) {
      body.grains->p_WG_m.push_back(vessel->X_WB * p_B_m);
      body.X_WB.p_m += body.grains->p_WG_m.back() / grains.count;
    }
    if (const std::size_t fit = body.grains->p_WG_m.size();
        fit < static_cast<std::size_t>(grains.count)) {
      errors_.Add(entity.in->where,
                  fmt::format("in: {} of {} grains fit into '{}' below its rim", fit, grains.count,
                              vessel->name),
                  "use fewer or smaller grains, or a larger vessel; its hollow is centred on the "
                  "vertical through its at_m");
    }
  }

  void PlaceOnSupport(std::size_t i) {
    const EntityYaml& entity = entry_.entities[i].value;
    physics::Body& body = bodies[i];
    const std::vector<double>& at = entity.at_m.value;
    if (at.size() < 2) return;  // already reported
    body.X_WB.p_m = {at[0], at[1], at.size() > 2 ? at[2] : 0};
    const physics::Body* placed = Placed(entity.on);
    if (!placed || body.shapes.empty()) return;  // unknown, cyclic, or reported already
    const physics::Body& support = *placed;
    const double lowest = physics::WorldBounds(body, {Vector3d::Zero(), body.X_WB.q}).min().z();
    if (!physics::IsAbove(support, support.X_WB, {at[0], at[1]})) {
      return errors_.Add(
          entity.at_m.where,
          fmt::format("at_m: the centre of '{}' is not above '{}'", body.name, support.name),
          "at_m is in world coordinates, also with 'on'");
    }
    // It is let down from higher than the whole support.
    body.X_WB.p_m.z() = physics::WorldBounds(support, support.X_WB).max().z() - lowest;
    const std::optional<double> landing_m =
        physics::LandingHeight(support, support.X_WB, body, body.X_WB);
    if (!landing_m) {
      return errors_.Add(
          entity.at_m.where,
          fmt::format("at_m: no part of '{}' is below '{}'", support.name, body.name),
          "'on' lets it straight down until it touches; here it would fall through");
    }
    body.X_WB.p_m.z() = *landing_m - lowest;
  }

  const ScenarioYaml& entry_;
  DiagnosticList& errors_;
  std::map<std::string, std::size_t> index_;
  std::vector<Progress> progress_;
  int grains_so_far_ = 0;
};

void Override(const PidOverride& given, physics::PidGains& gains) {
  gains.proportional = given.proportional.value_or(gains.proportional);
  gains.derivative = given.derivative.value_or(gains.derivative);
  gains.integral = given.integral.value_or(gains.integral);
  gains.limit = given.limit.value_or(gains.limit);
}

using physics::JointKind;

/// A relation of each entity to at most one other, without cycles.
class Relation {
 public:
  /// `to_itself` is the message about a cycle: "is part of itself".
  Relation(const ScenarioYaml& entry, std::string to_itself, DiagnosticList& errors)
      : entry_(entry),
        to_itself_(std::move(to_itself)),
        errors_(errors),
        target_(entry.entities.size(), grammar::kNoEntity) {
    for (const auto& named : entry.entities) names_.push_back(named.name);
  }

  /// False after an error.
  bool Add(std::size_t i, const std::string& key, const Located<std::string>& name) {
    const auto found = FindEntity(entry_, name, key, errors_);
    if (!found) return false;
    target_[i] = static_cast<int>(*found);
    if (!LeadsBackTo(i)) return true;
    errors_.Add(name.where,
                fmt::format("{}: '{}', directly or not, {}", key, names_[i], to_itself_));
    target_[i] = grammar::kNoEntity;
    return false;
  }

  /// The same, where mistakes are reported elsewhere: they change nothing.
  void AddQuietly(std::size_t i, const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return;
    target_[i] = static_cast<int>(found - names_.begin());
    if (LeadsBackTo(i)) target_[i] = grammar::kNoEntity;
  }

  int target(std::size_t i) const { return target_[i]; }
  std::vector<int> targets() const { return target_; }

 private:
  bool LeadsBackTo(std::size_t i) const {
    int next = target_[i];
    while (next != grammar::kNoEntity && next != static_cast<int>(i))
      next = target_[static_cast<std::size_t>(next)];
    return next != grammar::kNoEntity;
  }

  const ScenarioYaml& entry_;
  const std::string to_itself_;
  DiagnosticList& errors_;
  std::vector<std::string> names_;
  std::vector<int> target_;
};

physics::Joint MakeJoint(const JointYaml& written) {
  physics::Joint joint = written;
  const double scale = written.kind == JointKind::kHinge ? physics::kRadPerDeg : 1;
  joint.axis_W.normalize();
  joint.lower = written.range.value[0] * scale;
  joint.upper = written.range.value[1] * scale;
  joint.rest *= scale;
  return joint;
}

// Tested by tests/harness/episode/run/outcome_test.cc

/// Resolves names to bodies and joints of the scene.
class ConditionBuilder {
 public:
  ConditionBuilder(const physics::Scene& scene, const physics::Script& script,
                   DiagnosticList& errors)
      : scene_(scene), errors_(errors), end_s_(physics::DurationOf(script)) {
    // Every stage ends with a tick.
    latest_s_ = end_s_ + static_cast<double>(script.stages.size() + 1) / scene.world.rate_hz;
    for (const physics::Body& body : scene.bodies) names_.push_back(body.name);
  }

  std::optional<Outcome::Condition> Build(const ConditionYaml& wanted) const {
    Outcome::Condition condition{.wanted = wanted};
    condition.body = Find("entity", {wanted.entity, wanted.where});
    if (condition.body == physics::kNone) return std::nullopt;
    condition.joint = JointOf(condition.body);
    if ((wanted.joint_above || wanted.joint_below) && condition.joint < 0)
      errors_.Add(wanted.where, fmt::format("entity: '{}' has no joint", wanted.entity));
    if (wanted.share < 1 && !scene_.bodies[condition.body.index()].grains)
      errors_.Add(
          wanted.where,
          fmt::format("share: '{}' is not of grains; its centre is inside or not", wanted.entity));
    if (wanted.at_s && *wanted.at_s > latest_s_)
      errors_.Add(
          wanted.where,
          fmt::format("at_s: {} s is after the end of the run at {:.3f} s", *wanted.at_s, end_s_),
          "without at_s the condition is checked at the end");
    if (wanted.inside) {
      condition.vessel = Find("inside", *wanted.inside);
      if (condition.vessel == condition.body)
        errors_.Add(wanted.inside->where, "inside: an entity cannot be inside itself");
    }
    return condition;
  }

 private:
  /// None after an error.
  physics::BodyIndex Find(const char* key, const Located<std::string>& name) const {
    const auto found = errors_.Find(name, key, names_);
    return found ? physics::BodyIndex(*found) : physics::kNone;
  }

  int JointOf(physics::BodyIndex body) const {
    const auto joint =
        std::find_if(scene_.joints.begin(), scene_.joints.end(),
                     [&](const physics::Joint& candidate) { return candidate.body == body; });
    return joint == scene_.joints.end() ? -1 : static_cast<int>(joint - scene_.joints.begin());
  }

  const physics::Scene& scene_;
  DiagnosticList& errors_;
  double end_s_ = 0, latest_s_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<physics::Body> PlaceBodies(const ScenarioYaml& entry, DiagnosticList& errors) {
  Stacking stacking(entry, errors);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) stacking.Place(i);
  return std::move(stacking.bodies);
}

constexpr int kMostRate_hz = 4800;  // of 'rate_hz', docs/scenario-format.md

/// The least rate from this one on at which the hand is stable; "" if none is.
std::string RateRemedy(const physics::HandModel& model, int rate_hz) {
  while (rate_hz <= kMostRate_hz && !physics::CheckGains(model, rate_hz).empty()) ++rate_hz;
  return rate_hz > kMostRate_hz
             ? ""
             : fmt::format("it is stable from 'world: {{rate_hz: {}}}' on", rate_hz);
}

physics::Hand PlaceHand(const Named<HandActorYaml>& actor, physics::HandModel model, int rate_hz,
                        DiagnosticList& errors) {
  if (actor.value.gains) {
    Override(actor.value.gains->value.translation, model.translation);
    Override(actor.value.gains->value.rotation, model.rotation);
  }
  if (const std::string unstable = physics::CheckGains(model, rate_hz); !unstable.empty()) {
    errors.Add(actor.value.gains ? actor.value.gains->where : actor.value.hand.where,
               fmt::format("actor '{}': {}", actor.name, unstable), RateRemedy(model, rate_hz));
  }
  physics::Hand hand{
      .name = actor.name,
      .model = std::move(model),
      .X_WH = {actor.value.at_m.value, physics::FromRollPitchYaw(actor.value.rpy_deg)}};
  if (const auto& tracking = actor.value.tracking) {
    hand.tracking = tracking->value;
    if (tracking->value.tracker_hz > rate_hz) {
      errors.Add(tracking->where, fmt::format("tracker_hz {} is above rate_hz {}",
                                              tracking->value.tracker_hz, rate_hz));
    }
  }
  return hand;
}

std::vector<physics::Joint> BuildJoints(const ScenarioYaml& entry, DiagnosticList& errors) {
  std::vector<physics::Joint> joints;
  Relation hangs_on(entry, "is attached to itself", errors);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    if (!entity.joint) continue;
    const JointYaml& written = entity.joint->value;
    if (!hangs_on.Add(i, written.key, written.to)) continue;
    const auto base = static_cast<std::size_t>(hangs_on.target(i));
    if (written.kind == JointKind::kFixed && entry.entities[base].value.fixed) {
      errors.Add(written.to.where, fmt::format("fixed_to: '{}' never moves", written.to.value),
                 fmt::format("give '{}' 'fixed: true' instead", entry.entities[i].name));
    }
    if (AbstractOf(entry.entities[base].value) != physics::Abstract::kNot)
      errors.Add(written.to.where,
                 fmt::format("{}: '{}' is abstract: nothing can be attached to it", written.key,
                             written.to.value));
    if (entry.entities[base].value.grains)
      errors.Add(written.to.where,
                 fmt::format("{}: '{}' is grains: nothing can be attached to them", written.key,
                             written.to.value));
    physics::Joint& joint = joints.emplace_back(MakeJoint(written));
    joint.body = physics::BodyIndex(i);
    joint.base = physics::BodyIndex(base);
  }
  return joints;
}

std::vector<int> PartsOf(const ScenarioYaml& entry, DiagnosticList& errors) {
  Relation part_of(entry, "is part of itself", errors);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    if (entity.part_of) part_of.Add(i, "part_of", *entity.part_of);
  }
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    const Located<std::string>* const whole = FixedTo(entity);
    if (!entity.part_of && whole) part_of.AddQuietly(i, whole->value);
  }
  return part_of.targets();
}

std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionYaml>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   DiagnosticList& errors) {
  const ConditionBuilder builder(scene, script, errors);
  std::vector<Outcome> outcomes;
  for (const auto& entry : entries) {
    if (entry.name == "failed" || entry.name == "other")
      errors.Add(entry.name_where,
                 fmt::format("outcomes: '{}' is reserved for trials that {}", entry.name,
                             entry.name == "failed" ? "went wrong" : "match no outcome"),
                 "choose another name");
    Outcome& outcome = outcomes.emplace_back();
    outcome.name = entry.name;
    for (const ConditionYaml& wanted : entry.value) {
      if (auto condition = builder.Build(wanted))
        outcome.conditions.push_back(std::move(*condition));
    }
  }
  return outcomes;
}

}  // namespace prehend::scenario
