// SPDX-License-Identifier: Apache-2.0
// See harness/measure/score/score_labels.h: what two people marked. Tested by
// tests/program/label_agreement_test.cc
#include "harness/measure/score/score_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "grammar/contents.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/exchange/labels/label_map.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {
namespace {

/// The name of the recording, and a line for each event that is missing, too much, or has a
/// boundary beyond the collar; "" if there is none.
std::string DifferencesOf(const EpisodeToScore& episode, double collar_s) {
  const auto per_s = static_cast<double>(episode.truth.ticks_per_second);
  const auto collar = static_cast<grammar::Tick>(std::lround(collar_s * per_s));
  const std::string lines =
      truth::DescribeDisagreement(truth::Agree(episode.truth, episode.found, collar), collar);
  return lines.empty() ? "" : episode.scenario + ":\n" + lines;
}

/// The labels of one take, and nothing found yet.
Result<EpisodeToScore> Labelled(episode::Episode& episode, const episode::Take& take,
                                std::size_t index, const exchange::LabelReading& truths) {
  PREHEND_TRY(const grammar::Tick end, episode.EndTick());
  const grammar::EntityTable table = episode.entities();
  PREHEND_TRY(grammar::Timeline truth,
              truths.Truth(index, table.entities, table.ticks_per_second, end));
  return EpisodeToScore{.scenario = episode.name().scenario,
                        .ticks = end,
                        .truth = std::move(truth),
                        .person = take.person,
                        .set = take.set,
                        .video = truths.rows(index).video,
                        .offset_s = truths.rows(index).offset_s};
}

/// Labels by frame that last less than this share of their take, or it of them, are doubted.
constexpr double kFramesCover = 0.9;

/// Without a recording there is no rate.
constexpr grammar::Tick kTicksPerSecond = 10'000;

tl::unexpected<grammar::Diagnostics> Refused(std::string message, std::string hint) {
  return tl::unexpected(grammar::Diagnostics{
      {.file = "--truth", .message = std::move(message), .hint = std::move(hint)}});
}

/// What labels mean where nothing says it: an event of their name, with the tier as its role.
exchange::LabelMap MapOf(const std::vector<exchange::LabelFile>& files,
                         std::vector<grammar::EventSignature>& events) {
  exchange::LabelMap map;
  for (const exchange::LabelFile& file : files) {
    for (const exchange::Label& label : file.labels) {
      const std::string text(Trimmed(label.text));
      if (map.labels.emplace(text, exchange::Meaning{.event = text}).second)
        events.push_back({.name = text, .roles = {"tier"}, .classes = {"Entity"}});
      exchange::Meaning& tier = map.tiers[label.tier];
      if (tier.roles.empty() && !label.tier.empty()) tier.roles = {{"tier", label.tier}};
    }
  }
  return map;
}

/// Truths and, behind them, what is compared with them.
Result<std::vector<exchange::LabelFile>> ReadBoth(const LabelFilesRequest& request,
                                                  const exchange::CsvReading& csv) {
  std::vector<exchange::LabelFile> files;
  for (const auto* side : {&request.truth, &request.files}) {
    for (const std::string& path : *side) {
      PREHEND_TRY(auto file, exchange::ReadLabels(path, csv, request.backward));
      if (csv.take.empty() && !file.several.empty())
        return tl::unexpected(grammar::Diagnostics{exchange::SeveralTakes(file, path)});
      files.push_back(std::move(file));
    }
  }
  return files;
}

/// Takes that are scored together: of one set, and by one grammar.
struct Together {
  std::string set;
  std::string asked;               ///< a grammar; "": their own
  std::vector<std::size_t> takes;  ///< indices
};

std::vector<Together> Grouped(const std::vector<episode::Take>& takes, const std::string& grammar) {
  std::vector<Together> groups;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const episode::Take& take = takes[i];
    const std::string& asked = grammar.empty() ? take.episode.asked : grammar;
    auto group = std::ranges::find_if(groups, [&](const Together& other) {
      return other.set == take.set && other.asked == asked;
    });
    if (group == groups.end()) group = groups.insert(group, {take.set, asked, {}});
    group->takes.push_back(i);
  }
  return groups;
}

/// In a map: of "grasping(right_hand, cup)" its event; else the label, in quotes if it needs them.
std::string KeyOf(const std::string& label) {
  const auto is_plain = [](char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c));
  };
  const auto end = std::ranges::find_if_not(label, is_plain);
  const std::string name(label.begin(), end);
  if (end == label.end() || (!name.empty() && *end == '(' && label.ends_with(')'))) return name;
  return nlohmann::json(label).dump();
}

/// Scores one source after another.
class LabelScorer {
 public:
  LabelScorer(const LabelsRequest& request, std::string& warnings)
      : request_(request), warnings_(warnings), opener_(request.root) {}

  Result<LabelScores> Score() {
    std::vector<Source> sources = request_.asking.sources;
    if (sources.empty()) sources.emplace_back();
    for (const Source& source : sources) {
      const bool is_grammar = source.kind == Source::Kind::kGrammar;
      Foreign foreign(request_.asking, source);
      if (!request_.first_is_truth || &source != sources.data()) scores_.opinions.emplace_back();
      for (const Together& group :
           Grouped(request_.takes, is_grammar ? source.text : request_.asking.WhoseEvents())) {
        if (const auto added =
                Add(group, is_grammar ? nullptr : &foreign, source.text, &source == sources.data());
            !added)
          return tl::unexpected(added.error());
      }
    }
    return std::move(scores_);
  }

 private:
  /// `foreign` finds the events, or else the grammar of the group.
  Result<void> Add(const Together& group, Foreign* foreign, const std::string& named,
                   bool is_first) {
    std::vector<episode::EpisodeName> names;
    for (const std::size_t i : group.takes) names.push_back(request_.takes[i].episode);
    if (group.asked.empty()) {
      auto why = episode::WhyNotOneGrammar(names, request_.root);
      if (!why.empty()) return tl::unexpected(std::move(why));
    }
    PREHEND_TRY(const auto settings, episode::ParameterSettings(request_.settings));
    const grammar::CompileResult compiled = opener_.Compile(names.front(), group.asked, settings);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    PREHEND_TRY(const auto truths, TruthsOf(group, names.front(), settings, compiled));
    if (const std::string strange = exchange::WarningsOf(truths);
        is_first && said_.insert(strange).second)
      warnings_ += strange;
    if (is_first) scores_.counted += truths.counted();
    std::vector<EpisodeToScore> all;
    std::size_t true_events = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      PREHEND_TRY(const auto episode, Open(names[i], group.asked));
      if (const std::string moved = episode->moved(); said_.insert(moved).second)
        warnings_ += moved;
      if (episode->recording() && !foreign)
        AddMissing(episode::FindMissingFacts(*episode->recording(), *compiled.program));
      PREHEND_TRY(EpisodeToScore labelled,
                  Labelled(*episode, request_.takes[group.takes[i]], i, truths));
      true_events += labelled.truth.events.size();
      const double take_s = truth::SecondsOf(labelled.ticks, episode->entities().ticks_per_second);
      if (is_first) scores_.counted.cut += truths.Cut(i, take_s);
      if (const std::string doubt = RateWarning(truths, i, take_s); said_.insert(doubt).second)
        warnings_ += doubt;
      PREHEND_TRY(const grammar::Timeline found,
                  foreign ? foreign->Find(request_.takes, group.takes[i], Watched(*episode),
                                          *compiled.program, truths.compared(), labelled)
                          : episode->Segment(compiled.program));
      if (const auto said = first_.find(group.takes[i]); said != first_.end())
        labelled.truth = said->second;
      AddFound(found, i, truths, request_.collar_s, labelled);
      labelled.take = group.takes[i];
      if (said_.insert(labelled.notes).second) warnings_ += labelled.notes;
      if (!labelled.failure.empty())
        scores_.failures += fmt::format("prehend: {} was not scored by {}: {}", names[i].scenario,
                                        named, labelled.failure);
      all.push_back(std::move(labelled));
    }
    if (is_first) scores_.counted.merged += truths.counted().labels - true_events;
    if (std::ranges::none_of(all, [](const auto& one) { return one.failure.empty(); })) return {};
    const std::string& name = named.empty() && group.asked.empty() ? GrammarName(*compiled.program)
                              : named.empty()                      ? group.asked
                                                                   : named;
    if (request_.first_is_truth && is_first) {
      scores_.first = scores_.first.empty() ? name : scores_.first;
      for (EpisodeToScore& one : all) first_[one.take] = std::move(one.found);
      return {};
    }
    warnings_ += ClockWarning(name, all, truths);
    Opinion& opinion = scores_.opinions.back();
    if (opinion.name.empty()) opinion.name = name;
    opinion.takes.insert(opinion.takes.end(), all.begin(), all.end());
    scores_.collars_s = request_.is_collar_asked ? Collars{} : truths.collars_s();
    AddScores(name, std::move(all), request_.collar_s, scores_.collars_s, scores_);
    scores_.of_grammars.back().set = scores_.by_hand.back().set = group.set;
    const std::vector<std::string> own = grammar::EventNames(*compiled.program);
    for (const auto& [event, _] : truths.compared())
      if (!foreign && std::ranges::count(own, event) == 0)
        scores_.of_grammars.back().not_covered.push_back(event);
    return {};
  }

  /// Labels are events of the first grammar that is named.
  Result<exchange::LabelReading> TruthsOf(const Together& group, const episode::EpisodeName& name,
                                          const grammar::Overrides& settings,
                                          const grammar::CompileResult& compiled) {
    if (request_.first_is_truth)
      return exchange::NothingMarked(group.takes.size(), *compiled.program);
    const std::string whose = request_.asking.WhoseEvents();
    const grammar::CompileResult first =
        whose.empty() || whose == group.asked ? compiled : opener_.Compile(name, whose, settings);
    if (!first.program) return tl::unexpected(first.diagnostics);
    auto truths =
        exchange::ReadTruths(request_.takes, request_.label_files, request_.asking.label_map,
                             *first.program, request_.backward, group.takes);
    if (truths || request_.asking.sources.size() < 2) return truths;
    for (grammar::Diagnostic& one : truths.error())
      if (one.message.find("the grammar") != std::string::npos)
        one.hint +=
            fmt::format("{}labels are events of the first grammar ({}): name one that has it first",
                        one.hint.empty() ? "" : "; ", GrammarName(*first.program));
    return truths;
  }

  /// Each is opened once, also for several grammars.
  Result<episode::Episode*> Open(const episode::EpisodeName& name, const std::string& grammar) {
    for (const auto& known : episodes_)
      if (known->name() == name) return known.get();
    PREHEND_TRY(episode::Episode episode, opener_.Open(name, {grammar, request_.settings}));
    episodes_.push_back(std::make_unique<episode::Episode>(std::move(episode)));
    return episodes_.back().get();
  }

  /// Each event that is never recognised, once for all episodes.
  void AddMissing(const episode::MissingFacts& missing) {
    for (const std::string& warning : missing.never)
      if (said_.insert(warning).second) warnings_ += warning;
  }

  const LabelsRequest& request_;
  std::string& warnings_;
  episode::EpisodeOpener opener_;
  std::vector<std::unique_ptr<episode::Episode>> episodes_;
  std::set<std::string> said_;
  std::map<std::size_t, grammar::Timeline> first_;  ///< by take, what is true without labels
  LabelScores scores_;
};

}  // namespace

std::string RateWarning(const exchange::LabelReading& truths, std::size_t take, double take_s) {
  const std::size_t at = truths.files().empty() ? 0 : truths.rows(take).file;
  if (at >= truths.files().size()) return "";
  const exchange::LabelFile& file = truths.files()[at];
  if (file.frames_s == 0 ||
      (file.frames_s > kFramesCover * take_s && take_s > kFramesCover * file.frames_s))
    return "";
  return fmt::format(
      "warning: {}: its lines last {:.2f} s at {:g} per second, the recording {:.2f} s\n"
      "  hint: if it has a line for each frame of the video: rate_hz: {:.3g} in the map\n",
      file.file, file.frames_s, file.rate_hz, take_s, file.frames_s * file.rate_hz / take_s);
}

std::string ClockWarning(const std::string& grammar, const std::vector<EpisodeToScore>& episodes,
                         const exchange::LabelReading& truths) {
  std::vector<std::pair<grammar::Timeline, grammar::Timeline>> compared;
  for (const EpisodeToScore& episode : episodes)
    if (episode.failure.empty()) compared.emplace_back(episode.truth, episode.found);
  const auto clock = exchange::FindClockOffset(compared);
  if (!clock) return "";
  std::optional<double> offset_s = truths.offset_s();
  if (offset_s) *offset_s = std::round((*offset_s + clock->offset_s) * 100) / 100 + 0.0;  // no -0
  return fmt::format(
      "warning: {}: of {} labels {} are found, and {} if all of them were moved by {:+.2f} s; "
      "does the video begin when the tracker does?\n  hint: {}\n",
      grammar, clock->all, clock->found_now, clock->found_then, clock->offset_s,
      offset_s ? fmt::format("offset_s: {:.2f} in the map", *offset_s)
               : fmt::format("add {:.2f} to each offset_s", clock->offset_s));
}

void AddFound(const grammar::Timeline& found, std::size_t index,
              const exchange::LabelReading& truths, double collar_s, EpisodeToScore& labelled) {
  labelled.hands = truths.hands();
  labelled.found = exchange::Compared(found, truths.compared());
  labelled.moments = truths.TakeMoments(
      index, labelled.truth,
      static_cast<grammar::Tick>(collar_s * static_cast<double>(found.ticks_per_second)),
      labelled.found);
  for (const grammar::NamedEvent& event : found.events)
    if (!truths.compared().contains(event.event)) ++labelled.ignored[event.event];
}

void AddScores(const std::string& grammar, std::vector<EpisodeToScore> episodes, double collar_s,
               const Collars& collars, LabelScores& scores) {
  std::string& differences = scores.differences.emplace_back();
  for (const EpisodeToScore& episode : episodes)
    if (episode.failure.empty()) differences += DifferencesOf(episode, collar_s);
  scores.of_grammars.push_back(ScoreOf(grammar, episodes, collar_s, collars));
  scores.of_grammars.back().ignored_because = "no label means them";
  for (EpisodeToScore& episode : episodes) {
    episode.truth = exchange::ByHand(std::move(episode.truth), episode.hands);
    episode.found = exchange::ByHand(std::move(episode.found), episode.hands);
  }
  scores.by_hand.push_back(ScoreOf(grammar, episodes, collar_s, collars));
  scores.by_hand.back().ignored.clear();
}

bool LabelScores::HasHands() const {
  for (std::size_t g = 0; g < by_hand.size(); ++g)
    if (by_hand[g].events.size() > of_grammars[g].events.size()) return true;
  return false;
}

Result<LabelScores> ScoreLabels(const LabelsRequest& request, std::string& warnings) {
  return LabelScorer(request, warnings).Score();
}

std::string LabelScoresText(const LabelScores& scores, bool differences) {
  if (scores.of_grammars.empty()) return "";  // no table of nothing
  std::string text = ScoresText(scores.of_grammars);
  if (scores.of_people) {
    const Score& score = scores.of_grammars.front();
    const auto kappa = [](const EventScore& event) {
      return std::round(100 * event.frames.Kappa()) / 100 + 0.0;  // no -0
    };
    text += "kappa of frames:";
    for (const EventScore& event : score.events)
      text += fmt::format(" {} {:.2f},", event.event, kappa(event));
    text += fmt::format(" all {:.2f}\n", kappa(score.total));
    std::map<std::string, TimeErrors> boundaries;  // 95 % of these are at most so far apart
    for (const EventScore& event : score.events)
      for (const TimeErrors* errors : {&event.begin, &event.end})
        std::ranges::copy(errors->seconds,
                          std::back_inserter(boundaries[KeyOf(event.event)].seconds));
    std::string collars;
    for (const auto& [key, both] : boundaries) {
      if (both.seconds.empty()) continue;
      const double apart_ms = 1000 * std::abs(both.QuantileByMagnitude(0.95));
      collars += fmt::format("{}{}: {:g}", collars.empty() ? "" : ", ", key,
                             std::max(1.0, std::ceil(apart_ms - 1e-6)));
    }
    text += fmt::format("in a map: collar_ms: {{{}}}  # 95 % of the boundaries of {}\n", collars,
                        score.grammar);
  }
  text += scores.counted.Text();
  if (scores.HasHands()) {
    text += "\nEach hand for itself:\n\n";
    for (const Score& one : scores.by_hand) text += ScoreTable(one) + "\n";
  }
  for (std::size_t g = 0; differences && g < scores.differences.size(); ++g)
    text += fmt::format("\n{}, against the labels:\n{}", scores.of_grammars[g].grammar,
                        scores.differences[g].empty() ? "no differences\n" : scores.differences[g]);
  return text;
}

Result<LabelScores> ScoreLabelFiles(const LabelFilesRequest& request, std::string& warnings) {
  const std::size_t count = request.files.size();
  if (request.truth.size() != count)
    return Refused(
        fmt::format("{} files of labels, and {} to compare them with", count, request.truth.size()),
        "as many, in the same order");
  std::vector<grammar::EventSignature> events;
  std::optional<exchange::LabelMap> map;
  if (!request.grammar.empty()) {
    const grammar::CompileResult compiled = episode::LoadGrammar(request.root, request.grammar);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    events = EventSignatures(*compiled.program);
  }
  if (!request.label_map.empty()) {
    if (events.empty())
      return Refused("no recording says which events there are", "--grammar NAME, for the map");
    PREHEND_TRY(map, exchange::ReadLabelMap(request.label_map, events));
  }
  PREHEND_TRY(
      auto files,
      ReadBoth(request,
               map ? map->csv : exchange::CsvReading{.role_names = exchange::RolesOf(events)}));
  if (events.empty()) map = MapOf(files, events);
  PREHEND_TRY(auto reading,
              exchange::LabelReading::Of(std::move(files), map ? &*map : nullptr, events));
  warnings += exchange::WarningsOf(reading);
  std::size_t merged = reading.counted().labels;
  std::vector<EpisodeToScore> all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [begin_s, one_end_s] = reading.SpanOf(i);
    const auto [other_begin_s, other_end_s] = reading.SpanOf(count + i);
    const double before_s = -std::min(begin_s, other_begin_s),
                 end_s = before_s + std::max(one_end_s, other_end_s);
    for (const std::size_t take : {i, count + i}) reading.Move(take, before_s);
    const auto end =
        std::max<grammar::Tick>(1, std::llround(end_s * static_cast<double>(kTicksPerSecond)));
    EpisodeToScore pair{.scenario = request.files[i],
                        .ticks = end,
                        .truth = reading.Marked(i, kTicksPerSecond, end, false),
                        .found = reading.Marked(count + i, kTicksPerSecond, end, false)};
    pair.hands = reading.hands();
    pair.moments = reading.TakeMoments(
        i, pair.truth, std::llround(request.collar_s * static_cast<double>(kTicksPerSecond)),
        pair.found);
    merged -= pair.truth.events.size() + pair.found.events.size();
    all.push_back(std::move(pair));
  }
  LabelScores scores;
  AddScores(fmt::format("{}", fmt::join(request.files, ", ")), std::move(all), request.collar_s,
            request.is_collar_asked ? Collars{} : reading.collars_s(), scores);
  scores.counted = reading.counted();
  scores.counted.takes = count;
  scores.counted.merged = merged;
  scores.of_people = true;
  return scores;
}

}  // namespace prehend::measure
