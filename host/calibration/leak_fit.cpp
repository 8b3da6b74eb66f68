#include "calibration/leak_fit.h"

#include <algorithm>
#include <cmath>

#include "solve/pillar_maths.h"

namespace pillarfield {
namespace {

/// Sums of the edge neighbours of each sensel under its pillar, and beyond it.
struct NeighbourSums {
  SenselPatch inside{};
  SenselPatch across{};
};

NeighbourSums neighbour_sums(const SenselPatch& v) {
  NeighbourSums sums;
  const auto at = [&](std::size_t row, std::size_t col) {
    return row < kPatchSide && col < kPatchSide ? v.at(row * kPatchSide + col) : 0;
  };
  for (std::size_t row = 0; row < kPatchSide; ++row) {
    for (std::size_t col = 0; col < kPatchSide; ++col) {
      const auto in_v = static_cast<std::size_t>(double_precision::inward(static_cast<int>(row)));
      const auto in_h = static_cast<std::size_t>(double_precision::inward(static_cast<int>(col)));
      const std::size_t i = row * kPatchSide + col;
      sums.inside.at(i) = at(row + in_v, col) + at(row, col + in_h);
      sums.across.at(i) = at(row - in_v, col) + at(row, col - in_h);  // 0 - 1 is off the patch.
    }
  }
  return sums;
}

SenselPatch leak_sensels(const SenselPatch& v, const Leaks& leaks) {
  const NeighbourSums sums = neighbour_sums(v);
  SenselPatch readings = v;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings.at(i) += leaks[0] * sums.inside.at(i) + leaks[1] * sums.across.at(i);
  }
  return readings;
}

/// The load of the pressed pillar times `middle`, of its nearest pillars times `edge`, of the
/// diagonal ones times `corner`.
SenselPatch spread(const PressedLoad& load, double middle, double edge, double corner) {
  constexpr std::array<std::size_t, 4> kSenselOf = {1, 0, 2, 3};  // [row, col] to 0 to 3
  SenselPatch v{};
  for (std::size_t row = 0; row < kPatchSide; ++row) {
    for (std::size_t col = 0; col < kPatchSide; ++col) {
      const bool middle_row = row / 2 == 1;
      const bool middle_col = col / 2 == 1;
      const double factor = middle_row && middle_col   ? middle
                            : middle_row || middle_col ? edge
                                                       : corner;
      v.at(row * kPatchSide + col) = factor * load.at(kSenselOf.at(row % 2 * 2 + col % 2));
    }
  }
  return v;
}

}  // namespace

LeakedPatch leak_patch(const PressedLoad& load, const Leaks& leaks, double zone) {
  SenselPatch v = spread(load, 1, leaks[2], leaks[3]);
  SenselPatch by_edge = spread(load, 0, 1, 0);
  SenselPatch by_corner = spread(load, 0, 0, 1);
  for (std::size_t i = 0; zone > 0 && i < v.size(); ++i) {
    if (v.at(i) <= zone) by_edge.at(i) = by_corner.at(i) = 0;
    v.at(i) = std::max(0.0, v.at(i) - zone);
  }
  const NeighbourSums sums = neighbour_sums(v);
  return {leak_sensels(v, leaks),
          {sums.inside, sums.across, leak_sensels(by_edge, leaks), leak_sensels(by_corner, leaks)}};
}

std::optional<std::size_t> inactive_sensel(const PressedLoad& readings, double margin) {
  const double surplus = readings[0] + readings[2] - readings[1] - readings[3];
  if (!(std::abs(surplus) > margin)) return std::nullopt;
  const std::size_t first = surplus > 0 ? 0 : 1;
  return readings.at(first) < readings.at(first + 2) ? first : first + 2;
}

PressedLoad unleak(const PressedLoad& readings, const Leaks& leaks, double zone,
                   const std::optional<std::size_t>& inactive) {
  constexpr int kSteps = 30;  // of a contraction by 0.8 or less
  PressedLoad load = readings;
  for (double& each : load) each += zone;
  for (int step = 0; step < kSteps; ++step) {
    if (inactive) load.at(*inactive) = 0;
    const SenselPatch read = leak_patch(load, leaks, zone).readings;
    for (std::size_t n = 0; n < load.size(); ++n) {
      load.at(n) += readings.at(n) - read.at(kPressedSensels.at(n));
      load.at(n) = std::max(0.0, load.at(n));
    }
  }
  if (inactive) load.at(*inactive) = 0;
  return load;
}

}  // namespace pillarfield
