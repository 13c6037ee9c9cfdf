// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/columns.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "harness/episode/frames/rigid_motion.h"

namespace prehend::episode {
namespace {

Word Bits(double value) { return std::bit_cast<Word>(value); }

/// Decodes what was encoded and expects every bit to be the same.
std::size_t ExpectRoundTrip(const Columns& columns, const Guesses& guesses = {}) {
  std::string bytes;
  Encode(columns, guesses, bytes);
  const std::size_t size = bytes.size();
  bytes += "rest";
  std::string_view left = bytes;
  const auto decoded = Decode(left, columns.rows, columns.width, guesses);
  EXPECT_TRUE(decoded);
  if (!decoded) return size;
  EXPECT_EQ(decoded->words, columns.words);
  EXPECT_EQ(left, "rest");
  return size;
}

TEST(Columns, AnyBitsComeBack) {
  std::mt19937_64 random(1);
  Columns columns(100, 5);
  for (std::size_t row = 0; row < columns.rows; ++row) {
    columns.At(row, 0) = random();
    columns.At(row, 1) = Bits(0.001 * static_cast<double>(row * row));
    columns.At(row, 2) = row % 7;
    columns.At(row, 3) = Bits(row % 2 ? 0.0 : -0.0);
    columns.At(row, 4) = Bits(row % 3 == 0   ? std::numeric_limits<double>::infinity()
                              : row % 3 == 1 ? -std::numeric_limits<double>::infinity()
                                             : std::nan(""));
  }
  ExpectRoundTrip(columns);
}

TEST(Columns, OneRowAndNoColumnsComeBack) {
  ExpectRoundTrip(Columns(1, 3));
  ExpectRoundTrip(Columns(5, 0));
  ExpectRoundTrip(Columns(0, 2));
}

TEST(Columns, WhatStandsStillAndWhatMovesEvenlyIsShort) {
  Columns columns(400, 2);
  for (std::size_t row = 0; row < columns.rows; ++row) {
    columns.At(row, 0) = Bits(0.7);
    columns.At(row, 1) = Bits(static_cast<double>(row) / 256);
  }
  ExpectRoundTrip(columns);
  std::string bytes;
  Encode(columns, {}, bytes);
  EXPECT_LT(Compressor().Pack(bytes).size(), 100u) << "of 6400";
}

TEST(Columns, AnyOrderOfRowsComesBack) {
  std::mt19937_64 random(2);
  Columns columns(60, 3);
  Guesses guesses;
  for (std::size_t row = 0; row < columns.rows; ++row) {
    guesses.before.push_back(row < 4 || row % 9 == 0 ? -1 : static_cast<int>(row) - 4);
    for (std::size_t i = 0; i < 3; ++i)
      columns.At(row, i) = Bits(std::sin(0.01 * static_cast<double>(row) + static_cast<double>(i)));
  }
  ExpectRoundTrip(columns, guesses);
}

/// A body that turns and moves as its velocities say.
Columns Motion(std::size_t rows, double dt_s) {
  Columns columns(rows, 14);
  Turn turn;
  double x = 0.1;
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row) * dt_s, v = std::sin(t), w = 2 * std::cos(3 * t);
    if (row > 0) {
      x = x + v * dt_s;
      turn = Turned(turn, {w, 0.5, -0.2}, dt_s);
    }
    const double values[] = {x, 2, 3, turn.x, turn.y, turn.z, turn.w, v, 0, 0, w, 0.5, -0.2, 0};
    for (std::size_t i = 0; i < 14; ++i) columns.At(row, i) = Bits(values[i]);
  }
  return columns;
}

TEST(Columns, OfAMovingBodyOnlyItsVelocitiesAreKept) {
  const double dt_s = 1.0 / 480;
  const Columns motion = Motion(300, dt_s);
  const std::size_t with = ExpectRoundTrip(motion, {.dt_s = dt_s}),
                    without = ExpectRoundTrip(motion);
  EXPECT_LT(2 * with, without);
}

TEST(Columns, DamagedBytesAreRefusedOrReadAsSomething) {
  const double dt_s = 1.0 / 480;
  const Columns motion = Motion(50, dt_s);
  std::string good;
  Encode(motion, {.dt_s = dt_s}, good);
  for (std::size_t size = 0; size < good.size(); size += 7) {
    std::string_view cut = std::string_view(good).substr(0, size);
    EXPECT_FALSE(Decode(cut, motion.rows, motion.width, {.dt_s = dt_s})) << size;
  }
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bad = good;
    for (int i = 0; i < 3; ++i) bad[random() % bad.size()] = static_cast<char>(random());
    std::string_view bytes = bad;
    (void)Decode(bytes, motion.rows, motion.width, {.dt_s = dt_s});
  }
}

/// A finger on the palm, one on that, and one that slides.
physics::HandModel Fingers() {
  physics::HandModel model;
  model.links.resize(3);
  model.links[0].joint_axis = {0, 1, 0};
  model.links[1].parent = physics::LinkIndex(0);
  model.links[1].joint_axis = {0.6, 0, 0.8};
  model.links[1].pivot_m = {0.03, 0.01, 0};
  model.links[2].slides = true;
  model.links[2].joint_axis = {1, 0, 0};
  return model;
}

std::vector<PlacedLinks> Placed(const LinkGuess& guess, const std::array<physics::Pose, 4>& palms,
                                const std::vector<Lanes>& joints) {
  std::vector<PlacedLinks> placed(1 + guess.size());
  for (std::size_t lane = 0; lane < kLanes; ++lane) placed[0].PutPalm(lane, palms[lane]);
  for (std::size_t i = 0; i < guess.size(); ++i)
    guess.Guess(i, placed[static_cast<std::size_t>(guess.ParentOf(i) + 1)], joints[i],
                placed[i + 1]);
  return placed;
}

TEST(LinkGuess, IsForwardKinematicsAndEachFrameIsAloneInIt) {
  const physics::HandModel model = Fingers();
  const LinkGuess guess(model);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 500; ++trial) {
    std::array<physics::Pose, 4> palms;
    for (physics::Pose& palm : palms)
      palm = {{any(random), any(random), any(random)},
              Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized()};
    std::vector<Lanes> joints(3);
    for (Lanes& of_link : joints) {
      for (double& joint : of_link) joint = 3 * any(random);
    }
    const std::vector<PlacedLinks> placed = Placed(guess, palms, joints);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::array<physics::Pose, 4> same = {palms[lane], palms[lane], palms[lane],
                                                 palms[lane]};
      std::vector<Lanes> alone;
      for (const Lanes& of_link : joints)
        alone.push_back({of_link[lane], of_link[lane], of_link[lane], of_link[lane]});
      const std::vector<PlacedLinks> one = Placed(guess, same, alone);
      const std::vector<physics::Pose> exact =
          physics::LinkPoses(model, {joints[0][lane], joints[1][lane], joints[2][lane]});
      for (std::size_t i = 0; i < guess.size(); ++i) {
        const physics::Pose& found = placed[i + 1].X_WL[lane];
        EXPECT_EQ(found.p_m, one[i + 1].X_WL[0].p_m);
        EXPECT_EQ(found.q.coeffs(), one[i + 1].X_WL[0].q.coeffs());
        const Eigen::Vector3d p_W_m = palms[lane].p_m + palms[lane].q * exact[i].p_m;
        EXPECT_LT((found.p_m - p_W_m).norm(), 1e-12) << i;
        EXPECT_LT(found.q.angularDistance(palms[lane].q * exact[i].q), 1e-7) << i;
      }
    }
  }
}

TEST(Planes, HoldBytesOfEqualWeightTheLowestFirst) {
  std::mt19937_64 random(3);
  for (int planes = 0; planes <= 8; ++planes) {
    for (const std::size_t count : {0, 1, 7, 8, 9, 16, 29}) {
      std::vector<Word> words(count), joined(count);
      for (Word& word : words) word = planes == 0 ? 0 : random() >> (64 - 8 * planes);
      std::string bytes(static_cast<std::size_t>(planes) * count, 'x');
      SplitPlanes(words, planes, bytes.data());
      for (std::size_t at = 0; at < bytes.size(); ++at)
        ASSERT_EQ(static_cast<std::uint8_t>(bytes[at]),
                  (words[at % count] >> (at / count * 8)) & 255)
            << planes << " planes of " << count << ", byte " << at;
      JoinPlanes(bytes.data(), planes, joined);
      EXPECT_EQ(joined, words) << planes << " planes of " << count;
    }
  }
}

TEST(Varint, AnyNumberComesBack) {
  std::string bytes;
  const std::vector<Word> words = {0, 1, 127, 128, 300, Word{1} << 40, ~Word{0}};
  for (const Word word : words) AppendVarint(word, bytes);
  std::string_view left = bytes;
  for (const Word word : words) EXPECT_EQ(TakeVarint(left), word);
  EXPECT_FALSE(TakeVarint(left));
}

TEST(Compressor, RefusesWhatItDidNotPackAndWhatUnpacksToTooMuch) {
  Compressor compressor;
  const std::string packed(compressor.Pack(std::string(1000, 'a')));
  EXPECT_EQ(compressor.Unpack(packed, 1000), std::string(1000, 'a'));
  EXPECT_FALSE(compressor.Unpack(packed, 999));
  EXPECT_FALSE(compressor.Unpack("no zstd", 1000));
  EXPECT_FALSE(compressor.Unpack(std::string_view(packed).substr(0, packed.size() - 1), 1000));
}

}  // namespace
}  // namespace prehend::episode
