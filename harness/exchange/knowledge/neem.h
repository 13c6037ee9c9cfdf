// SPDX-License-Identifier: Apache-2.0
// An episode as the collections of a NEEM (narrative-enabled episodic memory): triples, tf and
// annotations as BSON, as mongodump writes them. Tested by
// tests/harness/exchange/knowledge/neem_test.cc
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/exchange/knowledge/triples.h"
#include "physics/base/pose.h"

namespace prehend::exchange {

/// Which classes and properties are below which.
class Hierarchy {
 public:
  void Add(const std::vector<Triple>& triples);
  /// The name itself, then everything above it.
  std::vector<std::string> Above(const std::string& name) const;

 private:
  std::map<std::string, std::set<std::string>> above_;
};

/// One document per statement: s, p, o, and p*, o* with what stands above p and o.
std::string TriplesBson(const std::vector<Triple>& triples, const Hierarchy& hierarchy);

/// One document per label or comment: s, p, string.
std::string AnnotationsBson(const std::vector<Triple>& triples);

/// A pose of an entity at a time, in the world.
struct Transform {
  std::int64_t milliseconds = 0;  ///< since 1970
  std::string entity;             ///< in full
  physics::Pose X_WE;
};
/// One document per transform: header (seq, stamp, frame_id), child_frame_id, transform.
std::string TransformsBson(const std::vector<Transform>& transforms);

}  // namespace prehend::exchange
