#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace pillarfield::random {
namespace {

/// The test vectors of the method's authors.
TEST(Random, PhiloxGivesThePublishedWords) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

std::vector<float> normal_row(const Row& row, std::size_t count) {
  std::vector<float> values(count);
  fill_normal(row, values);
  return values;
}

/// The method of Box and Muller in double precision, from the words of philox() one by one.
TEST(Random, NormalVariatesAreThoseOfTheirWords) {
  constexpr std::uint64_t kFrame = (7ULL << 32) + 5;
  const std::vector<float> values = normal_row({11ULL << 32, Stream::noise, kFrame, 3}, 40003);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Block words = philox({(3U << 16) | static_cast<std::uint32_t>(i / 4),
                                static_cast<std::uint32_t>(Stream::noise), 5, 7},
                               {0, 11});
    const std::size_t pair = i % 4 / 2 * 2;
    const double radius = std::sqrt(-2 * std::log(((words[pair] >> 8) + 1) * 0x1p-24));
    const double angle = 2 * std::numbers::pi * (words[pair + 1] >> 8) * 0x1p-24;
    const double expected = radius * (i % 2 == 0 ? std::cos(angle) : std::sin(angle));
    ASSERT_NEAR(double{values[i]}, expected, 4e-7 * std::max(1.0, radius)) << i;
  }
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += double{a[i]} * double{b[i]};
  return sum / static_cast<double>(std::min(a.size(), b.size()));
}

TEST(Random, SeedsStreamsFramesRowsAndNeighboursAreIndependent) {
  constexpr std::size_t kCount = 60000;
  const Row row{1, Stream::noise, 0, 0};
  const std::vector<float> values = normal_row(row, kCount);
  for (const Row& other : {Row{2, Stream::noise, 0, 0}, Row{1ULL << 40, Stream::noise, 0, 0},
                           Row{1, Stream::tare, 0, 0}, Row{1, Stream::noise, 1, 0},
                           Row{1, Stream::noise, 1ULL << 33, 0}, Row{1, Stream::noise, 0, 1}}) {
    EXPECT_NEAR(correlation(values, normal_row(other, kCount)), 0, 5 / std::sqrt(kCount));
  }
  for (const std::ptrdiff_t lag : {1, 2, 3, 4}) {
    EXPECT_NEAR(correlation(values, {values.begin() + lag, values.end()}), 0,
                5 / std::sqrt(kCount));
  }
}

TEST(Random, UniformVariatesFillTheUnitInterval) {
  std::vector<double> values(60000);
  fill_uniform({3, Stream::dead, 0, 7}, values);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*least, 0);
  EXPECT_LT(*most, 1);
  for (const double share : {0.001, 0.1, 0.5, 0.9}) {
    const auto below =
        std::count_if(values.begin(), values.end(), [=](double value) { return value < share; });
    EXPECT_NEAR(static_cast<double>(below) / 60000, share, 5 * std::sqrt(share / 60000));
  }
}

}  // namespace
}  // namespace pillarfield::random
