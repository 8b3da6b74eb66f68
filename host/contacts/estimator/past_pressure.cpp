#include "contacts/estimator/past_pressure.h"

#include <algorithm>
#include <cmath>

#include "base/wide.h"
#include "contacts/estimator/contact_samples.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kMostCompared = 192;  // pillars
constexpr double kLeastCompared = 4;          // determined pillars that show how the load changed

/// Copies the normal forces that are above zero and not ignored; the others become zero.
PF_WIDE void copy_pressing(const float* from, std::size_t pillars, float* to) {
  constexpr auto kMost = static_cast<float>(kMostNormalN);
  for (std::size_t i = 0; i < pillars; ++i) to[i] = from[i] > 0 && from[i] < kMost ? from[i] : 0;
}

}  // namespace

/// Change of a contact's load since the frame before.
struct PastPressure::Load {
  double now = 0;  ///< sums of the largest possible normal forces, N
  double before = 0;
  double products = 0;  ///< sums over determined pillars, N²: normal force times that of the past,
  double past_squares = 0;
  double squares = 0;
  double compared = 0;

  double factor = 1;
  double deviation = 0;  ///< of the factor
  double scatter = 0;    ///< variance of the pillars about it, N²

  void conclude(double noise, double own) {
    if (before > 0 && now > 0) {
      const double change = now / before - 1;
      factor = 1 + 0.5 * change;
      deviation = 0.5 * std::abs(change) + own;
    }
    if (compared < kLeastCompared) return;
    const double seen = products / past_squares;
    scatter = std::max((squares - seen * products) / compared - noise, 0.0);
    const double variance = (scatter + noise) / past_squares;
    const double weight = deviation * deviation / (deviation * deviation + variance);
    factor += weight * (seen - factor);
    deviation = std::sqrt(weight * variance);
  }
};

void PastPressure::begin(std::uint32_t rows, std::uint32_t cols, std::span<const ContactRun> runs) {
  std::swap(now_, before_);
  if (rows != rows_ || cols != cols_) {
    rows_ = rows;
    cols_ = cols;
    const std::size_t pillars = std::size_t{rows} * cols;
    const std::vector<float> none(pillars, 0);
    now_ = before_ = {none, none, none, {}};
  }
  for (const ContactRun& run : now_.runs) {
    float* const normals = &now_.normal[std::size_t{run.row} * cols_];
    std::fill(normals + run.first, normals + run.end, 0.0F);
  }
  now_.runs.assign(runs.begin(), runs.end());
}

PastPressure::Origin::Origin(const Movement& movement)
    : rows(static_cast<std::int64_t>(std::floor(-movement.rows))),
      cols(static_cast<std::int64_t>(std::floor(-movement.cols))) {
  const double down = -movement.rows - static_cast<double>(rows);
  const double right = -movement.cols - static_cast<double>(cols);
  weights = {(1 - down) * (1 - right), (1 - down) * right, down * (1 - right), down * right};
}

void PastPressure::prefetch_before(std::span<const ContactRun> runs, const Origin& origin) const {
  constexpr std::uint32_t kLine = 16;  // pillars
  const auto pillars = static_cast<std::int64_t>(before_.normal.size());
  for (const ContactRun& run : runs) {
    const std::int64_t at = (run.row + origin.rows) * cols_ + origin.cols;
    for (std::uint32_t col = run.first; col < run.end + kLine; col += kLine) {
      const std::int64_t index = at + col;
      if (index >= 0 && index < pillars) prefetch(&before_.normal[static_cast<std::size_t>(index)]);
    }
  }
}

/// The frame before between its pillars. Where they differ, so may the place meant.
std::optional<PastPressure::Past> PastPressure::before(std::uint32_t row, std::uint32_t col,
                                                       const Origin& origin,
                                                       double noise_square) const {
  const std::int64_t first_row = row + origin.rows;
  const std::int64_t first_col = col + origin.cols;
  const bool inside =
      first_row >= 0 && first_col >= 0 && first_row + 1 < rows_ && first_col + 1 < cols_;
  double weights = 0;
  Past past;
  double squares = 0;
  for (std::size_t corner = 0; corner < origin.weights.size(); ++corner) {
    const double weight = origin.weights[corner];
    const std::int64_t r = first_row + static_cast<std::int64_t>(corner / 2);
    const std::int64_t c = first_col + static_cast<std::int64_t>(corner % 2);
    if (weight == 0 || (!inside && (r < 0 || c < 0 || r >= rows_ || c >= cols_))) continue;
    const auto index = static_cast<std::size_t>(r * cols_ + c);
    const float known = before_.normal[index];
    if (known == 0) continue;
    const double normal = std::abs(known);
    weights += weight;
    past.normal += weight * normal;
    squares += weight * normal * normal;
    past.variance += weight * (known > 0 ? noise_square : before_.variance[index]);
    past.most += weight * (known > 0 ? normal : before_.most[index]);
  }
  if (weights < 0.5) return std::nullopt;
  const double scale = 1 / weights;
  past.normal *= scale;
  past.most *= scale;
  past.variance =
      past.variance * scale + 2 * std::max(squares * scale - past.normal * past.normal, 0.0);
  return past;
}

void PastPressure::update(const ForceFieldView& forces, std::span<const ContactRun> runs,
                          const Movement& movement, double noise_n, const SegmentModel& model,
                          const ContactParameters& parameters) {
  const double noise = 0.5 * noise_n * noise_n;
  const double least = parameters.least_normal * noise_n;
  const double own = parameters.prediction_deviation;
  const double spread = parameters.regression_factor;
  std::uint32_t pillars = 0;
  for (const ContactRun& run : runs) {
    const std::size_t first = std::size_t{run.row} * cols_ + run.first;
    copy_pressing(&forces.normal[first], run.end - run.first, &now_.normal[first]);
    pillars += run.end - run.first;
  }
  bool all_determined = true;
  for_each_undetermined(forces, runs, [&](std::uint32_t) { all_determined = false; });
  if (all_determined) return;

  const auto most_of = [&](std::uint32_t index) {
    const std::uint8_t status = forces.status[index];
    return has_feasible_segment(status) ? segment_at(forces, index, model, {}).high
                                        : forces.normal[index];
  };
  const Origin origin(movement);
  prefetch_before(runs, origin);
  // Evenly spread pillars, which bounds the cost of large contacts.
  const std::uint32_t step = std::max(1U, pillars / kMostCompared);
  Load load;
  for_each_of(runs, step, [&](std::uint32_t row, std::uint32_t col) {
    const std::uint32_t index = row * cols_ + col;
    const auto past = before(row, col, origin, noise);
    if (!past || !(forces.normal[index] < kMostNormalN)) return;
    load.now += most_of(index);
    load.before += past->most;
    if (!is_determined(forces.status[index]) || past->normal < least) return;
    load.products += double{forces.normal[index]} * past->normal;
    load.past_squares += past->normal * past->normal;
    load.squares += double{forces.normal[index]} * forces.normal[index];
    ++load.compared;
  });
  load.conclude(noise, own);
  for_each_undetermined(forces, runs, [&](std::uint32_t index) {
    now_.normal[index] = 0;
    const std::uint32_t row = index / cols_;
    const auto past = before(row, index - row * cols_, origin, noise);
    if (!past) return;
    const double normal = load.factor * past->normal;
    // The factor errs alike from frame to frame, so deviations add and not variances.
    const double lasting = load.factor * std::sqrt(past->variance) + load.deviation * past->normal;
    const double variance =
        lasting * lasting + spread * spread * load.scatter + own * own * normal * normal;
    if (!(normal > 0 && normal < kMostNormalN && variance < kMostNormalN * kMostNormalN)) return;
    now_.normal[index] = -static_cast<float>(normal);
    now_.variance[index] = static_cast<float>(variance);
    now_.most[index] = most_of(index);
  });
}

std::optional<NormalEstimate> PastPressure::at(std::uint32_t index, double high,
                                               double noise_n) const {
  if (now_.normal.empty() || !(now_.normal[index] < 0)) return std::nullopt;
  return NormalEstimate{std::min(-double{now_.normal[index]}, high + noise_n),
                        now_.variance[index] + noise_n * noise_n};
}

}  // namespace pillarfield
