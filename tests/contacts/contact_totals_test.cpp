#include "contacts/contact_totals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr double kRatio = 0.5;

/// A field of forces up to about `largest_n` newtons, of all kinds of pillars.
ForceField some_field(std::uint32_t rows, std::uint32_t cols, float largest_n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(-1, 1);
  ForceField field(rows, cols);
  for (std::size_t i = 0; i < field.normal.size(); ++i) {
    field.shear_x[i] = largest_n * share(random);
    field.shear_y[i] = largest_n * share(random);
    field.normal[i] = largest_n * share(random);
    field.status[i] = static_cast<std::uint8_t>(random());
  }
  return field;
}

/// A field whose forces are multiples and odd halves of a quantum.
ForceField halves(std::uint32_t rows, std::uint32_t cols) {
  std::mt19937 random(7);
  ForceField field = some_field(rows, cols, 1, 3);
  for (float& force : field.normal) {
    const auto bits = static_cast<int>(random() % 24);
    const int half_quanta = static_cast<int>(random() & 0x7fffffff) >> (7 + bits);
    force = std::ldexp(static_cast<float>(random() % 2 == 0 ? half_quanta : -half_quanta), -25);
  }
  return field;
}

/// One pillar after another.
ContactTotals plain_totals(const ForceField& field, std::span<const ContactRun> runs) {
  const ForceQuanta quanta(field.normal.size());
  ContactTotals totals;
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::size_t i = std::size_t{run.row} * field.cols + col;
      const PillarForce pillar = {quanta.of(field.shear_x[i]),
                                  quanta.of(field.shear_y[i]),
                                  quanta.of(field.normal[i]),
                                  2 * std::int64_t{col} + 1 - field.cols,
                                  std::int64_t{field.rows} - 2 * std::int64_t{run.row} - 1,
                                  field.status[i]};
      totals.sum.add(pillar);
      if (pillar.normal <= 0) continue;
      totals.slip.pressing += pillar.normal;
      const Region region = region_of(pillar.status);
      if ((region != Region::one && region != Region::two) || (pillar.status & 0xe0) != 0) continue;
      totals.slip.known += pillar.normal;
      const double shear =
          std::hypot(static_cast<double>(pillar.shear_x), static_cast<double>(pillar.shear_y));
      if (shear >= kRatio * static_cast<double>(pillar.normal)) {
        totals.slip.slipping += pillar.normal;
      }
    }
  }
  return totals;
}

/// Runs of all lengths and offsets.
std::vector<ContactRun> some_runs(std::uint32_t rows, std::uint32_t cols) {
  std::vector<ContactRun> runs;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t first = row % 5; first < cols;) {
      const std::uint32_t end = std::min(cols, first + 1 + (7 * row + 3 * first) % 61);
      runs.push_back({row, first, end, 0});
      first = end + 1;
    }
  }
  runs.push_back({rows - 1, 0, cols, 0});
  return runs;
}

void expect_plain_totals(const ForceField& field, std::span<const ContactRun> runs) {
  const ContactTotals expected = plain_totals(field, runs);
  const ContactTotals totals = totals_of(field.view(), runs, kRatio);
  const ContactSum& a = totals.sum;
  const ContactSum& b = expected.sum;
  EXPECT_EQ(a.shear_x, b.shear_x);
  EXPECT_EQ(a.shear_y, b.shear_y);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.normal_x.value(), b.normal_x.value());
  EXPECT_EQ(a.normal_y.value(), b.normal_y.value());
  EXPECT_EQ(a.shear_y_x.value(), b.shear_y_x.value());
  EXPECT_EQ(a.shear_x_y.value(), b.shear_x_y.value());
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.pillars, b.pillars);
  EXPECT_EQ(a.ambiguous, b.ambiguous);
  EXPECT_EQ(a.resolved, b.resolved);
  EXPECT_EQ(a.peak, b.peak);
  EXPECT_EQ(a.peak_x, b.peak_x);
  EXPECT_EQ(a.peak_y, b.peak_y);
  EXPECT_EQ(totals.slip.pressing, expected.slip.pressing);
  EXPECT_EQ(totals.slip.known, expected.slip.known);
  EXPECT_EQ(totals.slip.slipping, expected.slip.slipping);
}

TEST(ContactTotals, AreThoseOfPillarsOneByOne) {
  for (const float largest_n : {1e-6F, 0.3F, 63.9F, 70.0F, 9000.0F, 1e30F}) {
    for (const std::uint32_t cols : {1U, 15U, 16U, 17U, 33U, 1500U}) {
      const ForceField field = some_field(20, cols, largest_n, cols);
      SCOPED_TRACE(testing::Message() << largest_n << " N, " << cols << " columns");
      expect_plain_totals(field, some_runs(20, cols));
      // Each run by itself: its peak too.
      for (const ContactRun& run : some_runs(3, cols)) expect_plain_totals(field, {&run, 1});
    }
  }
}

TEST(ContactTotals, RoundHalvesAwayFromZero) {
  const ForceField field = halves(40, 200);
  expect_plain_totals(field, some_runs(40, 200));
}

TEST(ContactTotals, TakeAnyForce) {
  ForceField field = some_field(12, 90, 5, 1);
  std::size_t place = 0;
  for (const float force :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -64.0F,
        64.0F, -0.0F, 1e-42F, -std::numeric_limits<float>::infinity(), 3e38F}) {
    field.shear_x[place += 71] = force;
    field.shear_y[place += 13] = force;
    field.normal[place += 20] = force;
  }
  expect_plain_totals(field, some_runs(12, 90));
}

TEST(ContactTotals, FindThePeakWhereAllPull) {
  ForceField field = some_field(9, 50, 1, 2);
  for (float& force : field.normal) force = -std::abs(force) - 0.1F;
  expect_plain_totals(field, some_runs(9, 50));
}

TEST(ContactTotals, WithoutARatioTellNothingOfSlip) {
  const ForceField field = some_field(5, 40, 1, 2);
  const ContactTotals totals = totals_of(field.view(), some_runs(5, 40), {});
  EXPECT_GT(totals.sum.pillars, 0);
  EXPECT_EQ(totals.slip.pressing, 0);
  EXPECT_EQ(totals.slip.known, 0);
}

TEST(PeakOf, IsTheLargestAboveZero) {
  ForceField field = some_field(8, 100, 1, 4);
  field.normal[250] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ContactRun> runs = {
      {0, 0, 100, 0}, {1, 0, 55, 0}, {4, 50, 51, 0}, {7, 3, 100, 0}};
  for (const std::size_t place : {0U, 99U, 100U, 154U, 450U, 799U}) {
    field.normal[place] += 3;
    EXPECT_EQ(peak_of(field.view(), runs), field.normal[place]) << place;
    field.normal[place] = 0.5F;
  }
  for (float& force : field.normal) force = -1;
  EXPECT_EQ(peak_of(field.view(), runs), 0);
}

}  // namespace
}  // namespace pillarfield
