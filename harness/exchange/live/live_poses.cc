// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/live/live_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "harness/base/base/median.h"
#include "harness/exchange/import/import_poses.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostHeadLines = 200;
constexpr std::size_t kMostSteps = 1000;

bool IsJson(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && (line[first] == '{' || line[first] == '[');
}

/// Mostly numbers, or cells of what is not tracked.
bool IsRow(std::string_view line) {
  if (line.starts_with('#')) return false;
  if (IsJson(line)) return true;
  for (const Separator separator :
       {Separator::kComma, Separator::kSemicolon, Separator::kTab, Separator::kSpace}) {
    const std::vector<CsvCell> cells = TableCellsOf(line, separator);
    std::size_t numbers = 0, blanks = 0;
    for (const CsvCell& cell : cells) {
      blanks += cell.text.empty();
      numbers += !cell.text.empty() && NumberOf(cell.text, true).has_value();
    }
    if (numbers >= 3 && 10 * (numbers + blanks) >= 6 * cells.size()) return true;
  }
  return false;
}

}  // namespace

grammar::Diagnostics LivePoses::Take(const std::string& line, episode::EpisodeStream& stream) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of the byte order
  if (line_ == 0 && line.starts_with(kMark)) return Take(line.substr(kMark.size()), stream);
  has_frame_ = false;
  ++line_;
  if (lines_) {
    grammar::Diagnostics wrong = lines_->Take(line);
    for (grammar::Diagnostic& one : wrong)
      if (one.file == name_) one.place.line = line_;
    if (!wrong.empty() || !lines_->row_s()) return wrong;
    return TakeRow(stream);
  }
  head_ += line + "\n";
  const auto count = static_cast<std::size_t>(line_);
  if (!HeadGoesOn(head_).value_or(!IsRow(line))) return Begin(line, stream);
  if (count < kMostHeadLines && head_.size() < kMaxPoseFileBytes / 256) return {};
  return {{.file = name_,
           .place = {line_, 1},
           .message = fmt::format("no row of poses in the first {} lines", line_)}};
}

grammar::Diagnostics LivePoses::Begin(const std::string& row, episode::EpisodeStream& stream) {
  const bool is_json = IsJson(row);
  if (is_json && row.find("\"recording\":") != std::string::npos)
    return {{.file = name_,
             .place = {line_, 1},
             .message = "these are lines of a recording, which says itself what it means",
             .hint = "without --map"}};
  if (is_json) head_ = row + "\n";
  PREHEND_TRY(map_, is_json ? ReadImportMap(map_path_, PoseFormat::kJson)
                            : ReadMapOfHead(ReadYamlFile(map_path_), head_));
  collects_ = is_json || !map_->map.columns.body.empty();
  DiagnosticList errors(map_->document);
  for (const Named<MappedEntity>& entity : map_->map.entities) {
    const auto& upright = entity.value.upright_at_s;
    if (upright && upright->value > 0)
      errors.Add(upright->where, "while poses come, upright_at_s can only be 0: their first one",
                 "axes_quat_wxyz holds for all takes; `import` prints it");
    if (!entity.value.markers.empty())
      errors.Add(entity.value.from->where,
                 "the shape of markers is learned from a whole file; while poses come, a body is "
                 "'from' one of the table");
  }
  if (map_->map.smooth_s > 0 || map_->map.outlier == OutlierRule::kLost)
    notes_.emplace_back(
        "smooth_s and outlier need poses that are still to come: they do nothing here");
  if (const auto& layout = map_->layout;
      layout && layout->ends_at_blank && !layout->name.ends_with("(Objects)"))
    notes_.push_back(layout->name +
                     ": while rows come, the first part is read; of a whole file `import` reads "
                     "Objects, or else Segments, where they follow");
  if (!errors.empty()) return errors.Sorted();
  const std::size_t count = map_->map.entities.size();
  samples_.resize(count);
  triggers_.resize(count);
  upright_.resize(count);
  seen_s_.resize(count);
  opened_.resize(OpeningsOf(map_->map).size());
  for (std::size_t i = 0; i < count; ++i) samples_[i].not_tracked = true;
  if (is_json)
    lines_.emplace(name_, *map_);
  else
    lines_.emplace(name_, head_, *map_);
  std::istringstream head(head_);
  grammar::Diagnostics left_out;
  for (std::string line; std::getline(head, line);)
    if (left_out = lines_->Take(line); !left_out.empty() && !left_out.front().is_warning)
      return left_out;
  std::ostringstream first;
  episode::EpisodeWriter(first, HeaderOf(*map_, name_));
  grammar::Diagnostics wrong = stream.Take(first.str().substr(0, first.str().find('\n')));
  if (wrong.empty() && lines_->row_s()) wrong = TakeRow(stream);
  return wrong.empty() ? left_out : wrong;
}

/// What a row says that the frame at its time has already, or "": "'Cup' has two poses at 1 s".
std::string LivePoses::Known(double row_s) const {
  const bool is_given = frame_s_ != row_s;
  for (const PoseBody& body : lines_->poses().bodies) {
    if (body.samples.empty()) continue;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const auto& from = map_->map.entities[i].value.from;
      if (from && from->value == body.name && (is_given || !samples_[i].not_tracked))
        return fmt::format("'{}' has two poses at {:.6g} s", body.name, row_s);
    }
  }
  for (std::size_t i = 0; i < opened_.size(); ++i) {
    const OpeningSeries& opening = lines_->poses().openings[i];
    if (!opening.samples.empty() && (is_given || opened_[i]))
      return fmt::format("'{}' has two values at {:.6g} s", opening.Of(map_->map).Names(), row_s);
  }
  return "";
}

/// A row with all bodies is a frame. Of rows with one each, those of a time are, and it is whole
/// once it has all that the map asks for, or another time has come.
grammar::Diagnostics LivePoses::TakeRow(episode::EpisodeStream& stream) {
  const ImportMap& map = map_->map;
  const double row_s = *lines_->row_s();
  if (const std::string known = collects_ ? Known(row_s) : "-"; known.empty()) {
    // Of what the map does not ask for; a frame that is given was whole without it.
    if (frame_s_ != row_s && given_s_ && row_s <= *given_s_) return {};
  } else if (collects_ && (frame_s_ == row_s || given_s_ == row_s)) {
    return {{.file = name_, .place = {line_, 1}, .message = known}};
  }
  grammar::Diagnostics wrong;
  if (frame_s_ && *frame_s_ != row_s) wrong = Emit(stream);
  frame_s_ = row_s;
  const PoseFile& poses = lines_->poses();
  bool is_whole = true;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    const MappedEntity& e = map.entities[i].value;
    if (!e.from) continue;
    const PoseBody& body = *std::ranges::find(poses.bodies, e.from->value, &PoseBody::name);
    if (!body.samples.empty()) Add(i, body.samples.back());
    is_whole = is_whole && !samples_[i].not_tracked;
  }
  for (std::size_t i = 0; i < poses.openings.size(); ++i) {
    if (!poses.openings[i].samples.empty()) {
      AddOpening(poses.openings[i]);
      opened_[i] = true;
    }
    is_whole = is_whole && opened_[i];
  }
  if (!collects_ || (is_whole && !has_frame_)) {
    const grammar::Diagnostics more = Emit(stream);
    wrong.insert(wrong.end(), more.begin(), more.end());
  }
  return wrong;
}

void LivePoses::Add(std::size_t entity, PoseSample sample) {
  const ImportMap& map = map_->map;
  const MappedEntity& e = map.entities[entity].value;
  if (map.is_left_handed) {
    sample.p = map.Mirrored(sample.p);
    sample.q.vec() = -map.Mirrored(sample.q.vec());
  }
  if (e.upright_at_s && !upright_[entity]) upright_[entity] = sample.q;
  const PoseSample at = InRecording(sample, e, map, upright_[entity]);
  if (!(at.p.cwiseAbs().maxCoeff() <= episode::kMaxPosition_m))
    too_far_ = fmt::format("'{}' is farther than {:g} m from the origin", map.entities[entity].name,
                           episode::kMaxPosition_m);
  samples_[entity] = {
      .at_m = at.p,
      .quat_wxyz = Located<Eigen::Vector4d>{{at.q.w(), at.q.x(), at.q.y(), at.q.z()}, {}}};
}

void LivePoses::AddOpening(const OpeningSeries& opening) {
  const double open = opening.samples.back().open;
  if (opening.is_grip) {
    triggers_[opening.entity] = 1 - std::clamp(open, 0.0, 1.0);
    return;
  }
  const ImportMap& map = map_->map;
  samples_[opening.entity].joint_fraction = std::clamp(open, 0.0, 1.0);
  const double at = opening.Of(map).PositionAt(open, map);
  if (std::abs(at) > episode::kMaxPosition_m)
    too_far_ = fmt::format("'{}' is at {:g} m or rad; a joint is at most at {:g}",
                           map.entities[opening.entity].name, at, episode::kMaxPosition_m);
  samples_[opening.entity].joint_position = at;
}

/// As an import: how a body came over a gap is not known, and in a pause without rows it is lost,
/// too, unless the map says otherwise.
void LivePoses::TellLosses(episode::FrameEntry& frame) {
  const ImportMap& map = map_->map;
  const double now_s = *frame_s_, step_s = given_s_ ? now_s - *given_s_ : 0;
  if (step_s > 0 && steps_s_.size() < kMostSteps) steps_s_.push_back(step_s);
  const double usual_s = step_s > map.bridge_s ? Median(steps_s_) : 0;
  const auto is_loss = [&](double gap_s) {
    return map.lost != Lost::kInRows && gap_s > map.bridge_s + 1e-9 && gap_s > kGap * usual_s;
  };
  episode::FrameEntry lost;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    const Named<MappedEntity>& entity = map.entities[i];
    if (!entity.value.from) continue;
    lost.samples.push_back({entity.name, {}, {.not_tracked = true}});
    const auto sample =
        std::ranges::find(frame.samples, entity.name, &Named<episode::SampleEntry>::name);
    if (sample == frame.samples.end() || sample->value.not_tracked) continue;
    if (seen_s_[i] && is_loss(now_s - *seen_s_[i]))
      sample->value.v_m_per_s = sample->value.w_rad_per_s = Eigen::Vector3d::Zero();
    seen_s_[i] = now_s;
  }
  if (map.lost == Lost::kHold || !is_loss(step_s) || step_s <= map.bridge_s + kGap * usual_s)
    return;
  const double lost_s = *given_s_ + map.bridge_s;  // at its end a bridge still holds
  lost.tick.value = std::llround(lost_s * static_cast<double>(map.ticks_per_second)) + 1;
  frame.before.push_back(std::move(lost));
}

grammar::Diagnostics LivePoses::Emit(episode::EpisodeStream& stream) {
  const ImportMap& map = map_->map;
  episode::FrameEntry frame;
  frame.tick.value = std::llround(*frame_s_ * static_cast<double>(map.ticks_per_second));
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    const Named<MappedEntity>& entity = map.entities[i];
    const MappedEntity& e = entity.value;
    episode::SampleEntry& sample = samples_[i];
    if (e.at_m) {
      sample.not_tracked = false;
      sample.at_m = *e.at_m;
      sample.quat_wxyz = Located<Eigen::Vector4d>{e.quat_wxyz, {}};
    }
    if (!sample.not_tracked || map.lost != Lost::kHold)
      frame.samples.push_back({entity.name, {}, sample});
    if (e.from) sample.not_tracked = true;
    if (!e.hand || (!e.ahead && !triggers_[i])) continue;
    episode::HandEntry& hand =
        frame.hands.emplace_back(Named<episode::HandEntry>{.name = entity.name}).value;
    hand.trigger = triggers_[i].value_or(0);
    if (e.ahead && sample.quat_wxyz) {  // lost: as it was turned last
      const Eigen::Vector4d& q = sample.quat_wxyz->value;
      hand.ahead = Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * e.ahead->value.normalized();
    }
  }
  TellLosses(frame);
  const double frame_s = *frame_s_;
  given_s_ = frame_s;
  frame_s_.reset();
  opened_.assign(opened_.size(), false);
  if (!too_far_.empty())
    return {{.file = name_, .place = {line_, 1}, .message = std::exchange(too_far_, "")}};
  if (stream.frame() && last_s_ && frame_s <= *last_s_)
    return {{.file = name_,
             .place = {line_, 1},
             .message = fmt::format("times must increase: {:.6g} s comes after {:.6g} s", frame_s,
                                    *last_s_)}};
  grammar::Diagnostics wrong = stream.Take(frame);
  const bool waited = waits_line_ > 0, is_faulty = !wrong.empty() && !waited;
  for (grammar::Diagnostic& one : wrong) one.place = {waited ? waits_line_ : line_, 1};
  waits_line_ = stream.frame() || is_faulty ? 0 : line_;
  if (stream.frame()) last_s_ = frame_s;
  has_frame_ = has_frame_ || stream.frame() != nullptr;
  return wrong;
}

grammar::Diagnostics LivePoses::Finish(episode::EpisodeStream& stream) {
  has_frame_ = false;
  grammar::Diagnostics wrong = frame_s_ ? Emit(stream) : grammar::Diagnostics{};
  for (grammar::Diagnostic& one : stream.LeftOut()) {
    one.place = {waits_line_, 1};
    wrong.push_back(std::move(one));
  }
  return wrong;
}

}  // namespace prehend::exchange
