// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/lengths.h.
#include "harness/exchange/import/lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace prehend::exchange {
namespace {

constexpr double kHandsWidth_m = 0.15;  ///< where all hands together stay
constexpr double kMoves_m = 0.002;
constexpr double kLeastReach_m = 0.3, kMostReach_m = 3;  ///< of hands that work
constexpr double kMostSize_m = 3;                        ///< of what is moved

}  // namespace

Eigen::AlignedBox3d ExtentOf(const PoseFile& poses, const ImportMap& map, bool of_hands_only) {
  Eigen::AlignedBox3d extent;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from || (of_hands_only && !entity.value.hand)) continue;
    const auto& name = entity.value.from->value;
    for (const PoseSample& sample : std::ranges::find(poses.bodies, name, &PoseBody::name)->samples)
      extent.extend(sample.p * map.MetresPerUnit());
  }
  return extent;
}

std::optional<SmallRange> RangeTooSmall(const PoseFile& poses, const ImportMap& map) {
  const Eigen::AlignedBox3d hands = ExtentOf(poses, map, true), all = ExtentOf(poses, map, false);
  if (poses.bodies.size() < 2 || hands.isEmpty()) return std::nullopt;
  const double hands_m = hands.diagonal().norm(), all_m = all.diagonal().norm();
  if (hands_m >= kHandsWidth_m || hands_m < kMoves_m || hands_m < all_m / 2) return std::nullopt;
  SmallRange range{.text = fmt::format("all hands together stay within {:.2g} m, and all that is "
                                       "tracked within {:.2g} m",
                                       hands_m, all_m),
                   .remedy = "correct unit"};
  constexpr std::array<std::pair<const char*, double>, 3> kUnits = {
      {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}}};
  for (const auto& [unit, scale] : kUnits) {
    const double would_m = hands_m / map.MetresPerUnit() * scale;
    if (would_m < kLeastReach_m || would_m > kMostReach_m) continue;
    range.text += fmt::format("; in {} it would be {:.2g} m", unit, would_m);
    range.remedy = fmt::format("unit: {}", unit);
    break;
  }
  return range;
}

TooLarge ThingsTooLarge(const ImportMap& map) {
  TooLarge large;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    const MappedEntity& e = map.entities[i].value;
    const Eigen::Vector3d& size = e.size_m;
    if (!e.from || e.fixed || size.maxCoeff() <= kMostSize_m) continue;
    const double factor = size.maxCoeff() / 100 <= kMostSize_m ? 100 : 1000;
    large.things.insert(i);
    large.warnings.push_back(fmt::format(
        "'{}' is {:g} x {:g} x {:g} m large, and size_m is in metres; if these are {}: size_m: "
        "[{:g}, {:g}, {:g}]",
        map.entities[i].name, size.x(), size.y(), size.z(),
        factor == 100 ? "centimetres" : "millimetres", size.x() / factor, size.y() / factor,
        size.z() / factor));
  }
  return large;
}

}  // namespace prehend::exchange
