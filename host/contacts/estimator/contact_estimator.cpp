#include "contacts/estimator/contact_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "base/wide.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"

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

/// Writes the ends of angles and magnitude for forces between two points of a segment: theta and
/// magnitude fall with the normal force, phi is monotonic (F5).
void write_ends(const FieldPlanes& field, std::uint32_t index, const maths::Force& least,
                const maths::Force& most) {
  const maths::Direction flat = maths::direction_of(least);
  const maths::Direction steep = maths::direction_of(most);
  const bool clockwise = least.shear_x * most.shear_y < least.shear_y * most.shear_x;
  field.at(Uncertainty::theta_low, index) = steep.theta;
  field.at(Uncertainty::theta_high, index) = flat.theta;
  field.at(Uncertainty::phi_low, index) = clockwise ? steep.phi : flat.phi;
  field.at(Uncertainty::phi_high, index) = clockwise ? flat.phi : steep.phi;
  field.at(Uncertainty::magnitude_low, index) = steep.magnitude;
  field.at(Uncertainty::magnitude_high, index) = flat.magnitude;
}

}  // namespace

ContactEstimator::ContactEstimator(const SolverPlan& plan, std::size_t threads,
                                   const ContactParameters& parameters)
    : parameters_(parameters),
      end_{.point = static_cast<float>(plan.segment_point),
           .hidden_n = static_cast<float>(hidden_normal_n(plan.skin))},
      friction_({.pitch_mm = plan.skin.pillar_pitch_mm(),
                 .noise_n = reading_noise_n(plan),
                 .segment_end = end_},
                plan.friction, threads, parameters),
      rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      pool_(std::make_unique<ThreadPool>(threads)) {}

void ContactEstimator::resolve(ForceField& field) { resolve(planes_of(field)); }

void ContactEstimator::resolve(const FieldPlanes& field, const IdleBlocks& idle) {
  const ForceFieldView forces = field.forces();
  labels_.find(forces.status, rows_, cols_, idle);
  friction_.begin(labels_);
  pool_->run(labels_.contacts(), [&](std::size_t contact, std::size_t member) {
    const auto label = static_cast<std::uint32_t>(contact);
    friction_.update(forces, labels_, label, member);
    if (friction_.model(label).any_ambiguous) estimate(field, label);
  });
}

namespace {

constexpr std::size_t kBatchPillars = 32;
using Values = std::array<float, kBatchPillars>;

/// Mean and mean square of the normal force over equally probable frictions `nodes`; a pillar
/// sticks with probability `sticks`, else it slips (C8).
PF_WIDE void average(const Values& fixed, const Values& moving, const Values& high,
                     std::span<const float> nodes, float sticks, Values& mean, Values& square) {
  constexpr float kRoot2 = std::numbers::sqrt2_v<float>;
  mean.fill(0);
  square.fill(0);
  const float share = 1.0F / static_cast<float>(nodes.size());
  for (const float friction : nodes) {
    const float excess = friction * friction - 2;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const float total = fixed[i] * fixed[i] + moving[i] * moving[i];
      const float under = 2 * moving[i] * moving[i] + excess * total;
      const float free = total / (kRoot2 * moving[i] + std::sqrt(under > 0 ? under : 0.0F));
      const float slip = free < high[i] ? free : high[i];
      const float sum = slip + high[i];
      mean[i] += share * ((1 - sticks) * slip + sticks * 0.5F * sum);
      square[i] += share * ((1 - sticks) * slip * slip +
                            sticks * (slip * sum + high[i] * high[i]) * (1.0F / 3));
    }
  }
}

}  // namespace

/// A batch of ambiguous pillars of a contact: segments and estimated normal forces.
struct ContactEstimator::Batch {
  std::array<std::uint32_t, kBatchPillars> index{};
  Values fixed{};  ///< as in FeasibleSegment, N
  Values moving{};
  Values high{};
  Values mean{};    ///< of the normal force, N
  Values square{};  ///< mean square of the normal force, N²
  std::size_t pillars = 0;
};

/// Estimates the ambiguous pillars of a contact in batches.
void ContactEstimator::estimate(const FieldPlanes& field, std::uint32_t contact) const {
  const ContactModel& model = friction_.model(contact);
  Batch batch;
  const auto finish = [&] {
    for (std::size_t i = batch.pillars; i < kBatchPillars; ++i) {
      batch.fixed[i] = batch.moving[i] = batch.high[i] = 1;
    }
    average(batch.fixed, batch.moving, batch.high, model.frictions,
            static_cast<float>(parameters_.ambiguous_sticks), batch.mean, batch.square);
    for (std::size_t i = 0; i < batch.pillars; ++i) write(field, model, batch, i);
    batch.pillars = 0;
  };
  const auto add = [&](std::uint32_t index) {
    if (!has_feasible_segment(field.status[index])) return;
    if (!(field.normal[index] > 0 && field.normal[index] < kMostNormalN)) return;
    const FeasibleSegment segment =
        segment_of(force_of(field, index), shear_y_is_free(field.status[index]), end_);
    batch.index[batch.pillars] = index;
    batch.fixed[batch.pillars] = segment.known_shear;
    batch.moving[batch.pillars] = segment.free_shear;
    batch.high[batch.pillars] = segment.high;
    if (++batch.pillars == kBatchPillars) finish();
  };
  for (const ContactRun& run : labels_.runs(contact)) {
    std::uint32_t index = run.row * cols_ + run.first;
    const std::uint32_t end = run.row * cols_ + run.end;
    // Skips eight pillars at a time: most are not ambiguous.
    for (; index + kWordBytes <= end; index += kWordBytes) {
      std::uint64_t word = 0;
      std::memcpy(&word, field.status + index, kWordBytes);
      if ((word & (status::kAmbiguous * kEachByte)) == 0) continue;
      for (std::uint32_t i = 0; i < kWordBytes; ++i) add(index + i);
    }
    for (; index < end; ++index) add(index);
  }
  if (batch.pillars > 0) finish();
}

/// Writes the posterior mean and standard deviation of one pillar's normal force (C9).
void ContactEstimator::write(const FieldPlanes& field, const ContactModel& model,
                             const Batch& batch, std::size_t i) const {
  const std::uint32_t index = batch.index[i];
  const maths::Force point = force_of(field, index);
  const bool vertical = shear_y_is_free(field.status[index]);
  const double noise_n = model.noise_n;
  const double high = batch.high[i];
  double mean = batch.mean[i];
  const double own = parameters_.ratio_deviation * mean;  // model error of a slipping pillar
  double variance =
      std::max(batch.square[i] - mean * mean, 0.0) + 0.5 * noise_n * noise_n + own * own;
  const std::uint32_t row = index / cols_;
  if (const auto found = model.predicted(row, index - row * cols_, high, parameters_)) {
    const double weight = variance / (variance + found->variance);
    mean += weight * (found->normal - mean);
    variance *= 1 - weight;
  }
  mean = std::min(mean, high);
  const double deviation = std::sqrt(variance);
  write_force(field, index, force_on_segment(point, vertical, static_cast<float>(mean)));
  if (deviation < parameters_.resolved_deviation * high) {
    field.status[index] |= status::kFromNeighbours;
  }
  if (!field.has_uncertainty()) return;
  const auto low_n = static_cast<float>(std::max(mean - kNormal95 * deviation, 0.0));
  const auto high_n = static_cast<float>(std::min(mean + kNormal95 * deviation, high));
  write_ends(field, index, force_on_segment(point, vertical, low_n),
             force_on_segment(point, vertical, high_n));
  field.at(Uncertainty::normal, index) = static_cast<float>(deviation);
  field.at(vertical ? Uncertainty::shear_y : Uncertainty::shear_x, index) =
      static_cast<float>(std::hypot(std::numbers::sqrt2 * deviation, noise_n));
}

}  // namespace pillarfield
