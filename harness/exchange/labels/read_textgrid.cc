// SPDX-License-Identifier: Apache-2.0
// Labels from Praat's TextGrid. Tested by tests/harness/exchange/labels/labels_test.cc
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::Place;

constexpr double kOverlap_s = 1e-3;  ///< less is rounding
constexpr double kMostTiers = 10'000, kMostIntervals = 1'000'000;

/// The free-standing numbers, texts and flags of a file; all else in it is for people.
class Reader {
 public:
  explicit Reader(LabelFile& file) : file_(file), text_(file.text) {}

  Diagnostics Read() {
    const std::string type = Text("the word ooTextFile"), kind = Text("the word TextGrid");
    if (problem_.empty() &&
        ((type != "ooTextFile" && type != "ooTextFile short") || kind != "TextGrid"))
      Fail({1, 1},
           fmt::format("found a file of type '{}', '{}'; wanted ooTextFile, TextGrid", type, kind));
    Number("its begin");
    Number("its end");
    const std::string flag = Flag();
    if (problem_.empty() && flag != "<exists>") Fail(place_, "it has no tiers");
    const double tiers = Count("the number of tiers", kMostTiers);
    for (double i = 0; i < tiers && problem_.empty(); ++i) ReadTier();
    return std::move(problem_);
  }

 private:
  void ReadTier() {
    const std::string kind = Text("the class of a tier"), name = Text("the name of a tier");
    Number("the begin of a tier");
    Number("the end of a tier");
    const bool has_intervals = kind == "IntervalTier";
    if (problem_.empty() && !has_intervals && kind != "TextTier")
      return Fail(place_,
                  fmt::format("found a tier of class '{}', wanted IntervalTier or TextTier", kind));
    const double rows = Count("the number of labels of a tier", kMostIntervals);
    double last_s = 0;
    for (double i = 0; i < rows && problem_.empty(); ++i) {
      Label label{.tier = name};
      label.begin_s = Number("the begin of a label");
      label.end_s = has_intervals ? Number("the end of a label") : label.begin_s;
      label.text = Text("the text of a label");
      label.place = place_;
      if (problem_.empty() && i > 0 && label.begin_s < last_s - kOverlap_s)
        Fail(place_, fmt::format("a label of '{}' begins at {:g} s, before the one before it ends, "
                                 "at {:g} s",
                                 name, label.begin_s, last_s));
      last_s = label.end_s;
      if (label.text.find_first_not_of(" \t\n") != std::string::npos && problem_.empty())
        file_.labels.push_back(std::move(label));
    }
  }

  void Fail(Place place, std::string message) {
    if (problem_.empty()) problem_ = {file_.At(place, std::move(message))};
  }

  double Count(const char* what, double most) {
    const double count = Number(what);
    if (problem_.empty() && (count < 0 || count > most || count != std::floor(count)))
      Fail(place_,
           fmt::format("{}: found {:g}, wanted a whole number up to {:g}", what, count, most));
    return problem_.empty() ? count : 0;
  }

  double Number(const char* what) {
    std::string_view word;
    while (problem_.empty()) {
      const bool is_value = word == "=";  // what stands before it is only words
      word = Word();
      if (word.empty()) break;
      double number = 0;
      if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error == std::errc() && end == word.data() + word.size() && std::isfinite(number))
        return number;
      if (is_value || word.front() == '"' || word.front() == '<')
        Fail(place_, fmt::format("found {}, wanted {}", word, what));
    }
    Fail(place_, fmt::format("the file ends before {}", what));
    return 0;
  }

  std::string Text(const char* what) {
    while (problem_.empty()) {
      const std::string_view word = Word();
      if (word.empty()) break;
      if (word.front() != '"') continue;
      if (word.size() < 2 || !closed_) {
        Fail(place_, "the quote is not closed");
        break;
      }
      std::string text;
      for (std::size_t i = 1; i + 1 < word.size(); ++i) {
        text += word[i];
        if (word[i] == '"') ++i;  // "" is one quote
      }
      return text;
    }
    Fail(place_, fmt::format("the file ends before {}", what));
    return {};
  }

  std::string Flag() {
    while (problem_.empty()) {
      const std::string_view word = Word();
      if (word.empty()) break;
      if (word.front() == '<') return std::string(word);
    }
    Fail(place_, "the file ends before <exists>");
    return {};
  }

  void Step() {
    if (text_[at_] == '\n') {
      ++line_;
      column_ = 0;
    }
    ++column_;
    ++at_;
  }

  /// A text with its quotes, or what stands between blanks; "" at the end. What follows '!' to the
  /// end of the line is a comment.
  std::string_view Word() {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n'; };
    while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '!')) {
      if (text_[at_] == '!')
        while (at_ < text_.size() && text_[at_] != '\n') Step();
      else
        Step();
    }
    place_ = {line_, column_};
    const std::size_t begin = at_;
    closed_ = false;
    if (at_ < text_.size() && text_[at_] == '"') {
      Step();
      while (at_ < text_.size() && !closed_) {
        const bool doubled = text_[at_] == '"' && at_ + 1 < text_.size() && text_[at_ + 1] == '"';
        if (doubled) Step();
        closed_ = !doubled && text_[at_] == '"';
        Step();
      }
    } else {
      while (at_ < text_.size() && !is_blank(text_[at_])) Step();
    }
    return text_.substr(begin, at_ - begin);
  }

  LabelFile& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
  Place place_;          ///< of the last word
  bool closed_ = false;  ///< the last word is a text that ends
  Diagnostics problem_;
};

}  // namespace

Diagnostics ReadTextGridLabels(LabelFile& file) { return Reader(file).Read(); }

}  // namespace prehend::exchange
