// Hysteresis, creep, wires and bending, and all effects in the order of the signal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "pillarfield/simulator.h"
#include "simulation/effects/memory_history.h"
#include "simulation/effects/sensel_leak.h"
#include "simulation/effects/wire_network.h"

namespace pillarfield {
namespace {

Scene sensels(std::uint32_t rows, std::uint32_t cols) {
  Scene scene;
  scene.skin.rows = rows;
  scene.skin.cols = cols;
  return scene;
}

/// Readings of a sensel whose V follows `loads`, one frame each.
std::vector<double> readings_of(const SensorModel& model, double rate_hz,
                                const std::vector<double>& loads) {
  Scene scene = sensels(2, 2);
  scene.sensor = model;
  scene.rate_hz = rate_hz;
  MemoryHistory history(scene);
  std::vector<double> readings;
  for (std::size_t frame = 0; frame < loads.size(); ++frame) {
    std::vector<double> v(4, loads[frame]);
    history.apply(frame, v, {});
    EXPECT_EQ(v.front(), v.back());
    readings.push_back(v.front());
  }
  return readings;
}

TEST(Hysteresis, HasItsWidthAtHalfTheRangeAndExactEnds) {
  SensorModel model;
  model.hysteresis = 0.06;
  model.hysteresis_range_counts = 200;
  std::vector<double> cycle;
  for (int i = 0; i <= 400; ++i) cycle.push_back(200 - std::abs(i - 200));
  const std::vector<double> read = readings_of(model, 100, cycle);
  EXPECT_NEAR(read[200], 200, 1e-3);
  EXPECT_NEAR(read[400], 0, 1e-3);
  EXPECT_NEAR(read[300] - read[100], 0.06 * 200, 1e-3);
  EXPECT_NEAR((read[300] + read[100]) / 2, 100, 1e-3);
  for (std::size_t i = 1; i < 200; ++i) {
    EXPECT_GT(read[i + 1], read[i]);
    EXPECT_LT(read[200 + i], read[199 + i]);
    EXPECT_GT(read[400 - i], read[i]);
    EXPECT_LE(read[400 - i] - read[i], 0.06 * 200 + 1e-3);
  }
}

/// Memory of the last turning points only: an inner loop closes.
TEST(Hysteresis, ForgetsAnInnerLoop) {
  SensorModel model;
  model.hysteresis = 0.1;
  const std::vector<double> direct = readings_of(model, 100, {0, 100, 150, 220});
  const std::vector<double> looped = readings_of(model, 100, {0, 100, 150, 60, 150, 220});
  EXPECT_NEAR(looped[4], direct[2], 1e-4);
  EXPECT_NEAR(looped[5], direct[3], 1e-4);
  EXPECT_NE(readings_of(model, 100, {0, 150, 60})[2], readings_of(model, 100, {0, 60})[1]);
}

TEST(Creep, RisesByItsFractionInEveryDecadeOfTime) {
  SensorModel model;
  model.creep_per_decade = 0.05;
  std::vector<double> step(60'002, 80.0);
  step.front() = 0;
  const std::vector<double> read = readings_of(model, 100, step);
  EXPECT_EQ(read[1], 80);
  for (const std::size_t frames : {1U, 3U, 10U, 30U, 100U, 300U, 1000U, 3000U, 6000U}) {
    EXPECT_NEAR(read[1 + 10 * frames] - read[1 + frames], 4, 0.2) << frames;
  }
  // After release the reading falls back as it rose.
  const std::vector<double> released = readings_of(model, 100, {0, 80, 80, 80, 0, 0, 0});
  EXPECT_GT(released[4], 0);
  EXPECT_LT(released[6], released[4]);
}

TEST(Creep, DoesNotDependOnTheFrameRate) {
  SensorModel model;
  model.creep_per_decade = 0.1;
  const double coarse = readings_of(model, 2, std::vector<double>(21, 50.0)).back();
  const double fine = readings_of(model, 200, std::vector<double>(2001, 50.0)).back();
  EXPECT_NEAR(coarse, fine, 1e-3);
}

/// Solves A x = b by elimination with partial pivoting.
std::vector<double> solve_dense(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

/// Kirchhoff's law at every row and column of one tile, for one driven row; the currents of the
/// columns. All conductances in counts.
std::vector<double> column_currents(const WireCrosstalk& wires,
                                    const std::vector<std::vector<double>>& g, std::size_t driven) {
  const std::size_t rows = g.size();
  const std::size_t cols = g.front().size();
  std::vector<std::vector<double>> a(rows + cols, std::vector<double>(rows + cols));
  std::vector<double> b(rows + cols);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < cols; ++c) {
      a[r][r] += g[r][c];
      a[rows + c][rows + c] += g[r][c];
      a[r][rows + c] -= g[r][c];
      a[rows + c][r] -= g[r][c];
    }
    a[r][r] += 1 / (r == driven ? wires.row_per_count : wires.idle_per_count);
  }
  for (std::size_t c = 0; c < cols; ++c) a[rows + c][rows + c] += 1 / wires.column_per_count;
  b[driven] = 1 / wires.row_per_count;
  const std::vector<double> potential = solve_dense(a, b);
  std::vector<double> currents;
  for (std::size_t c = 0; c < cols; ++c) {
    currents.push_back(potential[rows + c] / wires.column_per_count);
  }
  return currents;
}

TEST(WireNetwork, IsThatOfKirchhoffsLawsInEveryTile) {
  constexpr std::size_t kRows = 11;
  constexpr std::size_t kCols = 13;
  const WireCrosstalk wires = {6, 8, 3e-4, 2e-4, 7e-4};
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> counts(-100, 250);
  std::vector<double> readings(kRows * kCols);
  for (double& reading : readings) reading = std::max(0.0, counts(engine));
  std::vector<double> scanned = readings;
  read_through_wires(wires, kRows, kCols, scanned);
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::size_t top = row / 6 * 6;
    for (std::size_t left = 0; left < kCols; left += 8) {
      std::vector<std::vector<double>> tile;
      for (std::size_t r = top; r < std::min(kRows, top + 6); ++r) {
        const auto first = readings.begin() + static_cast<std::ptrdiff_t>(r * kCols + left);
        tile.emplace_back(
            first, first + static_cast<std::ptrdiff_t>(std::min<std::size_t>(8, kCols - left)));
      }
      const std::vector<double> expected = column_currents(wires, tile, row - top);
      for (std::size_t c = 0; c < expected.size(); ++c) {
        EXPECT_NEAR(scanned[row * kCols + left + c], expected[c], 1e-9) << row << " " << left + c;
      }
    }
  }
  // The effect is there: readings fall by several per cent, and unloaded sensels read ghosts.
  EXPECT_LT(std::accumulate(scanned.begin(), scanned.end(), 0.0),
            0.95 * std::accumulate(readings.begin(), readings.end(), 0.0));
  const auto unloaded = std::ranges::find(readings, 0.0) - readings.begin();
  EXPECT_GT(scanned[static_cast<std::size_t>(unloaded)], 0.01);
}

/// 50 of 200 counts are 40 kΩ, and two of them are a row of 20 kΩ behind 30 Ω.
TEST(WireNetwork, OfASceneReadsThroughItsOhmsAndMayLieBeforeTheTare) {
  Scene scene = sensels(2, 2);
  scene.skin.counts_per_newton = 100;
  scene.skin.full_scale_counts = 200;
  scene.load = DirectionSweep{1, 1, 0, {0.5}};
  const double row = 30 / (1e4 * 200);
  scene.sensor.effects.wires = {2, 2, row, 0, row, TareOrigin::offset};
  FrameBuffer raw(SenselType::f32, 2, 2);
  ForceField truth(1, 1);
  for (const float tare : {0.0F, 60.0F}) {
    scene.sensor.tare_counts = tare;
    const Simulator simulator(scene);
    simulator.render(0, raw, truth);
    for (const float reading : raw.readings<float>()) {
      EXPECT_NEAR(reading, tare + 50 / 1.0015, 1e-4);
    }
  }
}

/// Every stage of [sensor] and [surface], composed here in the documented order.
TEST(SensorEffectsOfAScene, FollowTheOrderOfTheSignal) {
  Scene scene = sensels(6, 8);
  scene.skin.counts_per_newton = 300;
  scene.rate_hz = 10;
  scene.load = DirectionSweep{4, 3, 60, {0.2}, {{0, 0.5}, {0.1, 1}}};
  SensorModel& model = scene.sensor;
  model.effects.pillar_leak = {0.05, 0.02};
  model.effects.shear_coefficient = {0.8, 1.2};
  model.dead_zone_counts = 4;
  model.effects.sensel_leak = {0.1, 0.06};
  model.hysteresis = 0.1;
  model.creep_per_decade = 0.1;
  model.effects.curve = {{20, 70}, {15, 90}};
  model.gain_spread = 0.2;
  model.tare_counts = 6;
  const double count_siemens = 1 / (1e4 * 255);
  model.effects.wires = {4, 4, 100 * count_siemens, 80 * count_siemens, 100 * count_siemens};
  scene.bending = Bending{50, {{0, 0.02, 0, 0}}};
  const Simulator simulator(scene);
  const Calibration& calibration = simulator.calibration();
  MemoryHistory memory(scene);
  FrameBuffer raw(SenselType::f32, 6, 8);
  ForceField truth(3, 4);
  for (const std::uint64_t frame : {0U, 1U}) {
    simulator.render(frame, raw, truth);
    std::vector<double> v(48);
    for (std::size_t sensel = 0; sensel < 48; ++sensel) {
      const auto row = static_cast<int>(sensel / 16);
      const auto col = static_cast<int>(sensel % 8 / 2);
      const double up = sensel / 8 % 2 == 0 ? 1.2 : -1.2;
      const double right = sensel % 2 == 1 ? 0.8 : -0.8;
      for (int i = std::max(0, row - 1); i <= std::min(2, row + 1); ++i) {
        for (int j = std::max(0, col - 1); j <= std::min(3, col + 1); ++j) {
          const double fractions[] = {1, 0.05, 0.02};
          const auto pillar = static_cast<std::size_t>(i) * 4 + static_cast<std::size_t>(j);
          const double shear = right * truth.shear_x[pillar] + up * truth.shear_y[pillar];
          v[sensel] += 300 * fractions[std::abs(i - row) + std::abs(j - col)] *
                       (truth.normal[pillar] + shear / std::numbers::sqrt2);
        }
      }
      // Status bits are of the pillar's own force, with its shear coefficient.
      const auto own = static_cast<std::size_t>(row) * 4 + static_cast<std::size_t>(col);
      const int bit = up > 0 ? (right > 0 ? 0 : 1) : (right > 0 ? 3 : 2);
      const double shear = right * truth.shear_x[own] + up * truth.shear_y[own];
      EXPECT_EQ((truth.status[own] >> bit & 1) != 0,
                truth.normal[own] + shear / std::numbers::sqrt2 > 0);
      v[sensel] = std::max(0.0, std::max(0.0, v[sensel]) - 4);
    }
    leak_between_sensels({0.1, 0.06}, 6, 8, v);
    memory.apply(frame, v, {});
    for (std::size_t sensel = 0; sensel < 48; ++sensel) {
      v[sensel] = reading_at(model.effects.curve, v[sensel]) / calibration.gain[sensel] + 6 +
                  0.02 * calibration.bend_x[sensel];
    }
    read_through_wires(*calibration.effects.wires, 6, 8, v);
    for (std::size_t sensel = 0; sensel < 48; ++sensel) {
      EXPECT_NEAR(raw.readings<float>()[sensel], v[sensel], 1e-4) << frame << " " << sensel;
    }
  }
}

TEST(BendingOfAScene, AddsCurvatureTimesPatternToTheTare) {
  Scene scene = sensels(40, 30);
  scene.sensor.tare_counts = 50;
  scene.bending = Bending{120, {{0, 0, 0, 0}, {1, 0.02, -0.01, 0.004}}};
  scene.rate_hz = 2;
  const Simulator simulator(scene);
  const Calibration& calibration = simulator.calibration();
  FrameBuffer raw(SenselType::f32, 40, 30);
  ForceField truth(20, 15);
  for (const std::uint64_t frame : {0U, 1U, 2U, 9U}) {
    simulator.render(frame, raw, truth);
    const double part = std::min(1.0, static_cast<double>(frame) / 2);
    for (std::size_t i = 0; i < raw.readings<float>().size(); ++i) {
      const double bend = 0.02 * calibration.bend_x[i] - 0.01 * calibration.bend_y[i] +
                          0.004 * calibration.bend_xy[i];
      EXPECT_NEAR(raw.readings<float>()[i], 50 + part * bend, 1e-4);
    }
  }
  double squares = 0;
  double mixed = 0;
  for (std::size_t i = 0; i < 1200; ++i) {
    squares += std::pow(double{calibration.bend_y[i]}, 2) / 1200;
    mixed += double{calibration.bend_x[i]} * calibration.bend_y[i] / 1200;
  }
  EXPECT_NEAR(std::sqrt(squares), 120, 12);
  EXPECT_NEAR(mixed, 0, 0.15 * 120 * 120);
}

}  // namespace
}  // namespace pillarfield
