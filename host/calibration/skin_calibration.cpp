#include "pillarfield/skin_calibration.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/quantile.h"
#include "pillarfield/error.h"
#include "pillarfield/version.h"
#include "skin/skin_fields.h"
#include "solve/sensor_corrections.h"

namespace pillarfield {
namespace {

/// Fraction of good sensels whose noise the threshold covers.
constexpr double kQuietShare = 0.99;

/// A skin of the calibration's size and constants, with defaults for missing ones.
Skin skin_of(const SkinCalibration& calibration) {
  Skin skin;
  skin.rows = calibration.rows;
  skin.cols = calibration.cols;
  skin.threshold_counts = calibration.threshold_counts.value_or(skin.threshold_counts);
  skin.counts_per_newton = calibration.counts_per_newton.value_or(skin.counts_per_newton);
  skin.power_law = calibration.power_law;
  skin.layout = calibration.layout.value_or(skin.layout);
  skin.sensel_pitch_mm = calibration.sensel_pitch_mm.value_or(skin.sensel_pitch_mm);
  skin.falling = calibration.falling;
  return skin;
}

/// Combines two masks, either of which may be empty (all good). Absent in one: absent.
std::vector<std::uint8_t> both_good(const std::vector<std::uint8_t>& a,
                                    std::vector<std::uint8_t> b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = a[i] == kGood || b[i] == kAbsent ? b[i] : a[i];
  return b;
}

/// Noise of each good sensel's corrected reading, counts.
std::vector<double> corrected_noise(const Calibration& planes) {
  std::vector<double> noise;
  noise.reserve(planes.noise.size());
  for (std::size_t i = 0; i < planes.noise.size(); ++i) {
    if (!is_good(planes, i)) continue;
    const double gain = planes.gain.empty() ? 1 : planes.gain[i];
    noise.push_back(gain * planes.noise[i]);
  }
  return noise;
}

/// The load of a reading that is a multiple of its noise, by the polynomial that the solver
/// evaluates, and at least the noise of the load there times that multiple.
double load_of_noise(const ResponseCurve& curve, double reading) {
  if (curve.empty()) return reading;
  const auto polynomial = curve_polynomial(curve).polynomial;
  const auto at = static_cast<float>(reading);
  const float slope = single_precision::curve_slope(at, polynomial);
  return std::max(single_precision::curve_load(at, polynomial), at * slope);
}

}  // namespace

CalibrationStep step_done(std::string step, std::vector<std::string> sources, std::uint64_t frames,
                          std::string parameters) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return {std::move(step),
          std::move(sources),
          frames,
          std::move(parameters),
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc),
          kVersion};
}

SkinCalibration blank_calibration(const Skin& skin) {
  SkinCalibration calibration;
  calibration.rows = skin.rows;
  calibration.cols = skin.cols;
  calibration.layout = skin.layout;
  if (skin.states_pitch()) calibration.sensel_pitch_mm = skin.sensel_pitch_mm;
  calibration.falling = skin.falling;
  return calibration;
}

void mask_missing(SkinCalibration& calibration, const std::vector<std::uint8_t>& mask) {
  calibration.planes.mask = both_good(mask, std::move(calibration.planes.mask));
}

void check(const SkinCalibration& calibration, std::string_view where) {
  const Skin skin = skin_of(calibration);
  check(skin, where);
  check(calibration.planes, skin, where);
  if (calibration.power_law && !calibration.planes.effects.curve.empty()) {
    throw Error(where, "has a power law and a response curve", "remove one of them");
  }
  if (calibration.threshold_factor) {
    check_range(where, kThresholdFactor, *calibration.threshold_factor);
  }
}

void require_fitting(const SkinCalibration& calibration, const Skin& skin, std::string_view where) {
  if (calibration.falling != skin.falling) {
    throw Error(where,
                calibration.falling ? "the calibration is of readings that fall under load"
                                    : "the calibration is of readings that rise under load",
                calibration.falling ? "give --falling" : "leave out --falling");
  }
  if (calibration.rows == skin.rows && calibration.cols == skin.cols) return;
  throw Error(where,
              fmt::format("has {} x {} sensels, the calibration {} x {}", skin.rows, skin.cols,
                          calibration.rows, calibration.cols),
              "give the calibration of this skin");
}

void apply(const SkinCalibration& calibration, Skin& skin, Calibration& planes) {
  require_fitting(calibration, skin, "calibration");
  std::vector<std::uint8_t> mask = both_good(planes.mask, calibration.planes.mask);
  planes = calibration.planes;
  planes.mask = std::move(mask);
  skin.threshold_counts = calibration.threshold_counts.value_or(skin.threshold_counts);
  skin.layout = calibration.layout.value_or(skin.layout);
  skin.sensel_pitch_mm = calibration.sensel_pitch_mm.value_or(skin.sensel_pitch_mm);
  skin.stated.layout |= calibration.layout.has_value();
  skin.stated.sensel_pitch |= calibration.sensel_pitch_mm.has_value();
  if (!planes.effects.curve.empty()) skin.power_law.reset();
  // A power law applies only with the counts per newton fitted with it.
  if (!calibration.counts_per_newton) return;
  skin.counts_per_newton = *calibration.counts_per_newton;
  skin.stated.counts_per_newton = true;
  skin.power_law = calibration.power_law;
}

void set_threshold(SkinCalibration& calibration, double factor) {
  std::vector<double> noise = corrected_noise(calibration.planes);
  if (noise.empty()) {
    throw Error("calibration", "no good sensel has a known noise", "take the tare first");
  }
  const double threshold = factor * quantile(noise, kQuietShare);
  const auto& law = calibration.power_law;
  calibration.threshold_factor = factor;
  calibration.threshold_counts = law ? straightened(*law, threshold)
                                     : load_of_noise(calibration.planes.effects.curve, threshold);
}

void set_power_law(SkinCalibration& calibration, const std::optional<PowerLaw>& law) {
  const std::optional<PowerLaw> old = std::exchange(calibration.power_law, law);
  std::optional<double>& threshold = calibration.threshold_counts;
  if (threshold && old) {
    threshold = straightened({1 / old->exponent, old->reference_counts}, *threshold);
  }
  if (threshold && law) threshold = straightened(*law, *threshold);
}

}  // namespace pillarfield
