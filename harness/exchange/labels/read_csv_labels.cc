// SPDX-License-Identifier: Apache-2.0
// Labels from tables: a row for each label, for each of its two ends, or for each frame. Tested by
// tests/harness/exchange/labels/label_tables_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "harness/base/base/number_text.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/episode/take.h"
#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;

std::optional<double> NumberIn(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto number = NumberFrom<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// A number, or seconds after minutes and hours: 1:02:03.5, 02:03.5; or a date.
struct TimeCell {
  double number = 0;
  bool is_clock = false;  ///< then in seconds
};
std::optional<TimeCell> TimeIn(std::string_view text) {
  if (const std::optional<double> date_s = episode::SecondsOfDate(text))
    return TimeCell{*date_s, true};
  TimeCell time{.is_clock = text.find(':') != std::string_view::npos};
  // The sign is of the whole: -0:02 is two seconds before 0:00.
  const double sign = time.is_clock && text.starts_with('-') ? -1 : 1;
  if (time.is_clock && (sign < 0 || text.starts_with('+'))) text.remove_prefix(1);
  if (time.is_clock && text.find_first_of("+-") != std::string_view::npos) return std::nullopt;
  int parts = 0;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos;
       colon = text.find(':'), ++parts) {
    const std::optional<double> part = NumberIn(text.substr(0, colon));
    if (!part || *part != std::floor(*part) || parts == 2) return std::nullopt;
    time.number = 60 * (time.number + *part);
    text.remove_prefix(colon + 1);
  }
  const std::optional<double> rest = NumberIn(text);
  if (!rest || (time.is_clock && *rest >= 60)) return std::nullopt;
  time.number = sign * (time.number + *rest);
  return time;
}

/// A column of times.
struct TimeColumn {
  std::size_t seat = 0;
  double unit_s = 1;
  bool in_frames = false;
};

/// "Start Time" and "start_time" are one name.
std::string Plain(std::string_view word) {
  std::string plain = LowerCase(word);
  std::ranges::replace(plain, ' ', '_');
  return plain;
}

bool IsOneOf(std::string_view word, std::initializer_list<const char*> words) {
  return std::ranges::find(words, word) != words.end();
}

/// "start_ms" without its unit.
std::string_view WithoutUnit(std::string_view plain) {
  for (const std::string_view unit :
       {"_s", "_sec", "_seconds", "_ms", "_time", "_timestamp", "_frame"}) {
    if (plain.ends_with(unit)) return plain.substr(0, plain.size() - unit.size());
  }
  return plain;
}

/// Columns that say whose rows these are, or who marked them.
bool SeemsToTellTakes(std::string_view word) {
  const std::string whole = Plain(word);
  std::string_view plain = whole;
  for (const std::string_view more : {"_id", "_name"})
    if (plain.ends_with(more)) plain.remove_suffix(more.size());
  return IsOneOf(
      plain, {"take", "video", "videoid", "file", "filename", "recording", "episode", "observation",
              "session", "participant", "clip", "annotator", "coder", "rater", "observer"});
}

TimeColumn TimeColumnAt(std::size_t seat, std::string_view word) {
  const std::string plain = Plain(word);
  return {.seat = seat,
          .unit_s = plain.ends_with("_ms") ? 1e-3 : 1,
          .in_frames = plain.ends_with("_frame") || plain == "frame"};
}

/// The columns of a file by the words in its first line.
struct CsvColumns {
  std::optional<TimeColumn> begin, end, duration, time, frame;
  std::optional<std::size_t> label, tier, kind;
  std::vector<std::pair<std::string, std::size_t>> roles;
  std::vector<std::size_t> keys;
  std::map<std::string, std::vector<std::string>> called;  ///< so are begin, end, duration, label

  void Take(std::string_view word, std::size_t seat) {
    const std::string whole = Plain(word);
    const std::string_view plain = WithoutUnit(whole);
    const TimeColumn column = TimeColumnAt(seat, word);
    // Of seconds and frames the seconds.
    const auto take = [&](std::optional<TimeColumn>& into, const char* what) {
      if (into && into->in_frames && !column.in_frames) called[what].clear();
      if (!into || into->in_frames || !column.in_frames) {
        into = column;
        called[what].emplace_back(word);
      }
    };
    if (IsOneOf(plain, {"begin", "start", "onset"}))
      take(begin, "begin");
    else if (IsOneOf(plain, {"end", "stop", "offset"}))
      take(end, "end");
    else if (plain == "duration")
      take(duration, "duration");
    else if (whole == "frame")
      frame = column;
    else if (IsOneOf(plain, {"label", "event", "annotation", "text", "action", "activity", "verb",
                             "value", "behavior", "behaviour", "trial_type"}))
      label = seat, called["label"].emplace_back(word);
    else if (!tier && IsOneOf(plain, {"tier", "hand", "track", "layer"}))
      tier = seat;
  }

  bool HasTimes() const {
    return (begin && (end || duration)) || (time && kind) || (!begin && !end && frame);
  }
  bool InFrames() const { return !time && !begin && frame; }
  std::vector<std::optional<TimeColumn>*> Times() {
    std::vector<std::optional<TimeColumn>*> used;
    if (time && kind)
      used = {&time};
    else if (InFrames())
      used = {&frame};
    else
      used = {&begin, end ? &end : &duration};
    if (used.size() == 2 && end && duration) used.push_back(&duration);
    return used;
  }
  /// Of all columns that are read.
  std::vector<std::size_t> Seats() {
    std::vector<std::size_t> seats = {*label};
    for (const auto* column : Times()) seats.push_back((*column)->seat);
    if (tier) seats.push_back(*tier);
    if (time && kind) seats.push_back(*kind);
    for (const auto& [_, seat] : roles) seats.push_back(seat);
    seats.insert(seats.end(), keys.begin(), keys.end());
    return seats;
  }
};

/// Finds the columns that the map names and those that have usual names.
class ColumnFinder {
 public:
  ColumnFinder(const LabelFile& file, const std::vector<std::string>& words, const CsvReading& how)
      : file_(file), words_(words), how_(how), found_("found the columns " + Joined(words)) {}

  Result<CsvColumns> Find() {
    for (std::size_t seat = 0; seat < words_.size(); ++seat) columns_.Take(words_[seat], seat);
    Named(columns_.begin, how_.begin);
    if (Named(columns_.end, how_.end)) columns_.duration.reset();
    if (Named(columns_.duration, how_.duration)) columns_.end.reset();
    Named(columns_.frame, how_.frame);
    if (Named(columns_.time, how_.time) || !how_.frame.empty())
      columns_.begin = columns_.end = columns_.duration = std::nullopt;
    Named(columns_.label, how_.label);
    Named(columns_.tier, how_.tier);
    Named(columns_.kind, how_.kind);
    for (const grammar::Role& role : how_.roles)
      if (const auto seat = SeatOf(role.value)) columns_.roles.emplace_back(role.name, *seat);
    for (const std::string& key : how_.keys)
      if (const auto seat = SeatOf(key)) columns_.keys.push_back(*seat);
    if (!missing_.empty())
      return Problem(fmt::format("{}; the map wants a column '{}'", found_, missing_),
                     grammar::DidYouMean(missing_, words_));
    if (columns_.end && columns_.duration && columns_.duration->in_frames)
      columns_.duration.reset();
    if (columns_.HasTimes() && columns_.label) FindRoles();
    return Checked();
  }

 private:
  static std::string Joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ", "));
  }
  tl::unexpected<Diagnostics> Problem(std::string message, std::string hint) const {
    return tl::unexpected(Diagnostics{file_.At({1, 1}, std::move(message), std::move(hint))});
  }
  std::optional<std::size_t> SeatOf(const std::string& name) {
    const auto at = std::ranges::find(words_, name);
    if (at != words_.end()) return static_cast<std::size_t>(at - words_.begin());
    missing_ = name;
    return std::nullopt;
  }
  bool Named(std::optional<TimeColumn>& column, const std::string& name) {
    if (name.empty()) return false;
    if (const auto seat = SeatOf(name)) column = TimeColumnAt(*seat, name);
    return true;
  }
  void Named(std::optional<std::size_t>& column, const std::string& name) {
    if (!name.empty()) column = SeatOf(name);
  }
  /// Columns that are called as roles are; a tier is one, too, unless the map says that it is one.
  void FindRoles() {
    std::set<std::string> wanted = how_.role_names;
    for (const grammar::Role& role : how_.roles) wanted.erase(role.name);
    const std::vector<std::size_t> read = columns_.Seats();
    for (std::size_t seat = 0; seat < words_.size(); ++seat) {
      const bool is_tier = columns_.tier == seat && how_.tier.empty();
      if ((is_tier || std::ranges::count(read, seat) == 0) && wanted.erase(Plain(words_[seat])))
        columns_.roles.emplace_back(Plain(words_[seat]), seat);
    }
  }

  Result<CsvColumns> Checked() {
    if (!how_.end.empty() && std::string(WithoutUnit(Plain(how_.end))) == "duration")
      return Problem(
          fmt::format("{}; the map says that '{}' is the end of a label", found_, how_.end),
          fmt::format("a length is no end: columns: {{duration: {}}}", how_.end));
    if (columns_.begin && columns_.end && columns_.begin->seat == columns_.end->seat)
      return Problem(
          fmt::format("{}; the map says that '{}' is both the begin and the end", found_,
                      words_[columns_.end->seat]),
          fmt::format("are there rows for START and for STOP? columns: {{time: {}, kind: COLUMN}}",
                      words_[columns_.end->seat]));
    if (!columns_.HasTimes() || !columns_.label)
      return Problem(
          found_ + "; wanted one for the begin, the end and the label of each row",
          "begin_s,end_s,label or begin_ms,end_ms,label, and 'tier' if you like; or name "
          "yours in the map: columns: {begin: t0, end: t1, label: what}; also {begin, duration}, "
          "{time, kind} of rows for START and STOP, and {frame} of a row for each frame");
    for (const std::size_t seat : columns_.Seats())
      if (std::ranges::count(words_, words_[seat]) > 1)
        return Problem(fmt::format("{}: two columns are called '{}'", found_, words_[seat]), "");
    for (const auto& [what, name, is_read] :
         {std::tuple("begin", how_.begin, columns_.begin.has_value()),
          std::tuple("end", how_.end, columns_.end.has_value()),
          std::tuple("duration", how_.duration, columns_.duration.has_value()),
          std::tuple("label", how_.label, true)})
      if (const auto& words = columns_.called[what]; words.size() > 1 && name.empty() && is_read)
        return Problem(
            fmt::format("{}: which of '{}' is the {}?", found_, fmt::join(words, "' and '"), what),
            fmt::format("in the map: columns: {{{}: {}}}", what, words.front()));
    for (std::optional<TimeColumn>* column : columns_.Times()) {
      if (how_.unit_s > 0 || how_.in_frames)
        **column = {.seat = (*column)->seat, .unit_s = how_.unit_s, .in_frames = how_.in_frames};
      if (columns_.InFrames()) (*column)->in_frames = true;
      if (!(*column)->in_frames) continue;
      if (how_.rate_hz <= 0)
        return Problem(fmt::format("'{}' is counted in frames", words_[(*column)->seat]),
                       "how many has the video per second? In the map: rate_hz: 30");
      (*column)->unit_s = 1 / how_.rate_hz;
    }
    return columns_;
  }

  const LabelFile& file_;
  const std::vector<std::string>& words_;
  const CsvReading& how_;
  const std::string found_;
  CsvColumns columns_;
  std::string missing_;
};

/// What must be equal of two rows that are one label.
auto Same(const Label& label) {
  std::vector<std::string> roles;
  for (const grammar::Role& role : label.roles) roles.push_back(role.value);
  return std::tuple(label.text, label.tier, roles, label.keys);
}
using SameLabel = decltype(Same(Label{}));

/// Rows one after another become labels.
class RowTaker {
 public:
  RowTaker(LabelFile& file, CsvColumns columns, std::vector<std::string> words)
      : file_(file),
        columns_(std::move(columns)),
        words_(std::move(words)),
        cells_of_(words_.size()) {}

  void Take(const std::vector<CsvCell>& cells, int line) {
    line_ = line;
    for (std::size_t seat = 0; seat < words_.size(); ++seat)
      if (cells_of_[seat].size() < 2 && SeemsToTellTakes(words_[seat]))
        cells_of_[seat].insert(cells[seat].Value());
    Label label = Row(cells);
    if (columns_.time)
      TakeEnd(std::move(label), cells);
    else if (columns_.InFrames())
      TakeFrame(std::move(label), cells);
    else
      TakeWhole(std::move(label), cells);
  }

  Diagnostics Finish() {
    for (const auto& [_, begun] : begun_)
      Complain(begun.place.column, fmt::format("'{}' begins and never ends", begun.text),
               begun.place.line);
    if (columns_.InFrames()) JoinFrames();
    if (columns_.InFrames() && is_each_frame_ && columns_.keys.empty()) {
      file_.frames_s = (last_frame_ + 1) * columns_.frame->unit_s;
      file_.rate_hz = 1 / columns_.frame->unit_s;
    }
    const std::vector<std::size_t> read = columns_.Seats();
    for (const auto& [role, _] : columns_.roles) file_.roles.insert(role);
    for (std::size_t seat = 0; seat < words_.size(); ++seat) {
      if (std::ranges::count(read, seat) > 0) continue;
      if (cells_of_[seat].size() > 1)
        file_.several.push_back(words_[seat]);
      else if (!SeemsToTellTakes(words_[seat]) &&
               !IsOneOf(words_[seat], {"uuid", "scenario", "decided_s", "open_end"}))
        file_.unread.push_back(words_[seat]);
    }
    return std::move(problems_);
  }

  bool IsFull() const { return problems_.size() >= kMostComplaints; }
  void Complain(int column, std::string message, int line) {
    if (!IsFull()) problems_.push_back(file_.At({line, column}, std::move(message)));
  }

 private:
  Label Row(const std::vector<CsvCell>& cells) const {
    const CsvCell& text = cells[*columns_.label];
    Label label{.text = text.Value(),
                .tier = columns_.tier ? cells[*columns_.tier].Value() : "",
                .place = {line_, text.column}};
    for (const auto& [role, seat] : columns_.roles)
      if (!cells[seat].text.empty()) label.roles.push_back({role, cells[seat].Value()});
    for (const std::size_t seat : columns_.keys) label.keys.push_back(cells[seat].Value());
    return label;
  }

  std::optional<double> Seconds(const TimeColumn& column, const std::vector<CsvCell>& cells) {
    const CsvCell& cell = cells[column.seat];
    const std::optional<TimeCell> time = TimeIn(cell.text);
    if (time) return time->number * (time->is_clock ? 1 : column.unit_s);
    Complain(cell.column,
             fmt::format("{}: found '{}', wanted a number or a time like 0:01:02.5",
                         words_[column.seat], cell.text),
             line_);
    return std::nullopt;
  }

  void Keep(Label label) {
    (label.text.empty() ? file_.empty : file_.labels).push_back(std::move(label));
  }

  void TakeWhole(Label label, const std::vector<CsvCell>& cells) {
    if (label.text.empty() && cells[columns_.begin->seat].text.empty() && !label.keys.empty()) {
      file_.nothing_in.insert(std::move(label.keys));
      return;
    }
    // An event as it is printed, without times: it is compared, also where nobody marked it.
    if (label.text.ends_with(')') && cells[columns_.begin->seat].text.empty() &&
        cells[(columns_.end ? columns_.end : columns_.duration)->seat].text.empty()) {
      label.begin_s = label.end_s = std::numeric_limits<double>::quiet_NaN();
      return Keep(std::move(label));
    }
    const auto from_s = Seconds(*columns_.begin, cells),
               to_s = Seconds(columns_.end ? *columns_.end : *columns_.duration, cells);
    if (!from_s || !to_s) return;
    label.begin_s = *from_s;
    label.end_s = columns_.end ? *to_s : *from_s + *to_s;
    constexpr double kRounding_s = 0.1;
    const CsvCell* lasts =
        columns_.end && columns_.duration ? &cells[columns_.duration->seat] : nullptr;
    const std::optional<TimeCell> length = lasts ? TimeIn(lasts->text) : std::nullopt;
    const double length_s =
        length ? length->number * (length->is_clock ? 1 : columns_.duration->unit_s) : 0;
    if (length && std::abs(label.end_s - label.begin_s - length_s) > kRounding_s)
      return Complain(
          lasts->column,
          fmt::format("{}: found {:g} s, and the end is {:g} s after the begin; which is right? In "
                      "the map: columns: {{end: {}}}",
                      words_[columns_.duration->seat], length_s, label.end_s - label.begin_s,
                      words_[columns_.end->seat]),
          line_);
    Keep(std::move(label));
  }

  void TakeEnd(Label label, const std::vector<CsvCell>& cells) {
    const auto at_s = Seconds(*columns_.time, cells);
    if (!at_s) return;
    label.begin_s = label.end_s = *at_s;
    const CsvCell& kind = cells[*columns_.kind];
    const std::string plain = LowerCase(kind.text);
    if (plain == "point") return Keep(std::move(label));
    const auto begun = begun_.find(Same(label));
    if (IsOneOf(plain, {"start", "begin"})) {
      if (begun != begun_.end())
        return Complain(label.place.column,
                        fmt::format("'{}' begins again; it began in line {} and has not ended",
                                    label.text, begun->second.place.line),
                        line_);
      begun_.emplace(Same(label), std::move(label));
    } else if (IsOneOf(plain, {"stop", "end"})) {
      if (begun == begun_.end())
        return Complain(label.place.column,
                        fmt::format("'{}' ends, and no row before it begins it", label.text),
                        line_);
      begun->second.end_s = *at_s;
      Keep(std::move(begun->second));
      begun_.erase(begun);
    } else {
      Complain(kind.column,
               fmt::format("{}: found '{}', wanted START, STOP or POINT", words_[*columns_.kind],
                           kind.text),
               line_);
    }
  }

  void TakeFrame(Label label, const std::vector<CsvCell>& cells) {
    const CsvCell& cell = cells[columns_.frame->seat];
    const std::optional<double> frame = NumberIn(cell.text);
    if (!frame || *frame < 0 || *frame != std::floor(*frame))
      return Complain(cell.column,
                      fmt::format("{}: found '{}', wanted the number of a frame",
                                  words_[columns_.frame->seat], cell.text),
                      line_);
    is_each_frame_ = is_each_frame_ && *frame <= last_frame_ + 1;
    last_frame_ = std::max(last_frame_, *frame);
    if (label.text.empty()) return;  // nothing happens in this frame
    label.begin_s = *frame * columns_.frame->unit_s;
    label.end_s = (*frame + 1) * columns_.frame->unit_s;
    file_.labels.push_back(std::move(label));
  }

  /// Rows need not be in the order of the frames.
  void JoinFrames() {
    std::ranges::stable_sort(file_.labels, {}, &Label::begin_s);
    std::vector<Label> joined;
    std::map<SameLabel, std::size_t> last;
    for (Label& label : file_.labels) {
      const auto [at, is_new] = last.try_emplace(Same(label), joined.size());
      if (!is_new && label.begin_s <= joined[at->second].end_s) {
        joined[at->second].end_s = label.end_s;
        continue;
      }
      at->second = joined.size();
      joined.push_back(std::move(label));
    }
    file_.labels = std::move(joined);
  }

  LabelFile& file_;
  CsvColumns columns_;
  const std::vector<std::string> words_;
  std::vector<std::set<std::string>> cells_of_;  ///< per column, of those that may tell takes: two
  std::map<SameLabel, Label> begun_;
  double last_frame_ = 0;
  bool is_each_frame_ = true;  ///< none is left out
  Diagnostics problems_;
  int line_ = 1;
};

char SeparatorOf(std::string_view line) {
  for (const char other : {';', '\t'})
    if (line.find(',') == std::string_view::npos && line.find(other) != std::string_view::npos)
      return other;
  return ',';
}

std::vector<std::string> WordsOf(std::string_view line, char separator) {
  std::vector<std::string> words;
  for (const CsvCell& cell : CsvCellsOf(line, separator)) words.push_back(cell.Value());
  return words;
}

bool IsFaulty(const CsvCell& cell) { return !cell.fault.empty(); }

/// Of the row that begins there, and ends at `end` if no cell in quotes goes on in a later line.
std::vector<CsvCell> RowAt(std::string_view text, std::size_t begin, char separator,
                           std::size_t& end) {
  constexpr int kMostLines = 100;  // with quotes
  std::vector<CsvCell> cells = CsvCellsOf(text.substr(begin, end - begin), separator);
  const int last_column = static_cast<int>(end - begin) + 1;
  std::size_t at = end;
  for (int i = 0; i < kMostLines && std::ranges::any_of(cells, IsFaulty); ++i) {
    const std::size_t quote = text.find('"', at);
    if (quote == std::string_view::npos) break;
    at = std::min(text.find('\n', quote), text.size());
    std::vector<CsvCell> longer = CsvCellsOf(text.substr(begin, at - begin), separator);
    if (std::ranges::any_of(longer, IsFaulty)) continue;
    end = at;
    for (CsvCell& cell : longer) cell.column = std::min(cell.column, last_column);
    return longer;
  }
  return cells;
}

}  // namespace

bool IsLabelTrack(std::string_view text) {
  const std::vector<CsvCell> cells = CsvCellsOf(text.substr(0, text.find('\n')), '\t');
  return cells.size() == 3 && NumberIn(cells[0].text) && NumberIn(cells[1].text);
}

Diagnostics ReadCsvLabels(LabelFile& file, const CsvReading& how) {
  std::optional<RowTaker> rows;
  std::size_t width = 0;
  char separator = ',';
  const std::string_view text = file.text;
  const bool has_no_header = IsLabelTrack(text);
  int line_number = 0;
  for (std::size_t begin = 0; begin < text.size() && !(rows && rows->IsFull());) {
    std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const std::size_t row = std::exchange(begin, end + 1);
    if (++line_number == 1) {
      const bool has_tabs = has_no_header || LowerCase(file.file).ends_with(".tsv");
      separator = has_tabs ? '\t' : SeparatorOf(line);
      std::vector<std::string> words =
          WordsOf(has_no_header ? "begin_s\tend_s\tlabel" : line, separator);
      PREHEND_TRY(CsvColumns known, ColumnFinder(file, words, how).Find());
      width = words.size();
      rows.emplace(file, std::move(known), std::move(words));
      if (!has_no_header) continue;
    }
    // A line "\\", low, high says the frequencies of the label above.
    if (line.find_first_not_of(" \t") == std::string_view::npos ||
        (has_no_header && line.starts_with('\\')))
      continue;
    const std::vector<CsvCell> cells = RowAt(text, row, separator, end);
    begin = end + 1;
    const auto faulty = std::ranges::find_if(cells, IsFaulty);
    if (faulty != cells.end())
      rows->Complain(faulty->column, fmt::format("the cell '{}': {}", faulty->text, faulty->fault),
                     line_number);
    else if (cells.size() != width)
      rows->Complain(1, fmt::format("found {} cells, wanted {}", cells.size(), width), line_number);
    else
      rows->Take(cells, line_number);
    line_number += static_cast<int>(std::ranges::count(text.substr(row, end - row), '\n'));
  }
  return rows ? rows->Finish() : Diagnostics{};
}

std::vector<std::string> HeadOfTable(const std::string& path) {
  const Result<std::string> text = ReadTextFile(path);
  if (!text) return {};
  const std::string_view line = std::string_view(*text).substr(0, text->find('\n'));
  return WordsOf(line, LowerCase(path).ends_with(".tsv") ? '\t' : SeparatorOf(line));
}

Diagnostics ReadFrameLabels(LabelFile& file, const CsvReading& how) {
  const std::vector<std::string_view> lines = LinesOf(file.text);
  const bool by_frame = how.frames_s.size() > 1 && lines.size() == how.frames_s.size() - 1;
  if (!by_frame && how.rate_hz <= 0)
    return {file.At({},
                    how.frames_s.empty()
                        ? "it has a line for each frame"
                        : fmt::format("it has {} lines, and the recording {} frames", lines.size(),
                                      how.frames_s.size() - 1),
                    "how many has the video per second? In the map: rate_hz: 30")};
  if (!by_frame) file.rate_hz = how.rate_hz;
  if (!by_frame) file.frames_s = static_cast<double>(lines.size()) / how.rate_hz;
  const auto at_s = [&](std::size_t line) {
    return by_frame ? how.frames_s[line] : static_cast<double>(line) / how.rate_hz;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].find_first_not_of(" \t") == std::string_view::npos) continue;
    if (!file.labels.empty() && file.labels.back().text == lines[i] &&
        file.labels.back().end_s == at_s(i))
      file.labels.back().end_s = at_s(i + 1);
    else
      file.labels.push_back({.begin_s = at_s(i),
                             .end_s = at_s(i + 1),
                             .text = std::string(lines[i]),
                             .place = {static_cast<int>(i) + 1, 1}});
  }
  return {};
}

}  // namespace prehend::exchange
