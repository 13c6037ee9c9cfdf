// SPDX-License-Identifier: Apache-2.0
// What an impulse changes of a multibody's speeds, computed once per tick instead of once per row
// of the solver. Tested by tests/physics/bullet/multibody_inertia_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <array>
#include <deque>
#include <vector>

namespace prehend::physics {

/// Three angular and three linear elements, in one or the other order.
using Six = std::array<btScalar, 6>;

/// The joint-space inertia of a multibody, factorised. Its speeds are those of the base (angular,
/// then linear, in world coordinates) and one per joint: 6 + n.
///
/// With the inertia [B C; C' D], B 6 x 6 of the base, D n x n of the joints, and W = D^-1 C', the
/// variables x = base speeds and u = joint speeds + W x do not act on each other: an impulse (f, g)
/// changes x by (B - C W)^-1 (f - W' g) and u by D^-1 g. The solver works on x and u: an impulse on
/// one limb (a finger) changes x, and u of that limb only. R. Featherstone, Rigid Body Dynamics
/// Algorithms, Springer 2008, sections 6.2 (inertia), 6.4 and 6.5 (factors of a tree's inertia).
///
/// The elements of u are in places: limb by limb, parents before children.
class MultibodyInertia {
 public:
  /// Places [first, end).
  struct Places {
    std::size_t first = 0, end = 0;
  };

  /// Requires joints of one degree of freedom. O(n^2).
  void Compute(const btMultiBody& multibody);

  std::size_t joint_count() const { return joint_at_.size(); }
  /// Number of the joint at a place.
  std::size_t JointAt(std::size_t place) const { return joint_at_[place]; }
  /// From the first to the last limb on which an impulse of 6 + n elements acts.
  Places LimbsOf(const btScalar* impulse) const;
  /// Change of u at a place by an impulse of 6 + n elements.
  btScalar JointResponse(std::size_t place, const btScalar* impulse) const;
  /// Impulse on x of an impulse of 6 + n elements.
  Six OnBase(const btScalar* impulse) const;
  /// The 6 + n speeds of x and u.
  void ToSpeeds(const Six& base, const btScalar* u, btScalar* speeds) const;
  /// Change of the 6 + n speeds by an impulse of 6 + n elements.
  void Respond(const btScalar* impulse, btScalar* change);
  /// The same for the base and the limbs on which the impulse acts; zero for all other joints. It
  /// is what the change of speed along the impulse itself needs.
  void RespondWhereItActs(const btScalar* impulse, btScalar* change);

 private:
  void ArrangeJoints(const btMultiBody& multibody);
  bool IsArranged(const btMultiBody& multibody) const;
  void ComputeMotions(const btMultiBody& multibody);
  void ComputeInertias(const btMultiBody& multibody);
  void Factorise(bool fixed_base);
  /// The same as the public one for some places; the others stay as they are.
  void ToSpeeds(const Six& base, const btScalar* u, Places places, btScalar* speeds) const;
  void Respond(const btScalar* impulse, Places limbs, Places wanted, btScalar* change);

  struct Link {
    btVector3 turn, shift;  ///< velocity of the link by a unit speed of its joint, at the origin
    btMatrix3x3 R_WL;
    btVector3 p;                    ///< from the base's centre of mass to the link's, in W
    btScalar mass;                  ///< of the link and all that it carries, as the next two
    btVector3 mass_times_distance;  ///< from the base's centre of mass
    btMatrix3x3 turning_inertia;    ///< about the base's centre of mass
  };
  std::size_t joint(std::size_t place) const { return 6 + joint_at_[place]; }
  Link& ParentOf(std::size_t place);

  std::vector<std::size_t> joint_at_, place_of_;
  std::vector<int> parents_;   ///< place of the parent, -1: the base
  std::vector<int> arranged_;  ///< by joint: its parent, when places were given
  std::vector<Places> limbs_;  ///< by place: those of its limb
  std::vector<Link> links_;    ///< by place
  Link base_;
  std::vector<Six> by_joints_;                      ///< C', n x 6
  std::vector<Six> carried_;                        ///< W', column by column
  std::vector<btScalar> joints_, joints_response_;  ///< D and D^-1, n x n, row by row
  std::array<btScalar, 36> base_response_;          ///< (B - C W)^-1, row by row
  std::vector<btScalar> scratch_;
};

/// The inertias of the multibodies of one tick. While an object of type `Use` lives, Bullet's
/// btMultiBody::calcAccelerationDeltasMultiDof(), which this file replaces, answers from them, and
/// only where the impulse acts: Bullet's rows need the change of speed along the impulse, no more.
class MultibodyInertias {
 public:
  /// Forgets all. Call it whenever multibodies have moved.
  void Clear() { used_ = 0; }
  /// Computes it at the first call after Clear(). The reference stays valid until then.
  MultibodyInertia& Of(const btMultiBody& multibody);

  class Use {
   public:
    explicit Use(MultibodyInertias& inertias);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    MultibodyInertias* before_;
  };

 private:
  struct Entry {
    const btMultiBody* multibody;
    MultibodyInertia inertia;
  };
  std::deque<Entry> entries_;
  std::size_t used_ = 0;
};

}  // namespace prehend::physics
