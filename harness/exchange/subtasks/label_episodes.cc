// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/subtasks/label_episodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/episode/episode/episode.h"
#include "harness/exchange/hdf5/hdf5_file.h"
#include "harness/exchange/poses/pose_file.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

tl::unexpected<episode::NotFound> Refused(std::string message) {
  return tl::unexpected(episode::NotFound{.message = std::move(message)});
}

std::string TableOf(const std::vector<Subtasks>& all, bool frames) {
  std::string text = frames ? "episode,frame,t_s,subtask,text\n"
                            : "episode,subtask,text,begin_s,end_s,begin_frame,end_frame\n";
  for (const Subtasks& one : all) {
    const std::string name = AsCsvCell(one.episode);
    for (const Subtask& task : one.all) {
      const std::string words = AsCsvCell(task.name) + "," + AsCsvCell(task.text);
      for (std::size_t i = task.begin; frames && i < task.end; ++i)
        text += fmt::format("{},{},{:.6f},{}\n", name, i, one.Seconds(one.ticks[i]), words);
      if (!frames)
        text +=
            fmt::format("{},{},{:.6f},{:.6f},{},{}\n", name, words, one.Seconds(task.begin_tick),
                        one.Seconds(task.end_tick), task.begin, task.end);
    }
  }
  return text;
}

/// Signals of a demonstration, where Isaac Lab or MimicGen looks for them. What does not fit its
/// file is missing.
void AddSignalsOf(const Hdf5File& file, const ImportMap& map, Subtasks& one,
                  std::vector<Hdf5Signal>& signals) {
  const std::string& pattern = map.hdf5.episodes.value;
  const std::string group = pattern.substr(0, pattern.rfind('/') + 1) + one.episode;
  const std::size_t skipped = static_cast<std::size_t>(map.hdf5.skip);
  std::size_t rows = one.ticks.size() + skipped;
  const Result<Hdf5Object> actions = file.Describe(group + "/actions"),
                           states = file.Describe(group + "/states");
  if (!file.Has(group)) one.missing = "'" + group + "' is not in " + file.path();
  // ManiSkill has the state after the last action, too.
  if (actions && actions->Rows() + 1 == rows) --rows;
  const bool is_late = one.all.size() > 1 && one.all[one.all.size() - 2].end + skipped >= rows;
  if (is_late) one.missing = one.all[one.all.size() - 2].name + ": after the last action";
  if (actions && actions->Rows() != rows)
    one.missing =
        fmt::format("it has {} actions, and the episode {} frames", actions->Rows(), rows);
  if (!one.missing.empty()) return one.all.clear();
  const bool isaac =
      file.Has(group + "/obs/datagen_info") ||
      (!file.Has(group + "/datagen_info") && states && states->kind == Hdf5Kind::kGroup);
  for (std::size_t i = 0; i + 1 < one.all.size(); ++i)
    signals.push_back({.dataset = group + (isaac ? "/obs" : "") +
                                  "/datagen_info/subtask_term_signals/" + one.all[i].name,
                       .first = one.all[i].end + skipped,
                       .rows = rows,
                       .as_integers = !isaac});
}

/// Returns "", or what went wrong.
std::string WriteCopy(const std::string& source, const std::string& output,
                      const std::vector<Hdf5Signal>& signals) {
  AtomicFile out(output);
  if (!out.problem().empty()) return out.problem();
  const TemporaryFolder folder;
  const std::filesystem::path copy = std::filesystem::path(folder.path()) / "copy.hdf5";
  std::error_code error;
  std::filesystem::copy_file(source, copy, error);
  if (error) return source + ": " + error.message();
  std::filesystem::permissions(copy, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::add, error);
  if (const std::string problem = AddSignals(copy, signals); !problem.empty()) return problem;
  out.stream() << std::ifstream(copy, std::ios::binary).rdbuf();
  return out.Commit();
}

constexpr double kSettles_s = 0.5;  ///< what a label requires may begin so much later

std::string EventIn(const std::string& label) { return label.substr(0, label.find('(')); }

bool Fits(const grammar::NamedEvent& event, const SubtaskLabel& label) {
  return event.event == label.of.value && !(label.at_end && event.open_end) &&
         (!label.hand ||
          std::ranges::count(event.roles, label.hand->value, &grammar::Role::value)) &&
         (!label.object || truth::RoleValue(event, "object") == label.object->value);
}

/// Whether the event that a label requires holds at a tick, or soon.
bool Holds(const SubtaskLabel& label, const Motion& motion, grammar::Tick tick) {
  if (!label.required) return true;
  const auto soon = static_cast<grammar::Tick>(
      kSettles_s * static_cast<double>(motion.timeline.ticks_per_second));
  std::string wanted = label.required->value;
  std::erase(wanted, ' ');
  return std::ranges::any_of(motion.timeline.events, [&](const grammar::NamedEvent& event) {
    std::string found = event.Label();
    std::erase(found, ' ');
    return found == wanted && event.interval.begin <= tick + soon && event.interval.end > tick;
  });
}

/// The first such boundary after `after`; -1: there is none.
grammar::Tick BoundaryOf(const SubtaskLabel& label, const Motion& motion, grammar::Tick after) {
  grammar::Tick first = -1;
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    const grammar::Tick tick = label.at_end ? event.interval.end : event.interval.begin;
    if (tick > after && (first < 0 || tick < first) && Fits(event, label) &&
        Holds(label, motion, tick))
      first = tick;
  }
  return first;
}

std::string TextOf(const ImportMap& map, const std::string& name) {
  const auto text = std::ranges::find(map.text, name, &Named<std::string>::name);
  return text == map.text.end() ? "" : text->value;
}

std::string WhatIsMissing(const SubtaskLabel& label) {
  std::string text = fmt::format("no {} of {}", label.at_end ? "end" : "begin", label.of.value);
  for (const auto& role : {label.hand, label.object}) {
    if (role) text += " " + role->value;
  }
  return text + (label.required ? " with " + label.required->value : "");
}

}  // namespace

tl::expected<std::vector<Subtasks>, episode::NotFound> LabelEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const LabelRequest& request) {
  episode::EpisodeOpener opener(request.root);
  std::optional<MapFile> map;
  std::vector<Subtasks> all;
  for (const episode::EpisodeName& name : episodes) {
    Result<episode::Episode> episode = opener.Open(name, request.choice);
    if (!episode) return tl::unexpected(episode::NotFound{.diagnostics = episode.error()});
    const std::string source = episode->loaded().scenario.file;
    if (!map) {
      const Result<PoseFormat> format = PoseFormatOf(source);
      Result<MapFile> read =
          format ? ReadImportMap(request.map, *format) : tl::unexpected(format.error());
      if (!read) return tl::unexpected(episode::NotFound{.diagnostics = read.error()});
      map = std::move(*read);
      if (auto wrong = WrongInLabels(*map, *episode->program()); !wrong.empty())
        return tl::unexpected(episode::NotFound{.diagnostics = std::move(wrong)});
    }
    const Result<Motion> motion = Motion::Of(*episode, request.choice);
    if (!motion) return tl::unexpected(episode::NotFound{.diagnostics = motion.error()});
    all.push_back(FindSubtasks(map->map, *motion));
    all.back().source = source;
    if (source != all.front().source && !request.hdf5.empty())
      return Refused(fmt::format(
          "--output: the episodes are of {} and of {}; label those of one file at a time",
          all.front().source, source));
  }
  std::string problem;
  if (request.hdf5.empty()) {
    problem = WriteTextFile(request.table, TableOf(all, request.frames));
  } else {
    const std::string& source = all.front().source;
    const Result<Hdf5File> file = Hdf5File::Open(source);
    if (!file) return tl::unexpected(episode::NotFound{.diagnostics = file.error()});
    std::vector<Hdf5Signal> signals;
    for (Subtasks& one : all) {
      if (one.missing.empty()) AddSignalsOf(*file, map->map, one, signals);
    }
    problem = WriteCopy(source, request.hdf5, signals);
  }
  if (problem.empty()) return all;
  return tl::unexpected(episode::NotFound{.exit_code = ExitCode::kFailure, .message = problem});
}

grammar::Diagnostics WrongInLabels(const MapFile& map, const grammar::Program& program) {
  DiagnosticList errors(map.document);
  const std::vector<std::string> events = EventNames(program);
  std::vector<std::string> entities;
  for (const Named<MappedEntity>& entity : map.map.entities) entities.push_back(entity.name);
  const auto look = [&](const Located<std::string>& name, const std::string& text,
                        const std::vector<std::string>& known, const std::string& what) {
    if (std::ranges::find(known, text) == known.end())
      errors.AddUnknownName(name.where, fmt::format("{} '{}'", what, text), text, known);
  };
  const std::string no_event = "grammar '" + GrammarName(program) + "' has no event";
  for (const Named<SubtaskLabel>& label : map.map.labels) {
    look(label.value.of, label.value.of.value, events, no_event);
    if (label.value.required)
      look(*label.value.required, EventIn(label.value.required->value), events, no_event);
    for (const auto& role : {label.value.hand, label.value.object}) {
      if (role) look(*role, role->value, entities, "the map has no entity");
    }
  }
  if (map.map.labels.empty())
    errors.Add({}, "the map has no 'labels'", "labels: {grasp: {at: begin, of: grasping}}");
  return errors.Sorted();
}

Subtasks FindSubtasks(const ImportMap& map, const Motion& motion) {
  Subtasks found{.episode = motion.header.episode,
                 .ticks_per_second = motion.table().ticks_per_second};
  motion.EachFrame([&](const grammar::Frame& frame) { found.ticks.push_back(frame.tick); });
  Subtask next;
  const auto end_at = [&](std::size_t frame, grammar::Tick tick) {
    next.end = frame;
    next.end_tick = tick;
    next.text = TextOf(map, next.name);
    found.all.push_back(next);
    next.begin = frame;
    next.begin_tick = tick;
  };
  for (const Named<SubtaskLabel>& label : map.labels) {
    const grammar::Tick tick =
        BoundaryOf(label.value, motion, found.all.empty() ? -1 : next.begin_tick);
    const auto frame = std::ranges::lower_bound(found.ticks, tick);
    next.name = label.name;
    if (tick < 0 || frame == found.ticks.end())
      found.missing = label.name + ": " + WhatIsMissing(label.value);
    else if (frame - found.ticks.begin() == static_cast<std::ptrdiff_t>(next.begin))
      found.missing = label.name + (found.all.empty() ? " would be true in the first frame"
                                                      : " is in the frame of the one before it");
    if (!found.missing.empty()) {
      found.all.clear();
      return found;
    }
    end_at(static_cast<std::size_t>(frame - found.ticks.begin()), *frame);
  }
  next.name = "rest";
  end_at(found.ticks.size(), motion.end_tick);
  return found;
}

}  // namespace prehend::exchange
