// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/corpus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "grammar/name_events.h"
#include "grammar/program/program.h"

namespace prehend::grammar::testing {
namespace {

constexpr Tick kTicksPerSecond = kCorpusTicksPerSecond;
constexpr Tick kColumnTicks = kCorpusColumnTicks;
constexpr int kUsualFramesPerSecond = 100;

[[noreturn]] void Abort(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::abort();
}

std::string Trim(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

EntityInfo Member(const std::string& name, const std::string& class_name) {
  EntityInfo member{.name = name, .classes = {class_name}};
  if (class_name == "Movable" || class_name == "Fixed" || class_name == "Jointed" ||
      class_name == "Attached")
    member.classes.emplace_back("Thing");
  if (class_name == "Hand") member.sensor_sets = {"fingers", "thumb", "palm"};
  member.classes.emplace_back("Entity");
  return member;
}

// "8kg", "50N", "of=drawer" or "thumb+index+middle". `others` come before it.
void ApplyDetail(EntityInfo& member, const std::string& detail,
                 const std::vector<EntityInfo>& others) {
  if (detail.starts_with("of=")) {
    const auto whole = std::find_if(others.begin(), others.end(), [&](const EntityInfo& other) {
      return other.name == detail.substr(3);
    });
    if (whole == others.end()) Abort("no entity before " + member.name + ":" + detail);
    member.part_of = static_cast<int>(whole - others.begin());
  } else if (detail.ends_with("kg")) {
    member.mass_kg = std::stod(detail);
  } else if (detail.ends_with("N")) {
    member.strength_n = std::stod(detail);
  } else {
    std::istringstream sets(detail);
    member.sensor_sets.clear();
    for (std::string set; std::getline(sets, set, '+');) member.sensor_sets.push_back(set);
  }
}

std::vector<EntityInfo> ParseEntities(const std::string& text) {
  std::vector<EntityInfo> entity_table;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::istringstream parts(word);
    std::string name, class_name;
    if (!std::getline(parts, name, ':') || !std::getline(parts, class_name, ':'))
      Abort("entities wants NAME:CLASS, found " + word);
    EntityInfo member = Member(name, class_name);
    for (std::string detail; std::getline(parts, detail, ':');)
      ApplyDetail(member, detail, entity_table);
    entity_table.push_back(std::move(member));
  }
  return entity_table;
}

int Digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'z') return c - 'a' + 10;
  return 0;
}

// A row's value at a time, in the row's own unit, straight between columns.
double Interpolate(const std::string& cells, Tick tick) {
  const double column = static_cast<double>(tick) / kColumnTicks;
  const auto left = std::min(static_cast<std::size_t>(column), cells.size() - 1);
  const auto right = std::min(left + 1, cells.size() - 1);
  const double share = std::min(column - static_cast<double>(left), 1.0);
  return Digit(cells[left]) + share * (Digit(cells[right]) - Digit(cells[left]));
}

// Builds the frames of one case.
class Stage {
 public:
  explicit Stage(const CorpusCase& c) : case_(c) {
    for (std::size_t i = 0; i < c.entity_table.size(); ++i)
      ids_[c.entity_table[i].name] = static_cast<int>(i);
  }

  Frame Look(Tick tick) {
    looks_.assign(case_.entity_table.size(), {});
    touches_.clear();
    hands_.clear();
    collision_spheres_.assign(case_.entity_table.size(), {});
    for (std::size_t i = 0; i < case_.entity_table.size(); ++i) {
      if (case_.entity_table[i].classes.front() == "Hand")
        hands_.push_back({.entity = static_cast<int>(i)});
    }
    for (const Row& row : case_.facts) Apply(row, tick);
    for (HandSample& hand : hands_) {
      collision_spheres_[hand.entity] = {.p_W_m = looks_[hand.entity].p_WB_m, .radius_m = 0};
      hand.collision_spheres = {&collision_spheres_[hand.entity], 1};
    }
    for (Touch& touch : touches_) {
      const EntitySample &a = looks_[touch.a], &b = looks_[touch.b];
      touch.vertical_speed_m_per_s =
          VerticalSpeedBetween(a, b, (touch.up_on_a >= touch.up_on_b ? a : b).p_WB_m);
    }
    std::sort(touches_.begin(), touches_.end(), [](const Touch& a, const Touch& b) {
      return std::pair(a.a, a.b) < std::pair(b.a, b.b);
    });
    return {.tick = tick, .entities = looks_, .hands = hands_, .touches = touches_};
  }

 private:
  int Id(const std::string& name) const {
    const auto found = ids_.find(name);
    if (found == ids_.end()) Abort("case '" + case_.title + "': nobody is called " + name);
    return found->second;
  }

  void Apply(const Row& row, Tick tick) {
    std::istringstream words(row.name);
    std::string who;
    std::string what;
    std::string whom;
    words >> who >> what >> whom;
    const char cell =
        row.cells[std::min(static_cast<std::size_t>(tick / kColumnTicks), row.cells.size() - 1)];
    if (what == "x" || what == "y" || what == "z") {
      const int axis = what[0] - 'x';
      EntitySample& look = looks_[Id(who)];
      look.p_WB_m[axis] = Interpolate(row.cells, tick) / 100;
      // As a simulator does, the velocity is that of the step that led here.
      look.v_WB_m_per_s[axis] =
          tick == 0 ? 0
                    : (Interpolate(row.cells, tick) - Interpolate(row.cells, tick - 1)) / 100 *
                          kTicksPerSecond;
    } else if (what == "shakes") {
      if (cell == '#') Shake(looks_[Id(who)], static_cast<double>(tick) / kTicksPerSecond);
    } else if (what == "grip") {
      for (HandSample& hand : hands_) {
        if (hand.entity == Id(who)) hand.trigger = cell == '#' ? 1 : Digit(cell) / 10.0;
      }
    } else if (what == "joint") {
      looks_[Id(who)].joint_fraction = Interpolate(row.cells, tick) / 20;
    } else if (what == "percent") {
      looks_[Id(who)].joint_fraction = Interpolate(row.cells, tick) / 100;
    } else if (what == "tilt") {
      const double rad = Interpolate(row.cells, tick) * 5 * std::numbers::pi / 180;
      looks_[Id(who)].q_WB = Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitX());
    } else if (what == "circles") {
      Circle(looks_[Id(who)], looks_[Id(whom)].p_WB_m, row.cells, tick);
    } else if (cell != '.') {
      ApplyPair(Id(who), Id(whom), what, cell);
    }
  }

  // Two centimetres around the other's origin; each column says by how many sixteenths of a turn it
  // goes on.
  static void Circle(EntitySample& look, const Eigen::Vector3d& centre, const std::string& cells,
                     Tick tick) {
    constexpr double kRadius_m = 0.02;
    const auto full = static_cast<std::size_t>(tick / kColumnTicks);
    double sixteenths = static_cast<double>(tick % kColumnTicks) / kColumnTicks *
                        Steps(cells[std::min(full, cells.size() - 1)]);
    for (std::size_t i = 0; i < full; ++i)
      sixteenths += Steps(cells[std::min(i, cells.size() - 1)]);
    const double rad = sixteenths * std::numbers::pi / 8;
    look.p_WB_m = centre + kRadius_m * Eigen::Vector3d(std::cos(rad), std::sin(rad), 0);
  }
  // 1..9 to the left, a..i as far to the right, . not at all.
  static int Steps(char cell) { return cell >= 'a' ? -(cell - 'a' + 1) : Digit(cell); }

  void ApplyPair(int a, int b, const std::string& what, char cell) {
    const std::vector<std::string>& sets = case_.entity_table[a].sensor_sets;
    const auto set = std::find(sets.begin(), sets.end(), what);
    if (what == "looks") {
      looks_[a].gazes_at = b;
    } else if (what == "presses") {
      TouchOf(a, b).normal_force_n = Digit(cell);
    } else if (set != sets.end()) {
      TouchOf(a, b).sensor_sets |= 1U << (set - sets.begin());
    } else {
      AddTouch(a, b, what, cell);
    }
  }

  // The touch of two, made if there is none.
  Touch& TouchOf(int a, int b) {
    if (a > b) std::swap(a, b);
    const auto found = std::find_if(touches_.begin(), touches_.end(),
                                    [&](const Touch& t) { return t.a == a && t.b == b; });
    if (found != touches_.end()) return *found;
    touches_.push_back({.a = a, .b = b, .up_on_a = 0, .up_on_b = 0, .normal_force_n = 1});
    return touches_.back();
  }

  static void Shake(EntitySample& look, double seconds) {
    constexpr double kAmplitude_m = 0.0002;
    constexpr double kRadPerSecond = 300;
    look.p_WB_m.x() += kAmplitude_m * std::sin(kRadPerSecond * seconds);
    look.v_WB_m_per_s.x() += kAmplitude_m * kRadPerSecond * std::cos(kRadPerSecond * seconds);
  }

  void AddTouch(int a, int b, const std::string& how, char cell) {
    Touch touch{.a = a, .b = b, .up_on_a = 0, .up_on_b = 0, .normal_force_n = 1};
    if (how == "on") {
      touch.up_on_a = 1;
      touch.up_on_b = -1;
    } else if (how == "holds") {
      touch.sensor_sets = (1U << Digit(cell)) - 1;
    } else if (how != "beside") {
      Abort("case '" + case_.title + "': what is '" + how + "'?");
    }
    if (touch.a > touch.b) {
      std::swap(touch.a, touch.b);
      std::swap(touch.up_on_a, touch.up_on_b);
    }
    touches_.push_back(touch);
  }

  const CorpusCase& case_;
  std::map<std::string, int> ids_;
  std::vector<EntitySample> looks_;
  std::vector<CollisionSphere> collision_spheres_;
  std::vector<HandSample> hands_;
  std::vector<Touch> touches_;
};

// Steps of a jittered camera, in ticks; the mean is the usual frame.
Tick NextFrame(const CorpusCase& c, int index, int frames_per_second) {
  static constexpr std::array<Tick, 7> kJitter = {36, 25, 47, 14, 58, 32, 40};
  return c.jittered ? kJitter[static_cast<std::size_t>(index) % kJitter.size()]
                    : kTicksPerSecond / frames_per_second;
}

std::string EventName(const std::string& label) { return label.substr(0, label.find('(')); }

}  // namespace

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) Abort("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Includer LibraryIncluder() {
  return [](std::string_view name) -> std::optional<GrammarText> {
    const std::string file = name.ends_with(".grammar")
                                 ? std::string(name)
                                 : "grammar/library/" + std::string(name) + ".grammar";
    if (!std::ifstream(std::string(PREHEND_SOURCE_DIR) + "/" + file)) return std::nullopt;
    return GrammarText{file, ReadFile(std::string(PREHEND_SOURCE_DIR) + "/" + file)};
  };
}

std::shared_ptr<const Program> CompileLibrary(const std::string& name, const Overrides& overrides) {
  const std::optional<GrammarText> text = LibraryIncluder()(name);
  if (!text) Abort("no grammar " + name);
  CompileResult result = Compile(*text, LibraryIncluder(), overrides);
  if (!result.program) Abort(Format(result.diagnostics));
  return result.program;
}

std::vector<CorpusCase> ReadCorpus(const std::string& path) {
  return ReadCorpusText(path, ReadFile(path));
}

std::vector<CorpusCase> ReadCorpusText(const std::string& path, const std::string& text) {
  std::vector<CorpusCase> cases;
  std::istringstream lines(text);
  bool in_expected = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto bar = line.find('|');
    if (line.empty() || line[0] == '#') continue;
    if (line.starts_with("== ")) {
      cases.push_back({.title = line.substr(3),
                       .line = number,
                       .entity_table = ParseEntities("hand:Hand cup:Movable table:Fixed")});
      in_expected = false;
    } else if (cases.empty()) {
      Abort(path + ": a case starts with '== TITLE'");
    } else if (line == "--") {
      in_expected = true;
    } else if (line == "rates") {
      cases.back().rates = {30, 60, 90, kUsualFramesPerSecond, 240};
    } else if (line == "jittered") {
      cases.back().jittered = true;
    } else if (line.starts_with("grammar ")) {
      cases.back().grammar = Trim(line.substr(8));
    } else if (line.starts_with("entities ")) {
      cases.back().entity_table = ParseEntities(line.substr(9));
    } else if (bar != std::string::npos) {
      const std::string cells = line.substr(bar + 1, line.find('|', bar + 1) - bar - 1);
      (in_expected ? cases.back().expected : cases.back().facts)
          .push_back({Trim(line.substr(0, bar)), cells});
      if (cells.size() != cases.back().facts.front().cells.size()) {
        Abort(path + ":" + std::to_string(number) +
              ": this row is longer or shorter than the first");
      }
    } else {
      Abort(path + ":" + std::to_string(number) + ": cannot read this line");
    }
  }
  return cases;
}

CorpusRun RunCase(const CorpusCase& c, int frames_per_second) {
  static std::map<std::string, std::shared_ptr<const Program>> programs;
  std::shared_ptr<const Program>& program = programs[c.grammar];
  if (!program) program = CompileLibrary(c.grammar);
  return RunCase(c, program, frames_per_second);
}

CorpusRun RunCase(const CorpusCase& c, const std::shared_ptr<const Program>& program,
                  int frames_per_second) {
  const EntityTable entity_table{
      .ticks_per_second = kTicksPerSecond, .entities = c.entity_table, .styles = {"wrap"}};
  Monitor monitor(program, entity_table);
  Stage stage(c);
  std::vector<Event> events;
  const Tick end = kColumnTicks * static_cast<Tick>(c.facts.front().cells.size());
  int index = 0;
  for (Tick tick = 0; tick < end; tick += NextFrame(c, index++, frames_per_second))
    monitor.Advance(stage.Look(tick), events);
  monitor.Finish(end, events);
  return {monitor.error(), NameEvents(*program, entity_table, events)};
}

std::vector<Row> DrawEvents(const CorpusCase& c, const Timeline& timeline) {
  std::vector<std::string> wanted;
  for (const Row& row : c.expected) wanted.push_back(EventName(row.name));
  std::vector<Row> rows;
  for (const NamedEvent& event : timeline.events) {
    const bool background = event.event == "contact" || event.event == "supported_by";
    if (background && std::find(wanted.begin(), wanted.end(), event.event) == wanted.end())
      continue;
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const Row& r) { return r.name == event.Label(); });
    if (row == rows.end()) {
      rows.push_back({event.Label(), std::string(c.facts.front().cells.size(), '.')});
      row = rows.end() - 1;
    }
    const auto column = [](Tick tick) {
      return static_cast<std::size_t>((tick + kColumnTicks / 2) / kColumnTicks);
    };
    const std::size_t begin = column(event.interval.begin);
    for (std::size_t i = begin; i < column(event.interval.end) && i < row->cells.size(); ++i) {
      row->cells[i] = i == begin ? '[' : '=';
    }
  }
  return rows;
}

std::string Text(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    text += row.name + std::string(row.name.size() < 28 ? 28 - row.name.size() : 0, ' ') + "|" +
            row.cells + "|\n";
  }
  return text;
}

}  // namespace prehend::grammar::testing
