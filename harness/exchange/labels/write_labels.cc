// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/write_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <vector>

#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

struct Tier {
  std::string event, name;
  std::vector<const grammar::NamedEvent*> events;  ///< by their begins, without overlaps
};

/// Sorted by name.
std::vector<Tier> TiersOf(const grammar::Timeline& timeline) {
  std::vector<Tier> tiers;
  for (const grammar::NamedEvent& event : timeline.events) {
    const std::string& hand = truth::RoleValue(event, "hand");
    const std::string name = hand.empty() ? event.event : event.event + " of " + hand;
    std::size_t copies = 1;
    Tier* free = nullptr;
    for (Tier& tier : tiers) {
      if (tier.event != name) continue;
      ++copies;
      if (!free && tier.events.back()->interval.end <= event.interval.begin) free = &tier;
    }
    if (!free) {
      const std::string number = copies == 1 ? "" : fmt::format(" {}", copies);
      free = &tiers.emplace_back(Tier{name, name + number, {}});
    }
    free->events.push_back(&event);
  }
  std::ranges::stable_sort(tiers, {}, &Tier::name);
  return tiers;
}

std::string CsvText(const grammar::Timeline& timeline) {
  std::string text = "begin_s,end_s,label,tier\n";
  for (const Tier& tier : TiersOf(timeline)) {
    for (const grammar::NamedEvent* event : tier.events)
      text += fmt::format("{},{},\"{}\",{}\n",
                          truth::SecondsText(event->interval.begin, timeline.ticks_per_second),
                          truth::SecondsText(event->interval.end, timeline.ticks_per_second),
                          event->Label(), tier.name);
  }
  return text;
}

std::string EafText(const grammar::Timeline& timeline, const std::string& date) {
  pugi::xml_document document;
  const pugi::xml_node root =
      AddElement(document, "ANNOTATION_DOCUMENT",
                 {{"AUTHOR", "prehend"},
                  {"DATE", date + "T00:00:00+00:00"},
                  {"FORMAT", "3.0"},
                  {"VERSION", "3.0"},
                  {"xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance"},
                  {"xsi:noNamespaceSchemaLocation", "http://www.mpi.nl/tools/elan/EAFv3.0.xsd"}});
  AddElement(root, "HEADER", {{"MEDIA_FILE", ""}, {"TIME_UNITS", "milliseconds"}});
  const pugi::xml_node order = AddElement(root, "TIME_ORDER");
  const auto milliseconds = [&](grammar::Tick tick) {
    return fmt::format("{:.0f}",
                       std::round(truth::MillisecondsOf(tick, timeline.ticks_per_second)));
  };
  const std::vector<Tier> tiers = TiersOf(timeline);
  std::map<grammar::Tick, std::string> slots;  // one for each time, in their order
  for (const grammar::NamedEvent& event : timeline.events)
    slots[event.interval.begin], slots[event.interval.end];
  for (int number = 0; auto& [tick, id] : slots) {
    id = fmt::format("ts{}", ++number);
    AddElement(order, "TIME_SLOT", {{"TIME_SLOT_ID", id}, {"TIME_VALUE", milliseconds(tick)}});
  }
  int annotations = 0;
  for (const Tier& tier : tiers) {
    const pugi::xml_node node =
        AddElement(root, "TIER", {{"LINGUISTIC_TYPE_REF", "event"}, {"TIER_ID", tier.name}});
    for (const grammar::NamedEvent* event : tier.events) {
      const pugi::xml_node aligned =
          AddElement(AddElement(node, "ANNOTATION"), "ALIGNABLE_ANNOTATION",
                     {{"ANNOTATION_ID", fmt::format("a{}", ++annotations)},
                      {"TIME_SLOT_REF1", slots[event->interval.begin]},
                      {"TIME_SLOT_REF2", slots[event->interval.end]}});
      AddElement(aligned, "ANNOTATION_VALUE", {}, event->Label());
    }
  }
  AddElement(root, "LINGUISTIC_TYPE",
             {{"GRAPHIC_REFERENCES", "false"},
              {"LINGUISTIC_TYPE_ID", "event"},
              {"TIME_ALIGNABLE", "true"}});
  return ToText(document, Layout::kIndented);
}

/// Tiers of a TextGrid have no gaps: between labels stand empty ones.
std::string TextGridText(const grammar::Timeline& timeline, grammar::Tick end) {
  struct Interval {
    grammar::Tick begin, end;
    std::string text;
  };
  const std::vector<Tier> tiers = TiersOf(timeline);
  const auto seconds = [&](grammar::Tick tick) {
    return truth::SecondsText(tick, timeline.ticks_per_second);
  };
  std::string text = fmt::format(
      "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = {}\n"
      "tiers? <exists>\nsize = {}\nitem []:\n",
      seconds(end), tiers.size());
  for (std::size_t i = 0; i < tiers.size(); ++i) {
    std::vector<Interval> intervals;
    grammar::Tick at = 0;
    for (const grammar::NamedEvent* event : tiers[i].events) {
      if (event->interval.begin > at) intervals.push_back({at, event->interval.begin, ""});
      intervals.push_back({event->interval.begin, event->interval.end, event->Label()});
      at = event->interval.end;
    }
    if (at < end) intervals.push_back({at, end, ""});
    text += fmt::format(
        "    item [{}]:\n        class = \"IntervalTier\"\n        name = \"{}\"\n"
        "        xmin = 0\n        xmax = {}\n        intervals: size = {}\n",
        i + 1, tiers[i].name, seconds(end), intervals.size());
    for (std::size_t k = 0; k < intervals.size(); ++k)
      text += fmt::format(
          "        intervals [{}]:\n            xmin = {}\n            xmax = {}\n"
          "            text = \"{}\"\n",
          k + 1, seconds(intervals[k].begin), seconds(intervals[k].end), intervals[k].text);
  }
  return text;
}

}  // namespace

bool CanWriteLabels(const std::string& path) {
  return path.ends_with(".csv") || path.ends_with(".eaf") || path.ends_with(".TextGrid");
}

std::string LabelsText(const std::string& ending, const grammar::Timeline& timeline,
                       grammar::Tick end, const std::string& date) {
  if (ending == ".eaf") return EafText(timeline, date);
  return ending == ".csv" ? CsvText(timeline) : TextGridText(timeline, end);
}

tl::expected<std::size_t, episode::NotFound> WriteLabels(episode::Episode& episode,
                                                         const std::vector<std::string>& only,
                                                         const std::string& file,
                                                         const std::string& date) {
  const grammar::Program& program = *episode.program();
  const std::vector<std::string> known = EventNames(program);
  for (const std::string& name : only) {
    if (std::ranges::count(known, name) > 0) continue;
    const std::string near = grammar::NearestName(name, known);
    return tl::unexpected(episode::NotFound{
        .message = fmt::format("--event: grammar '{}' has no event '{}'{}", GrammarName(program),
                               name, near.empty() ? "" : "; did you mean '" + near + "'?")});
  }
  Result<grammar::Timeline> found = episode.Segment(episode.program());
  if (!found) return tl::unexpected(episode::NotFound{.diagnostics = found.error()});
  std::erase_if(found->events, [&](const grammar::NamedEvent& event) {
    return !only.empty() && std::ranges::count(only, event.event) == 0;
  });
  const std::string problem = WriteTextFile(
      file, LabelsText(file.substr(file.rfind('.')), *found, *episode.EndTick(), date));
  if (problem.empty()) return found->events.size();
  return tl::unexpected(episode::NotFound{.exit_code = ExitCode::kFailure, .message = problem});
}

}  // namespace prehend::exchange
