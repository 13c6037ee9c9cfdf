// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"

namespace prehend::exchange {
namespace {

using Json = nlohmann::json;
using grammar::Diagnostics;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// What a map asks each frame for.
struct AskedPath {
  Located<std::string> name;
  std::vector<JsonPath> parts;  ///< several if it has braces
  std::size_t width = 0, found = 0;
  bool by_name = false;
  std::vector<double> values;
  JsonMiss miss;
};

/// Takes a frame; returns what is wrong, or "".
using TakesFrame = std::function<std::string(const Json&)>;

/// Builds each value to which a path leads, and nothing else.
class FrameReader : public nlohmann::json_sax<Json> {
 public:
  FrameReader(const JsonPath& frames, const TakesFrame& take) : frames_(frames), take_(take) {}

  std::string problem;
  std::size_t at_byte = 0;  ///< of a mistake in the text; 0: it is not in the text
  /// Of the path, how many steps led to something, and the names where it stopped.
  std::size_t steps = 0;
  std::set<std::string> names;

  bool null() override { return Take(nullptr); }
  bool boolean(bool value) override { return Take(value); }
  bool number_integer(number_integer_t value) override { return Take(value); }
  bool number_unsigned(number_unsigned_t value) override { return Take(value); }
  bool number_float(number_float_t value, const string_t&) override { return Take(value); }
  bool string(string_t& value) override { return Take(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return Open(Json::object()); }
  bool start_array(std::size_t) override { return Open(Json::array()); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }

  bool key(string_t& name) override {
    levels_.back().key = name;
    const std::size_t depth = levels_.size() - 1;
    if (inside_.empty() && depth < frames_.size() && Leads(depth)) {
      if (depth > steps) names.clear();
      steps = std::max(steps, depth);
      if (depth == steps && names.size() < 50) names.insert(name);
    }
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::json::exception& error) override {
    problem = dynamic_cast<const nlohmann::json::out_of_range*>(&error) != nullptr
                  ? "a number that is too large"
                  : "this is no JSON";
    at_byte = std::max<std::size_t>(byte, 1);
    return false;
  }

 private:
  struct Level {
    bool is_array = false;
    std::size_t next = 0;  ///< of an array
    std::string key;       ///< of an object
  };

  bool Fail(std::string why) {
    if (problem.empty()) problem = std::move(why);
    return false;
  }

  /// Whether the first `depth` steps of the path lead here.
  bool Leads(std::size_t depth) const {
    for (std::size_t i = 0; i < depth; ++i) {
      const JsonStep& step = frames_[i];
      const Level& level = levels_[i];
      const bool leads =
          step.kind == JsonStep::Kind::kAll ||
          (level.is_array ? step.kind == JsonStep::Kind::kIndex && step.index + 1 == level.next
                          : step.kind == JsonStep::Kind::kKey && step.key == level.key);
      if (!leads) return false;
    }
    return true;
  }

  /// Where a value stands in the frame that is built; null: it is of none.
  Json* Place(Json value) {
    if (!levels_.empty() && levels_.back().is_array) ++levels_.back().next;
    if (!inside_.empty()) {
      Json& parent = *inside_.back();
      if (++values_ > kMostJsonValues) {
        Fail(
            fmt::format("a frame of more than {} values; 'frames' of the map says which list "
                        "has them: $.frames[*]",
                        kMostJsonValues));
        return nullptr;
      }
      if (!parent.is_array()) return &(parent[levels_.back().key] = std::move(value));
      parent.push_back(std::move(value));
      return &parent.back();
    }
    if (levels_.size() != frames_.size() || !Leads(levels_.size())) return nullptr;
    values_ = 0;
    frame_ = std::move(value);
    return &frame_;
  }

  bool Finish() {
    std::string why = take_(frame_);
    frame_ = nullptr;
    return why.empty() || Fail(std::move(why));
  }

  bool Take(Json value) {
    const Json* const place = Place(std::move(value));
    return problem.empty() && (place != &frame_ || Finish());
  }

  bool Open(Json value) {
    if (levels_.size() >= kMostJsonDepth)
      return Fail(fmt::format("nested deeper than {} levels", kMostJsonDepth));
    const bool is_array = value.is_array();
    Json* const place = Place(std::move(value));
    if (place) inside_.push_back(place);
    levels_.push_back({.is_array = is_array, .key = {}});
    return problem.empty();
  }

  bool Close() {
    levels_.pop_back();
    if (inside_.empty()) return true;
    inside_.pop_back();
    return !inside_.empty() || Finish();
  }

  const JsonPath& frames_;
  const TakesFrame& take_;
  std::vector<Level> levels_;
  std::vector<Json*> inside_;  ///< what is open of the frame
  Json frame_;
  std::size_t values_ = 0;
};

class JsonRows : public RowSource {
 public:
  /// `is_line`: others follow, so what is not in it may be in one of these.
  JsonRows(const std::string& path, std::string text, const MapFile& map, bool is_line = false)
      : file_(path),
        text_(std::move(text)),
        map_(map.map),
        is_line_(is_line),
        errors_(map.document) {
    nan_is_missing = true;
    if (map_.t) Ask(*map_.t);
    for (const Named<MappedEntity>& entity : map_.entities) {
      const MappedEntity& e = entity.value;
      for (const auto* one :
           {&e.pose, &e.position, &e.quaternion, &e.euler, &e.axis_angle, &e.rotation, &e.first})
        if (*one) Ask(**one);
      for (const auto* opening : {&e.grip, &e.joint})
        if (*opening)
          for (const Located<std::string>& name : (*opening)->from) Ask(name);
    }
  }

  /// What is wrong with the file or with the map.
  Diagnostics Load() {
    const bool is_lines = !is_line_ && IsJsonLines(file_, text_);
    JsonPath frames;
    if (map_.frames) {
      if (const auto path = ParseJsonPath(map_.frames->value))
        frames = *path;
      else
        errors_.Add(map_.frames->where, "this is no path of JSON", "frames: $.frames[*]");
    } else if (!is_lines && text_.find_first_not_of(" \t\n") == text_.find('[')) {
      frames.push_back({.kind = JsonStep::Kind::kAll, .key = {}, .value = {}});
    }
    if (!errors_.empty()) return errors_.Sorted();
    const TakesFrame take = [this](const Json& frame) { return TakeFrame(frame); };
    std::size_t steps = 0;
    std::set<std::string> names;
    line_is_of_frame_ = is_lines;
    for (std::size_t begin = 0; begin < text_.size();) {
      const std::size_t end =
          is_lines ? std::min(text_.find('\n', begin), text_.size()) : text_.size();
      const std::string_view part = std::string_view(text_).substr(begin, end - begin);
      if (part.find_first_not_of(" \t\n") != std::string_view::npos) {
        FrameReader reader(frames, take);
        const bool read = Json::sax_parse(part.begin(), part.end(), &reader);
        if (!reader.problem.empty() || !read) return {Problem(reader, part, begin)};
        if (reader.steps >= steps) names.insert(reader.names.begin(), reader.names.end());
        steps = std::max(steps, reader.steps);
      }
      begin = end + 1;
      ++line_;
    }
    if (is_line_ && count_ + left_out_ == 1 && left_out_ == 1) {
      grammar::Diagnostic left_out = grammar::DiagnosticAt(
          file_, text_, {1, 1}, fmt::format("it has {}, and is left out", Lacks()), "");
      left_out.is_warning = true;
      return {std::move(left_out)};
    }
    if (is_line_) return count_ < 2 ? Diagnostics{} : Diagnostics{ManyFrames()};
    if (count_ + left_out_ == 0 && !map_.frames)
      return {grammar::DiagnosticAt(file_, text_, {1, 1}, "there is no frame in it", "")};
    if (count_ + left_out_ == 0)
      errors_.AddUnknownName(
          map_.frames->where, fmt::format("nothing is at '{}'", map_.frames->value),
          steps < frames.size() ? frames[steps].key : "", {names.begin(), names.end()});
    else if (!map_.frames && !is_lines && frames.empty() && !IsOfColumns())
      errors_.Add(map_.entities.front().name_where,
                  "the file is one object, and not a list of frames",
                  "the map says where the list is: frames: $.frames[*]; the object has " +
                      fmt::format("{}", fmt::join(members_, ", ")));
    if (errors_.empty() && IsOfColumns()) SplitColumns();
    return errors_.Sorted();
  }

  std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) override {
    const AskedPath& path = *std::ranges::find_if(
        asked_, [&](const AskedPath& one) { return one.name.value == name.value; });
    if (is_line_ && path.width == 0 && !(map_.t && &path == &asked_.front())) return std::nullopt;
    if (path.found == 0) {
      errors.AddUnknownName(
          name.where,
          fmt::format("no frame has '{}': {}", name.value,
                      path.miss.name.empty()
                          ? "it is null"
                          : fmt::format("there is no '{}'", ReadableName(path.miss.name))),
          path.miss.name, path.miss.names);
      return std::nullopt;
    }
    return Rows{.count = count_,
                .width = path.width,
                .is_matrix = path.width == 16,
                .by_name = path.by_name,
                .shape = fmt::format("{} in each of {} frames",
                                     grammar::CountOf(path.width, "number"), count_),
                .values = path.values};
  }

  std::string Note() const override {
    return left_out_ == 0
               ? ""
               : fmt::format("{} of {} frames have {}", left_out_, count_ + left_out_, Lacks());
  }
  std::vector<int> Lines() const override { return lines_; }
  std::string Columns(const std::string&, std::size_t) const override { return ""; }
  std::size_t count() const { return count_; }

 private:
  /// What frames have that are left out.
  const char* Lacks() const {
    return map_.t ? "no time, or nothing that the map asks for" : "nothing that the map asks for";
  }

  grammar::Diagnostic ManyFrames() const {
    return grammar::DiagnosticAt(file_, text_, {1, 1},
                                 fmt::format("a line of {} frames; one was expected", count_), "");
  }

  void Ask(const Located<std::string>& name) {
    const auto has = [&](const AskedPath& one) { return one.name.value == name.value; };
    if (std::ranges::any_of(asked_, has)) return;
    AskedPath asked{.name = name};
    for (const std::string& part : WithoutBraces(name.value)) {
      const auto path = ParseJsonPath(part);
      const auto goes_all = [](const JsonStep& s) { return s.kind == JsonStep::Kind::kAll; };
      if (!path || std::ranges::any_of(*path, goes_all))
        return errors_.Add(name.where,
                           fmt::format("'{}' is no path into a frame", ReadableName(name.value)),
                           "hands[0].palm, or hands[type=right].palm; \"pos_{x,y,z}\"");
      asked.parts.push_back(*path);
    }
    asked_.push_back(std::move(asked));
  }

  std::string TakeFrame(const Json& frame) {
    if (count_ >= kMostJsonFrames) return fmt::format("more than {} frames", kMostJsonFrames);
    if (count_ == 0 && frame.is_object())
      for (const auto& [key, member] : frame.items())
        if (members_.size() < 20)
          members_.push_back(ReadableName(key) + (member.is_array() ? "[*]" : ""));
    bool has_any = !map_.t, has_time = true;
    for (AskedPath& path : asked_) {
      JsonMiss miss;
      const Json* const value = FindInJson(frame, path.parts.front(), miss);
      has_any = has_any || value;
      if (map_.t && &path == &asked_.front()) has_time = value && !value->is_null();
      if (!value && path.found == 0 && miss.steps >= path.miss.steps) path.miss = std::move(miss);
    }
    left_out_ += has_any && has_time ? 0 : 1;
    if (!has_any || !has_time) return "";  // the head of a log
    for (AskedPath& path : asked_) {
      if (std::string why = TakePath(frame, path); !why.empty())
        return fmt::format("frame {}: {}", count_, why);
    }
    ++count_;
    if (line_is_of_frame_) lines_.push_back(line_);
    return "";
  }

  std::string TakePath(const Json& frame, AskedPath& path) {
    std::vector<double> numbers;
    bool has_all = true;
    for (const JsonPath& part : path.parts) {
      JsonMiss miss;
      const Json* const value = FindInJson(frame, part, miss);
      has_all = has_all && value && !value->is_null();
      path.found += value ? 1 : 0;
      if (!has_all) break;
      bool by_name = false;
      if (IsTime(path) && value->is_string())
        numbers.push_back(SecondsOfIsoTime(value->get_ref<const std::string&>()).value_or(kNone));
      else if (!NumbersOfJson(*value, numbers, by_name))
        return fmt::format("expected numbers at '{}', found {}", ReadableName(path.name.value),
                           ReadableName(value->dump(-1, ' ', true).substr(0, 60)));
      path.by_name = by_name;
    }
    if (!has_all) numbers.assign(path.width, kNone);
    if (has_all && path.width == 0) {
      path.width = numbers.size();
      path.values.assign(count_ * path.width, kNone);  // those before it had none
    }
    if (numbers.size() != path.width)
      return fmt::format("'{}' is {} here, and {} before", ReadableName(path.name.value),
                         grammar::CountOf(numbers.size(), "number"), path.width);
    path.values.insert(path.values.end(), numbers.begin(), numbers.end());
    numbers_ += numbers.size();
    return numbers_ > kMostRowNumbers ? fmt::format("more than {} numbers", kMostRowNumbers) : "";
  }

  bool IsTime(const AskedPath& path) const {
    return map_.t && map_.time_unit->value == TimeUnit::kIso && path.name.value == map_.t->value;
  }

  /// One object, whose lists have a number for each time.
  bool IsOfColumns() const { return count_ == 1 && map_.t && asked_.front().width > 1; }

  void SplitColumns() {
    const std::size_t times = asked_.front().width;
    for (AskedPath& path : asked_) {
      if (path.found == 0) continue;
      if (path.values.size() % times != 0)
        errors_.Add(path.name.where,
                    fmt::format("'{}' has {}, for {} times", path.name.value,
                                grammar::CountOf(path.values.size(), "number"), times));
      path.width = path.values.size() / times;
    }
    count_ = times;
    lines_.clear();
  }

  grammar::Diagnostic Problem(const FrameReader& reader, std::string_view part, std::size_t begin) {
    grammar::Place place;
    std::string message = reader.problem.empty() ? "this is no JSON" : reader.problem, hint;
    if (reader.at_byte > 0) {
      const std::size_t in_part = std::min(reader.at_byte, part.size()) - 1;
      const std::string_view before = std::string_view(text_).substr(0, begin + in_part);
      const std::size_t newline = before.rfind('\n');
      place.line = 1 + static_cast<int>(std::ranges::count(before, '\n'));
      place.column =
          static_cast<int>(before.size() - (newline == std::string_view::npos ? 0 : newline + 1)) +
          1;
      if (reader.at_byte > part.size())
        message = "the file ends within a value: is it cut off?";
      else if (part.substr(in_part < 3 ? 0 : in_part - 3, 7).find("NaN") != std::string_view::npos)
        hint = "NaN is no JSON: what is not tracked is null";
    } else if (line_is_of_frame_) {
      place = {line_, 1};
    }
    return grammar::DiagnosticAt(file_, text_, place, std::move(message), std::move(hint));
  }

  const std::string file_, text_;
  const ImportMap& map_;
  const bool is_line_;
  DiagnosticList errors_;
  std::vector<AskedPath> asked_;  ///< the time first
  std::size_t count_ = 0, left_out_ = 0, numbers_ = 0;
  int line_ = 1;
  bool line_is_of_frame_ = false;
  std::vector<int> lines_;
  std::vector<std::string> members_;  ///< of the first frame
};

}  // namespace

Result<PoseFile> ReadJsonPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(std::string text, ReadTextFile(path, kMostJsonBytes));
  JsonRows rows(path, std::move(text), map);
  if (Diagnostics wrong = rows.Load(); !wrong.empty()) return tl::unexpected(std::move(wrong));
  const double rate_hz = map.map.rate_hz ? map.map.rate_hz->value : 1;
  return ReadRowPoses(rows, map, path, rate_hz);
}

PoseLines::PoseLines(const std::string& name, const MapFile& map) {
  const auto poses = std::make_shared<PoseFile>();
  const double rate_hz = map.map.rate_hz ? map.map.rate_hz->value : 1;
  poses_ = poses.get();
  take_ = [=, &map, stream = RowStream()](const std::string& line,
                                          std::optional<double>& row_s) mutable -> Diagnostics {
    row_s = std::nullopt;
    if (line.find_first_not_of(" \t") == std::string::npos) return {};
    JsonRows rows(name, line, map, /*is_line=*/true);
    if (Diagnostics wrong = rows.Load(); !wrong.empty() || rows.count() == 0) return wrong;
    Result<PoseFile> read = ReadRowPoses(rows, map, name, rate_hz, &stream);
    if (read && read->rows > 0) row_s = read->last_s;
    stream.frames += rows.count();
    if (!read) return read.error();
    *poses = std::move(*read);
    return {};
  };
}

}  // namespace prehend::exchange
