// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/input_files.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/hdf5/hdf5_file.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;

constexpr std::size_t kFewFrames = 10;  ///< nothing can be told of so few
constexpr double kMostSkew = 0.01;      ///< of a matrix from a rotation

class RowPoseReader {
 public:
  RowPoseReader(RowSource& source, const MapFile& map, std::string file, double rate_hz,
                RowStream* stream)
      : source_(source),
        stream_(stream),
        map_(map.map),
        errors_(map.document),
        rate_hz_(rate_hz),
        lines_(source.Lines()) {
    poses_.file = std::move(file);
    poses_.bodies = BodiesOf(map_, errors_);
    poses_.openings = OpeningsOf(map_);
    poses_.has_orientations = false;
  }

  Result<PoseFile> Read() {
    if (map_.t) ReadTimes(*map_.t);
    for (const Named<MappedEntity>& entity : map_.entities)
      if (entity.value.from && errors_.empty()) ReadBody(entity.value);
    for (OpeningSeries& opening : poses_.openings) ReadOpening(opening);
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    poses_.rows = frames_;
    if (stream_ && frames_ > 0) poses_.last_s = SecondsAt(frames_ - 1);
    if (stream_) return std::move(poses_);
    poses_.last_s = SecondsAt(frames_ - 1);
    for (std::size_t i = 0; map_.lost == Lost::kInRows && i < frames_; ++i)
      poses_.rows_s.push_back(SecondsAt(i));
    if (frames_ < kFewFrames && map_.lost != Lost::kInRows)
      poses_.notes.push_back(fmt::format("it has only {}, {:.2f} s",
                                         grammar::CountOf(frames_, "frame"), poses_.last_s));
    if (orders_ && !others_) poses_.quaternion_order = map_.quaternion_order->value;
    if (!orders_ && others_ && map_.quaternion_order)
      poses_.notes.emplace_back(
          "'quaternion_order' of the map says nothing here: no orientation is four numbers in a "
          "row");
    if (std::string note = source_.Note(); !note.empty()) poses_.notes.push_back(std::move(note));
    RefuseAbsentBodies(poses_, map_, errors_);
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    return std::move(poses_);
  }

 private:
  /// Of this demonstration, at what the map says.
  void Complain(const Located<std::string>& name, const std::string& what,
                const std::string& hint = {}) {
    errors_.Add(name.where, fmt::format("'{}' {}", name.value, what), hint);
  }

  std::optional<Rows> ReadRows(const Located<std::string>& name) {
    std::optional<Rows> rows = source_.Read(name, errors_);
    if (!rows) return rows;
    shape_ = rows->shape;
    numbers_ += rows->values.size();
    if (numbers_ <= kMostRowNumbers) return rows;
    Complain(name,
             fmt::format("is too much: the map asks for more than {} numbers", kMostRowNumbers),
             "import fewer bodies, or a part of the recording");
    return std::nullopt;
  }

  double SecondsAt(std::size_t frame) const {
    if (!times_.empty()) return times_[frame];
    return static_cast<double>(frame + (stream_ ? stream_->frames : 0)) / rate_hz_;
  }

  std::string Place(std::size_t row) const {
    return row < lines_.size() ? fmt::format("in row {} (line {})", row, lines_[row])
                               : fmt::format("in row {}", row);
  }

  void ReadTimes(const Located<std::string>& name) {
    const std::optional<Rows> rows = ReadRows(name);
    if (!rows || !HasWidth(name, *rows, 1) || !TakesLength(name, *rows)) return;
    if (stream_ && !stream_->first_time && std::isfinite(rows->values[0]))
      stream_->first_time = rows->values[0];
    const double first = stream_ ? stream_->first_time.value_or(0) : rows->values[0];
    for (std::size_t i = 0; i < rows->count; ++i) {
      const bool is_iso = map_.time_unit && map_.time_unit->value == TimeUnit::kIso;
      const double time = is_iso ? AfterMidnight(rows->values[i], first) : rows->values[i];
      const double t_s = (time - first) * map_.SecondsPerUnit();
      if (!std::isfinite(t_s)) return Complain(name, "has no time " + Place(i));
      if (!times_.empty() && t_s < times_.back())
        return Complain(name, fmt::format("goes back from {:.6g} to {:.6g} s {}", times_.back(),
                                          t_s, Place(i)));
      times_.push_back(t_s);
    }
  }

  bool HasWidth(const Located<std::string>& name, const Rows& rows, std::size_t width) {
    if (rows.width == width) return true;
    Complain(name, fmt::format("is {}; expected {} numbers in a row", shape_, width),
             rows.width > width ? source_.Columns(name.value, width) : "");
    return false;
  }

  /// Its rows, one for each frame, of which those of other bodies are as many.
  bool TakesLength(const Located<std::string>& name, const Rows& rows) {
    if (length_ == 0) {
      length_ = rows.count;
      length_of_ = name.value;
      const auto skip = static_cast<std::size_t>(map_.hdf5.skip);
      if (skip < length_) frames_ = length_ - skip;
      if (frames_ == 0)
        Complain(name, fmt::format("has {} rows, and hdf5.skip is {}", length_, skip));
    } else if (rows.count != length_) {
      Complain(name, fmt::format("has {} rows, but '{}' has {}", rows.count, length_of_, length_),
               rows.count + 1 == length_ || rows.count == length_ + 1
                   ? "one of them may have the state before the first action, too"
                   : "");
      return false;
    }
    return frames_ > 0;
  }

  void ReadBody(const MappedEntity& e) {
    const Located<std::string>& name = e.pose ? *e.pose : *e.position;
    const std::optional<Rows> rows = ReadRows(name);
    if (!rows || !TakesLength(name, *rows)) return;
    const bool matrix = e.pose && rows->is_matrix;
    if (!matrix && !HasWidth(name, *rows, e.pose ? 7 : 3)) return;
    std::optional<Rows> turns, first;
    const Located<std::string>* turned = nullptr;
    OrientationFormat format = map_.Orientation();
    for (const auto* one : {&e.quaternion, &e.euler, &e.axis_angle, &e.rotation}) {
      if (!*one) continue;
      turned = &**one;
      turns = ReadRows(**one);
      if (!turns || !TakesLength(**one, *turns)) return;
      if (one == &e.rotation) {
        format.form = turns->width == 9   ? OrientationForm::kMatrix
                      : turns->width == 3 ? OrientationForm::kEuler
                                          : OrientationForm::kQuaternion;
      } else {
        format.form = one == &e.quaternion ? OrientationForm::kQuaternion
                      : one == &e.euler    ? OrientationForm::kEuler
                                           : OrientationForm::kAxisAngle;
      }
      if (!HasWidth(**one, *turns, NumbersOf(format.form)) || !KnowsAngles(**one, format)) return;
      if (turns->by_name) format.order = QuaternionOrder::kXyzw;
    }
    if (e.first) {
      first = ReadRows(*e.first);
      if (!first || (!matrix && !HasWidth(*e.first, *first, 7))) return;
    }
    const bool by_quaternion =
        (e.pose && !matrix) || (turned && format.form == OrientationForm::kQuaternion);
    const bool by_name = turns && turns->by_name;
    if (by_quaternion && !by_name && !map_.quaternion_order)
      return errors_.Add((turned ? *turned : name).where,
                         "quaternion_order is missing: which of the four numbers is w",
                         "quaternion_order: wxyz for Isaac Lab up to 2 and ManiSkill, xyzw for "
                         "Isaac Lab from 3 on and robosuite");
    orders_ = orders_ || (by_quaternion && !by_name);
    others_ = others_ || matrix || (turned && (!by_quaternion || by_name));
    poses_.has_orientations = poses_.has_orientations || e.pose || turned;
    PoseBody& body = *std::ranges::find(poses_.bodies, e.from->value, &PoseBody::name);
    for (std::size_t i = 0; i < frames_; ++i) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(i) + map_.hdf5.skip - e.shift;
      const bool is_first = row < 0 && first;
      if ((row < 0 && !first) || row >= std::ssize(rows->values) / std::ssize(rows->At(0)))
        continue;
      const std::size_t at = is_first ? 0 : static_cast<std::size_t>(row);
      const std::span<const double> numbers = (is_first ? *first : *rows).At(at);
      const std::span<const double> turn = turns ? turns->At(at) : std::span<const double>();
      PoseSample sample{.t_s = SecondsAt(i)};
      if (at < lines_.size()) sample.line = lines_[at];
      std::string why = Convert(format, numbers, turn, matrix, sample);
      if (why == "-") continue;
      if (why.empty() && !body.samples.empty() && sample.t_s <= body.samples.back().t_s)
        why = fmt::format("two poses at {:.6g} s", sample.t_s);
      if (!why.empty()) return Complain(turned ? *turned : name, Place(at) + ": " + why);
      body.samples.push_back(sample);
    }
  }

  /// About which axes three numbers turn, and in what unit.
  bool KnowsAngles(const Located<std::string>& name, OrientationFormat& format) {
    const bool euler = format.form == OrientationForm::kEuler;
    if (!euler && format.form != OrientationForm::kAxisAngle) return true;
    if (source_.knows_angles) {
      format.euler_order = "xyz";
      format.radians_per_unit = 1;
    } else if ((euler && !map_.euler_order) || !map_.angles_in_degrees) {
      Complain(name,
               "has angles: euler_order and angle_unit of the map say which, and in what unit",
               "euler_order: YXZ and angle_unit: deg, of Unity");
      return false;
    }
    return true;
  }

  bool NanIsMissing() const {
    return source_.nan_is_missing || std::ranges::any_of(map_.missing, [](const std::string& text) {
             return text == "nan" || text == "NaN";
           });
  }

  /// What is wrong, "", or "-": it is not tracked.
  std::string Convert(const OrientationFormat& format, std::span<const double> numbers,
                      std::span<const double> turn, bool matrix, PoseSample& sample) {
    const auto finite = [](double v) { return std::isfinite(v); };
    if (!std::ranges::all_of(numbers, finite) || !std::ranges::all_of(turn, finite))
      return NanIsMissing() ? "-" : "it is no number; if that means 'not tracked', missing: [nan]";
    if (matrix) {
      Eigen::Matrix4d m =
          Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
      const auto off = [](const Eigen::Vector4d& v) {
        return (v - Eigen::Vector4d::UnitW()).cwiseAbs().maxCoeff();
      };
      if (off(m.row(3)) > kMostSkew && off(m.col(3)) <= kMostSkew) m.transposeInPlace();
      const Eigen::Matrix3d r = m.topLeftCorner<3, 3>();
      const double skew = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
      if (skew > kMostSkew || r.determinant() < 0 || off(m.row(3)) > kMostSkew)
        return "expected a matrix of a rotation and a place";
      sample.p = m.topRightCorner<3, 1>();
      sample.q = Eigen::Quaterniond(r).normalized();
      return "";
    }
    sample.p = {numbers[0], numbers[1], numbers[2]};
    if (map_.zero_is_missing && sample.p.isZero(0)) return ++poses_.zeros, "-";
    if (numbers.size() == 7) turn = numbers.subspan(3);
    if (turn.empty()) return "";
    // Angles are about x, y and z; they are turned by in another order.
    std::vector<double> ordered(turn.begin(), turn.end());
    for (std::size_t i = 0; format.form == OrientationForm::kEuler && i < 3; ++i)
      ordered[i] = turn[static_cast<std::size_t>((format.euler_order[i] | 0x20) - 'x')];
    return ReadOrientation(format, ordered, sample.q, &poses_.most_angle);
  }

  void ReadOpening(OpeningSeries& opening) {
    const Opening& said = opening.Of(map_);
    const MappedEntity& e = map_.entities[opening.entity].value;
    std::vector<Rows> all;
    for (const Located<std::string>& name : said.from) {
      const std::optional<Rows> rows = ReadRows(name);
      if (!rows) return;
      // Actions are one less than the states around them.
      if (length_ > 0 && rows->count + 1 != length_)
        TakesLength(name, *rows);
      else if (length_ == 0)
        TakesLength(name, *rows);
      all.push_back(*rows);
    }
    for (std::size_t i = 0; i < frames_ && errors_.empty(); ++i) {
      std::vector<double> numbers;
      for (const Rows& rows : all) {
        const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(i) + map_.hdf5.skip - e.shift;
        const auto at = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(row, 0, static_cast<std::ptrdiff_t>(rows.count) - 1));
        numbers.insert(numbers.end(), rows.At(at).begin(), rows.At(at).end());
      }
      const double open = said.FractionOf(numbers);
      if (std::isfinite(open))
        opening.samples.push_back({.t_s = SecondsAt(i), .open = open});
      else if (!NanIsMissing())
        return Complain(said.from.front(), Place(i) + ": it is no number");
    }
  }

  RowSource& source_;
  RowStream* const stream_;  ///< or null
  const ImportMap& map_;
  DiagnosticList errors_;
  const double rate_hz_;
  const std::vector<int> lines_;
  std::vector<double> times_;
  PoseFile poses_;
  std::string shape_;  ///< of what was read last
  std::size_t length_ = 0, frames_ = 0, numbers_ = 0;
  std::string length_of_;
  bool orders_ = false, others_ = false;  ///< some have quaternions; some have none
};

}  // namespace

std::string RowSource::Columns(const std::string& name, std::size_t width) const {
  return fmt::format("the map can say which: {}[0:{}]", Hdf5PartOf(name)->dataset, width);
}

grammar::Diagnostics ErrorOfFile(const std::string& path, std::string why) {
  return {{.file = ReadableName(path), .message = std::move(why)}};
}

Result<std::string> ReadBytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return tl::unexpected(ErrorOfFile(
        path, std::filesystem::exists(path, error) ? "is not a regular file" : "no such file"));
  if (std::filesystem::file_size(path, error) > kMaxPoseFileBytes)
    return tl::unexpected(
        ErrorOfFile(path, fmt::format("it is larger than {} MiB", kMaxPoseFileBytes >> 20)));
  std::ifstream in = OpenInput(path);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in) return tl::unexpected(ErrorOfFile(path, "cannot be read"));
  return std::move(bytes).str();
}

Result<PoseFile> ReadRowPoses(RowSource& source, const MapFile& map, std::string file,
                              double rate_hz, RowStream* stream) {
  return RowPoseReader(source, map, std::move(file), rate_hz, stream).Read();
}

}  // namespace prehend::exchange
