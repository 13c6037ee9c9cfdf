// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/doubts/plausibility.h.
//
// Which way is up is told by four signs: what is carried from rest to rest is lifted on the way;
// what stands has the map's tables below; things that are set down anew have turned about up; heads
// are above feet. Turns, and how a thing lies in the hand that carries it, tell the order of
// quaternions, too.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "harness/exchange/doubts/plausibility.h"

namespace prehend::exchange {
namespace {

constexpr double kLift_m = 0.05,
                 kDip_m = 0.02;  ///< what is lifted does not get lower than it stood
constexpr double kWay_m = 0.1;   ///< what got so far was moved
constexpr double kNearTop_m = 0.05, kOneHeight_m = 0.02;
constexpr double kTurned_deg = 15, kAbout_deg = 20;
constexpr double kInHand_m = 0.015;  ///< in the hand that carries it, root mean square
constexpr double kWaits_m = 0.005;
constexpr double kCarried_m_per_s = 7;
constexpr double kNowhere_m = 0.5, kThere_m = 0.15;  ///< from what the map places
constexpr double kUprightMost_deg = 10, kAskew_deg = 30;
constexpr double kBeside_m = 0.05;  ///< a right hand from a left one

double DegreesFrom(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(std::abs(a.normalized().dot(b)), 0.0, 1.0)) *
         (180 / static_cast<double>(EIGEN_PI));
}

/// How far its own up is from `up`.
double TiltOf(const Eigen::Quaterniond& q, const Eigen::Vector3d& up) {
  return std::acos(std::clamp((q * up).dot(up), -1.0, 1.0)) * (180 / static_cast<double>(EIGEN_PI));
}

/// Of all that could tell, how much speaks for it and how much against it.
struct Votes {
  int yes = 0, no = 0;
  bool Agree() const { return yes > 0 && yes >= 4 * no; }
  bool Deny() const { return no > 0 && no >= 4 * yes; }
};

/// Components of the other order, read as w, x, y, z.
Eigen::Quaterniond Reordered(const Eigen::Quaterniond& q, bool was_wxyz) {
  return was_wxyz ? Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y())
                  : Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w());
}

class WayUp {
 public:
  WayUp(const MotionSeen& seen, const ImportMap& map) : seen_(seen), map_(map) {
    for (const std::vector<BodyLook>& looks : seen.looks) {
      std::vector<std::size_t>& jumps = last_jump_.emplace_back(looks.size());
      for (std::size_t k = 1; k < looks.size(); ++k) {
        const double way_m = (looks[k].p_m - looks[k - 1].p_m).norm();
        jumps[k] = way_m > kCarried_m_per_s * seen.look_s ? k : jumps[k - 1];
      }
    }
  }

  /// What stood, was carried, and stands again, is lifted along `up`.
  Votes Lifts(const Eigen::Vector3d& up, double& highest_m, std::string& example) const {
    Votes votes;
    for (std::size_t i = 1; i < seen_.rests.size(); ++i) {
      const Rest &from = seen_.rests[i - 1], &to = seen_.rests[i];
      if (from.body != to.body || !from.stands || !to.stands || Jumps(from, to)) continue;
      Eigen::AlignedBox1d heights;
      Eigen::AlignedBox3d extent;
      for (std::size_t k = from.begin; k < to.end; ++k) {
        const Eigen::Vector3d& p = seen_.looks[from.body][k].p_m;
        if (!p.allFinite()) continue;
        heights.extend(Eigen::Matrix<double, 1, 1>(p.dot(up)));
        extent.extend(p);
      }
      if (extent.diagonal().norm() < kWay_m) continue;
      const double begin = from.p_m.dot(up), end = to.p_m.dot(up);
      const double rise_m = heights.max().x() - std::max(begin, end);
      const bool is_lifted =
          rise_m >= kLift_m && std::min(begin, end) - heights.min().x() <= kDip_m;
      ++(is_lifted ? votes.yes : votes.no);
      if (!is_lifted || rise_m <= highest_m) continue;
      highest_m = rise_m;
      example = seen_.entities[from.body]->from->value;
    }
    return votes;
  }

  /// How far what is carried gets off the line between its rests, and whose way it is, at most.
  Eigen::Vector3d OffLine(std::string& whose) const {
    Eigen::Vector3d most = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < seen_.rests.size(); ++i) {
      const Rest &from = seen_.rests[i - 1], &to = seen_.rests[i];
      if (from.body != to.body || !from.stands || !to.stands || Jumps(from, to)) continue;
      const Eigen::Vector3d along = (to.p_m - from.p_m).normalized();
      for (std::size_t k = from.begin; k < to.end; ++k) {
        const Eigen::Vector3d way = seen_.looks[from.body][k].p_m - from.p_m,
                              off = way - along * along.dot(way);
        if (off.norm() <= most.norm()) continue;
        most = off;
        whose = seen_.entities[from.body]->from->value;
      }
    }
    return most;
  }

  /// What stands is on top of what the map places, were `turn` the way to the recording.
  Votes OnTops(const Eigen::Quaterniond& turn) const {
    Votes votes;
    for (const Rest& rest : seen_.rests) {
      if (!rest.stands) continue;
      const Eigen::Vector3d p = turn * rest.p_m;
      const Eigen::Vector3d half = seen_.entities[rest.body]->size_m / 2;
      bool is_on = false;
      for (const Named<MappedEntity>& place : map_.entities) {
        const MappedEntity& e = place.value;
        if (!e.at_m) continue;
        const Eigen::Vector3d off = p - *e.at_m;
        // Wherever in it the markers are.
        is_on = is_on || (std::abs(off.x()) < e.size_m.x() / 2 + kNearTop_m &&
                          std::abs(off.y()) < e.size_m.y() / 2 + kNearTop_m &&
                          off.z() > e.size_m.z() / 2 - kNearTop_m &&
                          off.z() < e.size_m.z() / 2 + 2 * half.z() + kNearTop_m);
      }
      ++(is_on ? votes.yes : votes.no);
    }
    return votes;
  }

  /// How far apart the undersides of things are along `up`, where they stand first; of one thing,
  /// infinitely far.
  double Apart_m(const Eigen::Vector3d& up) const {
    Eigen::AlignedBox1d heights;
    std::vector<std::size_t> bodies;
    for (const Rest& rest : seen_.rests) {
      if (!rest.stands || std::ranges::count(bodies, rest.body) > 0) continue;
      bodies.push_back(rest.body);
      const double half_m = seen_.entities[rest.body]->size_m.dot(up.cwiseAbs()) / 2;
      heights.extend(Eigen::Matrix<double, 1, 1>(rest.p_m.dot(up) - half_m));
    }
    return bodies.size() < 2 ? std::numeric_limits<double>::infinity() : heights.sizes().x();
  }

  /// Between two rests things turn about `up`.
  Votes Turns(const Eigen::Vector3d& up, std::optional<bool> reorder_wxyz = {}) const {
    Votes votes;
    for (std::size_t i = 0; i < seen_.rests.size(); ++i) {
      for (std::size_t k = i + 1; k < seen_.rests.size(); ++k) {
        const Rest &a = seen_.rests[i], &b = seen_.rests[k];
        if (a.body != b.body || !a.stands || !b.stands || Jumps(a, b)) continue;
        const auto as_read = [&](const Eigen::Quaterniond& q) {
          return reorder_wxyz ? Reordered(q, *reorder_wxyz) : q;
        };
        const Eigen::AngleAxisd turn(as_read(b.q) * as_read(a.q).conjugate());
        const double degrees = turn.angle() * (180 / static_cast<double>(EIGEN_PI));
        if (degrees < kTurned_deg || degrees > 360 - kTurned_deg) continue;
        ++(DegreesFrom(turn.axis(), up) < kAbout_deg ? votes.yes : votes.no);
      }
    }
    return votes;
  }

 private:
  /// Faster than anybody carries it: what it did there tells nothing.
  bool Jumps(const Rest& from, const Rest& to) const {
    return last_jump_[from.body][to.end - 1] > from.begin;
  }

  const MotionSeen& seen_;
  const ImportMap& map_;
  std::vector<std::vector<std::size_t>> last_jump_;  ///< by body and look; 0: none
};

/// How far things slip in the hands that carry them, as seen from hands that turn, m.
std::optional<double> Slips_m(const MotionSeen& seen, std::optional<bool> reorder_wxyz) {
  double sum = 0;
  std::size_t count = 0;
  for (const Carry& carry : seen.carries) {
    std::vector<Eigen::Vector3d> seen_from;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t k = carry.begin; k < carry.end; ++k) {
      const BodyLook &hand = seen.looks[carry.hand][k], &thing = seen.looks[carry.thing][k];
      const Eigen::Quaterniond q = reorder_wxyz ? Reordered(hand.q, *reorder_wxyz) : hand.q;
      seen_from.push_back(q.conjugate() * (thing.p_m - hand.p_m));
      middle += seen_from.back();
    }
    middle /= static_cast<double>(seen_from.size());
    for (const Eigen::Vector3d& p : seen_from) sum += (p - middle).squaredNorm();
    count += seen_from.size();
  }
  if (count < 10) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

Guess GuessAxes(const PoseFile& poses, const ImportMap& map, bool any_sign) {
  Guess guess{map.UpWhere(), Warning::kAxes, {}, {}};
  const Eigen::Vector3d up = map.Up();
  int nearest = 0;  // of the file's axes to up
  up.cwiseAbs().maxCoeff(&nearest);
  const std::string stated = map.up ? "up" : std::string(1, "xyz"[nearest]);
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  const WayUp way(seen, map);
  const Votes tops = way.OnTops(map.WorldTurn());
  if (tops.Agree()) return guess;  // what stands is where the map says
  double unused = 0;
  std::string nothing;
  const Votes lifts = way.Lifts(up, unused, nothing), turns = way.Turns(up);
  const Approach here = NearestApproach(poses, map, map.MetresPerUnit());
  const double here_m = here.place ? here.distance_m : 0;
  for (const int axis : {1, 2, 0}) {
    if (axis == nearest) continue;
    const Eigen::Vector3d other = Eigen::Vector3d::Unit(axis);
    std::vector<std::string> signs;
    double highest_m = 0;
    std::string example;
    int told = 0;
    if (poses.stature && poses.stature->dot(up) < 0.7 * poses.stature->norm() &&
        (*poses.stature)[axis] > 0.9 * poses.stature->norm())
      signs.push_back(fmt::format(
          "the head is {:.2f} m from the feet along {}, and {:.2f} m along {}: {} looks up",
          (*poses.stature)[axis] * map.MetresPerUnit(), "xyz"[axis],
          poses.stature->dot(up) * map.MetresPerUnit(), stated, "xyz"[axis]));
    const Votes other_lifts = way.Lifts(other, highest_m, example);
    if (lifts.yes == 0 && lifts.no > 0 && other_lifts.no == 0) {
      told += other_lifts.yes;
      signs.push_back(
          fmt::format("nothing is lifted along {}, but '{}' rises {:.2f} m along {} and comes down "
                      "again: {} looks up",
                      stated, example, highest_m, "xyz"[axis], "xyz"[axis]));
    }
    // Of things that stand at one height, the map has the table at another: that is not about up.
    const double level_m = way.Apart_m(up), other_level_m = way.Apart_m(other);
    const bool is_level = level_m < kOneHeight_m && other_level_m > kWay_m / 2;
    ImportMap upright = map;
    upright.up.reset();
    upright.axes = Located<int>{axis, {}};
    if (const Votes other_tops = way.OnTops(upright.WorldTurn());
        !is_level && tops.Deny() && other_tops.Agree()) {
      told += 2 * other_tops.yes;
      signs.push_back(fmt::format("with {} up, what stands would have what the map places below it",
                                  "xyz"[axis]));
    }
    if (const double near_m = NearestApproach(poses, upright, map.MetresPerUnit()).distance_m;
        !is_level && !seen.rests.empty() && here_m > kNowhere_m && near_m < kThere_m) {
      told += 3;
      signs.push_back(
          fmt::format("with {} up, something tracked comes to what the map places, to which "
                      "nothing comes nearer than {:.2f} m now",
                      "xyz"[axis], here_m));
    }
    const Votes other_turns = way.Turns(other);
    if (turns.Deny() && other_turns.Agree()) {
      told += other_turns.yes;
      signs.push_back(fmt::format("what is set down anew has turned about {}", "xyz"[axis]));
    }
    // One alone is worth a word if it is told again and again.
    if (signs.size() < guess.signs.size() ||
        signs.size() < (any_sign || poses.stature || told >= 3 ? 1U : 2U))
      continue;
    guess.signs = std::move(signs);
    guess.remedy = fmt::format("axes: {}_up", "xyz"[axis]);
  }
  return guess;
}

std::string LiftedAskew(const PoseFile& poses, const ImportMap& map) {
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  const WayUp way(seen, map);
  double highest_m = 0;
  std::string whose;
  const Votes lifts = way.Lifts(map.Up(), highest_m, whose);
  const Eigen::Vector3d off = way.OffLine(whose);
  if (lifts.yes > 0 || lifts.no == 0 || off.norm() < kLift_m) return "";
  const Eigen::Array3d up = (100 * off.normalized().array()).round() / 100 + 0.0;  // no "-0"
  return fmt::format(
      "nothing is lifted along up; '{}' is carried {:.2f} m off the line from where it stood to "
      "where it stands: if that was up, up: [{:.2f}, {:.2f}, {:.2f}] in the place of axes",
      whose, off.norm(), up.x(), up.y(), up.z());
}

namespace {

/// How far a body goes while none of `others` is within reach of it, m.
double WayAlone_m(const MotionSeen& seen, std::size_t body, bool others_are_hands) {
  double way_m = 0;
  const std::vector<BodyLook>& looks = seen.looks[body];
  for (std::size_t k = 1; k < looks.size(); ++k) {
    const double step_m = (looks[k].p_m - looks[k - 1].p_m).norm();
    if (!(step_m > kMoves_m_per_s * seen.look_s)) continue;
    bool alone = true;
    for (std::size_t other = 0; alone && other < seen.looks.size(); ++other) {
      if (seen.entities[other]->hand != others_are_hands) continue;
      const MappedEntity& thing = *seen.entities[others_are_hands ? body : other];
      // Of what is lost nobody knows.
      alone =
          (seen.looks[other][k].p_m - looks[k].p_m).norm() > thing.size_m.norm() / 2 + kHandReach_m;
    }
    if (alone) way_m += step_m;
  }
  return way_m;
}

/// Things do not come to hands that wait for them.
std::vector<std::string> HandsThatAreFetched(const MotionSeen& seen) {
  constexpr double kComes_m = 0.1, kOfIt = 0.1;
  std::set<std::pair<std::size_t, std::size_t>> pairs;  // of thing and hand
  for (const Carry& carry : seen.carries) pairs.emplace(carry.thing, carry.hand);
  std::vector<std::string> lines;
  for (const auto& [thing, hand] : pairs) {
    const double way_m = WayAlone_m(seen, thing, true);
    if (way_m < kComes_m || WayAlone_m(seen, hand, false) > kOfIt * way_m) continue;
    const std::string& is_thing = seen.entities[thing]->from->value;
    const std::string& is_hand = seen.entities[hand]->from->value;
    lines.push_back(fmt::format(
        "the thing '{}' goes {:.2f} m with no hand near, and the hand '{}' moves only together "
        "with it: are they exchanged? (from: {} and from: {}); or, if not, sure: [place]",
        is_thing, way_m, is_hand, is_hand, is_thing));
  }
  return lines;
}

/// A gripper is wider open than what it carries, before or after.
std::vector<std::string> GrippersTheOtherWay(const PoseFile& poses, const ImportMap& map,
                                             const MotionSeen& seen) {
  constexpr double kAlike = 0.05, kClearly = 0.1;  // of the way from closed to open
  std::vector<std::string> lines;
  for (const OpeningSeries& series : poses.openings) {
    const MappedEntity& hand = map.entities[series.entity].value;
    std::vector<double> carrying;
    double widest = 0, least = 1;  // of the rest
    for (const OpeningSeries::Sample& sample : series.samples) {
      const bool carries = std::ranges::any_of(seen.carries, [&](const Carry& carry) {
        const double look = sample.t_s / seen.look_s;
        return seen.entities[carry.hand] == &hand && look >= static_cast<double>(carry.begin) &&
               look < static_cast<double>(carry.end);
      });
      if (carries) carrying.push_back(sample.open);
      if (!carries) widest = std::max(widest, sample.open), least = std::min(least, sample.open);
    }
    const double held = Median(carrying);
    if (!series.is_grip || carrying.size() < 10 || held < widest - kAlike ||
        held < least + kClearly)
      continue;
    lines.push_back(
        fmt::format("the gripper '{}' is never wider open than while it carries things: are open "
                    "and closed exchanged? (open: {:g}, closed: {:g}); or, if not, sure: [place]",
                    hand.from->value, hand.grip->closed, hand.grip->open));
  }
  return lines;
}

}  // namespace

std::vector<std::string> OddlyHeld(const PoseFile& poses, const ImportMap& map) {
  constexpr double kFar_m = 0.03;  // from the surface: grip_near of grasp_from_gripper
  if (map.IsSure(Warning::kPlace)) return {};
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  std::map<std::size_t, std::array<std::vector<double>, 3>> held;  // by hand, in its axes
  std::map<std::size_t, std::vector<double>> gaps_m;
  for (const Carry& carry : seen.carries) {
    const MappedEntity &hand = *seen.entities[carry.hand], &thing = *seen.entities[carry.thing];
    for (std::size_t k = carry.begin; hand.grip && k < carry.end; ++k) {
      const BodyLook &at = seen.looks[carry.hand][k], &look = seen.looks[carry.thing][k];
      const Eigen::Vector3d off_m =
          at.q.conjugate() * (look.p_m + look.q * thing.offset_m - at.p_m) - hand.offset_m;
      gaps_m[carry.hand].push_back(off_m.norm() - thing.size_m.maxCoeff() / 2);
      for (const std::size_t i : {0U, 1U, 2U})
        held[carry.hand][i].push_back(off_m[static_cast<Eigen::Index>(i)]);
    }
  }
  std::vector<std::string> lines = HandsThatAreFetched(seen);
  for (std::string& line : GrippersTheOtherWay(poses, map, seen)) lines.push_back(std::move(line));
  for (const auto& [hand, axes] : held) {
    if (Median(gaps_m[hand]) < kFar_m) continue;
    const Eigen::Vector3d& now = seen.entities[hand]->offset_m;
    lines.push_back(fmt::format(
        "what the gripper '{}' carries is {:.2f} m off its origin, which must lie between its "
        "finger tips: offset_m: [{:.3f}, {:.3f}, {:.3f}]; or, if it is right, sure: [place]",
        seen.entities[hand]->from->value,
        Eigen::Vector3d(Median(axes[0]), Median(axes[1]), Median(axes[2])).norm(),
        now.x() + Median(axes[0]), now.y() + Median(axes[1]), now.z() + Median(axes[2])));
  }
  return lines;
}

Guess GuessOrder(const PoseFile& poses, const ImportMap& map) {
  const bool is_wxyz = poses.quaternion_order == QuaternionOrder::kWxyz;
  Guess guess{map.quaternion_order ? map.quaternion_order->where : FirstBodyWhere(map),
              Warning::kOrder,
              {},
              fmt::format("quaternion_order: {}", is_wxyz ? "xyzw" : "wxyz")};
  // A body that stands as when it was defined has w near 1; grippers point down.
  std::set<std::string> grippers;
  for (const Named<MappedEntity>& entity : map.entities)
    if (entity.value.grip && entity.value.from) grippers.insert(entity.value.from->value);
  const double w = MedianOfPoses(
      poses, [](const auto& at) { return std::abs(at.q.w()); }, grippers);
  const double other_w = MedianOfPoses(
      poses, [&](const auto& at) { return std::abs(is_wxyz ? at.q.z() : at.q.x()); }, grippers);
  // Names of columns that say w are believed, but where nothing turns and w is nothing.
  const auto& names = map.columns.quaternion;
  const std::string is_w = names.empty() ? "" : names[is_wxyz ? 0 : 3].value;
  const bool says_w = is_w.ends_with('w') || is_w.ends_with('W');
  const bool looks_so = w <= (says_w ? 0.05 : 0.5) && other_w >= (says_w ? 0.99 : 0.85);
  if (looks_so)
    guess.signs.push_back(
        fmt::format("the {} of four numbers, as w, is {:.2f} (median, without its sign), the {} is "
                    "{:.2f}: this looks like {}",
                    is_wxyz ? "first" : "last", w, is_wxyz ? "last" : "first", other_w,
                    is_wxyz ? "xyzw" : "wxyz"));
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  const WayUp way(seen, map);
  const Votes turns = way.Turns(map.Up()), other_turns = way.Turns(map.Up(), is_wxyz);
  if (turns.Deny() && other_turns.Agree())
    guess.signs.push_back(
        "what is set down anew would have turned about up in the other order only");
  const auto slips_m = Slips_m(seen, {}), other_m = Slips_m(seen, is_wxyz);
  const bool slips = slips_m && *slips_m > kInHand_m && *other_m < *slips_m / 3;
  if (slips)
    guess.signs.push_back(fmt::format(
        "things slip by {:.0f} mm in the hands that carry them, in the other order by {:.0f} mm",
        1e3 * *slips_m, 1e3 * *other_m));
  // What stands, is carried and carries mostly stays upright; of some the map says when.
  std::vector<double> askew_deg, other_askew_deg;
  for (std::size_t body = 0; body < seen.looks.size(); ++body) {
    if (SaysAxes(*seen.entities[body]) || seen.entities[body]->grip) continue;
    for (const BodyLook& look : seen.looks[body]) {
      if (!look.p_m.allFinite()) continue;
      askew_deg.push_back(TiltOf(look.q, map.Up()));
      other_askew_deg.push_back(TiltOf(Reordered(look.q, is_wxyz), map.Up()));
    }
  }
  const double askew = Median(std::move(askew_deg)),
               other_askew = Median(std::move(other_askew_deg));
  const bool is_askew =
      !says_w && !looks_so && askew > kAskew_deg && other_askew < kUprightMost_deg;
  if (is_askew)
    guess.signs.push_back(fmt::format(
        "bodies are {:.0f} degrees away from upright (median), in the other order {:.0f}", askew,
        other_askew));
  // Turns alone are few.
  if (!looks_so && !slips && !is_askew && guess.signs.size() == 1) guess.signs.clear();
  return guess;
}

/// More than a turn; or less than half of one in the other unit, while something turns smoothly.
Guess GuessAngleUnit(const PoseFile& poses, const ImportMap& map) {
  constexpr double kMost_rad = 7, kHalf_rad = 3.15, kTurns_deg = 0.5, kSmooth = 10,
                   kDegrees = 180 / EIGEN_PI;
  const bool in_degrees = map.angles_in_degrees && map.angles_in_degrees->value;
  Guess guess{map.angles_in_degrees ? map.angles_in_degrees->where : FirstBodyWhere(map),
              Warning::kAngles,
              {},
              in_degrees              ? "angle_unit: rad"
              : map.angles_in_degrees ? "angle_unit: deg"
                                      : "angles in radians, which these files have"};
  if (!in_degrees && poses.most_angle > kMost_rad)
    guess.signs.push_back(fmt::format(
        "angles of up to {:.4g} are read as radians: they look like degrees", poses.most_angle));
  if (!in_degrees || poses.most_angle > kHalf_rad || poses.most_angle == 0) return guess;
  double turned = 0;  // in the file's unit
  for (const PoseBody& body : poses.bodies) {
    std::vector<double> steps;
    double most = 0;
    for (std::size_t i = 1; i < body.samples.size(); ++i) {
      steps.push_back(body.samples[i].q.angularDistance(body.samples[i - 1].q) * kDegrees);
      most = std::max(most, body.samples[i].q.angularDistance(body.samples[0].q) * kDegrees);
    }
    LetGo(body.samples);
    if (most > kSmooth * Median(std::move(steps))) turned = std::max(turned, most);
  }
  if (turned > kTurns_deg)
    guess.signs.push_back(
        fmt::format("angles of up to {:.3g} are read as degrees, and nothing turns by more than "
                    "{:.2g} degrees; in radians that is {:.0f}",
                    poses.most_angle, turned, turned * kDegrees));
  return guess;
}

/// A right hand is to the right of a left one, as both see what they work with.
Guess GuessHandedness(const PoseFile& poses, const ImportMap& map) {
  const std::string other = map.is_left_handed ? "right" : "left";
  Guess guess{FirstBodyWhere(map), Warning::kHanded, {}, "handed: " + other};
  const MotionSeen seen = MotionIn(poses, map, map.MetresPerUnit());
  std::array<std::size_t, 2> hands{};  // left, right
  std::array<int, 2> named{};
  std::size_t body = 0;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    if (entity.value.hand)
      for (const std::size_t side : {0U, 1U})
        if (entity.name.find(side ? "right" : "left") != std::string::npos) {
          hands[side] = body;
          ++named[side];
        }
    ++body;
  }
  if (named != std::array{1, 1}) return guess;
  std::vector<double> beside_m;
  for (const Rest& rest : seen.rests) {
    if (!rest.stands) continue;
    for (std::size_t k = rest.begin + 1; k < rest.end; ++k) {
      // Hands that work may cross; where they wait they do not.
      const auto waits = [&](std::size_t hand) {
        const Eigen::Vector3d& p = seen.looks[hand][k].p_m;
        return (p - seen.looks[hand][k - 1].p_m).norm() < kWaits_m &&
               (p - rest.p_m).norm() > 2 * kHandReach_m;
      };
      if (!waits(hands[0]) || !waits(hands[1])) continue;
      const Eigen::Vector3d &left = seen.looks[hands[0]][k].p_m,
                            &right = seen.looks[hands[1]][k].p_m;
      const Eigen::Vector3d ahead = rest.p_m - (left + right) / 2;
      const Eigen::Vector3d aside = ahead.cross(map.Up());
      const double m = (right - left).dot(aside.normalized());
      if (!std::isnan(m)) beside_m.push_back(m);
    }
  }
  const auto left_of = static_cast<std::size_t>(
      std::ranges::count_if(beside_m, [](double m) { return m < -kBeside_m; }));
  if (beside_m.size() < 20 || 10 * left_of < 7 * beside_m.size()) return guess;
  guess.signs.push_back(
      fmt::format("the right hand is {:.2f} m to the left of the left hand, as they see what "
                  "stands before them: the file's axes look {}-handed, or the hands are exchanged",
                  -Median(std::move(beside_m)), other));
  return guess;
}

}  // namespace prehend::exchange
