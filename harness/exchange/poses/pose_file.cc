// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/pose_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace prehend::exchange {

std::vector<PoseBody> BodiesOf(const ImportMap& map, DiagnosticList& errors) {
  std::vector<PoseBody> bodies;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    const std::string& name = entity.value.from->value;
    if (std::ranges::find(bodies, name, &PoseBody::name) != bodies.end())
      errors.Add(entity.value.from->where, fmt::format("'{}' is two entities", name));
    else
      bodies.push_back({.name = name, .samples = {}});
  }
  return bodies;
}

std::vector<OpeningSeries> OpeningsOf(const ImportMap& map) {
  std::vector<OpeningSeries> openings;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    for (const bool is_grip : {true, false}) {
      const MappedEntity& e = map.entities[i].value;
      if (is_grip ? e.grip : e.joint) openings.push_back({.entity = i, .is_grip = is_grip});
    }
  }
  return openings;
}

const Opening& OpeningSeries::Of(const ImportMap& map) const {
  const MappedEntity& e = map.entities[entity].value;
  return is_grip ? *e.grip : *e.joint;
}

void RefuseAbsentBodies(const PoseFile& poses, const ImportMap& map, DiagnosticList& errors) {
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    const Located<std::string>& from = *entity.value.from;
    const std::size_t count =
        std::ranges::find(poses.bodies, from.value, &PoseBody::name)->samples.size();
    if (count >= 2) continue;
    errors.AddUnknownName(
        from.where,
        fmt::format("'{}' has {} poses in the file; at least 2 are needed", from.value, count),
        from.value, poses.unused);
  }
}

void MirrorPoses(const ImportMap& map, PoseFile& poses) {
  for (PoseBody& body : poses.bodies) {
    for (PoseSample& sample : body.samples) {
      sample.p = map.Mirrored(sample.p);
      // Turns are the other way round, but for the part about the mirror's own axis.
      sample.q.vec() = -map.Mirrored(sample.q.vec());
    }
  }
  if (poses.stature) poses.stature = map.Mirrored(*poses.stature);
}

}  // namespace prehend::exchange
