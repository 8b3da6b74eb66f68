#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// One step by which a calibration came about: what a calibration file keeps as its provenance.
struct CalibrationStep {
  std::string step;                  ///< "tare", "equilibrate", "load" or "faults"
  std::vector<std::string> sources;  ///< names of the files of frames
  std::uint64_t frames = 0;          ///< in all of them
  std::string parameters;            ///< "threshold_factor = 4, ..."
  std::string date_utc;              ///< "2026-01-31T12:34:56Z"
  std::string program_version;
};

/// What was found out about one skin (docs/calibration.md): its planes, and those of its constants
/// that a step has measured. The steps take one and give a better one.
struct SkinCalibration {
  std::uint32_t rows = 0;  ///< sensels
  std::uint32_t cols = 0;
  Calibration planes;
  std::optional<double> threshold_counts;
  /// The threshold as a multiple of the noise; see set_threshold.
  std::optional<double> threshold_factor;
  std::optional<double> counts_per_newton;
  std::optional<PowerLaw> power_law;     ///< comes with counts_per_newton
  std::vector<CalibrationStep> history;  ///< oldest first
};

/// Limit of SkinCalibration::threshold_factor.
inline constexpr double kMaxThresholdFactor = 1000;

/// The step just done, by this version of the program and now.
[[nodiscard]] CalibrationStep step_done(std::string step, std::vector<std::string> sources,
                                        std::uint64_t frames, std::string parameters);

/// A calibration of which nothing is known but the size of the skin.
[[nodiscard]] SkinCalibration blank_calibration(const Skin& skin);

/// Masks the sensels that `mask` (as Calibration::mask, of the calibration's size) has as missing.
void mask_missing(SkinCalibration& calibration, const std::vector<std::uint8_t>& mask);

/// Throws Error, its place being `where`, when a plane or a constant is out of its range.
void check(const SkinCalibration& calibration, std::string_view where);

/// Throws Error, its place being `where`, when the calibration is that of a skin of another size.
void require_fitting(const SkinCalibration& calibration, const Skin& skin, std::string_view where);

/// Replaces the planes, and the constants that the calibration has. A sensel that is missing in
/// `planes` stays missing. `skin` must be of the calibration's size.
void apply(const SkinCalibration& calibration, Skin& skin, Calibration& planes);

/// Makes the threshold `factor` times the noise that 99 % of the good sensels do not exceed, in
/// counts of the readings that it is compared with: noise · gain, and that by the power law where
/// there is one. Needs the noise plane.
void set_threshold(SkinCalibration& calibration, double factor);

/// Gives the calibration this power law in place of what it has, and moves the threshold, where
/// there is one, so that it stays at the same reading.
void set_power_law(SkinCalibration& calibration, const std::optional<PowerLaw>& law);

}  // namespace pillarfield
