#include "contacts/contact_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/field_planes.h"
#include "core/status_word.h"
#include "core/wide.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// Of a contact so many pillars are asked at most, evenly spread, and so many rows and columns for
/// its edge: what they tell is the same, and large contacts take no longer.
constexpr std::uint32_t kMostAsked = 96;
constexpr std::uint32_t kMostEdges = 16;
constexpr std::uint32_t kMostPredicted = 16;

/// The edge of a contact lies so far beyond the centre of its outermost pillars, in pillars.
constexpr double kEdge = 0.25;

/// Larger normal forces, N, are none; their squares would not be numbers.
constexpr double kMostNormal = 1e15;

/// Above all frictions.
constexpr double kNoCeiling = 1e3;

/// How far a contact may jump from frame to frame and still be the same.
constexpr double kReachMm = 10;

/// Where the noise is not known, the threshold is taken to be so many deviations.
constexpr double kThresholdDeviations = 4;

constexpr double kNormal95 = 1.96;

double noise_of(const SolverPlan& plan) {
  const bool known = plan.noise_counts || !plan.calibration.noise.empty();
  const double counts =
      known ? reading_noise(plan) : plan.skin.threshold_counts / kThresholdDeviations;
  return counts / plan.skin.counts_per_newton;
}

/// The largest ratio of shear to normal force at which a pillar that is sheared in this direction
/// has three usable sensels and so a determined force (C4).
double ceiling_of(double shear_x, double shear_y) {
  const double least = std::min(std::abs(shear_x + shear_y), std::abs(shear_y - shear_x));
  const double shear = std::sqrt(shear_x * shear_x + shear_y * shear_y);
  return least > 0 ? std::numbers::sqrt2 * shear / least : kNoCeiling;
}

double ratio_at(const maths::Segment& segment, double normal) {
  const double fixed = segment.fixed;
  const double moving = std::max(segment.moving - std::numbers::sqrt2 * normal, 0.0);
  return std::sqrt(fixed * fixed + moving * moving) / normal;
}

}  // namespace

void ContactEstimator::Workspace::clear() {
  ratios.clear();
  bounds.clear();
  predicted.clear();
  samples.clear();
  ambiguous.clear();
  peak_n = 0;
}

ContactEstimator::ContactEstimator(const SolverPlan& plan, std::size_t threads,
                                   const ContactParameters& parameters)
    : parameters_(parameters),
      likelihood_(parameters),
      prior_(plan.friction),
      remember_(plan.friction.memory),
      pitch_mm_(plan.skin.pillar_pitch_mm()),
      noise_n_(noise_of(plan)),
      segment_point_(static_cast<float>(plan.segment_point)),
      rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      workspaces_(threads),
      team_(std::make_unique<WorkTeam>(threads)) {}

void ContactEstimator::resolve(ForceField& field) { resolve(planes_of(field)); }

void ContactEstimator::resolve(const maths::Field& field, const SilentBlocks& idle) {
  map_.find({field.status, std::size_t{rows_} * cols_}, rows_, cols_, idle);
  match();
  contacts_.assign(map_.contacts(), {});
  friction_.assign(map_.contacts(), {});
  team_->run(map_.contacts(), [&](std::size_t contact, std::size_t member) {
    const auto number = static_cast<std::uint32_t>(contact);
    learn(field, number, workspaces_[member]);
    if (!contacts_[contact].any_ambiguous) return;
    estimate(field, number);
  });
}

/// Hands each contact the belief of the one that it was a frame before.
void ContactEstimator::match() {
  std::swap(beliefs_, beliefs_before_);
  beliefs_.assign(map_.contacts(), prior_);
  if (!remember_) return;
  std::swap(traces_, traces_before_);
  traces_.runs.assign(map_.runs_by_row().begin(), map_.runs_by_row().end());
  traces_.ids.assign(map_.contacts(), 0);
  traces_.centres.clear();
  for (std::uint32_t contact = 0; contact < map_.contacts(); ++contact) {
    double pillars = 0;
    double row = 0;
    double col = 0;
    for (const ContactRun& run : map_.runs(contact)) {
      const double length = run.end - run.first;
      pillars += length;
      row += length * run.row;
      col += length * 0.5 * (run.first + run.end - 1.0);
    }
    traces_.centres.push_back({pitch_mm_ * col / pillars, -pitch_mm_ * row / pillars});
  }
  const ContactMatches matches = match_contacts(traces_before_, traces_, kReachMm);
  for (std::uint32_t contact = 0; contact < map_.contacts(); ++contact) {
    const std::uint32_t before = matches.earlier[contact] != kNoContact ? matches.earlier[contact]
                                                                        : matches.parents[contact];
    if (before == kNoContact) continue;
    beliefs_[contact] = beliefs_before_[before].carried(prior_, parameters_.forgetting);
  }
}

/// Brings what is believed of a contact's friction up to date with a frame.
void ContactEstimator::learn(const maths::Field& field, std::uint32_t number, Workspace& work) {
  Contact& contact = contacts_[number];
  FrictionBelief& belief = beliefs_[number];
  gather(field, contact, map_.runs(number), work);
  FrictionCurve log_likelihood{};
  likelihood_.add_slip_or_stick(work.ratios, parameters_.effective_pillars, log_likelihood);
  likelihood_.add_lower_bounds(work.bounds, parameters_.effective_pillars, log_likelihood);
  if (!work.ambiguous.empty()) {
    contact.pressure = PressureRegression::fit(work.samples);
    if (contact.pressure) predict(field, contact, work);
    likelihood_.add_slip_or_stick(work.predicted, parameters_.effective_predictions,
                                  log_likelihood);
  }
  if (!work.ratios.empty() || !work.bounds.empty()) belief.update(log_likelihood);
  for (std::size_t i = 0; i < Contact::kNodes; ++i) {
    contact.nodes[i] =
        static_cast<float>(belief.quantile((static_cast<double>(i) + 0.5) / Contact::kNodes));
  }
  friction_[number] = {belief.quantile(0.5), belief.spread()};
}

maths::Segment ContactEstimator::segment_of(const maths::Field& field, std::uint32_t index) const {
  return maths::segment_of(maths::force_of_field(field, index),
                           maths::moves_vertically(maths::Bits{field.status[index]}),
                           segment_point_);
}

/// The normal force that a pillar has or may have at most, N.
double ContactEstimator::most_normal(const maths::Field& field, std::uint32_t index) const {
  const std::uint8_t status = field.status[index];
  const double normal = field.normal[index];
  if (maths::is_determined(status)) return std::max(normal, 0.0);
  return maths::is_open(status) ? normal / segment_point_ : 0;
}

/// Of a ratio of shear to a normal force, relative.
double ContactEstimator::deviation_of_ratio(double normal) const {
  const double noise = parameters_.noise_of_ratio * noise_n_ / normal;
  return std::sqrt(noise * noise + parameters_.ratio_deviation * parameters_.ratio_deviation);
}

/// The box about a contact.
void ContactEstimator::measure(std::span<const ContactRun> runs, Contact& contact) const {
  contact.first_row = runs.front().row;
  contact.rows = runs.back().row - runs.front().row + 1;
  contact.first_col = cols_;
  std::uint32_t end_col = 0;
  for (const ContactRun& run : runs) {
    contact.pillars += run.end - run.first;
    contact.first_col = std::min(contact.first_col, run.first);
    end_col = std::max(end_col, run.end);
  }
  contact.cols = end_col - contact.first_col;
}

/// Collects what sampled pillars of a contact show.
void ContactEstimator::gather(const maths::Field& field, Contact& contact,
                              std::span<const ContactRun> runs, Workspace& work) const {
  work.clear();
  measure(runs, contact);
  const std::uint32_t step = (contact.pillars + kMostAsked - 1) / kMostAsked;
  std::uint32_t skip = 0;
  for (const ContactRun& run : runs) {
    std::uint32_t col = run.first + skip;
    for (; col < run.end; col += step) ask(field, contact, run.row, col, work);
    skip = col - run.end;
  }
  // Those that were passed over may still be ambiguous.
  contact.any_ambiguous = !work.ambiguous.empty() || step > 1;
  if (work.ambiguous.empty() || work.samples.empty()) return;
  add_ends_of_rows(field, contact, runs, 1.0 / step, work);
  add_ends_of_columns(field, contact, runs, 1.0 / step, work);
}

/// Collects what one pillar shows.
void ContactEstimator::ask(const maths::Field& field, const Contact& contact, std::uint32_t row,
                           std::uint32_t col, Workspace& work) const {
  const std::uint32_t index = row * cols_ + col;
  const std::uint8_t status = field.status[index];
  const double normal = field.normal[index];
  const double least = parameters_.least_normal * noise_n_;
  if (!(normal > 0 && normal < kMostNormal)) return;
  if (maths::is_open(status)) {
    const maths::Segment segment = segment_of(field, index);
    const double high = segment.high;
    work.ambiguous.push_back(index);
    work.peak_n = std::max(work.peak_n, high);
    if (high > least) work.bounds.push_back({ratio_at(segment, high), deviation_of_ratio(high), 0});
  } else if (maths::is_determined(status)) {
    work.peak_n = std::max(work.peak_n, normal);
    work.samples.push_back({contact.x_of(col), contact.y_of(row), normal * normal, 1});
    if (!(normal > least) || (status & status::kAmbiguous) != 0) return;
    const double x = field.shear_x[index];
    const double y = field.shear_y[index];
    work.ratios.push_back(
        {std::sqrt(x * x + y * y) / normal, deviation_of_ratio(normal), ceiling_of(x, y)});
  }
}

/// The normal force vanishes at a contact's edge, unless its outermost pillars bear much (C7). The
/// edge lies `down` or `right` (1, 0 or -1) of the pillar.
void ContactEstimator::add_edge(const maths::Field& field, const Contact& contact, const Edge& edge,
                                double weight, Workspace& work) const {
  double most = most_normal(field, edge.row * cols_ + edge.col);
  const std::int64_t inner_row = std::int64_t{edge.row} - edge.down;
  const std::int64_t inner_col = std::int64_t{edge.col} - edge.right;
  if (inner_row >= 0 && inner_row < rows_ && inner_col >= 0 && inner_col < cols_) {
    most = std::max(most, most_normal(field, static_cast<std::uint32_t>(inner_row) * cols_ +
                                                 static_cast<std::uint32_t>(inner_col)));
  }
  const double rest = std::max(1 - most / work.peak_n, 0.0);
  work.samples.push_back({contact.x_of(edge.col + kEdge * edge.right),
                          contact.y_of(edge.row + kEdge * edge.down), 0, weight * rest * rest});
}

void ContactEstimator::add_ends_of_rows(const maths::Field& field, const Contact& contact,
                                        std::span<const ContactRun> runs, double weight,
                                        Workspace& work) const {
  const std::uint32_t step = (contact.rows + kMostEdges - 1) / kMostEdges;
  for (std::size_t i = 0; i < runs.size();) {
    std::size_t end = i + 1;
    while (end < runs.size() && runs[end].row == runs[i].row) ++end;
    const std::uint32_t row = runs[i].row;
    const std::uint32_t first = runs[i].first;
    const std::uint32_t last = runs[end - 1].end - 1;
    i = end;
    if ((row - contact.first_row) % step != 0) continue;
    if (first > 0) add_edge(field, contact, {row, first, 0, -1}, weight * step, work);
    if (last + 1 < cols_) add_edge(field, contact, {row, last, 0, 1}, weight * step, work);
  }
}

void ContactEstimator::add_ends_of_columns(const maths::Field& field, const Contact& contact,
                                           std::span<const ContactRun> runs, double weight,
                                           Workspace& work) const {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const std::uint32_t step = (contact.cols + kMostEdges - 1) / kMostEdges;
  const std::uint32_t columns = (contact.cols + step - 1) / step;
  work.top.assign(columns, kNone);
  work.bottom.assign(columns, 0);
  for (const ContactRun& run : runs) {
    const std::uint32_t first = (run.first - contact.first_col + step - 1) / step;
    for (std::uint32_t i = first; i < columns && contact.first_col + i * step < run.end; ++i) {
      work.top[i] = std::min(work.top[i], run.row);
      work.bottom[i] = run.row;
    }
  }
  for (std::uint32_t i = 0; i < columns; ++i) {
    if (work.top[i] == kNone) continue;
    const std::uint32_t col = contact.first_col + i * step;
    if (work.top[i] > 0) add_edge(field, contact, {work.top[i], col, -1, 0}, weight * step, work);
    if (work.bottom[i] + 1 < rows_) {
      add_edge(field, contact, {work.bottom[i], col, 1, 0}, weight * step, work);
    }
  }
}

/// What the regression of the pressure predicts of a pillar (C6); no more than readings allow.
std::optional<ContactEstimator::NormalEstimate> ContactEstimator::predicted(const Contact& contact,
                                                                            std::uint32_t index,
                                                                            double high) const {
  if (!contact.pressure) return std::nullopt;
  const std::uint32_t row = index / cols_;
  const PressureRegression::Prediction found =
      contact.pressure->at(contact.x_of(index - row * cols_), contact.y_of(row));
  if (!(found.square > 0)) return std::nullopt;
  const double normal = std::min(std::sqrt(found.square), high + noise_n_);
  const double factor = parameters_.regression_factor;
  const double own = parameters_.prediction_deviation * normal;
  return NormalEstimate{normal, factor * factor * found.variance / (4 * found.square) +
                                    noise_n_ * noise_n_ + own * own};
}

/// What is predicted of ambiguous pillars tells of the friction, too.
void ContactEstimator::predict(const maths::Field& field, const Contact& contact,
                               Workspace& work) const {
  constexpr double kMostDeviation = 0.35;  // relative, of a prediction that is used
  constexpr double kStep = 0.02;           // relative, of the derivative of the ratio
  const std::size_t step = (work.ambiguous.size() + kMostPredicted - 1) / kMostPredicted;
  for (std::size_t i = 0; i < work.ambiguous.size(); i += step) {
    const std::uint32_t index = work.ambiguous[i];
    const maths::Segment segment = segment_of(field, index);
    const auto found = predicted(contact, index, segment.high);
    if (!found) continue;
    const double normal = found->normal;
    const double deviation = std::sqrt(found->variance) / normal;
    if (!(deviation < kMostDeviation && normal > parameters_.least_normal * noise_n_)) continue;
    const double steepness = std::abs(std::log(ratio_at(segment, normal * (1 + kStep)) /
                                               ratio_at(segment, normal * (1 - kStep)))) /
                             (2 * kStep);
    work.predicted.push_back({ratio_at(segment, normal),
                              std::hypot(deviation * steepness, deviation_of_ratio(normal)),
                              kNoCeiling});
  }
}

namespace {

constexpr std::size_t kBatchPillars = 32;
using Values = std::array<float, kBatchPillars>;

/// Mean and mean square of normal forces over frictions of equal probability, at which pillars slip
/// or, with a probability, stick (C8).
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

/// Some ambiguous pillars of a contact: their segments, and the normal forces on them.
struct ContactEstimator::Batch {
  std::array<std::uint32_t, kBatchPillars> index{};
  Values fixed{};  ///< as in Segment, N
  Values moving{};
  Values high{};
  Values mean{};    ///< of the normal force, N
  Values square{};  ///< its mean square, N²
  std::size_t pillars = 0;
};

/// Estimates the ambiguous pillars of a contact, some at a time.
void ContactEstimator::estimate(const maths::Field& field, std::uint32_t number) const {
  const Contact& contact = contacts_[number];
  Batch batch;
  const auto finish = [&] {
    for (std::size_t i = batch.pillars; i < kBatchPillars; ++i) {
      batch.fixed[i] = batch.moving[i] = batch.high[i] = 1;
    }
    average(batch.fixed, batch.moving, batch.high, contact.nodes,
            static_cast<float>(parameters_.ambiguous_sticks), batch.mean, batch.square);
    for (std::size_t i = 0; i < batch.pillars; ++i) write(field, contact, batch, i);
    batch.pillars = 0;
  };
  const auto add = [&](std::uint32_t index) {
    if (!maths::is_open(field.status[index])) return;
    if (!(field.normal[index] > 0 && field.normal[index] < kMostNormal)) return;
    const maths::Segment segment = segment_of(field, index);
    batch.index[batch.pillars] = index;
    batch.fixed[batch.pillars] = segment.fixed;
    batch.moving[batch.pillars] = segment.moving;
    batch.high[batch.pillars] = segment.high;
    if (++batch.pillars == kBatchPillars) finish();
  };
  for (const ContactRun& run : map_.runs(number)) {
    std::uint32_t index = run.row * cols_ + run.first;
    const std::uint32_t end = run.row * cols_ + run.end;
    // Most pillars are not ambiguous: eight are passed over at a time.
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

/// The posterior mean of one ambiguous pillar's normal force, and its deviation (C9).
void ContactEstimator::write(const maths::Field& field, const Contact& contact, const Batch& batch,
                             std::size_t i) const {
  const std::uint32_t index = batch.index[i];
  const maths::Force point = maths::force_of_field(field, index);
  const maths::Mask vertical = maths::moves_vertically(maths::Bits{field.status[index]});
  const double high = batch.high[i];
  double mean = batch.mean[i];
  const double own = parameters_.ratio_deviation * mean;  // a pillar is not quite at the friction
  double variance =
      std::max(batch.square[i] - mean * mean, 0.0) + 0.5 * noise_n_ * noise_n_ + own * own;
  if (const auto found = predicted(contact, index, high)) {
    const double weight = variance / (variance + found->variance);
    mean += weight * (found->normal - mean);
    variance *= 1 - weight;
  }
  mean = std::min(mean, high);
  const double deviation = std::sqrt(variance);
  const bool resolved = deviation < parameters_.resolved_deviation * high;
  const auto normal = static_cast<float>(mean);
  const maths::Force force = maths::force_on_segment(point, vertical, normal);
  field.shear_x[index] = force.shear_x;
  field.shear_y[index] = force.shear_y;
  field.normal[index] = force.normal;
  if (resolved) field.status[index] |= PF_STATUS_FROM_NEIGHBOURS;
  if (field.magnitude != nullptr) {
    const maths::Direction direction = maths::direction_of(force);
    field.magnitude[index] = direction.magnitude;
    field.theta[index] = direction.theta;
    field.phi[index] = direction.phi;
  }
  if (field.deviation_normal == nullptr) return;
  const auto low_n = static_cast<float>(std::max(mean - kNormal95 * deviation, 0.0));
  const auto high_n = static_cast<float>(std::min(mean + kNormal95 * deviation, high));
  maths::write_ends(field, index, maths::force_on_segment(point, vertical, low_n),
                    maths::force_on_segment(point, vertical, high_n));
  field.deviation_normal[index] = static_cast<float>(deviation);
  const auto moving = static_cast<float>(std::hypot(std::numbers::sqrt2 * deviation, noise_n_));
  (vertical ? field.deviation_y : field.deviation_x)[index] = moving;
}

}  // namespace pillarfield
