// SPDX-License-Identifier: Apache-2.0
// Bullet's own method, which goes through the links for each impulse, is the reference.
#include "physics/bullet/core/multibody_inertia.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace prehend::physics {
namespace {

constexpr int kPrismaticEveryNth = 4;

/// A tree of joints that turn and slide, in a random posture.
class RandomTree {
 public:
  RandomTree(unsigned seed, int joints, bool fixed_base)
      : random_(seed), body_(joints, 0.6, {2e-3, 1e-3, 3e-3}, fixed_base, false) {
    for (int i = 0; i < joints; ++i) {
      // Parents come before their children; some joints move against the base.
      const int parent = i == 0 ? -1 : std::uniform_int_distribution<int>(-1, i - 1)(random_);
      const btVector3 inertia(Uniform(1e-5, 1e-3), Uniform(1e-5, 1e-3), Uniform(1e-5, 1e-3));
      if (i % kPrismaticEveryNth == kPrismaticEveryNth - 1)
        body_.setupPrismatic(i, Uniform(0.02, 0.2), inertia, parent, Turn(), Direction(), Place(),
                             Place(), true);
      else
        body_.setupRevolute(i, Uniform(0.02, 0.2), inertia, parent, Turn(), Direction(), Place(),
                            Place(), true);
    }
    body_.finalizeMultiDof();
    body_.setBaseWorldTransform(btTransform(Turn(), Place() * 20));
    for (int i = 0; i < joints; ++i) body_.setJointPos(i, Uniform(-1, 1));
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    body_.forwardKinematics(turns, places);
    // Bullet's method wants what a step of the world leaves behind.
    btAlignedObjectArray<btScalar> scalars;
    btAlignedObjectArray<btVector3> vectors;
    btAlignedObjectArray<btMatrix3x3> matrices;
    body_.computeAccelerationsArticulatedBodyAlgorithmMultiDof(1e-3, scalars, vectors, matrices,
                                                               false, true, true);
  }

  const btMultiBody& body() const { return body_; }
  std::size_t size() const { return 6 + static_cast<std::size_t>(body_.getNumDofs()); }

  /// Elements that are zero now and then.
  std::vector<btScalar> Impulse() {
    std::vector<btScalar> impulse(size());
    for (btScalar& element : impulse) element = Uniform(0, 1) < 0.3 ? 0 : Uniform(-1, 1);
    return impulse;
  }

  std::vector<btScalar> Response(const std::vector<btScalar>& impulse) const {
    std::vector<btScalar> change(size());
    btAlignedObjectArray<btScalar> scalars;
    btAlignedObjectArray<btVector3> vectors;
    body_.calcAccelerationDeltasMultiDof(impulse.data(), change.data(), scalars, vectors);
    return change;
  }

 private:
  btScalar Uniform(btScalar least, btScalar most) {
    return std::uniform_real_distribution<btScalar>(least, most)(random_);
  }
  btVector3 Place() { return {Uniform(-0.1, 0.1), Uniform(-0.1, 0.1), Uniform(-0.1, 0.1)}; }
  btVector3 Direction() { return (Place() + btVector3(0.2, 0, 0)).normalized(); }
  btQuaternion Turn() { return {Direction(), Uniform(-3, 3)}; }

  std::mt19937 random_;
  btMultiBody body_;
};

/// Largest difference, relative to the largest element unless that is zero.
btScalar Error(const std::vector<btScalar>& actual, const std::vector<btScalar>& expected) {
  btScalar difference = 0, largest = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    difference = std::max(difference, std::abs(actual[i] - expected[i]));
    largest = std::max(largest, std::abs(expected[i]));
  }
  return largest > 0 ? difference / largest : difference;
}

class OfARandomTree : public testing::TestWithParam<bool> {};

TEST_P(OfARandomTree, TheResponseIsBulletsOwn) {
  const bool fixed_base = GetParam();
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomTree tree(seed, 1 + static_cast<int>(seed % 24), fixed_base);
    MultibodyInertia inertia;
    inertia.Compute(tree.body());
    for (int i = 0; i < 5; ++i) {
      const std::vector<btScalar> impulse = tree.Impulse();
      std::vector<btScalar> change(tree.size());
      inertia.Respond(impulse.data(), change.data());
      ASSERT_LT(Error(change, tree.Response(impulse)), 1e-11) << "tree " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MultibodyInertia, OfARandomTree, testing::Bool(),
                         [](const auto& fixed) { return fixed.param ? "Fixed" : "Free"; });

/// The base and the joints of a limb are all that an impulse on the limb changes.
TEST(MultibodyInertia, SeparatesTheLimbs) {
  RandomTree tree(7, 20, /*fixed_base=*/false);
  MultibodyInertia inertia;
  inertia.Compute(tree.body());
  std::vector<btScalar> impulse(tree.size());
  impulse[6 + inertia.JointAt(0)] = 1;
  const MultibodyInertia::Places limbs = inertia.LimbsOf(impulse.data());
  EXPECT_EQ(limbs.first, 0u);
  ASSERT_GT(limbs.end, 0u);
  ASSERT_LT(limbs.end, inertia.joint_count()) << "a tree of one limb separates nothing";
  for (std::size_t place = limbs.end; place < inertia.joint_count(); ++place)
    EXPECT_EQ(inertia.JointResponse(place, impulse.data()), 0);
}

TEST(MultibodyInertia, OfATickIsComputedOnce) {
  RandomTree first(1, 5, false), second(2, 6, false);
  MultibodyInertias inertias;
  const MultibodyInertia* const computed = &inertias.Of(first.body());
  EXPECT_NE(&inertias.Of(second.body()), computed);
  EXPECT_EQ(&inertias.Of(first.body()), computed);
  inertias.Clear();
  EXPECT_EQ(inertias.Of(second.body()).joint_count(), 6u) << "the one of the last tick";
}

/// What replaces Bullet's method answers within `Use` only.
TEST(MultibodyInertia, AnswersForBulletWhileItIsInUse) {
  RandomTree tree(3, 12, false);
  const std::vector<btScalar> impulse = tree.Impulse(), bullets = tree.Response(impulse);
  MultibodyInertias inertias;
  std::vector<btScalar> expected(tree.size());
  inertias.Of(tree.body()).Respond(impulse.data(), expected.data());
  ASSERT_NE(expected, bullets) << "both round alike: the test shows nothing";
  {
    const MultibodyInertias::Use use(inertias);
    EXPECT_EQ(tree.Response(impulse), expected);
  }
  EXPECT_EQ(tree.Response(impulse), bullets);
}

}  // namespace
}  // namespace prehend::physics
