// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/value_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <regex.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>

#include "harness/base/yaml/yaml_scalar.h"

namespace prehend {
namespace {

std::string LabelOf(const YamlNode& node) { return node.key.empty() ? "" : node.key + ": "; }

/// POSIX, since std::regex recurses once per character, and since pattern and text are short. Null
/// for no pattern.
std::shared_ptr<const regex_t> Compiled(const std::string& pattern) {
  auto compiled = std::make_unique<regex_t>();
  if (regcomp(compiled.get(), pattern.c_str(), REG_EXTENDED | REG_NOSUB) != 0) return nullptr;
  return {compiled.release(), [](regex_t* unused) {
            regfree(unused);
            delete unused;
          }};
}

/// Characters below a blank can only come from escapes in quotes; a NUL would hide the rest of the
/// text.
bool Matches(const regex_t* pattern, const std::string& text) {
  return pattern && text.find('\0') == std::string::npos &&
         regexec(pattern, text.c_str(), 0, nullptr, 0) == 0;
}

/// The node's text if it is unmistakably a string; nothing after an error.
std::optional<std::string> StringOf(const YamlNode& node, DiagnosticList& errors,
                                    const std::string& wanted) {
  if (node.kind == YamlNode::Kind::kScalar) {
    ScalarMeaning meaning = MeaningOf(node);
    if (meaning.string) return std::move(meaning.string);
    if (meaning.number || meaning.flag) {
      errors.Add(node.where,
                 fmt::format("{}expected {}, found the {} {}", LabelOf(node), wanted,
                             meaning.number ? "number" : "flag", node.text),
                 fmt::format("put it in quotes if text is meant: '{}'", node.text));
      return std::nullopt;
    }
  }
  ReportExpected(node, errors, wanted);
  return std::nullopt;
}

std::optional<ScalarMeaning> NumericMeaning(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kScalar) return std::nullopt;
  ScalarMeaning meaning = MeaningOf(node);
  if (!meaning.number) return std::nullopt;
  return meaning;
}

/// The hint for a text where a number is expected: "0.3kg", "0,3".
std::string NumberRemedy(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kScalar || node.quoted) return "";
  const std::string& text = node.text;
  const std::size_t end = std::min(text.find_first_not_of("+-.0123456789eE"), text.size());
  double ignored = 0;
  const bool begins_with_number =
      end < text.size() &&
      std::from_chars(text.data(), text.data() + end, ignored).ec == std::errc();
  if (!begins_with_number) return "";
  return text[end] == ',' ? "decimals have a point: 0.5"
                          : "write the number alone; its unit is the last word of the key";
}

bool ReportExpectedNumber(const YamlNode& node, DiagnosticList& errors, const std::string& wanted) {
  const std::string remedy = NumberRemedy(node);
  if (remedy.empty() || !MeaningOf(node).string) return ReportExpected(node, errors, wanted);
  errors.Add(node.where,
             fmt::format("{}expected {}, found {}", LabelOf(node), wanted, Describe(node)), remedy);
  return false;
}

bool HasSize(const YamlNode& node, DiagnosticList& errors, std::size_t least, std::size_t most) {
  const std::size_t size = node.children.size();
  if (size >= least && size <= most) return true;
  const auto of = [&](std::size_t count) {
    const char* noun = node.kind == YamlNode::Kind::kMapping ? "key" : "item";
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
  };
  const std::string wanted = least == most  ? of(least)
                             : size < least ? "at least " + of(least)
                                            : "at most " + of(most);
  errors.Add(node.where, fmt::format("{}expected {}, found {}", LabelOf(node), wanted, size));
  return false;
}

Json ShowString(const void* value) { return Json(*static_cast<const std::string*>(value)); }
std::string& StringAt(void* value) { return *static_cast<std::string*>(value); }

/// Reports a node that is no list, or has a wrong number of items. The same for mappings.
bool IsListOf(const YamlNode& node, DiagnosticList& errors, std::size_t least, std::size_t most) {
  if (node.kind == YamlNode::Kind::kSequence) return HasSize(node, errors, least, most);
  const std::string wanted = least == most ? fmt::format("a list of {}", least) : "a list";
  if (node.kind != YamlNode::Kind::kMapping) return ReportExpected(node, errors, wanted);
  errors.Add(node.where, fmt::format("{}expected {}, found a mapping", LabelOf(node), wanted),
             "begin each item with '- ' on a line of its own, or put all in [..]");
  return false;
}

bool IsMappingOf(const YamlNode& node, DiagnosticList& errors, std::size_t least,
                 std::size_t most) {
  if (node.kind == YamlNode::Kind::kMapping) return HasSize(node, errors, least, most);
  if (node.kind != YamlNode::Kind::kSequence)
    return ReportExpected(node, errors, "a mapping from names");
  errors.Add(node.where,
             fmt::format("{}expected a mapping from names, found a list", LabelOf(node)),
             "write lines 'NAME: ..' without a leading '- '");
  return false;
}

/// The text in small letters with '_' for what separates, or with a capital at its begin, if that
/// matches; else "".
std::string WithOtherLetters(const regex_t* matcher, std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    if (letter == '-' || letter == ' ') letter = '_';
  }
  if (text.empty() || Matches(matcher, text)) return text;
  if (text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return Matches(matcher, text) ? text : "";
}

/// `count` numbers in a row, from `value` on.
ErasedFormat ErasedVector(std::size_t count, double lowest, double highest) {
  const ValueFormat<double> number = Number(lowest, highest);
  return {.schema = [=]() -> Json {
            return {{"type", "array"},
                    {"items", number.schema().json()},
                    {"minItems", count},
                    {"maxItems", count}};
          },
          .read =
              [=](const YamlNode& node, DiagnosticList& errors, void* value) {
                if (!IsListOf(node, errors, count, count)) return false;
                std::array<double, 4> numbers{};
                bool good = true;
                for (std::size_t i = 0; i < count; ++i)
                  good &= number.Read(node.children[i], errors, numbers[i]);
                if (good) std::copy_n(numbers.data(), count, static_cast<double*>(value));
                return good;
              },
          .show =
              [count](const void* value) {
                const auto* numbers = static_cast<const double*>(value);
                return Json(std::vector<double>(numbers, numbers + count));
              }};
}

}  // namespace

const Json& Schema::json() const {
  if (!state_->made) state_->made = state_->make();
  return *state_->made;
}

Schema AnyOf(std::vector<Schema> schemas) {
  return [schemas = std::move(schemas)] {
    Json any_of = Json::array();
    for (const Schema& schema : schemas) any_of.push_back(schema.json());
    return Json{{"anyOf", std::move(any_of)}};
  };
}

FormatHolder::FormatHolder(ErasedFormat erased) : erased_(std::move(erased)) {}
FormatHolder::FormatHolder(const FormatHolder& other) = default;
FormatHolder::FormatHolder(FormatHolder&& other) noexcept = default;
FormatHolder::~FormatHolder() = default;

bool ReportExpected(const YamlNode& node, DiagnosticList& errors, const std::string& wanted) {
  std::string message =
      fmt::format("{}expected {}, found {}", LabelOf(node), wanted, Describe(node));
  std::string hint;
  if (node.kind == YamlNode::Kind::kScalar) {
    const ScalarMeaning meaning = MeaningOf(node);
    if (!meaning.ambiguous.empty()) message += fmt::format(" ({})", meaning.ambiguous);
    hint = meaning.remedy.empty() ? LookAlikeRemedy(node.text) : meaning.remedy;
  }
  errors.Add(node.where, std::move(message), std::move(hint));
  return false;
}

ValueFormat<double> Number(double lowest, double highest) {
  const std::string wanted = fmt::format("a number from {} to {}", lowest, highest);
  return ValueFormat<double>(
      {.schema = [=]() -> Json {
         return {{"type", "number"}, {"minimum", lowest}, {"maximum", highest}};
       },
       .read =
           [=](const YamlNode& node, DiagnosticList& errors, void* value) {
             const auto meaning = NumericMeaning(node);
             if (!meaning || !(*meaning->number >= lowest && *meaning->number <= highest))
               return ReportExpectedNumber(node, errors, wanted);
             *static_cast<double*>(value) = *meaning->number;
             return true;
           },
       .show = [](const void* value) { return Json(*static_cast<const double*>(value)); }});
}

ErasedFormat ErasedInteger(std::int64_t lowest, std::int64_t highest, const IntegerAccess& access) {
  const std::string wanted = lowest == highest
                                 ? fmt::format("{}", lowest)
                                 : fmt::format("a whole number from {} to {}", lowest, highest);
  return {.schema = [=]() -> Json {
            return {{"type", "integer"}, {"minimum", lowest}, {"maximum", highest}};
          },
          .read =
              [=](const YamlNode& node, DiagnosticList& errors, void* value) {
                const auto meaning = NumericMeaning(node);
                constexpr double kExactInDouble = 9007199254740992.0;  // 2^53
                if (!meaning || !meaning->integer || std::abs(*meaning->number) > kExactInDouble)
                  return ReportExpectedNumber(node, errors, wanted);
                const auto whole = static_cast<std::int64_t>(*meaning->number);
                if (whole < lowest || whole > highest) return ReportExpected(node, errors, wanted);
                access.set(whole, value);
                return true;
              },
          .show = [access](const void* value) { return Json(access.get(value)); }};
}

ValueFormat<bool> Flag() {
  return ValueFormat<bool>(
      {.schema = []() -> Json {
         return {{"type", "boolean"}};
       },
       .read =
           [](const YamlNode& node, DiagnosticList& errors, void* value) {
             if (node.kind != YamlNode::Kind::kScalar || !MeaningOf(node).flag)
               return ReportExpected(node, errors, "true or false");
             *static_cast<bool*>(value) = *MeaningOf(node).flag;
             return true;
           },
       .show = [](const void* value) { return Json(*static_cast<const bool*>(value)); }});
}

ValueFormat<std::string> Text(std::size_t max_length) {
  const std::string wanted = fmt::format("text of 1 to {} bytes", max_length);
  return ValueFormat<std::string>(
      {.schema = [=]() -> Json {
         return {{"type", "string"}, {"minLength", 1}, {"maxLength", max_length}};
       },
       .read =
           [=](const YamlNode& node, DiagnosticList& errors, void* value) {
             auto text = StringOf(node, errors, wanted);
             if (!text) return false;
             if (text->empty() || text->size() > max_length)
               return ReportExpected(node, errors, wanted);
             StringAt(value) = std::move(*text);
             return true;
           },
       .show = ShowString});
}

ValueFormat<std::string> Word(const std::string& pattern, const std::string& wanted,
                              std::size_t max_length) {
  const std::string whole = "^(" + pattern + ")$";
  const bool is_name = pattern.starts_with("[a-z]") || pattern.starts_with("[A-Z]");
  return ValueFormat<std::string>(
      {.schema = [=]() -> Json {
         return {{"type", "string"}, {"pattern", whole}, {"maxLength", max_length}};
       },
       .read =
           [=, matcher = Compiled(whole)](const YamlNode& node, DiagnosticList& errors,
                                          void* value) {
             auto text = StringOf(node, errors, wanted);
             if (!text) return false;
             if (text->size() > max_length) {
               return ReportExpected(node, errors,
                                     fmt::format("{} of at most {} bytes", wanted, max_length));
             }
             if (!Matches(matcher.get(), *text)) {
               const std::string fitting =
                   is_name ? WithOtherLetters(matcher.get(), *text) : std::string();
               if (fitting.empty()) return ReportExpected(node, errors, wanted);
               errors.Add(
                   node.where,
                   fmt::format("{}expected {}, found {}", LabelOf(node), wanted, Describe(node)),
                   fmt::format("write '{}': {}", fitting,
                               fitting.front() >= 'a' ? "small letters, digits and '_'"
                                                      : "it begins with a capital letter"));
               return false;
             }
             StringAt(value) = std::move(*text);
             return true;
           },
       .show = ShowString});
}

void CheckLeastMost(const std::string& key, const Eigen::Vector2d& range, Where where,
                    DiagnosticList& errors) {
  if (range[0] < range[1]) return;
  errors.Add(where,
             fmt::format("{}: expected [min, max], found [{}, {}]", key, range[0], range[1]));
}

template <>
ValueFormat<Eigen::Vector2d> Vector<2>(double lowest, double highest) {
  return ValueFormat<Eigen::Vector2d>(ErasedVector(2, lowest, highest));
}
template <>
ValueFormat<Eigen::Vector3d> Vector<3>(double lowest, double highest) {
  return ValueFormat<Eigen::Vector3d>(ErasedVector(3, lowest, highest));
}
template <>
ValueFormat<Eigen::Vector4d> Vector<4>(double lowest, double highest) {
  return ValueFormat<Eigen::Vector4d>(ErasedVector(4, lowest, highest));
}

ValueFormat<Eigen::Vector4d> UnitQuaternion() {
  const auto vector = Vector<4>(-1.01, 1.01);
  return ValueFormat<Eigen::Vector4d>(
             vector.schema(),
             [vector](const YamlNode& node, DiagnosticList& errors, Eigen::Vector4d& value) {
               constexpr double kTolerance = 0.01;  // two written digits
               if (!vector.Read(node, errors, value)) return false;
               if (std::abs(value.norm() - 1) <= kTolerance) return true;
               errors.Add(node.where,
                          fmt::format("{}expected a unit quaternion [w, x, y, z], found one "
                                      "of length {:.4g}",
                                      LabelOf(node), value.norm()));
               return false;
             })
      .ShownAs(vector);
}

ValueFormat<std::string> Identifier() {
  return Word("[a-z][a-z0-9_]*", "a name like 'milk_carton'");
}

ValueFormat<std::string> Choice(std::vector<std::string> words) {
  const std::string wanted = words.size() == 1 ? fmt::format("'{}'", words[0])
                                               : fmt::format("one of {}", fmt::join(words, ", "));
  return ValueFormat<std::string>(
      {.schema = [words]() -> Json {
         return {{"type", "string"}, {"enum", words}};
       },
       .read =
           [wanted, words = std::move(words)](const YamlNode& node, DiagnosticList& errors,
                                              void* value) {
             auto text = StringOf(node, errors, wanted);
             if (!text) return false;
             if (std::find(words.begin(), words.end(), *text) == words.end()) {
               errors.Add(
                   node.where,
                   fmt::format("{}expected {}, found {}", LabelOf(node), wanted, Describe(node)),
                   grammar::DidYouMean(*text, words));
               return false;
             }
             StringAt(value) = std::move(*text);
             return true;
           },
       .show = ShowString});
}

ErasedFormat ErasedChoice(std::vector<std::string> words, std::vector<std::int64_t> meanings,
                          const IntegerAccess& access) {
  const ValueFormat<std::string> word = Choice(words);
  return {.schema = word.schema(),
          .read =
              [=](const YamlNode& node, DiagnosticList& errors, void* value) {
                std::string chosen;
                if (!word.Read(node, errors, chosen)) return false;
                const auto found = std::ranges::find(words, chosen) - words.begin();
                access.set(meanings[static_cast<std::size_t>(found)], value);
                return true;
              },
          .show =
              [=](const void* value) {
                const auto found = std::ranges::find(meanings, access.get(value));
                if (found == meanings.end()) return Json();
                return Json(words[static_cast<std::size_t>(found - meanings.begin())]);
              }};
}

ErasedFormat ErasedList(const ErasedFormat& item, std::size_t least, std::size_t most,
                        const ListAccess& access) {
  return {
      .schema = [=, items = item.schema]() -> Json {
        return {
            {"type", "array"}, {"items", items.json()}, {"minItems", least}, {"maxItems", most}};
      },
      .read =
          [=, read = item.read](const YamlNode& node, DiagnosticList& errors, void* list) {
            access.clear(list);
            if (!IsListOf(node, errors, least, most)) return false;
            bool good = true;
            for (const YamlNode& child : node.children)
              good &= read(child, errors, access.append(list));
            return good;
          },
      .show =
          [access, show = item.show](const void* list) {
            Json shown = Json::array();
            for (std::size_t i = 0; i < access.size(list); ++i)
              shown.push_back(show ? show(access.at(list, i)) : Json());
            return shown;
          }};
}

ErasedFormat ErasedMap(const ValueFormat<std::string>& name, const ErasedFormat& item,
                       std::size_t least, std::size_t most, const MapAccess& access) {
  return {.schema = [=, names = name.schema(), items = item.schema]() -> Json {
            return {{"type", "object"},
                    {"propertyNames", names.json()},
                    {"additionalProperties", items.json()},
                    {"minProperties", least},
                    {"maxProperties", most}};
          },
          .read =
              [=, read_name = name.erased().read, read = item.read](
                  const YamlNode& node, DiagnosticList& errors, void* map) {
                access.clear(map);
                bool good = IsMappingOf(node, errors, least, most);
                if (node.kind != YamlNode::Kind::kMapping) return good;
                for (const YamlNode& child : node.children) {
                  YamlNode key;
                  key.kind = YamlNode::Kind::kScalar;
                  key.text = child.key;
                  key.where = child.key_where;
                  std::string read_key = child.key;
                  good &= read_name(key, errors, &read_key);
                  good &= read(child, errors, access.append(map, read_key, child.key_where));
                }
                return good;
              }};
}

}  // namespace prehend
