#include "calibration/linear_readings.h"

#include <cmath>
#include <limits>

#include "pillarfield/error.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

double linearise(const SkinCalibration& calibration, double reading) {
  if (calibration.power_law && reading > 0) return straightened(*calibration.power_law, reading);
  return load_at(calibration.planes.effects.curve, reading);
}

}  // namespace

std::vector<float> linear_readings(const SkinCalibration& calibration, const Skin& skin,
                                   const FrameView& frame) {
  const Calibration& planes = calibration.planes;
  const double full_scale =
      skin.full_scale_counts.value_or(std::numeric_limits<double>::infinity());
  std::vector<float> linear(skin.sensels());
  for_each_row(frame, [&](std::size_t row, const auto* readings) {
    for (std::size_t col = 0; col < skin.cols; ++col) {
      const std::size_t i = row * skin.cols + col;
      const auto raw = static_cast<double>(readings[col]);
      const bool masked = !planes.mask.empty() && planes.mask[i] == 0;
      const double tare = planes.tare.empty() ? 0 : planes.tare[i];
      const double gain = planes.gain.empty() ? 1 : planes.gain[i];
      linear[i] = masked || !(raw < full_scale)
                      ? std::nanf("")
                      : static_cast<float>(linearise(calibration, (raw - tare) * gain));
    }
  });
  return linear;
}

double mean_noise(const SkinCalibration& calibration) {
  const Calibration& planes = calibration.planes;
  if (planes.noise.empty()) {
    throw Error("calibration", "has no noise", "take the tare of the unloaded skin first");
  }
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < planes.noise.size(); ++i) {
    if (!planes.mask.empty() && planes.mask[i] == 0) continue;
    const double noise = planes.noise[i] * (planes.gain.empty() ? 1.0 : planes.gain[i]);
    squares += noise * noise;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

}  // namespace pillarfield
