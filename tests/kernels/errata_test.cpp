// Where the paper's printed equations are wrong, and that what docs/derivations/pillar_model.md
// puts in their place is right. V[n] is sensel n's reading; V[0] is not used.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "oracle.h"

namespace pillarfield {
namespace {

using Voltages = std::array<double, 5>;

Voltages voltages(double theta, double phi) {
  const oracle::Readings readings = oracle::readings_from(1, theta, phi, 1);
  Voltages v{};
  for (std::size_t n = 0; n < 4; ++n) v[n + 1] = static_cast<double>(readings[n]);
  return v;
}

double sensel_angle(int n) { return std::numbers::pi / 4 * (2 * n - 1); }

/// Calls `check(v, phi)` over region 2.n: sensel n lifted and no other.
template <class Check>
void for_region_two(std::size_t lifted, Check check) {
  int cases = 0;
  for (double theta = 0.05; theta < 1.55; theta += 0.05) {
    for (double phi = -3.1; phi < 3.1; phi += 0.05) {
      const Voltages v = voltages(theta, phi);
      bool in_region = true;
      for (std::size_t n = 1; n <= 4; ++n) in_region = in_region && (v[n] > 0) == (n != lifted);
      if (!in_region) continue;
      check(v, phi);
      ++cases;
    }
  }
  EXPECT_GT(cases, 100);
}

void expect_tangent(double actual, double phi) {
  EXPECT_NEAR(std::remainder(std::atan(actual) - phi, std::numbers::pi), 0, 1e-9);
}

TEST(Errata, EquationNineHasAWrongSignInRegionsOneAndThree) {
  for_region_two(1, [](const Voltages& v, double phi) {
    const double printed = (v[2] - v[3]) / (v[3] - v[4]);
    EXPECT_NEAR(printed, -std::tan(phi), 1e-6 * std::abs(printed) + 1e-9);
    expect_tangent((v[2] - v[3]) / (v[4] - v[3]), phi);
  });
  for_region_two(3, [](const Voltages& v, double phi) {
    const double printed = (v[4] - v[1]) / (v[1] - v[2]);
    EXPECT_NEAR(printed, -std::tan(phi), 1e-6 * std::abs(printed) + 1e-9);
    expect_tangent((v[1] - v[4]) / (v[1] - v[2]), phi);
  });
}

TEST(Errata, EquationNineIsRightInRegionsTwoAndFour) {
  for_region_two(
      2, [](const Voltages& v, double phi) { expect_tangent((v[4] - v[1]) / (v[3] - v[4]), phi); });
  for_region_two(
      4, [](const Voltages& v, double phi) { expect_tangent((v[2] - v[3]) / (v[1] - v[2]), phi); });
}

/// Equation (8) for i = 1, j = 2, k = 3 with the ratio that leads its denominator.
double tangent_of_equation_eight(const Voltages& v, double leading_ratio) {
  const double ratio_ik = v[1] / v[3];
  const double ratio_jk = v[2] / v[3];
  const double i = sensel_angle(1);
  const double j = sensel_angle(2);
  const double k = sensel_angle(3);
  const double numerator = ratio_ik * (std::cos(k) - std::cos(j)) +
                           ratio_jk * (std::cos(i) - std::cos(k)) + (std::cos(j) - std::cos(i));
  const double denominator = leading_ratio * (std::sin(j) - std::sin(k)) +
                             ratio_jk * (std::sin(k) - std::sin(i)) + (std::sin(i) - std::sin(j));
  return numerator / denominator;
}

TEST(Errata, EquationEightLeadsItsDenominatorWithRik) {
  int wrong = 0;
  for_region_two(4, [&](const Voltages& v, double phi) {
    expect_tangent(tangent_of_equation_eight(v, v[1] / v[3]), phi);
    const double printed = std::atan(tangent_of_equation_eight(v, v[2] / v[3]));
    wrong += std::abs(std::remainder(printed - phi, std::numbers::pi)) > 0.01 ? 1 : 0;
  });
  EXPECT_GT(wrong, 100);
}

TEST(Errata, EquationSevenPointsWhereTheForceGoes) {
  for (double phi = -3.1; phi < 3.1; phi += 0.1) {
    const Voltages v = voltages(0.5, phi);
    const double numerator = v[1] * v[2] - v[3] * v[4];
    const double denominator = v[1] * v[4] - v[2] * v[3];
    EXPECT_NEAR(std::atan2(-numerator, -denominator), phi, 1e-9);
    const double as_printed = std::atan2(numerator, denominator);
    EXPECT_NEAR(std::abs(std::remainder(as_printed - phi, 2 * std::numbers::pi)), std::numbers::pi,
                1e-9);
  }
}

TEST(Errata, EquationFiveIsZeroByZeroAcrossADiagonal) {
  for (const double phi : {3 * std::numbers::pi / 4, -std::numbers::pi / 4}) {
    const Voltages v = voltages(0.5, phi);
    const double ratio = v[1] / v[3];
    EXPECT_NEAR(ratio - 1, 0, 1e-15);
    EXPECT_NEAR(ratio * std::cos(sensel_angle(3) - phi) - std::cos(sensel_angle(1) - phi), 0,
                1e-15);
  }
}

TEST(Errata, EveryRatioFormIsZeroByZeroUnderPressingAlone) {
  const Voltages v = voltages(0, 0);
  EXPECT_EQ(v[1] / v[3] - 1, 0);
  EXPECT_EQ(v[1] * v[2] - v[3] * v[4], 0);
  EXPECT_EQ(v[1] * v[4] - v[2] * v[3], 0);
}

TEST(Errata, TableTwosRegionThreeIsInRegionTwo) {
  const Voltages v = voltages(1.222, 5.760);
  EXPECT_LT(v[4], 0);
  for (const std::size_t n : {1U, 2U, 3U}) EXPECT_GT(v[n], 0);
  EXPECT_NEAR(v[1], 0.098, 0.0005);
}

}  // namespace
}  // namespace pillarfield
