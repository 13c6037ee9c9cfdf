// SPDX-License-Identifier: Apache-2.0
// Poses as comma-separated values, one body per row or all of them. Tested by
// tests/program/import_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/cells/column_names.h"
#include "harness/exchange/poses/pose_file.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::Place;

constexpr std::size_t kMostComplaints = 12;
constexpr std::size_t kMostHeaderBytes = 100'000;
constexpr std::size_t kLeastSteps = 20;
constexpr int kMostPreamble = 100;  ///< lines in which the names of the columns are looked for

class CsvPoseReader {
 public:
  CsvPoseReader(const std::string& path, std::string text, const MapFile& map)
      : map_(map.map),
        map_errors_(map.document),
        layout_(map.layout.get()),
        stem_(std::filesystem::path(path).stem().string()) {
    poses.file = path;
    poses.text = std::move(text);
    orientation_ = map_.Orientation();
    poses.bodies = BodiesOf(map_, map_errors_);
    poses.openings = OpeningsOf(map_);
    poses.markers = MarkersOf(map_);
    for (const Named<MappedEntity>& entity : map_.entities) {
      const MappedEntity& e = entity.value;
      for (const Located<std::string>& marker : e.markers)
        index_.emplace(marker.value, Wanted{.from = marker});
      if (e.from && e.markers.empty())
        index_.emplace(e.from->value,
                       Wanted{.from = *e.from, .most_error = e.residual_m / map_.MetresPerUnit()});
    }
    for (auto* all : {&poses.bodies, &poses.markers})
      for (PoseBody& body : *all)
        if (const auto wanted = index_.find(body.name); wanted != index_.end())
          wanted->second.body = &body;
    poses.has_orientations = !map_.columns.Orientation().empty();
    if (!map_.columns.quaternion.empty()) poses.quaternion_order = orientation_.order;
  }

  void Read(std::string block, bool is_last) {
    if (!goes_on_) return;
    poses.text = std::move(block);
    lines_before_text_ = line_;
    if (line_ == 0) TakeHead();
    goes_on_ = map_errors_.empty();
    const std::string_view text = poses.text;
    for (std::size_t begin = 0;
         goes_on_ && begin < text.size() && problems_.size() < kMostComplaints;) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view line = text.substr(begin, end - begin);
      begin = end + 1;
      goes_on_ = TakeLine(line, is_last && begin >= text.size());
    }
  }

  void Finish() {
    if (!map_errors_.empty()) return;
    if (line_ < header_line_)
      Complain({1, 1}, fmt::format("{} lines; the header is on line {}", line_, header_line_));
    if (!problems_.empty()) return;
    if (poses.first_s != 0) BeginAtZero(poses);
    if (poses.rows < map_.LeastPoses())
      return Complain({line_, 1},
                      grammar::CountOf(poses.rows, "row") + "; a recording has at least 2");
    ComposeMarkers(map_, poses, map_errors_);
    if (map_errors_.empty()) RefuseAbsentBodies(poses, map_, map_errors_);
    for (const auto& [name, wanted] : index_) {
      const double m = map_.MetresPerUnit();
      AddNote(poses, wanted.errors.Text(
                         name, layout_ ? fmt::format("markers, by '{}',", layout_->error) : "",
                         poses.file, m, wanted.most_error * m));
    }
    CheckTimes();
    if (layout_ && layout_->frames) AddNote(poses, CountDoubt({*layout_->frames}, poses.rows));
  }

  /// Where the names of the columns are, of `poses.text`.
  void TakeHead() {
    header_line_ = layout_ ? 0 : HeaderLine();
    if (layout_) TakeLayout();
  }

  /// False if no other line is to be read.
  bool TakeLine(std::string_view line, bool is_last) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (++line_ < (layout_ ? layout_->first_row : header_line_)) return true;
    if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (line_ == header_line_) {
      TakeHeader(HeaderCells(line));
      return problems_.empty() && map_errors_.empty();
    }
    if (line.find_first_not_of(" \t") != std::string_view::npos && !line.starts_with('#'))
      TakeRow(TableCellsOf(line, map_.separator), is_last);
    else if (layout_ && layout_->ends_at_blank && poses.rows > 0)
      return false;
    return map_errors_.empty();
  }

  /// From now on each line is all that is known: times need not increase, and nothing is kept.
  void Stream() {
    streams_ = true;
    for (const auto& entity : map_.entities)
      if (entity.value.from && map_.columns.IsOfOneBody()) stem_ = entity.value.from->value;
  }
  /// What is wrong with the next line. `row_s`: its time, if it is a row.
  Diagnostics TakeNext(const std::string& line, std::optional<double>& row_s) {
    for (PoseBody& body : poses.bodies) body.samples.clear();
    for (OpeningSeries& opening : poses.openings) opening.samples.clear();
    poses.text = line;
    lines_before_text_ = line_;
    poses.unused.clear();
    const std::size_t rows = poses.rows;
    goes_on_ = goes_on_ && TakeLine(poses.text, /*is_last=*/false);
    Diagnostics problems = Problems();
    problems_.clear();
    row_s = poses.rows > rows ? std::optional(row_s_) : std::nullopt;
    return problems;
  }

  Diagnostics Problems() const {
    Diagnostics all = map_errors_.Sorted();
    all.insert(all.end(), problems_.begin(), problems_.end());
    return all;
  }

  PoseFile poses;

 private:
  void Complain(Place place, std::string message, std::string hint = {}) {
    const int line = place.line;
    place.line -= lines_before_text_;
    problems_.push_back(
        grammar::DiagnosticAt(poses.file, poses.text, place, std::move(message), std::move(hint)));
    problems_.back().place.line = line;
  }

  /// What the map says; or, of lines with '#' at the top, the one with the names.
  int HeaderLine() {
    if (map_.header_line > 0) return map_.header_line;
    std::string_view text = poses.text;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::size_t most = 0;
    int best = 1;
    for (int line = 1; text.starts_with('#') && line <= kMostPreamble; ++line) {
      const std::string_view whole = text.substr(0, text.find('\n'));
      const std::string_view head = whole.substr(0, kMostHeaderBytes);
      const std::size_t names =
          std::max(NamesIn(HeaderCells(head)), NamesIn(TableCellsOf(head, Separator::kSpace)));
      if (names > most) best = line;
      most = std::max(most, names);
      text.remove_prefix(std::min(whole.size() + 1, text.size()));
    }
    return best;
  }

  /// Without the sign of a comment before the names, unless the map has it in a name.
  std::vector<CsvCell> HeaderCells(std::string_view line) const {
    std::size_t first = 0;
    if (line.starts_with('#') && !(map_.columns.time && map_.columns.time->value.starts_with('#')))
      first = std::min(line.find_first_not_of("# "), line.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    std::vector<CsvCell> cells = TableCellsOf(line.substr(first), map_.separator);
    while (cells.size() > 1 && cells.back().text.empty()) cells.pop_back();
    for (CsvCell& cell : cells) cell.column += static_cast<int>(first);
    return cells;
  }

  /// A header that cannot be one, whatever the map says.
  bool IsNoHeader(const std::vector<CsvCell>& cells) {
    const std::string_view text = cells.front().text;
    std::size_t other = text.find_first_of(",;\t");
    if (other == std::string_view::npos && NamesIn(TableCellsOf(text, Separator::kSpace)) > 1)
      other = text.find(' ');
    if (cells.size() == 1 && other != std::string_view::npos) {
      const char* const name = text[other] == ','   ? "comma"
                               : text[other] == ';' ? "semicolon"
                               : text[other] == ' ' ? "space"
                                                    : "tab";
      Complain({line_, cells.front().column + static_cast<int>(other)},
               fmt::format("the names of the columns are separated by {}s", name),
               fmt::format("the map says how: separator: {}", name));
      return true;
    }
    const bool has_name = std::ranges::any_of(cells, [](const CsvCell& cell) {
      double number = 0;
      const char* const end = cell.text.data() + cell.text.size();
      return std::from_chars(cell.text.data(), end, number).ptr != end;
    });
    if (has_name || std::ranges::all_of(cells, [](const CsvCell& c) { return c.text.empty(); }))
      return false;
    Complain({line_, cells.front().column}, "expected the names of the columns, found numbers",
             "the map says on which line the names are: header_line: 1");
    return true;
  }

  /// How many of the columns that the map names a line has.
  std::size_t NamesIn(const std::vector<CsvCell>& cells) const {
    const Columns& columns = map_.columns;
    std::vector<std::string> wanted;
    if (columns.time) wanted.push_back(columns.time->value);
    for (const Located<std::string>& column : columns.body) wanted.push_back(column.value);
    for (const auto* list : {&columns.position, &columns.Orientation()}) {
      for (const Located<std::string>& column : *list) {
        if (!columns.body.empty()) wanted.push_back(column.value);
        for (const PoseBody& body : poses.bodies) {
          if (columns.body.empty()) wanted.push_back(WithBody(column.value, body.name));
        }
      }
    }
    std::set<std::string_view> found;
    for (const CsvCell& cell : cells) found.insert(cell.text);
    return static_cast<std::size_t>(std::ranges::count_if(
        wanted, [&](const std::string& name) { return found.contains(name); }));
  }

  /// Another line has the names.
  bool IsElsewhere(const std::vector<CsvCell>& cells) {
    if (NamesIn(cells) > 0) return false;
    std::size_t most = 1;
    Place place;
    const std::string_view text = poses.text;
    for (std::size_t begin = 0, line = 1; begin < text.size() && line <= kMostPreamble; ++line) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::vector<CsvCell> other =
          HeaderCells(text.substr(begin, std::min(end - begin, kMostHeaderBytes)));
      begin = end + 1;
      const std::size_t names = NamesIn(other);
      if (names <= most) continue;
      most = names;
      place = {static_cast<int>(line), other.front().column};
    }
    if (most == 1) return false;
    Complain(place,
             fmt::format("the names of the columns are on line {}, and not on line {}", place.line,
                         line_),
             fmt::format("in the map: header_line: {}", place.line));
    return true;
  }

  void TakeLayout() {
    std::vector<CsvCell> cells;
    for (const std::string& name : layout_->names) cells.push_back({.text = name});
    line_ = std::max(layout_->first_row - 1, 1);
    TakeNames(cells);
    line_ = 0;
    poses.notes = layout_->notes;
    poses.quaternion_order.reset();  // the file says it
    if (map_.columns.IsOfOneBody()) return;
    poses.has_orientations = false;
    for (const PoseBody& body : poses.bodies)
      poses.has_orientations |= std::ranges::count(layout_->turning, body.name) > 0;
    if (layout_->turning.empty()) return;
    poses.unused = layout_->turning;  // its markers are left aside
    std::erase_if(poses.unused, [&](const std::string& name) { return index_.contains(name); });
  }

  void TakeHeader(const std::vector<CsvCell>& cells) {
    if (!IsElsewhere(cells) && !IsNoHeader(cells)) TakeNames(cells);
  }

  void TakeNames(const std::vector<CsvCell>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string name(cells[i].text);
      names_.push_back(name);
      if (!name.empty() && !seats_by_name_.try_emplace(name, i).second)
        twice_.insert_or_assign(name, cells[i].column);
    }
    const Columns& columns = map_.columns;
    if (columns.time) time_seat_ = SeatOf(*columns.time, columns.time->value);
    for (const OpeningSeries& opening : poses.openings) {
      std::vector<std::size_t>& seats = opening_seats_.emplace_back();
      for (const Located<std::string>& column : opening.Of(map_).from)
        seats.push_back(SeatOf(column, WithBody(column.value, BodyOf(opening))));
    }
    for (const Located<std::string>& column : columns.body)
      body_seats_.push_back(SeatOf(column, column.value));
    if (!columns.body.empty()) {
      shared_ = SeatsOf("");
      return;
    }
    for (auto& [body, wanted] : index_) {
      const Where where = wanted.from.where;
      if (columns.IsOfOneBody() && body != stem_) {
        map_errors_.AddUnknownName(
            where,
            fmt::format("no body is called '{}': no column has a body's name, so the file is of "
                        "one body, which is called as the file, '{}'",
                        body, stem_),
            body, {stem_});
        continue;
      }
      if (std::ranges::none_of(columns.position, [&](const Located<std::string>& column) {
            return seats_by_name_.contains(WithBody(column.value, body));
          })) {
        map_errors_.AddUnknownName(
            where,
            layout_ ? fmt::format("no body is called '{}' in {}", body, layout_->name)
                    : fmt::format("no body is called '{}': the file has no column '{}'", body,
                                  WithBody(columns.position.front().value, body)),
            body, BodiesOfHeader());
        continue;
      }
      wanted.seats = SeatsOf(body);
    }
    for (const std::string& body : BodiesOfHeader()) {
      if (!index_.contains(body)) poses.unused.push_back(body);
    }
  }

  /// Whose row has it, or stands for '{}' in its column.
  const std::string& BodyOf(const OpeningSeries& opening) const {
    const Named<MappedEntity>& entity = map_.entities[opening.entity];
    return entity.value.from ? entity.value.from->value : entity.name;
  }

  /// The names for which the pattern of x has a column.
  std::vector<std::string> BodiesOfHeader() const {
    std::vector<std::string> bodies;
    for (const std::string& name : names_)
      if (auto body = BodyOfColumn(map_.columns.position.front().value, name))
        bodies.push_back(*std::move(body));
    return bodies;
  }

  std::size_t SeatOf(const Located<std::string>& column, const std::string& name) {
    if (const auto twice = twice_.find(name); twice != twice_.end())
      Complain({line_, twice->second}, fmt::format("a second column is called '{}'", name));
    const auto found = seats_by_name_.find(name);
    if (found != seats_by_name_.end()) return found->second;
    map_errors_.AddUnknownName(column.where, fmt::format("no column is called '{}'", name), name,
                               names_);
    return 0;
  }

  Seats SeatsOf(const std::string& body) {
    Seats seats;
    for (const Located<std::string>& column : map_.columns.position)
      seats.all.push_back(SeatOf(column, WithBody(column.value, body)));
    const bool turns =
        !layout_ || map_.columns.IsOfOneBody() || std::ranges::count(layout_->turning, body) > 0;
    const auto error = seats_by_name_.find(body + " " + (layout_ ? layout_->error : ""));
    if (layout_ && turns && error != seats_by_name_.end()) seats.error = error->second;
    for (const Located<std::string>& column : map_.columns.Orientation())
      if (turns) seats.all.push_back(SeatOf(column, WithBody(column.value, body)));
    return seats;
  }

  /// Of the row's body, in a file with one per row.
  std::string BodyOfRow(const std::vector<CsvCell>& cells) const {
    std::string name;
    for (const std::size_t seat : body_seats_)
      name.append(name.empty() ? "" : "/").append(cells[seat].text);
    return name;
  }

  std::optional<double> TimeOf(const CsvCell& cell) {
    if (map_.time_unit->value != TimeUnit::kIso) return Number(cell);
    const auto time = SecondsOfIsoTime(cell.text);
    if (!time)
      Complain({line_, cell.column}, fmt::format("expected a time like 2026-01-31T10:00:00.25Z, "
                                                 "found '{}'",
                                                 ReadableText(cell.text)));
    return time && first_time_ ? AfterMidnight(*time, *first_time_) : time;
  }

  void TakeRow(std::vector<CsvCell> cells, bool is_last) {
    while (cells.size() > names_.size() && cells.back().text.empty()) cells.pop_back();
    // Some programs leave out the empty cells at the end of a row.
    while (layout_ && cells.size() < names_.size() && (!is_last || poses.text.ends_with('\n')))
      cells.push_back({.text = {}, .column = cells.back().column});
    if (cells.size() != names_.size())
      return Complain(
          {line_, cells.back().column},
          fmt::format("expected {} values as in the header, found {}{}", names_.size(),
                      cells.size(), cells.size() < names_.size() ? ": is the file cut off?" : ""));
    const std::string name = BodyOfRow(cells);
    double t_s = 0;
    if (time_seat_) {
      const auto time = TimeOf(cells[*time_seat_]);
      if (!time) return;
      if (first_time_ == std::nullopt) first_time_ = *time;
      t_s = (*time - *first_time_) * map_.SecondsPerUnit();
    } else {
      t_s = static_cast<double>(rows_of_[name]++) / map_.rate_hz->value;
    }
    const Place place{line_, time_seat_ ? cells[*time_seat_].column : 1};
    const bool has_bodies = !body_seats_.empty();
    // One body after the other is as good as one time after the other.
    const auto [before, is_first] = last_times_s_.try_emplace(streams_ ? "" : name, t_s);
    if (!is_first && !streams_ && (has_bodies ? t_s < before->second : t_s <= before->second))
      return Complain(place,
                      fmt::format("the times{} must increase from row to row: {:.6g} s after the "
                                  "first row comes after {:.6g} s",
                                  has_bodies ? " of '" + name + "'" : "", t_s, before->second));
    if (!is_first && time_seat_) CountStep((t_s - before->second) / map_.SecondsPerUnit());
    before->second = row_s_ = t_s;
    poses.first_s = std::min(poses.first_s, t_s);
    poses.last_s = std::max(poses.last_s, t_s);
    if (map_.lost == Lost::kInRows && !streams_) poses.rows_s.push_back(t_s);
    ++poses.rows;
    bool is_asked = false;
    for (std::size_t i = 0; i < poses.openings.size(); ++i) {
      if (has_bodies && name != BodyOf(poses.openings[i])) continue;
      TakeOpening(cells, opening_seats_[i], t_s, poses.openings[i]);
      is_asked = true;
    }
    if (!has_bodies) {
      for (auto& [body, wanted] : index_) TakePose(cells, wanted.seats, t_s, wanted);
      return;
    }
    const auto body = index_.find(name);
    if (body != index_.end()) return TakePose(cells, shared_, t_s, body->second);
    if (!is_asked && poses.unused.size() < 1000 &&
        std::ranges::find(poses.unused, name) == poses.unused.end())
      poses.unused.push_back(name);
  }

  /// In the file's unit of time.
  void CountStep(double step) {
    const double whole = std::round(step);
    if (whole == 0 && !body_seats_.empty()) return;
    ++steps_;
    whole_steps_ += whole >= 1 && std::abs(step - whole) < 1e-6;
    unit_steps_ += whole == 1;
  }

  /// A tracker that takes one pose each millisecond has times as frames have numbers.
  void CheckTimes() {
    poses.counts_frames = time_seat_ && map_.time_unit->value != TimeUnit::kFrame &&
                          steps_ >= kLeastSteps && whole_steps_ == steps_ &&
                          10 * unit_steps_ >= 9 * steps_;
    if (poses.counts_frames && !map_.rate_hz && !map_.IsSure(Warning::kTime))
      poses.notes.push_back(fmt::format(
          "the times of '{}' are whole numbers that grow by 1 each: they look like frame numbers; "
          "in the map: time_unit: frame, and rate_hz; or, if they are times, sure: [time]",
          map_.columns.time->value));
  }

  bool IsMissing(const CsvCell& cell) const {
    return cell.text.empty() || std::ranges::find(map_.missing, cell.text) != map_.missing.end();
  }

  /// What the map asks for.
  struct Wanted {
    Located<std::string> from;
    PoseBody* body = nullptr;
    double most_error = 0;  ///< in the file's unit
    MarkerErrors errors = {};
    Seats seats = {};
  };

  /// `cell`: one of a pose that has none.
  std::string HintOfNoQuaternion(const CsvCell& cell) const {
    if (orientation_.form != OrientationForm::kQuaternion) return "";
    if (std::ranges::count(values_, values_[0]) < std::ssize(values_))
      return "are these the four columns of one body's orientation?";
    return "if this means 'not tracked', in the map: " +
           (values_[0] == 0 ? "zero_is_missing: true" : fmt::format("missing: [{}]", cell.text));
  }

  void TakePose(const std::vector<CsvCell>& cells, const Seats& seats, double t_s, Wanted& wanted) {
    PoseBody& body = *wanted.body;
    const auto missing = [&](std::size_t seat) { return IsMissing(cells[seat]); };
    if (std::ranges::all_of(seats.all, missing)) return;
    if (const auto one = std::ranges::find_if(seats.all, missing); one != seats.all.end())
      return Complain({line_, cells[*one].column},
                      fmt::format("'{}' has a pose without '{}'", body.name, names_[*one]),
                      "where a body is not tracked, all of its cells are empty");
    values_.clear();
    for (const std::size_t seat : seats.all) {
      const auto value = Number(cells[seat]);
      if (!value) return;
      values_.push_back(*value);
    }
    PoseSample sample{.t_s = t_s, .p = {values_[0], values_[1], values_[2]}, .line = line_};
    if (map_.zero_is_missing && sample.p.isZero(0)) return void(++poses.zeros);
    if (!body.samples.empty() && t_s <= body.samples.back().t_s)
      return Complain({line_, cells[seats.all.back()].column},
                      fmt::format("'{}' has two poses at {:.6g} s", body.name, t_s));
    if (seats.all.size() > 3) {
      const std::string fault =
          ReadOrientation(orientation_, std::span(values_).subspan(3), sample.q, &poses.most_angle);
      if (!fault.empty())
        return Complain({line_, cells[seats.all[3]].column},
                        fmt::format("'{}': {}", body.name, fault),
                        HintOfNoQuaternion(cells[seats.all[3]]));
    }
    if (seats.error && !IsMissing(cells[*seats.error])) {
      const auto error = Number(cells[*seats.error]);
      if (!error || !wanted.errors.Take(*error, wanted.most_error, t_s, line_)) return;
    }
    body.samples.push_back(sample);
    if (body.samples.size() % 4096 == 1) LetGo(body.samples);  // also when it has just grown
  }

  void TakeOpening(const std::vector<CsvCell>& cells, const std::vector<std::size_t>& seats,
                   double t_s, OpeningSeries& opening) {
    std::vector<double> numbers;
    for (const std::size_t seat : seats) {
      if (IsMissing(cells[seat])) return;
      const auto number = Number(cells[seat]);
      if (!number) return;
      numbers.push_back(*number);
    }
    if (!opening.samples.empty() && t_s <= opening.samples.back().t_s)
      return Complain({line_, cells[seats.front()].column},
                      fmt::format("'{}' has two values at {:.6g} s", names_[seats.front()], t_s));
    opening.samples.push_back(
        {.t_s = t_s, .open = opening.Of(map_).FractionOf(numbers), .line = line_});
  }

  std::optional<double> Number(const CsvCell& cell) {
    const std::optional<double> value = NumberOf(cell.text, map_.decimal_comma);
    if (value && std::isfinite(*value)) return value;
    std::string hint;
    if (value)
      hint = fmt::format("if that means 'not tracked', the map says missing: [{}]", cell.text);
    else if (NumberOf(cell.text, true))
      hint = "if that is a decimal comma, the map says decimal: comma";
    else if (SecondsOfIsoTime(cell.text))
      hint = "if that is the time, the map says time_unit: iso";
    Complain({line_, cell.column},
             fmt::format("expected a number, found '{}'", ReadableText(cell.text)), hint);
    return std::nullopt;
  }

  const ImportMap& map_;
  DiagnosticList map_errors_;
  Diagnostics problems_;
  const TableLayout* const layout_;
  std::string stem_;
  OrientationFormat orientation_;
  int line_ = 0, header_line_ = 0, lines_before_text_ = 0;
  bool streams_ = false, goes_on_ = true;
  double row_s_ = 0;  ///< of the last row
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> seats_by_name_, rows_of_;  ///< .. of body, without times
  std::map<std::string, int> twice_;     ///< names of several columns -> place of the last
  std::map<std::string, Wanted> index_;  ///< bodies and markers
  std::optional<std::size_t> time_seat_;
  std::vector<std::size_t> body_seats_;
  std::optional<double> first_time_;
  std::map<std::string, double> last_times_s_;  ///< by body; of a row with all bodies under ""
  std::size_t steps_ = 0, whole_steps_ = 0, unit_steps_ = 0;  ///< of times
  Seats shared_;
  std::vector<double> values_;                           ///< of a pose
  std::vector<std::vector<std::size_t>> opening_seats_;  ///< of each of the openings
};

}  // namespace

PoseLines::PoseLines(const std::string& name, std::string head, const MapFile& map) {
  const auto reader = std::make_shared<CsvPoseReader>(name, std::move(head), map);
  reader->Stream();
  reader->TakeHead();
  poses_ = &reader->poses;
  take_ = [reader](const std::string& line, std::optional<double>& row_s) {
    return reader->TakeNext(line, row_s);
  };
}

Result<PoseFile> ReadCsvPoses(const std::string& path, const MapFile& map) {
  // What is wrong with the text comes before what is wrong with poses.
  CsvPoseReader reader(path, "", map);
  for (const bool reads : {false, true}) {
    Diagnostics problems =
        ReadTextBlocks(path, kMaxPoseFileBytes, [&](std::string block, bool is_last) {
          if (reads) reader.Read(std::move(block), is_last);
        });
    if (!problems.empty()) return tl::unexpected(std::move(problems));
  }
  reader.Finish();
  if (Diagnostics problems = reader.Problems(); !problems.empty())
    return tl::unexpected(std::move(problems));
  return std::move(reader.poses);
}

}  // namespace prehend::exchange
