// Sums of contacts over masked sensels against the truth: random smooth pressures and masks.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/host_solve.h"

namespace pillarfield {
namespace {

constexpr double kCountsPerNewton = 1000;
constexpr double kLeastLoad = 0.02;

class World {
 public:
  explicit World(unsigned seed) : random_(seed) {
    Skin& skin = plan.skin;
    skin.layout = seed % 2 == 0 ? SkinLayout::sensels : SkinLayout::pillars;
    step_ = skin.has_pillars() ? 2 : 1;
    skin.rows = step_ * static_cast<std::uint32_t>(draw(12, 32));
    skin.cols = step_ * static_cast<std::uint32_t>(draw(12, 32));
    skin.counts_per_newton = kCountsPerNewton;
    skin.threshold_counts = kLeastLoad * kCountsPerNewton;
    plan.sensel_type = SenselType::f32;
    plan.estimator = Estimator::direct;
    kind_ = static_cast<int>(draw(0, 4));
    const double middle = skin.rows / 2.0 / step_;
    const double size = std::min(skin.rows, skin.cols) / step_;
    for (int i = 0; i < (kind_ == 3 ? 3 : 1); ++i) {
      parts_.push_back({middle * draw(0.7, 1.3), skin.cols / 2.0 / step_ * draw(0.7, 1.3),
                        size * draw(0.15, 0.3), size * draw(0.15, 0.3)});
      if (i > 0) parts_.back()[0] = parts_[0][0] + size * draw(-0.1, 0.1);
      if (i > 0) parts_.back()[1] = parts_[0][1] + size * draw(-0.1, 0.1);
    }
  }

  double draw(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// Masks columns, rows, a cluster or single sensels; returns which.
  std::string mask() {
    const Skin& skin = plan.skin;
    const auto kind = static_cast<std::size_t>(draw(0, 4));
    const double row = step_ * std::floor(draw(0.3, 0.7) * skin.rows / step_);
    const double col = step_ * std::floor(draw(0.3, 0.7) * skin.cols / step_);
    const double wide = step_ * std::floor(draw(1, 3));
    for (std::uint32_t i = 0; i < skin.sensels(); ++i) {
      const double down = i / skin.cols - row;
      const double right = i % skin.cols - col;
      const std::array hits = {right >= 0 && right < wide, down >= 0 && down < wide,
                               std::hypot(down, right) < 1.3 * wide, draw(0, 1) < 0.06};
      plan.calibration.mask.push_back(hits[kind] ? 0 : 1);
    }
    return std::string(name_of(skin.layout)) +
           std::array{" columns", " rows", " clusters", " single"}[kind];
  }

  /// Solves the contact with noise of 3 counts; sets its truth.
  ContactQuantities solve() {
    const Skin& skin = plan.skin;
    FrameBuffer frame(SenselType::f32, skin.rows, skin.cols);
    std::normal_distribution<double> noise(0, 3);
    const double shear = step_ == 2 ? draw(-0.2, 0.2) : 0;
    double seen = 0;
    for (std::uint32_t i = 0; i < skin.sensels(); ++i) {
      const std::uint32_t row = i / skin.cols;
      const std::uint32_t col = i % skin.cols;
      const double load = pressure(row / step_ + 0.5, col / step_ + 0.5);
      const double lean = col % 2 == 0 ? 1 - shear : 1 + shear;
      frame.readings<float>()[i] =
          static_cast<float>(kCountsPerNewton * load * lean + noise(random_));
      if (row % step_ != 0 || col % step_ != 0 || load < kLeastLoad) continue;
      bool any = false;
      for (std::uint32_t k = 0; k < step_ * step_; ++k) {
        any = any || plan.calibration.mask[i + k / 2 * skin.cols + k % 2] != 0;
      }
      ++(any ? seen : unseen);
      truth[0] += load;
      truth[1] += load * (col + step_ / 2.0 - skin.cols / 2.0) * skin.sensel_pitch_mm.col_mm;
      truth[2] += load * (skin.rows / 2.0 - row - step_ / 2.0) * skin.sensel_pitch_mm.row_mm;
    }
    truth[1] /= truth[0];
    truth[2] /= truth[0];
    unseen /= seen + unseen;
    ContactOptions options;
    set_sensor(options, plan);
    ContactTracker tracker(skin.element_pitch_mm(), options);
    return tracker.update(solve_on_host(plan, frame.view()).view(), 0).total;
  }

  SolverPlan plan;
  std::array<double, 3> truth{};  ///< N, and the centre of pressure, mm
  double unseen = 0;

 private:
  [[nodiscard]] double pressure(double row, double col) const {
    double sum = 0;
    for (const auto& [y, x, a, b] : parts_) {
      const double square = std::pow((row - y) / a, 2) + std::pow((col - x) / b, 2);
      const double inside = std::max(1 - square, 0.0);
      sum += std::array{std::sqrt(inside), std::pow(inside, 1.5), 1 / (1 + std::pow(square, 3)),
                        0.5 * std::exp(-1.5 * square)}[static_cast<std::size_t>(kind_)];
    }
    return sum;
  }

  std::mt19937 random_;
  std::uint32_t step_ = 1;
  int kind_ = 0;  ///< ball, soft ball, flat base, bumps
  std::vector<std::array<double, 4>> parts_;
};

struct Counts {
  int all = 0;
  int held = 0;
  int shares = 0;
  double squares = 0;
};

void expect_sums(unsigned seeds) {
  std::map<std::string, Counts> counts;
  Counts all;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    World world(seed);
    Counts& count = counts[world.mask()];
    const ContactQuantities total = world.solve();
    const auto off = total.unseen_deviations.value_or(UnseenDeviations{});
    const std::array errors = {total.normal_n - world.truth[0],
                               total.centre_of_pressure.x_mm - world.truth[1],
                               total.centre_of_pressure.y_mm - world.truth[2]};
    const double noise_mm = 0.003 * world.plan.skin.sensel_pitch_mm.col_mm * world.plan.skin.rows;
    const bool held = std::abs(errors[0]) <= 1.96 * off.normal_n + 0.003 * world.truth[0] &&
                      std::abs(errors[1]) <= 1.96 * off.centre_of_pressure.x_mm + noise_mm &&
                      std::abs(errors[2]) <= 1.96 * off.centre_of_pressure.y_mm + noise_mm;
    for (Counts* const each : {&count, &all}) {
      ++each->all;
      each->held += held ? 1 : 0;
      each->shares += std::abs(total.unseen - world.unseen) < 0.06 ? 1 : 0;
      each->squares += std::pow(errors[0] / world.truth[0], 2);
    }
  }
  for (const auto& [kind, count] : counts) {
    std::printf("%-16s %d of %d held, share right %d, error of the total %.1f %% (RMS)\n",
                kind.c_str(), count.held, count.all, count.shares,
                100 * std::sqrt(count.squares / count.all));
  }
  EXPECT_GE(all.held, 0.93 * all.all);
  EXPECT_GE(all.shares, 0.85 * all.all);
}

TEST(UnseenElements, AreFilledInAsTheirDeviationsSay) { expect_sums(40); }
TEST(FurtherUnseenElements, AreFilledInAsTheirDeviationsSay) { expect_sums(400); }

}  // namespace
}  // namespace pillarfield
