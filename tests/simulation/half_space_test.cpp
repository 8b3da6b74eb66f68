#include "simulation/body/half_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace pillarfield {
namespace {

/// The mean of a kernel over the cell that is (dx, dy) cells away, by the midpoint rule.
template <class Kernel>
double integral_over_cell(double dx, double dy, Kernel kernel) {
  constexpr int kPoints = 200;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const double x = dx + (i + 0.5) / kPoints - 0.5;
      const double y = dy + (j + 0.5) / kPoints - 0.5;
      sum += kernel(x, y, std::hypot(x, y));
    }
  }
  return sum / (kPoints * kPoints);
}

constexpr double kKernelCellMm = 0.25;

struct UnitCell {
  explicit UnitCell(const CellBox& box, std::int64_t row, std::int64_t col)
      : loaded(box), unloaded(box), x(box), y(box) {
    loaded.values[loaded.index(row, col)] = 1;
  }
  CellField loaded;
  CellField unloaded;
  CellField x;
  CellField y;
};

TEST(HalfSpace, ACellUnderItsOwnTractionMovesByTheKnownMean) {
  const CellBox box = {0, 0, 9, 7};
  HalfSpace surface(9, 7, kKernelCellMm);
  UnitCell cell(box, 4, 3);
  surface.press(cell.loaded, cell.x);
  // The integral of 1/r over a unit square about its middle.
  const double mean = 4 * std::log(1 + std::sqrt(2.0)) * kKernelCellMm;
  EXPECT_NEAR(cell.x.values[cell.x.index(4, 3)], mean, 1e-12);
  surface.shear(cell.loaded, cell.unloaded, cell.x, cell.y);
  EXPECT_NEAR(cell.x.values[cell.x.index(4, 3)], 1.5 * mean, 1e-12);
  EXPECT_NEAR(cell.y.values[cell.y.index(4, 3)], 0, 1e-12);
}

TEST(HalfSpace, OtherCellsMoveAsBoussinesqAndCerrutiSay) {
  const CellBox box = {-3, 5, 11, 14};
  HalfSpace surface(11, 14, kKernelCellMm);
  UnitCell cell(box, -2, 6);
  CellField depth(box);
  surface.press(cell.loaded, depth);
  surface.shear(cell.loaded, cell.unloaded, cell.x, cell.y);
  CellField across_x(box);
  CellField across_y(box);
  surface.shear(cell.unloaded, cell.loaded, across_x, across_y);
  const auto expect = [&](std::int64_t row, std::int64_t col) {
    const auto dx = static_cast<double>(col - 6);
    const auto dy = static_cast<double>(-2 - row);  // rows count downwards
    const std::size_t i = depth.index(row, col);
    const auto mean = [&](auto kernel) {
      return kKernelCellMm * integral_over_cell(dx, dy, kernel);
    };
    const double z = mean([](double, double, double r) { return 1 / r; });
    const double xx = mean([](double x, double, double r) { return x * x / (r * r * r); });
    const double yy = mean([](double, double y, double r) { return y * y / (r * r * r); });
    const double xy = mean([](double x, double y, double r) { return x * y / (r * r * r); });
    EXPECT_NEAR(depth.values[i], z, 2e-5 * z) << row << " " << col;
    EXPECT_NEAR(cell.x.values[i], z + xx, 2e-5 * z) << row << " " << col;
    EXPECT_NEAR(cell.y.values[i], xy, 2e-5 * z) << row << " " << col;
    EXPECT_NEAR(across_x.values[i], xy, 2e-5 * z) << row << " " << col;
    EXPECT_NEAR(across_y.values[i], z + yy, 2e-5 * z) << row << " " << col;
  };
  expect(-1, 6);
  expect(-2, 7);
  expect(-3, 5);
  expect(0, 9);
  // The far corners: nothing wraps around.
  expect(7, 18);
  expect(7, 5);
  expect(-3, 18);
}

TEST(HalfSpace, PaddingToAnySizeGivesTheSame) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const CellBox box = {0, 0, 13, 10};
  CellField x(box);
  CellField y(box);
  for (double& value : x.values) value = uniform(random);
  for (double& value : y.values) value = uniform(random);
  HalfSpace tight(13, 10, kKernelCellMm);
  HalfSpace wide(40, 30, kKernelCellMm);
  CellField tight_x(box);
  CellField tight_y(box);
  CellField wide_x(box);
  CellField wide_y(box);
  tight.shear(x, y, tight_x, tight_y);
  wide.shear(x, y, wide_x, wide_y);
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    ASSERT_NEAR(tight_x.values[i], wide_x.values[i], 1e-10);
    ASSERT_NEAR(tight_y.values[i], wide_y.values[i], 1e-10);
  }
  tight.press(x, tight_x);
  wide.press(x, wide_x);
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    ASSERT_NEAR(tight_x.values[i], wide_x.values[i], 1e-10);
  }
}

TEST(HalfSpace, TheMostShearIsABound) {
  const CellBox box = {0, 0, 24, 24};
  HalfSpaces surfaces(kKernelCellMm);
  HalfSpace& surface = surfaces.for_box(box);
  CellField ones(box);
  std::fill(ones.values.begin(), ones.values.end(), 1.0);
  CellField none(box);
  CellField x(box);
  CellField y(box);
  surface.shear(ones, none, x, y);
  const double most = *std::max_element(x.values.begin(), x.values.end());
  EXPECT_LT(most, surface.most_shear_mm());
  EXPECT_GT(most, surface.most_shear_mm() / 5);
}

}  // namespace
}  // namespace pillarfield
