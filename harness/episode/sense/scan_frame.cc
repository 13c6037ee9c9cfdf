// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "harness/episode/sense/episode_format.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kLongestName = 64;
// What may be farther off from a unit is judged by the field tables.
constexpr double kUnitTolerance = 0.0099;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Follows the text; each function is false where it finds something else.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool AtEnd() {
    SkipSpace();
    return at_ == end_;
  }

  bool Take(char c) {
    SkipSpace();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  /// In quotes; letters, digits and underscores, no digit first.
  bool Name(std::string_view& name) {
    if (!Take('"')) return false;
    const char* const begin = at_;
    while (at_ != end_ && (IsDigit(*at_) || (*at_ >= 'a' && *at_ <= 'z') ||
                           (*at_ >= 'A' && *at_ <= 'Z') || *at_ == '_'))
      ++at_;
    name = {begin, static_cast<std::size_t>(at_ - begin)};
    return at_ != end_ && *at_++ == '"' && !name.empty() && !IsDigit(name.front()) &&
           name.size() <= kLongestName;
  }

  bool Integer(std::int64_t lowest, std::int64_t highest, std::int64_t& value) {
    SkipSpace();
    const char* const begin = at_;
    if (!SkipWhole()) return false;
    const bool goes_on = at_ != end_ && (*at_ == '.' || *at_ == 'e' || *at_ == 'E');
    return !goes_on && std::from_chars(begin, at_, value).ec == std::errc() && value >= lowest &&
           value <= highest;
  }

  /// As JSON writes it.
  bool Number(double lowest, double highest, double& value) {
    SkipSpace();
    const char* const begin = at_;
    if (!SkipWhole()) return false;
    if (at_ != end_ && *at_ == '.') {
      ++at_;
      if (!SkipDigits()) return false;
    }
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      ++at_;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      if (!SkipDigits()) return false;
    }
    const auto [end, error] = std::from_chars(begin, at_, value);
    return error == std::errc() && end == at_ && value >= lowest && value <= highest;
  }

  template <int N>
  bool Vector(double lowest, double highest, Eigen::Matrix<double, N, 1>& value) {
    if (!Take('[')) return false;
    for (int i = 0; i < N; ++i) {
      if ((i > 0 && !Take(',')) || !Number(lowest, highest, value[i])) return false;
    }
    return Take(']');
  }

  /// `{"key": value, ..}`; read(key) reads a value.
  template <typename Read>
  bool Mapping(const Read& read) {
    if (!Take('{')) return false;
    if (Take('}')) return true;
    std::string_view key;
    do {
      if (!Name(key) || !Take(':') || !read(key)) return false;
    } while (Take(','));
    return Take('}');
  }

 private:
  void SkipSpace() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }
  bool SkipDigits() {
    const char* const begin = at_;
    while (at_ != end_ && IsDigit(*at_)) ++at_;
    return at_ != begin;
  }
  // Perhaps a minus, and digits without a leading zero.
  bool SkipWhole() {
    if (at_ != end_ && *at_ == '-') ++at_;
    const char* const begin = at_;
    return SkipDigits() && (*begin != '0' || at_ == begin + 1);
  }

  const char* at_;
  const char* end_;
};

/// A key that is given twice is a mistake.
bool IsNew(unsigned key, unsigned& seen) {
  const bool is_new = (seen >> key & 1) == 0;
  seen |= 1U << key;
  return is_new;
}

bool ScanSample(Scanner& scanner, SampleEntry& sample) {
  sample = {};
  unsigned seen = 0;
  const bool all = scanner.Mapping([&](std::string_view key) {
    if (key == "at_m")
      return IsNew(0, seen) && scanner.Vector<3>(-kMaxPosition_m, kMaxPosition_m, sample.at_m);
    if (key == "quat_wxyz") {
      Eigen::Vector4d& q = sample.quat_wxyz.emplace().value;
      return IsNew(1, seen) && scanner.Vector<4>(-1, 1, q) &&
             std::abs(q.norm() - 1) <= kUnitTolerance;
    }
    if (key == "v_m_per_s")
      return IsNew(2, seen) &&
             scanner.Vector<3>(-kMaxVelocity, kMaxVelocity, sample.v_m_per_s.emplace());
    if (key == "w_rad_per_s")
      return IsNew(3, seen) &&
             scanner.Vector<3>(-kMaxVelocity, kMaxVelocity, sample.w_rad_per_s.emplace());
    return false;
  });
  return all && (seen & 1) != 0;
}

bool ScanHand(Scanner& scanner, HandEntry& hand) {
  hand.trigger = 0;
  hand.ahead.reset();
  hand.style.reset();
  hand.collision_spheres_m.clear();
  unsigned seen = 0;
  return scanner.Mapping([&](std::string_view key) {
    if (key == "trigger") return IsNew(0, seen) && scanner.Number(0, 1, hand.trigger);
    if (key == "ahead")
      return IsNew(1, seen) && scanner.Vector<3>(-1, 1, hand.ahead.emplace()) &&
             !hand.ahead->isZero();
    if (key != "collision_spheres_m" || !IsNew(2, seen) || !scanner.Take('[')) return false;
    do {
      Eigen::Vector4d& sphere = hand.collision_spheres_m.emplace_back();
      if (!scanner.Vector<4>(-kMaxPosition_m, kMaxPosition_m, sphere) || sphere[3] < 0)
        return false;
    } while (scanner.Take(','));
    return scanner.Take(']') && hand.collision_spheres_m.size() <= kMaxCollisionSpheres;
  });
}

/// Entries by name, each once.
template <typename Entry, typename Scan>
bool ScanNamed(Scanner& scanner, std::vector<Named<Entry>>& entries, const Scan& scan) {
  std::size_t count = 0;
  const bool all = scanner.Mapping([&](std::string_view name) {
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find_if(entries.begin(), end, [&](const auto& entry) { return entry.name == name; }) !=
        end)
      return false;
    if (count == entries.size()) entries.emplace_back();
    entries[count].name.assign(name);
    return scan(scanner, entries[count++].value);
  });
  entries.resize(count);
  return all;
}

}  // namespace

bool ScanFrame(std::string_view line, FrameEntry& frame) {
  Scanner scanner(line);
  unsigned seen = 0;
  const bool all = scanner.Mapping([&](std::string_view key) {
    if (key == "tick")
      return IsNew(0, seen) && scanner.Integer(-kLatestTick, kLatestTick, frame.tick.value);
    if (key == "samples") return IsNew(1, seen) && ScanNamed(scanner, frame.samples, ScanSample);
    if (key == "hands") return IsNew(2, seen) && ScanNamed(scanner, frame.hands, ScanHand);
    return key == "touches" && IsNew(3, seen) && scanner.Take('[') && scanner.Take(']');
  });
  if ((seen >> 1 & 1) == 0) frame.samples.clear();
  if ((seen >> 2 & 1) == 0) frame.hands.clear();
  frame.touches.clear();
  return all && (seen & 1) != 0 && scanner.AtEnd();
}

}  // namespace prehend::episode
