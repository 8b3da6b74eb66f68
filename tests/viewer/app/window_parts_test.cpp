// Layout of the window, scheduling of drawing, and its statistics.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "tests/viewer/app/fake_app_state.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/app/panels/plot.h"
#include "viewer/app/source/source_feed.h"
#include "viewer/app/window/gui.h"
#include "viewer/app/window/redraws.h"
#include "viewer/render/contact_marks.h"

namespace pillarfield::viewer {
namespace {

double area(const Viewport& box) { return box.width * box.height; }

constexpr Sides kBothSides{true, 131};

/// Both sides of a skin.
Sides sides_of_skin(double aspect) { return {true, 131, aspect}; }

TEST(Screen, ItsPartsTileTheWindow) {
  for (const std::uint32_t width : {1u, 100u, 481u, 1280u, 3841u}) {
    for (const std::uint32_t height : {1u, 30u, 321u, 720u, 2160u}) {
      for (const double scale : {1.0, 1.25, 2.0}) {
        for (const Sides& sides : {Sides{}, kBothSides, sides_of_skin(0.4), sides_of_skin(3)}) {
          const Screen screen = divide(width, height, scale, sides);
          const double all = area(screen.field) + area(screen.column) + area(screen.row) +
                             area(screen.transport) + area(screen.status);
          EXPECT_EQ(all, static_cast<double>(width) * height) << width << " x " << height;
          EXPECT_GE(screen.field.width, 1);
          EXPECT_GE(screen.field.height, 1);
          EXPECT_EQ(screen.column.width > 0, sides.column && width > 1);
          EXPECT_EQ(screen.row.height > 0, sides.column && height > 300);
        }
      }
    }
  }
}

TEST(Screen, FieldAndCurvesHaveTheirRoom) {
  for (const double scale : {1.0, 1.5}) {
    for (const double aspect : {0.42, 1.0, 2.0}) {
      const auto divided = [&](double width, double height) {
        return divide(static_cast<std::uint32_t>(scale * width),
                      static_cast<std::uint32_t>(scale * height), scale, sides_of_skin(aspect));
      };
      const Screen small = divided(1280, 720);
      EXPECT_GE(area(small.field), 0.55 * 1280 * 720 * scale * scale);
      EXPECT_GE(small.row.height, 120 * scale);
      EXPECT_EQ(small.column.width, 320 * scale);
      const Viewport field = divided(1920, 1080).field;
      RenderSettings settings;
      settings.scale = scale;
      const Viewport plot = layout_of(field.width, field.height, settings).plot;
      const double pixels = fit_top({100 * aspect, 100}, plot).pixels_per_mm;
      EXPECT_LT(area(plot) - aspect * 1e4 * pixels * pixels, 1920 * 1080 * scale * scale / 3);
    }
  }
}

TEST(Layout, LegendLiesBesideThePlot) {
  const Layout whole = layout_of(1000, 600, {});
  EXPECT_LT(whole.plot.x + whole.plot.width, whole.bar.x);
}

TEST(LoadRange, RisesAtOnceAndFallsWithPatience) {
  LoadRange range;
  EXPECT_FALSE(range.add(0, 0));
  EXPECT_EQ(range.add(0.1, 0.5F), 0.5F);
  EXPECT_EQ(range.add(0.2, 4), 4.0F);
  EXPECT_FALSE(range.add(0.3, 3));
  const auto hold = [&](double from_s, double to_s, float most) {
    std::optional<float> last;
    for (int tenth = 0; from_s + 0.1 * tenth < to_s; ++tenth) {
      const double time_s = from_s + 0.1 * tenth;
      if (const auto load = range.add(time_s, most)) last = load;
    }
    return last;
  };
  EXPECT_FALSE(hold(1, 100, 0.1F)) << "noise is no load";
  EXPECT_FALSE(hold(100, 100 + 0.7 * LoadRange::kPatienceS, 1)) << "a short touch";
  EXPECT_FALSE(range.add(110, 3)) << "a load again";
  EXPECT_EQ(hold(110, 111 + LoadRange::kPatienceS, 1), 1.0F);
  EXPECT_EQ(range.add(200, 2), 2.0F);
}

TEST(LoadFollower, ATareForgetsTheLoadBefore) {
  FakeAppState fake;
  LoadFollower follower(true);
  const auto shown = [&](float factor) {
    ShownField& field = *fake.state.source.field;
    const std::vector<float> normal(field.forces.normal.size(), factor);
    field.forces.normal = normal;
    field.arrived = std::chrono::steady_clock::now().time_since_epoch();
    follower.take_field(fake.state);
    return fake.state.look.settings.range.high;
  };
  EXPECT_EQ(shown(1000), 1200);
  EXPECT_EQ(shown(10), 1200);
  follower.forget();
  EXPECT_EQ(shown(0), 1200) << "nothing to show";
  EXPECT_EQ(shown(10), 12);
}

void expect_span(const Span& span, double from, double to) {
  EXPECT_NEAR(span.from, from, 1e-9);
  EXPECT_NEAR(span.to, to, 1e-9);
}

TEST(TimeWindow, ZoomsAboutTheCursorAndStaysInside) {
  TimeWindow window;
  const Span whole{10, 20};
  expect_span(window.of(whole, 0), 10, 20);
  window.zoom(whole, 0, 15, 2);
  expect_span(window.of(whole, 0), 12.5, 17.5);
  window.pan(whole, 0, 100);
  expect_span(window.of(whole, 0), 15, 20);
  window.zoom(whole, 0, 20, 1e9);
  expect_span(window.of(whole, 0), 20 - TimeWindow::kLeastSeconds, 20);
  window.zoom(whole, 0, 15, 1e-9);
  EXPECT_FALSE(window.is_chosen());
}

TEST(TimeWindow, FollowsASensorUntilItIsMovedBack) {
  TimeWindow window;
  expect_span(window.of({0, 100}, 20), 80, 100);
  window.zoom({0, 100}, 20, 100, 4);
  expect_span(window.of({0, 100}, 20), 95, 100);
  expect_span(window.of({0, 130}, 20), 125, 130);
  window.pan({0, 130}, 20, -50);
  expect_span(window.of({0, 130}, 20), 75, 80);
  expect_span(window.of({0, 200}, 20), 75, 80);
  window.reset();
  expect_span(window.of({0, 200}, 20), 180, 200);
}

TEST(Curve, BreaksWhereThereIsNoValue) {
  const FakeGui gui;
  const PlotArea area{{0, 0, 100, 50}, {0, 100}, {0, 1}};
  std::vector<Vec2> places;
  for (int i = 0; i <= 100; ++i) places.push_back({1.0 * i, i > 40 && i < 60 ? NAN : 0.5});
  ImDrawList list(ImGui::GetDrawListSharedData());
  list._ResetForNewFrame();
  draw_curve(list, area, places, 0xffffffff, 1);
  const auto x_of = [&](int i) { return list.VtxBuffer[list.IdxBuffer[i]].pos.x; };
  ASSERT_GT(list.IdxBuffer.Size, 0);
  for (int i = 0; i < list.IdxBuffer.Size; i += 3) {
    const auto [from, to] = std::minmax({x_of(i), x_of(i + 1), x_of(i + 2)});
    EXPECT_TRUE(to < 45 || from > 55);
  }
}

TEST(LabelBoxes, CoverNoLabelOfAHeavierContact) {
  SourceInfo source;
  source.skin.rows = 40;
  source.skin.cols = 80;
  source.skin.sensel_pitch_mm = 0.5;
  RenderSettings settings;
  settings.view = TopView{{0, 0}, 10};
  const Viewport plot{30, 20, 400, 200};
  const ShownContacts contacts = FieldContacts(1).contacts_of(
      touched_field(0, 20, 40, {{{4, 8, 20, 22}, 3}, {{4, 8, 23, 25}, 2}, {{12, 16, 20, 22}, 1}}));
  const auto marks = contact_marks(contacts, Ground(nullptr, source, settings, plot));
  FakeGui gui;
  gui.frame([&] {
    const std::vector<Viewport> labels = label_boxes(marks, plot, 1);
    ASSERT_EQ(labels.size(), 3U);
    EXPECT_GT(labels[0].width, 0);
    EXPECT_EQ(labels[1].width, 0) << "beside a heavier one";
    EXPECT_GT(labels[2].width, 0);
  });
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
  redraws.field();
  EXPECT_EQ(draw_all(redraws, 1e6), 1);
  redraws.input(2e6);
  EXPECT_GE(draw_all(redraws, 2e6), 2);
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

}  // namespace
}  // namespace pillarfield::viewer
