// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_poses.h. Tested by tests/program/import_test.cc
#include "harness/exchange/import/import_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "grammar/base/tracking.h"
#include "grammar/base/wording.h"
#include "harness/base/yaml/error_at.h"
#include "harness/exchange/import/import_warnings.h"
#include "harness/exchange/import/rest_poses.h"

namespace prehend::exchange {
namespace {

constexpr double kMostSpeed_m_per_s = 20;  ///< of a hand that throws; faster is a jump
constexpr double kGap = 1.5;               ///< of the usual step: longer is a gap
constexpr double kFarthest_m = 1e4;        ///< of the recording format
constexpr double kTrembles_m = 0.0008;     ///< more than this hides how things move

std::string EpisodeName(const ImportMap& map, const std::string& path) {
  if (!map.episode.empty()) return map.episode;
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_plain) c = '_';
  }
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "take_" + name;
  return name;
}

struct Pose {
  double t_s = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  bool after_loss = false;  ///< how it came here is not known
};

/// An entity over time.
struct Track {
  std::vector<Pose> poses;
  bool lost_before = false, lost_after = false;  ///< before its first and after its last pose
  std::size_t next = 0;  ///< the first one that is later than the present time

  Pose At(double t_s) {
    while (next < poses.size() && poses[next].t_s <= t_s) ++next;
    if (next == 0) return poses.front();
    const Pose& before = poses[next - 1];
    if (next == poses.size() || poses[next].after_loss) return before;
    const Pose& after = poses[next];
    const double part = (t_s - before.t_s) / (after.t_s - before.t_s);
    if (part <= 0) return before;
    return {.t_s = t_s,
            .p = before.p + part * (after.p - before.p),
            .q = before.q.slerp(part, after.q)};
  }
};

/// The poses from `begin` on, up to where it is lost.
std::size_t EndOfSight(const std::vector<Pose>& poses, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < poses.size() && !poses[end].after_loss) ++end;
  return end;
}

/// The mean of the poses at most `half_s` before or after each; less at both ends, so that it is
/// not drawn to one side.
std::vector<Pose> Smoothed(const std::vector<Pose>& poses, double half_s) {
  std::vector<Pose> smooth = poses;
  for (std::size_t begin = 0; begin < poses.size(); begin = EndOfSight(poses, begin)) {
    const std::size_t end = EndOfSight(poses, begin);
    for (std::size_t i = begin, first = begin; i < end; ++i) {
      const double t_s = poses[i].t_s;
      const double to_end_s = std::min(t_s - poses[begin].t_s, poses[end - 1].t_s - t_s);
      const double reach_s = std::min(half_s, to_end_s) + 1e-9;
      while (poses[first].t_s < t_s - half_s - 1e-9) ++first;
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      Eigen::Vector4d q = Eigen::Vector4d::Zero();
      double count = 0;
      for (std::size_t k = first; k < end && poses[k].t_s <= t_s + reach_s; ++k) {
        if (poses[k].t_s < t_s - reach_s) continue;
        p += poses[k].p;
        const double sign = poses[k].q.dot(poses[i].q) < 0 ? -1 : 1;
        q += sign * poses[k].q.coeffs();
        ++count;
      }
      smooth[i].p = p / count;
      smooth[i].q = Eigen::Quaterniond(q.normalized());
    }
  }
  return smooth;
}

/// How far a pose is off the polynomial of degree `order` - 1 through as many of its neighbours, as
/// the standard deviation that noise on each axis would have: half of all are below that times the
/// median of a chi distribution of three axes.
double OffNeighbours_m(const std::vector<Pose>& poses, std::size_t order) {
  constexpr double kMedianOfThree = 1.538;
  std::vector<double> off;
  for (std::size_t last = order; last < poses.size(); ++last) {
    const std::span<const Pose> some(&poses[last - order], order + 1);
    if (std::ranges::any_of(some.subspan(1), &Pose::after_loss)) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0;
    for (const Pose& pose : some) {
      double weight = 1;
      for (const Pose& other : some) {
        if (&other != &pose)
          weight *= (some.back().t_s - some.front().t_s) / (pose.t_s - other.t_s);
      }
      sum += weight * pose.p;
      squares += weight * weight;
    }
    off.push_back(sum.norm() / std::sqrt(squares));
  }
  return Median(std::move(off)) / kMedianOfThree;
}

/// The standard deviation of its position on each axis, as far as it is noise. A smooth path bends
/// from frame to frame, but a polynomial through six neighbours follows it; what repeats faster
/// than every four frames is off both.
double Trembling_m(const std::vector<Pose>& poses) {
  constexpr double kOfTrembling = 3.2;  // largest share of both that such repetition has
  const double bends_m = OffNeighbours_m(poses, 2), rough_m = OffNeighbours_m(poses, 6);
  return bends_m < kOfTrembling * rough_m ? bends_m : rough_m;
}

/// Whether nobody knows where it was at the time of the last At().
bool IsLost(const Track& track, double t_s) {
  if (track.next == 0) return track.lost_before;
  if (track.poses[track.next - 1].t_s >= t_s) return false;
  return track.next == track.poses.size() ? track.lost_after : track.poses[track.next].after_loss;
}

class Importer {
 public:
  Importer(const PoseFile& file, const MapFile& map)
      : file_(file), map_(map.map), document_(map.document), errors_(map.document) {}

  Result<Imported> Import() {
    Describe();
    for (const Named<MappedEntity>& entity : map_.entities) AddTrack(entity);
    WarnOfTrembling();
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    if (const std::string problem = SetTicks(); !problem.empty())
      return tl::unexpected(grammar::Diagnostics{
          {.file = file_.file, .place = {}, .message = problem, .source_line = {}, .hint = {}}});
    AddFrames();
    WarnOfRestPoses();
    WarnOfNoOrientations();
    for (const std::string& body : file_.unused)
      Warn(fmt::format("the file has '{}', which the map does not mention", body));
    for (const std::string& note : file_.notes) Warn(note);
    return std::move(imported_);
  }

 private:
  void Warn(std::string text) { imported_.warnings.push_back(std::move(text)); }

  void WarnOfRestPoses() {
    DoubtfulThings turned;
    if (const auto range = RangeTooSmall(file_, map_); range && !map_.IsSure(Warning::kUnit))
      return Warn(
          fmt::format("{}: {}; or, if it is right, sure: [unit]", range->text, range->remedy));
    if (!map_.IsSure(Warning::kUpright)) turned = FindNotUpright(imported_.episode, map_);
    for (std::string& text : turned.warnings) Warn(std::move(text));
    DoubtfulThings large = ThingsTooLarge(map_);
    for (std::string& text : large.warnings) Warn(std::move(text));
    turned.things.merge(large.things);
    if (std::string text = RestOnNothing(imported_.episode, turned.things); !text.empty())
      Warn(std::move(text));
    if (std::string text = TiltOfRestPlane(imported_.episode, map_.WorldTurn(), turned.things);
        !text.empty())
      Warn(std::move(text));
  }

  void Describe() {
    imported_.duration_s = file_.last_s;
    episode::EpisodeHeader& header = imported_.episode.header;
    header.episode = EpisodeName(map_, file_.file);
    header.grammar = map_.grammar.value;
    if (document_.root.Find("grammar"))
      header.grammar_named = ErrorAt(document_, map_.grammar.where);
    header.bridge_s = map_.bridge_s;
    header.entity_table.ticks_per_second = map_.ticks_per_second;
    for (const Named<MappedEntity>& entity : map_.entities) {
      const MappedEntity& e = entity.value;
      grammar::EntityInfo& info = header.entity_table.entities.emplace_back();
      info.name = entity.name;
      info.half_size_m = e.size_m / 2;
      if (e.hand) {
        info.classes = {"Hand", "Entity"};
        info.sensor_sets = {"fingers", "thumb", "palm"};
      } else {
        info.classes = {e.class_name, e.fixed ? "Fixed" : "Movable", "Thing", "Entity"};
      }
    }
  }

  void AddTrack(const Named<MappedEntity>& entity) {
    const MappedEntity& e = entity.value;
    EntityReport report{.name = entity.name, .from = {}, .extent = {}};
    Track track;
    if (e.at_m) {
      track.poses.push_back({.t_s = 0, .p = *e.at_m, .q = Quaternion(e.quat_wxyz)});
    } else {
      report.from = e.from->value;
      const PoseBody& body = *std::ranges::find(file_.bodies, report.from, &PoseBody::name);
      track.poses = Converted(body, e);
      if (e.upright_at_s) report.axes = (map_.WorldTurn() * OrientationThen(body, e)).conjugate();
      MarkGaps(body, e, track, report);
      WarnOfMotion(body, entity, track.poses, report);
      const double trembling_m = Trembling_m(track.poses);
      if (map_.smooth_s > 0) track.poses = Smoothed(track.poses, map_.smooth_s / 2);
      NoteTrembling(trembling_m, track.poses, report);
    }
    for (const Pose& pose : track.poses) report.extent.extend(pose.p);
    if (report.extent.min().minCoeff() < -kFarthest_m ||
        report.extent.max().maxCoeff() > kFarthest_m)
      errors_.Add(entity.name_where, fmt::format("'{}' is farther than {:g} m from the origin",
                                                 entity.name, kFarthest_m));
    imported_.entities.push_back(std::move(report));
    tracks_.push_back(std::move(track));
  }

  static Eigen::Quaterniond Quaternion(const Eigen::Vector4d& wxyz) {
    return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
  }

  /// At upright_at_s, as in the file.
  static Eigen::Quaterniond OrientationThen(const PoseBody& body, const MappedEntity& entity) {
    const double t_s = entity.upright_at_s->value;
    const auto then = std::ranges::min_element(
        body.samples, {}, [&](const PoseSample& sample) { return std::abs(sample.t_s - t_s); });
    return then->q;
  }

  std::vector<Pose> Converted(const PoseBody& body, const MappedEntity& entity) const {
    const Eigen::Quaterniond turn = map_.WorldTurn(), axes = map_.AxesTurn();
    const double scale = map_.MetresPerUnit();
    const auto upright = [&](const Eigen::Quaterniond& q) { return turn * q * axes.conjugate(); };
    Eigen::Quaterniond rest = Eigen::Quaterniond::Identity();
    if (entity.upright_at_s) rest = upright(OrientationThen(body, entity)).conjugate();
    std::vector<Pose> poses;
    for (const PoseSample& sample : body.samples) {
      const Eigen::Quaterniond q =
          entity.axes_quat_wxyz
              ? (turn * sample.q * Quaternion(entity.axes_quat_wxyz->value)).normalized()
              : (upright(sample.q) * rest).normalized();
      poses.push_back(
          {.t_s = sample.t_s, .p = turn * (sample.p * scale) + q * entity.offset_m, .q = q});
    }
    return poses;
  }

  void MarkGaps(const PoseBody& body, const MappedEntity& entity, Track& track,
                EntityReport& report) {
    std::vector<Pose>& poses = track.poses;
    const double usual_s = UsualStep_s(body);
    report.poses = poses.size();
    report.rate_hz = usual_s > 0 ? 1 / usual_s : 0;
    double longest_s = 0, longest_from_s = 0, bridge_s = 0;
    const auto take = [&](double from_s, double until_s, bool within) {
      const double gap_s = until_s - from_s;
      if (gap_s <= kGap * usual_s) return false;
      const bool lost = gap_s > map_.bridge_s + 1e-9 || !within;
      (lost ? report.lost : report.bridged) += 1;
      (lost ? report.lost_s : report.bridged_s) += gap_s;
      if (lost && within) bridge_s = std::max(bridge_s, std::ceil(100 * gap_s - 1e-6) / 100);
      if (lost && gap_s > longest_s) {
        longest_s = gap_s;
        longest_from_s = from_s;
      }
      return lost;
    };
    track.lost_before = take(0, poses.front().t_s, false);
    for (std::size_t i = 1; i < poses.size(); ++i)
      poses[i].after_loss = take(poses[i - 1].t_s, poses[i].t_s, true);
    track.lost_after = take(poses.back().t_s, file_.last_s, false);
    if (report.lost == 0) return;
    const std::string text = fmt::format(
        "'{}' is not tracked for {:.3f} s from {:.3f} s on; in all {}, {:.3f} s", report.from,
        longest_s, longest_from_s, grammar::CountOf(report.lost, "such time"), report.lost_s);
    if (map_.lost == Lost::kHold) return Warn(text + ": it is held where it was, at rest");
    if (map_.lost == Lost::kUnknown) return Warn(text + ": nobody knows where it is");
    errors_.Add(entity.from->where, text,
                fmt::format("in the map: lost: unknown (nobody knows where it is meanwhile){}, or "
                            "lost: hold (it stays where it was)",
                            bridge_s > 0 ? fmt::format(", or bridge_s: {:g} (a straight line over "
                                                       "the whole time)",
                                                       bridge_s)
                                         : ""));
  }

  void WarnOfMotion(const PoseBody& body, const Named<MappedEntity>& entity,
                    const std::vector<Pose>& poses, const EntityReport& report) {
    std::size_t jumps = 0, uneven = 0, worst = 0;
    double fastest = 0;
    const double usual_s = 1 / report.rate_hz;
    Eigen::AlignedBox3d extent;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      extent.extend(poses[i].p);
      if (i == 0) continue;
      const double step_s = poses[i].t_s - poses[i - 1].t_s;
      uneven += std::abs(step_s / usual_s - 1) > 0.2;
      const double speed = (poses[i].p - poses[i - 1].p).norm() / step_s;
      if (poses[i].after_loss || speed < kMostSpeed_m_per_s) continue;
      ++jumps;
      if (speed <= fastest) continue;
      fastest = speed;
      worst = i;
    }
    if (jumps > 0)
      Warn(fmt::format("{}: '{}' jumps {}, here {:.3f} m in {:.4f} s ({:.0f} m/s)",
                       body.samples[worst].line > 0
                           ? fmt::format("{}:{}", file_.file, body.samples[worst].line)
                           : fmt::format("{}, {:.3f} s", file_.file, poses[worst].t_s),
                       report.from, grammar::CountOf(jumps, "time"),
                       (poses[worst].p - poses[worst - 1].p).norm(),
                       poses[worst].t_s - poses[worst - 1].t_s, fastest));
    if (uneven * 10 > poses.size())
      Warn(fmt::format("'{}': {} of {} steps are more than 20 % off the usual {:.4f} s",
                       report.from, uneven, poses.size() - 1, usual_s));
    if (entity.value.hand && extent.diagonal().norm() < 0.01)
      Warn(fmt::format("the hand '{}' never leaves {:.1f} mm", entity.name,
                       extent.diagonal().norm() * 1e3));
  }

  /// `as_read_m`: how much it trembles in the file, which decides over how long to take means.
  void NoteTrembling(double as_read_m, const std::vector<Pose>& poses, const EntityReport& report) {
    const double trembling_m = map_.smooth_s > 0 ? Trembling_m(poses) : as_read_m;
    if (trembling_m <= kTrembles_m) return;
    trembling_.push_back("'" + report.from + "'");
    trembles_m_ = std::max(trembles_m_, trembling_m);
    smooth_s_ = std::max(smooth_s_, std::ceil(10 * as_read_m / kTrembles_m / report.rate_hz) / 10);
  }

  /// One line for all: the remedy is one for the file.
  void WarnOfTrembling() {
    if (trembling_.empty()) return;
    const bool one = trembling_.size() == 1;
    Warn(fmt::format("{} {} by {}{:.1f} mm from frame to frame, which hides how {}{}",
                     fmt::join(trembling_, ", "), one ? "trembles" : "tremble", one ? "" : "up to ",
                     1e3 * trembles_m_, one ? "it moves" : "they move",
                     smooth_s_ > map_.smooth_s
                         ? fmt::format("; smooth_s: {:g} takes means over that long", smooth_s_)
                         : ""));
  }

  /// What nobody can judge without them.
  void WarnOfNoOrientations() {
    if (file_.has_orientations) return;
    std::size_t poses = 0;
    for (const PoseBody& body : file_.bodies) poses += body.samples.size();
    Warn(
        fmt::format("the file has positions only, {} of {} {}, and no orientations: every tilt(..) "
                    "is 0, so no pouring is recognised, hold_tips cannot tell what is tipped in a "
                    "hand from what was put down, and up is always up in a thing (boxes, offset_m)",
                    poses, file_.bodies.size(), file_.bodies.size() == 1 ? "body" : "bodies"));
  }

  std::int64_t TickOf(double t_s) const {
    return std::llround(t_s * static_cast<double>(map_.ticks_per_second));
  }

  /// The times of all poses. Returns what is wrong, or "".
  std::string SetTicks() {
    for (const Track& track : tracks_) {
      for (std::size_t i = 0; i < track.poses.size(); ++i) {
        if (i > 0 && TickOf(track.poses[i].t_s) == TickOf(track.poses[i - 1].t_s))
          return fmt::format(
              "two poses are {:.3g} s apart, and a second has {} ticks; give the "
              "map more ticks_per_second",
              track.poses[i].t_s - track.poses[i - 1].t_s, map_.ticks_per_second);
        times_.emplace(TickOf(track.poses[i].t_s), track.poses[i].t_s);
      }
    }
    times_.emplace(0, 0.0);
    times_.emplace(TickOf(file_.last_s), file_.last_s);
    if (times_.size() > episode::kMaxEpisodeFrames)
      return fmt::format("{} different times; a recording has at most {} frames", times_.size(),
                         episode::kMaxEpisodeFrames);
    return "";
  }

  void AddFrames() {
    episode::Recording& episode = imported_.episode;
    episode::EpisodeFrame before;
    double before_s = 0;
    for (const auto& [tick, t_s] : times_) {
      episode::EpisodeFrame frame;
      frame.tick = tick;
      for (std::size_t i = 0; i < tracks_.size(); ++i) {
        const std::size_t passed = tracks_[i].next;
        const Pose pose = tracks_[i].At(t_s);
        grammar::EntitySample& sample = frame.entities.emplace_back();
        sample.p_WB_m = pose.p;
        sample.q_WB = pose.q;
        if (!before.entities.empty() && !Found(tracks_[i], passed) &&
            grammar::IsTracked(before.entities[i]))
          SetVelocity(before.entities[i], t_s - before_s, sample);
        if (map_.lost == Lost::kUnknown && IsLost(tracks_[i], t_s)) sample = grammar::NotTracked();
        if (map_.entities[i].value.hand) {
          frame.hands.push_back({.entity = static_cast<int>(i),
                                 .ahead_W = pose.q * AheadOf(map_.entities[i].value),
                                 .collision_spheres = {}});
          frame.collision_spheres.push_back({{pose.p, 0}});
        }
      }
      episode.frames.push_back(frame);
      before = std::move(frame);
      before_s = t_s;
    }
    episode.placed.assign(tracks_.size(), true);
    episode.says_its_end = true;
    episode.end_tick = episode.frames.back().tick + 1;
  }

  static Eigen::Vector3d AheadOf(const MappedEntity& hand) {
    return hand.ahead ? Eigen::Vector3d(hand.ahead->value.normalized()) : Eigen::Vector3d::UnitX();
  }

  /// Whether it was found again since `passed` poses had been passed: then its way is not known.
  static bool Found(const Track& track, std::size_t passed) {
    for (std::size_t i = passed; i < track.next; ++i) {
      if (track.poses[i].after_loss) return true;
    }
    return false;
  }

  static void SetVelocity(const grammar::EntitySample& before, double dt_s,
                          grammar::EntitySample& sample) {
    sample.v_WB_m_per_s = (sample.p_WB_m - before.p_WB_m) / dt_s;
    const Eigen::AngleAxisd turn(sample.q_WB * before.q_WB.conjugate());
    sample.w_WB_rad_per_s = turn.axis() * turn.angle() / dt_s;
  }

  const PoseFile& file_;
  const ImportMap& map_;
  const YamlDocument& document_;
  DiagnosticList errors_;
  Imported imported_;
  std::vector<Track> tracks_;
  std::map<std::int64_t, double> times_;
  std::vector<std::string> trembling_;
  double trembles_m_ = 0;  ///< the most
  double smooth_s_ = 0.2;  ///< over so long means no longer tremble
};

}  // namespace

Result<Imported> ImportPoses(const std::string& poses_path, const std::string& map_path) {
  const Result<PoseFormat> format = PoseFormatOf(poses_path);
  if (!format) return tl::unexpected(format.error());
  const Result<MapFile> map = ReadImportMap(map_path, *format);
  if (!map) return tl::unexpected(map.error());
  constexpr std::array kReaders = {ReadCsvPoses, ReadBvhPoses, ReadMcapPoses};
  const Result<PoseFile> poses = kReaders[static_cast<std::size_t>(*format)](poses_path, *map);
  if (!poses) return tl::unexpected(poses.error());
  if (grammar::Diagnostics warnings = FindImportWarnings(*poses, *map); !warnings.empty())
    return tl::unexpected(std::move(warnings));
  return Importer(*poses, *map).Import();
}

}  // namespace prehend::exchange
