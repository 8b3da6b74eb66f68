#include "pillarfield/arm_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/number_text.h"
#include "calibration/steps.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "pillarfield/untouched_skin.h"
#include "solve/pillar_lean.h"

namespace pillarfield {
namespace {

/// Factor on the standard error within which the inverse arm counts as zero.
constexpr double kArmInsignificant = 3;
/// Largest standard deviation of a lean that is used, as a fraction of the normal force: that of
/// steeper pressures is off in one direction.
constexpr double kMostLeanDeviation = 0.04;
constexpr std::uint64_t kFewestArmPillars = 12;
constexpr int kArmRounds = 4;

/// The lean under a ball: the odd cubic of least squares over smooth bodies, and what it leaves.
/// With the polynomial of the solve, which knows narrow bodies too, arms are found up to a fifth
/// too short (docs/decisions/off_centre_pressure.md).
single_precision::Lean lean_under_ball(float far_before, float before, float own, float after,
                                       float far_after) {
  const auto [d, e, s, t] =
      single_precision::line_ratios(far_before, before, own, after, far_after);
  const float by_d = 1 / 6.0F + s * (-0.152F + 0.390F * s) +
                     t * (-0.486F + 1.187F * s - 1.173F * t) + d * (0.789F * d - 1.210F * e) +
                     0.264F * (e * e);
  const float by_e =
      s * (0.798F - 1.144F * s + 1.029F * t) + t * (0.032F + 0.090F * t) + 0.015F * (e * e);
  const float steep = std::abs(d);
  const float deviation = 0.004F + 0.093F * steep * steep * steep + 0.009F * std::abs(s) +
                          0.076F * s * s + 0.011F * std::abs(e - d);
  return single_precision::lean_of(own, d * by_d + e * by_e, deviation);
}

/// One shear component of a pillar and the lean that explains it, N.
struct LeaningShear {
  double shear;
  double lean;            ///< moment over the pitch
  double shear_variance;  ///< of noise and residual error
  double lean_variance;
  std::size_t place;
};

ForceField solve_without_arm(const SkinCalibration& before, const FrameStatistics& press) {
  SolverPlan plan;
  plan.skin = press.skin();
  plan.sensel_type = SenselType::f32;
  plan.uncertainty = true;
  apply(before, plan.skin, plan.calibration);
  plan.calibration.effects.arm_mm.reset();
  plan.calibration.effects.wires.reset();  // The frames are without their crosstalk.
  for (float& noise : plan.calibration.noise) {
    noise /= std::sqrt(static_cast<float>(press.frames()));
  }
  return solve_on_host(plan, mean_frame(press).view());
}

bool is_fully_pressed(std::uint8_t status) {
  return (status & ~status::kAmbiguous) == status::kUsable;
}

class ArmFit {
 public:
  /// Adds the region 1 pillars of a press.
  void add(const SkinCalibration& before, const FrameStatistics& press) {
    const ForceField field = solve_without_arm(before, press);
    ContactLabels labels;
    labels.find(field.status, field.rows, field.cols);
    for (const ContactRun& run : labels.runs()) {
      for (std::uint32_t col = run.first; col < run.end; ++col) {
        add_pillar(field, run.row * field.cols + col, places_ + run.contact);
      }
    }
    places_ += labels.contacts();
  }

  /// Weighted least squares of shear = inverse · lean; the weights have the error of the lean too.
  void estimate() {
    for (int round = 0; round < kArmRounds; ++round) {
      double product = 0;
      information_ = 0;
      for (const LeaningShear& each : shears_) {
        product += weight(each) * each.lean * each.shear;
        information_ += weight(each) * each.lean * each.lean;
      }
      if (information_ > 0) inverse_ = product / information_;
    }
  }

  /// The largest of the errors that the weights, the residuals and the scatter of places give.
  [[nodiscard]] double standard_error() const {
    std::vector<double> gradients(places_);
    double squares = 0;
    for (const LeaningShear& each : shears_) {
      const double residual = each.shear - inverse_ * each.lean;
      squares += weight(each) * residual * residual;
      gradients[each.place] += weight(each) * each.lean * residual;
    }
    double scatter = 0;
    std::size_t pressed = 0;
    for (const double gradient : gradients) {
      scatter += gradient * gradient;
      if (gradient != 0) ++pressed;
    }
    const auto places = static_cast<double>(pressed);
    scatter = places > 1 ? scatter * places / (places - 1) / (information_ * information_) : 0;
    const double excess = std::max(1.0, squares / static_cast<double>(shears_.size() - 1));
    return std::sqrt(std::max(excess / information_, scatter));
  }

  /// RMS over all components of the shear without `inverse` times the lean, N.
  [[nodiscard]] double rms_without(double inverse) const {
    double squares = 0;
    for (const LeaningShear& each : shears_) {
      squares += (each.shear - inverse * each.lean) * (each.shear - inverse * each.lean);
    }
    return std::sqrt(squares / static_cast<double>(shears_.size()));
  }

  [[nodiscard]] double inverse() const { return inverse_; }  ///< pitch over arm
  [[nodiscard]] std::uint64_t pillars() const { return pillars_; }
  [[nodiscard]] std::uint64_t places() const { return places_; }

 private:
  void add_pillar(const ForceField& field, std::uint32_t index, std::size_t place) {
    if (!is_fully_pressed(field.status[index])) return;
    ++pillars_;
    const PillarLean lean = pillar_lean(field.view(), index, lean_under_ball);
    const auto add = [&](float shear, float deviation, const auto& along) {
      if (along.deviation > kMostLeanDeviation * field.normal[index]) return;
      shears_.push_back({shear, along.moment, double{deviation} * deviation,
                         double{along.deviation} * along.deviation, place});
    };
    add(field.shear_x[index], field.uncertainty[Uncertainty::shear_x][index], lean.x);
    add(field.shear_y[index], field.uncertainty[Uncertainty::shear_y][index], lean.y);
  }

  [[nodiscard]] double weight(const LeaningShear& each) const {
    return 1 / (each.shear_variance + inverse_ * inverse_ * each.lean_variance);
  }

  std::vector<LeaningShear> shears_;
  std::uint64_t pillars_ = 0;
  std::size_t places_ = 0;
  double inverse_ = 0;
  double information_ = 0;
};

void require_presses(const SkinCalibration& before, std::span<const FrameStatistics> presses) {
  if (before.planes.tare.empty() || before.planes.noise.empty()) {
    throw Error("calibration", "has no tare and noise", "take the tare of the unloaded skin first");
  }
  for (const FrameStatistics& press : presses) {
    require_fitting(before, press.skin(), press.name());
    require_frames(press, 1);
  }
}

}  // namespace

ArmResult calibrate_arm(const SkinCalibration& before, std::span<const FrameStatistics> presses) {
  require_presses(before, presses);
  ArmFit fit;
  for (const FrameStatistics& press : presses) fit.add(before, press);
  if (fit.pillars() < kFewestArmPillars) {
    throw Error("arm", fmt::format("only {} pillars have four usable sensels", fit.pillars()),
                "press harder, or with a larger body");
  }
  fit.estimate();
  ArmResult result;
  const double error = fit.standard_error();
  const double pitch_mm = presses.front().skin().pillar_pitch_mm();
  result.found = fit.inverse() > kArmInsignificant * error;
  result.arm_mm = pitch_mm / fit.inverse();
  result.standard_error = error / std::abs(fit.inverse());
  result.longest_mm = pitch_mm / (kArmInsignificant * error);
  if (fit.inverse() < -kArmInsignificant * error) {
    throw Error("arm", "the pillars lean away from the pressure",
                "check that the bodies press straight down and that rows and columns are in order");
  }
  if (result.found && result.standard_error > kMostArmError) {
    throw Error(
        "arm",
        fmt::format("the standard error of the arm is {:.0f} %", 100 * result.standard_error),
        "press more places, harder");
  }
  result.pillars = fit.pillars();
  result.places = fit.places();
  result.shear_before_n = fit.rms_without(0);
  result.shear_after_n = fit.rms_without(result.found ? fit.inverse() : 0);
  result.calibration = before;
  auto& arm = result.calibration.planes.effects.arm_mm;
  arm.reset();
  if (result.found) arm = result.arm_mm;
  require_untouched_idle(before, result.calibration, "arm");
  return result;
}

namespace {

SkinCalibration run_arm(StepWork& work) {
  const ArmResult result = calibrate_arm(work.before, work.statistics());
  StepReport& report = work.report;
  report.headline = fmt::format("Calibrated with {} at {}, {}", counted(result.pillars, "pillar"),
                                counted(result.places, "place"), counted(work.frames(), "frame"));
  report.facts = {{"pillars", result.pillars},
                  {"places", result.places},
                  {"shear_before_n", result.shear_before_n},
                  {"shear_after_n", result.shear_after_n}};
  report.measure("left", result.shear_after_n / result.shear_before_n, "left",
                 "% of the shear that the pillars read");
  report.facts["stored"] = result.found;
  if (result.found) {
    report.measure("arm_mm", result.arm_mm, "arm",
                   fmt::format("mm ± {:.1f} %", 100 * result.standard_error));
    report.facts["standard_error"] = result.standard_error;
  } else {
    report.notes.push_back(
        fmt::format("No off-centre pressure within three standard errors: an arm is longer than "
                    "{:.3g} mm; none is stored",
                    result.longest_mm));
  }
  work.parameters =
      fmt::format("places = {}, standard_error = {:.3g}", result.places, result.standard_error);
  return result.calibration;
}

}  // namespace

StepKind arm_step() {
  StepKind step = {
      "arm", "Arm of off-centre pressure, from bodies pressed straight down.", "PRESSED",
      "Frames of bodies at rest that press straight down, one file per placement", run_arm};
  step.only = SkinLayout::pillars;
  step.examples = {
      kSimulateIdle,
      kSimulatePressed,
      kTareIdle,
      "simulate scenes/calibration/leaning_skin_pressed.toml --uncalibrated -o balls.h5",
      kEquilibratePressed,
      "calibrate arm balls.h5 --calibration equal.h5 -o arm.h5"};
  return step;
}

}  // namespace pillarfield
