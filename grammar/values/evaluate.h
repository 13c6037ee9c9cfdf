// SPDX-License-Identifier: Apache-2.0
// The value of an expression for one binding at one remembered frame.
// Tested by tests/grammar/values/signals_test.cc
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/solid.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {

/// From a point in the world to the surface of an entity, at most `most_m`; 0 inside.
double DistanceToSurface_m(const Eigen::Vector3d& p_W, const EntityInfo& member,
                           const EntitySample& look,
                           double most_m = std::numeric_limits<double>::infinity());

class Evaluator {
 public:
  Evaluator(const Program& program, const EntityTable& entity_table, const History& history,
            RuleInstances& instances)
      : program_(program),
        entity_table_(entity_table),
        history_(history),
        instances_(instances),
        thresholds_(program.thresholds),
        computed_(SharesValues(program) ? kComputed : 0) {
    for (const TimeWindow& window : program.windows) {
      const double half_s = window.seconds / 2;
      windows_.push_back(
          {.half = window.inside ? history.AtMostTicks(half_s) : history.AtLeastTicks(half_s),
           .inside = window.inside});
    }
  }

  /// Whose roles, at which frame, and at which frame the interval ends, if that is known.
  struct View {
    RuleInstance& instance;
    FrameNumber frame = 0;
    std::optional<FrameNumber> end = std::nullopt;
    bool begin_known = true;    ///< values at the interval's begin, that is
    bool negated = false;       ///< below a `not`: there, what nobody knows must not be false
    FrameNumber begin_at = -1;  ///< if not negative: the anchors are those of this frame, and not
                                ///< kept in the instance
    View At(FrameNumber other) const {
      return {instance, other, end, begin_known, negated, begin_at};
    }
  };

  /// Here and in Number() and Position(), RuleInstance::by_itself is set where that was asked for
  /// what may change with time alone: a node that does, or a moment, which is over one frame later.
  /// kUnknown while it depends on truths that are not final, on a begin or an end that is not
  /// known, or on frames to come. Of what is not tracked, neither a condition nor its opposite
  /// holds.
  Kleene Truth(NodeId node, const View& view) const;
  /// Whether it is true and known to be; costs less where it is not.
  bool IsTrue(NodeId node, const View& view) const;
  /// nullopt only for values at a begin or an end that is not known, or that depend on frames to
  /// come. Of what is not tracked it is no number (NaN).
  std::optional<double> Number(NodeId node, const View& view) const;
  std::optional<Eigen::Vector3d> Position(NodeId node, const View& view) const;

  /// Of a node that tests for a region; nullopt like Number().
  std::optional<Reach> ReachOf(const Node& node, const View& view) const;

  /// The truth of reference `slot` at the view's frame.
  Kleene Holds(int slot, const View& view) const;
  Kleene Begins(int slot, const View& view) const;

  /// How far the hand's surface is at one frame from where it is at another: the farthest piece of
  /// it.
  double Apart_m(int hand, FrameNumber frame, FrameNumber other) const;
  /// Whether no piece of it gets farther than `still_m` from where it is at `frame`, in frames at
  /// most so many ticks before or after, up to `last`.
  bool StaysWithin(double still_m, Tick ticks, int hand, FrameNumber frame, FrameNumber last) const;

  /// True if no interval can hold at both frames, wherever it will end: both would have to lie in
  /// one region anchored at the end, and they are too far apart for that. False if this cannot be
  /// told.
  bool TooFarApart(NodeId node, RuleInstance& instance, FrameNumber early, FrameNumber late) const;

  /// A condition that is false at a frame stays so until the entities of its roles have moved by
  /// more than this, all their ways added. 0 if it may be true, or this cannot be told.
  double FalseFor_m(NodeId node, RuleInstance& instance, FrameNumber frame) const;
  /// Likewise of one that is true.
  double TrueFor_m(NodeId node, RuleInstance& instance, FrameNumber frame) const;
  /// Whether FalseFor_m() may tell something of it.
  bool NeedsNearness(NodeId node) const;

  /// From the origin of `whom` to the surface of `who`, as `nearest` measures it; no number if one
  /// of them is not tracked.
  double AwayFrom_m(int who, int whom, FrameNumber frame) const;

  /// Keeps the values of all anchors of the instance's rule at this frame. False while one is not
  /// known.
  [[nodiscard]] bool CaptureAnchors(RuleInstance& instance, FrameNumber frame) const;

 private:
  Kleene Owns(const Node& node, const View& view) const;
  static Kleene AtAnInstant(Kleene truth, const View& view);
  Kleene Edge(const Node& node, const View& view) const;
  Kleene Compare(const Node& node, const View& view) const;
  bool IsTracked(int entity, FrameNumber frame) const {
    return grammar::IsTracked(history_.Look(entity, frame));
  }
  Kleene CompareMeasured(const ByThreshold& by, const View& view) const;
  std::optional<double> Shared(const Node& node, const View& view) const;
  std::optional<double> Compute(const Node& node, const View& view) const;
  std::optional<double> Arithmetic(const Node& node, const View& view) const;
  double SignalOf(const Node& node, const View& view) const;
  double Clearance_m(int a, int b, FrameNumber frame) const;
  /// From a point in the world; the surface of a hand that was shown is its collision spheres.
  double ToSurface_m(const Eigen::Vector3d& p_W, int entity, FrameNumber frame) const;
  double OutOfBox_m(int a, int b, FrameNumber frame) const;
  double OutOfReach_m(const Node& node, RuleInstance& instance, FrameNumber frame) const;
  double OffTop_m(int a, int b, double most_m, FrameNumber frame) const;
  double AlongAxes_m(int a, int b, double away_m, FrameNumber frame) const;
  double OnTop_m(int a, int b, double most_m, FrameNumber frame) const;
  double Gap(int hand, int object, FrameNumber frame) const;
  double ClosingSpeed(int hand, int object, FrameNumber frame) const;
  double SurfaceSpeed(int hand, FrameNumber frame) const;
  bool SensorSet(const Node& node, const View& view) const;
  bool IsInside(const Node& node, const View& view) const;
  bool IsNearest(const Node& node, const View& view) const;
  double Weight(int entity) const;
  /// How something lies to a part of something else.
  struct OverPart {
    double above_m = 0;   ///< its lowest point, above the part's top
    double beside_m = 0;  ///< how far it is beside it; below 0 it is below or above it
    double up = 0;        ///< cosine between the part's top and up
  };
  const std::vector<OverPart>& OverParts(int a, int b, FrameNumber frame) const;
  std::optional<Kleene> AllInWindow(const Node& node, double number, const View& view) const;
  struct Window {
    FrameNumber early = 0;
    FrameNumber late = 0;
  };
  std::optional<Window> WindowAround(const Node& node, FrameNumber frame) const;
  bool AreSeenIn(const Window& window, const Node& node, const View& view) const;
  double SecondsBetween(FrameNumber early, FrameNumber late) const;
  Eigen::Vector2d WayOn(const Node& node, const View& view, FrameNumber early,
                        FrameNumber late) const;
  std::optional<double> Rate(const Node& node, const View& view) const;
  std::optional<double> SpeedOver(const Node& node, const View& view) const;
  std::optional<double> OfWindow(const Node& node, const View& view) const;
  std::optional<double> DriftAlong(const Node& node, const View& view) const;
  std::optional<double> TurnRate(const Node& node, const View& view) const;
  Eigen::Vector3d OrientationOn(const Node& node, const View& view, FrameNumber frame) const;
  std::optional<double> Rotation(const Node& node, const View& view) const;
  std::optional<double> Spin(const Node& node, const View& view) const;
  Eigen::Vector3d PositionOn(int a, int b, FrameNumber frame) const;
  Eigen::Vector3d RelativeVelocity(int a, int b, const Eigen::Vector3d& p_W_m,
                                   FrameNumber frame) const;
  struct TouchPlace {
    Eigen::Vector3d p_W_m;
    Eigen::Vector3d nhat_W;
  };
  TouchPlace TouchPlaceOf(const Node& node, const View& view) const;
  double SpeedAlong(const Node& node, const View& view) const;
  std::optional<double> DistanceAlong(const Node& node, const View& view) const;
  Eigen::Vector3d OfTouch(const Node& node, const View& view) const;
  const RuleInstance* Touching(const Node& node, const View& view, bool& swapped) const;
  const TouchSample* Touch(const Node& node, const View& view, bool& swapped) const;
  NodeId AnchorOf(const Node& node, const View& view) const {
    return program_.rules[view.instance.rule].anchors[static_cast<std::size_t>(node.slot)];
  }
  int Entity(const Node& node, const View& view, int i) const {
    return view.instance.entities[node.roles[i]];
  }

  static bool SharesValues(const Program& program) {
    return std::ranges::any_of(program.nodes,
                               [](const Node& node) { return node.shared != kNone; });
  }

  const Program& program_;
  const EntityTable& entity_table_;
  const History& history_;
  RuleInstances& instances_;
  Thresholds thresholds_;
  /// A window of the program, around the last frames; the same for all bindings.
  struct Windows {
    Tick half = 0;
    bool inside = false;
    struct Known {
      FrameNumber frame = -1;
      Window window;
    };
    std::array<Known, 64> known = {};  ///< by frame
  };
  mutable std::vector<Windows> windows_;
  /// The last values that rules share.
  struct Computed {
    FrameNumber frame = -1;
    int shared = kNone, a = kNoEntity, b = kNoEntity;
    double value = 0;
  };
  static constexpr std::size_t kComputed = 1024;  ///< a power of two
  mutable std::vector<Computed> computed_;        ///< empty if they share none
  mutable std::vector<double> window_values_;     ///< kept for its memory
  /// Values that stay on the side that a comparison asks for, from one frame to another.
  struct Stays {
    const Node* node = nullptr;
    int a = kNoEntity, b = kNoEntity;
    FrameNumber early = 0, late = -1;
  };
  static constexpr std::size_t kStays = 1024;  ///< a power of two
  mutable std::vector<Stays> stays_;           ///< empty until the first one
  /// How things lay to each other, last.
  struct LastOver {
    FrameNumber frame = -1;
    int a = kNoEntity, b = kNoEntity;
    std::vector<OverPart> parts;
  };
  static constexpr std::size_t kLastOver = 1024;  ///< a power of two
  mutable std::vector<LastOver> last_over_;       ///< empty until the first one
};

}  // namespace prehend::grammar
