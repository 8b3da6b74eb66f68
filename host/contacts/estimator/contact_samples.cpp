#include "contacts/estimator/contact_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solve/pillar_lean.h"

namespace pillarfield {
namespace {

/// Distance of a contact's edge from the centres of its outermost pillars, in pillars.
constexpr double kEdge = 0.25;

/// Largest ratio of shear to normal force at which a pillar sheared in this direction has three
/// usable sensels, and so a determined force (C4).
double ceiling_of(double shear_x, double shear_y, const SegmentModel& model) {
  const double x = model.coefficient_x * shear_x;
  const double y = model.coefficient_y * shear_y;
  const double least = std::min(std::abs(x + y), std::abs(y - x));
  const double shear = std::sqrt(shear_x * shear_x + shear_y * shear_y);
  return least > 0 ? std::numbers::sqrt2 * shear / least : ObservedRatio::kNoCeiling;
}

}  // namespace

LeanShear lean_at(const ForceFieldView& forces, std::uint32_t index, float pitch_over_arm) {
  if (pitch_over_arm == 0) return {};
  const auto [x, y] = pillar_lean(forces, index);
  const float square = x.deviation * x.deviation + y.deviation * y.deviation;
  return {pitch_over_arm * x.moment, pitch_over_arm * y.moment,
          pitch_over_arm * std::sqrt(square / 2)};
}

double deviation_of_ratio(double ratio, double normal, double noise_n, const PillarError& error,
                          const ContactParameters& parameters) {
  const double noise = parameters.noise_of_ratio * noise_n / normal;
  const double residual = parameters.noise_of_ratio * error.residual;
  const double square =
      noise * noise + parameters.ratio_deviation * parameters.ratio_deviation + residual * residual;
  if (error.shear_n == 0) return std::sqrt(square);
  return std::hypot(std::sqrt(square), error.shear_n / (ratio * normal));
}

ContactBox ContactBox::about(std::span<const ContactRun> runs) {
  ContactBox box;
  box.first_row = runs.front().row;
  box.rows = runs.back().row - runs.front().row + 1;
  box.first_col = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t end_col = 0;
  for (const ContactRun& run : runs) {
    box.pillars += run.end - run.first;
    box.first_col = std::min(box.first_col, run.first);
    end_col = std::max(end_col, run.end);
  }
  box.cols = end_col - box.first_col;
  return box;
}

void ContactSamples::sample(const ForceFieldView& forces, std::span<const LeanShear> leans,
                            std::span<const ContactRun> runs, double noise_n,
                            const SegmentModel& model, const ContactParameters& parameters) {
  forces_ = forces;
  leans_ = leans;
  model_ = model;
  runs_ = runs;
  box_ = ContactBox::about(runs);
  ratios_.clear();
  bounds_.clear();
  pressure_.clear();
  ambiguous_.clear();
  peak_n_ = 0;
  shear_x_ = 0;
  shear_y_ = 0;
  shear_ = 0;
  normal_ = 0;
  step_ = (box_.pillars + kMostPillars - 1) / kMostPillars;
  // Samples lie far apart: prefetch all before the first is used.
  for_each_of(runs, step_, [&](std::uint32_t row, std::uint32_t col) {
    const std::size_t index = std::size_t{row} * forces.cols + col;
    prefetch(&forces.status[index]);
    prefetch(&forces.normal[index]);
    prefetch(&forces.shear_x[index]);
    prefetch(&forces.shear_y[index]);
  });
  for_each_of(runs, step_, [&](std::uint32_t row, std::uint32_t col) {
    sample_pillar(row, col, noise_n, parameters);
  });
}

/// Adds the samples of one pillar.
void ContactSamples::sample_pillar(std::uint32_t row, std::uint32_t col, double noise_n,
                                   const ContactParameters& parameters) {
  const std::uint32_t index = row * forces_.cols + col;
  const std::uint8_t status = forces_.status[index];
  const double normal = forces_.normal[index];
  const double least = parameters.least_normal * noise_n;
  if (!(normal > 0 && normal < kMostNormalN)) return;
  if (has_feasible_segment(status)) {
    const LeanShear lean = lean_of(index);
    const FeasibleSegment segment = segment_at(forces_, index, model_, lean);
    const double high = segment.high;
    ambiguous_.push_back(index);
    peak_n_ = std::max(peak_n_, high);
    add_load(force_on_segment(force_at(forces_, index), status, model_, segment.high));
    if (!(high > least)) return;
    const double flat = segment.least_ratio_normal();
    const double ratio = segment.ratio_at(flat);
    bounds_.push_back(
        {ratio,
         deviation_of_ratio(ratio, flat, noise_n, {lean.deviation, model_.residual}, parameters),
         0});
  } else if (is_determined(status)) {
    peak_n_ = std::max(peak_n_, normal);
    add_load(force_at(forces_, index));
    pressure_.push_back({box_.x_of(col), box_.y_of(row), normal * normal, 1});
    if (!(normal > least)) return;
    const double x = forces_.shear_x[index];
    const double y = forces_.shear_y[index];
    const double ratio = std::sqrt(x * x + y * y) / normal;
    if (ratio < parameters.least_ratio) return;
    const double lean = lean_at(forces_, index, model_.pitch_over_arm).deviation;
    ratios_.push_back(
        {ratio, deviation_of_ratio(ratio, normal, noise_n, {lean, model_.residual}, parameters),
         ceiling_of(x, y, model_)});
  }
}

void ContactSamples::add_load(const single_precision::Force& force) {
  shear_x_ += force.shear_x;
  shear_y_ += force.shear_y;
  shear_ += std::sqrt(force.shear_x * force.shear_x + force.shear_y * force.shear_y);
  normal_ += force.normal;
}

/// Normal force of a determined pillar, or upper bound of an ambiguous one, N.
double ContactSamples::most_normal(std::uint32_t index) const {
  const std::uint8_t status = forces_.status[index];
  if (is_determined(status)) return std::max(double{forces_.normal[index]}, 0.0);
  if (!has_feasible_segment(status)) return 0;
  return segment_at(forces_, index, model_, lean_of(index)).high;
}

/// Adds a sample of zero normal force at an edge, weighted by how little the outermost pillars bear
/// (C7).
void ContactSamples::add_edge(const Edge& edge, double weight) {
  double most = most_normal(edge.row * forces_.cols + edge.col);
  const std::int64_t inner_row = std::int64_t{edge.row} - edge.down;
  const std::int64_t inner_col = std::int64_t{edge.col} - edge.right;
  if (inner_row >= 0 && inner_row < forces_.rows && inner_col >= 0 && inner_col < forces_.cols) {
    most = std::max(most, most_normal(static_cast<std::uint32_t>(inner_row) * forces_.cols +
                                      static_cast<std::uint32_t>(inner_col)));
  }
  const double rest = 1 - std::min(most / peak_n_, 1.0);
  pressure_.push_back({box_.x_of(edge.col + kEdge * edge.right),
                       box_.y_of(edge.row + kEdge * edge.down), 0, weight * rest * rest});
}

void ContactSamples::add_ends_of_rows() {
  const std::uint32_t step = (box_.rows + kMostEdges - 1) / kMostEdges;
  const double weight = static_cast<double>(step) / step_;
  for (std::size_t i = 0; i < runs_.size();) {
    std::size_t end = i + 1;
    while (end < runs_.size() && runs_[end].row == runs_[i].row) ++end;
    const std::uint32_t row = runs_[i].row;
    const std::uint32_t first = runs_[i].first;
    const std::uint32_t last = runs_[end - 1].end - 1;
    i = end;
    if ((row - box_.first_row) % step != 0) continue;
    if (first > 0) add_edge({row, first, 0, -1}, weight);
    if (last + 1 < forces_.cols) add_edge({row, last, 0, 1}, weight);
  }
}

void ContactSamples::add_ends_of_columns() {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const std::uint32_t step = (box_.cols + kMostEdges - 1) / kMostEdges;
  const double weight = static_cast<double>(step) / step_;
  const std::uint32_t columns = (box_.cols + step - 1) / step;
  top_.assign(columns, kNone);
  bottom_.assign(columns, 0);
  for (const ContactRun& run : runs_) {
    const std::uint32_t first = (run.first - box_.first_col + step - 1) / step;
    for (std::uint32_t i = first; i < columns && box_.first_col + i * step < run.end; ++i) {
      top_[i] = std::min(top_[i], run.row);
      bottom_[i] = run.row;
    }
  }
  for (std::uint32_t i = 0; i < columns; ++i) {
    if (top_[i] == kNone) continue;
    const std::uint32_t col = box_.first_col + i * step;
    if (top_[i] > 0) add_edge({top_[i], col, -1, 0}, weight);
    if (bottom_[i] + 1 < forces_.rows) add_edge({bottom_[i], col, 1, 0}, weight);
  }
}

void ContactSamples::add_edges() {
  if (!(peak_n_ > 0)) return;
  add_ends_of_rows();
  add_ends_of_columns();
}

}  // namespace pillarfield
