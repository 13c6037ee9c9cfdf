// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/read_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <pugixml.hpp>
#include <set>

#include "harness/base/base/input_files.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/truth/golden/golden.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;
using grammar::Diagnostics;
using grammar::Place;

/// The code points of UTF-16 as UTF-8; what is no code point becomes U+FFFD.
std::string FromUtf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<std::uint8_t>(bytes[i]),
               second = static_cast<std::uint8_t>(bytes[i + 1]);
    return static_cast<char32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  std::wstring codes;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    char32_t code = unit(i);
    const bool is_pair = code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size() &&
                         unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000;
    if (is_pair) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    codes += static_cast<wchar_t>(code);
  }
  std::string text = pugi::as_utf8(codes);
  std::erase(text, '\r');
  return text;
}

/// As ReadTextFile(); Praat also writes UTF-16 with a byte order mark.
Result<std::string> ReadAnyUtf(const std::string& path) {
  char mark[2] = {};
  std::error_code error;
  if (fs::is_regular_file(path, error)) std::ifstream(path, std::ios::binary).read(mark, 2);
  const bool big = mark[0] == '\xFE' && mark[1] == '\xFF',
             little = mark[0] == '\xFF' && mark[1] == '\xFE';
  if ((!big && !little) || fs::file_size(path, error) > kMaxTextFileBytes)
    return ReadTextFile(path);
  std::ifstream in = OpenInput(path);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::string text = FromUtf16(std::string_view(bytes).substr(2), big);
  Diagnostics strange = CheckText(path, text);
  if (!strange.empty()) return tl::unexpected(std::move(strange));
  return text;
}

/// Leaves them out, or says what is wrong with each.
void TakeBackward(LabelFile& file, Backward how, Diagnostics& problems) {
  const auto is_backward = [](const Label& label) { return label.end_s < label.begin_s; };
  if (how == Backward::kSkip) {
    file.backward = std::erase_if(file.labels, is_backward);
    return;
  }
  const auto count = static_cast<std::size_t>(std::ranges::count_if(file.labels, is_backward));
  std::size_t told = 0;
  for (const Label& label : file.labels) {
    if (!is_backward(label) || told == kMostBackward) continue;
    problems.push_back(
        file.At(label.place, fmt::format("'{}' ends before it begins: {:g} s to {:g} s", label.text,
                                         label.begin_s, label.end_s)));
    if (++told < std::min(count, kMostBackward)) continue;
    problems.back().hint = fmt::format(
        "{}--skip-bad-labels leaves out what ends before it begins",
        count > told ? fmt::format("there are {} such labels in the file; ", count) : "");
  }
}

// Events as lines of JSON: those of `grammar watch --json` and of a recogniser
// (docs/recognisers.md). Tested by tests/program/found_test.cc

using nlohmann::json;

/// A time: a whole count of ticks, where it is known how long one is, or else seconds.
std::optional<double> TimeIn(const json& line, const std::string& name, double ticks_per_second,
                             std::string& problem) {
  const auto tick = line.find(name + "_tick"), seconds = line.find(name + "_s");
  if (tick != line.end() && (ticks_per_second > 0 || seconds == line.end())) {
    if (tick->is_number_integer() && ticks_per_second > 0)
      return tick->get<double>() / ticks_per_second;
    problem = ticks_per_second > 0
                  ? fmt::format("{}_tick: found {}, wanted a whole number", name, tick->dump())
                  : fmt::format(
                        "{0}_tick: ticks are read only of what is --found; wanted {0}_s, "
                        "in seconds",
                        name);
  } else if (seconds != line.end()) {
    if (seconds->is_number()) return seconds->get<double>();
    problem = fmt::format("{}_s: found {}, wanted seconds", name, seconds->dump());
  }
  return std::nullopt;
}

// Labels from ELAN's annotation format. Tested by tests/harness/exchange/labels/labels_test.cc

Place PlaceAt(std::string_view text, std::ptrdiff_t offset) {
  const std::string_view before =
      text.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return {static_cast<int>(std::ranges::count(before, '\n')) + 1,
          static_cast<int>(before.size() - line_begin) + 1};
}

class EafReader {
 public:
  explicit EafReader(LabelFile& file) : file_(file) {}

  Diagnostics Read() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed =
        document.load_buffer(file_.text.data(), file_.text.size());
    if (!parsed)
      return {file_.At(PlaceAt(file_.text, parsed.offset),
                       std::string("it is no XML: ") + parsed.description())};
    const pugi::xml_node root = document.child("ANNOTATION_DOCUMENT");
    if (!root)
      return {file_.At(PlaceAt(file_.text, document.first_child().offset_debug()),
                       fmt::format("found <{}>, wanted <ANNOTATION_DOCUMENT>, as ELAN writes it",
                                   document.document_element().name()))};
    const std::string unit = root.child("HEADER").attribute("TIME_UNITS").as_string("milliseconds");
    if (unit != "milliseconds")
      Complain(root.child("HEADER"), "TIME_UNITS: found '" + unit + "', wanted milliseconds",
               "ELAN saves it so after Options > Propagate time offset is not set to frames");
    for (const pugi::xml_node media : root.child("HEADER").children("MEDIA_DESCRIPTOR"))
      WarnOfOrigin(media);
    file_.has_header = root.child("HEADER") || root.child("TIER");
    ReadSlots(root.child("TIME_ORDER"));
    for (const pugi::xml_node tier : root.children("TIER")) ReadAligned(tier);
    for (const pugi::xml_node tier : root.children("TIER")) ReadReferring(tier);
    return std::move(problems_);
  }

 private:
  struct Times {
    double begin_s = 0, end_s = 0;
  };

  void Complain(pugi::xml_node node, std::string message, std::string hint = {}) {
    if (problems_.size() < kMostComplaints)
      problems_.push_back(
          file_.At(PlaceAt(file_.text, node.offset_debug()), std::move(message), std::move(hint)));
  }

  /// ELAN shows the video from there on; its annotations count from there, too.
  void WarnOfOrigin(pugi::xml_node media) {
    const double origin_ms = media.attribute("TIME_ORIGIN").as_double(0);
    if (origin_ms == 0) return;
    file_.warnings.push_back(file_.At(
        PlaceAt(file_.text, media.offset_debug()),
        fmt::format("TIME_ORIGIN: 0 s of the labels is {:g} s of the video", origin_ms / 1000),
        "if the recording began with the video: offset_s of this take in the map or in a file of "
        "takes, 0 if it did not"));
    file_.warnings.back().is_warning = true;
  }

  void ReadSlots(pugi::xml_node order) {
    std::vector<std::pair<std::string, std::optional<double>>> slots;
    std::set<std::string> ids;
    for (const pugi::xml_node slot : order.children("TIME_SLOT")) {
      std::optional<double> time_s;
      if (const pugi::xml_attribute value = slot.attribute("TIME_VALUE")) {
        char* end = nullptr;
        const double milliseconds = std::strtod(value.as_string(), &end);
        if (*value.as_string() == '\0' || *end != '\0' || !(milliseconds >= 0))
          Complain(slot,
                   fmt::format("TIME_VALUE: found '{}', wanted milliseconds", value.as_string()));
        time_s = milliseconds / 1000;
      }
      slots.emplace_back(slot.attribute("TIME_SLOT_ID").as_string(), time_s);
      if (!ids.insert(slots.back().first).second)
        Complain(slot, fmt::format("TIME_SLOT_ID: '{}' is given twice", slots.back().first));
    }
    for (std::size_t i = 0; i < slots.size();) {
      if (slots[i].second) {
        times_[slots[i].first] = *slots[i].second;
        ++i;
        continue;
      }
      std::size_t next = i;
      while (next < slots.size() && !slots[next].second) ++next;
      if (i == 0 || next == slots.size()) return;  // such slots stay unknown
      const double from_s = *slots[i - 1].second, to_s = *slots[next].second;
      const auto parts = static_cast<double>(next - i + 1);
      for (std::size_t k = i; k < next; ++k)
        times_[slots[k].first] = from_s + (to_s - from_s) * static_cast<double>(k - i + 1) / parts;
      i = next;
    }
  }

  std::optional<double> TimeOf(pugi::xml_node annotation, const char* attribute) {
    const std::string slot = annotation.attribute(attribute).as_string();
    const auto found = times_.find(slot);
    if (found != times_.end()) return found->second;
    Complain(annotation,
             fmt::format("{}: there is no time slot '{}' with a time", attribute, slot));
    return std::nullopt;
  }

  void Add(pugi::xml_node annotation, pugi::xml_node tier, const Times& times) {
    const std::string text = annotation.child_value("ANNOTATION_VALUE");
    const bool is_empty = text.find_first_not_of(" \t\n") == std::string::npos;
    (is_empty ? file_.empty : file_.labels)
        .push_back({.begin_s = times.begin_s,
                    .end_s = times.end_s,
                    .text = text,
                    .tier = tier.attribute("TIER_ID").as_string(),
                    .place = PlaceAt(file_.text, annotation.offset_debug())});
  }

  void ReadAligned(pugi::xml_node tier) {
    for (const pugi::xml_node annotation : tier.children("ANNOTATION")) {
      const pugi::xml_node aligned = annotation.child("ALIGNABLE_ANNOTATION");
      if (!aligned) continue;
      const auto begin_s = TimeOf(aligned, "TIME_SLOT_REF1"),
                 end_s = TimeOf(aligned, "TIME_SLOT_REF2");
      if (!begin_s || !end_s) continue;
      by_id_[aligned.attribute("ANNOTATION_ID").as_string()] = {*begin_s, *end_s};
      Add(aligned, tier, {*begin_s, *end_s});
    }
  }

  /// Annotations of tiers that depend on another tier; these may refer to each other.
  void ReadReferring(pugi::xml_node tier) {
    for (const pugi::xml_node annotation : tier.children("ANNOTATION")) {
      const pugi::xml_node referring = annotation.child("REF_ANNOTATION");
      if (!referring) continue;
      const std::string to = referring.attribute("ANNOTATION_REF").as_string();
      const auto found = by_id_.find(to);
      if (found == by_id_.end()) {
        Complain(referring, "ANNOTATION_REF: there is no annotation '" + to + "' before it");
        continue;
      }
      by_id_[referring.attribute("ANNOTATION_ID").as_string()] = found->second;
      Add(referring, tier, found->second);
    }
  }

  LabelFile& file_;
  Diagnostics problems_;
  std::map<std::string, double> times_;
  std::map<std::string, Times> by_id_;
};

// Labels from Praat's TextGrid. Tested by tests/harness/exchange/labels/labels_test.cc

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
      if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
      const auto number = NumberFrom<double>(word);
      if (number && std::isfinite(*number)) return *number;
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

grammar::Diagnostic LabelFile::At(Place place, std::string message, std::string hint) const {
  return grammar::DiagnosticAt(file, text, place, std::move(message), std::move(hint));
}

const std::vector<std::string>& LabelEndings() {
  static const std::vector<std::string> endings = {".csv",      ".tsv",      ".eaf",
                                                   ".TextGrid", ".timeline", ".txt"};
  return endings;
}

bool IsLabelFile(const std::string& path) {
  return std::ranges::any_of(LabelEndings(), [&](const std::string& ending) {
    return EndingOf(path) == EndingOf("x" + ending);
  });
}

bool IsTable(const std::string& path) {
  const std::string ending = EndingOf(path);
  return ending == ".csv" || ending == ".tsv";
}

Result<LabelFile> ReadLabels(const std::string& path, const CsvReading& csv, Backward backward) {
  PREHEND_TRY(std::string text, ReadAnyUtf(path));
  LabelFile file{.file = path, .text = std::move(text)};
  const std::string ending = EndingOf(path);
  Diagnostics problems;
  if (IsTable(path) || (ending == ".txt" && IsLabelTrack(file.text))) {
    problems = ReadCsvLabels(file, csv);
  } else if (ending == ".txt") {
    problems = ReadFrameLabels(file, csv);
  } else if (ending == ".eaf") {
    problems = ReadEafLabels(file);
  } else if (ending == ".textgrid") {
    problems = ReadTextGridLabels(file);
  } else if (ending == ".timeline") {
    problems = ReadGoldenLabels(file);
  } else if (ending == ".jsonl") {
    problems = ReadJsonLabels(file, csv.ticks_per_second);
  } else {
    problems = {file.At({}, "no file of labels, which end in " +
                                fmt::format("{}", fmt::join(LabelEndings(), ", ")))};
  }
  TakeBackward(file, backward, problems);
  // Below a header, or in the tiers, nothing is an answer, too: nothing happened.
  const bool says_nothing = file.has_header && file.empty.empty() && file.backward == 0 &&
                            file.text.find_first_not_of(" \t\n") != std::string::npos;
  if (problems.empty() && file.labels.empty() && !says_nothing)
    problems.push_back(file.At({}, "it has no labels"));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return file;
}

Diagnostics ReadGoldenLabels(LabelFile& file) {
  PREHEND_TRY(const truth::Golden golden, truth::ReadGolden(file.file, file.text));
  const auto per_s = static_cast<double>(golden.ticks_per_second);
  for (const truth::GoldenEvent& line : golden.events) {
    file.labels.push_back({.begin_s = static_cast<double>(line.event.interval.begin) / per_s,
                           .end_s = static_cast<double>(line.event.interval.end) / per_s,
                           .text = line.event.Label()});
  }
  return {};
}

std::string ReadEventLine(const json& line, double ticks_per_second, Label& label) {
  const json& event = line.at("event");
  if (!event.is_string() || event.get_ref<const std::string&>().empty())
    return fmt::format("event: found {}, wanted the name of an event", event.dump());
  label.text = event.get<std::string>();
  if (const auto roles = line.find("roles"); roles != line.end()) {
    if (!roles->is_object()) return "roles: wanted {\"ROLE\": \"ENTITY\", ..}";
    for (const auto& [role, entity] : roles->items()) {
      if (!entity.is_string())
        return fmt::format("roles: {}: found {}, wanted the name of an entity", role,
                           entity.dump());
      label.roles.push_back({role, entity.get<std::string>()});
    }
  }
  std::string problem;
  const auto begin_s = TimeIn(line, "begin", ticks_per_second, problem),
             end_s = TimeIn(line, "end", ticks_per_second, problem);
  if (ticks_per_second > 0) label.decided_s = TimeIn(line, "decided", ticks_per_second, problem);
  if (!problem.empty()) return problem;
  if (!begin_s || !end_s) return "an event has a begin_tick and an end_tick";
  if (*begin_s >= *end_s) return "end_tick: an event ends after it begins";
  label.begin_s = *begin_s;
  label.end_s = *end_s;
  return "";
}

grammar::Diagnostics ReadJsonLabels(LabelFile& file, double ticks_per_second) {
  grammar::Diagnostics problems;
  int number = 0;
  const char* const event =
      ticks_per_second > 0 ? R"({"event": "NAME", "roles": {..}, "begin_tick": N, "end_tick": N})"
                           : R"({"event": "NAME", "roles": {..}, "begin_s": S, "end_s": S})";
  for (const std::string_view whole : LinesOf(file.text)) {
    Label label{.place = {++number, 1}, .roles = {}};
    std::string problem, wanted = event;
    if (problems.size() == kMostComplaints) break;
    if (Trimmed(whole).empty()) continue;
    const json line = json::parse(whole, nullptr, false);
    if (!line.is_object()) {
      problem = "it is no JSON object";
    } else if (line.contains("recogniser") && line["recogniser"] != 1) {
      problem = "found version " + line["recogniser"].dump() + " of the protocol, wanted 1";
      wanted = R"({"recogniser": 1, ..})";
    } else if (line.contains("event")) {
      problem = ReadEventLine(line, ticks_per_second, label);
      if (problem.empty() && label.decided_s.value_or(label.end_s) < label.end_s)
        problem = "decided_tick: it is before end_tick, and nobody knows the end before it came";
    } else if (line.contains("error")) {
      problem = "the recogniser failed: " + line["error"].dump();
    } else if (line.contains("recording") || line.contains("tick")) {
      problem = "it is a line of a recording, and no event";
    }
    if (!problem.empty())
      problems.push_back(file.At(label.place, problem, wanted));
    else if (!label.text.empty())
      file.labels.push_back(std::move(label));
  }
  return problems;
}

Diagnostics ReadEafLabels(LabelFile& file) { return EafReader(file).Read(); }

Diagnostics ReadTextGridLabels(LabelFile& file) { return Reader(file).Read(); }

}  // namespace prehend::exchange
