// SPDX-License-Identifier: Apache-2.0
// The strict reader of golden files: every line is understood or is an error with its place.
// A small cursor walks each line; header comments with a known key are provenance, all others are
// kept as they are. Tested by tests/harness/truth/golden/golden_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::Tick;

constexpr Tick kMaxTicksPerSecond = 1'000'000;
constexpr int kMaxPlays = 1000;
constexpr double kMaxSpread_ms = 1e7;

bool IsNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

bool IsDate(std::string_view text) {
  if (text.size() != 10) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool dash = i == 4 || i == 7;
    if (dash ? text[i] != '-' : (text[i] < '0' || text[i] > '9')) return false;
  }
  return true;
}

class GoldenReader {
 public:
  GoldenReader(std::string_view file, std::string_view text) : file_(file), text_(text) {}

  Result<Golden> Read() {
    for (const std::string_view line : LinesOf(text_)) {
      line_ = line;
      ++line_number_;
      column_ = 0;
      ReadLine();
    }
    golden_.closing_comments = std::move(pending_comments_);
    CheckWhole();
    if (!diagnostics_.empty()) return tl::unexpected(std::move(diagnostics_));
    std::sort(
        golden_.events.begin(), golden_.events.end(),
        [](const GoldenEvent& a, const GoldenEvent& b) { return ComesBefore(a.event, b.event); });
    return std::move(golden_);
  }

 private:
  void ReadLine() {
    SkipBlanks();
    if (AtEnd()) return;
    if (line_[column_] == '#') {
      ReadComment();
    } else {
      ReadEvent();
    }
  }

  void ReadComment() {
    ++column_;
    if (!AtEnd() && line_[column_] == ' ') ++column_;
    const std::string comment(line_.substr(column_));
    if (table_begun_) {
      pending_comments_.push_back(comment);
      return;
    }
    if (comment.starts_with("event ") && comment.find("begin_s") != std::string::npos) {
      table_begun_ = true;
      return;
    }
    const std::size_t colon = comment.find(": ");
    const std::string key = comment.substr(0, colon);
    if (colon == std::string::npos || !ReadProvenance(key, colon + 2)) {
      NoteNearMiss(comment);
      golden_.comments.push_back(comment);
    }
  }

  /// A comment that may be meant as a line of the header that must not be missing.
  void NoteNearMiss(std::string_view comment) {
    const std::string_view word = comment.substr(0, comment.find(':'));
    if (word.size() == comment.size() || word.size() > 40) return;
    const std::size_t begin = std::min(word.find_first_not_of(" \t"), word.size());
    const std::string near =
        grammar::NearestName(word.substr(begin), {"scenario", "grammar", "ticks_per_second"});
    if (!near.empty())
      near_misses_.try_emplace(near, NearMiss{line_, line_number_, column_ + begin});
  }

  /// Of the header; at a line that is nearly it, if there is one.
  void ComplainOfMissing(const std::string& key, const std::string& message) {
    const auto near = near_misses_.find(key);
    if (near == near_misses_.end()) return Complain(message);
    line_ = near->second.line;
    line_number_ = near->second.number;
    column_ = near->second.column;
    Complain(message, fmt::format("write '# {}: ', with these blanks", key));
  }

  /// False for any other key: the line is an ordinary comment.
  bool ReadProvenance(std::string_view key, std::size_t value_offset) {
    const std::size_t key_column = column_;
    column_ += value_offset;
    const std::string value(line_.substr(column_));
    if (key == "scenario") {
      SetOnce(golden_.scenario, value, key);
    } else if (key == "grammar") {
      SetOnce(golden_.grammar, value, key);
    } else if (key == "derived") {
      golden_.derived.push_back(value);
    } else if (key == "accepted") {
      ReadAcceptance(golden_.accepted);
    } else if (key == "pictures") {
      ReadAcceptance(golden_.pictures);
    } else if (key == "ensemble") {
      ReadEnsemble(value);
    } else if (key == "unsteady") {
      ReadUnsteady();
    } else if (key == "ticks_per_second") {
      ReadTicksPerSecond(value);
    } else if (key == "version") {  // 1 where no line says it
      if (value != "1") Complain("found version " + value + " of the format, wanted 1");
    } else {
      column_ = key_column;
      return false;
    }
    return true;
  }

  void SetOnce(std::string& field, const std::string& value, std::string_view key) {
    if (!field.empty()) return Complain(fmt::format("second '{}' line", key));
    field = value;
  }

  void ReadAcceptance(std::vector<Acceptance>& acceptances) {
    Acceptance acceptance{.date = std::string(Word())};
    if (!IsDate(acceptance.date)) {
      column_ -= acceptance.date.size();
      return Complain("expected the date of the acceptance, YYYY-MM-DD");
    }
    SkipBlanks();
    if (!ReadQuoted(acceptance.reason)) return;
    ExpectEnd();
    acceptances.push_back(std::move(acceptance));
  }

  void ReadEnsemble(std::string_view value) {
    if (golden_.ensemble_plays > 0) return Complain("second 'ensemble' line");
    std::optional<int> plays;
    if (value.ends_with(" plays")) plays = NumberFrom<int>(value.substr(0, value.size() - 6));
    if (!plays || *plays < 1 || *plays > kMaxPlays)
      return Complain(
          fmt::format("expected the number of plays, from 1 to {}, like '6 plays'", kMaxPlays));
    golden_.ensemble_plays = *plays;
  }

  void ReadUnsteady() {
    if (!golden_.unsteady.empty()) return Complain("second 'unsteady' line");
    const std::size_t reason_column = column_;
    if (!ReadQuoted(golden_.unsteady)) return;
    if (golden_.unsteady.empty()) FailAt(reason_column, "the reason is empty");
    ExpectEnd();
  }

  void ReadTicksPerSecond(const std::string& value) {
    if (has_ticks_per_second_) return Complain("second 'ticks_per_second' line");
    const auto ticks = NumberFrom<Tick>(value);
    if (!ticks || *ticks < 1 || *ticks > kMaxTicksPerSecond) {
      return Complain(
          fmt::format("ticks_per_second must be a whole number from 1 to {}", kMaxTicksPerSecond));
    }
    golden_.ticks_per_second = *ticks;
    has_ticks_per_second_ = true;
  }

  void ReadEvent() {
    if (!has_ticks_per_second_) {
      if (!missing_rate_reported_)
        ComplainOfMissing("ticks_per_second", "an event before the line '# ticks_per_second: N'");
      missing_rate_reported_ = true;
      return;
    }
    table_begun_ = true;
    GoldenEvent line;
    const std::size_t event_column = column_;
    line.comments = std::move(pending_comments_);
    pending_comments_.clear();
    if (!ReadName(line.event.event, "an event's name") ||
        !ReadTime(line.event.interval.begin, "begin_s") ||
        !ReadTime(line.event.interval.end, "end_s")) {
      return;
    }
    if (line.event.interval.begin >= line.event.interval.end) {
      column_ = event_column;
      return Complain("the event must end after it begins");
    }
    if (!ReadRolesAndFlags(line)) return;
    if (!seen_.insert({line.event.Label(), {line.event.interval.begin, line.event.interval.end}})
             .second) {
      column_ = event_column;
      return Complain("this event is listed twice");
    }
    line.as_written = line_;
    line.line = line_number_;
    golden_.events.push_back(std::move(line));
  }

  bool ReadRolesAndFlags(GoldenEvent& line) {
    bool may_explain = false;       // a tolerance stands before it, without its reason yet
    std::set<std::string> written;  // each of them once; a value may be called like a role
    for (SkipBlanks(); !AtEnd(); SkipBlanks()) {
      const std::size_t word_column = column_;
      if (line_[column_] == '#') return Fail("comments stand on lines of their own");
      std::string key;
      if (!ReadName(key, "role=value")) return false;
      const bool is_value = !AtEnd() && line_[column_] == '~';
      if ((key != "because" || is_value) && !written.insert(is_value ? key + "~" : key).second)
        return FailAt(word_column, fmt::format("second '{}'", key));
      if (is_value) {
        if (!ReadValue(line, key, word_column)) return false;
      } else if (key == "open_end") {
        line.event.open_end = true;
      } else if (key == "because") {
        if (!std::exchange(may_explain, false))
          return FailAt(word_column,
                        "'because' gives the reason of a tolerance, but none stands before it");
        if (!ReadReason(line)) return false;
      } else if (AtEnd() || line_[column_] != '=') {
        return Fail(fmt::format("expected '=' after '{}'", key),
                    grammar::NearestName(key, {"open_end"}).empty()
                        ? "ROLE=NAME without blanks, or open_end"
                        : "did you mean 'open_end'?");
      } else if (++column_; key == "tolerance") {
        if (!ReadTolerance(line)) return false;
        may_explain = true;
      } else if (key == "oracle") {
        return FailAt(word_column, "a line no longer says how it differs from the physical oracle",
                      "remove 'oracle=' and its reason; the header counts the events that follow "
                      "from the definitions");
      } else if (key == "accepted") {
        if (!ReadAcceptedBy(line)) return false;
      } else if (key == "spread") {
        if (!ReadSpread(line)) return false;
      } else if (!ReadRole(line, key, word_column)) {
        return false;
      }
    }
    if (line.event.roles.empty()) return Fail("an event needs at least one role=value");
    if (line.tolerance_ms && line.because.empty()) {
      return Fail("a tolerance needs a reason", "tolerance=20ms because \"the reason\"");
    }
    return true;
  }

  bool ReadRole(GoldenEvent& line, const std::string& key, std::size_t word_column) {
    const std::string value(Word());
    if (value.empty()) return Fail(fmt::format("expected a value for '{}'", key));
    if (line.event.roles.size() == kMostRoles) return FailAt(word_column, "too many roles");
    line.event.roles.push_back({key, value});
    return true;
  }

  /// NAME~NUMBER with the unit at once behind it.
  bool ReadValue(GoldenEvent& line, const std::string& name, std::size_t word_column) {
    ++column_;
    const std::size_t value_column = column_;
    const std::string_view word = Word();
    grammar::NamedValue value{.name = name};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value.value);
    if (error != std::errc() || std::isnan(value.value))
      return FailAt(value_column, fmt::format("expected a number after '{}~', like 12.5N", name));
    value.unit = std::string(end, word.data() + word.size());
    if (line.event.values.size() == kMostRoles) return FailAt(word_column, "too many values");
    line.event.values.push_back(std::move(value));
    return true;
  }

  bool ReadAcceptedBy(GoldenEvent& line) {
    const std::size_t value_column = column_;
    const auto number = NumberFrom<int>(Word());
    const int next = static_cast<int>(golden_.accepted.size()) + 1;
    if (!number || *number < 1 || *number > next) {
      return FailAt(value_column,
                    fmt::format("expected which of the {} 'accepted' lines it is from", next - 1));
    }
    line.accepted = *number;
    return true;
  }

  bool ReadSpread(GoldenEvent& line) {
    const std::size_t value_column = column_;
    std::string_view value = Word();
    const std::size_t slash = value.find('/');
    std::optional<double> begin_ms, end_ms;
    if (value.ends_with("ms") && slash != std::string_view::npos) {
      begin_ms = NumberFrom<double>(value.substr(0, slash));
      end_ms = NumberFrom<double>(value.substr(slash + 1, value.size() - slash - 3));
    }
    const auto is_spread = [](const std::optional<double>& ms) {
      return ms && *ms >= 0 && *ms <= kMaxSpread_ms;
    };
    if (!is_spread(begin_ms) || !is_spread(end_ms))
      return FailAt(value_column,
                    "a spread is how far begin and end moved, in milliseconds, like 0.0/12.5ms");
    line.spread = {*begin_ms, *end_ms};
    return true;
  }

  bool ReadTolerance(GoldenEvent& line) {
    const std::size_t value_column = column_;
    std::string_view value = Word();
    std::optional<int> milliseconds;
    if (value.ends_with("ms")) milliseconds = NumberFrom<int>(value.substr(0, value.size() - 2));
    if (!milliseconds || *milliseconds < 0 || *milliseconds > 10'000) {
      return FailAt(value_column, "a tolerance is whole milliseconds up to 10000, like 20ms");
    }
    line.tolerance_ms = milliseconds;
    return true;
  }

  bool ReadReason(GoldenEvent& line) {
    SkipBlanks();
    const std::size_t reason_column = column_;
    if (!ReadQuoted(line.because)) return false;
    return !line.because.empty() || FailAt(reason_column, "the reason is empty");
  }

  bool ReadName(std::string& name, std::string_view wanted) {
    const std::size_t begin = column_;
    while (!AtEnd() && IsNameCharacter(line_[column_])) ++column_;
    name = line_.substr(begin, column_ - begin);
    return !name.empty() || Fail(fmt::format("expected {}", wanted));
  }

  /// A time must be a tick: a silently rounded boundary would not be what the author wrote.
  bool ReadTime(Tick& tick, std::string_view what) {
    SkipBlanks();
    const std::size_t value_column = column_;
    const auto seconds = NumberFrom<double>(Word());
    if (!seconds || !std::isfinite(*seconds) || *seconds < 0 || *seconds > 1e6) {
      return FailAt(value_column, fmt::format("expected {}, a time in seconds", what));
    }
    tick = TickAt(*seconds, golden_.ticks_per_second);
    const std::string nearest = SecondsText(tick, golden_.ticks_per_second);
    if (std::abs(*seconds - *NumberFrom<double>(nearest)) > 1e-9 &&
        std::abs(*seconds * golden_.ticks_per_second - static_cast<double>(tick)) > 1e-6) {
      return FailAt(value_column,
                    fmt::format("{} is not on a tick of 1/{} s", what, golden_.ticks_per_second),
                    fmt::format("the nearest tick is at {}", nearest));
    }
    return true;
  }

  bool ReadQuoted(std::string& value) {
    if (AtEnd() || line_[column_] != '"') return Fail("expected a reason in double quotes");
    const std::size_t begin = column_;
    for (++column_; !AtEnd(); ++column_) {
      char c = line_[column_];
      if (c == '"') return ++column_, true;
      if (c == '\\' && column_ + 1 < line_.size()) c = line_[++column_];
      value += c;
    }
    return FailAt(begin, "the closing quote is missing");
  }

  void CheckWhole() {
    if (!diagnostics_.empty()) return;
    const auto must_have = [this](bool has, const std::string& key, const char* value) {
      line_ = {};
      line_number_ = 0;
      column_ = 0;
      if (!has) ComplainOfMissing(key, fmt::format("the line '# {}: {}' is missing", key, value));
    };
    must_have(!golden_.scenario.empty(), "scenario", "skill/name");
    must_have(!golden_.grammar.empty(), "grammar", "name");
    must_have(has_ticks_per_second_, "ticks_per_second", "N");
  }

  bool AtEnd() const { return column_ >= line_.size(); }

  void SkipBlanks() {
    while (!AtEnd() && (line_[column_] == ' ' || line_[column_] == '\t')) ++column_;
  }

  std::string_view Word() {
    const std::size_t begin = column_;
    while (!AtEnd() && line_[column_] != ' ' && line_[column_] != '\t') ++column_;
    return line_.substr(begin, column_ - begin);
  }

  void ExpectEnd() {
    SkipBlanks();
    if (!AtEnd()) Complain("unexpected text at the end of the line");
  }

  void Complain(std::string message, std::string hint = {}) {
    grammar::Diagnostic diagnostic{
        .file = std::string(file_), .message = std::move(message), .hint = std::move(hint)};
    const int column = static_cast<int>(column_) + 1;
    grammar::ShowLine(diagnostic, line_, column);
    if (line_number_ > 0) diagnostic.place = {line_number_, column};
    diagnostics_.push_back(std::move(diagnostic));
  }

  bool Fail(std::string message, std::string hint = {}) {
    Complain(std::move(message), std::move(hint));
    return false;
  }

  bool FailAt(std::size_t column, std::string message, std::string hint = {}) {
    column_ = column;
    return Fail(std::move(message), std::move(hint));
  }

  std::string_view file_;
  std::string_view text_;
  std::string_view line_;
  int line_number_ = 0;
  std::size_t column_ = 0;
  bool table_begun_ = false;
  bool has_ticks_per_second_ = false;
  bool missing_rate_reported_ = false;
  struct NearMiss {
    std::string_view line;
    int number = 0;
    std::size_t column = 0;
  };
  std::map<std::string, NearMiss> near_misses_;  ///< by what may be meant
  std::vector<std::string> pending_comments_;
  std::set<std::pair<std::string, std::pair<Tick, Tick>>> seen_;
  Golden golden_;
  grammar::Diagnostics diagnostics_;
};

}  // namespace

Result<Golden> ReadGolden(std::string_view file, std::string_view text) {
  grammar::Diagnostics not_text = CheckText(std::string(file), text);
  if (!not_text.empty()) return tl::unexpected(std::move(not_text));
  return GoldenReader(file, text).Read();
}

}  // namespace prehend::truth
