#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "calibration/linear_readings.h"
#include "calibration/normal_equations.h"
#include "calibration/steps.h"
#include "pillarfield/calibration_steps.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kLeastBentFrames = 5;
constexpr std::size_t kLeastShapes = 2;
/// Least ratio of the patterns' mean square to that of their errors.
constexpr double kLeastSignal = 1.2;
constexpr double kMostSaturated = 0.2;

using Triple = std::array<double, 3>;

Triple triple_of(const Curvature& curvature) { return {curvature.x, curvature.y, curvature.xy}; }

void require_shapes(const SkinCalibration& before, std::span<const BentSkin> shapes) {
  if (before.planes.tare.empty() || before.planes.noise.empty()) {
    throw Error("calibration", "has no tare or no noise", "take the tare of the flat skin first");
  }
  if (shapes.size() < kLeastShapes) {
    throw Error("bending", "one shape does not determine the patterns",
                "give cylinders along x, along y and in between");
  }
  for (const auto& [frames, curvature] : shapes) {
    require_fitting(before, frames.skin(), frames.name());
    require_frames(frames, kLeastBentFrames);
    double saturated = 0;
    for (const SenselStatistics& sensel : frames.sensels()) saturated += sensel.saturated > 0;
    if (saturated > kMostSaturated * static_cast<double>(frames.sensels().size())) {
      throw Error(frames.name(), fmt::format("{} sensels are at full scale", saturated),
                  "take the load off, or bend less");
    }
  }
}

/// Frames of the last tare; `otherwise` if the history does not say.
double frames_of_tare(const SkinCalibration& calibration, double otherwise) {
  double frames = otherwise;
  for (const CalibrationStep& step : calibration.history) {
    if (step.step == "tare" && step.frames > 0) frames = static_cast<double>(step.frames);
  }
  return frames;
}

/// The patterns as linear functions of the changes of the tare: pattern[p] = Σ weight[p][shape] ·
/// change[shape].
std::array<std::vector<double>, 3> weights_of(std::span<const BentSkin> shapes) {
  NormalEquations equations(3);
  std::vector<bool> active(3);
  for (const BentSkin& shape : shapes) {
    const Triple row = triple_of(shape.curvature);
    equations.add(row, 0);
    // cos 90° is not quite zero in floating point.
    for (std::size_t p = 0; p < 3; ++p) active[p] = active[p] || std::abs(row.at(p)) > 1e-9;
  }
  const auto inverse = equations.inverse(active);
  if (!active[0] || !active[1] || !inverse) {
    throw Error("bending", "the shapes do not determine the patterns",
                "give cylinders along x, along y and in between");
  }
  std::array<std::vector<double>, 3> weights;
  for (std::size_t p = 0; p < 3; ++p) {
    for (const BentSkin& shape : shapes) {
      const Triple row = triple_of(shape.curvature);
      double weight = 0;
      for (std::size_t q = 0; q < 3; ++q) weight += (*inverse)[p * 3 + q] * row.at(q);
      weights.at(p).push_back(weight);
    }
  }
  return weights;
}

/// Sums over the sensels that can be read on all shapes, and the patterns fitted to each.
struct PatternSums {
  double sensels = 0;
  double noise_squares = 0;
  Triple squares{};
  double residual_before = 0;
  double residual_after = 0;
  std::array<std::vector<float>, 3> patterns;
};

/// Changes of a sensel's tare by shape; false if a shape does not show it.
bool tare_changes(const Calibration& planes, std::span<const BentSkin> shapes, std::size_t sensel,
                  std::vector<double>& changes) {
  bool good = planes.mask.empty() || planes.mask[sensel] != 0;
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const SenselStatistics& seen = shapes[s].frames.sensels()[sensel];
    good = good && seen.saturated == 0 && seen.readings > 0;
    changes[s] = seen.mean - planes.tare[sensel];
  }
  return good;
}

PatternSums fit_patterns(const Calibration& planes, std::span<const BentSkin> shapes,
                         const std::array<std::vector<double>, 3>& weights) {
  PatternSums sums;
  for (auto& pattern : sums.patterns) pattern.assign(planes.tare.size(), 0);
  std::vector<double> changes(shapes.size());
  for (std::size_t i = 0; i < planes.tare.size(); ++i) {
    if (!tare_changes(planes, shapes, i, changes)) continue;
    ++sums.sensels;
    sums.noise_squares += double{planes.noise[i]} * planes.noise[i];
    Triple fitted{};
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t s = 0; s < shapes.size(); ++s) fitted.at(p) += weights.at(p)[s] * changes[s];
      sums.patterns.at(p)[i] = static_cast<float>(fitted.at(p));
      sums.squares.at(p) += fitted.at(p) * fitted.at(p);
    }
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      const Triple row = triple_of(shapes[s].curvature);
      const double rest = changes[s] - fitted[0] * row[0] - fitted[1] * row[1] - fitted[2] * row[2];
      sums.residual_before += changes[s] * changes[s];
      sums.residual_after += rest * rest;
    }
  }
  return sums;
}

/// Variance of a pattern by a sensel's noise of variance 1. The tare's error is common to all
/// shapes.
double variance_of(const std::vector<double>& weights, std::span<const BentSkin> shapes,
                   double tare_frames) {
  double variance = 0;
  double sum = 0;
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    variance += weights[s] * weights[s] / shapes[s].frames.frames();
    sum += weights[s];
  }
  return variance + sum * sum / tare_frames;
}

}  // namespace

Curvature curvature_of_cylinder(double radius_mm, double axis_deg) {
  const double angle = axis_deg * std::numbers::pi / 180;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  return {sine * sine / radius_mm, cosine * cosine / radius_mm, -2 * sine * cosine / radius_mm};
}

BendingResult calibrate_bending(const SkinCalibration& before, std::span<const BentSkin> shapes) {
  require_shapes(before, shapes);
  const std::array<std::vector<double>, 3> weights = weights_of(shapes);
  PatternSums sums = fit_patterns(before.planes, shapes, weights);
  const double count = sums.sensels;
  if (count == 0) throw Error("bending", "no sensel can be read on all shapes", "check the frames");
  BendingResult result;
  const auto shapes_of_sensels = count * static_cast<double>(shapes.size());
  result.residual_before = std::sqrt(sums.residual_before / shapes_of_sensels);
  result.residual_after = std::sqrt(sums.residual_after / shapes_of_sensels);
  const double tare_frames = frames_of_tare(before, shapes[0].frames.frames());
  double signal = 0;
  for (std::size_t p = 0; p < 3; ++p) {
    const double variance =
        sums.noise_squares / count * variance_of(weights.at(p), shapes, tare_frames);
    result.standard_error[p] = std::sqrt(variance);
    result.rms[p] = std::sqrt(sums.squares.at(p) / count);
    if (variance > 0) signal = std::max(signal, result.rms[p] * result.rms[p] / variance);
  }
  result.found = signal > kLeastSignal;
  result.calibration = before;
  Calibration& after = result.calibration.planes;
  after.bend_x = after.bend_y = after.bend_xy = {};
  if (!result.found) return result;
  after.bend_x = std::move(sums.patterns[0]);
  after.bend_y = std::move(sums.patterns[1]);
  after.bend_xy = std::move(sums.patterns[2]);
  return result;
}

namespace {

void report_bending(StepReport& report, const BendingResult& result) {
  constexpr const char* kPatterns[] = {"bend_x", "bend_y", "bend_xy"};
  for (std::size_t i = 0; i < std::size(kPatterns); ++i) {
    report.measure(
        fmt::format("{}_rms", kPatterns[i]).c_str(), result.rms[i], kPatterns[i],
        fmt::format("counts·mm, RMS of the sensels, each ± {:.2f}", result.standard_error[i]));
  }
  report.facts["standard_errors"] = result.standard_error;
  report.measure("residual_before", result.residual_before, "before",
                 "counts, RMS change of tares");
  report.measure("residual_after", result.residual_after, "after", "counts, RMS left");
  report.facts["stored"] = result.found;
  if (!result.found) report.notes.emplace_back("Within the noise: none is stored");
}

SkinCalibration run_bending(StepWork& work) {
  const std::vector<double> radii_mm = work.numbers("radius-mm");
  const std::vector<double> axes_deg = work.numbers("axis-deg");
  const std::vector<TareFrames> statistics = work.unloaded_frames();
  for (const TareFrames& each : statistics) {
    refuse_moving_touch(each, work.before.planes.mask, nullptr);
  }
  std::vector<BentSkin> shapes;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    shapes.push_back({statistics[i], curvature_of_cylinder(radii_mm[i], axes_deg[i])});
  }
  const BendingResult result = calibrate_bending(work.before, shapes);
  work.report.headline = fmt::format("Bent around {}, {}", counted(shapes.size(), "cylinder"),
                                     counted(work.frames(), "frame"));
  report_bending(work.report, result);
  work.parameters = fmt::format("radii_mm = {}, axes_deg = {}", fmt::join(radii_mm, " "),
                                fmt::join(axes_deg, " "));
  return result.calibration;
}

}  // namespace

StepKind bending_step() {
  StepKind step = {"bending",
                   "Change of the tares with curvature, from the unloaded skin on known cylinders.",
                   "BENT", "Frames of the unloaded skin, one file per cylinder", run_bending};
  step.arguments = {StepArgument::per_file(
                        "radius-mm", "R1,R2,...",
                        "Radius of each cylinder, in order; below zero inside of one", {-1e6, 1e6}),
                    StepArgument::per_file(
                        "axis-deg", "A1,A2,...",
                        "Angle of each axis from +x, counter-clockwise, in order", {-360, 360})};
  step.arguments.front().is_nonzero = true;
  step.examples = {kSimulateIdle,
                   kTareIdle,
                   "simulate scenes/calibration/bent_skin_x.toml --uncalibrated -o x.h5",
                   "simulate scenes/calibration/bent_skin_y.toml --uncalibrated -o y.h5",
                   "simulate scenes/calibration/bent_skin_xy.toml --uncalibrated -o xy.h5",
                   ("calibrate bending x.h5 y.h5 xy.h5 --radius-mm 60,60,60 --axis-deg 90,0,45 "
                    "--calibration tared.h5 -o bending.h5")};
  return step;
}

}  // namespace pillarfield
