// The field estimator: what it may touch, what it must not make worse, and contacts that are hard
// for it, by name.

#include "core/field_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/host_solve.h"
#include "field_study.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr float kThreshold = 2;
SolverPlan plan_of(std::uint32_t rows, std::uint32_t cols) {
  SolverPlan plan;
  plan.skin.rows = 2 * rows;
  plan.skin.cols = 2 * cols;
  plan.skin.counts_per_newton = 1;
  plan.skin.threshold_counts = kThreshold;
  plan.sensel_type = SenselType::f32;
  plan.noise_counts = 0.5;
  plan.estimator = Estimator::field;
  return plan;
}

/// A frame of float32 readings that pillars are pressed into one by one.
class Pressed {
 public:
  Pressed(std::uint32_t rows, std::uint32_t cols)
      : plan(plan_of(rows, cols)), readings_(4 * std::size_t{rows} * cols) {}

  /// A pillar that slips to the right: its right sensels read, its left ones are lifted.
  void slip(std::uint32_t row, std::uint32_t col, double normal, double friction) {
    const double reading = normal * (1 + friction / std::numbers::sqrt2);
    set(2 * row, 2 * col + 1, reading);
    set(2 * row + 1, 2 * col + 1, reading);
  }
  /// A pillar with any force; what would be pulled reads nothing.
  void push(std::uint32_t row, std::uint32_t col, double normal, double ratio, double azimuth) {
    constexpr std::array<std::array<std::uint32_t, 2>, 4> kPlaces = {
        {{0, 1}, {0, 0}, {1, 0}, {1, 1}}};
    for (std::size_t n = 0; n < 4; ++n) {
      const double sensel = std::numbers::pi / 4 * (2 * static_cast<double>(n) + 1);
      const double reading = normal * (1 + ratio * std::cos(azimuth - sensel));
      set(2 * row + kPlaces.at(n)[0], 2 * col + kPlaces.at(n)[1], std::max(0.0, reading));
    }
  }
  void press(std::uint32_t row, std::uint32_t col, double normal) {
    for (const std::uint32_t at : {0U, 1U}) {
      set(2 * row + at, 2 * col, normal);
      set(2 * row + at, 2 * col + 1, normal);
    }
  }
  void set(std::uint32_t row, std::uint32_t col, double reading) {
    readings_[std::size_t{row} * plan.skin.cols + col] = static_cast<float>(reading);
  }
  [[nodiscard]] ForceField solve() const { return solve_on_host(plan, frame()); }
  [[nodiscard]] ForceField direct() const {
    SolverPlan other = plan;
    other.estimator = Estimator::direct;
    return solve_on_host(other, frame());
  }

  SolverPlan plan;

 private:
  [[nodiscard]] FrameView frame() const {
    return {readings_.data(), SenselType::f32, plan.skin.rows, plan.skin.cols, plan.skin.cols};
  }

  std::vector<float> readings_;
};

double theta_of(const ForceField& field, std::size_t i) {
  return std::atan2(std::hypot(field.shear_x[i], field.shear_y[i]), field.normal[i]);
}

/// Where nothing is known, theta is halfway between that of the steepest force and a right angle.
void expect_middle(const ForceField& solved, const ForceField& direct, std::size_t i) {
  const double high = direct.normal[i] / kSegmentPoint;
  const double rest = (high - direct.normal[i]) * std::numbers::sqrt2;
  const double steepest = std::atan2(std::hypot(direct.shear_x[i] - rest, direct.shear_y[i]), high);
  EXPECT_NEAR(theta_of(solved, i), (steepest + std::numbers::pi / 2) / 2, 1e-5);
  EXPECT_EQ(solved.status[i], direct.status[i]);
}

TEST(FieldEstimate, OnePillarKeepsTheMiddle) {
  Pressed skin(5, 5);
  skin.slip(2, 2, 40, 1.8);
  expect_middle(skin.solve(), skin.direct(), 12);
}

TEST(FieldEstimate, AWholeSkinThatSlidesKeepsTheMiddle) {
  Pressed skin(20, 20);
  for (std::uint32_t i = 0; i < 400; ++i) skin.slip(i / 20, i % 20, 40, 1.8);
  const ForceField solved = skin.solve();
  const ForceField direct = skin.direct();
  for (std::size_t i = 0; i < 400; ++i) expect_middle(solved, direct, i);
}

TEST(FieldEstimate, TheSkinMayEndInTheContact) {
  Pressed skin(12, 12);
  for (std::uint32_t row = 0; row < 12; ++row) {
    for (std::uint32_t col = 0; col < 12; ++col) {
      if (col < 6) {
        skin.press(row, col, 50);
      } else {
        skin.slip(row, col, 50, 1.7);
      }
    }
  }
  const ForceField solved = skin.solve();
  for (const float normal : solved.normal) {
    EXPECT_TRUE(std::isfinite(normal));
    EXPECT_GT(normal, 0);
  }
}

TEST(FieldEstimate, WhatSlipsAtAKnownFrictionIsExact) {
  Pressed skin(9, 9);
  for (std::uint32_t i = 0; i < 81; ++i) skin.slip(i / 9, i % 9, 30 + i, 1.9);
  skin.plan.field.friction = 1.9;
  skin.plan.field.slips = true;
  const ForceField solved = skin.solve();
  for (std::size_t i = 0; i < 81; ++i) {
    ASSERT_NEAR(solved.normal[i], 30 + static_cast<double>(i), 1e-3);
    ASSERT_NEAR(solved.shear_x[i], 1.9 * (30 + static_cast<double>(i)), 2e-3);
    ASSERT_EQ(solved.status[i] & status::kFromNeighbours, status::kFromNeighbours);
  }
}

TEST(FieldEstimate, ABoundIsKept) {
  Pressed skin(9, 9);
  for (std::uint32_t i = 0; i < 81; ++i) skin.slip(i / 9, i % 9, 30 + i, 1.9);
  skin.plan.field.friction = 1.9;
  const ForceField solved = skin.solve();
  for (std::size_t i = 0; i < 81; ++i) {
    EXPECT_GE(solved.normal[i], 29.99 + static_cast<double>(i));
    EXPECT_EQ(solved.status[i] & status::kFromNeighbours, 0) << "a bound resolves nothing";
  }
}

TEST(FieldEstimate, APillarIsRememberedAFrameLongAndForgotten) {
  Pressed before(5, 5);
  before.press(2, 2, 40);
  Pressed after(5, 5);
  after.slip(2, 2, 40, 1.8);
  after.plan.field.frames_close = true;
  HostFieldEstimator estimator(after.plan);
  ForceField first = before.direct();
  estimator.resolve(first);
  ForceField second = after.direct();
  estimator.resolve(second);
  EXPECT_NEAR(second.normal[12], 40, 1e-3);
  EXPECT_NE(second.status[12] & status::kFromNeighbours, 0);
  ForceField gone = Pressed(5, 5).direct();
  estimator.resolve(gone);
  ForceField again = after.direct();
  estimator.resolve(again);
  expect_middle(again, after.direct(), 12);
}

TEST(FieldEstimate, FaultsAndSaturationAreLeftAlone) {
  Pressed skin(8, 8);
  skin.plan.skin.full_scale_counts = 200;
  for (std::uint32_t i = 0; i < 64; ++i) skin.slip(i / 8, i % 8, 40, 1.8);
  skin.set(4, 5, 1000);
  skin.set(9, 8, std::numeric_limits<float>::quiet_NaN());  // One that would be lifted.
  const ForceField solved = skin.solve();
  const ForceField direct = skin.direct();
  int faults = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    if ((direct.status[i] & (status::kSaturated | status::kInconsistent)) == 0) continue;
    ++faults;
    EXPECT_EQ(solved.normal[i], direct.normal[i]);
    EXPECT_EQ(solved.status[i], direct.status[i]);
  }
  EXPECT_EQ(faults, 2);
}

TEST(FieldEstimate, IsTheSameBitsWithAnyThreads) {
  // Six contacts of their own friction, each half open.
  Pressed skin(24, 33);
  for (std::uint32_t i = 0; i < 6 * 100; ++i) {
    const std::uint32_t contact = i / 100;
    const double direction = i % 100 < 60 ? std::numbers::pi / 4 : 0;
    skin.push(i % 100 / 10 + 12 * (contact % 2), i % 10 + 11 * (contact / 2), 50 + i % 7,
              1.6 + 0.1 * contact, direction);
  }
  ForceField expected = skin.direct();
  HostFieldEstimator(skin.plan).resolve(expected);
  HostFieldEstimator shared(skin.plan, 3);
  for (int turn = 0; turn < 20; ++turn) {
    ForceField field = skin.direct();
    shared.resolve(field);
    ASSERT_EQ(shared.work().tiles().size(), 6U);
    EXPECT_EQ(field.normal, expected.normal);
    EXPECT_EQ(field.shear_x, expected.shear_x);
    EXPECT_EQ(field.shear_y, expected.shear_y);
    EXPECT_EQ(field.status, expected.status);
  }
}

TEST(FieldEstimate, MemoryOfThinContactsStaysSmall) {
  // Nested angles, each with a box as large as the skin: their boxes would take 100 times the skin.
  constexpr std::uint32_t kSize = 200;
  Pressed skin(kSize, kSize);
  for (std::uint32_t ring = 0; ring < kSize; ring += 2) {
    for (std::uint32_t at = 0; at < kSize - ring; ++at) {
      skin.slip(ring, ring + at, 40, 1.8);
      if (at > 30) {
        skin.press(ring + at, ring, 40);
      }
    }
  }
  HostFieldEstimator estimator(skin.plan);
  ForceField field = skin.direct();
  estimator.resolve(field);
  EXPECT_LE(estimator.work().cells(), 17U * kSize * kSize + 1024U * 100U);
}

TEST(FieldEstimate, AFrictionThatOpenPillarsExceedIsNotTheirs) {
  // Sixty pillars share a ratio of 1.5, shown along a diagonal; thirty open ones have 3 and cannot
  // have less than 2.3, whatever their normal force.
  Pressed skin(9, 10);
  for (std::uint32_t i = 0; i < 90; ++i) {
    const bool shows = i < 60;
    skin.push(i / 10, i % 10, 50, shows ? 1.5 : 3, shows ? std::numbers::pi / 4 : 0.35);
  }
  HostFieldEstimator estimator(skin.plan);
  ForceField field = skin.direct();
  estimator.resolve(field);
  ASSERT_EQ(estimator.verdicts().size(), 1U);
  EXPECT_NE(estimator.verdicts()[0].way, PF_BY_SLIP);
}

TEST(FieldEstimate, AFrictionThatIsShownIsTakenOver) {
  Pressed skin(9, 10);
  for (std::uint32_t i = 0; i < 90; ++i) {
    skin.push(i / 10, i % 10, 50, 1.8, i < 60 ? std::numbers::pi / 4 : 0);
  }
  HostFieldEstimator estimator(skin.plan);
  ForceField field = skin.direct();
  estimator.resolve(field);
  ASSERT_EQ(estimator.verdicts().size(), 1U);
  EXPECT_EQ(estimator.verdicts()[0].way, PF_BY_SLIP);
  EXPECT_NEAR(estimator.verdicts()[0].friction, 1.8, 0.02);
  for (std::size_t i = 60; i < 90; ++i) EXPECT_NEAR(field.normal[i], 50, 1);
}

namespace maths = single_precision;

TEST(Plateau, IsWhatMostShareAndLittleExceeds) {
  std::array<std::uint32_t, PF_RATIO_COUNTS> counts{};
  counts.at(maths::bin_of_ratio(1.8F)) = 50;
  counts.at(maths::bin_of_ratio(0.9F)) = 20;
  counts.at(maths::bin_of_ratio(1.95F)) = 10;
  counts.at(maths::bin_of_ratio(3.0F)) = 15;
  counts.at(PF_RATIO_NONE) = 5;
  const maths::Plateau plateau = maths::find_plateau(counts.data(), 1.06F);
  EXPECT_NEAR(plateau.ratio, 1.8, 0.02);
  EXPECT_NEAR(plateau.share, 0.5, 1e-9);
  EXPECT_NEAR(plateau.above, 0.25, 1e-9);
  EXPECT_NEAR(plateau.far, 0.15, 1e-9);
  EXPECT_EQ(maths::find_plateau(std::array<std::uint32_t, PF_RATIO_COUNTS>{}.data(), 1.06F).share,
            0);
}

TEST(Plateau, BinsKeepTheOrderOfRatios) {
  std::uint32_t before = 0;
  for (int step = 0; step < 2000; ++step) {
    const float ratio = 0.4F * std::pow(1.003F, static_cast<float>(step));
    const std::uint32_t bin = maths::bin_of_ratio(ratio);
    ASSERT_GE(bin, before);
    before = bin;
    if (bin == 0 || bin >= PF_RATIO_BINS) continue;
    ASSERT_LE(maths::ratio_of_bin(bin), ratio);
    ASSERT_GT(maths::ratio_of_bin(bin + 1), ratio);
  }
  EXPECT_EQ(before, PF_RATIO_BEYOND);
}

TEST(Score, FallsByWhatIsFarAboveAndByTheMisfit) {
  std::array<std::uint32_t, PF_RATIO_COUNTS> counts{};
  counts.at(maths::bin_of_ratio(1.8F)) = 80;
  counts.at(maths::bin_of_ratio(1.0F)) = 20;
  maths::Trend trend = maths::no_trend(2, true);
  const auto verdict = [&](double misfit) {
    const maths::Plateau plateau = maths::find_plateau(counts.data(), PF_IMPLIED_WINDOW);
    return maths::verdict_of_shape(plateau, &trend, misfit);
  };
  EXPECT_NEAR(verdict(0).score, 0.8, 1e-6);
  EXPECT_NEAR(verdict(0.1).score, 0.7, 1e-6);
  const float sure = verdict(0).spread;
  EXPECT_NEAR(verdict(0.1).spread, sure + 0.1, 1e-6);
  trend.scale_error = 0.02;
  EXPECT_NEAR(verdict(0).spread, sure + 0.2, 1e-6);
  counts.at(maths::bin_of_ratio(1.0F)) = 0;
  counts.at(maths::bin_of_ratio(4.0F)) = 20;
  EXPECT_NEAR(verdict(0).score, 0.5, 1e-6);
}

TEST(Score, AModelsFrictionIsWiderByTheRatiosAboutItAndByThoseThatDoNotShareIt) {
  const maths::Trend trend = maths::no_trend(2, true);
  const auto spread = [&](double share, double about) {
    const maths::Plateau plateau = {1.8, share, 0, 0, about};
    return maths::verdict_of_shape(plateau, &trend, 0).spread;
  };
  EXPECT_EQ(spread(1, 0), 0);
  EXPECT_NEAR(spread(1, 0.1), 0.1 * PF_PLATEAU_SPREADS, 1e-7);
  EXPECT_NEAR(spread(0.4, 0.1), 0.1 * PF_PLATEAU_SPREADS + 0.6 * PF_SPREAD_OF_REST, 1e-7);
}

TEST(Edge, WeighsByHowLittleIsBorneBesideIt) {
  std::array<float, 3> top = {0, 0, 0};
  maths::Cells cells{};
  cells.top = top.data();
  EXPECT_EQ(maths::edge_weight(cells, 1, 1, 10), 1);
  top = {0, 2, 5};
  EXPECT_NEAR(maths::edge_weight(cells, 1, 1, 10), 0.25, 1e-6);
  top = {0, 6, 5};
  EXPECT_NEAR(maths::edge_weight(cells, 1, 1, 10), 0.16, 1e-6);
  top = {0, 10, 5};
  EXPECT_EQ(maths::edge_weight(cells, 1, 1, 10), 0);
}

/// On the study's tuning scenes; those that judge are the page's.
class OnScenes : public testing::Test {
 protected:
  /// Calls `check(score, midpoint, scene)` with those of every scene whose name contains a filter.
  template <class Check>
  static void for_scenes(const char* filter, Check check) {
    auto scenes = field_study::tuning(filter);
    ASSERT_FALSE(scenes.empty());
    field_study::integrate(scenes);
    for (const field_study::Scene& scene : scenes) {
      if (scene.noise_counts != 0.5) continue;
      const field_study::Observed observed(scene);
      const auto solved =
          field_study::solve(scene, observed, field_study::methods()[field_study::kNothingSaid]);
      const field_study::Score midpoint = observed.score(observed.theta_midpoint());
      if (midpoint.open < 30) continue;
      check(observed.score(*solved), midpoint, scene);
    }
  }
};

TEST_F(OnScenes, NothingIsMadeWorse) {
  for (const char* filter : {"punch 26", "cone 29", "slide"}) {
    for_scenes(filter, [](const auto& score, const auto& midpoint, const auto& scene) {
      EXPECT_LE(score.rms_counts(), 1.02 * midpoint.rms_counts()) << scene.name();
      EXPECT_EQ(score.touched, 0U) << "pillars of regions 1 and 2 in " << scene.name();
    });
  }
}

TEST_F(OnScenes, SpinIsResolvedWhateverTheShape) {
  for_scenes(", spin", [](const auto& score, const auto& midpoint, const auto& scene) {
    EXPECT_LE(score.rms_counts(), 0.1 * midpoint.rms_counts()) << scene.name();
  });
}

TEST_F(OnScenes, WhatSlipsInPartIsResolvedWithWhatSticks) {
  for (const char* filter : {"partial turn", "two spheres 21, partial slip 0.5"}) {
    for_scenes(filter, [](const auto& score, const auto& midpoint, const auto& scene) {
      EXPECT_LE(score.rms_counts(), 0.3 * midpoint.rms_counts()) << scene.name();
      EXPECT_GE(score.coverage(), 0.9) << scene.name();
    });
  }
}

TEST_F(OnScenes, RoundContactsThatStickInTheMiddleAreResolved) {
  for (const char* filter : {"sphere 31, partial slip 0.5", "sphere 31, partial slip 0.7",
                             "paraboloid 27, partial slip 0.5", "cylinder 15, roll"}) {
    for_scenes(filter, [](const auto& score, const auto& midpoint, const auto& scene) {
      EXPECT_LE(score.rms_counts(), 0.3 * midpoint.rms_counts()) << scene.name();
      EXPECT_EQ(score.resolved, score.open) << scene.name();
    });
  }
}

/// Where trends of the whole contact find a wrong friction, or none.
TEST_F(OnScenes, WhatNoTrendFollowsIsReadAlongItsFlanks) {
  for (const char* filter : {"sphere 31, partial slip 0.93 at 175°, mu 2.3",
                             "wavy 33 x 9, partial slip 0.93 at 86.5°, mu 1.8",
                             "cone 29, partial slip 0.75 at 269.5°, mu 2.3"}) {
    for_scenes(filter, [](const auto& score, const auto& midpoint, const auto& scene) {
      EXPECT_LE(score.rms_counts(), 0.15 * midpoint.rms_counts()) << scene.name();
      EXPECT_GE(score.coverage(), 0.93) << scene.name();
    });
  }
}

}  // namespace
}  // namespace pillarfield
