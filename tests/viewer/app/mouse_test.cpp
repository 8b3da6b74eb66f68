// Mouse gestures in the field, without a window.

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/app/fake_app_state.h"
#include "viewer/app/input/controls.h"

namespace pillarfield::viewer {
namespace {

/// Simulated gestures.
struct Mouse : FakeAppState {
  Controls controls;
  double time_s = 0;

  void move(Vec2 pixel) { controls.take(MotionEvent{pixel}, command()); }
  void button(bool pressed, Vec2 pixel, MouseButton which, Modifiers modifiers) {
    controls.take(ButtonEvent{which, pressed, modifiers, pixel, time_s}, command());
  }
  void click(Vec2 pixel) {
    time_s += 10;
    click_again(pixel);
  }
  void click_again(Vec2 pixel) {
    time_s += 0.1;
    button(true, pixel, MouseButton::left, {});
    button(false, pixel, MouseButton::left, {});
  }
  void drag(Vec2 from, Vec2 to, MouseButton which = MouseButton::left, Modifiers modifiers = {}) {
    time_s += 10;
    button(true, from, which, modifiers);
    move({0.5 * (from.x + to.x), 0.5 * (from.y + to.y)});
    move(to);
    button(false, to, which, modifiers);
  }
  [[nodiscard]] TopView top() const { return std::get<TopView>(state.look.settings.view); }
};

TEST(Mouse, HoverFindsThePillarUnderTheCursor) {
  Mouse mouse;
  mouse.move(mouse.pixel(7, 21));
  EXPECT_EQ(mouse.state.marks.hovered, (PillarIndex{7, 21}));
  mouse.move({799, 599});
  EXPECT_FALSE(mouse.state.marks.hovered);
  mouse.move(mouse.pixel(0, 0));
  EXPECT_EQ(mouse.state.marks.hovered, (PillarIndex{0, 0}));
  mouse.controls.take(LeaveEvent{}, mouse.command());
  EXPECT_FALSE(mouse.state.marks.hovered);
}

TEST(Mouse, AClickPinsAndAnotherUnpins) {
  Mouse mouse;
  mouse.click(mouse.pixel(7, 21));
  mouse.click(mouse.pixel(2, 3));
  ASSERT_EQ(mouse.state.marks.pins.size(), 2u);
  EXPECT_EQ(mouse.state.marks.pins[0].pillar, (PillarIndex{7, 21}));
  mouse.click(mouse.pixel(7, 21));
  ASSERT_EQ(mouse.state.marks.pins.size(), 1u);
  EXPECT_EQ(mouse.state.marks.pins[0].pillar, (PillarIndex{2, 3}));
  const Vec2 pixel = mouse.pixel(7, 21);
  mouse.drag(pixel, {pixel.x + 2, pixel.y + 1});
  EXPECT_EQ(mouse.state.marks.pins.size(), 2u) << "a trembling click";
}

TEST(Mouse, PinsAreNotMoreThanThereMayBe) {
  Mouse mouse;
  for (std::uint32_t col = 0; col < Marks::kMostPins + 2; ++col) mouse.click(mouse.pixel(1, col));
  EXPECT_EQ(mouse.state.marks.pins.size(), Marks::kMostPins);
  EXPECT_FALSE(mouse.state.window.notice.empty());
}

TEST(Mouse, ADoubleClickResetsTheViewAndLeavesPinsAlone) {
  Mouse mouse;
  const TopView fitted = mouse.top();
  mouse.controls.take(WheelEvent{3, {300, 250}}, mouse.command());
  ASSERT_NE(mouse.top(), fitted);
  const Vec2 pixel = mouse.pixel(9, 12);
  mouse.click(pixel);
  mouse.click_again(pixel);
  EXPECT_EQ(mouse.top(), fitted);
  EXPECT_TRUE(mouse.state.marks.pins.empty());
  mouse.controls.take(WheelEvent{3, {300, 250}}, mouse.command());
  mouse.click(pixel);
  mouse.click(pixel);
  EXPECT_NE(mouse.top(), fitted) << "two slow clicks";
}

TEST(Mouse, ADragMovesTheView) {
  for (const auto& [button, modifiers] :
       {std::pair{MouseButton::left, Modifiers{}}, std::pair{MouseButton::right, Modifiers{}},
        std::pair{MouseButton::middle, Modifiers{}},
        std::pair{MouseButton::left, Modifiers{true, false}}}) {
    Mouse mouse;
    const Vec2 from = mouse.pixel(10, 15);
    const auto point = sheet_point(mouse.place, mouse.state.look.settings, from);
    mouse.drag(from, {from.x + 60, from.y - 40}, button, modifiers);
    const auto moved = pixel_of(mouse.place, mouse.state.look.settings, *point);
    EXPECT_NEAR(moved->x, from.x + 60, 1e-6);
    EXPECT_NEAR(moved->y, from.y - 40, 1e-6);
    EXPECT_FALSE(mouse.state.look.view_is_fitted);
  }
}

TEST(Mouse, TheWheelZoomsAboutTheCursor) {
  Mouse mouse;
  const Vec2 pixel = mouse.pixel(5, 22);
  const auto before = sheet_point(mouse.place, mouse.state.look.settings, pixel);
  const double scale = mouse.top().pixels_per_mm;
  mouse.controls.take(WheelEvent{2, pixel}, mouse.command());
  const auto after = sheet_point(mouse.place, mouse.state.look.settings, pixel);
  EXPECT_NEAR(mouse.top().pixels_per_mm, scale * 1.44, 1e-9);
  EXPECT_NEAR(after->x, before->x, 1e-9);
  EXPECT_NEAR(after->y, before->y, 1e-9);
}

TEST(Mouse, ADragTurnsAViewInPerspective) {
  Mouse mouse;
  show_orbit(mouse.state, mouse.place, true);
  const auto before = std::get<OrbitView>(mouse.state.look.settings.view);
  mouse.drag({400, 300}, {460, 320});
  const auto after = std::get<OrbitView>(mouse.state.look.settings.view);
  EXPECT_NE(after.azimuth, before.azimuth);
  EXPECT_NE(after.elevation, before.elevation);
  EXPECT_EQ(after.distance_mm, before.distance_mm);
}

TEST(Mouse, OutsideTheFieldItDoesNothing) {
  Mouse mouse;
  const RenderSettings before = mouse.state.look.settings;
  mouse.click({900, 300});
  mouse.drag({900, 300}, {950, 350});
  mouse.controls.take(WheelEvent{2, {900, 300}}, mouse.command());
  EXPECT_TRUE(mouse.state.marks.pins.empty());
  EXPECT_EQ(mouse.state.look.settings, before);
}

TEST(Mouse, ADragThatBeganInTheFieldGoesOnOutside) {
  Mouse mouse;
  mouse.button(true, mouse.pixel(10, 15), MouseButton::right, {});
  EXPECT_TRUE(mouse.controls.is_dragging());
  const TopView before = mouse.top();
  mouse.move({900, 300});
  EXPECT_NE(mouse.top(), before);
  mouse.button(false, {900, 300}, MouseButton::right, {});
  EXPECT_FALSE(mouse.controls.is_dragging());
}

TEST(Mouse, KeysWithUnknownModifiersDoNothing) {
  Mouse mouse;
  mouse.controls.take(KeyEvent{GLFW_KEY_Q, {}, true, true}, mouse.command());
  mouse.controls.take(KeyEvent{GLFW_KEY_Q, {}, false, false}, mouse.command());
  EXPECT_FALSE(mouse.pending.quit);
  mouse.controls.take(KeyEvent{GLFW_KEY_Q, {}, true, false}, mouse.command());
  EXPECT_TRUE(mouse.pending.quit);
}

TEST(Views, EachKeepsItsPositionWhileTheOtherIsShown) {
  Mouse mouse;
  mouse.controls.take(WheelEvent{2, {300, 300}}, mouse.command());
  const TopView zoomed = mouse.top();
  show_orbit(mouse.state, mouse.place, true);
  mouse.drag({400, 300}, {460, 320});
  const View turned = mouse.state.look.settings.view;
  show_orbit(mouse.state, mouse.place, false);
  EXPECT_EQ(mouse.top(), zoomed);
  show_orbit(mouse.state, mouse.place, true);
  EXPECT_EQ(mouse.state.look.settings.view, turned);
}

TEST(Views, PillarsInSightAreThoseOfThePlot) {
  Mouse mouse;
  const PillarRect all = visible_pillars(mouse.place, mouse.state.look.settings);
  EXPECT_EQ(all.row_end - all.row_begin, FakeProducer::kRows);
  EXPECT_EQ(all.col_end - all.col_begin, FakeProducer::kCols);
  for (int i = 0; i < 8; ++i) {
    mouse.controls.take(WheelEvent{2, mouse.pixel(5, 22)}, mouse.command());
  }
  const PillarRect seen = visible_pillars(mouse.place, mouse.state.look.settings);
  EXPECT_LE(seen.row_begin, 5u);
  EXPECT_GT(seen.row_end, 5u);
  EXPECT_LE(seen.col_begin, 22u);
  EXPECT_GT(seen.col_end, 22u);
  const double pillars = 600 / (mouse.top().pixels_per_mm * 1.2649);
  EXPECT_LE(seen.row_end - seen.row_begin, std::ceil(pillars) + 1);
}

}  // namespace
}  // namespace pillarfield::viewer
