// SPDX-License-Identifier: Apache-2.0
// Lanes: one per rule and binding, each with the state of its rule for these entities. A lane exists from when its guard
// first held; while nothing about it is true, open or undecided it sleeps and costs nothing.
// Tested by tests/grammar/monitor_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "grammar/history.h"
#include "grammar/kleene.h"
#include "grammar/program.h"

namespace prehend::grammar {

/// An interval with the frames of its boundaries.
struct Span {
  Moment begin;
  Moment end;
  bool open_end = false;
};

/// What one frame says about two entities that touch; `up` in the order of the lane's roles.
struct TouchSample {
  FrameNumber frame = 0;
  std::array<double, 2> up = {-1, -1};
  double force_n = 0;
  std::uint32_t sensor_sets = 0;
};

/// A finished interval that waits for its confirmation.
struct Pending {
  Span span;
  int style = kNobody;
  FrameNumber next = 0;  ///< first frame not yet searched for the confirmation
};

struct Lane {
  int rule = 0;
  Binding entities = kUnbound;
  std::vector<int> references;  ///< lanes, one per Rule::references; kNone: not there yet
  std::vector<int> dependents;  ///< lanes this one guards
  std::vector<int> members;     ///< kAny only: the lanes of which one must hold

  bool awake = false;
  FrameNumber stirred = -1;  ///< the last frame at which a guard was not at rest
  FrameNumber next = 0;      ///< first frame not yet looked at
  FrameNumber known = 0;     ///< truth is final before this frame

  bool open = false;     ///< a run has begun
  bool certain = false;  ///< the open run will be an interval whatever comes
  bool in_gap = false;   ///< the run may have ended at `gap`
  Moment begin;
  Moment gap;
  int style = kNobody;
  std::vector<double> anchors;  ///< three numbers per Rule::anchors
  FrameNumber approach_from = 0;  ///< kUntilSince: no later interval reaches back before this frame
  FrameNumber last_end = 0;       ///< kUntilSince: frame of the previous `until`; kCompose: end of the previous one
  std::vector<Span> past;         ///< intervals, as long as somebody may ask
  std::vector<Pending> pending;
  std::vector<std::vector<Span>> parts;  ///< kCompose: finished intervals of each part
  Ring<TouchSample> touches;             ///< kTouching only
};

class Lanes {
 public:
  Lanes(const Program& program, const Cast& cast);

  /// Binds the rules that have no guard.
  void BindUnguarded();
  /// kNone if there is no such lane.
  int Find(int rule, const Binding& entities) const;
  /// Makes the lane and those it guards, unless an entity's class does not fit: then kNone.
  int Ensure(int rule, const Binding& entities);
  bool TooMany() const { return too_many_; }

  Lane& operator[](int lane) { return lanes_[lane]; }
  const Lane& operator[](int lane) const { return lanes_[lane]; }
  int size() const { return static_cast<int>(lanes_.size()); }

  /// The lane that reference `slot` of `lane` means, kNone if nothing was ever true there.
  int Resolve(Lane& lane, int slot);

  Kleene TruthAt(int lane, FrameNumber frame) const;
  Kleene BeginsAt(int lane, FrameNumber frame) const;
  Kleene EndsAt(int lane, FrameNumber frame) const;

  bool IsA(int entity, const std::string& class_name) const;

 private:
  struct Key {
    int rule;
    Binding entities;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  Binding Canonical(const Rule& rule, Binding entities) const;
  bool Fits(int rule, const Binding& entities, std::size_t count) const;
  void BindRest(int rule, Binding& entities, std::size_t role, int guard);
  void MakeDependents(int lane);

  const Program& program_;
  const Cast& cast_;
  std::deque<Lane> lanes_;  // a lane stays where it is when others are made
  std::unordered_map<Key, int, KeyHash> index_;     // looked up only, never walked
  std::vector<std::vector<int>> guarded_;           // by rule: the rules it guards
  std::vector<std::vector<std::vector<bool>>> fits_;  // by rule, role, entity
  std::vector<int> name_rank_;                      // alphabetical order of entities
  bool too_many_ = false;
};

}  // namespace prehend::grammar
