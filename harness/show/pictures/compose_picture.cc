// SPDX-License-Identifier: Apache-2.0
// Events are drawn as the grammar asks (harness/truth/timeline/event_text.h). Tested by
// tests/harness/show/pictures/compose_picture_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "harness/show/pictures/scenery.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

namespace {

using grammar::DrawnAs;

/// Paths are thinned to this many points per second; more only costs triangles.
constexpr double kPathPoints_per_s = 60;
const render::Color kKept = ColorOf(0xA8DDB5);
/// Radius of the mark of a contact.
constexpr float kHandsContact_m = 0.008f, kPersonsContact_m = 0.025f;
constexpr double kMarkHalf_m = 0.006;  ///< height of that of a support; less below a crumb
/// Rows of the strip; more would hide the picture.
constexpr std::size_t kMaxRows = 6;

/// Of a longer episode a picture shows the paths and ghosts of what hands do at its moment, without
/// a pause longer than this; of empty hands those around the moment.
constexpr double kLong_s = 15, kPause_s = 0.5;
constexpr double kBefore_s = 4, kAfter_s = 3;
/// A scene with more things has the names of those only with which hands deal.
constexpr std::size_t kFewThings = 8;

/// Which part of an episode, and which of its events, a picture shows.
struct Selection {
  double from_s = 0, to_s = 1;            ///< of the strip
  double path_from_s = 0, path_to_s = 1;  ///< of paths and ghosts
  std::string hand, entity;               ///< empty: all
  std::optional<double> kept_from_s;
  grammar::Tick moment = 0;

  bool IsIn(double t_s) const { return path_from_s <= t_s && t_s <= path_to_s; }
  bool HasHand(const std::string& name) const { return hand.empty() || hand == name; }
  bool Has(const grammar::NamedEvent& event) const {
    if (entity.empty()) return true;
    return std::ranges::any_of(event.roles,
                               [&](const grammar::Role& role) { return role.value == entity; });
  }
};

double Seconds(grammar::Tick tick, const episode::RunResult& run) {
  return truth::SecondsOf(tick, run.timeline.ticks_per_second);
}

render::Color EventColor(const episode::RunResult& run, const grammar::NamedEvent& event) {
  return ColorOf(run.drawings.Of(event.event).color);
}

bool IsDrawnAs(const episode::RunResult& run, const grammar::NamedEvent& event,
               grammar::DrawnAs as) {
  return run.drawings.Of(event.event).as == as;
}

/// Whether the event is a phase or a grasp of this hand.
bool IsOfHand(const episode::RunResult& run, const grammar::NamedEvent& event, grammar::DrawnAs as,
              const std::string& hand) {
  return IsDrawnAs(run, event, as) && event.roles[run.drawings.Of(event.event).hand].value == hand;
}

/// The held object, or the object on the support.
const std::string& FirstOf(const episode::RunResult& run, const grammar::NamedEvent& event) {
  return event.roles[run.drawings.Of(event.event).first].value;
}

bool Covers(const grammar::NamedEvent& event, grammar::Tick tick) {
  return event.interval.begin <= tick && tick < event.interval.end;
}

int BodyNamed(const physics::Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// The phase a hand is in, or nullptr.
const grammar::NamedEvent* PhaseOf(const episode::RunResult& run, const Selection& selection,
                                   const std::string& hand, grammar::Tick tick) {
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (IsOfHand(run, event, DrawnAs::kPhase, hand) && Covers(event, tick) && selection.Has(event))
      return &event;
  }
  return nullptr;
}

/// The path of one hand, cut where its phase changes; an interval starts at the end of the one
/// before.
void AppendPath(const physics::Scene& scene, const episode::RunResult& run,
                const Selection& selection, int hand, std::vector<render::PathInterval>& path) {
  const std::string& name = scene.hands[hand].name;
  const grammar::NamedEvent *phase = nullptr,
                            *at_last = PhaseOf(run, selection, name, selection.moment);
  double next_point_s = 0;
  bool first = true, was_kept = false;
  for (const physics::Snapshot& snapshot : run.recording) {
    const double t_s = Seconds(snapshot.tick, run);
    if (!selection.IsIn(t_s)) continue;
    const grammar::NamedEvent* now = PhaseOf(run, selection, name, snapshot.tick);
    const bool is_kept = selection.kept_from_s && t_s >= *selection.kept_from_s && now != at_last;
    const bool change = first || now != phase || is_kept != was_kept;
    if (!change && t_s < next_point_s) continue;
    const Eigen::Vector3f point = snapshot.hands[hand].palm.X_WB.p_m.cast<float>();
    if (change) {
      if (!first) path.back().points_m.push_back(point);
      path.push_back({.points_per_s = kPathPoints_per_s, .square_beads = hand % 2 == 1});
      if (now) {
        path.back().label = now->event;
        path.back().color = EventColor(run, *now);
      }
      if (is_kept) path.back().label = "kept";
      if (is_kept && now) path.back().color = kKept;
    }
    path.back().points_m.push_back(point);
    next_point_s = t_s + 1 / kPathPoints_per_s;
    phase = now;
    was_kept = is_kept;
    first = false;
  }
}

/// The path of one body in its colour, while it moves.
void AppendBodyPath(const episode::RunResult& run, const Selection& selection,
                    physics::BodyIndex body, const render::Color& color,
                    std::vector<render::PathInterval>& path) {
  constexpr float kStill_m = 0.002f;
  render::PathInterval interval{
      .label = selection.entity, .color = color, .points_per_s = kPathPoints_per_s};
  double next_point_s = 0;
  for (const physics::Snapshot& snapshot : run.recording) {
    const double t_s = Seconds(snapshot.tick, run);
    if (!selection.IsIn(t_s) || t_s < next_point_s) continue;
    const physics::BodyState& state = snapshot.body(body);
    const Eigen::Vector3f point = state.X_WB.p_m.cast<float>();
    if (!interval.points_m.empty() && (interval.points_m.back() - point).norm() < kStill_m)
      continue;
    interval.points_m.push_back(point);
    next_point_s = t_s + 1 / kPathPoints_per_s;
  }
  if (interval.points_m.size() > 1) path.push_back(std::move(interval));
}

/// Bodies that a hand holds at a tick.
std::vector<physics::BodyIndex> HeldBodies(const physics::Scene& scene,
                                           const episode::RunResult& run, const std::string& hand,
                                           grammar::Tick tick) {
  std::vector<physics::BodyIndex> held;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (!IsOfHand(run, event, DrawnAs::kGrasp, hand) || !Covers(event, tick)) continue;
    const physics::BodyIndex body(BodyNamed(scene, FirstOf(run, event)));
    if (body != physics::kNone && !scene.body(body).fixed) held.push_back(body);
  }
  return held;
}

/// A ghost of every hand at the begin or end of each phase whose drawing asks for one, except at
/// the pictured moment itself.
std::vector<render::Ghost> ComposeGhosts(const physics::Scene& scene, const episode::RunResult& run,
                                         const Selection& selection, grammar::Tick moment) {
  std::vector<render::Ghost> ghosts;
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    if (!selection.HasHand(scene.hands[h].name)) continue;
    for (const grammar::NamedEvent& event : run.timeline.events) {
      if (!IsOfHand(run, event, DrawnAs::kPhase, scene.hands[h].name)) continue;
      if (!selection.Has(event)) continue;
      const grammar::Ghost ghost = run.drawings.Of(event.event).ghost;
      if (ghost == grammar::Ghost::kNoGhost) continue;
      const grammar::Tick tick =
          ghost == grammar::Ghost::kAtEnd ? event.interval.end : event.interval.begin;
      if (std::abs(Seconds(tick - moment, run)) < 0.15 || !selection.IsIn(Seconds(tick, run)))
        continue;
      ghosts.push_back({.hand = physics::HandIndex(h),
                        .bodies = HeldBodies(scene, run, scene.hands[h].name, tick),
                        .snapshot = episode::SnapshotAt(run, tick),
                        .tint = EventColor(run, event)});
    }
  }
  return ghosts;
}

/// Whether a part of a person touches something.
bool IsPart(const scenario::Scenario& scenario, const physics::ContactPoint& contact) {
  const auto is_part = [&](physics::BodyIndex body) {
    return body != physics::kNone && scenario.scene.body(body).kinematic;
  };
  return is_part(contact.a.body) || is_part(contact.b.body);
}

/// Out of what supports a body: the mean normal where they touch; up where it is nearly that.
Eigen::Vector3d WayUp(const physics::Snapshot& snapshot, int body, int support) {
  constexpr double kLevel = 0.999;
  const physics::ContactSide on{.body = physics::BodyIndex(body)},
      below{.body = physics::BodyIndex(support)};
  Eigen::Vector3d sum_W = Eigen::Vector3d::Zero();
  for (const auto& contacts : snapshot.AllContacts()) {
    for (const physics::ContactPoint& contact : contacts) {
      if (contact.a == on && contact.b == below) sum_W += contact.nhat_BA_W;
      if (contact.a == below && contact.b == on) sum_W -= contact.nhat_BA_W;
    }
  }
  const bool is_level = sum_W.z() <= 0 || sum_W.z() > kLevel * sum_W.norm();
  return is_level ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(sum_W.normalized());
}

/// Markers of supports (green, under the supported body) and of contact points of hands and persons
/// (yellow).
std::vector<render::Marker> ComposeMarkers(const scenario::Scenario& scenario,
                                           const episode::RunResult& run,
                                           const physics::Snapshot& snapshot) {
  std::vector<render::Marker> markers;
  std::set<std::pair<int, int>> seen;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (!IsDrawnAs(run, event, DrawnAs::kSupport) || !Covers(event, snapshot.tick)) continue;
    const int body = BodyNamed(scenario.scene, FirstOf(run, event));
    if (body < 0 || !seen.insert({body, 0}).second) continue;
    const physics::LocalBox box = physics::BoundingBox(scenario.scene.bodies[body]);
    const physics::Pose& X_WB = snapshot.bodies[body].X_WB;
    const std::string& support = event.roles[run.drawings.Of(event.event).last].value;
    const Eigen::Quaterniond q_WM = physics::RotationBetween(
        Eigen::Vector3d::UnitZ(), WayUp(snapshot, body, BodyNamed(scenario.scene, support)));
    const Eigen::Vector3d half =
        (q_WM.inverse() * X_WB.q).toRotationMatrix().cwiseAbs() * box.half_size_m;
    const Eigen::Vector3d foot = X_WB * box.p_BC_m - q_WM * Eigen::Vector3d(0, 0, half.z());
    markers.push_back({.kind = render::MarkerKind::kSupport,
                       .p_W_m = foot.cast<float>(),
                       .half_size_m = Eigen::Vector3d(half.x() * 1.35, half.y() * 1.35,
                                                      std::min(kMarkHalf_m, half.maxCoeff() / 2))
                                          .cast<float>(),
                       .q_WM = q_WM.cast<float>()});
  }
  for (const physics::ContactPoint& contact : snapshot.contacts) {
    const bool is_hands = contact.a.hand != physics::kNone || contact.b.hand != physics::kNone;
    if (!is_hands && !IsPart(scenario, contact)) continue;
    markers.push_back(
        {is_hands ? render::MarkerKind::kContact : render::MarkerKind::kPersonsContact,
         contact.p_W_m.cast<float>(),
         Eigen::Vector3f::Constant(is_hands ? kHandsContact_m : kPersonsContact_m)});
  }
  return markers;
}

/// A bubble around each thing that is marked; it surrounds the corners of what the thing fills.
void MarkThings(const physics::Scene& scene, const physics::Snapshot& snapshot,
                const std::vector<std::string>& names, std::vector<render::Marker>& markers) {
  constexpr double kAroundCorners = 1.75;
  for (const std::string& name : names) {
    const int body = BodyNamed(scene, name);
    if (body < 0) continue;
    const physics::LocalBox box = physics::BoundingBox(scene.bodies[body]);
    const physics::Pose& X_WB = snapshot.bodies[body].X_WB;
    const Eigen::Vector3d half =
        kAroundCorners * (X_WB.q.toRotationMatrix().cwiseAbs() * box.half_size_m);
    markers.push_back(
        {render::MarkerKind::kRegion, (X_WB * box.p_BC_m).cast<float>(), half.cast<float>()});
  }
}

/// Events with a row of their own, in the order in which they first happen.
std::vector<std::string> OtherEvents(const episode::RunResult& run) {
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

/// Whether a hand deals with the thing in what the picture shows.
bool IsDealtWith(const episode::RunResult& run, const Selection& selection,
                 const std::string& thing) {
  return std::ranges::any_of(run.timeline.events, [&](const grammar::NamedEvent& event) {
    const bool of_hand =
        IsDrawnAs(run, event, DrawnAs::kPhase) || IsDrawnAs(run, event, DrawnAs::kGrasp);
    return of_hand && Seconds(event.interval.end, run) > selection.path_from_s &&
           Seconds(event.interval.begin, run) < selection.path_to_s && selection.Has(event) &&
           std::ranges::find(event.roles, thing, &grammar::Role::value) != event.roles.end();
  });
}

/// Makes the strip row by row, from bars that are events of the run.
class StripComposer {
 public:
  StripComposer(const episode::RunResult& run, const Selection& selection, grammar::Tick moment)
      : run_(run), selection_(selection) {
    strip_.begin_s = selection.from_s;
    strip_.end_s = selection.to_s;
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
    rows_of_hands_ = strip_.rows.size();
  }

  /// Bars have the names of the entities in the last role. Of several persons each has a row.
  void AddEvents(const std::string& name, const std::vector<physics::Person>& persons) {
    const auto is_by = [](const grammar::NamedEvent& event, const physics::Person& person) {
      return !event.roles.empty() && event.roles.front().value == person.name;
    };
    if (persons.size() > 1)
      for (const physics::Person& person : persons)
        AddEvents(name, person.name + " " + Printed(name),
                  [&](const auto& event) { return is_by(event, person); });
    AddEvents(name, Printed(name), [&](const auto& event) {
      return persons.size() <= 1 || std::ranges::none_of(persons, [&](const auto& person) {
               return is_by(event, person);
             });
    });
  }
  void AddEvents(const std::string& name, std::string label, const auto& is_in) {
    render::StripRow row{std::move(label), {}};
    for (const grammar::NamedEvent& event : run_.timeline.events) {
      if (event.event != name || !is_in(event)) continue;
      AddBar(event, event.roles.empty() ? Printed(name) : event.roles.back().value, row);
    }
    Append(std::move(row));
  }

  /// A row for a body that stands on something. Bars have the names of the supports.
  void AddSupports(const std::string& body) {
    render::StripRow row{body + " on", {}};
    for (const grammar::NamedEvent& event : run_.timeline.events) {
      if (!IsDrawnAs(run_, event, DrawnAs::kSupport) || FirstOf(run_, event) != body) continue;
      AddBar(event, event.roles[run_.drawings.Of(event.event).last].value, row);
    }
    Append(std::move(row));
  }

  /// Where there is no room for all rows: without the things that stay where they are and that no
  /// hand deals with; if that is not enough, without what is not at the moment, from the end.
  render::TimelineStrip Strip() {
    std::vector<render::StripRow>& rows = strip_.rows;
    const std::size_t all = rows.size();
    if (all <= kMaxRows) return strip_;
    std::erase_if(rows, [&](const render::StripRow& row) {
      return row.label.ends_with(" on") &&
             FirstChange_s(row.segments, strip_.begin_s, strip_.end_s) > strip_.end_s &&
             !IsDealtWith(run_, selection_, row.label.substr(0, row.label.size() - 3));
    });
    for (std::size_t i = rows.size(); i-- > rows_of_hands_ && rows.size() > kMaxRows;) {
      const bool is_now = std::ranges::any_of(rows[i].segments, [&](const auto& bar) {
        return bar.begin_s <= strip_.playhead_s && strip_.playhead_s < bar.end_s;
      });
      if (!is_now) rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
    }
    rows.resize(std::min(rows.size(), kMaxRows));
    strip_.rows_left_out = static_cast<int>(all - rows.size());
    return strip_;
  }

 private:
  void AddBar(const grammar::NamedEvent& event, std::string name, render::StripRow& row) const {
    if (!selection_.Has(event)) return;
    const bool is_in = Seconds(event.interval.end, run_) > selection_.from_s &&
                       Seconds(event.interval.begin, run_) < selection_.to_s;
    if (!is_in) return;
    row.segments.push_back({std::move(name), Seconds(event.interval.begin, run_),
                            Seconds(event.interval.end, run_), EventColor(run_, event)});
  }
  void Append(render::StripRow row) {
    if (!row.segments.empty()) strip_.rows.push_back(std::move(row));
  }

  const episode::RunResult& run_;
  const Selection& selection_;
  render::TimelineStrip strip_;
  std::size_t rows_of_hands_ = 0;
};

/// Rows per hand: its phases, its grasps; then one per kind of other events; then one of supports
/// per movable body that has any.
render::TimelineStrip ComposeStrip(const physics::Scene& scene, const episode::RunResult& run,
                                   const Selection& selection, grammar::Tick moment) {
  StripComposer composer(run, selection, moment);
  for (const physics::Hand& hand : scene.hands) {
    if (!selection.HasHand(hand.name)) continue;
    composer.AddPhases(scene.hands.size() == 1 ? "phase" : hand.name, hand.name);
    composer.AddGrasps(hand.name);
  }
  for (const std::string& name : OtherEvents(run)) composer.AddEvents(name, scene.persons);
  for (const physics::Body& body : scene.bodies)
    if (!body.fixed && !body.kinematic) composer.AddSupports(body.name);
  return composer.Strip();
}

struct Span_s {
  double from = 0, to = 0;
};

/// From when to when a hand does what it does at a moment: its phases and grasps that share an
/// entity with the one that holds then, or comes next, and follow one another without a pause.
std::optional<Span_s> ActionOf(const episode::RunResult& run, const std::string& hand,
                               double now_s) {
  std::vector<const grammar::NamedEvent*> events;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    if (IsOfHand(run, event, DrawnAs::kPhase, hand) || IsOfHand(run, event, DrawnAs::kGrasp, hand))
      events.push_back(&event);
  }
  const auto begin_s = [&](const auto* event) { return Seconds(event->interval.begin, run); };
  const auto end_s = [&](const auto* event) { return Seconds(event->interval.end, run); };
  // Events are sorted by their begin.
  const auto first =
      std::ranges::find_if(events, [&](const auto* event) { return end_s(event) > now_s; });
  if (first == events.end() || begin_s(*first) > now_s + kAfter_s) return std::nullopt;
  const auto shares = [&](const auto* event) {
    return std::ranges::any_of(event->roles, [&](const grammar::Role& role) {
      return role.value != hand &&
             std::ranges::find(first[0]->roles, role.value, &grammar::Role::value) !=
                 first[0]->roles.end();
    });
  };
  Span_s span{begin_s(*first), end_s(*first)};
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto* event : events) {
      if (!shares(event) || begin_s(event) > span.to + kPause_s ||
          end_s(event) < span.from - kPause_s)
        continue;
      grows = grows || begin_s(event) < span.from || end_s(event) > span.to;
      span = {std::min(span.from, begin_s(event)), std::max(span.to, end_s(event))};
    }
  }
  return span;
}

/// Of all hands that are selected.
Span_s ActionAt(const episode::RunResult& run, const physics::Scene& scene,
                const PictureFormat& format, double now_s) {
  std::optional<Span_s> all;
  for (const physics::Hand& hand : scene.hands) {
    if (!format.only.empty() && format.only != hand.name) continue;
    const std::optional<Span_s> span = ActionOf(run, hand.name, now_s);
    if (!span) continue;
    all = all ? Span_s{std::min(all->from, span->from), std::max(all->to, span->to)} : *span;
  }
  return all.value_or(Span_s{now_s - kBefore_s, now_s + kAfter_s});
}

Selection SelectionOf(const PictureFormat& format, const physics::Scene& scene,
                      const episode::RunResult& run, grammar::Tick moment) {
  const double end_s = std::max(Seconds(run.ticks, run), 0.1), now_s = Seconds(moment, run);
  Selection selection{.from_s = format.from_s.value_or(0),
                      .to_s = format.to_s.value_or(end_s),
                      .hand = format.only,
                      .entity = format.of,
                      .kept_from_s = format.kept_from_s,
                      .moment = moment};
  const bool is_given = format.from_s || format.to_s;
  const bool is_long = !is_given && end_s > kLong_s;
  const Span_s shown =
      is_long ? ActionAt(run, scene, format, now_s) : Span_s{selection.from_s, selection.to_s};
  selection.path_from_s = shown.from;
  selection.path_to_s = shown.to;
  if (format.path_so_far) selection.path_to_s = std::min(selection.path_to_s, now_s);
  return selection;
}

/// One per scene body; "" has no label. A person has one, at her head: labels of eighteen parts
/// would hide her. The only piece of furniture needs none.
std::vector<std::string> BodyLabels(const scenario::Scenario& scenario,
                                    const episode::RunResult& run, const Selection& selection) {
  const std::vector<physics::Body>& bodies = scenario.scene.bodies;
  const auto things = static_cast<std::size_t>(std::ranges::count_if(
      bodies, [](const physics::Body& body) { return physics::IsThing(body) && !body.kinematic; }));
  const auto fixed = std::ranges::count_if(
      bodies, [](const physics::Body& body) { return physics::IsThing(body) && body.fixed; });
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const physics::Body& body = bodies[i];
    const bool is_part = body.kinematic && scenario.body_classes[i] != "Person";
    const bool is_only_furniture = body.fixed && physics::IsThing(body) && fixed == 1 && things > 1;
    const bool is_beside = things > kFewThings && physics::IsThing(body) && !body.kinematic &&
                           !IsDealtWith(run, selection, body.name);
    const bool is_named = !is_part && !is_only_furniture && !is_beside && IsSeen(body);
    labels.push_back(is_named ? body.name : "");
  }
  return labels;
}

}  // namespace

render::Picture ComposePicture(const scenario::Scenario& scenario, const episode::RunResult& run,
                               const scenario::PictureYaml& entry, const PictureFormat& format) {
  const physics::Scene& scene = scenario.scene;
  const episode::FoundTime moment = episode::FindEventTime(entry.at.value, run);
  const Selection selection = SelectionOf(format, scene, run, moment.tick);
  render::Picture picture{.width_px = format.width_px, .height_px = format.height_px};
  picture.text_scale = static_cast<float>(format.text_scale);
  picture.theme = format.print ? render::Theme::kPrint : render::Theme::kLight;
  picture.scene = &scene;
  picture.snapshot = episode::SnapshotAt(run, moment.tick);
  picture.body_colors = BodyColors(scenario);
  if (format.labels) picture.body_labels = BodyLabels(scenario, run, selection);
  // The one hand is the hand.
  for (std::size_t h = 0; h < scene.hands.size() && format.labels && scene.hands.size() > 1; ++h)
    picture.hand_labels.push_back(selection.HasHand(scene.hands[h].name) ? scene.hands[h].name
                                                                         : "");
  if (const auto to_light = ToLight(scene)) picture.to_light = *to_light;
  for (std::size_t h = 0; h < scene.hands.size() && format.paths; ++h) {
    if (selection.HasHand(scene.hands[h].name))
      AppendPath(scene, run, selection, static_cast<int>(h), picture.path);
  }
  const int of = BodyNamed(scene, selection.entity);
  if (of >= 0 && format.paths)
    AppendBodyPath(run, selection, physics::BodyIndex(of),
                   picture.body_colors[static_cast<std::size_t>(of)], picture.path);
  // Near a hand, a ghost would hide it.
  if (format.ghosts && entry.camera.value != "hand")
    picture.ghosts = ComposeGhosts(scene, run, selection, moment.tick);
  picture.markers = ComposeMarkers(scenario, run, picture.snapshot);
  MarkThings(scene, picture.snapshot, format.marked, picture.markers);
  if (format.regions) {
    const auto shown = [&](const grammar::NamedEvent& event) {
      return selection.Has(event) &&
             selection.HasHand(event.roles[run.drawings.Of(event.event).hand].value);
    };
    std::ranges::copy(RegionMarkers(scenario, run, picture.snapshot, shown),
                      std::back_inserter(picture.markers));
  }
  picture.props = LegsOf(scenario, picture.body_colors, picture.snapshot);
  if (format.gaze) picture.gazes = GazesOf(scene, picture.snapshot);
  if (format.strip) picture.strip = ComposeStrip(scene, run, selection, moment.tick);
  picture.hand_colors = SensorColors(scene, format.sensor_colors);
  picture.camera = CameraFor(scenario, run, picture, entry.camera.value, format);
  picture.body_alphas = BodyAlphas(scene, picture.snapshot, picture.camera.eye_m);
  if (!format.title) return picture;
  const auto name = episode::ParseEventTime(entry.at.value);
  std::string at = name && name->time_s ? "" : fmt::format("  ·  {}", entry.at.value);
  if (!moment.missed.empty()) at = fmt::format("  ·  {}; the end", moment.missed);
  picture.title = fmt::format("{}{}  ·  {:.3f} s  ·  {}", scenario.name, at,
                              Seconds(picture.snapshot.tick, run), scenario.grammar);
  return picture;
}

}  // namespace prehend::show
