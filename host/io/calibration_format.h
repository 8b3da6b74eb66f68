#pragma once

// Names in a calibration file that a recording lacks (docs/formats.md).
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
