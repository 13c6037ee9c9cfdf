// SPDX-License-Identifier: Apache-2.0
// Poses from an MCAP file or a bag of ROS 1: of topics, of named bodies, of the frames of a tree of
// transforms. Tested by tests/program/import_mcap_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "harness/base/text_file.h"
#include "harness/import/frame_tree.h"
#include "harness/import/pose_file.h"
#include "harness/messages/bag_file.h"
#include "harness/messages/pose_messages.h"

namespace prehend::harness::import {

using messages::FormatOf;
using messages::LogChannel;
using messages::LogMessage;
using messages::MessageContent;
using messages::MessageFormat;
using messages::MessagePose;

namespace {

constexpr std::size_t kMostSeries = 10'000, kMostPoses = 5'000'000;
constexpr std::size_t kPosesOfAnyFile = 250'000;  ///< and one more for each four bytes of the file
constexpr std::int64_t kLast_ns = std::int64_t{1} << 62;  ///< in the year 2116
constexpr double kMostDuration_s = 1e5;
constexpr std::size_t kMostDeep = 200;  ///< frames in frames
constexpr std::ptrdiff_t kMostNamed = 4;
constexpr std::size_t kMostTopics = 20;  ///< that an error names
constexpr const char* kReadTypes =
    "read are PoseStamped, PoseArray, TransformStamped and TFMessage of ROS as JSON, CDR or ROS 1, "
    "and PoseInFrame, PosesInFrame, FrameTransform and FrameTransforms of Foxglove as JSON "
    "(docs/motion-capture.md)";
constexpr std::int64_t kMostBack_ns = 1'000'000'000;  ///< more than this is another clock

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Topics of tf may begin their names with a slash, and mean the same.
std::string FrameName(std::string name) {
  if (name.starts_with('/')) name.erase(0, 1);
  return name;
}

class McapPoseReader {
 public:
  McapPoseReader(const std::string& path, const MapFile& map)
      : map_(map.map), map_errors_(map.document) {
    poses.file = path;
    poses.bodies = BodiesOf(map_, map_errors_);
    poses.quaternion_order =
        map_.quaternion_order ? map_.quaternion_order->value : QuaternionOrder::kXyzw;
    nan_is_missing_ = std::ranges::find(map_.missing, "nan") != map_.missing.end();
  }

  void Read() {
    std::error_code error;
    const auto size = std::filesystem::file_size(poses.file, error);
    if (error || !std::filesystem::is_regular_file(poses.file))
      return Fail(std::filesystem::exists(poses.file) ? "is not a regular file" : "no such file");
    std::ifstream in(poses.file, std::ios::binary);
    size_ = size;
    most_poses_ = std::min<std::uint64_t>(kMostPoses, kPosesOfAnyFile + size / 4);
    const auto read = IsBag(poses.file) ? messages::ReadBag : messages::ReadMcap;
    const std::string why = read(
        in, size, [this](const LogMessage& message) { return TakeMessage(message); },
        [this](const LogChannel& channel) { TakeChannel(channel); });
    if (!why.empty()) return Fail(why);
    if (map_errors_.empty()) FindBodies();
    if (map_errors_.empty()) Compose();
    if (map_errors_.empty() && problems_.empty()) RefuseAbsentBodies(poses, map_, map_errors_);
  }

  grammar::Diagnostics Problems() const {
    grammar::Diagnostics all = map_errors_.Sorted();
    all.insert(all.end(), problems_.begin(), problems_.end());
    return all;
  }

  PoseFile poses;

 private:
  void Fail(std::string message) {
    problems_.push_back({.file = poses.file,
                         .place = {},
                         .message = std::move(message),
                         .source_line = {},
                         .hint = {}});
  }

  void TakeChannel(const LogChannel& channel) {
    if (FormatOf(channel)) return;
    unread_[channel.topic] = fmt::format(
        "{} ({})", channel.schema.empty() ? "no schema" : channel.schema, channel.message_encoding);
  }

  std::string TakeMessage(const LogMessage& message) {
    const std::optional<MessageFormat> format = FormatOf(message.channel);
    if (!format) return "";
    std::vector<MessagePose> read;
    const std::string& topic = message.channel.topic;
    std::string why = messages::DecodePoses(*format, message.data, read);
    for (std::size_t i = 0; why.empty() && i < read.size(); ++i) {
      MessagePose& pose = read[i];
      const bool moves_frame = format->content == MessageContent::kTransform ||
                               format->content == MessageContent::kTransforms;
      if (format->content == MessageContent::kPose) pose.name = topic;
      if (format->content == MessageContent::kPoses) pose.name = fmt::format("{}[{}]", topic, i);
      if (pose.name.empty()) why = "a transform without 'child_frame_id'";
      FrameLink& link = moves_frame ? tree_.links[FrameName(pose.name)] : topics_[pose.name];
      if (why.empty()) why = TakePose(message, pose, link);
    }
    if (tree_.links.size() + topics_.size() > kMostSeries)
      why = fmt::format("more than {} frames and bodies", kMostSeries);
    if (poses_ > most_poses_)
      why = most_poses_ == kMostPoses
                ? fmt::format("more than {} poses", kMostPoses)
                : fmt::format("more than {} poses in a file of {} KiB", most_poses_, size_ >> 10);
    if (why.empty()) return "";
    return fmt::format("a message of '{}', logged at {:.6f} s: {}", ReadableName(topic),
                       Seconds(message.log_ns), why);
  }

  std::string TakePose(const LogMessage& message, const MessagePose& pose, FrameLink& link) {
    const bool fixed = message.channel.topic.ends_with("tf_static");
    const std::string frame = FrameName(pose.frame);
    if (link.poses.empty()) {
      link.parent = frame;
      link.fixed = fixed;
    } else if (link.parent != frame) {
      return fmt::format("'{}' is in the frame '{}', and before it was in '{}'", pose.name, frame,
                         link.parent);
    }
    std::int64_t ns = map_.mcap.clock == Clock::kPublish ? message.publish_ns : message.log_ns;
    if (map_.mcap.clock == Clock::kHeader && pose.stamp_ns) {
      ns = *pose.stamp_ns;
      if (ns == 0 && !fixed)
        return fmt::format(
            "'{}' has the time 0 in its header; if it has no clock, the map says "
            "mcap: {{clock: log}}",
            pose.name);
    }
    if (ns < 0 || ns > kLast_ns)
      return fmt::format("'{}' has the time {:.0f} s; expected one of the years 1970 to 2116",
                         pose.name, static_cast<double>(static_cast<std::uint64_t>(ns)) * 1e-9);
    if (!link.poses.empty() && ns < link.poses.back().ns - kMostBack_ns)
      return fmt::format(
          "the times of '{}' go back from {:.6f} to {:.6f} s: its clock was set, or "
          "these are two recordings",
          pose.name, Seconds(link.poses.back().ns), Seconds(ns));
    if (pose.missing || (map_.zero_is_missing && pose.p.isZero(0))) return "";
    if (!pose.p.allFinite() || !pose.xyzw.allFinite()) {
      if (nan_is_missing_) return "";
      return fmt::format(
          "'{}' has a pose that is no number; if that means 'not tracked', the map "
          "says missing: [nan]",
          pose.name);
    }
    const double length = pose.xyzw.norm();
    if (std::abs(length - 1) > kUnitTolerance)
      return fmt::format("'{}': expected a unit quaternion, found one of length {:.4g}", pose.name,
                         length);
    const Eigen::Vector4d& v = pose.xyzw;
    Eigen::Quaterniond q(v[3], v[0], v[1], v[2]);
    if (poses.quaternion_order == QuaternionOrder::kWxyz)
      q = Eigen::Quaterniond(v[0], v[1], v[2], v[3]);
    link.poses.push_back({.ns = ns, .p = pose.p, .q = q.normalized()});
    ++poses_;
    return "";
  }

  /// Of each body its topic or its frame.
  void FindBodies() {
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from) continue;
      const Located<std::string>& from = *entity.value.from;
      const auto topic = topics_.find(from.value);
      const auto frame = tree_.links.find(FrameName(from.value));
      if (topic != topics_.end() && frame != tree_.links.end())
        map_errors_.Add(
            from.where,
            fmt::format("'{}' is a topic of poses and a frame of transforms", from.value));
      else if (topic != topics_.end())
        found_.push_back(&topic->second);
      else if (frame != tree_.links.end())
        found_.push_back(&frame->second);
      else
        RefuseUnknown(from);
    }
    std::set<std::string> used;
    for (const PoseBody& body : poses.bodies) used.insert(FrameName(body.name));
    for (const auto& [name, link] : topics_) {
      if (!used.contains(FrameName(name))) poses.unused.push_back(name);
    }
  }

  void RefuseUnknown(const Located<std::string>& from) {
    if (const auto unread = unread_.find(from.value); unread != unread_.end())
      return map_errors_.Add(from.where,
                             fmt::format("the messages of '{}' are of a type that is not read: {}",
                                         from.value, unread->second),
                             kReadTypes);
    std::vector<std::string> names;
    for (const auto* series : {&topics_, &tree_.links}) {
      for (const auto& [name, link] : *series) names.push_back(name);
    }
    if (names.empty() && !unread_.empty()) return RefuseAllTypes(from);
    map_errors_.AddUnknownName(
        from.where,
        fmt::format("no topic of poses, no body and no frame is called '{}'", from.value),
        from.value, names);
  }

  /// Once for all bodies.
  void RefuseAllTypes(const Located<std::string>& from) {
    if (!map_errors_.empty()) return;
    std::string topics;
    std::size_t named = 0;
    for (const auto& [topic, type] : unread_) {
      if (named++ == kMostTopics) break;
      topics += fmt::format("{}'{}': {}", topics.empty() ? "" : ", ", ReadableName(topic),
                            ReadableName(type));
    }
    if (unread_.size() > kMostTopics)
      topics += fmt::format(" and {} more", unread_.size() - kMostTopics);
    map_errors_.Add(
        from.where,
        fmt::format("the file has no topic of a type that is read, so no '{}'; it has {}",
                    from.value, topics),
        kReadTypes);
  }

  /// The frame that is the recording's, or "" after an error.
  std::optional<std::string> World() {
    std::map<std::string, std::string> roots;  // and a body of each
    for (std::size_t i = 0; i < found_.size(); ++i)
      roots.emplace(tree_.RootOf(found_[i]->parent), poses.bodies[i].name);
    const auto& given = map_.mcap.world;
    const std::string world = given ? FrameName(given->value) : roots.begin()->first;
    const std::string root = tree_.RootOf(world);
    if (given && !roots.contains(root)) {
      std::vector<std::string> names;
      for (const auto& [name, link] : tree_.links) names.push_back(name);
      for (const auto& [name, body] : roots) names.push_back(name);
      map_errors_.AddUnknownName(given->where,
                                 fmt::format("no body is tracked in the frame '{}'", given->value),
                                 given->value, names);
      return std::nullopt;
    }
    for (const auto& [name, body] : roots) {
      if (name == root) continue;
      map_errors_.Add(given ? given->where : map_.entities.front().name_where,
                      fmt::format("no transforms join the frames '{}' (of '{}') and '{}' (of '{}')",
                                  root, roots.at(root), name, body),
                      "is a topic of static transforms missing in the file?");
      return std::nullopt;
    }
    return world;
  }

  void Compose() {
    for (auto* series : {&topics_, &tree_.links}) {
      for (auto& [name, link] : *series) {
        if (const auto ns = link.Sort())
          return Fail(fmt::format("'{}' has two poses at {:.6f} s", name, Seconds(*ns)));
      }
    }
    for (std::size_t i = 0; i < found_.size(); ++i) RefuseRing(poses.bodies[i].name, *found_[i]);
    if (!problems_.empty()) return;
    const std::optional<std::string> world = World();
    if (!world) return;
    if (const auto link = tree_.links.find(*world); link != tree_.links.end())
      RefuseRing(*world, link->second);
    if (!problems_.empty()) return;
    const auto bridge_ns = static_cast<std::int64_t>(map_.bridge_s * 1e9);
    std::vector<std::vector<TimedPose>> all;
    std::optional<std::int64_t> first, last;
    for (const FrameLink* body : found_) {
      all.push_back(tree_.InFrame(*body, *world, bridge_ns));
      if (all.back().size() < 2) continue;
      first = std::min(first.value_or(all.back().front().ns), all.back().front().ns);
      last = std::max(last.value_or(all.back().back().ns), all.back().back().ns);
    }
    if (!first) return;  // refused, each by its name
    poses.last_s = Seconds(*last - *first);
    poses.began_at_s = Seconds(*first);
    if (poses.last_s > kMostDuration_s)
      return Fail(
          fmt::format("its poses are from {:.3f} to {:.3f} s: they are not of one clock; the "
                      "map can say mcap: {{clock: log}}",
                      Seconds(*first), Seconds(*last)));
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].size() == 1 && IsFixed(*found_[i], *world)) {  // it stands still all the time
        all[i].push_back(all[i].front());
        all[i].front().ns = *first;
        all[i].back().ns = *last;
      }
      for (const TimedPose& pose : all[i])
        poses.bodies[i].samples.push_back(
            {.t_s = Seconds(pose.ns - *first), .p = pose.p, .q = pose.q});
    }
  }

  /// From a body to its root there are few frames.
  void RefuseRing(const std::string& name, const FrameLink& body) {
    std::vector<const std::string*> way = {&body.parent};
    while (problems_.empty()) {
      const auto parent = tree_.links.find(*way.back());
      if (parent == tree_.links.end()) return;
      const std::string& next = parent->second.parent;
      const auto again = std::ranges::find_if(way, [&](const auto* of) { return *of == next; });
      if (again != way.end()) {
        std::string ring = fmt::format("'{}'", **again);
        for (auto frame = again + 1; frame != way.end() && frame - again < kMostNamed; ++frame)
          ring += fmt::format(" in '{}'", **frame);
        return Fail(fmt::format("the frames are in a ring: {} in {}'{}' again", ring,
                                way.end() - again > kMostNamed ? ".. in " : "", next));
      }
      if (way.size() >= kMostDeep)
        return Fail(fmt::format("'{}' is in more than {} frames, one in another", name, kMostDeep));
      way.push_back(&next);
    }
  }

  bool IsFixed(const FrameLink& body, const std::string& world) const {
    const FrameLink* link = &body;
    for (std::size_t depth = 0; link->fixed && depth <= tree_.links.size(); ++depth) {
      const auto parent = tree_.links.find(link->parent);
      if (link->parent == world || parent == tree_.links.end()) return true;
      link = &parent->second;
    }
    return false;
  }

  const ImportMap& map_;
  DiagnosticList map_errors_;
  grammar::Diagnostics problems_;
  bool nan_is_missing_ = false;
  FrameTree tree_;
  std::map<std::string, FrameLink> topics_;    ///< and named bodies
  std::map<std::string, std::string> unread_;  ///< topics, with what they hold
  std::vector<const FrameLink*> found_;        ///< of each body
  std::size_t poses_ = 0;
  std::uint64_t most_poses_ = kMostPoses, size_ = 0;
};

}  // namespace

Result<PoseFile> ReadMcapPoses(const std::string& path, const MapFile& map) {
  McapPoseReader reader(path, map);
  reader.Read();
  if (grammar::Diagnostics problems = reader.Problems(); !problems.empty())
    return tl::unexpected(std::move(problems));
  return std::move(reader.poses);
}

}  // namespace prehend::harness::import
