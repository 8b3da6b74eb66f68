// The paper's region diagram, its drawing of a pillar, reading bars, and pin numbers.
#include "viewer/app/panels/region_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/viewer/app/made_field.h"
#include "viewer/app/input/marks.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Equation (2) over F k.
double model(int sensel, double phi, double theta) {
  return std::cos(theta * kRadians) -
         std::sin(theta * kRadians) * std::cos((45 * (2 * sensel - 1) - phi) * kRadians);
}

int usable(double phi, double theta) {
  int count = 0;
  for (int sensel = 1; sensel <= 4; ++sensel) count += model(sensel, phi, theta) > 0 ? 1 : 0;
  return count;
}

TEST(RegionLimits, MatchTheUsableSenselsOfTheModel) {
  for (int column = 0; column < 360; ++column) {
    const double phi = column - 179.5;
    const RegionLimits limits = region_limits(phi);
    for (int row = 0; row < 90; ++row) {
      const double theta = row + 0.5;
      // The polyline of the borders is within a tenth of a degree.
      if (std::abs(theta - limits.four) < 0.1 || std::abs(theta - limits.three) < 0.1) continue;
      const int expected = theta < limits.four ? 4 : theta < limits.three ? 3 : 2;
      ASSERT_EQ(usable(phi, theta), expected) << phi << ", " << theta;
    }
  }
}

/// All pillars of a region in a made field.
std::vector<PillarValues> pillars_in(Region region) {
  static const MadeField made;
  const ShownField field = made.shown();
  std::vector<PillarValues> found;
  for (std::uint32_t row = 0; row < made.forces.rows; ++row) {
    for (std::uint32_t col = 0; col < made.forces.cols; ++col) {
      const PillarValues values = values_at(field, {row, col});
      if (region_of(values.status) == region) found.push_back(values);
    }
  }
  return found;
}

TEST(ContourOf, GoesThroughThePointAndKeepsTheRatioOfTheReadings) {
  const auto pillars = pillars_in(Region::three);
  ASSERT_GT(pillars.size(), 10u);
  for (const PillarValues& values : pillars) {
    const std::vector<Vec2> contour = contour_of(values);
    ASSERT_FALSE(contour.empty());
    int first = 1;
    while ((values.status & status::kUsable) != (1 << (first - 1) | 1 << first % 4)) ++first;
    double nearest = 1e9;
    const double ratio = static_cast<double>(values.readings[static_cast<std::size_t>(first) - 1]) /
                         static_cast<double>(values.readings[static_cast<std::size_t>(first % 4)]);
    for (const Vec2& at : contour) {
      const double of_model = model(first, at.x, at.y) / model(first % 4 + 1, at.x, at.y);
      EXPECT_NEAR(of_model / ratio, 1, 1e-3);
      const double phi = std::remainder(at.x - values.phi / kRadians, 360);
      nearest = std::min(nearest, std::hypot(phi, at.y - values.theta / kRadians));
    }
    EXPECT_LT(nearest, 1);
  }
}

TEST(ContourOf, IsInRegion3Alone) {
  for (const Region region : {Region::none, Region::one, Region::two, Region::four}) {
    for (const PillarValues& values : pillars_in(region)) EXPECT_TRUE(contour_of(values).empty());
  }
}

TEST(DirectionBox, HoldsThePointAndTheContour) {
  for (const PillarValues& values : pillars_in(Region::three)) {
    const auto box = direction_box(values);
    ASSERT_TRUE(box);
    for (const Vec2& at : contour_of(values)) {
      const double phi = box->phi.from + std::remainder(at.x - box->phi.from, 360);
      EXPECT_GE(phi, box->phi.from - 0.01);
      EXPECT_LE(phi, box->phi.to + 0.01);
      EXPECT_GE(at.y, box->theta.from - 0.01);
      EXPECT_LE(at.y, box->theta.to + 0.01);
    }
  }
}

TEST(DirectionBox, IsAStandardDeviationToEitherSideWhereNothingIsAmbiguous) {
  for (const PillarValues& values : pillars_in(Region::one)) {
    const auto box = direction_box(values);
    ASSERT_TRUE(box);
    EXPECT_LE(box->theta.from, values.theta / kRadians);
    EXPECT_GE(box->theta.to, values.theta / kRadians);
    EXPECT_NEAR(box->phi.from + box->phi.to, 2 * values.phi / kRadians, 1e-6);
  }
}

TEST(DirectionBox, IsNotThereWithoutUncertainty) {
  PillarValues values = pillars_in(Region::one).front();
  values.uncertainty.reset();
  EXPECT_FALSE(direction_box(values));
}

TEST(TrailOf, BreaksWherePhiWrapsAndOmitsIdlePillars) {
  std::vector<CurvePoint> curve;
  for (int i = 0; i < 40; ++i) {
    const float angle = 0.1f + 0.2f * static_cast<float>(i);
    const bool idle = i == 10;
    curve.push_back({.shear_x = idle ? 0 : std::cos(angle),
                     .shear_y = idle ? 0 : std::sin(angle),
                     .normal = idle ? 0.f : 1.f});
  }
  std::size_t points = 0;
  const auto pieces = trail_of(curve);
  for (const auto& piece : pieces) {
    points += piece.size();
    for (std::size_t i = 1; i < piece.size(); ++i) {
      EXPECT_LT(std::abs(piece[i].x - piece[i - 1].x), 30);
      EXPECT_NEAR(piece[i].y, 45, 1e-3);
    }
  }
  EXPECT_EQ(points, 39u);
  EXPECT_EQ(pieces.size(), 2u);
  EXPECT_EQ(trail_of(std::span(curve).last(1)).size(), 1u);
  EXPECT_TRUE(trail_of({}).empty());
}

TEST(SectionName, IsThePapers) {
  EXPECT_EQ(section_name(status::kUsable | status::kSaturated), "1");
  EXPECT_EQ(section_name(status::kUsable & ~status::kSensel3), "2.3");
  EXPECT_EQ(section_name(status::kSensel3 | status::kSensel4 | status::kAmbiguous), "3.12");
  EXPECT_EQ(section_name(status::kSensel4), "4.123");
  EXPECT_EQ(section_name(status::kSensel1 | status::kSensel3), "");
  EXPECT_EQ(section_name(0), "");
}

TEST(ReadingBars, ComeFromTheSenselsThatTheModelNumbers) {
  const MadeField made;
  const SourceInfo source = made.source();
  for (const PillarIndex pillar : {PillarIndex{14, 20}, {14, 30}, {10, 12}}) {
    const auto bars = reading_bars(values_at(made.shown(), pillar), pillar, source);
    const std::size_t corner =
        std::size_t{2} * pillar.row * made.skin.cols + std::size_t{2} * pillar.col;
    EXPECT_EQ(bars[0].reading, made.readings[corner + 1]);
    EXPECT_EQ(bars[1].reading, made.readings[corner]);
    EXPECT_EQ(bars[2].reading, made.readings[corner + made.skin.cols]);
    EXPECT_EQ(bars[3].reading, made.readings[corner + made.skin.cols + 1]);
    for (const ReadingBar& bar : bars) EXPECT_EQ(bar.usable, bar.reading > bar.threshold);
  }
}

TEST(ReadingBars, ShowTheThresholdAboveEachSenselsTare) {
  const MadeField made;
  SourceInfo source = made.source();
  source.calibration.tare.resize(made.skin.sensels());
  source.calibration.gain.assign(made.skin.sensels(), 2);
  source.calibration.tare[28 * made.skin.cols + 41] = 30;  // sensel 1 of (14, 20)
  const auto bars = reading_bars(values_at(made.shown(), {14, 20}), {14, 20}, source);
  EXPECT_EQ(bars[0].threshold, 33);
  EXPECT_EQ(bars[1].threshold, 3);
}

TEST(FullBar, IsTheFullScaleOrRoomForAllReadings) {
  std::array<ReadingBar, 4> bars{};
  bars[2].reading = 1234;
  bars[1].reading = std::numeric_limits<double>::quiet_NaN();
  SourceInfo source;
  EXPECT_EQ(full_bar(bars, source, SenselType::u8), 255);
  EXPECT_EQ(full_bar(bars, source, SenselType::u16), 2000);
  source.skin.full_scale_counts = 4095;
  EXPECT_EQ(full_bar(bars, source, SenselType::u16), 4095);
}

TEST(Pins, KeepTheirNumbersWhileOthersComeAndGo) {
  AppState state;
  for (std::uint32_t i = 0; i < 4; ++i) state.pins.push_back({{i, i}});
  number_pins(state);
  inspect_pin(state, 1);
  EXPECT_EQ(state.pins.back().number, 2);
  EXPECT_EQ(state.pins.back().pillar, (PillarIndex{1, 1}));
  remove_pin(state, 0);
  state.pins.push_back({{9, 9}});
  number_pins(state);
  std::vector<int> numbers;
  for (const Pin& pin : state.pins) numbers.push_back(pin.number);
  EXPECT_EQ(numbers, (std::vector<int>{3, 4, 2, 1}));
  remove_pin(state, 77);
  EXPECT_EQ(state.pins.size(), 4u);
}

TEST(Pins, HaveColoursOfTheirOwn) {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    for (int a = 1; a <= 6; ++a) {
      for (int b = 1; b < a; ++b) EXPECT_NE(pin_colour(a, theme), pin_colour(b, theme));
    }
  }
}

}  // namespace
}  // namespace pillarfield::viewer
