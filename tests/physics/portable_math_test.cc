// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace prehend::physics {
namespace {

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

/// The least and the greatest double within one unit in the last place of `exact`.
bool WithinOneUlp(double value, long double exact) {
  const double nearest = static_cast<double>(exact);
  return value >= std::nextafter(nearest, -HUGE_VAL) && value <= std::nextafter(nearest, HUGE_VAL);
}

TEST(PortableMath, LastBitsAreFixed) {
  // Results that the C library's variants for different processors do not agree about would show
  // here.
  std::mt19937_64 random(7);
  std::uint64_t hash = 0;
  const auto add = [&](double value) { hash = (hash ^ Bits(value)) * 0x9E3779B97F4A7C15u; };
  for (int i = 0; i < 100000; ++i) {
    const double x = std::ldexp(static_cast<double>(random() >> 11), -53);  // [0, 1)
    const double y = 20 * x - 10;
    for (double (*f)(double) :
         {static_cast<double (*)(double)>(std::sin), static_cast<double (*)(double)>(std::cos),
          static_cast<double (*)(double)>(std::tan), static_cast<double (*)(double)>(std::exp),
          static_cast<double (*)(double)>(std::exp2), static_cast<double (*)(double)>(std::atan),
          static_cast<double (*)(double)>(std::cbrt)})
      add(f(y));
    add(std::asin(x)), add(std::acos(x)), add(std::log(x + 1e-9)), add(std::log2(x + 1e-9)),
        add(std::log10(x + 1e-9));
    add(std::atan2(y, x)), add(std::pow(x, y)), add(std::hypot(x, y));
    add(std::sin(static_cast<float>(y))), add(std::cos(static_cast<float>(y)));
  }
  EXPECT_EQ(hash, 0xdd1af602e52be6eu);
}

TEST(PortableMath, ErrorsAreAtMostOneUlp) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::ldexp(static_cast<double>(random() >> 11), -53), y = 20 * x - 10;
    EXPECT_TRUE(WithinOneUlp(std::sin(y), sinl(y))) << y;
    EXPECT_TRUE(WithinOneUlp(std::cos(y), cosl(y))) << y;
    EXPECT_TRUE(WithinOneUlp(std::atan2(y, x), atan2l(y, x))) << y << ' ' << x;
    EXPECT_TRUE(WithinOneUlp(std::acos(x), acosl(x))) << x;
    EXPECT_TRUE(WithinOneUlp(std::pow(x, y), powl(x, y))) << x << ' ' << y;
    EXPECT_TRUE(WithinOneUlp(std::exp(y), expl(y))) << y;
    EXPECT_TRUE(WithinOneUlp(std::log(x), logl(x))) << x;
  }
}

TEST(PortableMath, EdgesAreThoseOfTheCStandard) {
  EXPECT_EQ(std::pow(0.0, 0.0), 1);
  EXPECT_EQ(std::pow(2.0, 10.0), 1024);
  EXPECT_EQ(std::pow(-2.0, 3.0), -8);
  EXPECT_TRUE(std::isnan(std::pow(-2.0, 0.5)));
  EXPECT_EQ(std::exp(-1000.0), 0);
  EXPECT_EQ(std::exp(1000.0), HUGE_VAL);
  EXPECT_EQ(std::log(0.0), -HUGE_VAL);
  EXPECT_EQ(Bits(std::atan2(-0.0, 1.0)), Bits(-0.0));
  EXPECT_EQ(std::atan2(0.0, -1.0), M_PI);
  EXPECT_EQ(std::acos(1.0), 0);
  EXPECT_TRUE(std::isnan(std::acos(1.0000001)));
  EXPECT_TRUE(std::isnan(std::sin(HUGE_VAL)));
  EXPECT_EQ(std::hypot(3.0, 4.0), 5);
}

// Bullet and Box2D find their functions by name, first in the program.
TEST(PortableMath, SharedLibrariesUseIt) {
  for (const char* name : {"sin", "cos", "sincos", "acos", "asin", "atan2", "pow", "sinf", "cosf",
                           "sincosf", "atan2f", "expf"}) {
    Dl_info found;
    ASSERT_TRUE(dladdr(dlsym(RTLD_DEFAULT, name), &found)) << name;
    EXPECT_EQ(std::string(found.dli_fname).find("libm"), std::string::npos)
        << name << " is from " << found.dli_fname;
  }
}

}  // namespace
}  // namespace prehend::physics
