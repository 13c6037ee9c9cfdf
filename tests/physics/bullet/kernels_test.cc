// SPDX-License-Identifier: Apache-2.0
// Loops for one kind of processor have the bits of those for any other: on random numbers, of which
// some slide, some pull and some do not move.
#include "physics/bullet/lanes/kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>
#include <random>
#include <vector>

namespace prehend::physics {
namespace {

const Kernels* Avx2() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return kAvx2Kernels;
#endif
  return nullptr;
}

class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  double Between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  template <std::size_t n>
  void Fill(Lanes<n>& lanes, double least, double most) {
    for (double& value : lanes.values) value = Between(least, most);
  }
  template <std::size_t n>
  void Fill(SingleRow<n>& row) {
    for (std::size_t i = 0; i < 6; ++i) {
      Fill(row.jacobian[i], -1, 1);
      row.response[i] = row.jacobian[i];
    }
    Fill(row.wanted, -0.1, 0.4);
    Fill(row.softness, 0, 0.01);
    Fill(row.inverse_mass, 0.3, 1);
    Fill(row.mass, 1, 3);
    Fill(row.impulse, 0, 0.1);
  }
  template <std::size_t n>
  SingleContacts<n> Contacts() {
    SingleContacts<n> contacts{};
    Fill(contacts.normal), Fill(contacts.first), Fill(contacts.second);
    Fill(contacts.friction, -0.1, 0.6);
    for (std::size_t lane = 0; lane < n; ++lane) {
      contacts.cosine[lane] = Between(0, 1);
      contacts.sine[lane] = std::sqrt(1 - contacts.cosine[lane] * contacts.cosine[lane]);
      contacts.moves[lane] = Between(0, 1) < 0.9 ? 1 : 0;
      if (contacts.friction[lane] < 0) contacts.friction[lane] = 0;
    }
    Fill(contacts.first_response, 1, 3), Fill(contacts.second_response, 1, 3);
    return contacts;
  }
  GrainBlock Grains(std::vector<std::array<btScalar, 6>>& speeds, std::size_t first) {
    GrainBlock block{};
    for (std::size_t lane = 0; lane < GrainBlock::kLanes; ++lane) {
      block.a[lane] = speeds[first + 2 * lane].data();
      block.b[lane] = speeds[first + 2 * lane + 1].data();
    }
    for (std::size_t i = 0; i < 3; ++i) Fill(block.n[i], -0.7, 0.7), Fill(block.slip[i], -0.2, 0.2);
    Fill(block.wanted, -0.1, 0.3), Fill(block.impulse, 0, 0.1);
    Fill(block.normal_mass, 0.3, 0.5);
    Fill(block.sliding_mass, 0.1, 0.2), Fill(block.sliding_response, 5, 10);
    Fill(block.inverse_mass, 1, 1.2), Fill(block.turn, 0.2, 0.5);
    Fill(block.radius, 0.1, 0.2), Fill(block.friction, 0, 0.8);
    return block;
  }

 private:
  std::mt19937 random_;
};

/// All values after some iterations.
template <std::size_t n>
std::vector<double> Solved(unsigned seed, Kernels::SolveSingle<n> kernel) {
  Numbers numbers(seed);
  std::vector<SingleContacts<n>> contacts;
  for (int i = 0; i < 5; ++i) contacts.push_back(numbers.Contacts<n>());
  std::array<Lanes<n>, 6> speeds{};
  for (Lanes<n>& speed : speeds) numbers.Fill(speed, -0.1, 0.1);
  kernel(contacts.data(), contacts.size(), speeds.data(), 20);
  std::vector<double> all;
  const auto add = [&](const Lanes<n>& lanes) {
    all.insert(all.end(), std::begin(lanes.values), std::end(lanes.values));
  };
  for (const Lanes<n>& speed : speeds) add(speed);
  for (const SingleContacts<n>& contact : contacts)
    add(contact.normal.impulse), add(contact.first.impulse), add(contact.second.impulse);
  return all;
}

std::vector<double> SolvedGrains(unsigned seed, const Kernels& kernels) {
  constexpr std::size_t kBlocks = 6, kGrains = 2 * GrainBlock::kLanes;
  Numbers numbers(seed);
  // Blocks have grains in common with the next block.
  std::vector<std::array<btScalar, 6>> speeds((kBlocks + 1) * kGrains / 2);
  for (auto& speed : speeds)
    for (btScalar& value : speed) value = numbers.Between(-0.2, 0.2);
  std::vector<GrainBlock> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i)
    blocks.push_back(numbers.Grains(speeds, i * kGrains / 2));
  std::vector<double> all;
  for (int i = 0; i < 10; ++i) all.push_back(kernels.solve_grains(blocks.data(), blocks.size()));
  for (const auto& speed : speeds) all.insert(all.end(), speed.begin(), speed.end());
  for (const GrainBlock& block : blocks)
    for (const GrainBlock::Values* values : {&block.impulse, &block.sliding[0], &block.sliding[2]})
      all.insert(all.end(), std::begin(values->values), std::end(values->values));
  return all;
}

TEST(Kernels, HaveTheSameBitsForEveryProcessor) {
  const Kernels* const avx2 = Avx2();
  if (!avx2) GTEST_SKIP() << "this processor has no AVX2";
  for (unsigned seed = 0; seed < 100; ++seed) {
    ASSERT_EQ(Solved<8>(seed, kPlainKernels.solve_eight), Solved<8>(seed, avx2->solve_eight));
    ASSERT_EQ(Solved<4>(seed, kPlainKernels.solve_four), Solved<4>(seed, avx2->solve_four));
    ASSERT_EQ(Solved<2>(seed, kPlainKernels.solve_two), Solved<2>(seed, avx2->solve_two));
    ASSERT_EQ(SolvedGrains(seed, kPlainKernels), SolvedGrains(seed, *avx2));
  }
}

TEST(Kernels, SolveLanesAsIfTheyWereAlone) {
  // The same body in the first lane of two and of eight: the others are none of its business.
  Numbers numbers(1);
  SingleContacts<2> two = numbers.Contacts<2>();
  SingleContacts<8> eight = numbers.Contacts<8>();
  const auto copy = [](const SingleRow<2>& from, SingleRow<8>& to) {
    for (std::size_t i = 0; i < 6; ++i) {
      to.jacobian[i][0] = from.jacobian[i][0];
      to.response[i][0] = from.response[i][0];
    }
    to.wanted[0] = from.wanted[0];
    to.softness[0] = from.softness[0];
    to.inverse_mass[0] = from.inverse_mass[0];
    to.mass[0] = from.mass[0];
    to.impulse[0] = from.impulse[0];
  };
  copy(two.normal, eight.normal), copy(two.first, eight.first), copy(two.second, eight.second);
  eight.least[0] = two.least[0];
  eight.friction[0] = two.friction[0];
  eight.cosine[0] = two.cosine[0];
  eight.sine[0] = two.sine[0];
  eight.first_response[0] = two.first_response[0];
  eight.second_response[0] = two.second_response[0];
  eight.moves[0] = two.moves[0];
  std::array<Lanes<2>, 6> speeds_of_two{};
  std::array<Lanes<8>, 6> speeds_of_eight{};
  BestKernels().solve_two(&two, 1, speeds_of_two.data(), 20);
  BestKernels().solve_eight(&eight, 1, speeds_of_eight.data(), 20);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(speeds_of_two[i][0], speeds_of_eight[i][0]);
  EXPECT_NE(speeds_of_two[0][0], 0);
}

}  // namespace
}  // namespace prehend::physics
