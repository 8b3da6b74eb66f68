// When a contact is foretold to slide, on ramps and holds of its ratio of shear to normal force.

#include "contacts/slip_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace pillarfield {
namespace {

constexpr double kFriction = 1;
constexpr double kDeviation = 0.05;

SlipForecast after(double seconds, double rate_hz, const std::function<double(double)>& ratio) {
  SlipTrend trend;
  for (int frame = 0; frame / rate_hz <= seconds; ++frame) {
    const double t = frame / rate_hz;
    trend.add(t, ratio(t) + 0.002 * std::sin(7.3 * frame));
  }
  return trend.forecast(kFriction, kDeviation).value();
}

TEST(SlipTrend, FollowsARamp) {
  for (const double rate_hz : {20.0, 100.0, 1000.0}) {
    const SlipForecast found = after(1, rate_hz, [](double t) { return 0.5 * t; });
    EXPECT_NEAR(found.time_s.value(), 1, 0.06) << rate_hz;
    EXPECT_LT(found.low_s.value(), 1);
    EXPECT_GT(found.high_s.value(), 1);
    EXPECT_LT(found.probability[0], 0.01);
    EXPECT_NEAR(found.probability[2], 0.5, 0.15);
    // The ends of the interval are where the probability is 2.5 and 97.5 %.
    const double sigma = 0.4 * 0.5 * *found.low_s;
    EXPECT_NEAR((0.5 + 0.5 * *found.low_s - 1) / std::hypot(kDeviation, sigma), -1.96, 0.2);
  }
}

TEST(SlipTrend, DoesNotAlarmInHolds) {
  const auto steady = [](double t) { return std::min(0.6, 2 * t); };
  const auto swinging = [](double t) { return 0.55 + 0.2 * std::sin(2 * M_PI * 1.5 * t); };
  for (int twentieth = 20; twentieth < 60; ++twentieth) {
    const double seconds = 0.05 * twentieth;
    EXPECT_LT(after(seconds, 50, steady).probability[1], 0.01) << seconds;
    EXPECT_LT(after(seconds, 50, swinging).probability[1], 0.5) << seconds;
  }
  EXPECT_FALSE(after(3, 50, [](double t) { return 0.6 - 0.1 * t; }).time_s);
}

TEST(SlipTrend, HasNoTimeWhileTheLoadRestsOrMaySwing) {
  for (int frame = 40; frame < 100; ++frame) {
    const SlipForecast rests = after(0.02 * frame, 50, [](double) { return 0.6; });
    EXPECT_FALSE(rests.time_s || rests.low_s || rests.high_s) << frame;
  }
  const auto swung = [](double t) { return 0.4 + 0.3 * std::sin(2 * M_PI * t); };
  const SlipForecast swings = after(2.1, 50, swung);
  EXPECT_FALSE(swings.time_s || swings.high_s);
  EXPECT_LT(swings.low_s.value(), 0.6 / 1.5);
}

/// The interval, stated from the seventh frame after a rest, a fall or a swing on, holds the time.
TEST(SlipTrend, FollowsARampAfterARestAndAfterASwing) {
  constexpr double kStartS = 2;
  constexpr double kRate = 0.8;
  const auto rest = [](double t) { return 0.2 + kRate * std::max(t - kStartS, 0.0); };
  const auto fall = [](double t) { return 0.2 + kRate * std::abs(t - kStartS) / 2; };
  const auto swing = [&](double t) {
    return rest(t) + (t < kStartS ? 0.1 * std::sin(2 * M_PI * t) : 0.0);
  };
  for (const auto& ratio : std::vector<std::function<double(double)>>{rest, fall, swing}) {
    for (int frame = 4; frame < 20; ++frame) {
      const double t = kStartS + frame / 30.0;
      const SlipForecast found = after(t + 1e-9, 30, ratio);
      const double rate = (ratio(t) - ratio(t - 1e-3)) / 1e-3;
      const double left_s = (kFriction - ratio(t)) / rate;
      EXPECT_TRUE(found.low_s || frame < 7) << frame;
      EXPECT_LT(found.low_s.value_or(0), left_s) << frame;
      EXPECT_GT(found.high_s.value_or(1e9), left_s) << frame;
      if (left_s < 0.25) {
        EXPECT_GT(found.probability[1], 0.5) << frame;
      }
    }
  }
}

/// Probabilities under any load do not fall with the horizon.
TEST(SlipTrend, ProbabilitiesDoNotFallWithTheHorizon) {
  std::mt19937 random(1);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int history = 0; history < 2000; ++history) {
    SlipTrend trend;
    const double slope = draw(-3, 3);
    const double noise = std::pow(10, draw(-4, 0));
    double time_s = draw(-1e3, 1e3);
    for (int frame = 0; frame < 40; ++frame) {
      time_s += std::pow(10, draw(-4, 0));
      trend.add(time_s, std::abs(slope * time_s + draw(0, noise)));
      const auto found = trend.forecast(draw(0.05, 3), std::pow(10, draw(-3, 0)));
      if (!found) continue;
      const auto& [tenth, third, whole] = found->probability;
      ASSERT_TRUE(0 <= tenth && tenth <= third && third <= whole && whole <= 1) << history;
      ASSERT_TRUE(found->time_s != 0 || tenth >= 0.5) << history;
    }
  }
}

TEST(SlipTrend, NeedsFourFramesOfOneClock) {
  SlipTrend trend;
  for (const double t : {0.0, 0.1, 0.2, 0.2, 0.3, 0.4}) {
    trend.add(t, t);
    EXPECT_FALSE(trend.forecast(kFriction, kDeviation)) << t;
  }
  trend.add(0.5, 0.5);
  EXPECT_TRUE(trend.forecast(kFriction, kDeviation));
}

}  // namespace
}  // namespace pillarfield
