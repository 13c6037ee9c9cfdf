// SPDX-License-Identifier: Apache-2.0
// Poses of joints, from a BVH file: the skeleton's forward kinematics. Tested by
// tests/program/import_bvh_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/scenario/motion/read_bvh.h"

namespace prehend::exchange {
namespace {

/// A minute of 200 joints at 120 Hz is 40 MB.
constexpr scenario::BvhLimits kLimits = {.frames = 500'000, .bytes = std::size_t{256} << 20};

/// The joint whose name, in small letters, ends with one of these words; -1 if there is none.
int JointCalled(const scenario::BvhFile& bvh, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
      std::string name = bvh.joints[i].name;
      std::ranges::transform(name, name.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
      });
      if (name.ends_with(word)) return static_cast<int>(i);
    }
  }
  return -1;
}

/// From a foot to the head, halfway through the file.
std::optional<Eigen::Vector3d> StatureOf(const scenario::BvhFile& bvh) {
  const int head = JointCalled(bvh, {"head"}),
            foot = JointCalled(bvh, {"foot", "ankle", "foot.l", "foot_l"});
  if (head < 0 || foot < 0) return std::nullopt;
  const std::vector<scenario::JointPose> poses = scenario::JointPosesAt(bvh, bvh.rows.size() / 2);
  return poses[static_cast<std::size_t>(head)].p - poses[static_cast<std::size_t>(foot)].p;
}

}  // namespace

Result<PoseFile> ReadBvhPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(const scenario::BvhFile bvh, scenario::ReadBvh(path, kLimits));
  DiagnosticList errors(map.document);
  PoseFile poses{
      .file = path, .text = {}, .bodies = BodiesOf(map.map, errors), .unused = {}, .notes = {}};
  std::map<std::string, std::size_t> joints;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
    if (bvh.joints[i].name.empty()) continue;
    joints.emplace(bvh.joints[i].name, i);
    names.push_back(bvh.joints[i].name);
  }
  for (const Named<MappedEntity>& entity : map.map.entities) {
    const auto& from = entity.value.from;
    if (from && !joints.contains(from->value))
      errors.AddUnknownName(from->where, fmt::format("no joint is called '{}'", from->value),
                            from->value, names);
  }
  if (!errors.empty()) return tl::unexpected(errors.Sorted());

  if (map.map.is_draft) poses.unused = names;
  poses.stature = StatureOf(bvh);
  poses.rows = bvh.rows.size();
  poses.last_s = static_cast<double>(bvh.rows.size() - 1) * bvh.frame_time_s;
  for (std::size_t frame = 0; frame < bvh.rows.size(); ++frame) {
    const std::vector<scenario::JointPose> all = scenario::JointPosesAt(bvh, frame);
    for (PoseBody& body : poses.bodies) {
      const scenario::JointPose& joint = all[joints.at(body.name)];
      if (map.map.zero_is_missing && joint.p.isZero(0)) continue;
      body.samples.push_back({.t_s = static_cast<double>(frame) * bvh.frame_time_s,
                              .p = joint.p,
                              .q = joint.q,
                              .line = bvh.places[frame].line});
    }
  }
  RefuseAbsentBodies(poses, map.map, errors);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return poses;
}

}  // namespace prehend::exchange
