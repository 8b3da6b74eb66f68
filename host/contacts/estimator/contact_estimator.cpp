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
  const auto update = [&](std::size_t contact, std::size_t member) {
    friction_.update(forces, labels_, static_cast<std::uint32_t>(contact), member);
  };
  const auto estimate_pillars = [&](std::size_t contact, std::size_t) {
    const auto label = static_cast<std::uint32_t>(contact);
    if (friction_.model(label).any_ambiguous) estimate(field, label);
  };
  if (model_.pitch_over_arm == 0) {
    pool_->run(labels_.contacts(), [&](std::size_t contact, std::size_t member) {
      update(contact, member);
      estimate_pillars(contact, member);
    });
    return;
  }
  // Leans depend on pillars of other contacts.
  pool_->run(labels_.contacts(), update);
  pool_->run(labels_.contacts(), estimate_pillars);
}

namespace {

constexpr std::size_t kBatchPillars = PressureRegression::kBatch;
using Values = std::array<float, kBatchPillars>;

/// Mean and mean square of the normal force over equally probable frictions `nodes`; a pillar
/// sticks with probability `sticks`, else it slips (C8).
PF_WIDE void average(const Values& fixed, const Values& moving, const Values& high,
                     const Values& slope, std::span<const float> nodes, float sticks, Values& mean,
                     Values& square) {
  mean.fill(0);
  square.fill(0);
  for (const float friction : nodes) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const float fixed_square = fixed[i] * fixed[i];
      const float total = fixed_square + moving[i] * moving[i];
      const float under = friction * friction * total - slope[i] * slope[i] * fixed_square;
      const float sum_of = slope[i] * moving[i] + std::sqrt(under > 0 ? under : 0.0F);
      const float free = total / sum_of;
      const float slip = ((sum_of > 0) & (free < high[i])) ? free : high[i];
      mean[i] += slip;
      square[i] += slip * slip;
    }
  }
  // Sticking, it is uniform between the force at slip and `high`.
  const float share = 1.0F / static_cast<float>(nodes.size());
  const float third = sticks * (1.0F / 3);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const float slip = share * mean[i];
    mean[i] = slip + 0.5F * sticks * (high[i] - slip);
    square[i] = (1 - 2 * third) * share * square[i] + third * high[i] * (slip + high[i]);
  }
}

/// Standard deviation of a slipping pillar's normal force, N, due to one of its shear, N (F8); at
/// most the segment's length.
double normal_deviation(const FeasibleSegment& segment, double normal, double shear_n) {
  const double shear = segment.ratio_at(normal) * normal;
  const double rest = segment.free_shear - segment.slope * normal;
  const double stiffness = shear * shear / normal + segment.slope * rest;
  return shear * shear_n < stiffness * segment.high ? shear * shear_n / stiffness : segment.high;
}

/// A batch of ambiguous pillars of a contact: segments and estimated normal forces.
struct Batch {
  std::array<std::uint32_t, kBatchPillars> index{};
  Values fixed{};  ///< as in FeasibleSegment, N
  Values moving{};
  Values high{};
  Values slope{};
  Values lean{};           ///< LeanShear::deviation
  Values mean{};           ///< of the normal force, N
  Values square{};         ///< mean square of the normal force, N²
  Values cautious_mean{};  ///< likewise, by FrictionBelief::cautious
  Values cautious_square{};
  PressureRegression::Predictions regression;
  PressureRegression::Values x{};  ///< place for the regression
  PressureRegression::Values y{};
  PressureRegression::Values past{};  ///< by PastPressure, N; 0 if unknown
  PressureRegression::Values past_variance{};
  PressureRegression::Values lean_square{};  ///< variance of the normal force due to the lean, N²
  PressureRegression::Values normal{};       ///< results: normal force and its deviation, N
  PressureRegression::Values deviation{};
  std::size_t pillars = 0;

  [[nodiscard]] FeasibleSegment segment(std::size_t i) const {
    return {fixed[i], moving[i], high[i], slope[i]};
  }
};

/// Parameters that the pillars of a contact share.
struct BatchModel {
  const ContactParameters& parameters;
  const SegmentModel& model;
  double noise_n;
};

/// Posterior mean and standard deviation of the normal forces (C9, C9a).
PF_WIDE void fuse(Batch& batch, const BatchModel& shared) {
  const ContactParameters& parameters = shared.parameters;
  const double noise_n = shared.noise_n;
  const double point = shared.model.point;
  const double residual_error = shared.model.residual;
  const double noise = noise_n * noise_n;
  const double own_square = parameters.ratio_deviation * parameters.ratio_deviation;
  for (std::size_t i = 0; i < kBatchPillars; ++i) {
    const double high = batch.high[i];
    double mean = batch.mean[i];
    const double spread = batch.square[i] - mean * mean;
    const double mixture = spread > 0 ? spread : 0;
    const double residual = residual_error * (batch.moving[i] / batch.slope[i]);  // mean reading
    double variance = mixture + 0.5 * (noise + residual * residual) + own_square * mean * mean +
                      batch.lean_square[i];
    // Variance that the cautious posterior adds (C8a): its mean square distance from the mean.
    const double apart =
        batch.cautious_square[i] + mean * (mean - 2 * double{batch.cautious_mean[i]}) - mixture;
    double added = apart > 0 ? apart : 0;

    const bool predicts = batch.regression.square[i] > 0;
    const double square = predicts ? batch.regression.square[i] : 1;
    const NormalEstimate predicted =
        predicted_normal(square, batch.regression.variance[i], high, noise_n, parameters);
    double weight = predicts ? variance / (variance + predicted.variance) : 0;
    mean += weight * (predicted.normal - mean);
    variance *= 1 - weight;
    added *= (1 - weight) * (1 - weight);

    // The past bounds the cautious posterior too.
    const double stated = variance + added;
    weight = batch.past[i] > 0 ? stated / (stated + batch.past_variance[i]) : 0;
    mean += weight * (batch.past[i] - mean);
    variance *= 1 - weight;
    added *= 1 - weight;

    // The lean moves the segment, and both forces with it: the variance stays (C9a).
    const double point_deviation = parameters.point_deviation * high;
    weight =
        batch.lean_square[i] > 0 ? variance / (variance + point_deviation * point_deviation) : 0;
    mean += weight * (point * high - mean);
    batch.normal[i] = mean < high ? mean : high;
    batch.deviation[i] = std::sqrt(variance + added);
  }
}

/// Writes one pillar.
void write(const FieldPlanes& field, const BatchModel& shared, const Batch& batch, std::size_t i) {
  const SegmentModel& model = shared.model;
  const std::uint32_t index = batch.index[i];
  const maths::Force point = force_of(field, index);
  const std::uint8_t status = field.status[index];
  const bool vertical = shear_y_is_free(status);
  const double high = batch.high[i];
  const double mean = batch.normal[i];
  const double deviation = batch.deviation[i];
  write_force(field, index, force_on_segment(point, status, model, static_cast<float>(mean)));
  if (deviation < shared.parameters.resolved_deviation * high) {
    field.status[index] |= status::kFromNeighbours;
  }
  if (!field.has_uncertainty()) return;
  const double beside = std::hypot(shared.noise_n, double{batch.lean[i]});
  const auto low_n = static_cast<float>(std::max(mean - kNormal95 * deviation, 0.0));
  const auto high_n = static_cast<float>(std::min(mean + kNormal95 * deviation, high));
  write_ends(field, index, {point, status, low_n, high_n}, batch.segment(i), model);
  field.at(Uncertainty::normal, index) = static_cast<float>(deviation);
  field.at(vertical ? Uncertainty::shear_y : Uncertainty::shear_x, index) =
      static_cast<float>(std::hypot(model.slope(vertical) * deviation, beside));
}

}  // namespace

/// Estimates the ambiguous pillars of a contact in batches.
void ContactEstimator::estimate(const FieldPlanes& field, std::uint32_t contact) const {
  const ContactModel& model = friction_.model(contact);
  const std::span<const LeanShear> leans = friction_.leans();
  const BatchModel shared{parameters_, model_, model.noise_n};
  Batch batch;
  const auto finish = [&] {
    for (std::size_t i = batch.pillars; i < kBatchPillars; ++i) {
      batch.fixed[i] = batch.moving[i] = batch.high[i] = batch.slope[i] = 1;
    }
    const auto sticks = static_cast<float>(parameters_.ambiguous_sticks);
    average(batch.fixed, batch.moving, batch.high, batch.slope, model.frictions, sticks, batch.mean,
            batch.square);
    average(batch.fixed, batch.moving, batch.high, batch.slope, model.cautious, sticks,
            batch.cautious_mean, batch.cautious_square);
    if (model.pressure) model.pressure->predict(batch.x, batch.y, batch.regression);
    for (std::size_t i = 0; !leans.empty() && i < batch.pillars; ++i) {
      const double deviation =
          batch.lean[i] > 0 ? normal_deviation(batch.segment(i), batch.mean[i], batch.lean[i]) : 0;
      batch.lean_square[i] = deviation * deviation;
    }
    fuse(batch, shared);
    for (std::size_t i = 0; i < batch.pillars; ++i) write(field, shared, batch, i);
    batch.pillars = 0;
  };
  for_each_ambiguous(field.forces(), labels_.runs(contact), [&](std::uint32_t index) {
    if (!(field.normal[index] > 0 && field.normal[index] < kMostNormalN)) return;
    const FeasibleSegment segment =
        segment_of(force_of(field, index), field.status[index], model_, {});
    const std::size_t i = batch.pillars++;
    batch.index[i] = index;
    batch.fixed[i] = segment.known_shear;
    batch.moving[i] = segment.free_shear;
    batch.high[i] = segment.high;
    batch.slope[i] = static_cast<float>(segment.slope);
    batch.lean[i] = leans.empty() ? 0 : leans[index].deviation;
    const std::uint32_t row = index / cols_;
    batch.x[i] = model.box.x_of(index - row * cols_);
    batch.y[i] = model.box.y_of(row);
    const auto past = friction_.past().at(index, segment.high, model.noise_n);
    batch.past[i] = past ? past->normal : 0;
    batch.past_variance[i] = past ? past->variance : 0;
    if (batch.pillars == kBatchPillars) finish();
  });
  if (batch.pillars > 0) finish();
}

}  // namespace pillarfield
