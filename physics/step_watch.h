// SPDX-License-Identifier: Apache-2.0
// Looks at the world while a script is played, and notes what its steps do not achieve: joints that
// do not follow a hand, limbs that are too short, arms that meet things on their way. It changes
// nothing. Tested by tests/physics/step_watch_test.cc
#pragma once

#include <array>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "physics/hand/script_player.h"
#include "physics/person/person_player.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class StepWatch {
 public:
  /// `scene` and `script` must outlive it.
  StepWatch(const Scene& scene, const Script& script);

  /// These steps begin with the tick after `now`.
  void Begin(const std::vector<BegunSteps>& begun, const Snapshot& now);
  /// After each tick.
  void See(const Snapshot& now, const std::vector<PersonPlayer>& persons);
  /// What there is to say in the end, by time.
  std::vector<ScriptNote> Notes() const;

 private:
  /// When a limb was farthest from where it should be.
  struct Short {
    std::int64_t tick = 0;
    double by_m = 0;
    LimbEnd end = LimbEnd::kRightWrist;  ///< that should be there
  };
  /// A hand that leads a joint.
  struct Leading {
    HandIndex hand = {};
    int joint = 0;  ///< index into Scene::joints
    double from = 0, to = 0;
    std::int64_t end_tick = 0;
    bool has_touched = false;  ///< what it leads
  };
  /// A thing that an arm has met.
  struct Met {
    std::int64_t tick = 0;       ///< of the first touch
    std::int64_t last_tick = 0;  ///< of the last one
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    double moved_m = 0;  ///< while the arm touched it and its hand did not
  };

  /// A fixed thing that a person has gone into.
  struct Entered {
    std::int64_t tick = 0;  ///< of the deepest part
    FixedTouch deepest;
    std::map<int, Eigen::Vector3d> first_W;  ///< by part, which way was out when it entered
    bool is_through = false;                 ///< a part has come out elsewhere
  };

  void SeeFixed(std::size_t person, const std::vector<FixedTouch>& touches, std::int64_t tick);
  void NoteFixed(std::vector<ScriptNote>& notes) const;
  void SeeJoints(const Snapshot& now);
  void SeeArms(const Snapshot& now, const std::vector<PersonPlayer>& persons);
  /// Of the arm that follows `hand`: its parts are the bodies from `begin` to before `end`.
  void SeeContacts(HandIndex hand, BodyIndex begin, BodyIndex end, const Snapshot& now);

  const Scene& scene_;
  const Script& script_;
  std::vector<Leading> leading_;
  std::vector<std::array<Short, 4>> limbs_;  ///< by person and limb
  std::vector<Short> heads_;                 ///< by person, of her neck
  std::map<std::tuple<HandIndex, BodyIndex, BodyIndex>, Met>
      met_;                                                       ///< hand, part of the arm, thing
  std::map<std::pair<std::size_t, BodyIndex>, Entered> entered_;  ///< person, thing
  std::vector<ScriptNote> notes_;
};

// Looks for what an engine gets wrong, whichever it is: bodies that come out on the other side of
// another one, and bodies that sink into another one. It changes nothing. Tested by
// tests/physics/limit_watch_test.cc

class LimitWatch {
 public:
  /// `scene` must outlive it.
  explicit LimitWatch(const Scene& scene);

  /// After each tick.
  void See(const Snapshot& now);
  /// What there is to say in the end, by time.
  std::vector<ScriptNote> Notes() const;

 private:
  /// The first time that a pair is through, and the deepest overlap of a pair.
  struct Through {
    std::int64_t tick = 0;
    double way_m = 0;
  };
  struct Overlap {
    std::int64_t begin_tick = 0, last_tick = -2;  ///< of the present overlap
    std::int64_t noted_tick = -1;                 ///< when it had lasted long enough
    double deepest_m = 0;
    double mass_ratio = 1;  ///< then
  };
  using BodyPair = std::pair<BodyIndex, BodyIndex>;
  using SidePair = std::pair<ContactSide, ContactSide>;  ///< whole hands

  void SeeWays(const Snapshot& now);
  /// Of a body that moves far in this tick.
  void SeeWay(BodyIndex body, const Snapshot& now);
  /// Whether the centre of a body goes through another one.
  void SeeWay(BodyIndex body, BodyIndex other, const Snapshot& now);
  void SeeOverlaps(const Snapshot& now);
  /// The centre of a body may be on its way into another one.
  void SeeEntry(BodyIndex body, BodyIndex other);
  bool MayCollide(BodyIndex a, BodyIndex b) const;

  const Scene& scene_;
  std::vector<double> half_m_;  ///< by body, half of its smallest extent
  double thinnest_m_ = 0;       ///< the least of them
  std::vector<Pose> before_;    ///< by body, its pose a tick ago
  /// Bodies that may be on their way through another one, and where their centre was, in that one's
  /// frame, when it was last seen outside.
  std::map<BodyPair, Eigen::Vector3d> entered_;
  std::map<BodyPair, Through> through_;
  std::map<SidePair, Overlap> overlaps_;
};

}  // namespace prehend::physics
