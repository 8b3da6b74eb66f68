#include "contacts/estimator/past_pressure.h"

#include <algorithm>
#include <cmath>

#include "contacts/estimator/contact_samples.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kMostCompared = 192;  // pillars
constexpr double kLeastCompared = 4;          // determined pillars that show how the load changed

template <class Use>
void for_each_pillar(std::span<const ContactRun> runs, std::uint32_t cols, Use use) {
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      use(run.row, col, run.row * cols + col);
    }
  }
}

}  // namespace

/// How the load of a contact changed since the frame before.
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

void PastPressure::begin(std::uint32_t rows, std::uint32_t cols) {
  rows_ = rows;
  cols_ = cols;
  std::swap(now_, before_);
  now_.resize(std::size_t{rows} * cols);
  before_.resize(now_.size());
  ++frame_;
}

PastPressure::Origin::Origin(const Movement& movement)
    : rows(static_cast<std::int64_t>(std::floor(-movement.rows))),
      cols(static_cast<std::int64_t>(std::floor(-movement.cols))) {
  const double down = -movement.rows - static_cast<double>(rows);
  const double right = -movement.cols - static_cast<double>(cols);
  weights = {(1 - down) * (1 - right), (1 - down) * right, down * (1 - right), down * right};
}

/// The frame before between its pillars. Where they differ, so may the place meant.
std::optional<PastPressure::Cell> PastPressure::before(std::uint32_t row, std::uint32_t col,
                                                       const Origin& origin) const {
  double weights = 0;
  double normal = 0;
  double squares = 0;
  double variance = 0;
  double most = 0;
  for (std::size_t corner = 0; corner < origin.weights.size(); ++corner) {
    const std::int64_t r = row + origin.rows + static_cast<std::int64_t>(corner / 2);
    const std::int64_t c = col + origin.cols + static_cast<std::int64_t>(corner % 2);
    if (r < 0 || c < 0 || r >= rows_ || c >= cols_) continue;
    const Cell& cell = before_[static_cast<std::size_t>(r * cols_ + c)];
    if (cell.frame + 1 != frame_) continue;
    const double weight = origin.weights[corner];
    weights += weight;
    normal += weight * cell.normal;
    squares += weight * cell.normal * cell.normal;
    variance += weight * cell.variance;
    most += weight * cell.most;
  }
  if (weights < 0.5) return std::nullopt;
  normal /= weights;
  const double apart = 2 * std::max(squares / weights - normal * normal, 0.0);
  return Cell{static_cast<float>(normal), static_cast<float>(variance / weights + apart),
              static_cast<float>(most / weights), frame_ - 1};
}

void PastPressure::keep(std::uint32_t index, double normal, double variance, double most) {
  if (!(normal > 0 && normal < kMostNormalN && variance < kMostNormalN * kMostNormalN)) return;
  now_[index] = {static_cast<float>(normal), static_cast<float>(variance), static_cast<float>(most),
                 frame_};
}

void PastPressure::update(const ForceFieldView& forces, std::span<const ContactRun> runs,
                          const Movement& movement, double noise_n, const SegmentModel& model,
                          const ContactParameters& parameters) {
  const double noise = 0.5 * noise_n * noise_n;
  const double least = parameters.least_normal * noise_n;
  const double own = parameters.prediction_deviation;
  const double spread = parameters.regression_factor;
  bool all_determined = true;
  std::uint32_t pillars = 0;
  const auto noise_square = static_cast<float>(noise);
  for (const ContactRun& run : runs) {
    Cell* const cells = &now_[std::size_t{run.row} * cols_];
    const float* const normals = &forces.normal[std::size_t{run.row} * cols_];
    const std::uint8_t* const status = &forces.status[std::size_t{run.row} * cols_];
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const float normal = normals[col];
      const bool determined = is_determined(status[col]);
      all_determined &= determined;
      const bool known = determined && normal > 0 && normal < static_cast<float>(kMostNormalN);
      cells[col] = {normal, noise_square, normal, known ? frame_ : 0};
    }
    pillars += run.end - run.first;
  }
  if (all_determined) return;

  const auto most_of = [&](std::uint32_t index) {
    const std::uint8_t status = forces.status[index];
    return has_feasible_segment(status) ? segment_at(forces, index, model, {}).high
                                        : forces.normal[index];
  };
  const Origin origin(movement);
  // Evenly spread pillars, which bounds the cost of large contacts.
  const std::uint32_t step = std::max(1U, pillars / kMostCompared);
  std::uint32_t place = 0;
  Load load;
  for_each_pillar(runs, cols_, [&](std::uint32_t row, std::uint32_t col, std::uint32_t index) {
    if (place++ % step != 0) return;
    const auto past = before(row, col, origin);
    if (!past || !(forces.normal[index] < kMostNormalN)) return;
    load.now += most_of(index);
    load.before += past->most;
    if (!is_determined(forces.status[index]) || past->normal < least) return;
    load.products += double{forces.normal[index]} * past->normal;
    load.past_squares += double{past->normal} * past->normal;
    load.squares += double{forces.normal[index]} * forces.normal[index];
    ++load.compared;
  });
  load.conclude(noise, own);
  for_each_pillar(runs, cols_, [&](std::uint32_t row, std::uint32_t col, std::uint32_t index) {
    if (is_determined(forces.status[index])) return;
    const auto past = before(row, col, origin);
    if (!past) return;
    const double normal = load.factor * past->normal;
    // The factor errs alike from frame to frame, so deviations add and not variances.
    const double lasting = load.factor * std::sqrt(past->variance) + load.deviation * past->normal;
    const double variance =
        lasting * lasting + spread * spread * load.scatter + own * own * normal * normal;
    keep(index, normal, variance, most_of(index));
  });
}

std::optional<NormalEstimate> PastPressure::at(std::uint32_t index, double high,
                                               double noise_n) const {
  if (now_.empty() || now_[index].frame != frame_) return std::nullopt;
  const Cell& cell = now_[index];
  return NormalEstimate{std::min(double{cell.normal}, high + noise_n),
                        cell.variance + noise_n * noise_n};
}

}  // namespace pillarfield
