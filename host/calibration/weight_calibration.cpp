#include "pillarfield/weight_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/steps.h"
#include "calibration/weight_fit.h"
#include "calibration/weight_selection.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

constexpr std::size_t kFewestFrames = 20;
constexpr std::size_t kFewestPlaces = 5;
/// Frames of which a visited sensel reads above the threshold.
constexpr std::size_t kFewestVisits = 5;
/// Largest misfit of the sums, relative.
constexpr double kMostWeightMisfit = 0.15;
/// Largest deviation of an exponent that counts as seen, relative. A rigid base, whose
/// gains may imitate another exponent, leaves 0.1 and more, too small by a factor of up to three.
constexpr double kMostExponentDeviation = 0.05;
constexpr int kWeightSamples = 48;

/// The threshold of readings after the gain, without curve and power law.
double reading_threshold(const SkinCalibration& calibration) {
  SkinCalibration linear = calibration;
  set_power_law(linear, std::nullopt);
  linear.planes.effects.curve = {};
  const double factor = calibration.threshold_factor.value_or(4);
  set_threshold(linear, factor);
  return *linear.threshold_counts;
}

}  // namespace

WeightFinder::WeightFinder(const Skin& skin, const SkinCalibration& calibration)
    : skin_(skin), calibration_(calibration) {
  require_fitting(calibration, skin, "calibration");
  if (calibration.planes.tare.empty() || calibration.planes.noise.empty()) {
    throw Error("calibration", "has no tare or no noise",
                "take the tare of the unloaded skin first");
  }
  if (calibration.planes.effects.memory) {
    throw Error("calibration", "has a memory, which a weight that moves would change",
                "calibrate the weight before the memory");
  }
  threshold_ = reading_threshold(calibration);
}

void WeightFinder::begin(double weight_n, std::string name) {
  if (!(weight_n > 0 && std::isfinite(weight_n))) {
    throw Error(name, fmt::format("its weight is {} N", weight_n), "it must be above zero");
  }
  recordings_.push_back({std::move(name), weight_n});
}

void WeightFinder::add(const FrameView& frame) {
  const Calibration& planes = calibration_.planes;
  const double full_scale =
      skin_.full_scale_counts.value_or(std::numeric_limits<double>::infinity());
  std::vector<float> readings(skin_.sensels());
  std::vector<std::size_t> above;
  bool saturated = false;
  bool unreadable = false;
  for_each_row(frame, [&](std::size_t row, const auto* raws) {
    for (std::size_t col = 0; col < skin_.cols; ++col) {
      const std::size_t i = row * skin_.cols + col;
      if (state_of(planes, i) != kGood) continue;
      const auto raw = static_cast<double>(raws[col]);
      saturated |= raw >= full_scale;
      unreadable |= !(std::abs(raw) <= kMaxCounts);
      const double gain = planes.gain.empty() ? 1 : planes.gain[i];
      readings[i] = static_cast<float>((raw - planes.tare[i]) * gain);
      if (readings[i] > threshold_) above.push_back(i);
    }
  });
  if (unreadable) {
    ++unreadable_;
    return;
  }
  saturated_ += saturated ? 1 : 0;
  std::vector<std::uint8_t> near(skin_.sensels(), 0);
  for (const std::size_t i : above) {
    const Neighbours beside(skin_, i);
    // A sensel alone is noise, somewhere on the array.
    if (std::ranges::none_of(beside.all(),
                             [&](std::size_t n) { return readings[n] > threshold_; })) {
      continue;
    }
    near[i] = 1;
    for (const std::size_t n : beside.all()) near[n] = 1;
  }
  const std::size_t begin = sensels_.size();
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (near[i] == 0 || state_of(planes, i) != kGood) continue;
    sensels_.push_back(static_cast<std::uint32_t>(i));
    readings_.push_back(readings[i]);
  }
  if (sensels_.size() == begin) return;
  contacts_.push_back({recordings_.size() - 1, begin, sensels_.size(), saturated});
}

namespace {

/// Throws if most frames of a recording are saturated: the others are those in which the weight is
/// put down or lifted.
void require_unsaturated(const WeightContacts& all, std::size_t recording,
                         const std::string& name) {
  std::size_t frames = 0;
  std::size_t saturated = 0;
  for (const WeightFinder::Contact& each : all.contacts) {
    if (each.recording != recording) continue;
    ++frames;
    saturated += each.saturated ? 1 : 0;
  }
  if (2 * saturated <= frames) return;
  throw Error(name,
              fmt::format("{} of its {} with contact are saturated: in the others the weight may "
                          "stand in part",
                          saturated, counted(frames, "frame")),
              "give a lighter weight, or one that stands on more sensels");
}

void require_selection(const WeightSelection& selection, const WeightResult& result,
                       const std::string& name) {
  if (selection.frames.size() < kFewestFrames) {
    throw Error(
        name,
        fmt::format("in {} frames the weight stands wholly on the array ({} at the edge, {} "
                    "saturated, {} with other sums)",
                    selection.frames.size(), selection.at_edge, result.frames_saturated,
                    selection.apart),
        fmt::format("give {} at least, away from the edge and below full scale", kFewestFrames));
  }
  if (selection.places < kFewestPlaces) {
    throw Error(name, fmt::format("the weight stands at {}", counted(selection.places, "place")),
                fmt::format("roll it over the array, or place it at {} at least", kFewestPlaces));
  }
}

/// Throws if sensels are loaded alike in nearly all frames, while the weight moves.
void refuse_standing_body(const WeightContacts& all, const Calibration& planes,
                          const std::string& name) {
  constexpr double kNearlyAlways = 0.98;
  constexpr double kAlike = 0.05;  // of the median reading, beside three deviations of the noise
  constexpr std::size_t kFewestStanding = 3;
  std::vector<std::vector<float>> loaded(all.skin.sensels());
  for (std::size_t n = 0; n < all.sensels.size(); ++n) {
    if (all.readings[n] > all.threshold) loaded[all.sensels[n]].push_back(all.readings[n]);
  }
  std::size_t standing = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    std::vector<float>& readings = loaded[i];
    if (static_cast<double>(readings.size()) <
        kNearlyAlways * static_cast<double>(all.contacts.size())) {
      continue;
    }
    const double middle = median(readings);
    const double low = quantile(readings, 0.05);
    if (middle - low > kAlike * middle + 3 * planes.noise[i]) continue;
    if (standing++ == 0) first = i;
  }
  if (standing < kFewestStanding) return;
  throw Error(
      name,
      fmt::format("{} sensels, the first at row {}, column {}, carry one load in all frames "
                  "while the weight moves: something else stands there",
                  standing, first / all.skin.cols, first % all.skin.cols),
      "take it off, or take the tare with it");
}

/// The typical reading under the weight.
double typical_reading(const std::vector<WeighedFrame>& frames, double threshold) {
  double sum = 0;
  double count = 0;
  for (const WeighedFrame& frame : frames) {
    for (const WeighedReading& each : frame.readings) {
      if (!(each.reading > threshold)) continue;
      sum += std::log(each.reading);
      ++count;
    }
  }
  return std::exp(sum / count);
}

WeightResponse response_before(const SkinCalibration& before, double reading) {
  WeightResponse response;
  response.curve = before.planes.effects.curve;
  response.reference = std::clamp(reading, kMinReferenceCounts, kMaxReferenceCounts);
  if (!before.power_law) return response;
  response.exponent = before.power_law->exponent;
  response.reference = before.power_law->reference_counts;
  return response;
}

/// Weighted mean of the counts of V above the threshold for each newton.
double counts_per_newton(const WeightFit& fit, double threshold_counts) {
  const std::span<const WeighedFrame> frames = fit.frames();
  const WeighedArray& array = fit.array();
  double sum = 0;
  double weights = 0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    double counts = 0;
    for (const auto& [i, reading] : frames[t].readings) {
      const double load = fit.response().at(std::exp(fit.log_gains()[i]) * reading).load;
      if (load > threshold_counts) counts += array.copies[i] * (load + array.zone(i, reading));
    }
    if (!(counts > 0) || fit.weights()[t] == 0) continue;
    sum += fit.weights()[t] * std::log(counts / frames[t].weight_n);
    weights += fit.weights()[t];
  }
  return std::exp(sum / weights);
}

void store_gains(const WeightFit& fit, WeightResult& result) {
  std::vector<float>& gain = result.calibration.planes.gain;
  if (gain.empty()) gain.assign(fit.log_gains().size(), 1);
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (result.visited[i] == 0) continue;
    const double found = gain[i] * std::exp(fit.log_gains()[i]);
    gain[i] = static_cast<float>(std::clamp(found, kMinGain, kMaxGain));
  }
}

std::vector<std::uint8_t> visited_by(const std::vector<WeighedFrame>& frames, const WeightFit& fit,
                                     double threshold) {
  std::vector<std::size_t> visits(fit.log_gains().size(), 0);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    if (fit.weights()[t] == 0) continue;
    for (const auto& [i, reading] : frames[t].readings) visits[i] += reading > threshold ? 1 : 0;
  }
  std::vector<std::uint8_t> visited(visits.size());
  std::ranges::transform(visits, visited.begin(),
                         [](std::size_t count) { return count >= kFewestVisits ? 1 : 0; });
  return visited;
}

void summarise_gains(const WeightFit& fit, const std::vector<double>& deviations,
                     WeightResult& result) {
  double spread = 0;
  double deviation = 0;
  double count = 0;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    if (result.visited[i] == 0) continue;
    spread += fit.log_gains()[i] * fit.log_gains()[i];
    deviation += deviations[i] * deviations[i];
    ++count;
  }
  result.gain_spread = std::sqrt(spread / std::max(1.0, count));
  result.gain_deviation = std::sqrt(deviation / std::max(1.0, count));
  result.unvisited_deviation = fit.spread();
}

/// Fits the exponent if the frames determine it, or keeps that before.
WeightFit fit_weight(const std::vector<WeighedFrame>& frames, const WeighedArray& array,
                     const WeightResponse& before, WeightResult& result) {
  WeightFit fit(frames, array, before);
  if (!before.curve.empty()) {
    fit.fit(WeightFit::Exponent{1, 0});
    return fit;
  }
  fit.fit(std::nullopt);
  const double exponent = fit.response().exponent;
  result.finds_exponent = fit.exponent_deviation() < kMostExponentDeviation * exponent &&
                          exponent > kMinExponent && exponent < kMaxExponent;
  if (!result.finds_exponent) {
    fit = WeightFit(frames, array, before);
    fit.fit(WeightFit::Exponent{before.exponent, WeightFit::kExponentSpread * before.exponent});
  }
  result.exponent = fit.response().exponent;
  result.exponent_deviation = fit.exponent_deviation();
  return fit;
}

}  // namespace

WeightResult WeightFinder::result() const {
  const std::string name = recordings_.empty() ? "weight" : recordings_.front().name;
  WeightResult result;
  result.calibration = calibration_;
  result.frames_saturated = saturated_;
  result.frames_unreadable = unreadable_;
  SkinCalibration& after = result.calibration;
  const WeightContacts all{skin_, threshold_, contacts_, sensels_, readings_};
  result.findings = unresponsive_sensels(all, after.planes);
  if (!result.findings.empty() && after.planes.mask.empty()) {
    after.planes.mask.assign(skin_.sensels(), kGood);
  }
  for (const SenselFinding& finding : result.findings) {
    after.planes.mask[std::size_t{finding.row} * skin_.cols + finding.col] = kMissing;
  }
  std::vector<double> weights_n;
  for (const Recording& each : recordings_) {
    require_unsaturated(all, weights_n.size(), each.name);
    weights_n.push_back(each.weight_n);
  }
  const WeightSelection selection = select_frames(all, after.planes, weights_n);
  const std::vector<double> copies = copies_of(after.planes, skin_);
  require_selection(selection, result, name);
  refuse_standing_body(all, after.planes, name);
  const std::vector<WeighedFrame>& frames = selection.frames;

  WeighedArray array{skin_.rows, skin_.cols, threshold_, {}, copies, after.planes.dead_zone};
  for (std::size_t i = 0; i < skin_.sensels(); ++i) {
    const double gain = after.planes.gain.empty() ? 1 : after.planes.gain[i];
    array.noise.push_back(std::max(gain * after.planes.noise[i], 1e-3 * threshold_ + 1e-9));
  }
  const WeightResponse before = response_before(calibration_, typical_reading(frames, threshold_));
  const WeightFit fit = fit_weight(frames, array, before, result);
  if (fit.misfit() > kMostWeightMisfit) {
    throw Error(name,
                fmt::format("the readings under the weight add up to sums that differ by {:.0f} %",
                            100 * fit.misfit()),
                "let the whole weight stand on the array, and nothing else");
  }
  result.frames_at_edge = selection.at_edge;
  result.places = selection.places;
  result.frames_used = static_cast<std::size_t>(
      std::ranges::count_if(fit.weights(), [](double weight) { return weight > 0; }));
  result.frames_apart = selection.apart + frames.size() - result.frames_used;
  result.misfit = fit.misfit();
  result.misfit_before = fit.first_misfit();
  result.visited = visited_by(frames, fit, threshold_);
  store_gains(fit, result);
  if (result.finds_exponent) {
    set_power_law(after, PowerLaw{fit.response().exponent, fit.response().reference});
  }
  set_threshold(after, calibration_.threshold_factor.value_or(4));
  after.counts_per_newton =
      counts_per_newton(fit, *after.threshold_counts) / sensel_sum(after.planes.effects);
  const WeightDeviations deviations = deviations_of(fit, kWeightSamples);
  summarise_gains(fit, deviations.gains, result);
  result.total_deviation = deviations.total;
  ResidualError residual = after.planes.effects.residual.value_or(ResidualError{});
  residual.relative = std::min(1.0, deviations.element);
  after.planes.effects.residual = residual;
  require_untouched_idle(calibration_, after, "weight");
  return result;
}

namespace {

void report_weight(StepReport& report, const WeightResult& result) {
  const SkinCalibration& calibration = result.calibration;
  const double k = *calibration.counts_per_newton;
  report.measure("counts_per_newton", k, "sensitivity",
                 fmt::format("counts per newton, ± {:.2g} %", 100 * result.total_deviation));
  report.facts["counts_per_newton_deviation"] = k * result.total_deviation;
  report.measure("total_deviation", result.total_deviation, "total",
                 "% deviation of the total of 0.3 to 2 times the weight, anywhere");
  if (calibration.planes.effects.curve.empty()) {
    report.measure("exponent", result.exponent, "exponent",
                   result.finds_exponent ? fmt::format("± {:.2g} of the load in the reading",
                                                       result.exponent_deviation)
                                         : "not seen: it stays as it was");
    report.facts["exponent_deviation"] = result.exponent_deviation;
  }
  report.facts["exponent_stored"] = result.finds_exponent;
  std::size_t good = 0;
  std::size_t visited = 0;
  auto unvisited = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.visited.size(); ++i) {
    if (!is_good(calibration.planes, i)) continue;
    ++good;
    visited += result.visited[i];
    if (result.visited[i] == 0) unvisited.push_back({i / calibration.cols, i % calibration.cols});
  }
  report.measure("visited", static_cast<double>(visited) / static_cast<double>(good), "visited",
                 fmt::format("% of the good sensels: {} of {}", visited, good));
  if (!unvisited.empty()) {
    report.notes.push_back(fmt::format("Not visited: {}, which keep their gain, ± {:.0f} %",
                                       counted(unvisited.size(), "sensel"),
                                       100 * result.unvisited_deviation));
  }
  report.facts["unvisited_sensels"] = std::move(unvisited);
  report.measure("gain_spread", result.gain_spread, "gain", "% spread of the visited sensels");
  report.measure("gain_deviation", result.gain_deviation, "gain error",
                 "% deviation of a visited sensel's gain");
  report.measure("unvisited_deviation", result.unvisited_deviation, "unvisited",
                 "% deviation of the gain of a sensel that was not visited");
  report.measure("misfit_before", result.misfit_before, "before",
                 "% misfit of the sums, beyond noise, without gains and exponent");
  report.measure("misfit", result.misfit, "after", "% misfit of the sums, beyond noise");
  report.facts["frames_used"] = result.frames_used;
  report.facts["places"] = result.places;
  report.facts["frames_at_edge"] = result.frames_at_edge;
  report.facts["frames_saturated"] = result.frames_saturated;
  report.facts["frames_unreadable"] = result.frames_unreadable;
  report.facts["frames_apart"] = result.frames_apart;
  report.add(calibration, result.findings);
  report.notes.push_back(fmt::format(
      "Frames: {} at {}; left out: {} at the edge, {} saturated, {} without a number, {} with "
      "another sum",
      counted(result.frames_used, "frame"), counted(result.places, "place"), result.frames_at_edge,
      result.frames_saturated, result.frames_unreadable, result.frames_apart));
  if (calibration.planes.effects.curve.empty() && !result.finds_exponent) {
    report.notes.emplace_back(
        "The weight presses too much alike to show the exponent: the response stays as it was, and "
        "other weights may be far off. Roll a second weight, or turn this one onto another face");
  }
  report.add_residual(calibration.planes.effects);
}

SkinCalibration run_weight(StepWork& work) {
  const std::vector<double> weights_n = work.numbers("load-n");
  WeightFinder finder(work.correction(work.files.front(), WireUse::loaded).skin(), work.before);
  for (std::size_t i = 0; i < work.files.size(); ++i) {
    finder.begin(weights_n[i], work.files[i].name());
    work.for_each(work.files[i], [&](const FrameView& frame, double) { finder.add(frame); });
  }
  const WeightResult result = finder.result();
  work.report.headline =
      fmt::format("Found gains and newtons from {}, {}", counted(weights_n.size(), "weight"),
                  counted(work.frames(), "frame"));
  report_weight(work.report, result);
  work.parameters = fmt::format(
      "loads_n = {}, exponent = {:.4f}, total_deviation = {:.4f}", fmt::join(weights_n, " "),
      result.finds_exponent ? result.exponent : 1, result.total_deviation);
  return result.calibration;
}

}  // namespace

StepKind weight_step() {
  StepKind step = {"weight",
                   "Gains, a power law and newtons from a known weight that is placed or rolled "
                   "anywhere.",
                   "FRAMES", "Frames under a weight that moves, one file per weight", run_weight};
  step.only = SkinLayout::sensels;
  step.arguments = {
      StepArgument::per_file("load-n", "L1,L2,...", "Weight of each file, in order", {1e-6, 1e6})};
  step.examples = {"simulate scenes/touch/pad.toml --uncalibrated --frames 20 -o idle.h5",
                   kTareIdle, "simulate scenes/touch/pad.toml --uncalibrated -o rolled.h5",
                   "calibrate weight rolled.h5 --load-n 20 --calibration tared.h5 -o pad.h5"};
  return step;
}

}  // namespace pillarfield
