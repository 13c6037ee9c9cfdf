// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/load_episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "grammar/contents.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {
namespace {

tl::unexpected<grammar::Diagnostics> Failure(const EpisodeFile& file, const EpisodeRow& episode,
                                             const std::string& message) {
  return tl::unexpected(grammar::Diagnostics{
      {.file = file.path(),
       .message = fmt::format("episode {} ({}): {}", episode.id, episode.scenario, message)}});
}

/// What has no extent is drawn this large.
constexpr double kLeastSize_m = 0.002;

bool IsHandEntity(const grammar::EntityInfo& entity) { return entity.classes.front() == "Hand"; }

/// What encloses these points, where they are no hull of their own.
physics::PlacedShape BoxAround(const std::vector<Eigen::Vector3d>& points_m) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points_m) box.extend(point);
  physics::PlacedShape placed{physics::Box{box.sizes().cwiseMax(kLeastSize_m)}, {}};
  placed.X_BS.p_m = box.center();
  return placed;
}

/// A shape in its own frame S.
struct ShapeShown {
  physics::PlacedShape operator()(const grammar::Box& box) const {
    return {physics::Box{2 * box.half_size_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Ball& ball) const {
    return {physics::Sphere{ball.radius_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Cylinder& cylinder) const {
    return {physics::Cylinder{cylinder.radius_m, 2 * cylinder.half_length_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Capsule& capsule) const {
    return {physics::Capsule{capsule.radius_m, 2 * capsule.half_length_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Hull& hull) const {
    physics::MadeHull made = physics::MakeHull(hull.points_m);
    if (!made.hull) return BoxAround(hull.points_m);
    return {std::move(*made.hull), {}};
  }
};

std::vector<physics::PlacedShape> ShapesOf(const grammar::EntityInfo& entity) {
  std::vector<physics::PlacedShape> shapes;
  for (const grammar::SolidPart& part : entity.solid.parts()) {
    physics::PlacedShape shape = std::visit(ShapeShown{}, part.shape);
    shape.X_BS = physics::Pose{part.p_BS_m, part.q_BS} * shape.X_BS;
    shapes.push_back(std::move(shape));
  }
  if (!shapes.empty()) return shapes;
  physics::PlacedShape whole{physics::Box{(2 * entity.half_size_m).cwiseMax(kLeastSize_m)}, {}};
  if (entity.round) whole.shape = physics::Sphere{entity.half_size_m.maxCoeff()};
  whole.X_BS.p_m = entity.p_BC_m;
  return {std::move(whole)};
}

physics::Abstract AbstractOf(const std::vector<std::string>& classes) {
  using physics::Abstract;
  const auto is = [&](const char* name) {
    return std::ranges::find(classes, name) != classes.end();
  };
  if (!is("Abstract")) return Abstract::kNot;
  if (is("Camera")) return Abstract::kCamera;
  if (is("Light")) return Abstract::kLight;
  return is("GazeTarget") ? Abstract::kGazeTarget : Abstract::kRegion;
}

physics::Hand HandOf(const grammar::EntityInfo& entity, const std::vector<std::string>& styles) {
  physics::Hand hand{.name = entity.name};
  hand.model.name = "palm";
  if (!entity.half_size_m.isZero())
    hand.model.palm_size_m = (2 * entity.half_size_m).cwiseMax(kLeastSize_m);
  hand.model.sensor_sets = entity.sensor_sets;
  for (const std::string& style : styles) hand.model.styles.push_back({.name = style});
  return hand;
}

/// Where an entity of the recording is in the scene.
struct Placeholder {
  int body = -1, hand = -1;
};

std::vector<Placeholder> PlaceholdersOf(const grammar::EntityTable& table) {
  std::vector<Placeholder> all;
  int bodies = 0, hands = 0;
  for (const grammar::EntityInfo& entity : table.entities)
    all.push_back(IsHandEntity(entity) ? Placeholder{.hand = hands++}
                                       : Placeholder{.body = bodies++});
  return all;
}

physics::BodyState StateOf(const grammar::EntitySample& look) {
  return {.X_WB = {look.p_WB_m, look.q_WB},
          .v_WB_m_per_s = look.v_WB_m_per_s,
          .w_WB_rad_per_s = look.w_WB_rad_per_s,
          .asleep = look.asleep};
}

}  // namespace

void EpisodeLoader::Refresh() {
  if (library_.read_hand && writes_read_ == tasks_.writes()) return;
  library_ = ProjectLibrary(tasks_.root());
  library_.were_played = true;
  library_.reads_recording = [this](const std::string& path) { return tasks_.Within(path); };
  library_.read_hand = [this, read = std::move(library_.read_hand)](
                           const std::string& hand, std::vector<std::string> grasps) {
    for (std::string& path : grasps) path = tasks_.Within(path);
    return read(hand.ends_with(".yaml") ? tasks_.Within(hand) : hand, grasps);
  };
  std::erase_if(programs_, [](const auto& known) { return known.first.is_own; });
  writes_read_ = tasks_.writes();
}

grammar::CompileResult EpisodeLoader::Compile(bool is_own, const std::string& name_or_path,
                                              const grammar::Overrides& overrides) {
  const std::string found = is_own ? tasks_.GrammarWithin(name_or_path) : name_or_path;
  const GrammarKey key{is_own, found, overrides};
  if (const auto known = programs_.find(key); known != programs_.end()) return {known->second, {}};
  const auto original = [&](const std::string& path) { return tasks_.Original(path); };
  grammar::CompileResult compiled =
      is_own ? LoadGrammar(tasks_.root(), found, overrides, nullptr, {}, original)
             : LoadGrammar(root_, found, overrides);
  if (compiled.program) programs_.emplace(key, compiled.program);
  return compiled;
}

grammar::Diagnostics EpisodeLoader::OfTask(grammar::Diagnostics diagnostics,
                                           const EpisodeFile& file,
                                           const EpisodeRow& episode) const {
  for (grammar::Diagnostic& diagnostic : diagnostics) {
    diagnostic.file = file.path() + ": " + tasks_.Original(diagnostic.file);
    if (diagnostic.message != "no such file") continue;
    diagnostic.message =
        fmt::format("no such file was kept with episode {} ({})", episode.id, episode.scenario);
  }
  return diagnostics;
}

Result<LoadedRun> EpisodeLoader::LoadRecording(const EpisodeFile& file, const EpisodeRow& episode,
                                               const TaskFiles& task, const GrammarChoice& choice) {
  PREHEND_TRY(EpisodeHeader header, ReadRecordingHeader(file, episode));
  PREHEND_TRY(grammar::Overrides overrides, ParameterSettings(choice.settings));
  const bool is_own = choice.grammar.empty();
  const std::string asked = tasks_.RequestOf(task).grammar;
  const std::string own = asked.empty() ? header.grammar : asked;
  const std::string name = is_own ? own : choice.grammar;
  grammar::CompileResult compiled = Compile(is_own, name, overrides);
  if (!compiled.program && is_own)
    return tl::unexpected(OfTask(std::move(compiled.diagnostics), file, episode));
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  LoadedRun loaded{
      .scenario = PlaceholderFor(header), .program = std::move(compiled.program), .grammar = name};
  loaded.scenario.file = task.run.scenario_file;
  loaded.scenario.grammar = GrammarName(*loaded.program);
  if (!is_own || !choice.settings.empty())
    loaded.warnings = Warnings(*loaded.program, header.entity_table);
  return loaded;
}

Result<LoadedRun> EpisodeLoader::Load(const EpisodeFile& file, const EpisodeRow& episode,
                                      const GrammarChoice& choice) {
  PREHEND_TRY(const TaskFiles task, file.TaskOf(episode));
  if (const std::string problem = tasks_.Unpack(task); !problem.empty())
    return Failure(file, episode, problem);
  Refresh();
  if (!episode.simulated) return LoadRecording(file, episode, task, choice);
  const auto load_grammar = [&](const std::string& name, const grammar::Overrides& overrides) {
    return Compile(true, name, overrides);
  };
  Result<LoadedRun> loaded = LoadRun(tasks_.RequestOf(task), tasks_.root(), library_, load_grammar);
  if (!loaded) return tl::unexpected(OfTask(std::move(loaded.error()), file, episode));
  loaded->scenario.file = tasks_.Original(loaded->scenario.file);
  loaded->warnings.clear();  // they were shown when it was recorded
  if (choice.grammar.empty() && choice.settings.empty()) return loaded;

  PREHEND_TRY(grammar::Overrides overrides, ParameterSettings(choice.settings));
  const bool is_own = choice.grammar.empty();
  if (!is_own) loaded->grammar = choice.grammar;
  grammar::CompileResult compiled = Compile(is_own, loaded->grammar, overrides);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  loaded->program = std::move(compiled.program);
  loaded->scenario.grammar = GrammarName(*loaded->program);
  loaded->warnings = Warnings(*loaded->program, MakeEntityTable(loaded->scenario));
  return loaded;
}

Result<RunResult> Resegment(const EpisodeFile& file, const EpisodeRow& episode,
                            const LoadedRun& loaded, bool frames) {
  RunResult run;
  run.status = episode.end;
  run.ticks = episode.ticks;
  run.outcome = episode.outcome;
  run.drawings = truth::EventDrawings(*loaded.program);
  Sensing sensing(loaded.scenario.scene, loaded.scenario.sensing);
  EpisodeFrames kept(file, episode, LayoutOf(loaded.scenario.scene));
  physics::StateHash hash;
  Result<void> played;
  const FrameFeed play = [&](const std::function<void(const FrameNews&)>& take) {
    played = kept.Play(
        [&](const physics::Snapshot& snapshot) {
          if (frames) hash.Add(snapshot);
          if (frames) run.recording.push_back(snapshot);
          if (sensing.Due(snapshot.tick)) take(sensing.SenseChanges(snapshot));
        },
        [&](std::int64_t tick) { return frames || sensing.Due(tick); });
    return run.ticks + 1;
  };
  Segmentation segmentation = Segment(loaded.program, MakeEntityTable(loaded.scenario), play);
  if (!played) return tl::unexpected(std::move(played.error()));
  if (!segmentation.problem.empty())
    return Failure(file, episode, "the grammar cannot segment it: " + segmentation.problem);
  run.timeline = std::move(segmentation.timeline);
  run.state_hash = frames ? hash.value() : std::strtoull(episode.state_hash.c_str(), nullptr, 16);
  if (frames && episode.status != kBeingRecorded && HashText(run.state_hash) != episode.state_hash)
    return Failure(file, episode,
                   fmt::format("the file is damaged: its frames have the state hash {}, recorded "
                               "was {}",
                               HashText(run.state_hash), episode.state_hash));
  PREHEND_TRY(run.notes, file.NotesOf(episode));
  return run;
}

scenario::Scenario PlaceholderFor(const EpisodeHeader& header) {
  const grammar::EntityTable& table = header.entity_table;
  const std::vector<Placeholder> places = PlaceholdersOf(table);
  scenario::Scenario scenario;
  scenario.name = header.episode;
  scenario.grammar = header.grammar;
  scenario.scene.world.rate_hz = static_cast<int>(table.ticks_per_second);
  for (const grammar::EntityInfo& entity : table.entities) {
    if (IsHandEntity(entity)) {
      scenario.scene.hands.push_back(HandOf(entity, table.styles));
      continue;
    }
    physics::Body& body = scenario.scene.bodies.emplace_back();
    body.name = entity.name;
    body.shapes = ShapesOf(entity);
    body.abstract = AbstractOf(entity.classes);
    body.fixed = std::ranges::find(entity.classes, "Fixed") != entity.classes.end();
    body.mass_kg = entity.mass_kg;
    scenario.body_classes.push_back(entity.classes.front());
    scenario.body_part_of.push_back(entity.part_of == grammar::kNoEntity
                                        ? grammar::kNoEntity
                                        : places[static_cast<std::size_t>(entity.part_of)].body);
    for (std::size_t i = 1; i < entity.classes.size(); ++i) {
      const std::string& below = entity.classes[i - 1];
      if (grammar::IsRootClass(below)) break;
      if (std::ranges::find(scenario.base_classes, below, &scenario::BaseClass::name) ==
          scenario.base_classes.end())
        scenario.base_classes.push_back({below, entity.classes[i]});
    }
  }
  return scenario;
}

physics::Snapshot PlaceholderSnapshotAt(const EpisodeHeader& header, const EpisodeFrame& frame) {
  const grammar::EntityTable& table = header.entity_table;
  const std::vector<Placeholder> places = PlaceholdersOf(table);
  physics::Snapshot snapshot;
  snapshot.tick = frame.tick;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const physics::BodyState state = StateOf(frame.entities[i]);
    if (places[i].body >= 0) {
      snapshot.bodies.push_back(state);
    } else {
      physics::HandState& hand = snapshot.hands.emplace_back();
      hand.palm = state;
      hand.palm.asleep = false;
      hand.X_WTarget = state.X_WB;
    }
  }
  for (std::size_t i = 0; i < frame.hands.size(); ++i) {
    snapshot.hands[i].trigger = frame.hands[i].trigger;
    snapshot.hands[i].style = frame.hands[i].style;
  }
  const auto side = [&](int entity) -> physics::ContactSide {
    const Placeholder& place = places[static_cast<std::size_t>(entity)];
    return {.body = physics::BodyIndex(place.body), .hand = physics::HandIndex(place.hand)};
  };
  for (const grammar::Touch& touch : frame.touches) {
    if (touch.nhat_BA_W.isZero()) continue;  // where it is is not known
    snapshot.contacts.push_back(
        {.a = side(touch.a),
         .b = side(touch.b),
         .p_W_m = touch.p_W_m,
         .nhat_BA_W = touch.nhat_BA_W,
         .distance_m = 0,
         .normal_impulse_n_s = touch.normal_force_n / static_cast<double>(table.ticks_per_second)});
  }
  return snapshot;
}

}  // namespace prehend::episode
