// SPDX-License-Identifier: Apache-2.0
// See harness/report/report.h. Tested by tests/harness/report/report_test.cc
#include "harness/report/report.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "harness/base/markup.h"
#include "harness/golden/timeline_svg.h"

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
                               {"", false, FillReason},
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
    const pugi::xml_node row = AddElement(table, "tr");
    for (const Column& column : kColumns) column.fill(AddCell(row, "td", column), verdict);
    AddText(table, kNewLine);
  }
}

void AddPicture(pugi::xml_node section, const ReportedPicture& picture) {
  const pugi::xml_node figure = AddElement(section, "figure");
  AddElement(figure, "img", {{"loading", "lazy"}, {"src", picture.file}, {"alt", picture.caption}});
  AddElement(figure, "figcaption", {}, picture.caption);
}

void AddSection(pugi::xml_node body, const ScenarioVerdict& verdict) {
  const std::string name(Name(verdict.verdict));
  const pugi::xml_node section = AddElement(body, "section", {{"id", verdict.scenario}});
  const pugi::xml_node title = AddElement(section, "h2");
  AddElement(title, "span", {{"class", name}}, name);
  AddText(title, " " + verdict.scenario);
  AddElement(section, "div", {{"class", "soft"}}, verdict.shows);
  if (!verdict.reason.empty()) AddElement(section, "p", {{"class", name}}, verdict.reason);
  if (!verdict.details.empty()) AddElement(section, "pre", {}, verdict.details);
  if (verdict.comparison)
    AddMarkup(section, TimelineSvg(*verdict.comparison, verdict.ticks + 1, verdict.drawings));
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) AddElement(section, "div", {{"class", "soft"}}, margin);
  for (const ReportedPicture& picture : verdict.pictures) AddPicture(section, picture);
  AddElement(section, "pre", {}, verdict.command);
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

}  // namespace

std::string ReportHtml(const std::vector<ScenarioVerdict>& verdicts) {
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  const pugi::xml_node html = AddElement(document, "html", {{"lang", "en"}});
  AddHead(html);
  const pugi::xml_node body = AddElement(html, "body");
  AddElement(body, "h1", {}, "Regression suite");
  AddSummary(body, Count(verdicts));
  AddElement(body, "p", {{"class", "soft"}},
             "In every row, the golden is above (pale) and the recognised event below.");
  AddTable(body, verdicts);
  AddText(body, kNewLine);
  for (const ScenarioVerdict& verdict : verdicts) AddSection(body, verdict);
  return ToText(document, Layout::kAsItIs) + "\n";
}

}  // namespace prehend::harness
