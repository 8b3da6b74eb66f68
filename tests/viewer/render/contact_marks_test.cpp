// Positions and texts of contact marks.

#include "viewer/render/contact_marks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/source/touched_field.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kRows = 20;
constexpr std::uint32_t kCols = 40;
constexpr Viewport kPlot{30, 20, 400, 200};

SourceInfo source() {
  SourceInfo info;
  info.skin.rows = 2 * kRows;
  info.skin.cols = 2 * kCols;
  info.skin.sensel_pitch_mm = 0.5;  // pillar pitch 1 mm
  return info;
}

/// 10 pixels per millimetre; the middle of the skin is pixel (230, 120).
RenderSettings top_settings() {
  RenderSettings settings;
  settings.view = TopView{{0, 0}, 10};
  return settings;
}

ShownContacts contacts_of(std::initializer_list<Touch> touches) {
  return FieldContacts(1).contacts_of(touched_field(0, kRows, kCols, touches));
}

void expect_point(const Vec2& point, double x, double y) {
  EXPECT_NEAR(point.x, x, 1e-9);
  EXPECT_NEAR(point.y, y, 1e-9);
}

TEST(ContactMarks, AreWhereTheContactIs) {
  // Rows 4 to 7, columns 22 to 27: x from 2 to 8 mm, y from 2 to 6 mm.
  const ShownContacts contacts = contacts_of({{{4, 8, 22, 28}, 0.5F, 0.25F, 0}});
  const auto marks = contact_marks(contacts, Ground(nullptr, source(), top_settings(), kPlot));
  ASSERT_EQ(marks.size(), 1U);
  const ContactMark& mark = marks.front();
  ASSERT_EQ(mark.outline.size(), 4U);
  expect_point(mark.outline[0], 250, 60);
  expect_point(mark.outline[1], 310, 60);
  expect_point(mark.outline[2], 310, 100);
  expect_point(mark.outline[3], 250, 100);
  expect_point(mark.centre, 280, 80);
  ASSERT_TRUE(mark.tip);
  expect_point(*mark.tip, 280 + 0.5 * kContactArrowPixels, 80);
  EXPECT_EQ(mark.words, "1  12.0 N");
}

TEST(ContactMarks, ArrowsPointUpWhereShearDoesAndGrowWithTheScaleAndNotForEver) {
  RenderSettings settings = top_settings();
  const auto tip_of = [&](float shear_y) {
    const auto marks = contact_marks(contacts_of({{{4, 8, 22, 28}, 1, 0, shear_y}}),
                                     Ground(nullptr, source(), settings, kPlot));
    return marks.front().tip;
  };
  expect_point(tip_of(1).value(), 280, 80 - kContactArrowPixels);
  const double diagonal = std::hypot(60, 40);
  expect_point(tip_of(100).value(), 280, 80 - diagonal);
  EXPECT_FALSE(tip_of(0.02F));
  settings.scale = 2;
  expect_point(tip_of(-0.5F).value(), 280, 80 + kContactArrowPixels);
  expect_point(tip_of(-1).value(), 280, 80 + diagonal);
}

TEST(ContactMarks, TheHeaviestAreDrawnAndTheRestIsReported) {
  const ShownContacts few = contacts_of({{{4, 8, 22, 28}}});
  EXPECT_EQ(contacts_left_out(few), "");
  ForceField forces(100, 100);
  for (std::size_t row = 0; row < 100; row += 2) {
    for (std::size_t col = 0; col < 100; col += 2) {
      forces.status[100 * row + col] = status::kUsable;
      forces.normal[100 * row + col] = static_cast<float>(row * 100 + col) / 10;
    }
  }
  ShownField field;
  field.forces = forces.view();
  const ShownContacts many = FieldContacts(1).contacts_of(field);
  SourceInfo wide = source();
  wide.skin.rows = wide.skin.cols = 200;
  RenderSettings settings = top_settings();
  settings.view = fit_top({100, 100}, kPlot);
  const auto marks = contact_marks(many, Ground(nullptr, wide, settings, kPlot));
  EXPECT_EQ(marks.size(), kMostContactsDrawn);
  EXPECT_EQ(marks.front().words, "2500  990 N");
  EXPECT_EQ(contacts_left_out(many), "256 of 2500 contacts are drawn, the heaviest");
}

}  // namespace
}  // namespace pillarfield::viewer
