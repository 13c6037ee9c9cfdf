// SPDX-License-Identifier: Apache-2.0
// The reference is RigidRows without single bodies: the same random rows, solved by both, end with
// the same bits, however many bodies there are and however many contacts each has.
#include "physics/bullet/core/single_bodies.h"

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "physics/bullet/core/rigid_rows.h"

namespace prehend::physics {
namespace {

/// Bodies with rows against something fixed, whose body is the last one.
class RandomRows {
 public:
  RandomRows(int bodies, unsigned seed) : random_(seed) {
    for (int i = 0; i <= bodies; ++i) AddBody(/*fixed=*/i == bodies);
    for (int i = 0; i < bodies; ++i)
      for (int count = i % 6; count > 0; --count) AddContact(i, bodies);
  }

  /// Impulses of all rows and speeds of all bodies, `iterations` times solved.
  std::vector<btScalar> Solve(bool alone, int iterations) {
    const std::vector<char> shared(static_cast<std::size_t>(bodies_.size()), alone ? 0 : 1);
    for (int i = 0; i < bodies_.size(); ++i) {
      bodies_[i].internalGetDeltaLinearVelocity() = speeds_[static_cast<std::size_t>(2 * i)];
      bodies_[i].internalGetDeltaAngularVelocity() = speeds_[static_cast<std::size_t>(2 * i + 1)];
    }
    btConstraintArray contacts = contacts_, frictions = frictions_;
    RigidRows rows;
    const RigidRows::Pools pools{bodies_, none_, contacts, frictions, none_, shared};
    rows.FindSingleBodies(pools);
    rows.Setup(pools);
    for (int i = 0; i < iterations; ++i) rows.Solve(i, iterations);
    rows.WriteBack(pools);
    std::vector<btScalar> result;
    for (const btConstraintArray* solved : {&contacts, &frictions})
      for (int i = 0; i < solved->size(); ++i) result.push_back((*solved)[i].m_appliedImpulse);
    for (int i = 0; i < bodies_.size(); ++i)
      for (const btScalar speed : rows.SpeedsOf(i)) result.push_back(speed);
    return result;
  }

 private:
  btScalar Number(btScalar least, btScalar most) {
    return std::uniform_real_distribution<btScalar>(least, most)(random_);
  }
  btVector3 Vector() { return {Number(-1, 1), Number(-1, 1), Number(-1, 1)}; }

  void AddBody(bool fixed) {
    btSolverBody& body = bodies_.expandNonInitializing();
    body.m_worldTransform.setIdentity();
    const btScalar inverse_mass = fixed ? 0 : Number(0.5, 5);
    body.m_originalBody = fixed ? nullptr : &anyone_;
    body.internalSetInvMass({inverse_mass, inverse_mass, inverse_mass});
    body.m_linearFactor = body.m_angularFactor = {1, 1, 1};
    speeds_.push_back(Vector() / 10);
    speeds_.push_back(Vector() / 10);
    body.internalGetPushVelocity().setZero();
    body.internalGetTurnVelocity().setZero();
  }

  /// A row of a body as the first or the second one.
  btSolverConstraint Row(int body, int fixed, bool first) {
    btSolverConstraint row;
    const btVector3 along = Vector().normalized(), turn = Vector(), response = turn * 3;
    const btVector3 none(0, 0, 0);
    row.m_solverBodyIdA = first ? body : fixed;
    row.m_solverBodyIdB = first ? fixed : body;
    row.m_contactNormal1 = first ? along : none;
    row.m_contactNormal2 = first ? none : along;
    row.m_relpos1CrossNormal = first ? turn : none;
    row.m_relpos2CrossNormal = first ? none : turn;
    row.m_angularComponentA = first ? response : none;
    row.m_angularComponentB = first ? none : response;
    const btScalar mass =
        bodies_[body].internalGetInvMass().x() * along.length2() + turn.dot(response);
    row.m_jacDiagABInv = 1 / mass;
    row.m_rhs = Number(-0.1, 0.4) / mass;
    row.m_rhsPenetration = 0;
    row.m_cfm = Number(0, 1) < 0.5 ? 0 : 0.01;
    row.m_lowerLimit = 0;
    row.m_upperLimit = 1e10;
    row.m_appliedImpulse = Number(0, 1) < 0.5 ? 0 : 0.05;
    row.m_appliedPushImpulse = 0;
    return row;
  }

  void AddContact(int body, int fixed) {
    const bool first = Number(0, 1) < 0.5;
    const btScalar friction = Number(0, 1) < 0.2 ? 0 : Number(0, 1);
    const int index = contacts_.size();
    contacts_.push_back(Row(body, fixed, first));
    contacts_[index].m_frictionIndex = frictions_.size();
    for (int i = 0; i < 2; ++i) {
      btSolverConstraint row = Row(body, fixed, first);
      row.m_frictionIndex = index;
      row.m_friction = friction;
      row.m_appliedImpulse = 0;
      frictions_.push_back(row);
    }
  }

  std::mt19937 random_;
  btSphereShape shape_{1};
  btRigidBody anyone_{1, nullptr, &shape_};
  btAlignedObjectArray<btSolverBody> bodies_;
  std::vector<btVector3> speeds_;  ///< two of each body, before
  btConstraintArray contacts_, frictions_, none_;
};

TEST(SingleBodies, HaveTheBitsOfRowsThatAreSolvedInTurn) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomRows rows(static_cast<int>(seed % 23), seed);
    for (const int iterations : {1, 2, 50})
      ASSERT_EQ(rows.Solve(true, iterations), rows.Solve(false, iterations)) << seed;
  }
}

}  // namespace
}  // namespace prehend::physics
