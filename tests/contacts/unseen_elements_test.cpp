// Sums of contacts over masked sensels against the truth: random smooth pressures and masks.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/host_solve.h"

namespace pillarfield {
namespace {

constexpr double kCountsPerNewton = 1000;

/// A random smooth pressure, by place in elements; its largest value is about 1.
struct Pressure {
  Pressure(std::mt19937& random, double rows, double cols) {
    std::uniform_real_distribution<double> unit(0, 1);
    kind = static_cast<int>(5 * unit(random));
    const double size = std::min(rows, cols);
    const int bumps = kind == 4 ? 3 : 1;
    const double row = rows * (0.3 + 0.4 * unit(random));
    const double col = cols * (0.3 + 0.4 * unit(random));
    for (int i = 0; i < bumps; ++i) {
      const double away = i == 0 ? 0 : 0.15 * size;
      parts.push_back({row + away * (unit(random) - 0.5), col + away * (unit(random) - 0.5),
                       size * (0.15 + 0.15 * unit(random)), size * (0.15 + 0.15 * unit(random)),
                       std::numbers::pi * unit(random)});
    }
  }
  [[nodiscard]] double at(double row, double col) const {
    double sum = 0;
    for (const auto& [y, x, a, b, angle] : parts) {
      const double u = ((col - x) * std::cos(angle) + (row - y) * std::sin(angle)) / a;
      const double v = ((row - y) * std::cos(angle) - (col - x) * std::sin(angle)) / b;
      const double square = u * u + v * v;
      const double inside = std::max(1 - square, 0.0);
      if (kind == 0) sum += std::sqrt(inside);      // ball
      if (kind == 1) sum += std::pow(inside, 1.5);  // soft ball
      if (kind == 2)
        sum += inside > 0 ? 0.5 + 0.5 * std::cos(std::numbers::pi * std::sqrt(square)) : 0;
      if (kind == 3) sum += 1 / (1 + std::pow(square, 3));  // rounded flat base
      if (kind == 4) sum += 0.5 * std::exp(-1.5 * square);  // several bumps
    }
    return sum;
  }
  int kind;
  std::vector<std::array<double, 5>> parts;  // row, column, half axes, angle
};

struct Counts {
  int places = 0;
  int held = 0;
  int shares = 0;
  double squares = 0;
};

/// Masks random sensels of a kind: columns, rows, clusters or single ones.
std::string mask(std::mt19937& random, Skin& skin, std::vector<std::uint8_t>& good) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto draw = [&](double from, double to) {
    return static_cast<int>(from + (to - from) * unit(random));
  };
  const auto kind = static_cast<std::size_t>(draw(0, 4));
  const int rows = static_cast<int>(skin.rows);
  const int cols = static_cast<int>(skin.cols);
  const int step = skin.has_pillars() ? 2 : 1;
  const int row = step * draw(0.3 * rows / step, 0.7 * rows / step);
  const int col = step * draw(0.3 * cols / step, 0.7 * cols / step);
  const int wide = step * draw(1, 3);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const bool hits = kind == 0   ? c >= col && c < col + wide
                        : kind == 1 ? r >= row && r < row + wide
                        : kind == 2 ? std::hypot(r - row, c - col) < 1.3 * wide
                                    : unit(random) < 0.06;
      if (hits) good[static_cast<std::size_t>(r * cols + c)] = 0;
    }
  }
  return std::array{"columns", "rows", "clusters", "single"}[kind];
}

void expect_sums(int seeds) {
  std::map<std::string, Counts> counts;
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed + 1));
    std::uniform_real_distribution<double> unit(0, 1);
    std::normal_distribution<double> normal;
    SolverPlan plan;
    plan.skin.layout = seed % 2 == 0 ? SkinLayout::sensels : SkinLayout::pillars;
    const auto sensels =
        static_cast<std::uint32_t>(12 + 20 * unit(random)) * (seed % 2 == 0 ? 1U : 2U);
    plan.skin.rows = sensels;
    plan.skin.cols = sensels + 2 * static_cast<std::uint32_t>(5 * unit(random));
    plan.skin.counts_per_newton = kCountsPerNewton;
    plan.skin.threshold_counts = 20;
    plan.sensel_type = SenselType::f32;
    plan.estimator = Estimator::direct;
    const std::uint32_t step = plan.skin.has_pillars() ? 2 : 1;
    const std::uint32_t rows = plan.skin.rows / step;
    const std::uint32_t cols = plan.skin.cols / step;
    const Pressure pressure(random, rows, cols);
    const double shear_x = 0.3 * (unit(random) - 0.5);
    const double shear_y = 0.3 * (unit(random) - 0.5);
    FrameBuffer frame(SenselType::f32, plan.skin.rows, plan.skin.cols);
    plan.calibration.mask.assign(plan.skin.sensels(), 1);
    const std::string kind = std::string(name_of(plan.skin.layout)) + " " +
                             mask(random, plan.skin, plan.calibration.mask);
    std::array<double, 3> truth{};
    double seen = 0;
    double unseen = 0;
    for (std::uint32_t r = 0; r < plan.skin.rows; ++r) {
      for (std::uint32_t c = 0; c < plan.skin.cols; ++c) {
        const double load = pressure.at(r / step + 0.5, c / step + 0.5);
        const double up = r % 2 == 0 ? 1 : -1;
        const double right = c % 2 == 0 ? -1 : 1;
        const double lean = step == 2 ? std::sqrt(0.5) * (right * shear_x + up * shear_y) : 0;
        frame.readings<float>()[r * plan.skin.cols + c] =
            static_cast<float>(kCountsPerNewton * load * (1 + lean) + 3 * normal(random));
        if (r % step != 0 || c % step != 0 || load < 0.02) continue;
        truth[0] += load;
        truth[1] += load * (c / step + 0.5 - 0.5 * cols) * step * plan.skin.sensel_pitch_mm.col_mm;
        truth[2] += load * (0.5 * rows - r / step - 0.5) * step * plan.skin.sensel_pitch_mm.row_mm;
        int left = 0;
        for (std::uint32_t k = 0; k < step * step; ++k) {
          left += plan.calibration.mask[(r + k / 2) * plan.skin.cols + c + k % 2];
        }
        (left == 0 ? unseen : seen) += 1;
      }
    }
    ContactOptions options;
    set_sensor(options, plan);
    ContactTracker tracker(plan.skin.element_pitch_mm(), options);
    const ContactQuantities total =
        tracker.update(solve_on_host(plan, frame.view()).view(), 0).total;
    if (total.pillars < 9) continue;
    Counts& count = counts[kind];
    const double sigma = total.unseen_deviations ? total.unseen_deviations->normal_n : 0;
    const double error = total.normal_n - truth[0];
    const double noise = 0.003 * truth[0];
    const std::array errors = {error, total.centre_of_pressure.x_mm - truth[1] / truth[0],
                               total.centre_of_pressure.y_mm - truth[2] / truth[0]};
    const PatchPlace place =
        total.unseen_deviations ? total.unseen_deviations->centre_of_pressure : PatchPlace{};
    const std::array deviations = {sigma, place.x_mm, place.y_mm};
    const std::array noises = {noise, 0.003 * plan.skin.sensel_pitch_mm.col_mm * cols,
                               0.003 * plan.skin.sensel_pitch_mm.row_mm * rows};
    for (std::size_t k = 0; k < 3; ++k) {
      ++count.places;
      const bool held = std::abs(errors[k]) <= 1.96 * deviations[k] + noises[k];
      count.held += held ? 1 : 0;
      if (!held && std::getenv("PILLARFIELD_SHOW") != nullptr) {
        std::printf("  seed %d %s kind %d: %zu error %.4f deviation %.4f of %.3f\n", seed,
                    kind.c_str(), pressure.kind, k, errors[k], deviations[k], truth[k]);
      }
    }
    count.squares += error * error / truth[0] / truth[0];
    const double share_error = std::abs(total.unseen - unseen / (seen + unseen));
    count.shares += share_error < 0.05 ? 3 : 0;
    EXPECT_LT(share_error, 0.2) << kind << " of seed " << seed;
  }
  Counts all;
  for (const auto& [kind, count] : counts) {
    std::printf("%-18s %d of %d held, error of the total %.2f %% (RMS), share %.0f %% right\n",
                kind.c_str(), count.held, count.places,
                100 * std::sqrt(3 * count.squares / count.places),
                100.0 * count.shares / count.places);
    all.places += count.places;
    all.held += count.held;
    all.shares += count.shares;
  }
  EXPECT_GE(all.held, 0.93 * all.places);
  EXPECT_GE(all.shares, 0.85 * all.places);
}

TEST(UnseenElements, AreFilledInAsTheirDeviationsSay) { expect_sums(40); }
TEST(FurtherUnseenElements, AreFilledInAsTheirDeviationsSay) { expect_sums(400); }

}  // namespace
}  // namespace pillarfield
