// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grammar/base/frame.h"
#include "harness/base/base/quoting.h"
#include "harness/exchange/export/motion.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

bool IsTrackerBody(const grammar::EntityInfo& entity) {
  const auto is = [&](const char* name) {
    return std::ranges::find(entity.classes, name) != entity.classes.end();
  };
  return is("Thing") || is("Hand");
}

std::string YamlVector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// `grip` and `joint` of a map, in columns of WriteCsv().
std::string OpeningText(const Motion::Seen& of) {
  std::string text;
  if (of.most_grip > 0) text += ", grip: {from: grip, open: 0, closed: 1}";
  if (!of.has_joint) return text;
  const auto& [at, fraction] = std::pair(of.shut.joint_position, of.shut.joint_fraction);
  const double way = of.open.joint_fraction - fraction;
  double closed = fraction == 0 ? at : 0, open = fraction == 0 ? at + 1 : at / fraction;
  if (way > 0) {
    const double full = (of.open.joint_position - at) / way;
    closed = at - fraction * full;
    open = of.open.joint_fraction == 1 ? of.open.joint_position : closed + full;
  }
  return text +
         fmt::format(", joint: {{from: joint_position, open: {}, closed: {}}}", open, closed);
}

}  // namespace

void WriteLines(const Motion& motion, std::ostream& out) {
  episode::EpisodeWriter writer(out, motion.header);
  motion.EachFrame([&](const grammar::Frame& frame) { writer.Write(frame); });
  if (motion.says_its_end) writer.Finish(motion.end_tick);
}

void WriteCsv(const Motion& motion, std::ostream& out) {
  out << "t,entity,x,y,z,qw,qx,qy,qz,grip,joint_position,joint_fraction\n";
  std::vector<std::string> names;
  for (const grammar::EntityInfo& entity : motion.table().entities)
    names.push_back(AsCsvCell(entity.name));
  std::vector<std::string> grips(names.size());
  motion.EachFrame([&](const grammar::Frame& frame) {
    for (const grammar::HandSample& hand : frame.hands)
      grips[hand.entity] = fmt::to_string(hand.trigger);
    const std::string t = truth::SecondsText(frame.tick, motion.table().ticks_per_second);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      const Eigen::Vector3d& p = look.p_WB_m;
      const Eigen::Quaterniond& q = look.q_WB;
      const std::string pose =
          grammar::IsTracked(look)
              ? fmt::format("{},{},{},{},{},{},{}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z())
              : ",,,,,,";
      const std::string joint = motion.seen[i].has_joint
                                    ? fmt::format("{},{}", look.joint_position, look.joint_fraction)
                                    : ",";
      out << t << ',' << names[i] << ',' << pose << ',' << grips[i] << ',' << joint << '\n';
    }
  });
}

std::string RolesJson(const grammar::NamedEvent& event) {
  nlohmann::ordered_json roles = nlohmann::ordered_json::object();
  for (const grammar::Role& role : event.roles) roles[role.name] = role.value;
  for (const grammar::NamedValue& value : event.values) roles[value.name] = value.value;
  return roles.dump();
}

std::string EventsCsv(const Motion& motion) {
  std::vector<std::string> columns;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(columns, name) == columns.end()) columns.push_back(name);
  };
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    for (const grammar::Role& role : event.roles) add(role.name);
    for (const grammar::NamedValue& value : event.values) add(value.name);
  }
  std::string text = "uuid,event,begin_s,end_s,decided_s,open_end";
  for (const std::string& column : columns) text += "," + column;
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i) {
    const grammar::NamedEvent& event = motion.timeline.events[i];
    text += "\n" + motion.uuids[i] + "," + AsCsvCell(event.event);
    for (const grammar::Tick tick : {event.interval.begin, event.interval.end, event.decided})
      text += "," + truth::SecondsText(tick, motion.timeline.ticks_per_second);
    text += event.open_end ? ",true" : ",false";
    for (const std::string& column : columns) {
      const auto value = std::ranges::find(event.values, column, &grammar::NamedValue::name);
      text += "," + (value == event.values.end() ? AsCsvCell(truth::RoleValue(event, column))
                                                 : fmt::to_string(value->value));
    }
  }
  return text + "\n";
}

std::string MapText(const Motion& motion, const std::string& ending) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  grammar::Tick ticks_per_second = motion.table().ticks_per_second;
  while (ticks_per_second < 100) ticks_per_second *= 10;  // the least that a map can say
  std::string text = fmt::format(
      "# prehend import FILE --map THIS -o take.jsonl; time 0 is that of the first frame.\n"
      "import: 1\nepisode: {}\nunit: m\naxes: z_up\nticks_per_second: {}\nlost: unknown\n"
      "bridge_s: {}\nsure: [unit, axes, quaternion_order, time, place, zero, upright, handed]\n",
      quoted(motion.header.episode), ticks_per_second, motion.header.bridge_s);
  if (ending == ".csv")
    text +=
        "quaternion_order: wxyz\ntime_unit: s\n"
        "columns: {time: t, body: entity, position: [x, \"y\", z], "
        "quaternion: [qw, qx, qy, qz]}\n";
  else if (ending == ".npz")
    text += "quaternion_order: wxyz\nt: t_s\ntime_unit: s\nmissing: [nan]\n";
  else
    text += "mcap: {clock: log, world: " + quoted(WorldName(motion.table())) + "}\n";
  text += "entities:\n";
  for (std::size_t i = 0; i < motion.seen.size(); ++i) {
    const grammar::EntityInfo& entity = motion.table().entities[i];
    if (!IsTrackerBody(entity) || motion.seen[i].looks < 2) continue;
    const std::string& own = entity.classes.front();
    const std::string at =
        ending == ".npz"
            ? fmt::format("position: \"position_m[{}:{}]\", quaternion: \"quaternion_wxyz[{}:{}]\"",
                          3 * i, 3 * i + 3, 4 * i, 4 * i + 4)
            : "from: " + quoted(entity.name);
    text += fmt::format("  {}: {{{}, size_m: {}", quoted(entity.name), at,
                        YamlVector(2 * entity.half_size_m));
    if (!entity.p_BC_m.isZero(0)) text += ", offset_m: " + YamlVector(entity.p_BC_m);
    if (own == "Hand")
      text += ", hand: true";
    else
      text += ", class: " + quoted(own);
    const bool has_joint = ending == ".csv" && motion.seen[i].has_joint;
    if (!has_joint && std::ranges::find(entity.classes, "Fixed") != entity.classes.end())
      text += ", fixed: true";
    if (ending == ".csv") text += OpeningText(motion.seen[i]);
    if (const auto& ahead = motion.seen[i].ahead_B)
      text += ", ahead: " + YamlVector(ahead->normalized());
    text += "}\n";
  }
  return text;
}

}  // namespace prehend::exchange
