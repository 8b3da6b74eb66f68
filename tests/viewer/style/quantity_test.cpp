#include "viewer/style/quantity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "made_up_field.h"
#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

using status::kAmbiguous;
using status::kFromNeighbours;
using status::kInconsistent;
using status::kSaturated;
using status::kSensel1;
using status::kSensel2;
using status::kSensel3;
using status::kSensel4;
using status::kUsable;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Quantity kOfPlanes[] = {Quantity::normal,  Quantity::shear,      Quantity::shear_x,
                                  Quantity::shear_y, Quantity::magnitude,  Quantity::theta,
                                  Quantity::phi,     Quantity::uncertainty};

TEST(Info, EveryQuantityIsFoundByItsOwnName) {
  std::set<std::string> titles;
  for (int i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    EXPECT_EQ(quantity_named(info_of(quantity).name), quantity);
    titles.insert(info_of(quantity).title);
  }
  EXPECT_EQ(titles.size(), std::size_t{kQuantities});
  EXPECT_EQ(quantity_named("shear_y"), Quantity::shear_y);
  EXPECT_EQ(quantity_named("parity"), Quantity::parity);
  EXPECT_EQ(quantity_named("Shear"), std::nullopt);
  EXPECT_EQ(quantity_named(""), std::nullopt);
}

TEST(Info, AnglesAreDisplayedInDegrees) {
  for (const Quantity quantity : {Quantity::theta, Quantity::phi}) {
    EXPECT_STREQ(info_of(quantity).unit, "°");
    EXPECT_DOUBLE_EQ(info_of(quantity).factor * std::numbers::pi, 180);
  }
  EXPECT_STREQ(info_of(Quantity::uncertainty).unit, "N");
  EXPECT_STREQ(info_of(Quantity::parity).unit, "counts");
  EXPECT_STREQ(info_of(Quantity::region).unit, "");
  EXPECT_EQ(info_of(Quantity::normal).factor, 1);
}

TEST(Info, ScalesSuitTheValues) {
  EXPECT_EQ(info_of(Quantity::normal).scale, Scale::sequential);
  EXPECT_EQ(info_of(Quantity::theta).scale, Scale::sequential);
  EXPECT_EQ(info_of(Quantity::shear_x).scale, Scale::diverging);
  EXPECT_EQ(info_of(Quantity::parity).scale, Scale::diverging);
  EXPECT_EQ(info_of(Quantity::phi).scale, Scale::cyclic);
  EXPECT_EQ(info_of(Quantity::region).scale, Scale::classes);
  EXPECT_EQ(info_of(Quantity::status).scale, Scale::classes);
}

TEST(Availability, FollowsWhatTheSourceHas) {
  SourceInfo source;
  const auto available = [&] {
    std::set<Quantity> found;
    for (int i = 0; i < kQuantities; ++i) {
      if (is_available(static_cast<Quantity>(i), source)) found.insert(static_cast<Quantity>(i));
    }
    return found;
  };
  const std::set<Quantity> always = {Quantity::normal,  Quantity::shear,  Quantity::shear_x,
                                     Quantity::shear_y, Quantity::region, Quantity::status,
                                     Quantity::peak};
  EXPECT_EQ(available(), always);
  source.has_angles = true;
  EXPECT_EQ(available().size(), always.size() + 3);
  EXPECT_TRUE(available().contains(Quantity::phi));
  source.has_uncertainty = true;
  EXPECT_TRUE(available().contains(Quantity::uncertainty));
  EXPECT_FALSE(available().contains(Quantity::parity));
  source.has_readings = true;
  EXPECT_EQ(available().size(), std::size_t{kQuantities});
}

TEST(StatusClasses, ReportTheWorst) {
  EXPECT_EQ(status_class(kUsable), StatusClass::determined);
  EXPECT_EQ(status_class(kSensel1 | kSensel2 | kAmbiguous), StatusClass::ambiguous);
  EXPECT_EQ(status_class(kAmbiguous | kFromNeighbours), StatusClass::from_contact);
  EXPECT_EQ(status_class(kUsable | kAmbiguous | kFromNeighbours | kSaturated),
            StatusClass::saturated);
  EXPECT_EQ(status_class(0xFF), StatusClass::inconsistent);
  EXPECT_TRUE(is_pressed(kSensel3));
  EXPECT_TRUE(is_pressed(kSaturated));
  EXPECT_FALSE(is_pressed(kInconsistent | kAmbiguous));
}

TEST(Value, IsThatOfThePlaneAtRowAndColumn) {
  MadeUpField made_up;
  made_up.normal[4] = 3;
  made_up.shear_x[4] = -0.5F;
  made_up.shear_y[4] = 0.25F;
  made_up.magnitude[4] = 4;
  made_up.theta[4] = 0.7F;
  made_up.phi[4] = -2;
  const ShownField field = made_up.shown();
  EXPECT_EQ(value_of(Quantity::normal, field, 1, 1), 3);
  EXPECT_EQ(value_of(Quantity::shear_x, field, 1, 1), -0.5F);
  EXPECT_EQ(value_of(Quantity::shear_y, field, 1, 1), 0.25F);
  EXPECT_EQ(value_of(Quantity::magnitude, field, 1, 1), 4);
  EXPECT_EQ(value_of(Quantity::theta, field, 1, 1), 0.7F);
  EXPECT_EQ(value_of(Quantity::phi, field, 1, 1), -2);
  EXPECT_EQ(value_of(Quantity::normal, field, 1, 0), 0);
  EXPECT_EQ(value_of(Quantity::normal, field, 0, 1), 0);
}

TEST(Value, ShearIsTheRootOfTheSumOfSquaresInSinglePrecision) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> newtons(-3, 3);
  MadeUpField made_up(1, 1);
  for (int i = 0; i < 1000; ++i) {
    const float x = made_up.shear_x[0] = newtons(random);
    const float y = made_up.shear_y[0] = newtons(random);
    const volatile float x_squared = x * x;
    const volatile float y_squared = y * y;
    const volatile float sum = x_squared + y_squared;
    EXPECT_EQ(value_of(Quantity::shear, made_up.shown(), 0, 0), std::sqrt(float{sum}));
  }
}

TEST(Value, UncertaintyIsTheRootOfTheVariances) {
  MadeUpField made_up(1, 1);
  made_up.uncertainty[Uncertainty::shear_x] = {2};
  made_up.uncertainty[Uncertainty::shear_y] = {3};
  made_up.uncertainty[Uncertainty::normal] = {6};
  made_up.uncertainty[Uncertainty::magnitude_low] = {10};
  made_up.uncertainty[Uncertainty::magnitude_high] = {40};
  EXPECT_EQ(value_of(Quantity::uncertainty, made_up.shown(), 0, 0), 7) << "not ambiguous";
  made_up.status[0] = kSensel1 | kSensel2 | kAmbiguous;
  EXPECT_EQ(value_of(Quantity::uncertainty, made_up.shown(), 0, 0), 15) << "half the span";
  made_up.uncertainty[Uncertainty::magnitude_low] = {39};
  EXPECT_EQ(value_of(Quantity::uncertainty, made_up.shown(), 0, 0), 7) << "noise is more";
}

TEST(Value, RegionAndStatusAreSmallWholeNumbers) {
  MadeUpField made_up(1, 1);
  const auto values = [&](int status) {
    made_up.status[0] = static_cast<std::uint8_t>(status);
    return std::pair(value_of(Quantity::region, made_up.shown(), 0, 0),
                     value_of(Quantity::status, made_up.shown(), 0, 0));
  };
  EXPECT_EQ(values(kUsable), std::pair(1.0F, 0.0F));
  EXPECT_EQ(values(kSensel1 | kSensel2 | kSensel3 | kSaturated), std::pair(2.0F, 3.0F));
  EXPECT_EQ(values(kSensel1 | kSensel2 | kAmbiguous), std::pair(3.0F, 1.0F));
  EXPECT_EQ(values(kSensel2 | kFromNeighbours), std::pair(4.0F, 2.0F));
  EXPECT_EQ(values(kSensel2 | kSensel4 | kInconsistent), std::pair(5.0F, 4.0F));
  EXPECT_TRUE(std::isnan(values(kInconsistent).first));
  EXPECT_EQ(values(kInconsistent).second, 4) << "a fault without contact";
  EXPECT_TRUE(std::isnan(values(0).first));
  EXPECT_TRUE(std::isnan(values(0).second));
  EXPECT_TRUE(std::isnan(values(kAmbiguous).second));
}

TEST(Value, IsNoneWhereThePillarIsIdle) {
  MadeUpField made_up;
  made_up.normal.assign(6, 1);
  made_up.status = {0, kAmbiguous, kInconsistent, kSaturated, kSensel4, kUsable};
  for (const Quantity quantity : kOfPlanes) {
    for (std::uint32_t pillar = 0; pillar < 6; ++pillar) {
      const float value = value_of(quantity, made_up.shown(), pillar / 3, pillar % 3);
      EXPECT_EQ(std::isnan(value), pillar < 3) << info_of(quantity).name << " of " << pillar;
    }
  }
}

TEST(Value, IsNoneWhereTheSourceLacksIt) {
  MadeUpField made_up;
  ShownField field = made_up.shown();
  field.forces.magnitude = field.forces.theta = field.forces.phi = {};
  field.forces.uncertainty = {};
  for (const Quantity quantity : {Quantity::magnitude, Quantity::theta, Quantity::phi,
                                  Quantity::uncertainty, Quantity::parity}) {
    EXPECT_TRUE(std::isnan(value_of(quantity, field, 1, 2))) << info_of(quantity).name;
    EXPECT_EQ(largest(quantity, field), 0) << info_of(quantity).name;
  }
}

/// Distinct readings of sensel n of the pillar at (r, c).
template <class Reading>
Reading reading_at(std::uint32_t r, std::uint32_t c, int n) {
  return static_cast<Reading>((r * 3 + c) * 7 + static_cast<std::uint32_t>(n * n * n));
}

template <class Reading>
void expect_parity(SenselType type, std::size_t stride) {
  const MadeUpField made_up;
  std::vector<Reading> readings(4 * stride, Reading{99});
  for (std::uint32_t r = 0; r < 2; ++r) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::size_t upper_left = std::size_t{2} * r * stride + std::size_t{2} * c;
      readings[upper_left] = reading_at<Reading>(r, c, 2);
      readings[upper_left + 1] = reading_at<Reading>(r, c, 1);
      readings[upper_left + stride] = reading_at<Reading>(r, c, 3);
      readings[upper_left + stride + 1] = reading_at<Reading>(r, c, 4);
    }
  }
  // Only one, so that the pillars differ.
  readings[3 * stride + 5] = Reading{200};
  ShownField field = made_up.shown();
  field.raw = {readings.data(), type, 4, 6, stride};
  for (std::uint32_t r = 0; r < 2; ++r) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const auto v4 = static_cast<float>(r == 1 && c == 2 ? 200 : reading_at<int>(r, c, 4));
      const auto others = static_cast<float>(reading_at<int>(r, c, 1) + reading_at<int>(r, c, 3) -
                                             reading_at<int>(r, c, 2));
      EXPECT_EQ(value_of(Quantity::parity, field, r, c), others - v4) << r << " " << c;
    }
  }
  EXPECT_EQ(largest(Quantity::parity, field), 200 - (5 * 7 + 1 + 27 - 8));
}

TEST(Value, ParityIsThatOfReadingsOfAllTypes) {
  for (const std::size_t stride : {std::size_t{6}, std::size_t{7}, std::size_t{64}}) {
    expect_parity<std::uint8_t>(SenselType::u8, stride);
    expect_parity<std::uint16_t>(SenselType::u16, stride);
    expect_parity<float>(SenselType::f32, stride);
  }
}

TEST(Value, ParityOfTheLargestWholeReadingsIsExact) {
  const MadeUpField made_up(1, 1);
  const std::uint16_t readings[] = {0, 65535, 65535, 1};
  ShownField field = made_up.shown();
  field.raw = {readings, SenselType::u16, 2, 2, 2};
  EXPECT_EQ(value_of(Quantity::parity, field, 0, 0), 131069);
}

TEST(Largest, IsOverDeterminedAndAmbiguousPillars) {
  MadeUpField made_up;
  made_up.shear_x = {1, -4, 9, 16, 25, 36};
  made_up.status = {kUsable,
                    kSensel1 | kSensel2 | kAmbiguous,
                    0,
                    kUsable | kSaturated,
                    kUsable | kInconsistent,
                    kInconsistent};
  EXPECT_EQ(largest(Quantity::shear_x, made_up.shown()), 4);
  EXPECT_EQ(largest(Quantity::region, made_up.shown()), 3);
  made_up.status.assign(6, 0);
  EXPECT_EQ(largest(Quantity::shear_x, made_up.shown()), 0);
}

TEST(Largest, SkipsValuesThatAreNotFinite) {
  MadeUpField made_up;
  made_up.normal = {kNan, kInfinity, 2, -kInfinity, 1, kNan};
  EXPECT_EQ(largest(Quantity::normal, made_up.shown()), 2);
}

TEST(FittingRange, IsNotBelowTheLargestAndNotFarAbove) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> logarithm(-20, 20);
  for (int i = 0; i < 5000; ++i) {
    const float seen = std::pow(10.0F, logarithm(random));
    const Range sequential = fitting_range(Quantity::normal, seen);
    EXPECT_EQ(sequential.low, 0);
    EXPECT_GE(sequential.high, seen);
    EXPECT_LE(sequential.high, 1.34F * seen);
    const Range diverging = fitting_range(Quantity::shear_y, seen);
    EXPECT_EQ(diverging.low, -diverging.high);
    EXPECT_EQ(diverging.high, sequential.high);
    EXPECT_EQ(fitting_range(Quantity::normal, sequential.high).high, sequential.high)
        << "a range fits itself";
  }
}

TEST(FittingRange, IsRound) {
  EXPECT_EQ(fitting_range(Quantity::normal, 0.29F).high, 0.3F);
  EXPECT_EQ(fitting_range(Quantity::normal, 0.1F).high, 0.1F);
  EXPECT_EQ(fitting_range(Quantity::normal, std::nextafter(0.1F, 1.0F)).high, 0.12F);
  EXPECT_EQ(fitting_range(Quantity::normal, 7).high, 8);
  EXPECT_EQ(fitting_range(Quantity::parity, 130).high, 150);
}

TEST(FittingRange, OfAnglesAndClassesIsFixed) {
  for (const float seen : {0.0F, 0.4F, 9.0F}) {
    EXPECT_FLOAT_EQ(fitting_range(Quantity::theta, seen).high, 1.57079633F);
    EXPECT_EQ(fitting_range(Quantity::theta, seen).low, 0);
    EXPECT_FLOAT_EQ(fitting_range(Quantity::phi, seen).high, 3.14159265F);
    EXPECT_FLOAT_EQ(fitting_range(Quantity::phi, seen).low, -3.14159265F);
    EXPECT_EQ(fitting_range(Quantity::region, seen).high, 6);
    EXPECT_EQ(fitting_range(Quantity::status, seen).high, 5);
  }
}

TEST(FittingRange, IsUsableWhateverWasSeen) {
  for (const float seen : {0.0F, kNan, kInfinity, -kInfinity, -1.0F}) {
    EXPECT_EQ(fitting_range(Quantity::normal, seen).high, 1) << seen;
  }
  for (const float seen : {1e-45F, 3.4e38F}) {
    const Range range = fitting_range(Quantity::shear_x, seen);
    EXPECT_GT(range.high, 0);
    EXPECT_TRUE(std::isfinite(range.high - range.low)) << seen;
  }
}

}  // namespace
}  // namespace pillarfield::viewer
