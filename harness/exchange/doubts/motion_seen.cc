// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/doubts/motion_seen.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace prehend::exchange {
namespace {

constexpr double kStill_m = 0.01;
constexpr std::size_t kLeastStill = 5;  ///< looks
constexpr double kSlips_m = 0.06;       ///< between a hand and what it carries
constexpr double kCarries_m = 0.8;

std::vector<BodyLook> LooksAt(const PoseBody& body, double last_s, double look_s,
                              double metres_per_unit) {
  std::vector<BodyLook> looks(static_cast<std::size_t>(last_s / look_s) + 1);
  std::size_t next = 0;
  for (std::size_t k = 0; k < looks.size(); ++k) {
    const double t_s = static_cast<double>(k) * look_s;
    while (next < body.samples.size() && body.samples[next].t_s < t_s - 1e-9) ++next;
    if (next == body.samples.size() || body.samples[next].t_s >= t_s + look_s) continue;
    looks[k] = {body.samples[next].p * metres_per_unit, body.samples[next].q};
  }
  LetGo(body.samples);
  return looks;
}

class MotionFinder {
 public:
  explicit MotionFinder(MotionSeen& seen) : seen_(seen) {
    for (std::size_t i = 0; i < seen.entities.size(); ++i)
      if (seen.entities[i]->hand) hands_.push_back(i);
  }

  void Find() {
    for (std::size_t body = 0; body < seen_.looks.size(); ++body) {
      if (seen_.entities[body]->hand || seen_.entities[body]->fixed) continue;
      FindRests(body);
      FindCarries(body);
    }
  }

 private:
  void FindRests(std::size_t body) {
    const std::vector<BodyLook>& looks = seen_.looks[body];
    for (std::size_t begin = 0, end = 0; begin < looks.size(); begin = std::max(end, begin + 1)) {
      for (end = begin; end < looks.size() && (looks[end].p_m - looks[begin].p_m).norm() < kStill_m;
           ++end) {
      }
      if (end - begin < kLeastStill) {
        end = begin + 1;
        continue;
      }
      Rest rest{body, begin, end, looks[(begin + end) / 2].p_m, looks[(begin + end) / 2].q, false};
      for (std::size_t k = begin; k < end; ++k) rest.stands = rest.stands || IsAlone(body, k);
      seen_.rests.push_back(rest);
    }
  }

  /// No hand is near, or there is none. Of a hand that is lost nobody knows.
  bool IsAlone(std::size_t body, std::size_t k) const {
    const double reach_m = seen_.entities[body]->size_m.norm() / 2 + kHandReach_m;
    return std::ranges::all_of(hands_, [&](std::size_t hand) {
      return (seen_.looks[hand][k].p_m - seen_.looks[body][k].p_m).norm() > reach_m;
    });
  }

  bool Moves(std::size_t body, std::size_t k) const {
    return (seen_.looks[body][k].p_m - seen_.looks[body][k - 1].p_m).norm() >
           kMoves_m_per_s * seen_.look_s;
  }

  void FindCarries(std::size_t body) {
    for (std::size_t begin = 1, end = 1; begin < seen_.looks[body].size(); begin = end + 1) {
      for (end = begin; end < seen_.looks[body].size() && Moves(body, end); ++end) {
      }
      if (end - begin < 3) continue;
      Carry best{.thing = body, .begin = begin, .end = end};
      double least_m = kSlips_m;
      for (const std::size_t hand : hands_) {
        double near_m = std::numeric_limits<double>::infinity(), far_m = 0;
        for (std::size_t k = begin; k < end; ++k) {
          const double m = (seen_.looks[hand][k].p_m - seen_.looks[body][k].p_m).norm();
          near_m = std::min(near_m, m);
          far_m = std::isnan(m) ? std::numeric_limits<double>::infinity() : std::max(far_m, m);
        }
        if (far_m - near_m >= least_m || far_m > kCarries_m || !Moves(hand, (begin + end) / 2))
          continue;
        least_m = far_m - near_m;
        best.hand = hand;
        best.distance_m = (near_m + far_m) / 2;
      }
      if (least_m < kSlips_m) seen_.carries.push_back(best);
    }
  }

  MotionSeen& seen_;
  std::vector<std::size_t> hands_;
};

}  // namespace

MotionSeen MotionIn(const PoseFile& poses, const ImportMap& map, double metres_per_unit) {
  MotionSeen seen;
  constexpr double kMostLooks = 36'000;  ///< an hour tells enough
  for (const PoseBody& body : poses.bodies)
    seen.look_s = std::max(seen.look_s, 1.01 * UsualStep_s(body.samples));
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    const auto body = std::ranges::find(poses.bodies, entity.value.from->value, &PoseBody::name);
    seen.entities.push_back(&entity.value);
    seen.looks.push_back(LooksAt(*body, std::min(poses.last_s, kMostLooks * seen.look_s),
                                 seen.look_s, metres_per_unit));
  }
  MotionFinder(seen).Find();
  return seen;
}

double UsualStep_s(const PoseSeries& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps.push_back(samples[i].t_s - samples[i - 1].t_s);
  LetGo(samples);
  return Median(std::move(steps));
}

double MedianOfPoses(const PoseFile& poses, const std::function<double(const PoseSample&)>& number,
                     const std::set<std::string>& without) {
  // As bits, numbers that are not negative are sorted alike: 16 bits of it by each time through.
  std::uint64_t median = 0;
  std::size_t before = 0;  ///< how many there are up to it, of those that begin with these bits
  for (const PoseBody& body : poses.bodies)
    if (!without.contains(body.name)) before += body.samples.size();
  if (before == 0) return 0;
  before /= 2;
  for (int shift = 48; shift >= 0; shift -= 16) {
    std::vector<std::size_t> counts(1 << 16);
    for (const PoseBody& body : poses.bodies) {
      if (without.contains(body.name)) continue;
      for (const PoseSample& sample : body.samples) {
        const auto bits = std::bit_cast<std::uint64_t>(number(sample)) >> shift;
        if (bits >> 16 == median) ++counts[bits & 0xFFFF];
      }
      LetGo(body.samples);
    }
    std::size_t next = 0;
    while (before >= counts[next]) before -= counts[next++];
    median = median << 16 | next;
  }
  return std::bit_cast<double>(median);
}

}  // namespace prehend::exchange
