#include "pillarfield/equilibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/finding_list.h"
#include "calibration/held_out.h"
#include "calibration/response_fit.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// Largest fraction of sensels that may fail in one way before the press is refused.
constexpr double kFailingFraction = 0.2;
/// Largest residual of the curve on held-out pressures, relative to that of straight lines, at
/// which it is preferred.
constexpr double kCurveWins = 0.8;
/// Factor from the median response beyond which a sensel is masked as unequal.
constexpr double kUnequal = 10;

void require_presses(const SkinCalibration& before, std::span<const UniformPress> presses) {
  if (presses.empty()) throw Error("equilibration", "no press is given", "give one at least");
  if (before.planes.tare.empty()) {
    throw Error("calibration", "has no tare", "take the tare of the unloaded skin first");
  }
  for (const auto& [frames, pressure_kpa] : presses) {
    require_fitting(before, frames.skin(), frames.name());
    require_frames(frames, kLeastPressFrames);
    if (pressure_kpa > 0 && std::isfinite(pressure_kpa)) continue;
    throw Error(frames.name(), fmt::format("its pressure is {} kPa", pressure_kpa),
                "it must be above zero");
  }
}

/// The responses of all sensels; unresponsive for masked ones and those that no element has.
std::vector<Response> fit_all(const ResponseFit& fit, const Skin& skin, const FindingList& found) {
  std::vector<Response> responses(skin.sensels());
  for_each_solved_sensel(skin, [&](std::size_t i) {
    if (found.good(i)) responses[i] = fit(i);
  });
  return responses;
}

SenselFault fault_of(Response::Kind kind) {
  if (kind == Response::Kind::saturated) return SenselFault::saturated;
  return kind == Response::Kind::unresponsive ? SenselFault::unresponsive : SenselFault::unequal;
}

void mask_unresponsive(const std::vector<Response>& responses, const Skin& skin,
                       FindingList& found) {
  for_each_solved_sensel(skin, [&](std::size_t i) {
    if (!found.good(i) || responses[i].kind == Response::Kind::good) return;
    found.mask(i, fault_of(responses[i].kind));
  });
}

void require_responses(const FindingList& found, std::size_t tested, const std::string& name) {
  std::size_t saturated = 0;
  for (const SenselFinding& finding : found.findings()) {
    saturated += finding.fault == SenselFault::saturated ? 1 : 0;
  }
  const std::size_t unresponsive = found.findings().size() - saturated;
  const double limit = kFailingFraction * static_cast<double>(tested);
  if (static_cast<double>(saturated) > limit) {
    throw Error(name, fmt::format("{} of {} sensels are at full scale", saturated, tested),
                "press less");
  }
  if (tested > 0 && static_cast<double>(unresponsive) <= limit) return;
  throw Error(name, fmt::format("{} of {} sensels do not respond", unresponsive, tested),
              "press the whole skin evenly, and harder than its dead zone and noise");
}

/// Statistics over the responses of all good sensels.
class ResponseSummary {
 public:
  ResponseSummary(const std::vector<Response>& responses, const FindingList& found)
      : responses_(responses), found_(found) {}

  [[nodiscard]] double median_newtons_per_count() const {
    std::vector<double> values;
    for_good([&](const Response& r) { values.push_back(r.newtons_per_count); });
    return median(values);
  }

  /// Counts per newton for which the mean gain is 1.
  [[nodiscard]] double counts_per_newton() const {
    double newtons_per_count = 0;
    double dead_zone_gain = 0;
    double count = 0;
    for_good([&](const Response& r) {
      newtons_per_count += r.newtons_per_count;
      dead_zone_gain += r.dead_zone_gain;
      ++count;
    });
    return (count + dead_zone_gain) / newtons_per_count;
  }

  [[nodiscard]] double gain_spread(double k) const {
    double squares = 0;
    double count = 0;
    for_good([&](const Response& r) {
      const double gain = k * r.newtons_per_count - r.dead_zone_gain;
      squares += (gain - 1) * (gain - 1);
      ++count;
    });
    return std::sqrt(squares / count);
  }

  [[nodiscard]] double nonlinearity() const {
    double misfit = 0;
    double responded = 0;
    for_good([&](const Response& r) {
      misfit += r.misfit;
      responded += r.responded;
    });
    return responded > 0 ? std::sqrt(misfit / responded) : 0;
  }

  /// `sum`, of the sensels, multiplies the load, but not the dead zone, which comes before.
  [[nodiscard]] double median_dead_zone(double k, double sum) const {
    std::vector<double> values;
    for_good([&](const Response& r) { values.push_back(k * r.dead_zone_n / sum); });
    return median(values);
  }

 private:
  template <class Use>
  void for_good(Use use) const {
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (found_.good(i) && responses_[i].kind == Response::Kind::good) use(responses_[i]);
    }
  }

  const std::vector<Response>& responses_;
  const FindingList& found_;
};

void mask_unequal(const std::vector<Response>& responses, double typical, FindingList& found) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    if (!found.good(i) || responses[i].kind != Response::Kind::good) continue;
    const double ratio = responses[i].newtons_per_count / typical;
    if (ratio > kUnequal || ratio < 1 / kUnequal) found.mask(i, SenselFault::unequal);
  }
}

/// Standard deviation of the log response between pillars that the four sensels of a pillar do not
/// explain: one-way analysis of variance over pillars with four good sensels.
double unevenness_of(const std::vector<Response>& responses, const Skin& skin,
                     const FindingList& found) {
  double pillars = 0;
  double sum = 0;
  double between = 0;
  double within = 0;
  for_each_pillar(skin, [&](auto, auto, const auto& sensels) {
    double mean = 0;
    double squares = 0;
    for (const std::size_t i : sensels) {
      if (!found.good(i)) return;
      const double response = std::log(responses[i].newtons_per_count);
      mean += response / 4;
      squares += response * response;
    }
    ++pillars;
    sum += mean;
    between += mean * mean;
    within += squares - 4 * mean * mean;
  });
  if (pillars < 2) return 0;
  const double mean_square_within = within / (3 * pillars);
  const double mean_square_between = 4 * (between - sum * sum / pillars) / (pillars - 1);
  return std::sqrt(std::max(0.0, (mean_square_between - mean_square_within) / 4));
}

/// Ratio of mean shear to mean normal force over pillars with four good sensels. By D1 with
/// V = kN (1 + c) it is √2 times the mean contrast c of the sides; random differences cancel.
double shear_of(const std::vector<Response>& responses, const Skin& skin,
                const FindingList& found) {
  if (!skin.has_pillars()) return 0;
  double pillars = 0;
  double right = 0;
  double up = 0;
  for_each_pillar(skin, [&](auto, auto, const auto& sensels) {
    std::array<double, 4> log_responses{};
    for (std::size_t n = 0; n < sensels.size(); ++n) {
      if (!found.good(sensels.at(n))) return;
      log_responses.at(n) = -std::log(responses[sensels.at(n)].newtons_per_count);
    }
    ++pillars;
    right += (log_responses[0] + log_responses[3] - log_responses[1] - log_responses[2]) / 4;
    up += (log_responses[0] + log_responses[1] - log_responses[2] - log_responses[3]) / 4;
  });
  return pillars == 0 ? 0 : std::numbers::sqrt2 * std::hypot(right, up) / pillars;
}

void require_even(double unevenness, double most, const std::string& name) {
  if (unevenness <= most) return;
  throw Error(name,
              fmt::format("the pressure varies by {:.1f} % between pillars, more than {:.1f} %",
                          100 * unevenness, 100 * most),
              "press evenly, as with an inflated membrane, or allow more unevenness");
}

/// Judges the models on held-out pressures and chooses one.
void choose_model(const EquilibrationOptions& options, const ResponseFit& fit,
                  const std::vector<std::uint8_t>& mask, EquilibrationResult& result) {
  const std::vector<HeldOutLevel> linear = hold_out(ResponseModel::linear, fit, mask);
  const std::vector<HeldOutLevel> curve = hold_out(ResponseModel::curve, fit, mask);
  result.held_out_linear = relative_residual(linear);
  result.held_out_curve = relative_residual(curve);
  const bool wins = result.held_out_linear && result.held_out_curve &&
                    *result.held_out_curve < kCurveWins * *result.held_out_linear;
  result.model = options.model.value_or(wins ? ResponseModel::curve : ResponseModel::linear);
}

ResponseFit fit_model(ResponseModel model, std::span<const UniformPress> presses,
                      const SkinCalibration& before) {
  if (auto fit = fit_of(model, presses, before.planes, before.planes.mask)) return *std::move(fit);
  throw Error(presses.back().frames.name(), "the presses determine no response curve",
              "give two or more pressures at which most sensels respond and none is at full scale, "
              "or fit straight lines");
}

/// The common response in counts: its readings with gains of mean 1, its loads with `k`.
ResponseCurve curve_in_counts(const ResponseFit& fit, double k) {
  ResponseCurve curve = fit.common()->curve;
  for (double& reading : curve.readings) reading *= k * fit.newtons_per_reading();
  for (double& load : curve.loads) load *= k;
  return curve;
}

/// Fills gains, and dead zones if there are several pressures; masked sensels get 1 and 0.
void fill_planes(const std::vector<Response>& responses, double k, bool several, const Skin& skin,
                 const FindingList& found, Calibration& planes) {
  planes.gain.assign(responses.size(), 1);
  if (several) planes.dead_zone.assign(responses.size(), 0);
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Response& response = responses[i];
    if (!found.good(i) || response.kind != Response::Kind::good) continue;
    planes.gain[i] = static_cast<float>(k * response.newtons_per_count - response.dead_zone_gain);
    if (!several) continue;
    planes.dead_zone[i] =
        static_cast<float>(k * response.dead_zone_n / sensel_sum(planes.effects, skin, i));
  }
  planes.mask = found.mask_plane();
}

}  // namespace

EquilibrationResult equilibrate(const SkinCalibration& before,
                                std::span<const UniformPress> presses,
                                const EquilibrationOptions& options) {
  require_presses(before, presses);
  const FrameStatistics& last = presses.back().frames;
  const Skin& skin = last.skin();
  EquilibrationResult result;
  choose_model(options, ResponseFit(presses, before.planes), before.planes.mask, result);
  const ResponseFit fit = fit_model(result.model, presses, before);
  FindingList found(before.planes.mask, last);
  const std::size_t masked_before = skin.sensels() - found.count_good();
  const std::vector<Response> responses = fit_all(fit, skin, found);
  mask_unresponsive(responses, skin, found);
  const std::size_t solved = skin.has_pillars() ? 4 * skin.pillars() : skin.sensels();
  require_responses(found, solved - std::min(solved, masked_before), last.name());
  const ResponseSummary summary(responses, found);
  mask_unequal(responses, summary.median_newtons_per_count(), found);

  const double k = summary.counts_per_newton();
  result.levels = fit.levels().size();
  result.unevenness = unevenness_of(responses, skin, found);
  require_even(result.unevenness, options.most_unevenness, last.name());
  result.shear = shear_of(responses, skin, found);
  result.gain_spread = summary.gain_spread(k);
  result.nonlinearity = result.levels > 2 ? summary.nonlinearity() : 0;
  result.dead_zone_counts = summary.median_dead_zone(k, sensel_sum(before.planes.effects));
  result.calibration = before;
  SkinCalibration& after = result.calibration;
  fill_planes(responses, k, result.levels > 1, skin, found, after.planes);
  after.counts_per_newton = k;
  after.planes.effects.curve = {};
  if (fit.common()) {
    set_power_law(after, std::nullopt);
    after.planes.effects.curve = curve_in_counts(fit, k);
  }
  after.planes.effects.residual =
      residual_error(hold_out(result.model, fit, found.mask_plane()), k);
  if (before.threshold_factor) set_threshold(after, *before.threshold_factor);
  require_untouched_idle(before, after, "equilibrate");
  result.findings = found.findings();
  return result;
}

namespace {

/// Relative shear under uniform pressure above which the gains are worth a warning.
constexpr double kMuchShear = 0.03;

const char* name_of(ResponseModel model) {
  return model == ResponseModel::curve ? "curve" : "linear";
}

void add_held_out(StepReport& report, const char* fact, const std::optional<double>& residual,
                  const char* what) {
  if (!residual) return;
  report.measure(fact, *residual, "held out",
                 fmt::format("% residual of {} on pressures that the fit left out", what));
}

void report_equilibration(StepReport& report, const EquilibrationResult& result) {
  report.facts["levels"] = result.levels;
  report.measure("counts_per_newton", *result.calibration.counts_per_newton, "sensitivity",
                 "counts per newton and pillar");
  report.measure("gain_spread", result.gain_spread, "gain", "% standard deviation, mean 1");
  report.measure("unevenness", result.unevenness, "unevenness",
                 "% from pillar to pillar, beyond the spread of their sensels");
  report.measure("shear", result.shear, "shear", "% of the normal force");
  if (result.levels > 1) {
    report.measure("dead_zone_counts", result.dead_zone_counts, "dead zone", "counts, median");
  }
  if (result.levels > 2) {
    report.measure("nonlinearity", result.nonlinearity, "nonlinearity",
                   "% of the response, residual of the fits");
  }
  report.facts["model"] = name_of(result.model);
  add_held_out(report, "held_out_linear", result.held_out_linear, "straight lines");
  add_held_out(report, "held_out_curve", result.held_out_curve, "a common curve");
  report.add(result.calibration, result.findings);
  report.notes.push_back(fmt::format("Model: {}", name_of(result.model)));
  report.add_residual(result.calibration.planes.effects);
}

SkinCalibration run_equilibrate(StepWork& work) {
  EquilibrationOptions options;
  options.most_unevenness = work.number("max-unevenness", options.most_unevenness);
  if (const auto model = work.word("model")) {
    options.model = *model == "curve" ? ResponseModel::curve : ResponseModel::linear;
  }
  const std::vector<double> pressures_kpa = work.numbers("pressure-kpa");
  const std::vector<FrameStatistics> statistics = work.statistics();
  std::vector<UniformPress> presses;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    presses.push_back({statistics[i], pressures_kpa[i]});
  }
  const EquilibrationResult result = equilibrate(work.before, presses, options);
  work.report.headline = fmt::format(
      "Equilibrated {} x {} sensels from {} at {:g} kPa", result.calibration.rows,
      result.calibration.cols, counted(work.frames(), "frame"), fmt::join(pressures_kpa, ", "));
  report_equilibration(work.report, result);
  if (result.shear > kMuchShear) {
    work.report.warnings.push_back(fmt::format(
        "{}: shear is {:.1f} % of the normal force and biases the gains; press without shear",
        work.files.back().name(), 100 * result.shear));
  }
  work.parameters =
      fmt::format("pressures_kpa = {}, most_unevenness = {}, model = {}",
                  fmt::join(pressures_kpa, " "), options.most_unevenness, name_of(result.model));
  return result.calibration;
}

}  // namespace

StepKind equilibrate_step() {
  StepKind step = {
      "equilibrate",
      "Gains, and from several pressures dead zones and a response curve, under uniform pressure.",
      "UNIFORM", "Frames under uniform pressure, one file per pressure", run_equilibrate};
  step.arguments = {
      StepArgument::per_file("pressure-kpa", "P1,P2,...", "Pressure of each file, in order",
                             {1e-6, 1e6}),
      StepArgument::number("max-unevenness", "RATIO",
                           "Largest variation of the pressure from pillar to pillar [0.1]",
                           {0, 1e6}),
      StepArgument::word("model", {"linear", "curve"},
                         "linear: a straight line for each sensel; curve: a response that all "
                         "share, from two pressures or more [the better one on held-out "
                         "pressures]")};
  step.examples = {kSimulateIdle, kSimulatePressed, kTareIdle, kEquilibratePressed,
                   ("calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --model linear "
                    "--calibration tared.h5 -o lines.h5")};
  return step;
}

}  // namespace pillarfield
