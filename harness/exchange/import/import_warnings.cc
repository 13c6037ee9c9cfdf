// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_warnings.h. Tested by tests/program/import_test.cc
#include "harness/exchange/import/import_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prehend::exchange {
namespace {

// What a room is like.
constexpr double kFarFromOrigin_m = 30;                        ///< median distance of all poses
constexpr double kLeastStature_m = 0.5, kMostStature_m = 2.3;  ///< from feet to head
constexpr double kNothingMoves_m = 0.03;                       ///< extent of all poses together
constexpr double kLeastRate_hz = 2, kMostRate_hz = 2500;
constexpr double kLift_m = 0.05;  ///< what is lifted gets so far up, and comes down again
constexpr double kDip_m = 0.02;   ///< and does not get lower than where it stood
constexpr double kNear_m = 0.5;   ///< something gets so near to what stands
constexpr double kAt_m = 0.1;     ///< and so near with the right unit
constexpr double kLeastHands_m = 0.15, kMostHands_m = 5;  ///< where hands go

constexpr const char* kAxes = "xyz";

constexpr double kHandsWidth_m = 0.15;  ///< where all hands together stay
constexpr double kMoves_m = 0.002;
constexpr double kLeastReach_m = 0.3, kMostReach_m = 3;  ///< of hands that work
constexpr double kMostSize_m = 3;                        ///< of what is moved

/// Of all poses of some bodies, m, z up or not.
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

class ImportWarningFinder {
 public:
  ImportWarningFinder(const PoseFile& poses, const MapFile& map)
      : poses_(poses), map_(map.map), errors_(map.document), scale_(map.map.MetresPerUnit()) {}

  grammar::Diagnostics Find() {
    if (Asks(Warning::kZero) && !map_.zero_is_missing) Zeros();
    if (Asks(Warning::kTime)) Times();
    if (Asks(Warning::kUnit)) Unit();
    // With a wrong unit, lengths mean nothing.
    if (errors_.empty() && Asks(Warning::kAxes)) Up();
    if (errors_.empty() && Asks(Warning::kPlace)) Near();
    if (Asks(Warning::kQuaternionOrder) && poses_.quaternion_order) Order();
    return errors_.Sorted();
  }

 private:
  bool Asks(Warning warning) const { return !map_.IsSure(warning); }

  void Add(const Where& where, Warning warning, const std::string& message,
           const std::string& remedy) {
    errors_.Add(where, message,
                fmt::format("{}; or, if it is right, sure: [{}]", remedy,
                            kWarningNames[static_cast<std::size_t>(warning)]));
  }

  void Zeros() {
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from) continue;
      const PoseBody& body = BodyOf(entity.value);
      const auto zeros = std::ranges::count_if(
          body.samples, [](const PoseSample& sample) { return sample.p.isZero(0); });
      if (zeros == 0 || static_cast<std::size_t>(zeros) == body.samples.size()) continue;
      Add(entity.value.from->where, Warning::kZero,
          fmt::format("'{}' is at exactly 0, 0, 0 in {} of {} poses; many trackers write that for "
                      "'not tracked'",
                      body.name, zeros, body.samples.size()),
          "zero_is_missing: true");
    }
  }

  void Times() {
    std::vector<double> steps;
    for (const PoseBody& body : poses_.bodies) steps.push_back(UsualStep_s(body));
    const double step_s = *std::ranges::min_element(steps);
    const double rate_hz = 1 / step_s;
    if (map_.rate_hz && std::abs(rate_hz / map_.rate_hz->value - 1) > 0.05) {
      Add(map_.rate_hz->where, Warning::kTime,
          fmt::format("rate_hz: {:g}, but poses are {:.4g} s apart: {:.4g} Hz", map_.rate_hz->value,
                      step_s, rate_hz),
          poses_.counts_frames ? "the times look like frame numbers: time_unit: frame"
                               : "correct rate_hz or time_unit");
    } else if (rate_hz < kLeastRate_hz || rate_hz > kMostRate_hz) {
      Add(TimeWhere(), Warning::kTime,
          fmt::format("poses are {:.4g} s apart: {:.4g} Hz{}", step_s, rate_hz,
                      poses_.counts_frames       ? ""
                      : Plausible(rate_hz * 1e3) ? "; the times look like milliseconds"
                      : Plausible(rate_hz * 1e6) ? "; the times look like microseconds"
                      : Plausible(rate_hz * 1e9) ? "; the times look like nanoseconds"
                      : Plausible(rate_hz / 1e3) ? "; the times look a thousand times longer"
                                                 : ""),
          poses_.counts_frames ? "the times look like frame numbers: time_unit: frame and rate_hz"
                               : "correct time_unit");
    }
  }

  /// Where the map says what the times are, or else what is read.
  Where TimeWhere() const {
    if (map_.time_unit) return map_.time_unit->where;
    return map_.rate_hz ? map_.rate_hz->where : FirstBodyWhere();
  }
  Where FirstBodyWhere() const {
    return std::ranges::find_if(map_.entities,
                                [](const auto& entity) { return entity.value.from.has_value(); })
        ->value.from->where;
  }

  static bool Plausible(double rate_hz) { return rate_hz >= 10 && rate_hz <= 1000; }

  void Unit() {
    if (poses_.stature) {
      const double height_m = poses_.stature->norm() * scale_;
      if (height_m < kLeastStature_m || height_m > kMostStature_m)
        Add(map_.UnitWhere(), Warning::kUnit,
            fmt::format("from feet to head the skeleton is {:.3g} m ({:.4g} in the file)", height_m,
                        poses_.stature->norm()),
            fmt::format("correct unit, or metres_per_unit: {:.3g}, if it is 1.6 m",
                        1.6 / poses_.stature->norm()));
      return;
    }
    std::vector<double> distances;
    Eigen::AlignedBox3d extent;
    for (const PoseBody& body : poses_.bodies) {
      for (const PoseSample& sample : body.samples) {
        distances.push_back(sample.p.norm() * scale_);
        extent.extend(sample.p * scale_);
      }
    }
    const double median_m = Median(std::move(distances)), span_m = extent.diagonal().norm();
    if (median_m > kFarFromOrigin_m) {
      Add(map_.UnitWhere(), Warning::kUnit,
          fmt::format("the poses are {:.4g} m from the origin (median){}", median_m,
                      scale_ != 1      ? ""
                      : median_m > 150 ? "; they look like millimetres"
                                       : "; they look like centimetres or millimetres"),
          "correct unit");
    } else if (span_m < kNothingMoves_m) {
      Add(map_.UnitWhere(), Warning::kUnit,
          fmt::format("all poses are within {:.3g} mm{}", span_m * 1e3,
                      scale_ == 1 ? ""
                                  : fmt::format("; as metres they would be within {:.3g} m",
                                                span_m / scale_)),
          "correct unit");
    }
  }

  /// What a hand moves is lifted, and comes down again where it is put down.
  struct Lifts {
    int moving = 0, lifted = 0;
    double highest_m = 0;
    std::string example;
  };
  Lifts LiftsAlong(const Eigen::Vector3d& direction) const {
    Lifts lifts;
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from || entity.value.hand) continue;
      const PoseBody& body = BodyOf(entity.value);
      Eigen::AlignedBox3d extent;
      Eigen::AlignedBox1d heights;
      const auto height = [&](const PoseSample& sample) {
        return sample.p.dot(direction) * scale_;
      };
      for (const PoseSample& sample : body.samples) {
        extent.extend(sample.p * scale_);
        heights.extend(Eigen::Matrix<double, 1, 1>(height(sample)));
      }
      if (extent.diagonal().norm() < 0.1) continue;
      ++lifts.moving;
      const double begin = height(body.samples.front()), end = height(body.samples.back());
      const double rise_m = heights.max().x() - std::max(begin, end);
      const double dip_m = std::min(begin, end) - heights.min().x();
      if (rise_m < kLift_m || dip_m > kDip_m) continue;
      ++lifts.lifted;
      if (rise_m <= lifts.highest_m) continue;
      lifts.highest_m = rise_m;
      lifts.example = body.name;
    }
    return lifts;
  }

  void Up() {
    const Eigen::Vector3d up = map_.Up();
    int nearest = 0;  // of the file's axes to up
    up.cwiseAbs().maxCoeff(&nearest);
    const std::string stated_up = map_.up ? "up" : std::string(1, kAxes[nearest]);
    if (poses_.stature) {
      int tallest = 0;
      poses_.stature->maxCoeff(&tallest);
      const double along_up = poses_.stature->dot(up);
      if (tallest != nearest && along_up < 0.7 * poses_.stature->norm())
        Add(map_.UpWhere(), Warning::kAxes,
            fmt::format("the head is {:.2f} m from the feet along {}, and {:.2f} m along {}: {} "
                        "looks up",
                        (*poses_.stature)[tallest] * scale_, kAxes[tallest], along_up * scale_,
                        stated_up, kAxes[tallest]),
            fmt::format("axes: {}_up", kAxes[tallest]));
      return;
    }
    const Lifts stated = LiftsAlong(up);
    if (stated.moving == 0 || stated.lifted > 0) return;
    for (const int axis : {1, 2, 0}) {
      const Lifts other = LiftsAlong(Eigen::Vector3d::Unit(axis));
      if (axis == nearest || other.lifted < other.moving) continue;
      Add(map_.UpWhere(), Warning::kAxes,
          fmt::format("nothing is lifted along {}, but '{}' rises {:.2f} m along {} and comes "
                      "down again: {} looks up",
                      stated_up, other.example, other.highest_m, kAxes[axis], kAxes[axis]),
          fmt::format("axes: {}_up", kAxes[axis]));
      return;
    }
  }

  struct Approach {
    double distance_m = std::numeric_limits<double>::infinity();
    const Named<MappedEntity>* place = nullptr;
    const PoseBody* comes = nullptr;
  };
  /// How near what is tracked comes to what the map places.
  Approach Nearest(double metres_per_unit) const {
    Approach nearest;
    for (const Named<MappedEntity>& place : map_.entities) {
      const MappedEntity& e = place.value;
      if (!e.at_m) continue;
      const Eigen::Quaterniond q(e.quat_wxyz[0], e.quat_wxyz[1], e.quat_wxyz[2], e.quat_wxyz[3]);
      for (const PoseBody& body : poses_.bodies) {
        for (const PoseSample& sample : body.samples) {
          const Eigen::Vector3d p_B =
              q.conjugate() * (Upright(sample.p * metres_per_unit) - *e.at_m);
          const double distance_m = (p_B.cwiseAbs() - e.size_m / 2).cwiseMax(0).norm();
          if (distance_m < nearest.distance_m) nearest = {distance_m, &place, &body};
        }
      }
    }
    return nearest;
  }

  void Near() {
    const Approach nearest = Nearest(scale_);
    if (!nearest.place || nearest.distance_m <= kNear_m) return;
    const std::string text =
        fmt::format("nothing tracked comes nearer to '{}' than {:.2f} m ('{}')",
                    nearest.place->name, nearest.distance_m, nearest.comes->name);
    if (Asks(Warning::kUnit)) {
      if (const auto range = RangeTooSmall(poses_, map_))
        return Add(map_.UnitWhere(), Warning::kUnit, range->text + "; " + text, range->remedy);
      if (const std::string unit = UnitThatComesNear(); !unit.empty())
        return Add(map_.UnitWhere(), Warning::kUnit,
                   fmt::format("{}; in {} it would come to it", text, unit), "unit: " + unit);
    }
    Add(nearest.place->name_where, Warning::kPlace, text,
        "correct its at_m (z up, metres, after the change of axes), or unit, or axes");
  }

  /// Another unit in which something comes to what the map places, and hands go as far as hands do;
  /// or "". Not inch: too near to others.
  std::string UnitThatComesNear() const {
    const double hands_m = ExtentOf(poses_, map_, true).diagonal().norm();
    constexpr std::array<std::pair<const char*, double>, 3> kUnits = {
        {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}}};
    for (const auto& [unit, metres] : kUnits) {
      const double would_m = hands_m / scale_ * metres;
      if (metres != scale_ && would_m > kLeastHands_m && would_m < kMostHands_m &&
          Nearest(metres).distance_m < kAt_m)
        return unit;
    }
    return "";
  }

  /// z up, as in the recording.
  Eigen::Vector3d Upright(const Eigen::Vector3d& p) const { return map_.WorldTurn() * p; }

  /// A body that stands as when it was defined has w near 1.
  void Order() {
    std::vector<double> as_read, other;
    const bool w_first = poses_.quaternion_order == QuaternionOrder::kWxyz;
    for (const PoseBody& body : poses_.bodies) {
      for (const PoseSample& sample : body.samples) {
        as_read.push_back(std::abs(sample.q.w()));
        other.push_back(std::abs(w_first ? sample.q.z() : sample.q.x()));
      }
    }
    const double w = Median(std::move(as_read)), other_w = Median(std::move(other));
    if (w > 0.5 || other_w < 0.85) return;
    Add(map_.quaternion_order ? map_.quaternion_order->where : FirstBodyWhere(),
        Warning::kQuaternionOrder,
        fmt::format("the {} of four numbers, as w, is {:.2f} (median, without its sign), the {} is "
                    "{:.2f}: this looks like {}",
                    w_first ? "first" : "last", w, w_first ? "last" : "first", other_w,
                    w_first ? "xyzw" : "wxyz"),
        fmt::format("quaternion_order: {}", w_first ? "xyzw" : "wxyz"));
  }

  const PoseBody& BodyOf(const MappedEntity& entity) const {
    return *std::ranges::find(poses_.bodies, entity.from->value, &PoseBody::name);
  }

  const PoseFile& poses_;
  const ImportMap& map_;
  DiagnosticList errors_;
  double scale_ = 1;
};

}  // namespace

grammar::Diagnostics FindImportWarnings(const PoseFile& poses, const MapFile& map) {
  return ImportWarningFinder(poses, map).Find();
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double UsualStep_s(const PoseBody& body) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < body.samples.size(); ++i)
    steps.push_back(body.samples[i].t_s - body.samples[i - 1].t_s);
  return Median(std::move(steps));
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

DoubtfulThings ThingsTooLarge(const ImportMap& map) {
  DoubtfulThings large;
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
