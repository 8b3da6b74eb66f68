#include "pillarfield/leak_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/leak_fit.h"
#include "calibration/linear_readings.h"
#include "calibration/normal_equations.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// Least sum of a pressed pillar, in multiples of its noise.
constexpr double kLeastPress = 100;
/// Largest sum of a neighbour of a pressed pillar, as a fraction of that of the pillar.
constexpr double kMostNeighbour = 0.5;
/// Largest sum of a pillar beyond the neighbours, as a fraction, and in multiples of its noise.
constexpr double kMostBeyond = 0.05;
constexpr double kBeyondNoise = 6;
/// Least surplus of a diagonal that marks an inactive sensel, as a fraction of the sum, which gains
/// may be off by, and in multiples of the noise.
constexpr double kLeastSurplus = 0.04;
constexpr double kSurplusNoise = 6;
/// A press is left out if its residual exceeds the median by this factor.
constexpr double kOutlier = 3;
constexpr int kFitSteps = 12;
/// Factor on the standard error within which a leak counts as absent.
constexpr double kLeakInsignificant = 3;
/// Least reading by which a leak shows above a dead zone, in multiples of the noise.
constexpr double kLeastShown = 2;

bool is_significant(double leak, double error) {
  return std::abs(leak) > kLeakInsignificant * error && error > 0;
}

/// The part of a load, from rest on, that the plays add to its reading.
double part_of_plays(const SensorEffects& effects, double load_counts) {
  double sum = 0;
  for (const Play& play : effects.memory.value_or(SenselMemory{}).plays) {
    sum += play.weight * std::max(0.0, load_counts - play.width_counts);
  }
  return sum / load_counts;
}

/// Standard errors with those that all presses share: the residual error of what leaks from a press
/// of this mean reading, the relative one of the press, and half of what the plays have of it,
/// since a leak may come before or after the memory.
Leaks with_shared_errors(Leaks errors, const Leaks& leaks, const SensorEffects& effects,
                         double press) {
  const ResidualError residual = effects.residual.value_or(ResidualError{});
  const double relative =
      std::hypot(std::numbers::sqrt2 * residual.relative, part_of_plays(effects, press) / 2);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(errors.at(i) > 0)) continue;  // It is not known.
    errors.at(i) = std::hypot(errors.at(i), residual.offset_counts / press, relative * leaks.at(i));
  }
  return errors;
}

double mean_dead_zone(const SkinCalibration& calibration) {
  const std::vector<float>& zones = calibration.planes.dead_zone;
  const double sum = std::accumulate(zones.begin(), zones.end(), 0.0);
  return zones.empty() ? 0 : sum / static_cast<double>(zones.size());
}

}  // namespace

LeakFinder::LeakFinder(const Skin& skin, const SkinCalibration& calibration)
    : skin_(skin),
      calibration_(calibration),
      noise_(mean_noise(calibration)),
      sums_(skin.pillars()) {
  require_fitting(calibration, skin, "calibration");
  if (calibration.planes.tare.empty()) {
    throw Error("calibration", "has no tare", "take the tare of the unloaded skin first");
  }
}

bool LeakFinder::is_isolated(std::int64_t row, std::int64_t col) const {
  const auto rows = static_cast<std::int64_t>(skin_.pillar_rows());
  const auto cols = static_cast<std::int64_t>(skin_.pillar_cols());
  const auto sum_at = [&](std::int64_t r, std::int64_t c) {
    return r < 0 || c < 0 || r >= rows || c >= cols ? 0
                                                    : sums_[static_cast<std::size_t>(r * cols + c)];
  };
  if (row < 1 || col < 1 || row + 1 >= rows || col + 1 >= cols) return false;
  const double sum = sum_at(row, col);
  if (!(sum > kLeastPress * 2 * noise_)) return false;
  const double most_beyond = std::max(kMostBeyond * sum, kBeyondNoise * 2 * noise_);
  for (std::int64_t r = row - 2; r <= row + 2; ++r) {
    for (std::int64_t c = col - 2; c <= col + 2; ++c) {
      if (r == row && c == col) continue;
      const bool near = std::abs(r - row) < 2 && std::abs(c - col) < 2;
      if (sum_at(r, c) > (near ? kMostNeighbour * sum : most_beyond)) return false;
    }
  }
  return true;
}

void LeakFinder::add(const FrameView& frame) {
  const std::vector<float> readings = linear_readings(calibration_, skin_, frame);
  for_each_pillar(skin_, [&](std::size_t row, std::size_t col, const auto& sensels) {
    double sum = 0;
    for (const std::size_t i : sensels) sum += readings[i];
    sums_[row * skin_.pillar_cols() + col] = sum;
  });
  for_each_pillar(skin_, [&](std::size_t row, std::size_t col, const auto&) {
    if (presses_.size() == kMostLeakPresses ||
        !is_isolated(static_cast<std::int64_t>(row), static_cast<std::int64_t>(col))) {
      return;
    }
    Press press{static_cast<std::uint32_t>(row * skin_.pillar_cols() + col), {}};
    for (std::size_t i = 0; i < press.readings.size(); ++i) {
      const std::size_t at_row = 2 * (row - 1) + i / kPatchSide;
      const std::size_t at_col = 2 * (col - 1) + i % kPatchSide;
      press.readings.at(i) = readings[at_row * skin_.cols + at_col];
    }
    presses_.push_back(press);
  });
}

/// Gauss–Newton steps on the readings of the sensels that carry no load.
class LeakFinder::Fit {
 public:
  Fit(const std::vector<Press>& presses, double noise) : noise_(noise) {
    for (const Press& press : presses) presses_.push_back(&press);
  }

  /// Estimates the leaks; inside stays zero unless a pressed pillar has an inactive sensel.
  void estimate() {
    for (int step = 0; step < kFitSteps; ++step) {
      NormalEquations equations(4);
      inactive_ = 0;
      for (const Press* press : presses_) {
        visit(*press, [&](const auto& row, double residual) { equations.add(row, residual); });
      }
      active_ = {inactive_ > 0, true, pillars_seen_[0], pillars_seen_[1]};
      const auto change = equations.solve(active_);
      if (!change) return;
      for (std::size_t i = 0; i < leaks_.size(); ++i) {
        leaks_.at(i) =
            std::clamp(leaks_.at(i) + (*change)[i], -2 * kMostSenselLeak, 2 * kMostSenselLeak);
      }
    }
  }

  /// Estimates the leaks again, now below a dead zone. It hides a part of each leak between
  /// pillars; one that does not show above the noise counts as absent. The start lies above the
  /// hidden part.
  void estimate_below(double zone) {
    const double largest = largest_reading();
    zone_ = zone;
    for (std::size_t i = 0; i < pillars_seen_.size(); ++i) {
      double& leak = leaks_.at(2 + i);
      pillars_seen_.at(i) = leak * largest > kLeastShown * noise_;
      leak = pillars_seen_.at(i) ? leak + zone / largest : 0;
    }
    estimate();
  }

  /// Leaves out the presses whose residual is far above the median; returns their number.
  std::size_t leave_out() {
    std::vector<double> residuals;
    for (const Press* press : presses_) residuals.push_back(residual_of(*press));
    std::vector<double> sorted = residuals;
    const double most = kOutlier * median(sorted);
    std::vector<const Press*> kept;
    for (std::size_t i = 0; i < presses_.size(); ++i) {
      if (residuals[i] <= most) kept.push_back(presses_[i]);
    }
    const std::size_t left_out = presses_.size() - kept.size();
    presses_ = kept;
    return left_out;
  }

  /// Standard errors: the larger one of that from all residuals and that from the scatter between
  /// places, whose tares and gains are off together.
  [[nodiscard]] Leaks standard_errors() {
    NormalEquations equations(4);
    std::map<std::uint32_t, Leaks> gradients;
    for (const Press* press : presses_) {
      Leaks& gradient = gradients[press->pillar];
      visit(*press, [&](const auto& row, double residual) {
        equations.add(row, residual);
        for (std::size_t i = 0; i < row.size(); ++i) gradient.at(i) += row.at(i) * residual;
      });
    }
    places_ = gradients.size();
    Leaks errors{};
    const auto inverse = equations.inverse(active_);
    if (!inverse) return errors;
    const double variance = equations.squares_at({0, 0, 0, 0}) / equations.equations();
    const auto places = static_cast<double>(places_);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      double scatter = 0;
      for (const auto& [place, gradient] : gradients) {
        double shift = 0;
        for (std::size_t j = 0; j < errors.size(); ++j) {
          shift += (*inverse)[i * 4 + j] * gradient.at(j);
        }
        scatter += shift * shift;
      }
      if (places > 1) scatter *= places / (places - 1);
      errors.at(i) = std::sqrt(std::max(variance * (*inverse)[i * 4 + i], scatter));
    }
    return errors;
  }

  /// RMS over the presses of their residuals, as fractions of the pressed sensels' mean.
  [[nodiscard]] double relative_residual() {
    double squares = 0;
    for (const Press* press : presses_) {
      const double relative = residual_of(*press);
      squares += relative * relative;
    }
    return std::sqrt(squares / static_cast<double>(presses_.size()));
  }

  /// Mean reading of the pressed sensels, counts.
  [[nodiscard]] double mean_press() const {
    double sum = 0;
    for (const Press* press : presses_) {
      for (const std::size_t i : kPressedSensels) sum += press->readings.at(i) / 4;
    }
    return sum / static_cast<double>(presses_.size());
  }

  [[nodiscard]] const Leaks& leaks() const { return leaks_; }
  void set_leaks(const Leaks& leaks) { leaks_ = leaks; }
  [[nodiscard]] bool inside_known() const { return active_[0]; }
  [[nodiscard]] std::size_t places() const { return places_; }
  [[nodiscard]] std::size_t presses() const { return presses_.size(); }

 private:
  /// Calls `use(derivatives by the leaks, residual)` for each sensel without a load.
  template <class Use>
  void visit(const Press& press, Use use) {
    PressedLoad pressed{};
    for (std::size_t n = 0; n < pressed.size(); ++n) {
      pressed.at(n) = press.readings.at(kPressedSensels.at(n));
    }
    const double sum = pressed[0] + pressed[1] + pressed[2] + pressed[3];
    const auto inactive =
        inactive_sensel(pressed, std::max(kLeastSurplus * sum, kSurplusNoise * 2 * noise_));
    if (inactive) ++inactive_;
    const LeakedPatch read = leak_patch(unleak(pressed, leaks_, zone_, inactive), leaks_, zone_);
    for (std::size_t i = 0; i < read.readings.size(); ++i) {
      const auto* const own = std::ranges::find(kPressedSensels, i);
      const bool loaded =
          own != kPressedSensels.end() &&
          own - kPressedSensels.begin() != static_cast<std::ptrdiff_t>(inactive.value_or(4));
      if (loaded || std::isnan(press.readings.at(i))) continue;
      Leaks row{};
      for (std::size_t p = 0; p < row.size(); ++p) row.at(p) = read.derivatives.at(p).at(i);
      use(row, press.readings.at(i) - read.readings.at(i));
    }
  }

  /// Largest reading of the pressed pillars.
  [[nodiscard]] double largest_reading() const {
    float largest = 0;
    for (const Press* press : presses_) {
      for (const float reading : press->readings) {
        if (reading > largest) largest = reading;  // Missing ones are NaN.
      }
    }
    return largest;
  }

  /// RMS residual of a press over the mean reading of its pressed sensels.
  double residual_of(const Press& press) {
    double squares = 0;
    double count = 0;
    visit(press, [&](const auto&, double residual) {
      squares += residual * residual;
      ++count;
    });
    double sum = 0;
    for (const std::size_t i : kPressedSensels) sum += press.readings.at(i);
    return std::sqrt(squares / std::max(1.0, count)) / (sum / 4);
  }

  std::vector<const Press*> presses_;
  double noise_;
  Leaks leaks_{};
  double zone_ = 0;                                  ///< counts
  std::array<bool, 2> pillars_seen_ = {true, true};  ///< edge, corner
  std::vector<bool> active_ = {false, true, true, true};
  std::size_t inactive_ = 0;  ///< presses with an inactive sensel in the last pass
  std::size_t places_ = 0;
};

LeakResult LeakFinder::result() const {
  if (presses_.empty()) {
    throw Error(
        "leak", "no frame shows an isolated pressed pillar",
        "press single pillars, two or more from the edge of the skin, with a tip finer than "
        "a pillar, so hard that each reads 100 times its noise");
  }
  Fit fit(presses_, noise_);
  LeakResult result;
  fit.estimate();
  result.left_out = fit.leave_out();
  fit.estimate();
  if (const double zone = mean_dead_zone(calibration_); zone > 0) fit.estimate_below(zone);
  const Leaks leaks = fit.leaks();
  const Leaks errors = with_shared_errors(fit.standard_errors(), leaks, calibration_.planes.effects,
                                          fit.mean_press());
  for (const double leak : leaks) {
    if (std::abs(leak) <= kMostSenselLeak) continue;
    throw Error("leak", fmt::format("a leak of {:.2g} is more than {}", leak, kMostSenselLeak),
                "check that the tip is finer than a pillar and presses one at a time");
  }
  result.presses = fit.presses();
  result.places = fit.places();
  result.inside_known = fit.inside_known();
  result.leak = {{leaks[0], leaks[1]}, {leaks[2], leaks[3]}};
  result.standard_error = {{errors[0], errors[1]}, {errors[2], errors[3]}};
  result.residual_after = fit.relative_residual();
  fit.set_leaks({});
  result.residual_before = fit.relative_residual();
  std::optional<SenselLeak> sensel;
  std::optional<PillarLeak> pillar;
  if (is_significant(leaks[0], errors[0]) || is_significant(leaks[1], errors[1])) {
    sensel = result.leak.sensel;
  }
  if (is_significant(leaks[2], errors[2]) || is_significant(leaks[3], errors[3])) {
    pillar = result.leak.pillar;
  }
  result.calibration = calibration_;
  rescale_for_leaks(result.calibration, skin_, sensel, pillar);
  check(result.calibration.planes.effects, "leak");
  require_untouched_idle(calibration_, result.calibration, "leak");
  return result;
}

void rescale_for_leaks(SkinCalibration& calibration, const Skin& skin,
                       const std::optional<SenselLeak>& sensel,
                       const std::optional<PillarLeak>& pillar) {
  SensorEffects& effects = calibration.planes.effects;
  const SensorEffects before = effects;
  effects.sensel_leak = sensel;
  effects.pillar_leak = pillar;
  const double inner = linear_sum(effects) / linear_sum(before);
  if (calibration.counts_per_newton) *calibration.counts_per_newton /= inner;
  const double inner_zone = sensel_sum(effects) / sensel_sum(before);
  for (float& zone : calibration.planes.dead_zone) zone /= static_cast<float>(inner_zone);
  if (effects.memory) {
    for (Play& play : effects.memory->plays) play.width_counts /= inner_zone;
  }
  for (std::size_t i = 0; i < calibration.planes.gain.size(); ++i) {
    const double own = linear_sum(effects, skin, i) / linear_sum(before, skin, i);
    calibration.planes.gain[i] *= static_cast<float>(own / inner);
  }
}

namespace {

LeakResult find_leaks(const StepWork& work) {
  LeakFinder finder(work.correction(work.files.front(), WireUse::loaded).skin(), work.before);
  for (const StepFrames& file : work.files) {
    work.for_each(file, [&](const FrameView& frame, double) { finder.add(frame); });
  }
  return finder.result();
}

void report_leaks(StepReport& report, const LeakResult& result) {
  const auto& [sensel, pillar] = result.leak;
  const auto& [sensel_error, pillar_error] = result.standard_error;
  const SensorEffects& effects = result.calibration.planes.effects;
  const auto unit = [](double error) { return fmt::format("% ± {:.3f}", 100 * error); };
  if (result.inside_known) {
    report.measure("leak_inside", sensel.inside, "inside", unit(sensel_error.inside));
  } else {
    report.facts["leak_inside"] = sensel.inside;
    report.notes.emplace_back(
        "Inside: unknown, since no pressed pillar has an inactive sensel; pull the tip sideways");
  }
  report.measure("leak_across", sensel.across, "across", unit(sensel_error.across));
  report.measure("pillar_leak_edge", pillar.edge, "pillar edge", unit(pillar_error.edge));
  report.measure("pillar_leak_corner", pillar.corner, "corner", unit(pillar_error.corner));
  report.facts.update({{"leak_inside_error", sensel_error.inside},
                       {"leak_across_error", sensel_error.across},
                       {"pillar_leak_edge_error", pillar_error.edge},
                       {"pillar_leak_corner_error", pillar_error.corner},
                       {"inside_known", result.inside_known},
                       {"presses", result.presses},
                       {"left_out", result.left_out},
                       {"places", result.places}});
  report.measure("residual_before", result.residual_before, "before", "% read by unloaded sensels");
  report.measure("residual_after", result.residual_after, "after", "% left");
  report.facts["stored_between_sensels"] = effects.sensel_leak.has_value();
  report.facts["stored_between_pillars"] = effects.pillar_leak.has_value();
  if (!effects.sensel_leak)
    report.notes.emplace_back("Between sensels: none within 3 standard errors");
  if (!effects.pillar_leak)
    report.notes.emplace_back("Between pillars: none within 3 standard errors");
  if (const auto& k = result.calibration.counts_per_newton) {
    report.measure("counts_per_newton", *k, "sensitivity", "counts per newton and pillar");
  }
}

SkinCalibration run_leak(StepWork& work) {
  const LeakResult result = find_leaks(work);
  work.report.headline = fmt::format("Found leaks from presses: {}, on {}", grouped(result.presses),
                                     counted(result.places, "pillar"));
  report_leaks(work.report, result);
  work.parameters = fmt::format("presses = {}, places = {}, left_out = {}", result.presses,
                                result.places, result.left_out);
  return result.calibration;
}

}  // namespace

StepKind leak_step() {
  StepKind step = {"leak",
                   "Leaks between sensels and between pillars, from a fine tip on single pillars.",
                   "TIP", "Frames in which a fine tip presses one pillar after another", run_leak};
  step.only = SkinLayout::pillars;
  step.examples = {
      kSimulateIdle,
      kTareIdle,
      "simulate scenes/calibration/leaking_skin_pressed.toml --uncalibrated -o pressed.h5",
      "simulate scenes/calibration/leaking_skin_tip.toml --uncalibrated -o tip.h5",
      kEquilibratePressed,
      "calibrate leak tip.h5 --calibration equal.h5 -o leak.h5"};
  return step;
}

}  // namespace pillarfield
