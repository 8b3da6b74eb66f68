#include "simulation/indenter/friction_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace pillarfield {
namespace {

constexpr std::int64_t kRubbedCells = 64;
constexpr double kRubbedCellMm = 0.3;
constexpr double kRubbedRadiusMm = 9;
constexpr double kRubbedFriction = 0.8;
constexpr double kPeak = 0.01;  ///< of the pressure over πE*

double place(std::int64_t index) {
  return (static_cast<double>(index) - static_cast<double>(kRubbedCells - 1) / 2) * kRubbedCellMm;
}

/// Calls `visit(index, x, y)` for each cell.
template <class Visit>
void for_each_cell(Visit visit) {
  std::size_t index = 0;
  for (std::int64_t row = 0; row < kRubbedCells; ++row) {
    for (std::int64_t col = 0; col < kRubbedCells; ++col, ++index)
      visit(index, place(col), -place(row));
  }
}

/// Hertz's pressure times the friction, and what is rubbed on it step by step.
class Rubbed {
 public:
  Rubbed() : limit_(CellBox{0, 0, kRubbedCells, kRubbedCells}), shear_(limit_.box) {
    for_each_cell([&](std::size_t i, double x, double y) {
      const double rest = 1 - (x * x + y * y) / (kRubbedRadiusMm * kRubbedRadiusMm);
      limit_.values[i] = rest > 0 ? kRubbedFriction * kPeak * std::sqrt(rest) : 0;
    });
  }

  /// Drags the indenter by `drag(x, y)` from where it is.
  template <class Drag>
  int step(Drag drag) {
    HalfSpace& surface = surfaces_.for_box(limit_.box);
    CellVectors drive(limit_.box);
    surface.shear(shear_.x, shear_.y, drive.x, drive.y);
    for_each_cell([&](std::size_t i, double x, double y) {
      const PlaneVector by = drag(x, y);
      drive.x.values[i] += by.x;
      drive.y.values[i] += by.y;
    });
    const int iterations = solve_friction_contact(limit_, drive, surface, shear_);
    EXPECT_GE(iterations, 0);
    return iterations;
  }

  [[nodiscard]] double full() const { return sum(limit_); }
  [[nodiscard]] double pull_x() const { return sum(shear_.x); }
  [[nodiscard]] double pull_y() const { return sum(shear_.y); }
  [[nodiscard]] const CellField& limit() const { return limit_; }
  [[nodiscard]] const CellVectors& shear() const { return shear_; }

  [[nodiscard]] double torque() const {
    double torque = 0;
    for_each_cell([&](std::size_t i, double x, double y) {
      torque += x * shear_.y.values[i] - y * shear_.x.values[i];
    });
    return torque;
  }

  /// The radius of a disc of the area of those cells where `counts(cell)`.
  template <class Counts>
  [[nodiscard]] double radius_where(Counts counts) const {
    double cells = 0;
    for_each_cell(
        [&](std::size_t i, double, double) { cells += limit_.values[i] > 0 && counts(i); });
    return std::sqrt(cells / std::numbers::pi) * kRubbedCellMm;
  }

  [[nodiscard]] double stick_radius() const {
    return radius_where([this](std::size_t i) {
      return std::hypot(shear_.x.values[i], shear_.y.values[i]) < 0.999 * limit_.values[i];
    });
  }

 private:
  static double sum(const CellField& field) {
    return std::accumulate(field.values.begin(), field.values.end(), 0.0);
  }

  CellField limit_;
  CellVectors shear_;
  HalfSpaces surfaces_{kRubbedCellMm};
};

/// Mindlin's displacement at which Q = µP, with ν = 1/2: 3µP(2 − ν)/(16Ga), G = E*/4.
double sliding_displacement_mm(double full_sum) {
  return 9.0 / 8 * std::numbers::pi * full_sum * kRubbedCellMm * kRubbedCellMm / kRubbedRadiusMm;
}

TEST(FrictionContact, PartialSlipIsCattaneosAndMindlins) {
  for (const double ratio : {0.25, 0.5, 0.6, 0.8}) {
    Rubbed ball;
    const double displacement =
        sliding_displacement_mm(ball.full()) * (1 - std::pow(1 - ratio, 2.0 / 3));
    const int iterations = ball.step([&](double, double) { return PlaneVector{0, displacement}; });
    const double found = ball.pull_y() / ball.full();
    const double stick_mm = kRubbedRadiusMm * std::cbrt(1 - found);
    // The traction itself, point by point (C11).
    double squares = 0;
    double cells = 0;
    for_each_cell([&](std::size_t i, double x, double y) {
      if (!(ball.limit().values[i] > 0)) return;
      const double rest = 1 - (x * x + y * y) / (stick_mm * stick_mm);
      const double less =
          rest > 0 ? kRubbedFriction * kPeak * stick_mm / kRubbedRadiusMm * std::sqrt(rest) : 0;
      const double error = ball.shear().y.values[i] - (ball.limit().values[i] - less);
      squares += error * error;
      ++cells;
    });
    const double rms = std::sqrt(squares / cells) / (kRubbedFriction * kPeak);
    const std::string name = "ratio_" + std::to_string(ratio);
    RecordProperty(name + "_found", std::to_string(found));
    RecordProperty(name + "_rms_over_peak", std::to_string(rms));
    RecordProperty(name + "_iterations", iterations);
    EXPECT_NEAR(found, ratio, 0.01) << ratio;
    EXPECT_NEAR(ball.stick_radius(), stick_mm, 0.015 * kRubbedRadiusMm) << ratio;
    EXPECT_NEAR(ball.pull_x() / ball.full(), 0, 1e-6);
    EXPECT_LT(rms, 0.01) << ratio;
  }
}

/// Lubkin's torsion (J. Appl. Mech. 18, 1951, 183-187), derived as a superposition of punches
/// (H12, H13): the angle at which the stick radius is c, over µΣp'·cell².
double torsion_angle(double stick_mm) {
  const double k = std::sqrt(1 - stick_mm * stick_mm / (kRubbedRadiusMm * kRubbedRadiusMm));
  return 3 / (kRubbedRadiusMm * kRubbedRadiusMm) * (std::comp_ellint_1(k) - std::comp_ellint_2(k));
}

/// The torque over µP: of each punch (16/3) G s³ dβ, by parts, with the trapezoidal rule.
double torsion_torque_mm(double stick_mm) {
  // G over P/(πE*) is π/4 in the units of torsion_angle().
  constexpr double kStiffness = 16.0 / 3 / 4 / std::numbers::pi;
  constexpr int kParts = 20000;
  double integral = 0;
  const double width = (kRubbedRadiusMm - stick_mm) / kParts;
  for (int i = 0; i < kParts; ++i) {
    const double s = stick_mm + (i + 0.5) * width;
    integral += 3 * s * s * torsion_angle(s) * width;
  }
  return kStiffness * (stick_mm * stick_mm * stick_mm * torsion_angle(stick_mm) + integral);
}

TEST(FrictionContact, TorsionIsLubkins) {
  // Full sliding, (3π/16) µPa, checks the formula.
  EXPECT_NEAR(torsion_torque_mm(1e-6), 3 * std::numbers::pi / 16 * kRubbedRadiusMm, 1e-3);
  for (const double share : {0.9, 0.7, 0.4}) {
    Rubbed ball;
    const double stick_mm = share * kRubbedRadiusMm;
    const double angle = torsion_angle(stick_mm) * ball.full() * kRubbedCellMm * kRubbedCellMm;
    ball.step([&](double x, double y) { return PlaneVector{-angle * y, angle * x}; });
    const double torque = ball.torque() / ball.full();
    const std::string name = "stick_" + std::to_string(share);
    RecordProperty(name + "_found", std::to_string(ball.stick_radius() / kRubbedRadiusMm));
    RecordProperty(name + "_torque_over_lubkin",
                   std::to_string(torque / torsion_torque_mm(stick_mm)));
    EXPECT_NEAR(ball.stick_radius() / kRubbedRadiusMm, share, 0.02);
    EXPECT_NEAR(torque / torsion_torque_mm(stick_mm), 1, 0.01) << share;
    EXPECT_NEAR(ball.pull_x() / ball.full(), 0, 1e-6);
  }
}

TEST(FrictionContact, SlidingFarTakesAllOfTheFrictionAlongTheWay) {
  Rubbed ball;
  const double far = 100 * sliding_displacement_mm(ball.full());
  ball.step([&](double, double) { return PlaneVector{0.6 * far, -0.8 * far}; });
  for_each_cell([&](std::size_t i, double, double) {
    EXPECT_NEAR(ball.shear().x.values[i], 0.6 * ball.limit().values[i],
                0.02 * kRubbedFriction * kPeak);
    EXPECT_NEAR(ball.shear().y.values[i], -0.8 * ball.limit().values[i],
                0.02 * kRubbedFriction * kPeak);
  });
  EXPECT_EQ(ball.stick_radius(), 0);
}

/// Sliding in many small steps ends as in one: the history converges.
TEST(FrictionContact, SmallStepsSumUp) {
  Rubbed once;
  Rubbed often;
  const double displacement = 0.5 * sliding_displacement_mm(once.full());
  once.step([&](double, double) { return PlaneVector{displacement, 0}; });
  for (int i = 0; i < 5; ++i) {
    often.step([&](double, double) { return PlaneVector{displacement / 5, 0}; });
  }
  EXPECT_NEAR(often.pull_x() / once.pull_x(), 1, 5e-3);
}

/// Mindlin and Deresiewicz: pulled to Q₁ and back to Q₂, an annulus slips the other way, inside
/// which b/a = (1 − (Q₁ − Q₂)/2µP)^(1/3).
TEST(FrictionContact, AReversalLeavesAnAnnulusOfCounterSlip) {
  Rubbed ball;
  const double full_mm = sliding_displacement_mm(ball.full());
  const double first = full_mm * (1 - std::pow(0.3, 2.0 / 3));
  ball.step([&](double, double) { return PlaneVector{first, 0}; });
  const double pulled = ball.pull_x() / ball.full();
  // Unloading has twice the compliance: δ₁ − δ₂ = 2δ_s(1 − (1 − (Q₁ − Q₂)/2µP)^(2/3)).
  const double back = 2 * full_mm * (1 - std::pow(0.6, 2.0 / 3));
  ball.step([&](double, double) { return PlaneVector{-back, 0}; });
  const double left = ball.pull_x() / ball.full();
  EXPECT_NEAR(pulled, 0.7, 0.01);
  EXPECT_NEAR(left, -0.1, 0.015);
  const double inner = ball.radius_where([&](std::size_t i) {
    const double x = ball.shear().x.values[i];
    return x > 0 || std::hypot(x, ball.shear().y.values[i]) < 0.999 * ball.limit().values[i];
  });
  RecordProperty("inner_over_contact", std::to_string(inner / kRubbedRadiusMm));
  EXPECT_NEAR(inner / kRubbedRadiusMm, std::cbrt(1 - (pulled - left) / 2), 0.02);
  // Shear still points ahead in the ring that slipped first and never counter-slipped.
  EXPECT_GT(std::ranges::max(ball.shear().x.values), 0.1 * kRubbedFriction * kPeak);
}

}  // namespace
}  // namespace pillarfield
