#include "pillarfield/wire_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/quantile.h"
#include "calibration/mean_frame.h"
#include "calibration/normal_equations.h"
#include "calibration/wire_correction.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Least reading under the body at rest above the median, as a fraction of the largest one.
constexpr double kLeastResting = 0.3;
constexpr std::size_t kLeastSensels = 8;
constexpr double kWireInsignificant = 3;
constexpr int kWireSteps = 10;
/// Step of the derivatives, and largest value, per count.
constexpr double kStep = 1e-7;
constexpr double kMostPerCount = 0.01;

/// Row, column, idle.
using Resistances = std::array<double, 3>;

class WireFit {
 public:
  WireFit(std::span<const FrameStatistics> presses, const WireTile& tile,
          const std::vector<std::uint8_t>& mask)
      : tile_(tile), skin_(presses.front().skin()) {
    for (const FrameStatistics& press : presses) means_.push_back(mean_frame(press));
    std::vector<float> alone;
    for (std::size_t i = 0; i < skin_.sensels(); ++i) {
      if (std::isfinite(means_[0].readings<float>()[i])) {
        alone.push_back(means_[0].readings<float>()[i]);
      }
    }
    if (alone.empty()) return;
    unloaded_ = median(alone);
    const double least = kLeastResting * (*std::ranges::max_element(alone) - unloaded_);
    for (std::size_t i = 0; i < skin_.sensels(); ++i) {
      const auto is_good = [&](const FrameStatistics& press) {
        return press.sensels()[i].readings > 0 && press.sensels()[i].saturated == 0;
      };
      if ((mask.empty() || mask[i] != 0) && std::ranges::all_of(presses, is_good) &&
          means_[0].readings<float>()[i] - unloaded_ > least) {
        resting_.push_back(i);
      }
    }
  }

  [[nodiscard]] std::size_t sensels() const { return resting_.size(); }

  /// Relative changes of the resting sensels' corrected readings against those of the body alone.
  [[nodiscard]] std::vector<double> changes(const Resistances& at) const {
    const WireCrosstalk wires = {tile_.rows, tile_.cols, at[0], at[1], at[2]};
    WireCorrection correct(skin_, SenselType::f32, wires);
    std::vector<double> alone;
    std::vector<double> changes;
    for (const FrameBuffer& mean : means_) {
      const FrameView corrected = correct(mean.view());
      const auto* readings = static_cast<const float*>(corrected.data);
      for (std::size_t s = 0; s < resting_.size(); ++s) {
        const double reading = readings[resting_[s]];
        if (&mean == &means_.front()) {
          alone.push_back(reading);
        } else {
          const double change = (reading - alone[s]) / (alone[s] - unloaded_);
          changes.push_back(std::isfinite(change) ? change : 1);
        }
      }
    }
    return changes;
  }

  /// Equations of the resistances, linear around `at`.
  [[nodiscard]] NormalEquations linear_around(const Resistances& at) const {
    const std::vector<double> here = changes(at);
    std::array<std::vector<double>, 3> slopes;
    for (std::size_t p = 0; p < 3; ++p) {
      Resistances moved = at;
      moved.at(p) += kStep;
      slopes.at(p) = changes(moved);
      for (std::size_t i = 0; i < here.size(); ++i) {
        slopes.at(p)[i] = (slopes.at(p)[i] - here[i]) / kStep;
      }
    }
    NormalEquations equations(3);
    for (std::size_t i = 0; i < here.size(); ++i) {
      const Resistances row = {slopes[0][i], slopes[1][i], slopes[2][i]};
      equations.add(row, row[0] * at[0] + row[1] * at[1] + row[2] * at[2] - here[i]);
    }
    return equations;
  }

 private:
  WireTile tile_;
  Skin skin_;
  std::vector<FrameBuffer> means_;
  double unloaded_ = 0;
  std::vector<std::size_t> resting_;
};

double rms_of(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

void require_wire_presses(const SkinCalibration& before, std::span<const FrameStatistics> presses,
                          const WireTile& tile) {
  if (presses.size() < 2) {
    throw Error("wires", "one file is too few",
                "give frames of a body alone, then with another one elsewhere");
  }
  for (const FrameStatistics& press : presses) {
    require_fitting(before, press.skin(), press.name());
    require_frames(press, 1);
  }
  SensorEffects effects;
  effects.wires = {tile.rows, tile.cols};
  check(effects, "wires");
}

}  // namespace

WireResult calibrate_wires(const SkinCalibration& before, std::span<const FrameStatistics> presses,
                           const WireTile& tile) {
  require_wire_presses(before, presses, tile);
  const WireFit fit(presses, tile, before.planes.mask);
  WireResult result;
  result.sensels = fit.sensels();
  if (result.sensels < kLeastSensels) {
    throw Error(presses[0].name(), "shows no body at rest",
                fmt::format("press {} sensels or more, less than half of the skin", kLeastSensels));
  }
  Resistances at{};
  result.residual_before = rms_of(fit.changes(at));
  for (int step = 0; step < kWireSteps; ++step) {
    const std::vector<double> next = fit.linear_around(at).solve_non_negative({true, true, true});
    for (std::size_t p = 0; p < 3; ++p) at.at(p) = std::min(next[p], kMostPerCount);
  }
  const NormalEquations equations = fit.linear_around(at);
  const std::vector<double> left = fit.changes(at);
  result.residual_after = rms_of(left);
  auto inverse = equations.inverse({true, true, true});
  // Without a resistance of the columns that of idle rows has no effect.
  if (!inverse) inverse = equations.inverse({true, true, false});
  if (!inverse) {
    throw Error("wires", "the other loads do not tell rows from columns",
                "press elsewhere in the rows of the resting body, then in its columns");
  }
  Resistances errors{};
  for (std::size_t p = 0; p < 3; ++p) {
    errors.at(p) = result.residual_after * std::sqrt((*inverse)[p * 3 + p]);
  }
  result.wires = {tile.rows, tile.cols, at[0], at[1], at[2]};
  result.standard_error = {tile.rows, tile.cols, errors[0], errors[1], errors[2]};
  result.found = at[0] > kWireInsignificant * errors[0] || at[1] > kWireInsignificant * errors[1];
  result.calibration = blank_calibration(presses[0].skin());
  result.calibration.planes.mask = before.planes.mask;
  if (result.found) result.calibration.planes.effects.wires = result.wires;
  return result;
}

}  // namespace pillarfield
