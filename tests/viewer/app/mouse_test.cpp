// What the mouse does in the field, without a window.

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/app/fake_session.h"
#include "viewer/app/input/controls.h"

namespace pillarfield::viewer {
namespace {

/// A hand on the mouse over a session.
struct Hand : FakeSession {
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
  [[nodiscard]] TopView top() const { return std::get<TopView>(session.look.view); }
};

TEST(Mouse, HoverFindsThePillarUnderTheCursor) {
  Hand hand;
  hand.move(hand.pixel(7, 21));
  EXPECT_EQ(hand.session.hovered, (PillarIndex{7, 21}));
  hand.move({799, 599});
  EXPECT_FALSE(hand.session.hovered);
  hand.move(hand.pixel(0, 0));
  EXPECT_EQ(hand.session.hovered, (PillarIndex{0, 0}));
  hand.controls.take(LeaveEvent{}, hand.command());
  EXPECT_FALSE(hand.session.hovered);
}

TEST(Mouse, AClickPinsAndAnotherUnpins) {
  Hand hand;
  hand.click(hand.pixel(7, 21));
  hand.click(hand.pixel(2, 3));
  ASSERT_EQ(hand.session.pins.size(), 2u);
  EXPECT_EQ(hand.session.pins[0].pillar, (PillarIndex{7, 21}));
  EXPECT_EQ(hand.session.pins[1].history.points().size(), 1u);
  hand.click(hand.pixel(7, 21));
  ASSERT_EQ(hand.session.pins.size(), 1u);
  EXPECT_EQ(hand.session.pins[0].pillar, (PillarIndex{2, 3}));
  EXPECT_FALSE(hand.session.region);
}

TEST(Mouse, PinsAreNotMoreThanThereMayBe) {
  Hand hand;
  for (std::uint32_t col = 0; col < Session::kMostPins + 2; ++col) hand.click(hand.pixel(1, col));
  EXPECT_EQ(hand.session.pins.size(), Session::kMostPins);
  EXPECT_FALSE(hand.session.notice.empty());
}

TEST(Mouse, ATremblingClickIsAClick) {
  Hand hand;
  const Vec2 pixel = hand.pixel(7, 21);
  hand.drag(pixel, {pixel.x + 2, pixel.y + 1});
  EXPECT_EQ(hand.session.pins.size(), 1u);
  EXPECT_FALSE(hand.session.region);
}

TEST(Mouse, ADoubleClickResetsTheViewAndLeavesPinsAlone) {
  Hand hand;
  const TopView fitted = hand.top();
  hand.controls.take(WheelEvent{3, {300, 250}}, hand.command());
  ASSERT_NE(hand.top(), fitted);
  const Vec2 pixel = hand.pixel(9, 12);
  hand.click(pixel);
  hand.click_again(pixel);
  EXPECT_EQ(hand.top(), fitted);
  EXPECT_TRUE(hand.session.pins.empty());
}

TEST(Mouse, TwoSlowClicksAreNoDoubleClick) {
  Hand hand;
  hand.controls.take(WheelEvent{3, {300, 250}}, hand.command());
  const TopView zoomed = hand.top();
  hand.click(hand.pixel(9, 12));
  hand.click(hand.pixel(9, 12));
  EXPECT_EQ(hand.top(), zoomed);
}

TEST(Mouse, ADragMarksTheRegionThatItTouches) {
  Hand hand;
  hand.drag(hand.pixel(12, 20), hand.pixel(4, 6));
  ASSERT_TRUE(hand.session.region);
  const PillarRect& rect = hand.session.region->rect;
  EXPECT_EQ(rect.row_begin, 4u);
  EXPECT_EQ(rect.row_end, 13u);
  EXPECT_EQ(rect.col_begin, 6u);
  EXPECT_EQ(rect.col_end, 21u);
  EXPECT_EQ(hand.session.region->history.points().size(), 1u);
  EXPECT_TRUE(hand.session.pins.empty());
}

TEST(Mouse, ADragBeyondTheSkinEndsAtItsEdge) {
  Hand hand;
  hand.drag(hand.pixel(10, 10), {2000, -500});
  ASSERT_TRUE(hand.session.region);
  EXPECT_EQ(hand.session.region->rect.row_begin, 0u);
  EXPECT_EQ(hand.session.region->rect.col_end, FakeProducer::kCols);
}

TEST(Mouse, OtherButtonsAndShiftMoveTheView) {
  for (const auto& [button, modifiers] :
       {std::pair{MouseButton::right, Modifiers{}}, std::pair{MouseButton::middle, Modifiers{}},
        std::pair{MouseButton::left, Modifiers{true, false}}}) {
    Hand hand;
    const Vec2 from = hand.pixel(10, 15);
    const auto point = sheet_point(hand.place, hand.session.look, from);
    hand.drag(from, {from.x + 60, from.y - 40}, button, modifiers);
    const auto moved = pixel_of(hand.place, hand.session.look, *point);
    EXPECT_NEAR(moved->x, from.x + 60, 1e-6);
    EXPECT_NEAR(moved->y, from.y - 40, 1e-6);
    EXPECT_FALSE(hand.session.region);
    EXPECT_FALSE(hand.session.view_is_fitted);
  }
}

TEST(Mouse, TheWheelZoomsAboutTheCursor) {
  Hand hand;
  const Vec2 pixel = hand.pixel(5, 22);
  const auto before = sheet_point(hand.place, hand.session.look, pixel);
  const double scale = hand.top().pixels_per_mm;
  hand.controls.take(WheelEvent{2, pixel}, hand.command());
  const auto after = sheet_point(hand.place, hand.session.look, pixel);
  EXPECT_NEAR(hand.top().pixels_per_mm, scale * 1.44, 1e-9);
  EXPECT_NEAR(after->x, before->x, 1e-9);
  EXPECT_NEAR(after->y, before->y, 1e-9);
}

TEST(Mouse, ADragTurnsAViewInPerspective) {
  Hand hand;
  show_orbit(hand.session, hand.place, true);
  const auto before = std::get<OrbitView>(hand.session.look.view);
  hand.drag({400, 300}, {460, 320});
  const auto after = std::get<OrbitView>(hand.session.look.view);
  EXPECT_NE(after.azimuth, before.azimuth);
  EXPECT_NE(after.elevation, before.elevation);
  EXPECT_EQ(after.distance_mm, before.distance_mm);
  EXPECT_FALSE(hand.session.region);
}

TEST(Mouse, OutsideTheFieldItDoesNothing) {
  Hand hand;
  const Look before = hand.session.look;
  hand.click({900, 300});
  hand.drag({900, 300}, {950, 350});
  hand.controls.take(WheelEvent{2, {900, 300}}, hand.command());
  EXPECT_TRUE(hand.session.pins.empty());
  EXPECT_FALSE(hand.session.region);
  EXPECT_EQ(hand.session.look, before);
}

TEST(Mouse, ADragThatBeganInTheFieldGoesOnOutside) {
  Hand hand;
  hand.button(true, hand.pixel(10, 15), MouseButton::right, {});
  EXPECT_TRUE(hand.controls.is_dragging());
  const TopView before = hand.top();
  hand.move({900, 300});
  EXPECT_NE(hand.top(), before);
  hand.button(false, {900, 300}, MouseButton::right, {});
  EXPECT_FALSE(hand.controls.is_dragging());
}

TEST(Mouse, KeysWithUnknownModifiersDoNothing) {
  Hand hand;
  hand.controls.take(KeyEvent{GLFW_KEY_Q, {}, true, true}, hand.command());
  hand.controls.take(KeyEvent{GLFW_KEY_Q, {}, false, false}, hand.command());
  EXPECT_FALSE(hand.requests.quit);
  hand.controls.take(KeyEvent{GLFW_KEY_Q, {}, true, false}, hand.command());
  EXPECT_TRUE(hand.requests.quit);
}

TEST(Views, EachKeepsItsPlaceWhileTheOtherIsLookedAt) {
  Hand hand;
  hand.controls.take(WheelEvent{2, {300, 300}}, hand.command());
  const TopView zoomed = hand.top();
  show_orbit(hand.session, hand.place, true);
  hand.drag({400, 300}, {460, 320});
  const View turned = hand.session.look.view;
  show_orbit(hand.session, hand.place, false);
  EXPECT_EQ(hand.top(), zoomed);
  show_orbit(hand.session, hand.place, true);
  EXPECT_EQ(hand.session.look.view, turned);
}

TEST(Views, PillarsInSightAreThoseOfThePlot) {
  Hand hand;
  const PillarRect all = visible_pillars(hand.place, hand.session.look);
  EXPECT_EQ(all.row_end - all.row_begin, FakeProducer::kRows);
  EXPECT_EQ(all.col_end - all.col_begin, FakeProducer::kCols);
  for (int i = 0; i < 8; ++i) {
    hand.controls.take(WheelEvent{2, hand.pixel(5, 22)}, hand.command());
  }
  const PillarRect seen = visible_pillars(hand.place, hand.session.look);
  EXPECT_LE(seen.row_begin, 5u);
  EXPECT_GT(seen.row_end, 5u);
  EXPECT_LE(seen.col_begin, 22u);
  EXPECT_GT(seen.col_end, 22u);
  const double pillars = 600 / (hand.top().pixels_per_mm * 1.2649);
  EXPECT_LE(seen.row_end - seen.row_begin, std::ceil(pillars) + 1);
}

}  // namespace
}  // namespace pillarfield::viewer
