// The oracle against closed forms.

#include "lab/studies/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lab/studies/paper_oracle.h"

namespace pillarfield::oracle {
namespace {

constexpr double kTiny = 1e-30;

void expect_close(Exact actual, Exact expected) {
  EXPECT_LE(static_cast<double>(exact::abs(actual - expected)), kTiny);
}

void expect_same(const Force& actual, const Force& expected) {
  expect_close(actual.shear_x, expected.shear_x);
  expect_close(actual.shear_y, expected.shear_y);
  expect_close(actual.normal, expected.normal);
}

TEST(Exact, KnownAngles) {
  EXPECT_EQ(static_cast<double>(exact::pi()), M_PI);
  expect_close(exact::sin(exact::pi() / 6), Exact(1) / 2);
  expect_close(exact::cos(exact::pi() / 3), Exact(1) / 2);
  expect_close(exact::sin(-7 * exact::pi() / 6), Exact(1) / 2);
  expect_close(exact::sqrt(2) * exact::sqrt(2), 2);
  expect_close(2 * exact::cos(exact::pi() / 4), exact::sqrt(2));
}

TEST(Exact, CircleAndItsAngleAgree) {
  for (int i = -31; i <= 31; ++i) {
    const Exact angle = Exact(i) / 10;
    const Exact sine = exact::sin(angle);
    const Exact cosine = exact::cos(angle);
    expect_close(sine * sine + cosine * cosine, 1);
    expect_close(exact::atan2(3 * sine, 3 * cosine), angle);
    EXPECT_NEAR(static_cast<double>(sine), std::sin(i / 10.0), 1e-15);
    EXPECT_NEAR(static_cast<double>(cosine), std::cos(i / 10.0), 1e-15);
  }
}

TEST(Oracle, PressingAloneReadsTheSameEverywhere) {
  for (const Exact reading : readings_from(3, 0, 1, 10)) expect_close(reading, 30);
}

TEST(Oracle, AForceFromSenselThreePressesSenselOne) {
  const Readings readings = readings_from(1, exact::pi() / 2, 5 * exact::pi() / 4, 1);
  expect_close(readings[0], 1);
  expect_close(readings[1], 0);
  expect_close(readings[2], -1);
  expect_close(readings[3], 0);
}

TEST(Oracle, AnglesAndComponentsGiveTheSameReadings) {
  for (int i = 0; i < 40; ++i) {
    const Exact theta = Exact(i) / 26;
    const Exact phi = Exact(i * 7 % 63 - 31) / 10;
    const Readings by_angles = readings_from(2, theta, phi, 5);
    const Readings by_components = readings_of(force_from(2, theta, phi), 5);
    for (std::size_t n = 0; n < 4; ++n) expect_close(by_angles[n], by_components[n]);
  }
}

TEST(Oracle, EliminationFindsTheForceFromAnyThree) {
  const Force force = force_from(2, Exact(1) / 3, Exact(5) / 4);
  const Readings readings = readings_of(force, 7);
  for (std::size_t absent = 0; absent <= 4; ++absent) {
    SomeReadings usable;
    for (std::size_t n = 0; n < 4; ++n) {
      if (n != absent) usable[n] = readings[n];
    }
    const Force found = least_squares(usable, 7);
    expect_close(found.shear_x, force.shear_x);
    expect_close(found.shear_y, force.shear_y);
    expect_close(found.normal, force.normal);
  }
}

TEST(Oracle, ResidualsOfTheBestFitAreOrthogonalToTheModel) {
  const SomeReadings usable = {Exact(5), Exact(1), Exact(3), Exact(6)};
  const Readings fit = readings_of(least_squares(usable, 2), 2);
  std::array<Exact, 4> residual{};
  for (std::size_t n = 0; n < 4; ++n) residual[n] = *usable[n] - fit[n];
  expect_close(residual[0] + residual[1] + residual[2] + residual[3], 0);
  expect_close(residual[0], residual[2]);
  expect_close(residual[1], residual[3]);
}

TEST(Oracle, TheSegmentEndsWhereAnInactiveSenselWouldRead) {
  const SomeReadings usable = {Exact(2), Exact(3), std::nullopt, std::nullopt};
  const Segment segment = segment_of(usable, 1);
  expect_close(segment.low.normal, 0);
  expect_close(segment.high.normal, 1);
  const Readings at_end = readings_of(segment.high, 1);
  expect_close(at_end[0], 2);
  expect_close(at_end[1], 3);
  expect_close(at_end[2], 0);
  expect_close(at_end[3], -1);
}

TEST(Oracle, OnePressedSenselAloneHasAForceAlongTheSkin) {
  const SomeReadings usable = {Exact(3), std::nullopt, std::nullopt, std::nullopt};
  const Force flat = direct_force(usable, 2);
  const Force expected = force_from(Exact(3) / 2, exact::pi() / 2, 5 * exact::pi() / 4);
  expect_same(flat, expected);
  expect_same(paper_force(usable, 2, {}), expected);
  // Inactive sensels with a bound of two counts leave a segment; at its end the neighbours read
  // two.
  const Readings at_end = readings_of(segment_of(usable, 2, 2).high, 2);
  expect_close(at_end[0], 3);
  expect_close(at_end[1], 2);
  expect_close(at_end[2], 1);
  expect_close(at_end[3], 2);
}

TEST(Oracle, TwoOppositeReadingsHaveAForceOfTheirOwn) {
  const SomeReadings usable = {std::nullopt, Exact(5), std::nullopt, Exact(1)};
  const Readings readings = readings_of(direct_force(usable, 3), 3);
  expect_close(readings[1], 5);
  expect_close(readings[3], 1);
  expect_close(readings[0], 3);
  expect_close(readings[2], 3);
}

/// Calls `check(force, usable readings)` for forces of 2 N with k = 5 from all directions.
template <class Check>
void for_directions(Check check) {
  for (int i = 1; i < 30; ++i) {
    for (int j = 0; j < 40; ++j) {
      const Force force = force_from(2, Exact(i) / 19, Exact(2 * j - 39) / 13);
      SomeReadings usable;
      const Readings readings = readings_of(force, 5);
      for (std::size_t n = 0; n < 4; ++n) {
        if (readings[n] > 0) usable[n] = readings[n];
      }
      check(force, usable);
    }
  }
}

int count_of(const SomeReadings& usable) {
  int count = 0;
  for (const auto& reading : usable) count += reading ? 1 : 0;
  return count;
}

TEST(Oracle, ThePapersEquationsFindTheForceOfRegionsOneAndTwo) {
  int cases = 0;
  for_directions([&](const Force& force, const SomeReadings& usable) {
    if (count_of(usable) < 3) return;
    for (const PaperChoice& choice : paper_choices(usable)) {
      expect_same(paper_force(usable, 5, choice), force);
    }
    ++cases;
  });
  EXPECT_GT(cases, 500);
}

TEST(Oracle, ThePapersForceOfRegionThreeIsTheMidpointInTheta) {
  int cases = 0;
  for_directions([&](const Force&, const SomeReadings& usable) {
    if (count_of(usable) != 2) return;
    const auto theta = [](const Force& force) {
      return exact::atan2(
          exact::sqrt(force.shear_x * force.shear_x + force.shear_y * force.shear_y), force.normal);
    };
    const Force force = paper_force(usable, 5, {});
    const auto [low, high] = segment_of(usable, 5);
    expect_close(2 * theta(force), theta(low) + theta(high));
    const Readings readings = readings_of(force, 5);
    for (std::size_t n = 0; n < 4; ++n) {
      if (usable[n]) expect_close(readings[n], *usable[n]);
    }
    ++cases;
  });
  EXPECT_GT(cases, 100);
}

TEST(Oracle, ConditionOfTheDirectSolveFollowsFromItsLinearForm) {
  int cases = 0;
  for_directions([&](const Force& force, const SomeReadings& usable) {
    const auto estimate = [](const SomeReadings& some) { return direct_force(some, 5); };
    const auto at = [&](std::size_t n) { return usable[n].value_or(0); };
    Exact expected = 0;
    if (count_of(usable) == 4) {
      expected = exact::sqrt(2) * force.normal / magnitude(force);  // C2
    } else if (count_of(usable) == 3 && !usable[3]) {
      const Exact shear = std::max(at(0), at(2)) + at(1);  // C3
      const Exact normal = (at(0) + at(2)) / exact::sqrt(2);
      expected = std::max(shear, normal) / (exact::sqrt(2) * 5 * magnitude(force));
    } else {
      return;
    }
    EXPECT_NEAR(condition_number(usable, estimate), static_cast<double>(expected), 1e-9);
    ++cases;
  });
  EXPECT_GT(cases, 500);
}

}  // namespace
}  // namespace pillarfield::oracle
