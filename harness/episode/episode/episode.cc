// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "grammar/contents.h"
#include "harness/base/base/text_file.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"
#include "harness/truth/timeline/timeline_wire.h"

namespace prehend::physics {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunStatus, kind, tick, entity, reason, advice)

}  // namespace prehend::physics

namespace prehend::episode {
namespace {

bool IsComplete(const physics::RunStatus& status) {
  return status.kind == physics::RunStatus::Kind::kCompleted;
}

/// Of JSON Lines. What is wrong with it is said by who reads all of it.
Result<EpisodeHeader> HeaderOf(const std::string& file) {
  std::ifstream in = OpenRegular(file);
  std::string line;
  EpisodeStream stream(file);
  if (std::getline(in, line) && stream.Take(line).empty() && stream.has_header())
    return stream.header();
  PREHEND_TRY(Recording whole, ReadRecording(file));
  return std::move(whole.header);
}

}  // namespace

tl::unexpected<grammar::Diagnostics> Episode::Failure(const std::string& message) const {
  return tl::unexpected(
      grammar::Diagnostics{{.file = name_.file, .message = name_.scenario + ": " + message}});
}

grammar::EntityTable Episode::entities() const {
  return recording_ ? recording_->header.entity_table : MakeEntityTable(loaded_.scenario);
}

EpisodeHeader Episode::Header() const {
  if (recording_) return recording_->header;
  const std::string& name = name_.scenario;
  return {.episode = name.substr(name.rfind('/') + 1),
          .grammar = NameToRecord(loaded_),
          .entity_table = entities()};
}

const RunResult& Episode::Played() {
  if (played_) return *played_;
  if (!file_)
    return played_.emplace(RunScenario(loaded_.scenario, loaded_.program, {.record = true}));
  // What was kept is what would be simulated again, if its frames have the hash of then.
  Result<RunResult> kept = Resegment(*file_, row_, loaded_, /*frames=*/true);
  played_.emplace(kept ? std::move(*kept) : RunResult());
  if (!kept) played_->status.reason = kept.error().front().message;
  return *played_;
}

bool Episode::IsTrial() const {
  const YamlNode* vary = loaded_.document.root.Find("vary");
  const Result<TaskFiles> task = vary ? Task() : TaskFiles();
  if (!task || !vary) return false;
  const auto is_set = [&](const YamlNode& field) {
    return std::ranges::any_of(task->run.settings, [&](const std::string& setting) {
      return setting.starts_with(field.text + "=");
    });
  };
  return std::ranges::all_of(vary->children, [&](const YamlNode& variation) {
    const YamlNode* fields = variation.Find("fields");
    return fields && std::ranges::all_of(fields->children, is_set);
  });
}

Result<SegmentedRecording> Episode::SegmentRecorded() {
  return SegmentRecording(*recording_, loaded_.program, name_.file);
}

Result<RunResult> Episode::Run(bool frames) {
  if (name_.origin == Origin::kRecordedRun) return Resegment(*file_, row_, loaded_, frames);
  if (name_.origin == Origin::kScenario)
    return played_ ? *played_ : RunScenario(loaded_.scenario, loaded_.program, {.record = frames});
  PREHEND_TRY(SegmentedRecording segmented, SegmentRecorded());
  return RunOf(std::move(segmented), frames);
}

RunResult Episode::RunOf(SegmentedRecording segmented, bool frames) {
  RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = recording_->end_tick - 1;
  run.is_recording = true;
  run.is_unfinished = !recording_->says_its_end;
  missing_ = std::move(segmented.missing);
  run.timeline = std::move(segmented.timeline);
  run.drawings = truth::EventDrawings(*loaded_.program);
  run.state_hash = HashOfFrames(*recording_);
  if (frames)
    recording_->EachFrame([&](const EpisodeFrame& frame) {
      run.recording.push_back(PlaceholderSnapshotAt(recording_->header, frame));
    });
  return run;
}

Result<grammar::Timeline> Episode::Recorded() {
  if (file_) return file_->TimelineOf(row_);
  if (recording_) return Failure("no events were recorded with it");
  return Played().timeline;
}

Episode::End Episode::EachFrame(const std::function<void(const grammar::Frame&)>& look) {
  if (recording_) {
    recording_->EachFrame([&](EpisodeFrame& frame) { look(frame.View()); });
    return End{recording_->end_tick, ""};
  }
  const scenario::Scenario& scenario = loaded_.scenario;
  Sensing sensing(scenario.scene, scenario.sensing);
  if (played_) {
    for (const physics::Snapshot& snapshot : played_->recording) {
      if (sensing.Due(snapshot.tick)) look(sensing.Sense(snapshot));
    }
    return End{played_->ticks + 1, IsComplete(played_->status) ? "" : StatusText(*played_)};
  }
  if (!file_) {
    ScenarioRun playing(scenario, loaded_.program);
    while (playing.Step()) {
      if (playing.sensed()) look(playing.frame());
    }
    const RunResult run = playing.Finish();
    return End{run.ticks + 1, IsComplete(run.status) ? "" : StatusText(run)};
  }
  EpisodeFrames frames(*file_, row_, LayoutOf(scenario.scene));
  const Result<void> read =
      frames.Play([&](const physics::Snapshot& snapshot) { look(sensing.Sense(snapshot)); },
                  [&](std::int64_t tick) { return sensing.Due(tick); });
  End end{row_.ticks + 1, read ? "" : name_.file + ": " + read.error().front().message};
  if (!read || IsComplete(row_.end)) return end;
  RunResult run;
  run.status = row_.end;
  run.timeline.ticks_per_second = row_.ticks_per_second;
  end.failure = StatusText(run);
  return end;
}

Result<grammar::Tick> Episode::EndTick() {
  if (file_ && !IsComplete(row_.end)) return Failure("the episode did not come to a good end");
  if (recording_) return recording_->end_tick;
  if (file_) return row_.ticks + 1;
  if (!IsComplete(Played().status)) return Failure(StatusText(*played_));
  return played_->ticks + 1;
}

Result<std::vector<physics::Snapshot>> Episode::ReadSnapshots(
    const std::function<bool(std::int64_t)>& wanted) const {
  std::vector<physics::Snapshot> snapshots;
  const Result<void> read =
      EpisodeFrames(*file_, row_, LayoutOf(loaded_.scenario.scene))
          .Play([&](const physics::Snapshot& snapshot) { snapshots.push_back(snapshot); }, wanted);
  if (!read) return tl::unexpected(read.error());
  return snapshots;
}

Result<std::vector<physics::Snapshot>> Episode::Snapshots() {
  return file_ ? ReadSnapshots({}) : Played().recording;
}

Result<grammar::Timeline> Episode::Segment(const std::shared_ptr<const grammar::Program>& program) {
  PREHEND_TRY(const grammar::Tick end, EndTick());
  if (recording_) return SegmentFrames(*recording_, program, name_.file);
  const scenario::Scenario& scenario = loaded_.scenario;
  if (played_) return Resegment(scenario, played_->recording, program, end);
  if (!sensed_) {
    const Sensing sensing(scenario.scene, scenario.sensing);
    PREHEND_TRY(sensed_, ReadSnapshots([&](std::int64_t tick) { return sensing.Due(tick); }));
  }
  return Resegment(scenario, *sensed_, program, end);
}

Result<Episode> EpisodeOpener::OpenLines(const EpisodeName& name, const GrammarChoice& choice) {
  PREHEND_TRY(Recording recording, ReadRecording(name.file));
  return Open(std::move(recording), name, choice);
}

Result<Episode> EpisodeOpener::Open(Recording recording, const EpisodeName& name,
                                    const GrammarChoice& choice) {
  PREHEND_TRY(const grammar::Overrides parameters, ParameterSettings(choice.settings));
  const EpisodeHeader& header = recording.header;
  grammar::CompileResult compiled = LoadGrammarOf(header, choice.grammar, root_, parameters);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  LoadedRun loaded{.scenario = PlaceholderFor(header), .program = std::move(compiled.program)};
  loaded.scenario.file = name.file;
  loaded.scenario.grammar = GrammarName(*loaded.program);
  loaded.warnings = Warnings(*loaded.program, header.entity_table);
  Episode episode(name, std::move(loaded));
  episode.recording_ = std::move(recording);
  return episode;
}

Result<EpisodeRow> EpisodeOpener::FindKept(const EpisodeName& name) {
  if (!file_ || file_->path() != name.file) {
    PREHEND_TRY(auto opened, EpisodeFile::Open(name.file));
    file_ = std::make_shared<const EpisodeFile>(std::move(opened));
  }
  const auto row = std::ranges::find(file_->episodes(), *name.number, &EpisodeRow::id);
  if (row == file_->episodes().end())
    return tl::unexpected(
        grammar::Diagnostics{{.file = name.file, .message = "the episode is gone"}});
  return *row;
}

Result<Episode> EpisodeOpener::OpenKept(const EpisodeName& name, const GrammarChoice& choice) {
  PREHEND_TRY(const EpisodeRow row, FindKept(name));
  PREHEND_TRY(LoadedRun loaded, loader_.Load(*file_, row, choice));
  const Origin origin = row.simulated ? Origin::kRecordedRun : Origin::kRecording;
  Episode episode({name.file, row.id, row.scenario, origin, row.grammar}, std::move(loaded));
  episode.file_ = file_;
  episode.row_ = row;
  if (row.simulated) {
    if (auto whole = file_->CheckFrames(row, episode.loaded_.scenario.scene.world.rate_hz); !whole)
      return tl::unexpected(std::move(whole.error()));
    return episode;
  }
  PREHEND_TRY(episode.recording_, ReadRecording(*file_, row));
  return episode;
}

Result<Episode> EpisodeOpener::Open(const EpisodeName& name, const GrammarChoice& asked,
                                    std::vector<std::string>* files) {
  GrammarChoice choice = asked;
  if (choice.grammar.empty()) choice.grammar = name.asked;
  if (name.number) return OpenKept(name, choice);
  if (name.origin == Origin::kRecording) return OpenLines(name, choice);
  PREHEND_TRY(LoadedRun loaded,
              LoadRun({name.file, choice.grammar, choice.settings}, root_, files));
  return Episode(name, std::move(loaded));
}

grammar::CompileResult EpisodeOpener::Compile(const EpisodeName& name, const std::string& asked,
                                              const grammar::Overrides& parameters) {
  if (const std::string& other = asked.empty() ? name.asked : asked; !other.empty())
    return LoadGrammar(root_, other, parameters);
  if (compiled_ != name) {
    compiled_.reset();
    own_ = {};
    if (name.number) {
      const Result<EpisodeRow> row = FindKept(name);
      Result<LoadedRun> loaded = row ? loader_.Load(*file_, *row) : tl::unexpected(row.error());
      if (!loaded) return {nullptr, std::move(loaded.error())};
      own_ = std::move(*loaded);
    } else if (name.origin == Origin::kRecording) {
      Result<EpisodeHeader> header = HeaderOf(name.file);
      if (!header) return {nullptr, std::move(header.error())};
      return LoadGrammarOf(*header, "", root_, parameters);
    } else {
      Result<LoadedRun> loaded = LoadRun({name.file, "", {}}, root_);
      if (!loaded) return {nullptr, std::move(loaded.error())};
      own_ = std::move(*loaded);
    }
    compiled_ = name;
  }
  return name.number ? loader_.CompileOwn(own_.grammar, parameters)
                     : LoadGrammar(root_, own_.grammar, parameters);
}

grammar::Diagnostics WhyNotOneGrammar(std::span<const EpisodeName> episodes,
                                      const std::string& root) {
  EpisodeOpener opener(root);
  std::shared_ptr<const grammar::Program> first;
  std::map<std::string, int> named;
  grammar::Diagnostics why;
  for (const EpisodeName& episode : episodes) {
    if (episodes.size() == 1) break;
    grammar::CompileResult own = opener.Compile(episode, "", {});
    if (!own.program && !why.empty()) continue;
    if (!own.program) return std::move(own.diagnostics);
    if (!first) first = own.program;
    const std::string &name = GrammarName(*own.program), &other = GrammarName(*first);
    ++named[name];
    if (!why.empty() || SameTexts(*first, *own.program)) continue;
    why = {{.file = episode.scenario,
            .message = name == other
                           ? fmt::format("its grammar {} is not the same as that of {}, which has "
                                         "the same name",
                                         name, episodes.front().scenario)
                           : fmt::format("it names the grammar {}, and {} the grammar {}", name,
                                         episodes.front().scenario, other),
            .hint = name}};
  }
  if (why.empty()) return why;
  // What most of them name, or, of as many, what differs.
  std::string& hint = why.front().hint;
  for (const auto& [name, count] : named)
    if (count > named[hint]) hint = name;
  hint = "one of them for all: --grammar " + hint;
  return why;
}

Result<Episode> OpenEpisode(const EpisodeName& name, const GrammarChoice& choice,
                            const std::string& root, std::vector<std::string>* files) {
  return EpisodeOpener(root).Open(name, choice, files);
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunHeading, name, skill, grammar, notes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunResult, status, ticks, is_recording, is_unfinished,
                                   state_hash, timeline, outcome)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Resegmented, heading, run, differences, warnings, problem,
                                   nothing_left, finished)

namespace {

constexpr double kSliceTimeLimit_s = 3600;
constexpr std::size_t kSlicesPerJob = 2;
constexpr std::size_t kMostLines = 20;

std::vector<std::string> LinesOf(const grammar::Timeline& timeline, const RunResult& run) {
  RunResult shown;
  shown.status = run.status;
  shown.timeline = timeline;
  std::istringstream table(RunTable(shown));
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  lines.pop_back();  // the status
  return lines;
}

bool IsEqual(const grammar::NamedEvent& a, const grammar::NamedEvent& b) {
  return a.event == b.event && a.roles == b.roles && a.interval == b.interval &&
         a.decided == b.decided && a.open_end == b.open_end && a.values == b.values;
}

/// Lines that only one of the two has.
std::string Differences(const grammar::Timeline& recorded, const RunResult& run) {
  if (std::ranges::equal(recorded.events, run.timeline.events, IsEqual)) return "";
  const std::vector<std::string> before = LinesOf(recorded, run), now = LinesOf(run.timeline, run);
  std::vector<std::string> lines;
  for (const std::string& line : before) {
    if (std::ranges::find(now, line) == now.end()) lines.push_back("- " + line);
  }
  for (const std::string& line : now) {
    if (std::ranges::find(before, line) == before.end()) lines.push_back("+ " + line);
  }
  if (lines.empty()) lines.push_back("the same events were decided at other times");
  std::string text;
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLines); ++i) text += lines[i] + "\n";
  if (lines.size() > kMostLines) text += fmt::format("and {} more\n", lines.size() - kMostLines);
  return text;
}

/// Opens one episode after another.
class Worker {
 public:
  explicit Worker(const ResegmentRequest& request) : request_(request), opener_(request.root) {}

  Resegmented Run(const EpisodeName& name) {
    const auto failed = [](const grammar::Diagnostics& why) {
      return Resegmented{.problem = grammar::Format(why)};
    };
    Result<Episode> episode = opener_.Open(name, request_.choice);
    if (!episode) return failed(episode.error());
    Result<RunResult> run = episode->Run(request_.replay);
    if (!run) return failed(run.error());
    run->recording.clear();
    const LoadedRun& loaded = episode->loaded();
    const MissingFacts& missing = episode->missing();
    Resegmented result{.heading = HeadingOf(loaded.scenario, *run),
                       .run = std::move(*run),
                       .warnings = grammar::Format(loaded.warnings) + missing.warnings,
                       .nothing_left = missing.nothing_left,
                       .finished = !episode->row() || episode->row()->status != kBeingRecorded};
    if (!request_.compare || !result.finished) return result;
    const Result<grammar::Timeline> recorded = episode->Recorded();
    if (!recorded) return failed(recorded.error());
    result.differences = Differences(*recorded, result.run);
    return result;
  }

 private:
  const ResegmentRequest& request_;
  EpisodeOpener opener_;
};

}  // namespace

std::vector<Resegmented> ResegmentAll(const std::vector<EpisodeName>& episodes,
                                      const ResegmentRequest& request) {
  const std::size_t slices =
      std::min(episodes.size(), kSlicesPerJob * static_cast<std::size_t>(request.jobs));
  std::vector<WorkerJob> jobs;
  // Neighbours are often of one skill and equally long: each slice has some of all.
  for (std::size_t slice = 0; slice < slices; ++slice) {
    jobs.push_back([&, slice] {
      Worker worker(request);
      std::vector<Resegmented> of_slice;
      for (std::size_t i = slice; i < episodes.size(); i += slices)
        of_slice.push_back(worker.Run(episodes[i]));
      return ToWire(of_slice);
    });
  }
  const std::vector<WorkerResult> said =
      RunInWorkers(jobs, {.jobs = request.jobs, .time_limit_s = kSliceTimeLimit_s});
  std::vector<Resegmented> results(episodes.size());
  for (std::size_t slice = 0; slice < slices; ++slice) {
    std::vector<Resegmented> of_slice;
    if (said[slice].finished) of_slice = FromWire<std::vector<Resegmented>>(said[slice].output);
    for (std::size_t i = slice, k = 0; i < episodes.size(); i += slices, ++k) {
      results[i] = k < of_slice.size()
                       ? std::move(of_slice[k])
                       : Resegmented{.problem = "its process ended: " + said[slice].reason + "\n"};
      results[i].episode = episodes[i];
    }
  }
  return results;
}

}  // namespace prehend::episode
