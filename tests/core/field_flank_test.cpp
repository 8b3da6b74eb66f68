// The flanks of a contact: the scale of what slips, read along rows and columns.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/pillar_maths.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

constexpr std::uint32_t kFlankSide = 41;
constexpr double kFlankPeak = 100;
constexpr double kRadius = 19.3;  // pillars
constexpr double kCore = 9;       // of what is resolved
constexpr double kStuck = 13;     // of what sticks, up to a ratio just above the least
constexpr double kStuckRatio = 1.45;

/// How a contact is laid on the skin.
using Place = std::function<std::array<double, 2>(double row, double col)>;
std::array<double, 2> upright(double row, double col) { return {row, col}; }

/// A round contact, sheared along an axis: its middle is resolved, open pillars about it stick,
/// those farther out slip. The square of its pressure is a polynomial of degree 2.
class FlankedContact {
 public:
  explicit FlankedContact(double friction, double noise = 0, std::uint32_t seed = 1,
                          const Place& place = upright);

  [[nodiscard]] maths::FlankScale scale(double friction) const {
    return {static_cast<float>(friction), static_cast<float>(noise_),
            static_cast<float>(kFlankPeak)};
  }
  /// What flanks say in the rounds of an estimate.
  [[nodiscard]] maths::FlankVerdict verdict();

  maths::Tile tile{0, 0, kFlankSide, kFlankSide, 0, 0, 0, 0};
  maths::Cells cells{};
  std::vector<double> pressure;  ///< of each cell

 private:
  void lay(std::uint32_t cell, double from_centre, double resolved_error, double open_error);

  double friction_;
  double noise_;
  std::vector<std::uint8_t> kind_;
  std::vector<std::vector<float>> planes_;
  std::vector<double> lines_;
};

FlankedContact::FlankedContact(double friction, double noise, std::uint32_t seed,
                               const Place& place)
    : pressure(std::size_t{kFlankSide + 2} * (kFlankSide + 2)),
      friction_(friction),
      noise_(noise),
      kind_(pressure.size(), PF_CELL_OUTSIDE),
      planes_(6, std::vector<float>(kind_.size())),
      lines_(std::size_t{PF_LINE_SUMS} * kFlankSide) {
  cells = {kind_.data(),      planes_[0].data(), planes_[1].data(), planes_[2].data(),
           planes_[3].data(), planes_[4].data(), planes_[5].data()};
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  for (std::uint32_t row = 0; row < kFlankSide; ++row) {
    for (std::uint32_t col = 0; col < kFlankSide; ++col) {
      const auto [down, across] = place(row, col);
      const double resolved_error = std::numbers::sqrt2 / 2 * error(random);
      lay(maths::cell_at(tile, static_cast<std::uint32_t>(down),
                         static_cast<std::uint32_t>(across)),
          std::hypot(row - 20.2, col - 19.7), resolved_error, error(random));
    }
  }
}

void FlankedContact::lay(std::uint32_t cell, double from_centre, double resolved_error,
                         double open_error) {
  const double part = from_centre / kRadius;
  if (part >= 1) return;
  pressure[cell] = kFlankPeak * std::sqrt(1 - part * part);
  if (from_centre < kCore) {
    cells.kind[cell] = PF_CELL_RESOLVED;
    cells.top[cell] = static_cast<float>(pressure[cell] + resolved_error);
    return;
  }
  cells.kind[cell] = PF_CELL_AMBIGUOUS;
  const double ratio = from_centre < kStuck ? kStuckRatio : friction_;
  const double moving = (ratio + std::numbers::sqrt2) * pressure[cell] + open_error;
  cells.moving[cell] = static_cast<float>(moving);
  cells.top[cell] = static_cast<float>(moving / (2 * std::numbers::sqrt2));
}

maths::FlankVerdict FlankedContact::verdict() {
  maths::FlankVerdict said{double{PF_FLANK_FRICTION}, 1, 0};
  for (std::uint32_t round = 0; round < PF_FLANK_ROUNDS; ++round) {
    maths::sum_flanks(tile, cells, scale(said.friction), lines_.data(), {0, 1});
    said = maths::verdict_of_flanks(tile, static_cast<float>(said.friction), lines_.data());
  }
  return said;
}

/// What slips bears at another friction, as a share of what it does bear.
double share_at(double friction, double asked) {
  return (friction + std::numbers::sqrt2) / (asked + std::numbers::sqrt2);
}

/// The first flank of the middle row.
maths::Flank middle_flank(const FlankedContact& contact) {
  std::uint32_t at = 0;
  return maths::next_flank(contact.cells, maths::flank_row(contact.tile, kFlankSide / 2), &at);
}

TEST(Flank, BeginsBesideTheCoreAndEndsBeforeTheEdge) {
  const FlankedContact contact(2);
  const maths::Flank flank = middle_flank(contact);
  EXPECT_EQ(flank.core, PF_FLANK_SIDE);
  EXPECT_EQ(flank.last, maths::cell_at(contact.tile, kFlankSide / 2, 28));
  EXPECT_EQ(flank.open, 9U);  // up to column 37; 38 is the edge
}

TEST(Flank, IsNoneWhereAnotherCoreFollows) {
  const FlankedContact contact(2);
  contact.cells.kind[maths::cell_at(contact.tile, kFlankSide / 2, 36)] = PF_CELL_RESOLVED;
  EXPECT_EQ(middle_flank(contact).core, 0U);
}

TEST(Flank, TheScaleOfAnExactCubicIsExact) {
  const FlankedContact contact(2);
  const maths::Flank flank = middle_flank(contact);
  for (const double asked : {1.6, 2.0, 2.7}) {
    const maths::FlankScale scale = contact.scale(asked);
    maths::FlankSums sums = maths::no_flank_sums();
    for (int back = 0; back < 6; ++back) {
      maths::add_resolved(contact.cells, flank, -back, scale, &sums);
    }
    for (std::uint32_t at = 5; at <= flank.open; ++at) {
      maths::add_slipping(contact.cells, flank, at, scale, 1, &sums);
    }
    const maths::FlankFit fit = maths::fit_flank(&sums);
    EXPECT_NEAR(fit.pull / fit.precision * std::pow(share_at(2, asked), 2), 1, 1e-4) << asked;
    EXPECT_NEAR(fit.square / (fit.pull * fit.pull / fit.precision), 1, 1e-4) << asked;
  }
}

TEST(Flank, ItsRingBeginsWhereWhatSticksEnds) {
  const FlankedContact contact(2);
  const maths::Flank flank = middle_flank(contact);
  const maths::Ring ring = maths::ring_of(contact.cells, flank, contact.scale(2));
  EXPECT_EQ(ring.gap, 4U);  // columns 29 to 32
  EXPECT_EQ(ring.sums.samples, PF_FLANK_SIDE + 5.0);
  for (std::uint32_t at = 1; at <= flank.open; ++at) {
    const double truth = contact.pressure[maths::flank_cell(flank, static_cast<int>(at))];
    EXPECT_NEAR(maths::on_flank(&ring.fit, at), truth * truth, 1e-4 * kFlankPeak * kFlankPeak)
        << at;
  }
}

TEST(Flanks, FindTheFrictionOfWhatSlips) {
  for (const double friction : {1.7, 2.0, 2.6, 3.2}) {
    FlankedContact contact(friction);
    const maths::FlankVerdict said = contact.verdict();
    EXPECT_NEAR(said.friction, friction, 2e-3 * friction);
    EXPECT_LT(said.error, 1e-3);
    EXPECT_GT(said.flanks, 30);
  }
}

TEST(Flanks, TheirErrorIsWhatTheySayAndGrowsWithTheNoise) {
  constexpr std::uint32_t kSeeds = 40;
  const auto error_at = [](double noise) {
    double said_squares = 0;
    double squares = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      FlankedContact contact(2.4, noise, seed);
      const maths::FlankVerdict said = contact.verdict();
      said_squares += said.error * said.error;
      squares += std::pow(share_at(2.4, said.friction) - 1, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / said_squares), 1, 0.5) << noise;
    return std::sqrt(said_squares / kSeeds);
  };
  EXPECT_NEAR(error_at(1) / error_at(0.5), 2, 0.4);
}

TEST(Flanks, TheirErrorIsThatOfWhatTheirCubicsLeaveAndOfHowTheyDiffer) {
  // Two flanks of precision 1, whose scales are 0.8 and 1.2.
  std::array<double, PF_FLANKS_SUMS> sums{};
  sums[PF_FLANKS_PRECISION] = 2;
  sums[PF_FLANKS_PULL] = 2;
  sums[PF_FLANKS_PRECISION_SQUARE] = 2;
  sums[PF_FLANKS_PRODUCT] = 2;
  sums[PF_FLANKS_PULL_SQUARE] = 0.8 * 0.8 + 1.2 * 1.2;
  sums[PF_FLANKS_SQUARE] = 2;
  sums[PF_FLANKS_FREEDOM] = 4;
  const double of_mean = 0.2 * 0.2 / 2;
  EXPECT_NEAR(maths::flank_scale_variance(sums.data(), 1), of_mean, 1e-12);
  sums[PF_FLANKS_SQUARE] = 2.3;  // of which the scale explains 2
  EXPECT_NEAR(maths::flank_scale_variance(sums.data(), 1), of_mean + 0.3 / 3 / 2, 1e-12);
}

TEST(Flanks, SayTheSameOfAContactThatIsMirroredOrTurned) {
  const maths::FlankVerdict said = FlankedContact(2.2, 0.5).verdict();
  const std::array<Place, 3> places = {[](double row, double col) {
                                         return std::array{row, kFlankSide - 1 - col};
                                       },
                                       [](double row, double col) {
                                         return std::array{kFlankSide - 1 - row, col};
                                       },
                                       [](double row, double col) {
                                         return std::array{col, row};
                                       }};
  for (const Place& place : places) {
    const maths::FlankVerdict other = FlankedContact(2.2, 0.5, 1, place).verdict();
    EXPECT_NEAR(other.friction, said.friction, 1e-6);
    EXPECT_NEAR(other.error, said.error, 1e-8);
    EXPECT_EQ(other.flanks, said.flanks);
  }
}

TEST(Flanks, BridgeWhatSticksAndLeaveOthersToSlip) {
  const FlankedContact contact(2);
  maths::shape_rows(contact.tile, contact.cells, contact.scale(2), {0, 1});
  maths::shape_columns(contact.tile, contact.cells, contact.scale(2), {0, 1});
  std::size_t bridged = 0;
  for (std::uint32_t row = 0; row < kFlankSide; ++row) {
    for (std::uint32_t col = 0; col < kFlankSide; ++col) {
      const std::uint32_t cell = maths::cell_at(contact.tile, row, col);
      if (contact.cells.kind[cell] != PF_CELL_AMBIGUOUS) continue;
      const float shaped = contact.cells.shaped[cell];
      if (shaped == 0) continue;
      ++bridged;
      EXPECT_NEAR(shaped, contact.pressure[cell], 0.02 * kFlankPeak) << row << ", " << col;
    }
  }
  EXPECT_GT(bridged, 400U);
  EXPECT_EQ(contact.cells.shaped[maths::cell_at(contact.tile, 8, 8)], 0);  // beside no core
}

TEST(Flanks, RecordsOfColumnsFitBehindThoseOfRows) {
  static_assert(2 * PF_FLANKS_SUMS <= PF_LINE_SUMS);
  for (const std::uint32_t rows : {1U, 2U, 5U, 16U, 40U}) {
    const maths::Tile thin{0, 0, rows, 400, 0, 0, 0, 0};
    std::vector<double> lines(std::size_t{PF_LINE_SUMS} * rows);
    const std::uint32_t columns = (400 - 1) / maths::column_sampling_of(thin) + 1;
    EXPECT_LE(columns, PF_MOST_SAMPLED_ROWS);
    const auto fill = [&](double* record) {
      for (std::size_t i = 0; i < PF_FLANKS_SUMS; ++i) {
        lines.at(static_cast<std::size_t>(record - lines.data()) + i) += 1;
      }
    };
    for (std::uint32_t row = 0; row < rows; ++row) fill(maths::row_record(thin, lines.data(), row));
    for (std::uint32_t i = 0; i < columns; ++i) fill(maths::column_record(thin, lines.data(), i));
    EXPECT_LE(*std::max_element(lines.begin(), lines.end()), 1) << rows;
  }
}

}  // namespace
}  // namespace pillarfield
