// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/oracle.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "harness/truth/oracle/furniture.h"
#include "harness/truth/oracle/recording.h"
#include "harness/truth/oracle/touches.h"

namespace prehend::truth {

namespace {

/// What was found with some settings: most choices change none of those that it depends on.
struct Known {
  std::map<std::tuple<Grasp, int, int, ReachSettings>, int> reaches;
  std::map<std::tuple<Grasp, std::map<int, Spans>, CarrySettings, double>, Carrying> carryings;
  std::map<std::tuple<FurnitureSettings, double>, std::vector<Part>> parts;
};

class TimelineBuilder {
 public:
  TimelineBuilder(const Evidence& evidence, const Touches& touches, const OracleSettings& settings,
                  grammar::Tick end, Known& known)
      : evidence_(evidence),
        recording_(evidence.recording),
        settings_(settings),
        end_(end),
        touches_(touches),
        known_(known) {
    timeline_.ticks_per_second = recording_.scene.world.rate_hz;
  }

  grammar::Timeline Build() {
    AddContacts();
    for (const auto& [pair, spans] : touches_.supports)
      for (const Span& span : spans)
        Add("supported_by",
            {{"object", recording_.name(pair.first)}, {"support", recording_.name(pair.second)}},
            span);
    for (const Grasp& grasp : touches_.grasps) AddGrasp(grasp);
    AddFurniture();
    grammar::Sort(timeline_);
    return std::move(timeline_);
  }

 private:
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
    const auto [known, is_new] = known_.parts.try_emplace({settings_, settings_.contact_bridge_s});
    if (is_new) known->second = FindParts(evidence_, settings_, settings_.contact_bridge_s);
    for (const Part& part : known->second) {
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
    const Spans& contacts =
        touches_.contacts.at({grasp.body, recording_.body_count() + grasp.hand});
    Span contact, contact_before;
    for (const Span& span : contacts) {
      const bool brushes = recording_.Lasts_s(span) < settings_.reach_brush_s;
      if (span.end <= grasp.span.begin && !brushes) contact_before = span;
      if (span.Contains(grasp.span.begin)) contact = span;
    }
    int earliest = contact_before.end;
    for (const Grasp& other : touches_.grasps) {
      if (other.hand != grasp.hand) continue;
      if (other.body == grasp.body &&
          Span{contact.begin, grasp.span.begin}.Contains(other.span.begin))
        return {};
      // A grasp drops every candidate that is not touched yet; what comes after it may be a reach.
      if (other.span.begin < contact.begin) earliest = std::max(earliest, other.span.begin + 1);
    }
    Add("fixation", RolesOf(grasp), {contact.begin, grasp.span.begin});
    const auto [known, is_new] =
        known_.reaches.try_emplace({grasp, earliest, contact.begin, settings_});
    if (is_new)
      known->second =
          ReachBegin(evidence_, settings_, grasp.hand, grasp.body, earliest, contact.begin);
    const int begin = known->second;
    if (recording_.Seconds(begin, contact.begin) < settings_.reach_minimum_s) return {};
    Add("reaching", RolesOf(grasp), {begin, contact.begin});
    return {begin, contact.begin};
  }

  Carrying AddCarrying(const Grasp& grasp) {
    std::map<int, Spans> supports;
    for (const auto& [pair, spans] : touches_.supports)
      if (pair.first == grasp.body) supports[pair.second] = spans;
    const auto [known, is_new] =
        known_.carryings.try_emplace({grasp, supports, settings_, settings_.onset_speed_m_per_s});
    if (is_new) known->second = FindCarrying(evidence_, settings_, grasp, supports);
    const Carrying& carrying = known->second;
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
  return TimelineBuilder(evidence, FindTouches(evidence, settings), settings, end, known).Build();
}

std::vector<grammar::Timeline> PossibleTimelines(const physics::Scene& scene,
                                                 std::span<const physics::Snapshot> recording,
                                                 grammar::Tick end) {
  const Recording frames = MakeRecording(scene, recording);
  const Evidence evidence(frames);
  Known known;
  std::vector<grammar::Timeline> timelines;
  const Touches usual = FindTouches(evidence, {});  // most choices change none of their numbers
  for (const OracleSettings& choice : DefinitionChoices()) {
    const TouchSettings& touch = choice;
    const Touches own = touch == TouchSettings{} ? Touches{} : FindTouches(evidence, choice);
    const Touches& touches = touch == TouchSettings{} ? usual : own;
    timelines.push_back(TimelineBuilder(evidence, touches, choice, end, known).Build());
  }
  return timelines;
}

}  // namespace prehend::truth
