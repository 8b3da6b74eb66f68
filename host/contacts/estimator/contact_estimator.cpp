#include "contacts/estimator/contact_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/wide.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

constexpr double kNormal95 = 1.96;

maths::Force force_of(const FieldPlanes& field, std::uint32_t index) {
  return {field.shear_x[index], field.shear_y[index], field.normal[index]};
}

void write_force(const FieldPlanes& field, std::uint32_t index, const maths::Force& force) {
  field.shear_x[index] = force.shear_x;
  field.shear_y[index] = force.shear_y;
  field.normal[index] = force.normal;
  if (field.magnitude == nullptr) return;
  const maths::Direction direction = maths::direction_of(force);
  field.magnitude[index] = direction.magnitude;
  field.theta[index] = direction.theta;
  field.phi[index] = direction.phi;
}

/// A part of the segment through a force.
struct SegmentPart {
  maths::Force point;
  std::uint8_t status;
  float low_n;  ///< normal forces of its ends
  float high_n;
};

/// Writes the ends of angles and magnitude on a part of a segment: phi is monotonic, and theta and
/// magnitude each have one minimum, on an ideal skin at the largest normal force (F5, F7).
void write_ends(const FieldPlanes& field, std::uint32_t index, const SegmentPart& part,
                const FeasibleSegment& segment, const SegmentModel& model) {
  const auto force_at = [&](float normal) {
    return force_on_segment(part.point, part.status, model, normal);
  };
  const maths::Force least = force_at(part.low_n);
  const maths::Force most = force_at(part.high_n);
  const maths::Direction flat = maths::direction_of(least);
  const maths::Direction steep = maths::direction_of(most);
  const auto minimum_at = [&](double normal) {
    const float at = std::clamp(static_cast<float>(normal), part.low_n, part.high_n);
    return model.is_ideal() || at == part.high_n ? steep : maths::direction_of(force_at(at));
  };
  const bool clockwise = least.shear_x * most.shear_y < least.shear_y * most.shear_x;
  field.at(Uncertainty::theta_low, index) = minimum_at(segment.least_ratio_normal()).theta;
  field.at(Uncertainty::theta_high, index) = std::max(flat.theta, steep.theta);
  field.at(Uncertainty::phi_low, index) = clockwise ? steep.phi : flat.phi;
  field.at(Uncertainty::phi_high, index) = clockwise ? flat.phi : steep.phi;
  field.at(Uncertainty::magnitude_low, index) = minimum_at(segment.shortest_normal()).magnitude;
  field.at(Uncertainty::magnitude_high, index) = std::max(flat.magnitude, steep.magnitude);
}

SegmentModel segment_model_of(const SolverPlan& plan) {
  SegmentModel model = segment_model(plan.calibration.effects, plan.skin.pillar_pitch_mm());
  model.point = static_cast<float>(plan.segment_point);
  return model;
}

}  // namespace

ContactEstimator::ContactEstimator(const SolverPlan& plan, std::size_t threads,
                                   const ContactParameters& parameters)
    : parameters_(parameters),
      model_(segment_model_of(plan)),
      friction_({.pitch_mm = plan.skin.pillar_pitch_mm(),
                 .noise_n = reading_noise_n(plan),
                 .segment = model_},
                plan.friction, threads, parameters),
      rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      pool_(std::make_unique<ThreadPool>(threads)) {}

void ContactEstimator::resolve(ForceField& field) { resolve(planes_of(field)); }

void ContactEstimator::resolve(const FieldPlanes& field, const IdleBlocks& idle) {
  const ForceFieldView forces = field.forces();
  labels_.find(forces.status, rows_, cols_, idle);
  friction_.begin(forces, labels_);
  pool_->run(labels_.contacts(), [&](std::size_t contact, std::size_t member) {
    friction_.update(forces, labels_, static_cast<std::uint32_t>(contact), member);
  });
  pool_->run(labels_.contacts(), [&](std::size_t contact, std::size_t) {
    const auto label = static_cast<std::uint32_t>(contact);
    if (friction_.model(label).any_ambiguous) estimate(field, label);
  });
}

namespace {

constexpr std::size_t kBatchPillars = 32;
using Values = std::array<float, kBatchPillars>;

/// Mean and mean square of the normal force over equally probable frictions `nodes`; a pillar
/// sticks with probability `sticks`, else it slips (C8).
PF_WIDE void average(const Values& fixed, const Values& moving, const Values& high,
                     const Values& slope, const Values& slope_square, std::span<const float> nodes,
                     float sticks, Values& mean, Values& square) {
  mean.fill(0);
  square.fill(0);
  const float share = 1.0F / static_cast<float>(nodes.size());
  for (const float friction : nodes) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const float total = fixed[i] * fixed[i] + moving[i] * moving[i];
      const float under =
          slope_square[i] * moving[i] * moving[i] + (friction * friction - slope_square[i]) * total;
      const float sum_of = slope[i] * moving[i] + std::sqrt(under > 0 ? under : 0.0F);
      const float free = total / sum_of;
      const float slip = ((sum_of > 0) & (free < high[i])) ? free : high[i];
      const float sum = slip + high[i];
      mean[i] += share * ((1 - sticks) * slip + sticks * 0.5F * sum);
      square[i] += share * ((1 - sticks) * slip * slip +
                            sticks * (slip * sum + high[i] * high[i]) * (1.0F / 3));
    }
  }
}

}  // namespace

/// Standard deviation of a slipping pillar's normal force, N, due to one of its shear, N (F8); at
/// most the segment's length.
double normal_deviation(const FeasibleSegment& segment, double normal, double shear_n) {
  const double shear = segment.ratio_at(normal) * normal;
  const double rest = segment.free_shear - segment.slope * normal;
  const double stiffness = shear * shear / normal + segment.slope * rest;
  return shear * shear_n < stiffness * segment.high ? shear * shear_n / stiffness : segment.high;
}

/// Mean reading of the usable sensels as a force, N: that of the free shear without normal force.
double mean_reading_n(const FeasibleSegment& segment) { return segment.free_shear / segment.slope; }

/// A batch of ambiguous pillars of a contact: segments and estimated normal forces.
struct ContactEstimator::Batch {
  std::array<std::uint32_t, kBatchPillars> index{};
  Values fixed{};  ///< as in FeasibleSegment, N
  Values moving{};
  Values high{};
  Values slope{};
  Values slope_square{};
  Values lean{};           ///< LeanShear::deviation
  Values mean{};           ///< of the normal force, N
  Values square{};         ///< mean square of the normal force, N²
  Values cautious_mean{};  ///< likewise, by FrictionBelief::cautious
  Values cautious_square{};
  std::size_t pillars = 0;

  [[nodiscard]] FeasibleSegment segment(std::size_t i) const {
    return {fixed[i], moving[i], high[i], slope[i]};
  }
};

/// Estimates the ambiguous pillars of a contact in batches.
void ContactEstimator::estimate(const FieldPlanes& field, std::uint32_t contact) const {
  const ContactModel& model = friction_.model(contact);
  const std::span<const LeanShear> leans = friction_.leans();
  Batch batch;
  const auto finish = [&] {
    for (std::size_t i = batch.pillars; i < kBatchPillars; ++i) {
      batch.fixed[i] = batch.moving[i] = batch.high[i] = 1;
      batch.slope[i] = batch.slope_square[i] = 1;
    }
    average(batch.fixed, batch.moving, batch.high, batch.slope, batch.slope_square, model.frictions,
            static_cast<float>(parameters_.ambiguous_sticks), batch.mean, batch.square);
    average(batch.fixed, batch.moving, batch.high, batch.slope, batch.slope_square, model.cautious,
            static_cast<float>(parameters_.ambiguous_sticks), batch.cautious_mean,
            batch.cautious_square);
    for (std::size_t i = 0; i < batch.pillars; ++i) write(field, model, batch, i);
    batch.pillars = 0;
  };
  for_each_ambiguous(field.forces(), labels_.runs(contact), [&](std::uint32_t index) {
    if (!(field.normal[index] > 0 && field.normal[index] < kMostNormalN)) return;
    const FeasibleSegment segment =
        segment_of(force_of(field, index), field.status[index], model_, {});
    batch.index[batch.pillars] = index;
    batch.fixed[batch.pillars] = segment.known_shear;
    batch.moving[batch.pillars] = segment.free_shear;
    batch.high[batch.pillars] = segment.high;
    batch.slope[batch.pillars] = static_cast<float>(segment.slope);
    batch.slope_square[batch.pillars] = model_.slope_square(shear_y_is_free(field.status[index]));
    batch.lean[batch.pillars] = leans.empty() ? 0 : leans[index].deviation;
    if (++batch.pillars == kBatchPillars) finish();
  });
  if (batch.pillars > 0) finish();
}

/// Writes the posterior mean and standard deviation of one pillar's normal force (C9, C9a).
void ContactEstimator::write(const FieldPlanes& field, const ContactModel& model,
                             const Batch& batch, std::size_t i) const {
  const std::uint32_t index = batch.index[i];
  const maths::Force point = force_of(field, index);
  const std::uint8_t status = field.status[index];
  const bool vertical = shear_y_is_free(status);
  const double noise_n = model.noise_n;
  const double high = batch.high[i];
  double mean = batch.mean[i];
  const double own = parameters_.ratio_deviation * mean;  // model error of a slipping pillar
  const double lean =
      batch.lean[i] > 0 ? normal_deviation(batch.segment(i), mean, batch.lean[i]) : 0;
  const double residual = model_.residual * mean_reading_n(batch.segment(i));
  double variance = std::max(batch.square[i] - mean * mean, 0.0) +
                    0.5 * (noise_n * noise_n + residual * residual) + own * own + lean * lean;
  // What the cautious posterior adds (C8a): its mean square distance from the mean.
  const double apart_square = batch.cautious_square[i] + mean * (mean - 2 * batch.cautious_mean[i]);
  double added = std::max(apart_square - std::max(batch.square[i] - mean * mean, 0.0), 0.0);
  const std::uint32_t row = index / cols_;
  if (const auto found = model.predicted(row, index - row * cols_, high, parameters_)) {
    const double weight = variance / (variance + found->variance);
    mean += weight * (found->normal - mean);
    variance *= 1 - weight;
    added *= (1 - weight) * (1 - weight);
  }
  if (const auto past = friction_.past().at(index, high, noise_n)) {
    // What the past bounds, it bounds for the cautious posterior too.
    const double weight = NormalEstimate{mean, variance + added}.weight_of(*past);
    mean += weight * (past->normal - mean);
    variance *= 1 - weight;
    added *= 1 - weight;
  }
  if (lean > 0) {
    // The lean moves the segment, and both forces with it: the variance stays (C9a).
    const double apart = parameters_.point_deviation * high;
    mean += variance / (variance + apart * apart) * (model_.point * high - mean);
  }
  mean = std::min(mean, high);
  const double deviation = std::sqrt(variance + added);
  write_force(field, index, force_on_segment(point, status, model_, static_cast<float>(mean)));
  if (deviation < parameters_.resolved_deviation * high) {
    field.status[index] |= status::kFromNeighbours;
  }
  if (!field.has_uncertainty()) return;
  const double beside = lean > 0 ? std::hypot(noise_n, double{batch.lean[i]}) : noise_n;
  const auto low_n = static_cast<float>(std::max(mean - kNormal95 * deviation, 0.0));
  const auto high_n = static_cast<float>(std::min(mean + kNormal95 * deviation, high));
  write_ends(field, index, {point, status, low_n, high_n}, batch.segment(i), model_);
  field.at(Uncertainty::normal, index) = static_cast<float>(deviation);
  field.at(vertical ? Uncertainty::shear_y : Uncertainty::shear_x, index) =
      static_cast<float>(std::hypot(model_.slope(vertical) * deviation, beside));
}

}  // namespace pillarfield
