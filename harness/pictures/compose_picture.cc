// SPDX-License-Identifier: Apache-2.0
// Events are drawn as the grammar asks (harness/timeline/event_drawings.h). Tested by
// tests/harness/pictures/compose_picture_test.cc
#include "harness/pictures/compose_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/run/event_time.h"
#include "harness/timeline/event_drawings.h"

namespace prehend::harness {

namespace {

using grammar::DrawnAs;

/// A larger body is scenery: it does not affect what the camera frames.
constexpr double kSceneryFrom_m = 0.5;
/// Paths are thinned to this many points per second; more only costs triangles.
constexpr double kPathPoints_per_s = 60;
/// Rows of the strip; more would hide the picture.
constexpr std::size_t kMaxRows = 6;

render::Color ColorOf(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
          static_cast<float>(rgb & 255) / 255};
}

/// Calm, distinguishable colours for bodies; fixed ones are wood.
render::Color BodyColor(const physics::Body& body, int index) {
  if (body.fixed) return ColorOf(0xC8A27C);
  if (body.kinematic) return ColorOf(0xA9B4BE);  // a person: not the subject of the picture
  constexpr std::array<std::uint32_t, 6> palette = {0xE9EEF2, 0xE07A3F, 0x3F6E8C,
                                                    0xC0392B, 0x8FB339, 0x8C6BB1};
  return ColorOf(palette[index % palette.size()]);
}

/// Cameras and lights are not in the picture.
bool IsSeen(const physics::Body& body) {
  return body.abstract != physics::Abstract::kCamera && body.abstract != physics::Abstract::kLight;
}

/// Direction from the middle of the things to the first light; nullopt without a light.
std::optional<Eigen::Vector3f> ToLight(const physics::Scene& scene) {
  const auto light =
      std::ranges::find(scene.bodies, physics::Abstract::kLight, &physics::Body::abstract);
  if (light == scene.bodies.end()) return std::nullopt;
  Eigen::AlignedBox3d things;
  for (const physics::Body& body : scene.bodies)
    if (physics::IsThing(body)) things.extend(body.X_WB.p_m);
  if (things.isEmpty()) return std::nullopt;
  return (light->X_WB.p_m - things.center()).cast<float>();
}

double Seconds(grammar::Tick tick, const RunResult& run) {
  return static_cast<double>(tick) / static_cast<double>(run.timeline.ticks_per_second);
}

render::Color ColorOf(const RunResult& run, const grammar::NamedEvent& event) {
  return ColorOf(run.drawings.Of(event.event).color);
}

bool IsDrawnAs(const RunResult& run, const grammar::NamedEvent& event, grammar::DrawnAs as) {
  return run.drawings.Of(event.event).as == as;
}

/// Whether the event is a phase or a grasp of this hand.
bool IsOfHand(const RunResult& run, const grammar::NamedEvent& event, grammar::DrawnAs as,
              const std::string& hand) {
  return IsDrawnAs(run, event, as) && event.roles[run.drawings.Of(event.event).hand].value == hand;
}

/// The held object, or the object on the support.
const std::string& FirstOf(const RunResult& run, const grammar::NamedEvent& event) {
  return event.roles[run.drawings.Of(event.event).first].value;
}

bool Covers(const grammar::NamedEvent& event, grammar::Tick tick) {
  return event.interval.begin <= tick && tick < event.interval.end;
}

/// First recorded snapshot at or after a tick, else the last one.
const physics::Snapshot& SnapshotAt(const RunResult& run, grammar::Tick tick) {
  const auto at = std::ranges::lower_bound(run.recording, tick, {}, &physics::Snapshot::tick);
  return at == run.recording.end() ? run.recording.back() : *at;
}

int BodyNamed(const physics::Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// The phase a hand is in, or nullptr.
const grammar::NamedEvent* PhaseOf(const RunResult& run, const std::string& hand,
                                   grammar::Tick tick) {
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (IsOfHand(run, event, DrawnAs::kPhase, hand) && Covers(event, tick)) return &event;
  }
  return nullptr;
}

/// The path of one hand, cut where its phase changes; a stretch starts at the end of the one
/// before.
void AppendPath(const physics::Scene& scene, const RunResult& run, int hand,
                std::vector<render::PathStretch>& path) {
  const std::string& name = scene.hands[hand].name;
  const grammar::NamedEvent* phase = nullptr;
  double next_point_s = 0;
  bool first = true;
  for (const physics::Snapshot& snapshot : run.recording) {
    const grammar::NamedEvent* now = PhaseOf(run, name, snapshot.tick);
    const bool change = first || now != phase;
    const double t_s = Seconds(snapshot.tick, run);
    if (!change && t_s < next_point_s) continue;
    const Eigen::Vector3f point = snapshot.hands[hand].palm.X_WB.p_m.cast<float>();
    if (change) {
      if (!first) path.back().points_m.push_back(point);
      path.push_back({.points_per_s = kPathPoints_per_s});
      if (now) {
        path.back().label = now->event;
        path.back().color = ColorOf(run, *now);
      }
    }
    path.back().points_m.push_back(point);
    next_point_s = t_s + 1 / kPathPoints_per_s;
    phase = now;
    first = false;
  }
}

/// Bodies that a hand holds at a tick.
std::vector<int> HeldBodies(const physics::Scene& scene, const RunResult& run,
                            const std::string& hand, grammar::Tick tick) {
  std::vector<int> held;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (!IsOfHand(run, event, DrawnAs::kGrasp, hand) || !Covers(event, tick)) continue;
    const int body = BodyNamed(scene, FirstOf(run, event));
    if (body >= 0 && !scene.bodies[body].fixed) held.push_back(body);
  }
  return held;
}

/// A ghost of every hand at the begin or end of each phase whose drawing asks for one, except at
/// the pictured moment itself.
std::vector<render::Ghost> ComposeGhosts(const physics::Scene& scene, const RunResult& run,
                                         grammar::Tick moment) {
  std::vector<render::Ghost> ghosts;
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    for (const grammar::NamedEvent& event : run.timeline.events) {
      if (!IsOfHand(run, event, DrawnAs::kPhase, scene.hands[h].name)) continue;
      const grammar::Ghost ghost = run.drawings.Of(event.event).ghost;
      if (ghost == grammar::Ghost::kNoGhost) continue;
      const grammar::Tick tick =
          ghost == grammar::Ghost::kAtEnd ? event.interval.end : event.interval.begin;
      if (std::abs(Seconds(tick - moment, run)) < 0.15) continue;
      ghosts.push_back({.hand = static_cast<int>(h),
                        .bodies = HeldBodies(scene, run, scene.hands[h].name, tick),
                        .snapshot = SnapshotAt(run, tick),
                        .tint = ColorOf(run, event)});
    }
  }
  return ghosts;
}

/// Markers of supports (green, under the supported body) and of hands' contact points (yellow).
std::vector<render::Marker> ComposeMarkers(const Scenario& scenario, const RunResult& run,
                                           const physics::Snapshot& snapshot) {
  std::vector<render::Marker> markers;
  std::set<std::pair<int, int>> seen;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (!IsDrawnAs(run, event, DrawnAs::kSupport) || !Covers(event, snapshot.tick)) continue;
    const int body = BodyNamed(scenario.scene, FirstOf(run, event));
    if (body < 0 || !seen.insert({body, 0}).second) continue;
    const physics::LocalBox box = physics::BoundingBox(scenario.scene.bodies[body]);
    const physics::Pose& X_WB = snapshot.bodies[body].X_WB;
    const Eigen::Vector3d half = (X_WB.q.toRotationMatrix().cwiseAbs() * box.half_size_m);
    const Eigen::Vector3d foot = X_WB * box.p_BC_m - Eigen::Vector3d(0, 0, half.z());
    markers.push_back({render::MarkerKind::kSupport, foot.cast<float>(),
                       Eigen::Vector3d(half.x() * 1.35, half.y() * 1.35, 0.006).cast<float>()});
  }
  for (const physics::ContactPoint& contact : snapshot.contacts) {
    if (contact.a.hand < 0 && contact.b.hand < 0) continue;
    markers.push_back(
        {render::MarkerKind::kContact, contact.p_W_m.cast<float>(), {0.008f, 0.008f, 0.008f}});
  }
  return markers;
}

/// Events with a row of their own, in the order in which they first happen.
std::vector<std::string> OtherEvents(const RunResult& run) {
  std::vector<std::string> names;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (IsDrawnAs(run, event, DrawnAs::kRow) &&
        std::ranges::find(names, event.event) == names.end())
      names.push_back(event.event);
  }
  return names;
}

/// The name as it is printed: with spaces.
std::string Printed(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// Makes the strip row by row, from bars that are events of the run.
class StripComposer {
 public:
  StripComposer(const RunResult& run, grammar::Tick moment) : run_(run) {
    strip_.end_s = std::max(Seconds(run.ticks, run), 0.1);
    strip_.playhead_s = Seconds(moment, run);
  }

  void AddPhases(const std::string& label, const std::string& hand) {
    render::StripRow row{label, {}};
    for (const grammar::NamedEvent& event : run_.timeline.events)
      if (IsOfHand(run_, event, DrawnAs::kPhase, hand)) AddBar(event, Printed(event.event), row);
    Append(std::move(row));
  }

  /// Bars have the names of the held objects.
  void AddGrasps(const std::string& hand) {
    render::StripRow row{"grasp", {}};
    for (const grammar::NamedEvent& event : run_.timeline.events)
      if (IsOfHand(run_, event, DrawnAs::kGrasp, hand)) AddBar(event, FirstOf(run_, event), row);
    Append(std::move(row));
  }

  /// Bars have the names of the entities in the last role.
  void AddEvents(const std::string& name) {
    render::StripRow row{Printed(name), {}};
    for (const grammar::NamedEvent& event : run_.timeline.events) {
      if (event.event != name) continue;
      AddBar(event, event.roles.empty() ? Printed(name) : event.roles.back().value, row);
    }
    Append(std::move(row));
  }

  /// Bars have the names of the supports.
  void AddSupports(const std::string& body) {
    render::StripRow row{body + " on", {}};
    for (const grammar::NamedEvent& event : run_.timeline.events) {
      if (!IsDrawnAs(run_, event, DrawnAs::kSupport) || FirstOf(run_, event) != body) continue;
      AddBar(event, event.roles[run_.drawings.Of(event.event).last].value, row);
    }
    Append(std::move(row));
  }

  bool IsFull() const { return strip_.rows.size() >= kMaxRows; }
  const render::TimelineStrip& strip() const { return strip_; }

 private:
  void AddBar(const grammar::NamedEvent& event, std::string name, render::StripRow& row) const {
    row.segments.push_back({std::move(name), Seconds(event.interval.begin, run_),
                            Seconds(event.interval.end, run_), ColorOf(run_, event)});
  }
  void Append(render::StripRow row) {
    if (!row.segments.empty()) strip_.rows.push_back(std::move(row));
  }

  const RunResult& run_;
  render::TimelineStrip strip_;
};

/// Rows per hand: its phases, its grasps; then one per kind of other events; then one of supports
/// per movable body that has any.
render::TimelineStrip ComposeStrip(const physics::Scene& scene, const RunResult& run,
                                   grammar::Tick moment) {
  StripComposer composer(run, moment);
  for (const physics::Hand& hand : scene.hands) {
    composer.AddPhases(scene.hands.size() == 1 ? "phase" : hand.name, hand.name);
    composer.AddGrasps(hand.name);
  }
  for (const std::string& name : OtherEvents(run))
    if (!composer.IsFull()) composer.AddEvents(name);
  for (const physics::Body& body : scene.bodies)
    if (!body.fixed && !body.kinematic && !composer.IsFull()) composer.AddSupports(body.name);
  return composer.strip();
}

/// A camera of the scenario.
render::Camera CameraOf(const physics::Body& camera) {
  const Eigen::Vector3d ahead_m = camera.X_WB * Eigen::Vector3d::UnitX();
  return {.eye_m = camera.X_WB.p_m.cast<float>(),
          .look_at_m = ahead_m.cast<float>(),
          .vertical_field_of_view_deg = static_cast<float>(camera.view_deg)};
}

/// A camera of the scenario, or one that frames the paths and everything that is not scenery.
render::Camera ComposeCamera(const Scenario& scenario, const render::Picture& picture,
                             const std::string& name) {
  const int own = BodyNamed(scenario.scene, name);
  if (own >= 0 && scenario.scene.bodies[own].abstract == physics::Abstract::kCamera)
    return CameraOf(scenario.scene.bodies[own]);
  Eigen::AlignedBox3f box;
  for (const render::PathStretch& stretch : picture.path)
    for (const Eigen::Vector3f& point : stretch.points_m) box.extend(point);
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::LocalBox local = physics::BoundingBox(scenario.scene.bodies[i]);
    if (local.half_size_m.maxCoeff() * 2 > kSceneryFrom_m || !IsSeen(scenario.scene.bodies[i]))
      continue;
    const Eigen::Vector3f centre = (picture.snapshot.bodies[i].X_WB * local.p_BC_m).cast<float>();
    const float reach = static_cast<float>(local.half_size_m.norm());
    box.extend(Eigen::Vector3f(centre.array() + reach));
    box.extend(Eigen::Vector3f(centre.array() - reach));
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3f(0, 0, 0)).extend(Eigen::Vector3f(1, 1, 1));
  return render::NamedCamera(name, box.min(), box.max(),
                             static_cast<double>(picture.width_px) / picture.height_px);
}

}  // namespace

render::Picture ComposePicture(const Scenario& scenario, const RunResult& run,
                               const PictureYaml& entry) {
  const FoundTime moment = FindEventTime(entry.at.value, run);
  render::Picture picture;
  picture.scene = &scenario.scene;
  picture.snapshot = SnapshotAt(run, moment.tick);
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    picture.body_colors.push_back(BodyColor(scenario.scene.bodies[i], static_cast<int>(i)));
    // A person has one label, at her head: labels of eighteen parts would hide her.
    const bool is_part = scenario.body_classes[i] == "BodyPart";
    const bool is_named = !is_part && IsSeen(scenario.scene.bodies[i]);
    picture.body_labels.push_back(is_named ? scenario.scene.bodies[i].name : "");
  }
  if (const auto to_light = ToLight(scenario.scene)) picture.to_light = *to_light;
  for (std::size_t h = 0; h < scenario.scene.hands.size(); ++h)
    AppendPath(scenario.scene, run, static_cast<int>(h), picture.path);
  picture.ghosts = ComposeGhosts(scenario.scene, run, moment.tick);
  picture.markers = ComposeMarkers(scenario, run, picture.snapshot);
  picture.strip = ComposeStrip(scenario.scene, run, moment.tick);
  picture.camera = ComposeCamera(scenario, picture, entry.camera.value);
  const auto name = ParseEventTime(entry.at.value);
  std::string at = name && name->time_s ? "" : fmt::format("  ·  {}", entry.at.value);
  if (!moment.missed.empty()) at = fmt::format("  ·  {}; the end", moment.missed);
  picture.title =
      fmt::format("{}{}  ·  {:.3f} s", scenario.name, at, Seconds(picture.snapshot.tick, run));
  return picture;
}

}  // namespace prehend::harness
