// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/export/write_motion.h. Tested by tests/mcap/mcap_test.mjs
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grammar/base/frame.h"
#include "harness/exchange/export/mcap_writer.h"
#include "harness/exchange/export/ros_messages.h"
#include "harness/exchange/export/write_motion.h"

namespace prehend::exchange {
namespace {

/// The begins and ends of events, by time.
std::vector<std::pair<grammar::Tick, std::string>> EdgesOf(const Motion& motion) {
  std::vector<std::pair<grammar::Tick, std::string>> edges;
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i) {
    const grammar::NamedEvent& event = motion.timeline.events[i];
    nlohmann::ordered_json json = {{"event", event.event},
                                   {"edge", "begin"},
                                   {"roles", nlohmann::ordered_json::parse(RolesJson(event))},
                                   {"begin_s", motion.Seconds(event.interval.begin)},
                                   {"end_s", motion.Seconds(event.interval.end)},
                                   {"open_end", event.open_end},
                                   {"uuid", motion.uuids[i]}};
    edges.emplace_back(event.interval.begin, json.dump());
    json["edge"] = "end";
    edges.emplace_back(event.interval.end, json.dump());
  }
  std::ranges::stable_sort(edges, {}, &std::pair<grammar::Tick, std::string>::first);
  return edges;
}

std::string BagMetadata(const McapWriter& bag, const std::string& file) {
  const std::uint64_t length_ns = bag.last_ns() - bag.first_ns();
  const auto times = [&](const char* indent) {
    return fmt::format("{0}starting_time:\n{0}  nanoseconds_since_epoch: {1}\n", indent,
                       bag.first_ns()) +
           fmt::format("{0}duration:\n{0}  nanoseconds: {1}\n{0}message_count: {2}\n", indent,
                       length_ns, bag.messages());
  };
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n" +
                     times("  ") + "  topics_with_message_count:\n";
  for (const McapTopic& topic : bag.topics()) {
    const std::string qos = nlohmann::json(QosText(topic.latched)).dump();
    text += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n"
        "        serialization_format: cdr\n        offered_qos_profiles: {}\n"
        "      message_count: {}\n",
        topic.topic, topic.type, qos, topic.messages);
  }
  const std::string quoted = nlohmann::json(file).dump();
  return text +
         "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " +
         quoted + "\n  files:\n    - path: " + quoted + "\n" + times("      ");
}

}  // namespace

std::string WorldName(const grammar::EntityTable& table) {
  std::string name = "world";
  const auto is_taken = [&](const grammar::EntityInfo& entity) { return entity.name == name; };
  while (std::ranges::any_of(table.entities, is_taken)) name += "_";
  return name;
}

std::string WriteMcap(const Motion& motion, const std::string& name, std::ostream& out) {
  McapWriter bag(out);
  const auto topic = [&](const char* called, const std::string& type, bool latched = false) {
    return bag.AddTopic({called, type, RosDefinition(type), latched});
  };
  const std::size_t still = topic("/tf_static", "tf2_msgs/msg/TFMessage", true),
                    shapes = topic("/markers", "visualization_msgs/msg/MarkerArray", true),
                    moving = topic("/tf", "tf2_msgs/msg/TFMessage"),
                    joints = topic("/joint_states", "sensor_msgs/msg/JointState"),
                    events = topic("/events", "std_msgs/msg/String");
  const grammar::EntityTable& table = motion.table();
  const std::string world = WorldName(table);
  std::vector<FramePose> frames;
  std::vector<bool> stands;
  for (std::size_t i = 0; i < table.entities.size(); ++i) {
    const Motion::Seen& seen = motion.seen[i];
    stands.push_back(!seen.moves && seen.looks == motion.frames);
    if (stands[i] && seen.looks > 0)
      frames.push_back({&table.entities[i].name, seen.first.p_WB_m, seen.first.q_WB});
  }
  bag.Message(shapes, 0, ShapesMessage(0, table));
  if (!frames.empty()) bag.Message(still, 0, TransformsMessage(0, world, frames));
  const auto edges = EdgesOf(motion);
  auto edge = edges.begin();
  const auto tell_events = [&](grammar::Tick until) {
    for (; edge != edges.end() && edge->first <= until; ++edge)
      bag.Message(events, motion.Nanoseconds(edge->first), StringMessage(edge->second));
  };
  std::vector<JointValue> values;
  motion.EachFrame([&](const grammar::Frame& frame) {
    tell_events(frame.tick);
    const std::uint64_t ns = motion.Nanoseconds(frame.tick);
    frames.clear();
    values.clear();
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      if (!stands[i] && grammar::IsTracked(look))
        frames.push_back({&table.entities[i].name, look.p_WB_m, look.q_WB});
      if (motion.seen[i].has_joint) values.push_back({table.entities[i].name, look.joint_position});
    }
    for (const grammar::HandSample& hand : frame.hands)
      values.push_back({table.entities[hand.entity].name + "_grip", hand.trigger});
    if (!frames.empty()) bag.Message(moving, ns, TransformsMessage(ns, world, frames));
    if (!values.empty()) bag.Message(joints, ns, JointsMessage(ns, values));
  });
  tell_events(std::max(motion.end_tick, edges.empty() ? 0 : edges.back().first));
  bag.Finish();
  return BagMetadata(bag, name);
}

}  // namespace prehend::exchange
