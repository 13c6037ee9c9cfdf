// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/export/export_episode.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "grammar/base/frame.h"
#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episodes/database.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {
namespace {

/// `file` has one of the endings. Returns "", or what could not be written.
std::string WriteMotion(const Motion& motion, const std::string& file) {
  AtomicFile output(file);
  if (!output.problem().empty()) return output.problem();
  std::filesystem::path beside = file;
  const std::string ending = beside.extension();
  std::string metadata;
  if (ending == ".jsonl") WriteLines(motion, output.stream());
  if (ending == ".npz") WriteNpz(motion, output.stream());
  if (ending == ".csv") WriteCsv(motion, output.stream());
  if (ending == ".mcap") metadata = WriteMcap(motion, beside.filename(), output.stream());
  std::string problem = output.Commit();
  if (problem.empty() && ending != ".jsonl")
    problem = WriteTextFile(file + ".map.yaml", MapText(motion, ending));
  if (problem.empty() && ending == ".csv")
    problem = WriteTextFile(beside.replace_extension(".events.csv"), EventsCsv(motion));
  if (problem.empty() && ending == ".mcap")
    problem = WriteTextFile(beside.replace_filename("metadata.yaml"), metadata);
  return problem;
}

bool IsTrackerBody(const grammar::EntityInfo& entity) {
  const auto is = [&](const char* name) {
    return std::ranges::find(entity.classes, name) != entity.classes.end();
  };
  return is("Thing") || is("Hand");
}

std::string YamlVector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// `grip` and `joint` of a map, with where its file has them.
std::string OpeningText(const Motion::Seen& of, const std::string& grip, const std::string& joint) {
  std::string text;
  if (of.most_grip > 0) text += ", grip: {from: " + grip + ", open: 0, closed: 1}";
  if (!of.has_joint) return text;
  const auto& [at, fraction] = std::pair(of.shut.joint_position, of.shut.joint_fraction);
  const double way = of.open.joint_fraction - fraction;
  double closed = fraction == 0 ? at : 0, open = fraction == 0 ? at + 1 : at / fraction;
  if (way > 0) {
    const double full = (of.open.joint_position - at) / way;
    closed = at - fraction * full;
    open = of.open.joint_fraction == 1 ? of.open.joint_position : closed + full;
  }
  return text + fmt::format(", joint: {{from: {}, open: {}, closed: {}}}", joint, open, closed);
}

// See harness/exchange/export/export_episode.h: a zip file of arrays of NumPy (.npy, version 1.0),
// stored as they are. Tested by tests/program/exported.py

class NpzFile {
 public:
  explicit NpzFile(std::ostream& out) : out_(out) {}

  void Add(const std::string& name, const std::string& shape, const std::string& type,
           const std::string& data) {
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');
    ByteWriter array{.bytes = std::string("\x93NUMPY\x01\x00", 8)};
    array.U16(header.size() + 1).bytes += header + "\n" + data;
    const auto* bytes = reinterpret_cast<const Bytef*>(array.bytes.data());
    ByteWriter about;  // no flags, stored, 1 January 1980
    about.U16(20).U16(0).U16(0).U16(0).U16(33).U32(crc32_z(0, bytes, array.bytes.size()));
    about.U32(array.bytes.size()).U32(array.bytes.size()).U16(name.size() + 4).U16(0);
    ByteWriter entry;
    entry.U32(0x02014b50).U16(20).bytes += about.bytes;
    entry.U16(0).U16(0).U16(0).U32(0).U32(at_).bytes += name + ".npy";
    directory_ += entry.bytes;
    ++count_;
    Put(ByteWriter{}.U32(0x04034b50).bytes + about.bytes + name + ".npy" + array.bytes);
  }

  /// Rows of numbers.
  void Add(const std::string& name, const std::string& shape, const std::vector<double>& values) {
    Add(name, shape, "<f8",
        std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)));
  }

  /// UTF-8 texts, as bytes of one length.
  void Add(const std::string& name, const std::vector<std::string>& texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string data;
    for (const std::string& text : texts) data += text + std::string(longest - text.size(), '\0');
    Add(name, fmt::format("{},", texts.size()), fmt::format("|S{}", longest), data);
  }

  void Finish() {
    const std::uint64_t begin = at_;
    ByteWriter end{.bytes = directory_};
    end.U32(0x06054b50).U16(0).U16(0).U16(count_).U16(count_).U32(directory_.size()).U32(begin);
    Put(end.U16(0).bytes);
  }

 private:
  void Put(const std::string& bytes) {
    out_ << bytes;
    at_ += bytes.size();
  }

  std::ostream& out_;
  std::uint64_t at_ = 0;
  std::size_t count_ = 0;
  std::string directory_;
};

}  // namespace

tl::expected<std::vector<Exported>, episode::NotFound> ExportEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const ExportRequest& request) {
  const bool is_file = request.output.ends_with(request.ending);
  if (is_file && episodes.size() > 1)
    return tl::unexpected(episode::NotFound{
        .message = fmt::format("--output: {} is one file, and {} episodes are selected; name a "
                               "folder, or choose one with --episode",
                               request.output, episodes.size())});
  episode::EpisodeOpener opener(request.root);
  std::vector<Exported> all;
  std::map<std::string, int> taken;
  for (const episode::EpisodeName& named : episodes) {
    std::string name = FileNameOf(named.scenario);
    if (name.ends_with(".jsonl")) name.erase(name.size() - 6);
    if (const int before = taken[name]++; before > 0) name += fmt::format("-{}", before + 1);
    if (request.ending == ".mcap") name += "/" + name;  // a bag is a folder
    Exported one{.file = is_file ? request.output : request.output + "/" + name + request.ending};
    episode::GrammarChoice choice = request.choice;
    if (choice.grammar.empty()) choice.grammar = named.asked;
    Result<episode::Episode> episode = opener.Open(named, choice);
    if (!episode) return tl::unexpected(episode::NotFound{.diagnostics = episode.error()});
    const Result<Motion> motion = Motion::Of(*episode, choice);
    if (!motion) return tl::unexpected(episode::NotFound{.diagnostics = motion.error()});
    if (const std::string problem = WriteMotion(*motion, one.file); !problem.empty())
      return tl::unexpected(episode::NotFound{.exit_code = ExitCode::kFailure, .message = problem});
    one.frames = motion->frames;
    one.events = motion->timeline.events.size();
    one.warnings = episode->missing().warnings;
    if (!motion->failure.empty()) one.failure = named.scenario + ": " + motion->failure;
    all.push_back(std::move(one));
  }
  return all;
}

Result<Motion> Motion::Of(episode::Episode& episode, const episode::GrammarChoice& choice) {
  const bool other_grammar = !choice.grammar.empty() || !choice.settings.empty();
  Motion motion(episode);
  std::string uuid;
  if (episode.row()) uuid = episode.row()->uuid;
  if (episode.row() ? !other_grammar : episode.was_simulated()) {
    PREHEND_TRY(motion.timeline, episode.Recorded());  // of a scenario: plays it
  }
  if (!episode.row() || other_grammar) {
    PREHEND_TRY(episode::RunResult run, episode.Run(false));
    if (uuid.empty()) uuid = fmt::format("{} {:016x}", episode.name().scenario, run.state_hash);
    uuid = episode::UuidOf(uuid + " " + GrammarName(*episode.program()));
    motion.timeline = std::move(run.timeline);
  }
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i)
    motion.uuids.push_back(episode::UuidOfEvent(uuid, i));
  motion.LookAtAll();
  motion.judged_by = choice.grammar.empty() ? motion.header.grammar : choice.grammar;
  if (motion.judged_by.find_first_of("./") == std::string::npos)
    motion.header.grammar = motion.judged_by;
  motion.settings = choice.settings;
  motion.was_simulated = episode.was_simulated();
  return motion;
}

void Motion::LookAtAll() {
  header = episode_->Header();
  if (const episode::Recording* recording = episode_->recording())
    says_its_end = recording->says_its_end;
  for (const grammar::EntityInfo& entity : table().entities)
    seen.push_back({.has_joint = std::ranges::count(entity.classes, "Jointed") > 0});
  const episode::Episode::End end = episode_->EachFrame([&](const grammar::Frame& frame) {
    if (frames++ == 0) first_tick = frame.tick;
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      Seen& of = seen[i];
      if (!grammar::IsMeasured(look)) continue;
      of.has_joint = of.has_joint || look.joint_position != 0 || look.joint_fraction != 0;
      if (of.looks++ == 0) of.first = of.shut = of.open = look;
      if (look.joint_fraction < of.shut.joint_fraction) of.shut = look;
      if (look.joint_fraction > of.open.joint_fraction) of.open = look;
      of.moves = of.moves || look.p_WB_m != of.first.p_WB_m ||
                 look.q_WB.coeffs() != of.first.q_WB.coeffs();
    }
    for (const grammar::HandSample& hand : frame.hands) {
      Seen& of = seen[static_cast<std::size_t>(hand.entity)];
      const grammar::EntitySample& look = frame.entities[static_cast<std::size_t>(hand.entity)];
      of.most_grip = std::max(of.most_grip, hand.trigger);
      if (!of.ahead_B && grammar::IsMeasured(look))
        of.ahead_B = look.q_WB.conjugate() * hand.ahead_W;
    }
  });
  end_tick = end.tick;
  failure = end.failure;
}

void Motion::EachFrame(const Look& look) const { episode_->EachFrame(look); }

std::uint64_t Motion::Nanoseconds(grammar::Tick tick) const {
  return static_cast<std::uint64_t>(std::llround(Seconds(tick) * 1e9));
}

void WriteLines(const Motion& motion, std::ostream& out) {
  episode::EpisodeWriter writer(out, motion.header);
  motion.EachFrame([&](const grammar::Frame& frame) { writer.Write(frame); });
  if (motion.says_its_end) writer.Finish(motion.end_tick);
}

void WriteCsv(const Motion& motion, std::ostream& out) {
  out << "t,entity,x,y,z,qw,qx,qy,qz,grip,joint_position,joint_fraction\n";
  std::vector<std::string> names;
  for (const grammar::EntityInfo& entity : motion.table().entities)
    names.push_back(AsCsvCell(entity.name));
  std::vector<std::string> grips(names.size());
  motion.EachFrame([&](const grammar::Frame& frame) {
    for (const grammar::HandSample& hand : frame.hands)
      grips[hand.entity] = fmt::to_string(hand.trigger);
    const std::string t = truth::SecondsText(frame.tick, motion.table().ticks_per_second);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      const Eigen::Vector3d& p = look.p_WB_m;
      const Eigen::Quaterniond& q = look.q_WB;
      const bool known = grammar::IsMeasured(look);
      const std::string pose = known ? fmt::format("{},{},{},{},{},{},{}", p.x(), p.y(), p.z(),
                                                   q.w(), q.x(), q.y(), q.z())
                                     : ",,,,,,";
      const std::string joint = known && motion.seen[i].has_joint
                                    ? fmt::format("{},{}", look.joint_position, look.joint_fraction)
                                    : ",";
      out << t << ',' << names[i] << ',' << pose << ',' << grips[i] << ',' << joint << '\n';
    }
  });
}

std::string RolesJson(const grammar::NamedEvent& event) {
  nlohmann::ordered_json roles = nlohmann::ordered_json::object();
  for (const grammar::Role& role : event.roles) roles[role.name] = role.value;
  for (const grammar::NamedValue& value : event.values) roles[value.name] = value.value;
  return roles.dump();
}

std::string EventsCsv(const Motion& motion) {
  std::vector<std::string> columns;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(columns, name) == columns.end()) columns.push_back(name);
  };
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    for (const grammar::Role& role : event.roles) add(role.name);
    for (const grammar::NamedValue& value : event.values) add(value.name);
  }
  std::string text = "uuid,event,begin_s,end_s,decided_s,open_end";
  for (const std::string& column : columns) text += "," + column;
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i) {
    const grammar::NamedEvent& event = motion.timeline.events[i];
    text += "\n" + motion.uuids[i] + "," + AsCsvCell(event.event);
    for (const grammar::Tick tick : {event.interval.begin, event.interval.end, event.decided})
      text += "," + truth::SecondsText(tick, motion.timeline.ticks_per_second);
    text += event.open_end ? ",true" : ",false";
    for (const std::string& column : columns) {
      const auto value = std::ranges::find(event.values, column, &grammar::NamedValue::name);
      text += "," + (value == event.values.end() ? AsCsvCell(truth::RoleValue(event, column))
                                                 : fmt::to_string(value->value));
    }
  }
  return text + "\n";
}

/// `grammar` of a map, which is that of what `import` makes; or what it cannot say.
std::string GrammarOf(const Motion& motion) {
  const std::string& name = motion.judged_by;
  const auto is_letter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  const bool fits = !motion.was_simulated && std::ranges::all_of(name, is_letter);
  std::string text = fits ? "grammar: " + name + "\n" : "";
  if (fits && motion.settings.empty()) return text;
  return text +
         fmt::format("# not said here: its events are those of {}{}{}\n", name,
                     motion.settings.empty()
                         ? ""
                         : fmt::format(" with --set {}", fmt::join(motion.settings, " --set ")),
                     motion.was_simulated ? ", of all that was simulated" : "");
}

std::string MapText(const Motion& motion, const std::string& ending) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  grammar::Tick ticks_per_second = motion.table().ticks_per_second;
  while (ticks_per_second < 100) ticks_per_second *= 10;  // the least that a map can say
  std::string text = fmt::format(
      "# prehend import FILE --map THIS -o take.jsonl; time 0 is that of the first frame.\n"
      "import: 1\nepisode: {}\nunit: m\naxes: z_up\nticks_per_second: {}\nlost: in_rows\n"
      "bridge_s: {}\nend_s: {}\nsure: [unit, axes, quaternion_order, time, place, zero, upright, "
      "handed]\n",
      quoted(motion.header.episode), ticks_per_second, motion.header.bridge_s,
      motion.Seconds(motion.end_tick - motion.first_tick));
  if (ending == ".csv")
    text +=
        "quaternion_order: wxyz\ntime_unit: s\n"
        "columns: {time: t, body: entity, position: [x, \"y\", z], quaternion: [qw, qx, qy, qz]}\n";
  else if (ending == ".npz")
    text += "quaternion_order: wxyz\nt: t_s\ntime_unit: s\nmissing: [nan]\n";
  else
    text += "mcap: {clock: log, world: " + quoted(WorldName(motion.table())) + "}\n";
  text += GrammarOf(motion) + "entities:\n";
  const auto is_mapped = [&](std::size_t i) {
    return IsTrackerBody(motion.table().entities[i]) && motion.seen[i].looks > 0;
  };
  for (std::size_t i = 0; i < motion.seen.size(); ++i) {
    const grammar::EntityInfo& entity = motion.table().entities[i];
    if (!is_mapped(i)) continue;
    const std::string& own = entity.classes.front();
    const std::string at =
        ending == ".npz"
            ? fmt::format("position: \"position_m[{}:{}]\", quaternion: \"quaternion_wxyz[{}:{}]\"",
                          3 * i, 3 * i + 3, 4 * i, 4 * i + 4)
            : "from: " + quoted(entity.name);
    text += fmt::format("  {}: {{{}, size_m: {}", quoted(entity.name), at,
                        YamlVector(2 * entity.half_size_m));
    if (!entity.p_BC_m.isZero(0)) text += ", offset_m: " + YamlVector(entity.p_BC_m);
    if (own == "Hand")
      text += ", hand: true";
    else
      text += ", class: " + quoted(own);
    if (!motion.seen[i].has_joint &&
        std::ranges::find(entity.classes, "Fixed") != entity.classes.end())
      text += ", fixed: true";
    const int whole = entity.part_of;
    if (std::ranges::count(entity.classes, "Attached") > 0 && whole != grammar::kNoEntity &&
        is_mapped(static_cast<std::size_t>(whole)))
      text += ", part_of: " + quoted(motion.table().entities[whole].name);
    const auto element = [&](const char* of, const std::string& which) {
      return quoted(fmt::format("{}[{}]", of, which));
    };
    text += ending == ".csv" ? OpeningText(motion.seen[i], "grip", "joint_position")
            : ending == ".npz"
                ? OpeningText(motion.seen[i], element("grip", std::to_string(i)),
                              element("joint_position", std::to_string(i)))
                : OpeningText(motion.seen[i], element("/joint_states", entity.name + "_grip"),
                              element("/joint_states", entity.name));
    if (const auto& ahead = motion.seen[i].ahead_B)
      text += ", ahead: " + YamlVector(ahead->normalized());
    text += "}\n";
  }
  return text;
}

void WriteNpz(const Motion& motion, std::ostream& out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::size_t count = motion.seen.size();
  std::vector<double> t, p, q, grip, joint, begin, end;
  motion.EachFrame([&](const grammar::Frame& frame) {
    t.push_back(motion.Seconds(frame.tick));
    for (const grammar::EntitySample& look : frame.entities) {
      const bool known = grammar::IsMeasured(look);
      for (int i = 0; i < 3; ++i) p.push_back(known ? look.p_WB_m[i] : kNone);
      for (const int i : {3, 0, 1, 2}) q.push_back(known ? look.q_WB.coeffs()[i] : kNone);
      joint.push_back(known ? look.joint_position : kNone);
    }
    grip.resize(t.size() * count, kNone);
    for (const grammar::HandSample& hand : frame.hands)
      grip[grip.size() - count + static_cast<std::size_t>(hand.entity)] = hand.trigger;
  });
  std::vector<std::string> names, classes, events, roles;
  std::string open;
  for (const grammar::EntityInfo& entity : motion.table().entities) {
    names.push_back(entity.name);
    classes.push_back(entity.classes.front());
  }
  for (const grammar::NamedEvent& event : motion.timeline.events) {
    events.push_back(event.event);
    roles.push_back(RolesJson(event));
    begin.push_back(motion.Seconds(event.interval.begin));
    end.push_back(motion.Seconds(event.interval.end));
    open += event.open_end ? '\1' : '\0';
  }
  const std::string rows = fmt::format("{},", t.size()), cells = rows + fmt::format("{},", count),
                    of_events = fmt::format("{},", events.size());
  NpzFile file(out);
  file.Add("t_s", rows, t);
  file.Add("position_m", cells + "3", p);
  file.Add("quaternion_wxyz", cells + "4", q);
  file.Add("grip", cells, grip);
  file.Add("joint_position", cells, joint);
  file.Add("entity", names);
  file.Add("class", classes);
  file.Add("event", events);
  file.Add("event_uuid", motion.uuids);
  file.Add("event_begin_s", of_events, begin);
  file.Add("event_end_s", of_events, end);
  file.Add("event_open_end", of_events, "|b1", open);
  file.Add("event_roles_json", roles);
  file.Finish();
}

}  // namespace prehend::exchange
