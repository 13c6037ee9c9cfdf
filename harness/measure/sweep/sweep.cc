// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "grammar/contents.h"
#include "harness/base/base/median.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/visible_stream.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/load_run.h"
#include "harness/exchange/labels/read_labels.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/measure/score/overlap_metrics.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/oracle/oracle.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {

/// What one setting recognises in one episode.
struct JudgedSetting {
  int correct = 0, extra = 0, missed = 0;  ///< events
  std::vector<double> begin_ms, end_ms, latency_ms;
};

/// One episode under all settings, or why it is left out.
struct JudgedSettings {
  std::vector<JudgedSetting> settings;
  std::string left_out;
  bool is_unread = false;  ///< it is left out since it cannot be read
  std::string moved;       ///< a warning for who has labels by its own clock, or ""
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JudgedSetting, correct, extra, missed, begin_ms, end_ms,
                                   latency_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JudgedSettings, settings, left_out, is_unread, moved)

namespace {
using Programs = std::vector<std::shared_ptr<const grammar::Program>>;

constexpr double kTimeLimit_s = 3600;
constexpr double kLeastOverlap = 0.5;  ///< F1@50
constexpr std::size_t kSlicesPerJob = 4;

/// Number and unit off a text: "10cm".
std::optional<std::pair<double, std::string>> Quantity(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  std::string unit(end, text.data() + text.size());
  if (unit.starts_with(' ')) unit.erase(0, 1);
  return std::pair(number, std::move(unit));
}

std::vector<std::size_t> IndicesOf(std::size_t point, const std::vector<Axis>& axes) {
  std::vector<std::size_t> at(axes.size());
  for (std::size_t i = axes.size(); i-- > 0;) {
    at[i] = point % axes[i].values.size();
    point /= axes[i].values.size();
  }
  return at;
}

/// What each point sets, in the order of points.
std::vector<grammar::Overrides> Settings(const SweepRequest& request) {
  std::vector<grammar::Overrides> settings;
  if (request.one_at_a_time) {
    for (const Axis& axis : request.axes)
      for (std::size_t i = 0; i < axis.values.size(); ++i)
        settings.push_back({{axis.parameter, axis.ValueText(i)}});
    return settings;
  }
  std::size_t count = 1;
  for (const Axis& axis : request.axes) count *= axis.values.size();
  settings.resize(count);
  for (std::size_t point = 0; point < count; ++point) {
    const std::vector<std::size_t> at = IndicesOf(point, request.axes);
    for (std::size_t i = 0; i < at.size(); ++i)
      settings[point][request.axes[i].parameter] = request.axes[i].ValueText(at[i]);
  }
  return settings;
}

Result<Programs> CompileAll(const SweepRequest& request, const episode::EpisodeName& first) {
  episode::EpisodeOpener opener(request.root);
  PREHEND_TRY(const grammar::Overrides fixed, episode::ParameterSettings(request.settings));
  Programs programs;
  for (grammar::Overrides& overrides : Settings(request)) {
    overrides.insert(fixed.begin(), fixed.end());
    grammar::CompileResult compiled = opener.Compile(first, request.grammar, overrides);
    if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
    programs.push_back(std::move(compiled.program));
  }
  return programs;
}

/// Why the episode has no such truth, or "".
std::string WhyNoTruth(const episode::Episode& episode, Truth truth) {
  if (truth == Truth::kRecorded)
    return episode::Lacks(episode.name(), episode::Need::kRecordedEvents);
  return truth == Truth::kLabels ? "" : episode::Lacks(episode.name(), episode::Need::kGroundTruth);
}

/// The true events, only those that the grammar prints; or why there are none.
tl::expected<grammar::Timeline, std::string> TruthOf(const SweepRequest& request,
                                                     episode::Episode& episode,
                                                     const grammar::Program& program) {
  if (const std::string why = WhyNoTruth(episode, request.truth); !why.empty())
    return tl::unexpected(why);
  const episode::EpisodeName& name = episode.name();
  grammar::Timeline truth;
  if (request.truth == Truth::kOracle) {
    const auto snapshots = episode.Snapshots();
    if (!snapshots) return tl::unexpected(snapshots.error().front().message);
    truth = truth::TrueTimeline(episode.loaded().scenario.scene, *snapshots, *episode.EndTick());
  } else if (name.number && name.grammar != GrammarName(program)) {
    return tl::unexpected("its events are those of the grammar " + name.grammar);
  } else if (request.truth == Truth::kRecorded) {
    Result<grammar::Timeline> recorded = episode.Recorded();
    if (!recorded) return tl::unexpected(recorded.error().front().message);
    truth = std::move(*recorded);
  } else if (episode.IsTrial()) {
    return tl::unexpected(std::string("a trial has no golden"));
  } else {
    const auto golden = truth::GoldenFiles(request.root).ReadGoldenOf(name.scenario);
    if (!golden || !*golden) return tl::unexpected(std::string("it has no golden"));
    if (!name.number && (*golden)->grammar != GrammarName(program))
      return tl::unexpected("its golden is of the grammar " + (*golden)->grammar);
    truth = truth::ToTimeline(**golden);
  }
  std::erase_if(truth.events,
                [&](const grammar::NamedEvent& event) { return !HasEvent(program, event.event); });
  return truth;
}

JudgedSetting Judged(const grammar::Timeline& truth, grammar::Timeline found,
                     const SweepRequest& request, grammar::Tick ticks) {
  if (request.truth == Truth::kOracle)
    std::erase_if(found.events, [](const auto& event) { return !truth::OracleDefines(event); });
  const auto per_s = static_cast<double>(truth.ticks_per_second);
  const auto ms = [&](grammar::Tick offset) { return 1000 * static_cast<double>(offset) / per_s; };
  const LabelledEpisode episode = Labelled(truth, found, ticks);
  const Hits hits =
      request.by_overlap
          ? HitsByOverlap(episode.whole.truth, episode.whole.prediction, kLeastOverlap)
          : MatchWithCollar(episode.whole.truth, episode.whole.prediction, request.collar_s * per_s,
                            0)
                .AsHits();
  JudgedSetting judged{hits.correct, hits.extra, hits.missed, {}, {}, {}};
  for (const truth::LabelAgreement& label :
       truth::Agree(truth, found, static_cast<grammar::Tick>(request.collar_s * per_s)).labels) {
    for (const truth::Match& match : label.matches) {
      judged.begin_ms.push_back(ms(match.begin_offset()));
      judged.end_ms.push_back(ms(match.end_offset()));
    }
  }
  for (const grammar::NamedEvent& event : found.events)
    judged.latency_ms.push_back(ms(event.decided - event.interval.end));
  return judged;
}

/// One episode under all settings. With labels these are its truth, at `index`.
JudgedSettings JudgedEpisode(const episode::EpisodeName& name, std::size_t index,
                             const std::optional<exchange::LabelReading>& labels,
                             const SweepRequest& request, const Programs& programs,
                             episode::EpisodeOpener& opener, ProgressCounters::Tick& measured) {
  Result<episode::Episode> episode = opener.Open(name, {request.grammar, request.settings});
  if (!episode) return {.left_out = grammar::Format(episode.error().front()), .is_unread = true};
  const Result<grammar::Tick> end = episode->EndTick();
  if (!end) return {.left_out = "it did not come to a good end"};
  tl::expected<grammar::Timeline, std::string> truth;
  if (labels) {
    const grammar::EntityTable table = episode->entities();
    Result<grammar::Timeline> labelled =
        labels->Truth(index, table.entities, table.ticks_per_second, *end);
    if (!labelled) return {.left_out = grammar::Format(labelled.error().front())};
    truth = std::move(*labelled);
  } else {
    truth = TruthOf(request, *episode, *programs.front());
  }
  if (!truth) return {.left_out = truth.error()};
  JudgedSettings judged;
  if (const auto* recording = episode->recording(); labels && recording)
    judged.moved = episode::MovedText(recording->header, recording->moved);
  for (const auto& program : programs) {
    Result<grammar::Timeline> found = episode->Segment(program);
    if (!found) return {.left_out = grammar::Format(found.error().front()), .is_unread = true};
    if (labels) {
      found = exchange::Compared(*found, labels->compared());
      (void)labels->TakeMoments(index, *truth, 0, *found);
    }
    judged.settings.push_back(Judged(*truth, std::move(*found), request, *end));
    ++measured;
  }
  return judged;
}

/// "40 seconds", "12 minutes", "3.5 hours"
std::string TimeText(double seconds) {
  constexpr double kMinute_s = 60, kHour_s = 3600;
  if (seconds < 1.5 * kMinute_s) return fmt::format("{:.0f} seconds", std::ceil(seconds));
  if (seconds < 1.5 * kHour_s) return fmt::format("{:.0f} minutes", seconds / kMinute_s);
  return fmt::format("{:.1f} hours", seconds / kHour_s);
}

double Seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

std::string Axis::ValueText(std::size_t i) const {
  return fmt::format("{:.9g}{}{}", values[i], unit.empty() ? "" : " ", unit);
}

std::optional<Axis> ParseAxis(const std::string& text, std::string& problem) {
  const std::size_t equals = text.find('='), dots = text.find(".."), colon = text.rfind(':');
  const bool is_formed = equals != std::string::npos && equals > 0 && dots != std::string::npos &&
                         colon != std::string::npos && equals < dots && dots + 2 < colon;
  problem =
      fmt::format("found '{}', wanted NAME=FROM..TO:COUNT, like reach_radius=10cm..50cm:9", text);
  if (!is_formed) return std::nullopt;
  const auto from = Quantity(std::string_view(text).substr(equals + 1, dots - equals - 1)),
             to = Quantity(std::string_view(text).substr(dots + 2, colon - dots - 2));
  const int count = NumberFrom<int>(std::string_view(text).substr(colon + 1)).value_or(0);
  if (!from || !to || count < 2) return std::nullopt;
  if (from->second != to->second) {
    problem = fmt::format("'{}' goes from '{}' to '{}': both ends need the same unit", text,
                          from->second, to->second);
    return std::nullopt;
  }
  problem.clear();
  Axis axis{.parameter = text.substr(0, equals), .unit = from->second};
  for (int i = 0; i < count; ++i)
    axis.values.push_back(from->first + (to->first - from->first) * i / (count - 1));
  return axis;
}

std::string SetTruth(const std::vector<std::string>& given, SweepRequest& request) {
  static const std::map<std::string, Truth> words = {
      {"golden", Truth::kGolden}, {"oracle", Truth::kOracle}, {"recorded", Truth::kRecorded}};
  if (given.empty()) return "";
  const auto word = words.find(given.front());
  request.truth = word == words.end() ? Truth::kLabels : word->second;
  std::error_code error;
  for (const std::string& truth : given) {
    const bool is_known = words.contains(truth) ? given.size() == 1
                                                : exchange::IsLabelFile(truth) ||
                                                      std::filesystem::is_directory(truth, error);
    if (!is_known)
      return fmt::format(
          "--truth: found '{}', wanted golden, oracle or recorded, or files of labels or a folder "
          "of them",
          truth);
  }
  if (request.truth == Truth::kLabels) request.label_files = given;
  return "";
}

std::string SetAxes(const std::vector<std::string>& texts, SweepRequest& request) {
  std::size_t settings = 1;
  for (const std::string& text : texts) {
    std::string problem;
    Axis axis = *ParseAxis(text, problem);
    settings *= axis.values.size();
    if (std::ranges::count(request.axes, axis.parameter, &Axis::parameter) > 0)
      return "--over: " + axis.parameter + " is given twice";
    for (const std::string& setting : request.settings)
      if (setting.starts_with(axis.parameter + "="))
        return "--over: " + axis.parameter + " is given by --set, too";
    if (settings > kMostSettings)
      return fmt::format("--over: more than {} settings", kMostSettings);
    request.axes.push_back(std::move(axis));
  }
  if (request.axes.empty())
    return "--over is missing: which parameter? --over reach_radius=10cm..50cm:9";
  return "";
}

std::string MeasureText(const SweepRequest& request) {
  if (request.by_overlap)
    return "F1@50: an event is right if it and its label have half of their union in common; "
           "--collar-ms asks for both boundaries instead";
  return fmt::format("F1: an event is right if both boundaries are within {:g} ms",
                     1000 * request.collar_s);
}

Result<SweepResult> Sweep(const std::vector<episode::Take>& takes, const SweepRequest& request) {
  const std::vector<episode::EpisodeName> episodes = EpisodesOf(takes);
  PREHEND_TRY(const Programs programs, CompileAll(request, episodes.front()));
  std::optional<exchange::LabelReading> labels;
  if (request.truth == Truth::kLabels) {
    PREHEND_TRY(labels, exchange::ReadTruths(
                            takes, request.label_files, request.label_map, *programs.front(),
                            request.skip_bad_labels ? exchange::Backward::kSkip
                                                    : exchange::Backward::kRefuse));
  }
  const std::size_t slices =
      std::min(episodes.size(), kSlicesPerJob * static_cast<std::size_t>(request.jobs));
  ProgressCounters counters(1);
  ProgressCounters::Tick& measured = counters[0];
  measured = 0;
  std::vector<WorkerJob> jobs;
  for (std::size_t slice = 0; slice < slices; ++slice) {
    jobs.push_back([&, slice] {
      episode::EpisodeOpener opener(request.root);
      std::vector<JudgedSettings> all;
      for (std::size_t i = slice; i < episodes.size(); i += slices)
        all.push_back(JudgedEpisode(episodes[i], i, labels, request, programs, opener, measured));
      return ToWire(all);
    });
  }
  const std::function<void()> tell = [&] {
    request.progress(static_cast<std::size_t>(measured.load()), programs.size() * episodes.size());
  };
  const double limit_s =
      kTimeLimit_s * static_cast<double>(request.one_at_a_time ? request.axes.size() : 1);
  const auto said = RunInWorkers(jobs, {.jobs = request.jobs, .time_limit_s = limit_s}, {}, nullptr,
                                 request.progress ? tell : std::function<void()>());

  SweepResult result;
  result.grammar = GrammarName(*programs.front());
  result.measure = MeasureText(request);
  if (labels) result.label_warning = exchange::WarningsOf(*labels);
  if (labels) result.counted = labels->counted().Text();
  result.points.resize(programs.size());
  std::vector<std::vector<double>> begins(programs.size()), ends(begins), latencies(begins);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    std::vector<JudgedSettings> of_slice;
    if (said[slice].finished) of_slice = FromWire<std::vector<JudgedSettings>>(said[slice].output);
    for (std::size_t i = slice, k = 0; i < episodes.size(); i += slices, ++k) {
      const JudgedSettings one =
          k < of_slice.size() ? of_slice[k] : JudgedSettings{.left_out = said[slice].reason};
      if (one.settings.empty()) {
        result.left_out.push_back(episodes[i].scenario + ": " + one.left_out);
        if (one.is_unread) result.unread.push_back(result.left_out.back());
        continue;
      }
      ++result.episodes;
      result.label_warning += one.moved;
      for (std::size_t p = 0; p < programs.size(); ++p) {
        const JudgedSetting& judged = one.settings[p];
        SweepPoint& point = result.points[p];
        point.correct += judged.correct;
        point.extra += judged.extra;
        point.missed += judged.missed;
        point.of_each.insert(point.of_each.end(), {judged.correct, judged.extra, judged.missed});
        begins[p].insert(begins[p].end(), judged.begin_ms.begin(), judged.begin_ms.end());
        ends[p].insert(ends[p].end(), judged.end_ms.begin(), judged.end_ms.end());
        latencies[p].insert(latencies[p].end(), judged.latency_ms.begin(), judged.latency_ms.end());
      }
    }
  }
  for (std::size_t p = 0; p < result.points.size(); ++p) {
    SweepPoint& point = result.points[p];
    if (!request.one_at_a_time) point.at = IndicesOf(p, request.axes);
    point.f1 = Hits{point.correct, point.extra, point.missed}.F1();
    for (const auto& [of, median] :
         {std::pair(&begins[p], &point.begin_ms), std::pair(&ends[p], &point.end_ms),
          std::pair(&latencies[p], &point.latency_ms)})
      *median = of->empty() ? std::numeric_limits<double>::quiet_NaN() : Median(*of);
  }
  std::ranges::sort(result.left_out);
  return result;
}

SweepProgress::~SweepProgress() {
  if (said_ && is_person_) out_ << kEraseLine << std::flush;
}

void SweepProgress::Tell(std::size_t done, std::size_t all) {
  constexpr double kSoon_s = 2, kMeasured_s = 1;
  const Clock::time_point now = Clock::now();
  if (done > 0 && !first_) first_ = {now, done};
  if (!first_ || done == first_->done) return;
  // The first ones came with what happens once: grammars are compiled, recordings read.
  const double measured_s = Seconds(now - first_->at);
  const double more_s =
      measured_s * static_cast<double>(all - done) / static_cast<double>(done - first_->done);
  const double passed_s = Seconds(now - start_);
  if (!said_ && (measured_s < kMeasured_s || passed_s + more_s < kSoon_s)) return;
  if (!said_) {
    const std::size_t settings = all / episodes_;
    out_ << fmt::format("prehend: {} setting{} on {} recording{}, about {}\n", settings,
                        settings == 1 ? "" : "s", episodes_, episodes_ == 1 ? "" : "s",
                        TimeText(passed_s + more_s))
         << std::flush;
  }
  said_ = true;
  if (is_person_)
    out_ << kEraseLine << fmt::format("{} %, about {} more", 100 * done / all, TimeText(more_s))
         << std::flush;
}

}  // namespace prehend::measure
