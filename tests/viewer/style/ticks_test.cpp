#include "viewer/style/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>

namespace pillarfield::viewer {
namespace {

std::vector<std::string> labels(double low, double high, int most) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks(low, high, most)) labels.push_back(tick.label);
  return labels;
}

using Labels = std::vector<std::string>;

/// Number of a label, which has a Unicode minus sign.
double number_of(std::string label) {
  const std::string minus = "\u2212";
  for (auto at = label.find(minus); at != std::string::npos; at = label.find(minus)) {
    label.replace(at, minus.size(), "-");
  }
  return std::strtod(label.c_str(), nullptr);
}

bool is_nice(double value) {
  const double exponent = std::floor(std::log10(value) + 1e-7);
  const double mantissa = value / std::pow(10, exponent);
  return std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
         std::abs(mantissa - 5) < 1e-6;
}

struct Axis {
  double low, high;
  int most;
};

Axis random_axis(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_real_distribution<double> logarithm(-8, 8);
  const double size = std::pow(10, logarithm(random));
  const double low = size * 20 * place(random);
  return {low, low + size * (0.1 + std::abs(place(random))),
          std::uniform_int_distribution(1, 12)(random)};
}

TEST(Ticks, LieEvenlyWithinTheAxisAndAreNotTooMany) {
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    const auto [low, high, most] = random_axis(random);
    const std::vector<Tick> marks = ticks(low, high, most);
    EXPECT_LE(marks.size(), static_cast<std::size_t>(most));
    for (const Tick& tick : marks) {
      EXPECT_GE(tick.value, low);
      EXPECT_LE(tick.value, high);
    }
    if (marks.size() < 2) continue;
    const double step = marks[1].value - marks[0].value;
    EXPECT_TRUE(is_nice(step)) << step;
    for (std::size_t k = 2; k < marks.size(); ++k) {
      EXPECT_NEAR(marks[k].value - marks[k - 1].value, step, 1e-9 * step + 1e-14 * std::abs(high));
    }
  }
}

TEST(Ticks, AreAsManyAsMayBe) {
  std::mt19937 random(4);
  for (int i = 0; i < 3000; ++i) {
    const auto [low, high, most] = random_axis(random);
    if (most < 5) continue;
    // The next finer steps are at most 2.5 times as many and do not fit.
    EXPECT_GE(ticks(low, high, most).size(), static_cast<std::size_t>((most + 1) / 2.5) - 1);
  }
}

TEST(Ticks, LabelsSayTheValueAndDiffer) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    const auto [low, high, most] = random_axis(random);
    std::set<std::string> seen;
    for (const Tick& tick : ticks(low, high, most)) {
      EXPECT_EQ(number_of(tick.label), tick.value) << tick.label;
      EXPECT_TRUE(seen.insert(tick.label).second) << tick.label;
      EXPECT_EQ(tick.label.find('-'), std::string::npos);
    }
  }
}

TEST(Ticks, HaveTheExpectedLabels) {
  EXPECT_EQ(labels(0, 1, 6), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(0, 0.3, 4), (Labels{"0", "0.1", "0.2", "0.3"})) << "both ends";
  EXPECT_EQ(labels(-2, 2, 5), (Labels{"−2", "−1", "0", "1", "2"}));
  EXPECT_EQ(labels(-180, 180, 9), (Labels{"−150", "−100", "−50", "0", "50", "100", "150"}));
  EXPECT_EQ(labels(0, 0.05, 6), (Labels{"0", "0.01", "0.02", "0.03", "0.04", "0.05"}));
  EXPECT_EQ(labels(0, 1000, 3), (Labels{"0", "500", "1000"}));
  EXPECT_EQ(labels(0, 2e7, 5), (Labels{"0", "5e6", "1e7", "1.5e7", "2e7"}));
  EXPECT_EQ(labels(-1e-7, 1e-7, 3), (Labels{"−1e−7", "0", "1e−7"}));
  EXPECT_EQ(labels(3.1, 3.9, 1), (Labels{"3.5"}));
}

TEST(NiceCeiling, IsTheLeastNiceNumberNotBelow) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> logarithm(-290, 290);
  for (int i = 0; i < 5000; ++i) {
    const double value = std::pow(10, logarithm(random));
    const double nice = nice_ceiling(value);
    EXPECT_TRUE(is_nice(nice)) << nice;
    EXPECT_GE(nice, value);
    EXPECT_LE(nice, 2.5 * value * (1 + 1e-12));
    EXPECT_EQ(nice_ceiling(nice), nice);
  }
}

TEST(NiceCeiling, KeepsNiceNumbersAsTheyAreWritten) {
  for (const double nice :
       {0.001, 0.002, 0.005, 0.01, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 1000.0, 5e22}) {
    EXPECT_EQ(nice_ceiling(nice), nice);
    EXPECT_GT(nice_ceiling(std::nextafter(nice, 1e300)), 1.9 * nice);
  }
}

TEST(RoundCeiling, IsNearAndKeepsItsOwn) {
  for (int step = -442; step <= 442; ++step) {
    const double value = std::pow(1.0371, step);  // 1e-7 to 1e7
    const double round = round_ceiling(value);
    EXPECT_GE(round, value);
    EXPECT_LE(round, 1.3334 * value);
    EXPECT_EQ(round_ceiling(round), round);
    EXPECT_LE(round, nice_ceiling(value));
  }
  for (const double round : {0.012, 0.1, 0.15, 0.25, 3.0, 4.0, 60.0, 8e5}) {
    EXPECT_EQ(round_ceiling(round), round);
  }
}

TEST(ThreeDigits, AreThreeAndRounded) {
  EXPECT_EQ(three_digits(0.01234), "0.0123");
  EXPECT_EQ(three_digits(12.345), "12.3");
  EXPECT_EQ(three_digits(1234), "1230");
  EXPECT_EQ(three_digits(1.5), "1.50");
  EXPECT_EQ(three_digits(999.6), "1000") << "a digit more by rounding";
  EXPECT_EQ(three_digits(0.09996), "0.100");
  EXPECT_EQ(three_digits(-0.5), "−0.500");
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(-0.0), "0");
  EXPECT_EQ(three_digits(0.0001), "0.000100");
  EXPECT_EQ(three_digits(0.00001234), "1.23e−5");
  EXPECT_EQ(three_digits(9994000), "9990000");
  EXPECT_EQ(three_digits(-12345678), "−1.23e7");
  EXPECT_EQ(three_digits(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(three_digits(std::numeric_limits<double>::infinity()), "–");
}

TEST(ThreeDigits, AreWithinHalfOfTheLastDigit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> logarithm(-12, 12);
  for (int i = 0; i < 5000; ++i) {
    const double value = (i % 2 == 0 ? 1 : -1) * std::pow(10, logarithm(random));
    EXPECT_NEAR(number_of(three_digits(value)) / value, 1, 0.00501) << value;
  }
}

}  // namespace
}  // namespace pillarfield::viewer
