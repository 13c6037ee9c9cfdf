// SPDX-License-Identifier: Apache-2.0
// Simulators write the same motion twice: before and after each action, in the world and in the
// frame of one environment. Where a map mixes these, other datasets of the file show it. Tested by
// tests/program/import_hdf5.py
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/exchange/import/import_poses.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostDatasets = 300, kWidest = 64, kDeepest = 6, kLongest = 20'000;
constexpr double kSame_m = 1e-4;                     ///< what has the same way stays so near to it
constexpr double kTells_m = 0.02;                    ///< what moves less tells nothing
constexpr double kOrigins_m = 0.01;                  ///< two origins are not the same
constexpr double kNoHand_m = 0.3, kGripped_m = 0.2;  ///< a hand moves nothing so far; so near, yes

/// Places over time.
struct Series {
  std::string name;
  std::vector<Eigen::Vector3d> p;
};

/// How one series is the other one.
struct Match {
  int lag = 0;  ///< frames by which the other one comes later
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

std::string FamilyOf(const std::string& name) { return name.substr(0, name.find('/')); }

/// The same way, maybe from another origin, and a frame before or after.
std::optional<Match> MatchOf(const Series& a, const Series& b, double same) {
  Match match;
  double least = INFINITY, most = 0;
  for (const int lag : {0, 1, -1}) {
    Eigen::AlignedBox3d apart;
    for (std::size_t i = lag<0, j = lag> 0; i < a.p.size() && j < b.p.size(); ++i, ++j)
      apart.extend(b.p[j] - a.p[i]);
    const double off = apart.isEmpty() ? INFINITY : apart.diagonal().norm() / 2;
    most = std::max(most, off);
    if (off < least) match = {lag, apart.center()};
    least = std::min(least, off);
  }
  return least < same && 10 * least < most ? std::optional(match) : std::nullopt;
}

class Comparison {
 public:
  Comparison(const Demonstrations& all, std::string group, const PoseFile& poses,
             const MapFile& map)
      : file_(all.file()),
        group_(std::move(group)),
        poses_(poses),
        map_(map.map),
        errors_(map.document),
        metres_(map.map.MetresPerUnit()),
        rate_hz_(all.rate_hz()) {}

  grammar::Diagnostics Find() {
    if (!map_.IsSure(Warning::kTime)) CompareClock();
    if (poses_.rows < kLongest) CompareBelow(group_, 0);
    return errors_.Sorted();
  }

 private:
  Series OfBody(const MappedEntity& e) const {
    const PoseBody& body = *std::ranges::find(poses_.bodies, e.from->value, &PoseBody::name);
    Series series{e.from->value, {}};
    for (const PoseSample& sample : body.samples) series.p.push_back(sample.p);
    return series;
  }

  /// With all series of three numbers below a group, of datasets that are no larger than poses.
  void CompareBelow(const std::string& group, std::size_t depth) {
    const auto names = file_.NamesIn(group);
    for (std::size_t n = 0; names && n < names->size() && depth < kDeepest; ++n) {
      const std::string path = group + "/" + (*names)[n];
      const auto object = file_.Describe(path);
      if (!object || ++looked_ > kMostDatasets || !errors_.empty()) continue;
      if (object->kind == Hdf5Kind::kGroup) CompareBelow(path, depth + 1);
      const std::size_t width = object->Width(), rows = object->Rows(),
                        wanted = poses_.rows + static_cast<std::size_t>(map_.hdf5.skip);
      const bool meant = path.find("target") != std::string::npos ||
                         path.find("action") != std::string::npos;  // and not where it is
      if (object->kind != Hdf5Kind::kFloat || rows < wanted || rows > wanted + 1 || width < 3 ||
          width > kWidest || meant)
        continue;
      const auto values = file_.Read(path);
      const bool matrix = object->shape.size() == 3 && width == 16;
      const std::size_t step = matrix ? 4 : 1;
      for (std::size_t c = matrix ? 3 : 0; values && c + 2 * step < width && (!matrix || c == 3);
           ++c) {
        Series series{path.substr(group_.size() + 1), {}};
        if (width != 3 && !matrix) series.name += fmt::format("[{}:{}]", c, c + 3);
        for (std::size_t at = (wanted - poses_.rows) * width + c; at < values->size(); at += width)
          series.p.emplace_back((*values)[at], (*values)[at + step], (*values)[at + 2 * step]);
        CompareWith(series);
      }
    }
  }

  void CompareWith(const Series& other) {
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from || !errors_.empty() || entity.value.from->value == other.name)
        continue;
      const Series mine = OfBody(entity.value);
      Eigen::AlignedBox3d extent;
      for (const Eigen::Vector3d& p : mine.p) extent.extend(p);
      if (mine.p.size() != poses_.rows || extent.diagonal().norm() * metres_ < kTells_m) continue;
      if (const auto match = MatchOf(mine, other, kSame_m / metres_))
        Judge(entity, mine, other, *match);
    }
  }

  void Judge(const Named<MappedEntity>& entity, const Series& mine, const Series& other,
             const Match& match) {
    if (match.lag != 0 && FamilyOf(mine.name) != FamilyOf(other.name) &&
        !map_.IsSure(Warning::kTime)) {
      for (const Named<MappedEntity>& with : map_.entities) {
        const auto& from = with.value.from;
        if (!from || &with == &entity || FamilyOf(from->value) != FamilyOf(other.name) ||
            with.value.shift != 0)
          continue;
        const bool ahead = match.lag > 0;
        const std::string late = ahead ? mine.name : from->value;
        std::string first = "initial_state" + late.substr(std::min(late.find('/'), late.size()));
        if (!file_.Has(group_ + "/" + first)) first.clear();
        return errors_.Add(
            entity.value.from->where,
            fmt::format("'{}' is a frame {} '{}', which is the same motion, and so of '{}'",
                        mine.name, ahead ? "ahead of" : "behind", other.name, from->value),
            fmt::format("what is written after the action is shifted: {}: {{.., shift: {}{}}}; or, "
                        "if it is right, sure: [time]",
                        ahead ? entity.name : with.name, (ahead ? entity : with).value.shift + 1,
                        first.empty() ? "" : ", first: " + first));
      }
    }
    const double apart_m = match.offset.norm() * metres_;
    if (apart_m < kOrigins_m || entity.value.hand || map_.IsSure(Warning::kPlace)) return;
    for (const Named<MappedEntity>& hand : map_.entities) {
      if (!hand.value.hand || !hand.value.from) continue;
      const Series palm = OfBody(hand.value);
      const double as_is_m = Nearest_m(mine, palm, Eigen::Vector3d::Zero());
      const double moved_m = Nearest_m(mine, palm, match.offset);
      if (as_is_m < kNoHand_m || moved_m > kGripped_m) continue;
      return errors_.Add(
          entity.value.from->where,
          fmt::format("'{}' is {:.2f} m off the frame of '{}': while it moves, '{}' is never "
                      "nearer than {:.2f} m; '{}' has the same motion, and then {:.2f} m",
                      mine.name, apart_m, palm.name, hand.name, as_is_m, other.name, moved_m),
          fmt::format("take '{}'; or, if it is right, sure: [place]", other.name));
    }
  }

  /// How near a hand is while the thing moves.
  double Nearest_m(const Series& thing, const Series& hand, const Eigen::Vector3d& offset) const {
    double nearest = INFINITY;
    for (std::size_t i = 1; i < std::min(thing.p.size(), hand.p.size()); ++i) {
      if ((thing.p[i] - thing.p[i - 1]).norm() * metres_ > 0.002)
        nearest = std::min(nearest, (thing.p[i] + offset - hand.p[i]).norm() * metres_);
    }
    return nearest;
  }

  /// MuJoCo's states begin with the time.
  void CompareClock() {
    const auto states = file_.Describe(group_ + "/states");
    if (!states || states->kind != Hdf5Kind::kFloat || states->shape.size() != 2) return;
    const auto times = file_.Read(group_ + "/states", {.first = 0, .count = 1});
    if (!times || times->size() < 3) return;
    const double step = (times->back() - times->front()) / static_cast<double>(times->size() - 1);
    for (std::size_t i = 1; i < times->size(); ++i)
      if (!(std::abs((*times)[i] - (*times)[i - 1] - step) < 0.01 * step)) return;
    if (std::abs(step * rate_hz_ - 1) > 0.05)
      errors_.Add(
          map_.rate_hz ? map_.rate_hz->where : Where{},
          fmt::format("rate_hz is {:g}, but the times in 'states' are {:.4g} s apart: {:.4g} Hz",
                      rate_hz_, step, 1 / step),
          "correct rate_hz; or, if it is right, sure: [time]");
  }

  const Hdf5File& file_;
  const std::string group_;
  const PoseFile& poses_;
  const ImportMap& map_;
  DiagnosticList errors_;
  const double metres_, rate_hz_;
  std::size_t looked_ = 0;
};

grammar::Diagnostics OfGroup(const std::string& group, grammar::Diagnostics errors) {
  for (grammar::Diagnostic& error : errors) error.message = group + ": " + error.message;
  return errors;
}

}  // namespace

Result<DemonstrationImport> DemonstrationImport::Open(const std::string& poses_path,
                                                      const std::string& map_path) {
  PREHEND_TRY(MapFile map, ReadImportMap(map_path, PoseFormat::kHdf5));
  DemonstrationImport import;
  import.map_ = std::make_unique<MapFile>(std::move(map));
  PREHEND_TRY(import.demonstrations_, Demonstrations::Open(poses_path, *import.map_));
  return import;
}

grammar::Diagnostics DemonstrationImport::WrongInMap() const {
  constexpr std::size_t kLooks = 10;
  const std::size_t step = std::max<std::size_t>(1, groups().size() / kLooks);
  std::size_t looked = 0, refused = 0;
  grammar::Diagnostics first;
  for (std::size_t i = 0; i < groups().size(); i += step) {
    ++looked;
    const std::string& group = groups()[i];
    const Result<PoseFile> poses = demonstrations_->Read(group);
    grammar::Diagnostics wrong;
    if (poses) wrong = OfGroup(group, Comparison(*demonstrations_, group, *poses, *map_).Find());
    if (!wrong.empty()) return wrong;
    const Result<Imported> imported = Import(group);
    refused += !imported;
    if (!imported && first.empty()) first = imported.error();
  }
  return 2 * refused > looked ? first : grammar::Diagnostics{};
}

Result<Imported> DemonstrationImport::Import(const std::string& group) const {
  Result<PoseFile> poses = demonstrations_->Read(group);
  if (!poses) return tl::unexpected(OfGroup(group, std::move(poses.error())));
  Result<Imported> imported = ImportPoses(std::move(*poses), *map_);
  if (!imported) return tl::unexpected(OfGroup(group, std::move(imported.error())));
  return imported;
}

}  // namespace prehend::exchange
