// SPDX-License-Identifier: Apache-2.0
#include "harness/library/library/frames.h"

#include <fmt/format.h>

#include <cmath>

#include "grammar/monitor.h"
#include "grammar/name_events.h"
#include "harness/base/base/project_paths.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/library/library/opened.h"

namespace prehend {
namespace {

constexpr const char* kFrames = "frames";  ///< the file, in messages
constexpr double kUnitTolerance = 0.01;

void Check(const grammar::Diagnostics& found) {
  if (!found.empty()) throw Error(found);
}

void TakeFirst(episode::EpisodeStream& stream, const std::string& line) {
  Check(stream.Take(line));
  if (!stream.has_header()) Refuse(kFrames, "no entities are named");
}

}  // namespace

struct FrameBuilder::State {
  episode::EpisodeStream stream{kFrames, true};
  episode::FrameEntry frame;  ///< kept for its memory

  const grammar::EntityTable& table() const { return stream.header().entity_table; }

  const std::string& NameOf(int entity) const {
    const auto index = static_cast<std::size_t>(entity);
    if (entity < 0 || index >= table().entities.size())
      Refuse(kFrames, fmt::format("found entity number {}, wanted 0 to {}", entity,
                                  table().entities.size() - 1));
    return table().entities[index].name;
  }

  [[noreturn]] void RefuseFrame(const std::string& message, const std::string& hint) const {
    const double time_s = truth::SecondsOf(frame.tick.value, table().ticks_per_second);
    Refuse(kFrames, fmt::format("at {:g} s (tick {}): {}", time_s, frame.tick.value, message),
           hint);
  }

  void Fill(const PoseSeen& pose, Named<episode::SampleEntry>& sample) const {
    const Eigen::Vector3d& p = pose.p_WB_m;
    sample.name = NameOf(pose.entity);
    sample.value.at_m = p;
    sample.value.not_tracked = p.array().isNaN().all();
    sample.value.quat_wxyz.reset();
    if (sample.value.not_tracked) return;
    if (!(p.array().abs() <= episode::kMaxPosition_m).all())
      RefuseFrame(fmt::format("the position of '{}' is ({:g}, {:g}, {:g})", sample.name, p.x(),
                              p.y(), p.z()),
                  "positions are metres, at most 10 km; all three NaN: it is not tracked");
    if (!pose.q_wxyz) return;
    const Eigen::Vector4d& q = *pose.q_wxyz;
    if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
      RefuseFrame(fmt::format("the quaternion of '{}' is ({:g}, {:g}, {:g}, {:g})", sample.name,
                              q[0], q[1], q[2], q[3]),
                  "quaternions are (w, x, y, z) of length 1");
    sample.value.quat_wxyz = {q, {}};
  }
};

FrameBuilder::FrameBuilder(const std::string& first_line) : state_(std::make_unique<State>()) {
  TakeFirst(state_->stream, first_line);
}
FrameBuilder::~FrameBuilder() = default;

const grammar::EntityTable& FrameBuilder::entities() const { return state_->table(); }

void FrameBuilder::Take(grammar::Tick tick, std::span<const PoseSeen> poses,
                        std::span<const GripSeen> grips, std::span<const TouchSeen> touches) {
  episode::FrameEntry& frame = state_->frame;
  frame.tick.value = tick;
  const grammar::Tick before = state_->stream.end_tick() - 1;
  if (before >= 0 && tick <= before)
    state_->RefuseFrame(fmt::format("it comes after tick {}", before),
                        "times increase from frame to frame; sort the frames by time");
  if (std::abs(tick) > episode::kLatestTick)
    state_->RefuseFrame("it is too late", "are the times seconds?");
  frame.samples.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) state_->Fill(poses[i], frame.samples[i]);
  frame.hands.resize(grips.size());
  for (std::size_t i = 0; i < grips.size(); ++i) {
    frame.hands[i].name = state_->NameOf(grips[i].hand);
    frame.hands[i].value.trigger = grips[i].trigger;
    if (!(grips[i].trigger >= 0 && grips[i].trigger <= 1))
      state_->RefuseFrame(
          fmt::format("the grip of '{}' is {:g}", frame.hands[i].name, grips[i].trigger),
          "0 is open, 1 is closed; scale it");
  }
  frame.touches.resize(touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    episode::TouchEntry& touch = frame.touches[i];
    touch.a.value = state_->NameOf(touches[i].a);
    touch.b.value = state_->NameOf(touches[i].b);
    touch.up_on_a = touches[i].up_on_a;
    if (!(std::abs(touch.up_on_a) <= 1))
      state_->RefuseFrame(fmt::format("up_on_a of '{}' and '{}' is {:g}", touch.a.value,
                                      touch.b.value, touch.up_on_a),
                          "it is the upward part of a unit vector: -1 to 1");
  }
  Check(state_->stream.Take(frame));
}

Episode FrameBuilder::Finish(grammar::Tick end) {
  if (end < state_->stream.end_tick())
    Refuse(kFrames, fmt::format("the episode ends at tick {}, before its last frame", end));
  episode::Recording recording = Unwrap(state_->stream.Whole(end));
  auto impl =
      std::make_shared<Episode::Impl>(Episode::Impl{.name = {.file = "",
                                                             .scenario = recording.header.episode,
                                                             .origin = episode::Origin::kRecording,
                                                             .grammar = recording.header.grammar},
                                                    .file = ""});
  impl->kept =
      Unwrap(impl->shared->opener.Open(std::move(recording), impl->name, {kDefaultGrammar, {}}));
  return Episode(std::move(impl));
}

struct Monitor::State {
  episode::EpisodeStream stream{kFrames};
  std::shared_ptr<const grammar::Program> program;
  std::string warnings;
  std::unique_ptr<grammar::Monitor> monitor;
  std::optional<grammar::Tick> moved;  ///< since the first frame
  bool is_finished = false;

  grammar::Timeline Named(const std::vector<grammar::Event>& events) const {
    return grammar::NameEvents(*program, stream.header().entity_table, events);
  }
};

Monitor::Monitor(const Grammar& grammar, const std::string& first_line)
    : state_(std::make_unique<State>()) {
  TakeFirst(state_->stream, first_line);
  state_->program = grammar.program();
  state_->warnings = grammar::Format(episode::Warnings(*grammar.program(), entities()));
  state_->monitor = std::make_unique<grammar::Monitor>(grammar.program(), entities());
  if (!state_->monitor->error().empty()) Refuse(grammar.name_or_path(), state_->monitor->error());
}
Monitor::~Monitor() = default;

const grammar::EntityTable& Monitor::entities() const {
  return state_->stream.header().entity_table;
}
const std::string& Monitor::warnings() const { return state_->warnings; }
grammar::Tick Monitor::moved() const { return state_->moved.value_or(0); }

grammar::Timeline Monitor::Take(const std::string& line) {
  if (state_->is_finished)
    Refuse(kFrames, "the episode is finished", "make another monitor for another episode");
  Check(state_->stream.Take(line));
  std::vector<grammar::Event> events;
  if (episode::EpisodeFrame* frame = state_->stream.frame()) {
    if (!state_->moved) {
      state_->moved = episode::MovedBy(frame->tick);
      state_->warnings += episode::MovedText(state_->stream.header(), *state_->moved);
    }
    grammar::Frame moved = frame->View();
    moved.tick += *state_->moved;
    state_->monitor->Advance(moved, events);
  }
  return state_->Named(events);
}

grammar::Timeline Monitor::Finish(grammar::Tick end) {
  if (state_->is_finished) Refuse(kFrames, "the episode is finished");
  if (end < state_->stream.end_tick())
    Refuse(kFrames, fmt::format("the episode ends at tick {}, before its last frame", end));
  state_->is_finished = true;
  std::vector<grammar::Event> events;
  state_->monitor->Finish(end + moved(), events);
  return state_->Named(events);
}

}  // namespace prehend
