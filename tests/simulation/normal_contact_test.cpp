#include "simulation/indenter/normal_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

namespace pillarfield {
namespace {

constexpr double kPressedCellMm = 0.3;
constexpr double kNone = std::numeric_limits<double>::infinity();

/// `height(x, y)` on a square of cells about the origin.
template <class Height>
CellField indenter_of(std::int64_t cells, Height height) {
  CellField field(CellBox{0, 0, cells, cells});
  const double middle = static_cast<double>(cells - 1) / 2;
  for (std::int64_t row = 0; row < cells; ++row) {
    for (std::int64_t col = 0; col < cells; ++col) {
      field.values[field.index(row, col)] =
          height((static_cast<double>(col) - middle) * kPressedCellMm,
                 (middle - static_cast<double>(row)) * kPressedCellMm);
    }
  }
  return field;
}

CellField paraboloid(double radius_x_mm, double radius_y_mm) {
  return indenter_of(180, [=](double x, double y) {
    return x * x / (2 * radius_x_mm) + y * y / (2 * radius_y_mm);
  });
}

double sum_of(const CellField& field) {
  return std::accumulate(field.values.begin(), field.values.end(), 0.0);
}

double contact_area_mm2(const NormalContact& contact) {
  const auto cells = std::ranges::count_if(contact.pressure.values, [](double p) { return p > 0; });
  return static_cast<double>(cells) * kPressedCellMm * kPressedCellMm;
}

NormalContact solved(const CellField& height, double sum) {
  HalfSpaces surfaces(kPressedCellMm);
  const auto contact = solve_normal_contact(height, sum, surfaces);
  EXPECT_TRUE(contact);
  return contact.value_or(NormalContact());
}

/// Hertz: P = 4/3 E* a³/R. A sum of pressures over πE* is P / (πE* cell²).
double hertz_sum(double radius_mm, double contact_mm) {
  return 4 * contact_mm * contact_mm * contact_mm /
         (3 * std::numbers::pi * radius_mm * kPressedCellMm * kPressedCellMm);
}

TEST(NormalContact, ASphereIsHertzs) {
  constexpr double kRadiusMm = 60;
  constexpr double kContactMm = 11;
  const double sum = hertz_sum(kRadiusMm, kContactMm);
  const NormalContact contact = solved(paraboloid(kRadiusMm, kRadiusMm), sum);
  EXPECT_NEAR(sum_of(contact.pressure), sum, 1e-12 * sum);
  EXPECT_NEAR(contact.approach_mm, kContactMm * kContactMm / kRadiusMm, 2e-3);
  const double peak = 2 * kContactMm / (std::numbers::pi * std::numbers::pi * kRadiusMm);
  const double highest = std::ranges::max(contact.pressure.values);
  double squares = 0;
  double cells = 0;
  const CellField hertz = indenter_of(180, [=](double x, double y) {
    return peak * std::sqrt(std::max(0.0, 1 - (x * x + y * y) / (kContactMm * kContactMm)));
  });
  const CellField found = on_box(contact.pressure, hertz.box);
  for (std::size_t i = 0; i < hertz.values.size(); ++i) {
    if (hertz.values[i] == 0 && found.values[i] == 0) continue;
    squares += (found.values[i] - hertz.values[i]) * (found.values[i] - hertz.values[i]);
    ++cells;
  }
  const double rms = std::sqrt(squares / cells) / peak;
  RecordProperty("peak_over_hertz", std::to_string(highest / peak));
  RecordProperty("rms_over_peak", std::to_string(rms));
  RecordProperty("iterations", contact.iterations);
  EXPECT_NEAR(highest / peak, 1, 3e-3);
  EXPECT_LT(rms, 8e-3);
}

/// Hertz's ellipse: R_x/R_y = (b² E/a² ... ) from complete elliptic integrals (Johnson, 4.2).
TEST(NormalContact, AnEllipsoidHasHertzsEllipse) {
  constexpr double kLongMm = 12;
  constexpr double kShortMm = 6;
  const double e = std::sqrt(1 - (kShortMm / kLongMm) * (kShortMm / kLongMm));
  const double k = std::comp_ellint_1(e);
  const double l = std::comp_ellint_2(e);
  // R'/R'' = (a²/b² E − K)/(K − E), R' being the curvature radius along the long axis.
  const double ratio = ((kLongMm * kLongMm) / (kShortMm * kShortMm) * l - k) / (k - l);
  constexpr double kAcrossMm = 40;
  // 1/(2R'') = p₀ b (a²/b² E − K) / (E* e² a²), Johnson (4.26); P = 2/3 π a b p₀.
  const double p0 = e * e * kLongMm * kLongMm / (2 * kAcrossMm) /
                    (kShortMm * ((kLongMm * kLongMm) / (kShortMm * kShortMm) * l - k));
  const double sum = 2.0 / 3 * kLongMm * kShortMm * p0 / (kPressedCellMm * kPressedCellMm);
  const NormalContact contact = solved(paraboloid(kAcrossMm * ratio, kAcrossMm), sum);
  EXPECT_NEAR(static_cast<double>(contact.contact.cols) * kPressedCellMm, 2 * kLongMm,
              2.5 * kPressedCellMm);
  EXPECT_NEAR(static_cast<double>(contact.contact.rows) * kPressedCellMm, 2 * kShortMm,
              2.5 * kPressedCellMm);
  EXPECT_NEAR(std::ranges::max(contact.pressure.values), p0 / std::numbers::pi,
              5e-3 * p0 / std::numbers::pi);
}

/// Johnson (3.36): P = 2aE*δ.
TEST(NormalContact, AFlatPunchSinksInProportionToItsLoad) {
  constexpr double kRadiusMm = 9;
  const CellField punch = indenter_of(
      70, [](double x, double y) { return std::hypot(x, y) > kRadiusMm ? kNone : 0.0; });
  const NormalContact contact = solved(punch, 3);
  const double radius = std::sqrt(contact_area_mm2(contact) / std::numbers::pi);
  EXPECT_NEAR(radius, kRadiusMm, 0.02 * kRadiusMm);
  const double load = 3 * kPressedCellMm * kPressedCellMm * std::numbers::pi;  // over E*
  EXPECT_NEAR(contact.approach_mm, load / (2 * radius), 0.012 * load / (2 * radius));
}

/// Sneddon's cone: P = π a² E* cot α / 2 with a side that rises by cot α per millimetre.
TEST(NormalContact, AConeIsSneddons) {
  constexpr double kSlope = 0.05;
  constexpr double kContactMm = 10;
  const CellField cone =
      indenter_of(120, [](double x, double y) { return kSlope * std::hypot(x, y); });
  const double sum = kContactMm * kContactMm * kSlope / (2 * kPressedCellMm * kPressedCellMm);
  const NormalContact contact = solved(cone, sum);
  EXPECT_NEAR(contact_area_mm2(contact), std::numbers::pi * kContactMm * kContactMm, 6);
  EXPECT_NEAR(contact.approach_mm, std::numbers::pi / 2 * kContactMm * kSlope, 0.01);
}

/// Two hills far apart: the window holds both, though the first guess may be of one.
TEST(NormalContact, SeparateHillsShareTheLoad) {
  const CellField hills = indenter_of(150, [](double x, double y) {
    const double right = ((x - 12) * (x - 12) + y * y) / 40;
    const double left = ((x + 12) * (x + 12) + y * y) / 40;
    return std::min(left, right);
  });
  const NormalContact contact = solved(hills, 8);
  double left = 0;
  double middle = 0;
  double right = 0;
  const CellField whole = on_box(contact.pressure, hills.box);
  for (std::int64_t row = 0; row < 150; ++row) {
    for (std::int64_t col = 0; col < 150; ++col) {
      const double p = whole.values[whole.index(row, col)];
      (col < 60 ? left : col < 90 ? middle : right) += p;
    }
  }
  EXPECT_NEAR(left, 4, 1e-3);
  EXPECT_NEAR(right, 4, 1e-3);
  EXPECT_EQ(middle, 0);
}

TEST(NormalContact, OneCellBearsASmallLoadAlone) {
  const CellField needle =
      indenter_of(9, [](double x, double y) { return 100 * std::hypot(x, y); });
  const NormalContact contact = solved(needle, 1e-6);
  EXPECT_EQ(contact.contact.cells(), 1U);
  EXPECT_NEAR(sum_of(contact.pressure), 1e-6, 1e-18);
}

TEST(NormalContact, WithoutAnIndenterThereIsNone) {
  HalfSpaces surfaces(kPressedCellMm);
  const CellField nothing = indenter_of(5, [](double, double) { return kNone; });
  EXPECT_FALSE(solve_normal_contact(nothing, 1, surfaces));
}

}  // namespace
}  // namespace pillarfield
