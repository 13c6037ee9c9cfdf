// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <fstream>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/episode/episode/take.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

struct TakeYaml {
  std::string recording, labels, grammar, person, set;
  std::vector<Named<std::string>> rows;
  std::optional<double> offset_s, starts_at_s;
};
struct TakesYaml {
  int version = 1;
  std::string map, labels;
  std::vector<TakeYaml> takes;
};

/// What stands there, numbers as they are written: "rows: {video: 7}".
ValueFormat<std::string> Cell() {
  return ValueFormat<std::string>(
      []() -> Json {
        return {{"type", {"string", "number"}}};
      },
      [](const YamlNode& node, DiagnosticList& errors, std::string& value) {
        value = node.text;
        const bool is_there = node.kind == YamlNode::Kind::kScalar && !node.text.empty();
        return is_there || ReportExpected(node, errors, "a name");
      });
}

ValueFormat<double> Date() {
  return ValueFormat<double>(
      []() -> Json {
        return {{"type", "string"}};
      },
      [](const YamlNode& node, DiagnosticList& errors, double& seconds) {
        const std::optional<double> date = SecondsOfDate(node.text);
        seconds = date.value_or(0);
        return date || ReportExpected(node, errors, "a time like 2026-10-25T01:59:57.010");
      });
}

ValueFormat<TakesYaml> TakesFormat() {
  using T = TakeYaml;
  const auto take = StructFormat<T>("a take")
                        .Required("recording", &T::recording, Text(),
                                  "A recording, an episode file, the file of a scenario.")
                        .Optional("labels", &T::labels, Text(), "The file of its labels.")
                        .Optional("rows", &T::rows, MapOf(Text(), Cell(), 1, 20),
                                  "Only rows with these values in these columns are of this take.")
                        .Optional("offset_s", &T::offset_s, Number(-1e6, 1e6),
                                  "Added to the times of the labels, instead of the map's.")
                        .Optional("starts_at", &T::starts_at_s, Date(), "When the recording began.")
                        .AtMostOneOf({"offset_s", "starts_at"})
                        .Optional("person", &T::person, Cell(), "Who is in it.")
                        .Optional("grammar", &T::grammar, Text(), "Instead of its own.")
                        .Optional("set", &T::set, Cell(), "Its set of takes: tune, test, ..")
                        .format();
  return StructFormat<TakesYaml>("a file of takes")
      .Optional("version", &TakesYaml::version, Integer<int>(1, 1), "The version of this format.")
      .Optional("map", &TakesYaml::map, Text(), "What labels mean.")
      .Optional("labels", &TakesYaml::labels, Text(), "Labels of takes that name none.")
      .Required("takes", &TakesYaml::takes, ListOf(take, 1, 10'000), "The takes.")
      .format();
}

}  // namespace

std::optional<double> SecondsOfDate(std::string_view text) {
  const std::string date(text);
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, read = 0, zone_hour = 0, zone_minute = 0;
  char between = 0, sign = '+';
  double second = 0;
  if (std::sscanf(date.c_str(), "%4d-%2d-%2d%c%2d:%2d:%lf%n", &year, &month, &day, &between, &hour,
                  &minute, &second, &read) != 7)
    return std::nullopt;
  const std::string zone = date.substr(static_cast<std::size_t>(read));
  int zone_read = 0;
  if (!zone.empty() && zone != "Z" &&
      (std::sscanf(zone.c_str(), "%c%2d%n", &sign, &zone_hour, &zone_read) != 2 ||
       (zone_read != static_cast<int>(zone.size()) &&
        std::sscanf(zone.c_str() + zone_read, zone[zone_read] == ':' ? ":%2d" : "%2d",
                    &zone_minute) != 1)))
    return std::nullopt;
  const std::chrono::year_month_day ymd{std::chrono::year(year),
                                        std::chrono::month(static_cast<unsigned>(month)),
                                        std::chrono::day(static_cast<unsigned>(day))};
  if (!ymd.ok() || date[4] != '-' || (between != 'T' && between != ' ') || hour < 0 || hour > 23 ||
      minute < 0 || minute > 59 || !(second >= 0 && second < 61) || (sign != '+' && sign != '-'))
    return std::nullopt;
  const int east_s = (sign == '-' ? -1 : 1) * (zone_hour * 3600 + zone_minute * 60);
  const auto days = std::chrono::sys_days(ymd).time_since_epoch().count();
  return static_cast<double>(days) * 86400 + hour * 3600 + minute * 60 + second - east_s;
}

std::vector<Take> TakesOf(const std::vector<EpisodeName>& episodes) {
  std::vector<Take> takes;
  for (const EpisodeName& episode : episodes) takes.push_back({.episode = episode});
  return takes;
}

std::vector<EpisodeName> EpisodesOf(const std::vector<Take>& takes) {
  std::vector<EpisodeName> episodes;
  for (const Take& take : takes) episodes.push_back(take.episode);
  return episodes;
}

bool IsTakesFile(const std::string& path) {
  std::error_code error;
  if ((!path.ends_with(".yaml") && !path.ends_with(".yml")) || !fs::is_regular_file(path, error))
    return false;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("takes:")) return true;
  return false;
}

Result<std::vector<TakeEntry>> ReadTakes(const std::string& path) {
  PREHEND_TRY(const YamlDocument document, ReadYamlFile(path));
  DiagnosticList errors(document);
  TakesYaml read;
  if (!TakesFormat().Read(document.root, errors, read)) return tl::unexpected(errors.Sorted());
  const auto beside = [&](const std::string& file) {
    return file.empty() ? file : (fs::path(path).parent_path() / file).string();
  };
  std::vector<TakeEntry> entries;
  for (TakeYaml& take : read.takes) {
    const bool is_file = take.grammar.ends_with(".grammar");
    TakeEntry& entry = entries.emplace_back();
    entry.recording = beside(take.recording);
    entry.grammar = is_file ? beside(take.grammar) : take.grammar;
    entry.take.labels = beside(take.labels.empty() ? read.labels : take.labels);
    entry.take.map = beside(read.map);
    entry.take.person = take.person;
    entry.take.set = take.set;
    entry.take.offset_s = take.offset_s;
    if (take.starts_at_s) entry.take.offset_s = -*take.starts_at_s;
    for (const Named<std::string>& row : take.rows)
      entry.take.rows.emplace_back(row.name, row.value);
  }
  return entries;
}

}  // namespace prehend::episode
