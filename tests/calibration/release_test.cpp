// A followed baseline takes in the rests that touches leave, and no load: random sequences of
// grasps, rests and loads.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "pillarfield/processor.h"

namespace pillarfield {
namespace {

constexpr double kCountsPerNewton = 300;

/// A skin whose touches leave rests, at a random rate; what it reads is solved at once.
class Hand {
 public:
  explicit Hand(unsigned seed, const std::string& device = "host") : random_(seed) {
    rate_hz_ = std::exp(draw(std::log(20.0), std::log(500.0)));
    plan_.skin.layout = seed % 2 == 0 ? SkinLayout::sensels : SkinLayout::pillars;
    plan_.skin.rows = plan_.skin.cols = 2 * static_cast<std::uint32_t>(draw(5, 9));
    plan_.skin.counts_per_newton = kCountsPerNewton / (seed % 2 == 0 ? 1 : 4);
    plan_.skin.threshold_counts = 8;
    plan_.sensel_type = SenselType::f32;
    plan_.estimator = Estimator::direct;
    plan_.frame_interval_s = 1 / rate_hz_;
    plan_.calibration.tare.assign(plan_.skin.sensels(), 200);
    set_baseline(plan_, 10);
    processor_.emplace(open_device(device), plan_);
    frame_.emplace(SenselType::f32, plan_.skin.rows, plan_.skin.cols);
    rest_.assign(plan_.skin.sensels(), 0);
    std::normal_distribution<double> noise(0, 1.5);
    noise_.resize(5000);
    for (double& each : noise_) each = noise(random_);
    drift_per_s_ = draw(-0.02, 0.02);
    move();
  }

  double draw(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// Goes to another place, with another shape.
  void move() {
    const double middle = plan_.skin.rows / 2.0;
    const double row = middle * draw(0.8, 1.2);
    const double col = middle * draw(0.8, 1.2);
    const double size = middle * draw(0.5, 0.8);
    const bool flat = draw(0, 1) < 0.5;
    shape_.assign(plan_.skin.sensels(), 0);
    for (std::size_t i = 0; i < shape_.size(); ++i) {
      const double y = static_cast<double>(i / plan_.skin.cols) + 0.5 - row;
      const double x = static_cast<double>(i % plan_.skin.cols) + 0.5 - col;
      const double square = (x * x + y * y) / size / size;
      if (square < 1) shape_[i] = flat ? 1 / (1 + 9 * std::pow(square, 4)) : std::sqrt(1 - square);
    }
    const double sum = std::accumulate(shape_.begin(), shape_.end(), 0.0);
    for (double& share : shape_) share /= sum;
  }

  [[nodiscard]] std::vector<float> tare() const { return processor_->tare(); }

  /// A load that reads ten times the threshold at its largest.
  [[nodiscard]] double weak_n() const {
    return 10 * plan_.skin.threshold_counts / kCountsPerNewton / *std::ranges::max_element(shape_);
  }

  /// Ramps to a load within `ramp_s` and holds it; returns the mean total of the last fifth, N.
  double hold(double load_n, double ramp_s, double seconds) {
    const double from = load_n_;
    const auto frames = static_cast<int>(seconds * rate_hz_) + 5;
    double total = 0;
    int counted = 0;
    for (int i = 0; i < frames; ++i) {
      load_n_ = from + (load_n - from) * std::min(1.0, (i + 1) / rate_hz_ / ramp_s);
      time_s_ += 1 / rate_hz_;
      if (load_n_ == 0) free_s_ += 1 / rate_hz_;
      const double kept = rest_now();
      const std::size_t first = random_() % (noise_.size() - shape_.size());
      for (std::size_t k = 0; k < shape_.size(); ++k) {
        frame_->readings<float>()[k] = static_cast<float>(200 + drift_per_s_ * time_s_ +
                                                          kCountsPerNewton * load_n_ * shape_[k] +
                                                          kept * rest_[k] + noise_[first + k]);
      }
      processor_->submit(frame_->view());
      const ForceFieldView forces = processor_->receive();
      if (i < 0.8 * frames) continue;
      total += std::accumulate(forces.normal.begin(), forces.normal.end(), 0.0);
      ++counted;
    }
    return total / counted;
  }

  /// Lets go of a grasp of `peak_n`, which leaves a part of it that grows or decays.
  void release(double peak_n, double part) {
    const double kept = rest_now();
    for (std::size_t k = 0; k < rest_.size(); ++k) {
      const double left = part * draw(0.8, 1.2) * kCountsPerNewton * peak_n * shape_[k];
      rest_[k] = kept * rest_[k] + left;
    }
    free_s_ = 0;
    end_of_rest_ = draw(0.6, 1.1);
    time_of_rest_s_ = draw(2, 10);
  }

 private:
  [[nodiscard]] double rest_now() const {
    const double passed = 1 - std::exp(-free_s_ / time_of_rest_s_);
    return 1 + (end_of_rest_ - 1) * passed;
  }

  std::mt19937 random_;
  std::vector<double> noise_;  ///< counts
  SolverPlan plan_;
  std::optional<Processor> processor_;
  std::optional<FrameBuffer> frame_;
  double rate_hz_ = 0;
  double drift_per_s_ = 0;
  double time_s_ = 0;
  double load_n_ = 0;
  double free_s_ = 0;  ///< without a load since the last release
  double end_of_rest_ = 1;
  double time_of_rest_s_ = 1;
  std::vector<double> shape_;
  std::vector<double> rest_;  ///< counts
};

struct Kept {
  int all = 0;
  int right = 0;
  double worst = 0;
  void add(double error, double most) {
    ++all;
    right += error <= most ? 1 : 0;
    worst = std::max(worst, error);
  }
};

void expect_rests_to_go(unsigned seeds) {
  std::array<Kept, 4> kept;  // pauses, grasps, loads that rest, light loads
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Hand hand(seed);
    hand.hold(0, 0.1, 2);
    double peak_n = 0;
    const int grasps = 2 + static_cast<int>(hand.draw(0, 3));
    for (int grasp = 0; grasp < grasps; ++grasp) {
      if (hand.draw(0, 1) < 0.3) hand.move();
      peak_n = hand.draw(8, 20);
      const double part = hand.draw(0, 0.18);
      const double read_n = hand.hold(peak_n, hand.draw(0.05, 0.5), hand.draw(1, 4));
      kept[1].add(std::abs(read_n / peak_n - 1), 0.07);
      hand.release(peak_n, part);
      kept[0].add(hand.hold(0, hand.draw(0.02, 0.2), hand.draw(2, 5)) / peak_n, 0.03);
    }
    hand.move();
    const double lasting_n = std::max(peak_n * hand.draw(0.25, 1), std::min(peak_n, hand.weak_n()));
    hand.hold(peak_n, 0.2, 2);
    kept[2].add(std::abs(hand.hold(lasting_n, hand.draw(0.05, 1), 60) / lasting_n - 1), 0.07);
    hand.release(peak_n, 0.05);
    hand.hold(0, 0.1, 2 + hand.draw(0, 2));
    const double light_n = std::max(peak_n * hand.draw(0.05, 0.2), hand.weak_n());
    kept[3].add(std::abs(hand.hold(light_n, 0.2, 20) / light_n - 1), 0.15);
  }
  constexpr std::array kNames = {"pauses", "grasps", "loads that rest", "light loads"};
  for (std::size_t k = 0; k < kept.size(); ++k) {
    std::printf("%-16s %d of %d right, worst %.1f %%\n", kNames[k], kept[k].right, kept[k].all,
                100 * kept[k].worst);
    EXPECT_GE(kept[k].right, 0.95 * kept[k].all) << kNames[k];
  }
}

TEST(Release, HasTheSameBitsOnADevice) {
  for (const unsigned seed : {1U, 2U}) {
    std::vector<std::vector<float>> tares;
    for (const char* const device : {"host", "opencl"}) {
      Hand hand(seed, device);
      for (int grasp = 0; grasp < 2; ++grasp) {
        hand.hold(12, 0.1, 1);
        hand.release(12, 0.1);
        hand.hold(0, 0.1, 2);
      }
      tares.push_back(hand.tare());
    }
    EXPECT_EQ(tares[0], tares[1]);
    EXPECT_GT(*std::ranges::max_element(tares[0]), 205) << "no rest was taken in";
  }
}

TEST(Release, RestsGoAndLoadsStay) { expect_rests_to_go(20); }
TEST(FurtherRelease, RestsGoAndLoadsStay) { expect_rests_to_go(200); }

}  // namespace
}  // namespace pillarfield
