// Half precision, against all halves and the borders between them.

#include "pillarfield/half.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "pillarfield/force_field.h"

namespace pillarfield {
namespace {

using Limits = std::numeric_limits<float>;

constexpr std::uint32_t kInfinity = 0x7c00;
constexpr std::uint32_t kSign = 0x8000;

Half half(std::uint32_t bits) { return {static_cast<std::uint16_t>(bits)}; }

/// The value of a finite half by the definition of its format.
double value_of(std::uint32_t bits) {
  const auto exponent = static_cast<int>((bits & kInfinity) >> 10);
  const double fraction = bits & 0x3ff;
  const double size =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (bits & kSign) != 0 ? -size : size;
}

void expect_rounded(float value, std::uint32_t bits) {
  ASSERT_EQ(to_half(value).bits, bits) << value;
  ASSERT_EQ(to_half(-value).bits, bits | kSign) << -value;
}

TEST(Half, EveryFiniteOneHasItsValueAndComesBack) {
  for (std::uint32_t bits = 0; bits < kInfinity; ++bits) {
    for (const std::uint32_t sign : {std::uint32_t{0}, kSign}) {
      const float value = to_float(half(bits | sign));
      ASSERT_EQ(value, value_of(bits | sign)) << bits;
      ASSERT_EQ(std::signbit(value), sign != 0) << bits;
      ASSERT_EQ(to_half(value).bits, bits | sign);
    }
  }
}

TEST(Half, HalfwayBetweenTwoIsTheEvenOne) {
  for (std::uint32_t bits = 0; bits + 1 < kInfinity; ++bits) {
    const auto middle = static_cast<float>((value_of(bits) + value_of(bits + 1)) / 2);
    const std::uint32_t even = bits + (bits & 1);
    expect_rounded(middle, even);
    expect_rounded(std::nextafter(middle, 0.0F), bits);
    expect_rounded(std::nextafter(middle, Limits::infinity()), bits + 1);
  }
}

TEST(Half, WhatIsTooLargeIsInfinite) {
  constexpr float kBorder = 65520;
  expect_rounded(std::nextafter(kBorder, 0.0F), kInfinity - 1);
  for (const float value : {kBorder, 65536.0F, 1e10F, Limits::max(), Limits::infinity()}) {
    expect_rounded(value, kInfinity);
  }
  EXPECT_EQ(to_float(half(kInfinity)), Limits::infinity());
  EXPECT_EQ(to_float(half(kInfinity | kSign)), -Limits::infinity());
}

TEST(Half, WhatIsTooSmallIsZeroWithItsSign) {
  for (const float value : {0.0F, Limits::denorm_min(), Limits::min(), 0x1p-25F}) {
    expect_rounded(value, 0);
  }
  expect_rounded(std::nextafter(0x1p-25F, 1.0F), 1);
}

TEST(Half, NotANumberStaysOne) {
  for (const std::uint32_t payload : {1U, 0x1fffU, 0x2000U, 0x3fffffU, 0x400000U, 0x7fffffU}) {
    const std::uint32_t expected = 0x7e00 | payload >> 13;
    expect_rounded(std::bit_cast<float>(0x7f800000 | payload), expected);
    EXPECT_TRUE(std::isnan(to_float(half(expected))));
  }
  for (std::uint32_t bits = kInfinity + 1; bits < kSign; ++bits) {
    ASSERT_TRUE(std::isnan(to_float(half(bits)))) << bits;
    ASSERT_EQ(to_half(to_float(half(bits))).bits, bits | 0x200);
  }
}

TEST(Half, IsTheNearestOfItsNeighbours) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-30, 16);
  for (int i = 0; i < 1'000'000; ++i) {
    const float value = std::exp2(exponent(random));
    if (value >= 65504) continue;
    const std::uint32_t bits = to_half(value).bits;
    const double error = std::abs(value_of(bits) - value);
    ASSERT_LE(error, std::abs(value_of(bits + 1) - value)) << value;
    ASSERT_LE(error, std::abs(value_of(std::max(bits, 1U) - 1) - value)) << value;
    ASSERT_LE(error, std::max(value * 0x1p-11, 0x1p-25)) << value;
  }
}

TEST(Half, AFieldInSinglePrecisionHasItsValues) {
  const std::vector<Half> shear_x = {to_half(1.5F), to_half(-0.25F)};
  const std::vector<Half> shear_y = {to_half(2), to_half(3)};
  const std::vector<Half> normal = {to_half(4), to_half(0x1p-24F)};
  const std::vector<std::uint8_t> status = {15, 7};
  HalfFieldView view = {1, 2, shear_x, shear_y, normal, status, {}, {}, {}, {}};
  view.uncertainty[Uncertainty::phi_high] = shear_x;
  const ForceField field = to_single(view);
  EXPECT_EQ(field.rows, 1U);
  EXPECT_EQ(field.cols, 2U);
  EXPECT_EQ(field.shear_x, (std::vector<float>{1.5F, -0.25F}));
  EXPECT_EQ(field.shear_y, (std::vector<float>{2, 3}));
  EXPECT_EQ(field.normal, (std::vector<float>{4, 0x1p-24F}));
  EXPECT_EQ(field.status, status);
  EXPECT_EQ(field.uncertainty[Uncertainty::phi_high], field.shear_x);
  EXPECT_TRUE(field.uncertainty[Uncertainty::theta_low].empty());
}

}  // namespace
}  // namespace pillarfield
