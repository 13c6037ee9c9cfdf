// SPDX-License-Identifier: Apache-2.0
// Files that nobody should have written: what the project has, damaged, and floods of one thing.
#pragma once

#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::fuzz {

/// What a file pretends to be; each has a command that reads it.
enum class Kind { kScenario, kGrammar, kGolden, kRecording };
inline constexpr int kKinds = 4;

/// With the dot: ".yaml".
std::string EndingOf(Kind kind);

struct HostileFile {
  Kind kind = Kind::kScenario;
  std::string what;  ///< how it was made: "cut off, digits changed"
  std::string text;  ///< at most 1 MiB
};

class HostileFiles {
 public:
  /// `recordings` are texts; all else is taken from the source tree.
  HostileFiles(const std::filesystem::path& source, std::vector<std::string> recordings,
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
  std::string Damage(std::string& text, Kind kind);

  std::mt19937_64 random_;
  std::vector<std::string> seeds_[kKinds];
};

}  // namespace prehend::fuzz
