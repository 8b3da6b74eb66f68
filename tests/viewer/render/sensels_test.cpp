// Skins of bare sensels: values decoded from pixels, sharp squares, no layers of shear.
#include <gtest/gtest.h>

#include <cmath>

#include "pillarfield/status.h"
#include "tests/viewer/render/drawing.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kWide = 640;
constexpr std::uint32_t kHigh = 480;
constexpr std::uint32_t kBareRows = 17;
constexpr std::uint32_t kBareCols = 23;

/// A different force on every sensel; a few idle, saturated and without a reading.
MadeUpField bare_field() {
  return MadeUpField(
             kBareRows, kBareCols,
             [](std::uint32_t row, std::uint32_t col) {
               const std::uint32_t place = row * kBareCols + col;
               const std::uint8_t state = place % 37 == 5    ? 0
                                          : place % 41 == 7  ? status::kSensel1 | status::kSaturated
                                          : place % 43 == 11 ? status::kInconsistent
                                                             : status::kSensel1;
               return MadeUpPillar{0.3F, -0.2F, 0.01F * static_cast<float>(7 * place % 389), state};
             })
      .without_pillars();
}

/// The colour that a sensel has by the C++ side.
Colour expected_colour(const MadeUpField& field, const RenderSettings& settings, std::uint32_t row,
                       std::uint32_t col) {
  const ForceFieldView& forces = field.shown().forces;
  const auto special = special_of(settings.quantity, forces.status[row * forces.cols + col]);
  if (special) return colour_of(*special, settings.theme);
  const float value = value_of(settings.quantity, field.shown(), field.source().skin, row, col);
  return table_of(settings.map)[entry_of(value, settings.range, info_of(settings.quantity).scale)];
}

class BareSensels : public testing::TestWithParam<Quantity> {};

TEST_P(BareSensels, GiveTheirValuesBackThroughTheirColours) {
  const Quantity quantity = GetParam();
  const MadeUpField field = bare_field();
  Drawing drawing;
  RenderSettings settings = bare_settings(field, kWide, kHigh);
  settings.quantity = quantity;
  settings.range = fitting_range(quantity, largest(quantity, field.shown(), field.source().skin));
  const Pixels pixels = drawing.draw(field, settings, kWide, kHigh);
  for (std::uint32_t row = 0; row < kBareRows; ++row) {
    for (std::uint32_t col = 0; col < kBareCols; ++col) {
      const PixelPlace place = middle_of(field, settings, kWide, kHigh, row, col);
      EXPECT_EQ(colour_at(pixels, place.x, place.y), expected_colour(field, settings, row, col))
          << row << ", " << col;
    }
  }
  EXPECT_EQ(drawing.validation_messages(), 0);
}

INSTANTIATE_TEST_SUITE_P(Quantities, BareSensels,
                         testing::Values(Quantity::normal, Quantity::pressure, Quantity::status,
                                         Quantity::uncertainty, Quantity::peak),
                         [](const auto& test) { return info_of(test.param).name; });

TEST(BareSensels, APressureIsShownInItsUnit) {
  for (const PressureUnit& unit : kPressureUnits) {
    EXPECT_EQ(info_of(Quantity::pressure, unit).unit, unit.name);
    EXPECT_DOUBLE_EQ(info_of(Quantity::pressure, unit).factor * unit.kpa, 1);
    EXPECT_EQ(info_of(Quantity::normal, unit).factor, 1);
  }
}

TEST(BareSensels, AreSharpRectanglesAtAnyZoom) {
  const MadeUpField field = bare_field();
  Drawing drawing;
  for (const double pixels_per_sensel : {0.8, 1.7, 9.3, 41.9, 300.0}) {
    RenderSettings settings = bare_settings(field, kWide, kHigh);
    TopView view{{0.4, -0.7}, pixels_per_sensel / field.source().skin.element_pitch_mm().col_mm};
    settings.view = view;
    const Pixels pixels = drawing.draw(field, settings, kWide, kHigh);
    std::size_t seen = 0;
    for (std::uint32_t y = 0; y < kHigh; ++y) {
      for (std::uint32_t x = 0; x < kWide; ++x) {
        const auto [row_mm, col_mm] = field.source().skin.element_pitch_mm();
        const double col =
            ((x + 0.5 - kWide / 2.0) / view.pixels_per_mm + view.centre_mm.x) / col_mm +
            kBareCols / 2.0;
        const double row =
            ((y + 0.5 - kHigh / 2.0) / view.pixels_per_mm - view.centre_mm.y) / row_mm +
            kBareRows / 2.0;
        const auto at_edge = [](double place) {
          return std::abs(place - std::round(place)) < 1e-3;
        };
        if (row < 0 || col < 0 || row >= kBareRows || col >= kBareCols || at_edge(row) ||
            at_edge(col)) {
          continue;
        }
        ++seen;
        ASSERT_EQ(colour_at(pixels, x, y),
                  expected_colour(field, settings, static_cast<std::uint32_t>(row),
                                  static_cast<std::uint32_t>(col)))
            << x << ", " << y << " at " << pixels_per_sensel;
      }
    }
    EXPECT_GT(seen, 200U);
  }
}

TEST(BareSensels, PlacesWithoutASenselAreBlank) {
  const MadeUpField field(2, 4, [](std::uint32_t, std::uint32_t) {
    return MadeUpPillar{0, 0, 0, 0};
  });
  MadeUpField bare = field.without_pillars();
  Drawing drawing;
  const RenderSettings settings = bare_settings(bare, kWide, kHigh);
  SourceInfo source = bare.source();
  source.calibration.mask = {1, 1, 2, 2, 1, 0, 2, 1};
  const Pixels pixels = drawing.draw(bare.shown(), source, settings, kWide, kHigh);
  const Colour idle = colour_of(Special::idle, settings.theme);
  const Colour paper = background_of(settings.theme);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const PixelPlace place = middle_of(bare, settings, kWide, kHigh, i / 4, i % 4);
    const bool is_absent = source.calibration.mask[i] == kAbsent;
    EXPECT_EQ(colour_at(pixels, place.x, place.y), is_absent ? paper : idle) << i;
  }
}

TEST(BareSensels, HaveNoLayersOfShear) {
  const MadeUpField field = bare_field();
  Drawing drawing;
  RenderSettings settings = bare_settings(field, kWide, kHigh);
  settings.legend = true;
  for (const Quantity quantity : {Quantity::normal, Quantity::status}) {
    settings.quantity = quantity;
    settings.arrows = settings.sectors = settings.hatch = false;
    const Pixels without = drawing.draw(field, settings, kWide, kHigh);
    settings.arrows = settings.sectors = settings.hatch = true;
    EXPECT_EQ(drawing.draw(field, settings, kWide, kHigh).rgba, without.rgba);
  }
  EXPECT_EQ(drawing.validation_messages(), 0);
}

}  // namespace
}  // namespace pillarfield::viewer
