// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/column_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "harness/base/base/number_text.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kHeadLines = 200, kLongestName = 200;

enum Kind { kPosition, kQuaternion, kAngles, kOther };

/// What the name of a column says.
struct Part {
  Kind kind = kOther;
  std::size_t axis = 0;  ///< of x, y, z, w
  std::string before, body, after, unit;
  std::size_t letter = 0;  ///< where a body's name would end that has the one letter of the kind

  std::string Pattern() const { return before + (body.empty() ? "" : "{}") + after; }
};

/// "Cup_pos_x", "cup.qw", "x_cup", "CupX", "X (mm)", "cup_yaw".
Part PartOf(const std::string& name) {
  const std::string words =
      "pos|position|translation|trans|location|loc|point|p|t|"
      "quaternion|quat|orientation|orient|q|o|rotation|rot|euler|angle|r";
  static const std::regex kBehind("^(?:(.+?)([ _.:/-]+))?((?:(?:" + words +
                                      ")[ _.:/-]*)?[\\[(]?)([xyzw]|roll|pitch|yaw)" +
                                      "([\\])]?(?:[ _]*[\\[(]?(m|mm|cm|in|inch|deg|rad)[\\])]?)?)$",
                                  std::regex::icase);
  static const std::regex kBefore("^((?:(?:" + words + ")[ _.:/-]*)?)([xyzw])([ _.:/-]+)(.+)$",
                                  std::regex::icase);
  static const std::regex kCamel("^(.*?[a-z0-9])((?:Position|Pos|Rotation|Rot|Quat|Q)?)([XYZW])$");
  Part part;
  std::smatch m;
  std::string word, axis;
  if (name.size() > kLongestName) return part;
  if (std::regex_match(name, m, kBehind)) {
    static const std::regex kWord("^(?:pose|" + words + ")$", std::regex::icase);
    part.body = m[1], word = m[3], axis = m[4], part.unit = LowerCase(m.str(6));
    if (word.empty() && std::regex_match(part.body, kWord)) word.swap(part.body);  // of one body
    part.after = name.substr(part.body.size());
    if (word.size() == 2 && !part.body.empty() &&
        !std::isalpha(static_cast<unsigned char>(word[1])))
      part.letter = part.body.size() + static_cast<std::size_t>(m.length(2)) + 1;
  } else if (std::regex_match(name, m, kCamel)) {
    part.body = m[1], word = m[2], axis = m[3];
    part.after = name.substr(part.body.size());
  } else if (std::regex_match(name, m, kBefore)) {
    word = m[1], axis = m[2], part.body = m[4];
    part.before = name.substr(0, name.size() - part.body.size());
  } else {
    return part;
  }
  axis = LowerCase(axis);
  word = axis.size() > 1 ? "angle" : LowerCase(word);
  part.axis = std::string_view(axis.size() > 1 ? "rpy" : "xyzw").find(axis.front());
  const char first = word.empty() ? 'p' : word.front();
  part.kind = word.starts_with("or") || first == 'q' || first == 'o' ? kQuaternion
              : first == 'r' || first == 'e' || first == 'a'         ? kAngles
              : part.axis == 3                                       ? kQuaternion
                                                                     : kPosition;
  return part;
}

using Rows = std::vector<std::vector<std::string>>;

Rows RowsOf(std::string_view text, Separator separator) {
  Rows rows;
  for (std::size_t line = 0; !text.empty() && line < kHeadLines; ++line) {
    std::string_view whole = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(whole.size() + 1, text.size()));
    if (whole.ends_with('\r')) whole.remove_suffix(1);
    if (whole.starts_with('#'))
      whole.remove_prefix(std::min(whole.find_first_not_of("# "), whole.size()));
    std::vector<std::string>& row = rows.emplace_back();
    for (const CsvCell& cell : TableCellsOf(whole, separator)) row.emplace_back(cell.text);
    while (row.size() > 1 && row.back().empty()) row.pop_back();
  }
  return rows;
}

/// The row with the names: the one with the most columns of positions.
std::size_t HeaderOf(const Rows& rows, std::size_t& positions) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto count = static_cast<std::size_t>(std::ranges::count_if(
        rows[i], [](const std::string& cell) { return PartOf(cell).kind == kPosition; }));
    if (count > positions) best = i;
    positions = std::max(positions, count);
  }
  return best;
}

/// Columns of one body.
using Columns = std::map<Kind, std::array<std::string, 4>>;

bool IsWhole(const Columns& columns, Kind kind) {
  const auto found = columns.find(kind);
  return found != columns.end() &&
         std::ranges::none_of(std::span(found->second).first(3), &std::string::empty);
}

class Finder {
 public:
  Finder(const Rows& rows, std::size_t header) : rows_(rows), header_(header) {}

  std::optional<NamedColumns> Find(bool decimal_comma) {
    found_.decimal_comma = decimal_comma;
    const std::vector<std::string>& names = rows_[header_];
    std::map<std::string, Columns> bodies;
    const auto add_all = [&] {
      bodies.clear();
      for (const std::string& name : names)
        if (const Part& part = parts_[name]; part.kind != kOther)
          bodies[part.body][part.kind][part.axis] = name;
    };
    for (const std::string& name : names) parts_[name] = PartOf(name);
    add_all();
    // The "r" of "hand_r_x" is a side, and no rotation: of a hand that is nowhere else, of what has
    // a left one, or turns by itself.
    for (auto& [name, part] : parts_) {
      if (part.letter == 0 || IsWhole(bodies[part.body], kPosition)) continue;
      const std::string body = name.substr(0, part.letter);
      const std::string left = body.substr(0, part.letter - 1) + (body.back() == 'r' ? 'l' : 'L');
      if (LowerCase(body).back() != 'r' ||
          !(IsHand(WordsIn(part.body)) || bodies.contains(left) || bodies.contains(body)))
        continue;
      part.after = name.substr(part.letter);
      part.body = body, part.kind = kPosition;
    }
    add_all();
    for (const auto& [name, part] : parts_)
      if (!part.unit.empty() && part.kind == kPosition)
        found_.unit = part.unit == "in" ? "inch" : part.unit;
    // The body with the most columns is the pattern of all.
    const Columns* best = nullptr;
    std::string of;
    std::size_t whole = 0;
    for (const auto& [body, columns] : bodies) {
      if (!IsWhole(columns, kPosition)) continue;
      ++whole;
      if (best && best->size() >= columns.size()) continue;
      best = &columns;
      of = body;
    }
    if (!best) return std::nullopt;
    const bool one = whole == 1;
    const auto add = [&](std::vector<std::string>& list, Kind kind, std::size_t count) {
      for (const std::string& name : std::span(best->at(kind)).first(count))
        list.push_back(one ? name : parts_.at(name).Pattern());
    };
    add(found_.position, kPosition, 3);
    for (const Kind kind : {kQuaternion, kAngles}) {
      if (!IsWhole(*best, kind) || !found_.orientation.empty()) continue;
      const bool four = !best->at(kind)[3].empty();
      if (kind == kQuaternion && !four) continue;
      add(found_.orientation, kind, four ? 4 : 3);
      found_.form = four ? OrientationForm::kQuaternion : OrientationForm::kEuler;
      for (const std::string& name : std::span(best->at(kind)).first(3))
        found_.in_degrees |= parts_.at(name).unit == "deg" || Largest(name) > 2 * 3.2;
      found_.roll_first = LowerCase(best->at(kind).front()).find("roll") != std::string::npos;
    }
    FindTime(names);
    if (one && of.empty()) FindKeys(names);
    const auto in = [](const std::vector<std::string>& list, const std::string& name) {
      return std::ranges::any_of(list, [&](const std::string& pattern) {
        return name == pattern || BodyOfColumn(pattern, name);
      });
    };
    for (const std::string& name : names)
      if (!name.empty() && name != found_.time && !in(found_.keys, name) &&
          !in(found_.position, name) && !in(found_.orientation, name))
        found_.others.push_back(name);
    return found_;
  }

 private:
  std::vector<std::string> CellsOf(const std::string& name) const {
    const auto& names = rows_[header_];
    const auto seat = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    std::vector<std::string> cells;
    for (std::size_t i = header_ + 1; i < rows_.size(); ++i)
      if (seat < rows_[i].size() && !rows_[i][seat].empty()) cells.push_back(rows_[i][seat]);
    return cells;
  }

  double Largest(const std::string& name) const {
    double most = 0;
    for (const std::string& cell : CellsOf(name))
      most = std::max(most, std::abs(NumberOf(cell, found_.decimal_comma).value_or(0)));
    return most;
  }

  void FindTime(const std::vector<std::string>& names) {
    const NamedTime time = TimeAmong(
        names, [&](const std::string& name) { return CellsOf(name); }, found_.decimal_comma);
    found_.time = time.name, found_.time_unit = time.unit, found_.time_doubt = time.doubt;
  }

  void FindKeys(const std::vector<std::string>& names) {
    static const std::regex kKey(
        "^(body|rigid[ _]?body|name|object|entity|id|label|marker|landmark|joint|device|tracker|"
        "hand|side|bone|segment|subject|child_frame_id|body_name|object_name|track[ _]?id)$",
        std::regex::icase);
    for (const std::string& name : names) {
      const std::vector<std::string> cells = CellsOf(name);
      const bool is_text =
          !cells.empty() && std::ranges::none_of(cells, [&](const std::string& cell) {
            return NumberOf(cell, true) || SecondsOfIsoTime(cell);
          });
      const std::set<std::string> values(cells.begin(), cells.end());
      if (name != found_.time && (std::regex_match(name, kKey) || (is_text && values.size() > 1)))
        found_.keys.push_back(name);
    }
  }

  const Rows& rows_;
  const std::size_t header_;
  std::map<std::string, Part> parts_;  ///< by the name of the column
  NamedColumns found_;
};

}  // namespace

NamedTime TimeAmong(const std::vector<std::string>& names, const CellsOfName& cells_of,
                    bool decimal_comma) {
  static const std::regex kTime(
      "^(t|time|times|timestamps?|time[_ -]?stamp|stamp|sec|secs|seconds|clock|datetime|utc|"
      "ms|us|ns|(?:unix|epoch)(?:[ _-]?time)?)"
      "[ _]*[\\[(]?(s|sec|seconds|ms|milliseconds|us|ns)?[\\])]?$|^(frame|frames|frame#|index|"
      "sample)$",
      std::regex::icase);
  NamedTime time;
  std::smatch m;
  for (const bool frames : {false, true}) {
    for (const std::string& name : names) {
      if (!time.name.empty() || name.size() > kLongestName || !std::regex_match(name, m, kTime) ||
          m[3].matched != frames)
        continue;
      time.name = name;
      time.unit = frames ? "frame" : LowerCase(m[2].matched || name.size() != 2 ? m.str(2) : name);
    }
  }
  if (time.name.empty() || time.unit == "frame") return time;
  std::string& unit = time.unit;
  if (unit.starts_with("sec")) unit = "s";
  if (unit.starts_with("milli")) unit = "ms";
  const std::vector<std::string> cells = cells_of(time.name);
  if (!cells.empty() && !NumberOf(cells.front(), decimal_comma) && SecondsOfIsoTime(cells.front()))
    unit = "iso";
  if (!unit.empty()) return time;
  std::vector<double> steps;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const double step = NumberOf(cells[i], decimal_comma).value_or(0) -
                        NumberOf(cells[i - 1], decimal_comma).value_or(0);
    if (step > 0) steps.push_back(step);
  }
  std::ranges::sort(steps);
  const double step = steps.empty() ? 0.01 : steps[steps.size() / 2];
  unit = step < 0.6 ? "s" : step == 1 ? "frame" : step < 500 ? "ms" : step < 5e5 ? "us" : "ns";
  time.doubt = "by its steps";
  return time;
}

std::optional<std::string> BodyOfColumn(const std::string& pattern, const std::string& name) {
  const std::size_t at = pattern.find("{}");
  if (at == std::string::npos || name.size() + 2 <= pattern.size() ||
      !name.starts_with(pattern.substr(0, at)) || !name.ends_with(pattern.substr(at + 2)))
    return std::nullopt;
  return name.substr(at, name.size() + 2 - pattern.size());
}

std::optional<NamedColumns> ColumnsOf(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::optional<NamedColumns> best;
  std::size_t most = 2;
  for (const Separator separator :
       {Separator::kComma, Separator::kSemicolon, Separator::kTab, Separator::kSpace}) {
    const Rows rows = RowsOf(text, separator);
    std::size_t positions = 0;
    const std::size_t header = HeaderOf(rows, positions);
    if (positions <= most) continue;
    bool decimal_comma = false;
    for (std::size_t i = header + 1; separator != Separator::kComma && i < rows.size(); ++i)
      for (const std::string& cell : rows[i])
        decimal_comma |= !NumberOf(cell, false) && NumberOf(cell, true);
    auto found = Finder(rows, header).Find(decimal_comma);
    if (!found) continue;
    found->separator = separator;
    found->header_line = static_cast<int>(header) + 1;
    most = positions;
    best = std::move(found);
  }
  return best;
}

// See harness/exchange/cells/column_names.h.

Words WordsIn(const std::string& name) {
  Words words(1);
  char before = ' ';
  for (const char c : name) {
    const bool is_letter = std::isalpha(static_cast<unsigned char>(c)) != 0,
               is_digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    const bool begins = (std::isupper(static_cast<unsigned char>(c)) &&
                         std::islower(static_cast<unsigned char>(before))) ||
                        (is_digit && !std::isdigit(static_cast<unsigned char>(before)));
    if ((begins || !(is_letter || is_digit)) && !words.back().empty()) words.emplace_back();
    if (is_letter || is_digit)
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    before = c;
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool AnyOf(const Words& words, const std::set<std::string>& of) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    const bool side = word.size() > 3 && (word[0] == 'l' || word[0] == 'r');
    return of.contains(word) || (side && of.contains(word.substr(1)));
  });
}

bool IsBone(const Words& words) {
  return AnyOf(words, {"hip",   "hips",  "ab",     "chest",  "neck",  "head",  "shoulder",
                       "uarm",  "farm",  "arm",    "thigh",  "shin",  "leg",   "foot",
                       "toe",   "spine", "ankle",  "knee",   "calf",  "elbow", "pelvis",
                       "thumb", "index", "middle", "collar", "pinky", "ring",  "finger"});
}

bool IsHand(const Words& words) {
  return AnyOf(words, {"hand", "glove", "wrist", "palm", "lh", "rh", "gripper", "eef", "ee", "tcp",
                       "righthand", "lefthand"}) &&
         !IsBone(words);
}

bool IsTable(const Words& words) {
  return AnyOf(words, {"table", "desk", "shelf", "bench", "counter", "worktop", "floor", "rack"});
}

}  // namespace prehend::exchange
