// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/oracle.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>
#include <utility>

#include "harness/truth/oracle/evidence.h"
#include "harness/truth/oracle/furniture.h"
#include "harness/truth/oracle/recording.h"

namespace prehend::truth {
namespace {

/// What was found with some settings: most choices change none of those that it depends on.
struct Known {
  std::map<SupportSettings, Touches> touches;
  std::map<GraspSettings, std::vector<Grasp>> grasps;
  std::map<std::tuple<Grasp, int, int, ReachSettings>, int> reaches;
  std::map<std::tuple<Grasp, std::map<int, Spans>, CarrySettings, double>, Carrying> carryings;
  std::map<std::tuple<FurnitureSettings, double>, std::vector<Part>> parts;

  template <class Found, class Find>
  static const typename Found::mapped_type& Once(Found& found, const typename Found::key_type& key,
                                                 const Find& find) {
    const auto [at, is_new] = found.try_emplace(key);
    if (is_new) at->second = find();
    return at->second;
  }
};

class TimelineBuilder {
 public:
  TimelineBuilder(const Evidence& evidence, const OracleSettings& settings, grammar::Tick end,
                  Known& known)
      : evidence_(evidence),
        recording_(evidence.recording),
        settings_(settings),
        end_(end),
        touches_(
            Known::Once(known.touches, settings, [&] { return FindTouches(evidence, settings); })),
        grasps_(
            Known::Once(known.grasps, settings, [&] { return FindGrasps(evidence, settings); })),
        known_(known) {
    DateTouches();
    timeline_.ticks_per_second = recording_.scene.world.rate_hz;
  }

  grammar::Timeline Build() {
    AddContacts();
    for (const auto& [pair, spans] : touches_.supports)
      for (const Span& span : spans)
        Add("supported_by",
            {{"object", recording_.name(pair.first)}, {"support", recording_.name(pair.second)}},
            span);
    for (const Grasp& grasp : grasps_) AddGrasp(grasp);
    AddFurniture();
    grammar::Sort(timeline_);
    return std::move(timeline_);
  }

 private:
  void DateTouches() {
    const Grasp* before = nullptr;
    for (Grasp& grasp : grasps_) {
      for (const Span& contact : ContactsOf(grasp))
        if (contact.Contains(grasp.span.begin)) grasp.touched_since = contact.begin;
      const bool again = before && before->hand == grasp.hand && before->body == grasp.body;
      if (again) grasp.touched_since = std::max(grasp.touched_since, before->span.end);
      before = &grasp;
    }
  }

  const Spans& ContactsOf(const Grasp& grasp) const {
    return touches_.contacts.at({grasp.body, recording_.body_count() + grasp.hand});
  }

  grammar::Tick TickOf(int frame) const {
    return frame < recording_.size() ? recording_.ticks[frame] : end_;
  }

  void Add(const char* event, std::vector<grammar::Role> roles, Span span,
           std::vector<grammar::NamedValue> values = {}) {
    const grammar::Interval interval{TickOf(span.begin), TickOf(span.end)};
    if (interval.begin >= interval.end) return;  // it began with the last frame
    timeline_.events.push_back({event, std::move(roles), interval, interval.end,
                                span.end == recording_.size(), std::move(values)});
  }

  void AddContacts() {
    for (const auto& [pair, spans] : touches_.contacts) {
      const auto [a, b] = std::minmax(recording_.name(pair.first), recording_.name(pair.second));
      for (const Span& span : spans) Add("contact", {{"a", a}, {"b", b}}, span);
    }
  }

  void AddFurniture() {
    constexpr std::array kStates = {"closed", "half_closed", "half_open", "open"};
    const double bridge_s = settings_.contact_bridge_s;
    for (const Part& part : Known::Once(known_.parts, {settings_, bridge_s}, [&] {
           return FindParts(evidence_, settings_, bridge_s);
         })) {
      const grammar::Role role{"part", recording_.name(part.body)};
      for (std::size_t i = 0; i < kStates.size(); ++i)
        for (const Span& span : part.states[i]) Add(kStates[i], {role}, span);
      for (const PartMotion& motion : part.motions) {
        Add(motion.opens ? "opening" : "closing", {role}, motion.span, {{"way", motion.way, ""}});
        for (const auto& [agent, touch] : motion.by)
          Add(motion.opens ? "opened_by" : "closed_by", {role, {"agent", recording_.name(agent)}},
              touch);
      }
    }
  }

  std::vector<grammar::Role> RolesOf(const Grasp& grasp) const {
    return {{"hand", recording_.scene.hands[grasp.hand].name},
            {"object", recording_.name(grasp.body)}};
  }

  void AddGrasp(const Grasp& grasp) {
    std::vector<grammar::Role> roles = RolesOf(grasp);
    const physics::HandModel& model = recording_.scene.hands[grasp.hand].model;
    const int style = recording_.hand(grasp.hand, grasp.span.begin).style;
    if (style >= 0 && style < static_cast<int>(model.styles.size()))
      roles.push_back({"style", model.styles[style].name});
    Add("grasping", std::move(roles), grasp.span);

    const Span reach = AddReach(grasp);
    const Carrying carrying = AddCarrying(grasp);
    if (!reach.empty() && !carrying.put_downs.empty())
      Add("pick_and_place", RolesOf(grasp), {reach.begin, carrying.put_downs.front().end});
  }

  /// Only the first grasp of a contact was reached for; for a second one the hand was already
  /// there.
  Span AddReach(const Grasp& grasp) {
    Span contact, contact_before;
    for (const Span& span : ContactsOf(grasp)) {
      const bool brushes = recording_.Lasts_s(span) < settings_.reach_brush_s;
      if (span.end <= grasp.span.begin && !brushes) contact_before = span;
      if (span.Contains(grasp.span.begin)) contact = span;
    }
    int earliest = contact_before.end;
    for (const Grasp& other : grasps_) {
      if (other.hand != grasp.hand) continue;
      if (other.body == grasp.body &&
          Span{contact.begin, grasp.span.begin}.Contains(other.span.begin))
        return {};
      // A grasp drops every candidate that is not touched yet; what comes after it may be a reach.
      if (other.span.begin < contact.begin) earliest = std::max(earliest, other.span.begin + 1);
    }
    Add("fixation", RolesOf(grasp), {contact.begin, grasp.span.begin});
    const int begin = Known::Once(known_.reaches, {grasp, earliest, contact.begin, settings_}, [&] {
      return ReachBegin(evidence_, settings_, grasp.hand, grasp.body, earliest, contact.begin);
    });
    if (recording_.Seconds(begin, contact.begin) < settings_.reach_minimum_s) return {};
    Add("reaching", RolesOf(grasp), {begin, contact.begin});
    return {begin, contact.begin};
  }

  Carrying AddCarrying(const Grasp& grasp) {
    std::map<int, Spans> supports;
    for (const auto& [pair, spans] : touches_.supports)
      if (pair.first == grasp.body) supports[pair.second] = spans;
    const Carrying& carrying =
        Known::Once(known_.carryings, {grasp, supports, settings_, settings_.onset_speed_m_per_s},
                    [&] { return FindCarrying(evidence_, settings_, grasp, supports); });
    for (const Span& span : carrying.slides) Add("sliding", RolesOf(grasp), span);
    for (const Span& span : carrying.pick_ups) Add("picking_up", RolesOf(grasp), span);
    for (const Span& span : carrying.hovers) Add("hovering", RolesOf(grasp), span);
    for (const Span& span : carrying.transports) Add("transporting", RolesOf(grasp), span);
    for (const Span& span : carrying.put_downs) Add("putting_down", RolesOf(grasp), span);
    return carrying;
  }

  const Evidence& evidence_;
  const Recording& recording_;
  const OracleSettings& settings_;
  grammar::Tick end_;
  const Touches& touches_;
  std::vector<Grasp> grasps_;
  Known& known_;
  grammar::Timeline timeline_;
};

}  // namespace

std::span<const std::string_view> OracleEvents() {
  static constexpr std::array<std::string_view, 11> kDefined = {
      "contact",    "supported_by", "grasping",     "reaching",     "fixation",      "sliding",
      "picking_up", "hovering",     "transporting", "putting_down", "pick_and_place"};
  return kDefined;
}

std::span<const std::string_view> FurnitureEvents() {
  static constexpr std::array<std::string_view, 8> kDefined = {
      "closed", "half_closed", "half_open", "open", "opening", "closing", "opened_by", "closed_by"};
  return kDefined;
}

bool OracleDefines(std::string_view event, std::string_view first_role) {
  return std::ranges::count(OracleEvents(), event) > 0 ||
         (first_role == "part" && std::ranges::count(FurnitureEvents(), event) > 0);
}

bool OracleDefines(const grammar::NamedEvent& event) {
  return OracleDefines(event.event, event.roles.empty() ? "" : event.roles.front().name);
}

grammar::Timeline TrueTimeline(const physics::Scene& scene,
                               std::span<const physics::Snapshot> recording, grammar::Tick end,
                               const OracleSettings& settings) {
  const Recording frames = MakeRecording(scene, recording);
  const Evidence evidence(frames);
  Known known;
  return TimelineBuilder(evidence, settings, end, known).Build();
}

std::vector<grammar::Timeline> PossibleTimelines(const physics::Scene& scene,
                                                 std::span<const physics::Snapshot> recording,
                                                 grammar::Tick end) {
  const Recording frames = MakeRecording(scene, recording);
  const Evidence evidence(frames);
  Known known;
  std::vector<grammar::Timeline> timelines;
  for (const OracleSettings& choice : DefinitionChoices())
    timelines.push_back(TimelineBuilder(evidence, choice, end, known).Build());
  return timelines;
}

bool Covers(const Spans& spans, int frame) {
  return std::ranges::any_of(spans, [&](const Span& span) { return span.Contains(frame); });
}

Spans Within(const Spans& spans, Span window) {
  Spans parts;
  for (const Span& span : spans)
    if (const Span part = Common(span, window); !part.empty()) parts.push_back(part);
  return parts;
}

Spans Rest(const Spans& spans, Span window) {
  Spans rest;
  int covered_to = window.begin;
  for (const Span& span : Within(spans, window)) {
    if (covered_to < span.begin) rest.push_back({covered_to, span.begin});
    covered_to = span.end;
  }
  if (covered_to < window.end) rest.push_back({covered_to, window.end});
  return rest;
}

Spans Union(const Spans& a, const Spans& b) {
  Spans all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::ranges::sort(all, {}, &Span::begin);
  Spans joined;
  for (const Span& span : all) {
    if (!joined.empty() && span.begin <= joined.back().end)
      joined.back().end = std::max(joined.back().end, span.end);
    else
      joined.push_back(span);
  }
  return joined;
}

Spans Recording::Bridged(const Spans& spans, double gap_s) const {
  Spans joined;
  for (const Span& span : spans) {
    if (!joined.empty() && static_cast<double>(ticks[span.begin] - ticks[joined.back().end]) <=
                               gap_s * scene.world.rate_hz)
      joined.back().end = span.end;
    else
      joined.push_back(span);
  }
  return joined;
}

double Recording::Lasts_s(Span span) const {
  if (span.empty()) return 0;  // at the end of the recording there is no tick to ask for
  const grammar::Tick end = span.end < size() ? ticks[span.end] : ticks.back() + 1;
  return static_cast<double>(end - ticks[span.begin]) / scene.world.rate_hz;
}

const std::string& Recording::name(int entity) const {
  return entity < body_count() ? scene.bodies[entity].name
                               : scene.hands[entity - body_count()].name;
}

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames) {
  Recording recording{scene, frames, {}};
  for (const physics::Snapshot& frame : frames) recording.ticks.push_back(frame.tick);
  return recording;
}

Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m) {
  return body.v_WB_m_per_s + body.w_WB_rad_per_s.cross(p_W_m - body.X_WB.p_m);
}

std::span<const Band> DefinitionBands() {
  using S = OracleSettings;
  constexpr double kDegree = std::numbers::pi / 180;
  static constexpr std::array kBands = {
      Band{"contact gap", &S::contact_bridge_s, 0.080, 0.120},
      Band{"grip gap", &S::grasp_bridge_s, 0.045, 0.080},
      Band{"support direction", &S::support_up, 0.35, 0.64},
      Band{"support share", &S::support_share, 0.001, 0.10},
      Band{"support settled", &S::support_speed_m_per_s, 0.01, 0.04},
      Band{"support minimum", &S::support_minimum_s, 0.015, 0.030},
      Band{"grip minimum", &S::grasp_minimum_s, 0.015, 0.030},
      Band{"grip command", &S::commanded_trigger, 0.2, 0.4},
      Band{"hook force", &S::hook_force_n, 15, 25},
      Band{"hook slip", &S::hook_slip_m_per_s, 0.2, 0.4},
      Band{"grip opening", &S::opening_per_s, 0.7, 1.5},
      Band{"press force", &S::press_force_n, 1, 4},
      Band{"press facing", &S::press_facing_rad, 110 * kDegree, 130 * kDegree},
      Band{"reach region", &S::reach_radius_m, 0.25, 0.35},
      Band{"reach dead-band", &S::reach_dead_band_m, 0.020, 0.030},
      Band{"reach idle speed", &S::idle_speed_m_per_s, 0.007, 0.015},
      Band{"reach idle way", &S::idle_excursion_m, 0.002, 0.0035},
      Band{"reach idle window", &S::idle_window_s, 0.4, 0.6},
      Band{"reach idle time", &S::reach_idle_s, 0.4, 0.6},
      Band{"onset", &S::onset_speed_m_per_s, 0.0005, 0.003},
      Band{"turn pause", &S::turn_pause_s, 0.05, 0.2},
      Band{"reach look-back", &S::reach_look_back_s, 8, 12},
      Band{"reach minimum", &S::reach_minimum_s, 0.08, 0.12},
      Band{"reach brush", &S::reach_brush_s, 0.04, 0.06},
      Band{"slide speed", &S::slide_speed_m_per_s, 0.007, 0.015},
      Band{"slide window", &S::slide_window_s, 0.08, 0.12},
      Band{"slide jerk", &S::slide_moment_s, 0.04, 0.06},
      Band{"slide pause", &S::slide_pause_s, 0.12, 0.18},
      Band{"slide way", &S::slide_displacement_m, 0.015, 0.025},
      Band{"lift rise", &S::pick_up_rise_m, 0.025, 0.035},
      Band{"lift radius", &S::pick_up_radius_m, 0.08, 0.10},
      Band{"lift height", &S::pick_up_height_m, 0.10, 0.14},
      Band{"put drop", &S::put_down_drop_m, 0.015, 0.025},
      Band{"put radius", &S::put_down_radius_m, 0.08, 0.10},
      Band{"put height", &S::put_down_height_m, 0.07, 0.09},
      Band{"put look-back", &S::put_down_look_back_s, 3.0, 4.0},
      Band{"put dead-band", &S::put_down_dead_band_m, 0.004, 0.006},
      Band{"put window", &S::put_down_window_s, 0.08, 0.12},
      Band{"put slip", &S::put_down_slip_s, 0.015, 0.025},
      Band{"carry way", &S::carry_way_m, 0.004, 0.006},
      Band{"part speed", &S::part_speed_per_s, 0.04, 0.06},
      Band{"part window", &S::part_window_s, 0.08, 0.12},
      Band{"part onset", &S::part_onset, 0.0005, 0.002},
      Band{"part halt", &S::part_halt_s, 0.16, 0.24},
      Band{"part way", &S::part_way, 0.08, 0.12},
      Band{"part touch", &S::part_touch_s, 0.08, 0.12},
  };
  return kBands;
}

std::vector<OracleSettings> DefinitionChoices() {
  std::vector<OracleSettings> choices = {{}};
  for (const Band& band : DefinitionBands()) {
    for (const double value : {band.low, band.high}) {
      OracleSettings choice;
      choice.*band.setting = value;
      choices.push_back(choice);
    }
  }
  return choices;
}

}  // namespace prehend::truth
