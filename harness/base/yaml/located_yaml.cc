// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/base/yaml/located_yaml_test.cc
//
// Needs: yaml-cpp's event interface (YAML::Parser, YAML::EventHandler). Assumptions about yaml-cpp
// 0.7: marks count bytes from 0; the mark of a node with a tag or anchor is that of the tag or
// anchor; the mark of an absent value is that of the next token; OnSequenceStart and OnMapStart
// come before the parser recurses, so throwing there bounds its stack.
#include "harness/base/yaml/located_yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

#include "harness/base/base/text_file.h"

namespace prehend {
namespace {

using grammar::Diagnostic;
using grammar::DiagnosticAt;
using grammar::Diagnostics;
using grammar::LineOf;
using grammar::Place;
using Kind = YamlNode::Kind;

/// Stops the parser; never leaves this file.
struct Stop {};

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ < 2) return;
    Complain(PlaceOf(mark), "a second document begins here",
             "one file holds one document; remove the '---'");
    throw Stop{};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    YamlNode node = NewNode(Kind::kNull, mark);
    for (const char* spelling : {"~", "null", "Null", "NULL"}) {
      if (text_.compare(Offset(mark), std::char_traits<char>::length(spelling), spelling) == 0)
        node.text = spelling;
    }
    const bool absent = node.text.empty();
    if (absent && !open_.empty() && open_.back().has_key) node.where = open_.back().key_where;
    Attach(std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    Complain(PlaceOf(mark), "aliases ('*name') are not supported", "write the value out");
    Attach(NewNode(Kind::kNull, mark));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    YamlNode node = NewNode(Kind::kScalar, mark);
    node.text = value;
    node.quoted = tag == "!";  // yaml-cpp's way to say so; explicit tags were refused by NewNode()
    if (node.quoted && !IsClosed(Offset(mark))) {
      Complain(node.where.place, "this quote is not closed", "close it with the same quote");
    }
    if (node.quoted) RefuseStrange(node);
    Attach(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Open(NewNode(Kind::kSequence, mark));
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Open(NewNode(Kind::kMapping, mark));
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapEnd() override { Close(); }

  YamlNode root;
  Diagnostics diagnostics;

  void Complain(Place place, std::string message, std::string hint) {
    if (diagnostics.size() >= grammar::kMostDiagnostics) return;
    diagnostics.push_back(DiagnosticAt(file_, text_, place, std::move(message), std::move(hint)));
  }

 private:
  /// A collection that is still being read.
  struct Opened {
    YamlNode node;
    bool has_key = false;  ///< a mapping's key was read, its value comes next
    std::string key;
    Where key_where;
    std::set<std::string> seen;
  };

  static Place PlaceOf(const YAML::Mark& mark) { return {mark.line + 1, mark.column + 1}; }
  std::size_t Offset(const YAML::Mark& mark) const {
    return std::min(static_cast<std::size_t>(std::max(mark.pos, 0)), text_.size());
  }

  /// Whether the quote that opens here is closed. yaml-cpp accepts the end of the file instead.
  bool IsClosed(std::size_t open) const {
    const char quote = open < text_.size() ? text_[open] : '\0';
    if (quote != '"' && quote != '\'') return true;  // a block scalar
    for (std::size_t i = open + 1; i < text_.size(); ++i) {
      const bool escapes = quote == '"' ? text_[i] == '\\' : text_.compare(i, 2, "''") == 0;
      if (escapes) {
        ++i;
      } else if (text_[i] == quote) {
        return true;
      }
    }
    return false;
  }

  /// From escapes like "\x1b": terminals, reports and goldens could not carry it, so nobody sees
  /// it.
  void RefuseStrange(YamlNode& node) {
    const std::string strange = StrangeIn(node.text);
    if (strange.empty()) return;
    Complain(node.where.place, "expected text, found the " + strange,
             "an escape in quotes stands for a character; leave this one out");
    node.text = ReadableName(node.text);
  }

  YamlNode NewNode(Kind kind, const YAML::Mark& mark) {
    const std::size_t offset = Offset(mark);
    const char first = offset < text_.size() ? text_[offset] : '\0';
    if (first == '!') Complain(PlaceOf(mark), "tags ('!name') are not supported", "remove the tag");
    if (first == '&')
      Complain(PlaceOf(mark), "anchors ('&name') are not supported",
               "write the value out where it is used");
    YamlNode node;
    node.kind = kind;
    node.where.place = PlaceOf(mark);
    return node;
  }

  void Open(YamlNode node) {
    if (static_cast<int>(open_.size()) >= kMaxYamlDepth) {
      Complain(node.where.place, fmt::format("nested deeper than {} levels", kMaxYamlDepth), "");
      throw Stop{};
    }
    Label(node);
    open_.push_back({.node = std::move(node), .has_key = false});
  }

  void Close() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    Attach(std::move(node));
  }

  bool ExpectsKey() const {
    return !open_.empty() && open_.back().node.kind == Kind::kMapping && !open_.back().has_key;
  }

  void Label(YamlNode& node) const {
    if (open_.empty()) return;
    const Opened& parent = open_.back();
    const bool in_mapping = parent.node.kind == Kind::kMapping;
    node.key = in_mapping ? parent.key
                          : fmt::format("{}[{}]", parent.node.key, parent.node.children.size());
    node.key_where = in_mapping ? parent.key_where : node.where;
  }

  void Attach(YamlNode node) {
    if (open_.empty()) {
      root = std::move(node);
    } else if (ExpectsKey()) {
      TakeKey(node);
    } else {
      if (node.kind == Kind::kNull || node.kind == Kind::kScalar) Label(node);
      open_.back().node.children.push_back(std::move(node));
      open_.back().has_key = false;
    }
  }

  void TakeKey(const YamlNode& node) {
    Opened& mapping = open_.back();
    if (node.kind == Kind::kSequence || node.kind == Kind::kMapping) {
      Complain(node.where.place, "a key must be a word, not a list or mapping", "");
    } else if (node.text == "<<" && !node.quoted) {
      Complain(node.where.place, "merge keys ('<<') are not supported", "write the keys out");
    } else if (node.kind == Kind::kNull) {
      Complain(node.where.place, "a key is missing here", "");
    } else if (!mapping.seen.insert(node.text).second) {
      Complain(node.where.place, fmt::format("duplicate key '{}'", node.text),
               fmt::format("first given in line {}",
                           mapping.node.Find(node.text)->key_where.place.line));
    }
    mapping.has_key = true;
    mapping.key = node.text;
    mapping.key_where = node.where;
  }

  const std::string& file_;
  const std::string& text_;
  std::vector<Opened> open_;
  int documents_ = 0;
};

/// yaml-cpp treats some tabs as spaces and fails on others, so all are refused.
Diagnostics CheckTabs(const std::string& file, const std::string& text) {
  const auto tab = text.find('\t');
  if (tab == std::string::npos) return {};
  const auto line_start = tab == 0 ? 0 : text.rfind('\n', tab) + 1;
  const int line =
      1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(tab), '\n'));
  return {DiagnosticAt(file, text, {line, static_cast<int>(tab - line_start) + 1}, "tab character",
                       "indent and separate with spaces")};
}

/// "#ff0000" of the last line up to this one that has a colour where a value begins; or "".
std::string ColourAsComment(std::string_view text, int up_to_line) {
  constexpr int kMostLines = 50;
  for (int number = up_to_line; number > std::max(0, up_to_line - kMostLines); --number) {
    const std::string_view line = LineOf(text, number);
    const std::size_t at = line.find(": #");
    if (at == std::string_view::npos) continue;
    const std::size_t begin = at + 3;
    const std::size_t end =
        std::min(line.find_first_not_of("0123456789abcdefABCDEF", begin), line.size());
    if (end - begin == 3 || end - begin == 6) return std::string(line.substr(at + 2, end - at - 2));
  }
  return "";
}

/// Rewords yaml-cpp's message of a syntax error as message and hint.
std::pair<std::string, std::string> InPlainWords(const std::string& message, std::string_view text,
                                                 Place place) {
  struct Words {
    const char *said, *message, *hint;
  };
  const std::string_view line = LineOf(text, place.line);
  const std::size_t column =
      std::min(line.size(), static_cast<std::size_t>(std::max(1, place.column)) - 1);
  const std::string_view before = line.substr(0, column);
  if (line.substr(column).starts_with(':') && before.find(": ") != std::string_view::npos) {
    return {"not valid YAML: a second ':' in one value",
            "text with ': ' in it goes in quotes, like \"first: second\""};
  }
  const std::size_t braces = line.find("{}");
  if (braces != std::string_view::npos && braces + 2 < line.size() &&
      std::string_view(" ,]}").find(line[braces + 2]) == std::string_view::npos) {
    return {"not valid YAML: text cannot begin with '{}', which is an empty mapping",
            "text with '{}' in it goes in quotes, like \"{}_x\""};
  }
  if (message == "end of map not found" &&
      before.find_first_not_of(' ') != std::string_view::npos) {
    return {"not valid YAML: unexpected text after the value before it",
            "put the whole value in quotes"};
  }
  constexpr const char* kBrackets = "each '[' needs its ']', each '{' its '}'";
  constexpr const char* kIndent = "siblings begin in the same column";
  constexpr Words kWords[] = {
      {"illegal flow end", "this bracket does not match the open one", kBrackets},
      {"end of sequence flow not found", "a '[' before this is not closed", kBrackets},
      {"end of map flow not found", "a '{' before this is not closed", kBrackets},
      {"end of map not found", "this line's indentation does not match its siblings", kIndent},
      {"end of sequence not found", "this line's indentation does not match its siblings", kIndent},
      {"illegal map value", "no ':' is expected here",
       "a key begins a line or is inside '{}'; text with ': ' goes in quotes"},
      {"alias not found after *", "text cannot begin with '*'",
       "text with special characters goes in quotes"},
      {"anchor not found after &", "text cannot begin with '&'",
       "text with special characters goes in quotes"},
      {"the referenced anchor is not defined", "aliases ('*name') are not supported",
       "write the value out; text that begins with '*' goes in quotes"},
      {"unknown token", "a value cannot begin with this character",
       "text with special characters goes in quotes"},
  };
  const bool is_open =
      message == "end of map flow not found" || message == "end of sequence flow not found";
  if (const auto colour = ColourAsComment(text, place.line); is_open && !colour.empty())
    return {"not valid YAML: '#' begins a comment, which hides the rest of the line",
            fmt::format("a colour goes in quotes: \"{}\"", colour)};
  for (const Words& words : kWords) {
    if (message == words.said) return {std::string("not valid YAML: ") + words.message, words.hint};
  }
  return {"not valid YAML: " + message, ""};
}

/// What looks like a blank, and is none: where one is in the lines up to a syntax error, it is the
/// cause.
std::optional<Place> WrongBlank(std::string_view text, int up_to_line) {
  for (int number = std::max(1, up_to_line - 1); number <= up_to_line; ++number) {
    const std::string_view line = LineOf(text, number);
    for (const char* blank : {"\u00A0", "\u3000", "\u200B", "\uFEFF", "\u2007", "\u202F"}) {
      const std::size_t at = line.find(blank);
      if (at != std::string_view::npos) return Place{number, static_cast<int>(at) + 1};
    }
  }
  return std::nullopt;
}

/// A line that should begin a value, but has no ':'; the next one is where YAML stumbles.
std::optional<Place> KeyWithoutColon(std::string_view text, int line_number) {
  const std::string_view line = LineOf(text, line_number - 1), next = LineOf(text, line_number);
  const std::size_t begin = line.find_first_not_of(' ');
  if (line_number < 2 || begin == std::string_view::npos || begin != next.find_first_not_of(' '))
    return std::nullopt;
  const bool has_colon = line.find(": ") != std::string_view::npos || line.ends_with(':');
  if (has_colon || line[begin] == '#' || line[begin] == '-') return std::nullopt;
  return Place{line_number - 1, static_cast<int>(begin) + 1};
}

/// The first line with anything in it, if it is that of a grammar.
std::optional<Place> GrammarLine(std::string_view text) {
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin != std::string_view::npos && line[begin] != '#') {
      const bool is_grammar = line.starts_with("grammar ") && line.find(':') == line.npos;
      return is_grammar ? std::optional(Place{number, 1}) : std::nullopt;
    }
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return std::nullopt;
}

/// Of a syntax error: where it is to be mended, and how.
void Explain(TreeBuilder& builder, const std::string& message, std::string_view text, Place place) {
  if (const auto blank = WrongBlank(text, place.line))
    return builder.Complain(*blank,
                            "not valid YAML: a character that looks like a blank, but is none",
                            "separate with plain spaces");
  const auto key = KeyWithoutColon(text, place.line);
  if (key && message == "illegal map value")
    return builder.Complain(*key, "not valid YAML: a line without ':'", "write 'KEY: VALUE'");
  const auto [plain, hint] = InPlainWords(message, text, place);
  builder.Complain(place, plain, hint);
}

}  // namespace

const YamlNode* YamlNode::Find(std::string_view name) const {
  if (kind != Kind::kMapping) return nullptr;
  for (const YamlNode& child : children) {
    if (child.key == name) return &child;
  }
  return nullptr;
}

Result<YamlDocument> ParseYaml(const std::string& file, std::string text) {
  if (auto bad = CheckText(file, text); !bad.empty()) return tl::unexpected(std::move(bad));
  if (auto bad = CheckTabs(file, text); !bad.empty()) return tl::unexpected(std::move(bad));
  if (const auto place = GrammarLine(text))
    return tl::unexpected(
        Diagnostics{DiagnosticAt(file, text, *place, "expected YAML, found a grammar",
                                 "the name of a grammar's file ends in .grammar")});
  TreeBuilder builder(file, text);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    bool any = false;
    while (parser.HandleNextDocument(builder)) any = true;
    if (!any) builder.Complain({}, "the file contains only comments", "");
  } catch (const Stop&) {
    // The builder has reported why.
  } catch (const YAML::Exception& error) {
    builder.diagnostics.clear();  // they may be consequences
    const Place place =
        error.mark.is_null() ? Place{} : Place{error.mark.line + 1, error.mark.column + 1};
    Explain(builder, error.msg, text, place);
  }
  if (!builder.diagnostics.empty()) return tl::unexpected(std::move(builder.diagnostics));
  return YamlDocument{{{file, std::move(text)}}, std::move(builder.root)};
}

Result<YamlDocument> ReadYamlFile(const std::string& path) {
  PREHEND_TRY(auto text, ReadTextFile(path));
  return ParseYaml(path, std::move(text));
}

}  // namespace prehend
