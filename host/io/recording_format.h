// Names in a calibration file that a recording lacks (docs/formats.md).

#pragma once

#include <hdf5.h>

#include "pillarfield/skin.h"
// Names and types in a recording (docs/formats.md).
namespace pillarfield::recording_format {

inline constexpr const char* kName = "pillarfield-recording";
inline constexpr int kNewestVersion = 3;
inline constexpr int kSparseTruthSince = 2;  ///< the truth may lack chunks
inline constexpr int kLayoutSince = 3;       ///< the skin may lack pillars

inline constexpr const char* kFrames = "/frames";
inline constexpr const char* kRaw = "/frames/raw";
inline constexpr const char* kTime = "/frames/time";
inline constexpr const char* kMissing = "/frames/missing";

inline constexpr const char* kSkin = "/skin";
inline constexpr const char* kPitch = "sensel_pitch_mm";
inline constexpr const char* kCountsPerNewton = "counts_per_newton";
inline constexpr const char* kThreshold = "threshold_counts";
inline constexpr const char* kFullScale = "full_scale_counts";
inline constexpr const char* kExponent = "power_law_exponent";
inline constexpr const char* kReference = "power_law_reference_counts";
inline constexpr const char* kFalling = "falling";  ///< 1: readings are mirrored
inline constexpr const char* kLayout = "layout";    ///< "pillars" or "sensels"

inline constexpr const char* kCalibration = "/calibration";
inline constexpr const char* kTare = "/calibration/tare";
inline constexpr const char* kGain = "/calibration/gain";
inline constexpr const char* kDeadZone = "/calibration/dead_zone";
inline constexpr const char* kMask = "/calibration/mask";
inline constexpr const char* kNoise = "/calibration/noise";
inline constexpr const char* kBendX = "/calibration/bend_x";
inline constexpr const char* kBendY = "/calibration/bend_y";
inline constexpr const char* kBendXy = "/calibration/bend_xy";
inline constexpr const char* kEffects = "/calibration/effects";

inline constexpr const char* kTruth = "/truth";
inline constexpr const char* kTruthPlanes[] = {"/truth/shear_x", "/truth/shear_y", "/truth/normal"};

/// True if a skin's truth has the plane of this index; without pillars, normal force alone.
[[nodiscard]] inline bool has_truth_plane(const Skin& skin, std::size_t plane) {
  constexpr std::size_t kNormal = 2;
  return skin.has_pillars() || plane == kNormal;
}

/// HDF5 type of a reading in the file, and in memory.
[[nodiscard]] hid_t stored_type_of(SenselType type);
[[nodiscard]] hid_t memory_type_of(SenselType type);

}  // namespace pillarfield::recording_format

namespace pillarfield::calibration_format {

inline constexpr const char* kName = "pillarfield-calibration";
inline constexpr int kVersion = 1;

inline constexpr const char* kRows = "rows";
inline constexpr const char* kCols = "cols";
inline constexpr const char* kThresholdFactor = "threshold_factor";

inline constexpr const char* kHistory = "/history";
inline constexpr const char* kStep = "step";
inline constexpr const char* kSources = "sources";
inline constexpr const char* kStepFrames = "frames";
inline constexpr const char* kParameters = "parameters";
inline constexpr const char* kDate = "date_utc";
inline constexpr const char* kProgramVersion = "program_version";

}  // namespace pillarfield::calibration_format
