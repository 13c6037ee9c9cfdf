// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/table_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kHeadBytes = std::size_t{1} << 20;
constexpr int kPartLines = 6;                                                ///< with the first row
constexpr std::array kViconParts = {"Objects", "Segments", "Trajectories"};  ///< the best first

using Lines = std::vector<std::string_view>;

Lines HeadOf(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Lines lines;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> Words(std::string_view line, Separator separator) {
  std::vector<std::string> words;
  for (const CsvCell& cell : TableCellsOf(line, separator)) words.emplace_back(cell.text);
  return words;
}

std::string At(const std::vector<std::string>& words, std::size_t i) {
  return i < words.size() ? words[i] : "";
}

void SetColumns(std::vector<Located<std::string>>& columns, std::initializer_list<const char*> of) {
  columns.clear();
  for (const char* name : of) columns.push_back({name, {}});
}

/// Of a head that says 0, or nothing, it is not known.
std::optional<double> PositiveOf(std::string_view text) {
  const std::optional<double> number = NumberOf(text, true);
  return number && *number > 0 && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::size_t> CountOf(std::string_view text) {
  const std::optional<double> number = PositiveOf(text);
  if (!number || *number > 1e9) return std::nullopt;
  return static_cast<std::size_t>(*number);
}

bool IsNumber(std::string_view text) { return NumberOf(text, true).has_value(); }

/// Those with a column that ends so.
std::vector<std::string> BodiesWith(const TableLayout& layout, const std::string& ending) {
  std::vector<std::string> bodies;
  for (const std::string& name : layout.names)
    if (name.ends_with(ending)) bodies.push_back(name.substr(0, name.size() - ending.size()));
  return bodies;
}

std::optional<TableLayout> MotiveOf(const Lines& lines) {
  if (!lines.front().starts_with("Format Version,")) return std::nullopt;
  std::size_t axes = 1;
  while (axes < lines.size() && !lines[axes].starts_with("Frame,")) ++axes;
  if (axes < 4 || axes >= lines.size()) return std::nullopt;
  TableLayout layout{.name = "a CSV file of Motive",
                     .first_row = static_cast<int>(axes) + 2,
                     .error = "Mean Marker Error"};
  std::map<std::string, std::string> says;
  const std::vector<std::string> first = Words(lines.front(), Separator::kComma);
  for (std::size_t i = 0; i + 1 < first.size(); i += 2) says[first[i]] = first[i + 1];
  layout.unit = UnitCalled(says["Length Units"]);
  layout.time_unit = TimeUnit::kSecond;
  layout.rate_hz = PositiveOf(says["Export Frame Rate"]);
  layout.frames = CountOf(says["Total Exported Frames"]);
  if (says["Coordinate Space"] == "Local")
    layout.notes.push_back(
        "its Coordinate Space is Local: bones are relative to their parents, and not to the room");
  // The kinds of bodies stand in the first of the lines that name a column, their names in the
  // second; identifiers and parents may follow.
  std::size_t types = 1;
  while (types < axes && lines[types].find_first_not_of(", ") == std::string_view::npos) ++types;
  const auto names = Words(lines[types + 1], Separator::kComma),
             parts = Words(lines[axes - 1], Separator::kComma),
             letters = Words(lines[axes], Separator::kComma);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const std::string part = At(parts, i), body = At(names, i);
    const bool of_body = !body.empty() && (part == "Rotation" || part == "Position");
    layout.names.push_back(of_body ? body + " " + part + " " + letters[i]
                           : i < 2 ? letters[i]
                                   : body + " " + part);
  }
  SetColumns(layout.columns.position, {"{} Position X", "{} Position Y", "{} Position Z"});
  layout.columns.time = {"Time (Seconds)", {}};
  layout.turning = BodiesWith(layout, " Rotation X");
  if (layout.turning.empty()) return layout;
  if (!BodiesWith(layout, " Rotation W").empty()) {
    layout.quaternion_order = QuaternionOrder::kXyzw;
    SetColumns(layout.columns.quaternion,
               {"{} Rotation X", "{} Rotation Y", "{} Rotation Z", "{} Rotation W"});
    return layout;
  }
  const std::string order = says["Rotation Type"];
  layout.angles_in_degrees = true;
  layout.euler_order = FaultOfEulerOrder(order).empty() ? order : "XYZ";
  for (const char axis : *layout.euler_order)
    layout.columns.euler.push_back({fmt::format("{{}} Rotation {}", axis), {}});
  return layout;
}

/// "Global Angle (Quaternion) cup:cup" is of "cup:cup".
std::string ViconBody(std::string name) {
  const std::size_t kind = name.find(") ");
  return name.starts_with("Global ") && kind != std::string::npos ? name.substr(kind + 2) : name;
}

/// Its name, and blank cells.
bool BeginsPart(std::string_view line, std::string_view part) {
  return line.starts_with(part) && line.find_last_not_of(",;\t \r") == part.size() - 1;
}

/// A file of Vicon, whichever part is the first.
bool IsOfParts(const Lines& lines) {
  return lines.size() > 3 && lines[3].starts_with("Frame") &&
         IsNumber(lines[1].substr(0, lines[1].find_first_of(",;\t")));
}

std::optional<TableLayout> ViconOf(const Lines& lines) {
  for (const char* part : kViconParts) {
    for (std::size_t i = 0; i + 3 < lines.size(); ++i) {
      const std::string_view line = lines[i], head = lines[i + 3];
      if (!BeginsPart(line, part) || !head.starts_with("Frame") || head.size() < 6) continue;
      const Separator separator = head[5] == ';'    ? Separator::kSemicolon
                                  : head[5] == '\t' ? Separator::kTab
                                                    : Separator::kComma;
      TableLayout layout{.name = fmt::format("a CSV file of Vicon ({})", part),
                         .separator = separator,
                         .first_row = static_cast<int>(i) + 5,
                         .ends_at_blank = true};
      layout.rate_hz = PositiveOf(Words(lines[i + 1], separator).front());
      layout.time_unit = TimeUnit::kFrame;
      layout.columns.time = {"Frame", {}};
      const auto bodies = Words(lines[i + 2], separator), letters = Words(head, separator);
      std::vector<std::string> units;
      if (i + 4 < lines.size()) units = Words(lines[i + 4], separator);
      const bool has_units = !units.empty() && units.front().empty();
      layout.first_row += has_units ? 1 : 0;
      std::string body;
      for (std::size_t k = 0; k < letters.size(); ++k) {
        if (!At(bodies, k).empty()) body = ViconBody(bodies[k]);
        const bool is_position = letters[k] == "TX" || letters[k] == "X";
        if (is_position && has_units) layout.unit = UnitCalled(At(units, k));
        if (letters[k] == "RX" && has_units) layout.angles_in_degrees = At(units, k) == "deg";
        layout.names.push_back(body.empty() ? letters[k] : body + " " + letters[k]);
      }
      if (std::string_view(part) == "Trajectories")
        SetColumns(layout.columns.position, {"{} X", "{} Y", "{} Z"});
      else
        SetColumns(layout.columns.position, {"{} TX", "{} TY", "{} TZ"});
      layout.turning = BodiesWith(layout, " RX");
      if (layout.turning.empty()) return layout;
      if (!BodiesWith(layout, " RW").empty()) {
        layout.quaternion_order = QuaternionOrder::kXyzw;
        SetColumns(layout.columns.quaternion, {"{} RX", "{} RY", "{} RZ", "{} RW"});
      } else {
        SetColumns(layout.columns.axis_angle, {"{} RX", "{} RY", "{} RZ"});
      }
      return layout;
    }
  }
  return std::nullopt;
}

/// Whether the matrix of the first body stands row by row: then it agrees so with its angles.
bool IsRowByRow(const TableLayout& layout, const Lines& lines) {
  for (std::size_t i = static_cast<std::size_t>(layout.first_row) - 1; i < lines.size(); ++i) {
    const auto words = Words(lines[i], Separator::kTab);
    const auto value = [&](const std::string& ending) {
      const auto at = std::ranges::find(layout.names, layout.turning.front() + ending);
      const auto seat = static_cast<std::size_t>(at - layout.names.begin());
      return seat < words.size() ? NumberOf(words[seat], true).value_or(0) : 0;
    };
    Eigen::Quaterniond angles;
    ReadOrientation(
        {.form = OrientationForm::kEuler, .radians_per_unit = static_cast<double>(EIGEN_PI) / 180},
        std::array{value(" Roll"), value(" Pitch"), value(" Yaw")}, angles);
    Eigen::Matrix3d m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = value(fmt::format(" Rot[{}]", k));
    const Eigen::Matrix3d wanted = angles.toRotationMatrix();
    const double as_rows = (m - wanted).norm(), as_columns = (m.transpose() - wanted).norm();
    if (m.isZero(0) || std::abs(as_rows - as_columns) < 0.01) continue;
    return as_rows < as_columns;
  }
  return false;
}

/// The columns of a table without names for them.
std::vector<std::string> QualisysColumns(const std::vector<std::string>& bodies, bool six,
                                         std::size_t cells) {
  std::vector<std::string> all;
  const std::size_t each = six ? 16 : 3, lead = cells - std::min(cells, each * bodies.size());
  if (lead > 0) all.push_back("Frame");
  if (lead > 1) all.push_back("Time");
  for (const std::string& body : bodies) {
    std::vector<std::string> parts = {"X", "Y", "Z"};
    if (six) parts.insert(parts.end(), {"Roll", "Pitch", "Yaw", "Residual"});
    for (int k = 0; six && k < 9; ++k) parts.push_back(fmt::format("Rot[{}]", k));
    for (const std::string& part : parts) all.push_back(body + " " + part);
  }
  return all;
}

std::optional<TableLayout> QualisysOf(const Lines& lines) {
  if (!lines.front().starts_with("NO_OF_FRAMES\t")) return std::nullopt;
  TableLayout layout{
      .name = "a TSV file of Qualisys", .separator = Separator::kTab, .error = "Residual"};
  std::vector<std::string> bodies;
  std::size_t row = 0;
  for (; row < lines.size() && !lines[row].empty(); ++row) {
    auto words = Words(lines[row], Separator::kTab);
    if (words.front().empty() ||
        words.front().find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") != std::string::npos)
      break;
    if (words.front() == "FREQUENCY") layout.rate_hz = PositiveOf(At(words, 1));
    if (words.front() == "NO_OF_FRAMES") layout.frames = CountOf(At(words, 1));
    if (words.front() != "MARKER_NAMES" && words.front() != "BODY_NAMES") continue;
    while (words.back().empty()) words.pop_back();
    bodies.assign(words.begin() + 1, words.end());
  }
  while (row < lines.size() && lines[row].empty()) ++row;
  if (row >= lines.size() || bodies.empty()) return std::nullopt;
  const auto words = Words(lines[row], Separator::kTab);
  const bool six = std::ranges::any_of(lines, [](std::string_view line) {
    return line.starts_with("BODY_NAMES") || line.starts_with("DATA_INCLUDED\t6D");
  });
  layout.first_row = static_cast<int>(row) + 1;
  if (IsNumber(words.front())) {
    layout.names = QualisysColumns(bodies, six, words.size() - (words.back().empty() ? 1 : 0));
  } else {
    ++layout.first_row;
    std::size_t next = 0;
    std::string body;
    for (const std::string& word : words) {
      const std::size_t blank = word.rfind(' ');
      if (blank != std::string::npos)
        body = word.substr(0, blank);
      else if (word == "X" && next < bodies.size())
        body = bodies[next];
      const std::string part = word.substr(blank == std::string::npos ? 0 : blank + 1);
      next += part == "X" ? 1 : 0;
      layout.names.push_back(body.empty() ? word : body + " " + part);
    }
    while (layout.names.back().empty() || layout.names.back().ends_with(' '))
      layout.names.pop_back();
  }
  layout.unit = Unit::kMillimetre;
  layout.says_unit = false;
  layout.zero_is_missing = true;
  layout.time_unit = TimeUnit::kFrame;
  if (std::ranges::find(layout.names, "Time") != layout.names.end()) {
    layout.columns.time = {"Time", {}};
    layout.time_unit = TimeUnit::kSecond;
  } else if (std::ranges::find(layout.names, "Frame") != layout.names.end()) {
    layout.columns.time = {"Frame", {}};
  }
  SetColumns(layout.columns.position, {"{} X", "{} Y", "{} Z"});
  layout.turning = BodiesWith(layout, " Rot[8]");
  if (layout.turning.empty()) return layout;
  const bool by_rows = IsRowByRow(layout, lines);
  for (int k = 0; k < 9; ++k)
    layout.columns.matrix.push_back(
        {fmt::format("{{}} Rot[{}]", by_rows ? k : 3 * (k % 3) + k / 3), {}});
  return layout;
}

std::optional<TableLayout> TrcOf(const Lines& lines) {
  if (!lines.front().starts_with("PathFileType") || lines.size() < 5) return std::nullopt;
  TableLayout layout{.name = "a TRC file", .separator = Separator::kTab, .first_row = 6};
  const auto keys = Words(lines[1], Separator::kTab), values = Words(lines[2], Separator::kTab);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == "DataRate") layout.rate_hz = PositiveOf(At(values, i));
    if (keys[i] == "NumFrames") layout.frames = CountOf(At(values, i));
    if (keys[i] == "Units") layout.unit = UnitCalled(At(values, i));
  }
  layout.names = {"Frame#", "Time"};
  const auto names = Words(lines[3], Separator::kTab);
  for (std::size_t i = 2; i < names.size(); ++i) {
    for (const char* axis : {" X", " Y", " Z"})
      if (!names[i].empty()) layout.names.push_back(names[i] + axis);
  }
  layout.columns.time = {"Time", {}};
  layout.time_unit = TimeUnit::kSecond;
  SetColumns(layout.columns.position, {"{} X", "{} Y", "{} Z"});
  return layout;
}

std::optional<TableLayout> EurocOf(const Lines& lines) {
  std::string_view head = lines.front();
  if (head.empty() || head[0] != '#') return std::nullopt;
  head.remove_prefix(std::min(head.find_first_not_of("# "), head.size()));
  if (!head.starts_with("timestamp") || head.find("p_") == std::string_view::npos)
    return std::nullopt;
  TableLayout layout{.name = "a CSV file of EuRoC",
                     .yields = true,
                     .first_row = 2,
                     .unit = Unit::kMetre,
                     .says_unit = false,
                     .time_unit = TimeUnit::kNanosecond,
                     .says_time_unit = false};
  static const std::map<std::string, TimeUnit> kTimes = {{"s", TimeUnit::kSecond},
                                                         {"ms", TimeUnit::kMillisecond},
                                                         {"us", TimeUnit::kMicrosecond},
                                                         {"ns", TimeUnit::kNanosecond}};
  for (const std::string& name : Words(head, Separator::kComma)) {
    const std::size_t open = name.find(" [");
    layout.names.push_back(name.substr(0, open));
    if (open == std::string::npos) continue;
    const std::string in = name.substr(open + 2, name.find(']', open) - open - 2);
    if (name.starts_with("p_")) {
      layout.unit = UnitCalled(in);
      layout.says_unit = true;
    } else if (const auto time = kTimes.find(in);
               name.starts_with("timestamp") && time != kTimes.end()) {
      layout.time_unit = time->second;
      layout.says_time_unit = true;
    }
  }
  const auto column = [&](const char* begin, const char* end) {
    const auto found = std::ranges::find_if(layout.names, [&](const std::string& name) {
      return name.starts_with(begin) && name.ends_with(end);
    });
    return Located<std::string>{found == layout.names.end() ? "" : *found, {}};
  };
  layout.columns.time = {"timestamp", {}};
  layout.columns.position = {column("p_", "_x"), column("p_", "_y"), column("p_", "_z")};
  if (column("q_", "_w").value.empty()) return layout;  // of a tracker of one point
  layout.columns.quaternion = {column("q_", "_w"), column("q_", "_x"), column("q_", "_y"),
                               column("q_", "_z")};
  layout.quaternion_order = QuaternionOrder::kWxyz;
  return layout;
}

/// Of rows of 8 or 12 numbers without names: TUM and KITTI.
std::optional<TableLayout> RowsOf(const Lines& lines) {
  std::size_t row = 0;
  while (row < lines.size() && (lines[row].empty() || lines[row].starts_with('#'))) ++row;
  if (row == lines.size()) return std::nullopt;
  const Separator separator =
      lines[row].find(',') == std::string_view::npos ? Separator::kSpace : Separator::kComma;
  const auto words = Words(lines[row], separator);
  if (!std::ranges::all_of(words, IsNumber)) return std::nullopt;
  TableLayout layout{.yields = true,
                     .separator = separator,
                     .first_row = static_cast<int>(row) + 1,
                     .unit = Unit::kMetre,
                     .says_unit = false};
  if (words.size() == 8) {
    layout.name = "a trajectory of TUM";
    layout.names = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
    layout.columns.time = {"timestamp", {}};
    layout.time_unit = TimeUnit::kSecond;
    layout.says_time_unit = false;
    layout.quaternion_order = QuaternionOrder::kXyzw;
    SetColumns(layout.columns.quaternion, {"qx", "qy", "qz", "qw"});
  } else if (words.size() == 12) {
    layout.name = "a trajectory of KITTI";
    layout.names = {"r11", "r12", "r13", "tx",  "r21", "r22",
                    "r23", "ty",  "r31", "r32", "r33", "tz"};
    SetColumns(layout.columns.matrix,
               {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"});
  } else {
    return std::nullopt;
  }
  SetColumns(layout.columns.position, {"tx", "ty", "tz"});
  return layout;
}

template <class T>
bool IsAlike(const T& a, const T& b) {
  return a == b;
}
/// Rates are written with few digits.
bool IsAlike(double a, double b) { return std::abs(a / b - 1) < 1e-3; }

void Contradict(const char* key, Where where, const TableLayout& layout, DiagnosticList& errors) {
  errors.Add(where, fmt::format("'{}' contradicts the file: {} says otherwise", key, layout.name),
             fmt::format("leave '{}' out", key));
}

/// What the file says, where the map is silent; otherwise they must agree.
template <class T>
void Agree(const std::optional<T>& of_file, std::optional<Located<T>>& of_map, const char* key,
           const TableLayout& layout, Where where, DiagnosticList& errors) {
  if (!of_file) return;
  if (!of_map)
    of_map = Located<T>{*of_file, where};
  else if (!IsAlike(of_map->value, *of_file))
    Contradict(key, of_map->where, layout, errors);
}

void Complete(TableLayout& layout, Where where, ImportMap& map, DiagnosticList& errors) {
  if (!map.columns.position.empty())
    layout.notes.push_back(fmt::format(
        "this is {}, which says itself where its values stand: 'columns' of the map is not used",
        layout.name));
  if (!map.metres_per_unit && (layout.says_unit || !map.unit))
    Agree(layout.unit, map.unit, "unit", layout, where, errors);
  Agree(layout.quaternion_order, map.quaternion_order, "quaternion_order", layout, where, errors);
  // Of Vicon's three angles the file does not say what they are.
  if (!layout.columns.axis_angle.empty() && map.euler_order) {
    layout.columns.axis_angle.clear();
    for (const char axis : map.euler_order->value)
      layout.columns.euler.push_back(
          {fmt::format("{{}} R{}",
                       static_cast<char>(std::toupper(static_cast<unsigned char>(axis)))),
           {}});
  }
  Agree(layout.euler_order, map.euler_order, "euler_order", layout, where, errors);
  Agree(layout.angles_in_degrees, map.angles_in_degrees, "angle_unit", layout, where, errors);
  if (!layout.columns.time || layout.time_unit == TimeUnit::kFrame)
    Agree(layout.rate_hz, map.rate_hz, "rate_hz", layout, where, errors);
  if (layout.says_time_unit || !map.time_unit)
    Agree(layout.time_unit, map.time_unit, "time_unit", layout, where, errors);
  if (!layout.time_unit && map.time_unit) {
    errors.Add(map.time_unit->where,
               fmt::format("'time_unit' contradicts the file: {} has no times", layout.name),
               "leave 'time_unit' out");
    map.time_unit.reset();
  }
  map.separator = layout.separator;
  map.zero_is_missing = map.zero_is_missing || layout.zero_is_missing;
  map.missing.insert(map.missing.end(), {"NULL", "NaN", "nan"});
  map.columns = layout.columns;
  map.columns.where = where;
  for (auto* list : {&map.columns.position, &map.columns.quaternion, &map.columns.euler,
                     &map.columns.matrix, &map.columns.axis_angle})
    for (Located<std::string>& column : *list) column.where = where;
  if (map.columns.time) map.columns.time->where = where;
}

}  // namespace

std::optional<TableLayout> LayoutOf(std::string_view text) {
  const Lines lines = HeadOf(text);
  if (lines.empty()) return std::nullopt;
  for (const auto reader : {MotiveOf, ViconOf, QualisysOf, TrcOf, EurocOf, RowsOf})
    if (std::optional<TableLayout> layout = reader(lines)) return layout;
  return std::nullopt;
}

std::optional<bool> HeadGoesOn(std::string_view text) {
  const Lines lines = HeadOf(text);
  const auto begins = [&](const char* with) { return lines.front().starts_with(with); };
  if (lines.empty() || !(begins("Format Version,") || begins("NO_OF_FRAMES\t") ||
                         begins("PathFileType") || IsOfParts(lines)))
    return std::nullopt;
  const std::optional<TableLayout> layout = LayoutOf(text);
  return !layout || layout->first_row > std::ssize(lines);
}

Result<std::optional<TableLayout>> LayoutOfTable(const std::string& table) {
  std::ifstream file = OpenRegular(table);
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  if (head.empty()) {
    PREHEND_TRY(head, ReadTextFile(table));  // says what is wrong with it
  }
  if (!file || !IsOfParts(HeadOf(head))) return LayoutOf(head);
  // The best part may begin anywhere.
  file.seekg(0);
  std::array<std::string, kViconParts.size()> heads;
  std::array<int, kViconParts.size()> before{};
  std::string line;
  for (int i = 0; std::getline(file, line) && (heads[0].empty() || i < before[0] + kPartLines); ++i)
    for (std::size_t k = 0; k < heads.size(); ++k) {
      const bool begins = heads[k].empty() && BeginsPart(line, kViconParts[k]);
      if (begins) before[k] = i;
      if (begins || (!heads[k].empty() && i < before[k] + kPartLines)) heads[k] += line + "\n";
    }
  for (std::size_t k = 0; k < heads.size(); ++k)
    if (std::optional<TableLayout> layout = LayoutOf(heads[k])) {
      layout->first_row += before[k];
      return layout;
    }
  return std::nullopt;
}

Result<MapFile> ReadMapOfTable(Result<YamlDocument> document, const std::string& table) {
  PREHEND_TRY(std::optional<TableLayout> layout, LayoutOfTable(table));
  return ReadMapWith(std::move(document), PoseFormat::kCsv, std::move(layout));
}

Result<MapFile> ReadMapOfHead(Result<YamlDocument> document, std::string_view head) {
  return ReadMapWith(std::move(document), PoseFormat::kCsv, LayoutOf(head));
}

Result<MapFile> ReadMapWith(Result<YamlDocument> document, PoseFormat format,
                            std::optional<TableLayout> layout) {
  const YamlNode* const node = document ? document->root.Find("separator") : nullptr;
  const std::optional<Where> separator = node ? std::optional(node->where) : std::nullopt;
  Result<MapFile> file = ReadImportMap(
      std::move(document), format, [&](Where where, ImportMap& map, DiagnosticList& errors) {
        if (layout && layout->yields && !map.columns.position.empty()) layout.reset();
        if (!layout) return;
        if (separator && format == PoseFormat::kCsv && map.separator != layout->separator)
          Contradict("separator", *separator, *layout, errors);
        Complete(*layout, where, map, errors);
      });
  if (file && layout) file->layout = std::make_shared<const TableLayout>(std::move(*layout));
  return file;
}

std::string CountDoubt(const std::set<std::size_t>& said, std::size_t there) {
  if (said.empty() || said == std::set{there}) return "";
  return fmt::format("the head says {} frames, {} are there{}", fmt::join(said, " and "), there,
                     *said.begin() > there ? ": is the file cut off?" : "");
}

std::string WithBody(const std::string& column, const std::string& body) {
  const std::size_t at = column.find("{}");
  return at == std::string::npos ? column : std::string(column).replace(at, 2, body);
}

}  // namespace prehend::exchange
