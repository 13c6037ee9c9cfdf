// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/knowledge/write_knowledge.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>

#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/process/child_process.h"
#include "harness/episode/episode/episode.h"
#include "harness/exchange/knowledge/episode_graph.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;

/// Of the transforms of a NEEM.
constexpr grammar::Tick kTransforms_per_s = 30;

/// By the numbers of the entities; of what is not tracked NaN.
using Poses = std::vector<physics::Pose>;

Poses PosesIn(const physics::Snapshot& now) {
  Poses poses;
  for (const physics::BodyState& body : now.bodies) poses.push_back(body.X_WB);
  for (const physics::HandState& hand : now.hands) poses.push_back(hand.palm.X_WB);
  return poses;
}

Poses PosesIn(const episode::EpisodeFrame& frame) {
  Poses poses;
  for (const grammar::EntitySample& look : frame.entities)
    poses.push_back({look.p_WB_m, look.q_WB});
  return poses;
}

/// Calls `look` with those of each moment that is `wanted`.
Result<void> EachPoses(episode::Episode& episode,
                       const std::function<void(std::int64_t tick, const Poses&)>& look,
                       const std::function<bool(std::int64_t tick)>& wanted) {
  if (episode::Recording* recording = episode.recording()) {
    recording->EachFrame([&](const episode::EpisodeFrame& frame) {
      if (wanted(frame.tick)) look(frame.tick, PosesIn(frame));
    });
    return {};
  }
  return episode::EpisodeFrames(*episode.file(), *episode.row(),
                                episode::LayoutOf(episode.loaded().scenario.scene))
      .Play([&](const physics::Snapshot& now) { look(now.tick, PosesIn(now)); }, wanted, false);
}

Result<Poses> FirstPoses(episode::Episode& episode) {
  if (episode::Recording* recording = episode.recording()) {
    recording->Keep();
    return PosesIn(recording->frames.front());
  }
  PREHEND_TRY(const auto first,
              episode::EpisodeFrames(*episode.file(), *episode.row(),
                                     episode::LayoutOf(episode.loaded().scenario.scene))
                  .At(1));
  return PosesIn(first);
}

grammar::Diagnostics Problem(const std::string& file, const std::string& message) {
  return {{.file = file, .message = message}};
}

/// Milliseconds since 1970 at the begin of a day, "2026-11-23"; 0 if it is none.
std::int64_t MillisecondsOf(const std::string& day) {
  int year = 0;
  unsigned month = 0, of_month = 0;
  if (std::sscanf(day.c_str(), "%d-%u-%u", &year, &month, &of_month) != 3) return 0;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(of_month)};
  if (!date.ok()) return 0;
  return std::chrono::sys_days(date).time_since_epoch().count() * std::int64_t{86'400'000};
}

class KnowledgeWriter {
 public:
  KnowledgeWriter(const KnowledgeRequest& request, Vocabulary vocabulary)
      : request_(request), vocabulary_(std::move(vocabulary)), opener_(request.root) {
    std::string ignored;
    hierarchy_.Add(ReadTurtle(vocabulary_.text(), ignored));
  }

  /// Returns what could not be read or written.
  grammar::Diagnostics WriteTerminology() { return WriteText("prehend", vocabulary_.text()); }

  grammar::Diagnostics Write(const episode::EpisodeName& name) {
    PREHEND_TRY(episode::Episode opened, opener_.Open(name));
    file_ = opened.file();
    const episode::EpisodeRow* row = opened.row();
    const fs::path made = fs::path(name.file).lexically_relative(request_.unfinished);
    const bool is_made = !made.empty() && *made.begin() != "..";
    const fs::path file = is_made ? request_.folder / made : fs::path(name.file);
    EpisodeOfTask episode{.row = *row, .file = fs::absolute(file).string()};
    PREHEND_TRY(episode.timeline, opened.Recorded());
    for (const grammar::EventSignature& event : grammar::EventSignatures(*opened.program()))
      if (event.composed) episode.composed.insert(event.name);

    PREHEND_TRY(auto map, MapOf(*row, opened));
    const std::vector<Triple> triples = EpisodeTriples(episode, *map, vocabulary_);
    ++written_.episodes;
    written_.events += episode.timeline.events.size();
    grammar::Diagnostics bad = WriteTriples("episodes/" + row->uuid, triples);
    if (bad.empty() && request_.neem) bad = WriteNeem(*row, *map, triples, opened);
    return bad;
  }

  /// Moves all to its place. Returns what could not be written.
  grammar::Diagnostics Finish() const {
    for (const auto& file : fs::recursive_directory_iterator(request_.unfinished)) {
      if (!file.is_regular_file()) continue;
      AtomicFile finished(request_.folder / file.path().lexically_relative(request_.unfinished));
      finished.stream() << std::ifstream(file.path(), std::ios::binary).rdbuf();
      const std::string problem = finished.Commit();
      if (!problem.empty()) return Problem(request_.folder, problem);
    }
    return {};
  }

  const KnowledgeWritten& written() const { return written_; }

 private:
  struct WrittenMap {
    MapOfTask map;
    std::vector<Triple> triples;
  };

  /// The map of the episode's task, which is written when it is first asked for.
  Result<const MapOfTask*> MapOf(const episode::EpisodeRow& row, episode::Episode& episode) {
    PREHEND_TRY(auto task, file_->DescribeTaskOf(row));
    const std::string uuid = task.uuid;
    if (const auto known = maps_.find(uuid); known != maps_.end()) return &known->second.map;
    PREHEND_TRY(auto entities, file_->EntitiesOf(row));
    MapOfTask map{
        .task = std::move(task), .scenario = row.scenario, .entities = std::move(entities)};
    PREHEND_TRY(map.poses, FirstPoses(episode));
    std::vector<Triple> triples = MapTriples(map, vocabulary_);
    hierarchy_.Add(triples);
    ++written_.tasks;
    const grammar::Diagnostics bad = WriteTriples("maps/" + uuid, triples);
    if (!bad.empty()) return tl::unexpected(bad);
    return &(maps_[uuid] = {std::move(map), std::move(triples)}).map;
  }

  grammar::Diagnostics WriteTriples(const std::string& name, const std::vector<Triple>& triples) {
    written_.statements += triples.size();
    return WriteText(name, ToTurtle(triples));
  }

  grammar::Diagnostics WriteText(const std::string& name, const std::string& turtle) {
    grammar::Diagnostics bad = WriteBytes(name + ".ttl", turtle);
    if (!bad.empty() || !request_.owl) return bad;
    const ToolResult xml = RunTool({"rapper", "--quiet", "--input", "turtle", "--output",
                                    "rdfxml-abbrev", "-", "http://prehend.local/"},
                                   turtle);
    if (!xml.Succeeded()) {
      std::string why = xml.problem.empty() ? "rapper: " + xml.err : xml.problem;
      if (why.ends_with("is not installed")) why += "; Debian's package raptor2-utils has it";
      return Problem(request_.folder + "/" + name + ".owl", why);
    }
    return WriteBytes(name + ".owl", xml.out);
  }

  grammar::Diagnostics WriteBytes(const std::string& name, const std::string& bytes) {
    const std::string problem = WriteTextFile(fs::path(request_.unfinished) / name, bytes);
    return problem.empty() ? grammar::Diagnostics()
                           : Problem(request_.folder + "/" + name, problem);
  }

  grammar::Diagnostics WriteNeem(const episode::EpisodeRow& row, const MapOfTask& map,
                                 const std::vector<Triple>& triples, episode::Episode& episode) {
    std::vector<Triple> all = maps_.at(map.task.uuid).triples;
    all.insert(all.end(), triples.begin(), triples.end());
    hierarchy_.Add(triples);
    std::vector<Transform> transforms;
    const std::int64_t day = MillisecondsOf(row.recorded_on);
    const std::int64_t ticks = std::max<std::int64_t>(row.ticks_per_second / kTransforms_per_s, 1);
    std::int64_t next = 0;
    last_.clear();
    const Result<void> played = EachPoses(
        episode,
        [&](std::int64_t tick, const Poses& poses) {
          AddTransforms(map, poses, day + 1000 * tick / row.ticks_per_second, transforms);
        },
        [&](std::int64_t tick) {
          if (tick < next) return false;
          next = tick - tick % ticks + ticks;
          return true;
        });
    if (!played) return played.error();
    const std::string folder = "neem/" + row.uuid + "/";
    for (const auto& [name, bytes] : {std::pair{"triples", TriplesBson(all, hierarchy_)},
                                      std::pair{"tf", TransformsBson(transforms)},
                                      std::pair{"annotations", AnnotationsBson(all)}}) {
      const std::string metadata = std::string(
                                       "{\"options\":{},\"indexes\":[{\"v\":2,\"key\":{\"_id\":1},"
                                       "\"name\":\"_id_\"}],\"collectionName\":\"") +
                                   name + "\"}\n";
      for (const auto& [ending, content] :
           {std::pair{".bson", &bytes}, std::pair{".metadata.json", &metadata}}) {
        grammar::Diagnostics bad = WriteBytes(folder + name + ending, *content);
        if (!bad.empty()) return bad;
      }
    }
    return {};
  }

  /// Of what has moved since its last transform, or has none.
  void AddTransforms(const MapOfTask& map, const Poses& poses, std::int64_t milliseconds,
                     std::vector<Transform>& transforms) {
    for (std::size_t i = 0; i < std::min(poses.size(), map.entities.size()); ++i) {
      const physics::Pose& X_WE = poses[i];
      const std::string& uuid = map.entities[i].uuid;
      const auto last = last_.find(uuid);
      const bool has_moved = last == last_.end() || last->second.p_m != X_WE.p_m ||
                             last->second.q.coeffs() != X_WE.q.coeffs();
      if (!X_WE.p_m.allFinite() || !has_moved) continue;
      last_[uuid] = X_WE;
      transforms.push_back({milliseconds, FullName("log:" + uuid), X_WE});
    }
  }

  const KnowledgeRequest& request_;
  Vocabulary vocabulary_;
  Hierarchy hierarchy_;
  episode::EpisodeOpener opener_;
  const episode::EpisodeFile* file_ = nullptr;  ///< of the episode that is being written
  std::map<std::string, WrittenMap> maps_;      ///< by the UUID of their task
  std::map<std::string, physics::Pose> last_;
  KnowledgeWritten written_;
};

}  // namespace

Result<KnowledgeWritten> WriteKnowledge(const std::vector<episode::EpisodeName>& episodes,
                                        const KnowledgeRequest& request) {
  PREHEND_TRY(Vocabulary vocabulary, Vocabulary::Load());
  KnowledgeWriter writer(request, std::move(vocabulary));
  if (const grammar::Diagnostics bad = writer.WriteTerminology(); !bad.empty())
    return tl::unexpected(bad);
  for (const episode::EpisodeName& episode : episodes) {
    if (const grammar::Diagnostics bad = writer.Write(episode); !bad.empty())
      return tl::unexpected(bad);
  }
  if (const grammar::Diagnostics bad = writer.Finish(); !bad.empty()) return tl::unexpected(bad);
  return writer.written();
}

}  // namespace prehend::exchange
