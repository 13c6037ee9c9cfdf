// SPDX-License-Identifier: Apache-2.0
// Files that nobody should have written: what the project has, damaged, and floods of one thing.
#pragma once

#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::fuzz {

/// What a file pretends to be; each has a command that reads it.
enum class Kind {
  kScenario,
  kGrammar,
  kGolden,
  kRecording,
  kPoses,  ///< of a tracker, as comma-separated values
  kBvh,
  kMcap,
  kPosesMap,  ///< what a file of poses means
  kEaf,
  kTextGrid,
  kBag
};
inline constexpr int kKinds = 11;

/// With the dot: ".yaml".
std::string EndingOf(Kind kind);

struct HostileFile {
  Kind kind = Kind::kScenario;
  std::string what;  ///< how it was made: "cut off, digits changed"
  std::string text;  ///< at most 1 MiB
};

class HostileFiles {
 public:
  /// `made` has texts of the kinds that are not in the source tree: recordings, logs, labels.
  HostileFiles(const std::filesystem::path& source, std::map<Kind, std::vector<std::string>> made,
               std::uint64_t seed);

  HostileFile Next();

 private:
  std::size_t Below(std::size_t limit) {
    return limit == 0 ? 0 : static_cast<std::size_t>(random_() % limit);
  }
  template <typename T>
  const T& OneOf(const std::vector<T>& from) {
    return from[Below(from.size())];
  }
  HostileFile Damaged(Kind kind);
  HostileFile Flood(Kind kind);
  HostileFile McapFlood(std::size_t many);
  HostileFile BagFlood(std::size_t many);
  std::string Damage(std::string& text, Kind kind);

  std::mt19937_64 random_;
  std::vector<std::string> seeds_[kKinds];
};

}  // namespace prehend::fuzz
