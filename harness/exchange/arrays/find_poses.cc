// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/cells/column_names.h"
#include "harness/exchange/cells/table_cells.h"

namespace prehend::exchange {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostProposedBytes = std::size_t{64} << 20, kMostPaths = 1000;
constexpr std::size_t kLongestKey = 100, kMostLevels = 8, kLooks = 50, kMostInList = 50;

enum class Says { kNothing, kPlace, kTurn, kPose, kOther };

/// "cup_pos" is the place of a cup, "rotation" a turn, "velocity" neither.
Says PartOfName(std::string& name) {
  const std::string place = "position|pos|translation|location|xyz", pose = "pose|transform|matrix",
                    turn = "quaternion|quat|orientation|rotation|rot";
  static const std::regex kPart("^(?:(.*?)[_. :/-]*)(?:(" + place + ")|(" + turn + ")|(" + pose +
                                    "))(?:_(?:m|cm|mm|xyzw|wxyz))?_?$",
                                std::regex::icase);
  static const std::regex kLetter("^(?:(.*)[_. :/-])?(?:(p|t)|(q|r))_?$", std::regex::icase);
  static const std::regex kOther(
      "^.*(veloc|accel|normal|direction|extent|colou?r|gravity|force|torque|euler|angle|angular).*$"
      "|^(.*[_. "
      "-])?(vel|acc|dir|size|dim|dimensions|up|forward|offset|scale|rpy|ypr|rotvec|rvec|gyro|omega)"
      "$",
      std::regex::icase);
  std::smatch m;
  const std::string all = name.substr(0, kLongestKey);
  if (std::regex_match(all, m, kPart) || std::regex_match(all, m, kLetter)) {
    name = m[1];
    return m[2].matched ? Says::kPlace : m[3].matched ? Says::kTurn : Says::kPose;
  }
  return std::regex_match(all, kOther) ? Says::kOther : Says::kNothing;
}

std::string Joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + " " + b;
}

std::string Member(const std::string& path, const std::string& key) {
  const bool is_plain = !key.empty() && std::ranges::all_of(key, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (!is_plain) return fmt::format("{}['{}']", path, key);
  return path.empty() ? key : path + "." + key;
}

/// The frames of a file, or some of them.
struct JsonFrames {
  std::string path;  ///< "": lines, or a list
  std::vector<const Json*> frames;
};

/// The longest list of objects is that of the frames.
void FindFrames(const Json& value, const std::string& path, std::size_t level, JsonFrames& best) {
  if (value.is_array() && value.size() > best.frames.size() && value.front().is_object()) {
    best = {.path = path + "[*]", .frames = {}};
    for (const Json& frame : value) best.frames.push_back(&frame);
  }
  if (!value.is_object() || level == 0) return;
  for (const auto& [key, member] : value.items())
    FindFrames(member, Member(path, key), level - 1, best);
}

std::string TextOfMember(const Json& object, const std::string& key) {
  const auto member = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || member == object.end()) return "";
  return member->is_string()           ? member->get<std::string>()
         : member->is_number_integer() ? member->dump()
                                       : "";
}

/// The member that names each of some objects; "" if there is none.
std::string NameKeyOf(const std::vector<const Json*>& objects, bool all_differ) {
  for (const char* key : {"name", "label", "type", "side", "handedness", "hand", "body", "id"}) {
    std::set<std::string> values;
    for (const Json* object : objects) values.insert(TextOfMember(*object, key));
    if (!values.contains("") &&
        (all_differ ? values.size() == objects.size()
                    : values.size() > 1 && 2 * values.size() <= objects.size()))
      return key;
  }
  return "";
}

class JsonWalk {
 public:
  explicit JsonWalk(FoundPoses& found) : found_(found) {}

  /// `name_key`: which member says whose frame it is, of a file with one body a line.
  void Frame(const Json& frame, const std::string& name_key) {
    const std::string whose = TextOfMember(frame, name_key);
    Look(frame, whose.empty() ? "" : fmt::format("[{}={}]", name_key, whose), whose, "", 0, false);
  }

 private:
  void Add(const std::string& owner, const std::string& name, const std::string& path,
           std::size_t width, bool has_order) {
    if (seen_.size() < kMostPaths && path.size() < 2 * kLongestKey && seen_.insert(path).second)
      found_.Add(owner, name, path, width, has_order);
  }

  void Look(const Json& value, const std::string& path, const std::string& owner,
            const std::string& name, std::size_t level, bool in_list) {
    std::vector<double> numbers;
    bool has_order = false;
    const bool is_vector =
        value.is_string() && value.get_ref<const std::string&>().starts_with('(');
    if (level == 0 || !(value.is_structured() || is_vector) ||
        !NumbersOfJson(value, numbers, has_order))
      numbers.clear();
    if (!numbers.empty()) Add(owner, name, path, numbers.size(), has_order);
    found_.is_of_unity |= is_vector && numbers.size() == 3;
    const std::string whole = Joined(owner, name);
    if (value.is_object() && level < kMostLevels) {
      LookForThree(value, path, whole, !numbers.empty());
      for (const auto& [key, member] : value.items())
        if (key.size() < kLongestKey)
          Look(member, Member(path, key), whole, key, level + 1, in_list);
    }
    if (value.is_array() && !in_list && level < kMostLevels) LookInList(value, path, whole, level);
  }

  /// "px", "py", "pz".
  void LookForThree(const Json& object, const std::string& path, const std::string& owner,
                    bool has_own) {
    for (const auto& [key, member] : object.items()) {
      if (!member.is_number() || key.empty() || (key.back() != 'x' && key.back() != 'X')) continue;
      const std::string stem = key.substr(0, key.size() - 1), small = "xyzw", large = "XYZW";
      const std::string& axes = key.back() == 'x' ? small : large;
      std::size_t count = 0;
      while (count < 4 && object.contains(stem + axes[count])) ++count;
      if (count < 3 || (has_own && stem.empty())) continue;
      const std::string braces =
          fmt::format("{}{{{}}}", stem, fmt::join(std::string_view(axes).substr(0, count), ","));
      Add(owner, stem, path.empty() ? braces : path + "." + braces, count, false);
    }
  }

  void LookInList(const Json& list, const std::string& path, const std::string& called,
                  std::size_t level) {
    std::vector<const Json*> objects;
    for (const Json& one : list)
      if (one.is_object() && objects.size() < kMostInList) objects.push_back(&one);
    const std::string key = NameKeyOf(objects, /*all_differ=*/true);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const std::string value = key.empty() ? std::to_string(i) : TextOfMember(*objects[i], key);
      const bool says_all = key == "name" || key == "label" || key == "body";
      std::string one = called;
      if (one.ends_with('s')) one.pop_back();
      Look(*objects[i],
           path + (key.empty() ? "[" + value + "]" : fmt::format("[{}={}]", key, value)),
           says_all ? value : Joined(one, value), "", level + 1, /*in_list=*/true);
    }
  }

  FoundPoses& found_;
  std::set<std::string> seen_;
};

constexpr std::size_t kMostNames = 50;  ///< in an error
constexpr std::string_view kBlanks = " \t";

bool IsQuoted(std::string_view text) {
  return text.size() > 1 && (text.front() == '\'' || text.front() == '"') &&
         text.back() == text.front();
}

/// What stands between brackets.
std::optional<JsonStep> StepInBrackets(std::string_view text) {
  text = Trimmed(text, kBlanks);
  if (text == "*") return JsonStep{.kind = JsonStep::Kind::kAll, .key = {}, .value = {}};
  if (IsQuoted(text)) return JsonStep{.key = std::string(text.substr(1, text.size() - 2))};
  if (const auto index = NumberFrom<std::size_t>(text))
    return JsonStep{.kind = JsonStep::Kind::kIndex, .key = {}, .value = {}, .index = *index};
  // [type=right], and as JSONPath has it: [?(@.type == 'right')]
  if (text.starts_with('?')) text = Trimmed(text.substr(1), kBlanks);
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  std::string_view key = Trimmed(text.substr(0, equals), kBlanks);
  if (key.starts_with("@.")) key.remove_prefix(2);
  std::string_view value = Trimmed(text.substr(equals), "= \t");
  if (IsQuoted(value)) value = value.substr(1, value.size() - 2);
  if (key.empty() || value.empty()) return std::nullopt;
  return JsonStep{
      .kind = JsonStep::Kind::kMatch, .key = std::string(key), .value = std::string(value)};
}

/// The bracket that closes the first one, not one in quotes.
std::size_t EndOfBracket(std::string_view text) {
  char quote = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (quote != 0)
      quote = text[i] == quote ? '\0' : quote;
    else if (text[i] == '\'' || text[i] == '"')
      quote = text[i];
    else if (text[i] == ']')
      return i;
  }
  return std::string_view::npos;
}

std::string TextOf(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool Matches(const Json& value, const JsonStep& step, JsonMiss& miss) {
  if (!value.is_object()) return false;
  const auto member = value.find(step.key);
  if (member == value.end()) return false;
  const std::string text = TextOf(*member);
  if (text != step.value && miss.names.size() < kMostNames &&
      std::ranges::count(miss.names, text) == 0)
    miss.names.push_back(text);
  return text == step.value;
}

/// Of a member of `value`, or null.
const Json* Follow(const Json& value, const JsonStep& step, JsonMiss& miss) {
  miss.names.clear();
  miss.name = step.kind == JsonStep::Kind::kMatch ? step.value : step.key;
  if (step.kind == JsonStep::Kind::kKey) {
    if (!value.is_object()) return nullptr;
    const auto found = value.find(step.key);
    if (found != value.end()) return &*found;
    for (const auto& [key, member] : value.items())
      if (miss.names.size() < kMostNames) miss.names.push_back(key);
  } else if (step.kind == JsonStep::Kind::kIndex) {
    miss.name = std::to_string(step.index);
    if (value.is_array() && step.index < value.size()) return &value[step.index];
  } else if (step.kind == JsonStep::Kind::kMatch) {
    if (Matches(value, step, miss)) return &value;
    if (value.is_array())
      for (const Json& one : value)
        if (Matches(one, step, miss)) return &one;
  }
  return nullptr;
}

/// "(0.1, -2, 3)"
bool NumbersOfText(const std::string& text, std::vector<double>& numbers) {
  std::string_view left = Trimmed(text, "()[] \t");
  while (!left.empty()) {
    const std::size_t end = std::min(left.find_first_of(", \t"), left.size());
    const auto number = NumberOf(left.substr(0, end), false);
    if (!number) return false;
    numbers.push_back(*number);
    left.remove_prefix(std::min(left.find_first_not_of(", \t", end), left.size()));
  }
  return !text.empty();
}

bool NumbersOfObject(const Json& value, std::vector<double>& numbers, bool& by_name) {
  std::map<std::string, const Json*> members;
  bool is_matrix = value.size() == 9 || value.size() == 16;
  for (const auto& [key, member] : value.items()) {
    std::string name = LowerCase(key);
    is_matrix = is_matrix && name.size() == 3 &&
                std::isdigit(static_cast<unsigned char>(name[1])) &&
                std::isdigit(static_cast<unsigned char>(name[2]));
    members.emplace(std::move(name), &member);
  }
  std::vector<std::string> wanted;
  if (is_matrix)
    for (const auto& [name, member] : members) wanted.push_back(name);
  else
    wanted = members.contains("w") ? std::vector<std::string>{"x", "y", "z", "w"}
                                   : std::vector<std::string>{"x", "y", "z"};
  by_name = wanted.size() == 4;
  for (const std::string& name : wanted) {
    const auto member = members.find(name);
    if (member == members.end() || !(member->second->is_number() || member->second->is_null()))
      return false;
    bool ignored = false;
    NumbersOfJson(*member->second, numbers, ignored);
  }
  return true;
}

}  // namespace

std::string FoundBody::Keys() const {
  const auto quoted = [](const std::string& path) { return Json(path).dump(); };
  if (position.empty()) return "pose: " + quoted(pose);
  return "position: " + quoted(position) +
         (rotation.empty() ? "" : ", rotation: " + quoted(rotation));
}

void FoundPoses::Add(const std::string& owner, const std::string& name, const std::string& path,
                     std::size_t width, bool has_order) {
  std::string stem = name;
  const Says says = PartOfName(stem);
  const bool place = width == 3 && (says == Says::kPlace || says == Says::kNothing),
             turn = width == 4 || (says == Says::kTurn && width == 9),
             pose = width == 16 || width == 7;
  if (says == Says::kOther || !(place || turn || pose)) {
    if (width == 3 || width == 4 || width == 9) aside.push_back(path);
    return;
  }
  const std::string called = Joined(owner, stem);
  auto body = std::ranges::find(bodies, called, &FoundBody::called);
  if (body == bodies.end()) body = bodies.insert(bodies.end(), FoundBody{.called = called});
  std::string& of = place ? body->position : turn ? body->rotation : body->pose;
  if (of.empty()) of = path;
  if (width == 4 || width == 7) body->has_order = has_order;
}

void FoundPoses::AddTime(const std::map<std::string, std::vector<std::string>>& values) {
  std::vector<std::string> names;
  for (const auto& [name, cells] : values) names.push_back(name);
  const NamedTime time = TimeAmong(
      names, [&](const std::string& name) { return values.at(name); }, false);
  needs_rate = time.name.empty() || time.unit == "frame";
  if (!needs_rate)
    keys += fmt::format("t: {}\n{:<24}{}\n", Json(time.name).dump(), "time_unit: " + time.unit,
                        time.doubt.empty() ? "" : "# " + time.doubt);
}

bool IsJsonLines(const std::string& path, std::string_view text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const bool goes_on = text.find_first_not_of(" \t\n", end) != std::string_view::npos;
  return (goes_on || (EndingOf(path) != ".json" && text.starts_with('{'))) &&
         Json::accept(text.substr(0, end));
}

Result<FoundPoses> FindJsonPoses(const std::string& path) {
  PREHEND_TRY(std::string text, ReadTextFile(path, kMostProposedBytes));
  std::vector<Json> roots;
  const bool is_lines = IsJsonLines(path, text);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = is_lines ? std::min(text.find('\n', begin), text.size()) : text.size();
    Json root = Json::parse(std::string_view(text).substr(begin, end - begin), nullptr,
                            /*allow_exceptions=*/false);
    if (!root.is_discarded()) roots.push_back(std::move(root));
    begin = end + 1;
  }
  FoundPoses found;
  JsonFrames all;
  for (const Json& root : roots) {
    if (is_lines)
      all.frames.push_back(&root);
    else
      FindFrames(root, "$", 4, all);
  }
  if (!is_lines && all.path != "$[*]") found.keys = "frames: \"" + all.path + "\"\n";
  std::vector<const Json*> some;
  const std::size_t step = all.frames.size() / kLooks + 1;
  std::map<std::string, std::vector<std::string>> values;
  for (std::size_t i = 0; i < all.frames.size(); ++i) {
    if (i < kLooks || i % step == 0) some.push_back(all.frames[i]);
    if (i >= kLooks || !all.frames[i]->is_object()) continue;
    for (const auto& [key, member] : all.frames[i]->items())
      if (member.is_number() || member.is_string())
        values[key].push_back(member.is_string() ? member.get<std::string>() : member.dump());
  }
  const std::string name_key = NameKeyOf(some, /*all_differ=*/false);
  JsonWalk walk(found);
  for (const Json* frame : some) walk.Frame(*frame, name_key);
  found.AddTime(values);
  return found;
}

std::optional<JsonPath> ParseJsonPath(std::string_view text) {
  JsonPath path;
  const bool whole = text == "$" || text == "@";
  if (text.starts_with('$') || text.starts_with('@')) text.remove_prefix(1);
  bool first = true;
  while (!text.empty()) {
    if (text.starts_with('[')) {
      const std::size_t end = EndOfBracket(text);
      if (end == std::string_view::npos) return std::nullopt;
      auto step = StepInBrackets(text.substr(1, end - 1));
      if (!step) return std::nullopt;
      path.push_back(std::move(*step));
      text.remove_prefix(end + 1);
    } else {
      if (!first && !text.starts_with('.')) return std::nullopt;
      if (text.starts_with('.')) text.remove_prefix(1);
      const std::size_t end = std::min(text.find_first_of(".["), text.size());
      if (end == 0) return std::nullopt;
      if (text.substr(0, end) == "*")
        path.push_back({.kind = JsonStep::Kind::kAll, .key = {}, .value = {}});
      else
        path.push_back({.key = std::string(text.substr(0, end)), .value = {}});
      text.remove_prefix(end);
    }
    first = false;
  }
  if (path.empty() && !whole) return std::nullopt;
  return path;
}

std::vector<std::string> WithoutBraces(const std::string& text) {
  const std::size_t open = text.find('{'), close = text.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {text};
  std::vector<std::string> all;
  for (const std::string& part : SplitAt(text.substr(open + 1, close - open - 1), ','))
    all.push_back(text.substr(0, open) + std::string(Trimmed(part, kBlanks)) +
                  text.substr(close + 1));
  return all;
}

const Json* FindInJson(const Json& root, const JsonPath& path, JsonMiss& miss) {
  const Json* at = &root;
  for (miss.steps = 0; miss.steps < path.size(); ++miss.steps) {
    if (at->is_null()) return nullptr;
    at = Follow(*at, path[miss.steps], miss);
    if (!at) return nullptr;
  }
  return at;
}

bool NumbersOfJson(const Json& value, std::vector<double>& numbers, bool& by_name) {
  if (value.is_number()) {
    numbers.push_back(value.get<double>());
  } else if (value.is_boolean()) {
    numbers.push_back(value.get<bool>() ? 1 : 0);
  } else if (value.is_null()) {
    numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  } else if (value.is_string()) {
    return NumbersOfText(value.get_ref<const std::string&>(), numbers);
  } else if (value.is_array()) {
    for (const Json& one : value)
      if (!NumbersOfJson(one, numbers, by_name)) return false;
  } else {
    return NumbersOfObject(value, numbers, by_name);
  }
  return true;
}

}  // namespace prehend::exchange
