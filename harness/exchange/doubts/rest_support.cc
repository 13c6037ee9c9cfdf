// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/doubts/rest_poses.h.
//
// The lowest point of the box of what rests must be near the top of another box that it is above.
// Half of the times are enough: a hand may hold it still for a while.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/exchange/doubts/motion_seen.h"
#include "harness/exchange/doubts/rest_poses.h"

namespace prehend::exchange {
namespace {

constexpr double kOnTop_m = 0.08;  ///< lie_about of grammar/library/support_from_motion.grammar
constexpr double kHigh_m = 1.6;
constexpr double kTableHigh_m = 0.75, kMovesThere_m = 0.03;
constexpr double kOffTop_m = 0.015;
constexpr double kGrips_m = 0.1;  ///< farther off its box, a hand that moves does not hold it
constexpr double kLeast_s = 1;    ///< a shorter rest says nothing

Eigen::AlignedBox3d BoxOf(const grammar::EntityInfo& entity, const grammar::EntitySample& look) {
  const Eigen::Vector3d half = look.q_WB.toRotationMatrix().cwiseAbs() * entity.half_size_m;
  return {look.p_WB_m - half, look.p_WB_m + half};
}

bool IsAbove(const Eigen::AlignedBox3d& upper, const Eigen::AlignedBox3d& lower) {
  return (upper.min().head<2>().array() < lower.max().head<2>().array()).all() &&
         (lower.min().head<2>().array() < upper.max().head<2>().array()).all();
}

bool IsMovable(const grammar::EntityInfo& entity) {
  return std::ranges::find(entity.classes, "Movable") != entity.classes.end();
}

/// Without "-0.0".
double Tenths(double x) { return std::round(10 * x) / 10 + 0.0; }

/// Where one thing rested, looked at once per kBetweenLooks_s.
struct RestPoses {
  std::vector<double> bottoms_m;  ///< of all rests
  std::size_t supported = 0;      ///< on how many of them something was near below
  std::vector<double> off_m;      ///< how far over what is fixed it was, of those
  std::size_t off = 0;            ///< the last such entity
  Eigen::AlignedBox2d place;
};

/// A hand could hold it: it is in reach, and did not come from `last` to `frame`, or go. Of a hand
/// that is lost nobody knows.
bool IsHeld(const std::vector<grammar::EntityInfo>& entities, const episode::EpisodeFrame& last,
            const episode::EpisodeFrame& frame, const Eigen::AlignedBox3d& box) {
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (entities[i].classes.front() != "Hand") continue;
    const Eigen::Vector3d &was_m = last.entities[i].p_WB_m, &is_m = frame.entities[i].p_WB_m;
    const double was_off_m = box.exteriorDistance(was_m), off_m = box.exteriorDistance(is_m);
    const bool passes = (is_m - was_m).norm() > kMoves_m_per_s * kBetweenLooks_s &&
                        std::max(was_off_m, off_m) > kGrips_m;
    if (!(off_m > kHandReach_m) && !passes) return true;
  }
  return false;
}

RestPoses RestPosesOf(const episode::Recording& episode, std::size_t thing) {
  RestPoses rests;
  const auto& entities = episode.header.entity_table.entities;
  EachLook(episode, [&](const episode::EpisodeFrame& last, const episode::EpisodeFrame& frame) {
    const grammar::EntitySample& look = frame.entities[thing];
    if (!grammar::IsTracked(look) ||
        !((look.p_WB_m - last.entities[thing].p_WB_m).norm() < kSamePlace_m))
      return;
    const Eigen::AlignedBox3d box = BoxOf(entities[thing], look);
    if (IsHeld(entities, last, frame, box)) return;
    rests.bottoms_m.push_back(box.min().z());
    rests.place.extend(Eigen::AlignedBox2d(box.min().head<2>(), box.max().head<2>()));
    std::optional<std::size_t> on;  // the one with the nearest top
    double off_m = 0;
    for (std::size_t other = 0; other < entities.size(); ++other) {
      if (other == thing || entities[other].classes.front() == "Hand" ||
          !grammar::IsTracked(frame.entities[other]))
        continue;
      const Eigen::AlignedBox3d below = BoxOf(entities[other], frame.entities[other]);
      double above_m = box.min().z() - below.max().z();
      // Or it is in a bowl, of which only the box is known.
      const bool inside = below.contains(box.center());
      if (!IsAbove(box, below) || (std::abs(above_m) > kOnTop_m && !inside)) continue;
      if (inside && box.min().z() >= below.min().z()) above_m = 0;  // and does not jut out of it
      if (on && std::abs(above_m) >= std::abs(off_m)) continue;
      on = other;
      off_m = above_m;
    }
    if (!on) return;
    ++rests.supported;
    if (std::abs(off_m) <= kOffTop_m || IsMovable(entities[*on])) return;
    rests.off_m.push_back(off_m);
    rests.off = *on;
  });
  return rests;
}

/// Whether something moves in the unit in which this would be the height of a table. Else only the
/// origin is far.
bool MovesInUnitOfTable(const episode::Recording& episode, double height_m) {
  const auto& entities = episode.header.entity_table.entities;
  Eigen::AlignedBox3d extent;
  for (const episode::EpisodeFrame& frame : episode.frames)
    for (std::size_t i = 0; i < entities.size(); ++i)
      if (IsMovable(entities[i]) || entities[i].classes.front() == "Hand")
        if (grammar::IsTracked(frame.entities[i])) extent.extend(frame.entities[i].p_WB_m);
  return extent.diagonal().norm() * kTableHigh_m / height_m > kMovesThere_m;
}

}  // namespace

std::vector<std::string> RestOddly(const episode::Recording& episode,
                                   const std::set<std::size_t>& untrue) {
  const auto& entities = episode.header.entity_table.entities;
  std::vector<std::string> names, lines;
  std::vector<double> bottoms_m;
  Eigen::AlignedBox2d place;
  double lowest_top_m = std::numeric_limits<double>::infinity();  // of what does not move
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (entities[i].classes.front() == "Hand") continue;
    if (!IsMovable(entities[i]))
      lowest_top_m =
          std::min(lowest_top_m, BoxOf(entities[i], episode.frames.front().entities[i]).max().z());
    if (untrue.contains(i) || !IsMovable(entities[i])) continue;
    const RestPoses rests = RestPosesOf(episode, i);
    if (static_cast<double>(rests.bottoms_m.size()) * kBetweenLooks_s < kLeast_s) continue;
    if (2 * rests.off_m.size() > rests.bottoms_m.size())
      lines.push_back(
          fmt::format("'{0}' rests {1:.0f} mm {2} '{3}': is at_m or size_m of '{3}', or offset_m "
                      "or size_m of '{0}' wrong?",
                      entities[i].name, 1e3 * std::abs(Median(rests.off_m)),
                      Median(rests.off_m) < 0 ? "deep in" : "above", entities[rests.off].name));
    if (2 * rests.supported >= rests.bottoms_m.size()) continue;
    names.push_back(fmt::format("'{}'", entities[i].name));
    bottoms_m.push_back(Median(rests.bottoms_m));
    place.extend(rests.place);
  }
  if (names.empty()) return lines;
  const double height_m = Median(bottoms_m);
  const Eigen::Vector2d middle = place.center(), size = place.sizes().array() + 0.4;
  lines.push_back(fmt::format(
      "{} {} with the lowest point at {:.2f} m, and nothing in the map has its top within {:g} cm "
      "of that: no support, pick-up or put-down is recognised; what it stands on could be 'table: "
      "{{at_m: [{:.1f}, {:.1f}, {:.2f}], fixed: true, class: Table, size_m: [{:.1f}, {:.1f}, "
      "0.04]}}'{}",
      fmt::join(names, ", "), names.size() == 1 ? "rests" : "rest", height_m, 100 * kOnTop_m,
      Tenths(middle.x()), Tenths(middle.y()), height_m - 0.02, size.x(), size.y(),
      height_m > kHigh_m && MovesInUnitOfTable(episode, height_m)
          ? "; that is higher than people work: is unit right?"
      : height_m < lowest_top_m - kOnTop_m && std::isfinite(lowest_top_m)
          ? "; all that the map places is higher: is unit right?"
          : ""));
  return lines;
}

}  // namespace prehend::exchange
