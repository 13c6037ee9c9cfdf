// SPDX-License-Identifier: Apache-2.0
// Events as lines of JSON: those of `grammar watch --json` and of a recogniser
// (docs/recognisers.md). Tested by tests/program/found_test.cc
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

using nlohmann::json;

/// A time: a whole count of ticks, where it is known how long one is, or else seconds.
std::optional<double> TimeIn(const json& line, const std::string& name, double ticks_per_second,
                             std::string& problem) {
  const auto tick = line.find(name + "_tick"), seconds = line.find(name + "_s");
  if (tick != line.end() && (ticks_per_second > 0 || seconds == line.end())) {
    if (tick->is_number_integer() && ticks_per_second > 0)
      return tick->get<double>() / ticks_per_second;
    problem = fmt::format("{}_tick: found {}, wanted a whole number{}", name, tick->dump(),
                          ticks_per_second > 0 ? "" : "; no recording says how long a tick is");
  } else if (seconds != line.end()) {
    if (seconds->is_number()) return seconds->get<double>();
    problem = fmt::format("{}_s: found {}, wanted seconds", name, seconds->dump());
  }
  return std::nullopt;
}

}  // namespace

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
  const std::string_view text = file.text;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size() && problems.size() < kMostComplaints;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const json line = json::parse(text.substr(begin, end - begin), nullptr, false);
    const bool is_blank =
        text.substr(begin, end - begin).find_first_not_of(" \t") == std::string_view::npos;
    begin = end + 1;
    Label label{.place = {++number, 1}, .roles = {}};
    std::string problem;
    if (is_blank) continue;
    if (!line.is_object())
      problem = "it is no JSON object";
    else if (line.contains("event"))
      problem = ReadEventLine(line, ticks_per_second, label);
    else if (line.contains("error"))
      problem = "the recogniser failed: " + line["error"].dump();
    else if (line.contains("recording") || line.contains("tick"))
      problem = "it is a line of a recording, and no event";
    if (!problem.empty())
      problems.push_back(
          file.At(label.place, problem,
                  R"({"event": "NAME", "roles": {..}, "begin_tick": N, "end_tick": N})"));
    else if (!label.text.empty())
      file.labels.push_back(std::move(label));
  }
  return problems;
}

}  // namespace prehend::exchange
