// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/doubts/plausibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

constexpr double kLeastRate_hz = 2, kMostRate_hz = 2500;
constexpr double kLiftsRate_hz = 8;  ///< from here on a picking up of 0.2 s is seen
constexpr double kLeastSpeed_m_per_s = 0.02, kMostSpeed_m_per_s = 20;  ///< of what moves most
constexpr double kJump_m = 0.05;  ///< into a pose that stands for none
constexpr double kNear_m = 0.5;   ///< something gets so near to what stands

/// In which unit times would be of a usual rate, or "". `rate`: poses per unit of the file.
std::string LikelyTimes(double rate) {
  constexpr std::array<std::pair<const char*, double>, 4> kUnits = {
      {{"seconds", 1}, {"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}}};
  for (const auto& [unit, per_second] : kUnits)
    if (const double hz = rate * per_second; hz >= 10 && hz <= 1000)
      return fmt::format("; the times look like {}", unit);
  return "";
}

/// The fastest that any body usually is, in the file's unit.
double UsualSpeed(const PoseFile& poses) {
  double fastest = 0;
  for (const PoseBody& body : poses.bodies) {
    std::vector<double> speeds;
    for (std::size_t i = 1; i < body.samples.size(); ++i)
      speeds.push_back((body.samples[i].p - body.samples[i - 1].p).norm() /
                       (body.samples[i].t_s - body.samples[i - 1].t_s));
    LetGo(body.samples);
    std::ranges::sort(speeds);
    if (!speeds.empty()) fastest = std::max(fastest, speeds[speeds.size() * 95 / 100]);
  }
  return fastest;
}

class Judge {
 public:
  Judge(const PoseFile& poses, const MapFile& map)
      : poses_(poses), map_(map.map), layout_(map.layout.get()), errors_(map.document) {}

  Implausible Find() {
    if (!map_.zero_is_missing) Zeros();
    Add(GuessTimes());
    const std::size_t before = found_.warnings.size();
    Add(Fractions());
    if (found_.warnings.size() == before && errors_.empty()) Add(GuessUnit(poses_, map_));
    found_.unit = !errors_.empty() || found_.warnings.size() > before;
    const Guess angles = GuessAngleUnit(poses_, map_);
    Add(angles);
    // With a wrong unit, lengths mean nothing, and with one of angles no turn does.
    if (!found_.unit && angles.signs.empty()) {
      const Guess axes = GuessAxes(poses_, map_);
      Add(axes);
      if (axes.signs.empty()) Add(GuessHandedness(poses_, map_));
      if (poses_.quaternion_order) Add(GuessOrder(poses_, map_));
      found_.world = found_.warnings.size() > before;
      if (!found_.world)
        for (std::string& line : OddlyHeld(poses_, map_))
          found_.warnings.push_back(std::move(line));
    }
    found_.errors = errors_.Sorted();
    return std::move(found_);
  }

 private:
  void Add(const Guess& guess) {
    if (guess.signs.empty() || map_.IsSure(guess.kind)) return;
    if (guess.signs.size() > 1 || guess.is_certain)
      errors_.Add(guess.where, guess.Text(), guess.Remedy());
    else
      found_.warnings.push_back(guess.Text() + ": " + guess.Remedy());
  }

  /// Of a body that jumps to exactly zero and from there.
  void Zeros() {
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from) continue;
      const PoseBody& body =
          *std::ranges::find(poses_.bodies, entity.value.from->value, &PoseBody::name);
      std::size_t zeros = 0;
      double jump_m = 0;
      for (std::size_t i = 0; i < body.samples.size(); ++i) {
        if (!body.samples[i].p.isZero(0)) continue;
        ++zeros;
        for (const std::size_t next : {i - 1, i + 1})
          if (next < body.samples.size())
            jump_m = std::max(jump_m, body.samples[next].p.norm() * map_.MetresPerUnit());
      }
      LetGo(body.samples);
      if (jump_m < kJump_m) continue;
      Guess guess{entity.value.from->where, Warning::kZero, {}, "zero_is_missing: true"};
      guess.signs = {fmt::format("'{}' is at exactly 0, 0, 0 in {} of {} poses", body.name, zeros,
                                 body.samples.size()),
                     fmt::format("it jumps there by {:.2f} m; many trackers write that for 'not "
                                 "tracked'",
                                 jump_m)};
      Add(guess);
    }
  }

  Guess GuessTimes() const {
    std::vector<double> steps;
    for (const PoseBody& body : poses_.bodies) steps.push_back(UsualStep_s(body.samples));
    const double step_s = *std::ranges::min_element(steps), rate_hz = 1 / step_s;
    Guess guess{map_.time_unit ? map_.time_unit->where
                : map_.rate_hz ? map_.rate_hz->where
                               : FirstBodyWhere(map_),
                Warning::kTime,
                {},
                "correct time_unit"};
    if (map_.rate_hz && std::abs(rate_hz / map_.rate_hz->value - 1) > 0.05) {
      guess.where = map_.rate_hz->where;
      guess.is_certain = true;
      guess.signs = {fmt::format("rate_hz: {:g}, but poses are {:.4g} s apart: {:.4g} Hz",
                                 map_.rate_hz->value, step_s, rate_hz)};
      guess.remedy = poses_.counts_frames ? "the times look like frame numbers: time_unit: frame"
                                          : "correct rate_hz or time_unit";
      return guess;
    }
    const double mean_hz = static_cast<double>(poses_.rows - 1) / poses_.last_s;
    if (layout_ && layout_->rate_hz && layout_->time_unit == TimeUnit::kSecond &&
        std::abs(rate_hz / *layout_->rate_hz - 1) > 0.05 &&
        std::abs(mean_hz / *layout_->rate_hz - 1) > 0.05) {
      guess.signs = {
          fmt::format("the head says {:g} frames a second, but poses are {:.4g} s apart: "
                      "{:.4g} Hz",
                      *layout_->rate_hz, step_s, rate_hz)};
      guess.remedy = "the times count";
      return guess;
    }
    if (rate_hz >= kLiftsRate_hz && rate_hz <= kMostRate_hz) return guess;
    if (rate_hz >= kLeastRate_hz && rate_hz < kLiftsRate_hz) {
      guess.signs = {
          fmt::format("poses are {:.3g} s apart, and what takes less than two of these, "
                      "like picking_up, is not recognised",
                      step_s)};
      guess.remedy = "correct rate_hz or time_unit";
      return guess;
    }
    const double unit_s = map_.time_unit ? map_.SecondsPerUnit() : 1;
    guess.signs.push_back(fmt::format("poses are {:.4g} s apart: {:.4g} Hz{}", step_s, rate_hz,
                                      poses_.counts_frames ? "" : LikelyTimes(rate_hz * unit_s)));
    const double speed_m_per_s = UsualSpeed(poses_) * map_.MetresPerUnit();
    if (poses_.counts_frames) {
      guess.signs.push_back("they are whole numbers that grow by 1 each");
      guess.remedy = "the times look like frame numbers: time_unit: frame and rate_hz";
    } else if (speed_m_per_s < kLeastSpeed_m_per_s || speed_m_per_s > kMostSpeed_m_per_s) {
      guess.signs.push_back(
          fmt::format("the fastest body usually moves at {:.2g} m/s", speed_m_per_s));
    }
    return guess;
  }

  /// One axis never changes, and the others have values from 0 to 1.
  Guess Fractions() const {
    Guess guess{map_.UnitWhere(), Warning::kUnit, {}, "give positions in a unit of length"};
    Eigen::AlignedBox3d extent;
    for (const PoseBody& body : poses_.bodies) {
      for (const PoseSample& sample : body.samples) extent.extend(sample.p);
      LetGo(body.samples);
    }
    int flat = 0;
    const Eigen::Vector3d sizes = extent.sizes();
    if (sizes.minCoeff(&flat) > 0 || sizes.maxCoeff() * map_.MetresPerUnit() < 0.1) return guess;
    Eigen::Vector3d low = extent.min(), high = extent.max();
    low[flat] = high[flat] = 0;
    if (low.minCoeff() >= 0 && high.maxCoeff() <= 1)
      guess.signs.push_back(
          fmt::format("{} of the file is {:g} in all poses, and the others are from 0 to 1: they "
                      "look like fractions of an image",
                      "xyz"[flat], extent.min()[flat]));
    const Approach nearest = NearestApproach(poses_, map_, map_.MetresPerUnit());
    if (!guess.signs.empty() && nearest.place && nearest.distance_m > kNear_m)
      guess.signs.push_back(fmt::format("nothing tracked comes near to '{}'", nearest.place->name));
    return guess;
  }

  const PoseFile& poses_;
  const ImportMap& map_;
  const TableLayout* const layout_;
  DiagnosticList errors_;
  Implausible found_;
};

}  // namespace

std::string Guess::Text() const { return fmt::format("{}", fmt::join(signs, "; ")); }

std::string Guess::Remedy() const {
  return fmt::format("{}; or, if it is right, sure: [{}]", remedy,
                     kWarningNames[static_cast<std::size_t>(kind)]);
}

Implausible FindImplausible(const PoseFile& poses, const MapFile& map) {
  return Judge(poses, map).Find();
}

const Where& FirstBodyWhere(const ImportMap& map) {
  return std::ranges::find_if(map.entities,
                              [](const auto& entity) { return entity.value.from.has_value(); })
      ->value.from->where;
}

Approach NearestApproach(const PoseFile& poses, const ImportMap& map, double metres_per_unit) {
  Approach nearest;
  const Eigen::Quaterniond turn = map.WorldTurn();
  for (const Named<MappedEntity>& place : map.entities) {
    const MappedEntity& e = place.value;
    if (!e.at_m) continue;
    const Eigen::Quaterniond q(e.quat_wxyz[0], e.quat_wxyz[1], e.quat_wxyz[2], e.quat_wxyz[3]);
    for (const PoseBody& body : poses.bodies) {
      for (const PoseSample& sample : body.samples) {
        const Eigen::Vector3d p_B = q.conjugate() * (turn * (sample.p * metres_per_unit) - *e.at_m);
        const double distance_m = (p_B.cwiseAbs() - e.size_m / 2).cwiseMax(0).norm();
        if (distance_m < nearest.distance_m) nearest = {distance_m, &place, &body};
      }
      LetGo(body.samples);
    }
  }
  return nearest;
}

/// Nothing comes near what the map places, and what stands has nothing of it below.
Guess GuessPlace(const PoseFile& poses, const ImportMap& map) {
  Guess guess{FirstBodyWhere(map),
              Warning::kPlace,
              {},
              "correct its at_m (z up, metres, after the change of axes), or unit, or axes"};
  const Approach nearest = NearestApproach(poses, map, map.MetresPerUnit());
  if (!nearest.place || nearest.distance_m <= kNear_m) return guess;
  guess.where = nearest.place->name_where;
  guess.signs.push_back(fmt::format("nothing tracked comes nearer to '{}' than {:.2f} m ('{}')",
                                    nearest.place->name, nearest.distance_m, nearest.comes->name));
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  const auto stands = std::ranges::find(seen.rests, true, &Rest::stands);
  if (stands != seen.rests.end())
    guess.signs.push_back(fmt::format("'{}' stands where the map has nothing",
                                      seen.entities[stands->body]->from->value));
  return guess;
}

}  // namespace prehend::exchange
