// SPDX-License-Identifier: Apache-2.0
// Episode files beside a plain table of rows in the same SQLite: 200 bodies that all move, at 60
// Hz. PREHEND_BENCH_FRAMES (1,800) chooses how long; 36,000 are ten minutes. The label of the
// writers is the size of the file per frame. Times are those of the processor.
#include <benchmark/benchmark.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>

#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/record_episode.h"

namespace prehend::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBodies = 200;
constexpr int kRate_hz = 60;

std::int64_t Frames() {
  const char* frames = std::getenv("PREHEND_BENCH_FRAMES");
  return frames ? std::max(60, std::atoi(frames)) : 1800;
}

scenario::Scenario ManyBodies() {
  scenario::Scenario scenario;
  scenario.name = "many_bodies";
  scenario.scene.world.rate_hz = kRate_hz;
  for (std::size_t i = 0; i < kBodies; ++i)
    scenario.scene.bodies.push_back({.name = "body_" + std::to_string(i),
                                     .shapes = {{physics::Box{}, {}}},
                                     .grains = {},
                                     .mass_kg = 1});
  scenario.body_classes.assign(kBodies, "Object");
  scenario.body_part_of.assign(kBodies, -1);
  return scenario;
}

/// Bodies that are shaken: velocities with noise, positions that follow from them.
class Shaken {
 public:
  Shaken() { now_.bodies.resize(kBodies); }
  const physics::Snapshot& Next() {
    ++now_.tick;
    for (physics::BodyState& body : now_.bodies) {
      for (int axis = 0; axis < 3; ++axis) {
        body.v_WB_m_per_s[axis] += 0.1 * any_(random_);
        body.X_WB.p_m[axis] += body.v_WB_m_per_s[axis] / kRate_hz;
        body.w_WB_rad_per_s[axis] = any_(random_);
      }
    }
    return now_;
  }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> any_{-1, 1};
  physics::Snapshot now_;
};

std::string FileNamed(const char* name) {
  return (fs::temp_directory_path() / (name + std::to_string(getpid()))).string();
}

episode::RunResult Ended() {
  episode::RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = Frames();
  return run;
}

void WriteEpisode(const std::string& file, const scenario::Scenario& scenario) {
  fs::remove(file);
  episode::EpisodeRecorder recorder(
      {file,
       "/",
       {.scenario_file = "/many_bodies.yaml", .grammar = "", .settings = {}},
       {},
       "",
       ""},
      scenario);
  Shaken shaken;
  for (std::int64_t i = 0; i < Frames(); ++i) recorder.Add(shaken.Next());
  recorder.Finish(Ended());
  if (!recorder.problem().empty()) std::abort();
}

void WriteRows(const std::string& file) {
  fs::remove(file);
  sqlite3* rows = nullptr;
  sqlite3_open(file.c_str(), &rows);
  sqlite3_exec(
      rows,
      "PRAGMA synchronous=OFF; CREATE TABLE pose(tick INTEGER, body INTEGER, a, b, c, d, e,"
      " f, g, h, i, j, k, l, m, PRIMARY KEY(tick, body)) WITHOUT ROWID; BEGIN",
      nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(rows, "INSERT INTO pose VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)", -1, &insert,
                     nullptr);
  Shaken shaken;
  for (std::int64_t i = 0; i < Frames(); ++i) {
    const physics::Snapshot& now = shaken.Next();
    for (std::size_t b = 0; b < kBodies; ++b) {
      const physics::BodyState& body = now.bodies[b];
      sqlite3_bind_int64(insert, 1, now.tick);
      sqlite3_bind_int64(insert, 2, static_cast<sqlite3_int64>(b));
      for (int k = 0; k < 3; ++k) {
        sqlite3_bind_double(insert, 3 + k, body.X_WB.p_m[k]);
        sqlite3_bind_double(insert, 10 + k, body.v_WB_m_per_s[k]);
        sqlite3_bind_double(insert, 13 + k, body.w_WB_rad_per_s[k]);
      }
      for (int k = 0; k < 4; ++k) sqlite3_bind_double(insert, 6 + k, body.X_WB.q.coeffs()[k]);
      sqlite3_step(insert);
      sqlite3_reset(insert);
    }
  }
  sqlite3_finalize(insert);
  sqlite3_exec(rows, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(rows);
}

void SayBytes(benchmark::State& state, const std::string& file) {
  state.SetLabel(std::to_string(fs::file_size(file) / static_cast<std::uintmax_t>(Frames())) +
                 " bytes a frame");
  state.SetItemsProcessed(state.iterations() * Frames());
}

void RecordEpisode(benchmark::State& state) {
  const scenario::Scenario scenario = ManyBodies();
  const std::string file = FileNamed("bench_record_");
  for (auto _ : state) WriteEpisode(file, scenario);
  SayBytes(state, file);
  fs::remove(file);
}
BENCHMARK(RecordEpisode)->Unit(benchmark::kMillisecond);

void RecordRows(benchmark::State& state) {
  const std::string file = FileNamed("bench_rows_");
  for (auto _ : state) WriteRows(file);
  SayBytes(state, file);
  fs::remove(file);
}
BENCHMARK(RecordRows)->Unit(benchmark::kMillisecond);

/// An open episode for reading.
struct Recorded {
  scenario::Scenario scenario = ManyBodies();
  std::string file = FileNamed("bench_read_");
  std::optional<episode::EpisodeFile> open;
  std::optional<episode::EpisodeFrames> frames;
  Recorded() {
    WriteEpisode(file, scenario);
    open.emplace(*episode::EpisodeFile::Open(file));
    frames.emplace(*open, open->episodes().front(), episode::LayoutOf(scenario.scene));
  }
  ~Recorded() {
    frames.reset();
    open.reset();
    fs::remove(file);
  }
};

void AnyFrameOfAnEpisode(benchmark::State& state) {
  Recorded recorded;
  std::mt19937_64 random(2);
  for (auto _ : state) {
    const auto tick =
        static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(Frames())) + 1;
    const auto frame = recorded.frames->At(tick);
    if (!frame || frame->tick != tick) state.SkipWithError("no frame");
  }
}
BENCHMARK(AnyFrameOfAnEpisode)->Unit(benchmark::kMicrosecond);

void WholeTrackOfABody(benchmark::State& state) {
  Recorded recorded;
  for (auto _ : state) {
    const auto track = recorded.frames->TrackOf(77);
    if (!track || static_cast<std::int64_t>(track->size()) != Frames())
      state.SkipWithError("no track");
  }
}
BENCHMARK(WholeTrackOfABody)->Unit(benchmark::kMillisecond);

/// What a plain table needs for the same.
void FromRows(benchmark::State& state, const char* sql) {
  const std::string file = FileNamed("bench_rows_read_");
  WriteRows(file);
  sqlite3* rows = nullptr;
  sqlite3_open(file.c_str(), &rows);
  sqlite3_stmt* find = nullptr;
  sqlite3_prepare_v2(rows, sql, -1, &find, nullptr);
  for (auto _ : state) {
    sqlite3_bind_int64(find, 1, 77);
    double sum = 0;
    while (sqlite3_step(find) == SQLITE_ROW) {
      for (int i = 2; i < 15; ++i) sum += sqlite3_column_double(find, i);
    }
    benchmark::DoNotOptimize(sum);
    sqlite3_reset(find);
  }
  sqlite3_finalize(find);
  sqlite3_close(rows);
  fs::remove(file);
}
void AnyFrameOfRows(benchmark::State& state) {
  FromRows(state, "SELECT * FROM pose WHERE tick = ?");
}
BENCHMARK(AnyFrameOfRows)->Unit(benchmark::kMicrosecond);
void WholeTrackOfRows(benchmark::State& state) {
  FromRows(state, "SELECT * FROM pose WHERE body = ?");
}
BENCHMARK(WholeTrackOfRows)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace prehend::bench
