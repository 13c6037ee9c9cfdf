// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

#include "harness/base/base/quoting.h"
#include "harness/suite/check/causes.h"

namespace prehend::suite {
namespace {

// Where style and scripts go: HTML does not unescape what is in them.
constexpr std::string_view kStylePlace = "@style@", kScriptPlace = "@script@";

constexpr std::size_t kMostEffects = 6;  // of a cause

constexpr const char* kNewLine = "\n";  // between blocks, where a browser shows none

/// A take neither passes nor fails: it agrees with its labels or differs from them.
std::string WordOf(Verdict verdict, const Sides& sides) {
  if (!sides.empty() && verdict == Verdict::kPassed) return "agrees";
  return !sides.empty() && verdict == Verdict::kFailed ? "differs" : std::string(Name(verdict));
}

void AddSummary(pugi::xml_node body, const Tally& tally, const Sides& sides) {
  const pugi::xml_node line = AddElement(body, "p", {{"class", "verdict"}});
  const auto add = [&](int count, const char* verdict, const std::string& style) {
    AddElement(line, "span", {{"class", style}}, fmt::format("{} {}", count, verdict));
  };
  add(tally.passed, sides.empty() ? "passed" : "agree", "passed");
  AddText(line, ", ");
  add(tally.failed, sides.empty() ? "failed" : "differ", tally.failed > 0 ? "failed" : "soft");
  for (const auto& [count, name] :
       {std::pair{tally.pending, "pending"}, {tally.unchanged, "unchanged"}}) {
    if (count > 0) AddText(line, ", ");
    if (count > 0) add(count, name, name);
  }
  const pugi::xml_node bar =
      AddElement(body, "div", {{"class", "glance"}, {"aria-hidden", "true"}});
  for (const auto& [count, name] : {std::pair{tally.failed, "failed"},
                                    {tally.pending, "pending"},
                                    {tally.unchanged, "unchanged"},
                                    {tally.passed, "passed"}})
    if (count > 0)
      AddElement(bar, "span", {{"class", name}, {"style", fmt::format("flex-grow:{}", count)}}, "");
}

/// One column of the table of all scenarios.
struct Column {
  const char* title;
  bool is_number;
  void (*fill)(pugi::xml_node cell, const ScenarioVerdict& verdict);
};

void FillScenario(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  const std::string name(Name(verdict.verdict));
  AddElement(cell, "span", {{"class", "verdict " + name}}, name);
  AddElement(cell, "a", {{"href", "#" + verdict.scenario}}, verdict.scenario);
}

/// What the pictures of a moment that differs show.
std::string DrawnDifferenceText(const DrawnDifference& moment) {
  constexpr const char* kPaths = "; the paths show what hands do by the golden, and by this run";
  if (!moment.in_run)
    return "Where " + moment.what + " should begin, which was not recognised" + kPaths;
  if (!moment.in_golden)
    return "Where " + moment.what + " begins, which is not in the golden" + kPaths;
  return "The scene at the differing " + moment.what +
         ": when it should be, when it was recognised, and what moved in between";
}

/// The script of the page draws them.
void FillEvents(pugi::xml_node cell, const ScenarioVerdict&) {
  cell.append_attribute("class").set_value("mini");
}

void FillTime(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  AddText(cell, fmt::format("{:.1f} s", verdict.seconds));
}

/// From left to right.
constexpr Column kColumns[] = {
    {"scenario", false, FillScenario}, {"events", false, FillEvents}, {"time", true, FillTime}};

pugi::xml_node AddCell(pugi::xml_node row, const char* kind, const Column& column) {
  return column.is_number ? AddElement(row, kind, {{"class", "number"}}) : AddElement(row, kind);
}

void AddTable(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts,
              const std::vector<Cause>& causes) {
  const pugi::xml_node table = AddElement(body, "table");
  const pugi::xml_node head = AddElement(table, "tr");
  for (const Column& column : kColumns) AddText(AddCell(head, "th", column), column.title);
  AddText(table, kNewLine);
  for (const ScenarioVerdict& verdict : verdicts) {
    std::string numbers;
    for (std::size_t i = 0; i < causes.size(); ++i)
      if (std::ranges::binary_search(causes[i].scenarios, verdict.scenario))
        numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", i + 1);
    const pugi::xml_node row = AddElement(table, "tr",
                                          {{"data-of", verdict.scenario},
                                           {"data-verdict", std::string(Name(verdict.verdict))},
                                           {"data-causes", numbers}});
    for (const Column& column : kColumns) column.fill(AddCell(row, "td", column), verdict);
    AddText(table, kNewLine);
  }
}

/// Puts pictures into the page as long as there is room.
class PictureBox {
 public:
  explicit PictureBox(std::string folder) : folder_(std::move(folder)) {}

  void Add(pugi::xml_node section, const ReportedPicture& picture) {
    const auto path = std::filesystem::path(folder_) / picture.file;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::string text = Base64(bytes);
    if (bytes.empty() || used_ + text.size() > kMostPictureBytes) {
      AddElement(section, "p", {{"class", "soft"}},
                 "picture, not in this page: " + picture.file + " (" + picture.caption + ")");
      return;
    }
    used_ += text.size();
    const pugi::xml_node figure = AddElement(section, "figure");
    AddElement(
        figure, "img",
        {{"loading", "lazy"}, {"src", "data:image/png;base64," + text}, {"alt", picture.caption}});
    AddElement(figure, "figcaption", {}, picture.caption);
  }

 private:
  std::string folder_;
  std::size_t used_ = 0;
};

/// Puts replays into the page as long as there is room.
class ReplayBox {
 public:
  void Add(pugi::xml_node section, const std::string& data) {
    if (data.empty() || ReplayBundle().empty()) return;
    if (used_ + data.size() > kMostReplayBytes) {
      AddElement(section, "p", {{"class", "soft"}},
                 "The 3D replay is not in this page, which would grow too large: check this "
                 "scenario alone.");
      return;
    }
    used_ += data.size();
    AddElement(section, "div", {{"class", "replay"}}, "");
    AddElement(section, "script", {{"type", "text/plain"}, {"class", "replay-data"}}, data);
  }
  bool any() const { return used_ > 0; }

 private:
  std::size_t used_ = 0;
};

void AddCommand(pugi::xml_node parent, const std::string& command) {
  AddElement(parent, "pre", {{"class", "command"}, {"tabindex", "0"}}, command);
}

/// What stands between backticks as code.
void AddSentence(pugi::xml_node parent, std::string_view text) {
  for (bool code = false; !text.empty(); code = !code) {
    std::size_t end = text.find('`');
    // A backtick without partner is one.
    if (!code && end != std::string_view::npos && text.find('`', end + 1) == std::string_view::npos)
      end = std::string_view::npos;
    const std::string_view part = text.substr(0, end);
    if (code)
      AddElement(parent, "code", {}, part);
    else
      AddText(parent, part);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

/// With an arrow that reads as one.
std::string WithArrows(std::string text) {
  constexpr std::string_view kArrow = " -> ";
  for (std::size_t at = text.find(kArrow); at != std::string::npos; at = text.find(kArrow, at + 1))
    text.replace(at, kArrow.size(), " \u2192 ");
  return text;
}

/// The causes of one scenario's differences as sentences.
void AddReasons(pugi::xml_node section, const ScenarioVerdict& verdict) {
  for (const Cause& cause : CausesOf({verdict})) {
    if (cause.because.empty()) continue;
    std::string effects;
    for (const Effect& effect : cause.effects)
      effects += (effects.empty() ? "" : "; ") + EffectText(effect);
    const pugi::xml_node sentence = AddElement(section, "p", {{"class", "because"}});
    AddText(sentence, "Because of ");
    AddSentence(AddElement(sentence, "strong"), WithArrows(cause.because));
    AddText(sentence, ": " + effects + ".");
  }
}

bool IsGood(const ScenarioVerdict& verdict) {
  return verdict.verdict == Verdict::kPassed || verdict.verdict == Verdict::kUnchanged;
}

/// What the lanes of each row are, from above.
void AddLegend(pugi::xml_node parent, const Sides& sides) {
  const pugi::xml_node line = AddElement(parent, "p", {{"class", "soft sides"}});
  AddText(line, "From above: ");
  for (std::size_t i = 0; i < sides.size(); ++i) {
    AddText(line, fmt::format("{} ", i + 1));
    AddElement(line, "span", {}, sides[i]);
    AddText(line, ", ");
  }
  AddText(line, "and where they differ.");
}

void AddTime(pugi::xml_node views, const ScenarioVerdict& verdict, const Sides& sides) {
  const pugi::xml_node time = AddElement(views, "div", {{"class", "time"}});
  if (!sides.empty()) AddLegend(time, sides);
  const pugi::xml_node scroll = AddElement(time, "div",
                                           {{"class", "scroll"},
                                            {"tabindex", "0"},
                                            {"role", "group"},
                                            {"aria-label", "timeline of " + verdict.scenario}});
  std::vector<truth::Comparison> comparisons = {*verdict.comparison};
  comparisons.insert(comparisons.end(), verdict.labelled.others.begin(),
                     verdict.labelled.others.end());
  AddMarkup(scroll, TimelineSvg(comparisons, sides, verdict.ticks + 1, verdict.drawings,
                                verdict.has_golden, verdict.steps));
  AddElement(time, "output", {}, "");
  if (verdict.labelled.moments.empty()) return;
  const pugi::xml_node moments = AddElement(time, "p", {{"class", "soft moments"}});
  AddText(moments, "Labels of a moment:");
  for (const auto& [seconds, event] : verdict.labelled.moments) {
    AddText(moments, " ");
    AddElement(moments, "span",
               {{"data-at", fmt::format("{}", seconds)}, {"data-event", WithRoles(event)}},
               fmt::format("{} {:.2f} s", event.Label(), seconds));
  }
}

/// Shown by the script, at the cursor. It is not copied into the page.
void AddFilm(pugi::xml_node views, const ScenarioVerdict& verdict) {
  if (verdict.labelled.video.empty()) return;
  AddElement(AddElement(views, "div", {{"class", "film"}}), "video",
             {{"src", verdict.labelled.video},
              {"data-offset", fmt::format("{}", verdict.labelled.offset_s)},
              {"controls", "controls"},
              {"muted", "muted"},
              {"preload", "none"},
              {"aria-label", "video of " + verdict.scenario}},
             "");
}

/// `open`: nothing has to be clicked to read it.
void AddSection(pugi::xml_node body, const ScenarioVerdict& verdict, const Sides& sides, bool open,
                PictureBox& pictures, ReplayBox& replays) {
  const std::string name(Name(verdict.verdict));
  const pugi::xml_node section = AddElement(
      body, "section", {{"id", verdict.scenario}, {"class", "scenario"}, {"data-verdict", name}});
  pugi::xml_node fold = AddElement(section, "details");
  if (open) fold.append_attribute("open").set_value("open");
  const pugi::xml_node summary = AddElement(fold, "summary");
  const pugi::xml_node title = AddElement(summary, "h2");
  AddElement(title, "span", {{"class", name}}, WordOf(verdict.verdict, sides));
  AddText(title, " " + verdict.scenario);
  AddElement(fold, "div", {{"class", "soft"}}, verdict.shows);
  if (!verdict.reason.empty()) AddElement(fold, "p", {{"class", name}}, verdict.reason);
  for (const std::string& note : verdict.notes)
    AddElement(fold, "p", {{"class", "soft note"}}, note);
  if (sides.empty()) AddReasons(fold, verdict);
  const pugi::xml_node views = AddElement(fold, "div", {{"class", "views"}});
  if (verdict.comparison) AddTime(views, verdict, sides);
  AddFilm(views, verdict);
  replays.Add(views, verdict.replay);
  if (verdict.comparison &&
      !(verdict.explained.events.empty() && verdict.explained.differences.empty()))
    AddExplanations(AddElement(views, "div", {{"class", "why"}}), verdict.explained,
                    verdict.comparison->ticks_per_second);
  for (const DrawnDifference& moment : verdict.drawn_differences) {
    const pugi::xml_node pair = AddElement(fold, "div", {{"class", "drawn-difference"}});
    AddElement(pair, "p", {}, DrawnDifferenceText(moment));
    pictures.Add(pair, moment.expected);
    pictures.Add(pair, moment.recognised);
  }
  if (const std::string text = DetailsText(verdict); !text.empty()) {
    // Where it is explained above, it does not have to be read first.
    pugi::xml_node details = AddElement(fold, "details");
    if (verdict.explained.differences.empty()) details.append_attribute("open").set_value("open");
    AddElement(details, "summary", {}, "Everything that was found, as text");
    AddElement(details, "pre", {{"tabindex", "0"}}, text);
  }
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) AddElement(fold, "div", {{"class", "soft"}}, margin);
  for (const ReportedPicture& picture : verdict.pictures) pictures.Add(fold, picture);
  AddCommand(fold, verdict.command);
  AddText(body, kNewLine);
}

void AddHead(pugi::xml_node html, const std::string& title) {
  const pugi::xml_node head = AddElement(html, "head");
  AddElement(head, "meta", {{"charset", "utf-8"}});
  AddElement(head, "meta",
             {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  AddElement(head, "title", {}, "prehend: " + title);
  AddElement(head, "style", {}, kStylePlace);
}

/// Where shifts lie, from the least to the most, with their median; all of a cause in one scale.
void AddShifts(pugi::xml_node parent, const Effect& effect, double most_ms) {
  if (effect.count < 2 || effect.median_ms == 0) return;
  const auto x = [&](double shift_ms) {
    return fmt::format("{:.1f}", 60 + 58 * shift_ms / most_ms);
  };
  const pugi::xml_node svg = AddElement(
      parent, "svg", {{"class", "shifts"}, {"viewBox", "0 0 120 12"}, {"aria-hidden", "true"}});
  const auto line = [&](const char* style, const std::string& from, const std::string& to, int top,
                        int bottom) {
    AddElement(svg, "line",
               {{"class", style},
                {"x1", from},
                {"x2", to},
                {"y1", std::to_string(top)},
                {"y2", std::to_string(bottom)}});
  };
  line("grid", "60", "60", 0, 12);
  line("range", x(effect.least_ms), x(effect.most_ms), 6, 6);
  line("median", x(effect.median_ms), x(effect.median_ms), 2, 10);
}

/// Of agreement: wide tables scroll by themselves.
void AddTables(pugi::xml_node body, const ReportHeader& header) {
  const pugi::xml_node tables = AddElement(body, "div", {{"class", "tables"}});
  for (const ReportTable& one : header.tables) {
    const pugi::xml_node place = AddElement(
        tables, "div", {{"tabindex", "0"}, {"role", "group"}, {"aria-label", one.title}});
    const pugi::xml_node table = AddElement(place, "table", {{"class", "figures"}});
    AddElement(table, "caption", {}, one.title);
    for (const auto& row : one.rows) {
      const pugi::xml_node line = AddElement(table, "tr");
      for (std::size_t i = 0; i < row.size(); ++i)
        AddElement(line, i == 0 || &row == &one.rows.front() ? "th" : "td", {}, row[i]);
    }
  }
  const pugi::xml_node fold = AddElement(body, "details");
  AddElement(fold, "summary", {}, "All figures, as score prints them");
  AddElement(fold, "pre", {{"tabindex", "0"}}, header.scores);
}

void AddCauses(pugi::xml_node body, const std::vector<Cause>& causes,
               const std::vector<NearLimitPass>& near_limit, const Sides& sides) {
  if (!causes.empty()) {
    const bool is_one = causes.size() == 1;
    AddElement(body, "h2", {},
               !sides.empty() ? std::string("Where they differ")
                              : fmt::format("{} cause{}", causes.size(), is_one ? "" : "s"));
    const pugi::xml_node list = AddElement(body, "ol", {{"class", "causes"}});
    for (std::size_t i = 0; i < causes.size(); ++i) {
      const Cause& cause = causes[i];
      const pugi::xml_node item = AddElement(list, "li");
      const std::size_t count = cause.scenarios.size();
      AddElement(item, "button",
                 {{"class", "chip cause"},
                  {"type", "button"},
                  {"data-cause", std::to_string(i + 1)},
                  {"aria-pressed", "false"}},
                 fmt::format("{} {}{}", count, sides.empty() ? "scenario" : "take",
                             count == 1 ? "" : "s"));
      AddSentence(AddElement(item, "strong"), WithArrows(cause.Title()));
      double most_ms = 0;
      for (const Effect& effect : cause.effects)
        most_ms = std::max({most_ms, std::abs(effect.least_ms), std::abs(effect.most_ms)});
      for (std::size_t k = 0; k < std::min(kMostEffects, cause.effects.size()); ++k) {
        const Effect& effect = cause.effects[k];
        const pugi::xml_node text = AddElement(item, "div");
        AddText(text, fmt::format("{} x {}", effect.count, EffectText(effect)));
        AddShifts(text, effect, most_ms);
      }
      if (cause.effects.size() > kMostEffects)
        AddElement(item, "div", {},
                   fmt::format("and {} more", cause.effects.size() - kMostEffects));
      const pugi::xml_node example = AddElement(item, "div", {{"class", "soft"}});
      if (count > 1) AddText(example, "for example ");
      const Effect& shown = cause.effects.front();
      AddElement(example, "a", {{"href", "#" + shown.scenarios.front()}}, shown.scenarios.front());
      AddCommand(item, shown.command);
    }
  }
  if (near_limit.empty()) return;
  const pugi::xml_node fold = AddElement(body, "details");
  AddElement(fold, "summary", {}, "Passed at the limit of a tolerance");
  AddElement(fold, "pre", {{"tabindex", "0"}}, NearLimitText(near_limit));
}

/// Each with a link to its moment, in the replay, too.
void AddFailures(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts) {
  const Failures failures = FailuresOf(verdicts);
  if (failures.failed == 0) return;
  AddElement(
      body, "h2", {},
      fmt::format("{} of {} demonstrations failed", failures.failed, failures.demonstrations));
  AddElement(body, "p", {{"class", "soft"}},
             "What went wrong first, and when; a click shows the moment.");
  const pugi::xml_node list = AddElement(body, "ol", {{"class", "causes failures"}});
  for (const Failure& group : failures.groups) {
    const pugi::xml_node item = AddElement(list, "li");
    AddElement(item, "strong", {}, fmt::format("{}: {}", group.because, group.takes.size()));
    const pugi::xml_node takes = AddElement(item, "div");
    for (const FailedTake& take : group.takes) {
      AddElement(takes, "a", {{"href", fmt::format("#{}@{:.4f}s", take.scenario, take.at_s)}},
                 fmt::format("{} {:.2f} s", take.scenario, take.at_s));
      AddText(takes, " ");
    }
    if (!group.takes.front().command.empty())
      AddElement(item, "code", {}, group.takes.front().command);
  }
}

void AddTools(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts,
              const Sides& sides) {
  const pugi::xml_node tools = AddElement(body, "div", {{"id", "tools"}, {"hidden", "hidden"}});
  AddElement(tools, "input",
             {{"id", "search"},
              {"type", "search"},
              {"placeholder", "search (/)"},
              {"aria-label", "search scenarios"}});
  for (const Verdict each : {Verdict::kFailed, Verdict::kFlaky, Verdict::kPending, Verdict::kPassed,
                             Verdict::kUnchanged}) {
    const std::string name(Name(each));
    const auto count = std::ranges::count(verdicts, each, &ScenarioVerdict::verdict);
    if (count == 0) continue;
    AddElement(
        tools, "button",
        {{"class", "chip"}, {"type", "button"}, {"data-verdict", name}, {"aria-pressed", "false"}},
        fmt::format("{} {}", WordOf(each, sides), count));
  }
  const pugi::xml_node groups =
      AddElement(tools, "select", {{"id", "groups"}, {"aria-label", "how the list is grouped"}});
  for (const char* by : {"by verdict", "by folder", "by cause"})
    AddElement(groups, "option", {}, by);
  AddElement(tools, "span", {{"id", "shown"}, {"role", "status"}, {"class", "soft"}}, "");
}

void AddHeader(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts,
               const ReportHeader& header) {
  const pugi::xml_node made = AddElement(body, "p", {{"class", "soft"}});
  double seconds = 0;
  for (const ScenarioVerdict& verdict : verdicts) seconds += verdict.seconds;
  AddText(made, fmt::format("{}, {:.0f} s of work, by ", header.date, seconds));
  AddElement(made, "code", {}, header.command);
  if (!header.commit.empty()) AddText(made, ", of commit " + header.commit);
  if (!header.machine.empty()) AddText(made, ", on " + header.machine);
  Settings parameters;
  for (const ScenarioVerdict& verdict : verdicts) {
    for (const auto& [file, values] : verdict.settings) {
      if (file.ends_with(".grammar")) parameters[file] = values;
    }
  }
  const pugi::xml_node fold = AddElement(body, "details");
  AddElement(fold, "summary", {}, "Grammars with their parameters, slowest scenarios");
  for (const auto& [file, values] : parameters) {
    std::string text = file + "\n";
    for (const auto& [name, value] : values) text += "  " + name + " = " + value + "\n";
    AddElement(fold, "pre", {{"tabindex", "0"}}, text);
  }
  std::vector<const ScenarioVerdict*> slowest;
  for (const ScenarioVerdict& verdict : verdicts) slowest.push_back(&verdict);
  std::ranges::stable_sort(slowest, std::greater{}, &ScenarioVerdict::seconds);
  slowest.resize(std::min<std::size_t>(5, slowest.size()));
  for (const ScenarioVerdict* verdict : slowest)
    AddElement(fold, "div", {}, fmt::format("{:.2f} s  {}", verdict->seconds, verdict->scenario));
}

/// Episodes of the same scenario are numbered, as links go by names.
std::vector<ScenarioVerdict> WithOwnNames(std::vector<ScenarioVerdict> verdicts) {
  std::map<std::string, int> seen;
  for (ScenarioVerdict& verdict : verdicts) {
    const int number = ++seen[verdict.scenario];
    if (number > 1) verdict.scenario += fmt::format(" ({})", number);
  }
  return verdicts;
}

/// In the element whose only text is `place`.
void Put(std::string& page, std::string_view place, std::string_view text) {
  const std::size_t at = page.find(fmt::format(">{}</", place));
  if (at != std::string::npos) page.replace(at + 1, place.size(), text);
}

/// What needs a person first; in one kind, as they were.
std::vector<ScenarioVerdict> WorstFirst(std::vector<ScenarioVerdict> verdicts) {
  constexpr Verdict kWorst[] = {Verdict::kFailed, Verdict::kFlaky, Verdict::kPending};
  std::ranges::stable_sort(verdicts, {}, [&](const ScenarioVerdict& verdict) {
    return std::ranges::find(kWorst, verdict.verdict) - kWorst;
  });
  return verdicts;
}

}  // namespace

std::string ReportHtml(const std::vector<ScenarioVerdict>& unsorted, const ReportHeader& header) {
  const std::vector<ScenarioVerdict> verdicts = WithOwnNames(WorstFirst(unsorted));
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  const pugi::xml_node html = AddElement(document, "html", {{"lang", "en"}});
  AddHead(html, header.title);
  const pugi::xml_node body = AddElement(html, "body");
  const pugi::xml_node top = AddElement(body, "header");
  AddElement(top, "h1", {}, header.title);
  AddSummary(top, Count(verdicts), header.sides);
  AddHeader(top, verdicts, header);
  AddFailures(top, verdicts);
  const std::vector<Cause> causes = CausesOf(verdicts);
  const bool is_of_labels = !header.sides.empty();
  if (is_of_labels) AddTables(top, header);
  AddCauses(top, causes, is_of_labels ? std::vector<NearLimitPass>() : NearLimitPasses(verdicts),
            header.sides);
  const pugi::xml_node list =
      AddElement(body, "nav", {{"id", "list"}, {"aria-label", "scenarios"}, {"tabindex", "0"}});
  AddTools(list, verdicts, header.sides);
  AddTable(list, verdicts, causes);
  const pugi::xml_node sections = AddElement(body, "main");
  if (!WhyNoReplay().empty())
    AddElement(sections, "p", {{"class", "soft"}},
               fmt::format("3D replay was left out: {}.", WhyNoReplay()));
  PictureBox pictures(header.folder);
  ReplayBox replays;
  for (const ScenarioVerdict& verdict : verdicts) {
    const bool open = !IsGood(verdict) || verdicts.size() == 1;
    AddSection(sections, verdict, header.sides, open, pictures, replays);
  }
  const std::string rows =
      is_of_labels ? "d and D go to the next and the last difference, 1, 2, .. accept there what "
                     "one side says; what is accepted is saved as labels. "
                   : "In every row of a timeline, the golden is above (pale) and the recognised "
                     "event below; where they differ it is hatched. ";
  AddElement(sections, "p", {{"class", "soft"}},
             rows +
                 "A click moves the cursor; so do the arrows, and b and B to the next and the "
                 "last boundary; n and p choose the next and the previous scenario.");
  AddHistory(body, header.history);
  if (replays.any())
    AddElement(body, "script", {{"type", "text/plain"}, {"id", "replay-bundle"}}, ReplayBundle());
  AddElement(body, "script", {}, kScriptPlace);
  std::string text = ToText(document, Layout::kAsItIs) + "\n";
  Put(text, kStylePlace, PageStyle());
  Put(text, kScriptPlace, PageScript());
  return text;
}

}  // namespace prehend::suite
