// SPDX-License-Identifier: Apache-2.0
// Poses of a log of messages, over time: of the bodies that a map asks for, of named bodies and of
// the frames of a tree that move over time (tf of ROS); and what else could be asked for. Tested by
// tests/program/import_messages_test.cc
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/exchange/messages/pose_fields.h"
#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

struct TimedPose {
  std::int64_t ns = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// A frame, or the body of a topic, in its parent.
struct FrameLink {
  std::string parent;
  bool fixed = false;              ///< known once, and for ever
  std::vector<TimedPose> poses;    ///< sorted by time, after Sort()
  std::size_t repeats = 0;         ///< messages in which it comes again: the last counts
  std::uint64_t last_message = 0;  ///< in which it has a pose

  /// Sorts, and drops what is said twice. Returns the time of two poses that differ, if there are.
  std::optional<std::int64_t> Sort();
  /// The usual time between two poses.
  std::int64_t UsualStep_ns() const;
};

class FrameTree {
 public:
  /// By the frame's name.
  std::map<std::string, FrameLink> links;

  /// The frame that has no parent. A ring ends somewhere in it.
  std::string RootOf(const std::string& frame) const;

  /// The body in `world`, which must have the same root, at the times of the fastest link between
  /// them. Of the others it is what lies between two poses at most `bridge_ns` (or their usual
  /// step, and half of that) apart; where there is none, there is no pose. One pose, at time 0, if
  /// nothing between them ever moves.
  std::vector<TimedPose> InFrame(const FrameLink& body, const std::string& world,
                                 std::int64_t bridge_ns) const;

 private:
  /// From the body up to its root.
  std::vector<const FrameLink*> WayUp(const FrameLink& body) const;
};

/// Topics of tf may begin their names with a slash, and mean the same.
std::string FrameName(std::string name);

/// What a map says of a topic: "/frame[Cup]".
struct AskedBody {
  std::string from;
  BodyAddress address;
  std::map<std::size_t, FrameLink> links;  ///< of each field that it can mean
};

struct LogTopic {
  std::shared_ptr<const MessageReader> reader;  ///< null: it is not read, and
  std::string why_not;
  std::vector<AskedBody> asked;
  bool of_frames = false;    ///< its type is that of tf
  std::vector<bool> wanted;  ///< which of its fields are asked for
  /// Fields and keys of bodies, not all of very many.
  std::set<std::pair<std::size_t, std::vector<std::string>>> seen;
  std::size_t looked_at = 0;  ///< poses
  bool lacks_times = false;   ///< of what was asked for

  /// Bodies that could be asked for, as a map names them; positions only if there are no poses.
  std::vector<std::string> Names(const std::string& topic, bool unasked_only) const;
};

class LogSeries {
 public:
  /// `most_poses`: in a file of this size.
  LogSeries(const ImportMap& map, std::uint64_t file_bytes);

  void TakeChannel(const LogChannel& channel);
  /// Returns what is wrong with the message, or "".
  std::string TakeMessage(const LogMessage& message);

  QuaternionOrder quaternion_order() const { return order_; }

  /// Grips and joints of the map: what messages say of them, with their times.
  struct LogOpening {
    std::string topic;
    std::vector<BodyAddress> addresses;  ///< in it, of each `from`
    std::string why_not;                 ///< its messages are not read
    std::map<std::int64_t, std::vector<double>> numbers;
  };
  std::vector<LogOpening> openings;  ///< of OpeningsOf()

  std::map<std::string, LogTopic> topics;
  std::map<std::string, FrameLink> named;  ///< bodies with names of their own
  FrameTree tree;
  std::vector<std::int64_t> rows_ns;  ///< as in PoseFile
  std::size_t zeros = 0;              ///< as in PoseFile

 private:
  struct Source {
    std::shared_ptr<const MessageReader> reader;
    LogTopic* topic = nullptr;
    bool other_type = false;  ///< than the topic's first channel
    std::vector<std::size_t> openings;
    MessageDefinition definition;  ///< if there are some
  };

  std::string TakePoses(const LogMessage& message, const Source& source);
  void Ask(const std::string& topic_name, LogTopic& topic);
  /// The time of a message that counts.
  std::int64_t TimeOf(const LogMessage& message, std::optional<std::int64_t> stamp_ns) const;
  void AskOpenings(const LogChannel& channel, Source& source);
  std::string TakeOpenings(const LogMessage& message, const Source& source);
  void Look(const MessagePose& pose, LogTopic& topic);
  std::string TakeAsked(const LogMessage& message, const MessagePose& pose, LogTopic& topic);
  std::string TakePose(const LogMessage& message, const MessagePose& pose, const std::string& name,
                       FrameLink& link);

  const ImportMap& map_;
  const QuaternionOrder order_;
  const std::uint64_t file_bytes_, most_poses_;
  const bool nan_is_missing_;
  MessageReaders readers_;
  std::map<const LogChannel*, Source> sources_;
  std::uint64_t poses_ = 0, messages_ = 0;
  std::size_t seen_ = 0;
};

/// Topics of poses, and coordinate frames of a tree of transforms, each a body.
Result<PoseFile> ReadMcapPoses(const std::string& path, const MapFile& map);

}  // namespace prehend::exchange
