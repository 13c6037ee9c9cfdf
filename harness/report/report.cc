// SPDX-License-Identifier: Apache-2.0
// See harness/report/report.h. Tested by tests/harness/report/report_test.cc
#include "harness/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <tuple>

#include "harness/base/markup.h"
#include "harness/check/causes.h"
#include "harness/golden/timeline_svg.h"
#include "harness/report/page_script.h"

namespace prehend::harness {
namespace {

// Without <, > and &, which HTML would not unescape here.
constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --ink: #1d2329; --soft: #66707a; --line: #d9dee3; --paper: #fbfbfa; --card: #ffffff;
  --passed: #1f7a3d; --failed: #b3261e; --pending: #9a6700; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e8ea; --soft: #9aa4ae; --line: #363d45; --paper: #15181b;
  --card: #1d2125; --passed: #5cc27f; --failed: #f2837b; --pending: #e0b354; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 1100px;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin: 0; }
a { color: inherit; } .soft { color: var(--soft); }
table { border-collapse: collapse; width: 100%; margin: 1rem 0 2rem; }
td, th { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.number, th.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.passed { color: var(--passed); } .failed { color: var(--failed); } .pending { color: var(--pending); }
.flaky { color: var(--failed); } .unchanged { color: var(--passed); }
.verdict { font-weight: 600; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 1rem 1.2rem; margin: 1rem 0; }
pre { background: var(--paper); border: 1px solid var(--line); border-radius: 6px; padding: .6rem .8rem; overflow-x: auto;
  font-size: 13px; }
svg.timeline { width: 100%; height: auto; margin-top: .6rem; } svg text { font: 12px system-ui, sans-serif; fill: var(--ink); }
svg text.axis { fill: var(--soft); font-size: 11px; } svg text.differs { fill: var(--failed); font-weight: 600; }
svg .grid { stroke: var(--line); } svg rect { rx: 2px; } svg rect.golden { opacity: .45; }
svg rect.differs { stroke: var(--failed); stroke-width: 1.5; }
svg rect.differs.golden { stroke-dasharray: 4 2; } svg line.cursor { stroke: var(--ink); stroke-width: 1; pointer-events: none; }
.scroll { overflow-x: auto; } .scroll svg.timeline { min-width: 640px; } output { color: var(--soft); font-size: 13px; }
#tools { position: sticky; top: 0; background: var(--paper); padding: .5rem 0; display: flex; flex-wrap: wrap; gap: .4rem; z-index: 1; }
#tools[hidden] { display: none; } #tools input { font: inherit; flex: 1 1 12rem; min-width: 8rem; }
button.chip { font: inherit; border: 1px solid var(--line); border-radius: 1rem; background: var(--card); color: var(--ink); padding: 0 .8rem; }
button.chip[aria-pressed=true] { background: var(--ink); color: var(--paper); }
summary { cursor: pointer; } summary h2 { display: inline; } section.scenario { scroll-margin-top: 3.5rem; }
h2, td, p, li { overflow-wrap: anywhere; } ol.causes li { margin-bottom: .6rem; } code { font-size: 13px; }
@media (max-width: 600px) { td:nth-child(4), th:nth-child(4) { display: none; } section { padding: .7rem; } }
@media print { #tools { display: none; } section { break-inside: avoid; } }
figure { margin: .8rem 0 0; } figure img { max-width: 100%; border-radius: 6px; } figcaption { color: var(--soft); }
)";

constexpr const char* kNewLine = "\n";  // between blocks, where a browser shows none

void AddSummary(pugi::xml_node body, const Tally& tally) {
  const pugi::xml_node line = AddElement(body, "p", {{"class", "verdict"}});
  const auto add = [&](int count, const char* verdict, const std::string& style) {
    AddElement(line, "span", {{"class", style}}, fmt::format("{} {}", count, verdict));
  };
  add(tally.passed, "passed", "passed");
  AddText(line, ", ");
  add(tally.failed, "failed", tally.failed > 0 ? "failed" : "soft");
  if (tally.pending > 0) {
    AddText(line, ", ");
    add(tally.pending, "pending", "pending");
  }
  if (tally.unchanged > 0) {
    AddText(line, ", ");
    add(tally.unchanged, "unchanged", "unchanged");
  }
}

/// One column of the table of all scenarios.
struct Column {
  const char* title;
  bool is_number;
  void (*fill)(pugi::xml_node cell, const ScenarioVerdict& verdict);
};

void FillVerdict(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  const std::string name(Name(verdict.verdict));
  AddElement(cell, "span", {{"class", "verdict " + name}}, name);
}

void FillScenario(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  AddElement(cell, "a", {{"href", "#" + verdict.scenario}}, verdict.scenario);
  AddElement(cell, "br");
  AddElement(cell, "span", {{"class", "soft"}}, verdict.shows);
}

void FillReason(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  AddText(cell, verdict.reason.empty() ? MarginText(verdict) : verdict.reason);
}

void FillTime(pugi::xml_node cell, const ScenarioVerdict& verdict) {
  AddText(cell, fmt::format("{:.2f} s", verdict.seconds));
}

/// From left to right.
constexpr Column kColumns[] = {{"verdict", false, FillVerdict},
                               {"scenario", false, FillScenario},
                               {"result", false, FillReason},
                               {"time", true, FillTime}};

pugi::xml_node AddCell(pugi::xml_node row, const char* kind, const Column& column) {
  return column.is_number ? AddElement(row, kind, {{"class", "number"}}) : AddElement(row, kind);
}

void AddTable(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts) {
  const pugi::xml_node table = AddElement(body, "table");
  const pugi::xml_node head = AddElement(table, "tr");
  for (const Column& column : kColumns) AddText(AddCell(head, "th", column), column.title);
  AddText(table, kNewLine);
  for (const ScenarioVerdict& verdict : verdicts) {
    const pugi::xml_node row = AddElement(table, "tr", {{"data-of", verdict.scenario}});
    for (const Column& column : kColumns) column.fill(AddCell(row, "td", column), verdict);
    AddText(table, kNewLine);
  }
}

std::string Base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63u];
  }
  return text;
}

/// Puts pictures into the page as long as there is room.
class PictureBox {
 public:
  explicit PictureBox(std::string folder) : folder_(std::move(folder)) {}

  void Add(pugi::xml_node section, const ReportedPicture& picture) {
    const auto path = std::filesystem::path(folder_) / picture.file;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.empty() || used_ + bytes.size() > kMostPictureBytes) {
      AddElement(section, "p", {{"class", "soft"}},
                 "picture, not in this page: " + picture.file + " (" + picture.caption + ")");
      return;
    }
    used_ += bytes.size();
    const pugi::xml_node figure = AddElement(section, "figure");
    AddElement(figure, "img",
               {{"loading", "lazy"},
                {"src", "data:image/png;base64," + Base64(bytes)},
                {"alt", picture.caption}});
    AddElement(figure, "figcaption", {}, picture.caption);
  }

 private:
  std::string folder_;
  std::size_t used_ = 0;
};

void AddCommand(pugi::xml_node parent, const std::string& command) {
  AddElement(parent, "pre", {{"tabindex", "0"}}, command);
}

/// The causes of one scenario's differences as sentences.
void AddReasons(pugi::xml_node section, const ScenarioVerdict& verdict) {
  for (const Cause& cause : CausesOf({verdict})) {
    if (cause.because.empty()) continue;
    std::string effects;
    for (const Effect& effect : cause.effects)
      effects += (effects.empty() ? "" : ", ") + effect.event + " " + effect.what;
    AddElement(section, "p", {}, "Because of " + cause.because + ": " + effects + ".");
  }
}

bool IsGood(const ScenarioVerdict& verdict) {
  return verdict.verdict == Verdict::kPassed || verdict.verdict == Verdict::kUnchanged;
}

void AddSection(pugi::xml_node body, const ScenarioVerdict& verdict, PictureBox& pictures) {
  const std::string name(Name(verdict.verdict));
  const pugi::xml_node section = AddElement(
      body, "section", {{"id", verdict.scenario}, {"class", "scenario"}, {"data-verdict", name}});
  pugi::xml_node fold = AddElement(section, "details");
  if (!IsGood(verdict)) fold.append_attribute("open").set_value("open");
  const pugi::xml_node summary = AddElement(fold, "summary");
  const pugi::xml_node title = AddElement(summary, "h2");
  AddElement(title, "span", {{"class", name}}, name);
  AddText(title, " " + verdict.scenario);
  AddElement(fold, "div", {{"class", "soft"}}, verdict.shows);
  if (!verdict.reason.empty()) AddElement(fold, "p", {{"class", name}}, verdict.reason);
  AddReasons(fold, verdict);
  if (verdict.comparison) {
    const pugi::xml_node scroll = AddElement(fold, "div",
                                             {{"class", "scroll"},
                                              {"tabindex", "0"},
                                              {"role", "group"},
                                              {"aria-label", "timeline of " + verdict.scenario}});
    AddMarkup(scroll, TimelineSvg(*verdict.comparison, verdict.ticks + 1, verdict.drawings));
    AddElement(scroll, "output", {}, "");
  }
  if (!verdict.details.empty()) AddElement(fold, "pre", {{"tabindex", "0"}}, verdict.details);
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) AddElement(fold, "div", {{"class", "soft"}}, margin);
  for (const ReportedPicture& picture : verdict.pictures) pictures.Add(fold, picture);
  AddCommand(fold, verdict.command);
  AddText(body, kNewLine);
}

void AddHead(pugi::xml_node html) {
  const pugi::xml_node head = AddElement(html, "head");
  AddElement(head, "meta", {{"charset", "utf-8"}});
  AddElement(head, "meta",
             {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  AddElement(head, "title", {}, "prehend: regression suite");
  AddElement(head, "style", {}, kStyle);
}

void AddCauses(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts) {
  const std::vector<Cause> causes = CausesOf(verdicts);
  const std::vector<Brittle> brittle = BrittlePasses(verdicts);
  if (!causes.empty()) {
    AddElement(body, "h2", {}, "Causes");
    const pugi::xml_node list = AddElement(body, "ol", {{"class", "causes"}});
    for (const Cause& cause : causes) {
      const pugi::xml_node item = AddElement(list, "li");
      AddElement(item, "strong", {},
                 cause.because.empty() ? "nothing known has changed" : cause.because);
      AddText(item, fmt::format(": {} scenario{}, for example ", cause.scenarios.size(),
                                cause.scenarios.size() == 1 ? "" : "s"));
      AddElement(item, "a", {{"href", "#" + cause.scenarios.front()}}, cause.scenarios.front());
      for (const Effect& effect : cause.effects) AddElement(item, "div", {}, EffectText(effect));
      AddElement(item, "code", {}, cause.effects.front().command);
    }
  }
  if (brittle.empty()) return;
  const pugi::xml_node fold = AddElement(body, "details");
  AddElement(fold, "summary", {}, "Passed at the limit of a tolerance");
  AddElement(fold, "pre", {{"tabindex", "0"}}, BrittleText(brittle));
}

void AddTools(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts) {
  const pugi::xml_node tools = AddElement(body, "div", {{"id", "tools"}, {"hidden", "hidden"}});
  AddElement(tools, "input",
             {{"id", "search"},
              {"type", "search"},
              {"placeholder", "search (/), next (n), previous (p)"},
              {"aria-label", "search scenarios"}});
  for (const Verdict each : {Verdict::kFailed, Verdict::kFlaky, Verdict::kPending, Verdict::kPassed,
                             Verdict::kUnchanged}) {
    const std::string name(Name(each));
    if (std::ranges::none_of(verdicts, [&](const auto& of) { return of.verdict == each; }))
      continue;
    AddElement(
        tools, "button",
        {{"class", "chip"}, {"type", "button"}, {"data-verdict", name}, {"aria-pressed", "false"}},
        name);
  }
  AddElement(tools, "span", {{"id", "shown"}, {"role", "status"}, {"class", "soft"}}, "");
}

void AddHeader(pugi::xml_node body, const std::vector<ScenarioVerdict>& verdicts,
               const ReportHeader& header) {
  AddElement(body, "p", {{"class", "soft"}},
             fmt::format("{}, {}, by {}", header.date, header.program, header.command));
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

/// What needs a person first; in one kind, as they were.
std::vector<ScenarioVerdict> WorstFirst(std::vector<ScenarioVerdict> verdicts) {
  const auto rank = [](const ScenarioVerdict& verdict) {
    switch (verdict.verdict) {
      case Verdict::kFailed:
        return 0;
      case Verdict::kFlaky:
        return 1;
      case Verdict::kPending:
        return 2;
      default:
        return 3;
    }
  };
  std::ranges::stable_sort(verdicts, {}, rank);
  return verdicts;
}

}  // namespace

std::string ReportHtml(const std::vector<ScenarioVerdict>& unsorted, const ReportHeader& header) {
  const std::vector<ScenarioVerdict> verdicts = WorstFirst(unsorted);
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  const pugi::xml_node html = AddElement(document, "html", {{"lang", "en"}});
  AddHead(html);
  const pugi::xml_node body = AddElement(AddElement(html, "body"), "main");
  AddElement(body, "h1", {}, "Regression suite");
  AddSummary(body, Count(verdicts));
  AddHeader(body, verdicts, header);
  AddCauses(body, verdicts);
  AddTools(body, verdicts);
  AddTable(body, verdicts);
  AddText(body, kNewLine);
  AddElement(body, "p", {{"class", "soft"}},
             "In every row of a timeline, the golden is above (pale) and the recognised event "
             "below.");
  PictureBox pictures(header.folder);
  for (const ScenarioVerdict& verdict : verdicts) AddSection(body, verdict, pictures);
  AddElement(body, "script", {}, kPageScript);
  return ToText(document, Layout::kAsItIs) + "\n";
}

}  // namespace prehend::harness
