// Values and states decoded from the heat map's pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/viewer/render/drawing.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kMapWidth = 640;
constexpr std::uint32_t kMapHeight = 480;

/// A different force on every pillar, in all directions.
MadeUpField varied_field() {
  return {18, 24, [](std::uint32_t row, std::uint32_t col) {
            const float angle = 0.37F * static_cast<float>(row * 24 + col);
            const float size = 0.05F + 0.04F * static_cast<float>((7 * row + 5 * col) % 24);
            return MadeUpPillar{size * std::cos(angle), size * std::sin(angle),
                                0.02F * static_cast<float>((row + 2 * col) % 41), 15};
          }};
}

class HeatMap : public testing::TestWithParam<Quantity> {};

/// Entries of a table with this colour; neighbours may be equal.
std::set<std::size_t> entries_with(ColourMap map, const Colour& colour) {
  std::set<std::size_t> entries;
  const auto table = table_of(map);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i] == colour) entries.insert(i);
  }
  return entries;
}

TEST_P(HeatMap, GivesValuesBackThroughItsColours) {
  const Quantity quantity = GetParam();
  const MadeUpField field = varied_field();
  Drawing drawing;
  RenderSettings settings = bare_settings(field, kMapWidth, kMapHeight);
  settings.quantity = quantity;
  settings.map = default_map(info_of(quantity).scale);
  settings.range = fitting_range(quantity, largest(quantity, field.shown(), field.source().skin));
  const Pixels pixels = drawing.draw(field, settings, kMapWidth, kMapHeight);
  std::set<std::size_t> seen;
  for (std::uint32_t row = 0; row < 18; ++row) {
    for (std::uint32_t col = 0; col < 24; ++col) {
      const PixelPlace place = middle_of(field, settings, kMapWidth, kMapHeight, row, col);
      const auto entries = entries_with(settings.map, colour_at(pixels, place.x, place.y));
      const float value = value_of(quantity, field.shown(), field.source().skin, row, col);
      const std::size_t expected = entry_of(value, settings.range, info_of(quantity).scale);
      EXPECT_TRUE(entries.count(expected) == 1) << row << ", " << col << ": " << value;
      seen.insert(entries.begin(), entries.end());
    }
  }
  EXPECT_GT(seen.size(), 15U);  // More than a single colour.
  EXPECT_EQ(drawing.validation_messages(), 0);
}

INSTANTIATE_TEST_SUITE_P(Quantities, HeatMap,
                         testing::Values(Quantity::normal, Quantity::shear, Quantity::shear_x,
                                         Quantity::shear_y, Quantity::magnitude, Quantity::theta,
                                         Quantity::phi, Quantity::uncertainty, Quantity::parity,
                                         Quantity::pressure),
                         [](const auto& test) { return info_of(test.param).name; });

class States : public testing::TestWithParam<Quantity> {};

TEST_P(States, HaveColoursOfTheirOwn) {
  const Quantity quantity = GetParam();
  const MadeUpField field(16, 16, [](std::uint32_t row, std::uint32_t col) {
    return MadeUpPillar{0.1F, 0.2F, 0.5F, static_cast<std::uint8_t>(16 * row + col)};
  });
  Drawing drawing;
  for (const Theme theme : {Theme::dark, Theme::light}) {
    RenderSettings settings = bare_settings(field, kMapWidth, kMapHeight);
    settings.theme = theme;
    settings.quantity = quantity;
    const Pixels pixels = drawing.draw(field, settings, kMapWidth, kMapHeight);
    for (std::uint32_t status = 0; status < 256; ++status) {
      const PixelPlace place =
          middle_of(field, settings, kMapWidth, kMapHeight, status / 16, status % 16);
      const auto special = special_of(quantity, static_cast<std::uint8_t>(status));
      const Colour mapped = table_of(settings.map)[entry_of(
          value_of(quantity, field.shown(), field.source().skin, status / 16, status % 16),
          settings.range, info_of(quantity).scale)];
      EXPECT_EQ(colour_at(pixels, place.x, place.y), special ? colour_of(*special, theme) : mapped)
          << "status " << status;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Quantities, States,
                         testing::Values(Quantity::normal, Quantity::region, Quantity::status),
                         [](const auto& test) { return info_of(test.param).name; });

TEST(HeatMapFromAfar, AveragesThoseInContact) {
  // Stripes of pillars in contact; a pixel covers several of them.
  const MadeUpField field(480, 640, [](std::uint32_t, std::uint32_t col) {
    return MadeUpPillar{0, 0, col % 2 == 0 ? 0.25F : 0.75F,
                        static_cast<std::uint8_t>(col < 320 ? 15 : 0)};
  });
  Drawing drawing;
  RenderSettings settings = bare_settings(field, 160, 120);
  const Pixels pixels = drawing.draw(field, settings, 160, 120);
  // With few samples a mean may be off by one of them.
  const Colour left = colour_at(pixels, 40, 60);
  const auto table = table_of(settings.map);
  const auto close = std::find(table.begin() + 96, table.begin() + 160, left);
  EXPECT_NE(close, table.begin() + 160);
  EXPECT_EQ(colour_at(pixels, 120, 60), colour_of(Special::idle, settings.theme));
}

TEST(HeatMap, IsTheSameReadInPlaceAndCopied) {
  const MadeUpField field = varied_field();
  Drawing in_place;
  Drawing copied(false);
  RenderSettings settings = bare_settings(field, kMapWidth, kMapHeight);
  settings.arrows = true;
  settings.legend = true;
  const Pixels first = in_place.draw(field, settings, kMapWidth, kMapHeight);
  const Pixels second = copied.draw(field, settings, kMapWidth, kMapHeight);
  EXPECT_EQ(first.rgba, second.rgba);
  EXPECT_EQ(copied.memory().fields_in_place(), 0U);
  EXPECT_EQ(copied.memory().bytes_copied(), field.shown().pages.size());
  if (!in_place.device().imports_memory()) GTEST_SKIP() << "this device reads no host memory";
  EXPECT_EQ(in_place.memory().fields_in_place(), 1U);
  EXPECT_EQ(in_place.memory().bytes_copied(), 0U);
}

TEST(BareSensels, PlacesWithoutASenselAreBlank) {
  const MadeUpField field(2, 4, [](std::uint32_t, std::uint32_t) {
    return MadeUpPillar{0, 0, 0, 0};
  });
  MadeUpField bare = field.without_pillars();
  Drawing drawing;
  const RenderSettings settings = bare_settings(bare, kMapWidth, kMapHeight);
  SourceInfo source = bare.source();
  source.calibration.mask = {1, 1, 2, 2, 1, 0, 2, 1};
  const Pixels pixels = drawing.draw(bare.shown(), source, settings, kMapWidth, kMapHeight);
  const Colour idle = colour_of(Special::idle, settings.theme);
  const Colour paper = background_of(settings.theme);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const PixelPlace place = middle_of(bare, settings, kMapWidth, kMapHeight, i / 4, i % 4);
    const bool is_absent = source.calibration.mask[i] == kAbsent;
    EXPECT_EQ(colour_at(pixels, place.x, place.y), is_absent ? paper : idle) << i;
  }
}

}  // namespace
}  // namespace pillarfield::viewer
