// SPDX-License-Identifier: Apache-2.0
// Reads an episode line by line, with the field tables and error messages of scenario files. Tested
// by tests/harness/episode/sense/episode_file_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "grammar/base/check.h"
#include "grammar/base/frame.h"
#include "harness/base/base/input_files.h"
#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {
namespace {

GapTolerance BridgeOf(const EpisodeHeader& header) {
  const double most = header.bridge_s * static_cast<double>(header.entity_table.ticks_per_second);
  return {header.entity_table.entities.size(), static_cast<grammar::Tick>(most)};
}

}  // namespace

/// Reads line after line into an episode. The first line with an error ends it.
class EpisodeReader {
 public:
  /// `keeps_all`: frames of TakeOrNothing(), not only the last one.
  explicit EpisodeReader(std::string file, bool keeps_all = false)
      : file_(std::move(file)),
        line_format_(LineFormat()),
        keeps_all_(keeps_all),
        no_document_{.sources = {{file_, ""}}} {}

  grammar::Diagnostics diagnostics;
  Recording episode;
  double most_ahead_s = 0;       ///< EpisodeStream::DoubtFrames; 0: any
  std::span<EpisodeFrame> news;  ///< the frames that TakeOrNothing() has taken

  void TakeLine(const std::string& text) {
    ++line_;
    if (TakeUsualFrame(text)) return;
    if (text.find_first_not_of(" \r") == std::string::npos) return;
    const bool is_marked = line_ == 1 && text.starts_with("\xEF\xBB\xBF");
    auto document = ParseJson(file_, is_marked ? text.substr(3) : text);
    if (!document) return Report(std::move(document.error()));
    DiagnosticList errors(*document);
    if (!header_) {
      HeaderEntry header;
      if (HeaderFormat().Read(document->root, errors, header)) {
        TakeHeader(header, errors);
        if (document->root.Find("grammar"))
          episode.header.grammar_named = ErrorAt(*document, header.grammar.where);
        episode.header.grammar_named.place.line = line_;
      }
      header_ = true;
    } else {
      LineEntry line;
      if (line_format_.Read(document->root, errors, line)) {
        std::visit([&](const auto& entry) { Take(entry, errors); }, line);
      }
    }
    if (!errors.empty()) Report(errors.Sorted());
  }

  void TakeLine(const FrameEntry& frame) {
    ++line_;
    DiagnosticList errors(no_document_);
    Take(frame, errors);
    if (!errors.empty()) Report(errors.Sorted());
  }

  /// As if it had not been there, if there is anything wrong with the line or frame. A frame that
  /// comes far too late waits for the next one: if that agrees with it, there was a pause.
  template <typename Entry>
  grammar::Diagnostics TakeOrNothing(const Entry& entry) {
    const EpisodeFrame now = now_;
    const std::vector<bool> has_ahead = has_ahead_, has_spheres = has_spheres_;
    const GapTolerance bridge = bridge_;
    std::vector<EpisodeFrame>& all = episode.frames;
    if (!keeps_all_ && all.size() > 1) all.erase(all.begin(), all.end() - 1);
    const std::size_t frames = all.size();
    const bool said_its_end = episode.says_its_end;
    const grammar::Tick end_tick = episode.end_tick;
    const auto undo = [&] {
      now_ = now;
      has_ahead_ = has_ahead;
      has_spheres_ = has_spheres;
      bridge_ = bridge;
      all.resize(frames);
      episode.says_its_end = said_its_end;
      episode.end_tick = end_tick;
    };
    TakeLine(entry);
    grammar::Diagnostics found = std::exchange(diagnostics, {});
    if (!found.empty() && had_header_) undo();
    if (found.empty() && header_) had_header_ = true;
    if (most_ahead_s > 0 && frames > 0 && all.size() > frames) {
      const double rate = static_cast<double>(episode.header.entity_table.ticks_per_second),
                   ahead_s = static_cast<double>(now_.tick - now.tick) / rate;
      const auto since = static_cast<double>(now_.tick - waiting_tick_);
      const auto waiting = std::exchange(waiting_, nullptr);
      found = LeftOut();
      if (ahead_s > most_ahead_s && waiting && since > 0 && since <= most_ahead_s * rate) {
        undo();
        line_ -= 2;  // as many lines are taken again
        waiting();
        TakeLine(entry);
        found = std::exchange(diagnostics, {});
      } else if (ahead_s > most_ahead_s) {
        waiting_tick_ = now_.tick;
        waiting_ = [this, entry] { TakeLine(entry); };
        undo();
        Report(fmt::format("a frame {:.6g} s after the one before is left out", ahead_s),
               "is its time right?");
        left_out_ = std::exchange(diagnostics, {});
      }
    }
    news = {all.begin() + static_cast<std::ptrdiff_t>(frames), all.end()};
    return found;
  }
  grammar::Diagnostics LeftOut() { return std::exchange(left_out_, {}); }
  bool has_header() const { return had_header_; }

  void Finish() {
    if (!diagnostics.empty()) return;
    if (!header_) return Report("the file is empty", "");
    if (episode.frames.empty())
      return Report("the recording has no frames",
                    "each line after the first is one: {\"tick\": 0, ...}");
    if (!episode.says_its_end) episode.end_tick = episode.frames.back().tick + 1;
    episode.gaps = Gaps(episode.end_tick);
    episode.moved = MovedBy(episode.frames.front().tick);
    for (EpisodeFrame& frame : episode.frames) frame.tick += episode.moved;
    episode.end_tick += episode.moved;
  }

  std::vector<LookGaps> Gaps(grammar::Tick end) const { return bridge_.Gaps(end); }

  void Report(std::string message, std::string hint) {
    diagnostics.push_back({.file = file_,
                           .place = {std::max(line_, 1), 1},
                           .message = std::move(message),
                           .hint = std::move(hint)});
  }

 private:
  /// False, with nothing changed, if it is something else, or if there is anything to say about it.
  bool TakeUsualFrame(const std::string& text) {
    if (!header_ || !ScanFrame(text, scanned_) || episode.says_its_end) return false;
    if (!episode.frames.empty() && scanned_.tick.value <= now_.tick) return false;
    const auto known = [&](const auto& entry) {
      return std::find(names_.begin(), names_.end(), entry.name) != names_.end();
    };
    const auto known_hand = [&](const auto& entry) {
      return std::ranges::any_of(hands_, [&](int hand) { return names_[hand] == entry.name; });
    };
    if (!std::ranges::all_of(scanned_.samples, known) ||
        !std::ranges::all_of(scanned_.hands, known_hand) ||
        episode.frames.size() >= kMaxEpisodeFrames)
      return false;
    DiagnosticList errors(no_document_);
    Take(scanned_, errors);
    PREHEND_CHECK(errors.empty());
    return true;
  }

  void Report(grammar::Diagnostics found) {
    for (grammar::Diagnostic& diagnostic : found) diagnostic.place.line = line_;
    diagnostics = std::move(found);
  }

  void TakeHeader(const HeaderEntry& header, DiagnosticList& errors) {
    episode.header.episode = header.episode;
    episode.header.grammar = header.grammar.value;
    grammar::EntityTable& entity_table = episode.header.entity_table;
    entity_table.ticks_per_second = header.ticks_per_second;
    entity_table.styles = header.styles;
    for (const Named<MemberEntry>& entry : header.entities) names_.push_back(entry.name);
    for (const Named<MemberEntry>& entry : header.entities) {
      const MemberEntry& m = entry.value;
      grammar::EntityInfo& member = entity_table.entities.emplace_back();
      member.name = entry.name;
      member.p_BC_m = m.centre_m;
      member.half_size_m = m.size_m / 2;
      member.solid = SolidOf(m.parts);
      member.round = m.round;
      member.mass_kg = m.mass_kg;
      member.strength_n = m.strength_n;
      if (m.part_of) member.part_of = IndexOf(m.part_of->value, m.part_of->where, errors);
      if (m.hand) {
        member.classes = {"Hand", "Entity"};
        member.sensor_sets = m.sensor_sets;
        hands_.push_back(static_cast<int>(entity_table.entities.size()) - 1);
      } else {
        member.classes = m.kinds;
        member.classes.insert(member.classes.begin(), m.class_name);
        for (const std::string& root : RootsOf(m))
          if (std::ranges::count(member.classes, root) == 0) member.classes.push_back(root);
      }
      CheckMember(entry, member.classes, errors);
    }
    CheckParts(header, errors);
    episode.header.bridge_s = header.bridge_s;
    episode.header.attributes = {.success = header.success, .language = header.language};
    now_.entities.resize(names_.size(), grammar::NotTracked());
    bridge_ = BridgeOf(episode.header);
    for (const int hand : hands_) now_.hands.push_back({.entity = hand});
    now_.collision_spheres.resize(hands_.size());
    has_ahead_.resize(hands_.size());
    has_spheres_.resize(hands_.size());
  }

  static void CheckMember(const Named<MemberEntry>& entry, const std::vector<std::string>& classes,
                          DiagnosticList& errors) {
    const MemberEntry& m = entry.value;
    const auto add = [&](const std::string& what, const char* hint = "") {
      errors.Add(entry.name_where, fmt::format("'{}': {}", entry.name, what), hint);
    };
    if (entry.name == "any") add("this name stands for everybody, in claims and queries");
    if (m.round && (m.size_m.array() != m.size_m.x()).any())
      add(fmt::format("round: it is a ball, and its edges are {:g}, {:g} and {:g} m", m.size_m.x(),
                      m.size_m.y(), m.size_m.z()),
          "size_m: three times its diameter");
    std::vector<std::string> own = RootsOf(m);
    if (m.person) own.insert(own.end(), {"Person", "BodyPart"});
    if (const std::string wrong = grammar::WrongRoot(classes, own); !wrong.empty() && !m.hand)
      add("the class '" + wrong + "' is built in, and by its keys it is " + own[0],
          "say it by keys, like 'fixed' or 'hand'; name your own classes otherwise");
    if (const std::string twice = Repeated(m.kinds); !twice.empty())
      add("the kind '" + twice + "' is given twice");
    if (const std::string twice = Repeated(m.sensor_sets); !twice.empty())
      add("the sensor set '" + twice + "' is given twice");
  }

  /// The first name that is there before; "" if there is none.
  static std::string Repeated(const std::vector<std::string>& names) {
    for (auto name = names.begin(); name != names.end(); ++name) {
      if (std::find(names.begin(), name, *name) != name) return *name;
    }
    return "";
  }

  /// Nothing is a part of itself, however many parts lie between.
  void CheckParts(const HeaderEntry& header, DiagnosticList& errors) const {
    const std::vector<grammar::EntityInfo>& members = episode.header.entity_table.entities;
    for (std::size_t i = 0; i < members.size(); ++i) {
      int whole = members[i].part_of;
      for (std::size_t steps = 0; whole != grammar::kNoEntity && steps < members.size(); ++steps) {
        if (whole == static_cast<int>(i)) {
          errors.Add(header.entities[i].value.part_of->where,
                     fmt::format("'{}' is a part of itself", members[i].name));
          return;
        }
        whole = members[static_cast<std::size_t>(whole)].part_of;
      }
    }
  }

  static grammar::Solid SolidOf(const std::vector<PartEntry>& entries) {
    std::vector<grammar::SolidPart> parts;
    for (const PartEntry& entry : entries) {
      grammar::SolidPart& part = parts.emplace_back();
      if (entry.box) part.shape = *entry.box;
      if (entry.sphere) part.shape = *entry.sphere;
      if (entry.cylinder) part.shape = *entry.cylinder;
      if (entry.capsule) part.shape = *entry.capsule;
      if (entry.hull) part.shape = *entry.hull;
      part.p_BS_m = entry.at_m;
      const Eigen::Vector4d& q = entry.quat_wxyz;
      part.q_BS = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    }
    return grammar::Solid(std::move(parts));
  }

  /// What an entity that is not a hand is by its keys.
  static std::vector<std::string> RootsOf(const MemberEntry& m) {
    if (!m.abstract.empty()) return {m.abstract, "Abstract", "Entity"};
    if (m.grains) return {"Grains", "Entity"};
    if (m.person) return {m.part_of ? "BodyPart" : "Person", "Entity"};
    return {m.fixed      ? "Fixed"
            : m.jointed  ? "Jointed"
            : m.attached ? "Attached"
                         : "Movable",
            "Thing", "Entity"};
  }

  /// The entity of this name; otherwise kNoEntity, and an error is reported.
  int IndexOf(const std::string& name, const Where& where, DiagnosticList& errors) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    errors.AddUnknownName(where, fmt::format("no entity is called '{}'", name), name, names_);
    return grammar::kNoEntity;
  }

  void Take(const EndEntry& entry, DiagnosticList& errors) {
    if (episode.says_its_end)
      return errors.Add(entry.end_tick.where, "a second line with 'end_tick'");
    episode.says_its_end = true;
    episode.end_tick = entry.end_tick.value;
    if (!episode.frames.empty() && episode.end_tick <= episode.frames.back().tick) {
      errors.Add(
          entry.end_tick.where,
          fmt::format("end_tick: expected more than {}, the tick of the last frame, found {}",
                      episode.frames.back().tick, episode.end_tick));
    }
  }

  void Take(const FrameEntry& entry, DiagnosticList& errors) {
    for (const FrameEntry& one : entry.before) Take(one, errors);
    const grammar::Tick before = now_.tick, tick = entry.tick.value;
    const bool first = episode.frames.empty();
    if (episode.says_its_end)
      return errors.Add(entry.tick.where, "a frame after the line with 'end_tick'");
    if (!first && tick <= before) {
      return errors.Add(entry.tick.where,
                        fmt::format("the ticks must increase: {} comes after {}", tick, before));
    }
    const double dt_s = static_cast<double>(tick - before) /
                        static_cast<double>(episode.header.entity_table.ticks_per_second);
    now_.tick = tick;
    for (grammar::EntitySample& look : now_.entities) {
      if (IsTracked(look)) look.v_WB_m_per_s = look.w_WB_rad_per_s = Eigen::Vector3d::Zero();
    }
    for (const Named<SampleEntry>& sample : entry.samples) {
      const int index = IndexOf(sample.name, sample.name_where, errors);
      if (index == grammar::kNoEntity) continue;
      const auto entity = static_cast<std::size_t>(index);
      if (sample.value.not_tracked) {
        now_.entities[entity] = grammar::NotTracked();
        continue;
      }
      episode.placed.resize(now_.entities.size());
      episode.placed[entity] = true;
      const double since_s = SinceLastLook_s(entity, dt_s);
      TakeSample(sample.value, first ? 0 : since_s, now_.entities[entity]);
      if (const auto& gazes_at = sample.value.gazes_at) {
        now_.entities[index].gazes_at = IndexOf(gazes_at->value, gazes_at->where, errors);
      }
    }
    for (const Named<HandEntry>& hand : entry.hands) TakeHand(hand, errors);
    FollowTheirSamples();
    now_.touches.clear();
    EpisodeFrame& frame = episode.frames.emplace_back(now_);
    bridge_.Fill(tick, frame.entities);
    for (const TouchEntry& touch : entry.touches) TakeTouch(touch, frame.entities, errors);
    std::ranges::sort(now_.touches, {}, [](const auto& one) { return std::pair(one.a, one.b); });
    frame.touches = now_.touches;
    if (episode.frames.size() > kMaxEpisodeFrames)
      errors.Add(entry.tick.where, fmt::format("more than {} frames", kMaxEpisodeFrames));
  }

  /// The time since the look that its velocity follows from, which `now_` holds then; 0 if how it
  /// came here is not known.
  double SinceLastLook_s(std::size_t entity, double dt_s) {
    if (IsTracked(now_.entities[entity])) return dt_s;
    const GapTolerance::Seen* last = bridge_.LastOf(entity, now_.tick);
    now_.entities[entity] = last ? last->look : grammar::EntitySample();
    return last ? static_cast<double>(now_.tick - last->tick) /
                      static_cast<double>(episode.header.entity_table.ticks_per_second)
                : 0;
  }

  /// Velocities that are not given are computed from the previous sample and this one.
  static void TakeSample(const SampleEntry& entry, double dt_s, grammar::EntitySample& look) {
    const grammar::EntitySample before = look;
    look.v_WB_m_per_s = look.w_WB_rad_per_s = Eigen::Vector3d::Zero();
    look.p_WB_m = entry.at_m;
    if (entry.quat_wxyz) {
      const Eigen::Vector4d& q = entry.quat_wxyz->value;
      look.q_WB = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    }
    look.asleep = entry.asleep;
    look.joint_position = entry.joint_position;
    look.joint_fraction = entry.joint_fraction;
    look.gazes_at = grammar::kNoEntity;
    if (dt_s > 0) {
      look.v_WB_m_per_s = (look.p_WB_m - before.p_WB_m) / dt_s;
      const Eigen::AngleAxisd turn(look.q_WB * before.q_WB.conjugate());
      look.w_WB_rad_per_s = turn.axis() * turn.angle() / dt_s;
    }
    if (entry.v_m_per_s) look.v_WB_m_per_s = *entry.v_m_per_s;
    if (entry.w_rad_per_s) look.w_WB_rad_per_s = *entry.w_rad_per_s;
  }

  void TakeHand(const Named<HandEntry>& named, DiagnosticList& errors) {
    const int entity = IndexOf(named.name, named.name_where, errors);
    if (entity == grammar::kNoEntity) return;
    const auto found = std::find(hands_.begin(), hands_.end(), entity);
    if (found == hands_.end())
      return errors.Add(named.name_where, fmt::format("'{}' is not a hand", named.name),
                        "its entity has no 'hand: true'");
    const auto slot = static_cast<std::size_t>(found - hands_.begin());
    const HandEntry& entry = named.value;
    grammar::HandSample& hand = now_.hands[slot];
    hand.trigger = entry.trigger;
    if (entry.ahead && entry.ahead->isZero())
      errors.Add(named.name_where,
                 fmt::format("'{}': ahead: expected a direction, found [0, 0, 0]", named.name));
    has_ahead_[slot] = entry.ahead && !entry.ahead->isZero();
    if (has_ahead_[slot]) hand.ahead_W = entry.ahead->normalized();
    if (entry.style) {
      const std::vector<std::string>& styles = episode.header.entity_table.styles;
      const auto style = std::find(styles.begin(), styles.end(), entry.style->value);
      if (style == styles.end())
        errors.AddUnknownName(entry.style->where,
                              fmt::format("no style is called '{}'", entry.style->value),
                              entry.style->value, styles);
      hand.style = static_cast<int>(style - styles.begin());
    }
    // Who is lost and has none given keeps those that it had.
    std::vector<grammar::CollisionSphere>& collision_spheres = now_.collision_spheres[slot];
    if (!entry.collision_spheres_m.empty()) collision_spheres.clear();
    for (const Eigen::Vector4d& f : entry.collision_spheres_m) {
      if (f[3] < 0)
        errors.Add(named.name_where,
                   fmt::format("'{}': a collision sphere of radius {:g}", named.name, f[3]));
      collision_spheres.push_back({f.head<3>(), std::max(f[3], 0.0)});
    }
    has_spheres_[slot] = !entry.collision_spheres_m.empty();
  }

  /// What was not given of a hand is where its sample is, also in frames that do not mention it.
  void FollowTheirSamples() {
    for (std::size_t slot = 0; slot < hands_.size(); ++slot) {
      const grammar::EntitySample& look = now_.entities[static_cast<std::size_t>(hands_[slot])];
      if (!IsTracked(look)) {
        now_.collision_spheres[slot].resize(
            std::max<std::size_t>(now_.collision_spheres[slot].size(), 1));
        continue;
      }
      if (!has_ahead_[slot]) now_.hands[slot].ahead_W = look.q_WB * Eigen::Vector3d::UnitX();
      if (!has_spheres_[slot]) now_.collision_spheres[slot].assign(1, {look.p_WB_m, 0});
    }
  }

  /// `looks` are those of its frame, short gaps bridged.
  void TakeTouch(const TouchEntry& entry, const std::vector<grammar::EntitySample>& looks,
                 DiagnosticList& errors) {
    int a = IndexOf(entry.a.value, entry.a.where, errors),
        b = IndexOf(entry.b.value, entry.b.where, errors);
    if (a == grammar::kNoEntity || b == grammar::kNoEntity) return;
    if (a == b)
      return errors.Add(entry.b.where, fmt::format("'{}' cannot touch itself", entry.b.value));
    grammar::Touch touch{.a = a,
                         .b = b,
                         .up_on_a = std::clamp(entry.up_on_a, -1.0, 1.0),
                         .up_on_b = std::clamp(entry.up_on_b.value_or(-entry.up_on_a), -1.0, 1.0),
                         .normal_force_n = entry.force_n};
    touch.vertical_speed_m_per_s = entry.vertical_speed_m_per_s.value_or(SpeedAtTheUpper(
        touch, looks[static_cast<std::size_t>(a)], looks[static_cast<std::size_t>(b)]));
    if (entry.at_m && entry.normal) {
      touch.p_W_m = *entry.at_m;
      touch.nhat_BA_W = entry.normal->normalized();
    }
    for (const Located<std::string>& set : entry.sensor_sets)
      touch.sensor_sets |= SetBit(set, a, b, errors);
    if (a > b) {
      std::swap(touch.a, touch.b);
      std::swap(touch.up_on_a, touch.up_on_b);
      touch.nhat_BA_W = -touch.nhat_BA_W;
    }
    const bool twice =
        std::any_of(now_.touches.begin(), now_.touches.end(),
                    [&](const grammar::Touch& t) { return t.a == touch.a && t.b == touch.b; });
    if (twice)
      return errors.Add(entry.a.where, fmt::format("the touch of '{}' and '{}' is given twice",
                                                   entry.a.value, entry.b.value));
    now_.touches.push_back(touch);
  }

  std::uint32_t SetBit(const Located<std::string>& set, int a, int b,
                       DiagnosticList& errors) const {
    const std::vector<grammar::EntityInfo>& members = episode.header.entity_table.entities;
    const std::vector<std::string>& sets =
        !members[a].sensor_sets.empty() ? members[a].sensor_sets : members[b].sensor_sets;
    const auto found = std::find(sets.begin(), sets.end(), set.value);
    if (found != sets.end()) return std::uint32_t{1} << (found - sets.begin());
    errors.AddUnknownName(set.where, fmt::format("no sensor set is called '{}'", set.value),
                          set.value, sets);
    return 0;
  }

  std::string file_;
  ValueFormat<LineEntry> line_format_;
  int line_ = 0;
  const bool keeps_all_;
  std::function<void()> waiting_;  ///< takes the frame that waits for the next one
  grammar::Tick waiting_tick_ = 0;
  grammar::Diagnostics left_out_;
  bool header_ = false;
  bool had_header_ = false;  ///< a good one
  std::vector<std::string> names_;
  std::vector<int> hands_;
  std::vector<bool> has_ahead_, has_spheres_;  ///< of each hand: its last mention gave them
  FrameEntry scanned_;                         ///< of TakeUsualFrame(); kept for its memory
  YamlDocument no_document_;
  EpisodeFrame now_;  ///< what is not tracked is not, however short
  GapTolerance bridge_;
};

grammar::Frame EpisodeFrame::View() {
  for (std::size_t i = 0; i < hands.size(); ++i) hands[i].collision_spheres = collision_spheres[i];
  return {tick, entities, hands, touches};
}

void BridgeLooks(Recording& episode) {
  const auto bridged = [fresh = BridgeOf(episode.header), end_tick = episode.end_tick,
                        bare = std::move(episode.play)](const Recording::Look& look) {
    GapTolerance bridge = fresh;
    bare([&](EpisodeFrame& frame) {
      bridge.Fill(frame.tick, frame.entities);
      look(frame);
    });
    return bridge.Gaps(end_tick);
  };
  episode.gaps = bridged([](EpisodeFrame&) {});
  episode.play = bridged;
}

struct EpisodeStream::Reader {
  EpisodeReader lines;
};

EpisodeStream::EpisodeStream(const std::string& name, bool keeps_all)
    : reader_(std::make_unique<Reader>(Reader{EpisodeReader(name, keeps_all)})) {}
EpisodeStream::~EpisodeStream() = default;

grammar::Diagnostics EpisodeStream::Take(const std::string& line) {
  return reader_->lines.TakeOrNothing(line);
}
grammar::Diagnostics EpisodeStream::Take(const FrameEntry& frame) {
  return reader_->lines.TakeOrNothing(frame);
}
grammar::Diagnostics EpisodeStream::LeftOut() { return reader_->lines.LeftOut(); }
std::span<EpisodeFrame> EpisodeStream::frames() { return reader_->lines.news; }

Result<Recording> EpisodeStream::Whole(grammar::Tick end_tick) {
  EpisodeReader& lines = reader_->lines;
  lines.episode.says_its_end = true;
  lines.episode.end_tick = end_tick;
  lines.Finish();
  if (!lines.diagnostics.empty()) return tl::unexpected(std::move(lines.diagnostics));
  return std::move(lines.episode);
}

void EpisodeStream::DoubtFrames(double ahead_s) { reader_->lines.most_ahead_s = ahead_s; }
bool EpisodeStream::has_header() const { return reader_->lines.has_header(); }
const EpisodeHeader& EpisodeStream::header() const { return reader_->lines.episode.header; }
std::string EpisodeStream::gaps() const {
  return has_header() ? GapsText(header().entity_table, reader_->lines.Gaps(end_tick())) : "";
}
bool EpisodeStream::says_its_end() const { return reader_->lines.episode.says_its_end; }
grammar::Tick EpisodeStream::end_tick() const {
  const Recording& episode = reader_->lines.episode;
  if (episode.frames.empty()) return 0;
  return episode.says_its_end ? episode.end_tick : episode.frames.back().tick + 1;
}

Result<Recording> ReadRecording(const std::string& path) {
  EpisodeReader reader(path);
  const auto refuse = [&](std::string why) {
    return tl::unexpected(grammar::Diagnostics{{.file = path, .message = std::move(why)}});
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    return refuse(std::filesystem::exists(path, error) ? "is not a regular file" : "no such file");
  if (const auto size = std::filesystem::file_size(path, error); error || size > kMaxEpisodeBytes)
    return refuse(fmt::format("is larger than {} MiB", kMaxEpisodeBytes >> 20));
  std::ifstream stream = OpenInput(path);
  if (!stream) return refuse(std::string("cannot be read: ") + std::strerror(errno));
  for (std::string line; reader.diagnostics.empty() && std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();  // written on Windows
    if (line.size() > kMaxEpisodeLineBytes) {
      reader.TakeLine(" ");
      reader.Report(
          fmt::format("a line of {} bytes; at most {} are read", line.size(), kMaxEpisodeLineBytes),
          "one frame per line");
      break;
    }
    reader.TakeLine(line);
  }
  reader.Finish();
  if (!reader.diagnostics.empty()) return tl::unexpected(std::move(reader.diagnostics));
  return std::move(reader.episode);
}

}  // namespace prehend::episode
