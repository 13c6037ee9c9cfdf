// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario_fields_test.cc
#include "harness/step_fields.h"

#include <cmath>

#include "harness/record.h"
#include "harness/scenario_fields.h"

namespace prehend::harness {
namespace {

constexpr double kFarthestM = 100;
constexpr double kLongestMoveM = 10;
constexpr double kShortestS = 0.01;  // below, no human hand moves
constexpr double kLongestS = 600;

Format<double> Duration() { return Number(kShortestS, kLongestS); }
const std::string kOverDoc = "Duration in seconds.";

/// A record with one number, list or name and a duration; most steps are of this kind.
template <class Entry, class M, class F>
Format<StepEntry> TimedStep(const std::string& key, M Entry::*member, Format<F> format,
                            const std::string& doc) {
  return AsAlternative<StepEntry>(Record<Entry>("a " + key + " step")
                                      .Required(key, member, std::move(format), doc)
                                      .Optional("over_s", &Entry::over_s, Duration(), kOverDoc)
                                      .format());
}

Format<StepEntry> ReachFormat() {
  using R = ReachEntry;
  using physics::Approach;
  return AsAlternative<StepEntry>(
      Record<R>("a reach step")
          .Required("reach", &R::reach, Identifier(),
                    "The entity to move the hand to, ready to close around it.")
          .Optional("style", &R::style, Identifier(), "The grasp style, one of the hand's.")
          .Optional("from", &R::from,
                    Choice<Approach>({{"auto", Approach::kAuto},
                                      {"above", Approach::kAbove},
                                      {"side", Approach::kSide}}),
                    "Where the hand comes from; auto chooses by style and shape.")
          .Optional("offset_m", &R::offset_m, Vector<3>(-kLongestMoveM, kLongestMoveM),
                    "Added to where the hand goes, world axes: reach beside or above the entity.")
          .Optional("point_m", &R::point_m, Vector<3>(-kFarthestM, kFarthestM),
                    "The point to grasp, in the entity's own frame; default: its centre.")
          .Optional("over_s", &R::over_s, Duration(), kOverDoc)
          .format());
}

Format<StepEntry> FollowJointFormat() {
  using F = FollowJointEntry;
  return AsAlternative<StepEntry>(
      Record<F>("a follow_joint step")
          .Required("follow_joint", &F::follow_joint, Identifier(),
                    "The entity on a slider or hinge whose way the hand goes, with what it holds.")
          .Optional("to", &F::to, Number(0, 1),
                    "Where the joint then stands: 0 is the least of its range, 1 the most.")
          .Optional("over_s", &F::over_s, Duration(), kOverDoc)
          .format());
}

Format<StepEntry> WaitFormat() {
  return AsAlternative<StepEntry>(
      Record<WaitEntry>("a wait step")
          .Required("wait_s", &WaitEntry::wait_s, Duration(), "Hold still for this long.")
          .format());
}

Format<PoseEntry> PoseFormat() {
  using P = PoseEntry;
  return Record<P>("a pose")
      .Required("t_s", &P::t_s, Number(0, kMaxDurationS),
                "When, since the start of the step; increasing.")
      .Required("at_m", &P::at_m, Vector<3>(-kFarthestM, kFarthestM),
                "World coordinates of the palm's centre.")
      .Optional("rpy_deg", &P::rpy_deg, Vector<3>(-360, 360),
                "Roll, pitch and yaw; default is no rotation.")
      .Optional("quat_wxyz", &P::quat_wxyz, Vector<4>(-1, 1),
                "Unit quaternion [w, x, y, z], instead of rpy_deg.")
      .Optional("trigger", &P::trigger, Number(0, 1), "Grip at that time; default: stays.")
      .AtMostOneOf({"rpy_deg", "quat_wxyz"})
      .Check([](const YamlNode& node, const P& pose, Complaints& complaints) {
        constexpr double kUnitTolerance = 0.01;  // two written digits
        if (pose.quat_wxyz && std::abs(pose.quat_wxyz->norm() - 1) > kUnitTolerance) {
          complaints.Add(node.Find("quat_wxyz")->where,
                         "quat_wxyz: expected a unit quaternion [w, x, y, z]");
        }
      })
      .format();
}

Format<StepEntry> PosesFormat() {
  return AsAlternative<StepEntry>(
      Record<PosesEntry>("a poses step")
          .Required("poses", &PosesEntry::poses, ListOf(PoseFormat(), 1, kMaxPoses),
                    "Way-points of the tracked target, as a tracker would give them; the last one "
                    "ends the step.")
          .Check([](const YamlNode& node, const PosesEntry& step, Complaints& complaints) {
            for (std::size_t i = 1; i < step.poses.size(); ++i) {
              if (step.poses[i].t_s > step.poses[i - 1].t_s) continue;
              complaints.Add(node.Find("poses")->children[i].Find("t_s")->where,
                             "t_s must increase from pose to pose");
            }
          })
          .format());
}

}  // namespace

Format<StepEntry> StepFormat() {
  const auto grip = Number(0, 1);
  return ByKey<StepEntry>(
      "a step",
      {{"reach", ReachFormat()},
       {"close_to", TimedStep("close_to", &CloseEntry::close_to, grip,
                              "Grip: 0 open, 1 closed with full effort.")},
       {"open_to", TimedStep("open_to", &OpenEntry::open_to, grip,
                             "Grip: 0 open, 1 closed with full effort.")},
       {"lift_by_m",
        TimedStep("lift_by_m", &LiftEntry::lift_by_m, Number(-kLongestMoveM, kLongestMoveM),
                  "Straight up by this much; negative is down.")},
       {"move_by_m",
        TimedStep("move_by_m", &MoveEntry::move_by_m, Vector<3>(-kLongestMoveM, kLongestMoveM),
                  "Straight by [x, y, z], world axes.")},
       {"carry_to_m",
        TimedStep("carry_to_m", &CarryEntry::carry_to_m, Vector<2>(-kFarthestM, kFarthestM),
                  "The held object's centre goes to this [x, y], height kept.")},
       {"place_on", TimedStep("place_on", &PlaceEntry::place_on, Identifier(),
                              "Lower until the held object stands on this entity.")},
       {"retreat_by_m",
        TimedStep("retreat_by_m", &RetreatEntry::retreat_by_m, Number(0, kLongestMoveM),
                  "Back by this much, along the way the hand came.")},
       {"follow_joint", FollowJointFormat()},
       {"wait_s", WaitFormat()},
       {"poses", PosesFormat()}});
}

}  // namespace prehend::harness
