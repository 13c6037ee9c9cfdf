// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/motion/body_motion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "harness/base/base/median.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::Posture;

/// The joints that are needed; of pairs the right one comes first.
enum Role {
  kHead,
  kShoulder,
  kElbow = kShoulder + 2,
  kWrist = kElbow + 2,
  kHip = kWrist + 2,
  kKnee = kHip + 2,
  kAnkle = kKnee + 2,
  kRoles = kAnkle + 2
};

struct RoleNames {
  const char* called;              ///< in messages
  std::vector<std::string> names;  ///< the first that the file has is used
};

/// The names without their side; the best known conventions. "Shoulder" is the collar bone in files
/// that have an "Arm", so it comes last; likewise "Hip".
const std::map<Role, RoleNames>& NamesOfRoles() {
  static const std::map<Role, RoleNames> names = {
      {kHead, {"head", {"head"}}},
      {kShoulder, {"shoulder", {"arm", "upperarm", "uparm", "shldr", "shoulder"}}},
      {kElbow, {"elbow", {"forearm", "lowerarm", "lowarm", "elbow"}}},
      {kWrist, {"wrist", {"hand", "wrist"}}},
      {kHip, {"hip", {"upleg", "upperleg", "thigh", "hip"}}},
      {kKnee, {"knee", {"leg", "lowerleg", "lowleg", "shin", "calf", "knee"}}},
      {kAnkle, {"ankle", {"foot", "ankle"}}}};
  return names;
}

/// Without a prefix like "mixamorig:", in small letters, letters and digits only.
std::string Plain(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  std::string plain;
  for (const char c : name.substr(colon == std::string::npos ? 0 : colon + 1)) {
    if (c >= 'A' && c <= 'Z') plain += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) plain += c;
  }
  return plain.starts_with("mixamorig") ? plain.substr(9) : plain;
}

/// How the right or left part of this name is written: rightfoot, rfoot, footright, footr.
std::vector<std::string> Sided(const std::string& name, bool right) {
  const std::string word = right ? "right" : "left", letter = right ? "r" : "l";
  return {word + name, letter + name, name + word, name + letter};
}

/// From BVH's axes (x left, y up, z ahead) to ours.
Vector3d ToOurAxes(const Vector3d& p) { return {p.z(), p.x(), p.y()}; }

constexpr const char* kNamesHint =
    "like RightUpLeg, rThigh, thigh.R or mixamorig:RightUpLeg; see docs/recorded-input.md";

class TrackMaker {
 public:
  explicit TrackMaker(const BvhFile& bvh) : bvh_(bvh) {}

  void Make() {
    FindRoles();
    if (!diagnostics.empty()) return;
    FindRest();
    if (!diagnostics.empty()) return;
    for (std::size_t i = 0; i < bvh_.rows.size(); ++i) track.samples.push_back(SampleOf(i));
    track.file = bvh_.file;
    track.text = bvh_.text;
  }

  BodyTrack track;
  grammar::Diagnostics diagnostics;

 private:
  void Complain(std::string message, std::string hint) {
    diagnostics.push_back(grammar::DiagnosticAt(bvh_.file, bvh_.text, bvh_.joints.front().place,
                                                std::move(message), std::move(hint)));
  }

  void FindRoles() {
    std::map<std::string, int> joints;  // the first of that name
    for (std::size_t i = 0; i < bvh_.joints.size(); ++i)
      joints.emplace(Plain(bvh_.joints[i].name), static_cast<int>(i));
    roles_.fill(-1);
    for (const auto& [role, wanted] : NamesOfRoles()) {
      if (role == kHead) {
        roles_[role] = Find(wanted.names, joints);
        if (roles_[role] < 0) Complain("no joint is called Head", kNamesHint);
        continue;
      }
      for (const bool right : {true, false}) {
        std::vector<std::string> sided;
        for (const std::string& name : wanted.names) {
          const std::vector<std::string> ways = Sided(name, right);
          sided.insert(sided.end(), ways.begin(), ways.end());
        }
        int& joint = roles_[static_cast<std::size_t>(role) + (right ? 0 : 1)];
        joint = Find(sided, joints);
        if (joint >= 0) continue;
        const char* side = right ? "right" : "left";
        Complain(fmt::format("no joint is a person's {} {}: expected '{}' with one of {}", side,
                             wanted.called, side, fmt::join(wanted.names, ", ")),
                 kNamesHint);
      }
    }
  }

  /// The index of the first of these names that exists; -1: none.
  static int Find(const std::vector<std::string>& names, const std::map<std::string, int>& joints) {
    for (const std::string& name : names) {
      if (const auto found = joints.find(name); found != joints.end()) return found->second;
    }
    return -1;
  }

  /// The person with all joints at 0.
  void FindRest() {
    std::vector<Vector3d> places;
    for (const BvhJoint& joint : bvh_.joints) {
      const Vector3d parent =
          joint.parent < 0 ? Vector3d::Zero() : places[static_cast<std::size_t>(joint.parent)];
      places.push_back(parent + joint.offset);
    }
    const auto at = [&](int role) {
      return places[static_cast<std::size_t>(roles_[static_cast<std::size_t>(role)])];
    };
    Vector3d left = at(kHip + 1) - at(kHip);
    left.y() = 0;
    for (const bool right : {true, false}) {
      const int side = right ? 0 : 1;
      track.leg_units += ((at(kKnee + side) - at(kHip + side)).norm() +
                          (at(kAnkle + side) - at(kKnee + side)).norm()) /
                         2;
    }
    if (left.norm() < 1e-9 || track.leg_units < 1e-9)
      return Complain("the offsets put both hips, or hips and ankles, at the same point",
                      "the hierarchy's offsets are the person's bones");
    ahead_ = left.normalized().cross(Vector3d::UnitY());
  }

  BodySample SampleOf(std::size_t frame) const {
    const std::vector<JointPose> poses = JointPosesAt(bvh_, frame);
    const auto pose = [&](int role) -> const JointPose& {
      return poses[static_cast<std::size_t>(roles_[static_cast<std::size_t>(role)])];
    };
    const auto middle = [&](int role) { return Vector3d((pose(role).p + pose(role + 1).p) / 2); };
    // Joints at the same point have no direction; the one of the rest pose is used.
    const auto way = [&](const Vector3d& from, const Vector3d& to, const Vector3d& otherwise) {
      const Vector3d d = to - from;
      return ToOurAxes(d.norm() > 1e-9 ? Vector3d(d.normalized()) : otherwise);
    };
    const Vector3d hips = middle(kHip), shoulders = middle(kShoulder);
    const Vector3d up = Vector3d::UnitY(), left = up.cross(ahead_);

    BodySample sample{.t_s = static_cast<double>(frame) * bvh_.frame_time_s,
                      .place = bvh_.places[frame]};
    sample.posture.hips_W_m = ToOurAxes(hips);
    auto& directions = sample.posture.directions_W;
    directions[Posture::kTrunk] = way(hips, shoulders, up);
    directions[Posture::kNeck] = way(shoulders, pose(kHead).p, up);
    directions[Posture::kFace] = ToOurAxes(pose(kHead).q * ahead_);
    directions[Posture::kCrown] = ToOurAxes(pose(kHead).q * up);
    directions[Posture::kAcrossHips] = way(pose(kHip).p, pose(kHip + 1).p, left);
    directions[Posture::kAcrossShoulders] = way(pose(kShoulder).p, pose(kShoulder + 1).p, left);
    for (int side = 0; side < 2; ++side) {
      const auto at = static_cast<std::size_t>(side);
      directions[Posture::kUpperArm + at] =
          way(pose(kShoulder + side).p, pose(kElbow + side).p, -up);
      directions[Posture::kForearm + at] = way(pose(kElbow + side).p, pose(kWrist + side).p, -up);
      directions[Posture::kHand + at] = HandDirection(side, pose(kWrist + side).q);
      directions[Posture::kThigh + at] = way(pose(kHip + side).p, pose(kKnee + side).p, -up);
      directions[Posture::kShank + at] = way(pose(kKnee + side).p, pose(kAnkle + side).p, -up);
      directions[Posture::kFoot + at] = ToOurAxes(pose(kAnkle + side).q * ahead_);
      directions[Posture::kSole + at] = ToOurAxes(pose(kAnkle + side).q * -up);
    }
    sample.points = {sample.posture.hips_W_m, ToOurAxes(pose(kWrist).p),
                     ToOurAxes(pose(kWrist + 1).p), ToOurAxes(pose(kAnkle).p),
                     ToOurAxes(pose(kAnkle + 1).p)};
    return sample;
  }

  /// At rest the hand continues the direction of the forearm.
  Vector3d HandDirection(int side, const Eigen::Quaterniond& q) const {
    const auto wrist = static_cast<std::size_t>(roles_[static_cast<std::size_t>(kWrist + side)]);
    const Vector3d& offset = bvh_.joints[wrist].offset;
    return ToOurAxes(q *
                     (offset.norm() > 1e-9 ? Vector3d(offset.normalized()) : -Vector3d::UnitY()));
  }

  const BvhFile& bvh_;
  std::array<int, kRoles> roles_{};     ///< indices of joints
  Vector3d ahead_ = Vector3d::UnitZ();  ///< where the person looks with all joints at 0
};

// Tested by tests/harness/scenario/motion/hand_motion_test.cc

/// An uneven rate is not a gap, nor is a single missing sample at 90 Hz.
constexpr double kMinGap_s = 0.05;
constexpr double kGapOfMedian = 4;
/// Hands are slower than this, and noise moves them less far.
constexpr double kJumpSpeed_m_per_s = 8;
constexpr double kMinJump_m = 0.03;
constexpr std::size_t kMaxReported = 12;

double MedianInterval(const std::vector<TrackSample>& samples) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals.push_back(samples[i].t_s - samples[i - 1].t_s);
  return Median(std::move(intervals));
}

class TrackChecker {
 public:
  TrackChecker(const MotionTrack& track, const TrackLimits& limits)
      : track_(track), limits_(limits) {}

  grammar::Diagnostics Check() {
    const double usual_s = MedianInterval(track_.samples);
    if (usual_s > limits_.gap_s) {
      Add(track_.samples[1], false,
          fmt::format("samples are typically {:.3f} s apart; gaps of at most {} s are bridged",
                      usual_s, limits_.gap_s),
          "milliseconds need a column t_ms; otherwise raise max_gap_s");
      return std::move(found_);
    }
    const double gap_s = std::max(kMinGap_s, kGapOfMedian * usual_s);
    for (std::size_t i = 1; i < track_.samples.size(); ++i) {
      const TrackSample &before = track_.samples[i - 1], &sample = track_.samples[i];
      const double dt_s = sample.t_s - before.t_s;
      const double way_m = (sample.X_RD.p_m - before.X_RD.p_m).norm();
      if (dt_s > limits_.gap_s) {
        Add(sample, false,
            fmt::format("gap: no sample for {:.3f} s before this one, at {:.3f} s; at most {} s "
                        "are bridged",
                        dt_s, sample.t_s, limits_.gap_s),
            "cut the recording with from_s and to_s, or raise max_gap_s");
      } else if (dt_s > gap_s) {
        Add(sample, true,
            fmt::format("gap: no sample for {:.3f} s before this one, at {:.3f} s; it is bridged",
                        dt_s, sample.t_s));
      }
      if (way_m <= kMinJump_m || way_m <= kJumpSpeed_m_per_s * dt_s) continue;
      const std::string jump =
          fmt::format("jump: {:.3f} m within {:.3f} s, at {:.3f} s", way_m, dt_s, sample.t_s);
      if (way_m > limits_.jump_m) {
        Add(sample, false, jump + fmt::format("; at most {} m are followed", limits_.jump_m),
            "cut the recording with from_s and to_s, or raise max_jump_m");
      } else {
        Add(sample, true, jump);
      }
    }
    return std::move(found_);
  }

 private:
  void Add(const TrackSample& sample, bool is_warning, std::string message, std::string hint = {}) {
    if (found_.size() == kMaxReported) return;
    found_.push_back(grammar::DiagnosticAt(track_.file, track_.text, sample.place,
                                           std::move(message), std::move(hint)));
    found_.back().is_warning = is_warning;
  }

  const MotionTrack& track_;
  const TrackLimits& limits_;
  grammar::Diagnostics found_;
};

}  // namespace

Result<BodyTrack> ReadBodyTrack(const std::string& path) {
  PREHEND_TRY(BvhFile bvh, ReadBvh(path));
  TrackMaker maker(bvh);
  maker.Make();
  if (!maker.diagnostics.empty()) return tl::unexpected(std::move(maker.diagnostics));
  return std::move(maker.track);
}

grammar::Diagnostics CheckTrack(const MotionTrack& track, const TrackLimits& limits) {
  return TrackChecker(track, limits).Check();
}

}  // namespace prehend::scenario
