// SPDX-License-Identifier: Apache-2.0
// Where contacts stuck. Friction removes the sliding speed of a contact, but the solver begins anew
// in every tick and stops after 50 iterations, so a part is left over: a thing that was held still
// crept and turned in the hand, by up to 10 degrees in 10 s, and a cube on it crept by 4 mm/s. So
// each contact remembers which points of the two surfaces met when it stuck, and its friction also
// takes back the way between them, as a penetration is taken back. It is the same friction, within
// the same circle: a contact whose friction is at its limit slides and forgets. Rolling and
// spinning friction of hands, the same. Source of the idea: P. Cundall and O. Strack, "A discrete
// numerical model for granular assemblies", Geotechnique 29(1), 1979, section 2. Only for
// physics/bullet/core. Tested by tests/physics/world/holding_test.cc
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <optional>
#include <utility>
#include <vector>

namespace prehend::physics {

class FrictionAnchors {
 public:
  /// What body A has moved against body B since the contact stuck: in the plane of the contact,
  /// metres, and turned, radians; in the world.
  struct Drift {
    btVector3 way{0, 0, 0}, turn{0, 0, 0};
  };

  /// A body, or a link of a hand.
  struct Side {
    const btMultiBody* multibody = nullptr;
    int link = 0;
    const btRigidBody* rigid = nullptr;  ///< null: of a multibody, or fixed
    bool operator==(const Side&) const = default;
    btTransform Place() const;
  };
  using Sides = std::pair<Side, Side>;

  /// Forgets the contacts that were not added, and begins a tick.
  void BeginTick();
  /// Nothing has drifted where nothing stuck.
  Drift Add(const btManifoldPoint& point, const Sides& sides);
  /// Index of the next contact that is added.
  std::size_t size() const { return present_.size(); }
  /// The contact has slid, or nothing presses it.
  void Forget(std::size_t contact) { present_[contact].sticks = false; }
  /// It has slid, one of several between two bodies, and remembers up to kRemembered_m of its way:
  /// a corner that bears little slips again and again while the others stick.
  void Slip(std::size_t contact) { present_[contact].slid = true; }
  /// It has turned about its normal, or about the other axes.
  void ForgetSpin(std::size_t contact);
  void ForgetRoll(std::size_t contact);

 private:
  struct Anchor {
    Sides sides;
    btVector3 p_A, p_B;  ///< the points that met
    btMatrix3x3 R_AB;    ///< in this tick
    btVector3 turn_A;    ///< of A against B until this tick
    btVector3 nhat_A;
    bool sticks, slid;
  };
  std::vector<Anchor> before_, present_;
  std::size_t next_ = 0;  ///< in before_: where to look first
};

}  // namespace prehend::physics
