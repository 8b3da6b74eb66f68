#include "viewer/source/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A field of random forces and status bytes, with u16 readings that encode their position.
class Sample {
 public:
  Sample(std::uint32_t rows, std::uint32_t cols)
      : forces_(rows, cols), raw_(SenselType::u16, 2 * rows + 1, 2 * cols + 1) {
    std::mt19937 random(rows * 100 + cols);
    std::uniform_real_distribution<float> force(-1, 1);
    for (std::size_t i = 0; i < forces_.elements(); ++i) {
      forces_.shear_x[i] = force(random);
      forces_.shear_y[i] = force(random);
      forces_.normal[i] = 1 + force(random);
      forces_.status[i] = static_cast<std::uint8_t>(random() % 256);
      if (random() % 3 == 0) forces_.status[i] &= 0xF0;
    }
    std::uint16_t place = 0;
    for (std::uint16_t& reading : raw_.readings<std::uint16_t>()) reading = place++;
  }

  [[nodiscard]] ShownField shown() const {
    ShownField field;
    field.forces = forces_.view();
    field.raw = raw_.view();
    return field;
  }
  ForceField& forces() { return forces_; }

 private:
  ForceField forces_;
  FrameBuffer raw_;
};

TEST(ValuesAt, ASenselHasTheReadingOfItsPlaceAndNormalForceAlone) {
  ForceField forces;
  forces.rows = 5;
  forces.cols = 7;
  forces.normal.assign(35, 0);
  forces.status.assign(35, status::kSensel1);
  forces.uncertainty[Uncertainty::normal].assign(35, 0.125F);
  FrameBuffer raw(SenselType::u16, 5, 7);
  for (std::uint16_t place = 0; place < 35; ++place) {
    forces.normal[place] = 0.5F * place;
    raw.readings<std::uint16_t>()[place] = static_cast<std::uint16_t>(1000 + place);
  }
  ShownField field;
  field.forces = forces.view();
  field.raw = raw.view();
  const PillarValues values = values_at(field, {4, 6});
  EXPECT_FALSE(values.has_pillars);
  EXPECT_EQ(values.readings[0], 1034);
  EXPECT_TRUE(std::isnan(values.readings[1]));
  EXPECT_EQ(values.normal, 17);
  ASSERT_TRUE(values.uncertainty);
  const auto deviation = [&](Uncertainty plane) {
    return (*values.uncertainty)[static_cast<std::size_t>(plane)];
  };
  EXPECT_EQ(deviation(Uncertainty::normal), 0.125F);
  EXPECT_TRUE(std::isnan(deviation(Uncertainty::shear_x)));
  EXPECT_EQ(values_at(field, {0, 1}).readings[0], 1001);
}

TEST(ValuesAt, ReadingsFollowThePositionsOfSensels) {
  const Sample sample(4, 5);
  const PillarValues values = values_at(sample.shown(), {2, 3});
  const float stride = 11;  // One column more than the pillars use.
  const float upper_left = 4 * stride + 6;
  EXPECT_EQ(values.readings[0], upper_left + 1);
  EXPECT_EQ(values.readings[1], upper_left);
  EXPECT_EQ(values.readings[2], upper_left + stride);
  EXPECT_EQ(values.readings[3], upper_left + stride + 1);
}

TEST(ValuesAt, MissingReadingsAndUncertaintyAreMarked) {
  const Sample sample(3, 3);
  ShownField field = sample.shown();
  field.raw = {};
  const PillarValues values = values_at(field, {1, 1});
  for (const float reading : values.readings) EXPECT_TRUE(std::isnan(reading));
  EXPECT_FALSE(values.uncertainty);
  EXPECT_THROW(static_cast<void>(values_at(field, {3, 0})), Error);
  EXPECT_THROW(static_cast<void>(values_at(field, {0, 3})), Error);
}

TEST(ValuesAt, AnglesAndUncertaintyAreThoseOfThePlanesWhereThereAreSome) {
  Sample sample(2, 3);
  ShownField field = sample.shown();
  const PillarValues computed = values_at(field, {1, 2});
  const Direction direction = direction_of(computed.shear_x, computed.shear_y, computed.normal);
  EXPECT_EQ(computed.theta, direction.theta);
  EXPECT_EQ(computed.phi, direction.phi);
  EXPECT_EQ(computed.magnitude, direction.magnitude);
  const std::vector<float> plane = {0, 1, 2, 3, 4, 5};
  field.forces.magnitude = plane;
  field.forces.theta = plane;
  field.forces.phi = plane;
  for (auto& span : field.forces.uncertainty) span = plane;
  const PillarValues values = values_at(field, {1, 2});
  EXPECT_EQ(values.theta, 5);
  EXPECT_EQ(values.phi, 5);
  EXPECT_EQ(values.magnitude, 5);
  ASSERT_TRUE(values.uncertainty);
  EXPECT_EQ((*values.uncertainty)[kUncertaintyPlanes - 1], 5);
}

}  // namespace
}  // namespace pillarfield::viewer
