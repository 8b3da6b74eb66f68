// Curves of forces over time, and the survey that measures them for a whole source.
#include "viewer/source/curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "pillarfield/error.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/source/survey.h"

namespace pillarfield::viewer {
namespace {

constexpr double kCurvePitch = 1.25;
constexpr PillarRect kWholeSkin{0, 20, 0, 30};

/// A force that rises with the frame.
ShownField rising_field(std::uint64_t index) {
  const auto force = static_cast<float>(index + 1);
  return touched_field(index, 20, 30,
                       {{{2, 9, 12, 14}, force, 0.5F * force, -1}, {{15, 17, 3, 29}}});
}

TEST(CurvePoint, OfAnIdleSkinHasNoCentre) {
  const CurvePoint idle = curve_point(touched_field(3, 20, 30, {}), kWholeSkin, kCurvePitch);
  EXPECT_EQ(idle.normal, 0);
  EXPECT_TRUE(std::isnan(idle.centre_x_mm));
  EXPECT_TRUE(std::isnan(idle.torque));
}

TEST(Curves, TakeEachFrameOnceAndKeepThoseOfARectangleThatStays) {
  Curves curves(kCurvePitch);
  const PillarRect first{2, 3, 12, 13};
  const PillarRect second{15, 17, 3, 29};
  curves.set_rects(std::vector{first});
  for (const std::uint64_t index : {0U, 1U, 1U, 0U, 2U}) curves.add(rising_field(index));
  EXPECT_EQ(curves.total(0, 1, 100).size(), 3U);
  curves.set_rects(std::vector{second, first});
  EXPECT_EQ(curves.of(first, 0, 1, 100).size(), 3U);
  EXPECT_EQ(curves.of(second, 0, 1, 100).size(), 0U);
  EXPECT_EQ(curves.next(), 0U);
  curves.add(rising_field(0));
  EXPECT_EQ(curves.next(), 1U);
  EXPECT_EQ(curves.total(0, 1, 100).size(), 3U);
  EXPECT_FLOAT_EQ(curves.of(first, 0, 1, 100)[2].normal, 3);
}

TEST(Curves, ThinningKeepsThePeakAndTheNeighboursOfTheWindow) {
  Curves curves(kCurvePitch);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    curves.add_total({.time_s = 0.01 * static_cast<double>(i),
                      .index = i,
                      .normal = i == 457   ? 9.0F
                                : i == 613 ? -2.0F
                                           : 1.0F});
  }
  const auto points = curves.total(0, 100, 50);
  EXPECT_LE(points.size(), 52U);
  const auto [low, high] = std::ranges::minmax(points, {}, &CurvePoint::normal);
  EXPECT_EQ(low.index, 613U);
  EXPECT_EQ(high.index, 457U);
  const auto window = curves.total(2.005, 2.025, 50);
  ASSERT_EQ(window.size(), 4U);
  EXPECT_EQ(window.front().index, 200U);
  EXPECT_EQ(window.back().index, 203U);
}

TEST(Curves, ALongCurveLosesItsBegin) {
  Curves curves(kCurvePitch, 10);
  for (std::uint64_t i = 0; i < 25; ++i) curves.add(rising_field(i));
  const auto points = curves.total(-1, 1, 100);
  ASSERT_EQ(points.size(), 10U);
  EXPECT_EQ(points.front().index, 15U);
}

/// Rising fields, of which the even frames have a stored total.
class RisingProducer final : public FieldProducer {
 public:
  explicit RisingProducer(std::uint64_t frames) { info_.frames = frames; }
  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override {
    if (index == 40) throw Error("rising", "frame 40 is damaged", "repair it");
    return rising_field(index);
  }
  [[nodiscard]] std::optional<CurvePoint> stored_total(std::uint64_t index) override {
    if (index % 2 != 0) return std::nullopt;
    return CurvePoint{.time_s = 0.01 * static_cast<double>(index), .index = index, .normal = -1};
  }
  bool refresh() override {
    info_.frames = 30;
    return true;
  }

 private:
  SourceInfo info_;
};

template <class Condition>
void wait_until(Condition condition) {
  for (int i = 0; i < 300'000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(condition());
}

TEST(Survey, MeasuresEveryFrameThenNewRectanglesAndNewFrames) {
  const auto curves = std::make_shared<Curves>(kCurvePitch);
  Survey survey([] { return std::make_unique<RisingProducer>(20); }, curves);
  wait_until([&] { return survey.progress().done == 20; });
  const auto total = curves->total(0, 1, 100);
  ASSERT_EQ(total.size(), 20U);
  EXPECT_EQ(total[6].normal, -1) << "stored";
  EXPECT_FLOAT_EQ(total[7].normal,
                  static_cast<float>(sums_over(rising_field(7), kWholeSkin, 1).normal));
  const PillarRect pillar{2, 3, 12, 13};
  curves->set_rects(std::vector{pillar});
  survey.look_again();
  wait_until([&] { return curves->of(pillar, 0, 1, 100).size() == 20; });
  survey.set_follow(true);
  wait_until([&] { return survey.progress().done == 30; });
  EXPECT_EQ(curves->of(pillar, 0, 1, 100).size(), 30U);
}

TEST(Survey, AFailureIsReportedAndWhatWasMeasuredStays) {
  const auto curves = std::make_shared<Curves>(kCurvePitch);
  const PillarRect pillar{2, 3, 12, 13};
  curves->set_rects(std::vector{pillar});
  Survey survey([] { return std::make_unique<RisingProducer>(50); }, curves);
  wait_until([&] { return !survey.progress().failure.empty(); });
  EXPECT_NE(survey.progress().failure.find("frame 40 is damaged"), std::string::npos);
  EXPECT_EQ(curves->of(pillar, 0, 1, 100).size(), 40U);
}

}  // namespace
}  // namespace pillarfield::viewer
