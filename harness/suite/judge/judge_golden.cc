// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"
#include "harness/scenario/transform/transform.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/other_view.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

Finding TruthFinding(const GoldenComparison& compared) {
  std::string reason = DifferingText(compared.truth.Differing());
  if (compared.accepted_differing > 0)
    reason += fmt::format(", the golden records {}", compared.accepted_differing);
  return {.exit_code = ExitCode::kDiffers,
          .reason = std::move(reason),
          .details = GroundTruthText(compared.truth)};
}

bool IsHdf5(const std::filesystem::path& source) {
  return source.extension() == ".hdf5" || source.extension() == ".h5";
}

std::string LackOf(const episode::EpisodeName& name, episode::Episode& opened) {
  const bool has_place = opened.recording() && IsHdf5(opened.loaded().scenario.file);
  return !name.number || has_place ? "" : episode::Lacks(name, episode::Need::kGolden);
}

truth::Golden Propose(const JudgedRecording& judged, std::vector<std::string> derived,
                      std::optional<truth::Acceptance> acceptance) {
  if (derived.empty() && judged.golden) derived = judged.golden->derived;
  return ProposeGolden(judged.golden, judged.segmented.timeline,
                       {.scenario = judged.segmented.name,
                        .grammar = GrammarName(*judged.segmented.program),
                        .derived = std::move(derived),
                        .acceptance = std::move(acceptance),
                        .tolerance = ToleranceOf(judged.segmented)});
}

using grammar::Interval;
using grammar::Tick;

/// Touches within this time are listed.
constexpr double kAround_s = 0.1;
constexpr std::size_t kMaxTouches = 8;

struct Touching {
  int a = 0, b = 0;
  Interval interval;
};

/// Entities of the expected and of the recognised event.
std::set<int> Participants(const truth::Pairing& difference,
                           const grammar::EntityTable& entity_table) {
  std::set<int> ids;
  for (const std::optional<grammar::NamedEvent>* side :
       {&difference.expected, &difference.actual}) {
    if (!*side) continue;
    for (std::size_t i = 0; i < entity_table.entities.size(); ++i) {
      const bool takes_part = std::ranges::any_of((*side)->roles, [&](const auto& role) {
        return role.value == entity_table.entities[i].name;
      });
      if (takes_part) ids.insert(static_cast<int>(i));
    }
  }
  return ids;
}

/// Every touch without a gap of a participant that overlaps the window, in the order of begins.
std::vector<Touching> TouchesIn(Interval window, const std::set<int>& participants,
                                std::span<const physics::Snapshot> recording,
                                episode::Sensing& sensing) {
  std::map<std::pair<int, int>, Touching> open;
  std::vector<Touching> touches;
  const auto close = [&](const Touching& touching) {
    if (touching.interval.end >= window.begin && touching.interval.begin <= window.end)
      touches.push_back(touching);
  };
  for (const physics::Snapshot& snapshot : recording) {
    if (!sensing.Due(snapshot.tick)) continue;
    const grammar::Frame frame = sensing.Sense(snapshot);
    std::map<std::pair<int, int>, Touching> now;
    for (const grammar::Touch& touch : frame.touches) {
      if (!participants.contains(touch.a) && !participants.contains(touch.b)) continue;
      const auto before = open.extract({touch.a, touch.b});
      now[{touch.a, touch.b}] =
          before ? before.mapped() : Touching{touch.a, touch.b, {frame.tick, frame.tick}};
    }
    for (auto& [pair, ended] : open) {
      ended.interval.end = frame.tick;
      close(ended);
    }
    open = std::move(now);
  }
  for (auto& [pair, lasting] : open) {
    lasting.interval.end = recording.back().tick + 1;
    close(lasting);
  }
  std::ranges::sort(touches, {}, [](const Touching& t) {
    return std::tuple(t.interval.begin, t.interval.end, t.a, t.b);
  });
  return touches;
}

/// To millimetres, without a sign before a zero.
double Rounded(double value) { return std::round(1000 * value) / 1000 + 0.0; }

std::string StateText(const grammar::Frame& frame, const std::set<int>& participants,
                      const grammar::EntityTable& entity_table) {
  std::string text;
  for (const int id : participants) {
    const grammar::EntitySample& look = frame.entities[static_cast<std::size_t>(id)];
    text +=
        fmt::format("    {} at ({:.3f}, {:.3f}, {:.3f}) m, {:.3f} m/s, rising {:.3f} m/s",
                    entity_table.entities[static_cast<std::size_t>(id)].name,
                    Rounded(look.p_WB_m.x()), Rounded(look.p_WB_m.y()), Rounded(look.p_WB_m.z()),
                    look.v_WB_m_per_s.norm(), Rounded(look.v_WB_m_per_s.z()));
    for (const grammar::HandSample& hand : frame.hands) {
      if (hand.entity == id) text += fmt::format(", grip {:.2f}", hand.trigger);
    }
    text += "\n";
  }
  return text;
}

// Tested by tests/harness/suite/judge/compare_engines_test.cc

/// Without the events of those who are not in the scenario.
void LeaveOutOthers(const physics::Scene& scene, grammar::Timeline& timeline) {
  std::set<std::string> names;
  for (const physics::Body& body : scene.bodies) names.insert(body.name);
  for (const physics::Hand& hand : scene.hands) names.insert(hand.name);
  for (const physics::Person& person : scene.persons) names.insert(person.name);
  std::erase_if(timeline.events, [&](const grammar::NamedEvent& event) {
    return std::ranges::any_of(event.roles, [&](const grammar::Role& role) {
      return !truth::IsAttribute(role) && !names.contains(role.value);
    });
  });
}

/// Rounded as a golden is written.
double Milliseconds(grammar::Tick ticks, grammar::Tick ticks_per_second) {
  const double ms = 1000.0 * truth::SecondsOf(std::abs(ticks), ticks_per_second);
  return std::round(10 * ms) / 10;
}

/// How far boundaries are from their golden lines, by line; nothing for events without partner.
struct Offset {
  grammar::Tick begin, end;
};
std::vector<std::optional<Offset>> OffsetsOf(const truth::Comparison& comparison,
                                             const truth::Golden& golden) {
  std::vector<std::optional<Offset>> offsets(golden.events.size());
  for (const truth::Pairing& pairing : comparison.pairings)
    if (pairing.expected && pairing.actual)
      offsets[pairing.golden_line] = {pairing.begin_offset, pairing.end_offset};
  return offsets;
}

using physics::Engine;

Engine Other(Engine engine) { return engine == Engine::kBox2d ? Engine::kBullet : Engine::kBox2d; }

}  // namespace

Finding DifferenceFinding(const truth::Comparison& comparison, const std::string& explain,
                          const std::string& facts) {
  const auto differing =
      std::ranges::count_if(comparison.pairings, [](const truth::Pairing& pairing) {
        return pairing.agreement != truth::LineVerdict::kMatched;
      });
  return {.exit_code = ExitCode::kDiffers,
          .reason = fmt::format("{} of {} events differ from the golden", differing,
                                comparison.pairings.size()),
          .details = truth::DifferenceText(comparison, explain, facts)};
}

GoldenComparison CompareWithGolden(const std::optional<truth::Golden>& golden,
                                   const CheckedRun& checked) {
  const scenario::Scenario& scenario = checked.loaded.scenario;
  const grammar::Timeline& timeline = checked.result.timeline;
  const truth::Golden none{.ticks_per_second = timeline.ticks_per_second};
  GoldenComparison compared{
      .has_golden = golden.has_value(),
      .comparison =
          truth::Compare(golden.value_or(none), timeline, scenario::DefaultTolerance(scenario)),
      .truth = CompareWithOracle(scenario, *checked.loaded.program, checked.result),
      .accepted_differing = golden ? AcceptedDiffering(golden->derived) : 0};
  compared.pending = PendingGolden(golden, timeline, checked.id, scenario.grammar, compared.truth);
  return compared;
}

Findings JudgeGolden(const GoldenComparison& compared, const CheckedRun& checked,
                     const std::string& cause) {
  if (!compared.has_golden)
    return {{.exit_code = ExitCode::kPending,
             .reason = checked.in_project
                           ? "no golden yet"
                           : "no golden: only scenarios in scenarios/ of this project have one",
             .details = GroundTruthText(compared.truth)}};
  Findings findings;
  if (compared.Differs()) {
    const truth::Comparison& comparison = compared.comparison;
    const std::string facts = DifferenceContext(checked.loaded.scenario, checked.result.recording,
                                                *comparison.FirstDivergence());
    findings.push_back(DifferenceFinding(comparison, checked.explain, facts));
    findings.back().details += cause;
  }
  if (!compared.TruthIsAccepted()) findings.push_back(TruthFinding(compared));
  return findings;
}

std::string DifferenceContext(const scenario::Scenario& scenario,
                              std::span<const physics::Snapshot> recording,
                              const truth::Pairing& difference) {
  if (recording.empty()) return "";
  const Tick tick = difference.DivergenceTick();
  const grammar::EntityTable entity_table = episode::MakeEntityTable(scenario);
  const std::set<int> participants = Participants(difference, entity_table);
  const Tick rate = entity_table.ticks_per_second;
  const Tick around = truth::TickAt(kAround_s, rate);
  episode::Sensing sensing(scenario.scene, scenario.sensing);

  const auto at = std::ranges::lower_bound(recording, tick, {}, &physics::Snapshot::tick);
  const physics::Snapshot& snapshot = at == recording.end() ? recording.back() : *at;
  std::string text = fmt::format("  facts at {} s (tick {}):\n",
                                 truth::SecondsText(snapshot.tick, rate), snapshot.tick);
  text += StateText(sensing.Sense(snapshot), participants, entity_table);
  const std::vector<Touching> touches =
      TouchesIn({tick - around, tick + around}, participants, recording, sensing);
  for (std::size_t i = 0; i < std::min(touches.size(), kMaxTouches); ++i) {
    const auto name = [&](int id) {
      return entity_table.entities[static_cast<std::size_t>(id)].name;
    };
    text += fmt::format("    {} touches {} {}\n", name(touches[i].a), name(touches[i].b),
                        truth::IntervalText(touches[i].interval, rate));
  }
  if (touches.size() > kMaxTouches)
    text += fmt::format("    and {} more touches\n", touches.size() - kMaxTouches);
  return text;
}

std::string GoldenOf(const episode::EpisodeName& name, const scenario::Scenario& scenario,
                     const std::string& root) {
  namespace fs = std::filesystem;
  fs::path source = name.number ? fs::path(root) / scenario.file : fs::path(name.file);
  if (!name.number || !IsHdf5(source)) return source.replace_extension(".timeline").string();
  return (source.replace_extension(".timelines") / (FileNameOf(scenario.name) + ".timeline"))
      .string();
}

std::string LacksGolden(const episode::EpisodeName& name, const std::string& root) {
  Result<episode::Episode> opened = episode::OpenEpisode(name, {}, root);
  return opened ? LackOf(name, *opened) : Format(opened.error());
}

grammar::Tick ToleranceOf(const episode::SegmentedRecording& segmented) {
  constexpr int kToleratedFrames = 2;
  return kToleratedFrames * segmented.frame_ticks;
}

Result<JudgedRecording> JudgeRecording(const episode::EpisodeName& name, const std::string& grammar,
                                       const std::string& root) {
  PREHEND_TRY(episode::Episode recording, episode::OpenEpisode(name, {grammar, {}}, root));
  if (const std::string lack = LackOf(name, recording); !lack.empty())
    return tl::unexpected(grammar::Diagnostics{{.file = name.file, .message = lack}});
  PREHEND_TRY(episode::SegmentedRecording segmented, recording.SegmentRecorded());
  return JudgeSegmented(std::move(segmented), GoldenOf(name, recording.loaded().scenario, root));
}

Result<JudgedRecording> JudgeSegmented(episode::SegmentedRecording segmented,
                                       const std::string& golden_file) {
  PREHEND_TRY(auto golden, truth::ReadGoldenFile(golden_file, segmented.name));
  JudgedRecording judged{
      .segmented = std::move(segmented), .golden = std::move(golden), .golden_file = golden_file};
  const grammar::Timeline& timeline = judged.segmented.timeline;
  const truth::Golden none{.ticks_per_second = timeline.ticks_per_second};
  judged.comparison =
      truth::Compare(judged.golden.value_or(none), timeline, ToleranceOf(judged.segmented));
  judged.proposed = Propose(judged, {}, std::nullopt);
  return judged;
}

std::string OtherGrammarText(const JudgedRecording& judged) {
  const std::string now = GrammarName(*judged.segmented.program);
  if (!judged.golden || judged.golden->grammar == now) return "";
  return fmt::format(
      "the golden is of grammar '{}', and this is what '{}' recognises; --grammar names another "
      "one\n",
      judged.golden->grammar, now);
}

std::string ReviewText(const JudgedRecording& judged, const std::string& explain) {
  if (!judged.golden) return EventLines(judged.proposed);
  return truth::DifferenceText(judged.comparison, explain) + OtherGrammarText(judged);
}

truth::Golden AcceptedRecording(const JudgedRecording& judged,
                                const std::vector<std::string>& derived,
                                truth::Acceptance acceptance) {
  return Propose(judged, derived, std::move(acceptance));
}

Ensemble PlayEnsemble(const episode::LoadedRun& loaded, const grammar::Timeline& here,
                      const truth::Golden& golden) {
  Ensemble ensemble;
  ensemble.spreads.resize(golden.events.size());
  const auto offsets_here =
      OffsetsOf(truth::Compare(golden, here, scenario::DefaultTolerance(loaded.scenario)), golden);
  for (const scenario::Transform transform : scenario::kTransforms) {
    auto scenario = scenario::Transformed(loaded.scenario, transform);
    if (!scenario) continue;
    const std::string name(NameOf(transform));
    TransformedPlay play = Play({.name = name,
                                 .scenario = std::move(*scenario),
                                 .tolerance = scenario::DefaultTolerance(loaded.scenario)},
                                loaded, golden);
    ++ensemble.plays;
    Findings broken = BrokenIn(play, name);
    if (!broken.empty()) ++ensemble.plays_broken;
    Append(ensemble.broken, std::move(broken));
    Append(ensemble.differences, std::move(play.differs));
    if (!play.comparison) continue;
    const auto offsets = OffsetsOf(*play.comparison, golden);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (!offsets[i] || !offsets_here[i]) continue;
      const auto widen = [&](grammar::Tick moved, double& spread_ms) {
        spread_ms = std::max(spread_ms, Milliseconds(moved, here.ticks_per_second));
      };
      widen(offsets[i]->begin - offsets_here[i]->begin, ensemble.spreads[i].begin_ms);
      widen(offsets[i]->end - offsets_here[i]->end, ensemble.spreads[i].end_ms);
    }
  }
  return ensemble;
}

void KeepSpreads(const Ensemble& ensemble, truth::Golden& golden) {
  golden.ensemble_plays = ensemble.plays;
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    if (golden.events[i].spread == ensemble.spreads[i]) continue;
    golden.events[i].spread = ensemble.spreads[i];
    golden.events[i].as_written.clear();
  }
}

TransformedPlay Play(const TransformedScenario& there, const episode::LoadedRun& original,
                     const truth::Golden& here) {
  TransformedPlay play;
  episode::RunResult run = episode::RunScenario(there.scenario, original.program);
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    play.failed = {{.reason = there.name + ": the simulation failed",
                    .details = there.name + ": " + episode::StatusText(run) + "\n"}};
    return play;
  }
  if (there.rename_back) there.rename_back(run.timeline);
  LeaveOutOthers(original.scenario.scene, run.timeline);
  play.claims = JudgeClaims(original, run.timeline);
  play.comparison = truth::Compare(here, run.timeline, there.tolerance);
  if (!play.comparison->Agrees())
    play.differs = {{.reason = fmt::format("{}: {} of {} events differ", there.name,
                                           play.comparison->Differing().size(),
                                           play.comparison->pairings.size()),
                     .details = "recognised after '" + there.name + "', expected as without it:\n" +
                                truth::DifferenceText(*play.comparison, "")}};
  return play;
}

Findings BrokenIn(const TransformedPlay& play, const std::string& name) {
  Findings findings = play.failed;
  for (Finding& finding : ClaimFindings(play.claims))
    findings.push_back({.exit_code = finding.exit_code,
                        .reason = name + ": " + finding.reason,
                        .details = name + ": " + finding.details});
  return findings;
}

const char* NameOf(Engine engine) {
  switch (engine) {
    case Engine::kBox2d:
      return "box2d";
    case Engine::kBulletStock:
      return "bullet_stock";
    case Engine::kBullet:
      break;
  }
  return "bullet";
}

episode::RunResult RunInOtherEngine(scenario::Scenario scenario,
                                    std::shared_ptr<const grammar::Program> program,
                                    const episode::RunOptions& options) {
  scenario.scene.world.engine = Other(scenario.scene.world.engine);
  return episode::RunScenario(scenario, std::move(program), options);
}

grammar::Tick EngineTolerance(const grammar::Timeline& timeline) {
  return std::llround(0.05 * static_cast<double>(timeline.ticks_per_second));
}

truth::Golden GoldenOf(const grammar::Timeline& timeline) {
  truth::Golden golden{.ticks_per_second = timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : timeline.events)
    golden.events.push_back({.event = event});
  return golden;
}

std::optional<EngineComparison> CompareEngines(const scenario::Scenario& scenario,
                                               std::shared_ptr<const grammar::Program> program,
                                               const grammar::Timeline& timeline) {
  if (!scenario.scene.world.planar) return std::nullopt;
  EngineComparison result{.other = Other(scenario.scene.world.engine),
                          .run = RunInOtherEngine(scenario, std::move(program))};
  if (result.run.status.kind == physics::RunStatus::Kind::kCompleted)
    result.comparison =
        truth::Compare(GoldenOf(timeline), result.run.timeline, EngineTolerance(timeline));
  return result;
}

bool Agrees(const EngineComparison& compared) {
  return compared.run.status.kind == physics::RunStatus::Kind::kCompleted &&
         compared.comparison.Agrees();
}

std::string EngineDifferenceText(const scenario::Scenario& scenario,
                                 const EngineComparison& compared, const std::string& explain) {
  if (Agrees(compared)) return "";
  const std::string other = NameOf(compared.other),
                    again = explain + " --set world.engine=" + other;
  if (compared.run.status.kind != physics::RunStatus::Kind::kCompleted)
    return "in " + other + ": " + episode::StatusText(compared.run) + "\nsee: " + again + "\n";
  return "recognised in " + other + ", expected as recognised in " +
         NameOf(scenario.scene.world.engine) + ":\n" +
         truth::DifferenceText(compared.comparison, again);
}

}  // namespace prehend::suite
