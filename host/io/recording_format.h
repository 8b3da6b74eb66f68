// Names in a recording and in a calibration file that several files of code share
// (docs/formats.md).

#pragma once

#include <cstddef>

#include "pillarfield/skin.h"

namespace pillarfield::recording_format {

inline constexpr const char* kName = "pillarfield-recording";
inline constexpr int kNewestVersion = 3;
inline constexpr int kSparseTruthSince = 2;  ///< the truth may lack chunks
inline constexpr int kLayoutSince = 3;       ///< the skin may lack pillars

inline constexpr const char* kFrames = "/frames";
inline constexpr const char* kRaw = "/frames/raw";
inline constexpr const char* kTime = "/frames/time";
inline constexpr const char* kMissing = "/frames/missing";

inline constexpr const char* kTruth = "/truth";
inline constexpr const char* kTruthPlanes[] = {"/truth/shear_x", "/truth/shear_y", "/truth/normal"};

/// True if a skin's truth has the plane of this index; without pillars, normal force alone.
[[nodiscard]] inline bool has_truth_plane(const Skin& skin, std::size_t plane) {
  constexpr std::size_t kNormal = 2;
  return skin.has_pillars() || plane == kNormal;
}

}  // namespace pillarfield::recording_format

namespace pillarfield::calibration_format {

inline constexpr const char* kName = "pillarfield-calibration";
inline constexpr int kVersion = 1;

}  // namespace pillarfield::calibration_format
