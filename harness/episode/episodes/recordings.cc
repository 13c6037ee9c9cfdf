// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/recordings.h"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

#include "grammar/contents.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/frames/frame_layout.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {
namespace {

/// Of a recording, a chunk has one part.
constexpr std::size_t kFramesPart = 0;

grammar::Diagnostics NotRead(const EpisodeFile& file, const EpisodeRow& row,
                             const std::string& message) {
  return {{.file = file.path(),
           .message = fmt::format("episode {} ({}): {}", row.id, row.scenario, message)}};
}

std::string FirstLine(const EpisodeHeader& header) {
  std::ostringstream line;
  const EpisodeWriter writer(line, header);
  return std::move(line).str();
}

/// `where`: for messages.
Result<EpisodeHeader> ReadFirstLine(const std::string& where, const std::string& line) {
  EpisodeStream stream(where);
  grammar::Diagnostics wrong = stream.Take(line);
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  return stream.header();
}

bool IsPath(const std::string& grammar) {
  return grammar.find('/') != std::string::npos || grammar.ends_with(".grammar");
}

NewTask TaskOf(const ImportRequest& request, const EpisodeHeader& header,
               const std::vector<std::string>& grammars) {
  std::string asked = request.grammar;
  if (asked.empty() && IsPath(header.grammar)) asked = header.grammar;
  NewTask task{.files = PackTask({request.source, asked, {}}, grammars, request.root),
               .scenario = header.episode,
               .entities = header.entity_table};
  task.files.files[kHeaderFile] = FirstLine(header);
  return task;
}

void WriteFrames(const Database& database, std::int64_t row, Recording& recording) {
  ChunkRows rows(database, row);
  TablePacker packer;
  std::vector<EpisodeFrame> waiting;
  const auto write = [&] {
    const auto frames = std::span(waiting).first(FramesOfChunk(waiting));
    rows.Write({.first_tick = frames.front().tick,
                .last_tick = frames.back().tick,
                .frames = frames.size(),
                .parts = {{kFramesPart, packer.Pack(TablesOfFrames(frames, recording.placed))}}});
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(frames.size()));
  };
  recording.EachFrame([&](const EpisodeFrame& frame) {
    waiting.push_back(frame);
    if (waiting.size() >= kMostFramesOfChunk) write();
  });
  while (!waiting.empty()) write();
}

void AddTo(physics::StateHash& hash, const EpisodeFrame& frame) {
  const auto add = [&](double value) { hash.Add(&value, 1); };
  const auto add_integer = [&](std::int64_t value) { hash.Add(static_cast<std::uint64_t>(value)); };
  add_integer(frame.tick);
  for (const grammar::EntitySample& look : frame.entities) {
    hash.Add({.X_WB = {look.p_WB_m, look.q_WB},
              .v_WB_m_per_s = look.v_WB_m_per_s,
              .w_WB_rad_per_s = look.w_WB_rad_per_s});
    add(look.joint_position);
    add(look.joint_fraction);
    add_integer(look.gazes_at);
  }
  for (const grammar::HandSample& hand : frame.hands) {
    add(hand.trigger);
    add_integer(hand.style);
    hash.Add(hand.ahead_W.data(), 3);
  }
  for (const auto& of_hand : frame.collision_spheres) {
    for (const grammar::CollisionSphere& sphere : of_hand) {
      hash.Add(sphere.p_W_m.data(), 3);
      add(sphere.radius_m);
    }
  }
  for (const grammar::Touch& touch : frame.touches) {
    add_integer(touch.a);
    add_integer(touch.b);
    add(touch.up_on_a);
    add(touch.up_on_b);
    add(touch.normal_force_n);
    add(touch.vertical_speed_m_per_s);
    hash.Add(touch.p_W_m.data(), 3);
    hash.Add(touch.nhat_BA_W.data(), 3);
    add_integer(touch.sensor_sets);
  }
}

}  // namespace

std::uint64_t HashOfFrames(Recording& recording) {
  if (recording.hash != 0) return recording.hash;
  physics::StateHash hash;
  recording.EachFrame([&](const EpisodeFrame& frame) { AddTo(hash, frame); });
  return hash.value();
}

Result<ImportedRecording> ImportRecording(const ImportRequest& request, Recording& recording) {
  // What is segmented now is what is read later.
  PREHEND_TRY(recording.header, ReadFirstLine(request.source, FirstLine(recording.header)));
  std::vector<std::string> grammars;
  grammar::CompileResult compiled =
      LoadGrammarOf(recording.header, request.grammar, request.root, {}, &grammars);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  PREHEND_TRY(auto segmented,
              SegmentRecording(recording, std::move(compiled.program), request.source));
  ImportedRecording imported{.segmented = std::move(segmented), .problem = {}};
  const EpisodeHeader& header = recording.header;
  RunResult end;
  end.ticks = recording.end_tick - 1;
  end.state_hash = HashOfFrames(recording);
  end.timeline = imported.segmented.timeline;
  const NewTask task = TaskOf(request, header, grammars);
  const auto lock = LockToRecord(request.file, Writer::kAdds);  // nothing is made for what is wrong
  imported.problem = !lock ? lock.error() : ProblemOf(request.file, [&] {
    const Database database = OpenToWrite(request.file);
    Transaction transaction(database);
    const std::string uuid =
        request.once
            ? UuidOf(fmt::format("{}\n{}\n{}\n{} {}", task.scenario, task.files.Identity(),
                                 request.program_hash, HashText(end.state_hash), end.ticks))
            : "";
    Statement find = database.Prepare("SELECT 1 FROM episode WHERE uuid = ?");
    imported.was_there = find.Bind(uuid).Step();
    if (imported.was_there) return;
    const std::int64_t row = WriteEpisode(database, WriteTask(database, task),
                                          {.grammar = GrammarName(*imported.segmented.program),
                                           .ticks_per_second = header.entity_table.ticks_per_second,
                                           .engine = kNoEngine,
                                           .seed = 0,
                                           .program_hash = request.program_hash,
                                           .recorded_on = request.recorded_on,
                                           .uuid = uuid});
    WriteFrames(database, row, recording);
    WriteEnd(database, row, recording.says_its_end ? kCompleted : kUnfinished, end,
             header.entity_table);
    transaction.Commit();
  });
  return imported;
}

Result<EpisodeHeader> ReadRecordingHeader(const EpisodeFile& file, const EpisodeRow& row) {
  PREHEND_TRY(const TaskFiles task, file.TaskOf(row));
  const auto header = task.files.find(kHeaderFile);
  if (header == task.files.end())
    return tl::unexpected(NotRead(file, row, "the file is damaged: it has no entities"));
  return ReadFirstLine(file.path() + ": " + kHeaderFile, header->second);
}

Result<Recording> ReadRecording(const EpisodeFile& file, const EpisodeRow& row) {
  PREHEND_TRY(EpisodeHeader header, ReadRecordingHeader(file, row));
  Recording recording;
  recording.header = std::move(header);
  recording.end_tick = row.ticks + 1;
  recording.says_its_end = row.status == kCompleted;
  const auto play = [&file, row, entities = recording.header.entity_table](
                        const Recording::Look& look, std::vector<bool>* placed) -> Result<void> {
    TablePacker packer;
    std::size_t count = 0;
    grammar::Tick last = row.ticks + 1;  // of none
    const auto take = [&](const EpisodeFile::ChunkOfPart& chunk) {
      if (!chunk.part) throw Damage("a part is missing");
      RecordedFrames read = FramesOfTables(packer.Unpack(*chunk.part), entities);
      const bool follows = count == 0 || last < read.frames.front().tick;
      count += read.frames.size();
      if (!follows || count > kMaxEpisodeFrames)
        throw Damage("they do not follow those before them");
      last = read.frames.back().tick;
      if (placed) *placed = std::move(read.placed);
      for (EpisodeFrame& frame : read.frames) look(frame);
    };
    Result<void> done = file.EachPart(row, kFramesPart, take);
    if (done && last > row.ticks)
      return tl::unexpected(NotRead(file, row, "the file is damaged: frames are missing"));
    return done;
  };
  physics::StateHash hash;
  const Result<void> done =
      play([&](const EpisodeFrame& frame) { AddTo(hash, frame); }, &recording.placed);
  if (!done) return tl::unexpected(done.error());
  if (const std::string text = HashText(hash.value()); text != row.state_hash)
    return tl::unexpected(
        NotRead(file, row,
                fmt::format("the file is damaged: its frames have the hash {}, recorded was {}",
                            text, row.state_hash)));
  recording.hash = hash.value();
  recording.play = [play](const Recording::Look& look) {
    if (const Result<void> again = play(look, nullptr); !again)
      throw std::runtime_error(grammar::Format(again.error()));
  };
  return recording;
}

}  // namespace prehend::episode
