#include "contacts/contact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// A sum in long double, and that of the magnitudes of what is summed.
struct Exact {
  long double sum = 0;
  long double magnitude = 0;

  void add(long double value) {
    sum += value;
    magnitude += std::abs(value);
  }
};

/// Pillar after pillar.
struct PlainSum {
  Exact shear_x, shear_y, normal, normal_x, normal_y, shear_y_x, shear_x_y;
  Exact pressing, determined, slipping;
  std::int64_t x = 0, y = 0, pillars = 0, ambiguous = 0, resolved = 0;
  float peak = -std::numeric_limits<float>::infinity();
  std::int64_t peak_x = 0, peak_y = 0;

  PlainSum(const ForceField& field, std::span<const ContactRun> runs) {
    for (const ContactRun& run : runs) {
      for (std::uint32_t col = run.first; col < run.end; ++col) add(field, run.row, col);
    }
  }

  void add(const ForceField& field, std::uint32_t row, std::uint32_t col) {
    const std::size_t i = std::size_t{row} * field.cols + col;
    const auto finite = [](float force) { return std::isfinite(force) ? force : 0; };
    const float q_x = finite(field.shear_x[i]);
    const float q_y = finite(field.shear_y[i]);
    const float n = finite(field.normal[i]);
    const std::int64_t at_x = 2 * std::int64_t{col} + 1 - field.cols;
    const std::int64_t at_y = std::int64_t{field.rows} - 2 * std::int64_t{row} - 1;
    const auto place_x = static_cast<long double>(at_x);
    const auto place_y = static_cast<long double>(at_y);
    shear_x.add(q_x);
    shear_y.add(q_y);
    normal.add(n);
    normal_x.add(n * place_x);
    normal_y.add(n * place_y);
    shear_y_x.add(q_y * place_x);
    shear_x_y.add(q_x * place_y);
    x += at_x;
    y += at_y;
    ++pillars;
    const std::uint8_t status = field.status[i];
    if ((status & (status::kAmbiguous | status::kFromNeighbours)) != 0) ++ambiguous;
    if ((status & status::kFromNeighbours) != 0) ++resolved;
    if (n > peak) {
      peak = n;
      peak_x = at_x;
      peak_y = at_y;
    }
    if (n <= 0) return;
    pressing.add(n);
    const Region region = region_of(status);
    if ((region != Region::one && region != Region::two) || (status & 0xe0) != 0) return;
    determined.add(n);
    if (std::hypot(static_cast<long double>(q_x), static_cast<long double>(q_y)) >= kRatio * n) {
      slipping.add(n);
    }
  }
};

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

/// Expects agreement within the rounding of the additions.
void expect_near(double sum, const Exact& exact, std::int64_t pillars) {
  constexpr auto kEpsilon = std::numeric_limits<double>::epsilon();
  const auto bound = exact.magnitude * static_cast<long double>(pillars + 8) * kEpsilon;
  EXPECT_LE(std::abs(sum - exact.sum), bound);
}

void expect_plain_sum(const ForceField& field, std::span<const ContactRun> runs) {
  const PlainSum expected(field, runs);
  const ContactSum sum = sum_of(field.view(), runs, kRatio);
  const std::int64_t pillars = expected.pillars;
  expect_near(sum.shear_x, expected.shear_x, pillars);
  expect_near(sum.shear_y, expected.shear_y, pillars);
  expect_near(sum.normal, expected.normal, pillars);
  expect_near(sum.normal_x, expected.normal_x, pillars);
  expect_near(sum.normal_y, expected.normal_y, pillars);
  expect_near(sum.shear_y_x, expected.shear_y_x, pillars);
  expect_near(sum.shear_x_y, expected.shear_x_y, pillars);
  expect_near(sum.pressing, expected.pressing, pillars);
  expect_near(sum.determined, expected.determined, pillars);
  expect_near(sum.slipping, expected.slipping, pillars);
  EXPECT_EQ(sum.x, expected.x);
  EXPECT_EQ(sum.y, expected.y);
  EXPECT_EQ(sum.pillars, pillars);
  EXPECT_EQ(sum.ambiguous, expected.ambiguous);
  EXPECT_EQ(sum.resolved, expected.resolved);
  EXPECT_EQ(sum.peak, expected.peak);
  EXPECT_EQ(sum.peak_x, expected.peak_x);
  EXPECT_EQ(sum.peak_y, expected.peak_y);
}

TEST(ContactSum, IsThatOfPillarsOneByOne) {
  for (const float largest_n : {1e-6F, 0.3F, 63.9F, 9000.0F, 1e30F}) {
    for (const std::uint32_t cols : {1U, 3U, 4U, 5U, 33U, 1500U}) {
      const ForceField field = some_field(20, cols, largest_n, cols);
      SCOPED_TRACE(testing::Message() << largest_n << " N, " << cols << " columns");
      expect_plain_sum(field, some_runs(20, cols));
      // Each run by itself: its peak too.
      for (const ContactRun& run : some_runs(3, cols)) expect_plain_sum(field, {&run, 1});
    }
  }
}

TEST(ContactSum, TakesAnyForce) {
  ForceField field = some_field(12, 90, 5, 1);
  std::size_t place = 0;
  for (const float force :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -64.0F,
        64.0F, -0.0F, 1e-42F, -std::numeric_limits<float>::infinity(), 3e38F}) {
    field.shear_x[place += 71] = force;
    field.shear_y[place += 13] = force;
    field.normal[place += 20] = force;
  }
  expect_plain_sum(field, some_runs(12, 90));
}

TEST(ContactSum, FindsThePeakWhereAllPull) {
  ForceField field = some_field(9, 50, 1, 2);
  for (float& force : field.normal) force = -std::abs(force) - 0.1F;
  expect_plain_sum(field, some_runs(9, 50));
}

TEST(ContactSum, OfEqualPeaksTheFirstRowByRowCounts) {
  ForceField field(3, 9);
  for (const std::size_t i : {5U, 7U, 13U, 22U}) field.normal[i] = 7;
  const std::vector<ContactRun> runs = {{0, 1, 9, 0}, {1, 0, 9, 0}, {2, 0, 9, 0}};
  expect_plain_sum(field, runs);
  ContactSum joined;
  for (const ContactRun& run : runs) joined.add(sum_of(field.view(), {&run, 1}, {}));
  EXPECT_EQ(joined.peak_x, 2);
  EXPECT_EQ(joined.peak_y, 2);
}

TEST(ContactSum, WithoutARatioHasNoSlip) {
  const ForceField field = some_field(5, 40, 1, 2);
  const ContactSum sum = sum_of(field.view(), some_runs(5, 40), {});
  EXPECT_GT(sum.pillars, 0);
  EXPECT_EQ(sum.pressing, 0);
  EXPECT_EQ(sum.determined, 0);
}

}  // namespace
}  // namespace pillarfield
