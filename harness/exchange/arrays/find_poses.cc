// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/json_path.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/cells/column_names.h"

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
                                    "))(?:_(?:m|cm|mm|xyzw|wxyz))?$",
                                std::regex::icase);
  static const std::regex kLetter("^(?:(.*)[_. :/-])?(?:(p|t)|(q|r))_?$", std::regex::icase);
  static const std::regex kOther(
      "^.*(veloc|accel|normal|direction|extent|colou?r|gravity|force|torque|euler|angle|angular).*$"
      "|"
      "^(.*[_. -])?(vel|acc|dir|size|dim|dimensions|up|forward|offset|scale)$",
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

Result<FoundPoses> FindJsonPoses(const std::string& path) {
  PREHEND_TRY(std::string text, ReadTextFile(path, kMostProposedBytes));
  std::vector<Json> roots;
  const std::size_t first_end = std::min(text.find('\n'), text.size());
  const bool is_lines = text.find_first_not_of(" \t\r\n", first_end) != std::string::npos &&
                        Json::accept(text.substr(0, first_end));
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

}  // namespace prehend::exchange
