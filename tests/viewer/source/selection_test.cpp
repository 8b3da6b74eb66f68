#include "viewer/source/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

constexpr double kPitch = 1.25;
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

/// The sums by their definitions.
SelectionSums plain_sums(const ShownField& field, const PillarRect& rect) {
  const ForceFieldView& f = field.forces;
  SelectionSums sums;
  double weighted_x = 0;
  double weighted_y = 0;
  const auto x_of = [&](std::uint32_t col) { return kPitch * (col + 0.5) - kPitch * f.cols / 2; };
  const auto y_of = [&](std::uint32_t row) { return kPitch * f.rows / 2 - kPitch * (row + 0.5); };
  for (std::uint32_t r = rect.row_begin; r < rect.row_end; ++r) {
    for (std::uint32_t c = rect.col_begin; c < rect.col_end; ++c) {
      const std::size_t i = r * f.cols + c;
      if ((f.status[i] & status::kLoaded) == 0) continue;
      sums.shear_x += f.shear_x[i];
      sums.shear_y += f.shear_y[i];
      sums.normal += f.normal[i];
      weighted_x += f.normal[i] * x_of(c);
      weighted_y += f.normal[i] * y_of(r);
      sums.area_mm2 += kPitch * kPitch;
      if (f.normal[i] > sums.peak_normal) {
        sums.peak_normal = f.normal[i];
        sums.peak = {r, c};
      }
    }
  }
  sums.centre_x_mm = weighted_x / sums.normal;
  sums.centre_y_mm = weighted_y / sums.normal;
  for (std::uint32_t r = rect.row_begin; r < rect.row_end; ++r) {
    for (std::uint32_t c = rect.col_begin; c < rect.col_end; ++c) {
      const std::size_t i = r * f.cols + c;
      if ((f.status[i] & status::kLoaded) == 0) continue;
      sums.moment_z +=
          (x_of(c) - sums.centre_x_mm) * f.shear_y[i] - (y_of(r) - sums.centre_y_mm) * f.shear_x[i];
    }
  }
  return sums;
}

TEST(Selection, SumsAreThoseOfAPlainLoop) {
  const Sample sample(13, 21);
  for (const PillarRect rect : {PillarRect{0, 13, 0, 21}, {2, 9, 5, 6}, {12, 13, 0, 21}}) {
    const SelectionSums expected = plain_sums(sample.shown(), rect);
    const SelectionSums sums = sums_over(sample.shown(), rect, kPitch);
    EXPECT_NEAR(sums.shear_x, expected.shear_x, 1e-12);
    EXPECT_NEAR(sums.shear_y, expected.shear_y, 1e-12);
    EXPECT_NEAR(sums.normal, expected.normal, 1e-12);
    EXPECT_NEAR(sums.moment_z, expected.moment_z, 1e-10);
    EXPECT_NEAR(sums.centre_x_mm, expected.centre_x_mm, 1e-12);
    EXPECT_NEAR(sums.centre_y_mm, expected.centre_y_mm, 1e-12);
    EXPECT_NEAR(sums.area_mm2, expected.area_mm2, 1e-10);
    EXPECT_NEAR(sums.mean_normal, expected.normal * kPitch * kPitch / expected.area_mm2, 1e-12);
    EXPECT_EQ(sums.peak_normal, expected.peak_normal);
    EXPECT_EQ(sums.peak, expected.peak);
  }
}

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

TEST(Selection, ATurnToTheLeftIsPositive) {
  Sample sample(3, 3);
  ForceField& forces = sample.forces();
  forces = ForceField(3, 3);
  for (const std::size_t pillar : {3U, 5U}) {  // Left and right of the middle.
    forces.status[pillar] = 15;
    forces.normal[pillar] = 2;
    forces.shear_y[pillar] = pillar == 5 ? 1 : -1;
  }
  const SelectionSums sums = sums_over(sample.shown(), {0, 3, 0, 3}, kPitch);
  EXPECT_DOUBLE_EQ(sums.moment_z, 2 * kPitch);
  EXPECT_DOUBLE_EQ(sums.centre_x_mm, 0);
  EXPECT_DOUBLE_EQ(sums.centre_y_mm, 0);
  const SelectionSums right = sums_over(sample.shown(), {0, 3, 2, 3}, kPitch);
  EXPECT_DOUBLE_EQ(right.centre_x_mm, kPitch);
  EXPECT_DOUBLE_EQ(right.moment_z, 0);
}

TEST(Selection, WithoutLoadThereIsNoCentre) {
  Sample sample(4, 4);
  sample.forces() = ForceField(4, 4);
  const SelectionSums sums = sums_over(sample.shown(), {0, 4, 0, 4}, kPitch);
  EXPECT_TRUE(std::isnan(sums.centre_x_mm) && std::isnan(sums.centre_y_mm));
  EXPECT_EQ(sums.mean_normal, 0);
  EXPECT_EQ(sums.area_mm2, 0);
  EXPECT_EQ(sums_over(sample.shown(), {2, 2, 0, 4}, kPitch).pillars, 0U) << "an empty rectangle";
}

TEST(Selection, ForcesThatAreNoNumbersSpoilNothing) {
  Sample sample(5, 6);
  const std::uint64_t in_contact = sums_over(sample.shown(), {0, 5, 0, 6}, kPitch).in_contact;
  sample.forces().status[7] = 15;
  sample.forces().normal[7] = kNan;
  const SelectionSums sums = sums_over(sample.shown(), {0, 5, 0, 6}, kPitch);
  EXPECT_TRUE(std::isfinite(sums.normal) && std::isfinite(sums.moment_z));
  EXPECT_LE(sums.in_contact, in_contact);
}

TEST(Selection, ReadingsFollowThePositionsOfSensels) {
  const Sample sample(4, 5);
  const PillarValues values = values_at(sample.shown(), {2, 3});
  const float stride = 11;  // One column more than the pillars use.
  const float upper_left = 4 * stride + 6;
  EXPECT_EQ(values.readings[0], upper_left + 1);
  EXPECT_EQ(values.readings[1], upper_left);
  EXPECT_EQ(values.readings[2], upper_left + stride);
  EXPECT_EQ(values.readings[3], upper_left + stride + 1);
}

TEST(Selection, MissingReadingsAndUncertaintyAreMarked) {
  const Sample sample(3, 3);
  ShownField field = sample.shown();
  field.raw = {};
  const PillarValues values = values_at(field, {1, 1});
  for (const float reading : values.readings) EXPECT_TRUE(std::isnan(reading));
  EXPECT_FALSE(values.uncertainty);
  EXPECT_THROW(static_cast<void>(values_at(field, {3, 0})), Error);
  EXPECT_THROW(static_cast<void>(values_at(field, {0, 3})), Error);
}

TEST(Selection, AnglesAndUncertaintyAreThoseOfThePlanesWhereThereAreSome) {
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

TEST(Selection, CountsEveryPillarOnce) {
  const Sample sample(9, 14);
  const ShownField field = sample.shown();
  const SelectionSums sums = sums_over(field, {0, 9, 0, 14}, kPitch);
  std::uint64_t all = 0;
  for (const std::uint64_t pillars : sums.by_region) all += pillars;
  EXPECT_EQ(sums.pillars, 9U * 14U);
  EXPECT_EQ(all, sums.pillars);
  // Saturated pillars without a usable sensel are loaded, and in no region.
  EXPECT_GE(sums.in_contact + sums.by_region[static_cast<std::size_t>(Region::none)], all);
  std::uint64_t ambiguous = 0;
  std::uint64_t saturated = 0;
  std::uint64_t inconsistent = 0;
  for (const std::uint8_t state : field.forces.status) {
    ambiguous += state / 16 % 2;
    saturated += state / 32 % 2;
    inconsistent += state / 64 % 2;
  }
  EXPECT_EQ(sums.ambiguous, ambiguous);
  EXPECT_EQ(sums.saturated, saturated);
  EXPECT_EQ(sums.inconsistent, inconsistent);
}

}  // namespace
}  // namespace pillarfield::viewer
