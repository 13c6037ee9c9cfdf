// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/episode_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/record_episode.h"

namespace prehend::episode {
namespace {

std::string About(const EpisodeRow& episode) {
  return fmt::format("episode {} ({}): ", episode.id, episode.scenario);
}

constexpr const char* kFindPart =
    "SELECT data FROM part WHERE episode = ? AND part = ? AND first_tick BETWEEN ? AND ? ORDER BY "
    "first_tick DESC LIMIT 1";

/// Damage that is found meanwhile is of these frames.
template <typename Work>
void AtChunk(std::int64_t first_tick, const Work& work) {
  try {
    work();
  } catch (const Damage& damage) {
    throw Damage(fmt::format("frames from tick {} on: {}", first_tick, damage.what()));
  }
}

constexpr std::int64_t kMostTicks = std::int64_t{1} << 50;  // recordings may begin below 0

/// The number, or the file is damaged.
std::int64_t Between(std::int64_t least, std::int64_t number, std::int64_t most) {
  if (number < least || number > most)
    throw Damage(fmt::format("found the number {}, wanted {} to {}", number, least, most));
  return number;
}

physics::RunStatus EndOf(const EpisodeRow& row, const Statement& found) {
  using Kind = physics::RunStatus::Kind;
  if (row.status == kCompleted || row.status == kUnfinished)
    return {.kind = Kind::kCompleted, .tick = row.ticks};
  if (row.status == kFailed) {
    return {.kind = Kind::kFailed,
            .tick = row.ticks,
            .entity = found.Text(10),
            .reason = found.Text(11),
            .advice = found.Text(12)};
  }
  if (row.status != kBeingRecorded) throw Damage(fmt::format("found the status '{}'", row.status));
  return {.kind = Kind::kFailed,
          .tick = row.ticks,
          .entity = "",
          .reason = "its recording was cut off here",
          .advice = "record it again"};
}

}  // namespace

Result<EpisodeFile> EpisodeFile::Open(const std::string& path) {
  return Guarded(path, [&] {
    EpisodeFile file(path, OpenToRead(path));
    Statement find = file.database_.Prepare(
        "SELECT episode.id, episode.uuid, scenario, status, grammar, ticks_per_second, CASE status "
        "WHEN 'recording' THEN coalesce((SELECT max(last_tick) FROM chunk WHERE chunk.episode = "
        "episode.id), 0) ELSE ticks END, state_hash, outcome, recorded_on, failure_entity, "
        "failure_reason, failure_advice, engine FROM episode LEFT JOIN task ON task.id = "
        "episode.task ORDER BY episode.id");
    while (find.Step()) {
      if (find.IsNothing(2)) throw Damage("an episode has no task");
      EpisodeRow& row = file.episodes_.emplace_back();
      row = {.id = find.Integer(0),
             .uuid = find.Uuid(1),
             .scenario = find.Text(2),
             .status = find.Text(3),
             .simulated = find.Text(13) != kNoEngine,
             .grammar = find.Text(4),
             .ticks_per_second = Between(1, find.Integer(5), 1'000'000),
             .ticks = Between(-kMostTicks, find.Integer(6), kMostTicks),
             .state_hash = find.Text(7),
             .outcome = find.Text(8),
             .recorded_on = find.Text(9)};
      row.end = EndOf(row, find);
    }
    return file;
  });
}

Result<TaskFiles> EpisodeFile::TaskOf(const EpisodeRow& episode) const {
  const auto read = [&] {
    TaskFiles task;
    Statement find = database_.Prepare(
        "SELECT file, asked_grammar, settings, task.id FROM task JOIN episode ON episode.task = "
        "task.id WHERE episode.id = ?");
    if (!find.Bind(episode.id).Step()) throw Damage("an episode has no task");
    task.run.scenario_file = find.Text(0);
    task.run.grammar = find.Text(1);
    const auto settings = nlohmann::json::parse(find.Text(2), nullptr, false);
    const std::int64_t id = find.Integer(3);
    if (!settings.is_array()) throw Damage("a task's settings are no list");
    for (const auto& setting : settings) {
      if (setting.is_string()) task.run.settings.push_back(setting);
    }
    Statement assets = database_.Prepare(
        "SELECT path, hash, content, bytes FROM task_asset JOIN asset USING(hash) WHERE task = ?");
    assets.Bind(id);
    Compressor compressor;
    std::size_t all = 0;
    while (assets.Step()) {
      const auto bytes = static_cast<std::size_t>(std::max(assets.Integer(3), std::int64_t{0}));
      CheckTaskBytes(all += bytes);
      const auto content = compressor.Unpack(assets.Bytes(2), bytes);
      if (!content || ContentHash(*content) != assets.Text(1))
        throw Damage(assets.Text(0) + " is not what it was");
      task.files[assets.Text(0)] = std::string(*content);
    }
    return task;
  };
  return Guarded(path_, read, About(episode));
}

Result<KeptTask> EpisodeFile::DescribeTaskOf(const EpisodeRow& episode) const {
  return Guarded(path_, [&] {
    Statement find = database_.Prepare(
        "SELECT task.uuid, shows, task.id FROM task JOIN episode ON episode.task = task.id WHERE "
        "episode.id = ?");
    if (!find.Bind(episode.id).Step()) throw Damage("an episode has no task");
    KeptTask task{.uuid = find.Uuid(0), .shows = find.Text(1)};
    Statement assets =
        database_.Prepare("SELECT path, hash FROM task_asset WHERE task = ? ORDER BY path");
    assets.Bind(find.Integer(2));
    while (assets.Step()) task.assets.push_back({assets.Text(0), assets.Text(1)});
    return task;
  });
}

Result<grammar::Timeline> EpisodeFile::TimelineOf(const EpisodeRow& episode) const {
  return Guarded(path_, [&] {
    grammar::Timeline timeline{.ticks_per_second = episode.ticks_per_second};
    Statement find = database_.Prepare(
        "SELECT id, event, begin_tick, end_tick, decided_tick, open_end, begin_s, end_s, "
        "duration_s FROM event WHERE episode = ? ORDER BY id");
    // Their rows lie in the same order, each read once.
    constexpr const char* kTheirs =
        " WHERE event BETWEEN (SELECT min(id) FROM event WHERE episode = ?1) AND (SELECT max(id) "
        "FROM event WHERE episode = ?1) ORDER BY event, position";
    Statement roles =
        database_.Prepare(std::string("SELECT event, role, value FROM event_role") + kTheirs);
    Statement values = database_.Prepare(
        std::string("SELECT event, name, value, unit FROM event_value") + kTheirs);
    find.Bind(episode.id);
    bool has_role = roles.Bind(episode.id).Step(), has_value = values.Bind(episode.id).Step();
    while (find.Step()) {
      grammar::NamedEvent& event = timeline.events.emplace_back();
      const std::int64_t id = find.Integer(0);
      event.event = find.Text(1);
      event.interval.begin = Between(-kMostTicks, find.Integer(2), kMostTicks);
      event.interval.end = Between(event.interval.begin, find.Integer(3), kMostTicks);
      event.decided = Between(-kMostTicks, find.Integer(4), kMostTicks);
      event.open_end = find.Integer(5) != 0;
      const auto [begin, end] = event.interval;
      const grammar::Tick ticks[] = {begin, end, end - begin};
      for (int i = 0; i < 3; ++i)
        if (find.Double(6 + i) != truth::SecondsOf(ticks[i], episode.ticks_per_second))
          throw Damage(fmt::format("'{}' is {} s where it is tick {}", event.event,
                                   find.Double(6 + i), ticks[i]));
      for (; has_role && roles.Integer(0) <= id; has_role = roles.Step()) {
        if (roles.Integer(0) == id) event.roles.push_back({roles.Text(1), roles.Text(2)});
        if (event.roles.size() > truth::kMostRoles)
          throw Damage(fmt::format("an event has more than {} roles", truth::kMostRoles));
      }
      for (; has_value && values.Integer(0) <= id; has_value = values.Step()) {
        if (values.Integer(0) == id)
          event.values.push_back({values.Text(1), values.Double(2), values.Text(3)});
      }
    }
    const auto begin_of = [](const grammar::NamedEvent& event) { return event.interval.begin; };
    if (!std::ranges::is_sorted(timeline.events, {}, begin_of))
      std::ranges::stable_sort(timeline.events, {}, begin_of);
    return timeline;
  });
}

Result<std::vector<KeptEntity>> EpisodeFile::EntitiesOf(const EpisodeRow& episode) const {
  return Guarded(path_, [&] {
    std::vector<KeptEntity> entities;
    Statement find = database_.Prepare(
        "SELECT entity.number, name, coalesce(part_of, -1), entity_class.class, entity.uuid, "
        "coalesce(mass_kg, 0), size_x_m, size_y_m, size_z_m FROM episode JOIN entity USING(task) "
        "JOIN entity_class ON entity_class.task = entity.task AND entity_class.number = "
        "entity.number WHERE episode.id = ? ORDER BY entity.number, depth");
    find.Bind(episode.id);
    while (find.Step()) {
      const std::int64_t number = find.Integer(0);
      if (number == static_cast<std::int64_t>(entities.size()))
        entities.push_back(
            {.name = find.Text(1),
             .part_of = static_cast<int>(Between(-1, find.Integer(2), 1'000'000'000)),
             .uuid = find.Uuid(4),
             .mass_kg = find.Double(5),
             .size_m = {find.Double(6), find.Double(7), find.Double(8)}});
      if (number + 1 != static_cast<std::int64_t>(entities.size()))
        throw Damage("an entity is missing");
      entities.back().classes.push_back(find.Text(3));
    }
    return entities;
  });
}

Result<std::vector<physics::ScriptNote>> EpisodeFile::NotesOf(const EpisodeRow& episode) const {
  return Guarded(path_, [&] {
    std::vector<physics::ScriptNote> notes;
    Statement find =
        database_.Prepare("SELECT tick, hand, text FROM note WHERE episode = ? ORDER BY position");
    find.Bind(episode.id);
    while (find.Step())
      notes.push_back({find.Integer(0), physics::HandIndex(find.Integer(1)), find.Text(2)});
    return notes;
  });
}

Result<void> EpisodeFile::CheckFrames(const EpisodeRow& episode, int rate_hz) const {
  const auto check = [&] {
    Between(rate_hz, episode.ticks_per_second, rate_hz);
    Statement find = database_.Prepare(
        "SELECT coalesce(min(first_tick), 1), coalesce(max(last_tick), 0), coalesce(sum(frames), "
        "0) FROM chunk WHERE episode = ?");
    find.Bind(episode.id).Step();
    const std::int64_t last = find.Integer(1), frames = find.Integer(2);
    if (find.Integer(0) != 1 || frames != last || last < episode.ticks ||
        (last > episode.ticks && episode.status != kBeingRecorded))
      throw Damage(fmt::format("it has {} frames up to tick {}, wanted one of each of {} ticks",
                               frames, last, episode.ticks));
  };
  return Guarded(path_, check, About(episode));
}

Result<void> EpisodeFile::EachPart(const EpisodeRow& episode, std::size_t part,
                                   const std::function<void(const ChunkOfPart&)>& look) const {
  const auto each = [&] {
    Statement find = database_.Prepare(
        "SELECT chunk.first_tick, frames, data FROM chunk LEFT JOIN part ON part.episode = "
        "chunk.episode AND part = ? AND part.first_tick = chunk.first_tick WHERE chunk.episode = ? "
        "ORDER BY chunk.first_tick");
    find.Bind(static_cast<std::int64_t>(part)).Bind(episode.id);
    while (find.Step()) {
      ChunkOfPart chunk{.first_tick = find.Integer(0),
                        .frames = static_cast<std::size_t>(find.Integer(1))};
      if (!find.IsNothing(2)) chunk.part = find.Bytes(2);
      AtChunk(chunk.first_tick, [&] { look(chunk); });
    }
  };
  return Guarded(path_, each, About(episode));
}

void EpisodeFrames::OpenChunk(Statement& parts, std::int64_t first_tick, std::int64_t frames,
                              bool follows) {
  if (frames < 1 || frames > static_cast<std::int64_t>(kMostFramesOfChunk))
    throw Damage("it has no such number of frames");
  const auto fetch = [&](std::size_t part, bool here) -> std::optional<std::string_view> {
    parts.Reset();
    parts.Bind(episode_.id).Bind(static_cast<std::int64_t>(part));
    parts.Bind(here ? first_tick : 0).Bind(first_tick);
    if (!parts.Step()) return std::nullopt;
    return parts.Bytes(0);
  };
  player_.Open(fetch, first_tick, static_cast<std::size_t>(frames), follows);
}

Result<void> EpisodeFrames::Play(const std::function<void(const physics::Snapshot&)>& look,
                                 const std::function<bool(std::int64_t tick)>& wanted, bool links) {
  const auto play = [&] {
    Statement chunks = file_.database_.Prepare(
        "SELECT first_tick, frames FROM chunk WHERE episode = ? ORDER BY first_tick");
    Statement parts = file_.database_.Prepare(kFindPart);
    chunks.Bind(episode_.id);
    for (std::int64_t next = -1; chunks.Step();) {
      const std::int64_t first = chunks.Integer(0), frames = chunks.Integer(1);
      AtChunk(first, [&] {
        if (next >= 0 && first != next) throw Damage("those before them are missing");
        OpenChunk(parts, first, frames, next >= 0);
        next = first + frames;
        for (std::int64_t tick = first; tick < next; ++tick) {
          if (!wanted || wanted(tick))
            look(player_.Show(static_cast<std::size_t>(tick - first), links));
        }
      });
    }
  };
  return Guarded(file_.path(), play, About(episode_));
}

Result<physics::Snapshot> EpisodeFrames::At(std::int64_t tick) {
  const auto find = [&] {
    Statement chunk = file_.database_.Prepare(
        "SELECT first_tick, frames FROM chunk WHERE episode = ? AND first_tick <= ? ORDER BY "
        "first_tick DESC LIMIT 1");
    if (!chunk.Bind(episode_.id).Bind(tick).Step())
      throw DatabaseError(fmt::format("has no frame up to tick {}", tick));
    const std::int64_t first = chunk.Integer(0), frames = chunk.Integer(1);
    physics::Snapshot snapshot;
    AtChunk(first, [&] {
      Statement parts = file_.database_.Prepare(kFindPart);
      OpenChunk(parts, first, frames, false);
      snapshot = player_.Show(static_cast<std::size_t>(std::min(tick - first, frames - 1)));
    });
    snapshot.moved_tick.clear();
    return snapshot;
  };
  return Guarded(file_.path(), find, About(episode_));
}

Result<std::vector<EpisodeFrames::Moment>> EpisodeFrames::TrackOf(std::size_t body) {
  std::vector<Moment> track;
  physics::Snapshot now = BlankSnapshot(player_.layout());
  const Result<void> read =
      file_.EachPart(episode_, body, [&](const EpisodeFile::ChunkOfPart& chunk) {
        if (track.empty() && !chunk.part) throw Damage("a part is missing");
        std::optional<Columns> columns;
        if (chunk.part) columns = player_.Track(body, *chunk.part);
        if (columns && columns->rows != chunk.frames) throw Damage("a part is too short");
        for (std::size_t frame = 0; frame < chunk.frames; ++frame) {
          if (columns) ReadRow(player_.layout(), body, *columns, frame, now);
          track.push_back({chunk.first_tick + static_cast<std::int64_t>(frame), now.bodies[body]});
        }
      });
  if (!read) return tl::unexpected(read.error());
  return track;
}

}  // namespace prehend::episode
