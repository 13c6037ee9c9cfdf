// SPDX-License-Identifier: Apache-2.0
// Robustness, restated as signal temporal logic says it (as RTAMT computes it on samples at equal
// times): `always[0, n]` and `once[0, n]` over samples, minimum and maximum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "harness/show/tracks/tracks.h"
#include "tests/harness/show/explain/explain_stage.h"

namespace prehend::show::testing {
namespace {

constexpr int kFrames = 80;
using Values = std::vector<double>;

/// rho(always[0, n] F)(k) and rho(once[0, n] F)(k): the least from k on; the greatest up to k.
Values Always(const Values& f, int n) {
  Values out(f.size(), -std::numeric_limits<double>::infinity());
  for (int k = 0; k + n < static_cast<int>(f.size()); ++k)
    out[k] = *std::min_element(f.begin() + k, f.begin() + k + n + 1);
  return out;
}
Values Once(const Values& f, int n) {
  Values out;
  for (int k = 0; k < static_cast<int>(f.size()); ++k)
    out.push_back(*std::max_element(f.begin() + std::max(0, k - n), f.begin() + k + 1));
  return out;
}
Values Less(const Values& a, const Values& b) {
  Values out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(std::min(a[i], b[i]));
  return out;
}
Values Greater(const Values& a, const Values& b) {
  Values out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(std::max(a[i], b[i]));
  return out;
}
Values Not(Values a) {
  for (double& value : a) value = -value;
  return a;
}

struct Shown {
  Values height, x;
};

class Robust : public ::testing::TestWithParam<unsigned> {
 protected:
  Robust() : random_(GetParam()) {}

  /// Of the only binding of `e`, checked against where it holds.
  Values Of(const std::string& rule, Shown& shown) {
    Stage stage("event e(c: Cup) " + rule);
    double z = 0.5, x = 0.5;
    std::uniform_real_distribution<double> step(-0.12, 0.12);
    shown = {};
    for (int i = 0; i < kFrames; ++i) {
      z = std::clamp(z + step(random_), 0.0, 1.0);
      x = std::clamp(x + step(random_), 0.0, 1.0);
      stage.CupUpAt(z);
      stage.CupAt(x);
      stage.Show();
      shown.height.push_back(z);
      shown.x.push_back(x);
    }
    grammar::ReplayMonitor& past = stage.Finish();
    const Ask ask = Asked(past, "e");
    const auto instance = BindingsThatFit(past, ask.rule, ask.entities).front();
    const auto robustness = RobustnessOf(past, instance);
    EXPECT_TRUE(robustness);
    EXPECT_EQ(robustness->unit, "m");
    for (int i = 0; i < kFrames; ++i) {
      const bool holds = past.Covering(instance, i) != nullptr;
      EXPECT_TRUE(holds ? robustness->values[i] >= 0 : robustness->values[i] <= 0) << rule << i;
    }
    return robustness->values;
  }
  static Values Minus(const Values& a, double b) {
    Values out;
    for (const double value : a) out.push_back(value - b);
    return out;
  }

  std::mt19937 random_;
};

TEST_P(Robust, IsWhatSignalTemporalLogicSays) {
  Shown s;
  const auto near = [](const Values& a, const Values& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::abs(a[i] - b[i]) > 1e-12 && a[i] != b[i]) return false;
    return true;
  };
  Values found = Of("while height(c) > 40 cm and not (height(c) >= 70 cm or height(c) < 45 cm)", s);
  EXPECT_TRUE(near(found, Less(Minus(s.height, 0.4),
                               Not(Greater(Minus(s.height, 0.7), Not(Minus(s.height, 0.45)))))));
  // 50 ms are five frames: those from k to k + 4.
  found = Of("while height(c) > 40 cm lasting 50 ms", s);
  EXPECT_TRUE(near(found, Once(Always(Minus(s.height, 0.4), 4), 4)));
  // A gap of more than 30 ms has four frames or more, or reaches an end of the episode.
  found = Of("while height(c) > 40 cm bridging 30 ms", s);
  const double out = std::numeric_limits<double>::infinity();
  Values padded(10, out);
  const Values gap = Not(Minus(s.height, 0.4));
  padded.insert(padded.end(), gap.begin(), gap.end());
  padded.insert(padded.end(), 10, out);
  const Values opened = Once(Always(padded, 3), 3);
  EXPECT_TRUE(near(found, Not({opened.begin() + 10, opened.end() - 10})));
}

INSTANTIATE_TEST_SUITE_P(Episodes, Robust, ::testing::Range(0u, 20u));

TEST(RobustnessOf, OfWhatOnlyHoldsOrNotThereIsNone) {
  Stage stage("event e(h: Hand, c: Cup) while touching(h, c)");
  stage.Touch(true);
  stage.Show(3);
  grammar::ReplayMonitor& past = stage.Finish();
  const Ask ask = Asked(past, "e");
  EXPECT_FALSE(RobustnessOf(past, BindingsThatFit(past, ask.rule, ask.entities).front()));
}

}  // namespace
}  // namespace prehend::show::testing
