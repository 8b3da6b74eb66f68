#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/closed_form/disc_integrals.h"
#include "simulation/closed_form/elliptic_integrals.h"

namespace pillarfield {
namespace {

using std::numbers::pi;

double value_of(CornerFunction corner, double x, double y) {
  double value = 0;
  corner({&x, 1}, {&y, 1}, {&value, 1});
  return value;
}

/// The midpoint rule in theta, x = limit·sin(theta), which takes the root singularity at the end of
/// a chord; its nodes crowd at x = 0, where the integrand may bend sharply.
template <class Function>
double along_x(double x, double half_chord, Function f) {
  constexpr int kNodes = 40000;
  const double end = std::asin(std::min(1.0, x / half_chord));
  double sum = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double graded = std::pow((i + 0.5) / kNodes, 3);
    const double theta = end * graded;
    const double weight = end * 3 * std::pow((i + 0.5) / kNodes, 2) / kNodes;
    sum += f(half_chord * std::sin(theta)) * half_chord * std::cos(theta) * weight;
  }
  return sum;
}

double within(double value) { return std::min(1.0, value); }

/// h(r) of equation (C12), and its value at the rim.
double sphere_reach(double r) { return 3 / (4 * pi) * (r * std::sqrt(1 - r * r) + std::asin(r)); }
double punch_reach(double r) { return std::asin(r) / (2 * pi); }

template <class Reach>
double spin_by_quadrature(double x, double y, Reach reach) {
  if (y >= 1) return reach(1) * x;
  const double chord = std::sqrt(1 - y * y);
  const double inside = along_x(std::min(x, chord), chord,
                                [&](double at) { return reach(within(std::hypot(at, y))); });
  return inside + reach(1) * std::max(0.0, x - chord);
}

const std::vector<double> kPlaces = {0,   1e-14, 1e-9, 1e-5,  1e-3, 0.009,
                                     0.1, 0.5,   0.8,  0.999, 1,    1.7};

TEST(CornerFunction, SpinIsTheIntegralAlongAnEdgeAtAnyDistanceFromTheCentre) {
  for (const double x : kPlaces) {
    for (const double y : kPlaces) {
      EXPECT_NEAR(value_of(sphere_spin_corner, x, y), spin_by_quadrature(x, y, sphere_reach), 2e-9)
          << x << " " << y;
      EXPECT_NEAR(value_of(punch_spin_corner, x, y), spin_by_quadrature(x, y, punch_reach), 2e-9)
          << x << " " << y;
    }
  }
}

TEST(CornerFunction, SpinIsOddAlongTheEdgeAndEvenAcross) {
  for (const CornerFunction corner : {sphere_spin_corner, punch_spin_corner}) {
    for (const double x : kPlaces) {
      for (const double y : kPlaces) {
        EXPECT_DOUBLE_EQ(value_of(corner, -x, y), -value_of(corner, x, y));
        EXPECT_DOUBLE_EQ(value_of(corner, x, -y), value_of(corner, x, y));
      }
    }
  }
}

/// The integral by y in closed form, that by x by quadrature.
double sphere_by_quadrature(double x, double y) {
  return 3 / (2 * pi) * along_x(within(x), 1, [=](double at) {
           const double top = std::sqrt(std::max(0.0, 1 - at * at));
           const double t = std::min(y, top);
           return (t * std::sqrt(std::max(0.0, top * top - t * t)) +
                   top * top * std::asin(within(t / top))) /
                  2;
         });
}

double punch_by_quadrature(double x, double y) {
  return 1 / (2 * pi) * along_x(within(x), 1, [=](double at) {
           return std::asin(within(y / std::sqrt(1 - at * at)));
         });
}

TEST(CornerFunction, PressureIsTheIntegralFromTheAxes) {
  for (const double x : kPlaces) {
    for (const double y : kPlaces) {
      EXPECT_NEAR(value_of(sphere_pressure_corner, x, y), sphere_by_quadrature(x, y), 1e-7)
          << x << " " << y;
      EXPECT_NEAR(value_of(punch_pressure_corner, x, y), punch_by_quadrature(x, y), 1e-6)
          << x << " " << y;
    }
  }
}

TEST(CornerFunction, EachQuadrantBearsAQuarterOfTheLoad) {
  for (const CornerFunction corner : {sphere_pressure_corner, punch_pressure_corner}) {
    for (const double far : {1.0, 1.5, 1e100}) {
      EXPECT_DOUBLE_EQ(value_of(corner, far, far), 0.25);
      EXPECT_DOUBLE_EQ(value_of(corner, -far, far), -0.25);
      EXPECT_DOUBLE_EQ(value_of(corner, -far, -far), 0.25);
    }
  }
}

TEST(CornerFunction, NeighboursDoNotMatter) {
  std::vector<double> x;
  std::vector<double> y;
  for (const double first : kPlaces) {
    for (const double second : kPlaces) {
      x.push_back(-first);
      y.push_back(second);
    }
  }
  for (const CornerFunction corner :
       {sphere_pressure_corner, punch_pressure_corner, sphere_spin_corner, punch_spin_corner}) {
    std::vector<double> together(x.size());
    corner(x, y, together);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(together[i], value_of(corner, x[i], y[i]), 3e-16) << x[i] << " " << y[i];
    }
  }
}

TEST(EllipticIntegrals, AreCarlsonsPublishedValues) {
  const CarlsonIntegrals mixed = carlson_integrals(0, 2, 1);
  EXPECT_NEAR(mixed.first, 1.3110287771461, 1e-13);
  EXPECT_NEAR(mixed.second, 1.7972103521034, 1e-13);
  EXPECT_NEAR(carlson_integrals(2, 3, 4).first, 0.58408284167715, 1e-14);
  EXPECT_NEAR(carlson_integrals(2, 3, 4).second, 0.16510527294261, 1e-14);
}

TEST(EllipticIntegrals, AreElementaryForEqualArguments) {
  for (const double x : {1e-40, 0.3, 1.0, 1e30}) {
    EXPECT_NEAR(carlson_integrals(x, x, x).first * std::sqrt(x), 1, 1e-14);
    EXPECT_NEAR(carlson_integrals(x, x, x).second * x * std::sqrt(x), 1, 1e-14);
  }
}

}  // namespace
}  // namespace pillarfield
