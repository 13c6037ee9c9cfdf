// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/import/import_poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>

#include "grammar/base/diagnostic.h"
#include "grammar/base/frame.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/exchange/doubts/plausibility.h"
#include "harness/exchange/doubts/rest_poses.h"
#include "harness/exchange/import/track.h"
#include "harness/exchange/logs/log_series.h"

namespace prehend::exchange {
namespace {

constexpr double kWholeStep = 0.9;  ///< of the usual step: a frame is missing, at an end
constexpr double kUnmoved_m = 0.001, kSmoothedOff_m = 0.02, kFixedMoves_m = 0.03;
constexpr double kTrembles_m = 0.0008;  ///< more than this hides how things move
constexpr double kMostTrembling_m = 0.5, kTrembleRate_hz = 8;  ///< fewer poses: it is motion

Eigen::Quaterniond Quaternion(const Eigen::Vector4d& wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized();
}

/// Frames at the times of all poses, made whenever they are looked at: of an hour they would take
/// hundreds of megabytes.
class FrameMaker {
 public:
  explicit FrameMaker(ImportMap map) : map_(std::move(map)) {}

  std::vector<Track> tracks;    ///< of the map's entities
  std::vector<Track> openings;  ///< of `series`
  std::vector<OpeningSeries> series;
  std::map<std::int64_t, double> times;  ///< tick -> seconds

  /// `step`: those that are nearer to the one before, in ticks, are left out.
  void EachFrame(const episode::Recording::Look& look, std::int64_t step = 0) {
    for (auto* all : {&tracks, &openings})
      for (Track& track : *all) track.next = 0;
    std::vector last(tracks.size(), std::pair(0.0, grammar::NotTracked()));
    episode::EpisodeFrame frame{.tick = -step};
    for (const auto& [tick, t_s] : times) {
      if (tick - frame.tick < step) continue;
      frame = {.tick = tick};
      frame.entities.reserve(tracks.size());
      for (std::size_t i = 0; i < tracks.size(); ++i) {
        const std::size_t passed = tracks[i].next;
        const PoseSample pose = tracks[i].At(t_s);
        grammar::EntitySample& sample = frame.entities.emplace_back();
        sample.p_WB_m = pose.p;
        sample.q_WB = pose.q;
        const auto& [last_s, before] = last[i];
        const bool follows = !Found(tracks[i], passed) ||
                             (map_.lost == Lost::kInRows && t_s - last_s <= map_.bridge_s + 1e-9);
        if (follows && grammar::IsTracked(before)) SetVelocity(before, t_s - last_s, sample);
        const bool is_lost = map_.lost != Lost::kHold && IsLost(tracks[i], t_s);
        if (is_lost) sample = grammar::NotTracked();
        if (!is_lost) last[i] = {t_s, sample};
        if (map_.entities[i].value.hand) {
          frame.hands.push_back(
              {.entity = static_cast<int>(i), .ahead_W = pose.q * AheadOf(map_.entities[i].value)});
          frame.collision_spheres.push_back({{pose.p, 0}});
        }
      }
      SetOpenings(t_s, frame);
      look(frame);
    }
  }

 private:
  void SetOpenings(double t_s, episode::EpisodeFrame& frame) {
    for (std::size_t i = 0; i < openings.size(); ++i) {
      const double open = openings[i].At(t_s).p.x(), within = std::clamp(open, 0.0, 1.0);
      if (series[i].is_grip) {
        std::ranges::find(frame.hands, static_cast<int>(series[i].entity),
                          &grammar::HandSample::entity)
            ->trigger = 1 - within;
        continue;
      }
      grammar::EntitySample& part = frame.entities[series[i].entity];
      part.joint_fraction = within;
      part.joint_position = series[i].Of(map_).PositionAt(open, map_);
    }
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

  const ImportMap map_;
};

class Importer {
 public:
  Importer(PoseFile file, const MapFile& map, Implausible implausible)
      : file_(std::move(file)),
        map_file_(map),
        map_(map.map),
        errors_(map.document),
        unit_is_doubtful_(implausible.unit),
        world_is_doubtful_(implausible.world),
        place_(GuessPlace(file_, map_)) {
    imported_.warnings = std::move(implausible.warnings);
  }

  Result<Imported> Import() {
    imported_.duration_s = file_.last_s;
    imported_.episode.header = HeaderOf(map_file_, file_.file);
    imported_.episode.header.attributes = file_.attributes;
    for (const Named<MappedEntity>& entity : map_.entities) {
      Track& track = tracks_.emplace_back();
      if (entity.value.at_m)
        track.poses.push_back({.p = *entity.value.at_m, .q = Quaternion(entity.value.quat_wxyz)});
      else
        Convert(entity.value, track);
    }
    JudgeJumps();
    SetRows();
    for (std::size_t i = 0; i < tracks_.size(); ++i) AddTrack(map_.entities[i], tracks_[i]);
    imported_.openings = file_.quality;
    for (const OpeningSeries& opening : file_.openings) AddOpening(opening);
    if (std::ranges::all_of(imported_.entities, [](const EntityReport& report) {
          return report.from.empty() || report.extent.diagonal().norm() < kUnmoved_m;
        }))
      Warn(fmt::format("nothing moves: each body stays within {:g} mm", 1e3 * kUnmoved_m));
    WarnOfTrembling();
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    if (const std::string problem = SetTicks(); !problem.empty())
      return tl::unexpected(grammar::Diagnostics{{.file = file_.file, .message = problem}});
    WarnOfRestPoses(AddFrames());
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    for (std::string& text : UnknownOfBodies(map_, file_)) Warn(std::move(text));
    constexpr std::size_t kMostNamed = 20;
    const std::size_t unused = file_.unused.size(), named = std::min(unused, kMostNamed);
    if (unused > 0)
      Warn(fmt::format("the file has '{}'{}, which the map does not mention",
                       fmt::join(std::span(file_.unused).first(named), "', '"),
                       unused > named ? fmt::format(" and {} more", unused - named) : ""));
    for (const std::string& note : file_.notes) Warn(note);
    return std::move(imported_);
  }

 private:
  void Warn(std::string text) { imported_.warnings.push_back(std::move(text)); }

  /// `seen`: some of the frames.
  void WarnOfRestPoses(const episode::Recording& seen) {
    DoubtfulThings turned;
    if (unit_is_doubtful_) return;
    if (!map_.IsSure(Warning::kUpright)) turned = FindNotUpright(seen, map_);
    for (std::string& text : turned.warnings) Warn(std::move(text));
    DoubtfulThings large = ThingsTooLarge(map_);
    for (std::string& text : large.warnings) Warn(std::move(text));
    turned.things.merge(large.things);
    for (std::string& text : RestOddly(seen, turned.things)) Warn(std::move(text));
    std::string tilt = TiltOfRestPlane(seen, map_, turned.things);
    const bool says_place =
        !world_is_doubtful_ && !place_.signs.empty() && !map_.IsSure(Warning::kPlace);
    if (says_place && place_.signs.size() > 1 && tilt.empty() && turned.things.empty())
      errors_.Add(place_.where, place_.Text(), place_.Remedy());
    else if (says_place)
      Warn(place_.Text() + ": " + place_.Remedy());
    if (!tilt.empty()) Warn(std::move(tilt));
  }

  /// Where the pose of a track that is nearest after a time stands in the file.
  std::string PlaceOf(std::size_t track, double t_s) const {
    const PoseSeries& poses = tracks_[track].poses;
    const auto pose = std::ranges::lower_bound(poses, t_s, {}, &PoseSample::t_s);
    return pose != poses.end() && pose->line > 0 ? fmt::format("{}:{}", file_.file, pose->line)
                                                 : fmt::format("{}, {:.3f} s", file_.file, t_s);
  }

  /// Poses that leave and come back, those of bodies that were taken for each other, and jumps.
  void JudgeJumps() {
    std::vector<const PoseSeries*> poses;
    std::vector<JumpsOfTrack> found;
    for (const Track& track : tracks_) {
      poses.push_back(&track.poses);
      found.push_back(FindJumps(track.poses));
      LetGo(track.poses);
    }
    const auto name = [&](std::size_t i) { return map_.entities[i].value.from->value; };
    const bool drops = map_.outlier == OutlierRule::kLost;
    const char* remedy =
        drops ? ": they count as lost" : "; in the map, outlier: lost makes gaps of these";
    for (const Exchange& exchange : FindExchanges(poses, found))
      Warn(fmt::format("{}: '{}' and '{}' look exchanged from {:.3f} to {:.3f} s",
                       PlaceOf(exchange.a, exchange.begin_s), name(exchange.a), name(exchange.b),
                       exchange.begin_s, exchange.end_s));
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      PoseSeries& track = tracks_[i].poses;
      if (!found[i].jumps.empty()) {
        const Jump& jump = *std::ranges::max_element(found[i].jumps, {}, &Jump::way_m);
        const double step_s = track[jump.at].t_s - track[jump.at - 1].t_s;
        Warn(fmt::format("{}: '{}' jumps {}, here {:.3f} m and {:.0f} degrees in {:.4f} s",
                         PlaceOf(i, track[jump.at].t_s), name(i),
                         grammar::CountOf(found[i].jumps.size(), "time"), jump.way_m, jump.turn_deg,
                         step_s));
      }
      if (found[i].outliers.empty()) continue;
      const Outlier& worst = *std::ranges::max_element(
          found[i].outliers, {}, [](const Outlier& o) { return o.off_m + o.off_deg / 180; });
      Warn(
          fmt::format("{}: '{}' goes out and back {}, here {:.3f} m and {:.0f} degrees off in {}{}",
                      PlaceOf(i, track[worst.begin].t_s), name(i),
                      grammar::CountOf(found[i].outliers.size(), "time"), worst.off_m,
                      worst.off_deg, grammar::CountOf(worst.end - worst.begin, "pose"), remedy));
      for (std::size_t k = found[i].outliers.size(); drops && k-- > 0;)
        track.erase(track.begin() + static_cast<std::ptrdiff_t>(found[i].outliers[k].begin),
                    track.begin() + static_cast<std::ptrdiff_t>(found[i].outliers[k].end));
    }
  }

  void AddTrack(const Named<MappedEntity>& entity, Track& track) {
    const MappedEntity& e = entity.value;
    EntityReport report;
    report.name = entity.name;
    if (!e.at_m) {
      report.from = e.from->value;
      const Kept& kept = kept_[imported_.entities.size()];
      if (kept.upright) report.axes = (map_.WorldTurn() * *kept.upright).conjugate();
      MarkGaps(kept.usual_s, e.from->where, /*of_opening=*/false, track, report);
      WarnOfMotion(entity, track.poses, report);
      const double trembling_m = Trembling_m(track.poses);
      if (map_.smooth_s > 0) {
        PoseSeries smooth = Smoothed(track.poses, map_.smooth_s / 2);
        WarnOfSmoothing(track.poses, smooth, report);
        track.poses = std::move(smooth);
      }
      NoteTrembling(trembling_m, track.poses, report);
    }
    for (const PoseSample& pose : track.poses) report.extent.extend(pose.p);
    LetGo(track.poses);
    if (report.extent.min().minCoeff() < -episode::kMaxPosition_m ||
        report.extent.max().maxCoeff() > episode::kMaxPosition_m)
      errors_.Add(entity.name_where, fmt::format("'{}' is farther than {:g} m from the origin",
                                                 entity.name, episode::kMaxPosition_m));
    imported_.entities.push_back(std::move(report));
  }

  /// As a track whose x is how far it is open.
  void AddOpening(const OpeningSeries& series) {
    const Named<MappedEntity>& entity = map_.entities[series.entity];
    const Opening& said = series.Of(map_);
    Track& track = openings_.emplace_back();
    for (const OpeningSeries::Sample& sample : series.samples)
      track.poses.push_back({.t_s = sample.t_s, .p = {sample.open, 0, 0}});
    if (track.poses.empty())
      return errors_.Add(said.where, fmt::format("'{}' has no value in the file", said.Names()));
    EntityReport report;
    report.name = entity.name;
    report.from = said.Names();
    MarkGaps(UsualStep_s(track.poses), said.where, /*of_opening=*/true, track, report);
    if (OpeningDoubt doubt = JudgeOpening(series, said, file_.file); doubt.is_error)
      errors_.Add(said.where, entity.name + ": " + doubt.text, doubt.hint);
    else if (!doubt.text.empty())
      Warn(fmt::format("'{}': {}", entity.name, doubt.text));
    if (!series.is_grip && !said.unit && map_.MetresPerUnit() != 1)
      Warn(
          fmt::format("'{}': '{}' counts as in the file's unit of positions; if it turns, or has "
                      "another, unit: rad beside 'open' says it",
                      entity.name, said.Names()));
    const auto [least, most] =
        std::ranges::minmax(series.samples, {}, &OpeningSeries::Sample::open);
    const double farthest = std::max(std::abs(said.PositionAt(least.open, map_)),
                                     std::abs(said.PositionAt(most.open, map_)));
    if (!series.is_grip && farthest > episode::kMaxPosition_m)
      errors_.Add(said.where,
                  fmt::format("'{}' is at {:g} m or rad; a joint is at most at {:g}", entity.name,
                              farthest, episode::kMaxPosition_m),
                  "the unit of its values, beside 'open': unit: mm, or another");
    imported_.openings +=
        fmt::format("{}: {} '{}': {} values at {:.1f} Hz, {:.0f} to {:.0f} % open\n", entity.name,
                    series.is_grip ? "grip" : "joint", said.Names(), series.samples.size(),
                    report.rate_hz, std::round(100 * least.open) + 0.0, 100 * most.open);
  }

  /// The file's poses become those of the track.
  void Convert(const MappedEntity& entity, Track& track) {
    Kept& kept = kept_[tracks_.size() - 1];
    PoseBody& body = *std::ranges::find(file_.bodies, entity.from->value, &PoseBody::name);
    PoseSeries& samples = body.samples;
    track.stands = body.stands;
    kept.usual_s = UsualStep_s(samples);
    if (entity.upright_at_s) {
      const double t_s = entity.upright_at_s->value;
      const PoseSample& nearest = *std::ranges::min_element(
          samples, {}, [&](const PoseSample& sample) { return std::abs(sample.t_s - t_s); });
      kept.upright = nearest.q;
      if (t_s > file_.last_s + kGap * kept.usual_s)
        errors_.Add(entity.upright_at_s->where,
                    fmt::format("the file ends at {:.3f} s", file_.last_s));
      else if (std::abs(nearest.t_s - t_s) > std::max(map_.bridge_s, kGap * kept.usual_s))
        Warn(
            fmt::format("'{}' is not tracked at its upright_at_s, {:g} s: its pose at {:.3f} s "
                        "counts",
                        entity.from->value, t_s, nearest.t_s));
    }
    for (PoseSample& sample : samples) sample = InRecording(sample, entity, map_, kept.upright);
    track.poses = std::move(samples);
    LetGo(track.poses);
  }

  /// Whether something is seen between two poses, or before the first or after the last one.
  bool HasRowIn(double from_s, double until_s, bool within) const {
    const auto row = std::ranges::upper_bound(file_.rows_s, from_s);
    return within ? row != file_.rows_s.end() && *row < until_s : from_s < until_s;
  }

  /// What comes after the last row without a pose, longer than a bridge, is lost.
  double EndOfRows_s() const {
    const bool ends_late = map_.end_s && map_.lost != Lost::kInRows &&
                           map_.end_s->value > file_.last_s + map_.bridge_s;
    return ends_late ? map_.end_s->value : file_.last_s;
  }

  void MarkGaps(double usual_s, const Where& where, bool of_opening, Track& track,
                EntityReport& report) {
    PoseSeries& poses = track.poses;
    report.poses = poses.size();
    report.rate_hz = usual_s > 0 ? 1 / usual_s : 0;
    double longest_s = 0, longest_from_s = 0, bridge_s = 0;
    std::size_t own_steps = 0;
    const auto take = [&](double from_s, double until_s, bool within) {
      const double gap_s = until_s - from_s;
      const bool in_rows = map_.lost == Lost::kInRows, is_step = gap_s <= kGap * usual_s,
                 is_long = gap_s > map_.bridge_s + 1e-9;
      const bool passes_row = HasRowIn(from_s, until_s, within) && !track.stands;
      const bool is_long_step = !in_rows && is_step && is_long && passes_row;
      own_steps += within && is_long_step && !map_.says_bridge;
      if (in_rows ? !passes_row
                  : is_step && !(is_long_step && map_.says_bridge) &&
                        (within || gap_s <= kWholeStep * usual_s))
        return false;
      const bool lost =
          in_rows || (is_step ? is_long_step && map_.says_bridge : is_long || !within);
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
      if (take(poses[i - 1].t_s, poses[i].t_s, true)) poses[i].after_loss = true;
    track.lost_after = take(poses.back().t_s, EndOfRows_s(), false);
    LetGo(poses);
    if (own_steps > 0)
      Warn(fmt::format(
          "'{}' {} every {:.3f} s only: straight lines fill {}, longer than bridge_s: {:g}; a "
          "bridge_s in the map holds for these, too",
          report.from, of_opening ? "has a value" : "is seen", usual_s,
          grammar::CountOf(own_steps, "such time"), map_.bridge_s));
    if (report.lost == 0) return;
    const std::string text =
        fmt::format("'{}' {} for {:.3f} s from {:.3f} s on; in all {}, {:.3f} s", report.from,
                    of_opening ? "has no value" : "is not tracked", longest_s, longest_from_s,
                    grammar::CountOf(report.lost, "such time"), report.lost_s);
    if (of_opening && map_.lost != Lost::kRefuse)
      return Warn(text + (track.lost_before ? ": before its first value that one counts" : "") +
                  (track.lost_before && report.lost == 1 ? ""
                   : track.lost_before                   ? "; later it stays as it was"
                                                         : ": it stays as it was"));
    if (map_.lost == Lost::kHold) return Warn(text + ": it is held where it was, at rest");
    if (map_.lost != Lost::kRefuse) return Warn(text + ": nobody knows where it is");
    errors_.Add(where, text,
                fmt::format("in the map: lost: unknown (nobody knows where it is meanwhile){}, or "
                            "lost: hold (it stays where it was)",
                            bridge_s > 0 ? fmt::format(", or bridge_s: {:g} (a straight line over "
                                                       "the whole time)",
                                                       bridge_s)
                                         : ""));
  }

  void WarnOfMotion(const Named<MappedEntity>& entity, const PoseSeries& poses,
                    const EntityReport& report) {
    std::size_t uneven = 0;
    Eigen::AlignedBox3d extent;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      extent.extend(poses[i].p);
      uneven += i > 0 && std::abs((poses[i].t_s - poses[i - 1].t_s) * report.rate_hz - 1) > 0.2;
    }
    if (uneven * 10 > poses.size())
      Warn(fmt::format("'{}': {} of {} steps are more than 20 % off the usual {:.4f} s",
                       report.from, uneven, poses.size() - 1, 1 / report.rate_hz));
    if (entity.value.hand && extent.diagonal().norm() < 0.01)
      Warn(fmt::format("the hand '{}' never leaves {:.1f} mm", entity.name,
                       extent.diagonal().norm() * 1e3));
    if (!entity.value.fixed) return;
    const double way_m = WayOf(poses);
    if (way_m > kFixedMoves_m)
      Warn(
          fmt::format("'{}' moves by {:.2f} m, and the map says that it is fixed, which is only "
                      "what never moves",
                      entity.name, way_m));
  }

  /// Means over a time in which a body turns round cut off where it went.
  void WarnOfSmoothing(const PoseSeries& read, const PoseSeries& smooth,
                       const EntityReport& report) {
    std::size_t off = 0;
    double most_m = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
      const double off_m = (read[i].p - smooth[i].p).norm();
      off += off_m > kSmoothedOff_m;
      most_m = std::max(most_m, off_m);
    }
    if (off * 20 <= read.size()) return;
    Warn(fmt::format(
        "smooth_s: {:g} moves '{}' by more than {:g} mm in {:.0f} % of its poses, by "
        "{:.0f} mm at most: what takes less time than that is smoothed away",
        map_.smooth_s, report.from, 1e3 * kSmoothedOff_m,
        100.0 * static_cast<double>(off) / static_cast<double>(read.size()), 1e3 * most_m));
  }

  /// `as_read_m`: how much it trembles in the file, which decides over how long to take means.
  void NoteTrembling(double as_read_m, const PoseSeries& poses, const EntityReport& report) {
    const double trembling_m = map_.smooth_s > 0 ? Trembling_m(poses) : as_read_m;
    // What goes farther from frame to frame jumps, and means hide nothing of that.
    if (trembling_m <= kTrembles_m || trembling_m > kMostTrembling_m ||
        report.rate_hz < kTrembleRate_hz)
      return;
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
                     smooth_s_ > map_.smooth_s && smooth_s_ <= kMostSmooth_s
                         ? fmt::format("; smooth_s: {:g} takes means over that long", smooth_s_)
                         : ""));
  }

  std::int64_t TickOf(double t_s) const {
    return std::llround(t_s * static_cast<double>(map_.ticks_per_second));
  }

  /// Of all bodies, where they decide what is lost.
  void SetRows() {
    const auto is_slow = [&](const Kept& kept) { return kGap * kept.usual_s > map_.bridge_s; };
    if (map_.lost != Lost::kInRows && std::ranges::none_of(kept_, is_slow)) return;
    for (const Track& track : tracks_)
      for (const PoseSample& pose : track.poses) file_.rows_s.push_back(pose.t_s);
    std::ranges::sort(file_.rows_s);
    const auto again = std::ranges::unique(file_.rows_s);
    file_.rows_s.erase(again.begin(), again.end());
  }

  /// The times of all poses. Returns what is wrong, or "".
  std::string SetTicks() {
    const double most_s = static_cast<double>(episode::kLatestTick / map_.ticks_per_second);
    if (file_.last_s > most_s)
      return fmt::format(
          "its last row is {:g} s after the first; of {} ticks per second, a recording has at most "
          "{:g} s: is 'time_unit' right?",
          file_.last_s, map_.ticks_per_second, most_s);
    std::vector<const Track*> tracks;
    for (const auto* all : {&tracks_, &openings_})
      for (const Track& track : *all) tracks.push_back(&track);
    for (const Track* const track : tracks) {
      const PoseSeries& poses = track->poses;
      auto at = times_.begin();  // most are there already
      for (std::size_t i = 0; i < poses.size(); ++i) {
        if (i > 0 && TickOf(poses[i].t_s) == TickOf(poses[i - 1].t_s))
          return fmt::format(
              "two poses are {:.3g} s apart, and a second has {} ticks; give the "
              "map more ticks_per_second",
              poses[i].t_s - poses[i - 1].t_s, map_.ticks_per_second);
        at = std::next(times_.try_emplace(at, TickOf(poses[i].t_s), poses[i].t_s));
      }
      LetGo(poses);
    }
    times_.emplace(0, 0.0);
    times_.emplace(TickOf(file_.last_s), file_.last_s);
    for (const double t_s : file_.rows_s) times_.emplace(TickOf(t_s), t_s);
    if (map_.end_s && TickOf(map_.end_s->value) <= times_.rbegin()->first)
      errors_.Add(map_.end_s->where,
                  fmt::format("the last row of the file is at {:g} s", file_.last_s));
    if (map_.lost == Lost::kUnknown) AddEndsOfSight();
    if (times_.size() > episode::kMaxEpisodeFrames)
      return fmt::format("{} different times; a recording has at most {} frames", times_.size(),
                         episode::kMaxEpisodeFrames);
    return "";
  }

  /// Where nothing else is seen when a body becomes unknown, there is a frame that says so.
  void AddEndsOfSight() {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      const PoseSeries& poses = tracks_[i].poses;
      for (std::size_t k = 1; k <= poses.size(); ++k) {
        if (!(k < poses.size() ? poses[k].after_loss : tracks_[i].lost_after)) continue;
        const double end_s = poses[k - 1].t_s + map_.bridge_s;
        const std::int64_t tick = TickOf(end_s) + 1;  // at its end a bridge still holds
        const auto next = times_.lower_bound(tick);
        const double next_s = next != times_.end() ? next->second
                              : map_.end_s         ? map_.end_s->value
                                                   : 0;
        if (next_s > end_s + (next != times_.end() ? kGap * kept_[i].usual_s : 0))
          times_.emplace_hint(next, tick, end_s + 1.0 / static_cast<double>(map_.ticks_per_second));
      }
      LetGo(poses);
    }
  }

  /// Returns those that guesses look at.
  episode::Recording AddFrames() {
    episode::Recording& episode = imported_.episode;
    imported_.frames = times_.size();
    episode.placed.assign(tracks_.size(), true);
    episode.says_its_end = true;
    episode.end_tick = map_.end_s ? TickOf(map_.end_s->value) : times_.rbegin()->first + 1;
    maker_->series = std::move(file_.openings);
    episode.play = [maker = maker_](const auto& look) { maker->EachFrame(look); };
    episode::Recording seen{.header = episode.header};
    maker_->EachFrame(
        [&](const episode::EpisodeFrame& frame) { seen.frames.push_back(frame); },
        static_cast<grammar::Tick>(kBetweenLooks_s * static_cast<double>(map_.ticks_per_second)));
    return seen;
  }

  /// Of an entity's poses as they are in the file.
  struct Kept {
    double usual_s = 0;
    std::optional<Eigen::Quaterniond> upright;  ///< at its upright_at_s
  };

  PoseFile file_;
  const MapFile& map_file_;
  const ImportMap& map_;
  DiagnosticList errors_;
  bool unit_is_doubtful_ = false, world_is_doubtful_ = false;
  const Guess place_;
  std::vector<Kept> kept_{map_.entities.size()};
  Imported imported_;
  const std::shared_ptr<FrameMaker> maker_ = std::make_shared<FrameMaker>(map_);
  std::vector<Track>&tracks_ = maker_->tracks, &openings_ = maker_->openings;
  std::map<std::int64_t, double>& times_ = maker_->times;
  std::vector<std::string> trembling_;
  double trembles_m_ = 0, smooth_s_ = 0.2;  ///< the most; over so long means no longer tremble
};

}  // namespace

PoseSample InRecording(const PoseSample& sample, const MappedEntity& entity, const ImportMap& map,
                       const std::optional<Eigen::Quaterniond>& upright) {
  const Eigen::Quaterniond turn = map.WorldTurn(), axes = map.AxesTurn();
  const auto turned = [&](const Eigen::Quaterniond& q) { return turn * q * axes.conjugate(); };
  PoseSample at = sample;
  at.q = entity.axes_quat_wxyz
             ? (turn * sample.q * Quaternion(entity.axes_quat_wxyz->value)).normalized()
             : (turned(sample.q) *
                (upright ? turned(*upright).conjugate() : Eigen::Quaterniond::Identity()))
                   .normalized();
  at.p = turn * (sample.p * map.MetresPerUnit()) + at.q * entity.offset_m;
  return at;
}

Result<Imported> ImportPoses(PoseFile poses, const MapFile& map) {
  if (map.map.is_left_handed) MirrorPoses(map.map, poses);
  Implausible implausible = FindImplausible(poses, map);
  if (!implausible.errors.empty()) return tl::unexpected(std::move(implausible.errors));
  return Importer(std::move(poses), map, std::move(implausible)).Import();
}

}  // namespace prehend::exchange
