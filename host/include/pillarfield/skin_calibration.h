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

/// One step of a calibration's history.
struct CalibrationStep {
  std::string step;                  ///< name of the command, such as "tare"
  std::vector<std::string> sources;  ///< names of the files of frames
  std::uint64_t frames = 0;          ///< total of all sources
  std::string parameters;            ///< "threshold_factor = 4, ..."
  std::string date_utc;              ///< "2026-01-31T12:34:56Z"
  std::string program_version;
};

/// The calibration of one skin (docs/calibration.md): its planes and measured constants. Each step,
/// such as take_tare() or FaultFinder, takes one and returns a better one. Constants are unset
/// until a step measures them.
struct SkinCalibration {
  std::uint32_t rows = 0;  ///< sensel rows
  std::uint32_t cols = 0;  ///< sensel columns
  Calibration planes;
  std::optional<double> threshold_counts;
  /// The threshold as a multiple of the noise; see set_threshold().
  std::optional<double> threshold_factor;
  std::optional<double> counts_per_newton;
  std::optional<PowerLaw> power_law;     ///< set only with counts_per_newton
  std::optional<SkinLayout> layout;      ///< unset in files of earlier versions
  std::optional<Pitch> sensel_pitch_mm;  ///< unset where nothing stated it
  bool falling = false;                  ///< it is of mirrored readings
  std::vector<CalibrationStep> history;  ///< oldest first
};

/// A step of the history, dated now, with this version of the program.
[[nodiscard]] CalibrationStep step_done(std::string step, std::vector<std::string> sources,
                                        std::uint64_t frames, std::string parameters);

/// An empty calibration of the skin's size, for a new skin.
[[nodiscard]] SkinCalibration blank_calibration(const Skin& skin);

/// Masks the sensels where `mask` is 0, [rows, cols] of the calibration. Masked sensels stay
/// masked.
void mask_missing(SkinCalibration& calibration, const std::vector<std::uint8_t>& mask);

/// Throws Error, naming `where`, if a plane or a constant is out of range.
void check(const SkinCalibration& calibration, std::string_view where);

/// Throws Error, naming `where`, if the calibration and the skin differ in size or in
/// Skin::falling.
void require_fitting(const SkinCalibration& calibration, const Skin& skin, std::string_view where);

/// Puts a calibration into effect: replaces all of `planes`, effects included, and the constants of
/// `skin` that the calibration has. Sensels masked in `planes` stay masked. Both must have the same
/// size.
void apply(const SkinCalibration& calibration, Skin& skin, Calibration& planes);

/// Sets the threshold to `factor` times the 99th percentile of noise · gain over the good sensels,
/// through the power law, or the polynomial that the solver evaluates for a response curve: then at
/// least the factor times the noise of the load. The calibration must have a noise plane.
void set_threshold(SkinCalibration& calibration, double factor);

/// Replaces the power law, and adjusts the threshold so that no reading crosses it.
void set_power_law(SkinCalibration& calibration, const std::optional<PowerLaw>& law);

}  // namespace pillarfield
