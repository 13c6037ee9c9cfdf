// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/pose_file.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <fstream>
#include <map>

#include "harness/base/base/median.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

constexpr double kOnALine_m = 0.005;  ///< no marker is farther off the line of two
constexpr std::size_t kLooks = 1000;  ///< frames of which the shape is the median

using Points = std::vector<Eigen::Vector3d>;

struct MarkerFrame {
  int line = 0;
  std::vector<std::optional<Eigen::Vector3d>> at;  ///< of each marker

  std::size_t Seen() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(at, [](const auto& p) { return p.has_value(); }));
  }
};

struct Fit {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  double off = 0;  ///< the farthest marker from its place
};

/// The motion that brings `shape` nearest to `seen` (Horn 1987: the quaternion is the eigenvector
/// of the largest eigenvalue).
Fit FitOf(const Points& shape, const Points& seen) {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    a += shape[i] / static_cast<double>(shape.size());
    b += seen[i] / static_cast<double>(shape.size());
  }
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < shape.size(); ++i) s += (shape[i] - a) * (seen[i] - b).transpose();
  Eigen::Matrix4d n;
  const Eigen::Vector3d skew(s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
  n(0, 0) = s.trace();
  n.block<3, 1>(1, 0) = skew;
  n.block<1, 3>(0, 1) = skew.transpose();
  n.block<3, 3>(1, 1) = s + s.transpose() - s.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector4d v = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  Fit fit;
  fit.q = Eigen::Quaterniond(v[0], v[1], v[2], v[3]).normalized();
  if (fit.q.w() < 0) fit.q.coeffs() *= -1;
  fit.p = b - fit.q * a;
  for (std::size_t i = 0; i < shape.size(); ++i)
    fit.off = std::max(fit.off, (fit.p + fit.q * shape[i] - seen[i]).norm());
  return fit;
}

/// The first point that is off the line of the first two; 0: none is.
std::size_t OffTheLine(const Points& points, double least) {
  if (points.size() < 3) return 0;
  const Eigen::Vector3d along = points[1] - points[0];
  if (along.norm() < least) return 0;
  for (std::size_t i = 2; i < points.size(); ++i)
    if (along.normalized().cross(points[i] - points[0]).norm() >= least) return i;
  return 0;
}

/// The mean is the origin, x points from the first to the second, the third is in x and y.
Points InOwnAxes(const Points& points, std::size_t third) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d axes;
  axes.row(0) = (points[1] - points[0]).normalized();
  axes.row(2) = axes.row(0).cross((points[third] - points[0]).transpose()).normalized();
  axes.row(1) = axes.row(2).cross(axes.row(0));
  Points own;
  for (const Eigen::Vector3d& p : points) own.push_back(axes * (p - mean));
  return own;
}

class MarkerBody {
 public:
  MarkerBody(const Named<MappedEntity>& entity, const ImportMap& map, PoseFile& poses)
      : name_(entity.name), e_(entity.value), map_(map), poses_(poses) {
    const std::size_t count = e_.markers.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto marker = std::ranges::find(poses.markers, e_.markers[i].value, &PoseBody::name);
      for (const PoseSample& sample : marker->samples) {
        MarkerFrame& frame = frames_[sample.t_s];
        frame.at.resize(count);
        frame.line = sample.line;
        frame.at[i] = sample.p;
      }
    }
  }

  void Compose(DiagnosticList& errors) {
    if (const std::string why = FindShape(); !why.empty())
      return errors.Add(e_.markers.front().where, fmt::format("'{}': {}", name_, why));
    std::map<double, Fit> fits;
    MarkerErrors off;
    const double limit = e_.residual_m / map_.MetresPerUnit();
    double sum = 0;
    for (const auto& [t_s, frame] : frames_) {
      const std::optional<Fit> fit = FitTo(frame);
      if (!fit || !off.Take(fit->off, limit, t_s, frame.line)) continue;
      fits.emplace(t_s, *fit);
      sum += fit->off;
    }
    if (2 * off.count > off.of)
      return errors.Add(
          e_.markers.front().where,
          off.Text(name_, "markers", poses_.file, map_.MetresPerUnit(), e_.residual_m),
          "are these markers on one rigid body? If they move by so much, residual_m says it");
    const std::size_t fitted = fits.size();
    Bridge(fits);
    PoseBody& body = *std::ranges::find(poses_.bodies, e_.from->value, &PoseBody::name);
    for (const auto& [t_s, fit] : fits)
      body.samples.push_back({.t_s = t_s, .p = fit.p, .q = fit.q, .line = frames_.at(t_s).line});
    if (!SaysAxes(e_) && !body.samples.empty()) {
      const Eigen::Quaterniond back = body.samples.front().q.conjugate();
      for (PoseSample& sample : body.samples) sample.q = (sample.q * back).normalized();
    }
    poses_.has_orientations = true;
    const double mm = 1e3 * map_.MetresPerUnit();
    poses_.quality += fmt::format(
        "{}: {} markers: off their shape by {:.2f} mm (mean), {:.2f} mm (most, at {:.3f} s); two "
        "seen, bridged in {} poses\n",
        name_, e_.markers.size(), fitted > 0 ? sum / static_cast<double>(fitted) * mm : 0,
        off.most * mm, off.most_s, fits.size() - fitted);
    AddNote(poses_, off.Text(name_, "markers", poses_.file, map_.MetresPerUnit(), e_.residual_m));
  }

 private:
  /// Returns why there is none, or "".
  std::string FindShape() {
    for (const Located<std::string>& marker : e_.markers)
      if (std::ranges::find(poses_.markers, marker.value, &PoseBody::name)->samples.empty())
        return fmt::format("'{}' is never seen", marker.value);
    std::vector<Points> complete;
    for (const auto& [t_s, frame] : frames_) {
      if (frame.Seen() < e_.markers.size()) continue;
      Points& points = complete.emplace_back();
      for (const auto& p : frame.at) points.push_back(*p);
    }
    if (complete.empty()) return "its markers are never all seen at once";
    const double least = kOnALine_m / map_.MetresPerUnit();
    std::size_t third = OffTheLine(complete.front(), least);
    if (third == 0)
      return "its markers are on one line, or at one place: turns about it are not seen";
    shape_ = InOwnAxes(complete.front(), third);
    const std::size_t step = 1 + complete.size() / kLooks;
    for (int round = 0; round < 2; ++round) {
      std::vector<std::vector<double>> values(3 * shape_.size());
      for (std::size_t i = 0; i < complete.size(); i += step) {
        const Fit fit = FitOf(shape_, complete[i]);
        for (std::size_t k = 0; k < values.size(); ++k)
          values[k].push_back(
              (fit.q.conjugate() * (complete[i][k / 3] - fit.p))[static_cast<int>(k % 3)]);
      }
      for (std::size_t k = 0; k < values.size(); ++k)
        shape_[k / 3][static_cast<int>(k % 3)] = Median(std::move(values[k]));
      third = OffTheLine(shape_, least);
      if (third == 0) return "its markers are on one line: turns about it are not seen";
      shape_ = InOwnAxes(shape_, third);
    }
    return "";
  }

  std::optional<Fit> FitTo(const MarkerFrame& frame) const {
    Points of, seen;
    for (std::size_t i = 0; i < shape_.size(); ++i) {
      if (!frame.at[i]) continue;
      of.push_back(shape_[i]);
      seen.push_back(*frame.at[i]);
    }
    if (OffTheLine(of, kOnALine_m / map_.MetresPerUnit()) == 0) return std::nullopt;
    return FitOf(of, seen);
  }

  /// Where two markers are seen for a short time, or more on one line, which do not tell how it is
  /// turned: it turns evenly, and those that are seen say where it is.
  void Bridge(std::map<double, Fit>& fits) const {
    std::map<double, Fit> between;
    for (const auto& [t_s, frame] : frames_) {
      const auto after = fits.upper_bound(t_s);
      if (fits.contains(t_s) || after == fits.begin() || after == fits.end() || FitTo(frame) ||
          frame.Seen() < 2)
        continue;
      const auto before = std::prev(after);
      if (after->first - before->first > map_.bridge_s + 1e-9) continue;
      const double part = (t_s - before->first) / (after->first - before->first);
      Fit fit{.q = before->second.q.slerp(part, after->second.q)};
      for (std::size_t i = 0; i < shape_.size(); ++i)
        if (frame.at[i])
          fit.p += (*frame.at[i] - fit.q * shape_[i]) / static_cast<double>(frame.Seen());
      between.emplace(t_s, fit);
    }
    fits.merge(between);
  }

  const std::string& name_;
  const MappedEntity& e_;
  const ImportMap& map_;
  PoseFile& poses_;
  std::map<double, MarkerFrame> frames_;
  Points shape_;  ///< in its own axes
};

}  // namespace

void AddNote(PoseFile& poses, std::string note) {
  if (!note.empty()) poses.notes.push_back(std::move(note));
}

std::vector<PoseBody> BodiesOf(const ImportMap& map, DiagnosticList& errors) {
  std::vector<PoseBody> bodies;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    const std::string& name = entity.value.from->value;
    if (std::ranges::find(bodies, name, &PoseBody::name) != bodies.end())
      errors.Add(entity.value.from->where, fmt::format("'{}' is two entities", name));
    else
      bodies.push_back({.name = name});
  }
  return bodies;
}

std::vector<OpeningSeries> OpeningsOf(const ImportMap& map) {
  std::vector<OpeningSeries> openings;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    for (const bool is_grip : {true, false}) {
      const MappedEntity& e = map.entities[i].value;
      if (is_grip ? e.grip : e.joint) openings.push_back({.entity = i, .is_grip = is_grip});
    }
  }
  return openings;
}

const Opening& OpeningSeries::Of(const ImportMap& map) const {
  const MappedEntity& e = map.entities[entity].value;
  return is_grip ? *e.grip : *e.joint;
}

void RefuseAbsentBodies(const PoseFile& poses, const ImportMap& map, DiagnosticList& errors) {
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from || map.is_draft) continue;
    const Located<std::string>& from = *entity.value.from;
    const std::size_t count =
        std::ranges::find(poses.bodies, from.value, &PoseBody::name)->samples.size();
    if (count >= map.LeastPoses()) continue;
    errors.AddUnknownName(from.where,
                          fmt::format("'{}' has {} poses in the file; at least {} are needed",
                                      from.value, count, map.LeastPoses()),
                          from.value, poses.unused);
  }
}

void BeginAtZero(PoseFile& poses) {
  for (PoseBody& body : poses.bodies) {
    for (PoseSample& sample : body.samples) sample.t_s -= poses.first_s;
    LetGo(body.samples);
  }
  for (OpeningSeries& opening : poses.openings)
    for (OpeningSeries::Sample& sample : opening.samples) sample.t_s -= poses.first_s;
  for (double& t_s : poses.rows_s) t_s -= poses.first_s;
  poses.last_s -= poses.first_s;
  poses.first_s = 0;
}

void MirrorPoses(const ImportMap& map, PoseFile& poses) {
  for (PoseBody& body : poses.bodies) {
    for (PoseSample& sample : body.samples) {
      sample.p = map.Mirrored(sample.p);
      // Turns are the other way round, but for the part about the mirror's own axis.
      sample.q.vec() = -map.Mirrored(sample.q.vec());
    }
    LetGo(body.samples);
  }
  if (poses.stature) poses.stature = map.Mirrored(*poses.stature);
}

bool IsBag(const std::string& poses_path) { return EndingOf(poses_path) == ".bag"; }
bool IsDb3(const std::string& poses_path) { return EndingOf(poses_path) == ".db3"; }

bool IsJsonOfPoses(const std::string& poses_path) {
  const Result<PoseFormat> format = PoseFormatOf(poses_path);
  std::ifstream file = OpenRegular(poses_path);
  std::string head(200, ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return format && *format == PoseFormat::kJson &&
         head.substr(0, head.find('\n')).find("\"recording\":") == std::string::npos;
}

bool IsNamedAsPoses(const std::string& path) {
  constexpr std::array kTables = {".csv", ".tsv", ".txt", ".trc", ".tum"};
  const Result<PoseFormat> format = PoseFormatOf(path);
  if (!format) return false;
  if (*format == PoseFormat::kCsv)
    return std::ranges::find(kTables, EndingOf(path)) != kTables.end();
  return *format != PoseFormat::kJson || IsJsonOfPoses(path);
}

Result<PoseFormat> PoseFormatOf(const std::string& poses_path) {
  const std::string ending = EndingOf(poses_path);
  if (ending == ".bvh") return PoseFormat::kBvh;
  if (ending == ".hdf5" || ending == ".h5") return PoseFormat::kHdf5;
  if (ending == ".json" || ending == ".jsonl" || ending == ".ndjson") return PoseFormat::kJson;
  if (ending == ".npz") return PoseFormat::kNpz;
  if (ending == ".c3d") return PoseFormat::kC3d;
  if (ending == ".mcap" || ending == ".bag" || ending == ".db3") return PoseFormat::kMcap;
  static const std::array<std::pair<std::string, std::string>, 7> kOthers = {{
      {".npy", "write it with its times and others as .npz: numpy.savez"},
      {".pkl .pickle", "pickles run code when they are read: write its arrays as HDF5 with h5py"},
      {".parquet",
       "write its poses as CSV, or as HDF5 with h5py; Python passes tables (docs/python.md)"},
      {".fbx", "export it as BVH"},
      {".mat", "write its poses to a CSV file: one row a time, named columns"},
      {".xlsx .xls .ods", "save the sheet as CSV"},
      {".zip .gz .zst .zstd .7z", "unpack it"},
  }};
  const auto other = std::ranges::find_if(kOthers, [&](const auto& kind) {
    return !ending.empty() && (kind.first + ' ').find(ending + ' ') != std::string::npos;
  });
  if (other == kOthers.end()) return PoseFormat::kCsv;
  return tl::unexpected(grammar::Diagnostics{
      {.file = ReadableName(poses_path),
       .message = fmt::format(
           "files {} are not read; CSV, BVH, MCAP, bags of ROS, HDF5, JSON, .npz and C3D are",
           ending),
       .hint = other->second}});
}

bool MarkerErrors::Take(double error, double limit, double t_s, int line_of_file) {
  ++of;
  if (error > most) {
    most = error;
    most_s = t_s;
    line = line_of_file;
  }
  count += error > limit ? 1 : 0;
  return error <= limit;
}

std::string MarkerErrors::Text(const std::string& body, const std::string& what,
                               const std::string& file, double metres_per_unit,
                               double limit_m) const {
  if (count == 0) return "";
  const std::string place =
      line > 0 ? fmt::format("{}:{}", file, line) : fmt::format("{:.3f} s", most_s);
  return fmt::format(
      "'{}': in {} of {} frames its {} are more than {:g} mm off (residual_m), most at {}, {:.1f} "
      "mm: it is not tracked there",
      body, count, of, what, 1e3 * limit_m, place, 1e3 * most * metres_per_unit);
}

std::vector<PoseBody> MarkersOf(const ImportMap& map) {
  std::vector<PoseBody> markers;
  for (const Named<MappedEntity>& entity : map.entities)
    for (const Located<std::string>& marker : entity.value.markers)
      if (std::ranges::find(markers, marker.value, &PoseBody::name) == markers.end())
        markers.push_back({.name = marker.value});
  return markers;
}

void ComposeMarkers(const ImportMap& map, PoseFile& poses, DiagnosticList& errors) {
  for (const Named<MappedEntity>& entity : map.entities)
    if (!entity.value.markers.empty()) MarkerBody(entity, map, poses).Compose(errors);
}

}  // namespace prehend::exchange
