// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/read_truths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/exchange/labels/read_labels.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;

/// Where the labels of an episode may lie in a folder, without ending.
std::vector<fs::path> StemsOf(const episode::EpisodeName& episode, const fs::path& folder) {
  return {folder / episode.scenario, folder / fs::path(episode.scenario).filename()};
}

/// By these a take is called in tables: skill/name, name.
std::vector<std::string> NamesOf(const episode::Take& take) {
  const std::string& name = take.episode.scenario;
  std::vector<std::string> names = {name};
  if (name.find('/') != std::string::npos) names.push_back(name.substr(name.rfind('/') + 1));
  return names;
}

/// The file there with the name of the episode: of take1.jsonl take1.csv, take1.eaf, ..; of an
/// episode SKILL/NAME.csv or NAME.csv. "" and `problem` if there is none.
std::string FileIn(const std::string& folder, const episode::EpisodeName& episode, const char* what,
                   const std::vector<std::string>& endings, std::string& problem) {
  std::error_code error;
  for (const fs::path& stem : StemsOf(episode, folder)) {
    for (const std::string& ending : endings)
      if (fs::exists(stem.string() + ending, error)) return stem.string() + ending;
  }
  problem = fmt::format("{} has no {} of '{}': no {} with one of the endings {}", folder, what,
                        episode.scenario, StemsOf(episode, folder).back().filename().string(),
                        fmt::join(endings, ", "));
  return "";
}

/// Which rows of a table are of a take: those that have one of these values in the column.
struct WantedRows {
  std::string column;
  std::vector<std::string> values;
  auto operator<=>(const WantedRows&) const = default;
};

/// Reads the labels of takes, each file once. With `clock`, what somebody found in them.
class TruthReader {
 public:
  TruthReader(const std::vector<episode::Take>& takes, const LabelMap* map,
              const std::vector<grammar::EventSignature>& events, Backward backward,
              std::function<TakeClock()> clock = {})
      : takes_(takes),
        map_(map),
        csv_(map ? map->csv : CsvReading{}),
        backward_(backward),
        clock_(std::move(clock)) {
    if (clock_) csv_ = {.rate_hz = csv_.rate_hz};  // the columns of the map are those of labels
    if (clock_ || !map) csv_.role_names = RolesOf(events);
    if (csv_.take == "ignore") says_nothing_of_takes_ = true;
    if (says_nothing_of_takes_) csv_.take.clear();
  }

  /// One file or folder of what was found.
  Result<LabelReading> ReadFound(const std::string& given,
                                 const std::vector<grammar::EventSignature>& events,
                                 std::vector<std::size_t> only) {
    if (IsTable(given)) {
      const std::vector<std::string> head = HeadOfTable(given);
      if (std::ranges::count(head, "episode") > 0) csv_.take = "episode";
    }
    return Read({given}, events, std::move(only));
  }

  Result<LabelReading> Read(const std::vector<std::string>& given,
                            const std::vector<grammar::EventSignature>& events,
                            std::vector<std::size_t> only) {
    if (only.empty())
      for (std::size_t i = 0; i < takes_.size(); ++i) only.push_back(i);
    std::string problem;
    const std::vector<std::string> paths = PathsFrom(given, problem);
    if (!problem.empty())
      return tl::unexpected(
          grammar::Diagnostics{{.file = clock_ ? "--found" : "--truth", .message = problem}});
    for (std::size_t i = 0; i < takes_.size(); ++i)
      if (IsTable(paths[i]))
        for (const WantedRows& wanted : WantedOf(takes_[i])) keys_[paths[i]].insert(wanted.column);
    for (const std::size_t i : only)
      if (problems_.size() < kMostBackward) AddTake(takes_[i], paths[i]);
    if (!problems_.empty()) return tl::unexpected(std::move(problems_));
    for (std::size_t i = 0; i < takes_.size(); ++i) MarkRows(takes_[i], paths[i]);
    Counted others;
    CountOthers(others);
    auto reading = LabelReading::Of(std::move(files_), map_, events, std::move(rows_),
                                    clock_ ? Side::kFound : Side::kTruth);
    if (reading) reading->counted().of_other_takes = std::move(others.of_other_takes);
    return reading;
  }

 private:
  std::vector<WantedRows> WantedOf(const episode::Take& take) const {
    std::vector<WantedRows> wanted;
    for (const auto& [column, value] : take.rows) wanted.push_back({column, {value}});
    if (take.rows.empty() && !csv_.take.empty()) wanted.push_back({csv_.take, NamesOf(take)});
    return wanted;
  }

  std::vector<std::string> PathsFrom(const std::vector<std::string>& given, std::string& problem) {
    std::vector<std::string> paths;
    std::error_code error;
    const bool is_folder = given.size() == 1 && fs::is_directory(given.front(), error);
    const auto without =
        static_cast<std::size_t>(std::ranges::count(takes_, "", &episode::Take::labels));
    if (!given.empty() && without < takes_.size()) {
      problem = "the labels are named in the file of takes";
    } else if (given.empty() && without > 0) {
      problem = "which labels? --truth FILE or FOLDER, or 'labels' in the file of takes";
    } else if (!given.empty() && !is_folder && given.size() != takes_.size() &&
               (given.size() != 1 || !AllHaveRows())) {
      problem = fmt::format(
          "{} recordings and {} files of {}; wanted one file for each recording, in the same "
          "order, or a folder, or one table of all whose column says the recording: {}",
          takes_.size(), given.size(), what_,
          clock_ ? "'episode'" : "in the map columns: {take: COLUMN}");
    }
    if (!problem.empty()) return paths;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      std::string why;
      paths.push_back(given.empty() ? takes_[i].labels
                      : is_folder ? FileIn(given.front(), takes_[i].episode, what_, Endings(), why)
                      : given.size() == 1 ? given.front()
                                          : given[i]);
      if (problem.empty()) problem = why;
    }
    if (problem.empty() && given.size() == 1) problem = MeantTwice(paths);
    return paths;
  }

  /// Two recordings that are called alike, for which the same labels would count, or "".
  std::string MeantTwice(const std::vector<std::string>& paths) const {
    std::map<std::pair<std::string, std::vector<WantedRows>>, std::size_t> first;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      const auto [known, is_new] = first.try_emplace({paths[i], WantedOf(takes_[i])}, i);
      if (is_new) continue;
      const auto text = [&](std::size_t k) {
        const episode::EpisodeName& one = takes_[k].episode;
        return one.file + (one.number ? fmt::format(" (episode {})", *one.number) : "");
      };
      return fmt::format(
          "the same {} of {} would count for {} and for {}, both called '{}'; a file of takes "
          "names the labels of each (docs/labels.md)",
          what_, paths[i], text(known->second), text(i), takes_[i].episode.scenario);
    }
    return "";
  }

  std::vector<std::string> Endings() const {
    std::vector<std::string> endings = LabelEndings();
    if (clock_) endings.emplace_back(".jsonl");
    return endings;
  }

  bool AllHaveRows() const {
    return std::ranges::none_of(takes_, [&](const auto& take) { return WantedOf(take).empty(); });
  }

  /// The index of a file that has been read; nothing if it cannot be.
  std::optional<std::size_t> FileOf(const std::string& path) {
    const auto [known, is_new] = index_.try_emplace(path);
    if (!is_new) return known->second;
    CsvReading csv = csv_;
    csv.keys = {keys_[path].begin(), keys_[path].end()};
    if (clock_ && !IsTable(path)) {
      const TakeClock clock = clock_();
      csv.ticks_per_second = clock.ticks_per_second;
      csv.frames_s = clock.frames_s;
    }
    Result<LabelFile> file = ReadLabels(path, csv, backward_);
    if (!file) {
      problems_.insert(problems_.end(), file.error().begin(), file.error().end());
      return std::nullopt;
    }
    known->second = files_.size();
    files_.push_back(std::move(*file));
    without_text_.emplace_back();
    return known->second;
  }

  void AddTake(const episode::Take& take, const std::string& path) {
    const std::vector<std::string> names = NamesOf(take);
    const auto index = FileOf(path);
    if (!index) return;
    LabelFile& file = files_[*index];
    std::optional<double> offset_s = take.offset_s;
    if (!offset_s) offset_s = map_ ? OffsetOf(*map_, names) : std::optional(0.0);
    if (!offset_s)
      problems_.push_back({.file = map_->document.sources.front().name,
                           .message = "offset_s: the map has none of " + names.front()});
    if (take.offset_s) file.warnings.clear();  // by its clock
    const std::vector<WantedRows> wanted = WantedOf(take);
    if (wanted.empty() && !file.several.empty() && !says_nothing_of_takes_) {
      problems_.push_back(SeveralTakes(file, names.front()));
      return;
    }
    TakeRows& rows = rows_.emplace_back(TakeRows{.file = *index,
                                                 .offset_s = offset_s.value_or(0),
                                                 .video = map_ ? VideoOf(*map_, names) : ""});
    const bool is_table = IsTable(path);
    for (std::size_t i = 0; i < file.empty.size(); ++i)
      if (!is_table || IsWanted(file.empty[i], wanted, path)) without_text_[*index].insert(i);
    if (!is_table && !take.rows.empty())
      problems_.push_back(file.At({}, "it has no columns, and 'rows' names some"));
    for (std::size_t i = 0; i < file.labels.size(); ++i) {
      if (is_table && !IsWanted(file.labels[i], wanted, path)) continue;
      rows.labels.push_back(i);
    }
    const bool says_nothing =
        wanted.empty() || !is_table || std::ranges::any_of(file.nothing_in, [&](const auto& keys) {
          return IsWanted({.keys = keys}, wanted, path);
        });
    if (rows.labels.empty() && !says_nothing) ComplainOfNone(file, wanted, path);
  }

  /// Which labels of the files that were read are of some take, also one that is read apart.
  void MarkRows(const episode::Take& take, const std::string& path) {
    const auto index = index_.find(path);
    if (index == index_.end() || !index->second) return;
    const LabelFile& file = files_[*index->second];
    const std::vector<WantedRows> wanted = WantedOf(take);
    const auto is_of = [&](const Label& label) {
      return !IsTable(path) || IsWanted(label, wanted, path);
    };
    for (const auto* labels : {&file.labels, &file.empty})
      for (const Label& label : *labels)
        if (is_of(label)) of_takes_.insert(&label);
  }

  std::size_t KeyOf(const std::string& path, const std::string& column) const {
    const std::set<std::string>& keys = keys_.at(path);
    return static_cast<std::size_t>(std::distance(keys.begin(), keys.find(column)));
  }

  bool IsWanted(const Label& label, const std::vector<WantedRows>& wanted,
                const std::string& path) const {
    return std::ranges::all_of(wanted, [&](const WantedRows& one) {
      return std::ranges::count(one.values, label.keys[KeyOf(path, one.column)]) > 0;
    });
  }

  void ComplainOfNone(const LabelFile& file, const std::vector<WantedRows>& wanted,
                      const std::string& path) {
    std::string asked;
    for (const WantedRows& one : wanted)
      asked += fmt::format("{}'{}' in the column '{}'", asked.empty() ? "" : " and ",
                           one.values.front(), one.column);
    std::set<std::string> known;
    for (const Label& label : file.labels) known.insert(label.keys[KeyOf(path, wanted[0].column)]);
    const std::string near =
        grammar::NearestName(wanted[0].values.front(), {known.begin(), known.end()});
    problems_.push_back(file.At(
        {}, "no row has " + asked,
        fmt::format("{}rows: {{{}: VALUE}} in a file of takes says which are of a recording; if "
                    "nothing happened in it, a row with nothing but its name says so",
                    near.empty() ? "" : "it has '" + near + "'; ", wanted[0].column)));
  }

  /// Rows that are of none of the takes; of those without text only those of these takes stay.
  void CountOthers(Counted& counted) {
    for (std::size_t f = 0; f < files_.size(); ++f) {
      LabelFile& file = files_[f];
      for (const auto* labels : {&file.labels, &file.empty})
        for (const Label& label : *labels)
          if (!of_takes_.contains(&label))
            ++counted.of_other_takes[file.file][fmt::format("{}", fmt::join(label.keys, " "))];
      std::vector<Label> empty;
      for (const std::size_t i : without_text_[f]) empty.push_back(std::move(file.empty[i]));
      file.empty = std::move(empty);
    }
  }

  const std::vector<episode::Take>& takes_;
  const LabelMap* map_;
  CsvReading csv_;
  const Backward backward_;
  const std::function<TakeClock()> clock_;
  const char* const what_ = clock_ ? "events" : "labels";
  bool says_nothing_of_takes_ = false;
  std::map<std::string, std::set<std::string>> keys_;  ///< by path: columns that tell rows apart
  std::map<std::string, std::optional<std::size_t>> index_;  ///< by path: in `files_`
  std::vector<LabelFile> files_;
  std::vector<std::set<std::size_t>> without_text_;  ///< of each file, such labels of these takes
  std::set<const Label*> of_takes_;                  ///< of any take
  std::vector<TakeRows> rows_;
  grammar::Diagnostics problems_;
};

/// That of the command line or of the takes; none if nobody names one.
Result<std::optional<LabelMap>> MapOf(const std::vector<episode::Take>& takes,
                                      const std::string& map,
                                      const std::vector<grammar::EventSignature>& events) {
  const std::string& path = map.empty() ? takes.front().map : map;
  if (path.empty()) return std::optional<LabelMap>();
  PREHEND_TRY(LabelMap meaning, ReadLabelMap(path, events));
  return std::optional<LabelMap>(std::move(meaning));
}

struct Tier {
  std::string event, name;
  std::vector<const grammar::NamedEvent*> events;  ///< by their begins, without overlaps
};

/// Sorted by name.
std::vector<Tier> TiersOf(const grammar::Timeline& timeline, const truth::HandRoles& hands) {
  std::vector<Tier> tiers;
  for (const grammar::NamedEvent& event : timeline.events) {
    const std::string name = truth::NameByHand(event, hands);
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

std::string CsvText(const grammar::Timeline& timeline, const std::vector<Tier>& tiers) {
  std::string text = "begin_s,end_s,label,tier\n";
  for (const Tier& tier : tiers) {
    for (const grammar::NamedEvent* event : tier.events)
      text += fmt::format("{},{},\"{}\",{}\n",
                          truth::SecondsText(event->interval.begin, timeline.ticks_per_second),
                          truth::SecondsText(event->interval.end, timeline.ticks_per_second),
                          event->Label(), tier.name);
  }
  return text;
}

std::string EafText(const grammar::Timeline& timeline, const std::vector<Tier>& tiers,
                    const std::string& date) {
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
std::string TextGridText(const grammar::Timeline& timeline, const std::vector<Tier>& tiers,
                         grammar::Tick end) {
  struct Interval {
    grammar::Tick begin, end;
    std::string text;
  };
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

Result<LabelReading> ReadTruths(const std::vector<episode::Take>& takes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program, Backward backward,
                                std::vector<std::size_t> only) {
  const std::vector<grammar::EventSignature> events = grammar::EventSignatures(program);
  PREHEND_TRY(const auto read, MapOf(takes, map, events));
  return TruthReader(takes, read ? &*read : nullptr, events, backward)
      .Read(given, events, std::move(only));
}

Result<LabelReading> NothingMarked(std::size_t takes, const grammar::Program& program) {
  return LabelReading::Of({LabelFile{}}, nullptr, grammar::EventSignatures(program),
                          std::vector<TakeRows>(takes));
}

Result<LabelReading> ReadFound(const std::vector<episode::Take>& takes, std::size_t take,
                               const std::string& given, const std::string& map,
                               const grammar::Program& program,
                               const std::function<TakeClock()>& clock) {
  const std::vector<grammar::EventSignature> events = grammar::EventSignatures(program);
  PREHEND_TRY(const auto read, MapOf(takes, map, events));
  // What the takes know of labels, and by which clock, is not so of what was found.
  std::vector<episode::Take> bare = episode::TakesOf(episode::EpisodesOf(takes));
  for (episode::Take& one : bare) one.offset_s = 0;
  return TruthReader(bare, read ? &*read : nullptr, events, Backward::kRefuse, clock)
      .ReadFound(given, events, {take});
}

Result<LabelReading> AsFound(LabelFile file, const std::vector<episode::Take>& takes,
                             const std::string& map, const grammar::Program& program) {
  const std::vector<grammar::EventSignature> events = grammar::EventSignatures(program);
  PREHEND_TRY(const auto read, MapOf(takes, map, events));
  TakeRows rows;
  for (std::size_t i = 0; i < file.labels.size(); ++i) rows.labels.push_back(i);
  return LabelReading::Of({std::move(file)}, read ? &*read : nullptr, events, {std::move(rows)},
                          Side::kFound);
}

std::string WarningsOf(const LabelReading& reading) {
  std::size_t count = 0;
  std::string files;
  for (const LabelFile& file : reading.files()) {
    if (file.backward == 0) continue;
    count += file.backward;
    files += fmt::format("{}{} of {}", files.empty() ? "" : ", ", file.backward, file.file);
  }
  const std::string backward =
      count == 0 ? ""
      : count == 1
          ? fmt::format("warning: a label ends before it begins, and is left out: {}\n", files)
          : fmt::format("warning: {} labels end before they begin, and are left out: {}\n", count,
                        files);
  return reading.warnings() + backward;
}

bool CanWriteLabels(const std::string& path) {
  return path.ends_with(".csv") || path.ends_with(".eaf") || path.ends_with(".TextGrid");
}

std::string LabelsText(const std::string& ending, const grammar::Timeline& timeline,
                       const truth::HandRoles& hands, grammar::Tick end, const std::string& date) {
  const std::vector<Tier> tiers = TiersOf(timeline, hands);
  if (ending == ".eaf") return EafText(timeline, tiers, date);
  return ending == ".csv" ? CsvText(timeline, tiers) : TextGridText(timeline, tiers, end);
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
  const std::string problem =
      WriteTextFile(file, LabelsText(file.substr(file.rfind('.')), *found,
                                     truth::HandRolesOf(grammar::EventSignatures(program)),
                                     *episode.EndTick(), date));
  if (problem.empty()) return found->events.size();
  return tl::unexpected(episode::NotFound{.exit_code = ExitCode::kFailure, .message = problem});
}

}  // namespace prehend::exchange
