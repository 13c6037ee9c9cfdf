// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/logs/log_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/base/base/median.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostSeries = 10'000, kMostPoses = 5'000'000;
constexpr std::size_t kPosesOfAnyFile = 250'000;  ///< and one more for each four bytes of the file
constexpr std::int64_t kLast_ns = std::int64_t{1} << 62;  ///< in the year 2116
constexpr std::int64_t kMostBack_ns = 1'000'000'000;      ///< more than this is another clock
constexpr std::size_t kMostLookedAt = 100'000;  ///< poses of a topic that nobody asked for
constexpr std::size_t kMostSeen = 1000;         ///< bodies of a topic
constexpr std::size_t kMostSeenOfFile = 20'000;

constexpr double kMostApart_m = 0.1;  ///< of a body, twice in a message

double InSeconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// "/frame[Cup]" is of the topic "/frame".
bool IsOfTopic(const std::string& from, const std::string& topic) {
  return from.starts_with(topic) &&
         (from.size() == topic.size() || from[topic.size()] == '[' || from[topic.size()] == ':');
}

/// Of a link, over increasing times.
class LinkWalk {
 public:
  LinkWalk(const FrameLink& link, std::int64_t bridge_ns)
      : link_(link), most_gap_ns_(std::max(bridge_ns, link.UsualStep_ns() * 3 / 2)) {}

  std::optional<TimedPose> At(std::int64_t ns) {
    const std::vector<TimedPose>& poses = link_.poses;
    if (poses.empty()) return std::nullopt;
    if (link_.fixed) return poses.back();
    while (next_ < poses.size() && poses[next_].ns < ns) ++next_;
    if (next_ == poses.size()) return std::nullopt;
    const TimedPose& after = poses[next_];
    if (after.ns == ns) return after;
    if (next_ == 0) return std::nullopt;
    const TimedPose& before = poses[next_ - 1];
    if (after.ns - before.ns > most_gap_ns_) return std::nullopt;
    const double part =
        static_cast<double>(ns - before.ns) / static_cast<double>(after.ns - before.ns);
    return TimedPose{
        .ns = ns, .p = before.p + part * (after.p - before.p), .q = before.q.slerp(part, after.q)};
  }

 private:
  const FrameLink& link_;
  const std::int64_t most_gap_ns_;
  std::size_t next_ = 0;
};

/// All links of a way, the innermost first.
std::optional<TimedPose> Along(std::vector<LinkWalk>& way, std::int64_t ns) {
  TimedPose pose{.ns = ns};
  for (LinkWalk& link : way) {
    const std::optional<TimedPose> outer = link.At(ns);
    if (!outer) return std::nullopt;
    pose.p = outer->p + outer->q * pose.p;
    pose.q = outer->q * pose.q;
  }
  return pose;
}

}  // namespace

std::string FrameName(std::string name) {
  if (name.starts_with('/')) name.erase(0, 1);
  return name;
}

std::vector<std::string> LogTopic::Names(const std::string& topic, bool unasked_only) const {
  std::vector<std::string> names;
  if (!reader || (unasked_only && reader->is_drawn())) return names;
  const std::vector<PoseField>& fields = reader->fields();
  const bool has_poses = std::ranges::find(fields, true, &PoseField::oriented) != fields.end();
  for (const auto& [field, keys] : seen) {
    if (has_poses && !fields[field].oriented) continue;
    const bool is_asked =
        std::ranges::any_of(asked, [&field = field, &keys = keys](const AskedBody& body) {
          return body.links.contains(field) && body.address.keys == keys;
        });
    if (!is_asked || !unasked_only)
      names.push_back(AddressOf(ReadableName(topic), fields, field, keys));
  }
  return names;
}

LogSeries::LogSeries(const ImportMap& map, std::uint64_t file_bytes)
    : map_(map),
      order_(map.quaternion_order ? map.quaternion_order->value : QuaternionOrder::kXyzw),
      file_bytes_(file_bytes),
      most_poses_(std::min<std::uint64_t>(kMostPoses, kPosesOfAnyFile + file_bytes / 4)),
      nan_is_missing_(std::ranges::find(map.missing, "nan") != map.missing.end()) {
  openings.resize(OpeningsOf(map).size());
}

void LogSeries::TakeChannel(const LogChannel& channel) {
  std::string why;
  const bool is_known = topics.contains(channel.topic);
  LogTopic& topic = topics[channel.topic];
  Source source{.reader = readers_.Of(channel, why), .topic = &topic};
  if (topic.reader && source.reader)
    source.other_type = topic.reader->fields() != source.reader->fields();
  if (!is_known || (!topic.reader && source.reader)) {
    topic.reader = source.reader;
    topic.why_not = why;
    topic.of_frames = MessageReaders::IsOfFrames(channel);
    Ask(channel.topic, topic);
  }
  AskOpenings(channel, source);
  sources_.emplace(&channel, std::move(source));
}

void LogSeries::AskOpenings(const LogChannel& channel, Source& source) {
  const std::vector<OpeningSeries> series = OpeningsOf(map_);
  for (std::size_t i = 0; i < series.size(); ++i) {
    LogOpening& opening = openings[i];
    const auto& from = series[i].Of(map_).from;
    const bool is_of_topic = std::ranges::all_of(
        from, [&](const Located<std::string>& one) { return IsOfTopic(one.value, channel.topic); });
    // Of "/a" and "/a:b" the longer one is meant.
    if (!is_of_topic || channel.topic.size() < opening.topic.size()) continue;
    opening.topic = channel.topic;
    opening.addresses.clear();
    for (const Located<std::string>& one : from)
      if (const auto address =
              ParseBodyAddress(std::string_view(one.value).substr(channel.topic.size())))
        opening.addresses.push_back(*address);
    source.definition = {};
    opening.why_not = opening.addresses.size() < from.size()
                          ? "expected TOPIC, TOPIC[NAME] or TOPIC:FIELD"
                          : MessageReaders::Definition(channel, source.definition);
    if (opening.why_not.empty()) source.openings.push_back(i);
  }
}

std::string LogSeries::TakeOpenings(const LogMessage& message, const Source& source) {
  for (const std::size_t i : source.openings) {
    LogOpening& opening = openings[i];
    if (opening.topic != message.channel.topic) continue;
    std::vector<double> numbers;
    std::optional<std::int64_t> stamp_ns;
    for (const BodyAddress& address : opening.addresses) {
      const bool ros1 = message.channel.message_encoding == "ros1";
      std::string why =
          DecodeBinaryNumber(source.definition, ros1, message.data, address, numbers, stamp_ns);
      if (!why.empty()) return why;
    }
    if (numbers.size() < opening.addresses.size()) continue;  // of other joints
    source.topic->lacks_times |= !stamp_ns;
    opening.numbers.insert_or_assign(TimeOf(message, stamp_ns), std::move(numbers));
    if (++poses_ > most_poses_) return "too many values of grips and joints";
  }
  return "";
}

std::int64_t LogSeries::TimeOf(const LogMessage& message,
                               std::optional<std::int64_t> stamp_ns) const {
  if (map_.mcap.clock == Clock::kHeader && stamp_ns) return *stamp_ns;
  return map_.mcap.clock == Clock::kPublish ? message.publish_ns : message.log_ns;
}

/// What the map says of it.
void LogSeries::Ask(const std::string& topic_name, LogTopic& topic) {
  topic.asked.clear();
  if (!topic.reader || topic.reader->bodies() == MessageReader::Bodies::kByName) return;
  const std::vector<PoseField>& fields = topic.reader->fields();
  topic.wanted.assign(fields.size(), topic.reader->bodies() == MessageReader::Bodies::kFrames);
  for (const Named<MappedEntity>& entity : map_.entities) {
    if (!entity.value.from || !IsOfTopic(entity.value.from->value, topic_name)) continue;
    AskedBody body{.from = entity.value.from->value, .address = {}, .links = {}};
    const auto address = ParseBodyAddress(std::string_view(body.from).substr(topic_name.size()));
    if (!address) continue;
    body.address = *address;
    for (const std::size_t field : FieldsOf(body.address, fields)) {
      body.links[field];
      topic.wanted[field] = true;
    }
    topic.asked.push_back(std::move(body));
  }
}

std::string LogSeries::TakeMessage(const LogMessage& message) {
  const Source& source = sources_.at(&message.channel);
  std::string why = source.openings.empty() ? "" : TakeOpenings(message, source);
  if (why.empty() && source.reader) why = TakePoses(message, source);
  if (why.empty()) return "";
  return fmt::format("a message of '{}', logged at {:.6f} s: {}",
                     ReadableName(message.channel.topic), InSeconds(message.log_ns), why);
}

std::string LogSeries::TakePoses(const LogMessage& message, const Source& source) {
  LogTopic& topic = *source.topic;
  const MessageReader::Bodies bodies = source.reader->bodies();
  const bool matters = bodies != MessageReader::Bodies::kOfTopic || !topic.asked.empty();
  if (!matters && (source.other_type || topic.looked_at > kMostLookedAt)) return "";
  if (source.other_type) return "the messages of this topic are of two types";
  ++messages_;
  std::vector<MessagePose> read;
  std::string why = source.reader->Decode(message.data, topic.wanted, read);
  if (!why.empty() && !matters) topic.looked_at = kMostLookedAt + 1;
  if (!why.empty()) return matters ? why : "";
  if (matters && map_.lost == Lost::kInRows && !message.channel.topic.ends_with("tf_static"))
    rows_ns.push_back(TimeOf(message, read.empty() ? std::nullopt : read.front().stamp_ns));
  for (const MessagePose& pose : read) {
    if (bodies == MessageReader::Bodies::kByName) {
      why = TakePose(message, pose, pose.name, named[pose.name]);
      if (!why.empty()) return why;
      continue;
    }
    if (bodies == MessageReader::Bodies::kFrames) {
      if (pose.name.empty()) return "a transform without 'child_frame_id'";
      why = TakePose(message, pose, pose.name, tree.links[FrameName(pose.name)]);
      if (!why.empty()) return why;
    }
    Look(pose, topic);
    why = TakeAsked(message, pose, topic);
    if (!why.empty()) return why;
  }
  if (tree.links.size() + named.size() > kMostSeries)
    return fmt::format("more than {} frames and bodies", kMostSeries);
  if (poses_ <= most_poses_) return "";
  return most_poses_ == kMostPoses ? fmt::format("more than {} poses", kMostPoses)
                                   : fmt::format("more than {} poses in a file of {} KiB",
                                                 most_poses_, file_bytes_ >> 10);
}

std::string LogSeries::TakeAsked(const LogMessage& message, const MessagePose& pose,
                                 LogTopic& topic) {
  for (AskedBody& body : topic.asked) {
    const auto found = body.links.find(pose.field);
    if (found == body.links.end() || body.address.keys != pose.keys) continue;
    topic.lacks_times = topic.lacks_times || !pose.stamp_ns;
    std::string why = TakePose(message, pose, body.from, found->second);
    if (!why.empty()) return why;
  }
  return "";
}

void LogSeries::Look(const MessagePose& pose, LogTopic& topic) {
  if (++topic.looked_at > kMostLookedAt || topic.seen.size() >= kMostSeen ||
      seen_ >= kMostSeenOfFile)
    return;
  seen_ += topic.seen.emplace(pose.field, pose.keys).second ? 1 : 0;
}

std::string LogSeries::TakePose(const LogMessage& message, const MessagePose& pose,
                                const std::string& name, FrameLink& link) {
  const bool fixed = message.channel.topic.ends_with("tf_static");
  const std::string frame = FrameName(pose.frame);
  if (link.poses.empty()) {
    link.parent = frame;
    link.fixed = fixed;
  } else if (link.parent != frame) {
    return fmt::format("'{}' is in the frame '{}', and before it was in '{}'", name, frame,
                       link.parent);
  }
  const std::int64_t ns = TimeOf(message, pose.stamp_ns);
  if (map_.mcap.clock == Clock::kHeader && pose.stamp_ns && ns == 0 && !fixed)
    return fmt::format(
        "'{}' has the time 0 in its header; if it has no clock, the map says mcap: {{clock: log}}",
        name);
  if (ns < 0 || ns > kLast_ns)
    return fmt::format("'{}' has the time {:.0f} s; expected one of the years 1970 to 2116", name,
                       static_cast<double>(static_cast<std::uint64_t>(ns)) * 1e-9);
  if (!link.poses.empty() && ns < link.poses.back().ns - kMostBack_ns)
    return fmt::format(
        "the times of '{}' go back from {:.6f} to {:.6f} s: its clock was set, or these are two "
        "recordings",
        name, InSeconds(link.poses.back().ns), InSeconds(ns));
  if (pose.missing || (map_.zero_is_missing && pose.p.isZero(0) && ++zeros > 0)) return "";
  if (!pose.p.allFinite() || !pose.xyzw.allFinite()) {
    if (nan_is_missing_) return "";
    return fmt::format(
        "'{}' has a pose that is no number; if that means 'not tracked', the map says missing: "
        "[nan]",
        name);
  }
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  if (pose.oriented) {
    const double length = pose.xyzw.norm();
    if (std::abs(length - 1) > kUnitTolerance)
      return fmt::format(
          "'{}': expected a unit quaternion, found one of length {:.4g}{}", name, length,
          pose.p.isZero(0)
              ? "; if a body at exactly 0, 0, 0 is not tracked, the map says zero_is_missing: true"
              : "");
    const Eigen::Vector4d& v = pose.xyzw;
    q = Eigen::Quaterniond(v[3], v[0], v[1], v[2]);
    if (order_ == QuaternionOrder::kWxyz) q = Eigen::Quaterniond(v[0], v[1], v[2], v[3]);
  }
  const TimedPose at{.ns = ns, .p = pose.p, .q = q.normalized()};
  const bool again = link.last_message == messages_ && (fixed || link.poses.back().ns == ns);
  link.last_message = messages_;
  if (again) {  // some drivers send two frames in a message
    const double apart_m = (link.poses.back().p - at.p).norm() * map_.MetresPerUnit();
    if (apart_m > kMostApart_m)
      return fmt::format("'{}' is in it twice, {:.2f} m apart", name, apart_m);
    link.poses.back() = at;
    ++link.repeats;
    return "";
  }
  link.poses.push_back(at);
  ++poses_;
  return "";
}

std::optional<std::int64_t> FrameLink::Sort() {
  std::ranges::stable_sort(poses, {}, &TimedPose::ns);
  std::optional<std::int64_t> contradiction;
  const auto is_again = [&](const TimedPose& a, const TimedPose& b) {
    if (a.ns != b.ns) return false;
    if (!fixed && ((a.p - b.p).norm() > 1e-6 || a.q.angularDistance(b.q) > 1e-4))
      contradiction = contradiction ? std::min(*contradiction, a.ns) : a.ns;
    return true;
  };
  poses.erase(std::unique(poses.begin(), poses.end(), is_again), poses.end());
  return contradiction;
}

std::int64_t FrameLink::UsualStep_ns() const {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].ns - poses[i - 1].ns);
  return Median(std::move(steps));
}

std::string FrameTree::RootOf(const std::string& frame) const {
  std::string root = frame;
  for (std::size_t depth = 0; depth <= links.size() && links.contains(root); ++depth)
    root = links.at(root).parent;
  return root;
}

std::vector<const FrameLink*> FrameTree::WayUp(const FrameLink& body) const {
  std::vector<const FrameLink*> way = {&body};
  while (way.size() <= links.size()) {
    const auto parent = links.find(way.back()->parent);
    if (parent == links.end()) break;
    way.push_back(&parent->second);
  }
  return way;
}

std::vector<TimedPose> FrameTree::InFrame(const FrameLink& body, const std::string& world,
                                          std::int64_t bridge_ns) const {
  std::vector<const FrameLink*> up = WayUp(body), from_world;
  if (const auto link = links.find(world); link != links.end()) from_world = WayUp(link->second);
  while (!up.empty() && !from_world.empty() && up.back() == from_world.back()) {
    up.pop_back();
    from_world.pop_back();
  }
  const FrameLink* fastest = nullptr;
  std::vector<LinkWalk> inner, outer;
  for (const auto* way : {&up, &from_world}) {
    for (const FrameLink* link : *way) {
      (way == &up ? inner : outer).emplace_back(*link, bridge_ns);
      if (!link->fixed && (!fastest || link->poses.size() > fastest->poses.size())) fastest = link;
    }
  }
  const auto at = [&](std::int64_t ns) -> std::optional<TimedPose> {
    std::optional<TimedPose> pose = Along(inner, ns);
    const std::optional<TimedPose> of_world = Along(outer, ns);
    if (!pose || !of_world) return std::nullopt;
    const Eigen::Quaterniond back = of_world->q.conjugate();
    pose->p = back * (pose->p - of_world->p);
    pose->q = (back * pose->q).normalized();
    return pose;
  };
  std::vector<TimedPose> poses;
  if (!fastest) {
    if (const std::optional<TimedPose> pose = at(0)) poses.push_back(*pose);
    return poses;
  }
  for (const TimedPose& sample : fastest->poses) {
    if (const std::optional<TimedPose> pose = at(sample.ns)) poses.push_back(*pose);
  }
  return poses;
}

}  // namespace prehend::exchange
