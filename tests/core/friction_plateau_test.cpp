#include "core/friction_plateau.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace pillarfield {
namespace {

constexpr double kPi = std::numbers::pi;

struct Sample {
  float ratio;
  std::uint32_t weight;
  float ceiling;
};

/// A disc under a Hertz pressure, as pillars see it: those whose ratio exceeds their ceiling are
/// ambiguous and left out.
class Disc {
 public:
  using Ratio = std::function<double(double radius)>;
  using Direction = std::function<double(double x, double y)>;

  Disc(const Ratio& ratio, const Direction& direction, double noise = 0, std::uint64_t seed = 1)
      : random_(seed) {
    constexpr int kRadius = 16;
    for (int row = -kRadius; row <= kRadius; ++row) {
      for (int col = -kRadius; col <= kRadius; ++col) {
        const double x = static_cast<double>(col) / kRadius;
        const double y = static_cast<double>(row) / kRadius;
        const double r = std::hypot(x, y);
        const double pressure = std::sqrt(std::max(0.0, 1 - r * r));
        if (pressure > 0.25) add(pressure, ratio(r), direction(x, y), noise);
      }
    }
  }

  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

  [[nodiscard]] std::optional<FrictionPlateau> plateau() const {
    FrictionHistogram histogram;
    for (const Sample& sample : samples_) {
      histogram.add(sample.ratio, sample.weight, sample.ceiling);
    }
    return histogram.plateau();
  }

 private:
  /// `noise` is that of a component of force, as a share of the peak pressure.
  void add(double pressure, double ratio, double direction, double noise) {
    std::normal_distribution<double> error(0, noise);
    const double x = pressure * ratio * std::cos(direction) + error(random_);
    const double y = pressure * ratio * std::sin(direction) + error(random_);
    const double normal = pressure + error(random_);
    const double off = std::atan2(y, x) - kPi / 4;
    const double ceiling = 1 / std::min(std::abs(std::cos(off)), std::abs(std::sin(off)));
    const double seen = std::hypot(x, y) / normal;
    if (normal <= 0 || seen > ceiling) return;
    samples_.push_back({static_cast<float>(seen), static_cast<std::uint32_t>(4000 * pressure),
                        static_cast<float>(ceiling)});
  }

  std::mt19937_64 random_;
  std::vector<Sample> samples_;
};

double around(double x, double y) { return std::atan2(y, x) + kPi / 2; }

Disc::Direction towards(double degrees) {
  return [=](double, double) { return degrees * kPi / 180; };
}

Disc::Ratio everywhere(double friction) {
  return [=](double) { return friction; };
}

/// Cattaneo and Mindlin: sticks within `stick` of the radius.
Disc::Ratio partial_slip(double friction, double stick) {
  return [=](double r) {
    if (r >= stick) return friction;
    return friction * (1 - stick * std::sqrt((stick * stick - r * r) / (1 - r * r)));
  };
}

void expect_found(const Disc& disc, double friction, double within) {
  const auto plateau = disc.plateau();
  ASSERT_TRUE(plateau.has_value()) << friction;
  EXPECT_NEAR(plateau->friction, friction, within * friction);
}

TEST(FrictionPlateau, OfASpinIsFound) {
  for (const double friction : {0.1, 0.3, 0.6, 1.0, 1.3, 1.6, 2.0}) {
    expect_found(Disc(everywhere(friction), around), friction, 1e-4);
  }
}

TEST(FrictionPlateau, OfASlideIsFoundBelowTheCeiling) {
  expect_found(Disc(everywhere(1.2), towards(45)), 1.2, 1e-4);
  expect_found(Disc(everywhere(1.2), towards(135)), 1.2, 1e-4);
  expect_found(Disc(everywhere(4), towards(225)), 4, 1e-4);
  expect_found(Disc(everywhere(1.0), towards(0)), 1.0, 1e-4);
  expect_found(Disc(everywhere(0.5), towards(77)), 0.5, 1e-4);
}

TEST(FrictionPlateau, AtTheCeilingIsNone) {
  EXPECT_FALSE(Disc(everywhere(1.35), towards(0)).plateau());
  EXPECT_FALSE(Disc(everywhere(1.41), towards(90)).plateau());
  EXPECT_FALSE(Disc(everywhere(3), towards(0)).plateau());  // all ambiguous
}

/// The core that readings resolve ends at sqrt(2), because they end there.
TEST(FrictionPlateau, ResolvedCoreOfPartialSlipShowsNone) {
  for (const double friction : {1.5, 1.7, 2.0, 3.0}) {
    for (const double stick : {0.3, 0.5, 0.7, 0.9}) {
      for (const double noise : {0.0, 0.01, 0.03}) {
        for (const double degrees : {0.0, 90.0, 180.0, 3.0}) {
          const Disc disc(partial_slip(friction, stick), towards(degrees), noise);
          EXPECT_FALSE(disc.plateau()) << friction << " " << stick << " " << degrees;
        }
      }
    }
  }
}

/// Along a diagonal the annulus that slips is resolved too, and shows its friction where it bears
/// enough.
TEST(FrictionPlateau, AnnulusOfPartialSlipIsFoundAlongADiagonal) {
  expect_found(Disc(partial_slip(1.2, 0.5), towards(45)), 1.2, 0.02);
  expect_found(Disc(partial_slip(0.8, 0.6), towards(0)), 0.8, 0.02);
}

TEST(FrictionPlateau, OfAPressIsNone) {
  EXPECT_FALSE(Disc(everywhere(0), towards(0)).plateau());
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    for (const double noise : {0.003, 0.01, 0.03, 0.1}) {
      EXPECT_FALSE(Disc(everywhere(0), towards(0), noise, seed).plateau()) << noise;
    }
  }
}

TEST(FrictionPlateau, RatiosThatOnlyRiseAreNone) {
  EXPECT_FALSE(Disc([](double r) { return r; }, around).plateau());
  EXPECT_FALSE(Disc([](double r) { return r * r; }, around).plateau());
  EXPECT_FALSE(Disc([](double r) { return 1 - r; }, around).plateau());
}

TEST(FrictionPlateau, StandsNoise) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    expect_found(Disc(everywhere(0.8), around, 0.01, seed), 0.8, 0.01);
    expect_found(Disc(everywhere(0.8), around, 0.02, seed), 0.8, 0.02);
    expect_found(Disc(everywhere(1.2), towards(45), 0.02, seed), 1.2, 0.02);
    expect_found(Disc(everywhere(1.6), around, 0.01, seed), 1.6, 0.02);
  }
}

TEST(FrictionPlateau, IsTheSameBitsInAnyOrder) {
  std::vector<Sample> samples = Disc(partial_slip(0.8, 0.3), around, 0.01).samples();
  std::mt19937_64 random(3);
  std::optional<FrictionPlateau> first;
  FrictionHistogram histogram;
  for (int turn = 0; turn < 20; ++turn) {
    histogram.clear();
    for (const Sample& sample : samples) histogram.add(sample.ratio, sample.weight, sample.ceiling);
    const auto plateau = histogram.plateau();
    ASSERT_TRUE(plateau.has_value());
    if (!first) first = plateau;
    EXPECT_EQ(plateau->friction, first->friction);
    EXPECT_EQ(plateau->share, first->share);
    std::shuffle(samples.begin(), samples.end(), random);
  }
}

TEST(FrictionPlateau, ShareIsOfAllThatWasAdded) {
  FrictionHistogram histogram;
  for (int i = 0; i < 30; ++i) histogram.add(0.5F, 1000, 2);
  for (int i = 0; i < 10; ++i) histogram.add(0.01F, 1000, 2);
  const auto plateau = histogram.plateau();
  ASSERT_TRUE(plateau.has_value());
  EXPECT_NEAR(plateau->friction, 0.5, 1e-5);
  EXPECT_DOUBLE_EQ(plateau->share, 0.75);
}

TEST(FrictionPlateau, FewPillarsShowNone) {
  FrictionHistogram histogram;
  EXPECT_FALSE(histogram.plateau());
  for (int i = 0; i < 7; ++i) histogram.add(0.5F, 1000, 2);
  EXPECT_FALSE(histogram.plateau());
  histogram.add(0.5F, 1000, 2);
  EXPECT_TRUE(histogram.plateau());
  histogram.clear();
  EXPECT_FALSE(histogram.plateau());
}

TEST(FrictionPlateau, TakesAnyNumber) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  FrictionHistogram histogram;
  for (const float ratio :
       {kNan, kInfinity, -kInfinity, -1.0F, 0.0F, 1e-40F, 1e38F, 32.0F, std::nextafter(32.0F, 0.0F),
        1.0F / 32, std::nextafter(1.0F / 32, 0.0F)}) {
    for (const float ceiling : {kNan, kInfinity, -kInfinity, -1.0F, 0.0F, 1.0F, 1e38F}) {
      histogram.add(ratio, 0, ceiling);
      histogram.add(ratio, UINT32_MAX, ceiling);
    }
  }
  (void)histogram.plateau();
}

}  // namespace
}  // namespace pillarfield
