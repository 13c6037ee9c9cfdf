// SPDX-License-Identifier: Apache-2.0
// Where the contacts of a hand stuck. Friction removes the sliding speed of a contact, but the
// solver begins anew in every tick and stops after 50 iterations, so a part is left over: a thing
// that was held still crept and turned in the hand, by up to 10 degrees in 10 s. So each contact
// remembers which points of the two surfaces met when it stuck, and its friction also takes back
// the way between them, as a penetration is taken back. It is the same friction, within the same
// circle: a contact whose friction is at its limit slides and forgets. Rolling and spinning
// friction, the same. Source of the idea: P. Cundall and O. Strack, "A discrete numerical model for
// granular assemblies", Geotechnique 29(1), 1979, section 2. Only for physics/bullet/core. Tested
// by tests/physics/world/holding_test.cc
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include <vector>

namespace prehend::physics {

class FrictionAnchors {
 public:
  /// What body A has moved against body B since the contact stuck: in the plane of the contact,
  /// metres, and turned, radians; in the world.
  struct Drift {
    btVector3 way{0, 0, 0}, turn{0, 0, 0};
  };

  /// Forgets the contacts that were not added, and begins a tick.
  void BeginTick();
  /// `row`: the contact's normal; `a`, `b`: its rigid bodies, null where the row has a multibody or
  /// what is fixed. Nothing has drifted where nothing stuck.
  Drift Add(const btMultiBodySolverConstraint& row, const btRigidBody* a, const btRigidBody* b);
  /// Index of the next contact that is added.
  std::size_t size() const { return present_.size(); }
  /// The contact has slid, or nothing presses it.
  void Forget(std::size_t contact) { present_[contact].sticks = false; }
  /// It has turned about its normal, or about the other axes.
  void ForgetSpin(std::size_t contact);
  void ForgetRoll(std::size_t contact);

 private:
  /// A body, or a link of a hand.
  struct Side {
    const btMultiBody* multibody;
    int link;
    const btRigidBody* rigid;  ///< null: of a multibody, or fixed
    bool operator==(const Side&) const = default;
    btTransform Place() const;
  };
  struct Anchor {
    Side a, b;
    btVector3 p_A, p_B;  ///< the points that met
    btMatrix3x3 R_AB;    ///< in this tick
    btVector3 turn_A;    ///< of A against B until this tick
    btVector3 nhat_A;
    bool sticks;
  };
  std::vector<Anchor> before_, present_;
};

}  // namespace prehend::physics
