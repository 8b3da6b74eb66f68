#include <gtest/gtest.h>

#include <algorithm>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {
namespace {

History::Point at(double time_s) { return {time_s, 0, 1, 2, 3}; }

TEST(History, KeepsTheNewestInOrder) {
  History history(3);
  for (const double time_s : {1.0, 2.0, 3.0, 4.0, 5.0}) history.add(at(time_s));
  ASSERT_EQ(history.points().size(), 3U);
  EXPECT_EQ(history.points().front().time_s, 3);
  EXPECT_EQ(history.points().back().time_s, 5);
  history.clear();
  EXPECT_TRUE(history.points().empty());
}

TEST(History, RemovesLaterPointsWhenThePlayHeadGoesBack) {
  History history(100);
  for (const double time_s : {1.0, 2.0, 3.0, 4.0}) history.add(at(time_s));
  history.add(at(3.0));
  EXPECT_EQ(history.points().size(), 3U) << "3 replaced, 4 removed";
  history.add(at(0.5));
  EXPECT_EQ(history.points().size(), 1U);
}

TEST(History, TimesAlwaysRise) {
  History history(50);
  for (int i = 0; i < 1000; ++i) {
    history.add(at(i * 7919 % 101));
    ASSERT_TRUE(std::ranges::is_sorted(history.points(), std::ranges::less_equal(),
                                       &History::Point::time_s));
    ASSERT_LE(history.points().size(), 50U);
    ASSERT_EQ(history.points().back().time_s, i * 7919 % 101);
  }
}

TEST(History, HoldsOnePointAtLeast) {
  History history(0);
  history.add(at(1));
  EXPECT_EQ(history.points().size(), 1U);
}

}  // namespace
}  // namespace pillarfield::viewer
