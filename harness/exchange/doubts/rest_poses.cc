// SPDX-License-Identifier: Apache-2.0
// A thing rests where it gets less than a centimetre far in half a second, hardly turns, is as low
// as it ever rests, and no hand is at it. If it never rests upright, it is not turned as the map
// says; unless it lies or is upside down, which things do. Whether it really lies is told by what
// is below: if it would stand there, but hovers or sinks in as it lies, it does not lie.
//
// Several things that are turned the same way rest on a frame that is not upright: of that,
// harness/exchange/doubts/rest_poses.h says something.
#include "harness/exchange/doubts/rest_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "grammar/base/frame.h"

namespace prehend::exchange {
namespace {

constexpr double kSameTurn_deg = 3;
constexpr double kLow_m = 0.03;    ///< above its lowest rest: higher it is held
constexpr double kAtHand_m = 0.1;  ///< beyond the sphere around its box: nearer, a hand may hold it
constexpr std::size_t kLeastLooks = 2;  ///< looks
constexpr double kUpright_deg = 15;
constexpr double kRound = 0.9;    ///< as deep as wide by this share, it may roll
constexpr double kAlike_deg = 5;  ///< of the axes of two things
constexpr double kTouches_m = 0.03, kIsOff_m = 0.05;

double DegreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / EIGEN_PI;
}

/// One thing at rest.
struct RestPose {
  std::size_t thing = 0;
  double at_s = 0;  ///< the first time
  double degrees = 0;
  Eigen::Vector3d markers_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::size_t looks = 0;

  Eigen::Vector3d Axis() const { return q * Eigen::Vector3d::UnitZ(); }
  /// What is not round lies on a side of its box.
  bool LiesOrIsUpsideDown(const Eigen::Vector3d& half_m) const {
    const Eigen::Vector3d up = q.conjugate() * Eigen::Vector3d::UnitZ();
    const bool is_round = half_m.head<2>().minCoeff() >= kRound * half_m.head<2>().maxCoeff();
    return degrees >= 180 - kUpright_deg ||
           (std::abs(degrees - 90) <= kUpright_deg &&
            (is_round ||
             up.head<2>().cwiseAbs().maxCoeff() >= std::cos(kUpright_deg * EIGEN_PI / 180)));
  }
};

class RestPoseFinder {
 public:
  RestPoseFinder(const episode::Recording& episode, const ImportMap& map)
      : episode_(episode), map_(map), entities_(episode.header.entity_table.entities) {}

  DoubtfulThings Find() {
    std::vector<RestPose> rests;
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      const MappedEntity& e = map_.entities[i].value;
      if (!e.from || e.hand || e.fixed) continue;
      if (auto rest = RestPoseOf(i)) rests.push_back(*rest);
    }
    bool axes_are_any = false;
    for (const RestPose& rest : rests) {
      if (rest.degrees <= kUpright_deg) continue;
      const bool alike = std::ranges::any_of(rests, [&](const RestPose& other) {
        return &other != &rest && DegreesBetween(other.Axis(), rest.Axis()) < kAlike_deg;
      });
      if (rest.LiesOrIsUpsideDown(entities_[rest.thing].half_size_m) ? !StandsRather(rest) : alike)
        continue;
      found_.things.insert(rest.thing);
      axes_are_any = axes_are_any || !SaysAxes(map_.entities[rest.thing].value);
    }
    for (const RestPose& rest : rests) {
      // What seems to lie has any axes, too, where the others have.
      if (axes_are_any && rest.degrees > kUpright_deg && !SaysAxes(map_.entities[rest.thing].value))
        found_.things.insert(rest.thing);
      if (found_.things.contains(rest.thing)) Warn(rest, rests.size() == 1);
    }
    if (axes_are_any) WarnOfHands();
    return std::move(found_);
  }

 private:
  double SecondsAt(const episode::EpisodeFrame& frame) const {
    return static_cast<double>(frame.tick) /
           static_cast<double>(episode_.header.entity_table.ticks_per_second);
  }

  /// Where the tracker sees it, however it is turned.
  Eigen::Vector3d Markers_m(const episode::EpisodeFrame& frame, std::size_t thing) const {
    const grammar::EntitySample& look = frame.entities[thing];
    return look.p_WB_m - look.q_WB * map_.entities[thing].value.offset_m;
  }

  bool IsAtHand(const episode::EpisodeFrame& frame, std::size_t thing) const {
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      if (!map_.entities[i].value.hand || !grammar::IsTracked(frame.entities[i])) continue;
      if ((frame.entities[i].p_WB_m - Markers_m(frame, thing)).norm() <
          entities_[thing].half_size_m.norm() + kAtHand_m)
        return true;
    }
    return false;
  }

  /// The least turned of its rests, with the time of the first.
  std::optional<RestPose> RestPoseOf(std::size_t thing) const {
    std::vector<const episode::EpisodeFrame*> still;
    double lowest_m = std::numeric_limits<double>::infinity();
    bool turns = false;
    EachLook(episode_, [&](const episode::EpisodeFrame& last, const episode::EpisodeFrame& frame) {
      const grammar::EntitySample &look = frame.entities[thing], &old = last.entities[thing];
      if (!grammar::IsTracked(look) || !grammar::IsTracked(old)) return;
      turns = turns || !look.q_WB.coeffs().isApprox(old.q_WB.coeffs(), 1e-12);
      if ((Markers_m(frame, thing) - Markers_m(last, thing)).norm() >= kSamePlace_m ||
          look.q_WB.angularDistance(old.q_WB) * 180 / EIGEN_PI >= kSameTurn_deg)
        return;
      lowest_m = std::min(lowest_m, Markers_m(last, thing).z());
      still.push_back(&last);
    });
    std::optional<RestPose> rest;
    for (const episode::EpisodeFrame* frame : still) {
      const grammar::EntitySample& look = frame->entities[thing];
      if (Markers_m(*frame, thing).z() > lowest_m + kLow_m || IsAtHand(*frame, thing)) continue;
      const double degrees =
          DegreesBetween(look.q_WB * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ());
      if (!rest) rest = RestPose{.thing = thing, .at_s = SecondsAt(*frame), .degrees = 360};
      ++rest->looks;
      if (degrees >= rest->degrees) continue;
      rest->degrees = degrees;
      rest->markers_m = Markers_m(*frame, thing);
      rest->q = look.q_WB;
    }
    // A body of which only positions are known never turns.
    if (!rest || rest->looks < kLeastLooks || !turns) return std::nullopt;
    return rest;
  }

  /// How far the lowest point of a box is from the nearest top of what the map places below it.
  double OffTops_m(const Eigen::Vector3d& p_m, const Eigen::Vector3d& half_m) const {
    double off_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      const MappedEntity& e = map_.entities[i].value;
      if (!e.at_m) continue;
      const grammar::EntitySample& at = episode_.frames.front().entities[i];
      const Eigen::Vector3d reach =
          at.q_WB.toRotationMatrix().cwiseAbs() * entities_[i].half_size_m;
      if (((p_m - at.p_WB_m).cwiseAbs() - reach).head<2>().maxCoeff() > 0) continue;
      off_m = std::min(off_m, std::abs(p_m.z() - half_m.z() - at.p_WB_m.z() - reach.z()));
    }
    return off_m;
  }

  /// It would stand on something of the map, but as it lies it does not touch that.
  bool StandsRather(const RestPose& rest) const {
    const Eigen::Vector3d& offset_m = map_.entities[rest.thing].value.offset_m;
    const Eigen::Vector3d& half_m = entities_[rest.thing].half_size_m;
    const Eigen::Vector3d upright_m = rest.markers_m + offset_m;
    return OffTops_m(upright_m, half_m) < kTouches_m &&
           OffTops_m(rest.markers_m + rest.q * offset_m,
                     rest.q.toRotationMatrix().cwiseAbs() * half_m) > kIsOff_m;
  }

  void Warn(const RestPose& rest, bool alone) {
    const Named<MappedEntity>& entity = map_.entities[rest.thing];
    const double at_s = std::round(100 * rest.at_s) / 100;
    std::string text = fmt::format(
        "'{}' rests with its z axis {:.0f} degrees away from upright: ", entity.name, rest.degrees);
    if (const auto& said = entity.value.upright_at_s)
      text += fmt::format("at its upright_at_s, {:g} s, it was turned otherwise than it rests; ",
                          said->value);
    else if (entity.value.axes_quat_wxyz)
      text += "its axes_quat_wxyz is not that of these markers; ";
    else
      text += "trackers give bodies any axes; ";
    text +=
        fmt::format("if it stands upright at {:g} s, in the map: {}: {{.., upright_at_s: {:g}}}",
                    at_s, entity.name, at_s);
    if (alone) text += "; if the whole frame is not upright, in the map: up";
    found_.warnings.push_back(std::move(text));
  }

  /// Nobody can see from poses how a hand is held.
  void WarnOfHands() {
    std::vector<std::string> names;
    for (const Named<MappedEntity>& entity : map_.entities) {
      const MappedEntity& e = entity.value;
      if (e.hand && !SaysAxes(e) && (e.ahead || !e.offset_m.isZero(0)))
        names.push_back("'" + entity.name + "'");
    }
    if (names.empty()) return;
    found_.warnings.push_back(fmt::format(
        "{} {} no upright_at_s either, and offset_m and ahead count in the axes that the tracker "
        "gave: it is a time at which the hand is flat, as it is described",
        fmt::join(names, ", "), names.size() == 1 ? "has" : "have"));
  }

  const episode::Recording& episode_;
  const ImportMap& map_;
  const std::vector<grammar::EntityInfo>& entities_;
  DoubtfulThings found_;
};

}  // namespace

void EachLook(const episode::Recording& episode,
              const std::function<void(const episode::EpisodeFrame& before,
                                       const episode::EpisodeFrame& now)>& look) {
  const auto step = static_cast<grammar::Tick>(
      kBetweenLooks_s * static_cast<double>(episode.header.entity_table.ticks_per_second));
  const episode::EpisodeFrame* before = nullptr;
  for (const episode::EpisodeFrame& frame : episode.frames) {
    if (before != nullptr && frame.tick - before->tick < step) continue;
    if (before != nullptr) look(*before, frame);
    before = &frame;
  }
}

DoubtfulThings FindNotUpright(const episode::Recording& episode, const ImportMap& map) {
  return RestPoseFinder(episode, map).Find();
}

}  // namespace prehend::exchange
