#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "calibration/golden_section.h"
#include "calibration/steps.h"
#include "pillarfield/calibration_steps.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "pillarfield/untouched_skin.h"

namespace pillarfield {
namespace {

/// Largest fraction of touched pillars of a load that may be saturated.
constexpr double kSaturatedFraction = 0.2;
/// Least ratio of the largest to the smallest load for fitting an exponent.
constexpr double kDifferent = 1.1;
constexpr double kExponentAccuracy = 1e-5;
/// Largest root-mean-square relative error of the solved loads.
constexpr double kMostMisfit = 0.5;
/// Misfit, relative, that no stated deviation shows.
constexpr double kNegligibleMisfit = 1e-3;

/// The mean frame of a load, and its solution in counts (k = 1).
class Press {
 public:
  Press(const KnownLoad& load, const SkinCalibration& calibration)
      : load_n_(load.load_n), name_(load.frames.name()), mean_(mean_frame(load.frames)) {
    plan_.skin = load.frames.skin();
    plan_.sensel_type = SenselType::f32;
    apply(calibration, plan_.skin, plan_.calibration);
    plan_.calibration.effects.wires.reset();  // The frames are without their crosstalk.
  }

  [[nodiscard]] double load_n() const { return load_n_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Solves with a calibration whose planes equal those of the constructor's.
  [[nodiscard]] ForceField solve(const SkinCalibration& calibration,
                                 double segment_point = kSegmentPoint) const {
    SolverPlan plan = plan_;
    plan.segment_point = segment_point;
    plan.skin.threshold_counts = calibration.threshold_counts.value_or(plan.skin.threshold_counts);
    plan.skin.power_law = calibration.power_law;
    plan.skin.counts_per_newton = 1;
    return solve_on_host(plan, mean_.view());
  }

 private:
  double load_n_;
  std::string name_;
  FrameBuffer mean_;
  SolverPlan plan_;
};

/// Sum of normal force over a field, in the units of its planes.
struct NormalSum {
  double all = 0;
  double ambiguous = 0;  ///< part of pillars whose parity sum is ambiguous
  std::uint64_t touched = 0;
  std::uint64_t saturated = 0;
};

/// True if neither diagonal has two usable sensels, so that parity does not determine the sum.
bool has_ambiguous_sum(std::uint8_t bits) {
  constexpr std::uint8_t kRising = status::kSensel1 | status::kSensel3;
  constexpr std::uint8_t kFalling = status::kSensel2 | status::kSensel4;
  return (bits & status::kAmbiguous) != 0 && (bits & kRising) != kRising &&
         (bits & kFalling) != kFalling;
}

NormalSum sum_normal(const ForceField& field) {
  NormalSum sum;
  for (std::size_t i = 0; i < field.elements(); ++i) {
    const std::uint8_t bits = field.status[i];
    if (bits == 0) continue;
    ++sum.touched;
    sum.all += field.normal[i];
    if (has_ambiguous_sum(bits)) sum.ambiguous += field.normal[i];
    if ((bits & status::kSaturated) != 0) ++sum.saturated;
  }
  return sum;
}

void require_loads(std::span<const KnownLoad> loads, const SkinCalibration& before) {
  if (loads.empty()) throw Error("load", "no load is given", "give one at least");
  for (const auto& [frames, load_n] : loads) {
    require_fitting(before, frames.skin(), frames.name());
    require_frames(frames, 1);
    if (load_n > 0 && std::isfinite(load_n)) continue;
    throw Error(frames.name(), fmt::format("its load is {} N", load_n), "it must be above zero");
  }
}

void require_contact(const Press& press, const NormalSum& sum) {
  if (!(sum.all > 0)) {
    throw Error(press.name(), fmt::format("has no contact under a load of {} N", press.load_n()),
                "check the calibration's tare and threshold, or give the frames with the load on");
  }
  const double limit = kSaturatedFraction * static_cast<double>(sum.touched);
  if (static_cast<double>(sum.saturated) <= limit) return;
  throw Error(press.name(),
              fmt::format("{} of {} touched pillars are saturated", sum.saturated, sum.touched),
              "press less, or on a larger area");
}

/// Natural logarithm of the counts per newton of each load.
std::vector<double> log_ratios(const std::vector<Press>& presses,
                               const SkinCalibration& calibration) {
  std::vector<double> ratios;
  for (const Press& press : presses) {
    const NormalSum sum = sum_normal(press.solve(calibration));
    require_contact(press, sum);
    ratios.push_back(std::log(sum.all / press.load_n()));
  }
  return ratios;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(values.size());
}

/// Reference reading of the power law: geometric mean over the loads of the force-weighted mean
/// normal force of a pillar, counts.
double typical_reading(const std::vector<Press>& presses, const SkinCalibration& linear) {
  std::vector<double> logs;
  for (const Press& press : presses) {
    const ForceField field = press.solve(linear);
    require_contact(press, sum_normal(field));
    double sum = 0;
    double squares = 0;
    for (const float normal : field.normal) {
      sum += normal;
      squares += double{normal} * normal;
    }
    logs.push_back(std::log(squares / sum));
  }
  return std::exp(mean_of(logs));
}

void require_different(std::span<const KnownLoad> loads) {
  const auto [least, most] = std::ranges::minmax_element(loads, {}, &KnownLoad::load_n);
  if (most->load_n >= kDifferent * least->load_n) return;
  throw Error(
      "load",
      fmt::format("loads of {} to {} N do not determine a power law", least->load_n, most->load_n),
      "give loads that differ by a factor of several");
}

PowerLaw fit_power_law(const std::vector<Press>& presses, const SkinCalibration& linear) {
  const double reference =
      std::clamp(typical_reading(presses, linear), kMinReferenceCounts, kMaxReferenceCounts);
  const auto variance = [&](double exponent) {
    SkinCalibration candidate = linear;
    set_power_law(candidate, PowerLaw{exponent, reference});
    return variance_of(log_ratios(presses, candidate));
  };
  const double exponent = least_of(variance, kMinExponent, kMaxExponent, kExponentAccuracy);
  if (exponent > kMinExponent + 2 * kExponentAccuracy &&
      exponent < kMaxExponent - 2 * kExponentAccuracy) {
    return {exponent, reference};
  }
  throw Error("load",
              fmt::format("no exponent in [{}, {}] fits the loads", kMinExponent, kMaxExponent),
              "check which load belongs to which file");
}

LoadResult result_of(const std::vector<Press>& presses, SkinCalibration calibration) {
  LoadResult result;
  const std::vector<double> ratios = log_ratios(presses, calibration);
  const double k = std::exp(mean_of(ratios));
  calibration.counts_per_newton = k;
  double log_least = 0;
  double log_most = 0;
  double squares = 0;
  for (const Press& press : presses) {
    const NormalSum sum = sum_normal(press.solve(calibration));
    const double relative = sum.all / (k * press.load_n()) - 1;
    squares += relative * relative;
    log_least += std::log(std::max(0.0, sum.all - sum.ambiguous) / press.load_n());
    // With the segment point at 0.5, twice the ambiguous sum is its upper end.
    const NormalSum middle = sum_normal(press.solve(calibration, 0.5));
    log_most += std::log((middle.all + middle.ambiguous) / press.load_n());
    result.loads.push_back({press.load_n(), sum.all / k, sum.ambiguous / sum.all, sum.saturated});
  }
  const auto count = static_cast<double>(presses.size());
  result.misfit = std::sqrt(squares / count);
  result.least_counts_per_newton = std::exp(log_least / count);
  result.most_counts_per_newton = std::exp(log_most / count);
  result.calibration = std::move(calibration);
  return result;
}

void require_fit(const std::vector<Press>& presses, const LoadResult& result) {
  if (result.misfit <= kMostMisfit) return;
  const auto error = [](const LoadResidual& load) {
    return std::abs(std::log(load.solved_n / load.load_n));
  };
  const auto worst = std::ranges::max_element(result.loads, {}, error);
  const auto index = static_cast<std::size_t>(worst - result.loads.begin());
  throw Error(presses[index].name(),
              fmt::format("its load of {} N is solved as {:.4g} N", worst->load_n, worst->solved_n),
              "check which load belongs to which file");
}

/// Raises the residual error to what the loads leave; they also found `parameters` numbers.
void store_misfit(LoadResult& result, std::size_t parameters) {
  if (result.loads.size() <= parameters) return;
  const auto count = static_cast<double>(result.loads.size());
  const double relative =
      result.misfit * std::sqrt(count / (count - static_cast<double>(parameters)));
  if (relative < kNegligibleMisfit) return;
  std::optional<ResidualError>& residual = result.calibration.planes.effects.residual;
  if (!residual) residual.emplace();
  residual->relative = std::min(1.0, std::max(residual->relative, relative));
}

}  // namespace

LoadResult calibrate_load(const SkinCalibration& before, std::span<const KnownLoad> loads,
                          LoadModel model) {
  require_loads(loads, before);
  SkinCalibration calibration = before;
  set_power_law(calibration, std::nullopt);
  std::vector<Press> presses;
  presses.reserve(loads.size());
  for (const KnownLoad& load : loads) presses.emplace_back(load, calibration);
  if (model == LoadModel::power) {
    require_different(loads);
    set_power_law(calibration, fit_power_law(presses, calibration));
  }
  LoadResult result = result_of(presses, std::move(calibration));
  require_fit(presses, result);
  store_misfit(result, model == LoadModel::power ? 2 : 1);
  require_untouched_idle(before, result.calibration, "load");
  return result;
}

namespace {

/// Largest fraction of a load on ambiguous pillars without a warning.
constexpr double kMuchAmbiguous = 0.05;

void warn_of_loads(StepWork& work, const std::vector<LoadResidual>& loads) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string file = work.files[i].name();
    if (loads[i].ambiguous_share > kMuchAmbiguous) {
      work.report.warnings.push_back(fmt::format(
          "{}: ambiguous pillars bear {:.0f} % of the load; press flat and without shear", file,
          100 * loads[i].ambiguous_share));
    }
    if (loads[i].saturated > 0) {
      work.report.warnings.push_back(
          fmt::format("{}: {} pillars have a saturated sensel, which hides force; press less", file,
                      loads[i].saturated));
    }
  }
}

void report_load(StepReport& report, const LoadResult& result) {
  report.measure(
      "counts_per_newton", *result.calibration.counts_per_newton, "sensitivity",
      fmt::format("counts per newton and pillar, {:.2f} to {:.2f} with ambiguous pillars",
                  result.least_counts_per_newton, result.most_counts_per_newton));
  report.facts["least_counts_per_newton"] = result.least_counts_per_newton;
  report.facts["most_counts_per_newton"] = result.most_counts_per_newton;
  report.facts["misfit"] = result.misfit;
  if (const auto& law = result.calibration.power_law) {
    report.measure("power_law_exponent", law->exponent, "exponent", "of the power law");
    report.measure("power_law_reference_counts", law->reference_counts, "reference",
                   "counts, of the power law");
  }
  auto& loads = report.facts["loads"] = nlohmann::ordered_json::array();
  for (const LoadResidual& load : result.loads) {
    loads.push_back({{"load_n", load.load_n},
                     {"solved_n", load.solved_n},
                     {"ambiguous_share", load.ambiguous_share},
                     {"saturated", load.saturated}});
    report.notes.push_back(fmt::format(
        "  {:8.3f} N is solved as {:8.3f} N ({:+.2f} %), {:.1f} % of it on ambiguous pillars",
        load.load_n, load.solved_n, 100 * (load.solved_n / load.load_n - 1),
        100 * load.ambiguous_share));
  }
  report.add_residual(result.calibration.planes.effects);
}

SkinCalibration run_load(StepWork& work) {
  const std::vector<double> loads_n = work.numbers("load-n");
  const std::vector<FrameStatistics> statistics = work.statistics();
  std::vector<KnownLoad> known;
  for (std::size_t i = 0; i < statistics.size(); ++i) known.push_back({statistics[i], loads_n[i]});
  const std::string model = work.word("model").value_or("linear");
  const LoadResult result =
      calibrate_load(work.before, known, model == "power" ? LoadModel::power : LoadModel::linear);
  work.report.headline = fmt::format("Calibrated with {}, {}", counted(known.size(), "load"),
                                     counted(work.frames(), "frame"));
  work.report.facts["model"] = model;
  report_load(work.report, result);
  warn_of_loads(work, result.loads);
  work.parameters = fmt::format("loads_n = {}, model = {}", fmt::join(loads_n, " "), model);
  return result.calibration;
}

}  // namespace

StepKind load_step() {
  StepKind step = {"load", "Counts per newton, and a power law, from known loads.", "FRAMES",
                   "Frames under a constant load, one file per load", run_load};
  step.arguments = {
      StepArgument::per_file("load-n", "L1,L2,...", "Normal load of each file, in order",
                             {1e-6, 1e6}),
      StepArgument::word("model", {"linear", "power"},
                         "linear: proportional; power: power law, from at least two loads "
                         "[linear]")};
  step.examples = {kSimulateIdle, kSimulatePressed, kTareIdle,
                   "calibrate load pressed.h5 --load-n 200 --calibration tared.h5 -o loaded.h5"};
  return step;
}

}  // namespace pillarfield
