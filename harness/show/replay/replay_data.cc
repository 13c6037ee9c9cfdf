// SPDX-License-Identifier: Apache-2.0
#include "harness/show/replay/replay_data.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "harness/base/base/quoting.h"
#include "harness/show/pictures/scenery.h"
#include "physics/base/visitors.h"
#include "physics/hand/script_player.h"

namespace prehend::show {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
using physics::Pose;
using physics::Snapshot;

// Whole numbers, and differences of them, are short as text.
constexpr double kUnits_per_m = 10'000;   ///< positions: 0.1 mm
constexpr double kUnits_per_one = 5'000;  ///< components of quaternions
constexpr double kCoarseUnits_per_m = 1'000;
constexpr int kSamples_hz = 30;  ///< contacts and gaze
constexpr int kGrainSamples_hz = 10;
constexpr std::size_t kMostGrains = 300;  ///< of one body; more are not told apart
constexpr int kPacking = 5;  ///< of zlib's 9: more takes twice as long for 1/100 of the size

std::int64_t Rounded(double value) {
  return std::isfinite(value) ? std::llround(std::clamp(value, -1e12, 1e12)) : 0;
}

/// Appends whole numbers as differences to those of the row before.
class Differences {
 public:
  explicit Differences(std::size_t width) : last_(width, 0) {}
  void Add(std::size_t column, double value) {
    const std::int64_t now = Rounded(value);
    list.push_back(now - last_[column]);
    last_[column] = now;
  }
  json list = json::array();

 private:
  std::vector<std::int64_t> last_;
};

json Numbers(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json PoseJson(const Pose& pose) {
  return {{"p", Numbers(pose.p_m)}, {"q", {pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()}}};
}

json TrackJson(const std::vector<Pose>& poses, const std::vector<std::int64_t>& ticks) {
  Differences at(1), p(3), q(4);
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  for (const std::size_t key : KeysOf(poses, ticks)) {
    Eigen::Quaterniond turned = poses[key].q;
    if (turned.dot(last) < 0) turned.coeffs() *= -1;  // the same rotation, nearer as numbers
    last = turned;
    at.Add(0, static_cast<double>(ticks[key]));
    for (int i = 0; i < 3; ++i) p.Add(i, poses[key].p_m[i] * kUnits_per_m);
    q.Add(0, turned.w() * kUnits_per_one);
    for (int i = 0; i < 3; ++i) q.Add(i + 1, turned.vec()[i] * kUnits_per_one);
  }
  return {{"t", at.list}, {"p", p.list}, {"q", q.list}};
}

struct ShapeJson {
  json operator()(const physics::Box& box) const {
    return {{"kind", "box"}, {"size", Numbers(box.size_m)}};
  }
  json operator()(const physics::Sphere& ball) const {
    return {{"kind", "sphere"}, {"radius", ball.radius_m}};
  }
  json operator()(const physics::Cylinder& cylinder) const {
    return {{"kind", "cylinder"}, {"radius", cylinder.radius_m}, {"length", cylinder.length_m}};
  }
  json operator()(const physics::Capsule& capsule) const {
    return {{"kind", "capsule"}, {"radius", capsule.radius_m}, {"length", capsule.length_m}};
  }
  json operator()(const physics::Hull& hull) const {
    json corners = json::array(), triangles = json::array();
    for (const Vector3d& corner : hull.corners_m) corners.push_back(Numbers(corner));
    for (const physics::Hull::Face& face : hull.faces)
      for (std::size_t i = 2; i < face.corners.size(); ++i)
        triangles.push_back({face.corners[0], face.corners[i - 1], face.corners[i]});
    return {{"kind", "hull"}, {"corners", corners}, {"triangles", triangles}};
  }
};

std::string KindOf(const physics::Body& body) {
  if (body.abstract == physics::Abstract::kRegion) return "region";
  if (body.abstract == physics::Abstract::kGazeTarget) return "gaze_target";
  if (body.kinematic) return "person";
  return body.fixed ? "fixed" : "thing";
}

std::string ColorText(const render::Color& color) {
  const auto part = [](float share) {
    return static_cast<int>(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", part(color.x()), part(color.y()), part(color.z()));
}

/// The frames of a run, and those at which what changes with every frame is sampled.
class Frames {
 public:
  explicit Frames(const episode::RunResult& run) : run_(run) {
    for (const Snapshot& frame : run.recording) ticks.push_back(frame.tick);
  }

  template <typename PoseAt>
  json Track(PoseAt&& pose_at) const {
    std::vector<Pose> poses;
    poses.reserve(run_.recording.size());
    for (const Snapshot& frame : run_.recording) poses.push_back(pose_at(frame));
    return TrackJson(poses, ticks);
  }

  template <typename Look>
  void Sample(int hz, Look&& look) const {
    for (std::size_t i = 0; i < ticks.size(); i += Every(hz)) look(run_.recording[i]);
  }

  std::size_t Every(int hz) const {
    return std::max<std::size_t>(1, static_cast<std::size_t>(run_.timeline.ticks_per_second) / hz);
  }
  /// From which tick on there is a sample, and after how many ticks the next.
  json Sampled(int hz, json list) const {
    return {{"begin", ticks.front()}, {"every", Every(hz)}, {"samples", std::move(list)}};
  }

  std::vector<std::int64_t> ticks;

 private:
  const episode::RunResult& run_;
};

json GrainsJson(const physics::Scene& scene, std::size_t body, const Frames& frames) {
  json samples = json::array();
  const std::size_t count =
      std::min(scene.bodies[body].grains->p_WG_m.size(), std::size_t{kMostGrains});
  Differences places(3 * count);
  frames.Sample(kGrainSamples_hz, [&](const Snapshot& frame) {
    const auto grains = physics::GrainsOf(scene, physics::BodyIndex(body), frame);
    for (std::size_t g = 0; g < std::min(count, grains.size()); ++g)
      for (int i = 0; i < 3; ++i) places.Add(3 * g + i, grains[g][i] * kCoarseUnits_per_m);
  });
  return {{"radius", scene.bodies[body].grains->radius_m},
          {"count", count},
          {"places", frames.Sampled(kGrainSamples_hz, places.list)}};
}

json BodiesJson(const scenario::Scenario& scenario, const Frames& frames) {
  const std::vector<render::Color> colors = BodyColors(scenario);
  json bodies = json::array();
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    if (!IsSeen(body)) continue;
    json shapes = json::array();
    for (const physics::PlacedShape& placed : body.shapes) {
      json shape = std::visit(ShapeJson{}, placed.shape);
      shape["X"] = PoseJson(placed.X_BS);
      shapes.push_back(std::move(shape));
    }
    json entry = {
        {"name", body.name},
        {"kind", KindOf(body)},
        {"color", ColorText(colors[i])},
        {"shapes", shapes},
        {"track", frames.Track([i](const Snapshot& frame) { return frame.bodies[i].X_WB; })}};
    if (body.grains) entry["grains"] = GrainsJson(scenario.scene, i, frames);
    bodies.push_back(std::move(entry));
  }
  return bodies;
}

/// What a hand is doing when: {"from", "to" (ticks), "name", "color"}.
json PhasesJson(const episode::RunResult& run, const std::string& hand) {
  json phases = json::array();
  for (const grammar::NamedEvent& event : run.timeline.events) {
    const truth::EventDrawing& drawing = run.drawings.Of(event.event);
    if (drawing.as != grammar::DrawnAs::kPhase || drawing.hand >= event.roles.size()) continue;
    if (event.roles[drawing.hand].value != hand) continue;
    phases.push_back({{"from", event.interval.begin},
                      {"to", event.interval.end},
                      {"name", event.event},
                      {"color", fmt::format("#{:06x}", drawing.color)}});
  }
  return phases;
}

json HandsJson(const physics::Scene& scene, const episode::RunResult& run, const Frames& frames) {
  json hands = json::array();
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    const physics::HandModel& model = scene.hands[h].model;
    std::vector<std::vector<Pose>> from_palm(model.links.size());
    for (const Snapshot& frame : run.recording) {
      const physics::HandState& hand = frame.hands[h];
      const Pose X_PW = hand.palm.X_WB.inverse();
      for (std::size_t l = 0; l < from_palm.size(); ++l)
        from_palm[l].push_back(X_PW * hand.X_WL[l]);
    }
    json links = json::array();
    for (std::size_t l = 0; l < model.links.size(); ++l) {
      const physics::HandLink& link = model.links[l];
      links.push_back(
          {{"size", Numbers({link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m})},
           {"track", TrackJson(from_palm[l], frames.ticks)}});
    }
    hands.push_back(
        {{"name", scene.hands[h].name},
         {"palm", Numbers(model.palm_size_m)},
         {"links", links},
         {"phases", PhasesJson(run, scene.hands[h].name)},
         {"track", frames.Track([h](const Snapshot& frame) { return frame.hands[h].palm.X_WB; })}});
  }
  return hands;
}

/// Of each sample a list of x, y, z in millimetres.
json ContactsJson(const Frames& frames) {
  json samples = json::array();
  frames.Sample(kSamples_hz, [&](const Snapshot& frame) {
    json points = json::array();
    for (const physics::ContactPoint& contact : frame.contacts)
      for (int i = 0; i < 3; ++i) points.push_back(Rounded(contact.p_W_m[i] * kCoarseUnits_per_m));
    samples.push_back(std::move(points));
  });
  return frames.Sampled(kSamples_hz, std::move(samples));
}

/// For each person and sample: x, y, z of the eyes and of what she sees, in millimetres.
json GazesJson(const physics::Scene& scene, const Frames& frames) {
  json gazes = json::array();
  for (std::size_t person = 0; person < scene.persons.size(); ++person) {
    Differences rays(6);
    frames.Sample(kSamples_hz, [&](const Snapshot& frame) {
      const std::vector<render::GazeRay> all = GazesOf(scene, frame);
      const render::GazeRay ray = person < all.size() ? all[person] : render::GazeRay{};
      for (int i = 0; i < 3; ++i) rays.Add(i, ray.from_m[i] * kCoarseUnits_per_m);
      for (int i = 0; i < 3; ++i) rays.Add(3 + i, ray.to_m[i] * kCoarseUnits_per_m);
    });
    gazes.push_back(
        {{"name", scene.persons[person].name}, {"rays", frames.Sampled(kSamples_hz, rays.list)}});
  }
  return gazes;
}

json LegsJson(const scenario::Scenario& scenario, const Snapshot& first) {
  json legs = json::array();
  for (const render::Prop& leg : LegsOf(scenario, BodyColors(scenario), first))
    legs.push_back({{"size", Numbers(2 * leg.half_size_m.cast<double>())},
                    {"p", Numbers(leg.center_m.cast<double>())},
                    {"color", ColorText(leg.color)}});
  return legs;
}

/// Rotations are compared by tan^2 of half the angle between them, without its arc tangent.
const double kTrackTan2 = std::pow(std::tan(kTrackTolerance_rad / 2), 2);

double Apart(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const double w2 = a.dot(b) * a.dot(b);
  return (a.squaredNorm() * b.squaredNorm() - w2) / w2;
}

bool IsNearPlace(const Pose& pose, const Eigen::Vector3d& p_m) {
  return (pose.p_m - p_m).squaredNorm() <= kTrackTolerance_m * kTrackTolerance_m;
}

bool IsNear(const Pose& a, const Pose& b) {
  return IsNearPlace(a, b.p_m) && Apart(a.q, b.q) <= kTrackTan2;
}

/// How far a thing has come and turned up to each pose, no less than it has.
struct Way {
  explicit Way(std::span<const Pose> poses) : m(poses.size()), rad(poses.size()) {
    for (std::size_t i = 1; i < poses.size(); ++i) {
      m[i] = m[i - 1] + (poses[i].p_m - poses[i - 1].p_m).norm();
      rad[i] = rad[i - 1] + 2 * std::sqrt(std::max(0.0, Apart(poses[i].q, poses[i - 1].q)));
    }
  }
  std::vector<double> m, rad;
};

/// Whether all poses strictly between two of them are near to what is interpolated. What does not
/// fit shows in the middle first, or where the last span did not (`misfit`), and in places before
/// rotations. Poses that cannot be too far off, because one beside them is so near, are not looked
/// at.
class Span {
 public:
  Span(std::span<const Pose> poses, std::span<const std::int64_t> at, const Way& way,
       std::size_t first, std::size_t last)
      : poses_(poses), at_(at), way_(way), first_(first), last_(last) {}

  bool Fits(std::size_t& misfit) {
    const std::size_t middle = first_ + (last_ - first_) / 2;
    if (middle > first_ && !IsNearAt(middle)) return false;
    if (misfit > first_ && misfit < last_ && !IsNearAt(misfit)) return false;
    for (std::size_t i = last_ - 1; i > first_; --i) {
      if (IsNearAt(i)) {
        const std::size_t near = i;
        for (std::size_t step = 1; step > 0;) {
          const bool is_near = i > first_ + step && IsNearBeside(near, i - step);
          if (is_near) i -= step;
          step = is_near ? 2 * step : step / 2;
        }
        continue;
      }
      misfit = i;
      return false;
    }
    return true;
  }

 private:
  double ShareAt(std::size_t i) const {
    return static_cast<double>(at_[i] - at_[first_]) /
           static_cast<double>(at_[last_] - at_[first_]);
  }

  /// Sets by how much it is nearer than it must be, at least.
  bool IsNearAt(std::size_t i) {
    const Pose &a = poses_[first_], &b = poses_[last_];
    const double share = ShareAt(i);
    spare_m_ = kTrackTolerance_m - (poses_[i].p_m - (a.p_m + share * (b.p_m - a.p_m))).norm();
    if (!(spare_m_ >= 0)) return false;
    spare_rad_ = 0;
    if (turn_ < kSmall) {
      // A straight line between the quaternions is off by less than turn^3 / 30 (0.0003 rad), and
      // decides most poses.
      Eigen::Quaterniond straight;
      straight.coeffs() = (1 - share) * a.q.coeffs() + share * sign_ * b.q.coeffs();
      const double apart = Apart(poses_[i].q, straight);
      spare_rad_ = kTrackTolerance_rad - 2 * std::sqrt(std::max(0.0, apart)) - 0.0006;
      if (apart < kTrackTan2 * 0.8) return true;
      if (apart > kTrackTan2 * 1.25) return false;
    }
    return IsNear(poses_[i], Between(a, b, share));
  }

  /// Of a pose before one that was looked at last.
  bool IsNearBeside(std::size_t near, std::size_t i) const {
    const double share = ShareAt(near) - ShareAt(i);
    return way_.m[near] - way_.m[i] + share * way_m_ < spare_m_ &&
           way_.rad[near] - way_.rad[i] + share * std::numbers::pi * turn_ < spare_rad_;
  }

  /// Of the half angle between the ends.
  static constexpr double kSmall = 0.2;

  std::span<const Pose> poses_;
  std::span<const std::int64_t> at_;
  const Way& way_;
  std::size_t first_, last_;
  double dot_ = poses_[first_].q.dot(poses_[last_].q);
  double sign_ = dot_ < 0 ? -1 : 1;
  double turn_ = std::sqrt(std::max(0.0, 2 - 2 * std::abs(dot_)));
  double way_m_ = (poses_[last_].p_m - poses_[first_].p_m).norm();
  double spare_m_ = 0, spare_rad_ = 0;
};

// The script is played once more, over the recorded motion: what waits for something happens when
// it did.

using namespace physics;

std::string Text(const StepAction& action) {
  return std::visit(
      Overloaded{[](const WaitStep&) { return std::string("wait"); },
                 [](const ReachStep& step) { return "reach " + step.object; },
                 [](const TriggerStep& step) {
                   return step.trigger > 0 ? fmt::format("close to {:g}", step.trigger)
                                           : std::string("open to 0");
                 },
                 [](const MoveStep& step) {
                   const bool is_lift = step.by_m.head<2>().isZero() && step.by_m.z() > 0;
                   return std::string(is_lift ? "lift" : "move");
                 },
                 [](const CarryStep&) { return std::string("carry"); },
                 [](const PlaceStep& step) { return "place on " + step.support; },
                 [](const RetreatStep&) { return std::string("retreat"); },
                 [](const FollowJointStep& step) {
                   return fmt::format("move {} to {:g}", step.entity, step.to);
                 },
                 [](const PosesStep&) { return std::string("way-points"); },
                 [](const TurnHandStep&) { return std::string("turn"); },
                 [](const OrbitStep& step) { return "around " + step.around; },
                 [](const PressStep& step) { return "press " + step.against; }},
      action);
}

std::string Text(const PersonAction& action) {
  return std::visit(Overloaded{[](const WaitStep&) { return std::string("wait"); },
                               [](const LookAtStep& step) {
                                 const auto* const name = std::get_if<std::string>(&step.target);
                                 return name ? "look at " + *name : std::string("look at a point");
                               },
                               [](const EyesStep&) { return std::string("look ahead"); },
                               [](const WalkStep&) { return std::string("walk"); },
                               [](const TurnStep&) { return std::string("turn"); },
                               [](const LeanStep&) { return std::string("lean"); },
                               [](const SwayStep&) { return std::string("sway"); },
                               [](const MoveLimbStep&) { return std::string("move a limb"); },
                               [](const HeadPosesStep&) { return std::string("recorded head"); },
                               [](const BodyPosesStep&) { return std::string("recorded body"); }},
                    action);
}

}  // namespace

json ReplayJson(const scenario::Scenario& scenario, const episode::RunResult& run) {
  const Frames frames(run);
  return {{"ticks_per_second", run.timeline.ticks_per_second},
          {"end", frames.ticks.back()},
          {"bodies", BodiesJson(scenario, frames)},
          {"legs", LegsJson(scenario, run.recording.front())},
          {"hands", HandsJson(scenario.scene, run, frames)},
          {"contacts", ContactsJson(frames)},
          {"gazes", GazesJson(scenario.scene, frames)}};
}

std::string ReplayData(const scenario::Scenario& scenario, const episode::RunResult& run) {
  if (run.recording.empty()) return "";
  const std::string text =
      ReplayJson(scenario, run).dump(-1, ' ', false, json::error_handler_t::replace);
  uLongf size = compressBound(text.size());
  std::string bytes(size, '\0');
  const int result = compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                               reinterpret_cast<const Bytef*>(text.data()), text.size(), kPacking);
  if (result != Z_OK) throw std::runtime_error("zlib: no memory");
  bytes.resize(size);
  return Base64(bytes);
}

Pose Between(const Pose& a, const Pose& b, double share) {
  return {a.p_m + share * (b.p_m - a.p_m), a.q.slerp(share, b.q)};
}

std::vector<std::size_t> KeysOf(std::span<const Pose> poses, std::span<const std::int64_t> at) {
  if (poses.empty()) return {};
  std::vector<std::size_t> keys = {0};
  const auto differs = [&](const Pose& pose) { return !IsNear(pose, poses.front()); };
  if (std::ranges::none_of(poses, differs)) return keys;
  std::size_t misfit = 0;
  const Way way(poses);
  const auto fits = [&](std::size_t to) {
    return Span(poses, at, way, keys.back(), to).Fits(misfit);
  };
  while (keys.back() + 1 < poses.size()) {
    // As far as doubled steps lead, then between the last that fits and the first that does not.
    const std::size_t from = keys.back();
    std::size_t good = from + 1, step = 1, bad = poses.size();
    while (good + step < poses.size() && fits(good + step)) {
      good += step;
      step *= 2;
    }
    bad = std::min(bad, good + step);
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (fits(middle) ? good : bad) = middle;
    }
    keys.push_back(good);
  }
  return keys;
}

std::vector<PlayedStep> PlayedSteps(const scenario::Scenario& scenario,
                                    const episode::RunResult& run) {
  const Scene& scene = scenario.scene;
  std::vector<PlayedStep> played;
  std::map<std::string, std::size_t> last_of;  // by actor, its step that has no end yet
  const auto end_of_all = [&](grammar::Tick tick) {
    for (const auto& [_, step] : last_of) played[step].end = tick;
    last_of.clear();
  };
  const auto begin = [&](const std::string& who, std::string what, grammar::Tick tick) {
    if (const auto last = last_of.find(who); last != last_of.end()) played[last->second].end = tick;
    last_of[who] = played.size();
    played.push_back({who, std::move(what), tick, tick});
  };
  const auto ticks = [&](double seconds) {
    return static_cast<grammar::Tick>(seconds * static_cast<double>(scene.world.rate_hz));
  };
  ScriptPlayer player(scene, scenario.script);
  std::size_t stage = 0;
  grammar::Tick end = 0;
  for (const Snapshot& snapshot : run.recording) {
    end = snapshot.tick;
    if (!player.Advance(snapshot)) break;
    for (const BegunSteps& begun : player.begun()) {
      if (begun.stage != stage) end_of_all(snapshot.tick);
      stage = begun.stage;
      const ScriptStage& of = scenario.script.stages[stage];
      for (const std::size_t i : begun.steps)
        begin(scene.hand(of.steps[i].hand).name, Text(of.steps[i].action),
              snapshot.tick + ticks(of.steps[i].delay_s));
      for (const std::size_t i : begun.person_steps)
        begin(scene.persons[static_cast<std::size_t>(of.person_steps[i].person)].name,
              Text(of.person_steps[i].action), snapshot.tick);
    }
  }
  end_of_all(std::max<grammar::Tick>(0, end - ticks(scenario.script.settle_s)));
  std::erase_if(played, [](const PlayedStep& step) { return step.end <= step.begin; });
  return played;
}

}  // namespace prehend::show
