// SPDX-License-Identifier: Apache-2.0
// See report.h. Tested by tests/harness/report_test.cc
#include "harness/report.h"

#include <fmt/format.h>

#include "harness/phases.h"
#include "harness/timeline_svg.h"

namespace prehend::harness {
namespace {

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
.legend span { display: inline-block; margin-right: 1rem; } .legend i { display: inline-block; width: .8em; height: .8em;
  border-radius: 2px; margin-right: .35em; }
)";

std::string SummaryText(const Tally& tally) {
  std::string text =
      fmt::format("<span class=\"passed\">{} passed</span>, <span class=\"{}\">{} failed</span>",
                  tally.passed, tally.failed > 0 ? "failed" : "soft", tally.failed);
  if (tally.pending > 0)
    text += fmt::format(", <span class=\"pending\">{} pending</span>", tally.pending);
  if (tally.unchanged > 0)
    text += fmt::format(", <span class=\"unchanged\">{} unchanged</span>", tally.unchanged);
  return text;
}

std::string Legend() {
  std::string legend = "<p class=\"legend soft\">";
  for (const Phase& phase : kPhases) {
    legend += fmt::format("<span><i style=\"background:#{:06x}\"></i>{}</span>", phase.color,
                          phase.event);
  }
  return legend + "<br>In every row the golden is above (pale), what was recognised below.</p>\n";
}

std::string TableRow(const ScenarioVerdict& verdict) {
  return fmt::format(
      "<tr><td class=\"verdict {0}\">{0}</td><td><a href=\"#{1}\">{1}</a><br><span "
      "class=\"soft\">{2}</span></td>"
      "<td>{3}</td><td class=\"number\">{4:.2f} s</td></tr>\n",
      Name(verdict.verdict), EscapeHtml(verdict.scenario), EscapeHtml(verdict.shows),
      EscapeHtml(verdict.reason.empty() ? MarginText(verdict) : verdict.reason), verdict.seconds);
}

std::string Section(const ScenarioVerdict& verdict) {
  std::string html = fmt::format(
      "<section id=\"{0}\">\n<h2><span class=\"{1}\">{1}</span> {0}</h2>\n<div "
      "class=\"soft\">{2}</div>\n",
      EscapeHtml(verdict.scenario), Name(verdict.verdict), EscapeHtml(verdict.shows));
  if (!verdict.reason.empty())
    html +=
        fmt::format("<p class=\"{}\">{}</p>\n", Name(verdict.verdict), EscapeHtml(verdict.reason));
  if (!verdict.details.empty()) html += fmt::format("<pre>{}</pre>\n", EscapeHtml(verdict.details));
  if (verdict.comparison) html += TimelineSvg(*verdict.comparison, verdict.ticks + 1);
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) html += fmt::format("<div class=\"soft\">{}</div>\n", EscapeHtml(margin));
  for (const ReportedPicture& picture : verdict.pictures) {
    html += fmt::format(
        "<figure><img loading=\"lazy\" src=\"{}\" "
        "alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
        EscapeHtml(picture.file), EscapeHtml(picture.caption), EscapeHtml(picture.caption));
  }
  return html + fmt::format("<pre>{}</pre>\n</section>\n", EscapeHtml(verdict.command));
}

}  // namespace

std::string ReportHtml(const std::vector<ScenarioVerdict>& verdicts) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>prehend: "
      "regression suite</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<h1>Regression suite</h1>\n<p "
      "class=\"verdict\">{}</p>\n{}",
      kStyle, SummaryText(Count(verdicts)), Legend());
  html +=
      "<table>\n<tr><th>verdict</th><th>scenario</th><th></th><th "
      "class=\"number\">time</th></tr>\n";
  for (const ScenarioVerdict& verdict : verdicts) html += TableRow(verdict);
  html += "</table>\n";
  for (const ScenarioVerdict& verdict : verdicts) html += Section(verdict);
  return html + "</body>\n</html>\n";
}

}  // namespace prehend::harness
