#include "cli/pace/latencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pillarfield::cli {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Latencies of 1, 2, ... `solved` us, shuffled, and dropped frames.
PaceResult ramp(std::uint64_t solved, std::uint64_t dropped = 0) {
  PaceResult result;
  for (std::uint64_t i = 1; i <= solved; ++i) result.latencies.push_back(microseconds(i));
  std::shuffle(result.latencies.begin(), result.latencies.end(), std::mt19937(1));
  result.dropped = dropped;
  return result;
}

TEST(Latencies, QuantilesAreExact) {
  for (const std::uint64_t frames : {1000U, 2000U, 7000U, 100'000U}) {
    const Latencies latencies(ramp(frames));
    EXPECT_EQ(latencies.quantile(0.5), microseconds(frames / 2));
    EXPECT_EQ(latencies.quantile(0.99), microseconds(frames / 100 * 99));
    EXPECT_EQ(latencies.quantile(0.999), microseconds(frames / 1000 * 999));
    EXPECT_EQ(latencies.quantile(1), microseconds(frames));
    EXPECT_EQ(latencies.quantile(0), microseconds(1));
    EXPECT_EQ(latencies.largest(), microseconds(frames));
  }
}

TEST(Latencies, AQuantileOfFewFramesIsALatency) {
  const Latencies latencies(ramp(3));
  EXPECT_EQ(latencies.quantile(0.5), microseconds(2));
  EXPECT_EQ(latencies.quantile(0.99), microseconds(3));
}

TEST(Latencies, DroppedFramesCountAsInfinite) {
  const Latencies latencies(ramp(990, 10));
  EXPECT_EQ(latencies.quantile(0.5), microseconds(500));
  EXPECT_EQ(latencies.quantile(0.99), microseconds(990));
  EXPECT_EQ(latencies.quantile(0.999), std::nullopt);
  EXPECT_EQ(latencies.largest(), microseconds(990));
}

TEST(Latencies, WithoutFramesAreUnset) {
  const Latencies latencies{PaceResult()};
  EXPECT_EQ(latencies.quantile(0.5), std::nullopt);
  EXPECT_EQ(latencies.largest(), std::nullopt);
  EXPECT_EQ(latencies.later_than(Nanoseconds(0)), 0);
  EXPECT_TRUE(latencies.histogram().empty());
}

TEST(Latencies, AFrameAtItsDeadlineIsInTime) {
  const Latencies latencies(ramp(100));
  EXPECT_EQ(latencies.later_than(microseconds(60)), 40);
  EXPECT_EQ(latencies.later_than(microseconds(60) - Nanoseconds(1)), 41);
  EXPECT_EQ(latencies.later_than(microseconds(100)), 0);
}

TEST(Latencies, HistogramHoldsEveryFrameInTenBinsToTheDecade) {
  PaceResult result;
  std::mt19937 random(7);
  std::lognormal_distribution<double> time_ns(13, 2);
  for (int i = 0; i < 10'000; ++i) {
    result.latencies.push_back(Nanoseconds(std::llround(time_ns(random))));
  }
  std::uint64_t frames = 0;
  std::optional<Nanoseconds> edge;
  const std::vector<LatencyBin> bins = Latencies(result).histogram();
  for (const LatencyBin& bin : bins) {
    if (edge) {
      EXPECT_EQ(bin.from, *edge);
    }
    edge = bin.to;
    EXPECT_NEAR(static_cast<double>(bin.to.count()) / static_cast<double>(bin.from.count()),
                std::pow(10, 0.1), 1e-3);
    const auto inside = [&](Nanoseconds time) {
      return time < bin.to && (time >= bin.from || &bin == &bins.front());
    };
    EXPECT_EQ(bin.frames, std::ranges::count_if(result.latencies, inside));
    frames += bin.frames;
  }
  EXPECT_EQ(frames, result.solved());
  EXPECT_GT(bins.front().frames, 0);
  EXPECT_GT(bins.back().frames, 0);
}

TEST(Latencies, BinsBeginAtPowersOfTen) {
  PaceResult result;
  result.latencies = {Nanoseconds(3), milliseconds(1), milliseconds(1) - Nanoseconds(1)};
  const std::vector<LatencyBin> bins = Latencies(result).histogram();
  EXPECT_EQ(bins.size(), 31);
  EXPECT_EQ(bins.front().from, microseconds(1));
  EXPECT_EQ(bins.front().frames, 1);
  EXPECT_EQ(bins[29].to, milliseconds(1));
  EXPECT_EQ(bins[29].frames, 1);
  EXPECT_EQ(bins[30].from, milliseconds(1));
  EXPECT_EQ(bins[30].frames, 1);
}

}  // namespace
}  // namespace pillarfield::cli
