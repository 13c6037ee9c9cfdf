// SPDX-License-Identifier: Apache-2.0
// Which paths of JSON and arrays of .npz look like poses of bodies, by their names and by how many
// numbers they have: for a first map. Tested by tests/program/import_arrays.py
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/base/base/result.h"

namespace prehend::exchange {

struct FoundBody {
  std::string called;  ///< words of which its name can be made
  std::string position, rotation, pose;
  bool has_order = true;  ///< of its quaternion: which number is w is known

  std::string From() const { return position.empty() ? pose : position; }
  /// "position: .., rotation: ..", as a map has them.
  std::string Keys() const;
};

class FoundPoses {
 public:
  /// Numbers that are called `name`, of something called `owner`: "hand right", or "".
  void Add(const std::string& owner, const std::string& name, const std::string& path,
           std::size_t width, bool has_order);
  /// The time among names with values.
  void AddTime(const std::map<std::string, std::vector<std::string>>& values);

  std::string keys;  ///< "frames: .." and "t: ..", a line each
  bool needs_rate = true;
  std::vector<FoundBody> bodies;   ///< some have only a rotation
  std::vector<std::string> aside;  ///< what has as many numbers, and no such name
};

Result<FoundPoses> FindJsonPoses(const std::string& path);
Result<FoundPoses> FindNpzPoses(const std::string& path);

}  // namespace prehend::exchange
