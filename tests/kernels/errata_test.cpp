// The paper's printed equations have the errors that docs/derivations/pillar_model.md, section 6,
// lists, and its corrections are right.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/kernels/one_pillar.h"
#include "tests/kernels/oracle.h"

namespace pillarfield::errata {
namespace {

/// Errors of an equation's angle over the directions to which it applies.
struct Deviation {
  int cases = 0;
  int wrong = 0;         ///< cases that are off by more than 0.01 rad, or not a number
  double worst_rad = 0;  ///< infinite where one is not a number
};

/// One equation, as it is printed and as it should be.
struct Erratum {
  std::string name;     ///< as a test is called
  std::string where;    ///< "(9), region 2.1"
  std::string printed;  ///< what the paper says
  std::function<Deviation()> measure_printed;
  std::string mended;  ///< what it should say
  std::function<Deviation()> measure_mended;
};

using std::numbers::pi;

/// V[n] is sensel n's reading; V[0] is not used.
using Voltages = std::array<double, 5>;

Voltages voltages(double theta, double phi) {
  const oracle::Readings readings = oracle::readings_from(1, theta, phi, 1);
  Voltages v{};
  for (std::size_t n = 0; n < 4; ++n) v[n + 1] = static_cast<double>(readings[n]);
  return v;
}

double sensel_angle(int n) { return pi / 4 * (2 * n - 1); }

struct Direction {
  double theta;
  double phi;
};

/// Directions in which exactly the sensels in `inactive` do not read; none stands for region 1.
std::vector<Direction> directions(std::size_t inactive) {
  std::vector<Direction> found;
  for (int i = 1; i < 16; ++i) {
    for (int j = -31; j < 31; ++j) {
      const double theta = 0.1 * i;
      const double phi = 0.1 * j;
      const Voltages v = voltages(theta, phi);
      bool in_region = true;
      for (std::size_t n = 1; n <= 4; ++n) in_region = in_region && (v[n] > 0) == (n != inactive);
      if (in_region) found.push_back({theta, phi});
    }
  }
  return found;
}

/// The errors `error(direction, voltages)`, in radians.
template <class Error>
Deviation deviation(const std::vector<Direction>& directions, Error error) {
  constexpr double kWrong = 0.01;
  Deviation result;
  for (const Direction& direction : directions) {
    const double raw = std::abs(error(direction, voltages(direction.theta, direction.phi)));
    const double off = std::isnan(raw) ? std::numeric_limits<double>::infinity() : raw;
    ++result.cases;
    result.wrong += off > kWrong ? 1 : 0;
    result.worst_rad = std::max(result.worst_rad, off);
  }
  return result;
}

using Equation = double (*)(const Voltages&);

/// Measures an equation for tan(phi), the quadrant apart, where one sensel is inactive.
std::function<Deviation()> tangent(std::size_t inactive, Equation equation) {
  return [=] {
    return deviation(directions(inactive), [=](const Direction& direction, const Voltages& v) {
      return std::remainder(std::atan(equation(v)) - direction.phi, pi);
    });
  };
}

/// Measures an equation for phi.
std::function<Deviation()> azimuth(std::size_t inactive, Equation equation) {
  return [=] {
    return deviation(directions(inactive), [=](const Direction& direction, const Voltages& v) {
      return std::remainder(equation(v) - direction.phi, 2 * pi);
    });
  };
}

/// Equation (8) for i = 1, j = 2, k = 3 with the ratio that leads its denominator.
double equation_eight(const Voltages& v, double leading_ratio) {
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

/// Equation (5) for sensels 1 and 3, which the paper assigns in region 1.
double equation_five(const Voltages& v, double phi) {
  const double ratio = v[1] / v[3];
  return std::atan((ratio - 1) /
                   (ratio * std::cos(sensel_angle(3) - phi) - std::cos(sensel_angle(1) - phi)));
}

double equation_seven(const Voltages& v) {
  return std::atan((v[1] * v[2] - v[3] * v[4]) / (v[1] * v[4] - v[2] * v[3]));
}

/// theta by (5) at phi = 135 and 315 degrees, as near as a double comes to them.
template <class Theta>
std::function<Deviation()> across_first_diagonal(Theta theta_of) {
  return [=] {
    std::vector<Direction> all;
    for (int i = 1; i < 15; ++i) {
      const double theta = 0.05 * i;
      for (const double phi : {3 * pi / 4, -pi / 4}) all.push_back({theta, phi});
    }
    return deviation(all, [=](const Direction& direction, const Voltages& v) {
      return theta_of(direction, v) - direction.theta;
    });
  };
}

/// theta of a force that only presses.
template <class Theta>
std::function<Deviation()> pressing_alone(Theta theta_of) {
  return [=] {
    return deviation({{0, 0}}, [=](const Direction&, const Voltages& v) { return theta_of(v); });
  };
}

double theta_by(Estimator estimator, const Voltages& v) {
  return estimate_pillar<double>({v[1], v[2], v[3], v[4]}, PillarSensor{}, estimator)
      .direction.theta;
}

std::vector<Erratum> errata_of_tangents() {
  return {
      {"EquationNineInRegionOne", "(9), region 2.1",  //
       "(V2 − V3) / (V3 − V4)",
       tangent(1, [](const Voltages& v) { return (v[2] - v[3]) / (v[3] - v[4]); }),
       "(V2 − V3) / (V4 − V3)",
       tangent(1, [](const Voltages& v) { return (v[2] - v[3]) / (v[4] - v[3]); })},
      {"EquationNineInRegionThree", "(9), region 2.3",  //
       "(V4 − V1) / (V1 − V2)",
       tangent(3, [](const Voltages& v) { return (v[4] - v[1]) / (v[1] - v[2]); }),
       "(V1 − V4) / (V1 − V2)",
       tangent(3, [](const Voltages& v) { return (v[1] - v[4]) / (v[1] - v[2]); })},
      {"EquationEight", "(8), denominator",  //
       "begins with R_jk",
       tangent(4, [](const Voltages& v) { return equation_eight(v, v[2] / v[3]); }),
       "begins with R_ik",
       tangent(4, [](const Voltages& v) { return equation_eight(v, v[1] / v[3]); })},
  };
}

std::vector<Erratum> errata_of_quadrants() {
  return {
      {"QuadrantOfEquationSeven", "(7), quadrant",  //
       "atan2(V1V2 − V3V4, V1V4 − V2V3)",
       azimuth(0,
               [](const Voltages& v) {
                 return std::atan2(v[1] * v[2] - v[3] * v[4], v[1] * v[4] - v[2] * v[3]);
               }),
       "atan2(V3V4 − V1V2, V2V3 − V1V4)",
       azimuth(0,
               [](const Voltages& v) {
                 return std::atan2(v[3] * v[4] - v[1] * v[2], v[2] * v[3] - v[1] * v[4]);
               })},
      {"QuadrantOfEquationNine", "(9), region 2.4, quadrant",  //
       "atan2(V2 − V3, V1 − V2)",
       azimuth(4, [](const Voltages& v) { return std::atan2(v[2] - v[3], v[1] - v[2]); }),
       "atan2(V3 − V2, V2 − V1)",
       azimuth(4, [](const Voltages& v) { return std::atan2(v[3] - v[2], v[2] - v[1]); })},
  };
}

std::vector<Erratum> errata_of_zero_by_zero() {
  return {
      {"EquationFiveAcrossADiagonal", "(5) at φ = 135° and 315°", "with sensels 1 and 3",
       across_first_diagonal(
           [](const Direction& d, const Voltages& v) { return equation_five(v, d.phi); }),
       "with the diagonal along the shear",
       across_first_diagonal(
           [](const Direction&, const Voltages& v) { return theta_by(Estimator::paper, v); })},
      {"PressingAlone", "(7), then (5), at θ = 0", "ratios",
       pressing_alone([](const Voltages& v) { return equation_five(v, equation_seven(v)); }),
       "the direct solve",
       pressing_alone([](const Voltages& v) { return theta_by(Estimator::direct, v); })},
  };
}

/// The errata of equations (5), (7), (8) and (9), for readings of the model rounded to double.
std::vector<Erratum> equation_errata() {
  std::vector<Erratum> all = errata_of_tangents();
  for (const auto& more : {errata_of_quadrants(), errata_of_zero_by_zero()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// Equation (9) in regions 2.2 and 2.4, which is right as it is printed, up to the quadrant.
std::array<Deviation, 2> right_as_printed() {
  return {
      tangent(2, [](const Voltages& v) { return (v[4] - v[1]) / (v[3] - v[4]); })(),
      tangent(4, [](const Voltages& v) { return (v[2] - v[3]) / (v[1] - v[2]); })(),
  };
}

/// The model's V of sensels 1 to 4, in units of F k, for what Table II calls Region 3.
std::array<double, 4> table_two_region_three() {
  const Voltages v = voltages(1.222, 5.760);
  return {v[1], v[2], v[3], v[4]};
}

class Errata : public testing::TestWithParam<Erratum> {};

TEST_P(Errata, ThePrintedEquationIsWrong) {
  const Deviation printed = GetParam().measure_printed();
  // A tangent of the wrong sign is right where it vanishes.
  EXPECT_GE(printed.wrong, 0.95 * printed.cases);
  EXPECT_GT(printed.worst_rad, 0.3);
}

TEST_P(Errata, TheCorrectedEquationIsRight) {
  const Deviation mended = GetParam().measure_mended();
  EXPECT_GT(mended.cases, 0);
  EXPECT_EQ(mended.wrong, 0);
  EXPECT_LT(mended.worst_rad, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(In, Errata, testing::ValuesIn(equation_errata()),
                         [](const testing::TestParamInfo<Erratum>& erratum) {
                           return erratum.param.name;
                         });

TEST(NoErrata, EquationNineIsRightInRegionsTwoAndFour) {
  for (const Deviation& deviation : right_as_printed()) {
    EXPECT_GT(deviation.cases, 30);
    EXPECT_LT(deviation.worst_rad, 1e-9);
  }
}

TEST(TableTwo, ItsRegionThreeIsRegionTwoOfTheModel) {
  const std::array<double, 4> v = table_two_region_three();
  EXPECT_LT(v[3], 0);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_GT(v[n], 0);
  EXPECT_NEAR(v[0], 0.098, 0.0005);
}

}  // namespace
}  // namespace pillarfield::errata
