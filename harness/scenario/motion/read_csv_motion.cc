// SPDX-License-Identifier: Apache-2.0
// Reads the motion of a hand from CSV. Written here, although libcsv exists: the separators are the
// small part; units in the heads and errors with line and column are the large one. Tested by
// tests/harness/scenario/motion/hand_motion_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "harness/base/base/text_file.h"
#include "harness/scenario/motion/hand_motion.h"

namespace prehend::scenario {
namespace {

using grammar::Diagnostics;
using grammar::Place;

constexpr std::size_t kMaxReportedLines = 20;
constexpr double kUnitTolerance = 0.01;  // two written digits

/// A column of the header: which quantity it holds, and what to multiply with to get SI units.
struct Column {
  std::string quantity;
  double scale = 1;
};

const std::map<std::string, Column>& KnownColumns() {
  static const std::map<std::string, Column> columns = [] {
    std::map<std::string, Column> all = {{"t_s", {"t", 1}}, {"t_ms", {"t", 1e-3}}};
    for (const std::string axis : {"x", "y", "z"}) {
      all[axis + "_m"] = {axis, 1};
      all[axis + "_cm"] = {axis, 1e-2};
      all[axis + "_mm"] = {axis, 1e-3};
    }
    for (const std::string angle : {"roll", "pitch", "yaw"}) {
      all[angle + "_deg"] = {angle, 1};
      all[angle + "_rad"] = {angle, 180 / std::numbers::pi};
    }
    for (const char* plain : {"qw", "qx", "qy", "qz", "trigger"}) all[plain] = {plain, 1};
    return all;
  }();
  return columns;
}

struct Cell {
  std::string_view text;
  int column = 1;  ///< in bytes, from 1
};

std::vector<Cell> Cells(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::size_t first = line.find_first_not_of(" \t", begin);
    first = std::min(first, end);
    std::size_t last = end;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    begin = end + 1;
  }
  return cells;
}

/// The hint for an unknown column.
std::string ColumnRemedy(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, column] : KnownColumns()) names.push_back(known);
  const std::string nearest = grammar::NearestName(name, names);
  std::erase_if(names, [&](const std::string& known) { return !known.starts_with(name + "_"); });
  if (!name.empty() && !names.empty())
    return fmt::format(
        "did you mean '{}'?",
        *std::ranges::min_element(names, {}, [](const auto& n) { return n.size(); }));
  if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
  if (name.empty()) return "a comma too many";
  if (name.find_first_of(";\t") != std::string::npos) return "commas separate columns and values";
  if (name.front() == '"') return "names and values have no quotes";
  return "the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger";
}

class CsvReader {
 public:
  CsvReader(const std::string& path, std::string text) {
    track.file = path;
    track.text = std::move(text);
  }

  void Read() {
    const std::string_view text = track.text;
    for (std::size_t begin = 0; begin < text.size() && diagnostics.size() < kMaxReportedLines;) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      TakeLine(text.substr(begin, end - begin));
      begin = end + 1;
      if (header_ && columns_.empty()) return;  // rows have no meaning without it
    }
    if (!diagnostics.empty()) return;
    if (track.samples.size() < 2)
      Complain({line_, 1}, fmt::format("{} row{}; a motion has at least 2", track.samples.size(),
                                       track.samples.size() == 1 ? "" : "s"));
  }

  MotionTrack track;
  Diagnostics diagnostics;

 private:
  void Complain(Place place, std::string message, std::string hint = {}) {
    if (diagnostics.size() >= grammar::kMostDiagnostics) return;
    diagnostics.push_back(
        grammar::DiagnosticAt(track.file, track.text, place, std::move(message), std::move(hint)));
  }

  void TakeLine(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#') return;
    if (header_) return TakeRow(Cells(line));
    header_ = true;
    TakeHeader(Cells(line));
  }

  void TakeHeader(const std::vector<Cell>& cells) {
    std::map<std::string, int> seen;
    std::vector<Column> columns;
    for (const Cell& cell : cells) {
      const std::string name(cell.text);
      const auto known = KnownColumns().find(name);
      if (known == KnownColumns().end()) {
        Complain({line_, cell.column}, fmt::format("'{}' is no column of a motion", name),
                 ColumnRemedy(name));
        continue;
      }
      if (++seen[known->second.quantity] > 1)
        Complain({line_, cell.column}, fmt::format("'{}' is given twice", known->second.quantity));
      columns.push_back(known->second);
    }
    if (!diagnostics.empty()) return;
    CheckColumns(seen);
    if (diagnostics.empty()) columns_ = std::move(columns);
  }

  void CheckColumns(const std::map<std::string, int>& seen) {
    const auto count = [&](std::initializer_list<const char*> names) {
      return std::count_if(names.begin(), names.end(),
                           [&](const char* n) { return seen.contains(n); });
    };
    const auto quaternion = count({"qw", "qx", "qy", "qz"}),
               angles = count({"roll", "pitch", "yaw"});
    const auto missing = [&](std::initializer_list<const char*> names) {
      std::vector<std::string> all;
      for (const char* name : names) {
        if (!seen.contains(name)) all.push_back(name);
      }
      return fmt::format("{}", fmt::join(all, ", "));
    };
    if (count({"t", "x", "y", "z"}) < 4)
      Complain({line_, 1},
               "the header needs t_s (or t_ms), x_m, y_m and z_m (or _cm, _mm); missing: " +
                   missing({"t", "x", "y", "z"}));
    if (quaternion > 0 && angles > 0)
      Complain({line_, 1}, "an orientation is either qw,qx,qy,qz or roll_deg,pitch_deg,yaw_deg");
    else if (quaternion % 4 != 0)
      Complain({line_, 1}, "a quaternion needs qw, qx, qy and qz; missing: " +
                               missing({"qw", "qx", "qy", "qz"}));
    has_quaternion_ = quaternion == 4;
  }

  void TakeRow(const std::vector<Cell>& cells) {
    if (cells.size() != columns_.size()) {
      return Complain({line_, cells.back().column},
                      fmt::format("expected {} values as in the header, found {}", columns_.size(),
                                  cells.size()));
    }
    std::map<std::string, double> row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = Number(cells[i]);
      if (!value) return;
      row[columns_[i].quantity] = *value * columns_[i].scale;
    }
    TakeSample(row, cells);
  }

  std::optional<double> Number(const Cell& cell) {
    double value = 0;
    const char *begin = cell.text.data(), *end = begin + cell.text.size();
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error == std::errc() && rest == end && std::isfinite(value)) return value;
    Complain({line_, cell.column}, fmt::format("expected a number, found '{}'", cell.text));
    return std::nullopt;
  }

  void TakeSample(std::map<std::string, double>& row, const std::vector<Cell>& cells) {
    const auto place_of = [&](const std::string& quantity) {
      const auto it = std::find_if(columns_.begin(), columns_.end(),
                                   [&](const Column& c) { return c.quantity == quantity; });
      return Place{line_, cells[static_cast<std::size_t>(it - columns_.begin())].column};
    };
    TrackSample sample{
        .t_s = row["t"], .X_RD = {{row["x"], row["y"], row["z"]}}, .place = {line_, 1}};
    if (track.samples.empty()) first_t_s_ = sample.t_s;
    sample.t_s -= first_t_s_;
    if (!track.samples.empty() && sample.t_s <= track.samples.back().t_s)
      return Complain(place_of("t"),
                      fmt::format("the times must increase from row to row: {} s comes after {} s",
                                  row["t"], first_t_s_ + track.samples.back().t_s));
    for (const char* axis : {"x", "y", "z"}) {
      if (std::abs(row[axis]) > kMaxTrackCoordinate_m)
        return Complain(
            place_of(axis),
            fmt::format("{}: {} m is beyond {} m", axis, row[axis], kMaxTrackCoordinate_m),
            "does the unit match the header?");
    }
    if (has_quaternion_) {
      const Eigen::Quaterniond q(row["qw"], row["qx"], row["qy"], row["qz"]);
      if (std::abs(q.norm() - 1) > kUnitTolerance)
        return Complain(
            place_of("qw"),
            fmt::format("qw, qx, qy, qz: expected a unit quaternion, found one of length {:.4g}",
                        q.norm()));
      sample.X_RD.q = q.normalized();
    } else {
      sample.X_RD.q = physics::FromRollPitchYaw({row["roll"], row["pitch"], row["yaw"]});
    }
    if (const auto trigger = row.find("trigger"); trigger != row.end()) {
      if (trigger->second < 0 || trigger->second > 1)
        return Complain(
            place_of("trigger"),
            fmt::format("trigger: expected a number from 0 to 1, found {}", trigger->second));
      sample.trigger = trigger->second;
    }
    if (track.samples.size() == kMaxTrackSamples)
      return Complain({line_, 1}, fmt::format("more than {} rows", kMaxTrackSamples));
    track.samples.push_back(sample);
  }

  int line_ = 0;
  bool header_ = false, has_quaternion_ = false;
  std::vector<Column> columns_;  ///< empty until there is a good header
  double first_t_s_ = 0;
};

}  // namespace

Result<MotionTrack> ReadMotionCsv(const std::string& path) {
  PREHEND_TRY(std::string text, ReadTextFile(path));
  CsvReader reader(path, std::move(text));
  reader.Read();
  if (!reader.diagnostics.empty()) return tl::unexpected(std::move(reader.diagnostics));
  return std::move(reader.track);
}

}  // namespace prehend::scenario
