// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episode/episode.h"
#include "harness/show/pictures/pictures.h"
#include "harness/truth/timeline/event_text.h"
#include "physics/scene/geometry.h"

namespace prehend::show {
namespace {

using grammar::DrawnAs;
using grammar::NamedEvent;

constexpr double kAtOnce_s = 0.15;

struct Phase {
  double begin_s = 0, end_s = 0;
  std::string name;
  std::vector<std::string> involved;
};

/// What hands do, if it begins in the window.
std::vector<Phase> PhasesIn(const episode::RunResult& run, const Window& window) {
  std::vector<Phase> phases;
  for (const NamedEvent& event : run.timeline.events) {
    Phase phase{.begin_s = SecondsOf(run, event.interval.begin),
                .end_s = SecondsOf(run, event.interval.end),
                .name = event.event};
    const bool is_phase = run.drawings.Of(event.event).as == DrawnAs::kPhase;
    if (!is_phase || phase.begin_s < window.from_s || phase.begin_s > window.to_s) continue;
    for (const grammar::Role& role : event.roles) phase.involved.push_back(role.value);
    phases.push_back(std::move(phase));
  }
  return phases;
}

using episode::EventAnswer;

/// An episode, played.
struct Shown {
  episode::LoadedRun loaded;
  episode::RunResult run;
};

Result<Shown> Play(const Moment& moment, episode::EpisodeOpener& opener) {
  PREHEND_TRY(episode::Episode episode,
              opener.Open({.file = moment.file, .number = moment.episode}));
  PREHEND_TRY(episode::RunResult run, episode.Run(true));
  return Shown{std::move(episode.loaded()), std::move(run)};
}

PictureFormat FormatOf(const Moment& moment, const physics::Scene& scene) {
  PictureFormat format;
  format.from_s = moment.from_s;
  format.to_s = moment.to_s;
  format.marked = moment.marked;
  for (const std::string& name : moment.of) {
    const auto is_it = [&](const auto& entity) { return entity.name == name; };
    if (format.only.empty() && std::ranges::any_of(scene.hands, is_it)) format.only = name;
    if (format.of.empty() && std::ranges::any_of(scene.bodies, is_it)) format.of = name;
  }
  return format;
}

std::string FileName(std::size_t number, const Moment& moment) {
  const std::string scenario = moment.scenario.substr(moment.scenario.rfind('/') + 1);
  return FileNameOf(fmt::format("{:03}-{}-{}", number, scenario, moment.name)) + ".png";
}

}  // namespace

std::vector<KeyMoment> KeyMoments(const episode::RunResult& run, const Window& window,
                                  std::size_t most) {
  std::vector<Phase> phases = PhasesIn(run, window);
  std::map<double, KeyMoment> moments;
  const auto add = [&](double time_s, const std::string& caption, const Phase* phase) {
    if (moments.size() >= most || time_s > window.to_s) return;
    moments.try_emplace(
        time_s, KeyMoment{.time_s = time_s,
                          .caption = caption,
                          .involved = phase ? phase->involved : std::vector<std::string>()});
  };
  const Phase* last =
      phases.empty() ? nullptr : &*std::ranges::max_element(phases, {}, &Phase::end_s);
  // The begin of an episode in which something happens at once shows nothing of its own.
  const bool at_once = !phases.empty() && phases.front().begin_s - window.from_s < kAtOnce_s,
             at_last = last && std::abs(window.to_s - last->end_s) < kAtOnce_s;
  if (!at_once) add(window.from_s, "begin", phases.empty() ? nullptr : &phases.front());
  if (!at_last) add(window.to_s, "end", last);
  for (const Phase& phase : phases) add(phase.begin_s, phase.name + " begins", &phase);
  if (last) add(last->end_s, last->name + " ends", last);
  std::ranges::sort(phases, std::greater<>(),
                    [](const Phase& phase) { return phase.end_s - phase.begin_s; });
  for (const Phase& phase : phases) add((phase.begin_s + phase.end_s) / 2, phase.name, &phase);
  std::vector<KeyMoment> found;
  for (auto& [time_s, moment] : moments) found.push_back(std::move(moment));
  return found;
}

std::vector<KeyMoment> EventMoments(const episode::RunResult& run, const Window& window,
                                    std::size_t count) {
  std::vector<KeyMoment> moments;
  for (std::size_t most = count; moments.size() < count && most <= count + 2; ++most) {
    moments = KeyMoments(run, window, most);
    std::erase_if(moments, [](const KeyMoment& moment) {
      return moment.caption == "begin" || moment.caption == "end";
    });
  }
  return moments;
}

tl::expected<std::vector<KeyMoment>, std::string> NamedMoments(
    const std::vector<std::string>& names, const grammar::Program& program,
    const episode::RunResult& run) {
  std::vector<KeyMoment> moments;
  for (const std::string& name : names) {
    if (const auto problem = episode::WhyNoEventTime(name, program))
      return tl::unexpected(problem->message + "; " + problem->hint);
    const episode::FoundTime found = episode::FindEventTime(name, run);
    if (!found.missed.empty()) return tl::unexpected(found.missed);
    moments.push_back({.time_s = SecondsOf(run, found.tick), .caption = name});
  }
  return moments;
}

std::vector<Look> Looks(const scenario::Scenario& scenario, const episode::RunResult& run,
                        const Window& window) {
  const physics::Scene& scene = scenario.scene;
  std::vector<Look> looks;
  for (std::size_t p = 0; p < scene.persons.size(); ++p) {
    bool goes_on = false;
    std::vector<double> distances_m;
    const auto finish = [&] {
      if (goes_on) looks.back().distance_m = distances_m[distances_m.size() / 2];
      goes_on = false;
    };
    for (const physics::Snapshot& snapshot : run.recording) {
      const double time_s = SecondsOf(run, snapshot.tick);
      if (time_s < window.from_s || time_s > window.to_s) continue;
      const physics::GazeState& gaze = snapshot.gazes[p];
      const std::string seen = gaze.body != physics::kNone   ? scene.body(gaze.body).name
                               : gaze.hand != physics::kNone ? scene.hand(gaze.hand).name
                                                             : std::string();
      if (goes_on && looks.back().seen != seen) finish();
      if (seen.empty()) continue;
      if (!goes_on) {
        looks.push_back({.begin_s = time_s, .person = scene.persons[p].name, .seen = seen});
        distances_m.clear();
        goes_on = true;
      }
      looks.back().end_s = time_s;
      distances_m.push_back(gaze.distance_m);
    }
    finish();
  }
  std::ranges::stable_sort(looks, {}, &Look::begin_s);
  return looks;
}

std::optional<HeldMoment> LongestGrasp(const scenario::Scenario& scenario,
                                       const episode::RunResult& run) {
  const NamedEvent* longest = nullptr;
  for (const NamedEvent& event : run.timeline.events) {
    if (run.drawings.Of(event.event).as != DrawnAs::kGrasp ||
        truth::RoleValue(event, "style").empty())
      continue;
    if (!longest ||
        event.interval.end - event.interval.begin > longest->interval.end - longest->interval.begin)
      longest = &event;
  }
  if (!longest) return std::nullopt;
  const grammar::Tick middle = (longest->interval.begin + longest->interval.end) / 2;
  HeldMoment moment{.time_s = SecondsOf(run, middle), .style = truth::RoleValue(*longest, "style")};
  const physics::Scene& scene = scenario.scene;
  const auto hand = std::ranges::find(scene.hands, HandOf(run, *longest), &physics::Hand::name);
  const auto snapshot = std::ranges::find_if(
      run.recording, [&](const physics::Snapshot& one) { return one.tick >= middle; });
  if (hand == scene.hands.end() || snapshot == run.recording.end()) return moment;
  // Only of what is held: a finger may touch the table, too.
  const std::size_t role = run.drawings.Of(longest->event).first;
  const physics::BodyIndex held = role < longest->roles.size()
                                      ? physics::FindBody(scene, longest->roles[role].value)
                                      : physics::kNone;
  std::set<int> sets;
  const physics::HandIndex index(hand - scene.hands.begin());
  for (const physics::ContactPoint& point : snapshot->contacts) {
    for (const physics::ContactSide& side : {point.a, point.b}) {
      const bool touches_held = point.a.body == held || point.b.body == held;
      if (side.hand != index || !touches_held) continue;
      sets.insert(side.link == physics::kNone ? hand->model.palm_sensor_set
                                              : hand->model.link(side.link).sensor_set);
    }
  }
  for (const int set : sets) {
    if (set >= 0 && set < static_cast<int>(hand->model.sensor_sets.size()))
      moment.sensor_sets.push_back(hand->model.sensor_sets[static_cast<std::size_t>(set)]);
  }
  return moment;
}

bool Window::Shows(const scenario::Scenario& scenario, const grammar::NamedEvent& event) const {
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(event.roles,
                               [&](const grammar::Role& role) { return role.value == name; });
  };
  if (!entity.empty() && !has(entity)) return false;
  return hand.empty() ||
         std::ranges::none_of(scenario.scene.hands, [&](const physics::Hand& other) {
           return other.name != hand && has(other.name);
         });
}

Window WholeOf(const episode::RunResult& run) {
  return {.from_s = 0, .to_s = SecondsOf(run, run.ticks + (run.is_recording ? 1 : 0))};
}

std::string HandOf(const episode::RunResult& run, const grammar::NamedEvent& event) {
  const truth::EventDrawing& drawing = run.drawings.Of(event.event);
  return drawing.hand < event.roles.size() ? event.roles[drawing.hand].value : std::string();
}

double SecondsOf(const episode::RunResult& run, grammar::Tick tick) {
  return truth::SecondsOf(tick, run.timeline.ticks_per_second);
}

Moment MomentOf(const EventAnswer& answer) {
  const auto seconds = [&](grammar::Tick tick) {
    return truth::SecondsOf(tick, answer.ticks_per_second);
  };
  Moment moment{.file = answer.file,
                .episode = answer.episode,
                .scenario = answer.scenario,
                .name = answer.event.event,
                .at_s = seconds(answer.event.interval.begin),
                .from_s = seconds(answer.event.interval.begin),
                .to_s = seconds(answer.event.interval.end)};
  for (const grammar::Role& role : answer.event.roles) moment.of.push_back(role.value);
  return moment;
}

MomentPictures DrawMoments(const std::vector<Moment>& moments, const std::string& folder,
                           const std::string& root) {
  MomentPictures drawn{.files = std::vector<std::string>(moments.size()), .error = {}};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error)) {
    drawn.error = folder + " is not a folder, and cannot be made one";
    return drawn;
  }
  episode::EpisodeOpener opener(root);
  std::optional<Result<Shown>> shown;
  const Moment* last = nullptr;
  for (std::size_t i = 0; i < std::min(moments.size(), kMostMoments); ++i) {
    const Moment& moment = moments[i];
    if (!last || last->file != moment.file || last->episode != moment.episode)
      shown.emplace(Play(moment, opener));
    last = &moment;
    if (!*shown) {
      drawn.error = grammar::Format(shown->error());
      continue;
    }
    const scenario::Scenario& scenario = (*shown)->loaded.scenario;
    scenario::PictureYaml entry;
    const PictureFormat format = FormatOf(moment, scenario.scene);
    entry.at.value = fmt::format("{:.6f}", moment.at_s);
    const std::string file = (std::filesystem::path(folder) / FileName(i + 1, moment)).string();
    const PictureResult result = DrawPicture(scenario, (*shown)->run, entry, file, format);
    if (result.error.empty())
      drawn.files[i] = file;
    else
      drawn.error = result.error;
  }
  if (moments.size() > kMostMoments && drawn.error.empty()) {
    drawn.error =
        fmt::format("there are {} moments, at most {} are drawn", moments.size(), kMostMoments);
  }
  return drawn;
}

}  // namespace prehend::show
