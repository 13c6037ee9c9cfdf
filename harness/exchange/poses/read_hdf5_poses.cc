// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/poses/read_hdf5_poses.h. Tested by tests/program/import_hdf5.py
#include "harness/exchange/poses/read_hdf5_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "grammar/base/wording.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;

constexpr std::size_t kFewFrames = 10;  ///< nothing can be told of so few
constexpr double kMostSkew = 0.01;      ///< of a matrix from a rotation

/// Rows of numbers, of one dataset.
struct Rows {
  std::size_t count = 0, width = 0;
  bool is_matrix = false;
  std::vector<double> values;

  std::span<const double> At(std::size_t row) const { return {&values[row * width], width}; }
};

/// Words, or JSON with words in it, as in LIBERO's problem_info and RoboCasa's ep_meta.
std::string LanguageOf(const std::string& text) {
  std::string words = text;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  for (const char* key : {"language_instruction", "lang"})
    if (json.is_object() && json.contains(key) && json[key].is_string()) words = json[key];
  return ReadableName(words.substr(0, episode::kMaxLanguageBytes / 3));
}

class DemonstrationReader {
 public:
  DemonstrationReader(const Hdf5File& file, const MapFile& map, std::string group, double rate_hz)
      : file_(file),
        map_(map.map),
        errors_(map.document),
        group_(std::move(group)),
        rate_hz_(rate_hz) {
    poses_.file = file.path() + "/" + group_;
    poses_.bodies = BodiesOf(map_, errors_);
    poses_.openings = OpeningsOf(map_);
    poses_.has_orientations = false;
  }

  Result<PoseFile> Read() {
    for (const Named<MappedEntity>& entity : map_.entities)
      if (entity.value.from) ReadBody(entity.value);
    for (OpeningSeries& opening : poses_.openings) ReadOpening(opening);
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    poses_.rows = frames_;
    poses_.last_s = static_cast<double>(frames_ - 1) / rate_hz_;
    if (frames_ < kFewFrames)
      poses_.notes.push_back(fmt::format("it has only {}, {:.2f} s",
                                         grammar::CountOf(frames_, "frame"), poses_.last_s));
    if (orders_ && !others_) poses_.quaternion_order = map_.quaternion_order->value;
    poses_.attributes = Attributes();
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
    const Hdf5Part part = *Hdf5PartOf(name.value);
    const std::string path = group_ + "/" + part.dataset;
    const auto described = file_.Describe(path);
    const auto values = file_.Read(path, part);
    if (!described || !values) {
      const grammar::Diagnostic why = (described ? values.error() : described.error()).front();
      errors_.Add(name.where, why.message, why.hint);
      return std::nullopt;
    }
    Rows rows{.count = described->Rows(), .width = 0, .is_matrix = false, .values = *values};
    if (rows.count > 0) rows.width = rows.values.size() / rows.count;
    if (rows.width == 0 || (part.count != UINT64_MAX && rows.width != part.count)) {
      Complain(name, fmt::format("has nothing there: the dataset is {}", described->Text()));
      return std::nullopt;
    }
    rows.is_matrix = described->shape.size() == 3 && described->shape[1] == 4 && rows.width == 16;
    shape_ = described->Text();
    return rows;
  }

  bool HasWidth(const Located<std::string>& name, const Rows& rows, std::size_t width) {
    if (rows.width == width) return true;
    Complain(name, fmt::format("is {}; expected {} numbers in a row", shape_, width),
             rows.width > width ? fmt::format("the map can say which: {}[0:{}]",
                                              Hdf5PartOf(name.value)->dataset, width)
                                : "");
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
    for (const auto* one : {&e.quaternion, &e.euler, &e.axis_angle}) {
      if (!*one) continue;
      turned = &**one;
      turns = ReadRows(**one);
      if (!turns || !TakesLength(**one, *turns)) return;
      if (!HasWidth(**one, *turns, one == &e.quaternion ? 4 : 3)) return;
    }
    if (e.first) {
      first = ReadRows(*e.first);
      if (!first || (!matrix && !HasWidth(*e.first, *first, 7))) return;
    }
    const bool by_quaternion = (e.pose && !matrix) || e.quaternion;
    if (by_quaternion && !map_.quaternion_order)
      return errors_.Add((e.quaternion ? *e.quaternion : name).where,
                         "quaternion_order is missing: which of the four numbers is w",
                         "quaternion_order: wxyz for Isaac Lab up to 2 and ManiSkill, xyzw for "
                         "Isaac Lab from 3 on "
                         "and robosuite");
    orders_ = orders_ || by_quaternion;
    others_ = others_ || matrix || e.euler || e.axis_angle;
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
      PoseSample sample{.t_s = static_cast<double>(i) / rate_hz_};
      const std::string why = Convert(e, numbers, turn, matrix, sample);
      if (why == "-") continue;
      if (!why.empty())
        return Complain(turned && why.starts_with("turn") ? *turned : name,
                        fmt::format("in row {}: {}", at, why));
      body.samples.push_back(sample);
    }
  }

  bool NanIsMissing() const {
    return std::ranges::any_of(
        map_.missing, [](const std::string& text) { return text == "nan" || text == "NaN"; });
  }

  /// What is wrong, "", or "-": it is not tracked.
  std::string Convert(const MappedEntity& e, std::span<const double> numbers,
                      std::span<const double> turn, bool matrix, PoseSample& sample) const {
    const auto finite = [](double v) { return std::isfinite(v); };
    if (!std::ranges::all_of(numbers, finite) || !std::ranges::all_of(turn, finite))
      return NanIsMissing() ? "-" : "it is no number; if that means 'not tracked', missing: [nan]";
    if (matrix) {
      const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(numbers.data());
      const Eigen::Matrix3d r = m.topLeftCorner<3, 3>();
      const double skew = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
      if (skew > kMostSkew || r.determinant() < 0 ||
          (m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kMostSkew)
        return "expected a matrix of a rotation and a place";
      sample.p = m.topRightCorner<3, 1>();
      sample.q = Eigen::Quaterniond(r).normalized();
      return "";
    }
    sample.p = {numbers[0], numbers[1], numbers[2]};
    if (map_.zero_is_missing && sample.p.isZero(0)) return "-";
    if (e.pose) turn = numbers.subspan(3);
    if (e.pose || e.quaternion) {
      const bool w_first = map_.quaternion_order->value == QuaternionOrder::kWxyz;
      sample.q = w_first ? Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3])
                         : Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]);
      if (std::abs(sample.q.norm() - 1) > kUnitTolerance)
        return fmt::format("expected a unit quaternion, found one of length {:.4g}",
                           sample.q.norm());
      sample.q.normalize();
    } else if (!turn.empty()) {
      const Eigen::Vector3d v(turn[0], turn[1], turn[2]);
      const auto about = [](double angle, const Eigen::Vector3d& axis) {
        return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
      };
      if (e.euler)
        sample.q = about(v[2], Eigen::Vector3d::UnitZ()) * about(v[1], Eigen::Vector3d::UnitY()) *
                   about(v[0], Eigen::Vector3d::UnitX());
      else if (v.norm() > 1e-12)
        sample.q = about(v.norm(), v.normalized());
    }
    return "";
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
        opening.samples.push_back({.t_s = static_cast<double>(i) / rate_hz_, .open = open});
      else if (!NanIsMissing())
        return Complain(said.from.front(), fmt::format("in row {}: it is no number", i));
    }
  }

  /// "@success" is an attribute of the group, "success" a dataset, whose last value counts.
  std::optional<Hdf5Value> ValueOf(const std::optional<Located<std::string>>& key) {
    if (!key) return std::nullopt;
    std::optional<Hdf5Value> value;
    if (key->value.starts_with('@')) {
      value = file_.Attribute(group_, key->value.substr(1));
    } else if (const auto read = file_.Read(group_ + "/" + key->value); read && !read->empty()) {
      value = read->back();
    }
    if (!value) poses_.notes.push_back(fmt::format("it has no '{}'", key->value));
    return value;
  }

  episode::EpisodeAttributes Attributes() {
    episode::EpisodeAttributes attributes;
    if (const auto value = ValueOf(map_.hdf5.success);
        value && std::holds_alternative<double>(*value))
      attributes.success = std::get<double>(*value) != 0;
    if (const auto value = ValueOf(map_.hdf5.language);
        value && std::holds_alternative<std::string>(*value))
      attributes.language = LanguageOf(std::get<std::string>(*value));
    return attributes;
  }

  const Hdf5File& file_;
  const ImportMap& map_;
  DiagnosticList errors_;
  const std::string group_;
  const double rate_hz_;
  PoseFile poses_;
  std::string shape_;  ///< of what was read last
  std::size_t length_ = 0, frames_ = 0;
  std::string length_of_;
  bool orders_ = false, others_ = false;  ///< some have quaternions; some have none
};

}  // namespace

Result<std::vector<std::string>> GroupsLike(const Hdf5File& file, const std::string& pattern) {
  const std::size_t slash = pattern.rfind('/'), star = pattern.find('*');
  const std::string parent = slash == std::string::npos ? "" : pattern.substr(0, slash);
  const std::string before =
      pattern.substr(parent.empty() ? 0 : slash + 1, star - (parent.empty() ? 0 : slash + 1));
  const std::string after = star == std::string::npos ? "" : pattern.substr(star + 1);
  if (star == std::string::npos) return std::vector<std::string>{pattern};
  const auto names = file.NamesIn(parent);
  if (!names) return tl::unexpected(names.error());
  std::vector<std::string> groups;
  for (const std::string& name : *names) {
    if (name.size() < before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after))
      continue;
    const std::string path = parent.empty() ? name : parent + "/" + name;
    if (const auto member = file.Describe(path); !member || member->kind == Hdf5Kind::kGroup)
      groups.push_back(path);
  }
  if (groups.empty())
    return tl::unexpected(file.Error(fmt::format(
        "no group is like '{}': '{}' has {}", pattern, parent.empty() ? "/" : parent,
        names->empty() ? "nothing" : names->front() + (names->size() > 1 ? " .." : ""))));
  return groups;
}

std::optional<double> ControlRateOf(const Hdf5File& file, const std::string& group) {
  const std::size_t slash = group.rfind('/');
  const auto text =
      file.Attribute(slash == std::string::npos ? "" : group.substr(0, slash), "env_args");
  if (!text || !std::holds_alternative<std::string>(*text)) return std::nullopt;
  const auto json = nlohmann::json::parse(std::get<std::string>(*text), nullptr, false);
  if (!json.is_object() || !json.contains("env_kwargs") || !json["env_kwargs"].is_object())
    return std::nullopt;
  const auto rate = json["env_kwargs"].find("control_freq");
  if (rate == json["env_kwargs"].end() || !rate->is_number()) return std::nullopt;
  return rate->get<double>() > 0 ? std::optional(rate->get<double>()) : std::nullopt;
}

Result<Demonstrations> Demonstrations::Open(const std::string& path, const MapFile& map) {
  auto file = Hdf5File::Open(path);
  if (!file) return tl::unexpected(file.error());
  Demonstrations all(std::move(*file), map);
  auto groups = GroupsLike(all.file_, map.map.hdf5.episodes.value);
  if (!groups) return tl::unexpected(groups.error());
  all.groups_ = std::move(*groups);
  const auto& said = map.map.rate_hz;
  const std::optional<double> rate_hz = ControlRateOf(all.file_, all.groups_.front());
  DiagnosticList errors(map.document);
  if (!said && !rate_hz)
    errors.Add(map.document.root.where, "'rate_hz' is missing: the file does not say it",
               "the rate at which actions are given, often rate_hz: 20");
  if (said && rate_hz && std::abs(said->value / *rate_hz - 1) > 0.05 &&
      !map.map.IsSure(Warning::kTime))
    errors.Add(said->where,
               fmt::format("rate_hz: {:g}, but env_args of the file has control_freq {:g}",
                           said->value, *rate_hz),
               "leave out rate_hz; or, if it is right, sure: [time]");
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  all.rate_hz_ = said ? said->value : *rate_hz;
  return all;
}

Result<PoseFile> Demonstrations::Read(const std::string& group) const {
  return DemonstrationReader(file_, *map_, group, rate_hz_).Read();
}

}  // namespace prehend::exchange
