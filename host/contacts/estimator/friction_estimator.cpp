#include "contacts/estimator/friction_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/log_exp.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostPredicted = 16;
static_assert(kMostPredicted <= PressureRegression::kBatch);

/// Assumed ratio of a contact's largest normal force to the noise, if the noise is unknown.
constexpr double kPeakOverNoise = 64;

/// Probability that a friction is below its lower bound.
constexpr double kOneInTwenty = 0.05;

/// A wider prior, unless the friction is given.
FrictionKnowledge cautious(FrictionKnowledge knowledge, const ContactParameters& parameters) {
  knowledge.spread *= parameters.cautious_spread;
  return knowledge;
}

/// Relative standard deviation of the friction over a contact: the scatter about `friction` of the
/// ratios of its slipping pillars beyond noise (section 5).
double friction_scatter(const std::vector<ObservedRatio>& ratios, double friction,
                        const ContactParameters& parameters) {
  constexpr std::size_t kMostPillars = 48;
  constexpr int kRounds = 3;
  const double own = parameters.ratio_deviation * parameters.ratio_deviation;
  const double usual = parameters.usual_scatter * parameters.usual_scatter;
  const std::size_t step = (ratios.size() + kMostPillars - 1) / kMostPillars;
  std::array<double, kMostPillars> apart{};
  for (std::size_t i = 0; i * step < ratios.size(); ++i) {
    apart[i] = fast_log(ratios[i * step].ratio / friction);
  }
  double scatter = parameters.most_scatter * parameters.most_scatter;
  double slipping = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    double pillars = 1;
    double slip_pillars = 0;
    double squares = parameters.usual_scatter_pillars * usual;
    for (std::size_t i = 0; i * step < ratios.size(); ++i, ++pillars) {
      const double deviation = ratios[i * step].deviation;
      const double variance = scatter + deviation * deviation - own;
      const double square = apart[i] * apart[i];
      if (square > 16 * variance) continue;
      const double slips = slipping * fast_exp(-0.5 * square / variance) /
                           std::sqrt(2 * std::numbers::pi * variance);
      const double sticks = apart[i] < 0 ? (1 - slipping) * (1 + apart[i]) : 0;
      const double weight = slips / (slips + std::max(sticks, parameters.outliers));
      const double share = scatter / variance;
      squares += weight * (share * share * square + scatter * (1 - share));
      slip_pillars += weight;
    }
    scatter = squares / (slip_pillars + parameters.usual_scatter_pillars);
    slipping = (slip_pillars + 0.5) / pillars;
  }
  return std::sqrt(scatter);
}

/// Frictions of equal probability.
std::array<float, ContactModel::kNodes> nodes_of(const FrictionPosterior& posterior) {
  std::array<double, ContactModel::kNodes> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = (static_cast<double>(i) + 0.5) / ContactModel::kNodes;
  const auto fractions = values;
  posterior.quantiles(fractions, values);
  std::array<float, ContactModel::kNodes> nodes{};
  std::ranges::transform(values, nodes.begin(),
                         [](double value) { return static_cast<float>(value); });
  return nodes;
}

double largest_normal(const ForceFieldView& forces, std::span<const ContactRun> runs) {
  float largest = 0;
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      largest = std::max(largest, forces.normal[std::size_t{run.row} * forces.cols + col]);
    }
  }
  return largest;
}

}  // namespace

FrictionEstimator::FrictionEstimator(const Sensor& sensor, const FrictionKnowledge& knowledge,
                                     std::size_t members, const ContactParameters& parameters)
    : sensor_(sensor),
      parameters_(parameters),
      likelihood_(parameters),
      prior_{FrictionPosterior(knowledge), FrictionPosterior(cautious(knowledge, parameters))},
      prior_least_(prior_.cautious.quantile(kOneInTwenty)),
      given_(knowledge.given),
      carries_over_(knowledge.memory),
      workspaces_(members) {}

void FrictionEstimator::begin(const ForceFieldView& forces, const ContactLabels& labels) {
  if (sensor_.segment.pitch_over_arm > 0) leans_.resize(forces.status.size());
  std::swap(beliefs_, earlier_beliefs_);
  std::swap(histories_, earlier_histories_);
  beliefs_.assign(labels.contacts(), prior_);
  histories_.assign(labels.contacts(), {});
  models_.assign(labels.contacts(), {});
  friction_.assign(labels.contacts(), {});
  movements_.assign(labels.contacts(), {});
  if (!carries_over_) return;
  if (parameters_.past_pressure) {
    past_.begin(forces.rows, forces.cols, labels.runs_by_row());
  }
  std::swap(snapshot_, earlier_snapshot_);
  snapshot_.runs.assign(labels.runs_by_row().begin(), labels.runs_by_row().end());
  snapshot_.track_ids.assign(labels.contacts(), 0);
  snapshot_.centres.clear();
  for (std::uint32_t contact = 0; contact < labels.contacts(); ++contact) {
    double pillars = 0;
    double row = 0;
    double col = 0;
    for (const ContactRun& run : labels.runs(contact)) {
      const double length = run.end - run.first;
      pillars += length;
      row += length * run.row;
      col += length * 0.5 * (run.first + run.end - 1.0);
    }
    snapshot_.centres.push_back(
        {sensor_.pitch_mm * col / pillars, -sensor_.pitch_mm * row / pillars});
  }
  const ContactAssignment matches = match_contacts(earlier_snapshot_, snapshot_, sensor_.reach_mm);
  for (std::uint32_t contact = 0; contact < labels.contacts(); ++contact) {
    const std::uint32_t before = matches.earlier[contact] != kNoContact ? matches.earlier[contact]
                                                                        : matches.parents[contact];
    if (before == kNoContact) continue;
    const FrictionBelief& earlier = earlier_beliefs_[before];
    beliefs_[contact] = {earlier.estimate.carried(prior_.estimate, parameters_.forgetting),
                         earlier.cautious.carried(prior_.cautious, parameters_.forgetting)};
    histories_[contact] = earlier_histories_[before];
    if (matches.earlier[contact] == kNoContact) continue;
    if (std::ranges::find(matches.merged, contact) != matches.merged.end()) continue;
    const PatchPlace& from = earlier_snapshot_.centres[before];
    const PatchPlace& to = snapshot_.centres[contact];
    movements_[contact] = {(from.y_mm - to.y_mm) / sensor_.pitch_mm,
                           (to.x_mm - from.x_mm) / sensor_.pitch_mm};
  }
}

void FrictionEstimator::update(const ForceFieldView& forces, const ContactLabels& labels,
                               std::uint32_t contact, std::size_t member) {
  ContactModel& model = models_[contact];
  FrictionBelief& belief = beliefs_[contact];
  Workspace& work = workspaces_[member];
  ContactSamples& samples = work.samples;
  const auto runs = labels.runs(contact);
  model.noise_n =
      sensor_.noise_n ? *sensor_.noise_n : largest_normal(forces, runs) / kPeakOverNoise;
  if (!leans_.empty()) {
    for_each_ambiguous(forces, runs, [&](std::uint32_t index) {
      leans_[index] = lean_at(forces, index, sensor_.segment.pitch_over_arm);
    });
  }
  samples.sample(forces, leans_, runs, model.noise_n, sensor_.segment, parameters_);
  model.box = samples.box();
  const bool remembers = carries_over_ && parameters_.past_pressure;
  if (remembers) {
    past_.update(forces, runs, movements_[contact], model.noise_n, sensor_.segment, parameters_);
  }
  // Pillars that were not sampled may be ambiguous.
  model.any_ambiguous = !samples.ambiguous().empty() || samples.is_subsampled();

  FrictionEvidence evidence;
  likelihood_.add_slip_or_stick(samples.ratios(), parameters_.effective_pillars, evidence);
  likelihood_.add_lower_bounds(samples.bounds(), parameters_.effective_pillars, evidence);
  if (!samples.ambiguous().empty()) {
    if (!samples.pressure().empty()) samples.add_edges();
    model.pressure = PressureRegression::fit(samples.pressure());
    work.predicted.clear();
    if (model.pressure || remembers) predict(forces, model, work);
    FrictionEvidence by_pressure;
    likelihood_.add_slip_or_stick(work.predicted, parameters_.effective_predictions, by_pressure);
    for (std::size_t i = 0; i < evidence.estimate.size(); ++i) {
      evidence.estimate[i] += by_pressure.estimate[i];
    }
  }
  if (!samples.ratios().empty() || !samples.bounds().empty()) {
    belief.estimate.update(evidence.estimate);
    belief.cautious.update(evidence.cautious);
  }
  if (model.any_ambiguous) {
    model.frictions = nodes_of(belief.estimate);
    model.cautious = nodes_of(belief.cautious);
  }
  friction_[contact] = reported(contact, evidence.estimate, samples);
}

/// Collects the ratios of ambiguous pillars at their normal forces by regression and past.
void FrictionEstimator::predict(const ForceFieldView& forces, const ContactModel& model,
                                Workspace& work) const {
  constexpr double kMostDeviation = 0.35;  // largest relative deviation of a prediction
  constexpr double kStep = 0.02;           // relative step of the ratio's derivative
  const std::vector<std::uint32_t>& ambiguous = work.samples.ambiguous();
  const std::size_t step = (ambiguous.size() + kMostPredicted - 1) / kMostPredicted;
  const std::size_t count = (ambiguous.size() + step - 1) / step;
  PressureRegression::Values x{};
  PressureRegression::Values y{};
  PressureRegression::Predictions pressure;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t col = ambiguous[i * step] % forces.cols;
    const std::uint32_t row = ambiguous[i * step] / forces.cols;
    x[i] = model.box.x_of(col);
    y[i] = model.box.y_of(row);
  }
  if (model.pressure) model.pressure->predict(x, y, pressure);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = ambiguous[i * step];
    const LeanShear lean = leans_.empty() ? LeanShear{} : leans_[index];
    const FeasibleSegment segment = segment_at(forces, index, sensor_.segment, lean);
    auto found = past_.at(index, segment.high, model.noise_n);
    if (pressure.square[i] > 0) {
      const NormalEstimate shape = predicted_normal(pressure.square[i], pressure.variance[i],
                                                    segment.high, model.noise_n, parameters_);
      found = found ? shape.fused(*found) : shape;
    }
    if (!found) continue;
    const double normal = found->normal;
    const double deviation = std::sqrt(found->variance) / normal;
    if (!(deviation < kMostDeviation && normal > parameters_.least_normal * model.noise_n))
      continue;
    const double steepness = std::abs(std::log(segment.ratio_at(normal * (1 + kStep)) /
                                               segment.ratio_at(normal * (1 - kStep)))) /
                             (2 * kStep);
    const double ratio = segment.ratio_at(normal);
    const double own = deviation_of_ratio(ratio, normal, model.noise_n,
                                          {lean.deviation, sensor_.segment.residual}, parameters_);
    work.predicted.push_back(
        {ratio, std::hypot(deviation * steepness, own), ObservedRatio::kNoCeiling});
  }
}

/// True if the friction stayed while the load rose; while all pillars stick, both rise together.
/// Only loads above all earlier ones show it: unloaded pillars stick with the shear of before.
bool FrictionEstimator::stays(double friction, const FrictionPosterior::Summary& now,
                              double load_ratio, History& history) const {
  constexpr double kOneSided = 1.64;   // deviations
  constexpr double kLeastRise = 1e-6;  // spread of the logarithm of the load
  const bool newly_loaded = load_ratio >= parameters_.new_load * history.most_ratio &&
                            load_ratio > parameters_.least_load;
  if (!newly_loaded || now.spread > parameters_.clear_spread) return false;
  const double log_ratio = std::log(history.most_ratio);
  const double log_friction = std::log(now.median);
  FadingLine& growth = history.growth;
  growth.add(log_ratio - history.log_ratio, log_friction - history.log_friction,
             parameters_.load_memory);
  history.log_ratio = log_ratio;
  history.log_friction = log_friction;
  if (!(growth.spread() > kLeastRise)) return false;
  const double own = parameters_.friction_noise * parameters_.friction_noise;
  const double slope = growth.slope();
  const double end = slope + kOneSided * std::sqrt((growth.noise() + own) / growth.spread());
  const double away = std::log(friction) - (log_friction + growth.height());
  return std::abs(slope) < parameters_.most_growth && end < parameters_.most_growth_end &&
         std::abs(away) < parameters_.same_friction;
}

/// True if nearly all pillars share the friction as their ratio in directions apart, or on the way
/// of half the contact's length. Sticking, only a face or a body pressed obliquely has one ratio,
/// in one direction and at one place.
bool FrictionEstimator::slides(std::uint32_t contact, double friction, bool one_ratio,
                               const ContactSamples& samples, History& history) const {
  const double log_friction = std::log(friction);
  if (!one_ratio ||
      std::abs(log_friction - history.log_friction_then) > parameters_.same_friction) {
    history.log_friction_then = log_friction;
    history.travel = {};
  } else {
    history.travel.rows += movements_[contact].rows;
    history.travel.cols += movements_[contact].cols;
  }
  if (!one_ratio) return false;
  return samples.alignment() < parameters_.apart ||
         std::hypot(history.travel.rows, history.travel.cols) > samples.box().scale();
}

/// The friction to report, and its source.
ContactFriction FrictionEstimator::reported(std::uint32_t contact,
                                            const FrictionCurve& log_likelihood,
                                            const ContactSamples& samples) {
  const auto [median, spread] = beliefs_[contact].estimate.summary();
  ContactFriction friction{
      median, spread, FrictionSource::prior,
      parameters_.bound_factor * beliefs_[contact].cautious.quantile(kOneInTwenty)};
  if (given_) {
    friction.median = *given_;
    friction.source = FrictionSource::given;
    return friction;
  }
  if (friction.least > prior_least_) friction.source = FrictionSource::at_least;
  History& history = histories_[contact];
  history.most_ratio = std::max(history.most_ratio, samples.load_ratio());
  if (spread > parameters_.reported_spread) return friction;
  FrictionPosterior alone = prior_.estimate;
  alone.update(log_likelihood);
  const FrictionPosterior::Summary now = alone.summary();
  const bool stayed = stays(median, now, samples.load_ratio(), history);
  const bool one_ratio = now.spread <= parameters_.clear_spread &&
                         samples.load_ratio() >= parameters_.sliding_load * now.median;
  const bool slid = slides(contact, now.median, one_ratio, samples, history);
  if (stayed || slid) history.friction = median;
  if (!history.friction) return friction;
  // Below the friction last shown, pillars that stick after unloading say nothing against it.
  const double change = median / *history.friction - 1;
  const double fall = one_ratio ? parameters_.other_friction : parameters_.unloaded_friction;
  if (change > parameters_.other_friction || change < -fall) return friction;
  friction.median = *history.friction;
  friction.spread = std::hypot(parameters_.stated_over_spread * spread,
                               friction_scatter(samples.ratios(), friction.median, parameters_));
  const bool observed = now.spread <= parameters_.reported_spread &&
                        std::abs(now.median / friction.median - 1) <= parameters_.same_friction;
  friction.source = observed ? FrictionSource::observed : FrictionSource::carried_over;
  return friction;
}

}  // namespace pillarfield
