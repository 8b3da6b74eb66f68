// The past pressure of a contact that moves while its load changes.

#include "contacts/estimator/past_pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "contacts/estimator/contact_samples.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kSide = 16;
constexpr double kNoiseN = 0.01;

double pressure(double row, double col) {
  return std::sqrt(std::max(1 - (std::pow(row - 7.5, 2) + std::pow(col - 6.5, 2)) / 25, 0.0));
}

/// A ball pressed down, moved to the right by `moved` pillars, its normal forces times `load`. The
/// pillars of the upper half are ambiguous, at the ends of their segments, if `slips`.
ForceField pressed_ball(double moved, double load, bool slips) {
  ForceField field(kSide, kSide);
  for (std::uint32_t i = 0; i < field.elements(); ++i) {
    const std::uint32_t row = i / kSide;
    const double normal = load * pressure(row, i % kSide - moved);
    if (normal <= 0) continue;
    const bool ambiguous = slips && row < kSide / 2;
    field.normal[i] = static_cast<float>(normal * (ambiguous ? 1.3 : 1));
    field.status[i] = ambiguous ? 9 | status::kAmbiguous : status::kUsable;
  }
  return field;
}

/// Relative error of the past of the ambiguous pillars, root of the mean square, and the largest
/// deviation stated, relative too.
struct Found {
  double error = 0;
  double stated = 0;
};

Found past_of(double moved, double load, double told_moved) {
  const ContactParameters parameters;
  const SegmentModel model{.point = 0.875F};
  PastPressure past;
  for (const bool slips : {false, true}) {
    const ForceField field = slips ? pressed_ball(moved, load, true) : pressed_ball(0, 1, false);
    ContactLabels labels;
    labels.find(field.status, kSide, kSide);
    past.begin(kSide, kSide, labels.runs_by_row());
    past.update(field.view(), labels.runs(0), {0, slips ? told_moved : 0}, kNoiseN, model,
                parameters);
  }
  Found found;
  int pillars = 0;
  for (std::uint32_t i = 0; i < kSide * kSide / 2; ++i) {
    const std::uint32_t row = i / kSide;
    const double truth = load * pressure(row, i % kSide - moved);
    const auto known = past.at(i, 10, kNoiseN);
    if (truth < 0.4 * load || !known) continue;
    found.error += std::pow(known->normal / truth - 1, 2);
    found.stated = std::max(found.stated, std::sqrt(known->variance) / truth);
    ++pillars;
  }
  EXPECT_GT(pillars, 20);
  found.error = std::sqrt(found.error / pillars);
  return found;
}

TEST(PastPressure, ScalesWithTheLoadOfTheDeterminedPillars) {
  for (const double load : {0.5, 1.0, 1.5}) {
    const Found still = past_of(0, load, 0);
    EXPECT_LT(still.error, 0.02) << load;
    EXPECT_LT(still.stated, 0.1) << load;
  }
}

TEST(PastPressure, MovesWithTheContact) {
  const Found moved = past_of(1.5, 1.2, 1.5);
  EXPECT_LT(moved.error, 0.05);
  EXPECT_LT(moved.stated, 0.6);
  // Told another place, it states how far off it is.
  const Found elsewhere = past_of(1.5, 1.2, 0);
  EXPECT_GT(elsewhere.error, 2 * moved.error);
  EXPECT_GT(elsewhere.stated, elsewhere.error);
}

/// A face of five by four pillars that moved by 0.4 pillars to the right and then slips in its
/// upper rows; the left half of it bears `left`, the rest 1 N.
PastPressure moved_face(double left) {
  PastPressure past;
  for (const bool slips : {false, true}) {
    ForceField field(kSide, kSide);
    for (std::uint32_t row = 4; row < 9; ++row) {
      for (std::uint32_t col = 4; col < (slips ? 9U : 8U); ++col) {
        const std::size_t i = std::size_t{row} * kSide + col;
        field.normal[i] = col < 6 ? static_cast<float>(left) : 1;
        field.status[i] = slips && row < 6 ? 9 | status::kAmbiguous : status::kUsable;
      }
    }
    ContactLabels labels;
    labels.find(field.status, kSide, kSide);
    past.begin(kSide, kSide, labels.runs_by_row());
    past.update(field.view(), labels.runs(0), {0, slips ? 0.4 : 0}, kNoiseN, {.point = 1}, {});
  }
  return past;
}

TEST(PastPressure, IsKnownWhereMostOfThePlaceWasInContact) {
  const PastPressure past = moved_face(1);
  const auto at = [&](std::uint32_t col) { return past.at(5 * kSide + col, 10, kNoiseN); };
  EXPECT_TRUE(at(4).has_value());   // 0.6 of it
  EXPECT_FALSE(at(8).has_value());  // 0.4
  EXPECT_FALSE(at(3).has_value());
  EXPECT_FALSE(past.at(7 * kSide + 5, 10, kNoiseN).has_value());  // determined
  EXPECT_NEAR(at(4)->normal, 1, 0.01);
  EXPECT_EQ(past.at(5 * kSide + 4, 0.5, kNoiseN)->normal, 0.5 + kNoiseN);
}

TEST(PastPressure, StatesWhatTheFrameAndAnUncertainPlaceAdd) {
  const auto deviation = [](const PastPressure& past, std::uint32_t col) {
    return std::sqrt(past.at(5 * kSide + col, 10, kNoiseN)->variance);
  };
  // Three hundredths for a frame, and noise.
  const double even = deviation(moved_face(1), 6);
  EXPECT_GT(even, 0.03);
  EXPECT_LT(even, 0.037);
  // Halfway up a step of 1 N: a mean square difference of two places of 0.4 times 0.6 times 2.
  EXPECT_GT(deviation(moved_face(2), 6), std::sqrt(0.48));
}

/// Whatever the status bytes and the place of a run within words of eight.
TEST(ContactSamples, FindPillarsThatAreNotDetermined) {
  ForceField field(1, 256);
  for (std::uint32_t i = 0; i < 256; ++i) field.status[i] = static_cast<std::uint8_t>(i * 37);
  for (const std::uint32_t first : {0U, 3U, 250U}) {
    const std::vector<ContactRun> runs = {{0, first, 253, 0}};
    std::vector<std::uint32_t> found;
    for_each_undetermined(field.view(), runs, [&](std::uint32_t i) { found.push_back(i); });
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = first; i < 253; ++i) {
      if (!is_determined(field.status[i])) expected.push_back(i);
    }
    EXPECT_EQ(found, expected) << first;
  }
}

}  // namespace
}  // namespace pillarfield
