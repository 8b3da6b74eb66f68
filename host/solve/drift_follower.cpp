#include "solve/drift_follower.h"

#include <algorithm>
#include <cmath>

#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "skin/raw_reading.h"
#include "solve/activation_thresholds.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostTiles = 64;
constexpr double kDriftDeviations = 6;
constexpr double kDriftPart = 0.25;            // of the threshold
constexpr double kLeastUntouchedTiles = 0.15;  // fraction of the tiles
constexpr double kSlopeRidge = 1e-3;
constexpr double kSettlingTimes = 3;  // time constants after which a corrected tare is trusted

double value_at(const PatternTriple& factors, const PatternTriple& pattern) {
  return factors[0] * pattern[0] + factors[1] * pattern[1] + factors[2] * pattern[2];
}

}  // namespace

single_precision::BaselinePace baseline_pace(const SolverPlan& plan) {
  if (!plan.baseline_rate) return {};
  constexpr double kBandDeviations = 4;  // without a threshold
  const double cut = activation_range(plan).threshold;
  return {static_cast<float>(baseline_turn_rate(plan)),
          static_cast<float>(plan.baseline_interval * plan.frame_interval_s / plan.release_time_s),
          static_cast<float>(cut > 0 ? cut : kBandDeviations * reading_noise(plan))};
}

DriftFollower::DriftFollower(const SolverPlan& plan)
    : cols_(plan.skin.cols),
      middle_{1, 0.5 * quad_cols(plan.skin), 0.5 * quad_rows(plan.skin)},
      rate_(plan.baseline_rate.value_or(0)),
      noise_(reading_noise_n(plan) * plan.skin.counts_per_newton),
      limit_(plan.skin.threshold_counts),
      pace_{static_cast<float>(rate_),
            static_cast<float>(plan.frame_interval_s / plan.release_time_s),
            baseline_pace(plan).band},
      settling_(kSettlingTimes / rate_),
      turns_(static_cast<std::size_t>(plan.baseline_interval)) {
  if (plan.calibration.effects.wires) return;
  const std::size_t all = quads(plan.skin);
  const std::size_t step = all / kMostTiles | 1U;  // odd: reaches all columns
  for (std::size_t i = step / 2; i < all; i += step) add_tile(plan, i);
}

void DriftFollower::add_tile(const SolverPlan& plan, std::size_t quad) {
  const Calibration& planes = plan.calibration;
  const std::uint32_t rows = quad_rows(plan.skin);
  const std::uint32_t cols = quad_cols(plan.skin);
  const auto row = static_cast<std::uint32_t>(quad / cols);
  const auto col = static_cast<std::uint32_t>(quad % cols);
  Tile tile{};
  tile.first = sensels_.size();
  tile.place = {1, (col + 0.5) / middle_[1] - 1, (row + 0.5) / middle_[2] - 1};
  for (std::uint32_t r = 2 * std::max(row, 1U) - 2; r < 2 * std::min(row + 2, rows); ++r) {
    for (std::uint32_t c = 2 * std::max(col, 1U) - 2; c < 2 * std::min(col + 2, cols); ++c) {
      if (r >= plan.skin.rows || c >= plan.skin.cols) continue;
      if (planes.mask.empty() || planes.mask[r * cols_ + c] == 1) sensels_.push_back({r, c});
    }
  }
  tile.end = sensels_.size();
  if (tile.first == tile.end) return;
  const auto mean_of = [&](const std::vector<float>& plane) {
    return plane.empty() ? 0 : mean(tile, [&](auto at) { return plane[at.row * cols_ + at.col]; });
  };
  tile.tare = mean_of(planes.tare);
  tile.bend = {mean_of(planes.bend_x), mean_of(planes.bend_y), mean_of(planes.bend_xy)};
  tiles_.push_back(tile);
}

template <class Value>
double DriftFollower::mean(const Tile& tile, Value value) const {
  double sum = 0;
  for (std::size_t i = tile.first; i < tile.end; ++i) sum += value(sensels_[i]);
  return sum / static_cast<double>(tile.end - tile.first);
}

/// True if a tile is as far off its tare as untouched ones were in the last frame.
bool DriftFollower::is_near(const Tile& tile) const {
  const auto sensels = static_cast<double>(tile.end - tile.first);
  const double most = std::max(kDriftDeviations * noise_ / std::sqrt(sensels), kDriftPart * limit_);
  return std::abs(tile.difference) <= limit_ &&
         std::abs(tile.difference - value_at(drift_, tile.place)) <= most;
}

single_precision::Drift DriftFollower::follow(const FrameView& frame,
                                              const std::optional<Curvature>& bent) {
  const PatternTriple change = bent ? PatternTriple{bent->x, bent->y, bent->xy} : PatternTriple{};
  PatternEquations equations;
  double untouched = 0;
  for (Tile& tile : tiles_) {
    tile.tare += value_at(change, tile.bend);
    tile.difference =
        mean(tile, [&](Sensel at) { return raw_reading(frame, at.row, at.col); }) - tile.tare;
    if (!is_near(tile)) tile.trusted_from = static_cast<double>(frames_) + settling_;
    if (static_cast<double>(frames_) < tile.trusted_from) continue;
    equations.add(tile.place, tile.difference);
    ++untouched;
  }
  const bool enough = untouched >= kLeastUntouchedTiles * static_cast<double>(tiles_.size());
  const PatternTriple found = enough ? equations.solution(kSlopeRidge) : PatternTriple{};
  for (Tile& tile : tiles_) {
    tile.release =
        release_after(tile.release, tile.difference, tile.release.peak, tile.difference, pace_);
    const bool follows = is_released(tile.release) || std::abs(tile.difference) <= limit_;
    tile.tare += follows ? rate_after(tile.release, pace_) * tile.difference
                         : rate_ * value_at(found, tile.place);
  }
  for (std::size_t k = 0; k < 3; ++k) sum_[k] += rate_ * found[k];
  if (enough) drift_ = found;
  const single_precision::Drift drift = since_last_turn();
  turns_[frames_++ % turns_.size()] = sum_;
  return drift;
}

/// The change of `sum_` since the frame that last updated the same rows.
single_precision::Drift DriftFollower::since_last_turn() const {
  const PatternTriple& last = turns_[frames_ % turns_.size()];
  PatternTriple change{};
  for (std::size_t k = 0; k < 3; ++k) change[k] = (sum_[k] - last[k]) / middle_[k];
  const double first = change[0] + change[1] * (0.5 - middle_[1]) + change[2] * (0.5 - middle_[2]);
  return {static_cast<float>(first), static_cast<float>(change[1]), static_cast<float>(change[2])};
}

}  // namespace pillarfield
