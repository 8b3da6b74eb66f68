#include "pillarfield/shear_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "pillarfield/untouched_skin.h"

namespace pillarfield {
namespace {

/// Factor on the standard error within which a coefficient counts as 1.
constexpr double kInsignificant = 2;
constexpr double kLeastCoefficient = 0.1;
constexpr double kMostCoefficient = 10;

/// A known load along one axis and what the pillars' solved shear, with a coefficient of 1, adds up
/// to, N.
struct AxisLoad {
  double known;
  double solved;
  double variance;  ///< of `solved`, from noise and residual error
};

void require_shear_loads(std::span<const KnownShear> loads, const SkinCalibration& before) {
  if (!before.counts_per_newton) {
    throw Error("calibration", "has no counts per newton", "calibrate the load first");
  }
  for (const KnownShear& load : loads) {
    require_fitting(before, load.frames.skin(), load.frames.name());
    require_frames(load.frames, 1);
    if (std::isfinite(load.shear_x_n) && std::isfinite(load.shear_y_n) &&
        (!load.normal_n || (*load.normal_n > 0 && std::isfinite(*load.normal_n)))) {
      continue;
    }
    throw Error(load.frames.name(), "its load is not finite, or its normal force not above zero",
                "give newtons");
  }
}

ForceField solve_ideal(const KnownShear& load, const SkinCalibration& before) {
  SolverPlan plan;
  plan.skin = load.frames.skin();
  plan.sensel_type = SenselType::f32;
  apply(before, plan.skin, plan.calibration);
  plan.calibration.effects.shear_coefficient.reset();
  plan.calibration.effects.wires.reset();  // The frames are without their crosstalk.
  return solve_on_host(plan, mean_frame(load.frames).view());
}

/// Sums over the pillars of a load.
struct PillarSums {
  double shear_x = 0;
  double shear_y = 0;
  double normal = 0;
  double ambiguous = 0;
  double variance = 0;  ///< of shear_x and of shear_y, N²
};

/// A shear component has half the variance of a reading, over k²
/// (docs/derivations/direct_solve.md).
PillarSums sum_pillars(const ForceField& field, const SkinCalibration& calibration,
                       std::uint32_t frames) {
  const Calibration& planes = calibration.planes;
  const ResidualError residual = planes.effects.residual.value_or(ResidualError{});
  double noise = 0;
  for (const float deviation : planes.noise) noise += double{deviation} * deviation;
  if (!planes.noise.empty()) noise /= static_cast<double>(planes.noise.size()) * frames;
  const double k = *calibration.counts_per_newton;
  PillarSums sums;
  for (std::size_t i = 0; i < field.elements(); ++i) {
    if (field.status[i] == 0) continue;
    const double normal = field.normal[i];
    sums.shear_x += field.shear_x[i];
    sums.shear_y += field.shear_y[i];
    sums.normal += normal;
    const bool ambiguous = (field.status[i] & status::kAmbiguous) != 0;
    if (ambiguous && !is_determined(field.status[i])) sums.ambiguous += normal;
    const double spread = residual.relative * k * normal;
    sums.variance += (noise + spread * spread) / (2 * k * k);
  }
  return sums;
}

struct Estimate {
  double coefficient = 0;
  double standard_error = 0;
};

/// Least squares of solved = c · known. The scatter of several loads counts where it exceeds the
/// expected error.
std::optional<Estimate> fit_axis(const std::vector<AxisLoad>& loads) {
  double known_squared = 0;
  double product = 0;
  double variance = 0;
  double count = 0;
  for (const AxisLoad& load : loads) {
    known_squared += load.known * load.known;
    product += load.known * load.solved;
    variance += load.known * load.known * load.variance;
    if (load.known != 0) ++count;
  }
  if (count == 0) return std::nullopt;
  const double c = product / known_squared;
  double scatter = 0;
  for (const AxisLoad& load : loads) {
    if (load.known == 0) continue;
    scatter += (load.solved - c * load.known) * (load.solved - c * load.known);
  }
  scatter = count > 1 ? scatter / (count - 1) / known_squared : 0;
  variance /= known_squared * known_squared;
  return Estimate{c, std::sqrt(std::max(variance, scatter))};
}

void require_range(const char* axis, double coefficient) {
  if (coefficient >= kLeastCoefficient && coefficient <= kMostCoefficient) return;
  throw Error("shear", fmt::format("the coefficient along {} is {:.4g}", axis, coefficient),
              "check the signs of the loads (+ right, + up) and which load belongs to which file");
}

}  // namespace

ShearResult calibrate_shear(const SkinCalibration& before, std::span<const KnownShear> loads) {
  require_shear_loads(loads, before);
  ShearResult result;
  std::vector<AxisLoad> along_x;
  std::vector<AxisLoad> along_y;
  for (const KnownShear& load : loads) {
    const PillarSums sums = sum_pillars(solve_ideal(load, before), before, load.frames.frames());
    if (!(sums.normal > 0)) {
      throw Error(
          load.frames.name(), "has no contact",
          "check the calibration's tare and threshold, or give the frames with the load on");
    }
    const double scale = load.normal_n ? *load.normal_n / sums.normal : 1;
    const double variance = scale * scale * sums.variance;
    along_x.push_back({load.shear_x_n, scale * sums.shear_x, variance});
    along_y.push_back({load.shear_y_n, scale * sums.shear_y, variance});
    result.loads.push_back(
        {scale * sums.shear_x, scale * sums.shear_y, sums.ambiguous / sums.normal});
  }
  const auto x = fit_axis(along_x);
  const auto y = fit_axis(along_y);
  if (!x && !y) throw Error("shear", "all loads are zero", "give a tangential load");
  const Estimate for_x = x ? *x : *y;
  const Estimate for_y = y ? *y : *x;
  require_range("x", for_x.coefficient);
  require_range("y", for_y.coefficient);
  for (ShearSum& load : result.loads) {
    load.shear_x_n /= for_x.coefficient;
    load.shear_y_n /= for_y.coefficient;
  }
  result.coefficient = {for_x.coefficient, for_y.coefficient};
  result.standard_error = {for_x.standard_error, for_y.standard_error};
  result.calibration = before;
  const auto is_one = [](const Estimate& estimate) {
    return std::abs(estimate.coefficient - 1) <= kInsignificant * estimate.standard_error;
  };
  auto& stored = result.calibration.planes.effects.shear_coefficient;
  stored = result.coefficient;
  if (is_one(for_x) && is_one(for_y)) stored.reset();
  require_untouched_idle(before, result.calibration, "shear");
  return result;
}

namespace {

/// Largest fraction of the normal force on ambiguous pillars without a warning.
constexpr double kMuchAmbiguousShear = 0.05;

void report_shears(StepWork& work, const std::vector<KnownShear>& known,
                   const std::vector<ShearSum>& sums) {
  auto& loads = work.report.facts["loads"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < known.size(); ++i) {
    loads.push_back({{"shear_x_n", known[i].shear_x_n},
                     {"shear_y_n", known[i].shear_y_n},
                     {"solved_x_n", sums[i].shear_x_n},
                     {"solved_y_n", sums[i].shear_y_n},
                     {"ambiguous_share", sums[i].ambiguous_share}});
    work.report.notes.push_back(fmt::format("  ({:.3f}, {:.3f}) N is solved as ({:.3f}, {:.3f}) N",
                                            known[i].shear_x_n, known[i].shear_y_n,
                                            sums[i].shear_x_n, sums[i].shear_y_n));
    if (sums[i].ambiguous_share <= kMuchAmbiguousShear) continue;
    work.report.warnings.push_back(
        fmt::format("{}: ambiguous pillars bear {:.0f} % of the load; press harder or pull less",
                    work.files[i].name(), 100 * sums[i].ambiguous_share));
  }
}

SkinCalibration run_shear(StepWork& work) {
  const std::vector<double> shears_n = work.numbers("shear-n");
  const std::vector<double> loads_n = work.numbers("load-n");
  const std::vector<FrameStatistics> statistics = work.statistics();
  std::vector<KnownShear> known;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    known.push_back({statistics[i], shears_n[2 * i], shears_n[2 * i + 1]});
    if (!loads_n.empty()) known.back().normal_n = loads_n[i];
  }
  const ShearResult result = calibrate_shear(work.before, known);
  const auto& [x, y] = result.coefficient;
  const auto& [error_x, error_y] = result.standard_error;
  const bool stored = result.calibration.planes.effects.shear_coefficient.has_value();
  StepReport& report = work.report;
  report.headline = fmt::format("Calibrated with {}, {}", counted(known.size(), "tangential load"),
                                counted(work.frames(), "frame"));
  report.measure("shear_coefficient_x", x, "c_x", fmt::format("± {:.4f}", error_x));
  report.measure("shear_coefficient_y", y, "c_y", fmt::format("± {:.4f}", error_y));
  report.facts["standard_error_x"] = error_x;
  report.facts["standard_error_y"] = error_y;
  report.facts["stored"] = stored;
  if (!stored) report.notes.emplace_back("Within two standard errors of 1: none is stored");
  report_shears(work, known, result.loads);
  work.parameters =
      fmt::format("shears_n = {}, loads_n = {}, standard_error = {:.3g} {:.3g}",
                  fmt::join(shears_n, " "), fmt::join(loads_n, " "), error_x, error_y);
  return result.calibration;
}

}  // namespace

StepKind shear_step() {
  StepKind step = {"shear", "Shear coefficients from known tangential loads.", "SHEARED",
                   "Frames of bodies that do not slip under a tangential load, one file per load",
                   run_shear};
  StepArgument shears = StepArgument::per_file(
      "shear-n", "X1,Y1,X2,Y2,...",
      "Tangential force on the skin of each file, in order: + right, + up", {-1e6, 1e6});
  shears.count_per_file = 2;
  StepArgument loads = StepArgument::per_file(
      "load-n", "N1,N2,...",
      "Normal force of each file, so that errors of the sensitivity and creep cancel [unknown]",
      {1e-6, 1e6});
  loads.required = false;
  step.arguments = {shears, loads};
  step.only = SkinLayout::pillars;
  step.examples = {kSimulateIdle,
                   kSimulatePressed,
                   kTareIdle,
                   "simulate scenes/calibration/new_skin_sheared.toml --uncalibrated -o sheared.h5",
                   kEquilibratePressed,
                   ("calibrate shear sheared.h5 --shear-n 50,0 --load-n 200 --calibration equal.h5 "
                    "-o shear.h5")};
  return step;
}

}  // namespace pillarfield
