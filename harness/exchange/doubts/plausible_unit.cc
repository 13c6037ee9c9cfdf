// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/doubts/plausibility.h.
//
// Three families of signs do not depend on each other: how far and how fast what is tracked moves,
// where it is, and how large it is. Another unit is named if it would explain most of them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/exchange/doubts/plausibility.h"

namespace prehend::exchange {
namespace {

constexpr double kNothingMoves_m = 0.03, kSomethingMoves_m = 0.1;  ///< all poses together
constexpr double kNoMove_m = 0.0005;                       ///< in no unit does something move
constexpr double kHandsWidth_m = 0.15, kMostReach_m = 20;  ///< where hands go
constexpr double kLeastHands_m = 0.2, kMostHands_m = 5;
constexpr double kSlow_m_per_s = 0.02, kFast_m_per_s = 7;      ///< of hands, 98 % below it
constexpr double kSpeedOver_s = 0.02;                          ///< or over three frames
constexpr double kFarFromOrigin_m = 30;                        ///< median distance of all poses
constexpr double kNearPlace_m = 0.5, kAt_m = 0.1;              ///< of what the map places
constexpr double kLeastStature_m = 0.5, kMostStature_m = 2.3;  ///< from feet to head
constexpr double kFar_m = 0.5, kHeld_m = 0.35;                 ///< of hands from things

constexpr std::array<std::pair<const char*, double>, 3> kUnits = {
    {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}}};

/// Lengths in the file's unit.
struct Lengths {
  double from_origin = 0, span = 0, hands = 0, speed = 0;
  bool has_hands = false;
};

/// Over three frames or more. What goes out and back at once is an outlier, no speed.
void AddSpeeds(const PoseSeries& samples, std::vector<double>& speeds) {
  const auto way = [&](std::size_t from, std::size_t to) {
    return (samples[std::min(to, samples.size() - 1)].p - samples[from].p).norm();
  };
  for (std::size_t k = 0, next = 0; k < samples.size(); ++k) {
    next = std::max(next, k + 3);
    while (next < samples.size() && samples[next].t_s < samples[k].t_s + kSpeedOver_s) ++next;
    if (next >= samples.size()) break;
    const double step = way(k, next);
    const std::size_t frames = next - k;
    if (step > 0 && way(k, next + frames) >= step / 2 &&
        way(k - std::min(k, frames), next) >= step / 2)
      speeds.push_back(step / (samples[next].t_s - samples[k].t_s));
  }
}

Lengths LengthsIn(const PoseFile& poses, const MotionSeen& seen) {
  Lengths lengths;
  std::vector<double> speeds;
  Eigen::AlignedBox3d extent, hands;
  for (std::size_t body = 0; body < poses.bodies.size(); ++body) {
    for (const PoseSample& sample : poses.bodies[body].samples) {
      extent.extend(sample.p);
      if (seen.entities[body]->hand) hands.extend(sample.p);
    }
    const PoseSeries& samples = poses.bodies[body].samples;
    if (seen.entities[body]->hand) {
      lengths.has_hands = true;
      AddSpeeds(samples, speeds);
    }
    LetGo(samples);
  }
  lengths.from_origin = MedianOfPoses(poses, [](const PoseSample& at) { return at.p.norm(); });
  lengths.span = extent.isEmpty() ? 0 : extent.diagonal().norm();
  lengths.hands = hands.isEmpty() ? 0 : hands.diagonal().norm();
  std::ranges::sort(speeds);
  if (!speeds.empty()) lengths.speed = speeds[speeds.size() * 98 / 100];
  return lengths;
}

/// How far hands stay from all things, m.
double HandsFromThings(const MotionSeen& seen, double scale) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t hand = 0; hand < seen.looks.size(); ++hand) {
    for (std::size_t thing = 0; seen.entities[hand]->hand && thing < seen.looks.size(); ++thing) {
      if (seen.entities[thing]->hand) continue;
      for (std::size_t k = 0; k < std::min(seen.looks[hand].size(), seen.looks[thing].size());
           ++k) {
        const double m = scale * (seen.looks[hand][k].p_m - seen.looks[thing][k].p_m).norm() -
                         seen.entities[thing]->size_m.norm() / 2;
        if (m < least_m) least_m = m;
      }
    }
  }
  return least_m;
}

class UnitGuesser {
 public:
  UnitGuesser(const PoseFile& poses, const ImportMap& map)
      : poses_(poses),
        map_(map),
        seen_(MotionIn(poses, map, 1)),
        lengths_(LengthsIn(poses, seen_)) {}

  Guess Find() {
    const double stated = map_.MetresPerUnit();
    Guess guess{map_.UnitWhere(), Warning::kUnit, {}, "correct unit"};
    std::string places = PlacesLookWrong(stated), motion = MotionLooksWrong(stated),
                sizes = SizesLookWrong(stated);
    const auto unit = std::ranges::find_if(kUnits, [&](const auto& other) {
      return other.second != stated && (places.empty() || PlacesFit(other.second)) &&
             (motion.empty() || MotionFits(other.second)) &&
             (sizes.empty() || SizesLookWrong(other.second).empty());
    });
    const bool is_known = unit != kUnits.end();
    if (is_known) {
      guess.remedy = fmt::format("unit: {}", unit->first);
      if (motion.starts_with("all hands"))
        motion +=
            fmt::format("; in {} it would be {:.2g} m", unit->first, lengths_.hands * unit->second);
      else if (places.starts_with("nothing tracked") && motion.empty() && sizes.empty())
        places += fmt::format("; in {} it would come to it", unit->first);
    }
    if (poses_.stature && sizes.empty()) return guess;  // its length is known
    const bool far_only = motion.empty() && sizes.empty(),
               too_fast = motion.starts_with("the hands go");
    for (std::string* sign : poses_.stature ? std::array{&sizes, &places, &motion}
                             : places.starts_with("the poses")
                                 ? std::array{&places, &motion, &sizes}
                                 : std::array{&motion, &places, &sizes})
      if (!sign->empty()) guess.signs.push_back(std::move(*sign));
    if (poses_.stature)
      guess.remedy = fmt::format("correct unit, or metres_per_unit: {:.3g}, if it is 1.6 m",
                                 1.6 / poses_.stature->norm());
    else if (!is_known && too_fast)
      guess.remedy = "correct unit, or what the map says of times";
    // Far away alone is no unit; and what is still in every unit does not move.
    else if (!is_known && (far_only || (guess.signs.size() == 1 && lengths_.span < kNoMove_m)))
      guess.signs.clear();
    return guess;
  }

 private:
  std::string PlacesLookWrong(double scale) const {
    const double origin_m = lengths_.from_origin * scale;
    if (origin_m > kFarFromOrigin_m)
      return fmt::format("the poses are {:.4g} m from the origin (median){}", origin_m,
                         scale != 1       ? ""
                         : origin_m > 150 ? "; they look like millimetres"
                                          : "; they look like centimetres or millimetres");
    const Approach nearest = NearestApproach(poses_, map_, scale);
    if (nearest.place && nearest.distance_m > kNearPlace_m)
      return fmt::format("nothing tracked comes nearer to '{}' than {:.2f} m ('{}')",
                         nearest.place->name, nearest.distance_m, nearest.comes->name);
    return "";
  }
  bool PlacesFit(double scale) const {
    const double nearest_m = NearestApproach(poses_, map_, scale).distance_m;
    if (std::isinf(nearest_m))
      return MotionFits(scale) && lengths_.from_origin * scale <= kFarFromOrigin_m;
    return MotionFits(scale) && nearest_m < kAt_m;
  }

  std::string MotionLooksWrong(double scale) const {
    const double span_m = lengths_.span * scale, hands_m = lengths_.hands * scale;
    if (span_m < kNothingMoves_m)
      return fmt::format(
          "all poses are within {:.3g} mm{}", span_m * 1e3,
          scale == 1 ? ""
                     : fmt::format("; as metres they would be within {:.3g} m", lengths_.span));
    if (!lengths_.has_hands || poses_.bodies.size() < 2) return "";
    if (hands_m < kHandsWidth_m && hands_m > 0.002 && hands_m >= span_m / 2)
      return fmt::format(
          "all hands together stay within {:.2g} m, and all that is tracked within {:.2g} m",
          hands_m, span_m);
    const double speed_m_per_s = lengths_.speed * scale;
    if (hands_m > kMostReach_m || speed_m_per_s > kFast_m_per_s)
      return fmt::format("the hands go {:.3g} m far, at up to {:.3g} m/s", hands_m, speed_m_per_s);
    return "";
  }
  bool MotionFits(double scale) const {
    if (!lengths_.has_hands)
      return lengths_.span * scale > kSomethingMoves_m && lengths_.span * scale < kMostReach_m;
    const double hands_m = lengths_.hands * scale, speed_m_per_s = lengths_.speed * scale;
    return hands_m > kLeastHands_m && hands_m < kMostHands_m && speed_m_per_s > kSlow_m_per_s &&
           speed_m_per_s < kFast_m_per_s;
  }

  std::string SizesLookWrong(double scale) const {
    if (poses_.stature) {
      const double height_m = poses_.stature->norm() * scale;
      if (height_m >= kLeastStature_m && height_m <= kMostStature_m) return "";
      return fmt::format("from feet to head the skeleton is {:.3g} m ({:.4g} in the file)",
                         height_m, poses_.stature->norm());
    }
    const double from_things_m = HandsFromThings(seen_, scale);
    if (from_things_m > kFar_m && !std::isinf(from_things_m))
      return fmt::format("no hand comes nearer to a thing than {:.2f} m", from_things_m);
    return "";
  }

  const PoseFile& poses_;
  const ImportMap& map_;
  const MotionSeen seen_;
  const Lengths lengths_;
};

}  // namespace

Guess GuessUnit(const PoseFile& poses, const ImportMap& map) {
  return UnitGuesser(poses, map).Find();
}

DoubtfulThings ThingsTooLarge(const ImportMap& map) {
  constexpr double kMostSize_m = 3, kUsualSize_m = 0.6;
  DoubtfulThings large;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    const MappedEntity& e = map.entities[i].value;
    const Eigen::Vector3d& size = e.size_m;
    if (!e.from || e.fixed || size.maxCoeff() <= kMostSize_m) continue;
    const bool in_millimetres = map.MetresPerUnit() < 0.002 && size.maxCoeff() > 10;
    const double most_m = map.MetresPerUnit() == 0.01 ? kMostSize_m : kUsualSize_m;
    const double factor = in_millimetres || size.maxCoeff() / 100 > most_m ? 1000 : 100;
    large.things.insert(i);
    large.warnings.push_back(
        fmt::format("'{}' is {:g} x {:g} x {:g} m large, and size_m is in metres; if these are {}: "
                    "size_m: [{:g}, {:g}, {:g}]",
                    map.entities[i].name, size.x(), size.y(), size.z(),
                    factor == 100 ? "centimetres" : "millimetres", size.x() / factor,
                    size.y() / factor, size.z() / factor));
  }
  return large;
}

}  // namespace prehend::exchange
