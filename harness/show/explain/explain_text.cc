// SPDX-License-Identifier: Apache-2.0
// Explanations for people: a tree of clauses, aligned; one line per event for all of them.
// Tested by tests/harness/show/explain/explain_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/show/explain/explain.h"
#include "harness/show/explain/phrasing.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::Tick;
using Mark = Reason::Mark;

constexpr std::size_t kMaxWidth = 70;  // what stands beyond starts a column of its own

char Sign(Mark mark) {
  switch (mark) {
    case Mark::kTurned:
      return '>';
    case Mark::kHeld:
      return '=';
    case Mark::kFailed:
      return '-';
    case Mark::kNote:
      return ' ';
  }
  return ' ';
}

struct Line {
  std::string left;
  std::string right;
};

void AddLines(const Reasons& reasons, std::size_t indent, std::vector<Line>& lines) {
  for (const Reason& reason : reasons) {
    std::string right = reason.how;
    if (!reason.where.empty() && !reason.because.empty()) right += "  (" + reason.where + ")";
    lines.push_back({fmt::format("{:{}}{} {}", "", indent, Sign(reason.mark), reason.what), right});
    AddLines(reason.because, indent + 2, lines);
  }
}

std::string Tree(const std::string& title, const Reasons& reasons) {
  if (reasons.empty()) return "";
  std::vector<Line> lines;
  AddLines(reasons, 2, lines);
  std::size_t width = 0;
  for (const Line& line : lines) {
    if (line.left.size() <= kMaxWidth) width = std::max(width, line.left.size());
  }
  std::string text = title + "\n";
  for (const Line& line : lines) {
    std::string row = fmt::format("{:<{}}  {}", line.left, width, line.right);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

const Reason* FirstTurned(const Reasons& reasons) {
  for (const Reason& reason : reasons) {
    if (reason.mark != Mark::kTurned) continue;
    const Reason* inner = FirstTurned(reason.because);
    return inner != nullptr ? inner : &reason;
  }
  return reasons.empty() ? nullptr : &reasons.front();
}

// "in_cylinder(..)": the whole clause is in the event's own explanation.
std::string Short(const std::string& clause) {
  constexpr std::size_t kLong = 32;
  const std::size_t open = clause.find('(');
  if (clause.size() <= kLong || open == std::string::npos) return clause;
  std::size_t close = open;
  for (int depth = 0; close < clause.size(); ++close) {
    depth += clause[close] == '(' ? 1 : clause[close] == ')' ? -1 : 0;
    if (depth == 0) break;
  }
  return clause.substr(0, open) + "(..)" + clause.substr(std::min(close + 1, clause.size()));
}

std::string Late(const WhyEvent& why, Tick ticks_per_second) {
  if (why.open_end) return "at the end of the episode";
  if (why.decided == why.interval.end) return "at its end";
  return Duration(why.decided - why.interval.end, ticks_per_second) + " after its end";
}

}  // namespace

std::string InOneLine(const Reasons& reasons) {
  const Reason* first = FirstTurned(reasons);
  if (first == nullptr) return "";
  return first->how.empty() ? first->what : Short(first->what) + " " + first->how;
}

std::string Text(const WhyEvent& why, Tick ticks_per_second) {
  std::string text = fmt::format("{}  {}{}  ({})\n", why.event,
                                 truth::IntervalText(why.interval, ticks_per_second),
                                 why.open_end ? ", open end" : "", why.where);
  text += Tree("  began at " + At(why.interval.begin, ticks_per_second), why.began);
  text += Tree("  ended at " + At(why.interval.end, ticks_per_second), why.ended);
  text += Tree("  counts", why.counted);
  const std::string decided =
      "  decided at " + At(why.decided, ticks_per_second) + ", " + Late(why, ticks_per_second);
  return text + (why.waited.empty() ? decided + "\n" : Tree(decided, why.waited));
}

std::string Text(const WhyMissing& why, Tick ticks_per_second) {
  std::string text = why.event + " did not happen";
  if (why.expected_at) text += " at " + At(*why.expected_at, ticks_per_second);
  text += why.because.empty() ? "\n" : "\n  because " + why.because + "\n";
  text += Tree("", why.reasons);
  for (const WhyEvent& other : why.nearest) {
    text +=
        fmt::format("  it happened {}\n", truth::IntervalText(other.interval, ticks_per_second));
  }
  return text;
}

std::string Table(const std::vector<WhyEvent>& events, Tick ticks_per_second) {
  std::vector<std::vector<std::string>> rows = {
      {"event", "begin_s", "end_s", "began", "ended", "decided"}};
  for (const WhyEvent& why : events) {
    rows.push_back({why.event, truth::SecondsText(why.interval.begin, ticks_per_second),
                    truth::SecondsText(why.interval.end, ticks_per_second), InOneLine(why.began),
                    InOneLine(why.ended), Late(why, ticks_per_second)});
  }
  std::string text;
  for (const std::string& line : truth::AlignColumns(rows)) text += line + "\n";
  return text;
}

}  // namespace prehend::show
