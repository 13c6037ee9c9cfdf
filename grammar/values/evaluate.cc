// SPDX-License-Identifier: Apache-2.0
// One function per type of value. A new signal is a case in Compute(), or in SignalOf() if it is
// measured.
#include "grammar/values/evaluate.h"

#include <bit>
#include <cmath>
#include <limits>

namespace prehend::grammar {
namespace {

using Eigen::Vector3d;

constexpr double kBoundless = std::numeric_limits<double>::infinity();

bool IsPosition(const Program& program, NodeId index) {
  const Node& node = program.nodes[index];
  return node.op == Op::kAtEnd ? IsPosition(program, node.args[0])
                               : RowOf(node.op).type == Type::kPosition;
}

/// Directly, or through other parts. A recording may have rings of them, hence the bound.
bool IsPartOf(const EntityTable& entity_table, int part, int whole) {
  for (std::size_t depth = 0; depth < entity_table.entities.size() && part != kNoEntity; ++depth) {
    part = entity_table.entities[static_cast<std::size_t>(part)].part_of;
    if (part == whole) return true;
  }
  return false;
}

}  // namespace

Kleene Evaluator::Truth(NodeId index, const View& view) const {
  const Node& node = program_.nodes[index];
  if (node.needs_end && !view.end) return Kleene::kUnknown;
  if (node.by_itself) view.instance.by_itself = true;
  switch (node.op) {
    case Op::kAnd: {
      const Kleene left = Truth(node.args[0], view);
      return left == Kleene::kFalse ? left : And(left, Truth(node.args[1], view));
    }
    case Op::kOr: {
      const Kleene left = Truth(node.args[0], view);
      return left == Kleene::kTrue ? left : Or(left, Truth(node.args[1], view));
    }
    case Op::kNot: {
      View inner = view;
      inner.negated = !view.negated;
      return Not(Truth(node.args[0], inner));
    }
    case Op::kKnown: {
      View inner = view;
      inner.negated = false;
      return Truth(node.args[0], inner);
    }
    case Op::kHolds:
      return Holds(node.slot, view);
    case Op::kBegins:
    case Op::kEnds:
      return Edge(node, view);
    case Op::kInSphere:
    case Op::kSolidInSphere:
    case Op::kInCylinder: {
      const std::optional<Reach> reach = ReachOf(node, view);
      if (!reach) return Kleene::kUnknown;
      if (std::isnan(reach->distance_m + reach->radius_m + reach->height_m + reach->most_height_m))
        return Known(view.negated);
      return Known(reach->IsInside());
    }
    case Op::kInside:
    case Op::kNearest:
      if (!IsTracked(Entity(node, view, 0), view.frame) ||
          !IsTracked(Entity(node, view, 1), view.frame))
        return Known(view.negated);
      return Known(node.op == Op::kInside ? IsInside(node, view) : IsNearest(node, view));
    case Op::kOwns:
      return Owns(node, view);
    case Op::kPartOf:
      return Known(IsPartOf(entity_table_, Entity(node, view, 0), Entity(node, view, 1)));
    case Op::kGazed:
      if (!IsTracked(Entity(node, view, 0), view.frame)) return Known(view.negated);
      return Known(history_.Look(Entity(node, view, 0), view.frame).gazes_at ==
                   Entity(node, view, 1));
    case Op::kSensorSet:
      return Known(SensorSet(node, view));
    case Op::kIsA:
      return Known(instances_.IsA(Entity(node, view, 0), program_.class_names[node.slot]));
    case Op::kLess:
    case Op::kLessEqual:
    case Op::kGreater:
    case Op::kGreaterEqual:
    case Op::kEqual:
    case Op::kNotEqual:
      return Compare(node, view);
      PREHEND_MADE_NUMBERS(PREHEND_CASE)
      PREHEND_ANCHORED(PREHEND_CASE)
      PREHEND_MEASURED_NUMBERS(PREHEND_CASE)
      PREHEND_POSITIONS(PREHEND_CASE)
      break;
  }
  return Kleene::kUnknown;  // it is no truth value
}

bool Evaluator::IsTrue(NodeId index, const View& view) const {
  const Node& node = program_.nodes[index];
  if (node.op == Op::kAnd) return IsTrue(node.args[0], view) && IsTrue(node.args[1], view);
  if (node.op == Op::kOr) return IsTrue(node.args[0], view) || IsTrue(node.args[1], view);
  if (node.op == Op::kBegins && program_.nodes[node.args[0]].op != Op::kHolds) {
    View changing = view;
    changing.negated = false;
    if (!IsTrue(node.args[0], changing)) return false;
  }
  return Truth(index, view) == Kleene::kTrue;
}

Kleene Evaluator::Holds(int slot, const View& view) const {
  return instances_.TruthAt(instances_.Resolve(view.instance, slot), view.frame);
}

Kleene Evaluator::Owns(const Node& node, const View& view) const {
  const InstanceId owners = instances_.Resolve(view.instance, node.slot);
  const Kleene owned = instances_.TruthAt(owners, view.frame);
  if (owned != Kleene::kTrue) return owned;
  return Known(instances_.OwnerAt(owners, view.frame) == Entity(node, view, 0));
}

Kleene Evaluator::Begins(int slot, const View& view) const {
  return AtAnInstant(instances_.BeginsAt(instances_.Resolve(view.instance, slot), view.frame),
                     view);
}

// What is true here only will be false at the next frame, where its parts are as they are.
Kleene Evaluator::AtAnInstant(Kleene truth, const View& view) {
  if (truth == Kleene::kTrue) view.instance.by_itself = true;
  return truth;
}

// Of a reference: one of its intervals begins or ends here. Of any other condition: it changes
// here.
Kleene Evaluator::Edge(const Node& node, const View& view) const {
  const bool begins = node.op == Op::kBegins;
  const Node& arg = program_.nodes[node.args[0]];
  if (arg.op == Op::kHolds) {
    const InstanceId instance = instances_.Resolve(view.instance, arg.slot);
    return AtAnInstant(begins ? instances_.BeginsAt(instance, view.frame)
                              : instances_.EndsAt(instance, view.frame),
                       view);
  }
  View changing = view;
  changing.negated = false;  // what is lost ends, and is no longer
  const Kleene now = Truth(node.args[0], changing);
  const Kleene wanted = begins ? now : Not(now);
  if (wanted == Kleene::kFalse) return wanted;
  if (now == Kleene::kUnknown)  // even if there is no change here, the next frame looks back at it
    view.instance.by_itself = true;
  const bool is_first = view.frame == 0;
  Kleene before = Kleene::kFalse;
  if (!is_first) before = Truth(node.args[0], changing.At(view.frame - 1));
  return AtAnInstant(And(wanted, begins ? Not(before) : before), view);
}

// What is measured was compared when it was seen.
Kleene Evaluator::CompareMeasured(const ByThreshold& by, const View& view) const {
  const Node& value = program_.nodes[by.value];
  bool swapped = false;
  ThresholdSet crossed = 0;
  if (value.op == Op::kTrigger) {
    const HandAtFrame* hand = history_.Hand(Entity(value, view, 0), view.frame);
    crossed = hand != nullptr ? hand->crossed_thresholds : thresholds_.OfGrip(0);
  } else {
    const RuleInstance* instance = Touching(value, view, swapped);
    const TouchingState* touch = instance == nullptr ? nullptr : &instance->As<TouchingState>();
    const bool is_now = view.frame == history_.now() && instance != nullptr && instance->open;
    crossed = touch == nullptr ? thresholds_.OfNoTouch()
              : is_now         ? touch->crossed_thresholds
                               : SampleAt(touch->crossings, view.frame).crossed;
  }
  if (by.known != kNone && ((crossed >> by.known) & 1) == 0) return Known(view.negated);
  return Known((((crossed >> by.thresholds[swapped ? 1 : 0]) & 1) != 0) == by.when_crossed);
}

Kleene Evaluator::Compare(const Node& node, const View& view) const {
  if (node.by_threshold.value != kNone) return CompareMeasured(node.by_threshold, view);
  const Node& of = program_.nodes[node.args[0]];
  const Node& with = program_.nodes[node.args[1]];
  const bool all_less = node.op == Op::kLess || node.op == Op::kLessEqual;
  const bool all_greater = node.op == Op::kGreater || node.op == Op::kGreaterEqual;
  if (with.op == Op::kNumber && of.shared != kNone &&
      ((of.op == Op::kMaximum && all_less) || (of.op == Op::kMinimum && all_greater))) {
    const std::optional<Kleene> all = AllInWindow(node, with.number, view);
    if (all) return *all;
  }
  const std::optional<double> left = Number(node.args[0], view);
  if (!left) return Kleene::kUnknown;
  const std::optional<double> right = Number(node.args[1], view);
  if (!right) return Kleene::kUnknown;
  if (std::isnan(*left) || std::isnan(*right)) return Known(view.negated);
  return Known(Compares(node.op, *left, *right));
}

std::optional<Reach> Evaluator::ReachOf(const Node& node, const View& view) const {
  const bool solid = node.op == Op::kSolidInSphere;
  const std::optional<Vector3d> centre = Position(node.args[solid ? 0 : 1], view);
  const std::optional<double> radius = Number(node.args[solid ? 1 : 2], view);
  if (!centre || !radius) return std::nullopt;
  if (solid) {
    const int entity = Entity(node, view, 0);
    if (!IsTracked(entity, view.frame) || std::isnan(centre->x()))
      return Reach{.distance_m = kNotKnown};
    return Reach{.distance_m = ToSurface_m(*centre, entity, view.frame), .radius_m = *radius};
  }
  const std::optional<Vector3d> point = Position(node.args[0], view);
  if (!point) return std::nullopt;
  const Vector3d offset = *point - *centre;
  if (node.op == Op::kInSphere) return Reach{.distance_m = offset.norm(), .radius_m = *radius};
  const std::optional<double> height = Number(node.args[3], view);
  if (!height) return std::nullopt;
  return Reach{.distance_m = offset.head<2>().norm(),
               .radius_m = *radius,
               .height_m = std::abs(offset.z()),
               .most_height_m = *height};
}

bool Evaluator::TooFarApart(NodeId index, RuleInstance& instance, FrameNumber early,
                            FrameNumber late) const {
  const Node& node = program_.nodes[index];
  if (node.op == Op::kAnd) {
    return TooFarApart(node.args[0], instance, early, late) ||
           TooFarApart(node.args[1], instance, early, late);
  }
  const bool sphere = node.op == Op::kInSphere;
  if ((!sphere && node.op != Op::kInCylinder) || program_.nodes[node.args[1]].op != Op::kAtEnd)
    return false;
  const std::optional<Vector3d> from =
      Position(node.args[0], {.instance = instance, .frame = early});
  const std::optional<Vector3d> to = Position(node.args[0], {.instance = instance, .frame = late});
  const std::optional<double> radius = Number(node.args[2], {.instance = instance, .frame = late});
  if (!from || !to || !radius) return false;
  const Vector3d offset = *to - *from;
  if (sphere) return offset.norm() > 2 * *radius;
  const std::optional<double> height = Number(node.args[3], {.instance = instance, .frame = late});
  return height && (offset.head<2>().norm() > 2 * *radius || std::abs(offset.z()) > 2 * *height);
}

std::optional<double> Evaluator::Number(NodeId index, const View& view) const {
  const Node& node = program_.nodes[index];
  if (node.op == Op::kNumber) return node.number;
  if (node.needs_end && !view.end) return std::nullopt;
  if (node.by_itself) view.instance.by_itself = true;
  return node.shared == kNone ? Compute(node, view) : Shared(node, view);
}

// Other rules ask for it, too. What is known of a frame does not change any more.
std::optional<double> Evaluator::Shared(const Node& node, const View& view) const {
  const int a = view.instance.entities[static_cast<std::size_t>(node.shared_roles[0])];
  const int b = node.shared_roles[1] == kNone
                    ? kNoEntity
                    : view.instance.entities[static_cast<std::size_t>(node.shared_roles[1])];
  const auto place = static_cast<std::size_t>(view.frame) + 7 * static_cast<std::size_t>(a) +
                     61 * static_cast<std::size_t>(b + 1) +
                     509 * static_cast<std::size_t>(node.shared);
  Computed& computed = computed_[place % kComputed];
  const bool known = computed.frame == view.frame && computed.shared == node.shared &&
                     computed.a == a && computed.b == b;
  if (known) return computed.value;
  const std::optional<double> value = Compute(node, view);
  if (value) computed = {view.frame, node.shared, a, b, *value};
  return value;
}

std::optional<double> Evaluator::Compute(const Node& node, const View& view) const {
  switch (node.op) {
    case Op::kNumber:
      return node.number;
    case Op::kCount:
      return view.instance.count;
    case Op::kAtBegin:
      if (!view.begin_known) return std::nullopt;
      if (view.begin_at >= 0) return Number(AnchorOf(node, view), view.At(view.begin_at));
      return view.instance.anchors[3 * node.slot];
    case Op::kAtEnd:
      if (!view.end) return std::nullopt;
      return Number(node.args[0], view.At(*view.end));
    case Op::kDistance: {
      const std::optional<Vector3d> a = Position(node.args[0], view);
      const std::optional<Vector3d> b = Position(node.args[1], view);
      if (!a || !b) return std::nullopt;
      return (*a - *b).norm();
    }
    case Op::kDistanceAlong:
      return DistanceAlong(node, view);
    case Op::kHeight: {
      const std::optional<Vector3d> position = Position(node.args[0], view);
      if (!position) return std::nullopt;
      return position->z();
    }
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kNegate:
    case Op::kAbs:
      return Arithmetic(node, view);
    case Op::kDriftAlong:
      return DriftAlong(node, view);
    case Op::kRotation:
    case Op::kTwist:
      return Rotation(node, view);
    case Op::kSpin:
      return Spin(node, view);
    case Op::kTurnRate:
      return TurnRate(node, view);
    case Op::kRate:
      return Rate(node, view);
    case Op::kSpeedOver:
    case Op::kRelativeSpeedOver:
      return SpeedOver(node, view);
    case Op::kMean:
    case Op::kMinimum:
    case Op::kMaximum:
    case Op::kMedian:
      return OfWindow(node, view);
      PREHEND_MEASURED_NUMBERS(PREHEND_CASE)
      return SignalOf(node, view);
      PREHEND_TRUTHS(PREHEND_CASE)
      PREHEND_POSITIONS(PREHEND_CASE)
      break;
  }
  return kNotKnown;  // it is no number
}

std::optional<double> Evaluator::Arithmetic(const Node& node, const View& view) const {
  const std::optional<double> left = Number(node.args[0], view);
  if (!left) return std::nullopt;
  if (node.op == Op::kNegate) return -*left;
  if (node.op == Op::kAbs) return std::abs(*left);
  const std::optional<double> right = Number(node.args[1], view);
  if (!right) return std::nullopt;
  return Calculate(node.op, *left, *right);
}

double Evaluator::SignalOf(const Node& node, const View& view) const {
  const FrameNumber frame = view.frame;
  const int a = Entity(node, view, 0);
  const int b = node.roles[1] == kNone ? kNoEntity : Entity(node, view, 1);
  bool swapped = false;
  switch (node.op) {
    case Op::kTrigger: {
      const HandAtFrame* hand = history_.Hand(a, frame);
      return hand == nullptr ? 0 : hand->look.trigger;
    }
    case Op::kSensorSets: {
      const TouchSample* touch = Touch(node, view, swapped);
      return touch == nullptr ? 0 : std::popcount(touch->sensor_sets);
    }
    case Op::kUp: {
      const TouchSample* touch = Touch(node, view, swapped);
      return touch == nullptr ? -1 : touch->up[swapped ? 1 : 0];
    }
    case Op::kForceBetween: {
      const TouchSample* touch = Touch(node, view, swapped);
      return touch == nullptr ? 0 : touch->force_n;
    }
    case Op::kTouchSpeed: {
      const TouchSample* touch = Touch(node, view, swapped);
      return touch == nullptr ? 0 : touch->vertical_speed_m_per_s;
    }
    case Op::kGap:
      return Gap(a, b, frame);
    case Op::kClearance:
      return Clearance_m(a, b, frame);
    case Op::kClosingSpeed:
      return ClosingSpeed(a, b, frame);
    case Op::kSurfaceSpeed:
      return SurfaceSpeed(a, frame);
    case Op::kSpeed:
      return history_.Look(a, frame).v_WB_m_per_s.norm();
    case Op::kVerticalSpeed:
      return history_.Look(a, frame).v_WB_m_per_s.z();
    case Op::kRelativeVerticalSpeed:
      return RelativeVelocity(a, b, history_.Look(a, frame).p_WB_m, frame).z();
    case Op::kRelativeSpeed:
      return RelativeVelocity(a, b, history_.Look(a, frame).p_WB_m, frame).norm();
    case Op::kSpeedAlong:
      return SpeedAlong(node, view);
    case Op::kTilt: {
      const double up = (history_.Look(a, frame).q_WB * Vector3d::UnitZ()).z();
      return std::acos(std::clamp(up, -1.0, 1.0));
    }
    case Op::kAligned: {
      const auto axis = [&](int entity, int which) -> Vector3d {
        return history_.Look(entity, frame).q_WB * Vector3d::Unit(which);
      };
      return std::acos(std::clamp(axis(a, node.name % 3).dot(axis(b, node.name / 3)), -1.0, 1.0));
    }
    case Op::kJointFraction:
      return history_.Look(a, frame).joint_fraction;
    case Op::kJointAngle:
    case Op::kJointTravel:
      return history_.Look(a, frame).joint_position;
    case Op::kWeight:
      return Weight(a);
    case Op::kStrength:
      return entity_table_.entities[a].strength_n > 0 ? entity_table_.entities[a].strength_n
                                                      : kBoundless;
      PREHEND_TRUTHS(PREHEND_CASE)
      PREHEND_MADE_NUMBERS(PREHEND_CASE)
      PREHEND_ANCHORED(PREHEND_CASE)
      PREHEND_POSITIONS(PREHEND_CASE)
      break;
  }
  return kNotKnown;  // it is not measured
}

double Evaluator::Weight(int entity) const {
  constexpr double kGravity_m_per_s2 = 9.81;
  return instances_.IsA(entity, "Fixed")
             ? kBoundless
             : entity_table_.entities[entity].mass_kg * kGravity_m_per_s2;
}

bool Evaluator::SensorSet(const Node& node, const View& view) const {
  bool swapped = false;
  const TouchSample* touch = Touch(node, view, swapped);
  if (touch == nullptr) return false;
  int set = static_cast<int>(node.number) - 1;
  if (node.name != kNone) {
    const std::vector<std::string>& names =
        entity_table_.entities[Entity(node, view, 0)].sensor_sets;
    const auto found = std::find(names.begin(), names.end(), program_.sensor_sets[node.name].name);
    set = found == names.end() ? kNone : static_cast<int>(found - names.begin());
  }
  return set >= 0 && set < 32 && ((touch->sensor_sets >> set) & 1U) != 0;
}

double Evaluator::Gap(int hand, int object, FrameNumber frame) const {
  const HandAtFrame* sample = history_.Hand(hand, frame);
  if (sample == nullptr) return 0;
  if (!IsTracked(hand, frame) || !IsTracked(object, frame)) return kNotKnown;
  const EntitySample& look = history_.Look(object, frame);
  double gap = kBoundless;
  for (const CollisionSphere& sphere : sample->collision_spheres) {
    const double distance = DistanceToSurface_m(sphere.p_W_m, entity_table_.entities[object], look,
                                                gap + sphere.radius_m);
    gap = std::min(gap, distance - sphere.radius_m);
  }
  return std::max(gap, 0.0);
}

double Evaluator::ClosingSpeed(int hand, int object, FrameNumber frame) const {
  const double gap_m = Gap(hand, object, frame);
  if (frame <= history_.first()) return std::isnan(gap_m) ? kNotKnown : 0;
  return (Gap(hand, object, frame - 1) - gap_m) / SecondsBetween(frame - 1, frame);
}

double Evaluator::SurfaceSpeed(int hand, FrameNumber frame) const {
  if (frame <= history_.first()) return Apart_m(hand, frame, frame);
  return Apart_m(hand, frame, frame - 1) / SecondsBetween(frame - 1, frame);
}

double Evaluator::Apart_m(int hand, FrameNumber frame, FrameNumber other) const {
  const HandAtFrame* here = history_.Hand(hand, frame);
  const HandAtFrame* there = history_.Hand(hand, other);
  if (here == nullptr || there == nullptr) return 0;
  if (!IsTracked(hand, frame) || !IsTracked(hand, other)) return kNotKnown;
  double farthest_m = 0;
  for (std::size_t i = 0;
       i < std::min(here->collision_spheres.size(), there->collision_spheres.size()); ++i) {
    farthest_m = std::max(
        farthest_m, (here->collision_spheres[i].p_W_m - there->collision_spheres[i].p_W_m).norm());
  }
  return farthest_m;
}

// The most distant frames first: a hand that moves is farthest away there. A frame alone shows
// nothing.
bool Evaluator::StaysWithin(double still_m, Tick ticks, int hand, FrameNumber frame,
                            FrameNumber last) const {
  const Tick now = history_.At(frame).tick;
  const FrameNumber first = history_.FirstNotBefore(now - ticks);
  last = std::min(history_.LastNotAfter(now + ticks), last);
  for (FrameNumber early = first; early < frame; ++early)
    if (!(Apart_m(hand, frame, early) <= still_m)) return false;
  for (FrameNumber late = last; late > frame; --late)
    if (!(Apart_m(hand, frame, late) <= still_m)) return false;
  return first < last;
}

// Null where the two do not touch.
const RuleInstance* Evaluator::Touching(const Node& node, const View& view, bool& swapped) const {
  const InstanceId index = instances_.Resolve(view.instance, node.slot);
  if (instances_.TruthAt(index, view.frame) != Kleene::kTrue) return nullptr;
  const RuleInstance& instance = instances_[index];
  swapped = instance.entities[0] != Entity(node, view, 0);
  return &instance;
}

// Likewise.
const TouchSample* Evaluator::Touch(const Node& node, const View& view, bool& swapped) const {
  const RuleInstance* touching = Touching(node, view, swapped);
  return touching == nullptr ? nullptr
                             : &SampleAt(touching->As<TouchingState>().touches, view.frame);
}

std::optional<Vector3d> Evaluator::Position(NodeId index, const View& view) const {
  const Node& node = program_.nodes[index];
  if (node.by_itself) view.instance.by_itself = true;
  switch (node.op) {
    case Op::kAtBegin:
      if (!view.begin_known) return std::nullopt;
      if (view.begin_at >= 0) return Position(AnchorOf(node, view), view.At(view.begin_at));
      return Eigen::Map<const Vector3d>(view.instance.anchors.data() + 3 * node.slot);
    case Op::kAtEnd:
      if (!view.end) return std::nullopt;
      return Position(node.args[0], view.At(*view.end));
    case Op::kPositionOn:
      return PositionOn(Entity(node, view, 0), Entity(node, view, 1), view.frame);
    case Op::kOrientationOn:
      return OrientationOn(node, view, view.frame);
    case Op::kTouchIn:
    case Op::kNormalIn:
      return OfTouch(node, view);
    case Op::kAhead: {
      const int entity = Entity(node, view, 0);
      const HandAtFrame* hand = history_.Hand(entity, view.frame);
      const std::optional<double> distance = Number(node.args[0], view);
      if (!distance) return std::nullopt;
      const Vector3d ahead_W = hand == nullptr ? Vector3d(Vector3d::UnitX()) : hand->look.ahead_W;
      return history_.Look(entity, view.frame).p_WB_m + *distance * ahead_W;
    }
    case Op::kPosition:
      return history_.Look(Entity(node, view, 0), view.frame).p_WB_m;
      PREHEND_TRUTHS(PREHEND_CASE)
      PREHEND_MADE_NUMBERS(PREHEND_CASE)
      PREHEND_MEASURED_NUMBERS(PREHEND_CASE)
      break;
  }
  return Vector3d::Constant(kNotKnown);  // it is no position
}

bool Evaluator::CaptureAnchors(RuleInstance& instance, FrameNumber frame) const {
  const std::vector<NodeId>& anchors = program_.rules[instance.rule].anchors;
  const View view{.instance = instance, .frame = frame};
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (IsPosition(program_, anchors[i])) {
      const std::optional<Vector3d> value = Position(anchors[i], view);
      if (!value) return false;
      std::copy(value->data(), value->data() + 3,
                instance.anchors.begin() + static_cast<std::ptrdiff_t>(3 * i));
    } else {
      const std::optional<double> value = Number(anchors[i], view);
      if (!value) return false;
      instance.anchors[3 * i] = *value;
    }
  }
  return true;
}

}  // namespace prehend::grammar
