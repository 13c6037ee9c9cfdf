// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/report/explanations.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/base/base/markup.h"
#include "harness/suite/report/charts.h"

namespace prehend::suite {
namespace {

/// JSON without the characters that HTML would not unescape in a script.
std::string ScriptText(const nlohmann::json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&')
      text += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      text += c;
  }
  return text;
}

nlohmann::json BoundariesJson(const Explained& explained, grammar::Tick ticks_per_second) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(ticks_per_second);
  };
  nlohmann::json list = nlohmann::json::array();
  for (const ExplainedEvent& event : explained.events)
    list.push_back({{"event", event.event},
                    {"begin", seconds(event.begin)},
                    {"end", seconds(event.end)},
                    {"began", event.began},
                    {"ended", event.ended}});
  return list;
}

}  // namespace

void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second) {
  if (!explained.events.empty()) {
    AddElement(section, "div", {{"class", "turned"}, {"role", "status"}}, "");
    AddElement(section, "script", {{"type", "application/json"}, {"class", "boundaries"}},
               ScriptText(BoundariesJson(explained, ticks_per_second)));
  }
  for (const ExplainedDifference& difference : explained.differences) {
    pugi::xml_node fold = AddElement(section, "details", {{"class", "difference"}});
    if (&difference == &explained.differences.front())
      fold.append_attribute("open").set_value("open");
    AddElement(fold, "summary", {}, "Why: " + difference.what);
    const pugi::xml_node plots = AddElement(fold, "div", {{"class", "signals"}});
    for (const DecidingSignal& signal : difference.signals) {
      const pugi::xml_node figure = AddElement(plots, "figure");
      AddMarkup(figure, SignalSvg(signal, ticks_per_second));
      AddElement(figure, "figcaption", {}, signal.clause);
    }
    if (difference.signals.empty()) fold.remove_child(plots);
    AddElement(fold, "pre", {{"tabindex", "0"}}, difference.text);
  }
}

}  // namespace prehend::suite
