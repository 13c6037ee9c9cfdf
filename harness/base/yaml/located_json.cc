// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/base/yaml/located_json_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "harness/base/base/text_file.h"
#include "harness/base/yaml/located_yaml.h"

namespace prehend {
namespace {

using grammar::DiagnosticAt;
using grammar::Diagnostics;
using grammar::Place;
using Kind = YamlNode::Kind;

/// Builds the tree from the parser's callbacks. They come in the order of the text but without
/// places, so a cursor follows them: each token begins where the one before ended, after white
/// space, commas and colons.
class JsonTree : public nlohmann::json_sax<nlohmann::json> {
 public:
  JsonTree(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  YamlNode root;
  Diagnostics diagnostics;

  bool null() override { return TakeWord("null", Kind::kNull); }
  bool boolean(bool value) override { return TakeWord(value ? "true" : "false", Kind::kScalar); }
  bool number_integer(number_integer_t) override { return TakeNumber(); }
  bool number_unsigned(number_unsigned_t) override { return TakeNumber(); }
  bool number_float(number_float_t, const string_t&) override { return TakeNumber(); }
  bool string(string_t& value) override {
    YamlNode node = NewNode(Kind::kScalar);
    SkipString();
    node.text = std::move(value);
    node.quoted = true;
    if (!IsText(node)) return false;
    return Attach(std::move(node));
  }
  bool binary(binary_t&) override { return false; }  // not in text

  bool start_object(std::size_t) override { return Open(Kind::kMapping); }
  bool start_array(std::size_t) override { return Open(Kind::kSequence); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }
  bool key(string_t& name) override {
    YamlNode node = NewNode(Kind::kScalar);
    SkipString();
    node.text = std::move(name);
    if (!IsText(node)) return false;
    Opened& mapping = open_.back();
    if (!mapping.seen.insert(node.text).second) {
      const Place first = mapping.node.Find(node.text)->key_where.place;
      return Complain(node.where.place, fmt::format("duplicate key '{}'", node.text),
                      fmt::format("first given in column {}", first.column));
    }
    mapping.key = std::move(node.text);
    mapping.key_where = node.where;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::json::exception& error) override {
    if (dynamic_cast<const nlohmann::json::out_of_range*>(&error) != nullptr) {
      SkipSeparators();
      return Complain(PlaceOf(cursor_), "this number is too large", "");
    }
    const bool cut = byte > text_.size();
    if (cut && text_.find_first_not_of(" \t\r\n") != std::string::npos) {
      return Complain(PlaceOf(text_.empty() ? 0 : text_.size() - 1), "the line ends within a value",
                      "if it is the last line, the file was cut off");
    }
    // `byte` is behind the token that is wrong, or in it.
    SkipSeparators();
    return Complain(PlaceOf(std::min(cursor_, std::max<std::size_t>(byte, 1) - 1)),
                    "not valid JSON: unexpected text here", "each line is one JSON object");
  }

 private:
  /// A collection that is still being read.
  struct Opened {
    YamlNode node;
    std::string key;  ///< of the value that comes next, in a mapping
    Where key_where;
    std::set<std::string> seen;
  };

  bool Complain(Place place, std::string message, std::string hint) {
    diagnostics.push_back(DiagnosticAt(file_, text_, place, std::move(message), std::move(hint)));
    return false;  // the parser stops
  }

  Place PlaceOf(std::size_t at) {
    for (; counted_ < at && counted_ < text_.size(); ++counted_) {
      if (text_[counted_] != '\n') continue;
      ++line_;
      line_start_ = counted_ + 1;
    }
    return {line_, static_cast<int>(at - line_start_) + 1};
  }

  void SkipSeparators() {
    cursor_ = std::min(text_.find_first_not_of(" \t\r\n,:", cursor_), text_.size());
  }

  YamlNode NewNode(Kind kind) {
    SkipSeparators();
    YamlNode node;
    node.kind = kind;
    node.where.place = PlaceOf(cursor_);
    return node;
  }

  /// The cursor is at a quote.
  void SkipString() {
    for (++cursor_; cursor_ < text_.size() && text_[cursor_] != '"'; ++cursor_)
      cursor_ += text_[cursor_] == '\\';
    ++cursor_;
  }

  bool TakeWord(std::string_view word, Kind kind) {
    YamlNode node = NewNode(kind);
    node.text = word;
    cursor_ += word.size();
    return Attach(std::move(node));
  }

  bool TakeNumber() {
    YamlNode node = NewNode(Kind::kScalar);
    const std::size_t end =
        std::min(text_.find_first_not_of("+-.0123456789eE", cursor_), text_.size());
    node.text = text_.substr(cursor_, end - cursor_);
    cursor_ = end;
    return Attach(std::move(node));
  }

  /// Escapes like "\u001b" stand for what terminals, reports and goldens cannot carry.
  bool IsText(const YamlNode& node) {
    const std::string strange = StrangeIn(node.text);
    if (strange.empty()) return true;
    return Complain(node.where.place, "expected text, found the " + strange,
                    "an escape in quotes stands for a character; leave this one out");
  }

  bool Open(Kind kind) {
    YamlNode node = NewNode(kind);
    ++cursor_;
    if (static_cast<int>(open_.size()) >= kMaxYamlDepth) {
      return Complain(node.where.place, fmt::format("nested deeper than {} levels", kMaxYamlDepth),
                      "");
    }
    Label(node);
    open_.push_back({.node = std::move(node)});
    return true;
  }

  bool Close() {
    SkipSeparators();
    ++cursor_;
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    return Store(std::move(node));
  }

  bool Attach(YamlNode node) {
    Label(node);
    return Store(std::move(node));
  }

  bool Store(YamlNode node) {
    (open_.empty() ? root : open_.back().node.children.emplace_back()) = std::move(node);
    return true;
  }

  void Label(YamlNode& node) const {
    if (open_.empty()) return;
    const Opened& parent = open_.back();
    const bool in_mapping = parent.node.kind == Kind::kMapping;
    node.key = in_mapping ? parent.key
                          : fmt::format("{}[{}]", parent.node.key, parent.node.children.size());
    node.key_where = in_mapping ? parent.key_where : node.where;
  }

  const std::string& file_;
  const std::string& text_;
  std::vector<Opened> open_;
  std::size_t cursor_ = 0;                    ///< behind the last token
  std::size_t counted_ = 0, line_start_ = 0;  ///< of PlaceOf()
  int line_ = 1;
};

}  // namespace

Result<YamlDocument> ParseJson(const std::string& file, std::string text) {
  if (auto bad = CheckText(file, text); !bad.empty()) return tl::unexpected(std::move(bad));
  JsonTree tree(file, text);
  nlohmann::json::sax_parse(text, &tree);
  if (!tree.diagnostics.empty()) return tl::unexpected(std::move(tree.diagnostics));
  return YamlDocument{{{file, std::move(text)}}, std::move(tree.root)};
}

}  // namespace prehend
