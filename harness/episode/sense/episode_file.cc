// SPDX-License-Identifier: Apache-2.0
// Writes an episode, see harness/episode/sense/episode_file.h.
#include "harness/episode/sense/episode_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/base/base/project_paths.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Json ToJson(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

bool IsHand(const grammar::EntityInfo& member) { return member.classes.front() == "Hand"; }

/// Classes of an entity that is not a hand: its own, its base classes, the built-in ones.
void AddClasses(const std::vector<std::string>& classes, Json& json) {
  const auto given = std::find_if(classes.begin() + 1, classes.end(), grammar::IsRootClass);
  json["class"] = classes.front();
  if (given != classes.begin() + 1)
    json["kinds"] = std::vector<std::string>(classes.begin() + 1, given);
  json["fixed"] = *given == "Fixed";
  if (*given == "Jointed") json["jointed"] = true;
  if (*given == "Attached") json["attached"] = true;
  if (*given == "Entity" || *given == "Person" || *given == "BodyPart") json["person"] = true;
  if (*given == "Grains") json["grains"] = true;
  if (given + 1 != classes.end() && *(given + 1) == "Abstract") json["abstract"] = *given;
}

/// A shape as [its key, what it says].
struct ShapeJson {
  std::pair<const char*, Json> operator()(const grammar::Box& box) const {
    return {"box", {{"size_m", ToJson(2 * box.half_size_m)}}};
  }
  std::pair<const char*, Json> operator()(const grammar::Ball& ball) const {
    return {"sphere", {{"radius_m", ball.radius_m}}};
  }
  std::pair<const char*, Json> operator()(const grammar::Cylinder& cylinder) const {
    return {"cylinder", Round(cylinder.radius_m, cylinder.half_length_m)};
  }
  std::pair<const char*, Json> operator()(const grammar::Capsule& capsule) const {
    return {"capsule", Round(capsule.radius_m, capsule.half_length_m)};
  }
  std::pair<const char*, Json> operator()(const grammar::Hull& hull) const {
    Json points = Json::array();
    for (const Eigen::Vector3d& point : hull.points_m) points.push_back(ToJson(point));
    return {"hull", {{"points_m", std::move(points)}}};
  }

 private:
  static Json Round(double radius_m, double half_length_m) {
    return {{"radius_m", radius_m}, {"length_m", 2 * half_length_m}};
  }
};

Json PartJson(const grammar::SolidPart& part) {
  auto [key, shape] = std::visit(ShapeJson{}, part.shape);
  Json json = {{key, std::move(shape)}};
  if (!part.p_BS_m.isZero(0)) json["at_m"] = ToJson(part.p_BS_m);
  if (part.q_BS.vec() != Eigen::Vector3d::Zero()) json["quat_wxyz"] = ToJson(part.q_BS);
  return json;
}

Json MemberJson(const grammar::EntityInfo& member, const grammar::EntityTable& entity_table) {
  Json json = {{"centre_m", ToJson(member.p_BC_m)}, {"size_m", ToJson(2 * member.half_size_m)}};
  for (const grammar::SolidPart& part : member.solid.parts())
    json["parts"].push_back(PartJson(part));
  if (member.part_of != grammar::kNoEntity)
    json["part_of"] = entity_table.entities[member.part_of].name;
  if (member.mass_kg > 0) json["mass_kg"] = member.mass_kg;
  if (member.strength_n > 0) json["strength_n"] = member.strength_n;
  if (IsHand(member)) {
    json["hand"] = true;
    json["sensor_sets"] = member.sensor_sets;
  } else {
    AddClasses(member.classes, json);
    if (member.round) json["round"] = true;
  }
  return json;
}

// Lines of frames are written straight from the structs, with each number as Json writes it.

void Add(double number, std::string& line) {
  if (number == 0 && !std::signbit(number)) {
    line += "0.0";
  } else if (!std::isfinite(number)) {
    line += "null";
  } else {
    std::array<char, 64> text{};
    line.append(text.data(), nlohmann::detail::to_chars(text.data(), &text.back(), number));
  }
}

void Add(std::initializer_list<double> numbers, std::string& line) {
  char before = '[';
  for (const double number : numbers) {
    line += std::exchange(before, ',');
    Add(number, line);
  }
  line += ']';
}

void Add(const Eigen::Vector3d& v, std::string& line) { Add({v.x(), v.y(), v.z()}, line); }

template <typename Value>
void Add(const char* key, const Value& value, std::string& line) {
  line += key;
  Add(value, line);
}

void AddName(const std::string& name, std::string& line) {
  const bool is_plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  line += is_plain ? '"' + name + '"' : Json(name).dump();
}

void AddSample(const grammar::EntitySample& look, const grammar::EntityTable& entity_table,
               const WrittenFacts& facts, std::string& line) {
  if (!grammar::IsTracked(look)) {
    line += "null";
    return;
  }
  const Eigen::Quaterniond& q = look.q_WB;
  Add(R"({"at_m":)", look.p_WB_m, line);
  line += R"(,"quat_wxyz":)";
  Add({q.w(), q.x(), q.y(), q.z()}, line);
  Add(R"(,"v_m_per_s":)", look.v_WB_m_per_s, line);
  Add(R"(,"w_rad_per_s":)", look.w_WB_rad_per_s, line);
  if (look.asleep) line += R"(,"asleep":true)";
  if (facts.joints && look.joint_position != 0)
    Add(R"(,"joint_position":)", look.joint_position, line);
  if (facts.joints && look.joint_fraction != 0)
    Add(R"(,"joint_fraction":)", look.joint_fraction, line);
  if (facts.gazes && look.gazes_at != grammar::kNoEntity) {
    line += R"(,"gazes_at":)";
    AddName(entity_table.entities[look.gazes_at].name, line);
  }
  line += '}';
}

void AddHand(const grammar::HandSample& hand, const grammar::EntityTable& entity_table,
             const WrittenFacts& facts, std::string& line) {
  line += '{';
  if (facts.trigger) {
    Add(R"("trigger":)", hand.trigger, line);
    line += ',';
  }
  Add(R"("ahead":)", hand.ahead_W, line);
  if (facts.touches) {  // where the fingers are, they may touch
    line += R"(,"collision_spheres_m":[)";
    for (const grammar::CollisionSphere& one : hand.collision_spheres) {
      if (line.back() == ']') line += ',';
      Add({one.p_W_m.x(), one.p_W_m.y(), one.p_W_m.z(), one.radius_m}, line);
    }
    line += ']';
  }
  if (facts.trigger && hand.style >= 0 &&
      hand.style < static_cast<int>(entity_table.styles.size())) {
    line += R"(,"style":)";
    AddName(entity_table.styles[hand.style], line);
  }
  line += '}';
}

Json TouchJson(const grammar::Touch& touch, const grammar::EntityTable& entity_table) {
  Json json = {{"a", entity_table.entities[touch.a].name},
               {"b", entity_table.entities[touch.b].name},
               {"up_on_a", std::clamp(touch.up_on_a, -1.0, 1.0)},  // a unit vector's, nearly
               {"up_on_b", std::clamp(touch.up_on_b, -1.0, 1.0)},
               {"force_n", touch.normal_force_n}};
  if (!std::isnan(touch.vertical_speed_m_per_s))
    json["vertical_speed_m_per_s"] = touch.vertical_speed_m_per_s;
  if (!touch.nhat_BA_W.isZero()) {
    json["at_m"] = ToJson(touch.p_W_m);
    json["normal"] = ToJson(touch.nhat_BA_W);
  }
  for (const int one : {touch.a, touch.b}) {
    const std::vector<std::string>& sets = entity_table.entities[one].sensor_sets;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      if (touch.sensor_sets >> i & 1) json["sensor_sets"].push_back(sets[i]);
    }
    if (!sets.empty()) break;  // of two hands, the sets are those of the first
  }
  return json;
}

}  // namespace

const GapTolerance::Seen* GapTolerance::LastOf(std::size_t entity, grammar::Tick tick) const {
  const std::optional<Seen>& last = seen_[entity].last;
  return last && tick - last->tick <= most_ ? &*last : nullptr;
}

void GapTolerance::Fill(grammar::Tick tick, std::vector<grammar::EntitySample>& looks) {
  for (std::size_t i = 0; i < looks.size(); ++i) {
    Entity& entity = seen_[i];
    entity.gaps = GapsUntil(tick, i);
    const bool is_tracked = grammar::IsTracked(looks[i]);
    if (entity.tracked && !is_tracked) ++entity.gaps.gaps;
    entity.tracked = is_tracked;
    if (is_tracked)
      entity.last = {tick, looks[i]};
    else if (const Seen* last = LastOf(i, tick))
      (looks[i] = last->look).bridged = true;
  }
  before_ = tick;
}

// What a frame says holds until the next one.
LookGaps GapTolerance::GapsUntil(grammar::Tick tick, std::size_t entity) const {
  const auto& [last, tracked, so_far] = seen_[entity];
  LookGaps gaps = so_far;
  if (!tracked) (LastOf(entity, *before_) ? gaps.bridged : gaps.unknown) += tick - *before_;
  return gaps;
}

std::vector<LookGaps> GapTolerance::Gaps(grammar::Tick end_tick) const {
  std::vector<LookGaps> all;
  for (std::size_t i = 0; i < seen_.size(); ++i) all.push_back(GapsUntil(end_tick, i));
  return all;
}

std::string GapsText(const grammar::EntityTable& table, const std::vector<LookGaps>& gaps) {
  std::string text;
  const auto rate = static_cast<double>(table.ticks_per_second);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i].gaps == 0) continue;
    text += fmt::format(
        "warning: '{}' is not tracked in {} gap{}: {:.3f} s are bridged, in {:.3f} s it is "
        "unknown\n",
        table.entities[i].name, gaps[i].gaps, gaps[i].gaps == 1 ? "" : "s",
        static_cast<double>(gaps[i].bridged) / rate, static_cast<double>(gaps[i].unknown) / rate);
  }
  return text;
}

grammar::Tick MovedBy(grammar::Tick first_frame) {
  return std::max<grammar::Tick>(0, -first_frame);
}

std::string MovedText(const EpisodeHeader& header, grammar::Tick moved) {
  if (moved == 0) return "";
  const double by_s =
      static_cast<double>(moved) / static_cast<double>(header.entity_table.ticks_per_second);
  return fmt::format(
      "warning: '{}' begins at {:.9g} s: times count from its first frame\n"
      "  hint: of labels by its own clock: offset_s: {:.9g} in their map\n",
      header.episode, -by_s, by_s);
}

EpisodeWriter::EpisodeWriter(std::ostream& out, const EpisodeHeader& header,
                             const WrittenFacts& facts)
    : out_(out),
      facts_(facts),
      bridges_(header.bridge_s > 0),
      entity_table_(header.entity_table),
      shown_(header.entity_table.entities.size()) {
  Json entities = Json::object();
  for (const grammar::EntityInfo& member : entity_table_.entities)
    entities[member.name] = MemberJson(member, entity_table_);
  Json first = {{"recording", kEpisodeVersion}, {"episode", header.episode}};
  if (const auto several = SplitGrammars(header.grammar); several.size() > 1)
    first["grammar"] = several;
  else if (!header.grammar.empty())
    first["grammar"] = header.grammar;
  first["ticks_per_second"] = entity_table_.ticks_per_second;
  if (header.bridge_s != kBridge_s) first["bridge_s"] = header.bridge_s;
  if (header.attributes.success) first["success"] = *header.attributes.success;
  if (!header.attributes.language.empty()) first["language"] = header.attributes.language;
  first["styles"] = entity_table_.styles;
  first["entities"] = std::move(entities);
  out_ << first.dump() << "\n";
}

void EpisodeWriter::Write(const grammar::Frame& frame) {
  std::string line = fmt::format(R"({{"tick":{},"samples":{{)", frame.tick);
  const auto begin_of = [&](int entity) {
    if (line.back() != '{') line += ',';
    AddName(entity_table_.entities[entity].name, line);
    line += ':';
    return line.size();
  };
  for (std::size_t i = 0; i < frame.entities.size(); ++i) {
    const std::size_t before = line.size(), begin = begin_of(static_cast<int>(i));
    const grammar::EntitySample& look = frame.entities[i];
    if (look.bridged && bridges_)  // who reads it does the same
      line += "null";
    else
      AddSample(look, entity_table_, facts_, line);
    const std::string_view text = std::string_view(line).substr(begin);
    if (text == shown_[i]) {
      line.resize(before);
    } else {
      shown_[i] = text;
    }
  }
  line += R"(},"hands":{)";
  for (const grammar::HandSample& hand : frame.hands) {
    begin_of(hand.entity);
    AddHand(hand, entity_table_, facts_, line);
  }
  line += '}';
  if (facts_.touches) {
    Json touches = Json::array();
    for (const grammar::Touch& touch : frame.touches)
      touches.push_back(TouchJson(touch, entity_table_));
    line += R"(,"touches":)" + touches.dump();
  }
  out_ << line << "}\n";
}

void EpisodeWriter::Finish(grammar::Tick end_tick) {
  out_ << Json{{"end_tick", end_tick}}.dump() << "\n";
}

void Recording::EachFrame(const Look& look) {
  if (play) return play(look);
  for (EpisodeFrame& frame : frames) look(frame);
}

void Recording::Keep() {
  if (const auto played = std::exchange(play, nullptr))
    played([&](const EpisodeFrame& frame) { frames.push_back(frame); });
}

}  // namespace prehend::episode
