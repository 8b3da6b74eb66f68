// Curves of forces over time, and the survey that measures them for a whole source.
#include "viewer/source/curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/source/survey.h"

namespace pillarfield::viewer {
namespace {

constexpr double kCurvePitch = 1.25;

/// A force that rises with the frame.
ShownField rising_field(std::uint64_t index) {
  const auto force = static_cast<float>(index + 1);
  return touched_field(index, 20, 30,
                       {{{2, 9, 12, 14}, force, 0.5F * force, -1}, {{15, 17, 3, 29}}});
}

TEST(CurvePoint, OfAnIdleSkinHasNoCentre) {
  const CurvePoint idle = curve_point(touched_field(3, 20, 30, {}), kCurvePitch);
  EXPECT_EQ(idle.normal, 0);
  EXPECT_TRUE(std::isnan(idle.centre_x_mm));
  EXPECT_TRUE(std::isnan(idle.torque));
}

/// A field of random forces and status bytes.
ForceField random_forces(std::uint32_t rows, std::uint32_t cols) {
  ForceField forces(rows, cols);
  std::mt19937 random(rows * 100 + cols);
  std::uniform_real_distribution<float> force(-1, 1);
  for (std::size_t i = 0; i < forces.elements(); ++i) {
    forces.shear_x[i] = force(random);
    forces.shear_y[i] = force(random);
    forces.normal[i] = 1 + force(random);
    forces.status[i] = static_cast<std::uint8_t>(random() % 3 == 0 ? 0 : random() % 256);
  }
  return forces;
}

TEST(CurvePoint, IsTheSumOfAPlainLoop) {
  for (const auto& [rows, cols] : {std::pair{1U, 1U}, std::pair{9U, 14U}, std::pair{20U, 33U}}) {
    ForceField forces = random_forces(rows, cols);
    forces.normal[0] = std::nanf("");
    double normal = 0, shear_x = 0, shear_y = 0, moment_x = 0, moment_y = 0, turn = 0;
    for (std::size_t i = 1; i < forces.elements(); ++i) {
      if ((forces.status[i] & status::kLoaded) == 0) continue;
      const double x = kCurvePitch * (static_cast<double>(i % cols) + 0.5 - 0.5 * cols);
      const double y = kCurvePitch * (0.5 * rows - static_cast<double>(i / cols) - 0.5);
      const double n = forces.normal[i], sx = forces.shear_x[i], sy = forces.shear_y[i];
      normal += n;
      shear_x += sx;
      shear_y += sy;
      moment_x += n * x;
      moment_y += n * y;
      turn += x * sy - y * sx;
    }
    ShownField field;
    field.forces = forces.view();
    const CurvePoint point = curve_point(field, kCurvePitch);
    EXPECT_NEAR(point.normal, normal, 1e-4);
    EXPECT_NEAR(point.shear_x, shear_x, 1e-4);
    EXPECT_NEAR(point.shear_y, shear_y, 1e-4);
    if (!(normal > 0)) continue;
    EXPECT_NEAR(point.centre_x_mm, moment_x / normal, 1e-4);
    EXPECT_NEAR(point.centre_y_mm, moment_y / normal, 1e-4);
    EXPECT_NEAR(point.torque, turn - (moment_x * shear_y - moment_y * shear_x) / normal, 1e-3);
  }
}

TEST(CurvePoint, ATurnToTheLeftIsPositive) {
  ShownField field = touched_field(0, 3, 3, {{{1, 2, 0, 1}, 2, 0, -1}, {{1, 2, 2, 3}, 2, 0, 1}});
  const CurvePoint point = curve_point(field, kCurvePitch);
  EXPECT_FLOAT_EQ(point.torque, 2 * kCurvePitch);
  EXPECT_EQ(point.centre_x_mm, 0);
  EXPECT_EQ(point.centre_y_mm, 0);
}

TEST(Curves, TakeEachFrameOnce) {
  Curves curves(kCurvePitch);
  for (const std::uint64_t index : {0U, 1U, 1U, 0U, 2U}) curves.add(rising_field(index));
  EXPECT_EQ(curves.between(0, 1, 100).size(), 3U);
  EXPECT_EQ(curves.next(), 3U);
}

TEST(Curves, ThinningKeepsThePeakAndTheNeighboursOfTheWindow) {
  Curves curves(kCurvePitch);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    curves.add(CurvePoint{.time_s = 0.01 * static_cast<double>(i),
                          .index = i,
                          .normal = i == 457   ? 9.0F
                                    : i == 613 ? -2.0F
                                               : 1.0F});
  }
  const auto points = curves.between(0, 100, 50);
  EXPECT_LE(points.size(), 52U);
  const auto [low, high] = std::ranges::minmax(points, {}, &CurvePoint::normal);
  EXPECT_EQ(low.index, 613U);
  EXPECT_EQ(high.index, 457U);
  const auto window = curves.between(2.005, 2.025, 50);
  ASSERT_EQ(window.size(), 4U);
  EXPECT_EQ(window.front().index, 200U);
  EXPECT_EQ(window.back().index, 203U);
}

TEST(Curves, ALongCurveLosesItsBegin) {
  Curves curves(kCurvePitch, 10);
  for (std::uint64_t i = 0; i < 25; ++i) curves.add(rising_field(i));
  const auto points = curves.between(-1, 1, 100);
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
    if (index % 2 != 0 || index == 40) return std::nullopt;
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

TEST(Survey, MeasuresEveryFrameThenNewFrames) {
  const auto curves = std::make_shared<Curves>(kCurvePitch);
  Survey survey([] { return std::make_unique<RisingProducer>(20); }, curves);
  wait_until([&] { return survey.progress().done == 20; });
  const auto points = curves->between(0, 1, 100);
  ASSERT_EQ(points.size(), 20U);
  EXPECT_EQ(points[6].normal, -1) << "stored";
  EXPECT_EQ(points[7].normal, curve_point(rising_field(7), kCurvePitch).normal);
  survey.set_follow(true);
  wait_until([&] { return survey.progress().done == 30; });
}

TEST(Survey, AFailureIsReportedAndWhatWasMeasuredStays) {
  const auto curves = std::make_shared<Curves>(kCurvePitch);
  Survey survey([] { return std::make_unique<RisingProducer>(50); }, curves);
  wait_until([&] { return !survey.progress().failure.empty(); });
  EXPECT_NE(survey.progress().failure.find("frame 40 is damaged"), std::string::npos);
  EXPECT_EQ(curves->between(0, 1, 100).size(), 40U);
}

}  // namespace
}  // namespace pillarfield::viewer
