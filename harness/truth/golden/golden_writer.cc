// SPDX-License-Identifier: Apache-2.0
// The canonical text of a golden. Tested by tests/harness/truth/golden/golden_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

void AppendComments(const std::vector<std::string>& comments, std::string& out) {
  for (const std::string& comment : comments)
    out += comment.empty() ? "#\n" : "# " + comment + "\n";
}

/// The lines of the table: the title first, then one per event.
std::vector<std::string> TableLines(const Golden& golden) {
  std::size_t role_columns = 1;
  for (const GoldenEvent& line : golden.events) {
    role_columns = std::max(role_columns, line.event.roles.size());
  }
  std::vector<std::vector<std::string>> rows = {{"# event", "begin_s", "end_s", "roles"}};
  for (const GoldenEvent& line : golden.events) {
    auto cells = EventCells(line.event, golden.ticks_per_second, role_columns);
    const auto add = [&](const std::string& words) {
      cells.back() += (cells.back().empty() ? "" : "  ") + words;
    };
    for (const grammar::NamedValue& value : line.event.values)
      add(fmt::format("{}~{:.4g}{}", value.name, value.value, value.unit));
    if (line.accepted > 1) add(fmt::format("accepted={}", line.accepted));
    if (line.spread != Spread{})
      add(fmt::format("spread={:.1f}/{:.1f}ms", line.spread.begin_ms, line.spread.end_ms));
    if (line.tolerance_ms)
      add(fmt::format("tolerance={}ms because {}", *line.tolerance_ms, Quoted(line.because)));
    rows.push_back(std::move(cells));
  }
  std::vector<std::string> lines = AlignColumns(rows);
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    if (!golden.events[i].as_written.empty()) lines[i + 1] = golden.events[i].as_written;
  }
  return lines;
}

}  // namespace

bool operator==(const GoldenEvent& a, const GoldenEvent& b) {
  return a.event.event == b.event.event && a.event.roles == b.event.roles &&
         a.event.interval == b.event.interval && a.event.values == b.event.values &&
         a.event.open_end == b.event.open_end && a.tolerance_ms == b.tolerance_ms &&
         a.because == b.because && a.comments == b.comments && a.accepted == b.accepted;
}

bool operator==(const Golden& a, const Golden& b) {
  return a.scenario == b.scenario && a.grammar == b.grammar && a.derived == b.derived &&
         a.accepted == b.accepted && a.pictures == b.pictures && a.unsteady == b.unsteady &&
         a.ticks_per_second == b.ticks_per_second && a.comments == b.comments &&
         a.events == b.events && a.closing_comments == b.closing_comments;
}

std::string WriteGolden(const Golden& golden) {
  std::string out = fmt::format("# scenario: {}\n# grammar: {}\n", golden.scenario, golden.grammar);
  for (const std::string& line : golden.derived) out += fmt::format("# derived: {}\n", line);
  for (const Acceptance& acceptance : golden.accepted)
    out += fmt::format("# accepted: {} {}\n", acceptance.date, Quoted(acceptance.reason));
  for (const Acceptance& acceptance : golden.pictures)
    out += fmt::format("# pictures: {} {}\n", acceptance.date, Quoted(acceptance.reason));
  if (golden.ensemble_plays > 0)
    out += fmt::format("# ensemble: {} plays\n", golden.ensemble_plays);
  if (!golden.unsteady.empty()) out += fmt::format("# unsteady: {}\n", Quoted(golden.unsteady));
  out += fmt::format("# ticks_per_second: {}\n", golden.ticks_per_second);
  AppendComments(golden.comments, out);

  const std::vector<std::string> lines = TableLines(golden);
  out += lines.front() + "\n";
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    AppendComments(golden.events[i].comments, out);
    out += lines[i + 1] + "\n";
  }
  AppendComments(golden.closing_comments, out);
  return out;
}

grammar::Timeline ToTimeline(const Golden& golden) {
  grammar::Timeline timeline{.ticks_per_second = golden.ticks_per_second, .events = {}};
  for (const GoldenEvent& line : golden.events) timeline.events.push_back(line.event);
  return timeline;
}

}  // namespace prehend::truth
