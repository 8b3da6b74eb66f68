// Layout of the window, scheduling of drawing, and its statistics.

#include <gtest/gtest.h>

#include "viewer/app/window/draw_clock.h"
#include "viewer/app/window/redraws.h"
#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {
namespace {

double area(const Viewport& box) { return box.width * box.height; }

TEST(Screen, ItsPartsTileTheWindow) {
  for (const std::uint32_t width : {1u, 100u, 481u, 1280u, 3841u}) {
    for (const std::uint32_t height : {1u, 30u, 321u, 720u, 2160u}) {
      for (const double scale : {1.0, 1.25, 2.0}) {
        for (const bool column : {true, false}) {
          const Screen screen = divide(width, height, scale, column);
          const double all = area(screen.field) + area(screen.column) + area(screen.transport) +
                             area(screen.status);
          EXPECT_EQ(all, static_cast<double>(width) * height) << width << " x " << height;
          EXPECT_GE(screen.field.width, 1);
          EXPECT_GE(screen.field.height, 1);
          EXPECT_EQ(screen.column.width > 0, column && width > 1);
        }
      }
    }
  }
}

TEST(Screen, SizesFollowTheScale) {
  const Screen one = divide(2000, 1400, 1, true);
  const Screen two = divide(2000, 1400, 2, true);
  EXPECT_EQ(two.column.width, 2 * one.column.width);
  EXPECT_EQ(two.status.height, 2 * one.status.height);
}

/// Draws while due; returns the number of frames.
int draw_all(Redraws& redraws, double now_s) {
  int frames = 0;
  while (redraws.due(now_s) && frames < 100) {
    redraws.drawn(now_s);
    ++frames;
  }
  return frames;
}

TEST(Redraws, AnIdleWindowRestsForEver) {
  Redraws redraws;
  EXPECT_EQ(redraws.rest(0), 0);
  draw_all(redraws, 0);
  ASSERT_TRUE(redraws.rest(0));
  const double settles = *redraws.rest(0);
  EXPECT_GT(settles, 0.5);
  EXPECT_FALSE(redraws.due(0.5 * settles));
  EXPECT_EQ(draw_all(redraws, settles), 1);
  EXPECT_FALSE(redraws.rest(settles));
  EXPECT_FALSE(redraws.due(1e6));
}

TEST(Redraws, AFieldIsDrawnOnceAndInputAFewTimes) {
  Redraws redraws;
  draw_all(redraws, 0);
  redraws.field();
  EXPECT_EQ(draw_all(redraws, 10), 1);
  redraws.input(20);
  const int frames = draw_all(redraws, 20);
  EXPECT_GE(frames, 2);
  EXPECT_LT(frames, 10);
}

TEST(Redraws, ANoticeGoesAway) {
  Redraws redraws;
  draw_all(redraws, 0);
  draw_all(redraws, 2);
  redraws.notice(2);
  ASSERT_TRUE(redraws.rest(2));
  const double end = 2 + *redraws.rest(2);
  EXPECT_FALSE(redraws.notice_is_old(end - 0.1));
  EXPECT_TRUE(redraws.notice_is_old(end));
  EXPECT_TRUE(redraws.due(end));
  redraws.forget_notice();
  EXPECT_FALSE(redraws.rest(end));
}

TEST(DrawClock, MediansAreOfTheLastSecondAndOfAll) {
  DrawClock clock;
  for (int i = 0; i < 10; ++i) clock.add(0.1 * i, 5, 20);
  for (int i = 0; i < 5; ++i) clock.add(10 + 0.1 * i, 8 + i, std::nullopt);
  const DrawStatistics lately = clock.lately(10.5);
  EXPECT_EQ(lately.frames_hz, 5);
  EXPECT_EQ(lately.draw_ms_median, 10);
  EXPECT_EQ(lately.latency_ms_median, 0);
  EXPECT_EQ(clock.frames(), 15u);
  EXPECT_EQ(clock.draw_ms_median(), 5);
  EXPECT_EQ(clock.latency_ms_median(), 20);
  EXPECT_EQ(clock.lately(20).frames_hz, 0);
}

}  // namespace
}  // namespace pillarfield::viewer
