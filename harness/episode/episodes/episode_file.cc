// SPDX-License-Identifier: Apache-2.0
// See harness/episode/episodes/episode_file.h. Tested by
// tests/harness/episode/episodes/episode_file_test.cc
#include "harness/episode/episodes/episode_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/write_rows.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kMostAssetBytes = std::size_t{1} << 28;

grammar::Diagnostics Damage(const std::string& file, const std::string& message) {
  return {{.file = file, .place = {}, .message = message, .source_line = {}, .hint = {}}};
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
  return {.kind = Kind::kFailed,
          .tick = row.ticks,
          .entity = "",
          .reason = "its recording was cut off here",
          .advice = "record it again"};
}

}  // namespace

struct EpisodeFile::State {
  Database database;
};

EpisodeFile::EpisodeFile(std::string path, std::unique_ptr<State> state)
    : path_(std::move(path)), state_(std::move(state)) {}
EpisodeFile::~EpisodeFile() = default;
EpisodeFile::EpisodeFile(EpisodeFile&&) noexcept = default;

Result<EpisodeFile> EpisodeFile::Open(const std::string& path) {
  try {
    EpisodeFile file(path, std::make_unique<State>(State{OpenToRead(path)}));
    Statement find = file.state_->database.Prepare(
        "SELECT episode.id, episode.uuid, scenario, status, grammar, ticks_per_second,"
        " CASE status WHEN 'recording' THEN coalesce((SELECT max(last_tick) FROM chunk WHERE"
        " chunk.episode = episode.id), 0) ELSE ticks END, state_hash, outcome, recorded_on,"
        " failure_entity, failure_reason, failure_advice, engine"
        " FROM episode JOIN task ON task.id = episode.task ORDER BY episode.id");
    while (find.Step()) {
      EpisodeRow& row = file.episodes_.emplace_back();
      row = {.id = find.Integer(0),
             .uuid = find.Text(1),
             .scenario = find.Text(2),
             .status = find.Text(3),
             .simulated = find.Text(13) != kNoEngine,
             .grammar = find.Text(4),
             .ticks_per_second = std::max<std::int64_t>(find.Integer(5), 1),
             .ticks = find.Integer(6),
             .state_hash = find.Text(7),
             .outcome = find.Text(8),
             .recorded_on = find.Text(9),
             .end = {}};
      row.end = EndOf(row, find);
    }
    return file;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path, error.what()));
  }
}

Result<TaskFiles> EpisodeFile::TaskOf(const EpisodeRow& episode) const {
  try {
    TaskFiles task;
    Statement find = state_->database.Prepare(
        "SELECT file, asked_grammar, settings, task.id FROM task JOIN episode ON"
        " episode.task = task.id WHERE episode.id = ?");
    if (!find.Bind(episode.id).Step())
      return tl::unexpected(Damage(path_, "the file is damaged: an episode has no task"));
    task.run.scenario_file = find.Text(0);
    task.run.grammar = find.Text(1);
    const auto settings = nlohmann::json::parse(find.Text(2), nullptr, false);
    const std::int64_t id = find.Integer(3);
    if (!settings.is_array())
      return tl::unexpected(Damage(path_, "the file is damaged: a task's settings are no list"));
    for (const auto& setting : settings) {
      if (setting.is_string()) task.run.settings.push_back(setting);
    }
    Statement assets = state_->database.Prepare(
        "SELECT path, hash, content FROM task_asset JOIN asset USING(hash) WHERE task = ?");
    assets.Bind(id);
    Compressor compressor;
    while (assets.Step()) {
      const auto content = compressor.Unpack(assets.Bytes(2), kMostAssetBytes);
      if (!content || ContentHash(*content) != assets.Text(1))
        return tl::unexpected(
            Damage(path_, "the file is damaged: " + assets.Text(0) + " is not what it was"));
      task.files[assets.Text(0)] = std::string(*content);
    }
    return task;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path_, error.what()));
  }
}

Result<KeptTask> EpisodeFile::DescribeTaskOf(const EpisodeRow& episode) const {
  try {
    Statement find = state_->database.Prepare(
        "SELECT task.uuid, shows, task.id FROM task JOIN episode ON episode.task = task.id"
        " WHERE episode.id = ?");
    if (!find.Bind(episode.id).Step())
      return tl::unexpected(Damage(path_, "the file is damaged: an episode has no task"));
    KeptTask task{.uuid = find.Text(0), .shows = find.Text(1), .assets = {}};
    Statement assets =
        state_->database.Prepare("SELECT path, hash FROM task_asset WHERE task = ? ORDER BY path");
    assets.Bind(find.Integer(2));
    while (assets.Step()) task.assets.push_back({assets.Text(0), assets.Text(1)});
    return task;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path_, error.what()));
  }
}

Result<grammar::Timeline> EpisodeFile::TimelineOf(const EpisodeRow& episode) const {
  try {
    grammar::Timeline timeline{.ticks_per_second = episode.ticks_per_second, .events = {}};
    Statement find = state_->database.Prepare(
        "SELECT id, event, begin_tick, end_tick, decided_tick, open_end FROM event"
        " WHERE episode = ? ORDER BY id");
    Statement roles = state_->database.Prepare(
        "SELECT role, value FROM event_role WHERE event = ? ORDER BY position");
    Statement values = state_->database.Prepare(
        "SELECT name, value, unit FROM event_value WHERE event = ? ORDER BY position");
    find.Bind(episode.id);
    while (find.Step()) {
      grammar::NamedEvent& event = timeline.events.emplace_back();
      event.event = find.Text(1);
      event.interval = {find.Integer(2), find.Integer(3)};
      event.decided = find.Integer(4);
      event.open_end = find.Integer(5) != 0;
      roles.Bind(find.Integer(0));
      while (roles.Step()) event.roles.push_back({roles.Text(0), roles.Text(1)});
      roles.Reset();
      values.Bind(find.Integer(0));
      while (values.Step())
        event.values.push_back({values.Text(0), values.Double(1), values.Text(2)});
      values.Reset();
    }
    return timeline;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path_, error.what()));
  }
}

Result<std::vector<KeptEntity>> EpisodeFile::EntitiesOf(const EpisodeRow& episode) const {
  try {
    std::vector<KeptEntity> entities;
    Statement find = state_->database.Prepare(
        "SELECT entity.number, name, coalesce(part_of, -1), entity_class.class, entity.uuid,"
        " coalesce(mass_kg, 0), size_x_m, size_y_m, size_z_m"
        " FROM episode JOIN entity USING(task) JOIN entity_class ON"
        " entity_class.task = entity.task AND entity_class.number = entity.number"
        " WHERE episode.id = ? ORDER BY entity.number, depth");
    find.Bind(episode.id);
    while (find.Step()) {
      const std::int64_t number = find.Integer(0);
      if (number == static_cast<std::int64_t>(entities.size()))
        entities.push_back({.name = find.Text(1),
                            .classes = {},
                            .part_of = static_cast<int>(find.Integer(2)),
                            .uuid = find.Text(4),
                            .mass_kg = find.Double(5),
                            .size_m = {find.Double(6), find.Double(7), find.Double(8)}});
      if (number + 1 != static_cast<std::int64_t>(entities.size()))
        return tl::unexpected(Damage(path_, "the file is damaged: an entity is missing"));
      entities.back().classes.push_back(find.Text(3));
    }
    return entities;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path_, error.what()));
  }
}

Result<std::vector<physics::ScriptNote>> EpisodeFile::NotesOf(const EpisodeRow& episode) const {
  try {
    std::vector<physics::ScriptNote> notes;
    Statement find = state_->database.Prepare(
        "SELECT tick, hand, text FROM note WHERE episode = ? ORDER BY position");
    find.Bind(episode.id);
    while (find.Step())
      notes.push_back({find.Integer(0), physics::HandIndex(find.Integer(1)), find.Text(2)});
    return notes;
  } catch (const DatabaseError& error) {
    return tl::unexpected(Damage(path_, error.what()));
  }
}

std::string EpisodeFile::EachPart(const EpisodeRow& episode, std::size_t part,
                                  const std::function<bool(std::string_view)>& look) const {
  try {
    Statement find = state_->database.Prepare(
        "SELECT number, data FROM chunk LEFT JOIN part ON part.id = chunk.id * ? + ?"
        " WHERE episode = ? ORDER BY number");
    find.Bind(kPartsPerChunk).Bind(static_cast<std::int64_t>(part)).Bind(episode.id);
    for (std::int64_t expected = 0; find.Step(); ++expected) {
      const std::int64_t number = find.Integer(0);
      if (number != expected || find.IsNothing(1) || !look(find.Bytes(1)))
        return fmt::format("the file is damaged: chunk {} of an episode", expected);
    }
  } catch (const DatabaseError& error) {
    return error.what();
  }
  return "";
}

struct EpisodeFrames::State {
  const Database& database;
  std::int64_t episode = 0;
  FramePlayer player;
  PartReader parts;
  Statement find_chunk, find_tick, find_part, all_chunks;

  State(const Database& opened, std::int64_t id, FrameLayout layout)
      : database(opened),
        episode(id),
        player(std::move(layout)),
        parts(player.layout()),
        find_chunk(opened.Prepare("SELECT id FROM chunk WHERE episode = ? AND number = ?")),
        find_tick(opened.Prepare("SELECT id, number FROM chunk WHERE episode = ? AND"
                                 " first_tick <= ? ORDER BY first_tick DESC LIMIT 1")),
        find_part(opened.Prepare("SELECT data FROM part WHERE id = ?")),
        all_chunks(
            opened.Prepare("SELECT id, number FROM chunk WHERE episode = ? ORDER BY number")) {}

  std::optional<std::string_view> Part(std::int64_t chunk, std::size_t part) {
    find_part.Reset();
    find_part.Bind(chunk * kPartsPerChunk + static_cast<std::int64_t>(part));
    if (!find_part.Step()) return std::nullopt;
    return find_part.Bytes(0);
  }

  std::optional<std::string_view> PartBack(std::int64_t chunk, std::int64_t number, Word back,
                                           std::size_t part) {
    if (back == 0) return Part(chunk, part);
    if (back > static_cast<Word>(number)) return std::nullopt;
    find_chunk.Reset();
    find_chunk.Bind(episode).Bind(number - static_cast<std::int64_t>(back));
    if (!find_chunk.Step()) return std::nullopt;
    return Part(find_chunk.Integer(0), part);
  }

  bool Open(std::int64_t chunk, std::int64_t number, bool follows) {
    return player.Open(
        [&](Word back, std::size_t part) { return PartBack(chunk, number, back, part); }, follows);
  }
};

EpisodeFrames::EpisodeFrames(const EpisodeFile& file, const EpisodeRow& episode,
                             FrameLayout layout) {
  try {
    state_ = std::make_unique<State>(file.state_->database, episode.id, std::move(layout));
  } catch (const DatabaseError& error) {
    damage_ = error.what();
  }
}
EpisodeFrames::~EpisodeFrames() = default;

std::string EpisodeFrames::Play(const std::function<void(const physics::Snapshot&)>& look,
                                const std::function<bool(std::int64_t tick)>& wanted, bool links) {
  if (!state_) return damage_;
  try {
    Statement& chunks = state_->all_chunks;
    chunks.Reset();
    chunks.Bind(state_->episode);
    for (std::int64_t expected = 0; chunks.Step(); ++expected) {
      const std::int64_t number = chunks.Integer(1);
      const std::string damage = fmt::format("the file is damaged: chunk {} of an episode", number);
      if (number != expected) return damage + " has no predecessor";
      if (!state_->Open(chunks.Integer(0), number, expected > 0)) return damage;
      const std::vector<std::int64_t>& ticks = state_->player.ticks();
      for (std::size_t frame = 0; frame < ticks.size(); ++frame) {
        if (wanted && !wanted(ticks[frame])) continue;
        const physics::Snapshot* snapshot = state_->player.Show(frame, links);
        if (!snapshot) return damage;
        look(*snapshot);
      }
    }
  } catch (const DatabaseError& error) {
    return error.what();
  }
  return "";
}

std::optional<physics::Snapshot> EpisodeFrames::At(std::int64_t tick) {
  if (!state_) return std::nullopt;
  try {
    State& state = *state_;
    state.find_tick.Reset();
    state.find_tick.Bind(state.episode).Bind(tick);
    if (!state.find_tick.Step()) return std::nullopt;
    if (!state.Open(state.find_tick.Integer(0), state.find_tick.Integer(1), false))
      return std::nullopt;
    const std::vector<std::int64_t>& ticks = state.player.ticks();
    const auto after = std::ranges::upper_bound(ticks, tick);
    const physics::Snapshot* shown =
        state.player.Show(static_cast<std::size_t>(after - ticks.begin()) - 1);
    if (!shown) return std::nullopt;
    physics::Snapshot snapshot = *shown;
    snapshot.moved_tick.clear();
    return snapshot;
  } catch (const DatabaseError&) {
    return std::nullopt;
  }
}

std::optional<std::vector<EpisodeFrames::Moment>> EpisodeFrames::TrackOf(std::size_t body) {
  if (!state_) return std::nullopt;
  try {
    State& state = *state_;
    const FrameLayout& layout = state.player.layout();
    if (body >= layout.bodies) return std::nullopt;
    std::vector<Moment> track;
    physics::Snapshot now = BlankSnapshot(layout);
    Statement& chunks = state.all_chunks;
    chunks.Reset();
    chunks.Bind(state.episode);
    while (chunks.Step()) {
      const std::int64_t chunk = chunks.Integer(0);
      const auto head_bytes = state.Part(chunk, FrameLayout::kHead);
      if (!head_bytes) return std::nullopt;
      const auto head = state.parts.Head(*head_bytes);
      if (!head) return std::nullopt;
      std::optional<Columns> columns;
      if (head->back[body] == 0) {
        const auto bytes = state.Part(chunk, FrameLayout::PartOfTrack(body));
        if (!bytes) return std::nullopt;
        columns = state.parts.Track(body, *bytes);
        if (!columns || columns->rows != head->ticks.size()) return std::nullopt;
      }
      for (std::size_t frame = 0; frame < head->ticks.size(); ++frame) {
        if (columns) WriteRow(layout, body, *columns, frame, now);
        track.push_back({head->ticks[frame], now.bodies[body]});
      }
    }
    return track;
  } catch (const DatabaseError&) {
    return std::nullopt;
  }
}

}  // namespace prehend::episode
